//! The grains of a scene: materials, shapes, bodies, walls, sleeper.

mod after;
mod bonded;
mod bonds;
mod compaction;
mod flow;
mod groups;
mod materials;
mod periodic;
mod regions;
mod sizes;
mod sources;
mod track;
pub mod walls;

use super::tables::Grading;
use crate::failure::Failure;
use crate::scene::deposition::Deposition;
use crate::scene::{Document, Scene, SceneError, TimeControl};
pub use after::AfterPlan;
pub use bonds::{BondPart, check_joined};
pub use compaction::{CompactionPlan, Measure, Press, Radial};
pub use flow::{FlowPlan, InletPlan, InletRate, OutletPlan, OutletRegion};
use trackbed_coupling::track::CyclicLoad;
use trackbed_coupling::track::push::PushPlan;
use trackbed_coupling::track::rail::RailInput;
use trackbed_coupling::track::{SleeperRow, TrackInput};
use trackbed_dem::insert::container::Container;
use trackbed_dem::insert::grow::Growth;
use trackbed_dem::shape::Shape;
use trackbed_dem::{
    BodyInput, LocalDamping, Material, Model, ModelError, ModelInput, PairOverride, Plane, TimeStep, Vec3,
    WallInput, WallShape,
};

/// Root-mean-square speed below which a bed counts as settled, unless the scene says otherwise [m/s].
const SETTLED_SPEED: f64 = 5e-3;

/// The grains, ready to build models of.
#[derive(Clone)]
pub struct GrainsPart {
    materials: Vec<Material>,
    contacts: Vec<PairOverride>,
    shapes: Vec<Shape>,
    planes: Vec<Plane>,
    walls: Vec<WallInput>,
    recorded: Vec<walls::Recorded>,
    surface_material: Option<usize>,
    /// First face of meshed sleepers in the solid's surface, and their material.
    other_surface: Option<(u32, usize)>,
    gravity: Vec3,
    time_step: TimeStep,
    impact_speed: Option<f64>,
    periodic: [Option<[f64; 2]>; 3],
    /// All grains where they start.
    pub bodies: Vec<BodyInput>,
    /// Names of the groups; rigid sleepers are the group after the last.
    pub parts: Vec<String>,
    /// First shape of each group; a stone's number in its library is its shape less that.
    pub first_shape: Vec<usize>,
    /// Groups whose sizes follow a sieve curve.
    pub graded: Vec<GradedGroup>,
    /// Groups that grow to their size before anything else.
    pub growths: Vec<GrowthPlan>,
    /// Bonds between grains.
    pub bonds: BondPart,
    /// Groups of prescribed motion.
    pub moving: Vec<Moving>,
    /// Groups that foul the bed.
    pub fouling: Vec<u32>,
    /// Groups whose mean place and force are recorded.
    pub recorded_groups: Vec<u32>,
    /// Materials that grains consist of.
    grain_materials: Vec<usize>,
    material_names: Vec<String>,
    /// Settling before the run proper.
    pub deposition: Option<DepositionPlan>,
    /// Compaction of the settled bed.
    pub compaction: Vec<CompactionPlan>,
    /// Boxes that are measured.
    pub measures: Vec<Measure>,
    /// The sleepers; rigid ones are the last bodies of the run proper.
    pub sleeper: Option<SleeperPlan>,
    /// The load on them.
    pub load: Option<CyclicLoad>,
    /// Jumps over cycles, push at the end.
    pub after: AfterPlan,
    /// The rail, where it is a beam; one on each seat.
    pub rail: Option<RailInput>,
    /// Inlets and outlets.
    pub flow: Option<FlowPlan>,
}

/// A group of prescribed motion.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// Its number.
    pub part: u32,
    /// Velocity [m/s].
    pub velocity: Vec3,
}

