//! The grains of a scene: materials, shapes, bodies, walls, sleeper.

use super::seat_load::CyclicLoad;
use super::tables;
use crate::failure::Failure;
use crate::scene::grains::{GrainShape, Grains, Wall, WallKind};
use crate::scene::track::{Motion, Track};
use crate::scene::units::vector;
use crate::scene::{Document, Scene, SceneError, TimeControl};
use nalgebra::UnitQuaternion;
use trackbed_coupling::step::{self, Stability};
use trackbed_dem::insert::place;
use trackbed_dem::shape::Shape;
use trackbed_dem::{
    BodyInput, LocalDamping, Material, Model, ModelError, ModelInput, PairOverride, Plane, TimeStep,
    TriangleSurface, Vec3,
};
use trackbed_fem::Face;

/// The grains, ready to build models of.
pub struct GrainsPart {
    materials: Vec<Material>,
    contacts: Vec<PairOverride>,
    shapes: Vec<Shape>,
    planes: Vec<Plane>,
    triangles: Vec<TriangleSurface>,
    surface_material: Option<usize>,
    gravity: Vec3,
    time_step: TimeStep,
    /// All grains where they start.
    pub bodies: Vec<BodyInput>,
    /// Names of the groups; the sleeper is the group after the last.
    pub parts: Vec<String>,
    /// Materials that grains consist of.
    grain_materials: Vec<usize>,
    /// Settling before the run proper.
    pub deposition: Option<DepositionPlan>,
    /// The sleeper.
    pub sleeper: Option<SleeperPlan>,
    /// The load on it.
    pub load: Option<CyclicLoad>,
}

/// Settling before the run proper.
#[derive(Clone, Debug)]
pub struct DepositionPlan {
    /// Longest time [s].
    pub max_time: f64,
    /// Root-mean-square speed below which the bed counts as settled [m/s].
    pub settled_speed: f64,
    /// Height above which grains are taken away afterwards [m].
    pub level: Option<f64>,
    friction: Option<f64>,
    local_damping: f64,
}

/// A sleeper.
#[derive(Clone, Debug)]
pub struct SleeperPlan {
    shape: usize,
    material: usize,
    mass: f64,
    fixed: [bool; 6],
    /// Half edge lengths [m].
    pub half: [f64; 3],
    /// Place of the centre in x and y [m].
    pub centre: [f64; 2],
    /// Points of the top that share the load, in the sleeper's frame [m].
    pub seats: Vec<[f64; 3]>,
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
                            restitution: None,
                            stiffness: None,
                        });
                    }
                }
            }
        }
        let damping = (plan.local_damping > 0.0).then_some(LocalDamping { factor: plan.local_damping });
        ModelInput { contacts, damping, ..self.input(self.bodies.clone()) }
    }

    /// The model of the run proper with the given bodies.
    pub fn input(&self, bodies: Vec<BodyInput>) -> ModelInput {
        ModelInput {
            materials: self.materials.clone(),
            contacts: self.contacts.clone(),
            shapes: self.shapes.clone(),
            bodies,
            planes: self.planes.clone(),
            triangles: self.triangles.clone(),
            surface_material: self.surface_material,
            gravity: self.gravity,
            time_step: self.time_step,
            skin: None,
            damping: None,
        }
    }

    /// Stability of the exchange with a solid in windows of `window` [s], for the stiffest contact and the heaviest
    /// grain.
    pub fn stability(
        &self,
        model: &Model,
        window: f64,
        solid: &trackbed_fem::Model,
        faces: &[Face],
    ) -> Stability {
        let Some(surface) = self.surface_material else { return Stability::default() };
        let (mut stiffness, mut damping) = (0.0_f64, 0.0_f64);
        // The sleeper touches grains only.
        let grains = self.parts.len() as u32 - u32::from(self.sleeper.is_some());
        let heaviest = (0..model.body_count())
            .filter(|&b| model.part(b) < grains)
            .map(|b| model.mass(b))
            .fold(0.0, f64::max);
        for &material in &self.grain_materials {
            let (k, ratio) = model.contact_stiffness(material, surface);
            stiffness = stiffness.max(k);
            damping = damping.max(2.0 * ratio * (heaviest * k).sqrt());
        }
        step::stability(window, stiffness, damping, step::face_masses(solid, faces))
    }

    /// Planes, for the pictures of the walls.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Triangle walls, for the pictures.
    pub fn triangles(&self) -> &[TriangleSurface] {
        &self.triangles
    }

    /// The sleeper as a body with its centre at height `z` [m].
    pub fn sleeper_body(&self, plan: &SleeperPlan, z: f64) -> BodyInput {
        BodyInput {
            shape: plan.shape,
            material: plan.material,
            part: self.parts.len() as u32 - 1,
            position: Vec3::new(plan.centre[0], plan.centre[1], z),
            fixed: plan.fixed,
            mass: Some(plan.mass),
            ..BodyInput::default()
        }
    }
}

