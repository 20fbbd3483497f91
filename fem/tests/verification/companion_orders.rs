//! Orders of convergence of every element kind, on the manufactured solution of [`crate::convergence`].
//!
//! L2 and energy norm: 3 and 2 (quadratic), 2 and 1 (linear). Allowed shortfall: 0.15.

use crate::common::model;
use crate::convergence::{LINE4, SOIL, exact};
use crate::mixed::{block, on_surface};
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::kinematics::jacobian;
use trackbed_fem::mesh::Constraint;
use trackbed_fem::{ElementKind, loads, statics, stress};

/// Four points per axis, collapsed (conical products).
fn fine_rule(kind: ElementKind) -> Vec<([f64; 3], f64)> {
    let mut points = Vec::with_capacity(64);
    for (x, wx) in LINE4 {
        for (y, wy) in LINE4 {
            for (z, wz) in LINE4 {
                let weight = wx * wy * wz;
                let (a, b, c) = ((1.0 + x) / 2.0, (1.0 + y) / 2.0, (1.0 + z) / 2.0);
                points.push(match kind.linear() {
                    ElementKind::Hex8 => ([x, y, z], weight),
                    ElementKind::Wedge6 => ([a, b * (1.0 - a), z], weight * (1.0 - a) / 4.0),
                    ElementKind::Pyramid5 => {
                        ([x * (1.0 - c), y * (1.0 - c), c], weight * (1.0 - c).powi(2) / 2.0)
                    }
                    _ => (
                        [a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)],
                        weight * (1.0 - a).powi(2) * (1.0 - b) / 8.0,
                    ),
                });
            }
        }
    }
    points
}

/// Errors (L2 norm of u, energy norm) on a unit cube of n³ cells.
fn errors(kind: ElementKind, n: usize, rule: Quadrature, map: fn([f64; 3]) -> [f64; 3]) -> (f64, f64) {
    let mut mesh = block(kind, [n; 3], [1.0; 3]);
    mesh.coordinates.iter_mut().for_each(|x| *x = map(*x));
    let surface = on_surface(&mesh);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&i| surface[i as usize])
        .flat_map(|node| {
            let u = exact(mesh.coordinates[node as usize]).0;
            (0..3).map(move |k| Constraint { node, direction: k, value: u[usize::from(k)] })
        })
        .collect();
    let model = model(mesh, constraints, SOIL, rule);
    let (mesh, points) = (model.mesh(), fine_rule(kind));
    let shapes: Vec<_> = points.iter().map(|p| (kind.shape_functions(p.0), kind.gradients(p.0))).collect();
    let at = |values: &[[f64; 3]; 20], n: &[f64; 20]| -> [f64; 3] {
        std::array::from_fn(|k| (0..kind.node_count()).map(|a| n[a] * values[a][k]).sum())
    };
    let mut load = vec![0.0; model.dof_count()];
    for e in 0..mesh.element_count() {
        let x = mesh.element_coordinates(e);
        for (&(xi, w), (n, g)) in points.iter().zip(&shapes) {
            let volume = w * jacobian(&x, g).1;
            loads::point_load(mesh, e, xi, exact(at(&x, n)).2.map(|f| f * volume), &mut load);
        }
    }
    let u = statics::solve(&model, &load).unwrap().u;
    let (mut square, mut energy) = (0.0, 0.0);
    for e in 0..mesh.element_count() {
        let (x, moved) = (mesh.element_coordinates(e), mesh.element_values(e, &u));
        for (&(xi, w), (n, g)) in points.iter().zip(&shapes) {
            let volume = w * jacobian(&x, g).1;
            let (exact_u, exact_e, _) = exact(at(&x, n));
            let (found, sigma) = (at(&moved, n), SOIL.stress(&exact_e));
            square += volume * (0..3).map(|k| (found[k] - exact_u[k]).powi(2)).sum::<f64>();
            let s = stress::at_natural(&model, &u, e, xi);
            let d: [f64; 6] = std::array::from_fn(|c| s[c] - sigma[c]);
            let trace = d[0] + d[1] + d[2];
            let product: f64 = (0..6).map(|c| if c < 3 { 1.0 } else { 2.0 } * d[c] * d[c]).sum();
            energy += volume * ((1.0 + SOIL.poisson) * product - SOIL.poisson * trace * trace) / SOIL.young;
        }
    }
    (square.sqrt(), energy.sqrt())
}

fn assert_orders(kind: ElementKind, counts: [usize; 2], rule: Quadrature, map: fn([f64; 3]) -> [f64; 3]) {
    let [coarse, fine] = counts.map(|n| errors(kind, n, rule, map));
    let ratio = (counts[1] as f64 / counts[0] as f64).log2();
    let (u, energy) = ((coarse.0 / fine.0).log2() / ratio, (coarse.1 / fine.1).log2() / ratio);
    println!(
        "{} {rule:?} {counts:?}: order {u:.3} in u, {energy:.3} in energy; errors {:.2e} {:.2e}",
        kind.name(),
        fine.0,
        fine.1
    );
    let goal = if kind.is_linear() { 2.0 } else { 3.0 };
    assert!(u >= goal - 0.15 && energy >= goal - 1.15, "{} {rule:?}: {u} {energy}", kind.name());
}

fn smooth([x, y, z]: [f64; 3]) -> [f64; 3] {
    let bump = 0.04 * (3.0 * x).sin() * (2.0 * y).cos() * (1.0 + z);
    [x + bump, y - 0.5 * bump + 0.03 * z * z, z + bump * x]
}

#[test]
fn fine_rules_have_the_natural_volumes() {
    for kind in ElementKind::ALL {
        let sum: f64 = fine_rule(kind).iter().map(|p| p.1).sum();
        assert!((sum / kind.natural_volume() - 1.0).abs() < 1e-13, "{}", kind.name());
    }
}

#[test]
fn quadratic_kinds_order_three_and_two() {
    for (kind, counts) in [
        (ElementKind::Hex20, [3, 6]),
        (ElementKind::Wedge15, [3, 6]),
        (ElementKind::Pyramid13, [2, 4]),
        (ElementKind::Tet10, [3, 6]),
    ] {
        for rule in [Quadrature::Gauss3, Quadrature::Gauss2] {
            assert_orders(kind, counts, rule, |x| x);
            assert_orders(kind, counts, rule, smooth);
        }
    }
}

#[test]
fn linear_kinds_order_two_and_one() {
    for kind in [ElementKind::Hex8, ElementKind::Wedge6, ElementKind::Pyramid5, ElementKind::Tet4] {
        assert_orders(kind, [5, 10], Quadrature::Gauss2, |x| x);
        assert_orders(kind, [5, 10], Quadrature::Gauss2, smooth);
    }
}
