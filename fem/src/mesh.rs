//! The finite-element mesh: nodes, 20-node hexahedra, and the faces of its surface.

use crate::element::hex20;
use crate::element::quadrature::GAUSS3;
use crate::kinematics::{ElementCoordinates, jacobian};

/// Number of nodes of the serendipity hexahedron.
pub const HEX20_NODES: usize = 20;

/// Nodes of each face of a hex20, in local indices (0-based), by SOLID186 face number minus one.
///
/// The four corners come first, counter-clockwise seen from outside, then the mid-side node after each
/// corner. SOLID186 faces: 1 J-I-L-K, 2 I-J-N-M, 3 J-K-O-N, 4 K-L-P-O, 5 L-I-M-P, 6 M-N-O-P.
pub const FACE_NODES: [[usize; 8]; 6] = [
    [1, 0, 3, 2, 8, 11, 10, 9],
    [0, 1, 5, 4, 8, 17, 12, 16],
    [1, 2, 6, 5, 9, 18, 13, 17],
    [2, 3, 7, 6, 10, 19, 14, 18],
    [3, 0, 4, 7, 11, 16, 15, 19],
    [4, 5, 6, 7, 12, 13, 14, 15],
];

/// A mesh of 20-node hexahedra in SOLID186 node order (I…P corners, Q…T bottom, U…X top, Y…B uprights).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Node numbers as the user's files name them. Shape `[nodes]`.
    pub node_ids: Vec<u32>,
    /// Node coordinates [m]. Shape `[nodes][3]`.
    pub coordinates: Vec<[f64; 3]>,
    /// Element numbers as the user's files name them. Shape `[elements]`.
    pub element_ids: Vec<u32>,
    /// Material number of each element as the user's files name it. Shape `[elements]`.
    pub materials: Vec<u32>,
    /// Node indices (0-based, into `coordinates`) of each element. Shape `[elements][20]`.
    pub connectivity: Vec<[u32; HEX20_NODES]>,
}

/// One face of an element on the boundary of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Index of the element (0-based).
    pub element: u32,
    /// SOLID186 face number minus one, 0–5.
    pub side: u8,
    /// Node indices: corners counter-clockwise seen from outside, then mid-sides (see [`FACE_NODES`]).
    pub nodes: [u32; 8],
}

/// A constraint as a mesh file names it: node number, direction 0–2, prescribed displacement [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Index of the node (0-based).
    pub node: u32,
    /// Direction: 0 = x, 1 = y, 2 = z.
    pub direction: u8,
    /// Prescribed displacement [m].
    pub value: f64,
}

impl Mesh {
    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.coordinates.len()
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.connectivity.len()
    }

    /// The face `side` (SOLID186 number minus one) of element `element` (index).
    pub fn face(&self, element: usize, side: usize) -> Face {
        let nodes = FACE_NODES[side].map(|n| self.connectivity[element][n]);
        Face { element: element as u32, side: side as u8, nodes }
    }

    /// The faces that belong to one element only, in element order then side order.
    pub fn boundary_faces(&self) -> Vec<Face> {
        let mut keyed: Vec<([u32; 4], Face)> = (0..self.element_count())
            .flat_map(|e| (0..6).map(move |s| (e, s)))
            .map(|(e, s)| {
                let face = self.face(e, s);
                let mut key = [face.nodes[0], face.nodes[1], face.nodes[2], face.nodes[3]];
                key.sort_unstable();
                (key, face)
            })
            .collect();
        keyed.sort_unstable_by_key(|(key, face)| (*key, face.element, face.side));
        let mut faces: Vec<Face> = keyed
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|group| group.len() == 1)
            .map(|group| group[0].1)
            .collect();
        faces.sort_unstable_by_key(|f| (f.element, f.side));
        faces
    }
}

impl Mesh {
    /// Coordinates of the nodes of element `element` (index) [m].
    pub fn element_coordinates(&self, element: usize) -> ElementCoordinates {
        self.connectivity[element].map(|n| self.coordinates[n as usize])
    }

