//! The solid's surface as the grains see it: curved 8-node faces moving with the nodes.
//!
//! Within one exchange window the nodes move on straight lines, x(τ) = x₀ + v τ, with the position and the
//! velocity that the solid has at the start of the window (scheme B of the two-mass study in the guide:
//! displacement **and** velocity go back, so that damping and friction see the surface move).

use crate::face::{self, Location};
use trackbed_dem::search::bvh::Bvh;
use trackbed_dem::surface::{Feature, PatchPoint, Surface};
use trackbed_fem::FaceShape;
use trackbed_fem::mesh::{Face, Mesh};

/// Part of the solid's boundary that grains may touch.
pub struct SolidSurface {
    faces: Vec<Face>,
    /// Solid node of each surface node, ascending.
    nodes: Vec<u32>,
    /// Surface nodes of each face. Shape `[faces][8]`.
    face_nodes: Vec<[u32; 8]>,
    start: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    current: Vec<[f64; 3]>,
    max_speed: f64,
    tree: Bvh,
    boxes: Vec<([f64; 3], [f64; 3])>,
}

impl SolidSurface {
    /// The surface made of `faces` of `mesh`, at rest in the mesh's own shape.
    pub fn new(mesh: &Mesh, faces: Vec<Face>) -> SolidSurface {
        let mut nodes: Vec<u32> = faces.iter().flat_map(|f| f.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let local = |node: u32| nodes.binary_search(&node).expect("node of a face is a surface node") as u32;
        let face_nodes: Vec<[u32; 8]> = faces.iter().map(|f| f.nodes.map(local)).collect();
        let start: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.coordinates[n as usize]).collect();
        let boxes: Vec<_> = face_nodes.iter().map(|f| bounds(&f.map(|n| start[n as usize]))).collect();
        SolidSurface {
            tree: Bvh::new(&boxes),
            boxes,
            current: start.clone(),
            velocity: vec![[0.0; 3]; start.len()],
            start,
            nodes,
            face_nodes,
            faces,
            max_speed: 0.0,
        }
    }

    /// The 8-node boundary faces of `mesh` whose outward area vector makes an angle of at most `max_angle` [rad] with
    /// `direction`: the default choice of a surface for ballast is "upward, up to 75 degrees".
    pub fn facing(mesh: &Mesh, direction: [f64; 3], max_angle: f64) -> Vec<Face> {
        let length = face::dot(direction, direction).sqrt();
        mesh.boundary_faces()
            .into_iter()
            .filter(|f| f.shape == FaceShape::Quad8)
            .filter(|f| {
                let x = |k: usize| mesh.coordinates[f.nodes[k] as usize];
                let diagonal = |a: [f64; 3], b: [f64; 3]| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
                let area = face::cross(diagonal(x(0), x(2)), diagonal(x(1), x(3)));
                let norm = face::dot(area, area).sqrt();
                face::dot(area, direction) >= max_angle.cos() * norm * length
            })
            .collect()
    }

    /// Faces of the surface, in patch order.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Solid node (index) of each surface node, ascending.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Surface nodes of face `patch`.
    pub fn face_nodes(&self, patch: u32) -> &[u32; 8] {
        &self.face_nodes[patch as usize]
    }

    /// Present position of surface node `node` [m].
    pub fn position(&self, node: u32) -> [f64; 3] {
        self.current[node as usize]
    }

