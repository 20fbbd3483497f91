//! What the processor hands over: forces of contacts that it has worked out itself.

use super::record::Part;
use crate::device::layout::What;

pub(super) fn part() -> Part {
    Part { frame: include_str!("handed.c"), formulas: Vec::new(), entries: &[(What::Handed, "handed_over")] }
}
