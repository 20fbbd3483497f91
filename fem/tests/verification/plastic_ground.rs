//! Initial stress and factor of safety of a slope.

use crate::plastic_common::{mohr_coulomb, slab};
use std::collections::BTreeMap;
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::initial_stress::{self, Overburden};
use trackbed_fem::nonlinear::strength_reduction::{ReductionOptions, factor_of_safety};
use trackbed_fem::nonlinear::{NewtonOptions, QuasiStatic, StepControl};
use trackbed_fem::{
    Constraint, Elastic, Material, Mesh, Model, ModelInput, Quadrature, State, element::stiffness_points,
};

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Two soils, 2 m each, between smooth walls.
fn column(upper: Material, lower: Material) -> Model {
    let mut mesh = Mesh::block([2, 1, 4], [2.0, 1.0, 4.0]);
    for e in 0..mesh.element_count() {
        let middle: f64 =
            mesh.connectivity[e].iter().map(|n| mesh.coordinates[*n as usize][2]).sum::<f64>() / 20.0;
        mesh.materials[e] = if middle > 2.0 { 1 } else { 2 };
    }
    let mut constraints = Vec::new();
    for (node, x) in mesh.coordinates.iter().enumerate() {
        for (direction, at) in [(0, [0.0, 2.0]), (1, [0.0, 1.0]), (2, [0.0, -1.0])] {
            if at.contains(&x[direction]) {
                constraints.push(Constraint { node: node as u32, direction: direction as u8, value: 0.0 });
            }
        }
    }
    let materials = [(1, upper), (2, lower)].into();
    let quadrature = Quadrature::Gauss2;
    Model::new(ModelInput {
        mesh,
        materials,
        quadrature,
        constraints,
        gravity: GRAVITY,
        ..Default::default()
    })
    .unwrap()
}

/// Height and stress per point.
fn profile(model: &Model, state: &State) -> Vec<(f64, [f64; 6])> {
    let mesh = model.mesh();
    (0..mesh.element_count())
        .flat_map(|e| {
            let (x, points) = (
                mesh.element_coordinates(e),
                stiffness_points(mesh.connectivity.kind(e), model.quadrature()),
            );
            points.iter().enumerate().map(move |(i, p)| {
                let z = (0..20).map(|a| p.shape[a] * x[a][2]).sum();
                (z, state.points[model.point_start(e) + i].stress)
            })
        })
        .collect()
}

/// Overburden of 1800 over 2000 kg/m³.
fn vertical(z: f64) -> f64 {
    -9.81 * (1800.0 * (4.0 - z).min(2.0) + 2000.0 * (2.0 - z).max(0.0))
}

#[test]
fn layered_k0_state_is_in_equilibrium() {
    let soil = |density, phi| mohr_coulomb(Elastic { young: 20e6, poisson: 0.3, density }, 5e3, phi, 0.0);
    let model = column(soil(1800.0, 30.0), soil(2000.0, 25.0));
    let mut state = State::new(&model);
    let layers = Overburden::Layers(vec![(4.0, 1800.0), (2.0, 2000.0)]);
    let k0 = BTreeMap::from([(1, 0.5), (2, 0.6)]);
    let report = initial_stress::k0(&model, &mut state, &layers, &k0, NewtonOptions::default(), 1).unwrap();
    println!("K0: {report:?}");
    assert!(report.returned == 0 && report.largest_displacement < 1e-10 && state.u.iter().all(|u| *u == 0.0));
    for (z, s) in profile(&model, &state) {
        let (v, k) = (vertical(z), if z > 2.0 { 0.5 } else { 0.6 });
        assert!(
            (s[2] - v).abs() < 1e-6 * 80e3 && (s[0] - k * v).abs() < 1e-6 * 80e3 && s[3].abs() < 1.0,
            "{z} {s:?}"
        );
    }
}

#[test]
fn inadmissible_k0_returns_to_yield_surface() {
    let soil = |density| mohr_coulomb(Elastic { young: 20e6, poisson: 0.3, density }, 0.1, 30.0, 0.0);
    let model = column(soil(1800.0), soil(2000.0));
    let mut state = State::new(&model);
    let layers = Overburden::Layers(vec![(4.0, 1800.0), (2.0, 2000.0)]);
    let k0 = BTreeMap::from([(1, 0.1), (2, 0.1)]);
    let report = initial_stress::k0(&model, &mut state, &layers, &k0, NewtonOptions::default(), 1).unwrap();
    println!("K0 below the active state: {report:?}");
    assert!(report.returned == model.point_count() && report.largest_displacement > 1e-5);
    for (z, s) in profile(&model, &state) {
        assert!((s[2] / vertical(z) - 1.0).abs() < 1e-3, "{z} {s:?}");
        // Between Rankine's active state and rest.
        assert!(s[0] / s[2] > 1.0 / 3.0 - 1e-3 && s[0] / s[2] < 1.0, "{z} {s:?}");
    }
}

