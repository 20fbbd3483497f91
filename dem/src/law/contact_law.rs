//! What the loops over contacts, the limit of the step and the measures know of a law.

use super::constants::Constants;
use super::contact::{ContactForce, ContactGeometry, History, LawInput, LawOutput, Linearised, Memory};
use super::material::Pair;
use super::normal::Expected;
use crate::base::Vec3;
use crate::lanes::{Real, V3};

/// A law of contact: constants of one pair of materials, and the force.
pub trait ContactLaw: Constants {
    /// Mixes the constants of two materials.
    fn mix(pair: &Pair<'_>) -> Self;

    /// The same with another coefficient of friction.
    fn with_friction(&self, friction: f64) -> Self;

    /// The forces of the contacts in the lanes `on`, over a step [s]. Advances their memory; what it does to the
    /// other lanes has no meaning. `ROLL`: with rolling and twisting resistance, and with adhesion.
    fn evaluate<R: Real, const ROLL: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut Memory<R>,
        on: R::Mask,
        step: R,
    ) -> LawOutput<R>;

    /// As [`ContactLaw::evaluate`], which all loops inline but those that record: they share one copy.
    #[inline(always)]
    fn acting<R: Real, const ROLL: bool>(
        law: &Self::Lanes<R>,
        touch: &LawInput<R>,
        memory: &mut Memory<R>,
        on: R::Mask,
        step: R,
    ) -> LawOutput<R> {
        if R::RECORDS {
            apart(|| Self::evaluate::<R, ROLL>(law, touch, memory, on, step))
        } else {
            Self::evaluate::<R, ROLL>(law, touch, memory, on, step)
        }
    }

    /// Energy stored in the normal spring, and in the tangential, rolling and twisting springs together [J].
    fn stored(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Force of the normal spring less adhesion [N], and stiffness of the tangential spring [N/m], of a contact with
    /// this memory.
    fn springs(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Largest force of the tangential spring that friction holds with this memory [N], and the spring's stiffness [N/m].
    fn held_by_friction(&self, overlap: f64, radius: f64, history: &History) -> (f64, f64);

    /// Energy that contacts which end leave in their tangential, rolling and twisting springs [J].
    fn stored_in_springs<R: Real, const ROLL: bool>(law: &Self::Lanes<R>, memory: &Memory<R>) -> R;

    /// Force of the normal spring on first loading [N] and its tangent stiffness [N/m], for estimates.
    fn loading(&self, overlap: f64, radius: f64) -> (f64, f64);

    /// Largest normal stiffness [N/m] at an overlap [m], for the time step.
    fn stiffness(&self, overlap: f64, radius: f64) -> f64;

    /// The contact as springs and dashpots about where it is, sticking; `mass` is the effective mass of the bodies [kg].
    fn linearised(&self, mass: f64, radius: f64, overlap: f64, history: &History) -> Linearised;

    /// Tangential over normal stiffness [-], both at one overlap.
    fn tangential_ratio(&self) -> f64;

    /// Damping ratio ζ of the contact [-].
    fn damping_ratio(&self) -> f64;

    /// Share 1 − e² of its energy that a collision takes [-].
    fn loss(&self) -> f64;

    /// Largest overlap expected, over the effective radius [-]; zero where the stiffness does not depend on it.
    fn expected_overlap(&self, expected: &Expected) -> f64;

    /// What the normal law remembers of a contact that is there already and closes at `approach` [m/s].
    fn begun(&self, approach: f64) -> f64;

    /// Whether the contact resists rolling or twisting, or adheres.
    fn rolls(&self) -> bool;

    /// Names of the normal and the tangential law.
    fn names(&self) -> [&'static str; 2];

    /// Sources of the parts in use.
    fn sources(&self) -> Vec<&'static str>;

    /// The force on one contact, given the sum 1/m₁ + 1/m₂ of the inverse masses of the bodies [1/kg], the velocity of a
    /// relative to b at the contact point and the spin of a less that of b, both half a step ago [m/s, rad/s], and
    /// the step [s]. Advances the contact's memory.
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

    /// Ends a contact: forgets it, and returns the energy left in its tangential, rolling and twisting springs [J].
    #[inline(always)]
    fn release(&self, history: &mut History) -> f64 {
        let memory = history.memory();
        *history = History::NONE;
        Self::stored_in_springs::<f64, true>(&self.splat(), &memory)
    }
}

/// A call that is not inlined.
#[cold]
#[inline(never)]
fn apart<T>(call: impl FnOnce() -> T) -> T {
    call()
}
