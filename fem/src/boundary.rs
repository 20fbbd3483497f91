//! Distributed springs and dashpots on faces: absorbing boundaries and elastic supports.
//!
//! Traction `t = -(k_n n n^T + k_t (1 - n n^T)) u - (c_n n n^T + c_t (1 - n n^T)) v`, outward normal n.
//! Springs join the stiffness (also in Rayleigh damping).
//!
//! `c_n = rho c_p`, `c_t = rho c_s` absorb plane waves at normal incidence (Lysmer and Kuhlemeyer 1969).
//! Springs of order G/R, R being the source distance, prevent static drift (Deeks and Randolph 1994,
//! axisymmetric; Liu and others 2006, three dimensions). Limits: oblique and surface waves are partly
//! reflected; normals are undeformed.
//!
//! Theory manual: equation (4.17) of `docs/theory/solid.md`.

use crate::error::ModelError;
use crate::material::elastic::Elastic;
use crate::mesh::{Face, Mesh};
use std::collections::BTreeMap;

/// Springs and dashpots on faces of the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoundaryLayer {
    /// Boundary faces, each once.
    pub faces: Vec<Face>,
    /// Normal dashpot [Pa s/m], 0 or above.
    pub dashpot_normal: f64,
    /// Tangential dashpot [Pa s/m], 0 or above.
    pub dashpot_tangential: f64,
    /// Normal spring [Pa/m], 0 or above.
    pub spring_normal: f64,
    /// Tangential spring [Pa/m], 0 or above.
    pub spring_tangential: f64,
}

/// Factors of `G/R` in [`BoundaryLayer::viscous_spring`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringFactors {
    /// Normal factor [-].
    pub normal: f64,
    /// Tangential factor [-].
    pub tangential: f64,
}

impl SpringFactors {
    /// Three-dimensional bodies with surface loads (Liu and others 2006).
    pub const SPATIAL: SpringFactors = SpringFactors { normal: 4.0 / 3.0, tangential: 2.0 / 3.0 };
    /// Exact for an expanding (u ~ 1/r², `t = 4 G u/R`) or twisted sphere (`t = 3 G u/R`).
    pub const SPHERE: SpringFactors = SpringFactors { normal: 4.0, tangential: 3.0 };
    /// Exact for an expanding or twisted cylinder in plane strain (u ~ 1/r, `t = 2 G u/R`).
    pub const CYLINDER: SpringFactors = SpringFactors { normal: 2.0, tangential: 2.0 };
}

impl BoundaryLayer {
    /// Absorbing dashpots `rho c_p` and `rho c_s` (Lysmer and Kuhlemeyer 1969).
    pub fn absorbing(faces: Vec<Face>, medium: &Elastic) -> BoundaryLayer {
        let (lambda, mu) = medium.lame();
        BoundaryLayer {
            faces,
            dashpot_normal: (medium.density * (lambda + 2.0 * mu)).sqrt(),
            dashpot_tangential: (medium.density * mu).sqrt(),
            ..Default::default()
        }
    }

    /// Absorbing dashpots with springs `factor G/R`; `distance` R [m] from wave source to boundary.
    pub fn viscous_spring(
        faces: Vec<Face>,
        medium: &Elastic,
        distance: f64,
        factors: SpringFactors,
    ) -> BoundaryLayer {
        let shear = medium.lame().1;
        BoundaryLayer {
            spring_normal: factors.normal * shear / distance,
            spring_tangential: factors.tangential * shear / distance,
            ..BoundaryLayer::absorbing(faces, medium)
        }
    }

    /// Springs only, per area [Pa/m].
    pub fn springs(faces: Vec<Face>, normal: f64, tangential: f64) -> BoundaryLayer {
        BoundaryLayer { faces, spring_normal: normal, spring_tangential: tangential, ..Default::default() }
    }
}

/// Checks constants and faces of the layers.
///
/// # Errors
/// [`ModelError::BoundaryConstant`] or [`ModelError::BoundaryFace`].
pub(crate) fn check(mesh: &Mesh, layers: &[BoundaryLayer]) -> Result<(), ModelError> {
    if layers.is_empty() {
        return Ok(());
    }
    let surface = mesh.boundary_faces();
    for (index, layer) in layers.iter().enumerate() {
        for (name, value) in [
            ("dashpot_normal", layer.dashpot_normal),
            ("dashpot_tangential", layer.dashpot_tangential),
            ("spring_normal", layer.spring_normal),
            ("spring_tangential", layer.spring_tangential),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ModelError::BoundaryConstant { index, name, value });
            }
        }
        let mut seen = std::collections::BTreeSet::new();
        for face in &layer.faces {
            let key = (face.element, face.side);
            let there = surface.binary_search_by_key(&key, |f| (f.element, f.side));
            let fault = match there.map(|i| surface[i] == *face) {
                Ok(true) if seen.insert(key) => continue,
                Ok(true) => "is named twice",
                _ => "is not on the boundary of the mesh",
            };
            let element = mesh.element_ids.get(face.element as usize).copied().unwrap_or(face.element);
            return Err(ModelError::BoundaryFace { index, element, side: face.side + 1, fault });
        }
    }
    Ok(())
}

/// Symmetric 3×3 blocks over node pairs of faces; upper half, ascending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceMatrix {
    pairs: Vec<[u32; 2]>,
    blocks: Vec<[f64; 9]>,
}

