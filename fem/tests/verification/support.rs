//! Insufficient constraints, prescribed displacements, extreme numbers.

use crate::common::{fix, model};
use trackbed_fem::ElementKind;
use trackbed_fem::SolveError;
use trackbed_fem::element::quadrature::Quadrature::{Gauss2, Gauss3};
use trackbed_fem::loads;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::statics;

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

#[test]
fn rejects_sliding_body() {
    let mesh = Mesh::block([3, 2, 2], [3.0, 2.0, 2.0]);
    let constraints = fix(&mesh, &[0, 2], |x| x[2] == 0.0);
    let model = model(mesh, constraints, SOIL, Gauss3);
    let error = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap_err();
    assert!(matches!(error, SolveError::RigidBodyMotion { direction: "y", .. }), "{error}");
    assert!(
        error.to_string().starts_with("insufficiently constrained: rigid-body motion of node "),
        "{error}"
    );
}

/// Two blocks, one above the other, joined along one edge, on a fixed base.
fn hinged(size: f64) -> Mesh {
    let mut mesh = Mesh::block([2, 1, 2], [2.0 * size, size, 2.0 * size]);
    for list in [&mut mesh.element_ids, &mut mesh.materials] {
        *list = vec![list[0], list[3]];
    }
    let all = std::mem::take(&mut mesh.connectivity);
    mesh.connectivity.push(ElementKind::Hex20, &all[0]);
    mesh.connectivity.push(ElementKind::Hex20, &all[3]);
    let mut index = vec![u32::MAX; mesh.node_count()];
    let mut kept = Vec::new();
    for node in mesh.connectivity.nodes_mut() {
        if index[*node as usize] == u32::MAX {
            index[*node as usize] = kept.len() as u32;
            kept.push(mesh.coordinates[*node as usize]);
        }
        *node = index[*node as usize];
    }
    mesh.node_ids = (1..=kept.len() as u32).collect();
    mesh.coordinates = kept;
    mesh
}

#[test]
fn rejects_hinge() {
    let (mut tiny, mut negative) = (0, 0);
    for n in 1..=20 {
        let size = 0.1 * f64::from(n);
        let mesh = hinged(size);
        let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
        let soil = Elastic { poisson: 0.02 * f64::from(n), ..SOIL };
        let model = model(mesh, constraints, soil, Gauss3);
        let error = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap_err();
        let SolveError::NoStiffness { node, pivot, .. } = error else { panic!("{error}") };
        let x = model.mesh().coordinates[node as usize - 1];
        assert!(x[0] >= 0.99 * size && x[2] >= 0.99 * size, "{error}: {x:?}");
        if pivot > 0.0 { tiny += 1 } else { negative += 1 }
    }
    println!("hinges: {tiny} tiny pivots, {negative} that are not positive");
    assert!(tiny > 0);
}

#[test]
fn rejects_zero_energy_mode() {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let at = |x: [f64; 3]| mesh.coordinates.iter().position(|c| *c == x).unwrap() as u32;
    let (o, a, b) = (at([0.0; 3]), at([1.0, 0.0, 0.0]), at([0.0, 1.0, 0.0]));
    let constraints: Vec<Constraint> = [(o, 0), (o, 1), (o, 2), (a, 1), (a, 2), (b, 2)]
        .map(|(node, direction)| Constraint { node, direction, value: 0.0 })
        .to_vec();
    let solve = |rule| {
        let model = model(mesh.clone(), constraints.clone(), SOIL, rule);
        let mut load = vec![0.0; model.dof_count()];
        loads::face_pressure(model.mesh(), &model.mesh().face(0, 5), 1e3, &mut load);
        loads::face_pressure(model.mesh(), &model.mesh().face(0, 0), 1e3, &mut load);
        statics::solve(&model, &load)
    };
    let error = solve(Gauss2).unwrap_err();
    assert!(matches!(error, SolveError::NoStiffness { .. }), "{error}");
    let top = at([1.0; 3]) as usize;
    assert!((solve(Gauss3).unwrap().u[3 * top + 2] + 1e3 / 20e6).abs() < 1e-13);
}

#[test]
fn reduced_column_needs_two_elements() {
    let solve = |counts: [usize; 3], rule| {
        let mesh = Mesh::block(counts, counts.map(|n| n as f64));
        let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
        let model = model(mesh, constraints, SOIL, rule);
        let mut load = vec![0.0; model.dof_count()];
        let last = model.mesh().element_count() - 1;
        loads::face_pressure(model.mesh(), &model.mesh().face(last, 5), 1e3, &mut load);
        statics::solve(&model, &load)
    };
    for height in [1, 3, 20] {
        let error = solve([1, 1, height], Gauss2).unwrap_err();
        assert!(matches!(error, SolveError::NoStiffness { .. }), "{error}");
        assert!(solve([1, 1, height], Gauss3).is_ok());
        assert!(solve([2, 1, height], Gauss2).is_ok());
    }
}

