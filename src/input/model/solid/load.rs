//! Nodal forces with time histories.

use super::common::time_function;
use super::geometry::Geometry;
use super::location::Locator;
use super::moving::MovingForce;
use super::selection;
use crate::scene::history::TimeFunction;
use crate::scene::solid::{SolidLoad, SolidLoadKind};
use crate::scene::units::vector;
use crate::scene::{SceneError, Table, kinds};
use trackbed_fem as fem;
use trackbed_fem::mesh::{Face, Mesh};

/// Load pattern with time history.
pub struct NodalLoad {
    /// Loaded faces.
    pub faces: Vec<Face>,
    /// Centres of the faces, or the loaded point [m], and forces there [N].
    pub forces: Vec<([f64; 3], [f64; 3])>,
    pattern: Pattern,
    /// Load factor over time.
    pub function: TimeFunction,
}

enum Pattern {
    /// (degree of freedom, force [N]) pairs.
    Fixed(Vec<(usize, f64)>),
    Moving(MovingForce),
}

impl NodalLoad {
    /// Adds the load at time `t` [s], shape `[3·nodes]`.
    pub fn add(&self, t: f64, load: &mut [f64]) {
        let factor = self.function.factor(t);
        if factor == 0.0 {
            return;
        }
        match &self.pattern {
            Pattern::Fixed(entries) => entries.iter().for_each(|(dof, value)| load[*dof] += factor * value),
            Pattern::Moving(moving) => moving.add(t, factor, load),
        }
    }
}

/// Resolves a `[[solid.load]]`.
///
/// # Errors
/// Wrong keys, or no face.
pub fn nodal_load(load: &Table<SolidLoad>, geometry: &Geometry) -> Result<NodalLoad, SceneError> {
    let mesh = &geometry.mesh;
    let function = time_function(load.optional("history", &load.history))?;
    reject_other_keys(load)?;
    let mut pattern = vec![0.0; 3 * mesh.node_count()];
    let (mut faces, mut forces) = (Vec::new(), Vec::new());
    match load.kind {
        SolidLoadKind::Pressure | SolidLoadKind::Traction => {
            faces = on_faces(load, geometry, &mut pattern, &mut forces)?;
        }
        SolidLoadKind::Point => forces.push(point(load, mesh, &mut pattern)?),
        SolidLoadKind::Moving => {
            let moving = MovingForce::new(load, mesh)?;
            forces.extend(load.path.zip(load.force).map(|(path, force)| (vector(&path[0]), vector(&force))));
            return Ok(NodalLoad { faces, forces, pattern: Pattern::Moving(moving), function });
        }
    }
    let entries = pattern.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(i, v)| (i, *v)).collect();
    Ok(NodalLoad { faces, forces, pattern: Pattern::Fixed(entries), function })
}

/// Each key belongs to some kinds.
fn reject_other_keys(load: &Table<SolidLoad>) -> Result<(), SceneError> {
    use SolidLoadKind::{Moving, Point, Pressure, Traction};
    let given: [(&str, bool, &[SolidLoadKind]); 14] = [
        ("faces", load.faces.is_some(), &[Pressure, Traction]),
        ("faces_in", load.faces_in.is_some(), &[Pressure, Traction]),
        ("side", load.side.is_some(), &[Pressure, Traction]),
        ("set", load.set.is_some(), &[Pressure, Traction]),
        ("pressure", load.pressure.is_some(), &[Pressure]),
        ("traction", load.traction.is_some(), &[Traction]),
        ("node", load.node.is_some(), &[Point]),
        ("at", load.at.is_some(), &[Point]),
        ("force", load.force.is_some(), &[Point, Moving]),
        ("path", load.path.is_some(), &[Moving]),
        ("speed", load.speed.is_some(), &[Moving]),
        ("start", load.start.is_some(), &[Moving]),
        ("axles", load.axles.is_some(), &[Moving]),
        ("size", load.size.is_some(), &[Moving]),
    ];
    for (key, found, allowed) in given {
        load.reject_without([(key, found && !allowed.contains(&load.kind))], &kinds(allowed))?;
    }
    Ok(())
}

fn on_faces(
    load: &Table<SolidLoad>,
    geometry: &Geometry,
    pattern: &mut [f64],
    forces: &mut Vec<([f64; 3], [f64; 3])>,
) -> Result<Vec<Face>, SceneError> {
    let mesh = &geometry.mesh;
    let (list, set) = (load.faces.as_deref(), load.set.as_deref());
    let faces = selection::faces(load, geometry, list, load.faces_in, load.side, set)?;
    for face in &faces {
        let before = sum(face, pattern);
        if load.kind == SolidLoadKind::Pressure {
            let p = load.need("pressure", load.pressure, "a value for a pressure load")?.si;
            fem::loads::face_pressure(mesh, face, p, pattern);
        } else {
            let t = vector(&load.need("traction", load.traction, "a value for a traction load")?);
            fem::loads::face_traction(mesh, face, t, pattern);
        }
        let after = sum(face, pattern);
        forces.push((face.centre(mesh), [0, 1, 2].map(|d| after[d] - before[d])));
    }
    Ok(faces)
}

/// Returns the loaded point and the force.
fn point(
    load: &Table<SolidLoad>,
    mesh: &Mesh,
    pattern: &mut [f64],
) -> Result<([f64; 3], [f64; 3]), SceneError> {
    let force = vector(&load.need("force", load.force, "a value for a point load")?);
    match (load.node, load.at) {
        (Some(id), None) => {
            let node = selection::find_node(load, mesh, id)?;
            for d in 0..3 {
                pattern[3 * node + d] += force[d];
            }
            Ok((mesh.coordinates[node], force))
        }
        (None, Some(at)) => {
            point_load(load, mesh, vector(&at), force, pattern)?;
            Ok((vector(&at), force))
        }
        (node, _) => Err(load.choice(["node", "at"], node.is_some())),
    }
}

fn sum(face: &Face, pattern: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|d| face.nodes().iter().map(|n| pattern[3 * *n as usize + d]).sum())
}

fn point_load(
    load: &Table<SolidLoad>,
    mesh: &Mesh,
    point: [f64; 3],
    force: [f64; 3],
    pattern: &mut [f64],
) -> Result<(), SceneError> {
    // Slack for points on the surface.
    const SLACK: f64 = 1e-9;
    let Some((e, xi)) = Locator::new(mesh, mesh.element_count()).find(point, SLACK) else {
        let found = format!("({}, {}, {})", point[0], point[1], point[2]);
        return Err(load.error("at", found, "a point of the solid"));
    };
    let n = mesh.connectivity.kind(e).shape_functions(xi);
    for (&node, n) in mesh.connectivity[e].iter().zip(n) {
        for d in 0..3 {
            pattern[3 * node as usize + d] += n * force[d];
        }
    }
    Ok(())
}
