//! Check of loads and motions against their targets: servo walls, driven walls, sleepers.

use super::{Check, Limits};
use crate::system::GrainsView;
use serde::Serialize;
use trackbed_dem::{AppliedLoad, LoadRange, Vec3};
use trackbed_input::model::grains::GrainsPart;
use trackbed_track::Track;

/// Error over the amplitude of the target.
const ERROR: Limits = Limits { warn: 0.02, fail: Some(0.1) };

/// Load or motion compared with its target.
#[derive(Clone, Debug, Serialize)]
pub struct LoadCheck {
    /// Wall or sleeper.
    pub name: String,
    /// Quantity and unit.
    pub quantity: &'static str,
    /// Comparison.
    #[serde(flatten)]
    pub load: AppliedLoad,
}

/// Compares the loads of a run over `end` [s].
pub fn applied_loads(part: &GrainsPart, view: GrainsView<'_>, track: &Track<'_>, end: f64) -> Vec<LoadCheck> {
    let walls = part.walls.others.iter().zip(&part.walls.names).enumerate();
    let servo = walls.clone().filter_map(|(k, (_, name))| {
        let load = view.state.wall_load(k)?;
        Some(LoadCheck { name: format!("wall {name}"), quantity: "force [N]", load })
    });
    let driven = walls.filter_map(|(k, (wall, name))| {
        // Oscillations set the displacement.
        let target = wall.motion.oscillation.is_none().then_some(wall.motion.velocity * end)?;
        let load = travel(target, view.state.wall_travel(k) - target)?;
        Some(LoadCheck { name: format!("wall {name}"), quantity: "travel [m]", load })
    });
    let sleeper = track.applied_load().map(|(k, load)| LoadCheck {
        name: format!("sleeper {}", k + 1),
        quantity: "load [N]",
        load,
    });
    servo.chain(driven).chain(sleeper).collect()
}

/// Travel against a prescribed one; none without.
fn travel(target: Vec3, missing: Vec3) -> Option<AppliedLoad> {
    let length = target.norm();
    let range = |x: f64| LoadRange { min: 0.0_f64.min(x), mean: 0.5 * x, max: 0.0_f64.max(x) };
    (length > 0.0).then(|| AppliedLoad {
        target: range(length),
        applied: range(length + missing.dot(&target) / length),
        amplitude_ratio: None,
        phase: None,
        error: missing.norm() / length,
    })
}

/// Checks the largest error; none without loads.
pub fn load_error(loads: &[LoadCheck]) -> Option<Check> {
    let worst = loads.iter().max_by(|a, b| a.load.error.total_cmp(&b.load.error))?;
    Some(Check::new("error of an applied load over its amplitude", worst.load.error, ERROR, || {
        let LoadCheck { name, quantity, load } = worst;
        let phase = load.phase.map_or(String::new(), |phase| format!(", phase {phase:.1} degrees"));
        format!(
            "{name}: {quantity} found {}, expected {}{phase}. Raise gain or max_speed of a servo, lower the frequency, or give its contacts restitution = 1.",
            shown(&load.applied),
            shown(&load.target),
        )
    }))
}

fn shown(range: &LoadRange) -> String {
    format!("{:.4e} to {:.4e} (mean {:.4e})", range.min, range.max, range.mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    #[test]
    fn travel_is_compared_along_its_direction() {
        assert!(travel(Vec3::zeros(), Vec3::x()).is_none());
        let load = travel(Vec3::new(0.0, 0.0, -0.2), Vec3::new(0.0, 0.0, 0.03)).unwrap();
        assert!((load.error - 0.15).abs() < 1e-12 && (load.applied.max - 0.17).abs() < 1e-12, "{load:?}");
    }

    #[test]
    fn worst_load_is_judged() {
        let load = |name: &str, missing: f64| LoadCheck {
            name: name.into(),
            quantity: "travel [m]",
            load: travel(Vec3::x(), Vec3::x() * missing).unwrap(),
        };
        let status = |all: &[LoadCheck]| load_error(all).map(|c| c.status);
        assert_eq!(status(&[]), None);
        assert_eq!(status(&[load("a", 0.01), load("b", -0.015)]), Some(Outcome::Passed));
        assert_eq!(status(&[load("a", 0.01), load("b", -0.05)]), Some(Outcome::Warned));
        assert_eq!(status(&[load("a", 0.2), load("b", -0.05)]), Some(Outcome::Failed));
        let message = load_error(&[load("a", 0.01), load("b", -0.05)]).unwrap().message;
        assert!(message.starts_with("b: travel [m] found 0.0000e0 to 9.5000e-1"), "{message}");
    }
}
