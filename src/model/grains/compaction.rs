//! `[[compaction]]` resolved.

use super::check::{check, find, region};
use super::deposition::{DepositionPlan, SETTLED_SPEED};
use super::groups::GroupsPart;
use super::walls::WallsPart;
use crate::scene::compaction::{Compaction, CompactionKind};
use crate::scene::units::vector;
use crate::scene::walls::WallKind;
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::measure::BoxRegion;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// Longest time of coming to rest, unless the scene says otherwise [s].
const REST: f64 = 0.2;

/// One stage of compaction.
#[derive(Clone)]
pub struct CompactionPlan {
    /// What is done.
    pub press: Press,
    /// Box whose porosity is measured.
    pub region: BoxRegion,
    /// Friction and damping of the stage, its longest time of rest, and what rest is.
    pub rest: DepositionPlan,
}

/// How a bed is pressed or shaken.
#[derive(Clone)]
pub enum Press {
    /// Planes swing along a unit vector.
    Vibration {
        /// The planes.
        planes: Vec<usize>,
        /// Displacement at the crest [m].
        amplitude: Vec3,
        /// Frequency [Hz].
        frequency: f64,
        /// Number of cycles.
        cycles: u32,
    },
    /// A plate presses at several places.
    Tamping {
        /// The plate; its height is found when it is set down.
        plate: BodyInput,
        /// Half edge lengths [m].
        half: [f64; 3],
        /// Places of its centre [m].
        at: Vec<[f64; 2]>,
        /// Largest force [N].
        force: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Number of cycles at each place.
        cycles: u32,
    },
    /// A plane moves in.
    Squeeze {
        /// The plane.
        plane: usize,
        /// Velocity [m/s].
        velocity: Vec3,
        /// Porosity at which it stops.
        porosity: f64,
        /// Longest way [m].
        max_travel: f64,
    },
}

impl Press {
    /// Name of the kind, as in a scene.
    pub fn name(&self) -> &'static str {
        match self {
            Press::Vibration { .. } => "vibration",
            Press::Tamping { .. } => "tamping",
            Press::Squeeze { .. } => "squeeze",
        }
    }
}

/// The stages of a scene; the shape of a plate is added to those of the groups.
pub(super) fn build(
    document: &Document,
    scene: &Scene,
    settled: Option<&DepositionPlan>,
    walls: &WallsPart,
    groups: &mut GroupsPart,
) -> Result<Vec<CompactionPlan>, SceneError> {
    let mut plans = Vec::new();
    for (i, c) in scene.compaction.iter().enumerate() {
        let key = |k: &str| format!("compaction.{i}.{k}");
        refuse_idle_keys(document, i, c)?;
        check(document, &key("friction"), c.friction, |f| f >= 0.0, "0 or more")?;
        let damping = Some(c.local_damping);
        check(document, &key("local_damping"), damping, |a| (0.0..1.0).contains(&a), "0 or more, below 1")?;
        check(document, &key("rest"), c.rest.map(|t| t.si), |t| t > 0.0, "a time above 0")?;
        let press = match c.kind {
            CompactionKind::Vibration => vibration(document, scene, i, c)?,
            CompactionKind::Tamping => tamping(document, scene, i, c, groups)?,
            CompactionKind::Squeeze => squeeze(document, scene, i, c, walls)?,
        };
        plans.push(CompactionPlan {
            press,
            region: region(document, &key("region"), &c.region)?,
            rest: DepositionPlan {
                max_time: c.rest.map_or(REST, |t| t.si),
                settled_speed: settled.map_or(SETTLED_SPEED, |d| d.settled_speed),
                unbalanced_ratio: settled.and_then(|d| d.unbalanced_ratio),
                layers: 1,
                level: None,
                friction: c.friction,
                local_damping: c.local_damping,
            },
        });
    }
    Ok(plans)
}

fn refuse_idle_keys(document: &Document, index: usize, c: &Compaction) -> Result<(), SceneError> {
    use CompactionKind::{Squeeze, Tamping, Vibration};
    let swings: &[CompactionKind] = &[Vibration, Tamping];
    for (k, present, kinds) in [
        ("walls", c.walls.is_some(), &[Vibration][..]),
        ("direction", c.direction.is_some(), &[Vibration]),
        ("amplitude", c.amplitude.is_some(), &[Vibration]),
        ("frequency", c.frequency.is_some(), swings),
        ("cycles", c.cycles.is_some(), swings),
        ("plate", c.plate.is_some(), &[Tamping]),
        ("force", c.force.is_some(), &[Tamping]),
        ("at", c.at.is_some(), &[Tamping]),
        ("wall", c.wall.is_some(), &[Squeeze]),
        ("speed", c.speed.is_some(), &[Squeeze]),
        ("porosity", c.porosity.is_some(), &[Squeeze]),
        ("max_travel", c.max_travel.is_some(), &[Squeeze]),
    ] {
        if present && !kinds.contains(&c.kind) {
            let key = format!("compaction.{index}.{k}");
            return Err(document.error(&key, "a value", "no such key for this kind of compaction"));
        }
    }
    Ok(())
}

/// A value that this kind cannot do without.
fn needed<T>(
    document: &Document,
    index: usize,
    key: &str,
    value: Option<T>,
    what: &str,
) -> Result<T, SceneError> {
    value.ok_or_else(|| document.error(&format!("compaction.{index}.{key}"), "nothing", what))
}

