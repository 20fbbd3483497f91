//! Solid inside a closed surface (e.g. Tonon, J. Math. Stat. 1, 2005). Files need not order vertices:
//! triangles are first oriented consistently.

use super::triangulated::welded;
use crate::base::Vec3;
use nalgebra::Matrix3;

pub(super) struct Enclosed {
    /// Volume [m³], centre [m], inertia per unit density [m⁵].
    pub volume: f64,
    pub centre: Vec3,
    pub inertia: Matrix3<f64>,
    /// Outward triangles of welded vertices, reordered.
    pub faces: Vec<[u32; 3]>,
}

/// `None` if an edge does not join exactly two triangles, or for zero volume.
pub(super) fn enclosed(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Option<Enclosed> {
    let same = welded(vertices);
    let welded: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| same[v as usize])).collect();
    let along = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let mut edges: Vec<([u32; 2], usize)> =
        welded.iter().enumerate().flat_map(|(k, t)| along(t).map(|e| (sorted(e), k))).collect();
    edges.sort_unstable();
    if !edges.chunk_by(|a, b| a.0 == b.0).all(|same| same.len() == 2) {
        return None;
    }
    let mut faces: Vec<Option<[u32; 3]>> = vec![None; welded.len()];
    let (mut open, mut outwards) = (Vec::new(), Vec::with_capacity(welded.len()));
    let (mut volume, mut first, mut second) = (0.0, Vec3::zeros(), Matrix3::zeros());
    let origin = *vertices.get(*welded.first()?.first()? as usize)?;
    for seed in 0..welded.len() {
        if faces[seed].is_some() {
            continue;
        }
        faces[seed] = Some(welded[seed]);
        open.push(seed);
        let (mut v, mut f, mut s) = (0.0, Vec3::zeros(), Matrix3::zeros());
        let first_face = outwards.len();
        while let Some(k) = open.pop() {
            let face = faces[k].unwrap_or(welded[k]);
            outwards.push(face);
            let [a, b, c] = face.map(|v| vertices[v as usize] - origin);
            let six = a.dot(&b.cross(&c));
            let sum = a + b + c;
            v += six / 6.0;
            f += sum * (six / 24.0);
            s += (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose())
                * (six / 120.0);
            for edge in along(&face) {
                let at = edges.partition_point(|e| e.0 < sorted(edge));
                let other = if edges[at].1 == k { edges[at + 1].1 } else { edges[at].1 };
                if faces[other].is_none() {
                    let t = welded[other];
                    let same_way = along(&t).contains(&edge);
                    faces[other] = Some(if same_way { [t[0], t[2], t[1]] } else { t });
                    open.push(other);
                }
            }
        }
        let sign = if v < 0.0 { -1.0 } else { 1.0 };
        if v < 0.0 {
            outwards[first_face..].iter_mut().for_each(|t| t.swap(1, 2));
        }
        volume += sign * v;
        first += f * sign;
        second += s * sign;
    }
    if volume <= 0.0 || !volume.is_finite() {
        return None;
    }
    let centre = first / volume;
    let about = second - centre * centre.transpose() * volume;
    let inertia = Matrix3::identity() * about.trace() - about;
    Some(Enclosed { volume, centre: centre + origin, inertia, faces: outwards })
}

#[cfg(test)]
#[path = "enclosed_tests.rs"]
mod tests;
