//! Response plots and tornado charts, for files and pages.

use super::analysis::{Analysis, Sensitivity};
use super::factor::Factor;
use maud::Markup;
use trackbed_io::plot::axis::{Ends, cut};
use trackbed_io::plot::draw::{self, BOTTOM, COLOURS, FONT, Frame, round, text, text_width};
use trackbed_io::plot::{Axis, Curve, Level, Plot, Style, minus};
use trackbed_report::plot::{framed, of_plot};

const WIDTH: f64 = 560.0;
/// Space above the bars, for their legend [px].
const TOP: f64 = 34.0;
const ROW: f64 = 34.0;
const SMALL: f64 = 11.5;

/// Figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Title.
    pub title: String,
    /// SVG file.
    pub file: String,
    /// Figure of a page.
    pub html: Markup,
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
        Some(([p.values[j]?, mean?], error.unwrap_or(0.0)))
    });
    let (points, errors): (Vec<[f64; 2]>, Vec<f64>) =
        known.filter(|(p, _)| p.iter().all(|v| v.is_finite())).unzip();
    if points.len() < 2 {
        return None;
    }
    let marks = Style { marks: true, ..Style::default() };
    let line = Style { colour: 1, dash: usize::from(analysis.sampled), line: true, marks: false };
    let name = if analysis.sampled { "regression" } else { "mean" };
    let means = &analysis.sensitivities[q].responses[j];
    let means: Vec<[f64; 2]> = means.iter().copied().filter(|p| p[1].is_finite()).collect();
    let mut curves = vec![Curve { errors, ..Curve::new("case ± standard error", points, marks) }];
    curves.extend((means.len() > 1).then(|| Curve::new(name, means, line)));
    let target = analysis.targets.iter().find(|t| t.quantity == q);
    let level =
        target.map(|t| Level { name: "target ± tolerance".into(), y: t.value, tolerance: t.tolerance });
    let mut x = Axis::new(&factor.name, &factor.unit);
    (x.logarithmic, x.categories) = (factor.log, factor.categories.clone());
    let title = format!("{} against {}", result.name, factor.name);
    let plot = Plot { title, x, y: Axis::new(&result.name, &result.unit), curves, level };
    Some(Figure { file: plot.file(), html: of_plot(&plot), title: plot.title })
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
    let axis = Axis::new(&result.name, &result.unit);
    let x = axis.ruler([low - margin, high + margin].into_iter(), 6, Ends::Ticks);
    let widest = bars.iter().map(|b| text_width(&analysis.factors[b.0].head(), FONT)).fold(60.0, f64::max);
    let left = round((widest + 14.0).min(0.45 * WIDTH));
    let bottom = TOP + ROW * bars.len() as f64;
    let frame = Frame { left, right: WIDTH - 24.0, top: TOP, bottom, y: x.clone(), x };
    let mut svg = draw::x_axis(&frame, &axis.label());
    for (row, (j, ends)) in bars.iter().enumerate() {
        svg += &bar(&frame, row, &analysis.factors[*j], ends, centre);
    }
    let at = frame.x(centre);
    svg +=
        &format!("<path d=\"M{at} {TOP}V{bottom}\" class=\"frame\" stroke=\"#444\" stroke-width=\"1.4\"/>\n");
    for (at, name, colour) in [(left, "low end", COLOURS[0]), (left + 80.0, "high end", COLOURS[1])] {
        let y = TOP - 17.0;
        svg += &format!("<rect x=\"{at}\" y=\"{y}\" width=\"9\" height=\"9\" fill=\"{colour}\"/>\n");
        svg += &text([at + 13.0, TOP - 9.0], "start", SMALL, name);
    }
    let (title, size) = (format!("Effects on {}", result.name), [WIDTH, bottom + BOTTOM]);
    let html = framed(&title, &draw::inline(&title, size, &svg), &[]);
    Some(Figure { file: draw::file(&title, size, &svg), html, title })
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

fn bar(frame: &Frame, row: usize, factor: &Factor, ends: &[[f64; 2]; 2], centre: f64) -> String {
    let top = round(TOP + ROW * row as f64 + 7.0);
    let height = ROW - 14.0;
    let base = top + 0.5 * height + 0.35 * FONT;
    let head = cut(&factor.head(), ((frame.left - 14.0) / text_width("n", FONT)) as usize);
    let mut svg = text([frame.left - 7.0, base], "end", FONT, &head);
    for (end, colour) in ends.iter().zip(COLOURS) {
        let (a, b) = (frame.x(centre.min(end[1])), frame.x(centre.max(end[1])));
        let width = round(b - a);
        svg += &format!(
            "<rect x=\"{a}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"{colour}\" fill-opacity=\"0.85\"/>\n"
        );
        let (at, anchor) = if end[1] >= centre { (b + 4.0, "start") } else { (a - 4.0, "end") };
        svg += &text([at, base], anchor, SMALL, &number(factor, end[0]));
    }
    svg
}

fn number(factor: &Factor, value: f64) -> String {
    if factor.categories.is_empty() { minus(&factor.text(value)) } else { factor.text(value) }
}
