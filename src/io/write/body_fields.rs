//! Fields of bodies. A new field needs a row here and an arm of `values` in `run/frames.rs`.

use super::fields::Needs::{Bonds, ContactForcesOnly, NoBorders, Spread};
use super::fields::Written::{Always, ByDefault, OnRequest, With};
use super::fields::{FrameField, field};

/// All fields.
pub const BODY_FIELDS: [FrameField; 16] = [
    field("radius", "Radius", "m", Always),
    field("velocity", "Velocity", "m/s", ByDefault),
    field("spin", "Spin", "rad/s", ByDefault),
    field("orientation", "Orientation", "", ByDefault),
    field("id", "Body", "", Always),
    field("part", "Group", "", Always),
    field("mean_stress", "Mean stress", "Pa", ByDefault),
    field("force", "Contact force", "N", ByDefault),
    field("coordination", "Coordination", "", ByDefault),
    field("fragment", "Fragment", "", ByDefault),
    field("displacement", "Displacement", "m", OnRequest(NoBorders)),
    field("initial_position", "Initial position", "m", OnRequest(NoBorders)),
    field("acceleration", "Acceleration", "m/s²", OnRequest(ContactForcesOnly)),
    field("stiffness_factor", "Stiffness over mean", "", With(Spread)),
    field("broken_bonds", "Broken bonds", "", With(Bonds)),
    field("broken_by_shear", "Bonds broken by shear", "", OnRequest(Bonds)),
];

/// Body id on polygons of polyhedral grains, as `id` of spheres.
pub const STONE_BODY: &str = "body";

/// Centre of mass on polygons of polyhedral grains [m].
pub const STONE_CENTRE: &str = "centre";

/// Derived fields.
pub const MADE_FIELDS: [FrameField; 3] = [
    field("speed", "Speed", "m/s", Always),
    field("diameter", "Diameter", "m", Always),
    field("piece", "Piece", "", Always),
];

/// Finds a field by name.
pub fn body_field(name: &str) -> Option<&'static FrameField> {
    BODY_FIELDS.iter().chain(&MADE_FIELDS).find(|field| field.name == name)
}
