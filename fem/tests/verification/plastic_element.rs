//! One element under triaxial histories of an independent program.
//!
//! Tolerance: 1e-6 of the largest stress; 1e-8 of strain.

use crate::common::{model, read_mesh, table};
use crate::plastic_common::{drucker_prager, mohr_coulomb, tight};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::{LoadFunctions, QuasiStatic, StepControl};
use trackbed_fem::{Cone, Constraint, Elastic, Material, Quadrature, State, loads};

const CASE: &str = "P1_single_element";
const SOIL: Elastic = Elastic { young: 50e6, poisson: 0.3, density: 2000.0 };
const PRESSURE: f64 = 100e3;

/// Largest relative error of axial stress, and error of volumetric strain.
fn follow(file: &str, material: &Material, ratio: f64, rule: Quadrature) -> (f64, f64) {
    let rows = table(CASE, file);
    let (mesh, mut constraints) = read_mesh(CASE);
    let top: Vec<u32> = (0..20).filter(|&n| mesh.coordinates[n as usize][2] == 1.0).collect();
    constraints.extend(top.iter().map(|&node| Constraint { node, direction: 2, value: 0.0 }));
    let model = model(mesh, constraints, material.clone(), rule);
    let mut held = vec![0.0; model.dof_count()];
    loads::face_pressure(model.mesh(), &model.mesh().face(0, 2), PRESSURE, &mut held);
    loads::face_pressure(model.mesh(), &model.mesh().face(0, 3), ratio * PRESSURE, &mut held);
    let mut state = State::new(&model);
    for point in &mut state.points {
        point.stress = [-PRESSURE, -ratio * PRESSURE, -PRESSURE, 0.0, 0.0, 0.0];
    }
    let dofs: Vec<bool> =
        model.supports().fixed().iter().map(|(d, _)| d % 3 == 2 && top.contains(&(d / 3))).collect();
    let axial = |time: f64| rows[time.round() as usize][0];
    let mut loading = LoadFunctions {
        load: |_: f64, load: &mut [f64]| load.copy_from_slice(&held),
        prescribed: |time: f64, values: &mut [f64]| {
            values.iter_mut().zip(&dofs).filter(|(_, top)| **top).for_each(|(v, _)| *v = axial(time));
        },
    };
    let mut solver = QuasiStatic::new(&model, tight(), StepControl::fixed(1.0)).unwrap();
    let (mut stress, mut volume) = (0.0_f64, 0.0_f64);
    let largest = rows.iter().fold(0.0, |m: f64, r| m.max(r[1].abs()));
    for (step, row) in rows.iter().enumerate().skip(1) {
        solver.integrate(&model, &mut state, step as f64, &mut loading, &mut |_, _, _| ()).unwrap();
        for point in &state.points {
            let miss = |found: f64, expected: f64| (found - expected).abs() / largest;
            stress = stress.max(miss(point.stress[2], row[1])).max(miss(point.stress[0], row[2]));
        }
        let corner = 3 * (model.mesh().node_count() - 1);
        let found: f64 = state.u[corner..].iter().sum();
        volume = volume.max((found - row[row.len() - 1]).abs());
    }
    let s = solver.statistics();
    println!(
        "{file} {rule:?}: stress {stress:.1e}, volume strain {volume:.1e}; {} iterations in {} steps, {} halvings, L L^T {} L U {} singular {}",
        s.iterations,
        s.steps,
        s.halvings,
        s.factorizations_symmetric,
        s.factorizations_unsymmetric,
        s.singular
    );
    assert!(s.halvings == 0 && s.singular == 0);
    (stress, volume)
}

#[test]
fn seven_triaxial_histories() {
    let mc = mohr_coulomb(SOIL, 20e3, 30.0, 10.0);
    let dp = |cone| drucker_prager(SOIL, 20e3, 30.0, 10.0, cone);
    for (file, material, ratio) in [
        ("history_mc_compression.csv", &mc, 1.0),
        ("history_mc_extension.csv", &mc, 1.0),
        ("history_mc_true_triaxial.csv", &mc, 1.3),
        ("history_dp_outer_compression.csv", &dp(Cone::Compression), 1.0),
        ("history_dp_outer_extension.csv", &dp(Cone::Compression), 1.0),
        ("history_dp_inner_compression.csv", &dp(Cone::Extension), 1.0),
        ("history_dp_inner_extension.csv", &dp(Cone::Extension), 1.0),
    ] {
        for rule in [Quadrature::Gauss2, Quadrature::Gauss3] {
            let (stress, volume) = follow(file, material, ratio, rule);
            assert!(stress < 1e-6 && volume < 1e-8, "{file} {rule:?}: {stress:e} {volume:e}");
        }
    }
}
