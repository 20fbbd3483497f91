//! `[[walls]]` resolved.

use super::{GrainsPart, check};
use crate::failure::Failure;
use crate::read::read_surface;
use crate::scene::track::Motion as Held;
use crate::scene::units::vector;
use crate::scene::walls::{Wall, WallKind};
use crate::scene::{Document, SceneError};
use trackbed_dem::{Motion, Oscillation, Plane, RigidBody, Servo, Vec3, WallInput, WallShape};

/// A wall whose force is written to the history.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Name of the wall.
    pub name: String,
    /// Number among the walls of the grains' model.
    pub wall: usize,
}

/// The keys that only some kinds of wall have.
const SPECIAL: [(&str, &[WallKind]); 12] = [
    ("point", &[WallKind::Plane]),
    ("normal", &[WallKind::Plane]),
    ("vertices", &[WallKind::Triangles]),
    ("triangles", &[WallKind::Triangles]),
    ("file", &[WallKind::Mesh]),
    ("scale", &[WallKind::Mesh]),
    ("translation", &[WallKind::Mesh]),
    ("base", &[WallKind::Cylinder, WallKind::Cone, WallKind::Sphere]),
    ("axis", &[WallKind::Cylinder, WallKind::Cone]),
    ("height", &[WallKind::Cylinder, WallKind::Cone]),
    ("radius", &[WallKind::Cylinder, WallKind::Sphere]),
    ("radii", &[WallKind::Cone]),
];

/// Adds a wall.
pub(super) fn add(
    document: &Document,
    index: usize,
    wall: &Wall,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let present = |k: &str| match k {
        "point" => wall.point.is_some(),
        "normal" => wall.normal.is_some(),
        "vertices" => wall.vertices.is_some(),
        "triangles" => wall.triangles.is_some(),
        "file" => wall.file.is_some(),
        "scale" => wall.scale.is_some(),
        "translation" => wall.translation.is_some(),
        "base" => wall.base.is_some(),
        "axis" => wall.axis.is_some(),
        "height" => wall.height.is_some(),
        "radius" => wall.radius.is_some(),
        _ => wall.radii.is_some(),
    };
    let foreign = |(k, kinds): &&(&str, &[WallKind])| present(k) && !kinds.contains(&wall.kind);
    if let Some((k, _)) = SPECIAL.iter().find(foreign) {
        return Err(document.error(&key(k), "a value", "no such key for this kind of wall").into());
    }
    if wall.caps.is_some() && !matches!(wall.kind, WallKind::Cylinder | WallKind::Cone) {
        return Err(document.error(&key("caps"), "a value", "no such key for this kind of wall").into());
    }
    let shape = shape(document, index, wall)?;
    let motion = motion(document, index, wall)?;
    let name = wall.name.clone().unwrap_or_else(|| format!("wall{index}"));
    if wall.record && part.recorded.iter().any(|r| r.name == name) {
        return Err(document.error(&key("name"), format!("\"{name}\""), "a name of its own").into());
    }
    let plain = motion.angular_velocity == Vec3::zeros()
        && motion.oscillation.is_none()
        && wall.servo.is_none()
        && wall.body.is_none()
        && !wall.record;
    if let (WallShape::Plane { point, normal }, true) = (&shape, plain) {
        part.planes.push(Plane { point: *point, normal: *normal, material, velocity: motion.velocity });
        return Ok(());
    }
    let servo = servo(document, index, wall)?;
    let body = body(document, index, wall)?;
    if wall.record {
        part.recorded.push(Recorded { name, wall: part.walls.len() });
    }
    part.walls.push(WallInput { shape, material, motion, servo, body });
    Ok(())
}

fn shape(document: &Document, index: usize, wall: &Wall) -> Result<WallShape, Failure> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let missing = |k: &str, expected: &str| document.error(&key(k), "nothing", expected);
    let above = |k: &str, x: f64| check(document, &key(k), Some(x), |x| x > 0.0, "a length above 0");
    let axis = || -> Result<Vec3, SceneError> {
        direction(document, &key("axis"), wall.axis.unwrap_or([0.0, 0.0, 1.0]))
    };
    let base = || {
        wall.base
            .map(|b| Vec3::from(vector(&b)))
            .ok_or_else(|| missing("base", "the middle of the first end, or of a sphere"))
    };
    let height =
        || wall.height.map(|h| h.si).ok_or_else(|| missing("height", "the distance of the two ends"));
    let radius = || wall.radius.map(|r| r.si).ok_or_else(|| missing("radius", "the radius"));
    Ok(match wall.kind {
        WallKind::Plane => {
            let point = wall.point.ok_or_else(|| missing("point", "a point of the plane"))?;
            let normal = wall.normal.ok_or_else(|| missing("normal", "the plane's normal"))?;
            direction(document, &key("normal"), normal)?;
            WallShape::Plane { point: Vec3::from(vector(&point)), normal: Vec3::from(normal) }
        }
        WallKind::Triangles => triangles(document, index, wall)?,
        WallKind::Mesh => mesh(document, index, wall)?,
        WallKind::Cylinder => {
            let (radius, height) = (radius()?, height()?);
            above("radius", radius)?;
            above("height", height)?;
            let caps = wall.caps.unwrap_or_default();
            WallShape::Frustum { base: base()?, axis: axis()?, height, radii: [radius; 2], caps }
        }
        WallKind::Cone => {
            let radii =
                wall.radii.ok_or_else(|| missing("radii", "the radii of the two ends"))?.map(|r| r.si);
            let height = height()?;
            check_cone(document, index, radii, height)?;
            WallShape::Frustum {
                base: base()?,
                axis: axis()?,
                height,
                radii,
                caps: wall.caps.unwrap_or_default(),
            }
        }
        WallKind::Sphere => {
            let radius = radius()?;
            above("radius", radius)?;
            WallShape::Sphere { centre: base()?, radius }
        }
    })
}

