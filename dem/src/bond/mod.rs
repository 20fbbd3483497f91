//! Bonds between bodies: elastic bars that carry force (and moment) until they break.
//!
//! A [`Bond`] is a kind of bond, one file each, and listed in `kind.rs`: [`ParallelBond`] (a cemented disk between two spheres), [`ContactPoint`]
//! (force only), [`DirectBond`] (stiffnesses and strengths of the bond itself), [`FaceBond`] (the face between two bodies of any
//! shape). A [`BondInput`] puts one between two bodies. All of them end up as the same sixteen constants, and one kernel (`kernel.rs`) computes the forces:
//!
//! * tension from the present length, kₙ (L − L₀): no drift;
//! * shear, bending and twisting by increments in a frame that turns with the line of centres and with the mean spin
//!   about it (Potyondy & Cundall, Int. J. Rock Mech. Min. Sci. 41, 2004). The increments are those of the angle
//!   between the spins and the line of centres, so that a rigid motion of any size stores nothing.
//!
//! A bond breaks in the step in which its criterion reaches 1 (`kernel.rs`); the elastic energy it held goes to the
//! ledger and, as the energy of an acoustic event, to the list of breaks. The pair then stays with this module as a
//! `DebondedPair` (`debonded.rs`) until the two have separated.
//!
//! Limits: all but face bonds join single spheres only, not clumps or boxes; rotations between bonded spheres are small (linear
//! springs); the stored vectors turn with an error of the sixth power of the angle per step.

mod contact_point;
pub(crate) mod debonded;
mod direct;
mod face;
pub(crate) mod kernel;
mod kind;
mod limit;
mod loops;
mod pairs;
mod parallel;
pub(crate) mod pass;
pub(crate) mod slot;
mod springs;
pub(crate) mod store;
mod strength;

pub use contact_point::ContactPoint;
pub use direct::DirectBond;
pub use face::{Face, FaceBond};
pub use kind::Bond;
pub use pairs::within_gap;
pub use parallel::{ParallelBond, ParallelStiffness, ShearStrength};
pub use springs::{BondDamping, Criterion};
pub use strength::{Spread, factors};

pub(crate) use limit::stiffest;
pub(crate) use store::{BondList, BondState, Held};

use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::bodies::input::BodyInput;
use crate::bodies::table::{Bodies, Body, Kind};
use serde::{Deserialize, Serialize};
use springs::Joint;

/// A bond between two bodies: single spheres, or, by their face, bodies of any shape. Its length at rest is their distance at the start of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondInput {
    /// First body (index).
    pub a: usize,
    /// Second body (index).
    pub b: usize,
    /// Kind of bond (index into [`crate::ModelInput::bond_kinds`]).
    pub kind: usize,
    /// Factor on the tensile strength [-].
    pub tension: f64,
    /// Factor on the shear strength [-].
    pub shear: f64,
    /// Factor on all stiffnesses [-].
    pub stiffness: f64,
    /// Face between the bodies, of a [`FaceBond`].
    pub face: Option<Face>,
}

impl BondInput {
    /// A bond with the strengths and stiffnesses of its kind.
    pub fn new(a: usize, b: usize, kind: usize) -> BondInput {
        BondInput { a, b, kind, tension: 1.0, shear: 1.0, stiffness: 1.0, face: None }
    }
}

/// How a bond broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BreakMode {
    /// Tension and bending used up the larger share.
    Tension,
    /// Shear and twisting did.
    Shear,
}

/// A bond that broke: an acoustic event.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Break {
    /// Time [s].
    pub time: f64,
    /// Number of the bond in the model.
    pub bond: u32,
    /// The bodies it joined.
    pub bodies: [u32; 2],
    /// Place of its middle [m].
    pub place: Vec3,
    /// How it broke.
    pub mode: BreakMode,
    /// Elastic energy set free, less what a contact of the pair takes over [J].
    pub energy: f64,
}

/// A bond resolved: what the kernel needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    /// Bodies.
    pub ends: [u32; 2],
    /// In the order of [`kernel`]'s indices.
    pub values: [f64; kernel::COUNT],
    /// Whether the contact of the pair acts beside the bond.
    pub contact: bool,
}

/// Checks and resolves the bonds of an input.
pub(crate) fn resolve(
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
                if bodies.kind(body) != Kind::Sphere && !by_face {
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
            Ok(constants(kind, b, p, q, length))
        })
        .collect()
}

fn constants(kind: &Bond, b: &BondInput, p: &Body, q: &Body, length: f64) -> Constants {
    // Of the principal moments the least is the one that a spring swings fastest.
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
    // Per unit of tension, bending angle, shear displacement, twist; the last per unit of tension.
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
