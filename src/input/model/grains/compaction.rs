//! `[[compaction]]` resolved.

use super::check::{find, region};
use super::deposition::{DepositionPlan, SETTLED_SPEED, SOFTER};
use super::groups::GroupsPart;
use super::tines::{self, TinesPlan};
use super::walls::{WallsPart, is_plain};
use crate::scene::compaction::{Compaction, CompactionKind};
use crate::scene::grains::GrainShape;
use crate::scene::track::Sleeper;
use crate::scene::units::vector;
use crate::scene::walls::WallKind;
use crate::scene::{Scene, SceneError, Table, kinds};
use trackbed_dem::measure::BoxRegion;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// Default time limit of rest [s].
const REST: f64 = 0.2;

/// Compaction stage.
#[derive(Clone)]
pub struct CompactionPlan {
    /// Type of compaction.
    pub press: Press,
    /// Box in which porosity is measured.
    pub region: BoxRegion,
    /// Friction, damping and rest criterion.
    pub rest: DepositionPlan,
}

/// Type of compaction.
#[derive(Clone)]
pub enum Press {
    /// Planes oscillate along a unit vector.
    Vibration {
        /// Planes.
        planes: Vec<usize>,
        /// Displacement amplitude [m].
        amplitude: Vec3,
        /// Frequency [Hz].
        frequency: f64,
        /// Cycles.
        cycles: u32,
    },
    /// A platen loads several positions.
    Tamping {
        /// Platen; its height is set when it is placed.
        plate: BodyInput,
        /// Half edge lengths [m].
        half: [f64; 3],
        /// Centres [m].
        at: Vec<[f64; 2]>,
        /// Largest force [N].
        force: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Cycles per position.
        cycles: u32,
    },
    /// Sleepers are placed if necessary and loaded.
    Bedding {
        /// Largest force per sleeper [N].
        force: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Cycles.
        cycles: u32,
    },
    /// Queued grains are dropped.
    Pouring {
        /// Groups.
        parts: Vec<u32>,
        /// Number of layers.
        layers: u32,
        /// Height above which grains are then removed [m].
        level: Option<f64>,
    },
    /// A plane moves inwards.
    Squeeze {
        /// Plane.
        plane: usize,
        /// Velocity [m/s].
        velocity: Vec3,
        /// Porosity at which the plane stops.
        porosity: f64,
        /// Longest travel [m].
        max_travel: f64,
    },
    /// Tines tamp each sleeper.
    Tines(TinesPlan),
    /// Sleepers are loaded and shaken across the track.
    Stabilizing {
        /// Vertical force per sleeper [N].
        force: f64,
        /// Amplitude of the horizontal force per sleeper [N].
        sway: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Cycles.
        cycles: u32,
    },
}

impl Press {
    /// Returns the scene name of the type.
    pub fn name(&self) -> &'static str {
        let kind = match self {
            Press::Vibration { .. } => CompactionKind::Vibration,
            Press::Tamping { .. } => CompactionKind::Tamping,
            Press::Squeeze { .. } => CompactionKind::Squeeze,
            Press::Bedding { .. } => CompactionKind::Bedding,
            Press::Pouring { .. } => CompactionKind::Pouring,
            Press::Tines(_) => CompactionKind::Tines,
            Press::Stabilizing { .. } => CompactionKind::Stabilizing,
        };
        kind.name()
    }

    /// Whether it acts on sleepers, which it sets down if necessary.
    pub fn needs_sleepers(&self) -> bool {
        matches!(self, Press::Bedding { .. } | Press::Tines(_) | Press::Stabilizing { .. })
    }
}

/// Resolves the stages; platen shapes are added to the group shapes.
pub(super) fn build(
    scene: &Table<Scene>,
    settled: Option<&DepositionPlan>,
    walls: &WallsPart,
    groups: &mut GroupsPart,
) -> Result<Vec<CompactionPlan>, SceneError> {
    let mut plans = Vec::new();
    for c in scene.rows("compaction", &scene.compaction) {
        refuse_idle_keys(&c)?;
        c.check("friction", c.friction, |f| f >= 0.0, "0 or more")?;
        let factor = c.check("stiffness_factor", c.stiffness_factor, |f| f > 0.0 && f <= 1.0, SOFTER)?;
        c.check("local_damping", c.local_damping, |a| (0.0..1.0).contains(&a), "0 or more, below 1")?;
        c.check("rest", c.rest, |t| t > 0.0, "a time above 0")?;
        let press = match c.kind {
            CompactionKind::Vibration => vibration(scene, &c)?,
            CompactionKind::Tamping => tamping(scene, &c, groups)?,
            CompactionKind::Squeeze => squeeze(scene, &c, walls)?,
            CompactionKind::Bedding => bedding(scene, &c)?,
            CompactionKind::Pouring => pouring(scene, &c, groups)?,
            CompactionKind::Tines => Press::Tines(tines::build(scene, &c)?),
            CompactionKind::Stabilizing => stabilizing(scene, &c)?,
        };
        plans.push(CompactionPlan {
            press,
            region: region(&c, "region", &c.region)?,
            rest: DepositionPlan {
                max_time: c.rest.map_or(REST, |t| t.si),
                settled_speed: settled.map_or(SETTLED_SPEED, |d| d.settled_speed),
                unbalanced_ratio: settled.and_then(|d| d.unbalanced_ratio),
                layers: 1,
                level: None,
                friction: c.friction,
                stiffness_factor: factor.unwrap_or(1.0),
                local_damping: c.local_damping,
            },
        });
    }
    Ok(plans)
}

