//! What the kernels are handed: places of arrays, numbers and counts, by the names that the text has for them.

use std::fmt::Write;
use std::ops::Range;

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
        /// Bodies of each contact, spheres where clumps may be; the second of those with planes is the plane.
        Ends = "ENDS": "ends",
        /// Where the entries of each body begin, and one past the last.
        Start = "START": "unsigned",
        /// A contact, a bond or what is handed over, what it is ([`What`]), and whether the body is the second, as [`entry`] puts them
        /// together; and what it is with: the other of the ends.
        Entries = "ENTRIES": "ends",
        /// Constants of the laws of each pair of materials.
        Law = "LAW": "const real",
        /// Unit normal and its product with a point; velocity and material.
        Planes = "PLANES": "const four",
        /// How a body moves ([`How`]).
        Single = "SINGLE": "const unsigned",
        /// Mass and moment of inertia of each body; its mass as sums of moments have it.
        Constants = "CONSTANTS": "const two",
        Mass = "MASS": "const real",
        /// Where the lists of each block begin ([`List`]).
        Ranges = "RANGES": "unsigned",
        /// The first body of each block that moves by itself, or one past its last.
        FirstSingle = "FIRST_SINGLE": "const unsigned",
        /// What dashpots and friction took in each contact.
        Spent = "SPENT": "two",
        /// Spheres of clumps and single ones: centre and radius, the body of each, the first of each body and one past the last, and
        /// where they lie in the frames of their bodies.
        OldSpheres = "OLD_SPHERES": "const four",
        NewSpheres = "NEW_SPHERES": "four",
        Owner = "OWNER": "const unsigned",
        FirstSphere = "FIRST_SPHERE": "const unsigned",
        Local = "LOCAL": "const four",
        /// Of each body in a model with clumps: orientation; angular momentum; principal moments and bounding radius, which is
        /// zero of spheres; the spin that fixed rotations keep.
        OldOrientation = "OLD_ORIENTATION": "const four",
        NewOrientation = "NEW_ORIENTATION": "four",
        OldMomentum = "OLD_MOMENTUM": "const four",
        NewMomentum = "NEW_MOMENTUM": "four",
        Moments = "MOMENTS": "const four",
        Target = "TARGET": "const four",
        /// What planes did in each of their contacts: power and force; moment about the origin.
        Walls = "WALLS": "four",
        /// Numbers and names of each triangle of walls, and where the walls are (`walls.rs`).
        Shapes = "SHAPES": "const real",
        Patches = "PATCHES": "const unsigned",
        WallNow = "WALL_NOW": "const real",
        /// Sphere and triangle of each pair; the first pair of each sphere that has any, and one past the last.
        PatchPairs = "PATCH_PAIRS": "const ends",
        Groups = "GROUPS": "const unsigned",
        /// Way that is left of each pair, and what it remembers of its contact.
        OldSpare = "OLD_SPARE": "const real",
        NewSpare = "NEW_SPARE": "real",
        OldTouch = "OLD_TOUCH": "const four",
        NewTouch = "NEW_TOUCH": "four",
        /// What the springs of a contact that ended had left, force on the body and moment about the centre of the wall, of each pair.
        Ended = "ENDED": "real",
        Action = "ACTION": "four",
        /// Of each contact across a periodic border the way of the image from its sphere, and the angular impulse that it gives.
        Ways = "WAYS": "const four",
        Couples = "COUPLES": "four",
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
        /// What each block books, and behind it whether the step has failed.
        Books = "BOOKS": "real",
        /// Whether a step has failed.
        Flags = "FLAGS": "unsigned",
        /// What the processor has worked out (`handed.rs`): where the forces of each entry begin, and one past the last; force and
        /// torque of each. The bodies that it needs to know, and their motion.
        HandedStart = "HANDED_START": "const unsigned",
        Handed = "HANDED": "const four",
        Watched = "WATCHED": "const unsigned",
        Picked = "PICKED": "four",
        /// Of the search. One over the width of the cells and the largest radius of each class of size; the block of each body; point,
        /// with one where it is open, offset and normal of each plane.
        Grids = "GRIDS": "const real",
        Block = "BLOCK": "const unsigned",
        PlanesSearched = "PLANES_SEARCHED": "const four",
        /// First item of each bucket and one past the last; the bucket of each sphere and its place there; spheres by bucket.
        Cells = "CELLS": "unsigned",
        Bucket = "BUCKET": "unsigned",
        Place = "PLACE": "unsigned",
        Items = "ITEMS": "unsigned",
        /// First contact of each sphere with other blocks, then within its own, then with planes; first of its partners. One past the last.
        Offsets = "OFFSETS": "unsigned",
        /// Entries that the processor lists: where those of each body begin, and one past the last; the entries; the block after whose
        /// contacts across each is summed up, which is one past the last for what follows all of these, and more for what comes last.
        RestStart = "REST_START": "const unsigned",
        Rest = "REST": "const ends",
        RestFrom = "REST_FROM": "const unsigned",
        /// Partners of each body that it never has a contact with, as these have bonds: where they begin, and one past the last.
        HeldStart = "HELD_START": "const unsigned",
        HeldWith = "HELD_WITH": "const unsigned",
        /// Partners of each sphere, ascending.
        Rows = "ROWS": "unsigned",
        /// Contacts and their offsets before the search, and how much it has found.
        OldEnds = "OLD_ENDS": "const ends",
        OldOffsets = "OLD_OFFSETS": "const unsigned",
        Totals = "TOTALS": "unsigned",
        /// A list of which sums are made, and those of its stretches.
        Summed = "SUMMED": "unsigned",
        Sums = "SUMS": "unsigned",
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
        /// Bound on the way that anything has come towards anything since the near list was made.
        Gone = "GONE",
        /// The last step, and the time since then: zero before the first.
        Last = "LAST",
        Since = "SINCE",
        /// Way apart up to which partners are listed.
        Reach = "REACH",
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
        /// The first contact of a sphere and a triangle.
        FirstPatch = "FIRST_PATCH",
        /// The first contact across a periodic border.
        FirstImage = "FIRST_IMAGE",
        Spheres = "SPHERE_COUNT",
        Planes = "PLANE_COUNT",
        Watched = "WATCHED_COUNT",
        /// A power of two.
        Buckets = "BUCKETS",
        /// Of sums: where the list begins, its length, and where the sums of its stretches go.
        SumFrom = "SUM_FROM",
        SumLength = "SUM_COUNT",
        SumTo = "SUM_TO",
    }
}

