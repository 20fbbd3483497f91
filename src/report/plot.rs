//! Figures of plots, with an HTML legend below, so that no text overlaps.

use super::quantity::scale;
use maud::{Markup, PreEscaped, html};
use trackbed_io::plot::Plot;
pub use trackbed_io::plot::{Axis, Curve, Style};

/// Draws a figure of curves in SI units, with prefixes by magnitude; nothing without two valid points.
pub fn figure(title: &str, x: Axis, y: Axis, curves: Vec<Curve>) -> Markup {
    let mut plot = Plot { title: title.into(), x, y, curves, level: None };
    for (d, axis) in [&mut plot.x, &mut plot.y].into_iter().enumerate() {
        let values = || plot.curves.iter().flat_map(|c| c.points.iter().map(|p| p[d].abs()));
        let scale = scale(&axis.unit, values().filter(|v| v.is_finite()).fold(0.0, f64::max));
        axis.unit = scale.unit;
        plot.curves.iter_mut().flat_map(|c| &mut c.points).for_each(|p| p[d] *= scale.factor);
    }
    of_plot(&plot)
}

/// Draws the figure of a plot; nothing without two valid points.
pub fn of_plot(plot: &Plot) -> Markup {
    plot.inline().map_or_else(Markup::default, |inline| framed(&plot.title, &inline.svg, &inline.legend))
}

/// Adds title and legend (SVG sample, name) to an SVG element.
pub fn framed(title: &str, svg: &str, legend: &[(String, String)]) -> Markup {
    html! {
        figure {
            "\n" figcaption { (title) } "\n"
            (PreEscaped(svg))
            @if !legend.is_empty() {
                ul class="legend" {
                    "\n"
                    @for (sample, name) in legend {
                        li {
                            svg viewBox="0 0 34 12" width="34" height="12" aria-hidden="true" { (PreEscaped(sample)) }
                            (name)
                        }
                        "\n"
                    }
                }
                "\n"
            }
        }
        "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figure_has_units_and_legend() {
        let style = |k| Style { colour: k, dash: 0, line: true, marks: true };
        let curve = |name: &str, points: &[[f64; 2]], k| Curve::new(name, points.to_vec(), style(k));
        let curves = vec![
            curve("run <1>", &[[0.0, 0.0], [1.0, 0.01], [10.0, 0.03]], 0),
            curve("run 2", &[[1.0, f64::NAN], [2.0, 0.02]], 1),
        ];
        let (x, y) = (Axis::new("cycle N", "").logarithmic(), Axis::new("settlement", "m").downwards());
        let text = figure("a < b", x, y, curves).0;
        assert!(text.contains("settlement [mm]") && text.contains("cycle N") && text.contains("a &lt; b"));
        assert!(text.contains("run &lt;1&gt;") && !text.contains("NaN"), "{text}");
        assert_eq!(text.matches("<li>").count(), 2);
        assert!(text.contains(">30<"), "values in the unit of the axis: {text}");
        assert_eq!(figure("x", Axis::default(), Axis::default(), vec![curve("a", &[], 0)]).0, "");
    }
}
