//! Patch test, zero-energy modes, face loads and inverted elements of every kind.
//!
//! Irons and Razzaque, in: The Mathematical Foundations of the Finite Element Method (1972) (patch test);
//! Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), chapters 9 and 10 (rank).

use crate::common::{difference, model};
use crate::mixed::{block, distort, mixed, on_surface, single};
use nalgebra::DMatrix;
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::mesh::Constraint;
use trackbed_fem::{Elastic, ElementKind, Face, FaceShape, Mesh, Model, ModelError, ModelInput};
use trackbed_fem::{loads, statics, stress};

const RULES: [Quadrature; 3] = [Quadrature::Gauss2, Quadrature::Irons14, Quadrature::Gauss3];
const SOIL: Elastic = Elastic { young: 30e6, poisson: 0.3, density: 2000.0 };
const GRADIENT: [[f64; 3]; 3] =
    [[0.001, 0.0002, -0.0003], [0.0005, -0.0007, 0.0001], [-0.0002, 0.0006, 0.0004]];

fn quadratic_kinds() -> impl Iterator<Item = ElementKind> {
    ElementKind::ALL.into_iter().filter(|kind| !kind.is_linear())
}

fn linear_kinds() -> impl Iterator<Item = ElementKind> {
    ElementKind::ALL.into_iter().filter(|kind| kind.is_linear())
}

/// Errors of displacement and stress with a linear surface field.
fn patch(mesh: Mesh, rule: Quadrature) -> (f64, f64) {
    let linear = |x: &[f64; 3]| GRADIENT.map(|g| g[0] * x[0] + g[1] * x[1] + g[2] * x[2]);
    let exact: Vec<f64> = mesh.coordinates.iter().flat_map(linear).collect();
    let surface = on_surface(&mesh);
    let constraints: Vec<Constraint> = (0..exact.len())
        .filter(|dof| surface[dof / 3])
        .map(|dof| Constraint { node: dof as u32 / 3, direction: (dof % 3) as u8, value: exact[dof] })
        .collect();
    assert!(constraints.len() < exact.len(), "no node is inside");
    let model = model(mesh, constraints, SOIL, rule);
    let u = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap().u;
    let g = GRADIENT;
    let shear = [g[0][1] + g[1][0], g[1][2] + g[2][1], g[2][0] + g[0][2]];
    let expected = SOIL.stress(&[g[0][0], g[1][1], g[2][2], shear[0], shear[1], shear[2]]);
    let points = (0..model.mesh().element_count()).flat_map(|e| stress::gauss(&model, &u, e));
    let miss = points.chain(stress::nodal(&model, &u)).map(|s| difference(&s, &expected)).fold(0.0, f64::max);
    (difference(&u, &exact), miss)
}