/// A wall of triangles in the scene.
fn triangles(document: &Document, index: usize, wall: &Wall) -> Result<WallShape, SceneError> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let missing = |k: &str| document.error(&key(k), "nothing", "the vertices and triangles of the wall");
    let vertices = wall.vertices.as_ref().ok_or_else(|| missing("vertices"))?;
    let triangles = wall.triangles.clone().ok_or_else(|| missing("triangles"))?;
    if let Some(bad) = triangles.iter().flatten().find(|v| **v as usize >= vertices.len()) {
        let expected = format!("0 to {}", vertices.len().max(1) - 1);
        return Err(document.error(&key("triangles"), format!("vertex {bad}"), expected));
    }
    Ok(WallShape::Triangles { vertices: vertices.iter().map(|v| Vec3::from(vector(v))).collect(), triangles })
}

/// A wall from a file.
fn mesh(document: &Document, index: usize, wall: &Wall) -> Result<WallShape, Failure> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let Some(file) = &wall.file else {
        let expected = "a surface file: .stl, .obj, or a plain list";
        return Err(document.error(&key("file"), "nothing", expected).into());
    };
    let scale = wall.scale.unwrap_or(1.0);
    check(document, &key("scale"), Some(scale), |s| s > 0.0, "above 0")?;
    let shift = wall.translation.map_or(Vec3::zeros(), |t| Vec3::from(vector(&t)));
    let surface = read_surface(&document.resolve(file))?;
    let vertices: Vec<Vec3> = surface.vertices.iter().map(|v| Vec3::from(*v) * scale + shift).collect();
    let triangles = with_area(&vertices, surface.triangles);
    if triangles.is_empty() {
        return Err(document.error(&key("file"), "no triangle with an area", "at least one").into());
    }
    Ok(WallShape::Triangles { vertices, triangles })
}

/// Refuses a cone without an area.
fn check_cone(document: &Document, index: usize, radii: [f64; 2], height: f64) -> Result<(), SceneError> {
    let key = |k: &str| format!("walls.{index}.{k}");
    check(document, &key("height"), Some(height), |h| h >= 0.0, "0 or more")?;
    for r in radii {
        check(document, &key("radii"), Some(r), |r| r >= 0.0, "0 or more")?;
    }
    if radii[0].max(radii[1]) > 0.0 && (height > 0.0 || radii[0] != radii[1]) {
        return Ok(());
    }
    let found = format!("[{}, {}]", radii[0], radii[1]);
    Err(document.error(&key("radii"), found, "radii that give the cone an area"))
}

/// Triangles that have an area; files hold some without, which nothing can touch that does not touch their neighbours.
fn with_area(vertices: &[Vec3], mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    triangles.retain(|t| {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() > 2e-9 * longest2
    });
    triangles
}

/// A vector with a length.
fn direction(document: &Document, key: &str, v: [f64; 3]) -> Result<Vec3, SceneError> {
    let length = Vec3::from(v).norm();
    check(document, key, Some(length), |l| l > 0.0 && l.is_finite(), "a vector that is not null")?;
    Ok(Vec3::from(v) / length)
}

