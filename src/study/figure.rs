//! Response plots and tornado charts as SVG, for files and pages.

use super::analysis::{Analysis, Sensitivity};
use super::factor::Factor;
use super::target::Target;
use maud::{Markup, html};
use trackbed_io::write::svg::{COLOURS, minus, round, text_width};
use trackbed_report::plot::ruler::Ruler;

const WIDTH: f64 = 560.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 50.0;
const RESPONSE: f64 = 360.0;
const ROW: f64 = 34.0;
const FONT: f64 = 13.0;
const SMALL: f64 = 11.5;
const CAP: f64 = 4.0;

/// Figure without frame.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Title.
    pub title: String,
    height: f64,
    body: Markup,
}

impl Figure {
    /// Formats a file: black on white.
    pub fn file(&self) -> String {
        let style = "svg text { fill: #111; } .major { stroke: #d8d8d8; } .minor { stroke: #efefef; } .frame { stroke: #444; }";
        let (w, h) = (WIDTH, self.height + 26.0);
        let page = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 -26 " (w) " " (h) } width=(w) height=(h) font-size=(FONT)
                font-family="Helvetica, Arial, sans-serif" {
                "\n" style { (style) } "\n"
                rect x="0" y="-26" width=(w) height=(h) fill="white" {} "\n"
                (text(0.5 * w, -7.0, "middle", &self.title, fitted(&self.title, 15.0, w - 16.0)))
                (self.body)
            }
            "\n"
        };
        page.0
    }

    /// Formats a figure of a page, in its colours.
    pub fn html(&self) -> Markup {
        html! {
            figure {
                "\n" figcaption { (self.title) } "\n"
                svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (WIDTH) " " (self.height) } role="img" aria-label=(self.title)
                    font-size=(FONT) { "\n" (self.body) } "\n"
            }
            "\n"
        }
    }
}

struct Area<'a> {
    left: f64,
    right: f64,
    bottom: f64,
    x: &'a Ruler,
    y: &'a Ruler,
}

impl Area<'_> {
    fn x(&self, value: f64) -> f64 {
        round(self.left + self.x.fraction(value) * (self.right - self.left))
    }

    fn y(&self, value: f64) -> f64 {
        round(self.bottom - self.y.fraction(value) * (self.bottom - TOP))
    }
}

/// Draws all figures.
pub fn all(analysis: &Analysis) -> Vec<Figure> {
    let of = |q: usize| {
        let responses = (0..analysis.factors.len()).filter_map(move |j| response(analysis, q, j));
        tornado(analysis, q).into_iter().chain(responses)
    };
    (0..analysis.results.len()).flat_map(of).collect()
}

/// Draws quantity `q` against parameter `j`; none without two results.
pub fn response(analysis: &Analysis, q: usize, j: usize) -> Option<Figure> {
    let (factor, result) = (&analysis.factors[j], &analysis.results[q]);
    let known = analysis.points.iter().filter_map(|p| {
        let [mean, _, error] = p.results[q];
        Some([p.values[j]?, mean?, error.unwrap_or(0.0)])
    });
    let points: Vec<[f64; 3]> = known.filter(|p| p[0].is_finite() && p[1].is_finite()).collect();
    if points.len() < 2 {
        return None;
    }
    let line: Vec<[f64; 2]> =
        analysis.sensitivities[q].responses[j].iter().copied().filter(|p| p[1].is_finite()).collect();
    let target = analysis.targets.iter().find(|t| t.quantity == q);
    let bars = points.iter().flat_map(|p| [p[1] - p[2], p[1] + p[2]]);
    let band = target.iter().flat_map(|t| [t.value - t.tolerance, t.value + t.tolerance]);
    let y = Ruler::linear(bars.chain(line.iter().map(|p| p[1])).chain(band), 6, 0.0, false);
    let x = match factor.log {
        true => Ruler::logarithmic(points.iter().map(|p| p[0])),
        false => {
            let margin = if factor.categories.is_empty() { 0.0 } else { 0.5 };
            let ends = points.iter().flat_map(|p| [p[0] - margin, p[0] + margin]);
            Ruler::linear(ends, 7, 2.0 * margin, false)
        }
    };
    let widest =
        y.ticks.iter().filter_map(|t| t.label.as_ref()).map(|l| text_width(l, FONT)).fold(0.0, f64::max);
    let area = Area { left: widest + 38.0, right: WIDTH - 24.0, bottom: RESPONSE - BOTTOM, x: &x, y: &y };
    let body = html! {
        (frame(&area, factor, &result.head()))
        @if let Some(target) = target { (target_band(&area, target)) }
        @for p in &points { (estimate(&area, p)) }
        @if line.len() > 1 { (curve(&area, &line, analysis.sampled)) }
        (key(&area, analysis, line.len() > 1, target.is_some()))
    };
    Some(Figure { title: format!("{} against {}", result.name, factor.name), height: RESPONSE, body })
}

