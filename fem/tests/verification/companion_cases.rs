//! Membrane, thick cylinder and bending with every element kind.

use crate::common::{fix, model};
use crate::mixed::{block, mixed};
use nalgebra::{DMatrix, DVector};
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::element::stiffness_points;
use trackbed_fem::kinematics::{gradient_products, stiffness_block};
use trackbed_fem::{Constraint, Elastic, ElementKind, Mesh, loads, statics, stress};

/// Cook's membrane (Cook, J. Struct. Div. ASCE 100 (1974) 1851-1863), plane strain, one element thick:
/// corners (0, 0), (48, 44), (48, 60), (0, 44), shear force 100 N.
fn membrane(kind: ElementKind, n: usize) -> (Mesh, Vec<Constraint>) {
    let mut mesh = block(kind, [n, n, 1], [1.0; 3]);
    let mut constraints = fix(&mesh, &[0, 1], |x| x[0] == 0.0);
    constraints.extend(fix(&mesh, &[2], |_| true));
    for c in &mut mesh.coordinates {
        let [x, y, z] = *c;
        *c = [48.0 * x, 44.0 * x * (1.0 - y) + (44.0 + 16.0 * x) * y, z];
    }
    (mesh, constraints)
}

fn membrane_load(mesh: &Mesh) -> Vec<f64> {
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        if face.nodes().iter().all(|&n| (mesh.coordinates[n as usize][0] - 48.0).abs() < 1e-9) {
            loads::face_traction(mesh, &face, [0.0, 100.0 / 16.0, 0.0], &mut load);
        }
    }
    load
}

fn rubber(poisson: f64) -> Elastic {
    Elastic { young: 240.565, poisson, density: 1.0 }
}

fn tip(mesh: &Mesh, u: &[f64]) -> f64 {
    let corner = mesh.coordinates.iter().position(|x| (x[0] - 48.0).hypot(x[1] - 60.0) < 1e-9).unwrap();
    u[3 * corner + 1]
}

fn rise(kind: ElementKind, n: usize, poisson: f64, rule: Quadrature) -> f64 {
    let (mesh, constraints) = membrane(kind, n);
    let load = membrane_load(&mesh);
    let model = model(mesh, constraints, rubber(poisson), rule);
    tip(model.mesh(), &statics::solve(&model, &load).unwrap().u)
}

/// Displacement-based hex8 with full 2×2×2 integration.
fn plain_rise(n: usize, poisson: f64) -> f64 {
    let (mesh, constraints) = membrane(ElementKind::Hex8, n);
    let load = membrane_load(&mesh);
    let (lambda, mu) = rubber(poisson).lame();
    let mut free = vec![usize::MAX; load.len()];
    let mut fixed = vec![false; load.len()];
    constraints.iter().for_each(|c| fixed[3 * c.node as usize + usize::from(c.direction)] = true);
    let mut size = 0;
    for dof in (0..load.len()).filter(|&dof| !fixed[dof]) {
        free[dof] = size;
        size += 1;
    }
    let mut matrix = DMatrix::zeros(size, size);
    let mut right = DVector::zeros(size);
    (0..load.len()).filter(|&dof| !fixed[dof]).for_each(|dof| right[free[dof]] = load[dof]);
    for e in 0..mesh.element_count() {
        let points = stiffness_points(ElementKind::Hex8, Quadrature::Gauss2);
        let products = gradient_products::<8>(&mesh.element_coordinates(e), points);
        let nodes = &mesh.connectivity[e];
        for a in 0..8 {
            for b in 0..8 {
                let k = stiffness_block(&products, lambda, mu, a, b);
                for i in 0..9 {
                    let (r, c) = (free[3 * nodes[a] as usize + i / 3], free[3 * nodes[b] as usize + i % 3]);
                    if r != usize::MAX && c != usize::MAX {
                        matrix[(r, c)] += k[i];
                    }
                }
            }
        }
    }
    let solution = matrix.cholesky().expect("held").solve(&right);
    let u: Vec<f64> = free.iter().map(|&f| if f == usize::MAX { 0.0 } else { solution[f] }).collect();
    tip(&mesh, &u)
}