fn motion(document: &Document, index: usize, wall: &Wall) -> Result<Motion, SceneError> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let mut motion = Motion {
        velocity: wall.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        angular_velocity: wall.angular_velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        centre: wall.centre.map(|v| Vec3::from(vector(&v))),
        oscillation: None,
    };
    if motion.centre.is_some() && wall.angular_velocity.is_none() {
        return Err(document.error(&key("centre"), "a value", "no such key without `angular_velocity`"));
    }
    if let (WallKind::Plane, Some(normal)) = (wall.kind, wall.normal) {
        let (spin, normal) = (motion.angular_velocity, Vec3::from(normal));
        if spin.cross(&normal).norm() > 1e-12 * spin.norm() * normal.norm() {
            let expected =
                "an angular velocity along the plane's normal, or triangles for a floor that tilts";
            let found = format!("({}, {}, {}) rad/s", spin.x, spin.y, spin.z);
            return Err(document.error(&key("angular_velocity"), found, expected));
        }
    }
    if let Some(o) = &wall.oscillation {
        check(document, &key("oscillation.frequency"), Some(o.frequency.si), |f| f > 0.0, "above 0")?;
        check(
            document,
            &key("oscillation.amplitude"),
            Some(o.amplitude.si),
            |a| a > 0.0,
            "a length above 0",
        )?;
        let along = direction(document, &key("oscillation.direction"), o.direction)?;
        motion.oscillation = Some(Oscillation {
            amplitude: along * o.amplitude.si,
            frequency: o.frequency.si,
            phase: o.phase.map_or(0.0, |p| p.si),
        });
    }
    let moves = [
        ("velocity", wall.velocity.is_some()),
        ("angular_velocity", wall.angular_velocity.is_some()),
        ("oscillation", wall.oscillation.is_some()),
    ];
    for (owner, there) in [("servo", wall.servo.is_some()), ("body", wall.body.is_some())] {
        if let Some((k, _)) = moves.iter().find(|(_, given)| there && *given) {
            return Err(document.error(&key(k), "a value", format!("no such key beside `{owner}`")));
        }
    }
    if wall.servo.is_some() && wall.body.is_some() {
        return Err(document.error(&key("servo"), "a value", "no such key beside `body`"));
    }
    Ok(motion)
}

fn servo(document: &Document, index: usize, wall: &Wall) -> Result<Option<Servo>, SceneError> {
    let Some(s) = &wall.servo else { return Ok(None) };
    let key = |k: &str| format!("walls.{index}.servo.{k}");
    let along = match (s.direction, wall.normal) {
        (Some(d), _) => direction(document, &key("direction"), d)?,
        (None, Some(n)) => direction(document, &key("direction"), n)?,
        _ => {
            return Err(document.error(
                &key("direction"),
                "nothing",
                "the direction in which the wall presses",
            ));
        }
    };
    let force = match (s.force, s.pressure, s.area) {
        (Some(f), None, None) => f.si,
        (None, Some(p), Some(area)) => {
            check(document, &key("area"), Some(area), |a| a > 0.0, "an area above 0")?;
            p.si * area
        }
        (None, Some(_), None) => {
            return Err(document.error(&key("area"), "nothing", "the area that the pressure acts on"));
        }
        (Some(_), None, Some(_)) => {
            return Err(document.error(&key("area"), "a value", "no such key beside `force`"));
        }
        _ => {
            return Err(document.error(
                &key("force"),
                "both or none of `force` and `pressure`",
                "one of them",
            ));
        }
    };
    check(document, &key("max_speed"), Some(s.max_speed.si), |v| v > 0.0, "a speed above 0")?;
    let gain = s.gain.unwrap_or(0.5);
    check(document, &key("gain"), Some(gain), |g| g > 0.0 && g <= 1.0, "above 0, at most 1")?;
    let points = match &s.history {
        None => vec![[0.0, force]],
        Some(points) => points.iter().map(|(t, f)| [t.si, f * force]).collect(),
    };
    if points.is_empty()
        || !points.is_sorted_by(|a, b| a[0] < b[0])
        || !points.iter().flatten().all(|x| x.is_finite())
    {
        return Err(document.error(&key("history"), "times that do not rise", "points with rising times"));
    }
    Ok(Some(Servo { direction: along, force: points, max_speed: s.max_speed.si, gain }))
}

fn body(document: &Document, index: usize, wall: &Wall) -> Result<Option<RigidBody>, SceneError> {
    let Some(b) = &wall.body else { return Ok(None) };
    if !matches!(wall.kind, WallKind::Triangles | WallKind::Mesh) {
        let expected = "no such key for this kind of wall: only triangles make a body";
        return Err(document.error(&format!("walls.{index}.body"), "a value", expected));
    }
    check(document, &format!("walls.{index}.body.mass"), Some(b.mass.si), |m| m > 0.0, "a mass above 0")?;
    let mut fixed = [false; 6];
    for motion in &b.hold {
        let k = match motion {
            Held::X => 0,
            Held::Y => 1,
            Held::Z => 2,
            Held::Rx => 3,
            Held::Ry => 4,
            Held::Rz => 5,
        };
        fixed[k] = true;
    }
    Ok(Some(RigidBody {
        mass: b.mass.si,
        centre: b.centre.map(|c| Vec3::from(vector(&c))),
        inertia: b.inertia,
        velocity: b.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        spin: b.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        fixed,
    }))
}
