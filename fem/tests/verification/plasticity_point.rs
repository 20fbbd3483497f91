//! Plasticity at a material point.
//!
//! Tables: `tests/data/plasticity`, from a separate reference code (`case.json`).

mod closed_forms;
mod faults;
mod flow;
mod tables;
mod tangents;
mod timing;
mod walks;

use crate::common::Random;
use trackbed_fem::material::{
    Cone, DruckerPrager, Elastic, Hardening, Material, MohrCoulomb, PointState, Response, ReturnRegion,
    regularise, update,
};

/// E = 50 MPa, nu = 0.3.
pub const SOIL: Elastic = Elastic { young: 50e6, poisson: 0.3, density: 2000.0 };
pub const COHESION: f64 = 20e3;

pub fn rad(degrees: f64) -> f64 {
    degrees.to_radians()
}

pub fn mohr_coulomb(c: f64, phi: f64, psi: f64, tension: Option<f64>) -> MohrCoulomb {
    MohrCoulomb {
        cohesion: Hardening::Constant(c),
        friction: Hardening::Constant(rad(phi)),
        dilation: rad(psi),
        tension,
    }
}

pub fn drucker_prager(c: f64, phi: f64, psi: f64, cone: Cone, tension: Option<f64>) -> DruckerPrager {
    DruckerPrager {
        cohesion: Hardening::Constant(c),
        friction: Hardening::Constant(rad(phi)),
        dilation: rad(psi),
        cone,
        tension,
    }
}

pub fn norm(x: &[f64; 6]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| x.abs().max(m))
}

/// Deviatoric part of size `shear`, volumetric in +-`volume`.
pub fn random_strain(random: &mut Random, shear: f64, volume: f64) -> [f64; 6] {
    let mut e: [f64; 6] = std::array::from_fn(|_| shear * random.next());
    let volume = volume * random.next() / 3.0;
    let mean = (e[0] + e[1] + e[2]) / 3.0;
    e[..3].iter_mut().for_each(|e| *e += volume - mean);
    let draw = random.next();
    if draw < -0.6 {
        e[3..].fill(0.0);
    } else if draw > 0.7 {
        e[1] = e[0];
        e[3..].fill(0.0);
    }
    e
}

/// Descending principal values and axes (columns), by another library.
pub fn eigen(s: &[f64; 6]) -> ([f64; 3], nalgebra::Matrix3<f64>) {
    let m = nalgebra::Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
    let e = m.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| e.eigenvalues[j].total_cmp(&e.eigenvalues[i]));
    let columns = order.map(|i| e.eigenvectors.column(i).into_owned());
    (order.map(|i| e.eigenvalues[i]), nalgebra::Matrix3::from_columns(&columns))
}

pub fn step(material: &Material, old: &PointState, increment: &[f64; 6]) -> Response {
    update(material, old, increment, true).expect("a return")
}

/// Prescribed stresses where `held` is true, else strains (normal components; no shear). Returns the response
/// and the strain increment.
pub fn mixed_step(
    material: &Material,
    old: &PointState,
    mut strain: [f64; 3],
    held: [Option<f64>; 3],
    tolerance: f64,
) -> (Response, [f64; 3], usize) {
    let free: Vec<usize> = (0..3).filter(|&i| held[i].is_some()).collect();
    for iteration in 0..60 {
        let mut response = step(material, old, &[strain[0], strain[1], strain[2], 0.0, 0.0, 0.0]);
        let residual: Vec<f64> = free.iter().map(|&i| held[i].unwrap() - response.state.stress[i]).collect();
        if largest(&residual) <= tolerance {
            return (response, strain, iteration);
        }
        regularise(&mut response.tangent, &material.elastic, trackbed_fem::material::REGULARISATION);
        let k = nalgebra::DMatrix::from_fn(free.len(), free.len(), |r, c| response.tangent[free[r]][free[c]]);
        let change = k.lu().solve(&nalgebra::DVector::from_vec(residual)).expect("a regular matrix");
        free.iter().enumerate().for_each(|(row, &i)| strain[i] += change[row]);
    }
    panic!("no convergence at strain {strain:?}");
}

