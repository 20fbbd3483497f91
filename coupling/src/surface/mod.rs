//! Moving contact surface of the solid.
//!
//! Nodes move linearly within a window, x(τ) = x₀ + v τ, v from the coupling [scheme](crate::scheme).

mod face_adjacency;
mod face_triangles;

use crate::distributed_transfer::DistributedTransfer;
use crate::face::{self, Form, Location};
use face_adjacency::FaceAdjacency;
pub use face_triangles::face_triangles;
use trackbed_dem::Vec3;
use trackbed_dem::bvh::Bvh;
use trackbed_dem::sheet::SurfaceMesh;
use trackbed_dem::surface::{Feature, PatchPoint, Surface};
use trackbed_fem::FaceShape;
use trackbed_fem::mesh::{Face, Mesh};

/// Sample points for inversion: centre and corners; a triangle repeats its last corner.
fn places(shape: FaceShape) -> [[f64; 2]; 5] {
    let (corners, middle) = (face::landmarks(shape), shape.natural_centre());
    [0, 1, 2, 3, 4].map(|k| if k == 0 { middle } else { corners[(k - 1).min(shape.corner_count() - 1)] })
}

/// Cosine between face normals below which the common side is an edge.
const SHARP: f64 = 0.1;

/// Contact surface of the solid.
pub struct SolidSurface {
    faces: Vec<Face>,
    /// Solid node of each surface node, ascending.
    nodes: Vec<u32>,
    shapes: Vec<FaceShape>,
    /// Padded with the first node. Shape `[faces][8]`.
    face_nodes: Vec<[u32; 8]>,
    /// Undeformed.
    shape: Vec<[f64; 3]>,
    start: Vec<[f64; 3]>,
    /// Over the window.
    rate: Vec<[f64; 3]>,
    /// Initial velocity and its change, if not the rate.
    velocity: Option<[Vec<[f64; 3]>; 2]>,
    /// Displacement without velocity [m]; empty if none or applied.
    correction: Vec<[f64; 3]>,
    /// Faces and their rates.
    forms: Vec<[Form; 2]>,
    moving: bool,
    tau: f64,
    duration: f64,
    max_speed: f64,
    tree: Bvh,
    boxes: Vec<([f64; 3], [f64; 3])>,
    pub(crate) spread: Option<DistributedTransfer>,
    sides: FaceAdjacency,
    /// Undeformed normals at [`places`].
    areas: Vec<[[f64; 3]; 5]>,
    scratch: Vec<[f64; 3]>,
}

/// Motion of the solid's nodes over a window. Shapes `[3·nodes]`.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Initial displacement [m].
    pub start: &'a [f64],
    /// Displacement of the meshed shape [m].
    pub reference: &'a [f64],
    /// Displacement rate [m/s].
    pub rate: &'a [f64],
    /// Initial and final velocity for damping and friction [m/s]; `None`: the rate.
    pub velocity: Option<[&'a [f64]; 2]>,
    /// Extra displacement of tangential springs in the first step [m].
    pub correction: Option<&'a [f64]>,
    /// Duration [s].
    pub duration: f64,
}

