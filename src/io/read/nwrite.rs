//! Fixed columns of NWRITE, which leaves trailing zeros blank.
//!
//! Source: ANSYS Mechanical APDL Command Reference, NWRITE: `(I9,6G21.13E3)`, in older versions
//! `(I8,6G20.13)`.

use super::table::{Row, Table};

const WIDTHS: [(usize, usize); 2] = [(9, 21), (8, 20)];

/// Column of each field after the id, from 0, if rows are shorter than `id x y z` and all fit NWRITE.
pub(super) fn places(table: &Table) -> Option<Vec<Vec<usize>>> {
    let short = table.rows.iter().any(|row| row.width() < 4);
    let full = table.rows.iter().any(|row| row.width() >= 4);
    if !short || !full {
        return None;
    }
    WIDTHS.iter().find_map(|widths| table.rows.iter().map(|row| in_columns(table, row, *widths)).collect())
}

fn in_columns(table: &Table, row: &Row, (id, real): (usize, usize)) -> Option<Vec<usize>> {
    if table.extent(row, 0).1 != id {
        return None;
    }
    let mut places = Vec::with_capacity(row.width() - 1);
    for column in 1..row.width() {
        let (from, to) = table.extent(row, column);
        let place = (from.checked_sub(id)?) / real;
        let within = to <= id + (place + 1) * real && place < 6;
        if !within || places.last().is_some_and(|last| *last >= place) {
            return None;
        }
        places.push(place);
    }
    Some(places)
}
