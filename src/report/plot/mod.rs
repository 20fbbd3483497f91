//! SVG plots with an HTML legend below, so that no text overlaps.
//!
//! Curves differ by colour (Okabe and Ito 2008), dashes and markers.

mod draw;
pub mod ruler;

use super::quantity::{Scale, scale};
use maud::{Markup, html};
use ruler::Ruler;

/// Axis.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// Quantity, such as `settlement`.
    pub name: String,
    /// SI unit; empty for counts and ratios.
    pub unit: String,
    /// Whether logarithmic.
    pub logarithmic: bool,
    /// Whether it increases downwards.
    pub downwards: bool,
    /// Whether it starts at zero.
    pub from_zero: bool,
    /// Whether values are counts with integer ticks.
    pub whole: bool,
}

impl Side {
    /// Creates a linear axis.
    pub fn new(name: &str, unit: &str) -> Side {
        Side { name: name.into(), unit: unit.into(), ..Side::default() }
    }

    /// Creates an axis of counts.
    pub fn count(name: &str) -> Side {
        Side { name: name.into(), whole: true, ..Side::default() }
    }

    /// Makes it logarithmic.
    pub fn logarithmic(self) -> Side {
        Side { logarithmic: true, ..self }
    }

    /// Makes it increase downwards.
    pub fn downwards(self) -> Side {
        Side { downwards: true, ..self }
    }

    /// Makes it start at zero.
    pub fn with_zero(self) -> Side {
        Side { from_zero: true, ..self }
    }

    fn label(&self, scale: &Scale) -> String {
        match scale.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }

    fn ruler(&self, values: impl Iterator<Item = f64>, most: usize, tight: bool) -> Ruler {
        match self.logarithmic {
            true => Ruler::logarithmic(values),
            false => {
                let least = if self.whole { 1.0 } else { 0.0 };
                Ruler::linear(values.chain(self.from_zero.then_some(0.0)), most, least, tight)
            }
        }
    }
}

/// Curve style.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// Colour index.
    pub colour: usize,
    /// Index of dashes and marker shape.
    pub dash: usize,
    /// Whether points are connected.
    pub line: bool,
    /// Whether points have markers.
    pub marks: bool,
}

/// Curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Legend entry, if not empty.
    pub name: String,
    /// Points (x, y) in SI units.
    pub points: Vec<[f64; 2]>,
    /// Style.
    pub look: Look,
}

/// Plot.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Horizontal axis.
    pub x: Side,
    /// Vertical axis.
    pub y: Side,
    /// Curves.
    pub curves: Vec<Curve>,
}

impl Plot {
    /// Creates a plot.
    pub fn new(title: &str, x: Side, y: Side, curves: Vec<Curve>) -> Plot {
        Plot { title: title.into(), x, y, curves }
    }

    /// Draws the figure; nothing without two valid points.
    pub fn figure(&self) -> Markup {
        let values = |d: usize| self.curves.iter().flat_map(move |c| c.points.iter().map(move |p| p[d]));
        let largest = |d: usize| values(d).filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
        let scales = [scale(&self.x.unit, largest(0)), scale(&self.y.unit, largest(1))];
        let [fx, fy] = [scales[0].factor, scales[1].factor];
        let x = self.x.ruler(values(0).map(|v| v * fx), 7, true);
        let y = self.y.ruler(values(1).map(|v| v * fy), 6, false);
        let shown = |p: &[f64; 2]| {
            let p = [p[0] * fx, p[1] * fy];
            (x.holds(p[0]) && y.holds(p[1])).then_some(p)
        };
        let curves: Vec<Curve> = self
            .curves
            .iter()
            .map(|c| Curve { points: c.points.iter().filter_map(shown).collect(), ..c.clone() })
            .filter(|c| !c.points.is_empty())
            .collect();
        if curves.iter().all(|c| c.points.len() < 2) {
            return Markup::default();
        }
        let labels = [self.x.label(&scales[0]), self.y.label(&scales[1])];
        let svg = draw::svg(&self.title, labels, (&x, &y, self.y.downwards), &curves);
        html! {
            figure {
                "\n" figcaption { (self.title) } "\n"
                (svg)
                (legend(&curves))
            }
            "\n"
        }
    }
}

fn legend(curves: &[Curve]) -> Markup {
    let named: Vec<&Curve> = curves.iter().filter(|c| !c.name.is_empty()).collect();
    html! {
        @if !named.is_empty() {
            ul class="legend" {
                "\n"
                @for curve in named { li { (draw::sample(curve.look)) (curve.name) } "\n" }
            }
            "\n"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figure_has_units_and_legend() {
        let curve = |name: &str, points: &[[f64; 2]], k| Curve {
            name: name.into(),
            points: points.to_vec(),
            look: Look { colour: k, dash: 0, line: true, marks: true },
        };
        let plot = Plot::new(
            "a < b",
            Side::new("cycle N", "").logarithmic(),
            Side::new("settlement", "m").downwards(),
            vec![
                curve("run <1>", &[[0.0, 0.0], [1.0, 0.01], [10.0, 0.03]], 0),
                curve("run 2", &[[1.0, f64::NAN], [2.0, 0.02]], 1),
            ],
        );
        let text = plot.figure().0;
        assert!(text.contains("settlement [mm]") && text.contains("cycle N") && text.contains("a &lt; b"));
        assert!(text.contains("run &lt;1&gt;") && !text.contains("NaN"), "{text}");
        assert_eq!(text.matches("<li>").count(), 2);
        // Deepest is lowest on the page.
        let line = text.split("<polyline points=\"").nth(1).unwrap().split('"').next().unwrap();
        let y: Vec<f64> = line.split(' ').map(|p| p.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert!(y.len() == 2 && y[1] > y[0], "{y:?}");
        assert_eq!(Plot::new("x", Side::default(), Side::default(), vec![curve("a", &[], 0)]).figure().0, "");
    }
}
