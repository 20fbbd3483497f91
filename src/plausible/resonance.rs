//! Loads near natural frequencies: a mesh on a rigid base resonates, real ground does not.

use super::findings::Finding;
use crate::model::Job;
use trackbed_fem as fem;
use trackbed_fem::modal::{self, Modes};

const MODES: usize = 12;
/// Modal search takes a few seconds.
const UNKNOWNS: usize = 150_000;
/// Smallest effective over total mass.
const SHARE: f64 = 0.1;
/// Amplification limit: within about a quarter of the dominant frequency.
pub const AMPLIFICATION: f64 = 2.0;

/// Vertical mode with the nearest load frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
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
        format!("track.load: {found}, expected {expected}")
    }

    fn found(&self) -> String {
        format!(
            "{:.3} Hz, near the vertical mode of the solid at {:.3} Hz ({:.0} % of its mass), undamped amplification {:.1}",
            self.load,
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

/// Returns the mode most amplified by the track load; none without cyclic load or modes.
pub fn resonance(job: &Job) -> Option<Resonance> {
    let load = job.grains.as_ref()?.track.load.as_ref()?;
    let model = &job.solid.as_ref()?.model;
    let frequencies = load.frequencies();
    let searched = model.boundaries().is_empty() && model.free_dof_count() <= UNKNOWNS;
    if frequencies.is_empty() || !searched || job.coupling.is_none() {
        return None;
    }
    let modes = modal::solve(model, MODES).ok()?;
    nearest(&frequencies, &modes, model)
}

fn nearest(frequencies: &[f64], modes: &Modes, model: &fem::Model) -> Option<Resonance> {
    let mass = model.total_mass();
    let vertical = modes.frequencies.iter().zip(&modes.effective_mass).map(|(f, m)| (*f, m[2] / mass));
    let pairs = vertical.filter(|(f, share)| *f > 0.0 && *share >= SHARE);
    let pairs = pairs.flat_map(|(mode, share)| frequencies.iter().map(move |&load| (load, mode, share)));
    let found = pairs.map(|(load, mode, share)| Resonance {
        load,
        mode,
        share,
        amplification: share / (1.0 - (load / mode).powi(2)).abs().max(1e-3),
    });
    found.max_by(|a, b| a.amplification.total_cmp(&b.amplification))
}

/// Returns the finding on a near mode.
pub fn near_mode(job: &Job) -> Option<Finding> {
    let found = resonance(job).filter(|r| r.amplification > AMPLIFICATION)?;
    Some(Finding { serious: false, key: "track.load".into(), found: found.found(), usual: found.expected() })
}