fn swing(document: &Document, index: usize, c: &Compaction) -> Result<(f64, u32), SceneError> {
    let frequency = needed(document, index, "frequency", c.frequency, "a frequency")?.si;
    check(document, &format!("compaction.{index}.frequency"), Some(frequency), |f| f > 0.0, "above 0")?;
    let cycles = needed(document, index, "cycles", c.cycles, "a number of cycles")?;
    check(
        document,
        &format!("compaction.{index}.cycles"),
        Some(f64::from(cycles)),
        |n| n >= 1.0,
        "1 or more",
    )?;
    Ok((frequency, cycles))
}

fn vibration(document: &Document, scene: &Scene, index: usize, c: &Compaction) -> Result<Press, SceneError> {
    let key = |k: &str| format!("compaction.{index}.{k}");
    let (frequency, cycles) = swing(document, index, c)?;
    let amplitude = needed(document, index, "amplitude", c.amplitude, "an amplitude")?.si;
    check(document, &key("amplitude"), Some(amplitude), |a| a > 0.0, "above 0")?;
    let direction = Vec3::from(c.direction.unwrap_or([0.0, 0.0, 1.0]));
    let length = direction.norm();
    check(document, &key("direction"), Some(length), |l| l > 0.0, "a vector that is not null")?;
    let planes = match &c.walls {
        Some(walls) => {
            walls.iter().map(|w| plane(document, scene, &key("walls"), *w)).collect::<Result<_, _>>()?
        }
        None => (0..scene.walls.iter().filter(|w| w.kind == WallKind::Plane).count()).collect::<Vec<_>>(),
    };
    if planes.is_empty() {
        return Err(document.error(&key("walls"), "none", "at least one plane that moves"));
    }
    Ok(Press::Vibration { planes, amplitude: direction * (amplitude / length), frequency, cycles })
}

fn tamping(
    document: &Document,
    scene: &Scene,
    index: usize,
    c: &Compaction,
    groups: &mut GroupsPart,
) -> Result<Press, SceneError> {
    let key = |k: &str| format!("compaction.{index}.{k}");
    let (frequency, cycles) = swing(document, index, c)?;
    let plate = needed(document, index, "plate", c.plate.as_ref(), "the plate that presses")?;
    let half = vector(&plate.size).map(|l| 0.5 * l);
    for l in half {
        check(document, &key("plate.size"), Some(l), |l| l > 0.0, "lengths above 0")?;
    }
    check(document, &key("plate.mass"), Some(plate.mass.si), |m| m > 0.0, "a mass above 0")?;
    let force = needed(document, index, "force", c.force, "the largest force")?.si;
    check(document, &key("force"), Some(force), |f| f > 0.0, "above 0")?;
    let at = needed(document, index, "at", c.at.as_ref(), "places of the plate")?;
    if at.is_empty() {
        return Err(document.error(&key("at"), "none", "at least one place"));
    }
    let plate = BodyInput {
        shape: groups.add_shape(Shape::Box { half }),
        material: find(document, scene, &key("plate.material"), &plate.material)?,
        part: u32::MAX,
        fixed: [true, true, false, true, true, true],
        mass: Some(plate.mass.si),
        ..BodyInput::default()
    };
    let at = at.iter().map(|p| [p[0].si, p[1].si]).collect();
    Ok(Press::Tamping { plate, half, at, force, frequency, cycles })
}

fn squeeze(
    document: &Document,
    scene: &Scene,
    index: usize,
    c: &Compaction,
    walls: &WallsPart,
) -> Result<Press, SceneError> {
    let key = |k: &str| format!("compaction.{index}.{k}");
    let wall = needed(document, index, "wall", c.wall, "the number of the plane that moves")?;
    let plane = plane(document, scene, &key("wall"), wall)?;
    let normal = walls.planes[plane].normal.normalize();
    if normal.iter().filter(|n| n.abs() > 1e-12).count() != 1 {
        let expected = "a plane across an axis, for `region` is cut off at it";
        return Err(document.error(&key("wall"), "a plane that is inclined", expected));
    }
    let speed = needed(document, index, "speed", c.speed, "a speed")?.si;
    check(document, &key("speed"), Some(speed), |v| v > 0.0, "above 0")?;
    let porosity = needed(document, index, "porosity", c.porosity, "a porosity")?;
    check(document, &key("porosity"), Some(porosity), |n| n > 0.0 && n < 1.0, "above 0, below 1")?;
    let axis = normal.iamax();
    let width = c.region[1][axis].si - c.region[0][axis].si;
    let max_travel = c.max_travel.map_or(0.5 * width, |l| l.si);
    check(document, &key("max_travel"), Some(max_travel), |l| l > 0.0, "above 0")?;
    Ok(Press::Squeeze { plane, velocity: normal * speed, porosity, max_travel })
}

/// Number of a plane among the planes, from its number among the walls.
fn plane(document: &Document, scene: &Scene, key: &str, wall: usize) -> Result<usize, SceneError> {
    let is_plane = |w: &&crate::scene::walls::Wall| w.kind == WallKind::Plane;
    if scene.walls.get(wall).as_ref().is_some_and(is_plane) {
        return Ok(scene.walls[..wall].iter().filter(is_plane).count());
    }
    Err(document.error(key, wall.to_string(), "the number of a plane in [[walls]], counted from 0"))
}
