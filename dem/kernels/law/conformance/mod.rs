//! Conformance tests of contact laws; `conforms!` registers a type and a material.

mod energy;
mod force;
mod lanes;
mod own;

use super::composed::Composed;
use super::formula::{MEMORY, MODULUS, STIFFNESS};
use super::formula_law::FormulaLaw;
use super::material::{Material, Pair};
use super::mindlin::Mindlin;
use super::spring::Spring;
use super::table::{ConicalLaw, HertzLaw, LinearLaw, RoughLaw};
use super::walton_braun::WaltonBraun;
use super::{ContactForce, ContactGeometry, ContactLaw, History};
use crate::base::Vec3;

/// Overlaps of a few hundredths of the radius.
const GLASS: Material =
    Material { young: Some(6e7), poisson: 0.25, stiffness: f64::INFINITY, friction: 0.4, ..SOFT };

/// Effective radius [m] and mass [kg].
const RADIUS: f64 = 0.005;
const SOFT: Material = Material::SOFT;
const MASS: f64 = 0.1;

macro_rules! conforms {
    ($($name:ident: $law:ty, $material:expr;)+) => {$(
        mod $name {
            use super::*;

            #[test]
            fn no_force_at_zero_overlap() {
                force::no_force_at_zero_overlap::<$law>(&$material);
            }

            #[test]
            fn restitution_at_any_speed() {
                force::restitution_at_any_speed::<$law>(&$material);
            }

            #[test]
            fn partners_are_alike() {
                force::partners_are_alike::<$law>(&$material);
            }

            #[test]
            fn rotation_of_everything_rotates_the_force() {
                force::rotation_of_everything_rotates_the_force::<$law>(&$material);
            }

            #[test]
            fn friction_below_its_limit() {
                force::friction_below_its_limit::<$law>(&$material);
            }

            #[test]
            fn stiffness_equals_force_gradient() {
                force::stiffness_equals_force_gradient::<$law>(&$material);
            }

            #[test]
            fn a_closed_path_dissipates_its_work() {
                energy::a_closed_path_dissipates_its_work::<$law>(&$material);
            }

            #[test]
            fn path_work_is_stored_or_dissipated() {
                energy::path_work_is_stored_or_dissipated::<$law>(&$material);
            }

            #[test]
            fn memory_survives_a_checkpoint() {
                force::memory_survives_a_checkpoint::<$law>(&$material);
            }

            #[test]
            fn lanes_match_scalar_contacts_bitwise() {
                lanes::lanes_match_scalar_contacts_bitwise::<$law>(&$material);
            }
        }
    )+};
}

conforms! {
    linear: LinearLaw, SOFT;
    rough: RoughLaw, Material { friction: 0.2, asperity_friction: 0.4, asperity_pressure: 2e5, ..SOFT };
    hertz: HertzLaw, GLASS;
    walton_braun: Composed<WaltonBraun, Spring>, SOFT;
    conical_whole: ConicalLaw, Material { corner_strength: 4e7, corner_angle: 0.2, ..GLASS };
}

conforms! {
    own_hertz: Composed<FormulaLaw<MODULUS>, Mindlin>, own::hertz();
    own_linear: Composed<FormulaLaw<STIFFNESS>, Spring>, own::linear();
    own_memory: Composed<FormulaLaw<MEMORY>, Spring>, own::memory();
}

const CRUSHING: Material = Material {
    corner_strength: 6.5e5,
    corner_angle: 1.4,
    asperity_friction: 0.5,
    asperity_pressure: 2e5,
    ..GLASS
};

conforms! {
    conical: ConicalLaw, CRUSHING;
}

fn law<L: ContactLaw>(material: &Material) -> L {
    let m = Material {
        tangential_damping_ratio: 0.3,
        rolling_friction: 0.1,
        twisting_friction: 0.05,
        ..*material
    };
    L::mix(&Pair { a: &m, b: &m, exception: None })
}

fn plain<L: ContactLaw>(material: &Material, restitution: f64) -> L {
    let m = Material { restitution, ..*material };
    L::mix(&Pair { a: &m, b: &m, exception: None })
}

#[derive(Clone, Copy)]
struct Path {
    steps: usize,
    /// Largest overlap [m].
    depth: f64,
    /// Rate [1/s].
    step_size: f64,
}

struct Moment {
    geometry: ContactGeometry,
    /// Last half step.
    velocity: Vec3,
    spin: Vec3,
    /// Coming half step.
    next: (Vec3, Vec3),
}

impl Path {
    const USUAL: Path = Path { steps: 4000, depth: 2e-4, step_size: 50.0 };

    fn dt(&self) -> f64 {
        1.0 / (self.step_size * self.steps as f64)
    }

    fn overlap(&self, k: f64) -> f64 {
        let part = std::f64::consts::PI * k / self.steps as f64;
        self.depth * part.sin() * (1.0 - 0.6 * (3.0 * part).cos()).max(0.0)
    }

    fn motion(&self, k: f64) -> (Vec3, Vec3) {
        let part = std::f64::consts::TAU * k / self.steps as f64;
        let approach = (self.overlap(k + 0.5) - self.overlap(k - 0.5)) / self.dt();
        let slip = self.depth * self.step_size;
        let velocity = Vec3::new(2.0 * slip * part.sin(), slip * (2.0 * part).cos(), -approach);
        let spin = Vec3::new((3.0 * part).cos(), (2.0 * part).sin(), part.cos()) * (slip / RADIUS);
        (velocity, spin)
    }

    fn moments(self) -> impl Iterator<Item = Moment> {
        (1..self.steps).map(move |k| {
            let (velocity, spin) = self.motion(k as f64 - 0.5);
            let geometry = ContactGeometry {
                point: Vec3::zeros(),
                normal: Vec3::z(),
                overlap: self.overlap(k as f64),
                radius: RADIUS,
            };
            Moment { geometry, velocity, spin, next: self.motion(k as f64 + 0.5) }
        })
    }
}

impl Moment {
    fn evaluate<L: ContactLaw>(&self, law: &L, history: &mut History, dt: f64) -> ContactForce {
        law.evaluate_one(1.0 / MASS, &self.geometry, &self.velocity, &self.spin, history, dt)
    }
}
