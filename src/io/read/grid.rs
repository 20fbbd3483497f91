//! Triangulated heights on a regular grid.
//!
//! Samples are vertices at cell centres.

use std::path::Path;

use super::error::ReadError;
use super::surface::Surface;

/// Largest number of samples; their triangles would fill 16 GB.
pub const MOST_SAMPLES: usize = 100_000_000;

/// Heights [m] in rows from north to south, each from west to east.
pub struct Grid {
    /// Samples in a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Position of the north-western sample [m].
    pub corner: [f64; 2],
    /// Spacing of columns and rows, positive [m].
    pub step: [f64; 2],
    /// Heights by rows [m]; `None` for no data.
    pub heights: Vec<Option<f64>>,
}

impl Grid {
    /// Returns the surface through the samples, normals up.
    ///
    /// # Errors
    /// No three adjacent samples.
    pub fn surface(&self, file: &Path) -> Result<Surface, ReadError> {
        let mut surface = Surface::default();
        let mut index = vec![u32::MAX; self.heights.len()];
        for (k, height) in self.heights.iter().enumerate() {
            let Some(height) = *height else { continue };
            index[k] = surface.vertices.len() as u32;
            let (row, column) = ((k / self.columns) as f64, (k % self.columns) as f64);
            let place = [self.corner[0] + column * self.step[0], self.corner[1] - row * self.step[1]];
            surface.vertices.push([place[0], place[1], height]);
        }
        for row in 1..self.rows {
            for column in 1..self.columns {
                let at =
                    |down: usize, right: usize| index[(row - 1 + down) * self.columns + column - 1 + right];
                let (north_west, north_east) = (at(0, 0), at(0, 1));
                let (south_west, south_east) = (at(1, 0), at(1, 1));
                let here: Vec<u32> = [south_west, south_east, north_east, north_west]
                    .into_iter()
                    .filter(|v| *v != u32::MAX)
                    .collect();
                if let [a, b, c, rest @ ..] = here.as_slice() {
                    surface.triangles.push([*a, *b, *c]);
                    surface.triangles.extend(rest.iter().map(|d| [*a, *c, *d]));
                }
            }
        }
        if surface.triangles.is_empty() {
            let found =
                format!("{} samples, none of which has neighbours on two sides", surface.vertices.len());
            return Err(ReadError::whole(file, "heights", found, "heights that make a surface"));
        }
        Ok(surface.without_loose_vertices())
    }
}