    /// Height of the highest node [m].
    pub fn highest(&self) -> f64 {
        self.current.iter().map(|x| x[2]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Area vector of face `patch` in its present shape, by its corners: outward normal times area [m²].
    pub fn area_vector(&self, patch: u32) -> [f64; 3] {
        let x = |k: usize| self.current[self.face_nodes[patch as usize][k] as usize];
        let diagonal = |a: [f64; 3], b: [f64; 3]| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        face::cross(diagonal(x(0), x(2)), diagonal(x(1), x(3))).map(|c| 0.5 * c)
    }

    /// Begins a window of `duration` [s]: nodes at X + (u − reference), moving with `v`. All arrays have shape
    /// `[3·nodes]` of the solid; `reference` is the displacement in the shape that the mesh file describes.
    pub fn begin_window(&mut self, mesh: &Mesh, u: &[f64], reference: &[f64], v: &[f64], duration: f64) {
        let mut fastest = 0.0_f64;
        for (k, &node) in self.nodes.iter().enumerate() {
            let n = node as usize;
            for d in 0..3 {
                self.start[k][d] = mesh.coordinates[n][d] + (u[3 * n + d] - reference[3 * n + d]);
                self.velocity[k][d] = v[3 * n + d];
            }
            fastest = fastest.max(face::dot(self.velocity[k], self.velocity[k]));
        }
        // The absolute sum of the eight functions is at most 3 (at the centre: 4 × ¼ + 4 × ½).
        self.max_speed = 3.0 * fastest.sqrt();
        self.current.copy_from_slice(&self.start);
        // The boxes hold the faces over the whole window: motion is linear in time, so both ends suffice.
        for (b, f) in self.boxes.iter_mut().zip(&self.face_nodes) {
            let first = bounds(&f.map(|n| self.start[n as usize]));
            let last = bounds(&f.map(|n| {
                let (x, v) = (self.start[n as usize], self.velocity[n as usize]);
                [x[0] + v[0] * duration, x[1] + v[1] * duration, x[2] + v[2] * duration]
            }));
            for d in 0..3 {
                b.0[d] = first.0[d].min(last.0[d]);
                b.1[d] = first.1[d].max(last.1[d]);
            }
        }
        self.tree.refit(&self.boxes);
    }

    /// Moves the nodes to time `tau` [s] after the start of the window.
    pub fn advance(&mut self, tau: f64) {
        for ((x, x0), v) in self.current.iter_mut().zip(&self.start).zip(&self.velocity) {
            for d in 0..3 {
                x[d] = x0[d] + v[d] * tau;
            }
        }
    }

    fn coordinates(&self, patch: u32) -> [[f64; 3]; 8] {
        self.face_nodes[patch as usize].map(|n| self.current[n as usize])
    }
}

/// Bounding box of a curved face, from its Bernstein control points: the eight-node field is biquadratic, and a
/// biquadratic patch lies within the hull of its nine control points, whereas it may bulge beyond its nodes.
fn bounds(x: &[[f64; 3]; 8]) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for d in 0..3 {
        let corner = [x[0][d], x[1][d], x[2][d], x[3][d]];
        let side = [0, 1, 2, 3].map(|k| 2.0 * x[4 + k][d] - 0.5 * (corner[k] + corner[(k + 1) % 4]));
        let corners: f64 = corner.iter().sum();
        let centre = 0.5 * (x[4][d] + x[5][d] + x[6][d] + x[7][d]) - 0.25 * corners;
        let middle = 4.0 * centre - 0.25 * corners - 0.5 * side.iter().sum::<f64>();
        for c in corner.iter().chain(&side).chain([&middle]) {
            low[d] = low[d].min(*c);
            high[d] = high[d].max(*c);
        }
    }
    (low, high)
}

impl Surface for SolidSurface {
    fn candidates(&self, low: [f64; 3], high: [f64; 3], out: &mut Vec<u32>) {
        self.tree.query(low, high, out);
    }

    fn closest_point(&self, patch: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint {
        let closest = face::closest_point(&self.coordinates(patch), centre, local);
        let nodes = &self.face_nodes[patch as usize];
        let velocity = face::interpolate(&nodes.map(|n| self.velocity[n as usize]), closest.natural);
        // A mid-side node names its edge and a corner node its vertex, whichever face they are seen from.
        let feature = match closest.location {
            Location::Inside => Feature::Face,
            Location::Side(s) => Feature::Edge(nodes[4 + s as usize]),
            Location::Corner(c) => Feature::Vertex(nodes[c as usize]),
        };
        PatchPoint { point: closest.point, normal: closest.normal, velocity, local: closest.natural, feature }
    }

    fn max_speed(&self) -> f64 {
        self.max_speed
    }

    fn one_sided(&self) -> bool {
        true
    }
}
