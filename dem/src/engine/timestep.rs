//! Stability limit of the time step.
//!
//! A body of mass m in contacts of stiffness K, lever arm r, oscillates at most at ω² = s K (1/m + r²/I), s
//! twice the number of contacts in one direction (Gershgorin's bound). Twice the damping is used to resolve
//! the restitution of single collisions:
//!
//! ω dt < √(4 + 16 ζ'²) − 4 ζ', ζ' = ζ √(s/2).
//!
//! - sphere: s = 12;
//! - clump: s = 24, or twice the members touching a plane if more; largest r²;
//! - box: s twice the neighbours of smallest bounding radius on its largest side, two contacts each (at least
//!   16 with other boxes); mean r².
//!
//! A rolling or twisting spring counts as a second tangential spring.
//!
//! If stiffness grows with overlap, the limit holds up to the expected overlap (3.7) of the densest body;
//! large external loads need [`ModelInput::impact_speed`]. Bonds add their own bound (`bond/limit.rs`).
//!
//! Theory manual: equation (3.6) of `docs/theory/motion.md`.

use super::input::ModelInput;
use crate::base::Vec3;
use crate::base::names::Names;
use crate::bodies::table::{Bodies, Body, BodyKind};
use crate::body_force;
use crate::bond;
use crate::contact::narrow_phase::{DEEPEST, LENGTH};
use crate::law::Laws;
use crate::law::normal::Expected;
use crate::shape::Shape;
use crate::shape::dilated::Dilated;
use crate::wall::set::Walls;
use crate::wall::shells::Shells;
use std::collections::BTreeSet;

/// Stability limit and its cause.
#[derive(Clone, Debug, PartialEq)]
pub struct DtLimit {
    /// Critical time step [s]; 1e-4 if no body can move.
    pub dt: f64,
    /// Governing body.
    pub body: usize,
    /// Material index of the stiffest partner.
    pub partner: usize,
    /// Contact stiffness [N/m].
    pub stiffness: f64,
    /// Effective mass at the outermost contact [kg].
    pub mass: f64,
    /// Governing rigid-body wall, instead of `body`.
    pub wall: Option<usize>,
    /// Squared frequency bound of bonds only [1/s²].
    pub bonds: f64,
    /// Squared frequency bound of the wall support [1/s²].
    pub mount: f64,
}

impl DtLimit {
    const FREE: DtLimit = DtLimit {
        dt: 1e-4,
        body: 0,
        partner: 0,
        stiffness: 0.0,
        mass: 0.0,
        wall: None,
        bonds: 0.0,
        mount: 0.0,
    };
}

impl DtLimit {
    /// Formats with names; `group`: of a body.
    pub fn describe(&self, names: &Names, group: impl Fn(usize) -> Option<u32>) -> String {
        let contact = match self.stiffness > 0.0 {
            true => {
                let material = names.material(self.partner);
                format!(" in contact with {material} (stiffness {:.3e} N/m)", self.stiffness)
            }
            false => String::new(),
        };
        if let Some(wall) = self.wall {
            let mount = match self.mount > 0.0 {
                true => format!(" on its mount ({:.3e} rad/s)", self.mount.sqrt()),
                false => String::new(),
            };
            return format!("the rigid body of {}{contact}{mount}", names.wall(wall));
        }
        let bonds = match self.bonds > 0.0 {
            true => format!(" and held by its bonds (up to {:.3e} rad/s)", self.bonds.sqrt()),
            false => String::new(),
        };
        let body = group(self.body).map_or_else(|| "no body".into(), |group| names.body(group, self.body));
        format!("{body} (effective mass {:.3e} kg){contact}{bonds}", self.mass)
    }
}

/// Shortest time constant of fluids on bodies and floating walls [s].
pub(crate) fn fluids(input: &ModelInput, bodies: &Bodies, walls: &Walls) -> f64 {
    body_force::time_constant(&input.body_forces, bodies, &input.gravity).min(walls.water_time())
}

