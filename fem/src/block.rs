//! A block of equal 20-node bricks: the simplest mesh, for templates, tests and measurements.

use crate::element::ElementKind;
use crate::element::hex20::NATURAL;
use crate::mesh::{HEX20_NODES, Mesh};

impl Mesh {
    /// A block with one corner at the origin, `counts` elements and `size` [m] along x, y, z, of material 1.
    ///
    /// Nodes are numbered along x, then y, then z; so are elements. A count of 0 gives an empty mesh.
    pub fn block(counts: [usize; 3], size: [f64; 3]) -> Mesh {
        let [nx, ny, nz] = counts.map(|n| 2 * n + 1);
        let mut mesh = Mesh::default();
        if counts.contains(&0) {
            return mesh;
        }
        // On the grid of half elements a node has at most one odd index (a mid-side).
        let mut index = vec![u32::MAX; nx * ny * nz];
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    if i % 2 + j % 2 + k % 2 < 2 {
                        index[(k * ny + j) * nx + i] = mesh.coordinates.len() as u32;
                        let at = |i: usize, d: usize| size[d] * i as f64 / (2 * counts[d]) as f64;
                        mesh.coordinates.push([at(i, 0), at(j, 1), at(k, 2)]);
                    }
                }
            }
        }
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    let mut nodes = [0; HEX20_NODES];
                    for (node, natural) in nodes.iter_mut().zip(NATURAL) {
                        let [a, b, c] = natural.map(|v| (v + 1.0) as usize);
                        *node = index[((2 * k + c) * ny + 2 * j + b) * nx + 2 * i + a];
                    }
                    mesh.connectivity.push(ElementKind::Hex20, &nodes);
                }
            }
        }
        mesh.node_ids = (1..=mesh.coordinates.len() as u32).collect();
        mesh.element_ids = (1..=mesh.connectivity.len() as u32).collect();
        mesh.materials = vec![1; mesh.connectivity.len()];
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_of_a_block_are_counted_and_placed() {
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
