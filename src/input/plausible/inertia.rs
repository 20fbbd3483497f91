//! Mass scaling: whether the bed stays quasi-static.

use super::findings::{Findings, shown};
use crate::model::Job;
use crate::scene::Scene;
use std::f64::consts::PI;
use trackbed_dem::Material;

/// Inertial number below which granular stresses are rate-independent (GDR MiDi, Eur. Phys. J. E 14 (2004)
/// 341; da Cruz et al., Phys. Rev. E 72 (2005) 021309).
const QUASI_STATIC: f64 = 1e-3;
/// Limit of inertial flow.
const INERTIAL: f64 = 0.1;
/// Bed modulus over K/d, grain size d, contact stiffness K: 0.18 in the box test (125 MPa, 50 MN/m, 0.07 m).
const MODULUS: f64 = 0.18;
/// The same for elastic grains, K at the largest pressure times d²: 0.33 in the box test (110 MPa, 15 GPa,
/// corner strength 180 MPa).
const ELASTIC_MODULUS: f64 = 0.33;
/// Limit without a cyclic load, whose rate is unknown.
const UNKNOWN: f64 = 100.0;

/// Checks mass scaling by I = ε̇ d √(f ρ / p), ε̇ = π ν Δp/M for a haversine of frequency ν and range Δp on
/// bed modulus M.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(factor) = scene.time.mass_factor.filter(|f| *f > 1.0) else { return };
    let key = "time.mass_factor";
    let Some(number) = number(scene, job, factor) else {
        if factor > UNKNOWN {
            let found = format!("{}, in a scene without a cyclic load that sets its rate", shown(factor, ""));
            findings.add(factor > 30.0 * UNKNOWN, key, found, "at most 100");
        }
        return;
    };
    if number > QUASI_STATIC {
        let found = format!(
            "{}, at which the inertial number of the loaded bed is about {number:.1e}",
            shown(factor, "")
        );
        let fitting = factor * (QUASI_STATIC / number).powi(2);
        let usual = if fitting >= 1.0 {
            format!("below 1e-3 (quasi-static): a factor of at most {fitting:.1}")
        } else {
            "below 1e-3 (quasi-static), not reachable for this load rate".to_string()
        };
        findings.add(number > INERTIAL, key, found, usual);
    }
}

/// None without cyclic load or stiffness.
fn number(scene: &Scene, job: &Job, factor: f64) -> Option<f64> {
    let (track, grains) = (scene.track.as_ref()?, job.grains.as_ref()?);
    let load = track.load.as_ref()?;
    let (frequency, least, most) = (load.frequency?.si, load.minimum?.si, load.maximum?.si);
    let stones = grains.groups.bodies.first()?;
    let material = grains.material(stones);
    let size = 2.0 * grains.groups.mean_reach();
    let area = track.sleeper.size[0].si * track.sleeper.size[1].si;
    if size <= 0.0 || most <= least {
        return None;
    }
    let modulus = modulus(material, size, most / area)?;
    let rate = PI * frequency * (most - least) / area / modulus;
    let pressure = 0.5 * (least + most) / area;
    Some(rate * size * (factor * material.density / pressure).sqrt())
}

fn modulus(material: Material, size: f64, pressure: f64) -> Option<f64> {
    let Some(young) = material.young else {
        return (material.stiffness > 0.0).then(|| MODULUS * material.stiffness / size);
    };
    let force = pressure * size * size;
    let effective = young / (2.0 * (1.0 - material.poisson * material.poisson));
    let circle = libm::cbrt(0.75 * force * 0.25 * size / effective);
    let circle = circle.max((1.5 * force / (PI * material.corner_strength)).sqrt());
    Some(ELASTIC_MODULUS * 2.0 * effective * circle / size)
}
