//! Conversion between linear and quadratic elements.
//!
//! Linear meshes have about a quarter of the nodes; added mid-sides are straight.

use crate::mesh::Mesh;
use std::collections::{HashMap, HashSet};

impl Mesh {
    /// New index of each node in [`Mesh::to_linear`]. Shape `[nodes]`.
    ///
    /// # Panics
    /// If an element refers to a missing node; [`crate::Model::new`] rejects such meshes.
    pub fn linear_node_map(&self) -> Vec<Option<u32>> {
        let mut dropped = vec![false; self.node_count()];
        for (nodes, kind) in self.connectivity.iter().zip(self.connectivity.kinds()) {
            nodes[kind.corner_count()..].iter().for_each(|&n| dropped[n as usize] = true);
        }
        // Nodes that are a corner anywhere stay.
        for (nodes, kind) in self.connectivity.iter().zip(self.connectivity.kinds()) {
            nodes[..kind.corner_count()].iter().for_each(|&n| dropped[n as usize] = false);
        }
        let mut kept = 0..;
        dropped.into_iter().map(|dropped| if dropped { None } else { kept.next() }).collect()
    }

    /// Converts hex20 → hex8, wedge15 → wedge6, pyramid13 → pyramid5, tet10 → tet4; corners keep order and
    /// numbers ([`Mesh::linear_node_map`]).
    ///
    /// # Panics
    /// As [`Mesh::linear_node_map`].
    pub fn to_linear(&self) -> Mesh {
        let map = self.linear_node_map();
        let kept = || map.iter().enumerate().filter(|(_, new)| new.is_some()).map(|(old, _)| old);
        let mut mesh = Mesh {
            node_ids: kept().map(|n| self.node_ids[n]).collect(),
            coordinates: kept().map(|n| self.coordinates[n]).collect(),
            element_ids: self.element_ids.clone(),
            materials: self.materials.clone(),
            ..Mesh::default()
        };
        for (nodes, kind) in self.connectivity.iter().zip(self.connectivity.kinds()) {
            let corners: Vec<u32> =
                nodes[..kind.corner_count()].iter().filter_map(|&n| map[n as usize]).collect();
            mesh.connectivity.push(kind.linear(), &corners);
        }
        mesh
    }

