//! Loads and supports over time.

use super::SolidKind;
use crate::checkpoint_store::Interrupt;
use trackbed_fem::nonlinear::Loading;
use trackbed_input::model::solid::SolidPart;

/// Loads and supports, ramped from zero before time 0.
pub struct SolidLoading<'a> {
    part: &'a SolidPart,
    kind: SolidKind,
    /// Weight [N]. Shape `[3·nodes]`.
    pub gravity: Vec<f64>,
    /// Fraction of weight balanced by initial stress.
    pub carried: f64,
    interrupt: Interrupt,
}

impl<'a> SolidLoading<'a> {
    /// Collects loads and weight.
    pub fn new(part: &'a SolidPart, kind: SolidKind, interrupt: &Interrupt) -> SolidLoading<'a> {
        let (gravity, interrupt) = (part.model.gravity_load(), interrupt.clone());
        SolidLoading { part, kind, gravity, carried: 1.0, interrupt }
    }

    /// Returns loads and weight at a time [N]. Shape `[3·nodes]`.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let mut load = vec![0.0; self.gravity.len()];
        self.add(time, &mut load);
        load
    }

    fn add(&self, time: f64, load: &mut [f64]) {
        // Summation order keeps results bitwise identical.
        if matches!(self.kind, SolidKind::Elastic(_)) {
            load.copy_from_slice(&self.gravity);
            self.part.add_loads(time, load);
            return;
        }
        let (time, share, weight) = self.shares(time);
        self.part.add_loads(time, load);
        let carried = self.part.initial_stress.as_ref().is_some_and(|i| i.loads);
        let share = if carried { 1.0 } else { share };
        for (l, g) in load.iter_mut().zip(&self.gravity) {
            *l = share * *l + weight * g;
        }
    }

    fn shares(&self, time: f64) -> (f64, f64, f64) {
        let share = (1.0 + time).clamp(0.0, 1.0);
        (time.max(0.0), share, self.carried + (1.0 - self.carried) * share)
    }
}

impl Loading for SolidLoading<'_> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        self.add(time, load);
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
