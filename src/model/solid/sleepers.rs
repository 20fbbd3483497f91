//! Meshed sleepers: bodies of 20-node hexahedra behind the ground in the solid's mesh, joined to nothing.
//!
//! They wait above the ground until the bed is made, and are then set down on it: matrices do not depend on a body's
//! place. All sleepers of a scene are alike and numbered alike, so that what holds for the nodes of one does for all.

use crate::model::track::sleeper::MeshedSleepers;
use std::collections::BTreeMap;
use std::ops::Range;
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::track::SleeperMotion;
use trackbed_fem as fem;
use trackbed_fem::ElementKind;
use trackbed_fem::material::Material;
use trackbed_fem::mesh::{Constraint, Mesh};

/// Part of a sleeper's length within which a node counts as on a plane.
const ON_PLANE: f64 = 1e-9;
/// Points and weights of the rule of three points on −1 to 1, exact for the shape functions along a line.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// The sleepers of a solid.
#[derive(Clone, Debug)]
pub struct SleeperBodies {
    plan: MeshedSleepers,
    ground_nodes: usize,
    ground_elements: usize,
    /// Nodes of one sleeper.
    nodes: usize,
    /// Number of their material.
    pub material: u32,
    /// Height of their base while they wait [m].
    waiting: f64,
    /// Share of each node in a force on the seats; in what follows nodes are numbered within a sleeper.
    seats: Vec<(u32, f64)>,
    /// Share of each node in the mean over the volume.
    volume: Vec<f64>,
    /// Nodes of the base: share in the mean, times the offset from the middle over the mean square of that [1/m].
    slopes: [Vec<(u32, f64)>; 2],
    /// Mean of both ends of the base less that of its middle.
    bend: Vec<(u32, f64)>,
}

impl SleeperBodies {
    /// Adds the sleepers to the mesh of the ground, with a material and the supports of their planes of symmetry.
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
            // Far from every stone and from the ground's discs.
            waiting: top + 10.0 * plan.half.iter().sum::<f64>(),
            seats: seats(&plan, &alone),
            volume: volume(&alone),
            slopes: [0, 1].map(|d| slope(&alone, d)),
            bend: bend(&plan, &alone),
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

    /// Nodes of the ground, which come first.
    pub fn ground_nodes(&self) -> usize {
        self.ground_nodes
    }

    /// Elements of the ground, which come first.
    pub fn ground_elements(&self) -> usize {
        self.ground_elements
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.plan.centres.len()
    }

    /// Mass of one [kg].
    pub fn mass(&self) -> f64 {
        self.plan.elastic.density * self.plan.half.iter().map(|h| 2.0 * h).product::<f64>()
    }

    /// Faces of one.
    pub fn face_count(&self) -> usize {
        let [x, y, z] = self.plan.elements;
        2 * (x * y + y * z + z * x)
    }

    /// Nodes of sleeper `k` in the solid's mesh.
    fn nodes_of(&self, k: usize) -> Range<usize> {
        let first = self.ground_nodes + k * self.nodes;
        first..first + self.nodes
    }

    /// The model with the base of each sleeper at a height [m].
    pub fn set_down(&self, model: &fem::Model, heights: &[f64]) -> fem::Model {
        let mut model = model.clone();
        for (k, height) in heights.iter().enumerate() {
            model = model.with_bodies_moved(self.nodes_of(k), [0.0, 0.0, height - self.waiting]);
        }
        model
    }

    /// Centre of sleeper `k` whose base was set down at the height `base` [m].
    pub fn centre(&self, k: usize, base: f64) -> [f64; 3] {
        let [x, y] = self.plan.centres[k];
        [x, y, base + self.plan.half[2]]
    }

    /// Adds a downward force [N] on the seats of sleeper `k` to nodal loads, shape `[3·nodes]`.
    pub fn add_load(&self, k: usize, force: f64, load: &mut [f64]) {
        let first = self.nodes_of(k).start;
        self.seats.iter().for_each(|(n, share)| load[3 * (first + *n as usize) + 2] -= share * force);
    }

