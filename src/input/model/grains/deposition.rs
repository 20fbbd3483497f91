//! `[deposition]` resolved.

use crate::scene::deposition::Deposition;
use crate::scene::{SceneError, Table};
use trackbed_dem::Model;

/// Default RMS speed of rest [m/s].
pub(super) const SETTLED_SPEED: f64 = 5e-3;

pub(super) const SOFTER: &str = "above 0, at most 1";

/// Deposition before the main stage.
#[derive(Clone, Debug)]
pub struct DepositionPlan {
    /// Longest time [s].
    pub max_time: f64,
    /// RMS speed of rest [m/s].
    pub settled_speed: f64,
    /// Unbalanced to contact force ratio of rest.
    pub unbalanced_ratio: Option<f64>,
    /// Number of layers that are dropped.
    pub layers: u32,
    /// Removal height afterwards [m].
    pub level: Option<f64>,
    pub(super) friction: Option<f64>,
    /// Ratio to the true contact stiffness.
    pub(super) stiffness_factor: f64,
    pub(super) local_damping: f64,
}

impl DepositionPlan {
    /// Whether a bed of this RMS speed [m/s] is at rest.
    pub fn settled(&self, speed: f64, model: &Model, state: &trackbed_dem::State) -> bool {
        use trackbed_dem::measure::{contacts, unbalanced_ratio};
        speed < self.settled_speed
            && self
                .unbalanced_ratio
                .is_none_or(|most| unbalanced_ratio(model, state, &contacts(model, state)) < most)
    }
}

pub(super) fn build(d: &Table<Deposition>) -> Result<DepositionPlan, SceneError> {
    d.check("max_time", d.max_time, |t| t > 0.0, "a time above 0")?;
    d.check("settled_speed", d.settled_speed, |v| v > 0.0, "a speed above 0")?;
    let ratio =
        d.check("unbalanced_ratio", d.unbalanced_ratio, |r| r > 0.0 && r < 1.0, "above 0, below 1")?;
    d.check("layers", d.layers, |n| (1.0..=1000.0).contains(&n), "1 to 1000")?;
    d.check("friction", d.friction, |f| f >= 0.0, "0 or more")?;
    let factor = d.check("stiffness_factor", d.stiffness_factor, |f| f > 0.0 && f <= 1.0, SOFTER)?;
    d.check("local_damping", d.local_damping, |a| (0.0..1.0).contains(&a), "0 or more, below 1")?;
    Ok(DepositionPlan {
        max_time: d.max_time.si,
        // With a force ratio, any speed is accepted.
        settled_speed: match (d.settled_speed, ratio) {
            (Some(speed), _) => speed.si,
            (None, Some(_)) => f64::INFINITY,
            (None, None) => SETTLED_SPEED,
        },
        unbalanced_ratio: ratio,
        layers: d.layers,
        level: d.level.map(|l| l.si),
        friction: d.friction,
        stiffness_factor: factor.unwrap_or(1.0),
        local_damping: d.local_damping,
    })
}
