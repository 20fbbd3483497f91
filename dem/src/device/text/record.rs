//! A part of the text, and what the recorded formulas of all contacts share.

use crate::device::layout::What;
use crate::device::tape::{self, Recorded, Results, input, next, vector};
use crate::law::{ContactLaw, Memory, PairTable};

/// A part of the text.
pub(super) struct Part {
    /// C in which lines that begin with `//@` are to be replaced.
    pub frame: &'static str,
    /// By what.
    pub formulas: Vec<(&'static str, String)>,
    /// The entries of bodies that it is for, and the function of C that each is handed to.
    pub entries: &'static [(What, &'static str)],
}

/// A law whose constants are those that the text is handed for a pair of materials.
pub(super) fn law<L: ContactLaw>(table: &PairTable<L>) -> L::Lanes<Recorded> {
    L::mixed::<Recorded>([table.get(0, 0); 8], next)
}

/// What a contact remembers.
pub(super) fn memory() -> Memory<Recorded> {
    Memory { spring: vector("m"), rate: input("m.w"), roll: vector("r"), twist: input("r.w") }
}

/// Results that contacts of all kinds have.
pub(super) fn keep<const ROLL: bool>(
    out: &mut Results,
    m: &Memory<Recorded>,
    dashpot: Recorded,
    friction: Recorded,
    deep: tape::Truth,
) {
    out.vector("o->memory", m.spring);
    out.number("o->memory.w", m.rate);
    if ROLL {
        out.vector("o->turn", m.roll);
        out.number("o->turn.w", m.twist);
    }
    out.number("o->dashpot", dashpot);
    out.number("o->friction", friction);
    out.truth("o->deep", deep);
}

/// Energy left in the springs of a contact that ends.
pub(super) fn left<L: ContactLaw, const ROLL: bool>(table: &PairTable<L>) -> String {
    tape::begin();
    let law = law(table);
    let mut out = Results::default();
    out.number("left", L::stored_in_springs::<Recorded, ROLL>(&law, &memory()));
    out.text()
}
