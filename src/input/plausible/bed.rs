//! Plausibility of grain positions.

use super::findings::{Findings, Usual, shown};
use super::grains::length;
use crate::model::Job;
use crate::model::grains::{inside_of, is_plain};
use crate::scene::Scene;
use crate::scene::walls::{Wall, WallKind};
use trackbed_dem::Vec3;

/// Tolerated fraction of misplaced grains.
const SHARE: f64 = 0.2;

/// Acceleration of gravity on the Earth [m/s²].
const EARTH: f64 = 9.81;
/// Usual acceleration of a centrifuge over gravity: centimetres give 100, millimetres 1000.
const CENTRIFUGE: f64 = 50.0;
/// Implausible acceleration over gravity.
const FAR: f64 = 500.0;

/// Highest plausible over expected height of a bed.
const ABOVE: f64 = 1.1;

/// Bounding box.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Lower corner [m].
    pub low: [f64; 3],
    /// Upper corner [m].
    pub high: [f64; 3],
}

impl Extent {
    fn of(points: impl Iterator<Item = [f64; 3]>) -> Option<Extent> {
        let none = Extent { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
        let all = points.fold(none, |e, p| Extent {
            low: [0, 1, 2].map(|d| e.low[d].min(p[d])),
            high: [0, 1, 2].map(|d| e.high[d].max(p[d])),
        });
        (all.low[0] <= all.high[0]).then_some(all)
    }

    /// Returns the longest side [m].
    pub fn longest(&self) -> f64 {
        (0..3).map(|d| self.high[d] - self.low[d]).fold(0.0, f64::max)
    }
}

/// Returns the initial extent of the grains.
pub fn of_grains(job: &Job) -> Option<Extent> {
    let bodies = &job.grains.as_ref()?.groups.bodies;
    Extent::of(bodies.iter().map(place))
}

/// Returns the extent of the solid.
pub fn of_solid(job: &Job) -> Option<Extent> {
    Extent::of(job.solid.as_ref()?.model.mesh().coordinates.iter().copied())
}

/// Returns the mean grain size, if given [m].
pub fn size(scene: &Scene) -> Option<f64> {
    let sizes = scene.grains.iter().filter_map(|g| g.size.as_ref().map(|s| 0.5 * (s[0].si + s[1].si)));
    sizes.reduce(f64::max)
}

/// Checks grain positions.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    gravity(findings, scene);
    held(findings, scene, job);
    behind_walls(findings, scene, job);
    beside_containers(findings, scene, job);
    in_the_solid(findings, scene, job);
    scales(findings, scene, job);
    settling(findings, scene, job);
    compaction(findings, scene);
}

fn gravity(findings: &mut Findings, scene: &Scene) {
    let size = length(&scene.gravity);
    if scene.gravity[2].si > 0.0 && scene.gravity[2].si > 0.5 * size {
        findings.add(
            true,
            "gravity",
            format!("{} m/s2 upwards", shown(scene.gravity[2].si, "")),
            "downwards: z is negative",
        );
    }
    if size > CENTRIFUGE * EARTH {
        let found = format!("{} m/s2, {:.0} times the gravity of the Earth", shown(size, ""), size / EARTH);
        let usual = format!("{EARTH} m/s2, in a centrifuge up to {CENTRIFUGE} times as much");
        findings.add(size > FAR * EARTH, "gravity", found, usual);
        return;
    }
    findings.weigh("gravity", size, Usual::or_zero(0.5, CENTRIFUGE * EARTH, "m/s2"));
}

/// `down`: unit vector.
fn carries(wall: &Wall, down: [f64; 3]) -> bool {
    match (wall.kind, wall.normal) {
        (WallKind::Plane, Some(n)) => dot(n, down) < -0.05 * dot(n, n).sqrt(),
        _ => true,
    }
}

fn held(findings: &mut Findings, scene: &Scene, job: &Job) {
    let weight = length(&scene.gravity);
    let free = scene.grains.iter().any(|g| g.prescribed_velocity.is_none());
    if weight == 0.0
        || !free
        || job.grains.is_none()
        || scene.wind.is_some()
        || scene.water.is_some()
        || scene.solid.is_some()
        || !scene.outlet.is_empty()
    {
        return;
    }
    let down = [0, 1, 2].map(|d| scene.gravity[d].si / weight);
    let carried = scene.walls.iter().any(|w| carries(w, down))
        || scene.grains.iter().any(|g| g.prescribed_velocity.is_some());
    if !carried {
        let found = "no floor: no wall and no solid below the grains";
        findings.add(true, "walls", found, "a floor that supports the grains");
    }
}

