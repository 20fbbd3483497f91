//! Body forces: forces without a contact partner.
//!
//! Added mass mₐ reacts to all other forces F with −mₐ F/(m + mₐ), stable for any mₐ.

mod disk;
mod four;
mod skin;
mod soil;
mod water;
mod wind;
#[doc(hidden)]
mod work;

pub use water::{DragArea, Measured, Orbit, Water, Wave, WaveError};
pub use wind::Wind;

use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::bodies::sums::ForceTorque;
use crate::bodies::table::Bodies;
use crate::lanes::vec4::xyz;
use crate::shape::Shape;
pub use skin::{Skin, Wet};
pub use work::{BodyForceModel, ForceInput, ForceWork};

impl BodyForce {
    /// Returns the water.
    pub fn water(&self) -> Option<&Water> {
        match self {
            BodyForce::Water(water) => Some(water),
            BodyForce::Wind(_) => None,
        }
    }

    #[doc(hidden)]
    pub fn wave(&self) -> Option<&Wave> {
        self.water()?.wave.as_ref()
    }
}

macro_rules! body_forces {
    ($($name:ident = $source:expr),+ $(,)?) => {
        /// Body force.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum BodyForce {
            $(
                #[doc = concat!("See [`", stringify!($name), "`].")]
                $name($name)
            ),+
        }

        impl BodyForce {
            fn act(&self, seen: &ForceInput<'_>, work: &mut ForceWork) {
                match self { $(BodyForce::$name(force) => force.act(seen, work)),+ }
            }

            /// Source of the model.
            pub fn source(&self) -> &'static str {
                match self { $(BodyForce::$name(_) => $source),+ }
            }

            /// Quantity out of range, with value and requirement.
            pub fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
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
    /// Shortest time constant [s].
    fn time_constant(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        match self {
            BodyForce::Water(water) => water.time_constant(bodies, gravity),
            BodyForce::Wind(wind) => wind.time_constant(bodies, gravity),
        }
    }
}

/// Of all forces [s].
pub fn time_constant(forces: &[BodyForce], bodies: &Bodies, gravity: &Vec3) -> f64 {
    forces.iter().map(|f| f.time_constant(bodies, gravity)).fold(f64::INFINITY, f64::min)
}

/// Largest time step over time constant: velocity error 1 %.
pub const RESOLVED: f64 = 0.02;

/// Empty unless water or scarring needs surfaces.
pub fn skins(forces: &[BodyForce], scarred: bool, shapes: &[Shape]) -> Vec<Skin> {
    if scarred || forces.iter().any(|f| matches!(f, BodyForce::Water(_))) {
        shapes.iter().map(Skin::of).collect()
    } else {
        Vec::new()
    }
}

impl ForceWork {
    /// Computes forces and records their impulse; [`ForceWork::add_to`] adds them.
    pub fn act(&mut self, forces: &[BodyForce], seen: ForceInput<'_>, balance: &mut BalanceTerms) {
        let (block, sums, kick) = (seen.block, seen.sums, seen.kick);
        self.acting.clear();
        self.acting.resize(block.bodies.len(), ForceTorque::default());
        self.added.clear();
        for force in forces {
            force.act(&seen, self);
        }
        if !seen.scars.is_empty() {
            soil::act(&seen, self);
        }
        for (k, added) in self.added.iter().enumerate().filter(|(_, added)| **added > 0.0) {
            let mass = seen.bodies.mass(block.bodies[k] as usize);
            let all = xyz(sums[k].force()) + xyz(self.acting[k].force()) + seen.gravity * mass;
            self.acting[k].push(&(all * (-added / (mass + added))), &Vec3::zeros());
        }
        for (own, centre) in self.acting.iter().zip(&block.centre) {
            let (force, torque) = (xyz(own.force()), xyz(own.torque()));
            balance.body_forces.add(&xyz(centre), &(force * kick));
            balance.body_forces.angular += torque * kick;
        }
        self.power = self.power_on(block);
    }
}
