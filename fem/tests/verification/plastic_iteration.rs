//! Nonlinear iteration: rate of convergence, variants, determinism, errors.

use crate::common::difference;
use crate::plastic_common::{Footing, footing, mohr_coulomb, tight};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::newmark::{Newmark, NewmarkSolver};
use trackbed_fem::nonlinear::{LinearMethod, NewtonOptions, QuasiStatic, StepControl, StepReport, Variant};
use trackbed_fem::theta::ThetaSolver;
use trackbed_fem::{Elastic, SolveError, State, statics};

const SOIL: Elastic = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };

fn small(psi: f64) -> Footing {
    footing(mohr_coulomb(SOIL, 10e3, 20.0, psi), [2, 4, 4])
}

/// State, pressure and step reports of a pushed footing.
fn push(
    footing: &Footing,
    options: NewtonOptions,
    control: StepControl,
    depth: f64,
) -> (State, f64, Vec<StepReport>, trackbed_fem::nonlinear::Statistics) {
    let mut state = State::new(&footing.model);
    let mut solver = QuasiStatic::new(&footing.model, options, control).unwrap();
    let mut reports = Vec::new();
    solver
        .integrate(&footing.model, &mut state, depth, &mut footing.loading(), &mut |_, report, _| {
            reports.push(report.clone())
        })
        .unwrap();
    (state, footing.pressure(solver.reactions()), reports, solver.statistics())
}

/// Order `log(r3/r2)/log(r2/r1)` of the last three residuals above rounding: about 2.
#[test]
fn full_newton_converges_quadratically() {
    for psi in [20.0, 5.0] {
        let options = NewtonOptions { force_tolerance: 1e-12, energy_tolerance: 1e-14, ..tight() };
        let (_, _, reports, _) = push(&small(psi), options, StepControl::fixed(0.004), 0.02);
        let mut orders = Vec::new();
        for report in reports.iter().filter(|r| r.plastic_points > 20) {
            let r: Vec<f64> = report.residuals.iter().copied().filter(|r| *r > 1e-13).collect();
            let [.., a, b, c] = r[..] else { continue };
            println!(
                "psi {psi}: {:?}",
                report.residuals.iter().map(|r| format!("{r:.1e}")).collect::<Vec<_>>()
            );
            // Region of convergence.
            if b < 1e-3 {
                orders.push((c / b).ln() / (b / a).ln());
                assert!(c <= 100.0 * b * b + 1e-5 * b, "{a:e} {b:e} {c:e}");
            }
        }
        println!("psi {psi}: orders {orders:.2?}");
        assert!(!orders.is_empty());
    }
}

#[test]
fn variants_agree() {
    let control = StepControl { initial: 0.002, min: 1e-5, max: 0.002, target_iterations: 400 };
    for psi in [20.0, 5.0] {
        let (exact, pressure, _, _) = push(&small(psi), tight(), control, 0.012);
        for variant in [Variant::Full, Variant::Modified(3), Variant::Modified(0), Variant::InitialStiffness]
        {
            for line_search in [true, false] {
                if variant == Variant::Modified(0) && !line_search {
                    continue;
                }
                let options = NewtonOptions {
                    line_search,
                    force_tolerance: 1e-8,
                    energy_tolerance: 1e-10,
                    max_iterations: 2000,
                    ..NewtonOptions::new(variant)
                };
                let (state, other, _, s) = push(&small(psi), options, control, 0.012);
                let miss = difference(&state.u, &exact.u);
                println!(
                    "psi {psi} {variant:?} line search {line_search}: u {miss:.1e}, force {:.1e}, {} steps, {} iterations, {} halvings",
                    (other / pressure - 1.0).abs(),
                    s.steps,
                    s.iterations,
                    s.halvings
                );
                // Halved steps follow the path more closely.
                let tolerance = if s.steps == 6 { 1e-5 } else { 1e-2 };
                assert!(miss < tolerance && (other / pressure - 1.0).abs() < tolerance);
            }
        }
        let krylov = NewtonOptions { linear: LinearMethod::Krylov, ..tight() };
        let (state, _, _, s) = push(&small(psi), krylov, control, 0.012);
        let miss = difference(&state.u, &exact.u);
        println!(
            "psi {psi} GMRES: u {miss:.1e}, {} iterations, {} of GMRES, {} failures",
            s.iterations, s.krylov_iterations, s.krylov_failures
        );
        assert!(
            miss < 1e-8
                && (psi == 20.0
                    || (s.krylov_iterations > 0 && s.factorizations_unsymmetric == s.krylov_failures))
        );
    }
}