/// Settling before the run proper.
#[derive(Clone, Debug)]
pub struct DepositionPlan {
    /// Longest time [s].
    pub max_time: f64,
    /// Root-mean-square speed below which the bed counts as settled [m/s].
    pub settled_speed: f64,
    /// Ratio of unbalanced to contact forces below which it does.
    pub unbalanced_ratio: Option<f64>,
    /// Parts that the grains are dropped in.
    pub layers: u32,
    /// Height above which grains are taken away afterwards [m].
    pub level: Option<f64>,
    friction: Option<f64>,
    local_damping: f64,
}

impl DepositionPlan {
    /// Whether a bed of this root-mean-square speed [m/s] counts as settled.
    pub fn settled(&self, speed: f64, model: &Model, state: &trackbed_dem::State) -> bool {
        use trackbed_dem::measure::{contacts, unbalanced_ratio};
        speed < self.settled_speed
            && self
                .unbalanced_ratio
                .is_none_or(|most| unbalanced_ratio(model, state, &contacts(model, state)) < most)
    }
}

/// A group whose sizes follow a sieve curve.
#[derive(Clone)]
pub struct GradedGroup {
    /// Its number.
    pub part: u32,
    /// Its name.
    pub name: String,
    /// Limits and curve.
    pub grading: Grading,
}

/// Grains that grow to their size in a container.
#[derive(Clone)]
pub struct GrowthPlan {
    /// Name of the group.
    pub group: String,
    /// Bodies that grow.
    pub bodies: std::ops::Range<usize>,
    /// Where.
    pub container: Container,
    /// How.
    pub how: Growth,
}

/// Sleepers among the grains.
#[derive(Clone, Debug)]
pub struct SleeperPlan {
    shape: usize,
    material: usize,
    /// The sleepers.
    pub row: SleeperRow,
}

impl GrainsPart {
    /// The model in which filled grains settle: no sleeper, friction and damping of the deposition.
    pub fn deposition_input(&self, plan: &DepositionPlan) -> ModelInput {
        let mut contacts = self.contacts.clone();
        if let Some(friction) = plan.friction {
            for (i, &a) in self.grain_materials.iter().enumerate() {
                for &b in &self.grain_materials[i..] {
                    let same = |c: &&mut PairOverride| (c.a.min(c.b), c.a.max(c.b)) == (a.min(b), a.max(b));
                    if let Some(c) = contacts.iter_mut().find(same) {
                        c.friction = Some(friction);
                    } else {
                        contacts.push(PairOverride {
                            a,
                            b,
                            friction: Some(friction),
                            ..PairOverride::default()
                        });
                    }
                }
            }
        }
        let damping = (plan.local_damping > 0.0).then_some(LocalDamping { factor: plan.local_damping });
        // Sleepers are not there yet.
        let alone = ModelInput { other_surface: None, ..self.input(self.bodies.clone()) };
        let mut input = ModelInput { contacts, damping, ..alone };
        // Walls wait for the run proper, which starts with them in their first place; driven walls and rigid bodies come
        // in only then.
        input.planes.iter_mut().for_each(|p| p.velocity = Vec3::zeros());
        input.walls.retain(|w| w.servo.is_none() && w.body.is_none());
        input.walls.iter_mut().for_each(|w| *w = w.at_rest());
        for moving in &self.moving {
            let grip = input.bodies.iter_mut().filter(|b| b.part == moving.part);
            grip.for_each(|b| b.velocity = Vec3::zeros());
        }
        self.bonds.add_stones_to(&mut input);
        input
    }

    /// All materials, and what single pairs of them have of their own.
    pub fn contact_constants(&self) -> (Vec<Material>, Vec<PairOverride>) {
        (self.materials.clone(), self.contacts.clone())
    }

    /// Stiffness, density and the like of the material of a body.
    pub fn material(&self, body: &BodyInput) -> Material {
        self.materials[body.material]
    }

    /// Shapes, at scale 1.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// Radius about its centre of mass that holds a body [m].
    pub fn reach(&self, body: &BodyInput) -> f64 {
        body.scale * groups::bounding_radius(&self.shapes[body.shape])
    }

