//! Supports: prescribed displacements, numbering of free dofs, rigid-body check.
//!
//! A body is constrained if the six rigid motions are linearly independent on the supported dofs (eigenvalues
//! of the 6×6 Gram matrix). Limits: supports within a millionth of the body size count as one point; hinges
//! are detected by pivots.

use crate::boundary::SpringPoint;
use crate::error::ModelError;
use crate::mesh::{Constraint, Mesh};
use nalgebra::{Matrix6, Vector6};

/// Names of the directions.
pub const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// Constrained dof in [`Supports::free_index`].
pub const CONSTRAINED: u32 = u32::MAX;

/// Eigenvalue ratio of a free rigid motion: (1e-6)².
const RIGID_BODY_MOTION: f64 = 1e-12;

/// Numbered supports of a mesh.
#[derive(Clone, Debug)]
pub struct Supports {
    fixed: Vec<(u32, f64)>,
    free: Vec<u32>,
    free_index: Vec<u32>,
}

impl Supports {
    /// Checks and numbers the constraints, merging duplicates.
    ///
    /// # Errors
    /// Node or direction out of range, value not finite, or contradiction.
    pub fn new(mesh: &Mesh, constraints: &[Constraint]) -> Result<Supports, ModelError> {
        let mut fixed = Vec::with_capacity(constraints.len());
        for (index, c) in constraints.iter().enumerate() {
            if c.node as usize >= mesh.node_count() || c.direction > 2 {
                return Err(ModelError::ConstraintRange { index, node: c.node, direction: c.direction });
            }
            if !c.value.is_finite() {
                let (node, direction) = name(mesh, 3 * c.node as usize + c.direction as usize);
                return Err(ModelError::ConstraintValue { node, direction, value: c.value });
            }
            fixed.push((3 * c.node + u32::from(c.direction), c.value));
        }
        fixed.sort_by_key(|(dof, _)| *dof);
        for pair in fixed.windows(2) {
            if pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1 {
                let (node, direction) = name(mesh, pair[0].0 as usize);
                return Err(ModelError::Contradiction {
                    node,
                    direction,
                    first: pair[0].1,
                    second: pair[1].1,
                });
            }
        }
        fixed.dedup_by_key(|(dof, _)| *dof);
        let mut free_index = vec![0; 3 * mesh.node_count()];
        for (dof, _) in &fixed {
            free_index[*dof as usize] = CONSTRAINED;
        }
        let mut free = Vec::with_capacity(free_index.len() - fixed.len());
        for (dof, slot) in free_index.iter_mut().enumerate() {
            if *slot != CONSTRAINED {
                *slot = free.len() as u32;
                free.push(dof as u32);
            }
        }
        Ok(Supports { fixed, free, free_index })
    }

    /// Constrained dofs, ascending, with displacements [m].
    pub fn fixed(&self) -> &[(u32, f64)] {
        &self.fixed
    }

    /// Free dofs, ascending: equation number → dof.
    pub fn free(&self) -> &[u32] {
        &self.free
    }

    /// Dof → equation number, or [`CONSTRAINED`]. Shape `[3 * nodes]`.
    pub fn free_index(&self) -> &[u32] {
        &self.free_index
    }

    /// Gathers free dofs. Shapes `[3 * nodes]` and `[equations]`.
    pub fn gather(&self, nodal: &[f64], equations: &mut [f64]) {
        for (e, &dof) in equations.iter_mut().zip(&self.free) {
            *e = nodal[dof as usize];
        }
    }

    /// Scatters equation values to free dofs.
    pub fn scatter(&self, equations: &[f64], nodal: &mut [f64]) {
        for (e, &dof) in equations.iter().zip(&self.free) {
            nodal[dof as usize] = *e;
        }
    }

    /// Node index and direction of the largest free rigid motion.
    pub fn rigid_body_motion(&self, mesh: &Mesh) -> Option<(usize, usize)> {
        self.rigid_body_motion_on_springs(mesh, &[])
    }

