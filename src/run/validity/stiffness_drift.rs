//! Check for cyclic softening.

use super::{Check, Limits};

/// Second to last cycle, over the second.
const LOSS: Limits = Limits { warn: 0.25, fail: None };

/// Checks cyclic secant stiffnesses [N/m]; none for fewer than three.
pub fn stiffness_drift(secants: &[f64]) -> Option<Check> {
    // The first cycle seats the sleeper.
    let (&second, &last) = (secants.get(1)?, secants.get(2..)?.last()?);
    if second <= 0.0 {
        return None;
    }
    let value = 1.0 - last / second;
    Some(Check::new("loss of secant stiffness since the second cycle", value.max(0.0), LOSS, || {
        format!(
            "secant stiffness: {:.4} MN/m in cycle 2, {:.4} MN/m in the last cycle. The load may be near a natural frequency of the solid (`trackbed modal`), or the bed fails. Load slower, deepen the mesh, use [[solid.absorbing]], or reduce the load.",
            1e-6 * second,
            1e-6 * last
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    #[test]
    fn warns_about_softening_only() {
        let status = |k: &[f64]| stiffness_drift(k).map(|c| c.status);
        assert_eq!(status(&[77e6, 39.5e6, 31e6, 28e6, 28.6e6]), Some(Outcome::Warned));
        assert_eq!(status(&[77e6, 39.5e6, 39e6, 36e6]), Some(Outcome::Passed));
        assert_eq!(status(&[20e6, 30e6, 40e6]), Some(Outcome::Passed));
        assert_eq!(status(&[77e6, 39.5e6]), None);
        assert_eq!(status(&[0.0, 0.0, 0.0]), None);
    }
}