/// Blocks of 2 × 2 × 2 cells with inner corners moved.
fn meshes(quadratic: bool) -> Vec<(&'static str, Mesh)> {
    let kinds: Vec<ElementKind> =
        if quadratic { quadratic_kinds().collect() } else { linear_kinds().collect() };
    let moved = |mut mesh: Mesh| {
        let surface = on_surface(&mesh);
        distort(&mut mesh, 0.07, 11, |n| !surface[n]);
        if quadratic { mesh.to_quadratic() } else { mesh }
    };
    let mut all: Vec<(&'static str, Mesh)> =
        kinds.iter().map(|k| (k.name(), moved(block(k.linear(), [2; 3], [1.0; 3])))).collect();
    all.push(("mixed", moved(mixed(false))));
    all
}

#[test]
fn straight_patches_pass() {
    for (name, mesh) in meshes(true).into_iter().chain(meshes(false)) {
        for rule in RULES {
            let (u, s) = patch(mesh.clone(), rule);
            println!("{name} straight {rule:?}: u {u:.1e}, stress {s:.1e}");
            assert!(u <= 1e-12 && s <= 1e-11, "{name} {rule:?}: {u:e} {s:e}");
        }
    }
}

#[test]
fn curved_patches_need_full_integration() {
    for (name, mut mesh) in meshes(true) {
        let corners: Vec<bool> = mesh.linear_node_map().iter().map(Option::is_some).collect();
        distort(&mut mesh, 0.02, 5, |n| !corners[n]);
        let (u, s) = patch(mesh.clone(), Quadrature::Gauss3);
        let (lean_u, lean_s) = patch(mesh, Quadrature::Gauss2);
        println!("{name} curved: full u {u:.1e}, stress {s:.1e}; lean u {lean_u:.1e}, stress {lean_s:.1e}");
        assert!(u <= 1e-12 && s <= 1e-11, "{name}: {u:e} {s:e}");
        let range = if name == "pyramid13" { 0.0..1e-12 } else { 1e-5..2e-3 };
        assert!(range.contains(&lean_u) && lean_s <= 10.0 * range.end, "{name}: {lean_u:e} {lean_s:e}");
    }
}

/// Ascending eigenvalues over the largest, and the largest force of rigid motions.
fn spectrum(mesh: Mesh, rule: Quadrature) -> (Vec<f64>, f64) {
    let model = model(mesh, Vec::new(), Elastic { young: 1.0, poisson: 0.3, density: 1.0 }, rule);
    let n = model.dof_count();
    let mut matrix = DMatrix::zeros(n, n);
    let mut unit = vec![0.0; n];
    for dof in 0..n {
        unit[dof] = 1.0;
        model.stiffness_times(&unit, matrix.column_mut(dof).as_mut_slice());
        unit[dof] = 0.0;
    }
    let mut rigid: f64 = 0.0;
    for motion in 0..6 {
        let x: Vec<f64> = model
            .mesh()
            .coordinates
            .iter()
            .flat_map(|c| {
                let k = motion % 3;
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let mut step = [0.0; 3];
                if motion < 3 {
                    step[k] = 1.0;
                } else {
                    (step[i], step[j]) = (-c[j], c[i]);
                }
                step
            })
            .collect();
        model.stiffness_times(&x, &mut unit);
        rigid = unit.iter().fold(rigid, |m, f| m.max(f.abs()));
    }
    let mut values: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    let largest = values[n - 1];
    (values.into_iter().map(|v| v / largest).collect(), rigid)
}

#[test]
fn stiffness_has_six_zero_modes() {
    for kind in ElementKind::ALL {
        for (rule, amount) in RULES.into_iter().flat_map(|r| [(r, 0.0), (r, 0.1)]) {
            let mut mesh = single(kind);
            distort(&mut mesh, amount, 3, |_| true);
            let (values, rigid) = spectrum(mesh, rule);
            let zero = if kind == ElementKind::Hex20 && rule == Quadrature::Gauss2 { 12 } else { 6 };
            let (none, least) = (values[..zero].iter().fold(0.0, |m: f64, v| m.max(v.abs())), values[zero]);
            println!("{} {rule:?} {amount}: {zero} modes below {none:.1e}, next {least:.1e}", kind.name());
            assert!(none < 1e-14 && least > 1e-4, "{} {rule:?}: {values:?}", kind.name());
            assert!(rigid < 1e-14, "{} {rule:?}: rigid motions meet {rigid:e} N", kind.name());
        }
    }
}

fn resultants(mesh: &Mesh, load: &[f64]) -> ([f64; 3], [f64; 3]) {
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (x, f) in mesh.coordinates.iter().zip(load.as_chunks::<3>().0) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            force[k] += f[k];
            moment[k] += x[i] * f[j] - x[j] * f[i];
        }
    }
    (force, moment)
}

#[test]
fn face_loads_are_consistent() {
    let traction = [3.0, -7.0, 11.0];
    for kind in ElementKind::ALL {
        let mut mesh = single(kind);
        for c in &mut mesh.coordinates {
            let [x, y, z] = *c;
            *c = [1.3 * x + 0.2 * y + 0.5, 0.8 * y - 0.3 * z + 0.1 * x, 1.1 * z + 0.25 * x - 0.4 * y - 0.7];
        }
        for side in 0..kind.faces().len() {
            let face = mesh.face(0, side);
            let corners: Vec<[f64; 3]> =
                face.corners().iter().map(|&n| mesh.coordinates[n as usize]).collect();
            let part = if corners.len() == 3 { 0.5 } else { 1.0 };
            let edge = |a: usize| -> [f64; 3] { std::array::from_fn(|k| corners[a][k] - corners[0][k]) };
            let (a, b) = (edge(1), edge(corners.len() - 1));
            let area: [f64; 3] = std::array::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                part * (a[i] * b[j] - a[j] * b[i])
            });
            let size = area.iter().map(|a| a * a).sum::<f64>().sqrt();
            let middle: [f64; 3] =
                std::array::from_fn(|k| corners.iter().map(|c| c[k]).sum::<f64>() / corners.len() as f64);
            for (force, pressed) in [(area.map(|a| -500.0 * a), true), (traction.map(|t| t * size), false)] {
                let mut load = vec![0.0; 3 * mesh.node_count()];
                if pressed {
                    loads::face_pressure(&mesh, &face, 500.0, &mut load);
                } else {
                    loads::face_traction(&mesh, &face, traction, &mut load);
                }
                let largest = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
                let (total, moment) = resultants(&mesh, &load);
                for k in 0..3 {
                    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                    let turn = middle[i] * force[j] - middle[j] * force[i];
                    assert!((total[k] - force[k]).abs() < 1e-13 * largest, "{} {side}", kind.name());
                    assert!((moment[k] - turn).abs() < 1e-13 * largest, "{} {side}", kind.name());
                }
                assert_shares(&face, &load, force, largest);
            }
        }
    }
}

