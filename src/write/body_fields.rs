//! The fields of bodies in frames, pictures and the viewer. A new one is a row here, and an arm of `values` in `run/frames.rs`.

/// When a frame has a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// Always: nothing can be drawn without it.
    Always,
    /// Unless the scene names others.
    ByDefault,
    /// Where the scene names it, or has what it shows: bonds, a slide.
    OnRequest,
}

/// A field of bodies.
#[derive(Clone, Copy, Debug)]
pub struct BodyField {
    /// Name in files and in `output.fields`.
    pub name: &'static str,
    /// Name in legends.
    pub label: &'static str,
    /// Unit; empty where there is none.
    pub unit: &'static str,
    /// When it is written.
    pub written: Written,
}

use Written::{Always, ByDefault, OnRequest};

/// All of them, in the order of the files.
pub const BODY_FIELDS: [BodyField; 15] = [
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
    field("broken_bonds", "Broken bonds", "", OnRequest),
    field("broken_by_shear", "Bonds broken by shear", "", OnRequest),
];

/// Fields that pictures make of those of the files.
pub const MADE_FIELDS: [BodyField; 3] = [
    field("speed", "Speed", "m/s", Always),
    field("diameter", "Diameter", "m", Always),
    field("piece", "Piece", "", Always),
];

/// A field of files or pictures by its name.
pub fn body_field(name: &str) -> Option<&'static BodyField> {
    BODY_FIELDS.iter().chain(&MADE_FIELDS).find(|field| field.name == name)
}

const fn field(name: &'static str, label: &'static str, unit: &'static str, written: Written) -> BodyField {
    BodyField { name, label, unit, written }
}

/// Names of the fields that are written so.
pub fn body_fields(written: Written) -> impl Iterator<Item = &'static str> {
    BODY_FIELDS.iter().filter(move |field| field.written == written).map(|field| field.name)
}
