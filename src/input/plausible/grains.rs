//! Plausibility of grains, walls, wind and water.

use super::findings::{Findings, Usual};
use crate::scene::Scene;
use crate::scene::grains::Grains;
use crate::scene::units::Quantity;
use crate::scene::walls::{Mount, Wall};
use std::f64::consts::TAU;

/// Silt to boulders.
const SIZE: Usual = Usual::new(1e-5, 2.0, "m");
const SPEED: Usual = Usual::or_zero(1e-9, 100.0, "m/s");
const SPIN: Usual = Usual::or_zero(1e-9, 1000.0, "rad/s");

/// Checks groups, walls, wind and water.
pub fn weigh(findings: &mut Findings, scene: &Scene) {
    scene.grains.iter().enumerate().for_each(|(k, g)| group(findings, k, g));
    scene.walls.iter().enumerate().for_each(|(k, w)| wall(findings, k, w));
    if let Some(wind) = &scene.wind {
        findings.weigh("wind.velocity", length(&wind.velocity), SPEED);
        findings.weigh("wind.density", wind.density.si, Usual::new(0.01, 3000.0, "kg/m3"));
        findings.weigh("wind.drag", wind.drag, Usual::or_zero(0.05, 5.0, ""));
    }
    if let Some(water) = &scene.water {
        let speed = libm::hypot(water.current[0].si, water.current[1].si);
        findings.weigh("water.current", speed, Usual::or_zero(1e-9, 5.0, "m/s"));
        findings.weigh("water.density", water.density.si, Usual::new(900.0, 1300.0, "kg/m3"));
        findings.weigh("water.drag", water.drag, Usual::or_zero(0.05, 5.0, ""));
        findings.weigh("water.added_mass", water.added_mass, Usual::or_zero(0.05, 5.0, ""));
    }
}

/// Returns the length of a vector.
pub fn length<D>(v: &[Quantity<D>; 3]) -> f64 {
    v.iter().map(|x| x.si * x.si).sum::<f64>().sqrt()
}

fn group(findings: &mut Findings, k: usize, g: &Grains) {
    let key = |name: &str| format!("grains.{k}.{name}");
    if let Some([low, high]) = &g.size {
        findings.weigh(key("size"), low.si, SIZE);
        if high.si != low.si {
            findings.weigh(key("size"), high.si, SIZE);
        }
        let ratio = high.si / low.si;
        if ratio > 50.0 {
            let found = format!("largest over smallest of {ratio:.0}");
            findings.add(
                ratio > 1000.0,
                key("size"),
                found,
                "at most 50, for small grains set step and count",
            );
        }
    }
    for sphere in g.spheres.iter().flatten().take(1) {
        findings.weigh(key("spheres"), 2.0 * sphere[3].si, SIZE);
    }
    if let Some(count) = g.count.filter(|n| *n > 2_000_000) {
        findings.add(false, key("count"), format!("{count}"), "at most 2 million on one machine");
    }
    if let Some(gradation) = &g.gradation {
        findings.weigh(key("gradation.scale"), gradation.scale, Usual::new(0.02, 20.0, ""));
    }
    if let Some(lattice) = &g.lattice {
        findings.weigh(key("lattice.size"), lattice.size.si, SIZE);
    }
    findings.weigh_some(key("velocity"), g.velocity.as_ref().map(length), SPEED);
    findings.weigh_some(key("prescribed_velocity"), g.prescribed_velocity.as_ref().map(length), SPEED);
    findings.weigh_some(key("spin"), g.spin.as_ref().map(length), SPIN);
    if let Some(fill) = &g.fill {
        let size = g.size.as_ref().map(|s| s[1].si);
        for d in 0..2 {
            let width = fill.high[d].si - fill.low[d].si;
            if let Some(size) = size.filter(|s| width < 2.0 * s) {
                let found = format!("a width of {width:.3e} m for grains of {size:.3e} m");
                findings.add(width < size, key("fill"), found, "four grains or more");
            }
        }
    }
}

fn wall(findings: &mut Findings, k: usize, w: &Wall) {
    let key = |name: &str| format!("walls.{k}.{name}");
    findings.weigh_some(key("velocity"), w.velocity.as_ref().map(length), SPEED);
    findings.weigh_some(key("angular_velocity"), w.angular_velocity.as_ref().map(length), SPIN);
    findings.weigh_some(key("radius"), w.radius.map(|v| v.si), Usual::or_zero(1e-4, 100.0, "m"));
    findings.weigh_some(key("scale"), w.scale, Usual::new(1e-4, 100.0, ""));
    if let Some(o) = &w.oscillation {
        findings.weigh(key("oscillation.frequency"), o.frequency.si, Usual::new(0.001, 500.0, "Hz"));
        findings.weigh(key("oscillation.amplitude"), o.amplitude.si, Usual::or_zero(1e-8, 1.0, "m"));
    }
    if let Some(s) = &w.servo {
        findings.weigh_some(
            key("servo.pressure"),
            s.pressure.map(|v| v.si.abs()),
            Usual::or_zero(1.0, 1e8, "Pa"),
        );
        findings.weigh_some(key("servo.area"), s.area, Usual::new(1e-6, 1000.0, "m2"));
        findings.weigh(key("servo.max_speed"), s.max_speed.si, Usual::new(1e-6, 20.0, "m/s"));
    }
    if let Some(s) = &w.scarring {
        findings.weigh(key("scarring.strength"), s.strength.si, Usual::new(0.5e6, 100e6, "Pa"));
        findings.weigh_some(key("scarring.drag"), s.drag, Usual::or_zero(0.2, 10.0, ""));
        findings.weigh_some(
            key("scarring.density"),
            s.density.map(|d| d.si),
            Usual::or_zero(800.0, 2600.0, "kg/m3"),
        );
        findings.weigh_some(key("scarring.friction"), s.friction.map(|f| f[1]), Usual::or_zero(0.2, 3.0, ""));
    }
    if let Some(b) = &w.body {
        findings.weigh(key("body.mass"), b.mass.si, Usual::new(1e-6, 1e8, "kg"));
        if let Some(m) = &b.mount {
            mount(findings, &key("body.mount"), b.mass.si, m);
        }
    }
}

/// Slack mooring to machine bearing; up to overdamped.
fn mount(findings: &mut Findings, key: &str, mass: f64, m: &Mount) {
    let (frequency, share) = (Usual::or_zero(0.002, 500.0, "Hz"), Usual::or_zero(1e-4, 2.0, ""));
    let angular = |d: usize| match (&m.frequency, &m.stiffness) {
        (Some(f), _) => TAU * f[d].si,
        (None, k) => k.as_ref().map_or(0.0, |k| (k[d].si / mass).sqrt()),
    };
    let given = if m.frequency.is_some() { "frequency" } else { "stiffness" };
    for d in 0..3 {
        findings.weigh(format!("{key}.{given}"), angular(d) / TAU, frequency);
        findings.weigh_some(format!("{key}.damping_ratio"), m.damping_ratio.map(|z| z[d]), share);
        if let Some(c) = m.damping.as_ref().filter(|_| angular(d) > 0.0) {
            findings.weigh(format!("{key}.damping"), c[d].si / (2.0 * mass * angular(d)), share);
        }
    }
}
