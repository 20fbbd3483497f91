//! `[track.sleeper]` resolved: positions, seats, meshing.

use crate::scene::after::JumpMethod;
use crate::scene::solid::Integration;
use crate::scene::track::{HeldMotion, RailKind, Sleeper, SleeperMesh, TrackTable};
use crate::scene::units::vector;
use crate::scene::{Scene, SceneError, Table};
use trackbed_fem::Elastic;

/// Default rail foot width [m].
const FOOT: f64 = 0.15;
const MOST_ELEMENTS: u64 = 100_000;

/// Meshed sleepers.
#[derive(Clone, Debug)]
pub struct MeshedSleepers {
    /// Half edge lengths [m].
    pub half: [f64; 3],
    /// Elements along x, y, z.
    pub elements: [usize; 3],
    /// Elastic constants.
    pub elastic: Elastic,
    /// Centres in plan along the track [m].
    pub centres: Vec<[f64; 2]>,
    /// Seat positions from the centre [m].
    pub seats: Vec<[f64; 2]>,
    /// Loaded rectangle of each seat [m]. Shape `[seats]`.
    pub feet: Vec<[f64; 2]>,
    /// Symmetry about the x and y middle planes.
    pub symmetric: [bool; 2],
    /// Acceleration of gravity [m/s²].
    pub gravity: [f64; 3],
}

/// Returns half edge lengths [m].
///
/// # Errors
/// A length not above 0.
pub fn half(s: &Table<Sleeper>) -> Result<[f64; 3], SceneError> {
    let size = vector(&s.size);
    match size.iter().find(|l| !(l.is_finite() && **l > 0.0)) {
        Some(l) => Err(s.error("size", l.to_string(), "lengths above 0")),
        None => Ok(size.map(|l| 0.5 * l)),
    }
}

/// Returns fixed motions: along, then about x, y, z.
pub fn held(s: &Sleeper) -> [bool; 6] {
    let mut held = [false; 6];
    for motion in &s.hold {
        let k = match motion {
            HeldMotion::X => 0,
            HeldMotion::Y => 1,
            HeldMotion::Z => 2,
            HeldMotion::Rx => 3,
            HeldMotion::Ry => 4,
            HeldMotion::Rz => 5,
        };
        held[k] = true;
    }
    held
}

/// Returns seat positions [m].
///
/// # Errors
/// A seat outside the top face.
pub fn seats(track: &Table<TrackTable>, half: [f64; 3]) -> Result<Vec<[f64; 2]>, SceneError> {
    let load = track.optional("load", &track.load);
    let Some(l) = load.filter(|l| !l.seats.is_empty()) else { return Ok(vec![[0.0; 2]]) };
    let seats: Vec<[f64; 2]> = l.seats.iter().map(|p| [p[0].si, p[1].si]).collect();
    match seats.iter().find(|p| p[0].abs() > half[0] || p[1].abs() > half[1]) {
        Some(p) => {
            let found = format!("({}, {})", p[0], p[1]);
            Err(l.error("seats", found, "points on the sleeper's top"))
        }
        None => Ok(seats),
    }
}

/// Returns centres in plan [m].
///
/// # Errors
/// Invalid count or spacing.
pub fn row(s: &Table<Sleeper>) -> Result<Vec<[f64; 2]>, SceneError> {
    let (axis, spacing) = (s.along.axis(), s.spacing.map(|l| l.si));
    if !(1..=1000).contains(&s.count) {
        return Err(s.error("count", s.count.to_string(), "1 to 1000"));
    }
    let width = s.size[axis].si;
    if let Some(l) = spacing.filter(|l| !(l.is_finite() && *l > width)) {
        let expected = format!("more than the sleeper's width of {width} m along the track");
        return Err(s.error("spacing", l.to_string(), expected));
    }
    if s.count > 1 && spacing.is_none() {
        return Err(s.missing("spacing", "the distance of the sleepers"));
    }
    let first = [s.centre[0].si, s.centre[1].si];
    let place = |k: u32| {
        let mut centre = first;
        centre[axis] += f64::from(k) * spacing.unwrap_or(0.0);
        centre
    };
    Ok((0..s.count).map(place).collect())
}

