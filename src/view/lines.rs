//! Force chains and walls for the page.

use std::path::Path;

use super::chunk::{Chunk, Coding};
use crate::failure::Failure;
use crate::read::ReadError;
use crate::read::vtk_arrays::Arrays;
use crate::write::WallKind;

/// Places relative to `origin`.
pub fn relative(places: &[f64], origin: [f64; 3]) -> Vec<f64> {
    places.iter().enumerate().map(|(k, x)| x - origin[k % 3]).collect()
}

/// The block of a frame of force chains: both ends of each, forces, kinds.
///
/// # Errors
/// The file is not one of chains.
pub fn chains(file: &Path, origin: [f64; 3], coding: Coding) -> Result<Vec<u8>, Failure> {
    let arrays = Arrays::open(file, "PolyData")?;
    let points = arrays.values("Points", "Points")?;
    let ends = arrays.indices("Lines", "connectivity")?;
    if ends.iter().any(|e| *e as usize >= arrays.points) || !ends.len().is_multiple_of(2) {
        let found = format!("{} ends in {} points", ends.len(), arrays.points);
        return Err(ReadError::whole(file, "Lines", found, "two points of the file for each").into());
    }
    let places: Vec<f64> =
        ends.iter().flat_map(|e| &points[3 * *e as usize..3 * *e as usize + 3]).copied().collect();
    let mut chunk = Chunk::new(coding);
    // Six numbers a line would have the same limits as three.
    chunk.numbers("ends", &relative(&places, origin), 3);
    for name in ["normal_force", "tangential_force", "magnitude"] {
        if arrays.components("CellData", name) == Some(1) {
            chunk.numbers(name, &arrays.values("CellData", name)?, 1);
        }
    }
    for name in ["kind", "strong"] {
        if arrays.components("CellData", name) == Some(1) {
            let values: Vec<u8> = arrays.values("CellData", name)?.iter().map(|v| *v as u8).collect();
            chunk.small(name, &values);
        }
    }
    Ok(chunk.finish())
}

/// The block of a frame of walls: points, triangles and edges by their points, and for each triangle its wall and kind.
///
/// # Errors
/// The file is not one of walls.
pub fn walls(file: &Path, origin: [f64; 3], coding: Coding) -> Result<Vec<u8>, Failure> {
    let arrays = Arrays::open(file, "PolyData")?;
    let points = arrays.values("Points", "Points")?;
    let corners = arrays.indices("Polys", "connectivity")?;
    let ends = arrays.indices("Polys", "offsets")?;
    let of_polygons = |name: &str| match arrays.components("CellData", name) {
        Some(1) => Ok(Some(arrays.indices("CellData", name)?)),
        _ => Ok::<_, ReadError>(None),
    };
    let ids = of_polygons("id")?.unwrap_or_else(|| vec![0; ends.len()]);
    let kinds = of_polygons("kind")?.unwrap_or_else(|| kinds(&ids, &ends));
    let sorted = ends.is_sorted() && ends.last().is_none_or(|last| *last as usize <= corners.len());
    if !sorted || corners.iter().any(|c| *c as usize >= arrays.points) || ids.len() != ends.len() {
        let found = format!("{} corners of {} polygons", corners.len(), ends.len());
        return Err(ReadError::whole(file, "Polys", found, "points of the file for each").into());
    }
    let (mut triangles, mut edges, mut id, mut kind) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut begin = 0;
    for (p, end) in ends.iter().enumerate() {
        let polygon = &corners[begin as usize..*end as usize];
        for k in 1..polygon.len().saturating_sub(1) {
            triangles.extend([polygon[0], polygon[k], polygon[k + 1]]);
            id.push(ids[p]);
            kind.push(kinds.get(p).map_or(1, |k| *k as u8));
        }
        for k in 0..polygon.len() {
            edges.extend([polygon[k], polygon[(k + 1) % polygon.len()]]);
        }
        begin = *end;
    }
    let mut chunk = Chunk::new(coding);
    chunk.places("points", &relative(&points, origin), 3);
    chunk.indices("triangles", &triangles, 3);
    chunk.indices("edges", &edges, 2);
    chunk.indices("id", &id, 1);
    chunk.small("kind", &kind);
    Ok(chunk.finish())
}

/// What walls are in files that do not say so: one square is a plane, six are a box.
fn kinds(ids: &[u32], ends: &[u32]) -> Vec<u32> {
    let squares = |id: u32| {
        let corners = (0..ends.len().min(ids.len())).filter(|p| ids[*p] == id);
        let corners = corners.map(|p| ends[p] - if p == 0 { 0 } else { ends[p - 1].min(ends[p]) });
        let (mut count, mut all) = (0, true);
        corners.for_each(|c| (count, all) = (count + 1, all && c == 4));
        if all { count } else { 0 }
    };
    let mut known = std::collections::HashMap::new();
    let kind = |id: &u32| {
        *known.entry(*id).or_insert_with(|| match squares(*id) {
            1 => WallKind::Plane,
            6 => WallKind::Box,
            _ => WallKind::Wall,
        } as u32)
    };
    ids.iter().map(kind).collect()
}
