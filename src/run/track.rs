//! Sleepers of a running system and what loads them.

use crate::model::grains::{GrainsPart, SleeperPlan};
use crate::model::seat_load::CyclicLoad;
use trackbed_dem as dem;

/// The sleepers of a run, which are its last bodies, and the load on them.
pub struct Track<'a> {
    plan: Option<&'a SleeperPlan>,
    load: Option<&'a CyclicLoad>,
    /// Body of the first sleeper.
    first: usize,
}

/// Place and load of a sleeper at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Sleeper {
    /// Its body.
    pub body: usize,
    /// Downward load [N].
    pub load: f64,
}

impl<'a> Track<'a> {
    /// The track of a system with so many bodies; one without sleepers where there are none.
    pub fn new(grains: Option<&'a GrainsPart>, bodies: usize) -> Track<'a> {
        let plan = grains.and_then(|g| g.sleeper.as_ref());
        let load = grains.and_then(|g| g.load.as_ref());
        let count = plan.map_or(0, |p| p.centres.len());
        Track { plan, load, first: bodies.saturating_sub(count) }
    }

    /// Adds the forces that act on the sleepers at time `t` [s].
    pub fn apply(&self, t: f64, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>) {
        let (Some(load), Some(plan)) = (self.load, self.plan) else { return };
        for k in 0..self.count() {
            let body = self.first + k;
            let share = load.force(t) / plan.seats.len() as f64;
            let (x, q) = (state.position(body), state.orientation(model, body));
            for seat in &plan.seats {
                let point = x + q * dem::Vec3::from(*seat);
                out.push(dem::AppliedForce { body, force: dem::Vec3::new(0.0, 0.0, -share), point });
            }
        }
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.plan.map_or(0, |p| p.centres.len())
    }

    /// The sleepers with their loads at time `t` [s].
    pub fn sleepers(&self, t: f64) -> impl Iterator<Item = Sleeper> + '_ {
        let load = self.load.map_or(0.0, |l| l.force(t));
        (0..self.count()).map(move |k| Sleeper { body: self.first + k, load })
    }

    /// The sleeper whose settlement is followed: the one in the middle.
    pub fn observed(&self, t: f64) -> Option<Sleeper> {
        self.sleepers(t).nth(self.count() / 2)
    }
}
