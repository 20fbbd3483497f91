//! The finite-element mesh: nodes, elements, and the faces of its surface.

use crate::connectivity::Connectivity;
pub use crate::element::hex20::{FACE_NODES, HEX20_NODES};
use crate::element::{ElementKind, FaceShape, MAX_FACE_NODES, mass_points};
use crate::kinematics::{ElementCoordinates, jacobian};

/// A mesh: 20-node hexahedra in SOLID186 node order (I…P corners, Q…T bottom, U…X top, Y…B uprights), and their
/// companions.
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
    /// Kind and node indices (0-based, into `coordinates`) of each element.
    pub connectivity: Connectivity,
}

/// One face of an element on the boundary of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Index of the element (0-based).
    pub element: u32,
    /// Number of the face in [`ElementKind::faces`]; for a hexahedron the SOLID186 face number minus one, 0–5.
    pub side: u8,
    /// Its shape.
    pub shape: FaceShape,
    /// Node indices: corners counter-clockwise seen from outside, then the mid-side node after each corner. Those
    /// beyond the nodes of the shape repeat the first.
    pub nodes: [u32; MAX_FACE_NODES],
}

impl Face {
    /// The nodes of the face's shape.
    #[inline]
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.shape.node_count()]
    }

    /// The corners.
    #[inline]
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..self.shape.corner_count()]
    }

    /// Point [m] of the face at the natural point `xi`, and the area vector dx/dxi × dx/deta [m²] there: its length
    /// is the area per unit of natural area, its direction the outward normal of the body.
    pub fn point_and_area(&self, mesh: &Mesh, xi: [f64; 2]) -> ([f64; 3], [f64; 3]) {
        let (n, d) = (self.shape.shape_functions(xi), self.shape.gradients(xi));
        let (mut point, mut tangent, mut cotangent) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (a, &node) in self.nodes().iter().enumerate() {
            let x = mesh.coordinates[node as usize];
            for k in 0..3 {
                point[k] += n[a] * x[k];
                tangent[k] += d[a][0] * x[k];
                cotangent[k] += d[a][1] * x[k];
            }
        }
        let area = [
            tangent[1] * cotangent[2] - tangent[2] * cotangent[1],
            tangent[2] * cotangent[0] - tangent[0] * cotangent[2],
            tangent[0] * cotangent[1] - tangent[1] * cotangent[0],
        ];
        (point, area)
    }

    /// The middle of the face [m].
    pub fn centre(&self, mesh: &Mesh) -> [f64; 3] {
        self.point_and_area(mesh, self.shape.natural_centre()).0
    }
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

    /// The face `side` (number in [`ElementKind::faces`]) of element `element` (index).
    pub fn face(&self, element: usize, side: usize) -> Face {
        let (local, nodes) = (self.connectivity.kind(element).faces()[side], &self.connectivity[element]);
        let mut of_face = [nodes[local[0]]; MAX_FACE_NODES];
        for (node, &l) in of_face.iter_mut().zip(local) {
            *node = nodes[l];
        }
        let shape = FaceShape::with_nodes(local.len());
        Face { element: element as u32, side: side as u8, shape, nodes: of_face }
    }

    /// The faces that belong to one element only, in element order then side order.
    pub fn boundary_faces(&self) -> Vec<Face> {
        let mut keyed: Vec<([u32; 4], Face)> = (0..self.element_count())
            .flat_map(|e| (0..self.connectivity.kind(e).faces().len()).map(move |s| (e, s)))
            .map(|(e, s)| {
                let face = self.face(e, s);
                let mut key = [u32::MAX; 4];
                key[..face.corners().len()].copy_from_slice(face.corners());
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

    /// Adds an element.
    ///
    /// # Panics
    /// When the number of nodes is not that of the kind.
    pub fn push_element(&mut self, id: u32, material: u32, kind: ElementKind, nodes: &[u32]) {
        self.element_ids.push(id);
        self.materials.push(material);
        self.connectivity.push(kind, nodes);
    }
}

impl Mesh {
    /// Coordinates of the nodes of element `element` (index) [m]; zero beyond the nodes of its kind.
    #[inline]
    pub fn element_coordinates(&self, element: usize) -> ElementCoordinates {
        let mut x = ElementCoordinates::default();
        for (x, &n) in x.iter_mut().zip(&self.connectivity[element]) {
            *x = self.coordinates[n as usize];
        }
        x
    }

    /// The triples of the nodes of element `element` (index) out of a nodal vector of shape `[3 * nodes]`; zero beyond
    /// the nodes of its kind.
    #[inline]
    pub fn element_values(&self, element: usize, nodal: &[f64]) -> ElementCoordinates {
        let mut values = ElementCoordinates::default();
        for (value, &n) in values.iter_mut().zip(&self.connectivity[element]) {
            let n = 3 * n as usize;
            *value = [nodal[n], nodal[n + 1], nodal[n + 2]];
        }
        values
    }

    /// The middle of element `element` (index) [m].
    pub fn element_centre(&self, element: usize) -> [f64; 3] {
        let kind = self.connectivity.kind(element);
        let n = kind.shape_functions(kind.natural_centre());
        let x = self.element_coordinates(element);
        std::array::from_fn(|k| x.iter().zip(&n).map(|(x, n)| n * x[k]).sum())
    }

    /// Volume of element `element` [m³], by the rule of the mass.
    pub fn element_volume(&self, element: usize) -> f64 {
        let x = self.element_coordinates(element);
        mass_points(self.connectivity.kind(element))
            .iter()
            .map(|p| p.weight * jacobian(&x, &p.gradients).1)
            .sum()
    }

    /// Quality of element `element`: smallest over largest determinant of the Jacobian at the nodes and the points of the
    /// mass. 1 is a parallelepiped; 0 or below is degenerate or inverted somewhere. At the apex of a pyramid, the limits
    /// along its four uprights count ([`ElementKind::limits_at_node`]).
    pub fn jacobian_ratio(&self, element: usize) -> f64 {
        let (x, kind) = (self.element_coordinates(element), self.connectivity.kind(element));
        let at_nodes = (0..kind.node_count())
            .flat_map(|n| kind.limits_at_node(n))
            .map(|xi| jacobian(&x, &kind.gradients(*xi)).1);
        let at_points = mass_points(kind).iter().map(|p| jacobian(&x, &p.gradients).1);
        let (low, high) = at_nodes
            .chain(at_points)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), det| (low.min(det), high.max(det)));
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
            for &(xi, w) in face.shape.points() {
                let (x, a) = face.point_and_area(&mesh, xi);
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
            let (_, area) = mesh.face(0, side).point_and_area(&mesh, [0.3, -0.2]);
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