fn behind_walls(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(part) = &job.grains else { return };
    let bodies = &part.groups.bodies;
    for (k, wall) in scene.walls.iter().enumerate() {
        let moves = wall.velocity.is_some() || wall.servo.is_some() || wall.oscillation.is_some();
        let (WallKind::Plane, Some(point), Some(normal), false) =
            (wall.kind, &wall.point, wall.normal, moves)
        else {
            continue;
        };
        let behind = |b: &&trackbed_dem::BodyInput| {
            // Queued grains have no position.
            if b.absent {
                return false;
            }
            let x = place(b);
            dot([0, 1, 2].map(|d| x[d] - point[d].si), normal) < 0.0
        };
        let share = bodies.iter().filter(behind).count() as f64 / bodies.len().max(1) as f64;
        // Lids close after deposition.
        let lid = dot(normal, [0, 1, 2].map(|d| scene.gravity[d].si)) > 0.0;
        if share > SHARE && !lid {
            let found = format!("{:.0} % of the grains behind the plane", 100.0 * share);
            findings.add(true, format!("walls.{k}"), found, "all grains on the side of its normal");
        }
    }
}

fn beside_containers(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(part) = &job.grains else { return };
    let present = || part.groups.bodies.iter().filter(|b| !b.absent).map(place);
    let solid = scene.walls.iter().enumerate().filter(|(_, wall)| !is_plain(wall));
    for ((k, _), wall) in solid.zip(&part.walls.others) {
        let Some(side) = inside_of(&wall.shape).filter(|_| !wall.shape.open_end()) else { continue };
        let inside = |x: &[f64; 3]| side(&Vec3::from(*x)) == Some(true);
        let (all, held) = (present().count(), present().filter(inside).count());
        if held > 0 && held < all {
            let found = format!("{} of {all} grains outside it, the others inside", all - held);
            findings.add(
                true,
                format!("walls.{k}"),
                found,
                "all grains inside or all outside the closed container",
            );
        }
    }
}

fn in_the_solid(findings: &mut Findings, scene: &Scene, job: &Job) {
    let (Some(part), Some(solid), Some(_)) = (&job.grains, &job.solid, &scene.coupling) else { return };
    let Some(whole) = of_solid(job) else { return };
    let nodes = &solid.model.mesh().coordinates;
    for k in 0..scene.grains.len() {
        let places: Vec<[f64; 3]> =
            part.groups.bodies.iter().filter(|b| b.part as usize == k).map(place).collect();
        let Some(bed) = Extent::of(places.iter().copied()) else { continue };
        let key = format!("grains.{k}");
        if (0..2).any(|d| bed.low[d] > whole.high[d] || bed.high[d] < whole.low[d]) {
            findings.add(true, key, "all grains outside the plan of the solid", "grains above its surface");
            continue;
        }
        // Nodes below the bed.
        let margin = 0.05 * whole.longest();
        let below =
            |p: &&[f64; 3]| (0..2).all(|d| p[d] >= bed.low[d] - margin && p[d] <= bed.high[d] + margin);
        let top = nodes.iter().filter(below).map(|p| p[2]).fold(f64::NEG_INFINITY, f64::max);
        if solid.sleepers.is_some() || !top.is_finite() {
            continue;
        }
        let inside = places.iter().filter(|p| p[2] < top).count() as f64 / places.len() as f64;
        if inside > SHARE {
            let share = 100.0 * inside;
            let found =
                format!("{share:.0} % of the grains below the top of the solid at z = {}", shown(top, "m"));
            findings.add(true, key, found, "grains above its surface");
        } else if bed.low[2] - top > 5.0 * (bed.high[2] - bed.low[2]).max(0.2) {
            let found = format!("grains {} above the solid", shown(bed.low[2] - top, "m"));
            findings.add(true, key, found, "grains just above its surface");
        }
    }
}

fn place(body: &trackbed_dem::BodyInput) -> [f64; 3] {
    [body.position.x, body.position.y, body.position.z]
}