/// At 0.4999 plain hex8, wedge6 and tet4 lock.
#[test]
fn mean_dilatation_does_not_lock() {
    let reference = |poisson| {
        let [coarse, fine] = [16, 32].map(|n| rise(ElementKind::Hex20, n, poisson, Quadrature::Gauss2));
        assert!((coarse / fine - 1.0).abs() < 0.01, "reference {coarse} {fine}");
        fine
    };
    for (poisson, plain_range) in [(0.3, 0.85..1.0), (0.4999, 0.0..0.5)] {
        let exact = reference(poisson);
        let plain = plain_rise(8, poisson) / exact;
        let found = [8, 16].map(|n| rise(ElementKind::Hex8, n, poisson, Quadrature::Gauss2) / exact);
        println!(
            "membrane {poisson}: {exact:.4}; hex8 8×8 {:.4}, 16×16 {:.4}, plain 8×8 {plain:.4}",
            found[0], found[1]
        );
        assert!(plain_range.contains(&plain), "{poisson}: plain {plain}");
        assert!((found[0] - 1.0).abs() < 0.07 && (found[1] - 1.0).abs() < 0.03, "{poisson}: {found:?}");
        for kind in [ElementKind::Wedge6, ElementKind::Pyramid5, ElementKind::Tet4, ElementKind::Tet10] {
            let found = rise(kind, 8, poisson, Quadrature::Gauss2) / exact;
            println!("membrane {poisson}: {} 8×8 {found:.4}", kind.name());
            let expected = match kind {
                ElementKind::Tet10 => 0.9..1.0,
                ElementKind::Pyramid5 => {
                    if poisson < 0.4 {
                        0.8..1.0
                    } else {
                        0.5..0.7
                    }
                }
                _ => {
                    if poisson < 0.4 {
                        0.6..0.8
                    } else {
                        0.2..0.4
                    }
                }
            };
            assert!(expected.contains(&found), "{poisson} {}: {found}", kind.name());
        }
    }
}

/// Thick cylinder, plane strain (Lamé 1852; Timoshenko and Goodier, Theory of Elasticity (1951), section 26):
/// errors of radial displacement and hoop stress.
fn cylinder(kind: ElementKind, counts: [usize; 2], rule: Quadrature) -> (f64, f64) {
    let (young, nu, p, a, b) = (200e9, 0.3, 10e6, 0.5, 1.0);
    let mut mesh = block(kind, [counts[0], counts[1], counts[0] / 4], [1.0; 3]);
    let mut constraints = fix(&mesh, &[1], |x| x[1] == 0.0);
    constraints.extend(fix(&mesh, &[0], |x| x[1] == 1.0));
    constraints.extend(fix(&mesh, &[2], |_| true));
    let inside: Vec<bool> = mesh.coordinates.iter().map(|x| x[0] == 0.0).collect();
    for c in &mut mesh.coordinates {
        let (r, (sin, cos)) = (a + (b - a) * c[0], (std::f64::consts::FRAC_PI_2 * c[1]).sin_cos());
        *c = [r * cos, r * sin, 0.25 * c[2]];
    }
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        if face.nodes().iter().all(|&n| inside[n as usize]) {
            loads::face_pressure(&mesh, &face, p, &mut load);
        }
    }
    let model = model(mesh, constraints, Elastic { young, poisson: nu, density: 1.0 }, rule);
    let u = statics::solve(&model, &load).unwrap().u;
    let stresses = stress::nodal(&model, &u);
    let factor = p * a * a / (b * b - a * a);
    let (mut radial, mut hoop): (f64, f64) = (0.0, 0.0);
    for (n, x) in model.mesh().coordinates.iter().enumerate() {
        let r = x[0].hypot(x[1]);
        let (c, s) = (x[0] / r, x[1] / r);
        let exact = (1.0 + nu) / young * factor * ((1.0 - 2.0 * nu) * r + b * b / r);
        radial = radial.max(((u[3 * n] * c + u[3 * n + 1] * s) / exact - 1.0).abs());
        let t = stresses[n];
        let found = t[0] * s * s + t[1] * c * c - 2.0 * t[3] * s * c;
        hoop = hoop.max((found - factor * (1.0 + b * b / (r * r))).abs());
    }
    (radial, hoop / (factor * (1.0 + b * b / (a * a))))
}

