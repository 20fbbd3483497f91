//! Selection of frame fields.

use super::body_fields::{Written, body_fields};

/// Default fields of the solid.
pub const SOLID_FIELDS: [&str; 5] =
    ["velocity", "stress", "von_mises", "equivalent_plastic_strain", "yield_function"];

/// Optional fields of the solid.
pub const SOLID_EXTRA: [&str; 2] = ["strain", "plastic_strain"];

/// Written fields: all, or the named ones and those required for drawing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a>(pub Option<&'a [String]>);

impl Choice<'_> {
    /// Whether a field is written.
    pub fn has(self, name: &str) -> bool {
        let free = SOLID_FIELDS.contains(&name) || body_fields(Written::ByDefault).any(|field| field == name);
        !free || self.0.is_none_or(|names| names.iter().any(|n| n == name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_needed_is_always_there() {
        let names = ["stress".to_string()];
        let some = Choice(Some(&names));
        assert!(
            some.has("stress") && !some.has("velocity") && some.has("displacement") && some.has("radius")
        );
        assert!(Choice::default().has("velocity") && !Choice(Some(&[])).has("stress"));
    }
}
