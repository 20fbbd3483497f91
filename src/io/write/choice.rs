//! Selection of frame fields.

use super::body_fields::BODY_FIELDS;
use super::fields::Written;
use super::solid_fields::SOLID_FIELDS;

/// Written fields: all, or the named ones and those required for drawing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a>(pub Option<&'a [String]>);

impl Choice<'_> {
    /// Whether a field is written.
    pub fn has(self, name: &str) -> bool {
        let mut fields = SOLID_FIELDS.iter().chain(&BODY_FIELDS);
        let free = fields.any(|field| field.name == name && field.written == Written::ByDefault);
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