pub(crate) fn limit(
    bodies: &Bodies,
    input: &ModelInput,
    laws: &Laws,
    expected: f64,
    bonds: &[bond::Constants],
    (r_min, r_max): (f64, f64),
) -> DtLimit {
    let bonded = bond::stiffest(bonds, bodies, &input.bodies);
    let levers = if laws.rolls() { 2.0 } else { 1.0 };
    let partners = partners(bodies, input);
    let several = bodies.iter().filter(|b| b.kind == BodyKind::Solid).count() > 1;
    let r_min = bodies
        .iter()
        .filter(|b| b.kind != BodyKind::Solid)
        .map(|b| b.radius)
        .fold(f64::INFINITY, f64::min)
        .clamp(r_min, f64::MAX);
    let mut least = DtLimit::FREE;
    let mut found = false;
    for (k, body) in bodies.iter().enumerate() {
        if body.fixed == 0b11_1111 {
            continue;
        }
        let shape = &input.shapes[body.shape];
        let flexibility = compliance(&body, shape);
        let radius = contact_radius(&body, shape, r_max);
        for &partner in &partners {
            let (a, b) = (body.material, partner as u32);
            let stiffness = laws.stiffness(a, b, expected * radius, radius);
            let tangential = stiffness * laws.tangential_ratio(a, b);
            if !stiffness.is_finite() {
                continue;
            }
            let sides = sides(shape, &body, (r_min, several), (laws, b, stiffness));
            // Tangential spring with rotation: 1/m + r²/I = 3.5/m.
            let own = if body.kind == BodyKind::Sphere {
                stiffness.max((1.0 + 2.5 * levers) * tangential) / body.mass
            } else {
                stiffness.max(tangential) * flexibility
                    + (levers - 1.0) * tangential * (flexibility - 1.0 / body.mass)
            };
            let zeta = laws.damping_ratio(a, b) * f64::sqrt(0.5 * sides);
            let bound = (4.0 + 16.0 * zeta * zeta).sqrt() - 4.0 * zeta;
            let alone = bound / (sides * own).sqrt();
            let [bond_stiffness, bond_damping] = bonded.get(k).copied().unwrap_or_default();
            let dt = if bond_stiffness > 0.0 {
                // Contacts and bonds together: (λ₁ + λ₂) dt² + (8 ζ' √λ₁ + 2 γ) dt = 4.
                let all = sides * own + bond_stiffness;
                let damping = 4.0 * zeta * (sides * own).sqrt() + bond_damping;
                ((damping * damping + 4.0 * all).sqrt() - damping) / all
            } else {
                alone
            };
            if !found || dt < least.dt {
                found = true;
                least = DtLimit {
                    dt,
                    body: k,
                    partner,
                    stiffness,
                    mass: stiffness / own,
                    bonds: bond_stiffness,
                    ..least
                };
            }
        }
    }
    least
}

/// Largest effective contact radius [m]: on a plane; for a box, largest sphere of the model.
pub(crate) fn contact_radius(body: &Body, shape: &Shape, largest: f64) -> f64 {
    match shape.query(|s| s.contact_radius()) {
        Some(radius) => body.scale * radius,
        None if largest > 0.0 => largest,
        None => body.radius,
    }
}

/// Returns s. `smallest`: neighbour radius [m]; `several`: other boxes exist; `corner`: corner stiffness
/// [N/m].
fn sides(
    shape: &Shape,
    body: &Body,
    (smallest, several): (f64, bool),
    (laws, b, corner): (&Laws, u32, f64),
) -> f64 {
    match shape {
        Shape::Polyhedron(it) => 2.0 * faces(it, body, laws, b, corner),
        _ => shape.query(|s| s.contacts(body.scale, smallest, several)),
    }
}

fn corners(it: &Dilated) -> f64 {
    it.core.faces.iter().map(|f| f.corners.len()).max().unwrap_or(0) as f64
}

/// Equivalent number of `corner` stiffnesses [N/m]: face on identical face, largest circumference.
fn faces(it: &Dilated, body: &Body, laws: &Laws, b: u32, corner: f64) -> f64 {
    2.0 * Face::of(it, body).worth(laws, [body.material, b], corner)
}

#[derive(Clone, Copy)]
struct Face {
    corners: f64,
    /// Circumference [m], then in edge lengths equivalent to one corner (linear law).
    around: f64,
    lengths: f64,
}

impl Face {
    fn of(it: &Dilated, body: &Body) -> Face {
        let around = it.core.circumference();
        Face { corners: corners(it), around: body.scale * around, lengths: around / (LENGTH * it.radius) }
    }

    fn max(&self, other: &Face) -> Face {
        Face {
            corners: self.corners.max(other.corners),
            around: self.around.max(other.around),
            lengths: self.lengths.max(other.lengths),
        }
    }

    /// Stiffness in units of `corner` [N/m].
    fn worth(&self, laws: &Laws, materials: [u32; 2], corner: f64) -> f64 {
        let edges = match laws.edges(materials) {
            None => self.lengths,
            Some([a, b]) => self.around * laws.stiffness(a, b, 0.0, 0.0) / corner,
        };
        self.corners + edges
    }
}