    /// Volume of element `element` [m³], by the 3×3×3 rule.
    pub fn element_volume(&self, element: usize) -> f64 {
        let x = self.element_coordinates(element);
        GAUSS3.iter().map(|(xi, w)| w * jacobian(&x, &hex20::gradients(*xi)).1).sum()
    }

    /// Quality of element `element`: smallest over largest determinant of the Jacobian at the nodes and the 27 Gauss
    /// points. 1 is a parallelepiped; 0 or below is degenerate or inverted somewhere.
    pub fn jacobian_ratio(&self, element: usize) -> f64 {
        let x = self.element_coordinates(element);
        let points = GAUSS3.iter().map(|p| p.0).chain(hex20::NATURAL);
        let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), xi| {
            let det = jacobian(&x, &hex20::gradients(xi)).1;
            (low.min(det), high.max(det))
        });
        low / high.max(-low)
    }

    /// Smallest and largest coordinates [m] of the nodes; infinite and reversed for an empty mesh.
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        self.coordinates.iter().fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), c| {
            (std::array::from_fn(|k| low[k].min(c[k])), std::array::from_fn(|k| high[k].max(c[k])))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quad8::point_and_area;
    use crate::element::quadrature::FACE3;

    /// A curved, skewed two-element body: a block whose every node is moved smoothly.
    fn bent() -> Mesh {
        let mut mesh = Mesh::block([2, 2, 2], [2.0, 1.0, 1.0]);
        for c in &mut mesh.coordinates {
            let [x, y, z] = *c;
            *c = [x + 0.1 * y * z, y + 0.08 * x * x - 0.05 * z, z + 0.1 * (x * y).sin()];
        }
        mesh
    }

    #[test]
    fn area_vectors_of_a_closed_surface_add_up_to_zero_and_enclose_the_volume() {
        let mesh = bent();
        let (mut sum, mut enclosed, mut area) = ([0.0; 3], 0.0, 0.0);
        for face in mesh.boundary_faces() {
            for (xi, w) in FACE3 {
                let (x, a) = point_and_area(&mesh, &face, xi);
                for k in 0..3 {
                    sum[k] += w * a[k];
                    enclosed += w * a[k] * x[k] / 3.0;
                }
                area += w * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
            }
        }
        let volume: f64 = (0..mesh.element_count()).map(|e| mesh.element_volume(e)).sum();
        assert!(sum.iter().all(|s| s.abs() < 1e-13 * area), "{sum:?}");
        // Outward faces give the volume with a plus sign; the 3×3 rule is exact for x · dA only on flat faces.
        assert!((enclosed / volume - 1.0).abs() < 1e-3, "{enclosed} {volume}");
    }

    #[test]
    fn all_six_faces_of_an_element_point_outward() {
        let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
        let outward = [[0, 0, -1], [0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]];
        for (side, normal) in outward.into_iter().enumerate() {
            let (_, area) = point_and_area(&mesh, &mesh.face(0, side), [0.3, -0.2]);
            for k in 0..3 {
                assert!((area[k] - f64::from(normal[k]) / 4.0).abs() < 1e-15, "side {side}: {area:?}");
            }
        }
    }

    #[test]
    fn inner_faces_are_not_on_the_boundary() {
        let faces = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]).boundary_faces();
        assert_eq!(faces.len(), 10);
        assert!(faces.iter().all(|f| (f.element, f.side) != (0, 2) && (f.element, f.side) != (1, 4)));
    }

    #[test]
    fn quality_sees_an_inverted_element() {
        let mut mesh = Mesh::block([1, 1, 1], [2.0, 1.0, 3.0]);
        assert!((mesh.jacobian_ratio(0) - 1.0).abs() < 1e-14 && (mesh.element_volume(0) - 6.0).abs() < 1e-14);
        mesh.coordinates.iter_mut().for_each(|c| c[0] = -c[0]);
        assert!(mesh.jacobian_ratio(0) < 0.0);
        assert_eq!(mesh.bounding_box(), ([-2.0, 0.0, 0.0], [0.0, 1.0, 3.0]));
    }
}
