//! Fields of bodies. A new field needs a row here and an arm of `values` in `run/frames.rs`.

/// Condition for writing a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// Always; required for drawing.
    Always,
    /// Unless the scene selects fields.
    ByDefault,
    /// If selected, or for bonds and slides.
    OnRequest,
}

/// Field of bodies.
#[derive(Clone, Copy, Debug)]
pub struct BodyField {
    /// Name in files and in `output.fields`.
    pub name: &'static str,
    /// Name in legends.
    pub label: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Condition for writing.
    pub written: Written,
}

use Written::{Always, ByDefault, OnRequest};

/// All fields.
pub const BODY_FIELDS: [BodyField; 16] = [
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
    field("displacement", "Displacement", "m", OnRequest),
    field("initial_position", "Initial position", "m", OnRequest),
    field("acceleration", "Acceleration", "m/s²", OnRequest),
    field("stiffness_factor", "Stiffness over mean", "", OnRequest),
    field("broken_bonds", "Broken bonds", "", OnRequest),
    field("broken_by_shear", "Bonds broken by shear", "", OnRequest),
];

/// Body id on polygons of polyhedral grains, as `id` of spheres.
pub const STONE_BODY: &str = "body";

/// Centre of mass on polygons of polyhedral grains [m].
pub const STONE_CENTRE: &str = "centre";

/// Derived fields.
pub const MADE_FIELDS: [BodyField; 3] = [
    field("speed", "Speed", "m/s", Always),
    field("diameter", "Diameter", "m", Always),
    field("piece", "Piece", "", Always),
];

/// Finds a field by name.
pub fn body_field(name: &str) -> Option<&'static BodyField> {
    BODY_FIELDS.iter().chain(&MADE_FIELDS).find(|field| field.name == name)
}

const fn field(name: &'static str, label: &'static str, unit: &'static str, written: Written) -> BodyField {
    BodyField { name, label, unit, written }
}

/// Returns the fields with this condition.
pub fn body_fields(written: Written) -> impl Iterator<Item = &'static str> {
    BODY_FIELDS.iter().filter(move |field| field.written == written).map(|field| field.name)
}
