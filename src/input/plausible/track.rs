//! Plausibility of sleepers, rails and loads.

use super::bed::{of_grains, size};
use super::findings::{Findings, Usual, shown};
use super::grains::length;
use crate::model::Job;
use crate::scene::Scene;
use crate::scene::track::{SeatLoad, Sleeper, TrackTable};

const FORCE: Usual = Usual::or_zero(1.0, 2e6, "N");
const FREQUENCY: Usual = Usual::new(0.01, 300.0, "Hz");

/// Checks the track.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(track) = &scene.track else { return };
    sleeper(findings, &track.sleeper);
    place(findings, &track.sleeper, job);
    rail(findings, track);
    if let Some(l) = &track.load {
        load(findings, l);
        against_weight(findings, scene, l, &track.sleeper);
        against_stiffness(findings, scene, l, &track.sleeper);
    }
    if let Some(p) = &track.push {
        findings.weigh("track.push.displacement", p.displacement.si.abs(), Usual::new(1e-5, 0.5, "m"));
    }
}

fn sleeper(findings: &mut Findings, s: &Sleeper) {
    for side in &s.size {
        findings.weigh("track.sleeper.size", side.si, Usual::new(0.01, 5.0, "m"));
    }
    if let Some(mass) = s.mass {
        findings.weigh("track.sleeper.mass", mass.si, Usual::new(0.1, 3000.0, "kg"));
        let density = mass.si / s.size.iter().map(|x| x.si).product::<f64>();
        if !(100.0..=20_000.0).contains(&density) {
            let found = format!("{}, {} of its box", shown(mass.si, "kg"), shown(density, "kg/m3"));
            let serious = !(10.0..=100_000.0).contains(&density);
            findings.add(serious, "track.sleeper.mass", found, "500 to 8000 kg/m3");
        }
    }
    findings.weigh_some("track.sleeper.spacing", s.spacing.map(|v| v.si), Usual::new(0.1, 3.0, "m"));
    if let Some(mesh) = &s.mesh {
        findings.weigh("track.sleeper.mesh.young", mesh.young.si, Usual::new(1e6, 1e12, "Pa"));
        findings.weigh("track.sleeper.mesh.poisson", mesh.poisson, Usual::or_zero(0.01, 0.495, ""));
    }
}

fn place(findings: &mut Findings, s: &Sleeper, job: &Job) {
    let Some(bed) = of_grains(job) else { return };
    for d in 0..2 {
        let (centre, half) = (s.centre[d].si, 0.5 * s.size[0].si.max(s.size[1].si));
        if centre + half < bed.low[d] || centre - half > bed.high[d] {
            let axis = ["x", "y"][d];
            let (low, high) = (shown(bed.low[d], ""), shown(bed.high[d], "m"));
            let found = format!("{axis} = {}, off the bed from {low} to {high}", shown(centre, "m"));
            findings.add(true, "track.sleeper.centre", found, "a position above the grains");
        }
    }
}

fn rail(findings: &mut Findings, track: &TrackTable) {
    let Some(r) = &track.rail else { return };
    findings.weigh("track.rail.bending_stiffness", r.bending_stiffness.si, Usual::new(1e4, 5e7, "N m2"));
    findings.weigh_some("track.rail.mass", r.mass.map(|v| v.si), Usual::new(5.0, 200.0, "kg/m"));
    findings.weigh("track.rail.foundation", r.foundation.si, Usual::new(1e5, 1e10, "N/m"));
    findings.weigh_some(
        "track.rail.pad_stiffness",
        r.pad_stiffness.map(|v| v.si),
        Usual::new(1e6, 1e10, "N/m"),
    );
}

fn load(findings: &mut Findings, l: &SeatLoad) {
    let key = |name: &str| format!("track.load.{name}");
    findings.weigh_some(key("minimum"), l.minimum.map(|v| v.si), FORCE);
    findings.weigh_some(key("maximum"), l.maximum.map(|v| v.si), FORCE);
    findings.weigh_some(key("frequency"), l.frequency.map(|v| v.si), FREQUENCY);
    findings.weigh_some(key("cycles"), l.cycles.map(f64::from), Usual::or_zero(1.0, 1e7, ""));
    findings.weigh_some(key("speed"), l.speed.map(|v| v.si), Usual::new(0.1, 200.0, "m/s"));
    findings.weigh_some(key("axle_load"), l.axle_load.map(|v| v.si), Usual::new(500.0, 500e3, "N"));
    findings.weigh_some(key("wheelbase"), l.wheelbase.map(|v| v.si), Usual::new(0.3, 20.0, "m"));
    findings.weigh(key("rest"), l.rest.si, Usual::or_zero(1e-4, 60.0, "s"));
    findings.weigh(key("ramp"), l.ramp.si, Usual::or_zero(1e-4, 60.0, "s"));
    if let Some(s) = &l.seating {
        findings.weigh(key("seating.maximum"), s.maximum.si, FORCE);
        findings.weigh(key("seating.frequency"), s.frequency.si, FREQUENCY);
    }
}

/// Loads below the weight of a sleeper, such as kilonewtons given as newtons.
fn against_weight(findings: &mut Findings, scene: &Scene, l: &SeatLoad, s: &Sleeper) {
    let (Some(most), Some(mass)) = (l.maximum, s.mass) else { return };
    let weight = mass.si * length(&scene.gravity);
    if most.si > 0.0 && most.si < weight {
        let found = format!("{}, of a sleeper that weighs {}", shown(most.si, "N"), shown(weight, "N"));
        findings.add(most.si < 0.02 * weight, "track.load.maximum", found, "more than the weight");
    }
}

/// Overlap under the mean pressure, over grain size.
fn against_stiffness(findings: &mut Findings, scene: &Scene, l: &SeatLoad, s: &Sleeper) {
    let most = l.maximum.or(l.axle_load).map(|v| v.si);
    let stiffness = scene.grains.iter().filter_map(|g| {
        let material = scene.material.iter().find(|m| m.name == g.material)?;
        Some(material.stiffness?.si)
    });
    let (Some(most), Some(size), Some(stiffness)) = (most, size(scene), stiffness.reduce(f64::min)) else {
        return;
    };
    let mut sides = [s.size[0].si, s.size[1].si];
    sides.sort_by(f64::total_cmp);
    let pressure = most / (sides[0] * sides[1]);
    let overlap = pressure * size / stiffness;
    if overlap > 0.1 {
        let found = format!("{} with overlaps of {:.2} of the grain size", shown(most, "N"), overlap);
        findings.add(
            overlap > 1.0,
            "track.load.maximum",
            found,
            "overlaps of about 0.01: increase the stiffness or reduce the load",
        );
    }
}
