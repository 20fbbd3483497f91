//! Loads near natural frequencies.

use super::findings::Finding;
use crate::model::Job;
use crate::model::solid::{Analysis, SolidPart};
use trackbed_fem::modal::{self, Modes};

const MODES: usize = 12;
/// Modal search takes a few seconds.
const UNKNOWNS: usize = 150_000;
/// Smallest effective over total mass.
const SHARE: f64 = 0.1;
/// Amplification limit: within about a quarter of the dominant frequency.
pub const AMPLIFICATION: f64 = 2.0;

/// Fewest cycles that excite a mode.
const CYCLES: f64 = 3.0;

/// Harmonic load or motion.
#[derive(Clone, Debug, PartialEq)]
struct Excitation {
    key: String,
    /// Frequency [Hz].
    frequency: f64,
    /// Main axis.
    axis: usize,
}

/// Mode with the nearest load frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Resonance {
    /// Key of the load or motion.
    pub key: String,
    /// Main axis of load and mode.
    pub axis: usize,
    /// Load frequency [Hz].
    pub load: f64,
    /// Natural frequency [Hz].
    pub mode: f64,
    /// Effective over total mass [-].
    pub share: f64,
    /// Undamped modal over static deflection, load distributed like mass: share / |1 − (f/fₙ)²| [-].
    pub amplification: f64,
}

impl Resonance {
    /// Formats finding and remedy.
    pub fn message(&self) -> String {
        let (found, expected) = (self.found(), self.expected());
        format!("{}: {found}, expected {expected}", self.key)
    }

    fn found(&self) -> String {
        format!(
            "{:.3} Hz, near the {} mode of the solid at {:.3} Hz ({:.0} % of its mass), undamped amplification {:.1}",
            self.load,
            ["x", "y", "vertical"][self.axis],
            self.mode,
            100.0 * self.share,
            self.amplification
        )
    }

    fn expected(&self) -> String {
        format!(
            "below {:.3} Hz: load slower, deepen the mesh, or set [[solid.absorbing]]",
            self.mode * (1.0 - self.share / AMPLIFICATION).max(0.0).sqrt()
        )
    }
}

/// Returns the mode most amplified by harmonic loads and support motions; none without them or modes.
pub fn resonance(job: &Job) -> Option<Resonance> {
    let solid = job.solid.as_ref()?;
    let model = &solid.model;
    let moves = job.coupling.is_some() || matches!(solid.analysis, Analysis::Dynamic(_));
    let searched = model.boundaries().is_empty() && model.free_dof_count() <= UNKNOWNS;
    if !moves || !searched {
        return None;
    }
    let mut excitations = of_solid(solid, job.end);
    if let Some(load) = job.grains.as_ref().and_then(|g| g.track.load.as_ref()) {
        let of_track = |frequency| Excitation { key: "track.load".into(), frequency, axis: 2 };
        excitations.extend(load.frequencies().into_iter().map(of_track));
    }
    if excitations.is_empty() {
        return None;
    }
    near(&excitations, &modal::solve(model, MODES).ok()?, model.total_mass())
}

/// Loads and moving supports.
fn of_solid(solid: &SolidPart, end: f64) -> Vec<Excitation> {
    let loads = solid.loads.iter().enumerate().filter_map(|(k, load)| {
        let frequency = load.function.frequency(CYCLES, end)?;
        let mut force = [0.0; 3];
        load.forces.iter().for_each(|(_, f)| (0..3).for_each(|d| force[d] += f[d]));
        let axis = (0..3).max_by(|&a, &b| force[a].abs().total_cmp(&force[b].abs()))?;
        Some(Excitation { key: format!("solid.load.{k}"), frequency, axis })
    });
    let fixed = solid.model.supports().fixed();
    let motions = solid.supports.moving.iter().filter_map(|(position, _, function)| {
        let frequency = function.frequency(CYCLES, end)?;
        let axis = fixed[*position].0 as usize % 3;
        Some(Excitation { key: "solid.support".into(), frequency, axis })
    });
    // One for all nodes of a support.
    let mut all: Vec<Excitation> = loads.collect();
    for motion in motions {
        if !all.contains(&motion) {
            all.push(motion);
        }
    }
    all
}

fn near(excitations: &[Excitation], modes: &Modes, mass: f64) -> Option<Resonance> {
    let modes = modes.frequencies.iter().zip(&modes.effective_mass).filter(|(f, _)| **f > 0.0);
    let pairs = modes.flat_map(|(mode, masses)| excitations.iter().map(move |e| (e, *mode, masses)));
    let found = pairs.filter_map(|(Excitation { key, frequency, axis }, mode, masses)| {
        let share = masses[*axis] / mass;
        (share >= SHARE).then(|| Resonance {
            key: key.clone(),
            axis: *axis,
            load: *frequency,
            mode,
            share,
            amplification: share / (1.0 - (frequency / mode).powi(2)).abs().max(1e-3),
        })
    });
    found.max_by(|a, b| a.amplification.total_cmp(&b.amplification))
}

/// Returns the finding on a near mode.
pub fn near_mode(job: &Job) -> Option<Finding> {
    let found = resonance(job).filter(|r| r.amplification > AMPLIFICATION)?;
    let (text, usual) = (found.found(), found.expected());
    Some(Finding { serious: false, key: found.key, found: text, usual })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axis_and_frequency_decide() {
        let modes = Modes {
            frequencies: vec![3.0, 7.9],
            effective_mass: vec![[0.6, 0.6, 0.0], [0.0, 0.0, 0.8]],
            ..Modes::default()
        };
        let at = |frequency: f64, axis: usize| Excitation { key: "solid.load.0".into(), frequency, axis };
        let amplified =
            |e: &[Excitation]| near(e, &modes, 1.0).map(|r| (r.mode, r.amplification > AMPLIFICATION));
        assert_eq!(amplified(&[at(7.9, 2)]), Some((7.9, true)));
        assert_eq!(amplified(&[at(3.0, 2)]), Some((7.9, false)));
        assert_eq!(amplified(&[at(3.0, 2), at(3.0, 0)]), Some((3.0, true)));
        assert_eq!(amplified(&[]), None);
    }
}
