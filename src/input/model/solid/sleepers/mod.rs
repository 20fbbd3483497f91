//! Meshed sleepers: separate bodies of 20-node hexahedra after the ground in the mesh.
//!
//! They stay above the ground until the bed is deposited.

mod shares;
#[cfg(test)]
mod tests;

use crate::model::track::sleeper::MeshedSleepers;
use std::collections::BTreeMap;
use std::ops::Range;
use trackbed_coupling::surface::SolidSurface;
use trackbed_fem as fem;
use trackbed_fem::ElementKind;
use trackbed_fem::material::Material;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_track::SleeperMotion;

/// Tolerance relative to sleeper length.
const ON_PLANE: f64 = 1e-9;

/// Sleepers of a solid.
#[derive(Clone, Debug)]
pub struct SleeperBodies {
    plan: MeshedSleepers,
    ground_nodes: usize,
    ground_elements: usize,
    nodes: usize,
    /// Material number.
    pub material: u32,
    /// Base height before set-down [m].
    waiting: f64,
    /// Nodal weights of seat forces; nodes are numbered within a sleeper.
    seats: Vec<(u32, f64)>,
    volume: Vec<f64>,
    /// Base nodes: mean weight times offset over mean square offset [1/m].
    slopes: [Vec<(u32, f64)>; 2],
    /// Mean of both base ends minus the middle.
    bend: Vec<(u32, f64)>,
}

impl SleeperBodies {
    /// Adds sleepers with material and symmetry supports.
    pub fn add(
        plan: MeshedSleepers,
        mesh: &mut Mesh,
        materials: &mut BTreeMap<u32, Material>,
        constraints: &mut Vec<Constraint>,
    ) -> SleeperBodies {
        let material = (1..).find(|n| !materials.contains_key(n)).expect("there are fewer materials");
        materials.insert(material, plan.elastic.into());
        let alone = block(&plan, [0.0; 2], 0.0);
        let top = mesh.bounding_box().1[2];
        let bodies = SleeperBodies {
            ground_nodes: mesh.node_count(),
            ground_elements: mesh.element_count(),
            nodes: alone.node_count(),
            material,
            // Clear of all grains and load discs.
            waiting: top + 10.0 * plan.half.iter().sum::<f64>(),
            seats: shares::seats(&plan, &alone),
            volume: shares::volume(&alone),
            slopes: [0, 1].map(|d| shares::slope(&alone, d)),
            bend: shares::bend(&plan, &alone),
            plan,
        };
        let plan = &bodies.plan;
        let mut node_id = mesh.node_ids.iter().max().map_or(0, |n| *n);
        let mut element_id = mesh.element_ids.iter().max().map_or(0, |n| *n);
        for &centre in &plan.centres {
            let first = mesh.node_count() as u32;
            let own = block(plan, centre, bodies.waiting);
            for (x, base) in own.coordinates.iter().zip(&alone.coordinates) {
                for d in 0..2 {
                    if plan.symmetric[d] && base[d].abs() <= ON_PLANE * plan.half[d] {
                        let node = mesh.node_count() as u32;
                        constraints.push(Constraint { node, direction: d as u8, value: 0.0 });
                    }
                }
                mesh.coordinates.push(*x);
                node_id += 1;
                mesh.node_ids.push(node_id);
            }
            for nodes in own.connectivity.iter() {
                element_id += 1;
                let nodes: Vec<u32> = nodes.iter().map(|n| n + first).collect();
                mesh.push_element(element_id, material, ElementKind::Hex20, &nodes);
            }
        }
        bodies
    }

    /// Number of ground nodes, which come first.
    pub fn ground_nodes(&self) -> usize {
        self.ground_nodes
    }

    /// Number of ground elements, which come first.
    pub fn ground_elements(&self) -> usize {
        self.ground_elements
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.plan.centres.len()
    }

    /// Mass of a sleeper [kg].
    pub fn mass(&self) -> f64 {
        self.plan.elastic.density * self.plan.half.iter().map(|h| 2.0 * h).product::<f64>()
    }

    /// Returns the number of faces per sleeper.
    pub fn face_count(&self) -> usize {
        let [x, y, z] = self.plan.elements;
        2 * (x * y + y * z + z * x)
    }

    fn nodes_of(&self, k: usize) -> Range<usize> {
        let first = self.ground_nodes + k * self.nodes;
        first..first + self.nodes
    }

