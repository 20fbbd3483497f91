//! Newton variants on a rough rigid footing, and the cost of non-dilatant flow.
//!
//! Table 1: strip footing (phi = 20°, c = 10 kPa, E/c = 1000), 144 elements; psi = phi to 0.25 half widths in
//! 20 steps, psi = 0 to 0.12 in 40; force tolerance 1e-4. `q/c` with the settlement at failure. Table 2:
//! square footing, two plastic steps; CPU seconds per step and iteration: psi = phi (L L^T), psi = 0 (L U,
//! GMRES on the elastic factor).
//!
//! One thread, CPU time. `cargo bench --bench newton` (two minutes); `-- large`: 54,000 equations (minutes
//! more), `-- coarse`: 60 elements.

#[path = "../fem/tests/verification/collapse_common.rs"]
mod collapse_common;
#[path = "common/watch.rs"]
mod watch;

use collapse_common::{Footing, Ground, loose, mohr_coulomb, push};
use trackbed_fem::nonlinear::{LinearMethod, NewtonOptions, Variant};
use trackbed_fem::{Elastic, ElementKind};
use watch::Watch;

const SOIL: Elastic = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
const COHESION: f64 = 10e3;
const PHI: f64 = 20.0;

fn main() {
    let has = |word: &str| std::env::args().any(|a| a == word);
    let pool = watch::pool(1);
    pool.install(|| {
        variants(if has("coarse") { 0.25 } else { 0.125 }, if has("coarse") { 1.4 } else { 1.3 });
        dilation(0.25, 2.5);
        if has("large") {
            dilation(0.125, 2.0);
        }
    });
}

fn variants(first: f64, ratio: f64) {
    let ground = Ground { kind: ElementKind::Hex20, first, ratio, extent: [8.0, 4.0], square: false };
    println!(
        "{:>4} {:<12} {:<6} {:<6} {:>8} {:>8} {:>6} {:>6} {:>7} {:>7} {:>6} {:>6} {:>8}",
        "psi",
        "matrix",
        "search",
        "solver",
        "q/c",
        "at [m]",
        "steps",
        "halved",
        "iterat.",
        "evals",
        "LL^T",
        "LU",
        "CPU [s]"
    );
    for (psi, settlement, stations) in [(PHI, 0.25, 20), (0.0, 0.12, 40)] {
        for (name, variant) in [
            ("full", Variant::Full),
            ("modified", Variant::Modified(0)),
            ("modified(3)", Variant::Modified(3)),
            ("elastic", Variant::InitialStiffness),
        ] {
            for line_search in [true, false] {
                let solvers: &[LinearMethod] = if psi == PHI || variant == Variant::InitialStiffness {
                    &[LinearMethod::Direct]
                } else {
                    &[LinearMethod::Direct, LinearMethod::Krylov]
                };
                for &linear in solvers {
                    let usual = NewtonOptions::new(variant);
                    let options = NewtonOptions {
                        variant,
                        line_search,
                        linear,
                        max_iterations: usual.max_iterations.max(loose().max_iterations),
                        ..loose()
                    };
                    let footing = Footing::new(&ground, mohr_coulomb(SOIL, COHESION, PHI, psi));
                    let mut watch = Watch::default();
                    let course = watch.time(|| push(&footing, options, settlement, stations));
                    let s = course.statistics;
                    println!(
                        "{psi:>4} {name:<12} {:<6} {:<6} {:>8.3} {:>8} {:>6} {:>6} {:>7} {:>7} {:>6} {:>6} {:>8.2}",
                        if line_search { "yes" } else { "no" },
                        format!("{linear:?}").to_lowercase(),
                        course.factor(COHESION),
                        if course.stopped.is_some() {
                            format!("{:.4}", course.settlement)
                        } else {
                            "end".into()
                        },
                        s.steps,
                        s.halvings,
                        s.iterations,
                        s.evaluations,
                        s.factorizations_symmetric,
                        s.factorizations_unsymmetric,
                        watch.cpu
                    );
                }
            }
        }
    }
}

fn dilation(first: f64, depth: f64) {
    let ground =
        Ground { kind: ElementKind::Hex20, first, ratio: 1.0001, extent: [2.0, depth], square: true };
    let mut reference = None;
    for (name, psi, linear) in [
        ("psi = phi, L L^T", PHI, LinearMethod::Direct),
        ("psi = 0, L U", 0.0, LinearMethod::Direct),
        ("psi = 0, GMRES", 0.0, LinearMethod::Krylov),
    ] {
        let footing = Footing::new(&ground, mohr_coulomb(SOIL, COHESION, PHI, psi));
        let mut watch = Watch::default();
        let options = NewtonOptions { linear, ..loose() };
        let course = watch.time(|| push(&footing, options, 0.02, 2));
        let s = course.statistics;
        let (step, iteration) = (watch.cpu / s.steps as f64, watch.cpu / s.iterations as f64);
        let base = *reference.get_or_insert((step, iteration));
        println!(
            "{} elements, {} equations, {name}: q/c {:.3}, {} steps, {} iterations, {step:.2} s per step ({:.2}), {iteration:.3} s per iteration ({:.2})",
            footing.model.mesh().element_count(),
            footing.model.free_dof_count(),
            course.factor(COHESION),
            s.steps,
            s.iterations,
            step / base.0,
            iteration / base.1
        );
    }
}