impl FaceMatrix {
    /// Consistent spring matrix [N/m].
    pub fn springs(mesh: &Mesh, layers: &[BoundaryLayer]) -> FaceMatrix {
        FaceMatrix::assemble(mesh, layers, |l| [l.spring_normal, l.spring_tangential])
    }

    /// Consistent dashpot matrix [N s/m].
    pub fn dashpots(mesh: &Mesh, layers: &[BoundaryLayer]) -> FaceMatrix {
        FaceMatrix::assemble(mesh, layers, |l| [l.dashpot_normal, l.dashpot_tangential])
    }

    fn assemble(
        mesh: &Mesh,
        layers: &[BoundaryLayer],
        constants: impl Fn(&BoundaryLayer) -> [f64; 2],
    ) -> FaceMatrix {
        let mut sums: BTreeMap<[u32; 2], [f64; 9]> = BTreeMap::new();
        for layer in layers {
            let [normal, tangential] = constants(layer);
            if normal == 0.0 && tangential == 0.0 {
                continue;
            }
            for face in &layer.faces {
                for &(xi, weight) in face.shape.points() {
                    let (n, size) = unit_normal(mesh, face, xi);
                    let shape = face.shape.shape_functions(xi);
                    let mut tensor = [0.0; 9];
                    for i in 0..3 {
                        for j in 0..3 {
                            let same = if i == j { tangential } else { 0.0 };
                            tensor[3 * i + j] = weight * size * (same + (normal - tangential) * n[i] * n[j]);
                        }
                    }
                    for (a, &p) in face.nodes().iter().enumerate() {
                        for (b, &q) in face.nodes().iter().enumerate().filter(|(_, q)| **q >= p) {
                            let sum = sums.entry([p, q]).or_insert([0.0; 9]);
                            for (s, t) in sum.iter_mut().zip(&tensor) {
                                *s += shape[a] * shape[b] * t;
                            }
                        }
                    }
                }
            }
        }
        FaceMatrix { pairs: sums.keys().copied().collect(), blocks: sums.into_values().collect() }
    }

    /// Whether the matrix has no entries.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Node pairs p <= q, ascending, with row-major 3×3 blocks (rows of p).
    pub fn entries(&self) -> impl Iterator<Item = ([u32; 2], &[f64; 9])> {
        self.pairs.iter().copied().zip(&self.blocks)
    }

    #[inline]
    pub(crate) fn block(&self, index: usize) -> &[f64; 9] {
        &self.blocks[index]
    }

    /// `y += A x`. Shapes `[3 * nodes]`.
    pub fn add_times(&self, x: &[f64], y: &mut [f64]) {
        for ([p, q], block) in self.entries() {
            let (p, q) = (3 * p as usize, 3 * q as usize);
            for i in 0..3 {
                for j in 0..3 {
                    y[p + i] += block[3 * i + j] * x[q + j];
                    if p != q {
                        y[q + j] += block[3 * i + j] * x[p + i];
                    }
                }
            }
        }
    }

    /// `x·A x`. Shape `[3 * nodes]`.
    pub fn form(&self, x: &[f64]) -> f64 {
        let mut total = 0.0;
        for ([p, q], block) in self.entries() {
            let factor = if p == q { 1.0 } else { 2.0 };
            let (p, q) = (3 * p as usize, 3 * q as usize);
            for i in 0..3 {
                for j in 0..3 {
                    total += factor * x[p + i] * block[3 * i + j] * x[q + j];
                }
            }
        }
        total
    }
}

/// Direction in which springs constrain a point.
#[derive(Clone, Copy, Debug)]
pub struct SpringPoint {
    /// Node index of the same body.
    pub node: usize,
    /// Point [m].
    pub point: [f64; 3],
    /// Unit vector.
    pub direction: [f64; 3],
}

/// Constrained directions at the integration points of the spring faces.
pub fn spring_points(mesh: &Mesh, layers: &[BoundaryLayer]) -> Vec<SpringPoint> {
    let mut points = Vec::new();
    for layer in layers {
        for face in &layer.faces {
            for &(xi, _) in face.shape.points() {
                let (n, _) = unit_normal(mesh, face, xi);
                let (point, node) = (face.point_and_area(mesh, xi).0, face.nodes[0] as usize);
                if layer.spring_normal > 0.0 {
                    points.push(SpringPoint { node, point, direction: n });
                }
                if layer.spring_tangential > 0.0 {
                    // The axis farthest from the normal defines a tangential pair.
                    let axis = (0..3).fold(0, |k, i| if n[i].abs() < n[k].abs() { i } else { k });
                    let mut e = [0.0; 3];
                    e[axis] = 1.0;
                    let first = cross(n, e);
                    let length = first.iter().map(|v| v * v).sum::<f64>().sqrt();
                    let first = first.map(|v| v / length);
                    points.push(SpringPoint { node, point, direction: first });
                    points.push(SpringPoint { node, point, direction: cross(n, first) });
                }
            }
        }
    }
    points
}

/// Outward unit normal and area per natural area [m²].
fn unit_normal(mesh: &Mesh, face: &Face, xi: [f64; 2]) -> ([f64; 3], f64) {
    let (_, area) = face.point_and_area(mesh, xi);
    let size = area.iter().map(|a| a * a).sum::<f64>().sqrt();
    (area.map(|a| a / size), size)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
#[path = "boundary_tests.rs"]
mod tests;
