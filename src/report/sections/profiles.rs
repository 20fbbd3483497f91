//! Profiles along line probes of the solid.

use super::overlay::{Named, overlay};
use crate::data::RunData;
use crate::page::{Section, joined, paragraph, plots};
use crate::plot::{Axis, figure};
use trackbed_input::scene::Probe;
use trackbed_io::columns::{Definition, history};

/// Position of zz in a tensor.
const VERTICAL: usize = 2;

/// Returns whether `stem` is a point of a line probe, such as `crest_3`.
pub(super) fn is_line_point(run: &RunData, stem: &str) -> bool {
    let probes = run.scene.iter().flat_map(|s| &s.probe);
    let number = |name: &str| stem.strip_prefix(name)?.strip_prefix('_')?.parse::<u32>().ok();
    probes.filter_map(Probe::named_line).any(|(name, _)| number(name).is_some())
}

/// Line probe with the values of one component: a row of points per time.
struct Line<'a> {
    name: &'a str,
    distances: Vec<f64>,
    times: &'a [f64],
    /// Values of each point.
    points: Vec<&'a [f64]>,
}

impl<'a> Line<'a> {
    fn read(run: &'a RunData, probe: &'a Probe, quantity: &'static Definition, part: usize) -> Option<Self> {
        let ((name, length), table) = (probe.named_line()?, run.table("history")?);
        let columns = (1..).map(|k| table.column(quantity.of(&format!("{name}_{k}")).at(part)));
        let points: Vec<&[f64]> = columns.map_while(|c| c).collect();
        let step = length / points.len().saturating_sub(1).max(1) as f64;
        let distances = (0..points.len()).map(|k| k as f64 * step).collect();
        let line = Line { name, distances, times: table.column(history::TIME)?, points };
        (line.points.len() > 1).then_some(line)
    }

    /// Returns the row with the value of largest magnitude, and that value.
    fn largest(&self) -> (usize, f64) {
        let all = self.points.iter().flat_map(|values| values.iter().copied().enumerate());
        all.fold((0, 0.0), |best: (usize, f64), v| if v.1.abs() > best.1.abs() { v } else { best })
    }

    fn curve(&self, value: impl Fn(&[f64]) -> f64) -> Vec<[f64; 2]> {
        self.distances.iter().zip(&self.points).map(|(x, values)| [*x, value(values)]).collect()
    }

    /// Returns the profile at the time of the largest value; alone also at the end, and the largest values of each point.
    fn profiles(&self, alone: bool) -> Vec<Named> {
        let (row, value) = self.largest();
        if value == 0.0 {
            return Vec::new();
        }
        let time = crate::quantity::with_unit(self.times[row], "s");
        let mut all = vec![(format!("{}, at {time}", self.name), self.curve(|v| v[row]))];
        if alone {
            let signed = |v: &[f64]| v.iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
            all.push((format!("{}, largest in time", self.name), self.curve(signed)));
            all.push((format!("{}, at the end", self.name), self.curve(|v| v[v.len() - 1])));
        }
        all
    }
}

/// Formats displacement, vertical stress and strain along lines.
pub fn profiles(runs: &[RunData]) -> Option<Section> {
    let curves = |quantity: &'static Definition, part: usize| {
        overlay(runs, |run| {
            let probes = run.scene.iter().flat_map(|s| &s.probe);
            let lines = probes.filter_map(|p| Line::read(run, p, quantity, part));
            lines.flat_map(|line| line.profiles(runs.len() == 1)).collect()
        })
    };
    let figures = [
        ("Vertical displacement along lines", history::PROBE_U, "displacement, up positive", "m"),
        ("Vertical stress along lines", history::PROBE_STRESS, "stress, tension positive", "Pa"),
        ("Vertical strain along lines", history::PROBE_STRAIN, "strain, elongation positive", ""),
    ]
    .map(|(title, quantity, name, unit)| {
        let along = Axis::new("distance from the first end", "m");
        figure(title, along, Axis::new(name, unit), curves(quantity, VERTICAL))
    });
    if figures.iter().all(|figure| figure.0.is_empty()) {
        return None;
    }
    let note = paragraph(
        "Profile at the time of the value of largest magnitude along the line; the largest values of each point occur at different times.",
    );
    Section::new("profiles", "Profiles along lines", joined([plots(figures), note]))
}
