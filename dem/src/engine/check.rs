//! Checks of model input.

use super::input::{ModelInput, SearchSkin, TimeStep};
use super::timestep;
use crate::base::error::ModelError;
use crate::bodies::table::{Bodies, Body};
use crate::law::material::Material;
use crate::law::parameter::{self, first_invalid};
use crate::law::{self, Laws, conical_damage};
use crate::shape::Shape;
use crate::wall::check::in_range;
use crate::wall::set::Walls;
use crate::wall::shells::Shells;

const POSITIVE: &str = "be positive and finite";
const NOT_NEGATIVE: &str = "be zero or positive, and finite";

fn positive(x: f64) -> bool {
    x > 0.0 && x.is_finite()
}

fn not_negative(x: f64) -> bool {
    x >= 0.0 && x.is_finite()
}

fn crushing_takes_energy(m: &Material) -> bool {
    let modulus = m.young.map_or(f64::INFINITY, |young| 0.5 * young / (1.0 - m.poisson * m.poisson));
    m.corner_strength.is_infinite()
        || m.corner_strength < conical_damage::greatest_strength(modulus, m.corner_angle)
}

pub(crate) fn input(input: &ModelInput) -> Result<(), ModelError> {
    materials(input)?;
    shapes(input)?;
    bodies(input)?;
    walls(input)?;
    settings(input)
}

fn materials(input: &ModelInput) -> Result<(), ModelError> {
    for (material, m) in input.materials.iter().enumerate() {
        if let Some((p, value)) = first_invalid(&parameter::MATERIAL, m) {
            return Err(ModelError::Material { material, parameter: p.key, value, expected: p.expected() });
        }
        if !crushing_takes_energy(m) {
            let expected = "a strength for which crushing dissipates energy".to_string();
            let (parameter, value) = ("corner_strength", m.corner_strength);
            return Err(ModelError::Material { material, parameter, value, expected });
        }
    }
    for (index, pair) in input.contacts.iter().enumerate() {
        for found in [pair.a, pair.b] {
            in_range("contact override", index, "material", found, input.materials.len())?;
        }
        if let Some((p, value)) = first_invalid(&parameter::PAIR, pair) {
            return Err(ModelError::Pair { index, parameter: p.key, value, expected: p.expected() });
        }
    }
    law::check::laws(&input.materials, &input.contacts)
}

fn shapes(input: &ModelInput) -> Result<(), ModelError> {
    for (shape, s) in input.shapes.iter().enumerate() {
        if let Some(problem) = s.query(|s| s.fault()) {
            return Err(ModelError::Shape { shape, problem });
        }
    }
    Ok(())
}

fn bodies(input: &ModelInput) -> Result<(), ModelError> {
    for (index, b) in input.bodies.iter().enumerate() {
        in_range("body", index, "shape", b.shape, input.shapes.len())?;
        in_range("body", index, "material", b.material, input.materials.len())?;
        let error =
            |quantity, value, requirement| ModelError::Body { body: index, quantity, value, requirement };
        if !positive(b.scale) {
            return Err(error("scale", b.scale, POSITIVE));
        }
        if let Some(mass) = b.mass.filter(|&m| !positive(m)) {
            return Err(error("mass", mass, POSITIVE));
        }
        for (quantity, v) in [("position", b.position), ("velocity", b.velocity), ("spin", b.spin)] {
            if let Some(&value) = v.iter().find(|x| !x.is_finite()) {
                return Err(error(quantity, value, "be finite"));
            }
        }
        if let Some(problem) = input.shapes[b.shape].query(|s| s.permanent()).filter(|_| b.absent) {
            return Err(ModelError::Absent { body: index, problem });
        }
        if (b.orientation.norm() - 1.0).abs() > 1e-6 || b.orientation.norm().is_nan() {
            return Err(error("norm of the orientation", b.orientation.norm(), "be 1"));
        }
    }
    Ok(())
}

pub(crate) fn absent_bonds(input: &ModelInput) -> Result<(), ModelError> {
    match input.bonds.iter().flat_map(|b| [b.a, b.b]).find(|&b| input.bodies[b].absent) {
        Some(body) => Err(ModelError::Absent { body, problem: "a bond holds it" }),
        None => Ok(()),
    }
}