    /// Rise of the seats of sleeper `k`, mean under the load [m], by the displacements `u`, shape `[3·nodes]`.
    pub fn rise_of_seats(&self, k: usize, u: &[f64]) -> f64 {
        self.sum_z(k, u, &self.seats)
    }

    fn sum_z(&self, k: usize, u: &[f64], shares: &[(u32, f64)]) -> f64 {
        let first = self.nodes_of(k).start;
        shares.iter().map(|(n, share)| share * u[3 * (first + *n as usize) + 2]).sum()
    }

    /// How sleeper `k` has moved by the displacements `u`, shape `[3·nodes]`.
    pub fn moved(&self, k: usize, u: &[f64]) -> SleeperMotion {
        let first = self.nodes_of(k).start;
        let mean = |d: usize| {
            self.volume.iter().enumerate().map(|(n, share)| share * u[3 * (first + n) + d]).sum::<f64>()
        };
        let [x, y] = [0, 1].map(|d| self.sum_z(k, u, &self.slopes[d]));
        SleeperMotion {
            way: [0, 1, 2].map(mean),
            tilt: x.hypot(y).atan(),
            seats: self.rise_of_seats(k, u),
            bend: self.sum_z(k, u, &self.bend),
        }
    }

    /// One sleeper as a model of its own, in the manner of `model`, and its surface.
    ///
    /// # Errors
    /// As [`fem::Model::new`]; the whole solid was made of the same before.
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