    /// Converts hex8 → hex20, wedge6 → wedge15, pyramid5 → pyramid13, tet4 → tet10, with one node per edge.
    ///
    /// Nodes keep indices and numbers.
    ///
    /// # Panics
    /// If an element refers to a missing node.
    pub fn to_quadratic(&self) -> Mesh {
        let mut mesh = Mesh {
            node_ids: self.node_ids.clone(),
            coordinates: self.coordinates.clone(),
            element_ids: self.element_ids.clone(),
            materials: self.materials.clone(),
            ..Mesh::default()
        };
        let used: HashSet<u32> = self.node_ids.iter().copied().collect();
        let highest = used.iter().copied().max().unwrap_or(0);
        let after = highest.checked_add(1).into_iter().flat_map(|first| first..=u32::MAX);
        let mut free = after.chain((1..highest).filter(|id| !used.contains(id)));

        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let edge = |nodes: &[u32], [a, b]: [usize; 2]| [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
        for (nodes, kind) in self.connectivity.iter().zip(self.connectivity.kinds()) {
            for (corners, &middle) in kind.edges().iter().zip(kind.mid_sides(nodes)) {
                middles.insert(edge(nodes, *corners), middle);
            }
        }
        for (nodes, kind) in self.connectivity.iter().zip(self.connectivity.kinds()) {
            let mid_sides = kind.mid_sides(nodes);
            let mut all = [&nodes[..kind.corner_count()], mid_sides].concat();
            if mid_sides.is_empty() {
                for corners in kind.edges() {
                    let [a, b] = edge(nodes, *corners);
                    all.push(*middles.entry([a, b]).or_insert_with(|| {
                        let (x, y) = (mesh.coordinates[a as usize], mesh.coordinates[b as usize]);
                        mesh.coordinates.push(std::array::from_fn(|k| 0.5 * (x[k] + y[k])));
                        mesh.node_ids.extend(free.next());
                        mesh.coordinates.len() as u32 - 1
                    }));
                }
            }
            mesh.connectivity.push(kind.quadratic(), &all);
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind;

    fn mixed() -> Mesh {
        let mut mesh = Mesh {
            coordinates: vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
                [1.0, 1.0, 1.0],
                [0.0, 1.0, 1.0],
                [2.0, 0.5, 0.0],
                [2.0, 0.5, 1.0],
                [0.5, 0.5, 2.0],
                [2.0, 0.5, 2.0],
            ],
            node_ids: (0..12).map(|n| 10 + 3 * n).collect(),
            ..Mesh::default()
        };
        mesh.push_element(5, 1, ElementKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7]);
        mesh.push_element(7, 2, ElementKind::Wedge6, &[1, 8, 2, 5, 9, 6]);
        mesh.push_element(6, 2, ElementKind::Pyramid5, &[4, 5, 6, 7, 10]);
        mesh.push_element(1, 3, ElementKind::Tet4, &[5, 11, 6, 10]);
        mesh
    }

    #[test]
    fn adds_and_drops_mid_sides() {
        let linear = mixed();
        assert!((0..4).all(|e| linear.element_volume(e) > 0.0));
        let quadratic = linear.to_quadratic();
        // Edges: 12 (cube), 5 (wedge), 4 (pyramid), 3 (tetrahedron).
        assert_eq!((quadratic.node_count(), quadratic.element_count()), (12 + 12 + 5 + 4 + 3, 4));
        assert_eq!(quadratic.boundary_faces().len(), linear.boundary_faces().len());
        assert_eq!(quadratic.node_ids[12..], (44..68).collect::<Vec<_>>());
        for e in 0..4 {
            assert!((quadratic.element_volume(e) / linear.element_volume(e) - 1.0).abs() < 1e-14);
            assert!(quadratic.jacobian_ratio(e) > 0.0);
        }
        assert_eq!(quadratic.to_linear(), linear);
        assert_eq!(linear.to_linear(), linear);
        assert_eq!(quadratic.to_quadratic(), quadratic);
    }

    #[test]
    fn a_straight_block_comes_back() {
        let block = Mesh::block([3, 2, 2], [3.0, 1.0, 0.5]);
        let linear = block.to_linear();
        assert_eq!(linear.node_count(), 4 * 3 * 3);
        for (old, new) in block.linear_node_map().into_iter().enumerate() {
            if let Some(new) = new {
                assert_eq!(linear.node_ids[new as usize], block.node_ids[old]);
                assert_eq!(linear.coordinates[new as usize], block.coordinates[old]);
            }
        }
        let back = linear.to_quadratic();
        assert_eq!((back.node_count(), back.element_count()), (block.node_count(), block.element_count()));
        for e in 0..block.element_count() {
            assert_eq!(back.element_coordinates(e), block.element_coordinates(e));
        }
        let shared = |mesh: &Mesh, e: usize, f: usize| {
            mesh.connectivity[e].iter().filter(|n| mesh.connectivity[f].contains(n)).count()
        };
        assert!((1..12).all(|e| shared(&back, 0, e) == shared(&block, 0, e)));
    }

    #[test]
    fn shares_curved_mid_sides() {
        let mut mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        let middle = mesh.connectivity[0][9] as usize;
        mesh.coordinates[middle][0] += 0.1;
        let corners: Vec<u32> = [1, 2, 6, 5].map(|c| mesh.connectivity[0][c]).to_vec();
        mesh.coordinates.push([2.0, 0.5, 0.5]);
        mesh.node_ids.push(u32::MAX);
        let apex = mesh.node_count() as u32 - 1;
        mesh.push_element(
            2,
            1,
            ElementKind::Pyramid5,
            &[corners[0], corners[1], corners[2], corners[3], apex],
        );
        let quadratic = mesh.to_quadratic();
        assert_eq!(quadratic.connectivity[1][5] as usize, middle);
        assert_eq!(quadratic.node_count(), 20 + 1 + 4);
        // Numbers above are exhausted: the lowest free ones.
        assert_eq!(quadratic.node_ids[21..], [21, 22, 23, 24]);
        assert_eq!(quadratic.boundary_faces().len(), 9);
    }
}
