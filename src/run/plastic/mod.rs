//! A plastic solid that runs alone: in quasi-static steps, or through time.

mod dynamic;
mod quasi_static;

pub use dynamic::PlasticDynamics;
pub use quasi_static::QuasiStaticSystem;

use super::checkpoint_store::Interrupt;
use crate::model::solid::SolidPart;
use trackbed_fem::nonlinear::{Loading, Statistics};

/// Loads and supports of a solid in time; before time 0 they are brought on from nothing.
pub struct Course<'a> {
    /// The solid.
    pub part: &'a SolidPart,
    /// Weight [N]. Shape `[3·nodes]`.
    pub gravity: &'a [f64],
    /// Share of the weight that acts at the beginning of the time before 0: 1 where the initial stress carries it.
    pub carried: f64,
    /// Request to give a step up.
    pub interrupt: &'a Interrupt,
}

impl Course<'_> {
    /// The time at which loads and supports are taken, their share, and that of the weight.
    fn shares(&self, time: f64) -> (f64, f64, f64) {
        let share = (1.0 + time).clamp(0.0, 1.0);
        (time.max(0.0), share, self.carried + (1.0 - self.carried) * share)
    }
}

impl Loading for Course<'_> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        let (time, share, weight) = self.shares(time);
        self.part.add_loads(time, load);
        let carried = self.part.initial_stress.as_ref().is_some_and(|i| i.loads);
        let share = if carried { 1.0 } else { share };
        for (l, g) in load.iter_mut().zip(self.gravity) {
            *l = share * *l + weight * g;
        }
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        let (time, share, _) = self.shares(time);
        self.part.prescribe(time, values);
        values.iter_mut().for_each(|v| *v *= share);
    }

    fn stopped(&self) -> bool {
        self.interrupt.stopped()
    }
}

/// Newton iterations so far, in a few words.
fn iterations(statistics: &Statistics) -> String {
    let repeated = match statistics.halvings {
        0 => String::new(),
        n => format!(", {n} halved"),
    };
    format!("{} iterations{repeated}", statistics.iterations)
}
