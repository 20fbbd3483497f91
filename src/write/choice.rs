//! Which fields of solid and grains frames hold.

/// Fields that a scene may choose from, of the solid and of the grains.
pub const CHOSEN: [&[&str]; 2] = [
    &["velocity", "stress", "von_mises", "equivalent_plastic_strain", "yield_function"],
    &["velocity", "spin", "orientation", "mean_stress", "force", "coordination", "fragment"],
];

/// Fields of the grains that are written where a scene names them, or where it has what they show: bonds, a slide.
pub const EXTRA: [&str; 5] =
    ["displacement", "initial_position", "acceleration", "broken_bonds", "broken_by_shear"];

/// Fields of the solid that are written where a scene names them.
pub const SOLID_EXTRA: [&str; 2] = ["strain", "plastic_strain"];

/// The fields that are written: all, or those with these names and what every frame needs to be drawn: places, sizes, numbers of
/// bodies, parts and nodes, displacement.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a>(pub Option<&'a [String]>);

impl Choice<'_> {
    /// Whether a field is written.
    pub fn has(self, name: &str) -> bool {
        let free = CHOSEN.iter().any(|names| names.contains(&name));
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