/// Resolves `[[material]]`, `[[contact]]`, `[[grains]]`, `[[walls]]`, `[deposition]` and `[track]`.
///
/// # Errors
/// Bad input in the scene or in the tables it names.
pub fn build(document: &Document, scene: &Scene, gravity: [f64; 3]) -> Result<GrainsPart, Failure> {
    let names: Vec<&str> = scene.material.iter().map(|m| m.name.as_str()).collect();
    let find = |key: &str, name: &str| -> Result<usize, SceneError> {
        names.iter().position(|n| *n == name).ok_or_else(|| {
            document.error(
                key,
                format!("\"{name}\""),
                format!("the name of a [[material]]: {}", names.join(", ")),
            )
        })
    };
    let materials = materials(document, scene)?;
    let mut contacts = Vec::new();
    for (i, c) in scene.contact.iter().enumerate() {
        let key = |k: &str| format!("contact.{i}.{k}");
        check(document, &key("friction"), c.friction, |f| f >= 0.0, "0 or more")?;
        check(document, &key("restitution"), c.restitution, |e| e > 0.0 && e <= 1.0, "above 0, at most 1")?;
        check(document, &key("stiffness"), c.stiffness.map(|s| s.si), |k| k > 0.0, "above 0")?;
        contacts.push(PairOverride {
            a: find(&key("between"), &c.between[0])?,
            b: find(&key("between"), &c.between[1])?,
            friction: c.friction,
            restitution: c.restitution,
            stiffness: c.stiffness.map(|s| s.si),
        });
    }
    let mut part = GrainsPart {
        materials,
        contacts,
        shapes: Vec::new(),
        planes: Vec::new(),
        triangles: Vec::new(),
        surface_material: scene
            .coupling
            .as_ref()
            .map(|c| find("coupling.material", &c.material))
            .transpose()?,
        gravity: Vec3::from(gravity),
        time_step: time_step(document, &scene.time)?,
        bodies: Vec::new(),
        parts: Vec::new(),
        grain_materials: Vec::new(),
        deposition: None,
        sleeper: None,
        load: None,
    };
    for (i, group) in scene.grains.iter().enumerate() {
        let material = find(&format!("grains.{i}.material"), &group.material)?;
        if scene.material[material].density.is_none() {
            let key = format!("material.{material}.density");
            return Err(document.error(&key, "nothing", "the density of a material of grains").into());
        }
        if !part.grain_materials.contains(&material) {
            part.grain_materials.push(material);
        }
        part.parts.push(group.name.clone());
        add_group(document, i, group, material, &mut part)?;
    }
    for (i, wall) in scene.walls.iter().enumerate() {
        let material = find(&format!("walls.{i}.material"), &wall.material)?;
        add_wall(document, i, wall, material, &mut part)?;
    }
    if let Some(d) = &scene.deposition {
        check(document, "deposition.max_time", Some(d.max_time.si), |t| t > 0.0, "a time above 0")?;
        check(
            document,
            "deposition.settled_speed",
            Some(d.settled_speed.si),
            |v| v > 0.0,
            "a speed above 0",
        )?;
        check(document, "deposition.friction", d.friction, |f| f >= 0.0, "0 or more")?;
        check(
            document,
            "deposition.local_damping",
            Some(d.local_damping),
            |a| (0.0..1.0).contains(&a),
            "0 or more, below 1",
        )?;
        part.deposition = Some(DepositionPlan {
            max_time: d.max_time.si,
            settled_speed: d.settled_speed.si,
            level: d.level.map(|l| l.si),
            friction: d.friction,
            local_damping: d.local_damping,
        });
    }
    if let Some(track) = &scene.track {
        let material = find("track.sleeper.material", &track.sleeper.material)?;
        add_track(document, track, material, &mut part)?;
    }
    Ok(part)
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
            document.error("walls", format!("{wall}: {problem}"), "walls with an area")
        }
        other => document.error("grains", other.to_string(), "grains and walls that make a model"),
    }
}

