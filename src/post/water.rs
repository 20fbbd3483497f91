//! Water surface of a scene at any time, as pictures and viewer draw it.

use std::path::Path;

use serde_json::{Value, json};

use trackbed_dem::{Water, Wave};
use trackbed_input::model::grains::water_of;
use trackbed_io::failure::Failure;
use trackbed_io::results::grains::GrainFile;
use trackbed_io::results::lines::Walls;
use trackbed_io::results::series::{Frame, Part};
use trackbed_io::write::WallKind;
use trackbed_run::RunFile;

/// Colour `rrggbb`.
pub const COLOUR: &str = "56b4e9";
/// Opacity.
pub const OPACITY: f32 = 0.35;
/// Margin over the size of the model.
const MARGIN: f64 = 0.03;
/// Cells per wavelength.
const CELLS: f64 = 24.0;
/// Most cells along one side.
const MOST: usize = 160;

/// Rectangle of water with regular waves.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    level: f64,
    wave: Option<Wave>,
    low: [f64; 2],
    size: [f64; 2],
}

impl Surface {
    /// Water over the bounds of a model [m].
    pub fn new(water: &Water, [low, high]: [[f64; 3]; 2]) -> Surface {
        let margin = [0, 1].map(|k| MARGIN * (high[k] - low[k]));
        Surface {
            level: water.level,
            wave: water.wave,
            low: [0, 1].map(|k| low[k] - margin[k]),
            size: [0, 1].map(|k| high[k] - low[k] + 2.0 * margin[k]),
        }
    }

    /// Water of a run around grains and walls of its first and last frames; `None` without water or where the
    /// scene is not understood.
    ///
    /// # Errors
    /// Damaged file.
    pub fn of_run(dir: &Path, frames: &[Frame]) -> Result<Option<Surface>, Failure> {
        let water = || {
            let document = RunFile::read(dir)?.document()?;
            water_of(&document, &document.scene().ok()?).ok()?
        };
        let Some(water) = water() else { return Ok(None) };
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let mut take = |x: &[f64]| {
            for k in 0..3 {
                bounds[0][k] = bounds[0][k].min(x[k]);
                bounds[1][k] = bounds[1][k].max(x[k]);
            }
        };
        for frame in frames.iter().take(1).chain(frames.last()) {
            if let Some(file) = frame.file(Part::Grains) {
                GrainFile::open(file)?.bounds().iter().flatten().for_each(|x| take(x));
            }
            let Some(file) = frame.file(Part::Walls) else { continue };
            let walls = Walls::open(file)?;
            let bounded = walls.triangles.chunks_exact(3).zip(&walls.kind);
            for n in bounded.filter(|(_, kind)| **kind != WallKind::Plane as u8).flat_map(|(n, _)| n) {
                take(&walls.points[3 * *n as usize..3 * *n as usize + 3]);
            }
        }
        Ok((bounds[0][0] <= bounds[1][0]).then(|| Surface::new(&water, bounds)))
    }

    /// Cells along x and y.
    fn cells(&self) -> [usize; 2] {
        let Some(wave) = &self.wave else { return [1; 2] };
        self.size.map(|size| ((CELLS * size / wave.length()).ceil() as usize).clamp(1, MOST))
    }

    /// Points [m], row by row along x.
    pub fn points(&self, time: f64) -> Vec<[f64; 3]> {
        let [across, along] = self.cells();
        let at = |k: usize, i: usize, cells: usize| self.low[k] + self.size[k] * i as f64 / cells as f64;
        let point = |x: f64, y: f64| {
            let elevation = self.wave.map_or(0.0, |wave| wave.at(x, y, 0.0, time).elevation);
            [x, y, self.level + elevation]
        };
        (0..=along)
            .flat_map(|j| (0..=across).map(move |i| (i, j)))
            .map(|(i, j)| point(at(0, i, across), at(1, j, along)))
            .collect()
    }

