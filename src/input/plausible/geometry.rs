//! Implausible geometry, such as millimetre meshes.

use super::bed::of_solid;
use super::findings::{Findings, shown};
use super::grains::length;
use crate::model::Job;
use crate::model::grains::{Footprint, is_plain};
use crate::scene::Scene;
use crate::scene::units::vector;
use crate::scene::walls::WallKind;
use trackbed_dem::Vec3;

/// Element edge [m].
const ELEMENT: f64 = 30.0;
/// Length of a solid [m].
const SOLID: f64 = 3000.0;
/// Mean vertical strain under self-weight.
const STRAIN: f64 = 0.1;
/// Young's modulus of ground [Pa].
const SOFT: f64 = 1e6;
/// Lowest plausible over expected height of a bed.
const BED: f64 = 0.8;
/// Gravity fraction along z.
const ACROSS: f64 = 0.5;

/// Checks the geometry.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    millimetres(findings, scene, job);
    sleepers_through_walls(findings, scene, job);
    gravity_across(findings, scene);
}

/// A thousand times too large.
fn millimetres(findings: &mut Findings, scene: &Scene, job: &Job) {
    let (Some(table), Some(part), Some(extent)) = (&scene.solid, &job.solid, of_solid(job)) else { return };
    let mesh = part.model.mesh();
    let volume: f64 = (0..mesh.element_count()).map(|e| mesh.element_volume(e).abs()).sum();
    let element = libm::cbrt(volume / mesh.element_count().max(1) as f64);
    let height = extent.high[2] - extent.low[2];
    let softest = table.material.iter().filter_map(|m| m.young).map(|y| y.si).fold(f64::INFINITY, f64::min);
    let weight = length(&scene.gravity) * part.model.total_mass() / volume;
    // Implausible moduli are reported elsewhere.
    let weighs = table.gravity && softest >= SOFT;
    let strain = if weighs { 0.5 * weight * height / softest } else { 0.0 };
    let longest = extent.longest();
    let found = if longest > SOLID || element > ELEMENT {
        format!("{} with elements of {}", shown(longest, "m"), shown(element, "m"))
    } else if strain > STRAIN {
        let percent = (100.0 * strain).round();
        format!("a height of {}, reduced by {percent} % under its own weight", shown(height, "m"))
    } else {
        return;
    };
    let remedy = match table.block.is_some() {
        true => "lengths of `solid.block` in metres",
        false => "a mesh in metres; this one looks like millimetres: solid.scale = 0.001",
    };
    findings.add(true, "solid", found, remedy);
}

fn sleepers_through_walls(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(track) = &scene.track else { return };
    let sleeper = &track.sleeper;
    let step = sleeper.spacing.map_or(0.0, |s| s.si);
    let (mut deepest, mut through, mut cutting) = (0.0, None, None);
    let bottom = bed_height(job);
    for number in 0..sleeper.count {
        let mut centre = [sleeper.centre[0].si, sleeper.centre[1].si];
        centre[sleeper.along.axis()] += f64::from(number) * step;
        let half = [0, 1].map(|d| 0.5 * sleeper.size[d].si);
        let sleeper = Footprint { centre, half, bottom };
        for (k, wall) in scene.walls.iter().enumerate() {
            let moves = wall.velocity.is_some() || wall.servo.is_some() || wall.oscillation.is_some();
            let (WallKind::Plane, Some(point), Some(n), false) = (wall.kind, &wall.point, wall.normal, moves)
            else {
                continue;
            };
            let (point, normal) = (Vec3::from(vector(point)), Vec3::from(n));
            if let Some(behind) = sleeper.behind(&point, &normal).filter(|b| *b > deepest) {
                (deepest, through) = (behind, Some((k, number)));
            }
        }
        let walls = job.grains.iter().flat_map(|g| &g.walls.others);
        let others = scene.walls.iter().enumerate().filter(|(_, wall)| !is_plain(wall)).zip(walls);
        let mut cut = others.filter(|((_, w), _)| w.velocity.is_none() && w.body.is_none());
        let cut = cut.find(|(_, wall)| sleeper.is_cut_by(&wall.shape));
        cutting = cutting.or(cut.map(|((k, _), _)| (k, number)));
    }
    let which = |number: u32| match sleeper.count {
        1 => "the sleeper".into(),
        _ => format!("sleeper {}", number + 1),
    };
    let depth = through.map(|(wall, number)| (wall, number, format!("{} ", shown(deepest, "m"))));
    let found = depth.or(cutting.map(|(wall, number)| (wall, number, String::new())));
    if let Some((wall, number, depth)) = found {
        let found = format!("{} {depth}through walls.{wall}", which(number));
        findings.add(true, "track.sleeper.centre", found, "sleepers between the walls");
    }
}

/// Lowest expected height of the bed; −∞ if unknown [m].
fn bed_height(job: &Job) -> f64 {
    let filled = job.grains.iter().flat_map(|g| &g.groups.filled);
    filled.map(|bed| bed.floor + BED * bed.height).fold(f64::NEG_INFINITY, f64::max)
}

/// Grains are stacked and sleepers set down along z.
fn gravity_across(findings: &mut Findings, scene: &Scene) {
    let size = length(&scene.gravity);
    let along_z = scene.track.is_some() || scene.coupling.is_some() || scene.deposition.is_some();
    if size == 0.0 || !along_z || scene.gravity[2].si.abs() > ACROSS * size {
        return;
    }
    let axis = if scene.gravity[0].si.abs() > scene.gravity[1].si.abs() { 0 } else { 1 };
    let sign = if scene.gravity[axis].si < 0.0 { "-" } else { "+" };
    let mut what = vec!["grains"];
    what.extend(scene.track.is_some().then_some("sleepers"));
    what.extend(scene.coupling.is_some().then_some("coupling.direction"));
    let found = format!("{} m/s2 along {sign}{}", shown(size, ""), ["x", "y"][axis]);
    findings.add(true, "gravity", found, format!("along -z, as {} are", what.join(", ")));
}
