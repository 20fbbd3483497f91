//! Kernel arguments, with their names in the kernel source.

use std::fmt::Write;
use std::ops::Range;

macro_rules! table {
    ($(#[$doc:meta])* $enum:ident { $($(#[$about:meta])* $entry:ident = $name:literal $(: $kind:literal)?),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum $enum { $($(#[$about])* $entry),+ }

        impl $enum {
            const ALL: &[(&str, &str)] = &[$(($name, concat!("" $(, $kind)?))),+];
            pub const COUNT: usize = Self::ALL.len();
        }
    };
}

table! {
    /// Arrays; old and new ones are swapped after each step.
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
        /// Bodies, or spheres with clumps; then plane.
        Ends = "ENDS": "ends",
        /// Offsets of the entries of each body, with end.
        Start = "START": "unsigned",
        /// Packed entry (see [`entry`]) and the other body.
        Entries = "ENTRIES": "ends",
        Law = "LAW": "const real",
        /// Unit normal n and n·x of a plane point; velocity and material.
        Planes = "PLANES": "const four",
        Single = "SINGLE": "const unsigned",
        /// Mass, moment of inertia; mass for first moments.
        Constants = "CONSTANTS": "const two",
        Mass = "MASS": "const real",
        Ranges = "RANGES": "unsigned",
        /// First body integrated singly, by block.
        FirstSingle = "FIRST_SINGLE": "const unsigned",
        Spent = "SPENT": "two",
        /// Centre and radius; body; offsets by body; centre in the body frame.
        OldSpheres = "OLD_SPHERES": "const four",
        NewSpheres = "NEW_SPHERES": "four",
        Owner = "OWNER": "const unsigned",
        FirstSphere = "FIRST_SPHERE": "const unsigned",
        Local = "LOCAL": "const four",
        /// Clumps: orientation, angular momentum, principal moments and bounding radius (spheres: zero),
        /// fixed angular velocity.
        OldOrientation = "OLD_ORIENTATION": "const four",
        NewOrientation = "NEW_ORIENTATION": "four",
        OldMomentum = "OLD_MOMENTUM": "const four",
        NewMomentum = "NEW_MOMENTUM": "four",
        Moments = "MOMENTS": "const four",
        Target = "TARGET": "const four",
        /// Power and force; moment about the origin.
        Walls = "WALLS": "four",
        /// Wall triangles and poses (`walls.rs`).
        Shapes = "SHAPES": "const real",
        Patches = "PATCHES": "const unsigned",
        WallNow = "WALL_NOW": "const real",
        PatchPairs = "PATCH_PAIRS": "const ends",
        Groups = "GROUPS": "const unsigned",
        /// Distance left to contact, and history.
        OldSpare = "OLD_SPARE": "const real",
        NewSpare = "NEW_SPARE": "real",
        OldTouch = "OLD_TOUCH": "const four",
        NewTouch = "NEW_TOUCH": "four",
        /// Residual spring energy of an ended contact, force, moment about the wall's centre.
        Ended = "ENDED": "real",
        Action = "ACTION": "four",
        /// Vector from sphere to image, angular impulse.
        Ways = "WAYS": "const four",
        Couples = "COUPLES": "four",
        HeldBy = "HELD_BY": "real",
        /// Bodies, constants, history (shear, rotation), dashpot power.
        BondEnds = "BOND_ENDS": "const ends",
        BondConstants = "BOND_CONSTANTS": "const real",
        OldBonds = "OLD_BONDS": "const four",
        NewBonds = "NEW_BONDS": "four",
        Power = "POWER": "real",
        Reference = "REFERENCE": "const real",
        Speed2 = "SPEED2": "real",
        /// Block totals, then the failure flag.
        Books = "BOOKS": "real",
        Flags = "FLAGS": "unsigned",
        /// CPU forces (`cpu_forces.rs`): offsets by entry, force and torque; bodies that the CPU needs, and their
        /// motion.
        HandedStart = "HANDED_START": "const unsigned",
        Handed = "HANDED": "const four",
        Watched = "WATCHED": "const unsigned",
        Picked = "PICKED": "four",
        /// 1/cell width and largest radius per size class; block of each body; point (1 if open), offset and
        /// normal of planes.
        Grids = "GRIDS": "const real",
        Block = "BLOCK": "const unsigned",
        PlanesSearched = "PLANES_SEARCHED": "const four",
        /// Offsets of buckets; bucket and index of each sphere; spheres by bucket.
        Cells = "CELLS": "unsigned",
        Bucket = "BUCKET": "unsigned",
        Place = "PLACE": "unsigned",
        Items = "ITEMS": "unsigned",
        /// Offsets by sphere: contacts (cross-block, in-block, planes), partners.
        Offsets = "OFFSETS": "unsigned",
        /// CPU entries: offsets by body, entries, `Lists::after`.
        RestStart = "REST_START": "const unsigned",
        Rest = "REST": "const ends",
        RestFrom = "REST_FROM": "const unsigned",
        /// Bonded partners, which exclude contacts.
        HeldStart = "HELD_START": "const unsigned",
        HeldWith = "HELD_WITH": "const unsigned",
        Rows = "ROWS": "unsigned",
        /// Previous contacts and offsets; totals found.
        OldEnds = "OLD_ENDS": "const ends",
        OldOffsets = "OLD_OFFSETS": "const unsigned",
        Totals = "TOTALS": "unsigned",
        Summed = "SUMMED": "unsigned",
        Sums = "SUMS": "unsigned",
    }
}

