//! Nodal forces with time histories.

use super::common::time_function;
use super::geometry::Geometry;
use super::location::Locator;
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
    /// (degree of freedom, force [N]) pairs.
    pub entries: Vec<(usize, f64)>,
    /// Load factor over time.
    pub function: TimeFunction,
}

impl NodalLoad {
    /// Adds the load at time `t` [s], shape `[3·nodes]`.
    pub fn add(&self, t: f64, load: &mut [f64]) {
        let factor = self.function.factor(t);
        if factor != 0.0 {
            for &(dof, value) in &self.entries {
                load[dof] += factor * value;
            }
        }
    }
}

/// Resolves a `[[solid.load]]`.
///
/// # Errors
/// Wrong keys, or no face.
pub fn nodal_load(load: &Table<SolidLoad>, geometry: &Geometry) -> Result<NodalLoad, SceneError> {
    use SolidLoadKind::{Point, Pressure, Traction};
    let mesh = &geometry.mesh;
    let function = time_function(load.optional("history", &load.history))?;
    let mut pattern = vec![0.0; 3 * mesh.node_count()];
    let (mut loaded, mut forces) = (Vec::new(), Vec::new());
    match load.kind {
        SolidLoadKind::Pressure | SolidLoadKind::Traction => {
            let pressure = load.kind == SolidLoadKind::Pressure;
            load.reject_without([("traction", pressure && load.traction.is_some())], &kinds(&[Traction]))?;
            load.reject_without([("pressure", !pressure && load.pressure.is_some())], &kinds(&[Pressure]))?;
            let of_points =
                [("node", load.node.is_some()), ("at", load.at.is_some()), ("force", load.force.is_some())];
            load.reject_without(of_points, &kinds(&[Point]))?;
            let (list, set) = (load.faces.as_deref(), load.set.as_deref());
            let faces = selection::faces(load, geometry, list, load.faces_in, load.side, set)?;
            for face in &faces {
                let before = sum(face, &pattern);
                if pressure {
                    let p = load.need("pressure", load.pressure, "a value for a pressure load")?.si;
                    fem::loads::face_pressure(mesh, face, p, &mut pattern);
                } else {
                    let t = vector(&load.need("traction", load.traction, "a value for a traction load")?);
                    fem::loads::face_traction(mesh, face, t, &mut pattern);
                }
                let after = sum(face, &pattern);
                forces.push((face.centre(mesh), [0, 1, 2].map(|d| after[d] - before[d])));
            }
            loaded = faces;
        }
        SolidLoadKind::Point => {
            let of_faces = [
                ("faces", load.faces.is_some()),
                ("faces_in", load.faces_in.is_some()),
                ("side", load.side.is_some()),
                ("set", load.set.is_some()),
            ];
            load.reject_without(of_faces, &kinds(&[Pressure, Traction]))?;
            load.reject_without([("pressure", load.pressure.is_some())], &kinds(&[Pressure]))?;
            load.reject_without([("traction", load.traction.is_some())], &kinds(&[Traction]))?;
            let force = vector(&load.need("force", load.force, "a value for a point load")?);
            match (load.node, load.at) {
                (Some(id), None) => {
                    let node = selection::find_node(load, mesh, id)?;
                    for d in 0..3 {
                        pattern[3 * node + d] += force[d];
                    }
                    forces.push((mesh.coordinates[node], force));
                }
                (None, Some(at)) => {
                    point_load(load, mesh, vector(&at), force, &mut pattern)?;
                    forces.push((vector(&at), force));
                }
                (node, _) => return Err(load.choice(["node", "at"], node.is_some())),
            }
        }
    }
    let entries = pattern.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(i, v)| (i, *v)).collect();
    Ok(NodalLoad { faces: loaded, forces, entries, function })
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