    /// Returns the model with sleeper bases at these heights [m].
    pub fn set_down(&self, model: &fem::Model, heights: &[f64]) -> fem::Model {
        let mut model = model.clone();
        for (k, height) in heights.iter().enumerate() {
            model = model.with_displaced_bodies(self.nodes_of(k), [0.0, 0.0, height - self.waiting]);
        }
        model
    }

    /// Returns the centre of sleeper `k` on height `base` [m].
    pub fn centre(&self, k: usize, base: f64) -> [f64; 3] {
        let [x, y] = self.plan.centres[k];
        [x, y, base + self.plan.half[2]]
    }

    /// Adds a downward seat force [N] on sleeper `k`, shape `[3·nodes]`.
    pub fn add_load(&self, k: usize, force: f64, load: &mut [f64]) {
        let first = self.nodes_of(k).start;
        self.seats.iter().for_each(|(n, share)| load[3 * (first + *n as usize) + 2] -= share * force);
    }

    /// Returns the mean seat uplift of sleeper `k` [m]; shape of `u` `[3·nodes]`.
    pub fn rise_of_seats(&self, k: usize, u: &[f64]) -> f64 {
        self.sum_z(k, u, &self.seats)
    }

    fn sum_z(&self, k: usize, u: &[f64], shares: &[(u32, f64)]) -> f64 {
        let first = self.nodes_of(k).start;
        shares.iter().map(|(n, share)| share * u[3 * (first + *n as usize) + 2]).sum()
    }

    /// Returns the motion of sleeper `k`; shape of `u` `[3·nodes]`.
    pub fn moved(&self, k: usize, u: &[f64]) -> SleeperMotion {
        let first = self.nodes_of(k).start;
        let mean = |d: usize| {
            self.volume.iter().enumerate().map(|(n, share)| share * u[3 * (first + n) + d]).sum::<f64>()
        };
        let [x, y] = [0, 1].map(|d| self.sum_z(k, u, &self.slopes[d]));
        SleeperMotion {
            translation: [0, 1, 2].map(mean),
            tilt: libm::atan(libm::hypot(x, y)),
            seats: self.rise_of_seats(k, u),
            bend: self.sum_z(k, u, &self.bend),
        }
    }

    /// Returns a sleeper as a separate model, with surface.
    ///
    /// # Errors
    /// As [`fem::Model::new`].
    pub fn alone(&self, model: &fem::Model) -> Result<(fem::Model, SolidSurface), fem::ModelError> {
        let mesh = block(&self.plan, [0.0; 2], 0.0);
        let mut constraints = Vec::new();
        for (node, x) in (0..).zip(&mesh.coordinates) {
            for d in (0..2).filter(|&d| self.plan.symmetric[d]) {
                if x[d].abs() <= ON_PLANE * self.plan.half[d] {
                    constraints.push(Constraint { node, direction: d as u8, value: 0.0 });
                }
            }
        }
        let body = fem::Model::new(fem::ModelInput {
            mesh,
            materials: [(1, self.plan.elastic.into())].into(),
            quadrature: model.quadrature(),
            mass: model.mass(),
            rayleigh: model.rayleigh(),
            constraints,
            ..fem::ModelInput::default()
        })?;
        let surface = SolidSurface::new(body.mesh(), body.mesh().boundary_faces());
        Ok((body, surface))
    }

    /// Returns base faces of extreme effective mass: corner, middle.
    pub fn telling_faces(&self, surface: &SolidSurface) -> Vec<u32> {
        let base = |k: &u32| surface.normal(*k, [0.0; 2])[2] < -0.5;
        let far = |k: u32| {
            let middle = surface.face_nodes(k).iter().map(|&n| surface.mesh_position(n));
            [0, 1].map(|d| middle.clone().map(|x| x[d] / 8.0).sum::<f64>()).map(|x| x * x).iter().sum::<f64>()
        };
        let of_base: Vec<u32> = (0..surface.faces().len() as u32).filter(base).collect();
        let least = of_base.iter().copied().min_by(|&a, &b| far(a).total_cmp(&far(b)));
        let most = of_base.iter().copied().max_by(|&a, &b| far(a).total_cmp(&far(b)));
        let mut faces: Vec<u32> = least.into_iter().chain(most).collect();
        faces.dedup();
        faces
    }
}

fn block(plan: &MeshedSleepers, centre: [f64; 2], base: f64) -> Mesh {
    let low = [centre[0] - plan.half[0], centre[1] - plan.half[1], base];
    let planes = [0, 1, 2].map(|d| {
        let n = plan.elements[d];
        (0..=n).map(|i| low[d] + 2.0 * plan.half[d] * i as f64 / n as f64).collect()
    });
    Mesh::grid(&planes)
}