    /// Puts a plane elsewhere [m].
    pub fn place_plane(&mut self, plane: usize, point: Vec3) {
        self.planes[plane].point = point;
    }

    /// Adds a shape; returns its number.
    pub fn add_shape(&mut self, shape: Shape) -> usize {
        self.shapes.push(shape);
        self.shapes.len() - 1
    }

    /// The model of the run proper with the given bodies.
    pub fn input(&self, mut bodies: Vec<BodyInput>) -> ModelInput {
        for moving in &self.moving {
            for body in bodies.iter_mut().filter(|b| b.part == moving.part) {
                (body.velocity, body.fixed) = (moving.velocity, [true; 6]);
            }
        }
        let mut input = ModelInput {
            materials: self.materials.clone(),
            contacts: self.contacts.clone(),
            shapes: self.shapes.clone(),
            bodies,
            planes: self.planes.clone(),
            triangles: Vec::new(),
            walls: self.walls.clone(),
            surface_material: self.surface_material,
            other_surface: self.other_surface,
            gravity: self.gravity,
            time_step: self.time_step,
            impact_speed: self.impact_speed,
            skin: None,
            damping: None,
            periodic: self.periodic,
            ..ModelInput::default()
        };
        self.bonds.add_to(&mut input);
        input
    }

    /// Whether the box is periodic along an axis.
    pub fn is_periodic(&self) -> bool {
        self.periodic.iter().any(Option::is_some)
    }

    /// Density of a material [kg/m³].
    fn density(&self, material: usize) -> f64 {
        self.materials[material].density
    }

    /// Materials of grains that may touch a solid, with their names. A rigid sleeper touches grains only.
    pub fn touching_materials(&self) -> impl Iterator<Item = (usize, String)> {
        self.grain_materials.iter().map(|&m| (m, self.material_names[m].clone()))
    }

