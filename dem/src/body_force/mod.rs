//! Body forces: what acts on bodies without a partner. A stage of the step between contacts and motion, which works on four
//! bodies at a time where it can, and leaves their motion as it is; a model without body forces has no such stage. (Gravity and
//! local damping belong to the motion itself: one is the same acceleration for all, the other needs the sum of all forces.)
//!
//! A body force is one file with an `Act` and one line in `body_forces!`.
//!
//! A fluid that a body has to push aside adds to the body's inertia. Its reaction −mₐ a depends on the acceleration that it
//! takes part in, and is worked out from all other forces F: −mₐ F/(m + mₐ), stable whatever mₐ is.
//!
//! Velocities are those of half a step ago, so a force that takes them as they are is right to first order in the share of the
//! velocity that it takes in a step. Its work is booked exactly for translation, and with the spins before and after the step
//! for rotation.

mod disk;
mod four;
mod skin;
mod soil;
mod water;
mod wind;
mod work;

pub use water::{DragArea, Measured, Orbit, Water, Wave, WaveError};
pub use wind::Wind;

use crate::base::Vec3;
use crate::base::ledger::Ledger;
use crate::bodies::sums::Sums;
use crate::bodies::table::Bodies;
use crate::lanes::record::xyz;
use crate::shape::Shape;
pub(crate) use skin::Skin;
pub(crate) use work::{Act, ForceWork, Seen};

impl BodyForce {
    /// Waves that it depends on.
    pub(crate) fn wave(&self) -> Option<&Wave> {
        match self {
            BodyForce::Water(water) => water.wave.as_ref(),
            BodyForce::Wind(_) => None,
        }
    }
}

/// Writes the list of all body forces.
macro_rules! body_forces {
    ($($name:ident = $source:expr),+ $(,)?) => {
        /// A body force.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum BodyForce {
            $(
                #[doc = concat!("See [`", stringify!($name), "`].")]
                $name($name)
            ),+
        }

        impl BodyForce {
            fn act(&self, seen: &Seen<'_>, work: &mut ForceWork) {
                match self { $(BodyForce::$name(force) => force.act(seen, work)),+ }
            }

            /// Where it is published.
            pub fn source(&self) -> &'static str {
                match self { $(BodyForce::$name(_) => $source),+ }
            }

            /// What of it is out of range: quantity, value and requirement.
            pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
                match self { $(BodyForce::$name(force) => force.fault()),+ }
            }
        }
    };
}

body_forces! {
    Water = water::SOURCE,
    Wind = wind::SOURCE,
}

impl BodyForce {
    /// Shortest time in which it changes the motion of a body [s].
    fn time_constant(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        match self {
            BodyForce::Water(water) => water.time_constant(bodies, gravity),
            BodyForce::Wind(wind) => wind.time_constant(bodies, gravity),
        }
    }
}

/// Shortest time in which any of the forces changes the motion of a body [s].
pub(crate) fn time_constant(forces: &[BodyForce], bodies: &Bodies, gravity: &Vec3) -> f64 {
    forces.iter().map(|f| f.time_constant(bodies, gravity)).fold(f64::INFINITY, f64::min)
}

/// Longest step over that time: velocities then err by 1 %. Beyond the time itself explicit steps grow.
pub(crate) const RESOLVED: f64 = 0.02;

/// Surfaces of all shapes, where one of the forces asks for them, or ground that is scarred.
pub(crate) fn skins(forces: &[BodyForce], scarred: bool, shapes: &[Shape]) -> Vec<Skin> {
    if scarred || forces.iter().any(|f| matches!(f, BodyForce::Water(_))) {
        shapes.iter().map(Skin::of).collect()
    } else {
        Vec::new()
    }
}

impl ForceWork {
    /// Works out the forces on the bodies of a block and books their impulse; [`ForceWork::add_to`] adds them to the others.
    pub fn act(&mut self, forces: &[BodyForce], seen: Seen<'_>, ledger: &mut Ledger) {
        let (block, sums, kick) = (seen.block, seen.sums, seen.kick);
        self.acting.clear();
        self.acting.resize(block.bodies.len(), Sums::default());
        self.added.clear();
        for force in forces {
            force.act(&seen, self);
        }
        if !seen.scars.is_empty() {
            soil::act(&seen, self);
        }
        for (k, added) in self.added.iter().enumerate().filter(|(_, added)| **added > 0.0) {
            let mass = seen.bodies.get(block.bodies[k] as usize).mass;
            let all = xyz(sums[k].force()) + xyz(self.acting[k].force()) + seen.gravity * mass;
            self.acting[k].push(&(all * (-added / (mass + added))), &Vec3::zeros());
        }
        for (own, centre) in self.acting.iter().zip(&block.centre) {
            let (force, torque) = (xyz(own.force()), xyz(own.torque()));
            ledger.body_forces.add(&xyz(centre), &(force * kick));
            ledger.body_forces.angular += torque * kick;
        }
        self.power = self.power_on(block);
    }
}
