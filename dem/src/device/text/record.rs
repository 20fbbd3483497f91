//! Part of the kernel source, and formulas common to all contacts.

use crate::device::layout::EntryKind;
use crate::device::tape::{self, Recorded, Results, input, next, vector};
use crate::law::{ContactLaw, HistoryLanes, PairTable};

pub(super) struct Part {
    /// C template; lines starting with `//@` are replaced.
    pub frame: &'static str,
    pub formulas: Vec<(&'static str, String)>,
    /// Entry types of the part, and their C functions.
    pub entries: &'static [(EntryKind, &'static str)],
}

/// Law with the constants of a material pair.
pub(super) fn law<L: ContactLaw>(table: &PairTable<L>) -> L::Lanes<Recorded> {
    L::mixed::<Recorded>([table.get(0, 0); 8], next)
}

pub(super) fn memory() -> HistoryLanes<Recorded> {
    HistoryLanes { spring: vector("m"), rate: input("m.w"), roll: vector("r"), twist: input("r.w") }
}

pub(super) fn keep<const ROLLING: bool>(
    out: &mut Results,
    m: &HistoryLanes<Recorded>,
    dashpot: Recorded,
    friction: Recorded,
    deep: tape::RecordedMask,
) {
    out.vector("o->memory", m.spring);
    out.number("o->memory.w", m.rate);
    if ROLLING {
        out.vector("o->turn", m.roll);
        out.number("o->turn.w", m.twist);
    }
    out.number("o->dashpot", dashpot);
    out.number("o->friction", friction);
    out.truth("o->deep", deep);
}

/// Residual spring energy of an ended contact.
pub(super) fn left<L: ContactLaw, const ROLLING: bool>(table: &PairTable<L>) -> String {
    tape::begin();
    let law = law(table);
    let mut out = Results::default();
    out.number("left", L::tangential_energy::<Recorded, ROLLING>(&law, &memory()));
    out.text()
}
