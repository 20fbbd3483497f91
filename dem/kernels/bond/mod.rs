//! Bonds between bodies, carrying force and moment until failure.
//!
//! Types: [`Bond`]. A [`BondInput`] resolves to sixteen constants of one kernel (`kernel.rs`):
//!
//! * tension from total length, kₙ (L − L₀), without drift;
//! * shear, bending, twisting by increments in a frame rotating with the line of centres and the mean angular
//!   velocity about it (Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004).
//!
//! Limits: all but face bonds join single spheres; small rotations between bonded spheres (linear springs).

mod contact_point;
#[doc(hidden)]
pub mod debonded;
mod direct;
mod face;
#[doc(hidden)]
pub mod kernel;
mod kind;
mod limit;
mod loops;
mod pairs;
mod parallel;
#[doc(hidden)]
pub mod pass;
#[doc(hidden)]
pub mod slot;
mod springs;
#[doc(hidden)]
pub mod store;
mod strength;

pub use contact_point::ContactPoint;
pub use direct::DirectBond;
pub use face::{Face, FaceBond};
pub use kind::Bond;
pub use pairs::within_gap;
pub use parallel::{ParallelBond, ParallelStiffness, ShearStrength};
pub use springs::{BondDamping, Criterion};
pub use strength::{Spread, factors};

pub use limit::stiffest;
pub use store::{BondList, BondState, BondedPairs};

use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::bodies::input::BodyInput;
use crate::bodies::table::{Bodies, Body, BodyKind};
use serde::{Deserialize, Serialize};
use springs::Joint;

/// Bond between single spheres, or between bodies of any shape by a face; unstrained in the initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondInput {
    /// First body.
    pub a: usize,
    /// Second body.
    pub b: usize,
    /// Index into `ModelInput::bond_kinds`.
    pub kind: usize,
    /// Tensile strength factor [-].
    pub tension: f64,
    /// Shear strength factor [-].
    pub shear: f64,
    /// Stiffness factor [-].
    pub stiffness: f64,
    /// Face, of a [`FaceBond`].
    pub face: Option<Face>,
    /// Length without tension, above 0 [m]; by default the initial distance of the centres.
    pub length: Option<f64>,
}

impl BondInput {
    /// Bond with unit factors.
    pub fn new(a: usize, b: usize, kind: usize) -> BondInput {
        BondInput { a, b, kind, tension: 1.0, shear: 1.0, stiffness: 1.0, face: None, length: None }
    }
}

/// Failure mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BreakMode {
    /// Tension and bending.
    Tension,
    /// Shear and twisting.
    Shear,
}

/// Bond breakage, an acoustic event.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Break {
    /// Time [s].
    pub time: f64,
    /// Bond index.
    pub bond: u32,
    /// Bonded bodies.
    pub bodies: [u32; 2],
    /// Midpoint [m].
    pub place: Vec3,
    /// Failure mode.
    pub mode: BreakMode,
    /// Released elastic energy, minus the part stored by the contact [J].
    pub energy: f64,
}

#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    pub ends: [u32; 2],
    /// Order of [`kernel`].
    pub values: [f64; kernel::COUNT],
    /// The pair's contact acts in parallel.
    pub contact: bool,
}

