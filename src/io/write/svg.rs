//! Line plots as SVG.
//!
//! Colours: Okabe and Ito (2008), distinct for colour-blind readers.

use std::path::Path;

use quick_xml::escape::escape;

use super::atomic;
use super::error::{WriteError, check_field};

/// Curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points (x, y), joined in order, in axis units.
    pub points: Vec<[f64; 2]>,
}

/// Plot of curves with common axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinePlot {
    /// Title above the plot.
    pub title: String,
    /// Quantity and unit along x, such as `cycle [1]`.
    pub x_label: String,
    /// Quantity and unit along y, such as `settlement [mm]`.
    pub y_label: String,
    /// Curves.
    pub series: Vec<Series>,
}

pub(super) const WIDTH: f64 = 760.0;
pub(super) const HEIGHT: f64 = 460.0;
pub(super) const TOP: f64 = 48.0;
pub(super) const BOTTOM: f64 = 60.0;
pub(super) const FONT: f64 = 13.0;
pub(super) const TITLE_FONT: f64 = 16.0;
const CHARACTER: f64 = 0.6;
pub(super) const SAMPLE: f64 = 34.0;

/// Colours of curves, distinct for colour-blind readers (Okabe and Ito 2008).
pub const COLOURS: [&str; 7] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"];
/// Dash patterns of curves.
pub const DASHES: [&str; 4] = ["none", "7 4", "2 3", "9 3 2 3"];

impl LinePlot {
    /// Writes the plot.
    ///
    /// # Errors
    /// Non-finite points; I/O errors.
    pub fn write(&self, file: &Path) -> Result<(), WriteError> {
        for series in &self.series {
            let flat = series.points.as_flattened();
            check_field(file, &format!("series {}", series.name), flat, 2, series.points.len())?;
        }
        let text = self.render();
        atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))
    }

    fn render(&self) -> String {
        let x = Axis::over(self.points().map(|p| p[0]), 8);
        let y = Axis::over(self.points().map(|p| p[1]), 6);
        let widest = y.labels().iter().map(|l| text_width(l, FONT)).fold(0.0, f64::max);
        let area = Area {
            left: widest + 44.0,
            right: WIDTH - self.legend_width().max(24.0),
            top: TOP,
            bottom: HEIGHT - BOTTOM,
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
             height=\"{HEIGHT}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"{FONT}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        );
        self.frame(&mut svg, &area, &x, &y);
        for (index, series) in self.series.iter().enumerate() {
            svg += &curve(series, index, &area, &x, &y);
        }
        self.legend(&mut svg, &area);
        svg + "</svg>\n"
    }

    fn points(&self) -> impl Iterator<Item = &[f64; 2]> {
        self.series.iter().flat_map(|s| &s.points)
    }

    /// A single curve has no legend.
    fn legend_width(&self) -> f64 {
        let names = self.series.iter().map(|s| text_width(&s.name, FONT));
        if self.series.len() < 2 { 0.0 } else { names.fold(0.0, f64::max) + SAMPLE + 26.0 }
    }

    fn frame(&self, svg: &mut String, area: &Area, x: &Axis, y: &Axis) {
        let Area { left, right, top, bottom } = *area;
        for (value, label) in x.ticks().into_iter().zip(x.labels()) {
            let at = round(area.x(x.fraction(value)));
            *svg += &format!("<path d=\"M{at} {top}V{bottom}\" stroke=\"#ddd\"/>\n");
            *svg += &text(at, bottom + 18.0, "middle", &label);
        }
        for (value, label) in y.ticks().into_iter().zip(y.labels()) {
            let at = round(area.y(y.fraction(value)));
            *svg += &format!("<path d=\"M{} {at}H{}\" stroke=\"#ddd\"/>\n", round(left), round(right));
            *svg += &text(left - 8.0, at + 0.35 * FONT, "end", &label);
        }
        let (w, h) = (round(right - left), bottom - top);
        *svg += &format!(
            "<rect x=\"{}\" y=\"{top}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#333\"/>\n",
            round(left)
        );
        *svg += &text(0.5 * (left + right), bottom + 42.0, "middle", &self.x_label);
        let middle = 0.5 * (top + bottom);
        let font = fitted(&self.y_label, FONT, h);
        *svg += &format!("<g font-size=\"{font}\" transform=\"translate(18 {middle}) rotate(-90)\">");
        *svg += &text(0.0, 0.0, "middle", &self.y_label);
        *svg += "</g>\n";
        let font = fitted(&self.title, TITLE_FONT, WIDTH - 32.0);
        *svg += &format!("<g font-size=\"{font}\" font-weight=\"bold\">");
        *svg += &text(0.5 * WIDTH, 28.0, "middle", &self.title);
        *svg += "</g>\n";
    }

    fn legend(&self, svg: &mut String, area: &Area) {
        if self.series.len() < 2 {
            return;
        }
        for (index, series) in self.series.iter().enumerate() {
            let (from, at) = (area.right + 14.0, area.top + 14.0 + 20.0 * index as f64);
            *svg += &format!("<path d=\"M{} {at}h{}\" {}/>\n", round(from), SAMPLE - 8.0, stroke(index));
            *svg += &text(from + SAMPLE, at + 0.35 * FONT, "start", &series.name);
        }
    }
}