fn frame(area: &Area<'_>, factor: &Factor, y_label: &str) -> Markup {
    let (left, right, bottom) = (round(area.left), round(area.right), area.bottom);
    let label = |value: f64, label: &Option<String>| match factor.categories.is_empty() {
        true => label.clone(),
        false => {
            let name = factor.categories.get((value.round() as usize).wrapping_sub(1)).cloned()?;
            let most = ((right - left) / factor.categories.len() as f64 / text_width("n", FONT)) as usize;
            Some(if name.chars().count() <= most { name } else { cut(&name, most) })
        }
    };
    let class = |label: &Option<String>| if label.is_some() { "major" } else { "minor" };
    let font = fitted(y_label, FONT, bottom - TOP);
    html! {
        @for tick in &area.x.ticks {
            path d={ "M" (area.x(tick.value)) " " (TOP) "V" (bottom) } class=(class(&tick.label)) {} "\n"
            @if let Some(label) = label(tick.value, &tick.label) {
                (text(area.x(tick.value), bottom + 17.0, "middle", &label, FONT))
            }
        }
        @for tick in &area.y.ticks {
            path d={ "M" (left) " " (area.y(tick.value)) "H" (right) } class=(class(&tick.label)) {} "\n"
            @if let Some(label) = &tick.label {
                (text(left - 7.0, area.y(tick.value) + 0.35 * FONT, "end", label, FONT))
            }
        }
        rect x=(left) y=(TOP) width=(round(right - left)) height=(round(bottom - TOP)) fill="none" class="frame" {} "\n"
        (text(0.5 * (left + right), bottom + 40.0, "middle", &factor.head(), FONT))
        g transform={ "translate(15 " (round(0.5 * (TOP + bottom))) ") rotate(-90)" } { (text(0.0, 0.0, "middle", y_label, font)) } "\n"
    }
}

fn cut(name: &str, most: usize) -> String {
    let kept: String = name.chars().take(most.saturating_sub(1).max(1)).collect();
    format!("{kept}…")
}

fn target_band(area: &Area<'_>, target: &Target) -> Markup {
    let (left, right) = (round(area.left), round(area.right));
    let (high, low) = (area.y(target.value + target.tolerance), area.y(target.value - target.tolerance));
    html! {
        rect x=(left) y=(high) width=(round(right - left)) height=(round(low - high)) fill=(COLOURS[2]) fill-opacity="0.15" {} "\n"
        path d={ "M" (left) " " (area.y(target.value)) "H" (right) } stroke=(COLOURS[2]) stroke-width="1.4" {} "\n"
    }
}

fn estimate(area: &Area<'_>, [x, mean, error]: &[f64; 3]) -> Markup {
    let at = area.x(*x);
    let (high, low) = (area.y(mean + error), area.y(mean - error));
    let (left, right) = (round(at - CAP), round(at + CAP));
    html! {
        @if *error > 0.0 {
            path d={ "M" (at) " " (low) "V" (high) "M" (left) " " (low) "H" (right) "M" (left) " " (high) "H" (right) }
                stroke=(COLOURS[0]) fill="none" {} "\n"
        }
        circle cx=(at) cy=(area.y(*mean)) r="3" fill=(COLOURS[0]) {} "\n"
    }
}

fn curve(area: &Area<'_>, line: &[[f64; 2]], dashed: bool) -> Markup {
    let pixels: Vec<String> = line.iter().map(|p| format!("{},{}", area.x(p[0]), area.y(p[1]))).collect();
    let dash = if dashed { "7 4" } else { "none" };
    html! {
        polyline points=(pixels.join(" ")) fill="none" stroke=(COLOURS[1]) stroke-width="1.6" stroke-dasharray=(dash) {} "\n"
    }
}

fn key(area: &Area<'_>, analysis: &Analysis, line: bool, target: bool) -> Markup {
    let curve = if analysis.sampled { "regression" } else { "mean" };
    let entries = [
        ("case ± standard error", COLOURS[0], true),
        (curve, COLOURS[1], line),
        ("target ± tolerance", COLOURS[2], target),
    ];
    let mut at = area.left;
    let mut placed = Vec::new();
    for (name, colour, _) in entries.iter().filter(|e| e.2) {
        placed.push((at, *name, *colour));
        at += 26.0 + text_width(name, SMALL);
    }
    html! {
        @for (at, name, colour) in placed {
            rect x=(round(at)) y=(TOP - 17.0) width="9" height="9" fill=(colour) {} "\n"
            (text(at + 13.0, TOP - 9.0, "start", name, SMALL))
        }
    }
}

