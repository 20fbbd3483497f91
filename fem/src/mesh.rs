//! Finite-element mesh: nodes, elements, boundary faces.

use crate::connectivity::Connectivity;
use crate::element::{ElementKind, FaceShape, MAX_FACE_NODES, mass_points};
use crate::kinematics::{ElementCoordinates, jacobian};

/// Mesh; hex20 in SOLID186 node order (I…P corners, Q…T bottom, U…X top, Y…B uprights).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// File numbers of nodes. Shape `[nodes]`.
    pub node_ids: Vec<u32>,
    /// Node coordinates [m]. Shape `[nodes][3]`.
    pub coordinates: Vec<[f64; 3]>,
    /// File numbers of elements. Shape `[elements]`.
    pub element_ids: Vec<u32>,
    /// Material number per element. Shape `[elements]`.
    pub materials: Vec<u32>,
    /// Kind and node indices (0-based) per element.
    pub connectivity: Connectivity,
}

/// Boundary face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Element index (0-based).
    pub element: u32,
    /// Index in [`ElementKind::faces`]; for hexahedra the SOLID186 face number minus one.
    pub side: u8,
    /// Shape.
    pub shape: FaceShape,
    /// Node indices: corners counter-clockwise from outside, then mid-sides; padded with the first.
    pub nodes: [u32; MAX_FACE_NODES],
}

impl Face {
    /// Nodes of the face.
    #[inline]
    pub fn nodes(&self) -> &[u32] {
        &self.nodes[..self.shape.node_count()]
    }

    /// Corner nodes.
    #[inline]
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..self.shape.corner_count()]
    }

    /// Point [m] and outward area vector dx/dxi × dx/deta [m²] at the natural point `xi`.
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

    /// Centre [m].
    pub fn centre(&self, mesh: &Mesh) -> [f64; 3] {
        self.point_and_area(mesh, self.shape.natural_centre()).0
    }
}

/// Prescribed displacement of one dof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Node index (0-based).
    pub node: u32,
    /// Direction: 0 = x, 1 = y, 2 = z.
    pub direction: u8,
    /// Prescribed displacement [m].
    pub value: f64,
}

impl Mesh {
    /// Node count.
    pub fn node_count(&self) -> usize {
        self.coordinates.len()
    }

    /// Number of elements.
    pub fn element_count(&self) -> usize {
        self.connectivity.len()
    }

    /// Face `side` (as in [`ElementKind::faces`]) of an element (index).
    pub fn face(&self, element: usize, side: usize) -> Face {
        let (local, nodes) = (self.connectivity.kind(element).faces()[side], &self.connectivity[element]);
        let mut of_face = [nodes[local[0]]; MAX_FACE_NODES];
        for (node, &l) in of_face.iter_mut().zip(local) {
            *node = nodes[l];
        }
        let shape = FaceShape::with_nodes(local.len());
        Face { element: element as u32, side: side as u8, shape, nodes: of_face }
    }

    /// Faces of one element only, by element and side.
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
    /// If the number of nodes does not match the kind.
    pub fn push_element(&mut self, id: u32, material: u32, kind: ElementKind, nodes: &[u32]) {
        self.element_ids.push(id);
        self.materials.push(material);
        self.connectivity.push(kind, nodes);
    }
}

impl Mesh {
    /// Node coordinates of an element [m], zero-padded.
    #[inline]
    pub fn element_coordinates(&self, element: usize) -> ElementCoordinates {
        let mut x = ElementCoordinates::default();
        for (x, &n) in x.iter_mut().zip(&self.connectivity[element]) {
            *x = self.coordinates[n as usize];
        }
        x
    }

    /// Nodal values of an element, shape `[3 * nodes]`, zero-padded.
    #[inline]
    pub fn element_values(&self, element: usize, nodal: &[f64]) -> ElementCoordinates {
        let mut values = ElementCoordinates::default();
        for (value, &n) in values.iter_mut().zip(&self.connectivity[element]) {
            let n = 3 * n as usize;
            *value = [nodal[n], nodal[n + 1], nodal[n + 2]];
        }
        values
    }

    /// Centre of an element (index) [m].
    pub fn element_centre(&self, element: usize) -> [f64; 3] {
        let kind = self.connectivity.kind(element);
        let n = kind.shape_functions(kind.natural_centre());
        let x = self.element_coordinates(element);
        std::array::from_fn(|k| x.iter().zip(&n).map(|(x, n)| n * x[k]).sum())
    }

    /// Volume of an element [m³] by the mass rule.
    pub fn element_volume(&self, element: usize) -> f64 {
        let x = self.element_coordinates(element);
        mass_points(self.connectivity.kind(element))
            .iter()
            .map(|p| p.weight * jacobian(&x, &p.gradients).1)
            .sum()
    }

    /// Jacobian ratio, smallest over largest, at nodes ([`ElementKind::limits_at_node`]) and mass points: 1
    /// for a parallelepiped, 0 or below if inverted.
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

    /// Smallest and largest node coordinates [m]; infinite and reversed if empty.
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        self.coordinates.iter().fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), c| {
            (std::array::from_fn(|k| low[k].min(c[k])), std::array::from_fn(|k| high[k].max(c[k])))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent() -> Mesh {
        let mut mesh = Mesh::block([2, 2, 2], [2.0, 1.0, 1.0]);
        for c in &mut mesh.coordinates {
            let [x, y, z] = *c;
            *c = [x + 0.1 * y * z, y + 0.08 * x * x - 0.05 * z, z + 0.1 * (x * y).sin()];
        }
        mesh
    }

    #[test]
    fn closed_surface_encloses_volume() {
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
        // The 3×3 rule is exact for x · dA on flat faces only.
        assert!((enclosed / volume - 1.0).abs() < 1e-3, "{enclosed} {volume}");
    }

    #[test]
    fn element_faces_point_outward() {
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
    fn excludes_inner_faces() {
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
