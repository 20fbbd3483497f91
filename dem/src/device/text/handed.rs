//! Contact forces uploaded by the CPU.

use super::record::Part;
use crate::device::layout::EntryKind;

pub(super) fn part() -> Part {
    Part {
        frame: include_str!("handed.c"),
        formulas: Vec::new(),
        entries: &[(EntryKind::Handed, "handed_over")],
    }
}
