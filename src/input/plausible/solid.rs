//! Plausibility of solid loads, support displacements, damping.

use super::bed::of_solid;
use super::findings::{Findings, Usual, shown};
use crate::model::Job;
use crate::scene::Scene;
use crate::scene::solid::SolidLoad;
use crate::scene::units::vector;

/// Least number of solid steps in which an axle passes.
const FEW_STEPS: f64 = 8.0;

/// Checks loads and supports.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(solid) = &scene.solid else { return };
    let softest = solid.material.iter().filter_map(|m| m.young).map(|y| y.si).fold(f64::INFINITY, f64::min);
    for (k, load) in solid.load.iter().enumerate() {
        let key = |name: &str| format!("solid.load.{k}.{name}");
        if let Some(pressure) = load.pressure {
            findings.weigh(key("pressure"), pressure.si.abs(), Usual::or_zero(0.1, 1e9, "Pa"));
            if pressure.si.abs() > 0.1 * softest {
                let found = format!(
                    "{}, {:.2} of the softest Young's modulus",
                    shown(pressure.si, "Pa"),
                    pressure.si.abs() / softest
                );
                findings.add(true, key("pressure"), found, "at most 0.01 of it (small strains)");
            }
        }
        if let Some(force) = &load.force {
            let size = force.iter().map(|f| f.si * f.si).sum::<f64>().sqrt();
            findings.weigh(key("force"), size, Usual::or_zero(1e-3, 1e8, "N"));
        }
        moving(findings, load, &key, job);
        let frequency = load.history.as_ref().and_then(|h| h.frequency).map(|f| f.si);
        findings.weigh_some(key("history.frequency"), frequency, Usual::new(0.001, 1e5, "Hz"));
    }
    let longest = of_solid(job).map_or(f64::INFINITY, |e| e.longest());
    for (k, support) in solid.support.iter().enumerate() {
        if let Some(u) = support.displacement.filter(|u| u.si.abs() > 0.5 * longest) {
            let found = format!("{} on a solid of {}", shown(u.si, "m"), shown(longest, "m"));
            findings.add(true, format!("solid.support.{k}.displacement"), found, "at most 0.01 of the solid");
        }
    }
    if let Some(r) = &solid.rayleigh {
        findings.weigh_some("solid.rayleigh.damping_ratio", r.damping_ratio, Usual::or_zero(1e-4, 0.3, ""));
        for f in r.frequencies.iter().flatten() {
            findings.weigh("solid.rayleigh.frequencies", f.si, Usual::new(0.01, 1e5, "Hz"));
        }
        findings.weigh_some("solid.rayleigh.beta_k", r.beta_k.map(|b| b.si), Usual::or_zero(1e-8, 0.5, "s"));
    }
    if let Some(n) = &solid.newton {
        findings.weigh_some("solid.newton.tolerance", n.tolerance, Usual::new(1e-12, 0.05, ""));
    }
}

/// Moving axles that never arrive, or pass within few steps.
fn moving(findings: &mut Findings, load: &SolidLoad, key: &dyn Fn(&str) -> String, job: &Job) {
    let (Some(speed), Some(path)) = (load.speed, load.path) else { return };
    findings.weigh(key("speed"), speed.si, Usual::new(0.1, 300.0, "m/s"));
    let start = load.start.map_or(0.0, |t| t.si);
    if start >= job.end {
        let found = format!("{}, the run ends at {}", shown(start, "s"), shown(job.end, "s"));
        findings.add(true, key("start"), found, "the first axle on the path before the end");
    }
    let [from, to] = path.map(|p| vector(&p));
    let length = [0, 1, 2].map(|d| (to[d] - from[d]) * (to[d] - from[d])).iter().sum::<f64>().sqrt();
    if let Some(steps) =
        job.solid_step.map(|step| length / speed.si / step).filter(|steps| *steps < FEW_STEPS)
    {
        let found = format!("{}, {steps:.1} steps along the path", shown(speed.si, "m/s"));
        findings.add(
            false,
            key("speed"),
            found,
            format!("{FEW_STEPS} steps or more: smaller time.solid_step"),
        );
    }
}