/// Longest step [s] for polyhedra landing on a face, where stiffness rises many-fold between two checks.
pub(crate) fn landing(bodies: &Bodies, input: &ModelInput, laws: &Laws, expected: f64) -> f64 {
    let partners = partners(bodies, input);
    let mut longest = f64::INFINITY;
    for body in bodies.iter().filter(|b| b.fixed != 0b11_1111) {
        let shape = &input.shapes[body.shape];
        let Shape::Polyhedron(it) = shape else { continue };
        for &partner in &partners {
            let (a, b) = (body.material, partner as u32);
            let corner = laws.stiffness(a, b, expected * body.radius, body.radius);
            let stiffness = corner * laws.tangential_ratio(a, b).max(1.0);
            let zeta = laws.damping_ratio(a, b);
            // Half the stable value: such collisions add energy near the limit.
            let bound = 0.5 * ((4.0 + 16.0 * zeta * zeta).sqrt() - 4.0 * zeta);
            if stiffness.is_finite() {
                let all = faces(it, &body, laws, b, corner) * stiffness;
                longest = longest.min(bound / (all * compliance(&body, shape)).sqrt());
            }
        }
    }
    longest
}

/// Expected overlap over effective radius; zero for constant stiffness.
pub(crate) fn expected_overlap(bodies: &Bodies, input: &ModelInput, laws: &Laws) -> f64 {
    let gravity = input.gravity.norm();
    let down = if gravity > 0.0 { input.gravity / gravity } else { Vec3::z() };
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut speed, mut density) = (0.0_f64, 0.0_f64);
    for (b, start) in bodies.iter().zip(&input.bodies) {
        let depth = start.position.dot(&down);
        range = (range.0.min(depth - b.radius), range.1.max(depth + b.radius));
        speed = speed.max(start.velocity.norm() + start.spin.norm() * b.radius);
        density = density.max(input.materials[b.material as usize].density);
    }
    let height = (range.1 - range.0).max(0.0);
    let walls = input.planes.iter().map(|p| p.velocity.norm());
    let walls = walls.chain(input.triangles.iter().map(|t| t.velocity.norm())).fold(0.0, f64::max);
    let speed = input.impact_speed.unwrap_or(speed.max(walls) + (2.0 * gravity * height).sqrt());
    laws.expected_overlap(&Expected { density, speed, gravity, height })
}

pub(crate) fn partners(bodies: &Bodies, input: &ModelInput) -> Vec<usize> {
    let mut used = vec![false; input.materials.len()];
    bodies.iter().for_each(|b| used[b.material as usize] = true);
    input.planes.iter().for_each(|p| used[p.material] = true);
    input.triangles.iter().for_each(|t| used[t.material] = true);
    input.walls.iter().for_each(|w| used[w.material] = true);
    let surfaces = input.surface_material.into_iter().chain(input.other_surface.map(|(_, m)| m));
    surfaces.for_each(|m| used[m] = true);
    (0..used.len()).filter(|&m| used[m]).collect()
}

/// 1/m + max over principal axes of (lever arm)²/I [1/kg].
fn compliance(body: &Body, shape: &Shape) -> f64 {
    let reach2 = shape.query(|s| s.levers2());
    let turn = (0..3).map(|k| reach2[k] * body.scale * body.scale / body.inertia[k]).fold(0.0, f64::max);
    1.0 / body.mass + turn
}

/// Material and smallest radius [m].
#[derive(Clone, Copy)]
struct Partner {
    material: u32,
    radius: f64,
    /// Of polyhedra and disks.
    face: Option<Face>,
}

fn touching(bodies: &Bodies, input: &ModelInput, radius: f64) -> Vec<Partner> {
    let grains = bodies.iter().map(|b| b.material);
    let planes = input.planes.iter().map(|p| p.material as u32);
    let all: BTreeSet<u32> = grains.chain(planes).collect();
    let mut partners: Vec<Partner> =
        all.into_iter().map(|material| Partner { material, radius, face: None }).collect();
    let mut faced: Vec<Partner> = Vec::new();
    for body in bodies.iter() {
        let Shape::Polyhedron(it) = &input.shapes[body.shape] else { continue };
        let own = Face::of(it, &body);
        match faced.iter_mut().find(|p| p.material == body.material) {
            None => faced.push(Partner { material: body.material, radius: body.radius, face: Some(own) }),
            Some(p) => {
                p.radius = p.radius.min(body.radius);
                p.face = p.face.map(|f| f.max(&own));
            }
        }
    }
    // Polyhedra have no other partners.
    let round = |m: u32| {
        let point = |b: &Body| b.material == m && !matches!(input.shapes[b.shape], Shape::Polyhedron(_));
        bodies.iter().any(|b| point(&b)) || input.planes.iter().any(|p| p.material as u32 == m)
    };
    partners.retain(|p| round(p.material));
    partners.extend(faced);
    partners
}

