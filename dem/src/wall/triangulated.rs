//! Triangle patches.
//!
//! Coplanar triangles share one plane bitwise: from seeds in descending area, neighbours with vertices in the
//! seed's plane (to rounding) adopt its normal. Forces are then continuous over seams.

use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::lanes::{self, Real, V3};
use crate::shape::triangle::{self, Region};
use crate::spatial::bvh::Aabb;

/// Relative tolerance of lower bounds.
pub(super) const SLACK: f64 = 1e-9;
/// Smallest valid height over longest side.
const FLATTEST: f64 = 1e-9;
/// Rounding tolerance over the largest coordinate.
const COPLANAR: f64 = 1e-12;

/// Triangle in its wall's frame. Interior contact data comes first, in two cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Triangle {
    plane: [f64; 4],
    /// Outward in-plane normal and level by edge.
    rims: [[f64; 4]; 3],
    pub corners: [Vec3; 3],
    /// Unique within the surface.
    pub edges: [u32; 3],
    pub vertices: [u32; 3],
}

pub(crate) type Level<R> = [R; 4];

#[inline(always)]
fn height<R: Real>(plane: &Level<R>, x: V3<R>) -> R {
    plane[0] * x.x + plane[1] * x.y + plane[2] * x.z - plane[3]
}

/// Lower bound of the distance to `x`.
#[inline(always)]
pub(crate) fn clearance<R: Real>(plane: &Level<R>, rims: &[Level<R>; 3], x: V3<R>) -> R {
    let up = height(plane, x);
    let [a, b, c] = rims;
    let out = R::zero().max(height(a, x)).max(height(b, x)).max(height(c, x));
    (up * up + out * out).sqrt() * R::splat(1.0 - SLACK)
}

#[inline(always)]
pub(crate) fn inside<R: Real>([a, b, c]: &[Level<R>; 3], x: V3<R>) -> R::Mask {
    let below = R::zero();
    height(a, x).le(below) & height(b, x).le(below) & height(c, x).le(below)
}

#[inline(always)]
pub(crate) fn foot<R: Real>(plane: &Level<R>, x: V3<R>) -> V3<R> {
    x - V3::new(plane[0], plane[1], plane[2]) * height(plane, x)
}

#[inline(always)]
pub(crate) fn on_edge<R: Real>(a: V3<R>, b: V3<R>, x: V3<R>) -> V3<R> {
    let (along, zero, one) = (b - a, R::zero(), R::splat(1.0));
    let share = (x - a).dot(along) / along.norm2();
    let share = R::select(share.lt(zero), zero, R::select(share.gt(one), one, share));
    a + along * share
}

impl Triangle {
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        Vec3::new(self.plane[0], self.plane[1], self.plane[2])
    }

    /// Equal for coplanar neighbours.
    pub fn plane_bits(&self) -> [u64; 4] {
        self.plane.map(f64::to_bits)
    }

    /// Plane, edge planes, corners.
    pub fn numbers(&self) -> [f64; 25] {
        let corners = self.corners.iter().flat_map(|c| c.iter());
        let all = self.plane.iter().chain(self.rims.as_flattened()).chain(corners);
        let mut out = [0.0; 25];
        out.iter_mut().zip(all).for_each(|(to, x)| *to = *x);
        out
    }

    #[inline(always)]
    pub fn fetch(&self) {
        lanes::prefetch(std::slice::from_ref(&self.plane));
        lanes::prefetch(&self.rims[2..]);
    }

    /// Lower bound of the distance.
    #[inline(always)]
    pub fn clearance(&self, x: &Vec3) -> f64 {
        clearance(&self.plane, &self.rims, V3::from_vec(x))
    }

    #[inline(always)]
    pub fn foot(&self, x: &Vec3) -> Option<Vec3> {
        let x = V3::from_vec(x);
        inside(&self.rims, x).then(|| foot(&self.plane, x).to_vec())
    }

    #[inline(always)]
    pub fn closest(&self, x: &Vec3) -> (Vec3, Region) {
        match self.foot(x) {
            Some(foot) => (foot, Region::Face),
            None => self.beside(x),
        }
    }

    /// Closest point if not known to be inside.
    #[inline(never)]
    fn beside(&self, x: &Vec3) -> (Vec3, Region) {
        let [a, b, c] = &self.corners;
        let region = triangle::region_of(a, b, c, x);
        let of = V3::from_vec;
        let point = match region {
            Region::Face => foot(&self.plane, of(x)).to_vec(),
            Region::Vertex(k) => self.corners[k],
            // From the lower vertex: bitwise identical for both triangles.
            Region::Edge(k) => {
                let (first, second) = (k, (k + 1) % 3);
                let (first, second) = if self.vertices[first] < self.vertices[second] {
                    (first, second)
                } else {
                    (second, first)
                };
                on_edge(of(&self.corners[first]), of(&self.corners[second]), of(x)).to_vec()
            }
        };
        (point, region)
    }

    pub fn bounds(&self) -> Aabb {
        let [a, b, c] = &self.corners;
        (a.inf(b).inf(c).into(), a.sup(b).sup(c).into())
    }
}

fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// For each vertex the lowest coincident one.
pub(crate) fn welded(vertices: &[Vec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    // Adding zero merges −0 and 0.
    let key = |v: u32| vertices[v as usize].map(|x| x + 0.0);
    let compare = |a: &u32, b: &u32| {
        let (p, q) = (key(*a), key(*b));
        (0..3).map(|d| p[d].total_cmp(&q[d])).find(|o| o.is_ne()).unwrap_or(a.cmp(b))
    };
    order.sort_unstable_by(compare);
    let mut same = vec![0; vertices.len()];
    let mut lowest = 0;
    for (k, &v) in order.iter().enumerate() {
        if k == 0 || key(order[k - 1]) != key(v) {
            lowest = v;
        }
        same[v as usize] = lowest;
    }
    same
}

/// `name` prefixes messages.
///
/// # Errors
/// Vertex out of range or not finite, zero area.
pub(crate) fn triangles(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    name: &str,
) -> Result<Vec<Triangle>, ModelError> {
    let mut normals = Vec::with_capacity(triangles.len());
    for (t, triangle) in triangles.iter().enumerate() {
        let error = |problem| ModelError::Wall { wall: format!("triangle {t} of {name}"), problem };
        if triangle.iter().any(|&v| v as usize >= vertices.len()) {
            return Err(error("it names a vertex that does not exist"));
        }
        let [a, b, c] = triangle.map(|v| vertices[v as usize]);
        let area = (b - a).cross(&(c - a));
        let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        if !longest2.is_finite() {
            return Err(error("it has a vertex that is not finite"));
        }
        if area.norm() <= FLATTEST * longest2 {
            return Err(error("it has no area"));
        }
        normals.push(area);
    }
    let same = welded(vertices);
    let planes = planes(vertices, triangles, &same, &normals);
    let mut keys: Vec<[u32; 2]> = triangles.iter().flat_map(sides).collect();
    keys.sort_unstable();
    keys.dedup();
    let number = |key: [u32; 2]| keys.partition_point(|k| *k < key) as u32;
    Ok(triangles
        .iter()
        .zip(planes)
        .map(|(t, plane)| {
            let corners = t.map(|v| vertices[v as usize]);
            let normal = Vec3::new(plane[0], plane[1], plane[2]);
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let rims = [0, 1, 2].map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let out = (b - a).cross(&normal).normalize();
                let out = if out.dot(&(middle - a)) > 0.0 { -out } else { out };
                [out.x, out.y, out.z, out.dot(&a)]
            });
            Triangle { plane, rims, corners, edges: sides(t).map(number), vertices: *t }
        })
        .collect())
}

/// Bitwise equal for coplanar neighbours.
fn planes(vertices: &[Vec3], triangles: &[[u32; 3]], same: &[u32], normals: &[Vec3]) -> Vec<[f64; 4]> {
    let welded: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| same[v as usize])).collect();
    let mut edges: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (t, triangle) in welded.iter().enumerate() {
        edges.extend(sides(triangle).map(|side| (side, t as u32)));
    }
    edges.sort_unstable();
    let size = triangles.iter().flatten().map(|&v| vertices[v as usize].amax()).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&a, &b| normals[b].norm_squared().total_cmp(&normals[a].norm_squared()).then(a.cmp(&b)));
    let mut planes: Vec<Option<[f64; 4]>> = vec![None; triangles.len()];
    let mut open = Vec::new();
    for seed in order {
        if planes[seed].is_some() {
            continue;
        }
        let n = normals[seed].normalize();
        let corners = triangles[seed].map(|v| vertices[v as usize]);
        let level = (corners[0] + corners[1] + corners[2]).dot(&n) / 3.0;
        let plane = [n.x, n.y, n.z, level];
        planes[seed] = Some(plane);
        open.push(seed);
        while let Some(t) = open.pop() {
            for side in sides(&welded[t]) {
                let from = edges.partition_point(|e| e.0 < side);
                for &(_, next) in edges[from..].iter().take_while(|e| e.0 == side) {
                    let next = next as usize;
                    let flat =
                        |v: u32| height(&plane, V3::from_vec(&vertices[v as usize])).abs() <= COPLANAR * size;
                    if planes[next].is_none() && triangles[next].iter().all(|&v| flat(v)) {
                        planes[next] = Some(plane);
                        open.push(next);
                    }
                }
            }
        }
    }
    planes.into_iter().map(|p| p.unwrap_or([0.0, 0.0, 1.0, 0.0])).collect()
}

#[cfg(test)]
#[path = "triangulated_tests.rs"]
mod tests;