#[test]
fn results_independent_of_thread_count() {
    let bits = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let footing = footing(mohr_coulomb(SOIL, 10e3, 20.0, 5.0), [3, 6, 8]);
            let (state, _, _, _) = push(&footing, NewtonOptions::default(), StepControl::fixed(0.004), 0.02);
            let points =
                state.points.iter().flat_map(|p| p.stress.iter().chain(&p.plastic_strain).chain([&p.kappa]));
            state.u.iter().chain(points).map(|x| x.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = bits(1);
    assert!(one == bits(2) && one == bits(3));
}

#[test]
fn failed_step_leaves_state_untouched() {
    let footing = small(5.0);
    let control = StepControl { initial: 0.004, min: 0.004, max: 0.004, target_iterations: 10 };
    let few = NewtonOptions { max_iterations: 2, ..tight() };
    let mut state = State::new(&footing.model);
    let mut solver = QuasiStatic::new(&footing.model, tight(), control).unwrap();
    solver.integrate(&footing.model, &mut state, 0.008, &mut footing.loading(), &mut |_, _, _| ()).unwrap();
    let before = state.clone();
    let mut failing = QuasiStatic::new(&footing.model, few, control).unwrap();
    let error = failing
        .integrate(&footing.model, &mut state, 0.016, &mut footing.loading(), &mut |_, _, _| ())
        .unwrap_err();
    println!("{error}");
    assert!(matches!(error, SolveError::Diverged { iterations: 2, time, .. } if time == 0.008), "{error}");
    assert_eq!(state, before);
    let mut other = before.clone();
    solver.integrate(&footing.model, &mut state, 0.012, &mut footing.loading(), &mut |_, _, _| ()).unwrap();
    let mut fresh = QuasiStatic::new(&footing.model, tight(), control).unwrap();
    fresh.integrate(&footing.model, &mut other, 0.012, &mut footing.loading(), &mut |_, _, _| ()).unwrap();
    assert_eq!(state, other);
}

#[test]
fn linear_solvers_refuse_plastic_materials() {
    let footing = small(5.0);
    let model = &footing.model;
    let plastic = |e: Option<SolveError>| matches!(e, Some(SolveError::Plastic { material: 1 }));
    assert!(plastic(statics::solve(model, &vec![0.0; model.dof_count()]).err()));
    assert!(plastic(NewmarkSolver::new(model, Newmark::AVERAGE_ACCELERATION, 1e-3).err()));
    assert!(plastic(NewmarkSolver::hht(model, -0.1, 1e-3).err()));
    assert!(plastic(ThetaSolver::new(model, 0.5, 1e-3).err()));
}

#[test]
fn unusable_options_and_states_are_refused() {
    let footing = small(5.0);
    let model = &footing.model;
    let control = StepControl::fixed(0.01);
    let with = |o: NewtonOptions| QuasiStatic::new(model, o, control).err();
    assert!(matches!(
        with(NewtonOptions { force_tolerance: 0.0, ..tight() }),
        Some(SolveError::Option { .. })
    ));
    assert!(matches!(with(NewtonOptions { max_iterations: 0, ..tight() }), Some(SolveError::Option { .. })));
    let bad = StepControl { min: -1.0, ..control };
    assert!(QuasiStatic::new(model, tight(), bad).is_err());
    let mut solver = QuasiStatic::new(model, tight(), control).unwrap();
    let mut state = State::new(model);
    state.points.resize(model.point_count() - 1, 0);
    let error =
        solver.integrate(model, &mut state, 1.0, &mut footing.loading(), &mut |_, _, _| ()).unwrap_err();
    assert!(matches!(error, SolveError::Length { .. }), "{error}");
    let mut state = State::new(model);
    let mut nan = |_: f64, load: &mut [f64]| load[5] = f64::NAN;
    let error = solver.integrate(model, &mut state, 1.0, &mut nan, &mut |_, _, _| ()).unwrap_err();
    assert!(matches!(error, SolveError::NotFinite { .. }), "{error}");
}

#[test]
fn an_elastic_model_takes_one_iteration() {
    let footing = footing(SOIL.into(), [2, 4, 4]);
    let (state, _, reports, _) = push(&footing, tight(), StepControl::fixed(0.01), 0.01);
    let linear = statics::StaticSolver::new(&footing.model).unwrap().solve_prescribed(
        &footing.model,
        &vec![0.0; footing.model.dof_count()],
        Some(&footing.pushed.iter().map(|p| if *p { -0.01 } else { 0.0 }).collect::<Vec<_>>()),
    );
    let linear = linear.unwrap();
    assert!(difference(&state.u, &linear.u) < 1e-12 && reports.len() == 1 && reports[0].iterations == 1);
}
