//! Fields of bodies. A new field needs a row here and an arm of `values` in `run/frames.rs`.

/// Condition for writing a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// Always; required for drawing.
    Always,
    /// Unless the scene selects fields.
    ByDefault,
    /// As `ByDefault`, in scenes with what it needs.
    With(Needs),
    /// If selected, in scenes with what it needs.
    OnRequest(Needs),
}

impl Written {
    /// Returns what a field needs beyond bodies.
    pub fn needs(self) -> Option<Needs> {
        match self {
            Written::Always | Written::ByDefault => None,
            Written::With(needs) | Written::OnRequest(needs) => Some(needs),
        }
    }
}

/// What a field needs of a scene with grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// No more.
    Grains,
    /// No periodic borders: position of the start; written for slides.
    NoBorders,
    /// Contacts and gravity as the only forces.
    ContactForcesOnly,
    /// Material with a spread of stiffness.
    Spread,
    /// Bonds.
    Bonds,
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

use Needs::{Bonds, ContactForcesOnly, NoBorders, Spread};
use Written::{Always, ByDefault, OnRequest, With};

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

/// Returns the fields that need something beyond bodies.
pub fn conditional_body_fields() -> impl Iterator<Item = (&'static BodyField, Needs)> {
    BODY_FIELDS.iter().filter_map(|field| Some((field, field.written.needs()?)))
}
