//! Contact forces uploaded by the CPU.

use super::record::Part;
use crate::device::layout::What;

pub(super) fn part() -> Part {
    Part { frame: include_str!("handed.c"), formulas: Vec::new(), entries: &[(What::Handed, "handed_over")] }
}
