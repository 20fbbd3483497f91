//! Columns of an element list, and the rows of each element.
//!
//! The column count is the first of 22, 21, 20 and 26 that divides the file into whole elements. Otherwise
//! uniform lines of 10, 9, 8 or 14 columns are elements of 8 nodes, as are lines of 10 that do not pair into
//! 20 nodes.

use super::ansys_lists::ElementColumns;
use super::degenerate::from_brick;
use super::error::ReadError;
use super::number;
use super::table::{Row, Table};

/// Meaning of the columns before the nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Column of the element id.
    pub id: Option<usize>,
    /// Column of the material id.
    pub material: Option<usize>,
    /// First node column.
    pub nodes: usize,
    /// Number of nodes: 20 or 8.
    pub count: usize,
}

const ID_MATERIAL: Columns = Columns { id: Some(0), material: Some(1), nodes: 2, count: 20 };
const ID: Columns = Columns { id: Some(0), material: None, nodes: 1, count: 20 };
const MATERIAL: Columns = Columns { id: None, material: Some(0), nodes: 1, count: 20 };
const NEITHER: Columns = Columns { id: None, material: None, nodes: 0, count: 20 };
/// ELIST: element, material, type, real constant, coordinate system, section.
const LISTING: Columns = Columns { id: Some(0), material: Some(1), nodes: 6, count: 20 };

impl Columns {
    fn width(self) -> usize {
        self.nodes + self.count
    }

    fn of_eight(self) -> Columns {
        Columns { count: 8, ..self }
    }

    fn describe(self) -> &'static str {
        match (self.id, self.material, self.nodes) {
            (_, _, 6) => "26 (id mat type real system section n1…n20)",
            (Some(_), Some(_), _) => "22 (id mat n1…n20)",
            (Some(_), None, _) => "21 (id n1…n20)",
            (None, Some(_), _) => "21 (mat n1…n20)",
            (None, None, _) => "20 (n1…n20)",
        }
    }
}

/// Element in rows `first..end` of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    /// First row.
    pub first: usize,
    /// One past the last row.
    pub end: usize,
}

/// Splits the table into elements, with columns `wanted` or a guess that adds a warning.
pub fn split(
    table: &Table,
    wanted: ElementColumns,
    warnings: &mut Vec<String>,
) -> Result<(Columns, Vec<Record>), ReadError> {
    let given = match wanted {
        ElementColumns::IdMaterialNodes => Some(ID_MATERIAL),
        ElementColumns::IdNodes => Some(ID),
        ElementColumns::MaterialNodes => Some(MATERIAL),
        ElementColumns::Nodes => Some(NEITHER),
        ElementColumns::Auto => None,
    };
    if let Some(columns) = given {
        let eight = table.rows.iter().all(|row| row.width() == columns.of_eight().width());
        let columns = if eight { columns.of_eight() } else { columns };
        let (records, fault) = group(table, columns);
        return fault.map_or(Ok((columns, records)), Err);
    }
    let mut best: Option<(Columns, Vec<Record>, Option<ReadError>)> = None;
    for columns in [ID_MATERIAL, ID, NEITHER, LISTING] {
        let (records, fault) = group(table, columns);
        let rows_used = |records: &[Record]| records.last().map_or(0, |r| r.end);
        let better = match &best {
            None => true,
            Some((_, _, None)) => false,
            Some((kept, _, Some(_))) if fault.is_some() && usual(table, *kept) => false,
            Some((_, kept, Some(_))) => {
                fault.is_none() || usual(table, columns) || rows_used(&records) > rows_used(kept)
            }
        };
        if better {
            best = Some((columns, records, fault));
        }
    }
    let (mut columns, mut records, fault) = best.expect("the loop above tries four candidates");
    let two_lines = columns == NEITHER && table.rows.iter().all(|row| row.width() == 10);
    let fault = match (fault, two_lines && !records.iter().all(|record| is_brick(table, *record))) {
        (None, true) => Some(wrong_width(table, ID_MATERIAL, 0, 1, 10)),
        (fault, _) => fault,
    };
    if let Some(fault) = fault {
        let widths = [ID_MATERIAL, ID, NEITHER, LISTING].map(Columns::of_eight);
        let same = |c: &Columns| table.rows.iter().all(|row| row.width() == c.width());
        let Some(eight) = widths.into_iter().find(same) else { return Err(fault) };
        (columns, records) = (eight, group(table, eight).0);
    }
    if columns == ID || columns == ID.of_eight() {
        columns = id_or_material(table, columns.count, &records, warnings)?;
    }
    Ok((columns, records))
}

fn is_brick(table: &Table, record: Record) -> bool {
    let ids: Option<Vec<u32>> = fields(table, record).map(|(_, text)| number::whole(text)).collect();
    ids.is_some_and(|ids| from_brick(&ids).is_ok())
}

fn usual(table: &Table, columns: Columns) -> bool {
    let count = table.rows.iter().filter(|row| row.width() == columns.width()).count();
    2 * count > table.rows.len()
}

fn group(table: &Table, columns: Columns) -> (Vec<Record>, Option<ReadError>) {
    let width = columns.width();
    let mut records = Vec::with_capacity(table.rows.len());
    let mut first = 0;
    while first < table.rows.len() {
        let (mut end, mut count) = (first, 0);
        while count < width && end < table.rows.len() {
            count += table.rows[end].width();
            end += 1;
        }
        if count != width {
            return (records, Some(wrong_width(table, columns, first, end, count)));
        }
        records.push(Record { first, end });
        first = end;
    }
    (records, None)
}

fn wrong_width(table: &Table, columns: Columns, first: usize, end: usize, count: usize) -> ReadError {
    let (line, own, expected) = (table.rows[first].line, table.rows[first].width(), columns.describe());
    let last = count < columns.width();
    let key = if last { "columns of the last element" } else { "columns of an element" };
    let found = match (end - first, last) {
        (1, false) => format!("{own}"),
        (1, true) => format!("{own} and the end of the file (a truncated element)"),
        (_, true) => format!("{count} up to the end of the file (a truncated element)"),
        (_, false) => format!("{own}, and {count} with the lines up to {}", table.rows[end - 1].line),
    };
    ReadError::at(&table.file, line, key, found, expected)
}

/// Of 21 (8 nodes: 9) columns, the first is a material id if its values repeat, else an element id.
fn id_or_material(
    table: &Table,
    count: usize,
    records: &[Record],
    warnings: &mut Vec<String>,
) -> Result<Columns, ReadError> {
    let mut first: Vec<u32> = Vec::with_capacity(records.len());
    for record in records {
        first.push(table.whole(&table.rows[record.first], 0, "element or material number")?);
    }
    first.sort_unstable();
    first.dedup();
    let (columns, read, other) = if 2 * first.len() > records.len() {
        (ID, "element number", "material_nodes")
    } else {
        (MATERIAL, "material number", "id_nodes")
    };
    warnings.push(format!(
        "{}: {} columns: the first is read as the {read} ({} different values in {} elements); \
         columns = \"{other}\" reads it the other way",
        table.file.display(),
        count + 1,
        first.len(),
        records.len()
    ));
    Ok(Columns { count, ..columns })
}

pub fn fields<'a>(table: &'a Table, record: Record) -> impl Iterator<Item = (usize, &'a str)> + 'a {
    let rows: &'a [Row] = &table.rows[record.first..record.end];
    rows.iter().flat_map(move |row| table.fields(row).map(move |field| (row.line, field)))
}