/// K0 = `nu/(1 - nu)` between smooth walls.
#[test]
fn gravity_does_not_move_k0_state() {
    let soil = |density| mohr_coulomb(Elastic { young: 20e6, poisson: 0.3, density }, 5e5, 30.0, 0.0);
    let model = column(soil(1800.0), soil(2000.0));
    let mut state = State::new(&model);
    let report = initial_stress::turn_on_gravity(&model, &mut state, NewtonOptions::default(), 4).unwrap();
    assert!(
        report.largest_displacement > 1e-3
            && state.u.iter().all(|u| *u == 0.0)
            && report.statistics.steps == 4
    );
    for (z, s) in profile(&model, &state) {
        assert!(
            (s[2] / vertical(z) - 1.0).abs() < 1e-9 && (s[0] / s[2] - 3.0 / 7.0).abs() < 1e-9,
            "{z} {s:?}"
        );
    }
    let weight = model.gravity_load();
    let mut on = |_: f64, load: &mut [f64]| load.copy_from_slice(&weight);
    let mut solver = QuasiStatic::new(&model, NewtonOptions::default(), StepControl::fixed(1.0)).unwrap();
    solver.integrate(&model, &mut state, 1.0, &mut on, &mut |_, _, _| ()).unwrap();
    assert!(state.u.iter().all(|u| u.abs() < 1e-12));
    // Uniform stress outside the yield surface.
    let mut other = State::new(&model);
    let soft = column(
        mohr_coulomb(Elastic { young: 20e6, poisson: 0.3, density: 1.0 }, 1e3, 0.0, 0.0),
        mohr_coulomb(Elastic { young: 20e6, poisson: 0.3, density: 1.0 }, 1e6, 0.0, 0.0),
    );
    let returned = initial_stress::set_uniform(&soft, &mut other, [-1e4, -1e4, -3e4, 0.0, 0.0, 0.0]).unwrap();
    assert_eq!(returned, soft.point_count() / 2);
    assert!(initial_stress::set_k0(&model, &mut other, &Overburden::Level(4.0), &[(1, 0.5)].into()).is_err());
}

/// Griffiths and Lane (1999), example 1: slope 2:1, phi = 20°, c = 0.05 gamma H, psi = 0, no foundation
/// layer, gravity in one step. Factor 1.4 (Bishop and Morgenstern: 1.380).
#[test]
fn slope_of_griffiths_and_lane() {
    let (height, density): (f64, f64) = (10.0, 2000.0);
    let gamma = 9.81 * density;
    let lines = |n: usize| (0..=n).map(|i| i as f64 / n as f64).collect::<Vec<_>>();
    let mut mesh = slab(&lines(10), &lines(6), 1.0);
    for x in &mut mesh.coordinates {
        let z = height * x[2];
        *x = [x[0] * (1.2 * height + 2.0 * (height - z)), x[1], z];
    }
    let mut constraints = Vec::new();
    for (node, x) in mesh.coordinates.iter().enumerate() {
        let directions: &[u8] = match (x[2] == 0.0, x[0] == 0.0) {
            (true, _) => &[0, 1, 2],
            (_, true) => &[0, 1],
            _ => &[1],
        };
        constraints.extend(directions.iter().map(|&direction| Constraint {
            node: node as u32,
            direction,
            value: 0.0,
        }));
    }
    let soil = mohr_coulomb(Elastic { young: 1e8, poisson: 0.3, density }, 0.05 * gamma * height, 20.0, 0.0);
    let materials = [(1, soil)].into();
    let model =
        Model::new(ModelInput { mesh, materials, constraints, gravity: GRAVITY, ..Default::default() })
            .unwrap();
    let control = StepControl { min: 1.0 / 8.0, ..ReductionOptions::default().control };
    let options = ReductionOptions { tolerance: 0.06, control, ..Default::default() };
    let found = factor_of_safety(&model, &State::new(&model), &model.gravity_load(), &options).unwrap();
    for t in &found.trials {
        let size = 1e8 * t.largest_displacement / (gamma * height * height);
        println!(
            "slope: F {:.3} {} share {:.3}, {} iterations, E u/(gamma H²) {size:.3}",
            t.factor, t.converged, t.share, t.iterations
        );
    }
    println!("slope: factor of safety between {} and {}", found.converged, found.failed);
    assert!(found.failed - found.converged <= 0.07);
    assert!(found.converged > 1.30 && found.failed < 1.46, "{found:?}");
    assert!(found.trials.windows(2).all(|t| t[0].converged || !t[1].converged));
}
