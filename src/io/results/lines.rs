//! Force chains and walls of a frame.

use std::path::Path;

use crate::failure::Failure;
use crate::read::ReadError;
use crate::read::vtk_arrays::Arrays;
use crate::write::{STONE_BODY, STONE_CENTRE, WallKind};

/// Lines between contact partners.
pub struct Chains {
    /// Both ends, six coordinates each [m].
    pub ends: Vec<f64>,
    /// Available of `normal_force`, `tangential_force`, `magnitude` [N].
    pub forces: Vec<(&'static str, Vec<f64>)>,
    /// Available of `kind` and `strong`.
    pub marks: Vec<(&'static str, Vec<u8>)>,
}

impl Chains {
    /// Reads a file.
    ///
    /// # Errors
    /// Not a chain file.
    pub fn open(file: &Path) -> Result<Chains, Failure> {
        let arrays = Arrays::open(file, "PolyData")?;
        let points = arrays.values("Points", "Points")?;
        let ends = arrays.indices("Lines", "connectivity")?;
        if ends.iter().any(|e| *e as usize >= arrays.points) || !ends.len().is_multiple_of(2) {
            let found = format!("{} ends in {} points", ends.len(), arrays.points);
            return Err(ReadError::whole(file, "Lines", found, "two points of the file for each").into());
        }
        let ends: Vec<f64> =
            ends.iter().flat_map(|e| &points[3 * *e as usize..3 * *e as usize + 3]).copied().collect();
        let (mut forces, mut marks) = (Vec::new(), Vec::new());
        for name in ["normal_force", "tangential_force", "magnitude"] {
            if arrays.components("CellData", name) == Some(1) {
                forces.push((name, arrays.values("CellData", name)?));
            }
        }
        for name in ["kind", "strong"] {
            if arrays.components("CellData", name) == Some(1) {
                marks.push((name, arrays.values("CellData", name)?.iter().map(|v| *v as u8).collect()));
            }
        }
        Ok(Chains { ends, forces, marks })
    }
}

/// Walls: planes, surfaces, sleepers, rails.
pub struct Walls {
    /// Points, three coordinates each [m].
    pub points: Vec<f64>,
    /// Point indices of triangles.
    pub triangles: Vec<u32>,
    /// Point indices of polygon edges.
    pub edges: Vec<u32>,
    /// Wall id of each triangle.
    pub id: Vec<u32>,
    /// [`WallKind`] of each triangle.
    pub kind: Vec<u8>,
    polygon: Vec<u32>,
    arrays: Arrays,
}

impl Walls {
    /// Reads a file.
    ///
    /// # Errors
    /// Not a wall file.
    pub fn open(file: &Path) -> Result<Walls, Failure> {
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
        let (triangles, edges, polygon) = (Vec::new(), Vec::new(), Vec::new());
        let mut walls = Walls { points, triangles, edges, id: Vec::new(), kind: Vec::new(), polygon, arrays };
        let mut begin = 0;
        for (p, end) in ends.iter().enumerate() {
            let polygon = &corners[begin as usize..*end as usize];
            for k in 1..polygon.len().saturating_sub(1) {
                walls.triangles.extend([polygon[0], polygon[k], polygon[k + 1]]);
                walls.polygon.push(p as u32);
                walls.id.push(ids[p]);
                walls.kind.push(kinds.get(p).map_or(1, |k| *k as u8));
            }
            for k in 0..polygon.len() {
                walls.edges.extend([polygon[k], polygon[(k + 1) % polygon.len()]]);
            }
            begin = *end;
        }
        Ok(walls)
    }

    /// Returns the colour fields of polyhedral grains; vectors count by magnitude.
    pub fn fields(&self) -> Vec<String> {
        let geometry = ["id", "kind", STONE_BODY, STONE_CENTRE];
        let names = self.arrays.names("CellData").filter(|(name, _)| !geometry.contains(name));
        names.map(|(name, _)| if name == "velocity" { "speed".into() } else { name.to_string() }).collect()
    }

    /// Returns a value per triangle, of vectors the magnitude; `None` if unknown.
    ///
    /// # Errors
    /// Damaged field.
    pub fn field(&self, name: &str) -> Result<Option<Vec<f64>>, Failure> {
        let stored = if name == "speed" { "velocity" } else { name };
        let Some(components) = self.arrays.components("CellData", stored) else { return Ok(None) };
        let values = self.arrays.values("CellData", stored)?;
        let of = |p: &u32| {
            let own = &values[components * *p as usize..][..components];
            if components == 1 { own[0] } else { own.iter().map(|v| v * v).sum::<f64>().sqrt() }
        };
        Ok(Some(self.polygon.iter().map(of).collect()))
    }

    /// Selects values of polyhedral grains.
    pub fn of_stones<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let stone = |(_, kind): &(&f64, &u8)| **kind == WallKind::Stone as u8;
        values.iter().zip(&self.kind).filter(stone).map(|(v, _)| *v)
    }
}

/// Wall kinds of older files: one square is a plane, six are a box.
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
