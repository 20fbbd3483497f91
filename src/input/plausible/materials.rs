//! Plausibility of material, pair and bond constants.

use super::findings::{Findings, Usual};
use crate::model::grains::parameters;
use crate::scene::Scene;
use crate::scene::material::{GrainMaterial, PairContact};
use trackbed_dem::PairOverride;
use trackbed_dem::law::damping::Damping;
use trackbed_dem::law::parameter::{self, Parameter};

/// Soft models to diamond.
const YOUNG: Usual = Usual::new(1e4, 1.2e12, "Pa");
const POISSON: Usual = Usual::or_zero(0.01, 0.495, "");
/// Model-scale soft soils to steel.
const SOLID_YOUNG: Usual = Usual::new(1e5, 1e12, "Pa");
const STRENGTH: Usual = Usual::new(100.0, 5e9, "Pa");
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Checks all materials.
pub fn weigh(findings: &mut Findings, scene: &Scene) {
    scene.material.iter().enumerate().for_each(|(k, m)| grain(findings, k, m));
    scene.contact.iter().enumerate().for_each(|(k, c)| pair(findings, k, c));
    solid(findings, scene);
    bonds(findings, scene);
}

fn grain(findings: &mut Findings, k: usize, m: &GrainMaterial) {
    let material = parameters(m);
    // Wall density has no effect.
    let is_set = |p: &&Parameter<_>| p.key != "density" || m.density.is_some();
    for p in parameter::MATERIAL.iter().filter(is_set) {
        findings.weigh_some(format!("material.{k}.{}", p.key), p.value(&material), Usual::of(p));
    }
}

fn pair(findings: &mut Findings, k: usize, c: &PairContact) {
    let pair = PairOverride {
        friction: c.friction,
        restitution: c.restitution,
        stiffness: c.stiffness.map(|s| s.si),
        adhesion: c.adhesion.map(|w| w.si),
        damping: c.damping_ratio.map(Damping::Ratio),
        rolling_friction: c.rolling_friction,
        twisting_friction: c.twisting_friction,
        ..PairOverride::default()
    };
    for p in &parameter::PAIR {
        findings.weigh_some(format!("contact.{k}.{}", p.key), p.value(&pair), Usual::of(p));
    }
}

fn solid(findings: &mut Findings, scene: &Scene) {
    for (k, m) in scene.solid.iter().flat_map(|s| &s.material).enumerate() {
        let key = |name: &str| format!("solid.material.{k}.{name}");
        findings.weigh_some(key("young"), m.young.map(|v| v.si), SOLID_YOUNG);
        findings.weigh_some(key("poisson"), m.poisson, POISSON);
        findings.weigh(key("density"), m.density.si, Usual::or_zero(10.0, 12_000.0, "kg/m3"));
        findings.weigh_some(key("cohesion"), m.cohesion.map(|v| v.si), Usual::or_zero(10.0, 5e8, "Pa"));
        let degrees = |angle: Option<crate::scene::units::Quantity<_>>| angle.map(|a| a.si / DEGREE);
        findings.weigh_some(key("friction"), degrees(m.friction), Usual::or_zero(1.0, 60.0, "deg"));
        findings.weigh_some(key("dilation"), degrees(m.dilation), Usual::or_zero(0.1, 45.0, "deg"));
        if let (Some(friction), Some(dilation)) = (m.friction, m.dilation)
            && dilation.si > friction.si * (1.0 + 1e-9)
        {
            let found = format!(
                "{:.1} deg, more than the friction of {:.1} deg",
                dilation.si / DEGREE,
                friction.si / DEGREE
            );
            findings.add(false, key("dilation"), found, "at most the friction");
        }
        findings.weigh_some(key("yield_stress"), m.yield_stress.map(|v| v.si), Usual::new(100.0, 5e9, "Pa"));
        findings.weigh_some(key("lambda"), m.lambda, Usual::new(0.005, 2.0, ""));
        findings.weigh_some(key("kappa"), m.kappa, Usual::new(5e-4, 0.5, ""));
        findings.weigh_some(key("critical_ratio"), m.critical_ratio, Usual::new(0.3, 2.0, ""));
        findings.weigh_some(key("void_ratio"), m.void_ratio, Usual::new(0.05, 6.0, ""));
        findings.weigh_some(key("overconsolidation"), m.overconsolidation, Usual::new(1.0, 100.0, ""));
        findings.weigh_some(
            key("preconsolidation"),
            m.preconsolidation.map(|v| v.si),
            Usual::new(100.0, 1e8, "Pa"),
        );
        let strength = m.cohesion.or(m.yield_stress).map(|v| v.si);
        if let (Some(young), Some(strength)) = (m.young, strength)
            && strength > 0.5 * young.si
        {
            let name = if m.cohesion.is_some() { "cohesion" } else { "yield_stress" };
            let found = format!("{:.3e} Pa, {:.2} of Young's modulus", strength, strength / young.si);
            findings.add(true, key(name), found, "at most a tenth of Young's modulus");
        }
    }
}

fn bonds(findings: &mut Findings, scene: &Scene) {
    for (k, b) in scene.bond.iter().enumerate() {
        let Some(p) = &b.parallel else { continue };
        let key = |name: &str| format!("bond.{k}.parallel.{name}");
        findings.weigh_some(key("young"), p.young.map(|v| v.si), YOUNG);
        findings.weigh_some(key("tensile_strength"), p.tensile_strength.map(|v| v.si), STRENGTH);
        findings.weigh_some(key("shear_strength"), p.shear_strength.map(|v| v.si), STRENGTH);
        findings.weigh_some(key("radius_factor"), p.radius_factor, Usual::new(0.05, 2.0, ""));
        if let (Some(young), Some(strength)) = (p.young, p.tensile_strength)
            && strength.si > young.si
        {
            let found = format!("{:.3e} Pa, above Young's modulus", strength.si);
            findings.add(true, key("tensile_strength"), found, "at most a tenth of Young's modulus");
        }
    }
}