    /// Masses of the lightest and the heaviest grain of a material in a model of these grains [kg]; none without any.
    pub fn masses_of(&self, model: &Model, material: usize) -> Option<[f64; 2]> {
        let grains = self.parts.len() as u32 - u32::from(self.rigid_sleeper().is_some());
        let own = (0..model.body_count())
            .filter(|&b| model.part(b) < grains && model.material(b) == material)
            .map(|b| model.mass(b));
        let ends = own.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], m| [low.min(m), high.max(m)]);
        (ends[1] > 0.0).then_some(ends)
    }

    /// Mean bounding radius of the grains [m].
    pub fn mean_reach(&self) -> f64 {
        self.bodies.iter().map(|b| self.reach(b)).sum::<f64>() / self.bodies.len().max(1) as f64
    }

    /// Planes, for the pictures of the walls.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Walls other than plain planes, for the pictures.
    pub fn walls(&self) -> &[WallInput] {
        &self.walls
    }

    /// Walls whose force goes to the history.
    pub fn recorded(&self) -> &[walls::Recorded] {
        &self.recorded
    }

    /// Refuses pads that are too stiff or too strongly damped for sleepers that move in steps of `dt` [s] under the pads'
    /// force at the start of each step.
    ///
    /// # Errors
    /// Half a radian of the fastest motion of a sleeper on its pads is more than a step, or half a time constant of its
    /// damping.
    pub fn check_pads(&self, document: &Document, dt: f64) -> Result<(), SceneError> {
        let (Some(rail), Some(sleeper)) = (&self.rail, self.sleeper.as_ref().map(|s| &s.row)) else {
            return Ok(());
        };
        let [a, b, c] = sleeper.half;
        // 1/m of a seat, turning about both level axes included: a bound for all modes.
        let third = |x: f64, y: f64| 3.0 / (sleeper.mass * (x * x + y * y));
        let lightness: f64 = sleeper
            .seats
            .iter()
            .map(|s| 1.0 / sleeper.mass + s[0] * s[0] * third(a, c) + s[1] * s[1] * third(b, c))
            .sum();
        for (key, value, most) in [
            ("pad_stiffness", rail.pad[0], 0.25 / (dt * dt * lightness)),
            ("pad_damping", rail.pad[1], 0.5 / (dt * lightness)),
        ] {
            if value > most {
                let expected = format!("at most {most:.4e} with grain steps of {dt:.4e} s");
                return Err(document.error(&format!("track.rail.{key}"), value.to_string(), expected));
            }
        }
        Ok(())
    }

    /// Refuses a ram that steps of `dt` [s] cannot follow.
    ///
    /// # Errors
    /// Bad input.
    pub fn check_ram(&self, document: &Document, dt: f64) -> Result<(), SceneError> {
        let (Some(push), Some(sleeper)) = (&self.after.push, &self.sleeper) else { return Ok(()) };
        let most = PushPlan::largest_stiffness(sleeper.row.mass, dt);
        if push.stiffness > most {
            let expected = format!("at most {most:.3e} N/m, which the step of {dt:.3e} s can follow");
            let found = format!("{:.3e} N/m", push.stiffness);
            return Err(document.error("track.push.stiffness", found, expected));
        }
        Ok(())
    }

    /// Sleepers, load, rail and push for the run proper.
    pub fn track(&self) -> TrackInput<'_> {
        TrackInput {
            sleepers: self.sleeper.as_ref().map(|s| &s.row),
            load: self.load.as_ref(),
            rail: self.rail,
            push: self.after.push.as_ref(),
        }
    }

    /// The sleepers that are bodies among the grains.
    pub fn rigid_sleeper(&self) -> Option<&SleeperPlan> {
        self.sleeper.as_ref().filter(|s| !s.row.meshed)
    }

    /// Tells from which face of the solid's surface on the faces are those of meshed sleepers.
    pub fn set_sleeper_faces(&mut self, first: u32) {
        self.other_surface = self.sleeper.as_ref().filter(|s| s.row.meshed).map(|s| (first, s.material));
    }

    /// A sleeper as a body with its centre above `centre` at height `z` [m].
    pub fn sleeper_body(&self, plan: &SleeperPlan, centre: [f64; 2], z: f64) -> BodyInput {
        BodyInput {
            shape: plan.shape,
            material: plan.material,
            part: self.parts.len() as u32 - 1,
            position: Vec3::new(centre[0], centre[1], z),
            fixed: plan.row.held,
            mass: Some(plan.row.mass),
            ..BodyInput::default()
        }
    }
}

/// Resolves `[[material]]`, `[[contact]]`, `[[grains]]`, `[[walls]]`, `[deposition]` and `[track]`.
///
/// # Errors
/// Bad input in the scene or in the tables it names.
pub fn build(document: &Document, scene: &Scene, gravity: [f64; 3]) -> Result<GrainsPart, Failure> {
    let find = |key: &str, name: &str| find(document, scene, key, name);
    let materials = materials::build(document, scene)?;
    let contacts = materials::pairs(document, scene, find)?;
    materials::check_laws(document, scene, &materials, &contacts)?;
    let impact_speed = scene.time.impact_speed.map(|v| v.si);
    check(document, "time.impact_speed", impact_speed, |v| v >= 0.0, "0 or more")?;
    if impact_speed.is_some() && !materials::stiffens(&materials, &contacts) {
        let expected = "no such key without a material with `young`";
        return Err(document.error("time.impact_speed", "a value", expected).into());
    }
    let mut part = GrainsPart {
        materials,
        contacts,
        shapes: Vec::new(),
        planes: Vec::new(),
        walls: Vec::new(),
        recorded: Vec::new(),
        surface_material: scene
            .coupling
            .as_ref()
            .map(|c| find("coupling.material", &c.material))
            .transpose()?,
        other_surface: None,
        gravity: Vec3::from(gravity),
        time_step: time_step(document, &scene.time)?,
        impact_speed,
        periodic: [None; 3],
        bodies: Vec::new(),
        parts: Vec::new(),
        first_shape: Vec::new(),
        graded: Vec::new(),
        growths: Vec::new(),
        bonds: bonds::kinds(document, scene)?,
        moving: Vec::new(),
        fouling: Vec::new(),
        recorded_groups: Vec::new(),
        grain_materials: Vec::new(),
        material_names: scene.material.iter().map(|m| m.name.clone()).collect(),
        deposition: None,
        compaction: Vec::new(),
        measures: Vec::new(),
        sleeper: None,
        load: None,
        after: AfterPlan::default(),
        rail: None,
        flow: None,
    };
    add_groups(document, scene, &mut part)?;
    periodic::add(document, scene, &mut part)?;
    flow::add(document, scene, &mut part)?;
    add_walls(document, scene, &mut part)?;
    part.deposition = scene.deposition.as_ref().map(|d| deposition(document, d)).transpose()?;
    compaction::add(document, scene, &find, &mut part)?;
    bonds::rules(document, scene, &mut part)?;
    if let Some(track) = &scene.track {
        let material = find("track.sleeper.material", &track.sleeper.material)?;
        track::add(document, track, material, &mut part)?;
        part.after = after::build(document, track, &part)?;
    }
    Ok(part)
}