#[test]
fn prescribed_displacement_stretches_a_bar() {
    let mesh = Mesh::block([4, 1, 1], [4.0, 0.5, 0.5]);
    let mut constraints = fix(&mesh, &[0], |x| x[0] == 0.0);
    constraints.extend(fix(&mesh, &[1], |x| x[1] == 0.0));
    constraints.extend(fix(&mesh, &[2], |x| x[2] == 0.0));
    constraints.extend(fix(&mesh, &[0], |x| x[0] == 4.0).iter().map(|c| Constraint { value: 2e-3, ..*c }));
    let model = model(mesh, constraints, SOIL, Gauss2);
    let solution = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap();
    let pull: f64 = (0..model.mesh().node_count())
        .filter(|&n| model.mesh().coordinates[n][0] == 4.0)
        .map(|n| solution.reactions[3 * n])
        .sum();
    assert!((pull / (20e6 * 5e-4 * 0.25) - 1.0).abs() < 1e-12, "{pull}");
    let far = model.mesh().node_count() - 1;
    assert!((solution.u[3 * far + 1] + 0.3 * 5e-4 * 0.5).abs() < 1e-15);
}

#[test]
fn extreme_numbers_are_solved_not_refused() {
    for (young, poisson, size) in [
        (20e6, 0.4999, [1.0, 1.0, 1.0]),
        (20e6, 0.0, [100.0, 100.0, 1.0]),
        (1e-6, 0.3, [1e-4, 1e-4, 1e-4]),
        (1e15, 0.3, [1e4, 1e4, 1e4]),
        (20e6, -0.9, [1.0, 1.0, 50.0]),
    ] {
        let mesh = Mesh::block([3, 3, 3], size);
        let mut constraints = fix(&mesh, &[2], |x| x[2] == 0.0);
        constraints.extend(fix(&mesh, &[0], |x| x[0] == 0.0));
        constraints.extend(fix(&mesh, &[1], |x| x[1] == 0.0));
        let model = model(mesh, constraints, Elastic { young, poisson, density: 1.0 }, Gauss3);
        let mut load = vec![0.0; model.dof_count()];
        let pressure = young * 1e-3;
        for face in model.mesh().boundary_faces().iter().filter(|f| f.side == 5) {
            loads::face_pressure(model.mesh(), face, pressure, &mut load);
        }
        let solution = statics::solve(&model, &load).unwrap();
        let top = 3 * model.mesh().node_count() - 1;
        let exact = -1e-3 * size[2];
        assert!((solution.u[top] / exact - 1.0).abs() < 1e-9, "{young} {poisson}: {}", solution.u[top]);
    }
}

#[test]
fn solves_stiff_plate_on_soft_ground() {
    let mut mesh = Mesh::block([4, 4, 3], [4.0, 4.0, 3.0]);
    mesh.materials = (0..mesh.element_count()).map(|e| if e < 32 { 1 } else { 2 }).collect();
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let model = trackbed_fem::model::Model::new(trackbed_fem::model::ModelInput {
        mesh,
        materials: [(1, Elastic { young: 2e5, ..SOIL }.into()), (2, Elastic { young: 2e11, ..SOIL }.into())]
            .into(),
        quadrature: Gauss2,
        constraints,
        gravity: [0.0, 0.0, -9.81],
        ..Default::default()
    })
    .unwrap();
    let solution = statics::solve(&model, &model.gravity_load()).unwrap();
    let weight: f64 = solution.reactions.iter().skip(2).step_by(3).sum();
    assert!((weight / (48.0 * 2000.0 * 9.81) - 1.0).abs() < 1e-7, "{weight}");
}

#[test]
fn rejects_invalid_loads() {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let model = model(mesh, constraints, SOIL, Gauss3);
    let mut load = vec![0.0; model.dof_count()];
    load[59] = f64::NAN;
    let error = statics::solve(&model, &load).unwrap_err();
    assert!(matches!(error, SolveError::NotFinite { node: 20, direction: "z", .. }), "{error}");
    let error = statics::solve(&model, &load[..4]).unwrap_err();
    assert!(matches!(error, SolveError::Length { found: 4, expected: 60, .. }), "{error}");
}

#[test]
fn solves_fully_prescribed_body() {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let constraints =
        (0..60).map(|d| Constraint { node: d / 3, direction: (d % 3) as u8, value: 0.5 }).collect();
    let model = model(mesh, constraints, SOIL, Gauss3);
    let load: Vec<f64> = (0..60).map(f64::from).collect();
    let solution = statics::solve(&model, &load).unwrap();
    assert!(solution.reactions.iter().zip(&load).all(|(r, f)| (r + f).abs() < 1e-6));
    assert!(solution.u.iter().all(|&u| u == 0.5));
}
