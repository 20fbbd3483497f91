//! What the tables of fields say.

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
    /// Returns what a scene must have, if not every one writes the field.
    pub fn needs(self) -> Option<Needs> {
        match self {
            Written::Always | Written::ByDefault => None,
            Written::With(needs) | Written::OnRequest(needs) => Some(needs),
        }
    }
}

/// What a field needs of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// No more than its bodies or the solid.
    Nothing,
    /// No periodic borders: initial position; written of slides.
    NoBorders,
    /// Contacts and gravity as the only forces.
    ContactForcesOnly,
    /// Material with a spread of stiffness.
    Spread,
    /// Bonds.
    Bonds,
}

/// Field of bodies or of the solid.
#[derive(Clone, Copy, Debug)]
pub struct FrameField {
    /// Name in files and in `output.fields`.
    pub name: &'static str,
    /// Name in legends.
    pub label: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Condition for writing.
    pub written: Written,
}

pub(super) const fn field(
    name: &'static str,
    label: &'static str,
    unit: &'static str,
    written: Written,
) -> FrameField {
    FrameField { name, label, unit, written }
}