/// Sets servo damping and rigid-body step limits; returns the longest step [s] stable for contacts arising
/// between checks.
pub(crate) fn walls(
    walls: &mut Walls,
    limit: &mut DtLimit,
    bodies: &Bodies,
    input: &ModelInput,
    laws: &Laws,
    expected: f64,
    radii: (f64, f64),
) -> f64 {
    let mut least = f64::INFINITY;
    let grains: BTreeSet<u32> = bodies.iter().map(|b| b.material).collect();
    let partners = if input.walls.iter().any(|w| w.body.is_some()) {
        touching(bodies, input, radii.0)
    } else {
        Vec::new()
    };
    for (k, wall) in walls.walls.iter_mut().enumerate() {
        wall.damping = grains.iter().map(|&m| laws.damping_ratio(wall.material, m)).fold(0.0, f64::max);
        let Some(body) = wall.body.as_ref().filter(|b| b.fixed != 0b11_1111) else { continue };
        let mount = body.mount_frequency();
        let mut note = |dt: f64, sudden: f64, partner: usize, stiffness: f64| {
            least = least.min(sudden);
            if dt < limit.dt {
                let (bonds, mass) = (0.0, body.mass);
                *limit = DtLimit { dt, body: 0, partner, stiffness, mass, bonds, wall: Some(k), mount };
            }
        };
        if mount > 0.0 {
            let dt = 2.0 / mount.sqrt();
            note(dt, dt, 0, 0.0);
        }
        for &Partner { material, radius, face } in &partners {
            let point = laws.stiffness(wall.material, material, expected * radii.1, radii.1);
            let times = face.map_or(1.0, |f| f.worth(laws, [wall.material, material], point));
            let stiffness = times * point;
            if !stiffness.is_finite() {
                continue;
            }
            let ratio = laws.tangential_ratio(wall.material, material) * if laws.rolls() { 2.0 } else { 1.0 };
            let zeta = laws.damping_ratio(wall.material, material);
            let dt = body.step_limit(stiffness, stiffness * ratio, zeta, radius);
            // Existing face contacts are measured; new ones may form between two checks.
            let sudden = if face.is_some() {
                0.5 * body.step_limit(stiffness, stiffness * ratio, zeta, f64::INFINITY)
            } else {
                dt
            };
            note(dt, sudden, material as usize, stiffness);
        }
    }
    least
}

/// As `walls`, for walls landing flat on each other ([`Shells`]).
pub(crate) fn shells(walls: &mut Walls, limit: &mut DtLimit, shells: &Shells, laws: &Laws) -> f64 {
    let mut least = f64::INFINITY;
    for &[a, b] in &shells.pairs {
        let [own, other] = [a, b].map(|k| walls.walls[k as usize].material);
        let [first, second] = [shells.radius(a), shells.radius(b)];
        let reach = first + second;
        // Stiffness just before interpenetration is rejected.
        let corner = laws.stiffness(own, other, DEEPEST * reach, first.max(second));
        let edge = match laws.edges([own, other]) {
            None => corner / (LENGTH * reach),
            Some([a, b]) => laws.stiffness(a, b, 0.0, 0.0),
        };
        let [corners, length] = shells.flattest([a, b], reach);
        let stiffness = corners * corner + length * edge;
        let ratio = laws.tangential_ratio(own, other) * if laws.rolls() { 2.0 } else { 1.0 };
        let zeta = laws.damping_ratio(own, other);
        // The servo needs the dashpots of its contacts.
        let driven = &mut walls.walls[b as usize].damping;
        *driven = driven.max(zeta);
        for k in [a, b] {
            let body = walls.walls[k as usize].body.as_ref();
            let Some(body) = body.filter(|b| b.fixed != 0b11_1111) else { continue };
            let dt = body.step_limit(stiffness, stiffness * ratio, zeta, f64::INFINITY);
            least = least.min(0.5 * dt);
            if dt < limit.dt {
                let partner = if k == a { other } else { own } as usize;
                let (bonds, mass, wall, mount) = (0.0, body.mass, Some(k as usize), body.mount_frequency());
                *limit = DtLimit { dt, body: 0, partner, stiffness, mass, bonds, wall, mount };
            }
        }
    }
    least
}
