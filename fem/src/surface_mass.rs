//! Mass matrix near a surface.
//!
//! M⁻¹ of a consistent mass decays exponentially with distance (Demko, Moss and Smith, Math. Comp. 43
//! (1984) 491).

use crate::model::Model;

/// Principal submatrix of the mass.
#[derive(Clone, Debug)]
pub struct SurfaceMass {
    nodes: Vec<u32>,
    row_start: Vec<usize>,
    column: Vec<u32>,
    mass: Vec<f64>,
    /// 1 if free, else 0. Shape `[rows][3]`.
    free: Vec<[f64; 3]>,
}

impl SurfaceMass {
    /// Submatrix for all nodes of some elements.
    pub fn new(model: &Model, elements: impl Iterator<Item = u32>) -> SurfaceMass {
        let mesh = model.mesh();
        let mut nodes: Vec<u32> =
            elements.flat_map(|e| mesh.connectivity[e as usize].iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut own = vec![u32::MAX; mesh.node_count()];
        nodes.iter().zip(0..).for_each(|(&n, k)| own[n as usize] = k);
        let (mut row_start, mut column, mut mass) = (vec![0], Vec::new(), Vec::new());
        for &n in &nodes {
            for (q, m) in model.matrices().mass_row(n as usize) {
                let k = own[q as usize];
                if k != u32::MAX {
                    column.push(k);
                    mass.push(m);
                }
            }
            row_start.push(column.len());
        }
        let mut free = vec![[1.0; 3]; nodes.len()];
        for &(dof, _) in model.supports().fixed() {
            let k = own[dof as usize / 3];
            if k != u32::MAX {
                free[k as usize][dof as usize % 3] = 0.0;
            }
        }
        SurfaceMass { nodes, row_start, column, mass, free }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Row of a node, if it has one.
    pub fn row(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Inverse of the diagonal [1/kg], 0 for constrained dofs. Shape `[rows][3]`.
    pub fn inverse_diagonal(&self) -> Vec<[f64; 3]> {
        let diagonal = self.row_start.iter().map(|&slot| 1.0 / self.mass[slot]);
        diagonal.zip(&self.free).map(|(m, free)| free.map(|f| f * m)).collect()
    }

    /// `y = M x` on free dofs. Shapes `[rows][3]`.
    pub fn times(&self, x: &[[f64; 3]], y: &mut [[f64; 3]]) {
        y.fill([0.0; 3]);
        for p in 0..x.len() {
            let row = self.row_start[p]..self.row_start[p + 1];
            let mut sum = [0.0; 3];
            for (&m, &q) in self.mass[row.clone()].iter().zip(&self.column[row]) {
                let q = q as usize;
                for d in 0..3 {
                    sum[d] += m * x[q][d];
                    if q != p {
                        y[q][d] += m * x[p][d];
                    }
                }
            }
            (0..3).for_each(|d| y[p][d] += sum[d]);
        }
        y.iter_mut().zip(&self.free).for_each(|(y, f)| (0..3).for_each(|d| y[d] *= f[d]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Constraint, Elastic, Mesh, ModelInput};

    #[test]
    fn whole_block_gives_the_whole_product() {
        let elastic = Elastic { young: 2e7, poisson: 0.3, density: 2000.0 };
        let model = Model::new(ModelInput {
            mesh: Mesh::block([2, 2, 1], [1.0, 1.0, 0.5]),
            materials: [(1, elastic.into())].into(),
            constraints: vec![Constraint { node: 3, direction: 1, value: 0.0 }],
            ..Default::default()
        })
        .unwrap();
        let part = SurfaceMass::new(&model, 0..4);
        assert_eq!(part.len(), model.mesh().node_count());
        let x: Vec<[f64; 3]> = (0..part.len()).map(|k| [k as f64, 1.0, (k % 3) as f64]).collect();
        let mut x = x;
        x[3][1] = 0.0;
        let mut y = vec![[0.0; 3]; part.len()];
        part.times(&x, &mut y);
        let mut whole = vec![0.0; model.dof_count()];
        model.mass_times(x.as_flattened(), &mut whole);
        whole[10] = 0.0;
        for (a, b) in y.as_flattened().iter().zip(&whole) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        assert_eq!(part.inverse_diagonal()[3][1], 0.0);
    }
}
