//! Load frequency against the natural frequencies of the solid on its supports: a mesh on a rigid base resonates where the ground does not.

use super::findings::Finding;
use crate::model::Job;
use trackbed_fem as fem;
use trackbed_fem::modal::{self, Modes};

/// Modes that are searched.
const MODES: usize = 12;
/// Most unknowns of a solid whose modes are searched: a few seconds.
const UNKNOWNS: usize = 150_000;
/// Smallest effective mass of a mode, over the mass of the solid.
const SHARE: f64 = 0.1;
/// Amplification above which a load is near a mode: of one with most of the mass, a frequency within about a fourth of the mode's.
pub const AMPLIFICATION: f64 = 2.0;

/// A vertical mode of the solid and the load frequency nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// Frequency of the load [Hz].
    pub load: f64,
    /// Frequency of the mode [Hz].
    pub mode: f64,
    /// Effective mass of the mode, over the mass of the solid [-].
    pub share: f64,
    /// Deflection of the undamped mode over the static one of all modes under a load spread as the mass is:
    /// share / |1 − (f/fₙ)²| [-].
    pub amplification: f64,
}

impl Resonance {
    /// What was found, and the remedy.
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

/// The mode that the load of the track amplifies most; none without a cyclic load, or where modes cannot be had: a solid without
/// density, with absorbing borders, or too large.
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

/// The finding on a load near a mode of the solid.
pub fn near_mode(job: &Job) -> Option<Finding> {
    let found = resonance(job).filter(|r| r.amplification > AMPLIFICATION)?;
    Some(Finding { serious: false, key: "track.load".into(), found: found.found(), usual: found.expected() })
}