impl SolidSurface {
    /// Undeformed surface of `faces` of `mesh`.
    pub fn new(mesh: &Mesh, faces: Vec<Face>) -> SolidSurface {
        let mut nodes: Vec<u32> = faces.iter().flat_map(|f| f.nodes()).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let local = |node: u32| nodes.binary_search(&node).expect("node of a face is a surface node") as u32;
        let face_nodes: Vec<[u32; 8]> = faces.iter().map(|f| f.nodes.map(local)).collect();
        let start: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.coordinates[n as usize]).collect();
        let shapes: Vec<FaceShape> = faces.iter().map(|f| f.shape).collect();
        let of_kind = || shapes.iter().zip(&face_nodes).map(|(s, f)| (*s, f.map(|n| start[n as usize])));
        let boxes: Vec<_> = of_kind().map(|(s, x)| face::bounds(s, &x)).collect();
        let forms = of_kind().map(|(s, x)| [Form::new(s, &x), Form::default()]).collect();
        let areas = of_kind().map(|(s, x)| places(s).map(|p| Form::new(s, &x).area(p))).collect();
        let sides = FaceAdjacency::new(&shapes, &face_nodes);
        SolidSurface {
            tree: Bvh::new(&boxes),
            boxes,
            shape: start.clone(),
            rate: vec![[0.0; 3]; start.len()],
            velocity: None,
            correction: Vec::new(),
            forms,
            moving: false,
            tau: 0.0,
            duration: 0.0,
            scratch: vec![[0.0; 3]; start.len()],
            start,
            nodes,
            shapes,
            face_nodes,
            faces,
            max_speed: 0.0,
            spread: None,
            sides,
            areas,
        }
    }

    /// Distributed load transfer, if any.
    pub fn spread(&self) -> Option<&DistributedTransfer> {
        self.spread.as_ref()
    }

    /// Returns boundary faces with normals within `max_angle` [rad] of `direction`; for ballast usually
    /// upward, 75 degrees.
    pub fn facing(mesh: &Mesh, direction: [f64; 3], max_angle: f64) -> Vec<Face> {
        let length = face::dot(direction, direction).sqrt();
        mesh.boundary_faces()
            .into_iter()
            .filter(|f| {
                let area = twice_the_area(f.shape, |k| mesh.coordinates[f.nodes[k] as usize]);
                let norm = face::dot(area, area).sqrt();
                face::dot(area, direction) >= libm::cos(max_angle) * norm * length
            })
            .collect()
    }

    /// Faces, in patch order.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// Dofs of the surface in nodal vectors of the solid, ascending.
    pub fn dofs(&self) -> impl Iterator<Item = usize> {
        self.nodes.iter().flat_map(|&n| [0, 1, 2].map(|d| 3 * n as usize + d))
    }

    /// Solid node of each surface node, ascending.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Kind of face `patch`.
    #[inline]
    pub fn shape(&self, patch: u32) -> FaceShape {
        self.shapes[patch as usize]
    }

    /// Surface nodes of face `patch`: corners, then mid-sides.
    #[inline]
    pub fn face_nodes(&self, patch: u32) -> &[u32] {
        &self.face_nodes[patch as usize][..self.shape(patch).node_count()]
    }

    pub(crate) fn padded_nodes(&self, patch: u32) -> [u32; 8] {
        self.face_nodes[patch as usize]
    }

    /// Shape functions on face `patch`; zero beyond its nodes.
    #[inline]
    pub fn shape_functions(&self, patch: u32, natural: [f64; 2]) -> [f64; 8] {
        self.shape(patch).shape_functions(natural)
    }

    /// Current position on face `patch` [m].
    pub fn place(&self, patch: u32, natural: [f64; 2]) -> [f64; 3] {
        let x = self.face_nodes[patch as usize].map(|n| self.position(n));
        face::interpolate(self.shape(patch), &x, natural)
    }

    /// Undeformed triangles, for polyhedra; `None` with other faces ([`face_triangles`]).
    pub fn triangles(&self) -> Option<SurfaceMesh> {
        let flat = self.shapes.iter().all(|s| *s == FaceShape::Tri3);
        flat.then(|| SurfaceMesh {
            vertices: self.shape.iter().map(|x| Vec3::from(*x)).collect(),
            triangles: self.face_nodes.iter().map(|n| [n[0], n[1], n[2]]).collect(),
        })
    }

    /// For damping and friction [m/s].
    fn node_velocity(&self, node: u32) -> [f64; 3] {
        let n = node as usize;
        match &self.velocity {
            None => self.rate[n],
            Some([first, change]) => {
                let share = self.tau / self.duration;
                [0, 1, 2].map(|d| first[n][d] + share * change[n][d])
            }
        }
    }

    /// Current position of surface node `node` [m].
    pub fn position(&self, node: u32) -> [f64; 3] {
        let (x, v) = (self.start[node as usize], self.rate[node as usize]);
        [x[0] + v[0] * self.tau, x[1] + v[1] * self.tau, x[2] + v[2] * self.tau]
    }

    /// Undeformed position [m].
    pub fn mesh_position(&self, node: u32) -> [f64; 3] {
        self.shape[node as usize]
    }

    /// Highest node [m].
    pub fn highest(&self) -> f64 {
        (0..self.nodes.len() as u32).map(|n| self.position(n)[2]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Lowest node [m].
    pub fn lowest(&self) -> f64 {
        (0..self.nodes.len() as u32).map(|n| self.position(n)[2]).fold(f64::INFINITY, f64::min)
    }

    /// Distance of the farthest node of face `patch` from the origin [m].
    pub fn reach(&self, patch: u32) -> f64 {
        let square = |n: &u32| {
            let x = self.position(*n);
            face::dot(x, x)
        };
        self.face_nodes(patch).iter().map(square).fold(0.0, f64::max).sqrt()
    }

    /// Outward normal times area [m²], from the corners of face `patch`.
    pub fn area_vector(&self, patch: u32) -> [f64; 3] {
        let corner = |k: usize| self.position(self.face_nodes[patch as usize][k]);
        twice_the_area(self.shape(patch), corner).map(|c| 0.5 * c)
    }

    /// Outward unit normal at the start of the window.
    pub fn normal(&self, patch: u32, natural: [f64; 2]) -> [f64; 3] {
        let n = self.forms[patch as usize][0].area(natural);
        n.map(|c| c / face::dot(n, n).sqrt())
    }

    /// Displacement rate on face `patch` [m/s].
    pub fn velocity(&self, patch: u32, natural: [f64; 2]) -> [f64; 3] {
        self.forms[patch as usize][1].at(natural)
    }

    /// Begins a window of `duration` [s]: nodes at X + (u − reference), moving with `v`. Shapes `[3·nodes]`;
    /// `reference` is the displacement of the meshed shape.
    pub fn begin_window(&mut self, mesh: &Mesh, u: &[f64], reference: &[f64], v: &[f64], duration: f64) {
        self.begin(
            mesh,
            &Motion { start: u, reference, rate: v, velocity: None, correction: None, duration },
        );
    }

    /// Begins a window with the given motion.
    pub fn begin(&mut self, mesh: &Mesh, motion: &Motion<'_>) {
        debug_assert_eq!(mesh.node_count() * 3, motion.start.len());
        let at = |values: &[f64], node: u32| [0, 1, 2].map(|d| values[3 * node as usize + d]);
        for (s, &n) in self.scratch.iter_mut().zip(&self.nodes) {
            let (u, r) = (at(motion.start, n), at(motion.reference, n));
            *s = [0, 1, 2].map(|d| u[d] - r[d]);
        }
        smooth(self.spread.as_ref(), &self.scratch, &mut self.start);
        for (x, shape) in self.start.iter_mut().zip(&self.shape) {
            *x = [0, 1, 2].map(|d| shape[d] + x[d]);
        }
        self.scratch.iter_mut().zip(&self.nodes).for_each(|(s, &n)| *s = at(motion.rate, n));
        smooth(self.spread.as_ref(), &self.scratch, &mut self.rate);
        let fastest = |v: &[[f64; 3]]| v.iter().map(|v| face::dot(*v, *v)).fold(0.0, f64::max).sqrt();
        let speed = fastest(&self.rate);
        self.velocity = motion.velocity.map(|ends| {
            let [first, last] = ends.map(|v| {
                let mut out = vec![[0.0; 3]; self.nodes.len()];
                self.scratch.iter_mut().zip(&self.nodes).for_each(|(s, &n)| *s = at(v, n));
                smooth(self.spread.as_ref(), &self.scratch, &mut out);
                out
            });
            let change = last.iter().zip(&first).map(|(b, a)| [0, 1, 2].map(|d| b[d] - a[d])).collect();
            [first, change]
        });
        self.correction.clear();
        if let Some(correction) = motion.correction {
            self.scratch.iter_mut().zip(&self.nodes).for_each(|(s, &n)| *s = at(correction, n));
            self.correction.resize(self.nodes.len(), [0.0; 3]);
            smooth(self.spread.as_ref(), &self.scratch, &mut self.correction);
        }
        // Absolute sum of shape functions: at most 3 (8 nodes, centre: 4 × ¼ + 4 × ½), 5/3 with 6 nodes.
        self.max_speed = 3.0 * speed;
        self.moving = speed > 0.0;
        (self.tau, self.duration) = (0.0, motion.duration);
        // Motion is linear in time: both ends bound the faces over the window.
        let kinds = self.face_nodes.iter().zip(&self.shapes);
        for ((b, (f, &shape)), form) in self.boxes.iter_mut().zip(kinds).zip(&mut self.forms) {
            let start = f.map(|n| self.start[n as usize]);
            let rate = f.map(|n| self.rate[n as usize]);
            *form = [Form::new(shape, &start), Form::new(shape, &rate)];
            let (x, v, t) = (start, rate, motion.duration);
            let first = face::bounds(shape, &x);
            let end = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| [0, 1, 2].map(|d| x[k][d] + v[k][d] * t));
            let last = face::bounds(shape, &end);
            for d in 0..3 {
                b.0[d] = first.0[d].min(last.0[d]);
                b.1[d] = first.1[d].max(last.1[d]);
            }
        }
        self.tree.refit(&self.boxes);
    }

    pub(crate) fn end_correction(&mut self) {
        self.correction.clear();
    }

    /// Moves the nodes to `tau` [s].
    pub fn advance(&mut self, tau: f64) {
        self.tau = tau;
    }

    /// Bounds the displacement [m] of surface points for nodal displacements up to `way` [m].
    pub fn reach_of(&self, way: f64) -> f64 {
        // Disc and contact points: weights of absolute sum 3 at most.
        if self.spread.is_some() { 18.0 * way } else { 3.0 * way }
    }

    /// Returns an inverted face at the start of the window: normal rotated by 90 degrees, area down to a
    /// twentieth, or neighbours facing away from each other.
    pub fn folded(&self) -> Option<usize> {
        let bad = (0..self.faces.len()).find(|&k| {
            places(self.shapes[k]).iter().zip(&self.areas[k]).any(|(&place, before)| {
                // NaN counts as inverted.
                let part = face::dot(*before, self.forms[k][0].area(place)) / face::dot(*before, *before);
                part.is_nan() || part < 0.05
            })
        });
        let turned = |&[a, b]: &[u32; 2]| {
            let (a, b) = (a as usize, b as usize);
            let middle = |k: usize| self.forms[k][0].area(self.shapes[k].natural_centre());
            let now = face::dot(middle(a), middle(b));
            let product = |i: usize, j: usize| face::dot(self.areas[i][0], self.areas[j][0]);
            now <= 0.0 && product(a, b) > SHARP * (product(a, a) * product(b, b)).sqrt()
        };
        bad.or_else(|| self.sides.seams.iter().find(|s| turned(s)).map(|s| s[0] as usize))
    }

    /// Whether corner `corner` of face `patch` lies on the border.
    pub fn corner_on_border(&self, patch: u32, corner: usize) -> bool {
        self.sides.rim[self.face_nodes[patch as usize][corner] as usize]
    }

    pub(crate) fn on_border(&self, patch: u32, side: usize) -> bool {
        self.sides.border[patch as usize][side]
    }

    /// Nearest patch and point; boxes within `reach` [m].
    pub(crate) fn nearest(&self, point: [f64; 3], reach: f64) -> Option<(u32, face::Closest)> {
        let mut patches = Vec::new();
        self.tree.query(point.map(|c| c - reach), point.map(|c| c + reach), &mut patches);
        let found = patches.iter().map(|&k| (k, self.form(k).closest_point(self.shape(k), point, [0.0; 2])));
        let way = |c: &face::Closest| {
            let r = [0, 1, 2].map(|d| c.point[d] - point[d]);
            face::dot(r, r)
        };
        found.min_by(|a, b| way(&a.1).total_cmp(&way(&b.1)))
    }

    #[inline]
    fn form(&self, patch: u32) -> Form {
        let [start, rate] = &self.forms[patch as usize];
        if self.moving && self.tau != 0.0 { start.plus(self.tau, rate) } else { *start }
    }
}

