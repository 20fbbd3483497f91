//! Plausibility of time, steps and output.

use super::findings::{Findings, Usual, shown};
use crate::model::Job;
use crate::scene::Scene;

/// Frame bytes per node and body.
const BYTES: f64 = 400.0;
/// Result size limit [bytes].
const LARGE: f64 = 200e9;
/// Particle updates per second on one core.
const RATE: f64 = 15e6;

/// Checks time, steps and output.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    let grains = job.grains.is_some();
    let longest = if grains { 1e4 } else { 1e6 };
    findings.weigh_some("time.end", scene.time.end.map(|v| v.si), Usual::new(1e-7, longest, "s"));
    if let Some(step) = scene.time.solid_step.filter(|s| job.end > 0.0 && s.si > job.end) {
        let found = format!("{}, longer than the run of {}", shown(step.si, "s"), shown(job.end, "s"));
        findings.add(true, "time.solid_step", found, "a part of the run");
    }
    findings.weigh_some(
        "time.grain_step_fraction",
        scene.time.grain_step_fraction,
        Usual::new(0.01, 1.0, ""),
    );
    findings.weigh_some(
        "time.impact_speed",
        scene.time.impact_speed.map(|v| v.si),
        Usual::or_zero(1e-4, 300.0, "m/s"),
    );
    findings.weigh_some(
        "coupling.tolerance",
        scene.coupling.as_ref().and_then(|c| c.tolerance),
        Usual::new(1e-12, 0.05, ""),
    );
    output(findings, scene, job);
    duration(findings, scene, job);
}

fn output(findings: &mut Findings, scene: &Scene, job: &Job) {
    let frames = f64::from(scene.output.frames.unwrap_or(20));
    let nodes = job.solid.as_ref().map_or(0, |s| s.model.mesh().node_count());
    let bodies = job.grains.as_ref().map_or(0, |g| g.groups.bodies.len());
    let bytes = BYTES * frames * (nodes + bodies) as f64;
    if bytes > LARGE {
        let found = format!("{frames} frames, about {:.0} GB", 1e-9 * bytes);
        findings.add(bytes > 10.0 * LARGE, "output.frames", found, "at most 200 GB of frames");
    }
    if let Some(interval) = scene.output.history_interval {
        let rows = job.end / interval.si;
        if rows > 1e7 {
            let found = format!("{}, {} rows", shown(interval.si, "s"), shown(rows, ""));
            findings.add(rows > 1e9, "output.history_interval", found, "at most 10 million rows");
        }
        if job.end > 0.0 && interval.si > job.end {
            let found =
                format!("{}, longer than the run of {}", shown(interval.si, "s"), shown(job.end, "s"));
            findings.add(false, "output.history_interval", found, "a part of the run");
        }
    }
}

/// Steps of a fifth of √(m/k) of the mean grain.
fn duration(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(size) = super::bed::size(scene) else { return };
    let material = |name: &str| scene.material.iter().find(|m| m.name == name);
    let time_of = |g: &crate::scene::grains::Grains| {
        let m = material(&g.material)?;
        Some((m.density?.si * size.powi(3) / (2.0 * m.stiffness?.si)).sqrt())
    };
    let Some(shortest) = scene.grains.iter().filter_map(time_of).reduce(f64::min) else { return };
    let bodies = job.grains.as_ref().map_or(0, |g| g.groups.bodies.len()) as f64;
    let days = job.end / (0.2 * shortest) * bodies / RATE / 86400.0;
    if days > 60.0 {
        let key = if scene.time.end.is_some() { "time.end" } else { "track.load.cycles" };
        let found = format!("a run of about {days:.0} days on one core");
        findings.add(
            days > 2000.0,
            key,
            found,
            "a few days. Use fewer or larger grains, softer contacts, or cycle jumps",
        );
    }
}
