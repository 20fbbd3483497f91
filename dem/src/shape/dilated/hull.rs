//! The convex hull of few points. Every plane through three of them with none beyond it holds a face; what lies in one plane to
//! rounding is one face, so that no two faces of a core are level with each other.

use super::{CORNERS, Core, DilatedError, Edge, Face};
use crate::base::Vec3;

/// What counts as in a plane, over the size of the body.
const LEVEL: f64 = 1e-6;

/// See [`Core::new`].
pub(super) fn core(corners: &[Vec3]) -> Result<Core, DilatedError> {
    if !(4..=CORNERS).contains(&corners.len()) {
        return Err(DilatedError::Count(corners.len()));
    }
    if !corners.iter().all(|c| c.iter().all(|x| x.is_finite())) {
        return Err(DilatedError::NotFinite);
    }
    // About a corner, so that a body far from the origin loses nothing.
    let origin = corners[0];
    let points: Vec<Vec3> = corners.iter().map(|c| c - origin).collect();
    let size = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let slack = LEVEL * size;
    let twin = |k: &usize| points[..*k].iter().any(|p| (p - points[*k]).norm() <= slack);
    if let Some(k) = (1..points.len()).find(twin) {
        return Err(DilatedError::NotConvex(k));
    }
    let mut faces: Vec<Face> = Vec::new();
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            for k in j + 1..points.len() {
                // A face that is known already.
                let known = |f: &Face| [i, j, k].iter().all(|c| f.corners.contains(&(*c as u8)));
                if faces.iter().any(known) {
                    continue;
                }
                faces.extend(face(&points, [i, j, k], slack));
            }
        }
    }
    // A point on an edge belongs to two faces.
    let seen = |k: usize| faces.iter().filter(|f| f.corners.contains(&(k as u8))).count() >= 3;
    if faces.len() < 4 {
        return Err(DilatedError::Flat);
    }
    if let Some(k) = (0..points.len()).find(|&k| !seen(k)) {
        return Err(DilatedError::NotConvex(k));
    }
    for f in &mut faces {
        f.offset += f.normal.dot(&origin);
        f.sides.iter_mut().for_each(|(side, level)| *level += side.dot(&origin));
    }
    let core = joined(corners.to_vec(), faces);
    // Euler's formula: without it corners lie so close to an edge that faces do not fit together.
    if core.corners.len() + core.faces.len() != core.edges.len() + 2 {
        return Err(DilatedError::Sliver);
    }
    Ok(core)
}

/// A core of these corners and faces, with the edges that faces have in common.
pub(super) fn joined(corners: Vec<Vec3>, faces: Vec<Face>) -> Core {
    let reach = corners.iter().map(|c| c.norm()).fold(0.0, f64::max);
    let mut core = Core { spokes: vec![Vec::new(); corners.len()], corners, faces, edges: Vec::new(), reach };
    edges(&mut core);
    for (k, e) in core.edges.iter().enumerate() {
        core.spokes[e.ends[0] as usize].push((k as u8, 0));
        core.spokes[e.ends[1] as usize].push((k as u8, 1));
    }
    core
}

/// The face through three points, if no point is beyond its plane.
fn face(points: &[Vec3], [i, j, k]: [usize; 3], slack: f64) -> Option<Face> {
    let (u, v) = (points[j] - points[i], points[k] - points[i]);
    let cross = u.cross(&v);
    if cross.norm() <= 1e-9 * u.norm() * v.norm() {
        return None;
    }
    let mut normal = cross.normalize();
    let heights = |normal: &Vec3| -> [f64; 2] {
        let h = points.iter().map(|p| normal.dot(&(p - points[i])));
        h.fold([0.0, 0.0], |[low, high], h| [low.min(h), high.max(h)])
    };
    let [low, high] = heights(&normal);
    if high > slack {
        if low < -slack {
            return None;
        }
        normal = -normal;
    } else if low >= -slack {
        return None;
    }
    let level: Vec<usize> =
        (0..points.len()).filter(|&p| normal.dot(&(points[p] - points[i])).abs() <= slack).collect();
    let middle = level.iter().map(|&p| points[p]).sum::<Vec3>() / level.len() as f64;
    let x = (points[level[0]] - middle).normalize();
    let y = normal.cross(&x);
    let mut corners: Vec<(f64, usize)> = (level.iter())
        .map(|&p| (libm::atan2((points[p] - middle).dot(&y), (points[p] - middle).dot(&x)), p))
        .collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Points within the face are no corners of it; those on its sides may be corners of others.
    let at = |k: usize| points[corners[k % corners.len()].1];
    let n = corners.len();
    let bends = |k: usize| {
        let (a, b, c) = (at(k + n - 1), at(k), at(k + 1));
        (b - a).cross(&(c - b)).dot(&normal) > -slack * (c - a).norm()
    };
    let corners: Vec<u8> = (0..n).filter(|&k| bends(k)).map(|k| corners[k].1 as u8).collect();
    // Newell's normal is that of all corners rather than of three.
    let at = |k: usize| points[corners[k % corners.len()] as usize] - middle;
    let normal = (0..corners.len()).map(|k| at(k).cross(&at(k + 1))).sum::<Vec3>().normalize();
    let offset = (0..corners.len()).map(|k| normal.dot(&(at(k) + middle))).fold(f64::NEG_INFINITY, f64::max);
    let side = |k: usize| {
        let side = (at(k + 1) - at(k)).cross(&normal).normalize();
        (side, side.dot(&(at(k) + middle)))
    };
    let sides = (0..corners.len()).map(side).collect();
    let mask = corners.iter().fold(0, |mask, c| mask | 1 << c);
    (corners.len() >= 3).then_some(Face { normal, offset, corners, mask, sides })
}

/// Finds the edges: each belongs to two faces.
fn edges(core: &mut Core) {
    for (f, face) in core.faces.iter().enumerate() {
        for k in 0..face.corners.len() {
            let ends = [face.corners[k], face.corners[(k + 1) % face.corners.len()]];
            if ends[0] > ends[1] {
                continue;
            }
            let back = |g: &Face| {
                let n = g.corners.len();
                (0..n).find(|&m| g.corners[m] == ends[1] && g.corners[(m + 1) % n] == ends[0])
            };
            let Some((g, m)) = core.faces.iter().enumerate().find_map(|(g, face)| Some((g, back(face)?)))
            else {
                continue;
            };
            let way = core.corners[ends[1] as usize] - core.corners[ends[0] as usize];
            let length = way.norm();
            let direction = way / length;
            core.edges.push(Edge {
                ends,
                direction,
                levels: ends.map(|e| direction.dot(&core.corners[e as usize])),
                length,
                faces: [f as u8, g as u8],
                sides: [face.sides[k], core.faces[g].sides[m]],
            });
        }
    }
}