    /// Faces of a sleeper's own surface that tell what masses its points offer: at a corner of the base and in its middle.
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

/// One sleeper with its base at a height [m].
fn block(plan: &MeshedSleepers, centre: [f64; 2], base: f64) -> Mesh {
    let low = [centre[0] - plan.half[0], centre[1] - plan.half[1], base];
    let planes = [0, 1, 2].map(|d| {
        let n = plan.elements[d];
        (0..=n).map(|i| low[d] + 2.0 * plan.half[d] * i as f64 / n as f64).collect()
    });
    Mesh::grid(&planes)
}

/// Elements of the grid along an axis that a line from `low` to `high` meets: number, natural coordinates and shares of the
/// line of its points. A line without length is a point.
fn along_line(low: f64, high: f64, half: f64, count: usize) -> Vec<(usize, f64, f64)> {
    let step = 2.0 * half / count as f64;
    let begin = |i: usize| -half + i as f64 * step;
    if high - low <= ON_PLANE * half {
        let i = (((low + half) / step) as usize).min(count - 1);
        return vec![(i, 2.0 * (low - begin(i)) / step - 1.0, 1.0)];
    }
    let mut out = Vec::new();
    for i in 0..count {
        let (from, to) = (low.max(begin(i)), high.min(begin(i) + step));
        if to > from {
            for (xi, w) in GAUSS {
                let x = 0.5 * (from + to) + 0.5 * xi * (to - from);
                out.push((i, 2.0 * (x - begin(i)) / step - 1.0, 0.5 * w * (to - from) / (high - low)));
            }
        }
    }
    out
}

/// Shares of the nodes in a pressure on the rectangles of the seats.
fn seats(plan: &MeshedSleepers, mesh: &Mesh) -> Vec<(u32, f64)> {
    let [nx, ny, nz] = plan.elements;
    let mut shares: BTreeMap<u32, f64> = BTreeMap::new();
    for (seat, foot) in plan.seats.iter().zip(&plan.feet) {
        let [x, y] = [0, 1].map(|d| {
            let (low, high) = (seat[d] - 0.5 * foot[d], seat[d] + 0.5 * foot[d]);
            let (low, high) = (low.max(-plan.half[d]), high.min(plan.half[d]));
            along_line(low, high, plan.half[d], plan.elements[d])
        });
        for &(i, xi, wx) in &x {
            for &(j, eta, wy) in &y {
                let element = ((nz - 1) * ny + j) * nx + i;
                let n = ElementKind::Hex20.shape_functions([xi, eta, 1.0]);
                for (&node, n) in mesh.connectivity[element].iter().zip(n) {
                    *shares.entry(node).or_default() += n * wx * wy / plan.seats.len() as f64;
                }
            }
        }
    }
    shares.into_iter().filter(|(_, share)| *share != 0.0).collect()
}

/// Shares of the nodes in the mean over the volume of equal bricks.
fn volume(mesh: &Mesh) -> Vec<f64> {
    let mut shares = vec![0.0; mesh.node_count()];
    let count = mesh.element_count() as f64;
    for nodes in mesh.connectivity.iter() {
        for (k, &n) in nodes.iter().enumerate() {
            shares[n as usize] += if k < 8 { -1.0 / 8.0 } else { 1.0 / 6.0 } / count;
        }
    }
    shares
}

/// Shares of the nodes of the base in its mean slope along an axis: Σ w x u / Σ w x² with the consistent weights w.
fn slope(mesh: &Mesh, axis: usize) -> Vec<(u32, f64)> {
    let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
    for face in mesh.boundary_faces() {
        let on_base = face.nodes().iter().all(|n| mesh.coordinates[*n as usize][2] == 0.0);
        if on_base {
            for (k, &n) in face.nodes().iter().enumerate() {
                *weights.entry(n).or_default() += if k < 4 { -1.0 / 12.0 } else { 1.0 / 3.0 };
            }
        }
    }
    let x = |n: u32| mesh.coordinates[n as usize][axis];
    let square: f64 = weights.iter().map(|(&n, w)| w * x(n) * x(n)).sum();
    weights.into_iter().map(|(n, w)| (n, w * x(n) / square)).collect()
}

/// Shares of the nodes in the rise of the ends of the base over its middle.
fn bend(plan: &MeshedSleepers, mesh: &Mesh) -> Vec<(u32, f64)> {
    let axis = usize::from(plan.half[1] > plan.half[0]);
    let at = |place: f64| -> Vec<u32> {
        let on = |x: &[f64; 3]| x[2] == 0.0 && (x[axis].abs() - place).abs() <= ON_PLANE * plan.half[axis];
        (0..).zip(&mesh.coordinates).filter(|(_, x)| on(x)).map(|(n, _)| n).collect()
    };
    let (ends, middle) = (at(plan.half[axis]), at(0.0));
    let share = |nodes: Vec<u32>, sign: f64| {
        let each = sign / nodes.len() as f64;
        nodes.into_iter().map(move |n| (n, each))
    };
    share(ends, 1.0).chain(share(middle, -1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_fem::Elastic;

    fn plan(elements: [usize; 3]) -> MeshedSleepers {
        MeshedSleepers {
            half: [1.3, 0.14, 0.1],
            elements,
            elastic: Elastic { young: 3e10, poisson: 0.2, density: 2400.0 },
            centres: vec![[0.2, 0.3], [0.2, 0.9]],
            seats: vec![[-0.75, 0.0], [0.75, 0.02]],
            feet: vec![[0.15, 0.28], [0.2, 0.0]],
            symmetric: [false; 2],
            gravity: [0.0, 0.0, -9.81],
        }
    }

    fn on_a_block(elements: [usize; 3]) -> (SleeperBodies, Mesh) {
        let mut mesh = Mesh::block([2, 2, 1], [1.0, 1.0, 0.5]);
        let mut materials = [(1, Elastic { young: 2e7, poisson: 0.3, density: 2000.0 }.into())].into();
        let mut constraints = Vec::new();
        let bodies = SleeperBodies::add(plan(elements), &mut mesh, &mut materials, &mut constraints);
        let own: usize = elements.iter().product();
        assert_eq!((bodies.material, constraints.len(), mesh.element_count()), (2, 0, 4 + 2 * own));
        (bodies, mesh)
    }

    /// A rigid motion, and a parabola, are measured exactly, whatever the grid and for each sleeper.
    #[test]
    fn motions_are_measured_exactly() {
        for elements in [[6, 2, 1], [7, 1, 2], [1, 1, 1]] {
            let (bodies, mesh) = on_a_block(elements);
            for k in 0..2 {
                let c = bodies.centre(k, bodies.waiting);
                let mut u = vec![0.0; 3 * mesh.node_count()];
                for n in bodies.nodes_of(k) {
                    let [x, y, z] = [0, 1, 2].map(|d| mesh.coordinates[n][d] - c[d]);
                    u[3 * n] = 0.01 - 0.02 * z;
                    u[3 * n + 1] = -0.03 + 0.01 * z;
                    u[3 * n + 2] = 0.5 + 0.02 * x - 0.01 * y + 0.04 * x * x;
                }
                let m = bodies.moved(k, &u);
                let parabola = 0.04 * 1.3 * 1.3;
                let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{elements:?} {k}: {a} {b}");
                close(m.way[0], 0.01);
                close(m.way[1], -0.03);
                close(m.way[2], 0.5 + parabola / 3.0);
                close(m.tilt, 0.02_f64.hypot(0.01).atan());
                close(m.bend, parabola);
                // Mean of x² over a foot of 0.15 and one of 0.2 m.
                let mean = |foot: f64| 0.75 * 0.75 + foot * foot / 12.0;
                close(m.seats, 0.5 - 0.01 * 0.01 + 0.04 * 0.5 * (mean(0.15) + mean(0.2)));
                let mut load = vec![0.0; u.len()];
                bodies.add_load(k, 7.0, &mut load);
                close(load.iter().sum(), -7.0);
                close(load.iter().zip(&u).map(|(f, u)| f * u).sum(), -7.0 * m.seats);
            }
        }
    }

    /// Motions of a free sleeper that its stiffness does not resist.
    fn loose(elements: [usize; 3], quadrature: fem::Quadrature) -> usize {
        let body = fem::Model::new(fem::ModelInput {
            mesh: block(&plan(elements), [0.0; 2], 0.0),
            materials: [(1, plan(elements).elastic.into())].into(),
            quadrature,
            ..fem::ModelInput::default()
        })
        .unwrap();
        let n = body.dof_count();
        let mut k = nalgebra::DMatrix::zeros(n, n);
        for j in 0..n {
            let (mut x, mut y) = (vec![0.0; n], vec![0.0; n]);
            x[j] = 1.0;
            body.stiffness_times(&x, &mut y);
            k.set_column(j, &nalgebra::DVector::from_vec(y));
        }
        let values = k.symmetric_eigenvalues();
        let most = values.max();
        values.iter().filter(|v| v.abs() < 1e-9 * most).count()
    }

    #[test]
    fn nothing_is_loose_but_rigid_motions() {
        for elements in [[2, 2, 1], [1, 3, 2], [3, 1, 2], [2, 2, 2]] {
            assert_eq!(loose(elements, fem::Quadrature::Gauss2), 6, "{elements:?}");
        }
        for elements in [[1, 1, 1], [4, 1, 1]] {
            for rule in [fem::Quadrature::Irons14, fem::Quadrature::Gauss3] {
                assert_eq!(loose(elements, rule), 6, "{elements:?}");
            }
            // Why a single row is refused.
            assert!(loose(elements, fem::Quadrature::Gauss2) > 10);
        }
    }

    #[test]
    fn set_down_they_keep_their_matrices() {
        let (bodies, mesh) = on_a_block([3, 1, 1]);
        let elastic = Elastic { young: 2e7, poisson: 0.3, density: 2000.0 };
        let model = fem::Model::new(fem::ModelInput {
            mesh,
            materials: [(1, elastic.into()), (2, bodies.plan.elastic.into())].into(),
            ..fem::ModelInput::default()
        })
        .unwrap();
        let down = bodies.set_down(&model, &[0.7, 0.8]);
        for (k, base) in [0.7, 0.8].into_iter().enumerate() {
            let own = &down.mesh().coordinates[bodies.nodes_of(k)];
            let low = own.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
            assert!((low - base).abs() < 1e-12, "{low}");
        }
        assert_eq!(
            down.mesh().coordinates[..bodies.ground_nodes()],
            model.mesh().coordinates[..bodies.ground_nodes()]
        );
        assert!(std::ptr::eq(model.matrices(), down.matrices()));
        let (alone, surface) = bodies.alone(&model).unwrap();
        assert!((alone.total_mass() - bodies.mass()).abs() < 1e-9);
        assert_eq!((surface.faces().len(), bodies.telling_faces(&surface).len()), (bodies.face_count(), 2));
    }
}