/// Checks and resolves bonds.
pub fn resolve(
    kinds: &[Bond],
    bonds: &[BondInput],
    places: &[BodyInput],
    bodies: &Bodies,
) -> Result<Vec<Constants>, ModelError> {
    for (kind, bond) in kinds.iter().enumerate() {
        if let Some((quantity, value, requirement)) = bond.kind().problem() {
            return Err(ModelError::BondKind { kind, quantity, value, requirement });
        }
    }
    let mut seen = std::collections::HashSet::new();
    bonds
        .iter()
        .enumerate()
        .map(|(index, b)| {
            let error = |problem: String| ModelError::Bond { index, problem };
            let by_face = kinds.get(b.kind).is_some_and(Bond::fills_faces);
            for body in [b.a, b.b] {
                if body >= bodies.len() {
                    return Err(error(format!("there is no body {body}")));
                }
                if bodies.kind(body) != BodyKind::Sphere && !by_face {
                    return Err(error(format!("body {body} is not a single sphere")));
                }
            }
            if b.a == b.b {
                return Err(error(format!("it joins body {} with itself", b.a)));
            }
            if !seen.insert((b.a.min(b.b), b.a.max(b.b))) {
                return Err(error(format!("bodies {} and {} have another bond already", b.a, b.b)));
            }
            let Some(kind) = kinds.get(b.kind) else {
                return Err(error(format!("there is no kind of bond {}", b.kind)));
            };
            let factors = [b.tension, b.shear, b.stiffness];
            if !factors.iter().all(|f| *f > 0.0 && f.is_finite()) {
                return Err(error(
                    "its factors on strength and stiffness must be positive and finite".into(),
                ));
            }
            let (p, q) = (&bodies.get(b.a), &bodies.get(b.b));
            let length = (places[b.a].position - places[b.b].position).norm();
            if length.is_nan() || length <= 0.0 {
                return Err(error("its bodies have the same centre".into()));
            }
            match (by_face, b.face) {
                (true, Some(f))
                    if f.size.iter().all(|x| *x > 0.0 && x.is_finite()) && f.offset.abs() < length => {}
                (false, None) => {}
                (true, _) => {
                    return Err(error(
                        "its face must have a size above 0 and lie between the centres".into(),
                    ));
                }
                (false, Some(_)) => return Err(error("its kind has no face".into())),
            }
            let free = b.length.unwrap_or(length);
            if !(free > 0.0 && free.is_finite()) {
                return Err(error("its length without tension must be above 0 and finite".into()));
            }
            Ok(constants(kind, b, p, q, free))
        })
        .collect()
}

fn constants(kind: &Bond, b: &BondInput, p: &Body, q: &Body, length: f64) -> Constants {
    // The least principal moment gives the highest frequency.
    let inertia = |body: &Body| if body.fixed >> 3 == 7 { 0.0 } else { 1.0 / body.inertia.min() };
    let reduced = |sum: f64| if sum > 0.0 { 1.0 / sum } else { 0.0 };
    let joint = Joint {
        radii: [p.radius, q.radius],
        length,
        mass: reduced(p.inverse_mass + q.inverse_mass),
        inertia: reduced(inertia(p) + inertia(q)),
        face: b.face,
    };
    let kind = kind.kind();
    let (springs, rules) = (kind.springs(&joint), kind.rules());
    let stiffness = springs.stiffness.map(|k| k * b.stiffness);
    let dashpots = match rules.damping {
        BondDamping::None => [0.0; 4],
        BondDamping::Coefficients(c) => c,
        BondDamping::Fraction(zeta) => std::array::from_fn(|m| {
            2.0 * zeta * (stiffness[m] * if m < 2 { joint.mass } else { joint.inertia }).sqrt()
        }),
    };
    let [tension, bending, shear, twisting, confined] = springs.limit;
    let mut values = [0.0; kernel::COUNT];
    values[kernel::LENGTH] = length;
    values[kernel::OFFSET] = springs.offset;
    values[kernel::STIFFNESS..kernel::STIFFNESS + 4].copy_from_slice(&stiffness);
    values[kernel::DAMPING..kernel::DAMPING + 4].copy_from_slice(&dashpots);
    let limit = [
        tension / b.tension,
        bending / b.tension * stiffness[2],
        shear / b.shear * stiffness[1],
        twisting / b.shear * stiffness[3],
        confined / b.shear,
    ];
    values[kernel::LIMIT..kernel::LIMIT + 5].copy_from_slice(&limit);
    values[kernel::SUM] = if rules.criterion == Criterion::Sum { 1.0 } else { 0.0 };
    Constants { ends: [b.a as u32, b.b as u32], values, contact: rules.contact }
}