fn smooth(spread: Option<&DistributedTransfer>, field: &[[f64; 3]], out: &mut [[f64; 3]]) {
    match spread {
        None => out.copy_from_slice(field),
        Some(spread) => spread.mean(field, out),
    }
}

fn twice_the_area(shape: FaceShape, x: impl Fn(usize) -> [f64; 3]) -> [f64; 3] {
    let way = |a: [f64; 3], b: [f64; 3]| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    match shape.corner_count() {
        3 => face::cross(way(x(0), x(1)), way(x(0), x(2))),
        _ => face::cross(way(x(0), x(2)), way(x(1), x(3))),
    }
}

impl Surface for SolidSurface {
    fn candidates(&self, low: [f64; 3], high: [f64; 3], out: &mut Vec<u32>) {
        self.tree.query(low, high, out);
    }

    fn closest_point(&self, patch: u32, centre: [f64; 3], local: [f64; 2]) -> PatchPoint {
        let shape = self.shapes[patch as usize];
        let closest = self.form(patch).closest_point(shape, centre, local);
        let nodes = &self.face_nodes[patch as usize];
        let velocity = match &self.velocity {
            None if self.moving => self.forms[patch as usize][1].at(closest.natural),
            None => [0.0; 3],
            Some(_) => {
                let at = |n: u32| self.node_velocity(n);
                face::interpolate(shape, &nodes.map(at), closest.natural)
            }
        };
        // Same index from all faces.
        let feature = match closest.location {
            Location::Inside => Feature::Face,
            Location::Side(s) => Feature::Edge(self.sides.number[patch as usize][s as usize]),
            Location::Corner(c) => Feature::Vertex(nodes[c as usize]),
        };
        PatchPoint { point: closest.point, normal: closest.normal, velocity, local: closest.natural, feature }
    }

    fn correction(&self, patch: u32, local: [f64; 2]) -> Option<[f64; 3]> {
        (!self.correction.is_empty()).then(|| {
            let nodes = self.face_nodes[patch as usize];
            face::interpolate(self.shape(patch), &nodes.map(|n| self.correction[n as usize]), local)
        })
    }

    fn vertex_correction(&self, vertex: u32) -> Option<[f64; 3]> {
        self.correction.get(vertex as usize).copied()
    }

    fn vertex(&self, vertex: u32) -> Option<[Vec3; 2]> {
        Some([self.position(vertex).into(), self.node_velocity(vertex).into()])
    }

    fn max_speed(&self) -> f64 {
        self.max_speed
    }

    /// Distance from the box over the whole window.
    fn clearance(&self, patch: u32, centre: [f64; 3]) -> f64 {
        let (low, high) = &self.boxes[patch as usize];
        let beyond = [0, 1, 2].map(|d| (low[d] - centre[d]).max(centre[d] - high[d]).max(0.0));
        face::dot(beyond, beyond).sqrt()
    }

    fn one_sided(&self) -> bool {
        true
    }
}
