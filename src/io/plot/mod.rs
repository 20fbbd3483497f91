//! Plots as SVG, for files and pages.
//!
//! Grid, frame and open marks are grey and white, with classes for the style of a page; black is `currentColor`.

pub mod axis;
pub mod draw;

pub use axis::{Axis, minus};

use crate::write::error::check_field;
use crate::write::{WriteError, atomic};
use axis::Ends;
use draw::{FONT, Frame, SAMPLE, text, text_width};
use std::path::Path;

/// Plot of a page, plot of a file with legend but without title [px].
const PAGE: [f64; 2] = [560.0, 340.0];
const FILE: [f64; 2] = [760.0, 424.0];
/// Smallest width without legend [px].
const NARROW: f64 = 400.0;

/// Curve style.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Colour index.
    pub colour: usize,
    /// Index of dashes and mark: circle, square, diamond, triangle.
    pub dash: usize,
    /// Whether points are connected.
    pub line: bool,
    /// Whether points have marks.
    pub marks: bool,
}

/// Curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Legend entry, or empty.
    pub name: String,
    /// Points (x, y) in order, in axis units.
    pub points: Vec<[f64; 2]>,
    /// Style.
    pub style: Style,
    /// Labels of the points, or empty.
    pub labels: Vec<String>,
    /// Standard errors of y, or empty.
    pub errors: Vec<f64>,
}

impl Curve {
    /// Creates a curve.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>, style: Style) -> Curve {
        Curve { name: name.into(), points, style, ..Curve::default() }
    }
}

/// Horizontal line.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Legend entry.
    pub name: String,
    /// Height, in axis units.
    pub y: f64,
    /// Half width of the band around it, in axis units.
    pub tolerance: f64,
}

/// Plot of curves with common axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves.
    pub curves: Vec<Curve>,
    /// Horizontal line.
    pub level: Option<Level>,
}

/// SVG and legend of a plot on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Inline {
    /// SVG element.
    pub svg: String,
    /// SVG content of the sample (34 × 12 px), name.
    pub legend: Vec<(String, String)>,
}

impl Plot {
    /// Creates a plot of lines (name, points).
    pub fn lines<N: Into<String>>(
        title: String,
        x: Axis,
        y: Axis,
        named: impl IntoIterator<Item = (N, Vec<[f64; 2]>)>,
    ) -> Plot {
        let style = |k| Style { colour: k, dash: k, line: true, marks: false };
        let curve = |(k, (name, points))| Curve::new(name, points, style(k));
        Plot { title, x, y, curves: named.into_iter().enumerate().map(curve).collect(), level: None }
    }

    /// Writes an SVG file.
    ///
    /// # Errors
    /// Points not finite, or not positive on a logarithmic axis; I/O errors.
    pub fn write(&self, file: &Path) -> Result<(), WriteError> {
        for curve in &self.curves {
            let positions = curve.points.iter().map(|p| [self.x.position(p[0]), self.y.position(p[1])]);
            let all: Vec<[f64; 2]> = positions.collect();
            check_field(file, &format!("series {}", curve.name), all.as_flattened(), 2, all.len())?;
        }
        if let Some(level) = &self.level {
            check_field(file, &level.name, &[self.y.position(level.y)], 1, 1)?;
        }
        let text = self.file();
        atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))
    }

    /// Formats an SVG file, with the legend of several curves at the right.
    pub fn file(&self) -> String {
        let legend = self.legend();
        let widest = legend.iter().map(|entry| text_width(&entry.1, FONT)).fold(0.0, f64::max);
        let space = if legend.len() > 1 { widest + SAMPLE + 30.0 } else { 0.0 };
        let size = [FILE[0].max(space + NARROW), FILE[1]];
        let frame = self.frame(size, space);
        let mut body = self.body(&frame);
        for (row, (sample, name)) in legend.iter().enumerate().filter(|_| space > 0.0) {
            let (x, y) = (frame.right + 14.0, frame.top + 8.0 + 20.0 * row as f64);
            body += &format!("<g transform=\"translate({x} {y})\">{sample}</g>\n");
            body += &text([x + SAMPLE + 6.0, y + 6.0 + 0.35 * FONT], "start", FONT, name);
        }
        draw::file(&self.title, size, &body)
    }

    /// Formats a plot of a page; none without two valid points of a curve.
    pub fn inline(&self) -> Option<Inline> {
        if self.curves.iter().all(|c| self.valid(c).nth(1).is_none()) {
            return None;
        }
        let svg = draw::inline(&self.title, PAGE, &self.body(&self.frame(PAGE, 0.0)));
        Some(Inline { svg, legend: self.legend() })
    }

    fn valid<'a>(&'a self, curve: &'a Curve) -> impl Iterator<Item = &'a [f64; 2]> {
        let shows = |p: &[f64; 2]| self.x.position(p[0]).is_finite() && self.y.position(p[1]).is_finite();
        curve.points.iter().filter(move |p| shows(p))
    }

    fn legend(&self) -> Vec<(String, String)> {
        let named = self.curves.iter().filter(|c| !c.name.is_empty() && self.valid(c).next().is_some());
        let curves = named.map(|c| {
            let marks = c.style.marks || self.valid(c).nth(1).is_none();
            (draw::sample(Some(Style { marks, ..c.style })), c.name.clone())
        });
        curves.chain(self.level.iter().map(|l| (draw::sample(None), l.name.clone()))).collect()
    }

    fn frame(&self, size: [f64; 2], legend: f64) -> Frame {
        // Marks and labels need space, lines do not.
        let labelled = self.curves.iter().any(|c| !c.labels.is_empty());
        let y_ends = if labelled { Ends::Beyond } else { Ends::Ticks };
        let lines = !labelled && self.curves.iter().all(|c| c.style.line);
        let x_ends = if lines { Ends::Values } else { y_ends };
        let ends = |c: &Curve, k: usize| {
            let error = c.errors.get(k).copied().unwrap_or(0.0);
            [c.points[k][1] - error, c.points[k][1] + error]
        };
        let heights = self.curves.iter().flat_map(|c| (0..c.points.len()).flat_map(move |k| ends(c, k)));
        let band = self.level.iter().flat_map(|l| [l.y - l.tolerance, l.y + l.tolerance]);
        let x = self.x.ruler(self.curves.iter().flat_map(|c| c.points.iter().map(|p| p[0])), 7, x_ends);
        Frame::new(x, self.y.ruler(heights.chain(band), 6, y_ends), size, legend)
    }

    fn body(&self, frame: &Frame) -> String {
        let mut svg = draw::axes(frame, [&self.x.label(), &self.y.label()]);
        svg.extend(self.level.iter().map(|level| draw::level(frame, level)));
        svg.extend(self.curves.iter().map(|curve| draw::curve(frame, curve)));
        svg
    }
}

#[cfg(test)]
mod tests;
