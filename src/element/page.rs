//! Page of element tests.

use super::check::Check;
use super::file::Kind;
use super::outcome::Outcome;
use super::point::{self, State};
use super::results::{self, PAGE};
use maud::Markup;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_report::page::{Cell, Section, headed, joined, paragraph, plots, table};
use trackbed_report::plot::{Axis, Curve, Style, figure};
use trackbed_report::{results_in, save};

const SIGNS: &str =
    "Effective stress and strain, compression positive. q: √(3 J₂), negative in axial extension.";

/// Most points of a curve.
const MOST_POINTS: usize = 2000;

/// Writes the page.
///
/// # Errors
/// I/O errors.
pub fn write(dir: &Path, name: &str, outcomes: &[Outcome]) -> Result<(), Failure> {
    let sections = [
        Section::new("curves", "Curves", joined([paragraph(SIGNS), curves(outcomes)])),
        Section::new("figures", "Figures", figures(outcomes)),
        Section::new("checks", "Checks", checks(outcomes)),
    ];
    let sections: Vec<Section> = sections.into_iter().flatten().collect();
    save(&dir.join(PAGE), name, &results_in(dir), &sections)
}

/// Plots of each test with the curves of all its materials.
fn curves(outcomes: &[Outcome]) -> Markup {
    let tests = outcomes.chunk_by(|a, b| a.test == b.test);
    joined(tests.map(|test| headed(&test[0].test, plots(of_test(test)))))
}

fn of_test(test: &[Outcome]) -> [Markup; 3] {
    let kind = test[0].kind;
    let curves = |point: &dyn Fn(&State) -> [f64; 2]| {
        let curve = |(k, outcome): (usize, &Outcome)| {
            let style = Style { colour: k, dash: k, line: true, marks: false };
            let (states, every) = (&outcome.states, outcome.states.len().div_ceil(MOST_POINTS));
            let shown = states[..states.len() - 1].iter().step_by(every).chain(states.last());
            Curve::new(outcome.material.clone(), shown.map(point).collect(), style)
        };
        test.iter().enumerate().map(curve).collect::<Vec<_>>()
    };
    let strain = |state: &State| 1e2 * point::abscissa(kind, state);
    let abscissa = || Axis::new(results::strain_name(kind), "%");
    let q = || Axis::new("q", "Pa");
    [
        figure("Deviatoric stress", abscissa(), q(), curves(&|s| [strain(s), s.q])),
        match kind {
            Kind::Undrained => {
                let pressure = Axis::new("excess pore pressure", "Pa");
                figure("Pore pressure", abscissa(), pressure, curves(&|s| [strain(s), s.pore_pressure]))
            }
            Kind::Oedometer => {
                let stress = Axis::new("vertical stress", "Pa");
                figure("Vertical stress", abscissa(), stress, curves(&|s| [strain(s), s.stress[2]]))
            }
            _ => {
                let volume = Axis::new("volumetric strain", "%");
                figure(
                    "Volumetric strain",
                    abscissa(),
                    volume,
                    curves(&|s| [strain(s), 1e2 * s.volumetric()]),
                )
            }
        },
        figure("Stress path", Axis::new("p", "Pa"), q(), curves(&|s| [s.p(), s.q])),
    ]
}

fn figures(outcomes: &[Outcome]) -> Markup {
    let heads = [
        "test, material",
        "peak q",
        "strain at peak [%]",
        "friction angle at peak [°]",
        "at end [°]",
        "stiffness at start",
        "at 50 % of peak",
        "dilation angle [°]",
        "pore pressure at end",
    ];
    let degrees = |angle: Option<f64>| Cell::of(angle.map(f64::to_degrees), "");
    let row = |outcome: &Outcome| {
        let f = &outcome.figures;
        let cells = vec![
            Cell::of(Some(f.peak_q), "Pa"),
            Cell::of(Some(1e2 * f.peak_strain), ""),
            degrees(f.friction_peak),
            degrees(f.friction_end),
            Cell::of(f.stiffness_start, "Pa"),
            Cell::of(f.stiffness_50, "Pa"),
            degrees(f.dilation),
            Cell::of(f.pore_pressure, "Pa"),
        ];
        (outcome.label(), cells)
    };
    table(&heads, &outcomes.iter().map(row).collect::<Vec<_>>())
}

fn checks(outcomes: &[Outcome]) -> Markup {
    let heads = ["test, material", "tangent", "dissipation", "objectivity", "steps"];
    let row = |outcome: &Outcome| {
        let line = |check: &Check| Cell::text(check.line());
        (outcome.label(), outcome.checks.iter().map(line).collect())
    };
    table(&heads, &outcomes.iter().map(row).collect::<Vec<_>>())
}
