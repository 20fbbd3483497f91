//! Orders of convergence of hex20 on a smooth manufactured solution.
//!
//! Third order in L2, second in energy; one smooth map distorts all meshes.

use crate::common::model;
use trackbed_fem::element::hex20;
use trackbed_fem::element::quadrature::{GAUSS3, Quadrature};
use trackbed_fem::kinematics::{spatial_gradients, strain};
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::{loads, statics};

pub const SOIL: Elastic = Elastic { young: 3.0, poisson: 0.3, density: 1.0 };
/// Waves `A sin(k·x)` of the solution.
const WAVES: [([f64; 3], [f64; 3]); 2] =
    [([1.0, -0.5, 0.3], [2.0, 1.0, -1.5]), ([0.2, 0.7, -0.4], [-1.0, 2.5, 1.0])];

/// Four-point Gauss rule: no superconvergent points.
pub const LINE4: [(f64, f64); 4] = [
    (-0.8611363115940526, 0.3478548451374538),
    (-0.3399810435848563, 0.6521451548625461),
    (0.3399810435848563, 0.6521451548625461),
    (0.8611363115940526, 0.3478548451374538),
];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Displacement, strain (engineering shear) and body force.
pub fn exact(x: [f64; 3]) -> ([f64; 3], [f64; 6], [f64; 3]) {
    let (lambda, mu) = SOIL.lame();
    let (mut u, mut e, mut f) = ([0.0; 3], [0.0; 6], [0.0; 3]);
    for (a, k) in WAVES {
        let (sin, cos) = dot(k, x).sin_cos();
        for i in 0..3 {
            u[i] += a[i] * sin;
            e[i] += a[i] * k[i] * cos;
            f[i] += sin * ((lambda + mu) * dot(a, k) * k[i] + mu * dot(k, k) * a[i]);
        }
        for (c, (i, j)) in [(3, (0, 1)), (4, (1, 2)), (5, (2, 0))] {
            e[c] += (a[i] * k[j] + a[j] * k[i]) * cos;
        }
    }
    (u, e, f)
}

/// Errors (L2 norm of u, energy norm) on n³ elements.
fn errors(n: usize, rule: Quadrature, map: fn([f64; 3]) -> [f64; 3]) -> (f64, f64) {
    let mut mesh = Mesh::block([n; 3], [1.0; 3]);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&i| mesh.coordinates[i as usize].iter().any(|&x| x == 0.0 || x == 1.0))
        .flat_map(|node| {
            let u = exact(map(mesh.coordinates[node as usize])).0;
            (0..3).map(move |k| Constraint { node, direction: k, value: u[usize::from(k)] })
        })
        .collect();
    mesh.coordinates.iter_mut().for_each(|x| *x = map(*x));
    let model = model(mesh, constraints, SOIL, rule);
    let mesh = model.mesh();
    let position = |e: usize, xi: [f64; 3]| -> [f64; 3] {
        let (n, x) = (hex20::shape_functions(xi), mesh.element_coordinates(e));
        std::array::from_fn(|k| (0..20).map(|a| n[a] * x[a][k]).sum())
    };
    let mut load = vec![0.0; model.dof_count()];
    for e in 0..mesh.element_count() {
        for (xi, w) in GAUSS3 {
            let det = spatial_gradients(&mesh.element_coordinates(e), &hex20::gradients(xi)).1;
            let force = exact(position(e, xi)).2.map(|f| f * w * det);
            loads::point_load(mesh, e, xi, force, &mut load);
        }
    }
    let u = statics::solve(&model, &load).unwrap().u;
    let (mut square, mut energy) = (0.0, 0.0);
    for e in 0..mesh.element_count() {
        let moved = mesh.element_values(e, &u);
        for (x, wx) in LINE4 {
            for (y, wy) in LINE4 {
                for (z, wz) in LINE4 {
                    let xi = [x, y, z];
                    let (g, det) = spatial_gradients(&mesh.element_coordinates(e), &hex20::gradients(xi));
                    let (exact_u, exact_e, _) = exact(position(e, xi));
                    let n = hex20::shape_functions(xi);
                    let found = strain(&g, &moved);
                    let de: [f64; 6] = std::array::from_fn(|c| found[c] - exact_e[c]);
                    let ds = SOIL.stress(&de);
                    for k in 0..3 {
                        let uk: f64 = (0..20).map(|a| n[a] * moved[a][k]).sum();
                        square += wx * wy * wz * det * (uk - exact_u[k]).powi(2);
                    }
                    energy += wx * wy * wz * det * (0..6).map(|c| ds[c] * de[c]).sum::<f64>();
                }
            }
        }
    }
    (square.sqrt(), energy.sqrt())
}

fn assert_orders(name: &str, rule: Quadrature, map: fn([f64; 3]) -> [f64; 3]) {
    let found: Vec<(f64, f64)> = [2, 4, 8].map(|n| errors(n, rule, map)).to_vec();
    for pair in found.windows(2) {
        let (u, energy) = ((pair[0].0 / pair[1].0).log2(), (pair[0].1 / pair[1].1).log2());
        println!(
            "{name} {rule:?}: order {u:.3} in u, {energy:.3} in energy; errors {:.2e} {:.2e}",
            pair[1].0, pair[1].1
        );
        assert!(u >= 2.9 && energy >= 1.9, "{name} {rule:?}: {u} {energy}");
    }
}

#[test]
fn straight_meshes_order_three_and_two() {
    assert_orders("straight", Quadrature::Gauss3, |x| x);
    assert_orders("straight", Quadrature::Gauss2, |x| x);
}

#[test]
fn distorted_meshes_order_three_and_two() {
    let map = |[x, y, z]: [f64; 3]| {
        let bump = 0.04 * (3.0 * x).sin() * (2.0 * y).cos() * (1.0 + z);
        [x + bump, y - 0.5 * bump + 0.03 * z * z, z + bump * x]
    };
    assert_orders("distorted", Quadrature::Gauss3, map);
}