/// Draws the effects on quantity `q`, largest first; none without effects.
pub fn tornado(analysis: &Analysis, q: usize) -> Option<Figure> {
    let (sensitivity, result) = (&analysis.sensitivities[q], &analysis.results[q]);
    let centre = sensitivity.centre.filter(|c| c.is_finite())?;
    let bars = bars(analysis, sensitivity);
    if bars.is_empty() {
        return None;
    }
    let values = || bars.iter().flat_map(|b| b.1.map(|e| e[1])).chain([centre]);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let margin = 0.15 * (high - low);
    let x = Ruler::linear([low - margin, high + margin].into_iter(), 6, 0.0, false);
    let widest = bars.iter().map(|b| text_width(&analysis.factors[b.0].head(), FONT)).fold(60.0, f64::max);
    let left = (widest + 14.0).min(0.45 * WIDTH);
    let height = TOP + ROW * bars.len() as f64 + BOTTOM;
    let area = Area { left, right: WIDTH - 24.0, bottom: height - BOTTOM, x: &x, y: &x };
    let body = html! {
        @for tick in &x.ticks {
            path d={ "M" (area.x(tick.value)) " " (TOP) "V" (area.bottom) } class="major" {} "\n"
            @if let Some(label) = &tick.label { (text(area.x(tick.value), area.bottom + 17.0, "middle", label, FONT)) }
        }
        @for (row, (j, ends)) in bars.iter().enumerate() {
            (bar(&area, row, &analysis.factors[*j], ends, centre))
        }
        path d={ "M" (area.x(centre)) " " (TOP) "V" (area.bottom) } class="frame" stroke-width="1.4" {} "\n"
        (text(0.5 * (area.left + area.right), area.bottom + 40.0, "middle", &result.head(), FONT))
        rect x=(round(left)) y=(TOP - 17.0) width="9" height="9" fill=(COLOURS[0]) {} "\n"
        (text(left + 13.0, TOP - 9.0, "start", "low end", SMALL))
        rect x=(round(left + 80.0)) y=(TOP - 17.0) width="9" height="9" fill=(COLOURS[1]) {} "\n"
        (text(left + 93.0, TOP - 9.0, "start", "high end", SMALL))
    };
    Some(Figure { title: format!("Effects on {}", result.name), height, body })
}

/// Parameters with results at both ends, largest effect first.
fn bars(analysis: &Analysis, sensitivity: &Sensitivity) -> Vec<(usize, [[f64; 2]; 2])> {
    let factors = analysis.factors.iter().enumerate();
    let mut bars: Vec<(usize, [[f64; 2]; 2])> =
        factors.filter_map(|(j, factor)| Some((j, sensitivity.ends(j, factor)?))).collect();
    let size = |bar: &(usize, [[f64; 2]; 2])| (bar.1[1][1] - bar.1[0][1]).abs();
    bars.sort_by(|a, b| size(b).total_cmp(&size(a)));
    bars
}

fn bar(area: &Area<'_>, row: usize, factor: &Factor, ends: &[[f64; 2]; 2], centre: f64) -> Markup {
    let top = round(TOP + ROW * row as f64 + 7.0);
    let height = ROW - 14.0;
    let base = round(top + 0.5 * height + 0.35 * FONT);
    let head = factor.head();
    let most = ((area.left - 14.0) / text_width("n", FONT)) as usize;
    let head = if head.chars().count() <= most { head } else { cut(&head, most) };
    html! {
        (text(area.left - 7.0, base, "end", &head, FONT))
        @for (end, colour) in ends.iter().zip([COLOURS[0], COLOURS[1]]) {
            @let (a, b) = (area.x(centre.min(end[1])), area.x(centre.max(end[1])));
            rect x=(a) y=(top) width=(round(b - a)) height=(height) fill=(colour) fill-opacity="0.85" {} "\n"
            @let (at, anchor) = if end[1] >= centre { (b + 4.0, "start") } else { (a - 4.0, "end") };
            (text(at, base, anchor, &number(factor, end[0]), SMALL))
        }
    }
}

fn number(factor: &Factor, value: f64) -> String {
    if factor.categories.is_empty() { minus(&factor.text(value)) } else { factor.text(value) }
}

fn fitted(label: &str, font: f64, space: f64) -> f64 {
    (font * (space / text_width(label, font).max(1.0)).min(1.0) * 10.0).floor() / 10.0
}

fn text(x: f64, y: f64, anchor: &str, content: &str, font: f64) -> Markup {
    html! { text x=(round(x)) y=(round(y)) text-anchor=(anchor) font-size=(font) { (content) } "\n" }
}