fn check(
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

fn materials(document: &Document, scene: &Scene) -> Result<Vec<Material>, SceneError> {
    let mut out = Vec::new();
    for (i, m) in scene.material.iter().enumerate() {
        let key = |k: &str| format!("material.{i}.{k}");
        if scene.material[..i].iter().any(|other| other.name == m.name) {
            return Err(document.error(&key("name"), format!("\"{}\" again", m.name), "each name once"));
        }
        check(document, &key("density"), m.density.map(|d| d.si), |d| d > 0.0, "a density above 0")?;
        check(document, &key("stiffness"), m.stiffness.map(|s| s.si), |k| k > 0.0, "a stiffness above 0")?;
        check(
            document,
            &key("tangential_ratio"),
            Some(m.tangential_ratio),
            |r| (0.0..=1.0).contains(&r),
            "0 to 1",
        )?;
        check(
            document,
            &key("tangential_damping_ratio"),
            Some(m.tangential_damping_ratio),
            |r| (0.0..=1.0).contains(&r),
            "0 to 1",
        )?;
        check(document, &key("friction"), Some(m.friction), |f| f >= 0.0, "0 or more")?;
        check(
            document,
            &key("restitution"),
            Some(m.restitution),
            |e| e > 0.0 && e <= 1.0,
            "above 0, at most 1",
        )?;
        out.push(Material {
            // Bodies need a density and say so; walls never use it.
            density: m.density.map_or(1.0, |d| d.si),
            stiffness: m.stiffness.map_or(f64::INFINITY, |s| s.si),
            tangential_ratio: m.tangential_ratio,
            tangential_damping_ratio: m.tangential_damping_ratio,
            friction: m.friction,
            restitution: m.restitution,
        });
    }
    Ok(out)
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

fn add_group(
    document: &Document,
    index: usize,
    group: &Grains,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("grains.{index}.{k}");
    let number = part.parts.len() as u32 - 1;
    let velocity = group.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let spin = group.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let body = |shape: usize, scale: f64, position: Vec3, orientation: UnitQuaternion<f64>| BodyInput {
        shape,
        scale,
        material,
        part: number,
        position,
        orientation,
        velocity,
        spin,
        ..BodyInput::default()
    };
    let sources = [group.spheres.is_some(), group.packing.is_some(), group.fill.is_some()];
    if sources.iter().filter(|s| **s).count() != 1 {
        let expected = "exactly one of `spheres`, `packing` and `fill`";
        return Err(document.error(&format!("grains.{index}"), "another number of sources", expected).into());
    }
    if group.fill.is_none() {
        for (k, present) in [
            ("count", group.count.is_some()),
            ("gradation", group.gradation.is_some()),
            ("size", group.size.is_some()),
            ("library", group.library.is_some()),
        ] {
            if present {
                return Err(document.error(&key(k), "a value", "no such key without `fill`").into());
            }
        }
        if group.shape == GrainShape::Clump {
            return Err(document.error(&key("shape"), "\"clump\"", "`fill`, which clumps need").into());
        }
        let spheres = match (&group.spheres, &group.packing) {
            (Some(list), _) => {
                for s in list {
                    check(document, &key("spheres"), Some(s[3].si), |r| r > 0.0, "a radius above 0")?;
                }
                list.iter().map(|s| ([s[0].si, s[1].si, s[2].si], s[3].si)).collect()
            }
            (_, Some(file)) => tables::packing(&document.resolve(file))?,
            _ => Vec::new(),
        };
        if spheres.is_empty() {
            return Err(document.error(&key("spheres"), "none", "at least one sphere").into());
        }
        let shape = part.shapes.len();
        part.shapes.push(Shape::Sphere { radius: 1.0 });
        part.bodies
            .extend(spheres.iter().map(|(c, r)| body(shape, *r, Vec3::from(*c), UnitQuaternion::identity())));
        return Ok(());
    }
    let fill = group.fill.as_ref().expect("one of the three sources is there");
    let count = group
        .count
        .ok_or_else(|| document.error(&key("count"), "nothing", "the number of grains to fill in"))?;
    check(document, &key("count"), Some(count as f64), |n| (1.0..=1e7).contains(&n), "1 to 10000000")?;
    let first = part.shapes.len();
    // Size 1 of every shape is a sieve size of 1 m, so that the scale of a body is its sieve size.
    let unit_scale: Vec<f64> = match (group.shape, &group.library) {
        (GrainShape::Clump, Some(file)) => {
            let clumps = tables::stones(&document.resolve(file))?;
            part.shapes.extend(clumps.iter().cloned().map(Shape::Clump));
            clumps.iter().map(|c| 1.0 / c.sieve_size()).collect()
        }
        (GrainShape::Clump, None) => {
            return Err(document.error(&key("library"), "nothing", "the stone library of the clumps").into());
        }
        (GrainShape::Sphere, Some(_)) => {
            return Err(document.error(&key("library"), "a file", "no such key for spheres").into());
        }
        (GrainShape::Sphere, None) => {
            part.shapes.push(Shape::Sphere { radius: 0.5 });
            vec![1.0]
        }
    };
    let sizes = match (&group.gradation, &group.size) {
        (Some(g), None) => {
            check(document, &key("gradation.scale"), Some(g.scale), |s| s > 0.0, "above 0")?;
            let curve = tables::gradation(&document.resolve(&g.file), &g.standard, &g.grade)?;
            curve.scaled(g.scale).sample(count, group.seed)
        }
        (None, Some([low, high])) => {
            check(document, &key("size"), Some(low.si), |s| s > 0.0, "sizes above 0")?;
            check(document, &key("size"), Some(high.si), |s| s >= low.si, "the larger size last")?;
            (0..count).map(|i| low.si + (high.si - low.si) * (i as f64 + 0.5) / count as f64).collect()
        }
        _ => {
            return Err(document
                .error(&key("gradation"), "both or none of `gradation` and `size`", "one of them")
                .into());
        }
    };
    let scale: Vec<f64> =
        sizes.iter().enumerate().map(|(i, s)| s * unit_scale[i % unit_scale.len()]).collect();
    let radii: Vec<f64> = scale
        .iter()
        .enumerate()
        .map(|(i, s)| s * bounding_radius(&part.shapes[first + i % unit_scale.len()]))
        .collect();
    let high = [fill.high[0].si, fill.high[1].si];
    let placed = place::place_loose(vector(&fill.low), high, &radii, group.seed)
        .map_err(|e| document.error(&key("fill"), e.to_string(), "a box that holds the grains"))?;
    for (i, place) in placed.iter().enumerate() {
        part.bodies.push(body(first + i % unit_scale.len(), scale[i], place.position, place.orientation));
    }
    Ok(())
}

/// Radius about the centre of mass that holds a grain of scale 1 [m].
fn bounding_radius(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Clump(clump) => clump.bounding_radius(),
        Shape::Box { half } => half.iter().map(|h| h * h).sum::<f64>().sqrt(),
    }
}

fn add_wall(
    document: &Document,
    index: usize,
    wall: &Wall,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), SceneError> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let velocity = wall.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let foreign: [(&str, bool); 4] = [
        ("vertices", wall.vertices.is_some() && wall.kind == WallKind::Plane),
        ("triangles", wall.triangles.is_some() && wall.kind == WallKind::Plane),
        ("point", wall.point.is_some() && wall.kind == WallKind::Triangles),
        ("normal", wall.normal.is_some() && wall.kind == WallKind::Triangles),
    ];
    if let Some((k, _)) = foreign.iter().find(|(_, present)| *present) {
        return Err(document.error(&key(k), "a value", "no such key for this kind of wall"));
    }
    match wall.kind {
        WallKind::Plane => {
            let point =
                wall.point.ok_or_else(|| document.error(&key("point"), "nothing", "a point of the plane"))?;
            let normal =
                wall.normal.ok_or_else(|| document.error(&key("normal"), "nothing", "the plane's normal"))?;
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            check(
                document,
                &key("normal"),
                Some(length),
                |l| l > 0.0 && l.is_finite(),
                "a vector that is not null",
            )?;
            let point = Vec3::from(vector(&point));
            part.planes.push(Plane { point, normal: Vec3::from(normal), material, velocity });
        }
        WallKind::Triangles => {
            let missing =
                |k: &str| document.error(&key(k), "nothing", "the vertices and triangles of the wall");
            let vertices = wall.vertices.as_ref().ok_or_else(|| missing("vertices"))?;
            let triangles = wall.triangles.clone().ok_or_else(|| missing("triangles"))?;
            if let Some(bad) = triangles.iter().flatten().find(|v| **v as usize >= vertices.len()) {
                let expected = format!("0 to {}", vertices.len().max(1) - 1);
                return Err(document.error(&key("triangles"), format!("vertex {bad}"), expected));
            }
            let vertices = vertices.iter().map(|v| Vec3::from(vector(v))).collect();
            part.triangles.push(TriangleSurface { vertices, triangles, material, velocity });
        }
    }
    Ok(())
}

