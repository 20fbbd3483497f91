//! SVG elements of plots.

use super::axis::{Ruler, Tick};
use super::{Curve, Level, Style};
use quick_xml::escape::escape;

/// Colours of curves, distinct for colour-blind readers (Okabe and Ito 2008).
pub const COLOURS: [&str; 7] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "currentColor"];
const DASHES: [&str; 4] = ["none", "7 4", "2 3", "9 3 2 3"];

/// Font size [px].
pub const FONT: f64 = 13.0;
pub(super) const TITLE_FONT: f64 = 16.0;
/// Space above the plot area [px].
pub const TOP: f64 = 12.0;
/// Space below the plot area, for tick labels and the label of the axis [px].
pub const BOTTOM: f64 = 50.0;
/// Width of a legend sample [px].
pub const SAMPLE: f64 = 34.0;
/// Height of the title of a file [px].
pub(super) const TITLE: f64 = 36.0;
/// Width of a character over the font size.
const CHARACTER: f64 = 0.6;

/// Plot area [px] with its axes.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Left end.
    pub left: f64,
    /// Right end.
    pub right: f64,
    /// Upper end.
    pub top: f64,
    /// Lower end.
    pub bottom: f64,
    /// Horizontal scale.
    pub x: Ruler,
    /// Vertical scale.
    pub y: Ruler,
}

impl Frame {
    /// Creates the area in a picture [px], with space for a legend at the right.
    pub fn new(x: Ruler, y: Ruler, [width, height]: [f64; 2], legend: f64) -> Frame {
        let widths = |ruler: &Ruler| -> Vec<f64> {
            ruler.ticks.iter().filter_map(|t| Some(text_width(t.label.as_ref()?, FONT))).collect()
        };
        let left = round(widths(&y).into_iter().fold(0.0, f64::max) + 38.0);
        let last = widths(&x).last().copied().unwrap_or(0.0);
        let right = round(width - legend.max(0.5 * last + 6.0));
        Frame { left, right, top: TOP, bottom: height - BOTTOM, x, y }
    }

    /// Returns the pixel of a value along x.
    pub fn x(&self, value: f64) -> f64 {
        round(self.left + self.x.fraction(value) * (self.right - self.left))
    }

    /// Returns the pixel of a value along y.
    pub fn y(&self, value: f64) -> f64 {
        round(self.bottom - self.y.fraction(value) * (self.bottom - self.top))
    }
}

/// Formats an SVG file, with a title above a picture [px].
pub fn file(title: &str, [width, height]: [f64; 2], body: &str) -> String {
    let total = height + TITLE;
    let title = text([0.5 * width, -10.0], "middle", fitted(title, TITLE_FONT, width - 32.0), title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 -{TITLE} {width} {total}\" width=\"{width}\" \
         height=\"{total}\" font-family=\"Helvetica, Arial, sans-serif\">\n\
         <rect y=\"-{TITLE}\" width=\"{width}\" height=\"{total}\" fill=\"white\"/>\n\
         <g font-weight=\"bold\">{title}</g>\n{body}</svg>\n"
    )
}

/// Formats the SVG element of a page, with a title for screen readers.
pub fn inline(title: &str, [width, height]: [f64; 2], body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
         aria-label=\"{}\">\n{body}</svg>\n",
        escaped(title)
    )
}

/// Draws the frame, both axes and their labels.
pub fn axes(frame: &Frame, labels: [&str; 2]) -> String {
    let &Frame { left, right, top, bottom, .. } = frame;
    let (width, height) = (round(right - left), round(bottom - top));
    let mut svg = x_axis(frame, labels[0]);
    for tick in &frame.y.ticks {
        let at = frame.y(tick.value);
        svg += &grid(tick, &format!("M{left} {at}H{right}"), [left - 7.0, at + 0.35 * FONT], "end");
    }
    let name = text([0.0; 2], "middle", fitted(labels[1], FONT, height), labels[1]);
    let middle = round(0.5 * (top + bottom));
    svg + &format!(
        "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"none\" class=\"frame\" \
         stroke=\"#444\"/>\n<g transform=\"translate(15 {middle}) rotate(-90)\">{name}</g>\n"
    )
}

/// Draws the grid, tick labels and label of the x axis.
pub fn x_axis(frame: &Frame, label: &str) -> String {
    let &Frame { left, right, top, bottom, .. } = frame;
    let mut svg = String::new();
    for tick in &frame.x.ticks {
        let at = frame.x(tick.value);
        svg += &grid(tick, &format!("M{at} {top}V{bottom}"), [at, bottom + 17.0], "middle");
    }
    let font = fitted(label, FONT, right - left);
    svg + &text([0.5 * (left + right), bottom + 40.0], "middle", font, label)
}

