//! The finite-element mesh: nodes, 20-node hexahedra, and the faces of its surface.

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
