//! Neighbour search.

use super::record::Part;
use crate::device::tape::{self, Results, input, vector};
use crate::pairs::reach;

pub(super) fn part() -> Part {
    Part {
        frame: include_str!("search.c"),
        formulas: vec![("SPHERES_NEAR", spheres()), ("PLANE_NEAR", plane())],
        entries: &[],
    }
}

fn spheres() -> String {
    tape::begin();
    let mut out = Results::default();
    let radii = (input("xa.w"), input("xb.w"));
    out.truth("on", reach::spheres(vector("xa") - vector("xb"), radii, input("near")));
    out.text()
}

fn plane() -> String {
    tape::begin();
    let mut out = Results::default();
    let from = vector("x") - vector("point") - vector("offset");
    out.truth("on", reach::plane(from, vector("normal"), input("x.w"), input("near")));
    out.text()
}