fn assert_shares(face: &Face, load: &[f64], force: [f64; 3], largest: f64) {
    let (corner, middle) = match face.shape {
        FaceShape::Quad8 => (-1.0 / 12.0, 1.0 / 3.0),
        FaceShape::Tri6 => (0.0, 1.0 / 3.0),
        FaceShape::Quad4 => (0.25, 0.0),
        FaceShape::Tri3 => (1.0 / 3.0, 0.0),
    };
    for (a, &node) in face.nodes().iter().enumerate() {
        let share = if a < face.corners().len() { corner } else { middle };
        for k in 0..3 {
            let found = load[3 * node as usize + k];
            assert!((found - share * force[k]).abs() < 1e-14 * largest, "{face:?}: {found}");
        }
    }
}

#[test]
fn pressure_on_closed_surface_cancels() {
    let mut mesh = mixed(true);
    distort(&mut mesh, 0.03, 9, |_| true);
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        loads::face_pressure(&mesh, &face, 1.0, &mut load);
    }
    let (force, moment) = resultants(&mesh, &load);
    println!("closed surface: force {force:?} of 10, moment {moment:?}");
    assert!(force.iter().chain(&moment).all(|f| f.abs() < 1e-13));
}

fn refusal(mesh: Mesh) -> Option<ModelError> {
    let materials = [(1, SOIL.into())].into();
    Model::new(ModelInput { mesh, materials, ..Default::default() }).err()
}

#[test]
fn reports_inverted_elements() {
    for kind in ElementKind::ALL {
        let name = kind.name();
        let mut mesh = block(kind, [2, 2, 2], [1.0; 3]);
        assert_eq!(refusal(mesh.clone()), None);
        assert!((0..mesh.element_count()).all(|e| mesh.jacobian_ratio(e) > 0.3), "{name}");
        let first = mesh.node_count() as u32;
        let own: Vec<u32> = (first..first + kind.node_count() as u32).collect();
        mesh.coordinates.extend(kind.natural().iter().map(|[x, y, z]| [-x, *y, z + 5.0]));
        mesh.node_ids.extend(own.iter().map(|n| n + 1));
        mesh.push_element(77, 1, kind, &own);
        assert!(mesh.jacobian_ratio(mesh.element_count() - 1) < 0.0);
        let found = refusal(mesh);
        assert!(matches!(found, Some(ModelError::Inverted { element: 77, .. })), "{name}: {found:?}");

        for corner in 0..kind.corner_count() {
            let mut mesh = single(kind.linear());
            let count = mesh.node_count() as f64;
            for k in 0..3 {
                let middle = mesh.coordinates.iter().map(|x| x[k]).sum::<f64>() / count;
                mesh.coordinates[corner][k] += 2.5 * (middle - mesh.coordinates[corner][k]);
            }
            let mesh = if kind.is_linear() { mesh } else { mesh.to_quadratic() };
            assert!(mesh.jacobian_ratio(0) < 0.0, "{name} corner {corner}");
            let found = refusal(mesh);
            assert!(
                matches!(found, Some(ModelError::Inverted { element: 1, .. })),
                "{name} {corner}: {found:?}"
            );
        }
    }
}

#[test]
fn rejects_pyramid_inverted_at_apex() {
    for (along, sound) in [(0.5, true), (0.70, true), (0.80, false)] {
        let mut mesh = single(ElementKind::Pyramid13);
        mesh.coordinates[9] = [along - 1.0, along - 1.0, along];
        let ratio = mesh.jacobian_ratio(0);
        println!("pyramid13, mid-side at {along}: {ratio:.3}");
        assert_eq!(ratio > 0.0, sound, "{along}: {ratio}");
    }
    let mut mesh = single(ElementKind::Pyramid5);
    assert!((mesh.jacobian_ratio(0) - 1.0).abs() < 1e-14);
    mesh.coordinates[4][2] = -0.1;
    assert!(mesh.jacobian_ratio(0) < 0.0);
}