    /// Point indices of triangles.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let [across, along] = self.cells();
        let number = |i: usize, j: usize| (j * (across + 1) + i) as u32;
        (0..along)
            .flat_map(|j| (0..across).map(move |i| (i, j)))
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect()
    }

    /// Point indices of the lines around the surface.
    pub fn border(&self) -> Vec<[u32; 2]> {
        let [across, along] = self.cells();
        let number = |i: usize, j: usize| (j * (across + 1) + i) as u32;
        let rows = (0..across).flat_map(|i| [0, along].map(|j| [number(i, j), number(i + 1, j)]));
        let columns = (0..along).flat_map(|j| [0, across].map(|i| [number(i, j), number(i, j + 1)]));
        rows.chain(columns).collect()
    }

    /// Words about level and waves.
    pub fn name(&self) -> String {
        match &self.wave {
            None => format!("level {} m", self.level),
            Some(wave) => {
                let [height, length] = [2.0 * wave.amplitude, wave.length()].map(|x| (1e3 * x).round() / 1e3);
                format!("level {} m, waves of {height} m by {length} m", self.level)
            }
        }
    }

    /// What the viewer computes the surface from: z = level + a cos(k · x − ω t + φ).
    pub fn about(&self) -> Value {
        let wave = self.wave.map(|wave| {
            json!({ "amplitude": wave.amplitude, "frequency": wave.frequency, "phase": wave.phase,
                "number": wave.direction.map(|d| d * wave.number) })
        });
        json!({ "level": self.level, "low": self.low, "size": self.size, "cells": self.cells(), "wave": wave })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_dem::{DragArea, Measured};

    fn water(wave: Option<Wave>) -> Water {
        let drag_area = DragArea::Projected;
        let (current, still) = ([0.0; 2], 0.0);
        Water {
            level: -0.5,
            density: 1000.0,
            current,
            wave,
            drag: still,
            drag_area,
            skin_drag: still,
            drag_moment: still,
            added_mass: still,
        }
    }

    /// Crests travel by one wavelength in one period; trough and crest differ by the height.
    #[test]
    fn crests_travel() {
        let wave = Wave::new(0.4, Measured::Length(10.0), 0.0, 0.0, f64::INFINITY, [0.0; 2], 9.81).unwrap();
        let surface = Surface::new(&water(Some(wave)), [[0.0; 3], [20.0, 4.0, 1.0]]);
        let crest = |time: f64| {
            let points = surface.points(time);
            let first = points.iter().filter(|x| x[0] < 10.0);
            first.max_by(|a, b| a[2].total_cmp(&b[2])).copied().unwrap()
        };
        let period = std::f64::consts::TAU / wave.frequency;
        let cell = 10.0 / CELLS;
        assert!((crest(0.25 * period)[0] - 2.5).abs() < cell, "{:?}", crest(0.25 * period));
        assert!((crest(0.5 * period)[0] - 5.0).abs() < cell, "{:?}", crest(0.5 * period));
        let heights: Vec<f64> = surface.points(0.3).iter().map(|x| x[2]).collect();
        let [low, high] =
            heights.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], z| [a.min(*z), b.max(*z)]);
        assert!((low + 0.7).abs() < 0.004 && (high + 0.3).abs() < 0.004, "{low} to {high}");
        assert_eq!(surface.name(), "level -0.5 m, waves of 0.4 m by 10 m");
    }

    #[test]
    fn still_water_is_one_rectangle() {
        let surface = Surface::new(&water(None), [[0.0; 3], [2.0, 4.0, 1.0]]);
        assert_eq!(surface.points(3.0).len(), 4);
        assert_eq!(surface.triangles(), [[0, 1, 3], [0, 3, 2]]);
        assert_eq!(surface.border().len(), 4);
        assert!(surface.points(0.0).iter().all(|x| x[2] == -0.5));
        assert_eq!(surface.about()["wave"], Value::Null);
    }

    #[test]
    fn border_encloses_all_cells() {
        let wave = Wave::new(0.1, Measured::Length(4.0), 0.3, 0.0, 5.0, [0.0; 2], 9.81).unwrap();
        let surface = Surface::new(&water(Some(wave)), [[0.0; 3], [4.0, 2.0, 1.0]]);
        let [across, along] = surface.cells();
        assert_eq!(surface.triangles().len(), 2 * across * along);
        assert_eq!(surface.border().len(), 2 * (across + along));
        let most = surface.points(0.0).len() as u32;
        assert!(surface.triangles().iter().flatten().all(|n| *n < most));
    }
}