fn walls(input: &ModelInput) -> Result<(), ModelError> {
    let count = input.materials.len();
    for (index, p) in input.planes.iter().enumerate() {
        in_range("plane", index, "material", p.material, count)?;
        let problem = if !positive(p.normal.norm()) {
            "its normal must have a finite length above zero"
        } else if !p.point.iter().chain(p.velocity.iter()).all(|x| x.is_finite()) {
            "its point and velocity must be finite"
        } else {
            continue;
        };
        return Err(ModelError::Wall { wall: format!("plane {index}"), problem });
    }
    for (index, t) in input.triangles.iter().enumerate() {
        in_range("triangle surface", index, "material", t.material, count)?;
        if !t.velocity.iter().all(|x| x.is_finite()) {
            let problem = "its velocity must be finite";
            return Err(ModelError::Wall { wall: format!("triangle surface {index}"), problem });
        }
    }
    crate::wall::check::walls(&input.walls, count)?;
    if let Some(mesh) = &input.surface_mesh {
        let problem = if mesh.triangles.iter().flatten().any(|&v| v as usize >= mesh.vertices.len()) {
            "one of its triangles names a vertex that does not exist"
        } else if input.surface_material.is_none() {
            "it has no material"
        } else {
            ""
        };
        if !problem.is_empty() {
            return Err(ModelError::Wall { wall: "the external surface".into(), problem });
        }
    }
    for m in surfaces(input) {
        in_range("surface", 0, "material", m, count)?;
    }
    Ok(())
}

pub(crate) fn surfaces(input: &ModelInput) -> impl Iterator<Item = usize> {
    input.surface_material.into_iter().chain(input.other_surface.map(|(_, m)| m))
}

fn settings(input: &ModelInput) -> Result<(), ModelError> {
    let error = |quantity, value, requirement| Err(ModelError::StepContext { quantity, value, requirement });
    if let Some(&g) = input.gravity.iter().find(|x| !x.is_finite()) {
        return error("gravity", g, "be finite");
    }
    if let Some(speed) = input.impact_speed.filter(|&v| !not_negative(v)) {
        return error("impact speed", speed, NOT_NEGATIVE);
    }
    match input.time_step {
        TimeStep::Auto { fraction } | TimeStep::Measured { share: fraction, .. }
            if !(fraction > 0.0 && fraction <= 1.0) =>
        {
            return error("time step fraction", fraction, "lie above 0 and not above 1");
        }
        TimeStep::Fixed(dt) | TimeStep::FixedAboveLimit(dt) if !positive(dt) => {
            return error("time step", dt, POSITIVE);
        }
        _ => {}
    }
    let (SearchSkin::Share(skin) | SearchSkin::Distance(skin)) = input.skin;
    if !positive(skin) {
        return error("skin", skin, POSITIVE);
    }
    if let Some((quantity, value, requirement)) = input.body_forces.iter().find_map(|f| f.fault()) {
        return error(quantity, value, requirement);
    }
    if let Some(d) = input.damping.filter(|d| !(d.factor >= 0.0 && d.factor < 1.0)) {
        return error("local damping factor", d.factor, "lie in [0, 1)");
    }
    Ok(())
}

pub(crate) fn rigid_pairs(bodies: &Bodies, input: &ModelInput, laws: &Laws) -> Result<(), ModelError> {
    let endless = |a: u32, b: usize| laws.rigid(a, b as u32);
    let names = &input.names;
    let body = |k: usize| names.body(input.bodies[k].part, k);
    let count = input.materials.len();
    let hard = |m: u32| (0..count).any(|other| endless(m, other));
    let rigid: Vec<usize> = (0..bodies.len()).filter(|&k| hard(bodies.get(k).material)).collect();
    for (n, &i) in rigid.iter().enumerate() {
        let a = &bodies.get(i);
        let error = |b: String| Err(ModelError::RigidPair { a: body(i), b });
        for &j in &rigid[n + 1..] {
            let b = &bodies.get(j);
            let still = a.inverse_mass == 0.0 && b.inverse_mass == 0.0;
            if !still && endless(a.material, b.material as usize) {
                return error(body(j));
            }
        }
        if a.inverse_mass == 0.0 {
            continue;
        }
        if let Some(p) = input.planes.iter().position(|p| endless(a.material, p.material)) {
            return error(names.plane(p));
        }
        // Boxes interact with neither.
        if !matches!(input.shapes[a.shape], Shape::Box { .. }) {
            if let Some(t) = input.triangles.iter().position(|t| endless(a.material, t.material)) {
                return error(format!("triangle surface {t}"));
            }
            if let Some(t) = input.walls.iter().position(|w| endless(a.material, w.material)) {
                return error(names.wall(input.triangles.len() + t));
            }
            if surfaces(input).any(|m| endless(a.material, m)) {
                return error("the surface".to_string());
            }
        }
    }
    for (w, wall) in input.walls.iter().enumerate().filter(|(_, w)| w.body.is_some()) {
        let error = |b: String| {
            Err(ModelError::RigidPair {
                a: format!("the rigid body of {}", names.wall(input.triangles.len() + w)),
                b,
            })
        };
        if let Some(b) = rigid.iter().find(|&&b| endless(bodies.get(b).material, wall.material)) {
            return error(body(*b));
        }
        if let Some(p) = input.planes.iter().position(|p| endless(wall.material as u32, p.material)) {
            return error(names.plane(p));
        }
    }
    Ok(())
}