    /// Like [`Supports::rigid_body_motion`], with springs of any stiffness.
    pub fn rigid_body_motion_on_springs(
        &self,
        mesh: &Mesh,
        springs: &[SpringPoint],
    ) -> Option<(usize, usize)> {
        let body = bodies(mesh);
        let count = body.iter().max().map_or(0, |b| b + 1);
        let mut members = vec![Vec::new(); count];
        for (node, &b) in body.iter().enumerate() {
            members[b].push(node);
        }
        let mut springs_of = vec![Vec::new(); count];
        for spring in springs {
            springs_of[body[spring.node]].push(*spring);
        }
        members
            .iter()
            .zip(&springs_of)
            .find_map(|(nodes, springs)| self.rigid_body_motion_of(mesh, nodes, springs))
    }

    fn rigid_body_motion_of(
        &self,
        mesh: &Mesh,
        nodes: &[usize],
        springs: &[SpringPoint],
    ) -> Option<(usize, usize)> {
        let mut centre = [0.0; 3];
        for &n in nodes {
            for k in 0..3 {
                centre[k] += mesh.coordinates[n][k] / nodes.len() as f64;
            }
        }
        let offset = |x: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| x[k] - centre[k]) };
        let size =
            nodes.iter().flat_map(|&n| offset(mesh.coordinates[n])).fold(0.0, |m: f64, v| m.max(v.abs()));
        // Unit translations, and rotations that move the body's edge by one.
        let row_at = |point: [f64; 3], direction: usize| -> Vector6<f64> {
            let r = offset(point).map(|v| v / size);
            let turn = match direction {
                0 => [0.0, r[2], -r[1]],
                1 => [-r[2], 0.0, r[0]],
                _ => [r[1], -r[0], 0.0],
            };
            let mut v = Vector6::new(0.0, 0.0, 0.0, turn[0], turn[1], turn[2]);
            v[direction] = 1.0;
            v
        };
        let row = |node: usize, direction: usize| row_at(mesh.coordinates[node], direction);
        let mut gram = Matrix6::zeros();
        for &n in nodes {
            for k in 0..3 {
                if self.free_index[3 * n + k] == CONSTRAINED {
                    let r = row(n, k);
                    gram += r * r.transpose();
                }
            }
        }
        for spring in springs {
            let r = (0..3).map(|k| spring.direction[k] * row_at(spring.point, k)).sum::<Vector6<f64>>();
            gram += r * r.transpose();
        }
        let eigen = gram.symmetric_eigen();
        let softest = eigen.eigenvalues.imin();
        if eigen.eigenvalues[softest] > RIGID_BODY_MOTION * eigen.eigenvalues.max() {
            return None;
        }
        let motion = eigen.eigenvectors.column(softest).into_owned();
        let mut worst = (0.0, (nodes[0], 0));
        for &n in nodes {
            for k in (0..3).filter(|k| self.free_index[3 * n + k] != CONSTRAINED) {
                let moved = row(n, k).dot(&motion).abs();
                // Margin against rounding between equal motions.
                if moved > worst.0 * (1.0 + 1e-9) {
                    worst = (moved, (n, k));
                }
            }
        }
        Some(worst.1)
    }
}

pub(crate) fn name(mesh: &Mesh, dof: usize) -> (u32, &'static str) {
    (mesh.node_ids[dof / 3], DIRECTIONS[dof % 3])
}