/// Number of a material.
fn find(document: &Document, scene: &Scene, key: &str, name: &str) -> Result<usize, SceneError> {
    let names: Vec<&str> = scene.material.iter().map(|m| m.name.as_str()).collect();
    let found = names.iter().position(|n| *n == name);
    found.ok_or_else(|| {
        let expected = format!("the name of a [[material]]: {}", names.join(", "));
        document.error(key, format!("\"{name}\""), expected)
    })
}

/// `[[grains]]` resolved.
fn add_groups(document: &Document, scene: &Scene, part: &mut GrainsPart) -> Result<(), Failure> {
    for (i, group) in scene.grains.iter().enumerate() {
        let material = find(document, scene, &format!("grains.{i}.material"), &group.material)?;
        if scene.material[material].density.is_none() {
            let key = format!("material.{material}.density");
            return Err(document.error(&key, "nothing", "the density of a material of grains").into());
        }
        if !part.grain_materials.contains(&material) {
            part.grain_materials.push(material);
        }
        if group.fouling {
            part.fouling.push(part.parts.len() as u32);
        }
        part.parts.push(group.name.clone());
        groups::add(document, i, group, material, part)?;
    }
    if !part.fouling.is_empty() && part.fouling.len() == scene.grains.len() {
        let expected = "a group of grains beside it that is fouled";
        return Err(document.error("grains.0.fouling", "true for all groups", expected).into());
    }
    Ok(())
}

/// `[[walls]]` resolved.
fn add_walls(document: &Document, scene: &Scene, part: &mut GrainsPart) -> Result<(), Failure> {
    for (i, wall) in scene.walls.iter().enumerate() {
        let material = find(document, scene, &format!("walls.{i}.material"), &wall.material)?;
        let before = part.walls.len();
        walls::add(document, i, wall, material, part)?;
        let new = part.walls.get(before).map(|w| &w.shape);
        if scene.track.is_some() && matches!(new, Some(WallShape::Plane { .. })) {
            let expected =
                "a plane without `record` and motions other than `velocity`: a sleeper touches no other";
            return Err(document.error(&format!("walls.{i}"), "a plane that is more", expected).into());
        }
    }
    Ok(())
}