/// Laws with the regions to reach.
pub fn laws() -> Vec<(&'static str, Material, Vec<ReturnRegion>)> {
    use ReturnRegion::*;
    let open = vec![Plane, EdgeCompression, EdgeExtension, Apex];
    let cut = vec![
        Plane,
        EdgeCompression,
        EdgeExtension,
        TensionPlane,
        TensionEdge,
        TensionCorner,
        PlaneTension,
        EdgeCompressionTension,
        EdgeExtensionTension,
    ];
    let c = COHESION;
    let line = |initial: f64, modulus: f64, limit| Hardening::Linear { initial, modulus, limit };
    let table =
        Hardening::Table(vec![(0.0, rad(20.0)), (2e-3, rad(30.0)), (8e-3, rad(33.0)), (2e-2, rad(31.0))]);
    let mut list: Vec<(&'static str, Material, Vec<ReturnRegion>)> = Vec::new();
    let mut mc = |name, law: MohrCoulomb, regions: &Vec<ReturnRegion>| {
        list.push((name, Material::plastic(SOIL, law), regions.clone()));
    };
    mc("mc 30/30", mohr_coulomb(c, 30.0, 30.0, None), &open);
    mc("mc 30/10", mohr_coulomb(c, 30.0, 10.0, None), &open);
    mc("mc 30/0", mohr_coulomb(c, 30.0, 0.0, None), &open);
    mc("mc c=0", mohr_coulomb(0.0, 35.0, 5.0, None), &open);
    mc("tresca", MohrCoulomb::tresca(2.0 * c), &open[..3].to_vec());
    mc("mc 30/30 cut", mohr_coulomb(c, 30.0, 30.0, Some(0.4 * c)), &cut);
    mc("mc 30/10 cut", mohr_coulomb(c, 30.0, 10.0, Some(0.4 * c)), &cut);
    mc("mc 45/0 cut 0", mohr_coulomb(c, 45.0, 0.0, Some(0.0)), &cut);
    mc("tresca cut", MohrCoulomb { tension: Some(0.6 * c), ..MohrCoulomb::tresca(2.0 * c) }, &cut);
    let harder = MohrCoulomb { cohesion: line(c, 100.0 * c, None), ..mohr_coulomb(c, 30.0, 10.0, None) };
    mc("mc hardening c", harder.clone(), &open);
    mc("mc hardening c cut", MohrCoulomb { tension: Some(0.4 * c), ..harder.clone() }, &cut);
    let associated = MohrCoulomb { dilation: rad(30.0), ..harder.clone() };
    mc("mc 30/30 hardening c", associated, &open);
    let softer = MohrCoulomb { cohesion: line(c, -20.0 * c, Some(0.6 * c)), ..harder.clone() };
    mc("mc softening c", softer.clone(), &open);
    mc("mc softening c cut", MohrCoulomb { tension: Some(0.4 * c), ..softer }, &cut);
    let both = MohrCoulomb { friction: table.clone(), ..harder };
    mc("mc hardening c, phi", both.clone(), &open);
    mc("mc hardening c, phi cut", MohrCoulomb { tension: Some(0.4 * c), ..both }, &cut);
    let mut dp = |name, law: DruckerPrager, regions: &[ReturnRegion]| {
        list.push((name, Material::plastic(SOIL, law), regions.to_vec()));
    };
    let (open, cut) = ([Cone, ConeApex], [Cone, Cap, ConeCap]);
    use trackbed_fem::material::Cone as Match;
    dp("dp outer 30/30", drucker_prager(c, 30.0, 30.0, Match::Compression, None), &open);
    dp("dp inner 30/10", drucker_prager(c, 30.0, 10.0, Match::Extension, None), &open);
    dp("dp plane strain 30/0", drucker_prager(c, 30.0, 0.0, Match::PlaneStrain, None), &open);
    dp("dp c=0", drucker_prager(0.0, 35.0, 5.0, Match::Compression, None), &open);
    dp("von mises", DruckerPrager::von_mises(2.0 * c), &open[..1]);
    dp("dp 30/30 cap", drucker_prager(c, 30.0, 30.0, Match::Compression, Some(0.4 * c)), &cut);
    dp("dp 30/10 cap", drucker_prager(c, 30.0, 10.0, Match::Extension, Some(0.4 * c)), &cut);
    dp("von mises cap", DruckerPrager { tension: Some(0.6 * c), ..DruckerPrager::von_mises(2.0 * c) }, &cut);
    let harder = |law| DruckerPrager { cohesion: line(c, 100.0 * c, None), ..law };
    dp("dp 30/30 hardening c", harder(drucker_prager(c, 30.0, 30.0, Match::Compression, None)), &open);
    dp("von mises hardening", harder(DruckerPrager::von_mises(2.0 * c)), &open[..1]);
    for cone in [Match::Compression, Match::Extension, Match::PlaneStrain] {
        let harder =
            DruckerPrager { cohesion: line(c, 100.0 * c, None), ..drucker_prager(c, 30.0, 10.0, cone, None) };
        dp("dp hardening c", harder.clone(), &open);
        let both = DruckerPrager { friction: table.clone(), ..harder };
        dp("dp hardening c, phi", both.clone(), &open);
        dp("dp hardening c, phi cap", DruckerPrager { tension: Some(0.4 * c), ..both.clone() }, &cut);
        let softer = DruckerPrager { cohesion: line(c, -20.0 * c, Some(0.6 * c)), ..both };
        dp("dp softening c, hardening phi", softer, &open);
    }
    list
}
