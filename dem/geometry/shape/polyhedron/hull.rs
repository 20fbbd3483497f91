//! Convex hull.
//!
//! Incremental: each outside point replaces its visible faces by a fan from their boundary (M. de Berg et
//! al., Computational Geometry, 3rd ed., sec. 11.2). Points within 1e-10 of the size from a face plane do not
//! see that face.

use super::surface::Surface;
use nalgebra::Vector3;
use std::collections::HashSet;

/// Relative coplanarity tolerance.
const FLAT: f64 = 1e-10;

/// Degenerate point set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HullError {
    /// Fewer than four non-coplanar points.
    #[error("the {0} points lie in one plane, or are too few: they span no volume")]
    Flat(usize),
    /// Non-finite coordinate.
    #[error("point {0} has a coordinate that is not a finite number")]
    NotFinite(usize),
}

/// Convex hull of points [m] as outward-oriented triangles.
///
/// # Errors
/// [`HullError`] if points are coplanar or not finite.
pub fn convex_hull(points: &[[f64; 3]]) -> Result<Surface, HullError> {
    let x: Vec<Vector3<f64>> = points.iter().map(|p| Vector3::from(*p)).collect();
    let surface = Surface { vertices: points.to_vec(), triangles: triangles(&x)? };
    Ok(surface.without_loose_vertices())
}

/// Outward-oriented hull triangles on point indices.
///
/// # Errors
/// [`HullError`] if points are coplanar or not finite.
pub fn triangles(x: &[Vector3<f64>]) -> Result<Vec<[u32; 3]>, HullError> {
    if let Some(bad) = x.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(HullError::NotFinite(bad));
    }
    let (first, size) = first_tetrahedron(x).ok_or(HullError::Flat(x.len()))?;
    let slack = FLAT * size;
    let mut faces: Vec<([u32; 3], Vector3<f64>)> = Vec::new();
    let face = |[a, b, c]: [u32; 3]| {
        let [p, q, r] = [a, b, c].map(|i| x[i as usize]);
        let normal = (q - p).cross(&(r - p)).try_normalize(0.0).unwrap_or_default();
        ([a, b, c], normal)
    };
    let [a, b, c, d] = first;
    for corners in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
        faces.push(face(corners));
    }
    for i in 0..x.len() as u32 {
        if first.contains(&i) {
            continue;
        }
        let sees = |f: &([u32; 3], Vector3<f64>)| f.1.dot(&(x[i as usize] - x[f.0[0] as usize])) > slack;
        let seen: Vec<bool> = faces.iter().map(sees).collect();
        if !seen.contains(&true) {
            continue;
        }
        let edges = |f: &[u32; 3]| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])];
        let gone: HashSet<(u32, u32)> =
            faces.iter().zip(&seen).filter(|(_, s)| **s).flat_map(|(f, _)| edges(&f.0)).collect();
        let border: Vec<(u32, u32)> = faces
            .iter()
            .zip(&seen)
            .filter(|(_, s)| **s)
            .flat_map(|(f, _)| edges(&f.0))
            .filter(|(from, to)| !gone.contains(&(*to, *from)))
            .collect();
        let mut keep = seen.iter().map(|s| !s);
        faces.retain(|_| keep.next().unwrap_or(true));
        faces.extend(border.iter().map(|(from, to)| face([*from, *to, i])));
    }
    Ok(faces.iter().map(|f| f.0).collect())
}

/// Four distant points, the first three facing away from the fourth, and the extent.
fn first_tetrahedron(x: &[Vector3<f64>]) -> Option<([u32; 4], f64)> {
    let farthest = |measure: &dyn Fn(&Vector3<f64>) -> f64| {
        (0..x.len()).fold(None, |best: Option<(usize, f64)>, i| {
            let m = measure(&x[i]);
            if best.is_none_or(|(_, b)| m > b) { Some((i, m)) } else { best }
        })
    };
    let (a, _) = farthest(&|p| -p.x)?;
    let (b, size) = farthest(&|p| (p - x[a]).norm())?;
    let along = (x[b] - x[a]).try_normalize(0.0)?;
    let (c, width) = farthest(&|p| along.cross(&(p - x[a])).norm())?;
    let normal = (x[b] - x[a]).cross(&(x[c] - x[a])).try_normalize(0.0)?;
    let (d, height) = farthest(&|p| normal.dot(&(p - x[a])).abs())?;
    if width <= FLAT * size || height <= FLAT * size {
        return None;
    }
    let (b, c) = if normal.dot(&(x[d] - x[a])) > 0.0 { (c, b) } else { (b, c) };
    Some(([a, b, c, d].map(|i| i as u32), size))
}