fn refuse_idle_keys(c: &Table<Compaction>) -> Result<(), SceneError> {
    use CompactionKind::{Bedding, Pouring, Squeeze, Stabilizing, Tamping, Tines, Vibration};
    let swings: &[CompactionKind] = &[Vibration, Tamping, Bedding, Stabilizing];
    let shaken = &[swings, &[Tines]].concat()[..];
    let keys = [
        ("walls", c.walls.is_some(), &[Vibration][..]),
        ("direction", c.direction.is_some(), &[Vibration]),
        ("amplitude", c.amplitude.is_some(), &[Vibration]),
        ("frequency", c.frequency.is_some(), shaken),
        ("cycles", c.cycles.is_some(), swings),
        ("plate", c.plate.is_some(), &[Tamping]),
        ("force", c.force.is_some(), &[Tamping, Bedding, Stabilizing]),
        ("sway", c.sway.is_some(), &[Stabilizing]),
        ("tines", c.tines.is_some(), &[Tines]),
        ("at", c.at.is_some(), &[Tamping]),
        ("wall", c.wall.is_some(), &[Squeeze]),
        ("speed", c.speed.is_some(), &[Squeeze]),
        ("porosity", c.porosity.is_some(), &[Squeeze]),
        ("max_travel", c.max_travel.is_some(), &[Squeeze]),
        ("groups", c.groups.is_some(), &[Pouring]),
        ("layers", c.layers.is_some(), &[Pouring]),
        ("level", c.level.is_some(), &[Pouring]),
    ];
    match keys.into_iter().find(|(_, present, of)| *present && !of.contains(&c.kind)) {
        Some((key, _, of)) => Err(c.no_effect(key, kinds(of))),
        None => Ok(()),
    }
}

fn swing(c: &Table<Compaction>) -> Result<(f64, u32), SceneError> {
    let frequency = c.need("frequency", c.frequency, "a frequency")?.si;
    c.check("frequency", frequency, |f| f > 0.0, "above 0")?;
    let cycles = c.need("cycles", c.cycles, "a number of cycles")?;
    c.check("cycles", cycles, |n| n >= 1.0, "1 or more")?;
    Ok((frequency, cycles))
}

fn vibration(scene: &Table<Scene>, c: &Table<Compaction>) -> Result<Press, SceneError> {
    let (frequency, cycles) = swing(c)?;
    let amplitude = c.need("amplitude", c.amplitude, "an amplitude")?.si;
    c.check("amplitude", amplitude, |a| a > 0.0, "above 0")?;
    let direction = Vec3::from(c.direction.unwrap_or([0.0, 0.0, 1.0]));
    let length = direction.norm();
    c.check("direction", length, |l| l > 0.0, "a vector that is not null")?;
    let planes = match &c.walls {
        Some(walls) => walls.iter().map(|w| plane(scene, c, "walls", *w)).collect::<Result<_, _>>()?,
        None => (0..scene.walls.iter().filter(|w| w.kind == WallKind::Plane).count()).collect::<Vec<_>>(),
    };
    if planes.is_empty() {
        return Err(c.error("walls", "none", "at least one plane that moves"));
    }
    Ok(Press::Vibration { planes, amplitude: direction * (amplitude / length), frequency, cycles })
}

fn tamping(
    scene: &Table<Scene>,
    c: &Table<Compaction>,
    groups: &mut GroupsPart,
) -> Result<Press, SceneError> {
    let (frequency, cycles) = swing(c)?;
    let plate = c.need("plate", c.optional("plate", &c.plate), "the plate that presses")?;
    let half = vector(&plate.size).map(|l| 0.5 * l);
    for l in half {
        plate.check("size", l, |l| l > 0.0, "lengths above 0")?;
    }
    plate.check("mass", plate.mass, |m| m > 0.0, "a mass above 0")?;
    let force = c.need("force", c.force, "the largest force")?.si;
    c.check("force", force, |f| f > 0.0, "above 0")?;
    let at = c.need("at", c.at.as_ref(), "places of the plate")?;
    if at.is_empty() {
        return Err(c.error("at", "none", "at least one position"));
    }
    let plate = BodyInput {
        shape: groups.add_shape(Shape::Box { half }),
        material: find(scene, &plate, "material", &plate.material)?,
        part: u32::MAX,
        fixed: [true, true, false, true, true, true],
        mass: Some(plate.mass.si),
        ..BodyInput::default()
    };
    let at = at.iter().map(|p| [p[0].si, p[1].si]).collect();
    Ok(Press::Tamping { plate, half, at, force, frequency, cycles })
}