/// `[deposition]` resolved.
fn deposition(document: &Document, d: &Deposition) -> Result<DepositionPlan, SceneError> {
    check(document, "deposition.max_time", Some(d.max_time.si), |t| t > 0.0, "a time above 0")?;
    check(
        document,
        "deposition.settled_speed",
        d.settled_speed.map(|v| v.si),
        |v| v > 0.0,
        "a speed above 0",
    )?;
    let ratio = d.unbalanced_ratio;
    check(document, "deposition.unbalanced_ratio", ratio, |r| r > 0.0 && r < 1.0, "above 0, below 1")?;
    let layers = Some(f64::from(d.layers));
    check(document, "deposition.layers", layers, |n| (1.0..=1000.0).contains(&n), "1 to 1000")?;
    check(document, "deposition.friction", d.friction, |f| f >= 0.0, "0 or more")?;
    check(
        document,
        "deposition.local_damping",
        Some(d.local_damping),
        |a| (0.0..1.0).contains(&a),
        "0 or more, below 1",
    )?;
    Ok(DepositionPlan {
        max_time: d.max_time.si,
        // With a ratio of forces alone, speed does not matter.
        settled_speed: match (d.settled_speed, ratio) {
            (Some(speed), _) => speed.si,
            (None, Some(_)) => f64::INFINITY,
            (None, None) => SETTLED_SPEED,
        },
        unbalanced_ratio: ratio,
        layers: d.layers,
        level: d.level.map(|l| l.si),
        friction: d.friction,
        local_damping: d.local_damping,
    })
}

/// What is wrong with the grains as a whole, which shows only when their model is made.
pub fn refused(document: &Document, error: &ModelError) -> SceneError {
    match error {
        ModelError::TimeStep { dt, limit, cause } => {
            let expected =
                format!("at most {limit:.6e} s, set by {cause}, or `accept_step_above_limit = true`");
            document.error("time.grain_step", format!("{dt} s"), expected)
        }
        ModelError::RigidPair { a, b } => {
            let found = format!("no stiffness for {a} against {b}, which may touch");
            document.error("material", found, "`stiffness` for one of their materials, or for the pair")
        }
        ModelError::Wall { wall, problem } => {
            document.error("walls", format!("{wall}: {problem}"), "walls that can be built")
        }
        ModelError::Adhesion { index, with } => document.error(
            &format!("contact.{index}.adhesion"),
            format!("adhesion beside {with}"),
            "no adhesion in such a scene",
        ),
        ModelError::Periodic { problem } => {
            document.error("periodic", problem, "axes that the rest of the scene can be periodic along")
        }
        ModelError::Bond { .. } | ModelError::BondKind { .. } => {
            document.error("bond", error.to_string(), "bonds that can be made")
        }
        other => document.error("grains", other.to_string(), "grains and walls that make a model"),
    }
}

pub(super) fn check(
    document: &Document,
    key: &str,
    value: Option<f64>,
    good: impl Fn(f64) -> bool,
    expected: &str,
) -> Result<(), SceneError> {
    match value {
        Some(v) if !(v.is_finite() && good(v)) => Err(document.error(key, v.to_string(), expected)),
        _ => Ok(()),
    }
}

fn time_step(document: &Document, time: &TimeControl) -> Result<TimeStep, SceneError> {
    match (time.grain_step, time.grain_step_fraction) {
        (Some(_), Some(f)) => {
            Err(document.error("time.grain_step_fraction", f.to_string(), "no such key beside `grain_step`"))
        }
        (Some(step), None) if step.si <= 0.0 => {
            Err(document.error("time.grain_step", step.si.to_string(), "a time above 0"))
        }
        (Some(step), None) if time.accept_step_above_limit => Ok(TimeStep::FixedAboveLimit(step.si)),
        (Some(step), None) => Ok(TimeStep::Fixed(step.si)),
        (None, fraction) => {
            if time.accept_step_above_limit {
                let key = "time.accept_step_above_limit";
                return Err(document.error(key, "true", "a `grain_step` that it accepts"));
            }
            let fraction = fraction.unwrap_or(0.9);
            check(
                document,
                "time.grain_step_fraction",
                Some(fraction),
                |f| f > 0.0 && f <= 1.0,
                "above 0, at most 1",
            )?;
            Ok(TimeStep::Auto { fraction })
        }
    }
}