fn add_track(
    document: &Document,
    track: &Track,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), SceneError> {
    let s = &track.sleeper;
    let half = vector(&s.size).map(|l| 0.5 * l);
    for l in half {
        check(document, "track.sleeper.size", Some(l), |l| l > 0.0, "lengths above 0")?;
    }
    check(document, "track.sleeper.mass", Some(s.mass.si), |m| m > 0.0, "a mass above 0")?;
    let shape = part.shapes.len();
    part.shapes.push(Shape::Box { half });
    part.parts.push("sleeper".into());
    let mut fixed = [false; 6];
    for motion in &s.hold {
        let k = match motion {
            Motion::X => 0,
            Motion::Y => 1,
            Motion::Z => 2,
            Motion::Rx => 3,
            Motion::Ry => 4,
            Motion::Rz => 5,
        };
        fixed[k] = true;
    }
    let mut seats = vec![[0.0, 0.0, half[2]]];
    if let Some(l) = &track.load {
        check(document, "track.load.minimum", Some(l.minimum.si), |f| f >= 0.0, "0 or more")?;
        check(
            document,
            "track.load.maximum",
            Some(l.maximum.si),
            |f| f > l.minimum.si,
            "more than the minimum",
        )?;
        check(document, "track.load.frequency", Some(l.frequency.si), |f| f > 0.0, "above 0")?;
        check(document, "track.load.cycles", Some(f64::from(l.cycles)), |n| n >= 1.0, "1 or more")?;
        check(document, "track.load.rest", Some(l.rest.si), |t| t >= 0.0, "0 or more")?;
        check(document, "track.load.ramp", Some(l.ramp.si), |t| t >= 0.0, "0 or more")?;
        if !l.seats.is_empty() {
            seats = l.seats.iter().map(|p| [p[0].si, p[1].si, half[2]]).collect();
        }
        if let Some(p) = seats.iter().find(|p| p[0].abs() > half[0] || p[1].abs() > half[1]) {
            let found = format!("({}, {})", p[0], p[1]);
            return Err(document.error("track.load.seats", found, "points on the sleeper's top"));
        }
        part.load = Some(CyclicLoad::new(l));
    }
    part.sleeper = Some(SleeperPlan {
        shape,
        material,
        mass: s.mass.si,
        fixed,
        half,
        centre: [s.centre[0].si, s.centre[1].si],
        seats,
    });
    Ok(())
}
