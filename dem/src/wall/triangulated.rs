//! Triangles as patches.
//!
//! Triangles that lie in one plane share its bits: seed by seed in falling order of area, neighbours across edges whose
//! vertices are in the seed's plane to rounding take over the seed's normal. So a floor of many triangles, slivers
//! among them, has the same height and the same normal everywhere, and a sphere that crosses its seams feels no change.
//!
//! Each triangle keeps its plane and its three edges as half planes, from which a lower bound of the distance costs a
//! few products: most patches of a near list are distinguished from those in touch by it.

use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::lanes::{self, Real, V3};
use crate::shape::triangle::{self, Region};
use crate::spatial::bvh::Aabb;

/// Relative slack of lower bounds.
pub(super) const SLACK: f64 = 1e-9;
/// Smallest height over longest side that a triangle may have: below it its normal has no meaning.
const FLATTEST: f64 = 1e-9;
/// Distance from a plane, over the largest coordinate of the surface, that counts as rounding.
const COPLANAR: f64 = 1e-12;

/// A triangle in the frame of its wall. What a contact inside it needs comes first, in two lines of the cache.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Triangle {
    /// Unit normal and level of its plane.
    plane: [f64; 4],
    /// Outward normal and level of each edge, within the plane.
    rims: [[f64; 4]; 3],
    pub corners: [Vec3; 3],
    /// Numbers of edges and vertices, unique within the surface.
    pub edges: [u32; 3],
    pub vertices: [u32; 3],
}

/// Unit normal and level of a plane.
pub(crate) type Level<R> = [R; 4];

#[inline(always)]
fn height<R: Real>(plane: &Level<R>, x: V3<R>) -> R {
    plane[0] * x.x + plane[1] * x.y + plane[2] * x.z - plane[3]
}

/// A lower bound of the distance from a triangle to `x`: from its height above the plane and outside the edges.
#[inline(always)]
pub(crate) fn clearance<R: Real>(plane: &Level<R>, rims: &[Level<R>; 3], x: V3<R>) -> R {
    let up = height(plane, x);
    let [a, b, c] = rims;
    let out = R::zero().max(height(a, x)).max(height(b, x)).max(height(c, x));
    (up * up + out * out).sqrt() * R::splat(1.0 - SLACK)
}

/// Whether the edges tell that `x` stands above the inside.
#[inline(always)]
pub(crate) fn inside<R: Real>([a, b, c]: &[Level<R>; 3], x: V3<R>) -> R::Mask {
    let below = R::zero();
    height(a, x).le(below) & height(b, x).le(below) & height(c, x).le(below)
}

/// Where `x` stands on a plane.
#[inline(always)]
pub(crate) fn foot<R: Real>(plane: &Level<R>, x: V3<R>) -> V3<R> {
    x - V3::new(plane[0], plane[1], plane[2]) * height(plane, x)
}

/// The point of the edge from `a` to `b` that is closest to `x`.
#[inline(always)]
pub(crate) fn on_edge<R: Real>(a: V3<R>, b: V3<R>, x: V3<R>) -> V3<R> {
    let (along, zero, one) = (b - a, R::zero(), R::splat(1.0));
    let share = (x - a).dot(along) / along.norm2();
    let share = R::select(share.lt(zero), zero, R::select(share.gt(one), one, share));
    a + along * share
}

impl Triangle {
    /// Unit normal of its plane.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        Vec3::new(self.plane[0], self.plane[1], self.plane[2])
    }

    /// Its plane, to compare: neighbours that lie in one plane to rounding have the same bits.
    pub fn plane_bits(&self) -> [u64; 4] {
        self.plane.map(f64::to_bits)
    }

    /// Plane, planes of the edges, corners.
    pub fn numbers(&self) -> [f64; 25] {
        let corners = self.corners.iter().flat_map(|c| c.iter());
        let all = self.plane.iter().chain(self.rims.as_flattened()).chain(corners);
        let mut out = [0.0; 25];
        out.iter_mut().zip(all).for_each(|(to, x)| *to = *x);
        out
    }

    /// Has the processor fetch the lines that a contact inside it needs.
    #[inline(always)]
    pub fn fetch(&self) {
        lanes::prefetch(std::slice::from_ref(&self.plane));
        lanes::prefetch(&self.rims[2..]);
    }

    /// A lower bound of the distance to `x`: from its height above the plane and outside the edges.
    #[inline(always)]
    pub fn clearance(&self, x: &Vec3) -> f64 {
        clearance(&self.plane, &self.rims, V3::from_vec(x))
    }

    /// Where `x` stands above the inside, if the edges tell that it does.
    #[inline(always)]
    pub fn foot(&self, x: &Vec3) -> Option<Vec3> {
        let x = V3::from_vec(x);
        inside(&self.rims, x).then(|| foot(&self.plane, x).to_vec())
    }

    /// Closest point, and where on the triangle it lies.
    #[inline(always)]
    pub fn closest(&self, x: &Vec3) -> (Vec3, Region) {
        match self.foot(x) {
            Some(foot) => (foot, Region::Face),
            None => self.beside(x),
        }
    }

    /// The closest point where the edges do not state that it is inside.
    #[inline(never)]
    fn beside(&self, x: &Vec3) -> (Vec3, Region) {
        let [a, b, c] = &self.corners;
        let region = triangle::region_of(a, b, c, x);
        let of = V3::from_vec;
        let point = match region {
            Region::Face => foot(&self.plane, of(x)).to_vec(),
            Region::Vertex(k) => self.corners[k],
            // From the lower vertex, so that both triangles of an edge find the same bits.
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

    /// Bounds.
    pub fn bounds(&self) -> Aabb {
        let [a, b, c] = &self.corners;
        (a.inf(b).inf(c).into(), a.sup(b).sup(c).into())
    }
}

/// The three sides of a triangle as sorted vertex pairs.
fn sides(t: &[u32; 3]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// For each vertex the lowest one at the same place.
pub(crate) fn welded(vertices: &[Vec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    // Adding zero makes −0 and 0 the same.
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

/// The patches of a surface; `name` goes before messages.
///
/// # Errors
/// A triangle that names a vertex which does not exist, has a vertex that is not finite, or no area.
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

/// Plane of each triangle, the same bits for neighbours that lie in one plane to rounding.
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
