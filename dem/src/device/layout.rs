//! What the kernels are handed: places of arrays, numbers and counts, by the names that the text has for them.

use std::fmt::Write;

macro_rules! table {
    ($(#[$doc:meta])* $enum:ident { $($(#[$about:meta])* $entry:ident = $name:literal $(: $kind:literal)?),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum $enum { $($(#[$about])* $entry),+ }

        impl $enum {
            /// Name, and type of what an array holds.
            const ALL: &[(&str, &str)] = &[$(($name, concat!("" $(, $kind)?))),+];
            /// How many there are.
            pub const COUNT: usize = Self::ALL.len();
        }
    };
}

table! {
    /// Arrays. Those with an old and a new one change places after each step.
    Slot {
        OldX = "OLD_X": "const four",
        OldV = "OLD_V": "const four",
        OldW = "OLD_W": "const four",
        OldMemory = "OLD_MEMORY": "const four",
        OldTurn = "OLD_TURN": "const four",
        NewX = "NEW_X": "four",
        NewV = "NEW_V": "four",
        NewW = "NEW_W": "four",
        NewMemory = "NEW_MEMORY": "four",
        NewTurn = "NEW_TURN": "four",
        /// Bodies of each contact; the second of those with planes is the plane.
        Ends = "ENDS": "const ends",
        /// Where the entries of each body begin, and one past the last.
        Start = "START": "const unsigned",
        /// Eight times a contact or bond; plus twice what it is ([`What`]), plus one where the body is the second.
        Entries = "ENTRIES": "const unsigned",
        /// Constants of the laws of each pair of materials.
        Law = "LAW": "const real",
        /// Unit normal and its product with a point; velocity and material.
        Planes = "PLANES": "const four",
        /// Zero for bodies that move four at a time, else 1 and twice the bits of fixed motions.
        Single = "SINGLE": "const unsigned",
        /// Mass and moment of inertia of each body.
        Constants = "CONSTANTS": "const two",
        /// Where the lists of each block begin ([`List`]).
        Ranges = "RANGES": "const unsigned",
        /// What dashpots and friction took in each contact.
        Spent = "SPENT": "two",
        /// What planes did in each of their contacts: power and force; moment about the origin.
        Walls = "WALLS": "four",
        /// What local damping and fixed motions did to each body, where a model has them.
        HeldBy = "HELD_BY": "real",
        /// Bodies of each bond, its constants, what it remembers (shear, turn), and the power of its dashpots.
        BondEnds = "BOND_ENDS": "const ends",
        BondConstants = "BOND_CONSTANTS": "const real",
        OldBonds = "OLD_BONDS": "const four",
        NewBonds = "NEW_BONDS": "four",
        Power = "POWER": "real",
        /// Overlap of each debonded pair that does not count.
        Reference = "REFERENCE": "const real",
        /// Square of the speed of each body.
        Speed2 = "SPEED2": "real",
        /// What each block books.
        Books = "BOOKS": "real",
        /// Whether a step has failed.
        Flags = "FLAGS": "unsigned",
    }
}

table! {
    /// Numbers.
    Number {
        Step = "STEP",
        Way = "WAY",
        GravityX = "GRAVITY_X",
        GravityY = "GRAVITY_Y",
        GravityZ = "GRAVITY_Z",
        Damping = "DAMPING",
        Bound = "BOUND",
        /// The last step, and the time since then: zero before the first.
        Last = "LAST",
        Since = "SINCE",
    }
}

table! {
    /// Counts.
    Count {
        Bodies = "BODIES",
        Blocks = "BLOCKS",
        Materials = "MATERIALS",
        /// The first contact with a plane.
        FirstPlane = "FIRST_PLANE",
        /// The first contact of a debonded pair.
        FirstDebonded = "FIRST_DEBONDED",
    }
}

/// What an entry of a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Spheres,
    Plane,
    Bond,
    Debonded,
}

/// Lists of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    Bodies,
    /// Contacts of spheres with other blocks and within; with planes; of debonded pairs across and within.
    Cross,
    Own,
    Planes,
    CrossDebonded,
    OwnDebonded,
    /// Bonds across and within.
    CrossBonds,
    OwnBonds,
}
pub(super) const LISTS: usize = 8;

/// Numbers that a block books, and those for bonds, for local damping and fixed motions beside them.
pub(super) const QUANTITIES: usize = 17;
pub(super) const BOND_QUANTITIES: usize = 6;
pub(super) const HELD_QUANTITIES: usize = 21;
/// Numbers that a body keeps for these.
pub(super) const HELD_WIDTH: usize = 21;

/// Arguments of a launch, as the text declares them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Arguments {
    /// Addresses of arrays.
    pub at: [u64; Slot::COUNT],
    /// Numbers.
    pub number: [f64; Number::COUNT],
    /// Counts.
    pub count: [u32; Count::COUNT],
}

/// What the text is for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Features {
    /// Constants of a pair of materials.
    pub law_width: usize,
    /// Whether any pair resists rolling or twisting, or adheres.
    pub roll: bool,
    /// Whether there are local damping, and motions held by it or fixed.
    pub damped: bool,
    pub held: bool,
    pub bonds: bool,
}

impl Features {
    /// Numbers that a block books.
    pub fn quantities(&self) -> usize {
        self.held_at() + if self.held { HELD_QUANTITIES } else { 0 }
    }

    /// Where those for local damping and fixed motions begin; those for bonds lie before them.
    pub fn held_at(&self) -> usize {
        QUANTITIES + if self.bonds { BOND_QUANTITIES } else { 0 }
    }
}

/// The declarations that the text begins with.
pub(super) fn declarations(f: &Features, fresh: &str) -> String {
    let mut out = format!(
        "typedef struct {{ void *at[{}]; real number[{}]; unsigned count[{}]; }} arguments;\n",
        Slot::COUNT,
        Number::COUNT,
        Count::COUNT
    );
    for (k, (name, kind)) in Slot::ALL.iter().enumerate() {
        _ = writeln!(out, "#define {name} (({kind} *)OF(at)[{k}])");
    }
    for (k, (name, _)) in Number::ALL.iter().enumerate() {
        _ = writeln!(out, "#define {name} (OF(number)[{k}])");
    }
    for (k, (name, _)) in Count::ALL.iter().enumerate() {
        _ = writeln!(out, "#define {name} (OF(count)[{k}])");
    }
    let sizes = [
        ("LISTS", LISTS),
        ("QUANTITIES", f.quantities()),
        ("BONDS_BOOKED", QUANTITIES),
        ("HELD_BOOKED", f.held_at()),
        ("LAW_WIDTH", f.law_width),
        ("HELD_WIDTH", HELD_WIDTH),
        ("BOND_WIDTH", crate::bond::kernel::COUNT),
    ];
    for (name, value) in sizes {
        _ = writeln!(out, "#define {name} {value}u");
    }
    for (name, on) in [("ROLL", f.roll), ("HELD", f.held), ("BONDS", f.bonds)] {
        _ = writeln!(out, "#define {name} {}", u32::from(on));
    }
    _ = writeln!(out, "#define FRESH {fresh}");
    out
}
