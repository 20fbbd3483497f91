//! Patch test on a distorted 2×2×2 block, tables `E1_*` of two independent programs.

use crate::common::{difference, model, read_mesh, table};
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::model::Model;
use trackbed_fem::statics::{self, StaticSolution};
use trackbed_fem::stress;

const GRADIENT: [[f64; 3]; 3] =
    [[0.001, 0.0002, -0.0003], [0.0005, -0.0007, 0.0001], [-0.0002, 0.0006, 0.0004]];
const STRESS: [f64; 6] = [
    35192.30769230769,
    -4038.4615384615354,
    21346.153846153844,
    8076.923076923076,
    8076.923076923076,
    -5769.2307692307695,
];

fn solve(case: &str, rule: Quadrature) -> (Model, StaticSolution) {
    let (mesh, constraints) = read_mesh(case);
    let model = model(mesh, constraints, Elastic { young: 30e6, poisson: 0.3, density: 2000.0 }, rule);
    let solution = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap();
    (model, solution)
}

/// To the 13 digits of the prescribed values.
fn linear(model: &Model) -> Vec<f64> {
    let at = |x: &[f64; 3]| GRADIENT.map(|g| g[0] * x[0] + g[1] * x[1] + g[2] * x[2]);
    model.mesh().coordinates.iter().flat_map(at).collect()
}

fn assert_patch_passes(case: &str, rule: Quadrature) {
    let (model, solution) = solve(case, rule);
    let miss = difference(&solution.u, &linear(&model));
    println!("{case} {rule:?}: displacement differs by {miss:.1e}");
    assert!(miss <= 1e-10, "{case}: {miss:e}");
    for e in 0..model.mesh().element_count() {
        for s in stress::gauss(&model, &solution.u, e) {
            assert!(difference(&s, &STRESS) <= 1e-9, "{case} element {e}: {s:?}");
        }
    }
    for s in stress::nodal(&model, &solution.u) {
        assert!(difference(&s, &STRESS) <= 1e-9, "{case}: {s:?}");
    }
    for k in 0..3 {
        let sum: f64 = solution.reactions.iter().skip(k).step_by(3).sum();
        assert!(sum.abs() < 1e-7, "reactions balance: {sum}");
    }
}

#[test]
fn straight_patch_passes_with_both_rules() {
    assert_patch_passes("E1_patch_straight", Quadrature::Gauss3);
    assert_patch_passes("E1_patch_straight", Quadrature::Gauss2);
}

#[test]
fn curved_patch_passes_under_full_integration() {
    assert_patch_passes("E1_patch_curved", Quadrature::Gauss3);
}

#[test]
fn reduced_integration_error_matches_other_programs() {
    let (model, solution) = solve("E1_patch_curved", Quadrature::Gauss2);
    let probes = [
        (26, [0.00054054519, -1.7476742e-05, 0.00021595113]),
        (37, [0.00040886609, 0.00012815142, 0.00016593745]),
        (40, [0.00024017166, -0.00014233126, 0.00032106847]),
    ];
    for (id, expected) in probes {
        let u = &solution.u[3 * (id - 1)..3 * id];
        assert!(difference(u, &expected) < 2e-8, "node {id}: {u:?}");
    }
    assert!(difference(&solution.u, &linear(&model)) > 1e-6);
}

#[test]
fn displacement_table_is_met() {
    for case in ["E1_patch_straight", "E1_patch_curved"] {
        let (_, solution) = solve(case, Quadrature::Gauss3);
        let reference: Vec<f64> =
            table(case, "reference_displacement.csv").iter().flat_map(|r| r[1..4].to_vec()).collect();
        assert!(difference(&solution.u, &reference) < 1e-9);
    }
}