#[test]
fn thick_cylinders_match_lame() {
    for (kind, radial_limit, hoop_limit) in [
        (ElementKind::Hex20, 1e-4, 0.03),
        (ElementKind::Wedge15, 1.5e-3, 0.02),
        (ElementKind::Pyramid13, 4e-4, 0.02),
        (ElementKind::Tet10, 2.5e-3, 0.02),
        (ElementKind::Hex8, 0.012, 0.08),
        (ElementKind::Wedge6, 0.12, 0.2),
        (ElementKind::Pyramid5, 0.04, 0.14),
        (ElementKind::Tet4, 0.12, 0.24),
    ] {
        // Linear kinds have one rule.
        let rules = [Quadrature::Gauss2, Quadrature::Gauss3];
        for rule in rules.into_iter().take(if kind.is_linear() { 1 } else { 2 }) {
            let (radial, hoop) = cylinder(kind, [4, 6], rule);
            let (fine_radial, fine_hoop) = cylinder(kind, [8, 12], rule);
            println!(
                "Lamé {} {rule:?}: radial {radial:.1e} → {fine_radial:.1e}, hoop {hoop:.1e} → {fine_hoop:.1e}",
                kind.name()
            );
            assert!(radial < radial_limit && hoop < hoop_limit, "{}: {radial:e} {hoop:e}", kind.name());
            let (gain, of_stress) = if kind.is_linear() { (2.8, 1.7) } else { (5.0, 3.4) };
            assert!(radial > gain * fine_radial && hoop > of_stress * fine_hoop, "{}", kind.name());
        }
    }
}

/// Pure bending about y, `sigma_x = E κ z`.
fn bending(x: [f64; 3]) -> [f64; 3] {
    let nu = SOIL.poisson;
    [x[0] * x[2], -nu * x[1] * x[2], 0.5 * (nu * (x[1] * x[1] - x[2] * x[2]) - x[0] * x[0])]
        .map(|u| CURVATURE * u)
}

const CURVATURE: f64 = 1e-3;
const SOIL: Elastic = Elastic { young: 30e6, poisson: 0.3, density: 2000.0 };

/// Errors of displacement and nodal stress; exact surface displacement.
fn bending_miss(mesh: Mesh, rule: Quadrature) -> (f64, f64) {
    let surface = crate::mixed::on_surface(&mesh);
    let exact: Vec<f64> = mesh.coordinates.iter().flat_map(|x| bending(*x)).collect();
    let constraints = (0..exact.len())
        .filter(|dof| surface[dof / 3])
        .map(|dof| Constraint { node: dof as u32 / 3, direction: (dof % 3) as u8, value: exact[dof] })
        .collect();
    let model = model(mesh, constraints, SOIL, rule);
    let u = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap().u;
    let (mut miss, mut largest): (f64, f64) = (0.0, 0.0);
    for (x, s) in model.mesh().coordinates.iter().zip(stress::nodal(&model, &u)) {
        let expected = [SOIL.young * CURVATURE * x[2], 0.0, 0.0, 0.0, 0.0, 0.0];
        largest = largest.max(expected[0].abs());
        miss = (0..6).fold(miss, |m, c| m.max((s[c] - expected[c]).abs()));
    }
    (crate::common::difference(&u, &exact), miss / largest)
}

#[test]
fn recovers_linear_stress_at_nodes() {
    for rule in [Quadrature::Gauss2, Quadrature::Gauss3] {
        let quadratic = ElementKind::ALL.into_iter().filter(|k| !k.is_linear());
        let blocks = quadratic.map(|kind| (kind.name(), block(kind, [3; 3], [1.0; 3])));
        for (name, mut mesh) in blocks.chain([("mixed", mixed(true))]) {
            mesh.coordinates.iter_mut().for_each(|[x, y, z]| *x += 0.2 * *y + 0.1 * *z);
            let (u, s) = bending_miss(mesh, rule);
            println!("bending {name} {rule:?}: u {u:.1e}, nodal stress {s:.1e}");
            assert!(u < 1e-12 && s < 1e-11, "{name}: {u:e} {s:e}");
        }
    }
    for kind in ElementKind::ALL.into_iter().filter(|k| k.is_linear()) {
        let [(u, coarse), (fine_u, fine)] =
            [4, 8].map(|n| bending_miss(block(kind, [n; 3], [1.0; 3]), Quadrature::Gauss2));
        println!("bending {}: u {u:.1e} → {fine_u:.1e}, nodal stress {coarse:.1e} → {fine:.1e}", kind.name());
        assert!(fine < 0.6 * coarse && fine < 0.2, "{}: {coarse:e} {fine:e}", kind.name());
    }
}