fn scales(findings: &mut Findings, scene: &Scene, job: &Job) {
    let solid = of_solid(job).map(|e| e.longest());
    if let Some(length) = solid {
        // Upper limit: see `geometry`.
        findings.weigh("solid", length.min(3000.0), Usual::new(1e-3, 3000.0, "m"));
    }
    if let (Some(length), Some(size)) = (solid, size(scene)) {
        let ratio = length / size;
        if !(1.0..=5000.0).contains(&ratio) {
            let found = format!("a mesh of {} for grains of {}", shown(length, "m"), shown(size, "m"));
            findings.add(true, "solid", found, "a mesh length of 5 to 1000 grains, in metres");
        }
    }
    if let (Some(bed), Some(size)) = (of_grains(job), size(scene)) {
        let ratio = bed.longest() / size;
        if ratio > 20_000.0 {
            let found = format!("a bed of {} for grains of {}", shown(bed.longest(), "m"), shown(size, "m"));
            findings.add(true, "grains", found, "a bed length of at most several thousand grains");
        }
    }
}

fn settling(findings: &mut Findings, scene: &Scene, job: &Job) {
    let Some(d) = &scene.deposition else { return };
    let weight = length(&scene.gravity);
    if weight == 0.0 {
        findings.add(true, "deposition", "settling without gravity", "gravity, or no settling");
        return;
    }
    findings.weigh_some(
        "deposition.settled_speed",
        d.settled_speed.map(|v| v.si),
        Usual::new(1e-5, 1.0, "m/s"),
    );
    findings.weigh_some("deposition.unbalanced_ratio", d.unbalanced_ratio, Usual::new(1e-6, 0.5, ""));
    findings.weigh_some("deposition.friction", d.friction, Usual::or_zero(1e-3, 1.5, ""));
    findings.weigh("deposition.local_damping", d.local_damping, Usual::or_zero(1e-3, 0.9, ""));
    findings.weigh("deposition.max_time", d.max_time.si, Usual::new(1e-3, 600.0, "s"));
    let Some(bed) = of_grains(job) else { return };
    // Upper grains fall through gaps, half of the height.
    let fall = ((bed.high[2] - bed.low[2]) / weight).sqrt();
    if d.layers <= 1 && d.max_time.si < 0.1 * fall {
        let found = format!("{}, for a fall of about {}", shown(d.max_time.si, "s"), shown(fall, "s"));
        findings.add(true, "deposition.max_time", found, "several times the time of fall");
    }
    if let Some(level) = d.level {
        let height = bed.high[2] - bed.low[2];
        if level.si <= bed.low[2] {
            let found = format!("{}, below all grains", shown(level.si, "m"));
            findings.add(true, "deposition.level", found, "a height within the bed");
        } else if level.si > bed.high[2] + 10.0 * height.max(0.01) {
            let found = format!("{}, far above all grains", shown(level.si, "m"));
            findings.add(true, "deposition.level", found, "a height within the bed");
        } else if let Some(top) = highest_top(job)
            && level.si > top
        {
            let found =
                format!("{}, a level above the bed (top at most {})", shown(level.si, "m"), shown(top, "m"));
            findings.add(false, "deposition.level", found, "a level below the top of the bed");
        }
    }
}

/// Highest expected centre of grains of a bed of filled groups alone [m].
fn highest_top(job: &Job) -> Option<f64> {
    let groups = &job.grains.as_ref()?.groups;
    let falls = |part: u32| groups.bodies.iter().any(|b| b.part == part && !b.absent);
    let falling =
        (0..groups.names.len() as u32).filter(|&part| falls(part) && !groups.fouling.contains(&part));
    let mut top = f64::NEG_INFINITY;
    for part in falling {
        let group = groups.filled.iter().find(|group| group.part == part)?;
        top = top.max(group.floor + ABOVE * group.height + 0.5 * group.size);
    }
    top.is_finite().then_some(top)
}

fn compaction(findings: &mut Findings, scene: &Scene) {
    for (k, c) in scene.compaction.iter().enumerate() {
        let key = |name: &str| format!("compaction.{k}.{name}");
        findings.weigh_some(key("frequency"), c.frequency.map(|v| v.si), Usual::new(0.1, 300.0, "Hz"));
        findings.weigh_some(key("amplitude"), c.amplitude.map(|v| v.si), Usual::new(1e-6, 0.1, "m"));
        findings.weigh_some(key("force"), c.force.map(|v| v.si), Usual::new(0.1, 1e7, "N"));
        findings.weigh_some(key("speed"), c.speed.map(|v| v.si.abs()), Usual::new(1e-5, 10.0, "m/s"));
        if let Some(p) = &c.plate {
            findings.weigh(key("plate.mass"), p.mass.si, Usual::new(1e-3, 1e5, "kg"));
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
