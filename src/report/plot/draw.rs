//! The SVG of a plot.

use super::ruler::Ruler;
use super::{Curve, Look};
use crate::report::page::escaped;
use crate::write::svg::{COLOURS, DASHES, round, text_width, thinned};
use std::fmt::Write;

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 340.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 50.0;
const FONT: f64 = 13.0;

/// The rectangle that curves are drawn in, with its sides.
struct Area<'a> {
    left: f64,
    right: f64,
    x: &'a Ruler,
    y: &'a Ruler,
    downwards: bool,
}

impl Area<'_> {
    fn x(&self, value: f64) -> f64 {
        round(self.left + self.x.fraction(value) * (self.right - self.left))
    }

    fn y(&self, value: f64) -> f64 {
        let (bottom, fraction) = (HEIGHT - BOTTOM, self.y.fraction(value));
        let fraction = if self.downwards { 1.0 - fraction } else { fraction };
        round(bottom - fraction * (bottom - TOP))
    }
}

/// The plot as SVG; points are those that have a place.
pub fn svg(title: &str, labels: [String; 2], sides: (&Ruler, &Ruler, bool), curves: &[Curve]) -> String {
    let (x, y, downwards) = sides;
    let width = |label: &Option<String>| label.as_ref().map_or(0.0, |l| text_width(l, FONT));
    let widest = y.ticks.iter().map(|t| width(&t.label)).fold(0.0, f64::max);
    let last = x.ticks.iter().rev().find_map(|t| t.label.as_ref()).map_or(0.0, |l| text_width(l, FONT));
    let area = Area { left: widest + 38.0, right: WIDTH - 0.5 * last - 6.0, x, y, downwards };
    let title = escaped(title);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\" \
         font-size=\"{FONT}\">\n"
    );
    frame(&mut svg, &area, &labels);
    curves.iter().for_each(|c| curve(&mut svg, c, &area));
    svg + "</svg>\n"
}

fn frame(svg: &mut String, area: &Area<'_>, labels: &[String; 2]) {
    let (left, right, bottom) = (round(area.left), round(area.right), HEIGHT - BOTTOM);
    let colour = |named: bool| if named { "#d8d8d8" } else { "#efefef" };
    for tick in &area.x.ticks {
        let (at, colour) = (area.x(tick.value), colour(tick.label.is_some()));
        add(svg, format_args!("<path d=\"M{at} {TOP}V{bottom}\" stroke=\"{colour}\"/>"));
        tick.label.iter().for_each(|label| text(svg, at, bottom + 17.0, "middle", label));
    }
    for tick in &area.y.ticks {
        let (at, colour) = (area.y(tick.value), colour(tick.label.is_some()));
        add(svg, format_args!("<path d=\"M{left} {at}H{right}\" stroke=\"{colour}\"/>"));
        tick.label.iter().for_each(|label| text(svg, left - 7.0, at + 0.35 * FONT, "end", label));
    }
    let (w, h) = (round(right - left), round(bottom - TOP));
    add(
        svg,
        format_args!(
            "<rect x=\"{left}\" y=\"{TOP}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#333\"/>"
        ),
    );
    text(svg, 0.5 * (left + right), bottom + 40.0, "middle", &labels[0]);
    let font = (FONT * (h / text_width(&labels[1], FONT)).min(1.0) * 10.0).floor() / 10.0;
    add(
        svg,
        format_args!(
            "<g transform=\"translate(15 {}) rotate(-90)\" font-size=\"{font}\">",
            round(0.5 * (TOP + bottom))
        ),
    );
    text(svg, 0.0, 0.0, "middle", &labels[1]);
    add(svg, format_args!("</g>"));
}

fn curve(svg: &mut String, curve: &Curve, area: &Area<'_>) {
    let pixels = thinned(curve.points.iter().map(|p| [area.x(p[0]), area.y(p[1])]));
    let colour = COLOURS[curve.look.colour % COLOURS.len()];
    if curve.look.line && pixels.len() > 1 {
        let list: Vec<String> = pixels.iter().map(|[x, y]| format!("{x},{y}")).collect();
        add(svg, format_args!("<polyline points=\"{}\" {}/>", list.join(" "), stroke(curve.look)));
    }
    if curve.look.marks || pixels.len() == 1 {
        for [x, y] in &pixels {
            add(svg, format_args!("{}", mark(curve.look.dash, colour, *x, *y)));
        }
    }
}

/// A marker; shapes go with the dashes.
fn mark(shape: usize, colour: &str, x: f64, y: f64) -> String {
    match shape % 4 {
        0 => format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"{colour}\"/>"),
        1 => format!(
            "<rect x=\"{}\" y=\"{}\" width=\"5.6\" height=\"5.6\" fill=\"white\" stroke=\"{colour}\" stroke-width=\"1.4\"/>",
            round(x - 2.8),
            round(y - 2.8)
        ),
        2 => format!("<path d=\"M{x} {y}m-4 0l4 -4l4 4l-4 4z\" fill=\"{colour}\"/>"),
        _ => format!(
            "<path d=\"M{x} {y}m0 -4l4 7h-8z\" fill=\"white\" stroke=\"{colour}\" stroke-width=\"1.4\"/>"
        ),
    }
}

/// Line and marker beside a name in the legend.
pub fn sample(look: Look) -> String {
    let mut out = String::from("<svg viewBox=\"0 0 34 12\" width=\"34\" height=\"12\" aria-hidden=\"true\">");
    if look.line {
        write!(out, "<path d=\"M1 6h32\" {}/>", stroke(look)).expect("writing to a string does not fail");
    }
    if look.marks {
        out += &mark(look.dash, COLOURS[look.colour % COLOURS.len()], 17.0, 6.0);
    }
    out + "</svg>"
}

fn stroke(look: Look) -> String {
    let (colour, dash) = (COLOURS[look.colour % COLOURS.len()], DASHES[look.dash % DASHES.len()]);
    format!(
        "fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"{dash}\" stroke-linejoin=\"round\""
    )
}

fn text(svg: &mut String, x: f64, y: f64, anchor: &str, content: &str) {
    let (x, y, content) = (round(x), round(y), escaped(content));
    add(svg, format_args!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{content}</text>"));
}

fn add(svg: &mut String, line: std::fmt::Arguments<'_>) {
    writeln!(svg, "{line}").expect("writing to a string does not fail");
}
