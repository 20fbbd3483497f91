//! Static cases: cantilever (E2), railway embankment (E3), thick cylinder (E6).
//!
//! Tolerances: 1e-6 of the largest displacement, 1e-5 of the largest stress.

use crate::common::{difference, read_mesh, soils, table};
use std::collections::BTreeMap;
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::loads;
use trackbed_fem::material::{Elastic, Material};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::statics::{self, StaticSolution};
use trackbed_fem::stress;

struct Case {
    name: &'static str,
    materials: BTreeMap<u32, Material>,
    gravity: [f64; 3],
    /// Element number, SOLID186 face, and pressure [Pa] or traction [Pa].
    loads: Vec<(usize, usize, Surface)>,
    /// Probes of the 2×2×2 rule: node number, displacement.
    reduced: Vec<(usize, [f64; 3])>,
}

#[derive(Clone, Copy)]
enum Surface {
    Pressure(f64),
    Traction([f64; 3]),
}

fn solve(case: &Case, rule: Quadrature) -> (Model, Vec<f64>, StaticSolution) {
    let (mesh, constraints) = read_mesh(case.name);
    let model = Model::new(ModelInput {
        mesh,
        materials: case.materials.clone(),
        quadrature: rule,
        constraints,
        gravity: case.gravity,
        ..Default::default()
    })
    .unwrap();
    let mut load = model.gravity_load();
    for &(element, side, surface) in &case.loads {
        let face = model.mesh().face(element - 1, side - 1);
        match surface {
            Surface::Pressure(p) => loads::face_pressure(model.mesh(), &face, p, &mut load),
            Surface::Traction(t) => loads::face_traction(model.mesh(), &face, t, &mut load),
        }
    }
    let solution = statics::solve(&model, &load).unwrap();
    (model, load, solution)
}

/// Compares both rules with the tables; returns the full-rule solution.
fn assert_tables_met(case: &Case) -> (Model, Vec<f64>, StaticSolution) {
    let (model, load, solution) = solve(case, Quadrature::Gauss3);
    let reference: Vec<f64> =
        table(case.name, "reference_displacement.csv").iter().flat_map(|r| r[1..4].to_vec()).collect();
    let u = difference(&solution.u, &reference);

    let mut found = Vec::new();
    let mut expected = Vec::new();
    for row in table(case.name, "reference_stress_centroid.csv") {
        found.extend(stress::at_natural(&model, &solution.u, row[0] as usize - 1, [0.0; 3]));
        expected.extend_from_slice(&row[4..10]);
    }
    let centroid = difference(&found, &expected);
    found.clear();
    expected.clear();
    for row in table(case.name, "reference_stress_gauss2x2x2.csv") {
        found.extend(stress::at_natural(&model, &solution.u, row[0] as usize - 1, [row[1], row[2], row[3]]));
        expected.extend_from_slice(&row[7..13]);
    }
    let gauss = difference(&found, &expected);
    println!("{}: displacement {u:.1e}, stress {centroid:.1e} (centroids) {gauss:.1e} (points)", case.name);
    assert!(u <= 1e-6 && centroid <= 1e-5 && gauss <= 1e-5, "{}: {u:e} {centroid:e} {gauss:e}", case.name);

    let largest = load.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    for k in 0..3 {
        let sum = |f: &[f64]| f.iter().skip(k).step_by(3).sum::<f64>();
        assert!((sum(&load) + sum(&solution.reactions)).abs() < 1e-9 * largest, "balance of direction {k}");
    }

    let (_, _, soft) = solve(case, Quadrature::Gauss2);
    let size = soft.u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    for (id, probe) in &case.reduced {
        let miss = (0..3).fold(0.0, |m: f64, k| m.max((soft.u[3 * (id - 1) + k] - probe[k]).abs())) / size;
        println!("{}: node {id} with 2×2×2 points {miss:.1e}", case.name);
        assert!(miss < 2e-8, "{} node {id}: {miss:e}", case.name);
    }
    (model, load, solution)
}

#[test]
fn cantilever_bends_as_tabled() {
    let traction = Surface::Traction([0.0, 0.0, -166666.6666666667]);
    assert_tables_met(&Case {
        name: "E2_cantilever",
        materials: [(1, Elastic { young: 210e9, poisson: 0.3, density: 7850.0 }.into())].into(),
        gravity: [0.0; 3],
        loads: vec![(10, 3, traction), (20, 3, traction)],
        reduced: vec![(171, [3.1544232e-05, -3.9333427e-09, -0.00028356206])],
    });
}

#[test]
fn embankment_under_a_sleeper_load() {
    let faces = [451, 452, 453, 454, 459, 460, 461, 462];
    let (model, load, solution) = assert_tables_met(&Case {
        name: "E3_embankment_patch",
        materials: soils(),
        gravity: [0.0; 3],
        loads: faces.map(|e| (e, 6, Surface::Pressure(80e3))).to_vec(),
        reduced: vec![
            (2429, [0.0, 0.0, -0.00067554932]),
            (2442, [0.0, 3.3675381e-05, -0.00069216674]),
            (2455, [0.0, 6.7167722e-05, -0.00075138705]),
        ],
    });
    let energy = 0.5 * load.iter().zip(&solution.u).map(|(f, u)| f * u).sum::<f64>();
    assert!((energy / 120.6723115269802 - 1.0).abs() < 1e-9, "{energy}");
    let mut expected = vec![0.0; model.dof_count()];
    for row in table("E3_embankment_patch", "nodal_loads.csv") {
        expected[3 * (row[0] as usize - 1)..][..3].copy_from_slice(&row[1..4]);
    }
    assert!(difference(&load, &expected) < 1e-8);
}

#[test]
fn embankment_under_its_own_weight() {
    let (model, _, solution) = assert_tables_met(&Case {
        name: "E3_embankment_patchg",
        materials: soils(),
        gravity: [0.0, 0.0, -9.81],
        loads: Vec::new(),
        reduced: [2429, 2442, 2455].map(|id| (id, [0.0, 0.0, -0.0043810315])).to_vec(),
    });
    let weight: f64 = solution.reactions.iter().skip(2).step_by(3).sum();
    assert!((weight / 7553650.95 - 1.0).abs() < 1e-9, "{weight}");
    assert!((model.total_mass() * 9.81 / 7553650.95 - 1.0).abs() < 1e-9);
}

#[test]
fn thick_cylinder_widens_as_tabled() {
    let (model, _, solution) = assert_tables_met(&Case {
        name: "E6_thick_cylinder",
        materials: [(1, Elastic { young: 200e9, poisson: 0.3, density: 7850.0 }.into())].into(),
        gravity: [0.0; 3],
        loads: [1, 5, 9, 13, 17, 21].map(|e| (e, 5, Surface::Pressure(10e6))).to_vec(),
        reduced: vec![(1, [4.7669692e-05, 0.0, 0.0]), (9, [3.0333896e-05, 0.0, 0.0])],
    });
    let (young, nu, p, a, b) = (200e9, 0.3, 10e6, 0.5, 1.0);
    let mut worst: f64 = 0.0;
    for (n, x) in model.mesh().coordinates.iter().enumerate() {
        let r = x[0].hypot(x[1]);
        let exact = (1.0 + nu) / young * p * a * a / (b * b - a * a) * ((1.0 - 2.0 * nu) * r + b * b / r);
        let radial = (solution.u[3 * n] * x[0] + solution.u[3 * n + 1] * x[1]) / r;
        worst = worst.max((radial / exact - 1.0).abs());
    }
    println!("E6 against Lamé: {worst:.2e}");
    assert!(worst < 1e-4, "{worst}");
}