struct Area {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

impl Area {
    fn x(&self, fraction: f64) -> f64 {
        self.left + fraction * (self.right - self.left)
    }

    fn y(&self, fraction: f64) -> f64 {
        self.bottom - fraction * (self.bottom - self.top)
    }
}

struct Axis {
    low: f64,
    step: f64,
    steps: usize,
}

impl Axis {
    /// At most `most` steps of 1, 2 or 5 times a power of ten.
    fn over(values: impl Iterator<Item = f64>, most: usize) -> Axis {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = match high - low {
            span if span.is_nan() || span == f64::NEG_INFINITY => (0.0, 1.0),
            span if span <= 1e-12 * high.abs().max(low.abs()) => {
                let half = if high == 0.0 { 1.0 } else { 0.5 * high.abs() };
                (low - half, high + half)
            }
            _ => (low, high),
        };
        let step = nice_step((high - low) / most as f64);
        // No further step for rounding errors.
        let first = (low / step + 1e-9).floor();
        let last = (high / step - 1e-9).ceil();
        Axis { low: first * step, step, steps: ((last - first) as usize).max(1) }
    }

    fn fraction(&self, value: f64) -> f64 {
        (value - self.low) / (self.step * self.steps as f64)
    }

    fn ticks(&self) -> Vec<f64> {
        (0..=self.steps).map(|i| (self.low / self.step + i as f64).round() * self.step).collect()
    }

    fn labels(&self) -> Vec<String> {
        let largest = self.ticks().into_iter().fold(0.0, |m: f64, t| m.max(t.abs()));
        let digits = (-libm::log10(self.step).floor()).max(0.0) as usize;
        let scientific = largest >= 1e6 || self.step < 1e-4;
        let label = |t: f64| match (scientific, t == 0.0) {
            (true, true) => "0".to_string(),
            (true, false) => {
                let decimals =
                    (libm::log10(largest).floor() - libm::log10(self.step).floor()).max(0.0) as usize;
                minus(&format!("{t:.decimals$e}"))
            }
            (false, _) => minus(&format!("{:.digits$}", t + 0.0)),
        };
        self.ticks().into_iter().map(label).collect()
    }
}

/// Typographic minus, as wide as a digit.
pub fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// Digit times a power of ten, in plain form if short.
pub fn power_of_ten(decade: i32, digit: u32) -> String {
    match decade {
        0..=4 => format!("{digit}{}", "0".repeat(decade as usize)),
        -3..=-1 => format!("0.{}{digit}", "0".repeat((-decade - 1) as usize)),
        _ => minus(&format!("{digit}e{decade}")),
    }
}

fn nice_step(least: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(least).floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= least * (1.0 - 1e-9)).unwrap_or(power)
}

/// Estimated width of a text [px].
pub fn text_width(text: &str, font: f64) -> f64 {
    CHARACTER * font * text.chars().count() as f64
}

/// Font size reduced to fit `space` [px].
pub(super) fn fitted(text: &str, font: f64, space: f64) -> f64 {
    let scale = space / text_width(text, font).max(1.0);
    if scale >= 1.0 { font } else { (10.0 * font * scale).floor() / 10.0 }
}

/// Rounds to hundredths of a pixel.
pub fn round(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

pub(super) fn text(x: f64, y: f64, anchor: &str, content: &str) -> String {
    let (x, y, content) = (round(x), round(y), escape(&printable(content)).into_owned());
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{content}</text>\n")
}

/// Removes control characters, invalid in XML 1.0.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn stroke(index: usize) -> String {
    let (colour, dash) = (COLOURS[index % COLOURS.len()], DASHES[index % DASHES.len()]);
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.8\" stroke-dasharray=\"{dash}\"")
}

fn curve(series: &Series, index: usize, area: &Area, x: &Axis, y: &Axis) -> String {
    let pixel = |p: &[f64; 2]| [round(area.x(x.fraction(p[0]))), round(area.y(y.fraction(p[1])))];
    let pixels = thinned(series.points.iter().map(pixel));
    match pixels.as_slice() {
        [] => String::new(),
        [[cx, cy]] => {
            format!("<circle cx=\"{cx}\" cy=\"{cy}\" r=\"3\" fill=\"{}\"/>\n", COLOURS[index % COLOURS.len()])
        }
        several => {
            let list = several.iter().map(|[px, py]| format!("{px},{py}")).collect::<Vec<_>>().join(" ");
            format!("<polyline points=\"{list}\" {} stroke-linejoin=\"round\"/>\n", stroke(index))
        }
    }
}

/// Keeps first, lowest, highest and last point of each half-pixel column.
pub fn thinned(pixels: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let all: Vec<[f64; 2]> = pixels.collect();
    let column = |p: &[f64; 2]| (2.0 * p[0]).floor();
    let mut kept = Vec::new();
    for group in all.chunk_by(|a, b| column(a) == column(b)) {
        let by_height = |a: &usize, b: &usize| group[*a][1].total_cmp(&group[*b][1]);
        let lowest = (0..group.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..group.len()).max_by(by_height).unwrap_or(0);
        let mut chosen = [0, lowest.min(highest), lowest.max(highest), group.len() - 1].to_vec();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|i| group[i]));
    }
    kept.dedup();
    kept
}

#[cfg(test)]
#[path = "svg_tests.rs"]
mod tests;
