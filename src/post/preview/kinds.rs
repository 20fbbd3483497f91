//! Kinds of objects.

use super::context::Context;
use super::item::Item;
use super::{grains, observed, solid, structures, walls};
use crate::water;

/// Kind of objects. One entry is all that a new kind needs.
pub struct Kind {
    /// Identifier.
    pub word: &'static str,
    /// Heading.
    pub label: &'static str,
    /// Part of pictures, as in `--show` and `--hide`.
    pub part: &'static str,
    /// Whether shown at first.
    pub shown: bool,
    /// Opacity.
    pub opacity: f32,
    /// Colour `rrggbb` of objects without their own.
    pub colour: &'static str,
    pub(super) make: fn(&Context) -> Vec<Item>,
}

/// All kinds. Later ones extend to the bounds of earlier ones.
pub static KINDS: [Kind; 17] = {
    const fn kind(
        (word, label, part): (&'static str, &'static str, &'static str),
        (shown, opacity, colour): (bool, f32, &'static str),
        make: fn(&Context) -> Vec<Item>,
    ) -> Kind {
        Kind { word, label, part, shown, opacity, colour, make }
    }
    [
        kind(("solid", "Solid", "solid"), (true, 1.0, "9aa7b3"), solid::materials),
        kind(("grains", "Grains", "grains"), (true, 1.0, "b9ab94"), grains::groups),
        kind(("fills", "Filled regions", "marks"), (true, 1.0, "0072b2"), grains::fills),
        kind(("sleepers", "Sleepers", "track"), (true, 1.0, "8f959c"), walls::sleepers),
        kind(("rails", "Rails, seat loads", "track"), (true, 1.0, "5b4a3f"), walls::rails),
        kind(("supports", "Supports", "marks"), (true, 1.0, "218f33"), solid::supports),
        kind(("loads", "Loads", "marks"), (true, 1.0, "d55e00"), solid::loads),
        kind(("absorbing", "Absorbing boundaries", "marks"), (true, 0.6, "cc79a7"), solid::absorbing),
        kind(("probes", "Probes", "marks"), (true, 1.0, "cc0077"), observed::probes),
        kind(("boxes", "Measuring boxes", "marks"), (true, 1.0, "8a2be2"), observed::boxes),
        kind(
            ("structures", "Structures with recorded loads", "marks"),
            (true, 1.0, "7a3e9d"),
            structures::all,
        ),
        kind(("flow", "Inlets, outlets", "marks"), (true, 1.0, "218f33"), grains::flow),
        kind(("walls", "Walls", "boundary"), (true, 0.25, "7d8fa3"), walls::walls),
        kind(("water", "Water", "water"), (true, water::OPACITY, water::COLOUR), observed::water),
        kind(("periodic", "Periodic borders", "boundary"), (true, 0.15, "cc79a7"), observed::periodic),
        kind(("contact", "Contact faces of the solid", "sets"), (false, 1.0, "7fd6bd"), solid::contact),
        kind(("sets", "Sets of the mesh", "sets"), (false, 1.0, "e69f00"), solid::sets),
    ]
};
