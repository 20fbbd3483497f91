//! Check of mass scaling (`time.mass_factor`), valid if quasi-static.

use super::{Check, Limits};
use trackbed_track::GrainsView;

/// Kinetic energy over the smaller of reference energy and weight times grain radius.
const INERTIA: Limits = Limits { warn: 0.05, fail: Some(0.25) };

/// Weight and size of the grains.
#[derive(Clone, Copy, Debug)]
pub struct Fall {
    /// True weight of all grains [N].
    pub weight: f64,
    /// Mean grain radius [m].
    pub radius: f64,
}

impl Fall {
    /// Evaluates a running system with reduced gravity.
    pub fn of(view: GrainsView<'_>) -> Fall {
        let (model, count) = (view.model, view.model.body_count());
        let mass: f64 = (0..count).map(|b| model.mass(b)).sum();
        let radius = (0..count).map(|b| model.radius(b)).sum::<f64>() / count.max(1) as f64;
        Fall { weight: mass * model.gravity().norm(), radius }
    }
}

/// Checks the largest kinetic energy [J] with masses scaled by `factor` against the reference energy [J].
pub fn scaled_inertia(factor: f64, kinetic: f64, reference: f64, fall: Fall) -> Check {
    let share = |whole: f64| match kinetic {
        0.0 => 0.0,
        _ if whole > 0.0 => kinetic / whole,
        _ => f64::INFINITY,
    };
    let by_energy = share(reference);
    let by_fall = if fall.weight > 0.0 { share(fall.weight * fall.radius) } else { f64::INFINITY };
    let value = by_energy.min(by_fall);
    Check::new("kinetic energy of grains with scaled masses", value, INERTIA, || {
        format!(
            "time.mass_factor: {factor} with a kinetic energy of {kinetic:.3e} J, {:.0} % of the reference energy. Mass scaling is valid for quasi-static loading only. Remove time.mass_factor.",
            100.0 * by_energy.min(1.0)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    const FALL: Fall = Fall { weight: 0.109, radius: 0.01 };

    /// Free fall: all work is kinetic. Slow motion and vibration at rest pass.
    #[test]
    fn falling_and_pressing_differ() {
        let status = |kinetic: f64, reference: f64| scaled_inertia(100.0, kinetic, reference, FALL).status;
        assert_eq!(status(4.8e-4, 4.8e-4), Outcome::Failed);
        assert_eq!(status(4.8e-4, 6e-3), Outcome::Warned);
        assert_eq!(status(4.8e-4, 1.0), Outcome::Passed);
        assert_eq!(status(1e-7, 1e-7), Outcome::Passed);
        assert_eq!(status(0.0, 0.0), Outcome::Passed);
    }

    /// Without gravity only the reference energy counts.
    #[test]
    fn without_weight_energy_decides() {
        let flying =
            |reference: f64| scaled_inertia(8.0, 1.0, reference, Fall { weight: 0.0, radius: 0.01 }).status;
        assert_eq!([flying(1.0), flying(100.0)], [Outcome::Failed, Outcome::Passed]);
    }
}