fn bedding(scene: &Table<Scene>, c: &Table<Compaction>) -> Result<Press, SceneError> {
    rigid_sleepers(scene, c)?;
    let (frequency, cycles) = swing(c)?;
    let force = c.need("force", c.force, "the largest force on a sleeper")?.si;
    c.check("force", force, |f| f > 0.0, "above 0")?;
    Ok(Press::Bedding { force, frequency, cycles })
}

fn stabilizing(scene: &Table<Scene>, c: &Table<Compaction>) -> Result<Press, SceneError> {
    rigid_sleepers(scene, c)?;
    let (frequency, cycles) = swing(c)?;
    let force = c.need("force", c.force, "the vertical force on a sleeper")?.si;
    c.check("force", force, |f| f > 0.0, "above 0")?;
    let sway = c.need("sway", c.sway, "the amplitude of the horizontal force on a sleeper")?.si;
    c.check("sway", sway, |f| f > 0.0, "above 0")?;
    Ok(Press::Stabilizing { force, sway, frequency, cycles })
}

/// Returns the sleepers, which a stage acts on.
pub(super) fn rigid_sleepers<'s>(
    scene: &'s Table<Scene>,
    c: &Table<Compaction>,
) -> Result<&'s Sleeper, SceneError> {
    match &scene.track {
        Some(track) if track.sleeper.mesh.is_none() => Ok(&track.sleeper),
        _ => {
            let kind = c.kind.name();
            Err(c.error("kind", format!("\"{kind}\""), "rigid sleepers ([track.sleeper])"))
        }
    }
}

fn pouring(
    scene: &Table<Scene>,
    c: &Table<Compaction>,
    groups: &mut GroupsPart,
) -> Result<Press, SceneError> {
    let names = c.need("groups", c.groups.as_ref(), "names of the groups that are poured")?;
    let mut parts = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let key = format!("groups.{k}");
        let Some(part) = groups.names.iter().position(|n| n == name) else {
            return Err(c.error(&key, format!("\"{name}\""), "the name of a group in [[grains]]"));
        };
        let bonded = scene.grains[part].shape == GrainShape::Bonded;
        let part = part as u32;
        let mut own = groups.bodies.iter_mut().filter(|b| b.part == part).peekable();
        if bonded || own.peek().is_none_or(|b| b.absent) || groups.moving.iter().any(|m| m.part == part) {
            let expected = "a group of grains that are not bonded, at rest, and that nothing else lets in";
            return Err(c.error(&key, format!("\"{name}\""), expected));
        }
        own.for_each(|b| b.absent = true);
        parts.push(part);
    }
    if parts.is_empty() {
        return Err(c.error("groups", "none", "at least one group"));
    }
    let layers = c.layers.unwrap_or(1);
    c.check("layers", layers, |n| (1.0..=1000.0).contains(&n), "1 to 1000")?;
    Ok(Press::Pouring { parts, layers, level: c.level.map(|l| l.si) })
}

fn squeeze(scene: &Table<Scene>, c: &Table<Compaction>, walls: &WallsPart) -> Result<Press, SceneError> {
    let wall = c.need("wall", c.wall, "the number of the plane that moves")?;
    let plane = plane(scene, c, "wall", wall)?;
    let normal = walls.planes[plane].normal.normalize();
    if normal.iter().filter(|n| n.abs() > 1e-12).count() != 1 {
        let expected = "a plane across an axis, for `region` is cut off at it";
        return Err(c.error("wall", "a plane that is inclined", expected));
    }
    let speed = c.need("speed", c.speed, "a speed")?.si;
    c.check("speed", speed, |v| v > 0.0, "above 0")?;
    let porosity = c.need("porosity", c.porosity, "a porosity")?;
    c.check("porosity", porosity, |n| n > 0.0 && n < 1.0, "above 0, below 1")?;
    let axis = normal.iamax();
    let width = c.region[1][axis].si - c.region[0][axis].si;
    let max_travel = c.max_travel.map_or(0.5 * width, |l| l.si);
    c.check("max_travel", max_travel, |l| l > 0.0, "above 0")?;
    Ok(Press::Squeeze { plane, velocity: normal * speed, porosity, max_travel })
}

/// Converts an index among walls to planes.
fn plane(scene: &Table<Scene>, c: &Table<Compaction>, key: &str, wall: usize) -> Result<usize, SceneError> {
    match scene.walls.get(wall) {
        Some(it) if is_plain(it) => Ok(scene.walls[..wall].iter().filter(|w| is_plain(w)).count()),
        Some(it) if it.kind == WallKind::Plane => {
            let expected = "a plane without `servo`, `body`, `oscillation`, `angular_velocity` and `record`";
            Err(c.error(key, format!("{wall}, a plane with other keys"), expected))
        }
        _ => Err(c.error(key, wall.to_string(), "the number of a plane in [[walls]], counted from 0")),
    }
}