/// Resolves meshed sleepers, if any.
///
/// # Errors
/// Input errors.
pub fn meshed(scene: &Table<Scene>, gravity: [f64; 3]) -> Result<Option<MeshedSleepers>, SceneError> {
    let Some(track) = scene.optional("track", &scene.track) else { return Ok(None) };
    let s = &track.below("sleeper", &track.sleeper);
    let Some(mesh) = s.optional("mesh", &s.mesh) else { return Ok(None) };
    refuse_company(scene, &track)?;
    let half = half(s)?;
    let count: u64 = mesh.elements.iter().map(|&n| u64::from(n)).product();
    if !(1..=MOST_ELEMENTS).contains(&count) {
        let expected = format!("three numbers of 1 or more, {MOST_ELEMENTS} elements at most");
        return Err(mesh.error("elements", format!("{:?}", mesh.elements), expected));
    }
    let reduced = scene.solid.as_ref().is_some_and(|s| s.integration == Integration::Reduced);
    if reduced && mesh.elements.iter().filter(|n| **n > 1).count() < 2 {
        let expected = "2 or more along two axes, or `solid.integration = \"full\"`: elements in a single row bend in ways that \
                        the reduced rule does not see";
        return Err(mesh.error("elements", format!("{:?}", mesh.elements), expected));
    }
    mesh.check("young", mesh.young, |y| y > 0.0, "a modulus above 0")?;
    mesh.check("poisson", mesh.poisson, |p| p > -1.0 && p < 0.5, "above -1 and below 0.5")?;
    let volume: f64 = half.iter().map(|h| 2.0 * h).product();
    let density = match (s.mass, mesh.density) {
        (Some(mass), None) if mass.si > 0.0 => mass.si / volume,
        (Some(mass), None) => {
            return Err(s.error("mass", mass.si.to_string(), "a mass above 0"));
        }
        (None, Some(density)) => mesh.check("density", density.si, |d| d > 0.0, "a density above 0")?,
        (Some(_), Some(_)) => {
            return Err(mesh.conflict("density", "track.sleeper.mass"));
        }
        (None, None) => {
            let expected = "it, or the density of a meshed sleeper";
            return Err(s.missing("mass", expected));
        }
    };
    let seats = seats(&track, half)?;
    let feet = feet(&mesh, &seats, half, s.along.axis())?;
    Ok(Some(MeshedSleepers {
        half,
        elements: mesh.elements.map(|n| n as usize),
        elastic: Elastic { young: mesh.young.si, poisson: mesh.poisson, density },
        centres: row(s)?,
        seats,
        feet,
        symmetric: symmetric(s)?,
        gravity,
    }))
}

fn refuse_company(scene: &Table<Scene>, track: &Table<TrackTable>) -> Result<(), SceneError> {
    let Some(solid) = &scene.solid else {
        return Err(track.requirement("sleeper.mesh", "[solid]"));
    };
    if track.rail.as_ref().is_some_and(|r| r.kind == RailKind::Beam) {
        let expected = "\"winkler\": a rail with mass needs rigid sleepers";
        return Err(track.error("rail.kind", "\"beam\" on meshed sleepers", expected));
    }
    if track.push.is_some() {
        return Err(track.conflict("push", "[track.sleeper.mesh]"));
    }
    if track.jump.as_ref().is_some_and(|j| j.method == JumpMethod::Displace) {
        let expected = "\"extrapolate\". Meshed sleepers cannot be displaced";
        return Err(track.error("jump.method", "\"displace\"", expected));
    }
    if solid.reduction.is_some() {
        return Err(scene.conflict("solid.reduction", "[track.sleeper.mesh]"));
    }
    Ok(())
}

/// Motions of a symmetry plane must be fixed together or not at all.
fn symmetric(s: &Table<Sleeper>) -> Result<[bool; 2], SceneError> {
    let held = held(s);
    let [x, y] = [[0, 4, 5], [1, 3, 5]].map(|plane: [usize; 3]| plane.iter().all(|&k| held[k]));
    let of_planes = [x, y, false, y, x, x || y];
    if held == of_planes {
        return Ok([x, y]);
    }
    let names = ["x", "y", "z", "rx", "ry", "rz"];
    let found: Vec<&str> = names.iter().zip(held).filter(|(_, h)| *h).map(|(n, _)| *n).collect();
    let expected = "no key for a meshed sleeper, or a plane of symmetry: [\"y\", \"rx\", \"rz\"] or [\"x\", \"ry\", \"rz\"], or both";
    Err(s.error("hold", format!("{found:?}"), expected))
}

fn feet(
    mesh: &Table<SleeperMesh>,
    seats: &[[f64; 2]],
    half: [f64; 3],
    along: usize,
) -> Result<Vec<[f64; 2]>, SceneError> {
    // Twice the distance from seat to edge.
    let room = |seat: &[f64; 2]| [0, 1].map(|d| 2.0 * (half[d] - seat[d].abs()));
    let Some(foot) = mesh.foot.map(|f| [f[0].si, f[1].si]) else {
        let across = 1 - along;
        let default = |seat: &[f64; 2]| {
            let mut foot = room(seat);
            foot[across] = foot[across].min(FOOT);
            foot
        };
        return Ok(seats.iter().map(default).collect());
    };
    let fits = |seat: &[f64; 2]| (0..2).all(|d| foot[d] >= 0.0 && foot[d] <= room(seat)[d] * (1.0 + 1e-12));
    match seats.iter().find(|s| !fits(s)) {
        Some(seat) => {
            let [x, y] = room(seat);
            let found = format!("[{}, {}]", foot[0], foot[1]);
            let expected =
                format!("0 to {x} and 0 to {y} m, which the seat at ({}, {}) has room for", seat[0], seat[1]);
            Err(mesh.error("foot", found, expected))
        }
        None => Ok(vec![foot; seats.len()]),
    }
}