fn grid(tick: &Tick, line: &str, at: [f64; 2], anchor: &str) -> String {
    match &tick.label {
        Some(label) => {
            format!("<path d=\"{line}\" class=\"major\" stroke=\"#d8d8d8\"/>\n")
                + &text(at, anchor, FONT, label)
        }
        None => format!("<path d=\"{line}\" class=\"minor\" stroke=\"#efefef\"/>\n"),
    }
}

/// Draws the valid points of a curve.
pub fn curve(frame: &Frame, curve: &Curve) -> String {
    let style = curve.style;
    let shows = |p: &[f64; 2]| frame.x.shows(p[0]) && frame.y.shows(p[1]);
    let points = || curve.points.iter().enumerate().filter(|(_, p)| shows(p));
    let pixels = points().map(|(_, p)| [frame.x(p[0]), frame.y(p[1])]);
    let pixels = if curve.labels.is_empty() { thinned(pixels) } else { pixels.collect() };
    let mut svg = String::new();
    if style.line && pixels.len() > 1 {
        let list: Vec<String> = pixels.iter().map(|[x, y]| format!("{x},{y}")).collect();
        svg += &format!("<polyline points=\"{}\" {}/>\n", list.join(" "), stroke(style));
    }
    for (k, p) in points() {
        let [x, y] = [frame.x(p[0]), frame.y(p[1])];
        if let Some(error) = curve.errors.get(k).filter(|e| **e > 0.0 && frame.y.shows(p[1] - *e)) {
            let [low, high] = [p[1] - error, p[1] + error].map(|v| frame.y(v));
            let cap = |at: f64| format!("M{} {at}h8", round(x - 4.0));
            let bar = format!("M{x} {low}V{high}{}{}", cap(low), cap(high));
            svg += &format!("<path d=\"{bar}\" fill=\"none\" stroke=\"{}\"/>\n", colour(style));
        }
        if let Some(label) = curve.labels.get(k) {
            svg += &text([x + 7.0, y - 6.0], "start", FONT, label);
        }
    }
    let marked = style.marks || pixels.len() == 1;
    svg.extend(pixels.iter().filter(|_| marked).map(|p| mark(style, *p)));
    svg
}

/// Draws a horizontal line with its band.
pub fn level(frame: &Frame, level: &Level) -> String {
    let &Frame { left, right, .. } = frame;
    let [a, b] = [level.y - level.tolerance, level.y + level.tolerance].map(|v| frame.y(v));
    let (top, width, height) = (a.min(b), round(right - left), round((a - b).abs()));
    format!(
        "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"currentColor\" fill-opacity=\"0.1\"/>\n\
         <path d=\"M{left} {}H{right}\" {LEVEL}/>\n",
        frame.y(level.y)
    )
}

const LEVEL: &str = "fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.2\" stroke-dasharray=\"7 4\"";

/// Draws the legend sample of a style, 12 px high; of a level without style.
pub fn sample(style: Option<Style>) -> String {
    let Some(style) = style else { return format!("<path d=\"M1 6h32\" {LEVEL}/>") };
    let line = if style.line { format!("<path d=\"M1 6h32\" {}/>", stroke(style)) } else { String::new() };
    if style.marks { line + &mark(style, [0.5 * SAMPLE, 6.0]) } else { line }
}

fn mark(style: Style, [x, y]: [f64; 2]) -> String {
    let colour = colour(style);
    let (shape, open) = match style.dash % 4 {
        0 => return format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"3.5\" fill=\"{colour}\"/>\n"),
        1 => ("m-3 -3h6v6h-6z", true),
        2 => ("m-4.5 0l4.5 -4.5l4.5 4.5l-4.5 4.5z", false),
        _ => ("m0 -4l4 7h-8z", true),
    };
    let paint = match open {
        true => format!("class=\"hollow\" fill=\"white\" stroke=\"{colour}\" stroke-width=\"1.4\""),
        false => format!("fill=\"{colour}\""),
    };
    format!("<path d=\"M{x} {y}{shape}\" {paint}/>\n")
}

fn stroke(style: Style) -> String {
    let (colour, dash) = (colour(style), DASHES[style.dash % DASHES.len()]);
    format!(
        "fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"{dash}\" stroke-linejoin=\"round\""
    )
}

fn colour(style: Style) -> &'static str {
    COLOURS[style.colour % COLOURS.len()]
}

/// Draws a text of a font size [px] at a pixel; anchor `start`, `middle` or `end`.
pub fn text([x, y]: [f64; 2], anchor: &str, font: f64, content: &str) -> String {
    let (x, y, content) = (round(x), round(y), escaped(content));
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{font}\">{content}</text>\n")
}

/// Escapes a text, without characters that XML 1.0 forbids.
fn escaped(text: &str) -> String {
    let fits = |c: char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().map(|c| if fits(c) { c } else { ' ' }).collect();
    escape(&text).into_owned()
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

/// Keeps first, lowest, highest and last point of each half-pixel column.
fn thinned(pixels: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
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
