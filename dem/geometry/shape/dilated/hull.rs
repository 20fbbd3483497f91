//! Convex hull as faces. Triangles coplanar to 1e-6 of the size are merged.

use super::{CORNERS, Core, DilatedError, Edge, Face};
use crate::base::Vec3;
use crate::shape::polyhedron::hull_triangles;

/// Coplanarity tolerance over body size.
const LEVEL: f64 = 1e-6;

pub(super) fn core(corners: &[Vec3]) -> Result<Core, DilatedError> {
    if !(4..=CORNERS).contains(&corners.len()) {
        return Err(DilatedError::Count(corners.len()));
    }
    if !corners.iter().all(|c| c.iter().all(|x| x.is_finite())) {
        return Err(DilatedError::NotFinite);
    }
    // Local origin avoids cancellation.
    let origin = corners[0];
    let points: Vec<Vec3> = corners.iter().map(|c| c - origin).collect();
    let size = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let slack = LEVEL * size;
    let twin = |k: &usize| points[..*k].iter().any(|p| (p - points[*k]).norm() <= slack);
    if let Some(k) = (1..points.len()).find(twin) {
        return Err(DilatedError::NotConvex(k));
    }
    let triangles = hull_triangles(&points).map_err(|_| DilatedError::Flat)?;
    let mut faces = (merged(&points, &triangles, slack).iter())
        .map(|group| face(&points, group))
        .collect::<Result<Vec<Face>, DilatedError>>()?;
    if faces.len() < 4 {
        return Err(DilatedError::Flat);
    }
    // A point on an edge belongs to two faces, an interior point to at most one.
    let seen = |k: usize| faces.iter().filter(|f| f.corners.contains(&(k as u8))).count() >= 3;
    if let Some(k) = (0..points.len()).find(|&k| !seen(k)) {
        return Err(DilatedError::NotConvex(k));
    }
    for f in &mut faces {
        f.offset += f.normal.dot(&origin);
        f.sides.iter_mut().for_each(|(side, level)| *level += side.dot(&origin));
    }
    let core = joined(corners.to_vec(), faces);
    // Euler's formula fails if corners are too close to an edge.
    if core.corners.len() + core.faces.len() != core.edges.len() + 2 {
        return Err(DilatedError::Sliver);
    }
    Ok(core)
}

/// Groups mutually coplanar neighbours; slivers join the neighbour at their longest side.
fn merged(points: &[Vec3], triangles: &[[u32; 3]], slack: f64) -> Vec<Vec<[u32; 3]>> {
    let at = |corner: u32| points[corner as usize];
    let mut group: Vec<usize> = (0..triangles.len()).collect();
    for (t, &own) in triangles.iter().enumerate() {
        let length = |k: usize| (at(own[(k + 1) % 3]) - at(own[k])).norm();
        let longest = (1..3).fold(0, |most, k| if length(k) > length(most) { k } else { most });
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|m| own[(k + m) % 3]);
            let beyond = |other: &[u32; 3]| {
                let m = (0..3).find(|&m| other[m] == b && other[(m + 1) % 3] == a)?;
                Some(other[(m + 2) % 3])
            };
            let Some((u, d)) = triangles.iter().enumerate().find_map(|(u, other)| Some((u, beyond(other)?)))
            else {
                continue;
            };
            let along = (at(b) - at(a)).normalize();
            let width = |corner: u32| {
                let way = at(corner) - at(a);
                way - along * along.dot(&way)
            };
            let [here, there] = [width(c), width(d)];
            let thin = here.norm() <= slack && k == longest;
            let off = here.cross(&there).norm() / here.norm().min(there.norm()).max(f64::MIN_POSITIVE);
            if thin || (off <= slack && here.dot(&there) < 0.0) {
                let [one, all] = [group[t], group[u]];
                group.iter_mut().filter(|g| **g == one).for_each(|g| *g = all);
            }
        }
    }
    let of = |g: usize| -> Vec<[u32; 3]> {
        triangles.iter().zip(&group).filter(|(_, h)| **h == g).map(|(t, _)| *t).collect()
    };
    (0..triangles.len()).map(of).filter(|triangles| !triangles.is_empty()).collect()
}

pub(super) fn joined(corners: Vec<Vec3>, faces: Vec<Face>) -> Core {
    let reach = corners.iter().map(|c| c.norm()).fold(0.0, f64::max);
    let n = corners.len();
    let (spokes, at) = (vec![Vec::new(); n], vec![([0; 3], [0; 2]); n]);
    let mut core = Core { spokes, at, corners, faces, edges: Vec::new(), reach, rim: None };
    edges(&mut core);
    for (k, e) in core.edges.iter().enumerate() {
        core.spokes[e.ends[0] as usize].push((k as u8, 0));
        core.spokes[e.ends[1] as usize].push((k as u8, 1));
        e.ends.iter().for_each(|end| core.at[*end as usize].0[k / 64] |= 1 << (k % 64));
    }
    for (k, f) in core.faces.iter().enumerate() {
        f.corners.iter().for_each(|c| core.at[*c as usize].1[k / 64] |= 1 << (k % 64));
    }
    core
}

fn face(points: &[Vec3], triangles: &[[u32; 3]]) -> Result<Face, DilatedError> {
    let sides = || triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    let border: Vec<[u32; 2]> = sides().filter(|[a, b]| !sides().any(|side| side == [*b, *a])).collect();
    let mut corners: Vec<u8> = Vec::new();
    let mut at = border.first().ok_or(DilatedError::Sliver)?[0];
    for _ in &border {
        corners.push(at as u8);
        let next: Vec<u32> = border.iter().filter(|side| side[0] == at).map(|side| side[1]).collect();
        let [one] = next[..] else { return Err(DilatedError::Sliver) };
        at = one;
    }
    let mask: u64 = corners.iter().fold(0, |mask, c| mask | 1 << c);
    // The boundary must be one loop through all corners.
    if at != u32::from(corners[0]) || mask.count_ones() as usize != corners.len() {
        return Err(DilatedError::Sliver);
    }
    let middle = corners.iter().map(|&p| points[p as usize]).sum::<Vec3>() / corners.len() as f64;
    // Newell's normal uses all corners.
    let at = |k: usize| points[corners[k % corners.len()] as usize] - middle;
    let normal = (0..corners.len()).map(|k| at(k).cross(&at(k + 1))).sum::<Vec3>().normalize();
    let offset = (0..corners.len()).map(|k| normal.dot(&(at(k) + middle))).fold(f64::NEG_INFINITY, f64::max);
    let side = |k: usize| {
        let side = (at(k + 1) - at(k)).cross(&normal).normalize();
        (side, side.dot(&(at(k) + middle)))
    };
    let sides = (0..corners.len()).map(side).collect();
    Ok(Face { normal, offset, corners, sides })
}

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
