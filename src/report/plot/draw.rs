//! SVG of a plot.

use super::ruler::{Ruler, Tick};
use super::{Curve, Look};
use maud::{Markup, html};
use trackbed_io::write::svg::{COLOURS, DASHES, round, text_width, thinned};

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 340.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 50.0;
const FONT: f64 = 13.0;
const STROKE: f64 = 1.6;

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

/// Draws the plot; only points within range.
pub fn svg(title: &str, labels: [String; 2], sides: (&Ruler, &Ruler, bool), curves: &[Curve]) -> Markup {
    let (x, y, downwards) = sides;
    let width = |label: &Option<String>| label.as_ref().map_or(0.0, |l| text_width(l, FONT));
    let widest = y.ticks.iter().map(|t| width(&t.label)).fold(0.0, f64::max);
    let last = x.ticks.iter().rev().find_map(|t| t.label.as_ref()).map_or(0.0, |l| text_width(l, FONT));
    let area = Area { left: widest + 38.0, right: WIDTH - 0.5 * last - 6.0, x, y, downwards };
    html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label=(title) font-size=(FONT) {
            "\n"
            (frame(&area, &labels))
            @for c in curves { (curve(c, &area)) }
        }
        "\n"
    }
}

fn frame(area: &Area<'_>, labels: &[String; 2]) -> Markup {
    let (left, right, bottom) = (round(area.left), round(area.right), HEIGHT - BOTTOM);
    let class = |tick: &Tick| if tick.label.is_some() { "major" } else { "minor" };
    let (w, h) = (round(right - left), round(bottom - TOP));
    let font = (FONT * (h / text_width(&labels[1], FONT)).min(1.0) * 10.0).floor() / 10.0;
    html! {
        @for (tick, at) in area.x.ticks.iter().map(|t| (t, area.x(t.value))) {
            path d={ "M" (at) " " (TOP) "V" (bottom) } class=(class(tick)) {} "\n"
            @if let Some(label) = &tick.label { (text(at, bottom + 17.0, "middle", label)) }
        }
        @for (tick, at) in area.y.ticks.iter().map(|t| (t, area.y(t.value))) {
            path d={ "M" (left) " " (at) "H" (right) } class=(class(tick)) {} "\n"
            @if let Some(label) = &tick.label { (text(left - 7.0, at + 0.35 * FONT, "end", label)) }
        }
        rect x=(left) y=(TOP) width=(w) height=(h) fill="none" class="frame" {} "\n"
        (text(0.5 * (left + right), bottom + 40.0, "middle", &labels[0]))
        g transform={ "translate(15 " (round(0.5 * (TOP + bottom))) ") rotate(-90)" } font-size=(font) {
            (text(0.0, 0.0, "middle", &labels[1]))
        }
        "\n"
    }
}

fn curve(curve: &Curve, area: &Area<'_>) -> Markup {
    let pixels = thinned(curve.points.iter().map(|p| [area.x(p[0]), area.y(p[1])]));
    let colour = colour(curve.look);
    let joined = curve.look.line && pixels.len() > 1;
    let marked = curve.look.marks || pixels.len() == 1;
    let list: Vec<String> = pixels.iter().filter(|_| joined).map(|[x, y]| format!("{x},{y}")).collect();
    html! {
        @if joined {
            polyline points=(list.join(" ")) fill="none" stroke=(colour) stroke-width=(STROKE) stroke-dasharray=(dashes(curve.look))
                stroke-linejoin="round" {}
            "\n"
        }
        @for [x, y] in pixels.iter().filter(|_| marked) { (mark(curve.look.dash, colour, *x, *y)) "\n" }
    }
}

fn mark(shape: usize, colour: &str, x: f64, y: f64) -> Markup {
    let (left, top) = (round(x - 2.8), round(y - 2.8));
    html! {
        @match shape % 4 {
            0 => circle cx=(x) cy=(y) r="3" fill=(colour) {},
            1 => rect x=(left) y=(top) width="5.6" height="5.6" class="hollow" stroke=(colour) stroke-width="1.4" {},
            2 => path d={ "M" (x) " " (y) "m-4 0l4 -4l4 4l-4 4z" } fill=(colour) {},
            _ => path d={ "M" (x) " " (y) "m0 -4l4 7h-8z" } class="hollow" stroke=(colour) stroke-width="1.4" {},
        }
    }
}

/// Black follows the text, for dark pages.
fn colour(look: Look) -> &'static str {
    match COLOURS[look.colour % COLOURS.len()] {
        "#000000" => "currentColor",
        colour => colour,
    }
}

/// Draws a legend sample.
pub fn sample(look: Look) -> Markup {
    let colour = colour(look);
    html! {
        svg viewBox="0 0 34 12" width="34" height="12" aria-hidden="true" {
            @if look.line {
                path d="M1 6h32" fill="none" stroke=(colour) stroke-width=(STROKE) stroke-dasharray=(dashes(look))
                    stroke-linejoin="round" {}
            }
            @if look.marks { (mark(look.dash, colour, 17.0, 6.0)) }
        }
    }
}

fn dashes(look: Look) -> &'static str {
    DASHES[look.dash % DASHES.len()]
}

fn text(x: f64, y: f64, anchor: &str, content: &str) -> Markup {
    html! { text x=(round(x)) y=(round(y)) text-anchor=(anchor) { (content) } "\n" }
}