/// Body number of each node.
fn bodies(mesh: &Mesh) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..mesh.node_count()).collect();
    fn root(parent: &mut [usize], mut n: usize) -> usize {
        while parent[n] != n {
            parent[n] = parent[parent[n]];
            n = parent[n];
        }
        n
    }
    for nodes in mesh.connectivity.iter() {
        let first = root(&mut parent, nodes[0] as usize);
        let mut low = first;
        for &n in nodes {
            let r = root(&mut parent, n as usize);
            let (small, large) = (low.min(r), low.max(r));
            parent[large] = small;
            low = small;
        }
    }
    let mut number = vec![usize::MAX; mesh.node_count()];
    let mut count = 0;
    for n in 0..mesh.node_count() {
        let r = root(&mut parent, n);
        if r == n {
            number[n] = count;
            count += 1;
        } else {
            number[n] = number[r];
        }
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_base(mesh: &Mesh, directions: &[u8]) -> Vec<Constraint> {
        (0..mesh.node_count() as u32)
            .filter(|&n| mesh.coordinates[n as usize][2] == 0.0)
            .flat_map(|node| {
                directions.iter().map(move |&direction| Constraint { node, direction, value: 0.0 })
            })
            .collect()
    }

    #[test]
    fn finds_free_rigid_motion() {
        let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        let held = Supports::new(&mesh, &on_base(&mesh, &[0, 1, 2])).unwrap();
        assert_eq!(held.rigid_body_motion(&mesh), None);
        let sliding = Supports::new(&mesh, &on_base(&mesh, &[1, 2])).unwrap();
        assert_eq!(sliding.rigid_body_motion(&mesh).unwrap().1, 0);
        let none = Supports::new(&mesh, &[]).unwrap();
        assert!(none.rigid_body_motion(&mesh).is_some());
        // Six constraints hold a body; two on one line leave a rotation.
        let node = |x: f64, y: f64, z: f64| {
            mesh.coordinates.iter().position(|c| *c == [x, y, z]).expect("a corner of the block") as u32
        };
        let (o, a, b) = (node(0.0, 0.0, 0.0), node(2.0, 0.0, 0.0), node(0.0, 1.0, 0.0));
        let fix = |list: &[(u32, u8)]| -> Vec<Constraint> {
            list.iter().map(|&(node, direction)| Constraint { node, direction, value: 0.0 }).collect()
        };
        let six = fix(&[(o, 0), (o, 1), (o, 2), (a, 1), (a, 2), (b, 2)]);
        assert_eq!(Supports::new(&mesh, &six).unwrap().rigid_body_motion(&mesh), None);
        let turn = fix(&[(o, 0), (o, 1), (o, 2), (a, 1), (a, 2), (a, 0)]);
        assert!(Supports::new(&mesh, &turn).unwrap().rigid_body_motion(&mesh).is_some());
    }

    #[test]
    fn checks_second_body() {
        let mut mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        let other = Mesh::block([1, 1, 1], [1.0; 3]);
        mesh.coordinates.extend(other.coordinates.iter().map(|c| [c[0] + 5.0, c[1], c[2] + 1.0]));
        mesh.node_ids = (1..=40).collect();
        let nodes: Vec<u32> = other.connectivity[0].iter().map(|n| n + 20).collect();
        mesh.push_element(2, 1, crate::element::ElementKind::Hex20, &nodes);
        let supports = Supports::new(&mesh, &on_base(&mesh, &[0, 1, 2])).unwrap();
        assert!(supports.rigid_body_motion(&mesh).unwrap().0 >= 20);
    }

    #[test]
    fn rejects_contradictions_and_merges_duplicates() {
        let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        let c = |value| Constraint { node: 3, direction: 1, value };
        assert_eq!(Supports::new(&mesh, &[c(0.1), c(0.1)]).unwrap().fixed(), &[(10, 0.1)]);
        let error = Supports::new(&mesh, &[c(0.1), c(0.2)]).unwrap_err();
        assert!(matches!(error, ModelError::Contradiction { node: 4, direction: "y", .. }), "{error}");
        assert!(matches!(Supports::new(&mesh, &[c(f64::NAN)]), Err(ModelError::ConstraintValue { .. })));
        let far = Constraint { node: 99, direction: 0, value: 0.0 };
        assert!(matches!(Supports::new(&mesh, &[far]), Err(ModelError::ConstraintRange { index: 0, .. })));
    }
}