/// What an entry of a body is: at most sixteen kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Spheres,
    Plane,
    Bond,
    Debonded,
    /// A contact of spheres that may be members of clumps, and one of such a sphere with a plane.
    Members,
    MemberPlane,
    /// The pairs of a sphere with triangles.
    Walls,
    /// A contact across a periodic border.
    Images,
    /// What the processor hands over.
    Handed,
}

/// Bits of an entry below what it is of.
const ENTRY_SHIFT: u32 = 5;

/// The entry of a body: contact or bond `of`, of which it may be the `second`.
pub(super) fn entry(what: What, of: u32, second: bool) -> u32 {
    of << ENTRY_SHIFT | (what as u32) << 1 | u32::from(second)
}

/// What an entry is of, the number of a [`What`], and whether the body is the second.
pub(super) fn parts_of(entry: u32) -> (usize, u32, bool) {
    ((entry >> ENTRY_SHIFT) as usize, entry >> 1 & ((1 << (ENTRY_SHIFT - 1)) - 1), entry & 1 == 1)
}

/// How a body moves: by itself, with bits of fixed motions; turning, as clumps do and all of a group of four with one; in a block with
/// orientations; not on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct How;

impl How {
    pub const SINGLE: u32 = 1;
    pub const TURNS: u32 = 1 << 7;
    pub const ORIENTED: u32 = 1 << 8;
    /// The processor moves it.
    pub const ELSEWHERE: u32 = 1 << 9;

    /// Bits of fixed motions of a body that moves by itself.
    pub fn fixed(bits: u8) -> u32 {
        u32::from(bits) << 1
    }
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
    /// Pairs of spheres and triangles.
    Patches,
    /// Contacts across periodic borders.
    Images,
}
pub(super) const LISTS: usize = 10;

/// What a block books, part by part: how many numbers each, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Booked {
    /// What dashpots and friction took in contacts of spheres with other blocks, then within.
    Spheres,
    /// The same of contacts with planes; power, force and moment of what the planes did.
    Planes,
    /// Mass times position, and the largest square of a speed.
    Motion,
    /// Power of bonds across and within; what dashpots and friction took in contacts of debonded pairs across and within.
    Bonds,
    /// What local damping and fixed motions did.
    Held,
    /// What dashpots and friction took in contacts with triangles; force and moment of each wall.
    Patches,
    /// Angular impulse of contacts across periodic borders.
    Images,
}

impl Booked {
    const ALL: [(Booked, &str, usize); 7] = [
        (Booked::Spheres, "SPHERES", 4),
        (Booked::Planes, "PLANES", 9),
        (Booked::Motion, "MOTION", 4),
        (Booked::Bonds, "BONDS", 6),
        (Booked::Held, "HELD", 21),
        (Booked::Patches, "PATCHES", 2),
        (Booked::Images, "IMAGES", 3),
    ];
}

/// Numbers that a block books of each wall: force and moment.
pub(super) const WALL_BOOKED: usize = 6;
/// Numbers of a triangle and of a wall, and names of a triangle.
pub(super) const SHAPE_WIDTH: usize = 25;
pub(super) const WALL_WIDTH: usize = 19;
pub(super) const PATCH_WIDTH: usize = 5;

/// Numbers that one thread sums up in the search.
pub(super) const STRETCH: usize = 64;

/// Numbers that a body keeps for local damping and fixed motions.
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
    /// Whether any body is a clump.
    pub clumps: bool,
    /// Number of walls, where these are the device's.
    pub walls: usize,
    /// Whether there are periodic borders.
    pub periodic: bool,
    /// Whether the processor has a part in each step.
    pub beside: bool,
    /// Classes of size in the search for neighbours.
    pub classes: usize,
}

