//! Structured meshes of bricks.

use crate::element::ElementKind;
use crate::element::hex20::{NATURAL, NODES};
use crate::mesh::Mesh;

impl Mesh {
    /// Block with one corner at the origin, `counts` elements and `size` [m] along x, y, z, of material 1.
    pub fn block(counts: [usize; 3], size: [f64; 3]) -> Mesh {
        let lines: [Vec<f64>; 3] = std::array::from_fn(|d| {
            (0..=counts[d]).map(|i| size[d] * i as f64 / counts[d].max(1) as f64).collect()
        });
        Mesh::grid(&lines)
    }

    /// Hex20 block of material 1 between ascending grid planes [m] along x, y, z.
    pub fn grid(planes: &[Vec<f64>; 3]) -> Mesh {
        let mut mesh = Mesh::default();
        if planes.iter().any(|p| p.len() < 2) {
            return mesh;
        }
        let counts = [0, 1, 2].map(|d| planes[d].len() - 1);
        let [nx, ny, nz] = counts.map(|n| 2 * n + 1);
        let at = |d: usize, i: usize| {
            let low = planes[d][i / 2];
            if i.is_multiple_of(2) { low } else { 0.5 * (low + planes[d][i / 2 + 1]) }
        };
        // On the half-element grid, a node has at most one odd index (mid-side).
        let mut index = vec![u32::MAX; nx * ny * nz];
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    if i % 2 + j % 2 + k % 2 < 2 {
                        index[(k * ny + j) * nx + i] = mesh.coordinates.len() as u32;
                        mesh.coordinates.push([at(0, i), at(1, j), at(2, k)]);
                    }
                }
            }
        }
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let mut nodes = [0; NODES];
                    for (node, natural) in nodes.iter_mut().zip(NATURAL) {
                        let [a, b, c] = natural.map(|v| (v + 1.0) as usize);
                        *node = index[((2 * k + c) * ny + 2 * j + b) * nx + 2 * i + a];
                    }
                    let id = mesh.element_count() as u32 + 1;
                    mesh.push_element(id, 1, ElementKind::Hex20, &nodes);
                }
            }
        }
        mesh.node_ids = (1..=mesh.node_count() as u32).collect();
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_nodes_of_block() {
        let mesh = Mesh::block([2, 3, 1], [2.0, 3.0, 0.5]);
        assert_eq!(mesh.element_count(), 6);
        // corners + sides along x, y, z
        assert_eq!(mesh.node_count(), 3 * 4 * 2 + 2 * 4 * 2 + 3 * 3 * 2 + 3 * 4);
        let last = &mesh.connectivity[5];
        for (node, natural) in last.iter().zip(NATURAL) {
            let expected = [1.5 + natural[0] / 2.0, 2.5 + natural[1] / 2.0, 0.25 + natural[2] / 4.0];
            assert_eq!(mesh.coordinates[*node as usize], expected);
        }
        assert_eq!(mesh.boundary_faces().len(), 2 * (2 * 3 + 3 + 2));
        assert_eq!(Mesh::block([0, 1, 1], [1.0; 3]).node_count(), 0);
    }
}
