//! Strip footing on weightless soil, with the cost of the Newton variants.
//!
//! `Nc = (tan²(45° + phi/2) exp(pi tan phi) - 1) cot phi`, `2 + pi` for phi = 0 (Prandtl 1920).

use crate::common::difference;
use crate::common::model;
use crate::plastic_common::{cpu_seconds, footing, mohr_coulomb};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::{LoadFunctions, NewtonOptions, QuasiStatic, StepControl, Variant};
use trackbed_fem::{Constraint, Elastic, Mesh, Quadrature, State};

const SOIL: Elastic = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
const COHESION: f64 = 10e3;

fn variants() -> Vec<(&'static str, NewtonOptions)> {
    let with = |variant, line_search| NewtonOptions { line_search, ..NewtonOptions::new(variant) };
    vec![
        ("full", with(Variant::Full, false)),
        ("full, line search", with(Variant::Full, true)),
        ("modified 0, line search", with(Variant::Modified(0), true)),
        ("modified 3, line search", with(Variant::Modified(3), true)),
        ("elastic, line search", with(Variant::InitialStiffness, true)),
    ]
}

#[test]
#[ignore = "prints the cost of the variants, a minute"]
fn cost_of_the_variants() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(table_of_costs);
}

fn table_of_costs() {
    for (phi, psi, end) in [(0.0, 0.0, 0.04), (20.0, 20.0, 0.25), (20.0, 0.0, 0.25)] {
        let mut reference = None;
        for (name, options) in variants() {
            let footing = footing(mohr_coulomb(SOIL, COHESION, phi, psi), [4, 7, 9]);
            let mut state = State::new(&footing.model);
            let control = StepControl {
                initial: end / 20.0,
                min: end / 1000.0,
                max: end / 20.0,
                target_iterations: 12,
            };
            let control = if options.variant == Variant::InitialStiffness {
                StepControl { target_iterations: 200, ..control }
            } else {
                control
            };
            let mut solver = QuasiStatic::new(&footing.model, options, control).unwrap();
            let start = cpu_seconds();
            let outcome =
                solver.integrate(&footing.model, &mut state, end, &mut footing.loading(), &mut |_, _, _| ());
            let cpu = cpu_seconds() - start;
            let s = solver.statistics();
            let factor = footing.pressure(solver.reactions()) / COHESION;
            let miss = difference(&state.u, reference.get_or_insert_with(|| state.u.clone()));
            println!(
                "phi {phi} psi {psi} {name}: q/c {factor:.4} at {:.4} m{}, u {miss:.1e}; {} steps {} halvings {} iterations {} evaluations {} L L^T {} L U, {} not positive, {} singular; CPU {cpu:.2} s",
                state.time,
                if outcome.is_ok() { "" } else { " STOPPED" },
                s.steps,
                s.halvings,
                s.iterations,
                s.evaluations,
                s.factorizations_symmetric,
                s.factorizations_unsymmetric,
                s.not_positive,
                s.singular
            );
        }
    }
}

#[test]
fn footing_on_clay_reaches_its_plateau() {
    let footing = footing(mohr_coulomb(SOIL, COHESION, 0.0, 0.0), [5, 8, 9]);
    let mut state = State::new(&footing.model);
    let control = StepControl { initial: 0.004, min: 1e-5, max: 0.01, target_iterations: 10 };
    let mut solver = QuasiStatic::new(&footing.model, NewtonOptions::default(), control).unwrap();
    let mut factors = Vec::new();
    for depth in [0.05, 0.1, 0.15] {
        solver
            .integrate(&footing.model, &mut state, depth, &mut footing.loading(), &mut |_, _, _| ())
            .unwrap();
        factors.push(footing.pressure(solver.reactions()) / COHESION);
    }
    let exact = 2.0 + std::f64::consts::PI;
    println!("footing: q/c {factors:.4?}, Prandtl {exact:.4}; {:?}", solver.statistics());
    assert!(factors[2] > exact && factors[2] < 1.10 * exact, "{factors:?}");
    assert!((factors[2] / factors[1] - 1.0).abs() < 3e-3, "not a plateau: {factors:?}");
}

#[test]
#[ignore = "prints the cost of unsymmetric systems, a minute"]
fn cost_of_unsymmetric_systems() {
    use trackbed_fem::nonlinear::LinearMethod;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for side in [10, 14] {
            for (psi, linear) in
                [(20.0, LinearMethod::Direct), (5.0, LinearMethod::Direct), (5.0, LinearMethod::Krylov)]
            {
                let mesh = Mesh::block([side, side, side * 7 / 10], [5.0, 5.0, 3.5]);
                let mut constraints = Vec::new();
                for (n, x) in mesh.coordinates.iter().enumerate() {
                    let pushed = x[2] == 3.5 && x[0] <= 1.0 && x[1] <= 1.0;
                    for (direction, held) in [
                        (0, x[0] == 0.0 || x[0] == 5.0 || x[2] == 0.0 || pushed),
                        (1, x[1] == 0.0 || x[1] == 5.0 || x[2] == 0.0 || pushed),
                        (2, x[2] == 0.0 || pushed),
                    ] {
                        if held {
                            constraints.push(Constraint { node: n as u32, direction, value: 0.0 });
                        }
                    }
                }
                let model = model(mesh, constraints, mohr_coulomb(SOIL, COHESION, 20.0, psi), Quadrature::Gauss2);
                let pushed: Vec<bool> = model
                    .supports()
                    .fixed()
                    .iter()
                    .map(|(d, _)| d % 3 == 2 && model.mesh().coordinates[*d as usize / 3][2] == 3.5)
                    .collect();
                let mut loading = LoadFunctions {
                    load: |_: f64, _: &mut [f64]| (),
                    prescribed: |time: f64, values: &mut [f64]| {
                        values.iter_mut().zip(&pushed).filter(|(_, p)| **p).for_each(|(v, _)| *v = -time);
                    },
                };
                let options = NewtonOptions { linear, ..NewtonOptions::default() };
                let mut state = State::new(&model);
                let mut solver = QuasiStatic::new(&model, options, StepControl::fixed(0.02)).unwrap();
                let start = cpu_seconds();
                let outcome = solver.integrate(&model, &mut state, 0.1, &mut loading, &mut |_, _, _| ());
                let s = solver.statistics();
                println!(
                    "{} free dofs, psi {psi} {linear:?}: {} steps{}, {} iterations, {} halvings, {} L L^T, {} L U, {} of GMRES ({} failed); CPU {:.1} s of which assembly {:.1} factor {:.1} solve {:.1} (clock)",
                    model.free_dof_count(), s.steps, if outcome.is_ok() { "" } else { " STOPPED" }, s.iterations, s.halvings,
                    s.factorizations_symmetric, s.factorizations_unsymmetric, s.krylov_iterations, s.krylov_failures,
                    cpu_seconds() - start, s.assembly_seconds, s.factor_seconds, s.solve_seconds
                );
            }
        }
    });
}