impl Features {
    /// Whether there is anything that the processor lists.
    pub fn rest(&self) -> bool {
        self.bonds || self.walls > 0 || self.periodic || self.beside
    }

    /// Records of four that state where a body is and how it moves.
    pub fn picked_width(&self) -> usize {
        if self.clumps { 4 } else { 3 }
    }

    /// Numbers that a block books.
    pub fn quantities(&self) -> usize {
        Booked::ALL.iter().map(|(part, ..)| self.booked(*part).len()).sum()
    }

    /// Where the numbers of a part lie among them; nowhere where a model has none.
    pub fn booked(&self, of: Booked) -> Range<usize> {
        let mut from = 0;
        for (part, _, count) in Booked::ALL {
            let there = match part {
                Booked::Spheres | Booked::Planes | Booked::Motion => count,
                Booked::Bonds => {
                    if self.bonds {
                        count
                    } else {
                        0
                    }
                }
                Booked::Held => {
                    if self.held {
                        count
                    } else {
                        0
                    }
                }
                Booked::Images => {
                    if self.periodic {
                        count
                    } else {
                        0
                    }
                }
                Booked::Patches => {
                    if self.walls > 0 {
                        count + WALL_BOOKED * self.walls
                    } else {
                        0
                    }
                }
            };
            let to = from + there;
            if part == of {
                return from..to;
            }
            from = to;
        }
        from..from
    }

    /// The lines of C that sum up number `number` of all blocks, which lie part by part, by the function of its part.
    pub fn books(&self) -> String {
        let mut out = String::new();
        for (part, name, _) in Booked::ALL {
            let Range { start, end } = self.booked(part);
            let count = end - start;
            if count > 0 {
                let name = name.to_lowercase();
                _ = writeln!(
                    out,
                    "    if (number < {count}u * BLOCKS) {{\n        \
                     const unsigned block = number / {count}u, q = number % {count}u;\n        \
                     const real x = {name}_books(p, LISTS_OF(block), LISTS_OF(block + 1), q);\n        \
                     if (t % 4 == 0) BOOKS[block * QUANTITIES + {start}u + q] = x;\n        \
                     return;\n    }}\n    number -= {count}u * BLOCKS;"
                );
            }
        }
        out
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
        ("LAW_WIDTH", f.law_width),
        ("HELD_WIDTH", HELD_WIDTH),
        ("SHAPE_WIDTH", SHAPE_WIDTH),
        ("WALL_WIDTH", WALL_WIDTH),
        ("PATCH_WIDTH", PATCH_WIDTH),
        ("PATCHES_LIST", List::Patches as usize),
        ("IMAGES_LIST", List::Images as usize),
        ("BOND_WIDTH", crate::bond::kernel::COUNT),
        ("ITERATIONS", crate::integrate::rotation::ITERATIONS),
        ("CLASSES", f.classes),
        ("STRETCH", STRETCH),
        // With spheres alone a step fits into the 128 registers that four blocks at once leave a thread, and is faster; larger steps would spill.
        ("BLOCKS_AT_ONCE", if f.clumps || f.bonds || f.walls > 0 || f.periodic || f.beside { 3 } else { 4 }),
        ("ENTRY_SHIFT", ENTRY_SHIFT as usize),
        ("PICKED_WIDTH", f.picked_width()),
        ("ELSEWHERE", How::ELSEWHERE as usize),
        ("ACROSS", if f.clumps { What::Members } else { What::Spheres } as usize),
        ("WITHIN", What::Spheres as usize),
        ("WITHIN_TURNED", What::Members as usize),
        ("PLANE", What::Plane as usize),
        ("PLANE_TURNED", What::MemberPlane as usize),
    ];
    for (name, value) in sizes {
        _ = writeln!(out, "#define {name} {value}u");
    }
    let flags = [
        ("ROLL", f.roll),
        ("HELD", f.held),
        ("CLUMPS", f.clumps),
        ("PERIODIC", f.periodic),
        ("BESIDE", f.beside),
        ("BONDS", f.bonds),
        ("LISTED_THERE", f.rest()),
    ];
    for (name, on) in flags {
        _ = writeln!(out, "#define {name} {}", u32::from(on));
    }
    let how = if f.clumps {
        let bit = |of: u32| format!("((SINGLE[i] & {of}u) != 0)");
        [
            "((SINGLE[i] & 1u) == 0)".into(),
            "(SINGLE[i] >> 1 & 63u)".into(),
            bit(How::TURNS),
            bit(How::ORIENTED),
        ]
    } else {
        ["(SINGLE[i] == 0)".into(), "(SINGLE[i] >> 1)".into(), "0".to_string(), "0".to_string()]
    };
    for (name, test) in ["BY_FOUR", "FIXED", "TURNS", "ORIENTED"].into_iter().zip(how) {
        _ = writeln!(out, "#define {name}(i) {test}");
    }
    _ = writeln!(out, "#define FRESH {fresh}");
    out
}
