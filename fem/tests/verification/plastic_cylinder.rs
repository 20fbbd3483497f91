//! Thick Mohr–Coulomb cylinder under internal pressure, plane strain.
//!
//! Closed form with the flow rule by quadrature (Hill 1950; Yu, Int. J. Numer. Anal. Methods Geomech. 16
//! (1992)); see case.json.

use crate::common::difference;
use crate::common::{model, read_mesh, table};
use crate::plastic_common::{mohr_coulomb, tight};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::{QuasiStatic, StepControl};
use trackbed_fem::{Elastic, Model, Quadrature, SolveError, State, loads, stress};

const SOIL: Elastic = Elastic { young: 80e6, poisson: 0.35, density: 2000.0 };
const LEVELS: [f64; 3] = [26000.40969747136, 36405.87317607287, 43316.796211670444];
const LIMIT: f64 = 49365.45446977625;

fn cylinder(psi: f64, rule: Quadrature) -> (Model, Vec<f64>) {
    let (mesh, constraints) = read_mesh("P3_thick_cylinder_mc");
    let model = model(mesh, constraints, mohr_coulomb(SOIL, 25e3, 25.0, psi), rule);
    let mut unit = vec![0.0; model.dof_count()];
    for element in [1, 9, 17, 25, 33, 41] {
        loads::face_pressure(model.mesh(), &model.mesh().face(element - 1, 4), 1.0, &mut unit);
    }
    (model, unit)
}

fn check(case: &str, psi: f64, wall: [f64; 3], rule: Quadrature) {
    let (model, unit) = cylinder(psi, rule);
    let mut pressure = |time: f64, load: &mut [f64]| {
        let p = time * LEVELS[2];
        load.iter_mut().zip(&unit).for_each(|(l, u)| *l = p * u);
    };
    let mut state = State::new(&model);
    let mut solver = QuasiStatic::new(&model, tight(), StepControl::fixed(0.1)).unwrap();
    let profile = table(case, "closed_form_profile.csv");
    for (level, (p, exact)) in LEVELS.into_iter().zip(wall).enumerate() {
        solver.integrate(&model, &mut state, p / LEVELS[2], &mut pressure, &mut |_, _, _| ()).unwrap();
        let radius = [0.6, 0.8, 1.0][level];
        let rows: Vec<&Vec<f64>> = profile.iter().filter(|r| r[0] == radius).collect();
        let exact_at = |r: f64, column: usize| {
            let k = rows.partition_point(|row| row[1] < r).clamp(1, rows.len() - 1);
            let (a, b) = (rows[k - 1], rows[k]);
            a[column] + (b[column] - a[column]) * (r - a[1]) / (b[1] - a[1])
        };
        let (mut u_miss, mut s_miss) = (0.0_f64, 0.0_f64);
        for (n, x) in model.mesh().coordinates.iter().enumerate() {
            let r = x[0].hypot(x[1]);
            let u = (state.u[3 * n] * x[0] + state.u[3 * n + 1] * x[1]) / r;
            if (r - 0.5).abs() < 1e-9 {
                u_miss = u_miss.max((u / exact - 1.0).abs());
            }
        }
        for e in 0..model.mesh().element_count() {
            let (x, s) = stress::centroid_of_points(&model, &state, e);
            let r = x[0].hypot(x[1]);
            let (c, n) = (x[0] / r, x[1] / r);
            let radial = s[0] * c * c + s[1] * n * n + 2.0 * s[3] * c * n;
            s_miss = s_miss.max((radial - exact_at(r, 2)).abs() / p);
        }
        println!("{case} {rule:?} p {p:.0}: u_a {u_miss:.1e}, radial stress {s_miss:.1e} of p");
        assert!(u_miss < 5e-3 && s_miss < 2e-2, "{case} level {level}: {u_miss:e} {s_miss:e}");
    }
    if rule == Quadrature::Gauss2 {
        let reference: Vec<f64> =
            table(case, "fe_displacement_2x2x2_last.csv").iter().flat_map(|r| r[1..4].to_vec()).collect();
        let miss = difference(&state.u, &reference);
        println!("{case}: displacement of the independent program {miss:.1e}");
        assert!(miss < 1e-6, "{miss:e}");
    }
    let s = solver.statistics();
    println!("{case} {rule:?}: {s:?}");
}

#[test]
fn associated() {
    let wall = [0.0002652713650909448, 0.0004371477541776971, 0.0006193686171384218];
    for rule in [Quadrature::Gauss2, Quadrature::Gauss3] {
        check("P3_thick_cylinder_mc", 25.0, wall, rule);
    }
}

#[test]
fn non_associated() {
    let wall = [0.0002682544109397361, 0.00046461964735363363, 0.0006949792986214717];
    for rule in [Quadrature::Gauss2, Quadrature::Gauss3] {
        check("P3_thick_cylinder_mc_nonassoc", 5.0, wall, rule);
    }
}

#[test]
fn no_equilibrium_above_the_limit_pressure() {
    let (model, unit) = cylinder(25.0, Quadrature::Gauss2);
    let mut pressure = |time: f64, load: &mut [f64]| {
        load.iter_mut().zip(&unit).for_each(|(l, u)| *l = time * LIMIT * u);
    };
    let mut state = State::new(&model);
    let control = StepControl { initial: 0.2, min: 0.002, max: 0.2, target_iterations: 8 };
    let mut solver = QuasiStatic::new(&model, Default::default(), control).unwrap();
    let mut accepted = state.clone();
    let error = solver
        .integrate(&model, &mut state, 2.0, &mut pressure, &mut |s, _, _| accepted.clone_from(s))
        .unwrap_err();
    println!("limit pressure reached: {:.4} of the closed form; {error}", state.time);
    assert!((state.time - 1.0).abs() < 0.01, "{}", state.time);
    let SolveError::Diverged { time, element, point, .. } = error else { panic!("{error}") };
    assert!(time == state.time && (1..=48).contains(&element) && (1..=8).contains(&point));
    assert_eq!(state, accepted);
}