table! {
    Number {
        Step = "STEP",
        Way = "WAY",
        GravityX = "GRAVITY_X",
        GravityY = "GRAVITY_Y",
        GravityZ = "GRAVITY_Z",
        Damping = "DAMPING",
        Bound = "BOUND",
        /// Bound on relative displacements since the last rebuild [m].
        Gone = "GONE",
        /// Last time step and time since it [s]; initially zero.
        Last = "LAST",
        Since = "SINCE",
        /// Largest gap of listed partners [m].
        Reach = "REACH",
    }
}

table! {
    Count {
        Bodies = "BODIES",
        Blocks = "BLOCKS",
        Materials = "MATERIALS",
        FirstPlane = "FIRST_PLANE",
        FirstDebonded = "FIRST_DEBONDED",
        FirstPatch = "FIRST_PATCH",
        FirstImage = "FIRST_IMAGE",
        Spheres = "SPHERE_COUNT",
        Planes = "PLANE_COUNT",
        Watched = "WATCHED_COUNT",
        Buckets = "BUCKETS",
        /// Prefix sums: offset, length, offset of segment sums.
        SumFrom = "SUM_FROM",
        SumLength = "SUM_COUNT",
        SumTo = "SUM_TO",
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EntryKind {
    Spheres,
    Plane,
    Bond,
    Debonded,
    /// Possible clump members, with spheres or planes.
    Members,
    MemberPlane,
    Walls,
    Images,
    Handed,
}

/// Bits of an entry below the index.
const ENTRY_SHIFT: u32 = 5;

/// Packs an entry: index of the contact or bond, its type, and whether the body is its second.
pub(super) fn entry(what: EntryKind, of: u32, second: bool) -> u32 {
    of << ENTRY_SHIFT | (what as u32) << 1 | u32::from(second)
}

/// Unpacks type, index and side of an entry.
pub(super) fn parts_of(entry: u32) -> (usize, u32, bool) {
    ((entry >> ENTRY_SHIFT) as usize, entry >> 1 & ((1 << (ENTRY_SHIFT - 1)) - 1), entry & 1 == 1)
}

/// Integration flags: singly (with fixed motions), rotating (clumps, or groups with one), in a block with
/// orientations, not on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MotionFlags;

impl MotionFlags {
    pub const SINGLE: u32 = 1;
    pub const TURNS: u32 = 1 << 7;
    pub const ORIENTED: u32 = 1 << 8;
    pub const ON_HOST: u32 = 1 << 9;

    pub fn fixed(bits: u8) -> u32 {
        u32::from(bits) << 1
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum List {
    Bodies,
    /// Spheres across and within blocks; planes; debonded pairs across and within.
    Cross,
    Own,
    Planes,
    CrossDebonded,
    OwnDebonded,
    CrossBonds,
    OwnBonds,
    Patches,
    Images,
}
pub(super) const LISTS: usize = 10;

/// Parts of a block's totals, with their numbers of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TotalsPart {
    /// Loss by dashpots and friction, across, then within the block.
    Spheres,
    Planes,
    /// First moment of mass, and largest squared speed.
    Motion,
    /// Power across and within; loss of debonded pairs across and within.
    Bonds,
    Held,
    /// Loss; force and moment of each wall.
    Patches,
    Images,
}

impl TotalsPart {
    const ALL: [(TotalsPart, &str, usize); 7] = [
        (TotalsPart::Spheres, "SPHERES", 4),
        (TotalsPart::Planes, "PLANES", 9),
        (TotalsPart::Motion, "MOTION", 4),
        (TotalsPart::Bonds, "BONDS", 6),
        (TotalsPart::Held, "HELD", 21),
        (TotalsPart::Patches, "PATCHES", 2),
        (TotalsPart::Images, "IMAGES", 3),
    ];
}

pub(super) const WALL_TOTALS: usize = 6;
/// Values per triangle and wall, indices per triangle.
pub(super) const SHAPE_WIDTH: usize = 25;
pub(super) const WALL_WIDTH: usize = 19;
pub(super) const PATCH_WIDTH: usize = 5;

/// Values per thread in prefix sums.
pub(super) const STRETCH: usize = 64;

pub(super) const HELD_WIDTH: usize = 21;

/// Launch arguments, as in the kernel source.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Arguments {
    /// Array addresses.
    pub at: [u64; Slot::COUNT],
    /// Numbers.
    pub number: [f64; Number::COUNT],
    /// Counts.
    pub count: [u32; Count::COUNT],
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Features {
    pub law_width: usize,
    /// Whether any pair has rolling or twisting resistance or adhesion.
    pub roll: bool,
    /// Local damping, or fixed motions.
    pub damped: bool,
    pub held: bool,
    pub bonds: bool,
    pub clumps: bool,
    /// Walls that the device computes.
    pub walls: usize,
    pub periodic: bool,
    pub beside: bool,
    pub classes: usize,
}

impl Features {
    pub fn rest(&self) -> bool {
        self.bonds || self.walls > 0 || self.periodic || self.beside
    }

    pub fn picked_width(&self) -> usize {
        if self.clumps { 4 } else { 3 }
    }

    pub fn quantities(&self) -> usize {
        TotalsPart::ALL.iter().map(|(part, ..)| self.booked(*part).len()).sum()
    }

    /// Range of a part; empty if the model lacks it.
    pub fn booked(&self, of: TotalsPart) -> Range<usize> {
        let mut from = 0;
        for (part, _, count) in TotalsPart::ALL {
            let there = match part {
                TotalsPart::Spheres | TotalsPart::Planes | TotalsPart::Motion => count,
                TotalsPart::Bonds => {
                    if self.bonds {
                        count
                    } else {
                        0
                    }
                }
                TotalsPart::Held => {
                    if self.held {
                        count
                    } else {
                        0
                    }
                }
                TotalsPart::Images => {
                    if self.periodic {
                        count
                    } else {
                        0
                    }
                }
                TotalsPart::Patches => {
                    if self.walls > 0 {
                        count + WALL_TOTALS * self.walls
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

    /// C code that sums value `number` of all blocks.
    pub fn books(&self) -> String {
        let mut out = String::new();
        for (part, name, _) in TotalsPart::ALL {
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
        // Spheres only: fits the 128 registers of four resident blocks.
        ("BLOCKS_AT_ONCE", if f.clumps || f.bonds || f.walls > 0 || f.periodic || f.beside { 3 } else { 4 }),
        ("ENTRY_SHIFT", ENTRY_SHIFT as usize),
        ("PICKED_WIDTH", f.picked_width()),
        ("ELSEWHERE", MotionFlags::ON_HOST as usize),
        ("ACROSS", if f.clumps { EntryKind::Members } else { EntryKind::Spheres } as usize),
        ("WITHIN", EntryKind::Spheres as usize),
        ("WITHIN_TURNED", EntryKind::Members as usize),
        ("PLANE", EntryKind::Plane as usize),
        ("PLANE_TURNED", EntryKind::MemberPlane as usize),
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
            bit(MotionFlags::TURNS),
            bit(MotionFlags::ORIENTED),
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