pub(crate) fn polyhedra(bodies: &Bodies, input: &ModelInput, laws: &Laws) -> Result<(), ModelError> {
    let is_one = |b: &Body| matches!(input.shapes[b.shape], Shape::Polyhedron(_));
    let Some(first) = bodies.iter().find(is_one) else { return Ok(()) };
    let error = |problem: String| Err(ModelError::Shape { shape: first.shape, problem });
    if surfaces(input).next().is_some() && input.surface_mesh.is_none() {
        let what = "an external surface that is not given as triangles";
        return error(format!("a dilated polyhedron or disk; {what} cannot be combined with it"));
    }
    let partners = timestep::partners(bodies, input);
    for body in bodies.iter().filter(is_one) {
        let grows = |b: &&usize| {
            let at = |overlap| laws.stiffness(body.material, **b as u32, overlap, 1.0);
            at(1.0) != at(2.0) && laws.edges([body.material, **b as u32]).is_none()
        };
        if let Some(b) = partners.iter().find(grows) {
            return error(format!(
                "a dilated polyhedron or disk; the stiffness of its material {} with material {b} grows with the overlap, and only linear \
                 springs and Hertz's law can be spread along its edges",
                body.material
            ));
        }
    }
    Ok(())
}

/// Rejects wall–wall contacts that are rigid, or nonlinear without an edge law.
pub(crate) fn shells(walls: &Walls, shells: &Shells, laws: &Laws) -> Result<(), ModelError> {
    for &[a, b] in &shells.pairs {
        let [own, other] = [a, b].map(|k| walls.walls[k as usize].material);
        if laws.rigid(own, other) {
            let [a, b] = [a, b].map(|k| walls.name(k as usize));
            let a = format!("the rigid body of {a}");
            return Err(ModelError::RigidPair { a, b });
        }
        let at = |overlap| laws.stiffness(own, other, overlap, 1.0);
        if at(1.0) != at(2.0) && laws.edges([own, other]).is_none() {
            let problem = "a rigid body of triangles in contact with other walls supports only linear and Hertz contacts";
            return Err(ModelError::Wall { wall: walls.name(a as usize), problem });
        }
    }
    Ok(())
}

pub(crate) fn scarring(bodies: &Bodies, input: &ModelInput) -> Result<(), ModelError> {
    let Some(wall) = input.walls.iter().position(|w| w.scarring.is_some()) else { return Ok(()) };
    let error = |problem| Err(ModelError::Wall { wall: format!("wall {wall}"), problem });
    if bodies.iter().any(|b| !matches!(input.shapes[b.shape], Shape::Polyhedron(_))) {
        return error("scarring supports only dilated polyhedra and disks");
    }
    if input.gravity.norm() == 0.0 {
        return error("scarring requires gravity");
    }
    Ok(())
}

pub(crate) fn adhesion(input: &ModelInput) -> Result<(), ModelError> {
    let Some(index) = input.contacts.iter().position(|c| c.adhesion.is_some_and(|w| w > 0.0)) else {
        return Ok(());
    };
    let error = |with| Err(ModelError::Adhesion { index, with });
    if input.bodies.iter().any(|b| input.shapes[b.shape].query(|s| s.sphere_count()) == 0) {
        return error("boxes and polyhedra");
    }
    if !input.bonds.is_empty() {
        return error("bonds");
    }
    if input.walls.iter().any(|w| w.body.is_some()) {
        return error("rigid bodies of walls");
    }
    Ok(())
}

/// Checks a fixed step; `time` [s].
///
/// # Errors
/// A step longer than the response time to fluid drag or lift.
pub(crate) fn fluid_step(step: &TimeStep, time: f64) -> Result<(), ModelError> {
    match *step {
        TimeStep::Fixed(dt) if dt > time => {
            let cause = "the drag or lift of a fluid on the lightest body".to_string();
            Err(ModelError::TimeStep { dt, limit: time, cause })
        }
        _ => Ok(()),
    }
}
