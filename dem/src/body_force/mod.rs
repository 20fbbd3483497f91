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

mod four;
mod water;
mod wind;

pub use water::{DragArea, Measured, Orbit, Water, Wave, WaveError};
pub use wind::Wind;

use crate::base::Vec3;
use crate::base::held::held;
use crate::base::ledger::Ledger;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::sums::Sums;
use crate::bodies::table::Bodies;
use crate::lanes::Simd;
use crate::lanes::record::xyz;
use crate::shape::Shape;
pub(crate) use water::Skin;

/// What a body force sees of the bodies of a block.
pub(crate) struct Seen<'a> {
    pub simd: Simd,
    pub block: &'a Block,
    pub members: &'a Members,
    pub bodies: &'a Bodies,
    /// Surfaces of the shapes, where a body force asks for them.
    pub skins: &'a [Skin],
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Sums of the forces of contacts and bonds.
    pub sums: &'a [Sums],
    /// Time of the places [s].
    pub time: f64,
    /// Length of the kick [s].
    pub kick: f64,
}

/// A body force: adds its forces [N] on the bodies of a block, at their centres, and the torques about them [N m].
pub(crate) trait Act {
    fn act(&self, seen: &Seen<'_>, work: &mut ForceWork);
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
    /// Longest step that resolves what it does to a body [s].
    pub(crate) fn longest(&self, bodies: &Bodies, gravity: &Vec3) -> f64 {
        match self {
            BodyForce::Water(water) => water.longest(bodies, gravity),
            BodyForce::Wind(_) => f64::INFINITY,
        }
    }
}

/// Surfaces of all shapes, where one of the forces asks for them.
pub(crate) fn skins(forces: &[BodyForce], shapes: &[Shape]) -> Vec<Skin> {
    if forces.iter().any(|f| matches!(f, BodyForce::Water(_))) {
        shapes.iter().map(Skin::of).collect()
    } else {
        Vec::new()
    }
}

/// Scratch of a block: empty in models without body forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForceWork {
    /// Radii of spheres of the bodies' volumes [m], in block order.
    radius: Vec<f64>,
    /// Force and torque on each body in the step at hand.
    acting: Vec<Sums>,
    /// Mass of fluid that each body takes along [kg]; empty where none does.
    added: Vec<f64>,
    /// Heights of the points of one body.
    heights: Vec<f64>,
    /// Their power before the kick [W].
    power: f64,
}

impl ForceWork {
    /// Lays itself out for bodies in the order of their block, given the volume of a body [m³] by number.
    pub fn arrange(&mut self, block: &Block, volume: impl Fn(usize) -> f64) {
        let radius = |v: f64| libm::cbrt(v * 0.75 / std::f64::consts::PI);
        self.radius.clear();
        self.radius.extend(block.bodies.iter().map(|&b| radius(volume(b as usize))));
    }

    /// Works out the forces on the bodies of a block and books their impulse; [`ForceWork::add_to`] adds them to the others.
    pub fn act(&mut self, forces: &[BodyForce], seen: Seen<'_>, ledger: &mut Ledger) {
        let (block, sums, kick) = (seen.block, seen.sums, seen.kick);
        self.acting.clear();
        self.acting.resize(block.bodies.len(), Sums::default());
        self.added.clear();
        for force in forces {
            force.act(&seen, self);
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

    /// Adds the forces to all others.
    pub fn add_to(&self, sums: &mut [Sums]) {
        for (sum, own) in sums.iter_mut().zip(&self.acting) {
            sum.push(&xyz(own.force()), &xyz(own.torque()));
        }
    }

    /// Lets a body take a mass of fluid along [kg].
    fn add_mass(&mut self, k: usize, mass: f64) {
        if self.added.is_empty() {
            self.added.resize(self.acting.len(), 0.0);
        }
        self.added[k] += mass;
    }

    /// Books the work of the forces of this step, after the bodies have moved.
    pub fn book(&self, block: &Block, ledger: &mut Ledger, kick: f64) {
        ledger.work_body_forces += 0.5 * (self.power + self.power_on(block)) * kick;
    }

    /// Power with the velocities of the block as they are [W].
    fn power_on(&self, block: &Block) -> f64 {
        let of = |(k, own): (usize, &Sums)| {
            let (v, w): (Vec3, Vec3) = (xyz(&block.velocity[k]), xyz(&block.spin[k]));
            xyz(own.force()).dot(&v) + xyz(own.torque()).dot(&w)
        };
        self.acting.iter().enumerate().map(of).sum()
    }

    /// Bytes held between steps.
    pub fn bytes(&self) -> usize {
        held(&self.radius) + held(&self.acting) + held(&self.added)
    }
}
