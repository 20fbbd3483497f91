//! Interface of contact laws.

use super::ContactGeometry;
use super::constants::Constants;
use super::contact::{ContactForce, History, HistoryLanes, LawInput, LawOutput, Linearised};
use super::material::Pair;
use super::normal::Expected;
use crate::base::Vec3;
use crate::lanes::{Real, V3};

/// Contact law: pair constants and force.
pub trait ContactLaw: Constants {
    /// Mixes two materials.
    fn mix(pair: &Pair<'_>) -> Self;

    /// Returns the law with another friction.
    fn with_friction(&self, friction: f64) -> Self;

    /// Returns forces in lanes `on` over a step [s] and advances history (undefined in other lanes). `ROLLING`:
    /// rolling and twisting resistance, adhesion.
    fn evaluate<R: Real, const ROLLING: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut HistoryLanes<R>,
        on: R::Mask,
        step: R,
    ) -> LawOutput<R>;

    /// [`ContactLaw::evaluate`], not inlined in recording loops.
    #[inline(always)]
    fn acting<R: Real, const ROLLING: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut HistoryLanes<R>,
        on: R::Mask,
        step: R,
    ) -> LawOutput<R> {
        if R::RECORDS {
            apart(|| Self::evaluate::<R, ROLLING>(law, touch, memory, on, step))
        } else {
            Self::evaluate::<R, ROLLING>(law, touch, memory, on, step)
        }
    }

    /// Returns the energy of normal, and of all other springs [J].
    fn stored(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Returns normal spring force minus adhesion [N] and tangential stiffness [N/m].
    fn springs(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Returns friction limit [N] and stiffness [N/m] of the tangential spring.
    fn friction_limit(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Returns the energy left in other than normal springs of ending contacts [J].
    fn tangential_energy<R: Real, const ROLLING: bool>(law: &Self::Lanes<R>, memory: &HistoryLanes<R>) -> R;

    /// Returns force [N] and tangent stiffness [N/m] of first loading.
    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64);

    /// Returns the largest normal stiffness [N/m] for the time step.
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// Linearises a sticking contact; effective `mass` [kg].
    fn linearised(&self, mass: f64, radius: f64, overlap: f64, history: &History) -> Linearised;

    /// Returns tangential over normal stiffness [-].
    fn tangential_ratio(&self) -> f64;

    /// Returns damping ratio ζ [-].
    fn damping_ratio(&self) -> f64;

    /// Returns energy loss 1 − e² of a collision [-].
    fn loss(&self) -> f64;

    /// Returns the largest expected overlap over radius [-]; zero for constant stiffness.
    fn expected_overlap(&self, expected: &Expected) -> f64;

    /// Returns the normal law's number for an existing contact closing at `approach` [m/s].
    fn initial_state(&self, approach: f64) -> f64;

    /// Whether it resists rolling or twisting, or adheres.
    fn rolls(&self) -> bool;

    /// Names, normal and tangential.
    fn names(&self) -> [&'static str; 2];

    /// Sources.
    fn sources(&self) -> Vec<&'static str>;

    /// Returns the force on one contact and advances its history. Inverse effective mass [1/kg]; velocity at
    /// the contact point, angular velocity, a minus b, last half step [m/s, rad/s]; step [s].
    #[inline(always)]
    fn evaluate_one(
        &self,
        inverse_mass: f64,
        geometry: &ContactGeometry,
        velocity: &Vec3,
        spin: &Vec3,
        history: &mut History,
        dt: f64,
    ) -> ContactForce {
        let touch = LawInput {
            inverse_mass,
            radius: geometry.radius,
            overlap: geometry.overlap,
            normal: V3::from_vec(&geometry.normal),
            velocity: V3::from_vec(velocity),
            spin: V3::from_vec(spin),
        };
        let mut memory = history.memory();
        let law = self.splat::<f64>();
        let a = if self.rolls() {
            Self::evaluate::<f64, true>(&law, &touch, &mut memory, true, dt)
        } else {
            Self::evaluate::<f64, false>(&law, &touch, &mut memory, true, dt)
        };
        *history = History::of(&memory);
        ContactForce {
            force: a.force.to_vec(),
            normal: a.normal,
            moment: a.moment.to_vec(),
            dashpot: a.dashpot,
            friction: a.friction,
        }
    }

    /// Resets the history; returns the energy left in other than normal springs [J].
    #[inline(always)]
    fn release(&self, history: &mut History) -> f64 {
        let memory = history.memory();
        *history = History::NONE;
        Self::tangential_energy::<f64, true>(&self.splat(), &memory)
    }
}

/// Prevents inlining.
#[cold]
#[inline(never)]
fn apart<T>(call: impl FnOnce() -> T) -> T {
    call()
}
