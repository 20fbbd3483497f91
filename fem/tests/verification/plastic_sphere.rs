//! Expansion of a spherical cavity in a thick Mohr–Coulomb shell.
//!
//! Yu, Cavity Expansion Methods in Geomechanics (2000), chapter 3 (finite shell; Yu, J. Geotech. Eng. 119
//! (1993)), small strain, compression positive. Tolerance 1 %.

use crate::common::model;
use crate::plastic_common::{mohr_coulomb, tight};
use std::collections::BTreeMap;
use trackbed_fem::TimeIntegrator;
use trackbed_fem::nonlinear::{QuasiStatic, StepControl};
use trackbed_fem::{Constraint, Elastic, ElementKind, Mesh, Quadrature, State, loads};

const SOIL: Elastic = Elastic { young: 50e6, poisson: 0.3, density: 2000.0 };
const INNER: f64 = 1.0;
const OUTER: f64 = 4.0;

/// Inner wall at plastic radius `c`.
struct ClosedForm {
    alpha: f64,
    beta: f64,
    y: f64,
}

impl ClosedForm {
    fn new(c: f64, phi: f64, psi: f64) -> ClosedForm {
        let ratio = |angle: f64| (1.0 + angle.to_radians().sin()) / (1.0 - angle.to_radians().sin());
        let alpha = ratio(phi);
        ClosedForm { alpha, beta: ratio(psi), y: 2.0 * c * alpha.sqrt() }
    }

    /// Radial and hoop stress, compression positive.
    fn stress(&self, r: f64, c: f64) -> (f64, f64) {
        let (al, y, outer) = (self.alpha, self.y, OUTER.powi(-3));
        let b = y / (c.powi(-3) * (1.0 + 0.5 * al) + outer * (al - 1.0));
        if r >= c {
            return (b * (r.powi(-3) - outer), -b * (0.5 * r.powi(-3) + outer));
        }
        let power = -2.0 * (al - 1.0) / al;
        let at_c = b * (c.powi(-3) - outer) + y / (al - 1.0);
        let radial = at_c * (r / c).powf(power) - y / (al - 1.0);
        (radial, (radial - y) / al)
    }

    /// Radial and hoop elastic strain, tension positive.
    fn elastic(&self, r: f64, c: f64) -> (f64, f64) {
        let (radial, hoop) = self.stress(r, c);
        let (e, nu) = (SOIL.young, SOIL.poisson);
        (-(radial - 2.0 * nu * hoop) / e, -(hoop - nu * (radial + hoop)) / e)
    }

    fn pressure(&self, c: f64) -> f64 {
        self.stress(INNER, c).0
    }

    fn wall(&self, c: f64) -> f64 {
        let k = 2.0 / self.beta;
        let f = |r: f64| {
            let (radial, hoop) = self.elastic(r.min(c * (1.0 - 1e-15)), c);
            (radial + k * hoop) * r.powf(k)
        };
        // Simpson's rule.
        let n = 2000;
        let h = (c - INNER) / f64::from(n);
        let sum: f64 = (0..=n)
            .map(|i| {
                let weight = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                weight * f(INNER + h * f64::from(i))
            })
            .sum();
        let at_c = self.elastic(c, c).1 * c;
        (at_c * c.powf(k) - sum * h / 3.0) / INNER.powf(k)
    }
}

/// Three patches of n × n columns, graded layers.
fn octant(n: usize, layers: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let mut known: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let ratio = (OUTER / INNER).powf(1.0 / layers as f64);
    for axis in 0..3 {
        for (i, j, l) in (0..n * n * layers).map(|k| (k % n, k / n % n, k / (n * n))) {
            // Corner at the axis, mid-sides, and centre of the octant.
            let point = |xi: [f64; 3]| -> [f64; 3] {
                let (s, t) = (
                    (i as f64 + 0.5 * (1.0 + xi[0])) / n as f64,
                    (j as f64 + 0.5 * (1.0 + xi[1])) / n as f64,
                );
                let mut d = [0.0; 3];
                let h = 0.5_f64.sqrt();
                let m = 3.0_f64.sqrt().recip();
                let (a, b, c) = (axis, (axis + 1) % 3, (axis + 2) % 3);
                d[a] = (1.0 - s) * (1.0 - t) + h * (s * (1.0 - t) + (1.0 - s) * t) + m * s * t;
                d[b] = h * s * (1.0 - t) + m * s * t;
                d[c] = h * (1.0 - s) * t + m * s * t;
                let size = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                let (r0, r1) = (INNER * ratio.powi(l as i32), INNER * ratio.powi(l as i32 + 1));
                let r = r0 + 0.5 * (1.0 + xi[2]) * (r1 - r0);
                d.map(|x| r * x / size)
            };
            let nodes: Vec<u32> = ElementKind::Hex20
                .natural()
                .iter()
                .map(|xi| {
                    let x = point(*xi);
                    let next = mesh.coordinates.len() as u32;
                    let node = *known.entry(x.map(|x| (x * 1e7).round() as i64)).or_insert(next);
                    if node == next {
                        mesh.node_ids.push(next + 1);
                        mesh.coordinates.push(x);
                    }
                    node
                })
                .collect();
            let id = mesh.element_ids.len() as u32 + 1;
            mesh.push_element(id, 1, ElementKind::Hex20, &nodes);
        }
    }
    mesh
}

#[test]
fn cavity_expansion_matches_closed_form() {
    for (phi, psi) in [(30.0, 30.0), (30.0, 10.0)] {
        let exact = ClosedForm::new(20e3, phi, psi);
        let mesh = octant(3, 8);
        let mut constraints = Vec::new();
        for (n, x) in mesh.coordinates.iter().enumerate() {
            for direction in (0..3).filter(|k| x[*k].abs() < 1e-9) {
                constraints.push(Constraint { node: n as u32, direction: direction as u8, value: 0.0 });
            }
        }
        let model = model(mesh, constraints, mohr_coulomb(SOIL, 20e3, phi, psi), Quadrature::Gauss2);
        let mesh = model.mesh();
        let radius = |x: &[f64; 3]| (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
        let mut unit = vec![0.0; model.dof_count()];
        for face in mesh.boundary_faces() {
            if face.nodes().iter().all(|n| radius(&mesh.coordinates[*n as usize]) < INNER + 1e-9) {
                loads::face_pressure(mesh, &face, 1.0, &mut unit);
            }
        }
        let levels = [1.25, 1.5, 2.0];
        let last = exact.pressure(levels[2]);
        let mut pressure =
            |time: f64, load: &mut [f64]| load.iter_mut().zip(&unit).for_each(|(l, u)| *l = time * last * u);
        let mut state = State::new(&model);
        let mut solver = QuasiStatic::new(&model, tight(), StepControl::fixed(0.2)).unwrap();
        for c in levels {
            solver
                .integrate(&model, &mut state, exact.pressure(c) / last, &mut pressure, &mut |_, _, _| ())
                .unwrap();
            let wall = exact.wall(c);
            let mut worst = 0.0_f64;
            for (n, x) in mesh.coordinates.iter().enumerate() {
                if radius(x) < INNER + 1e-9 {
                    let u: f64 = (0..3).map(|k| state.u[3 * n + k] * x[k] / INNER).sum();
                    worst = worst.max((u / wall - 1.0).abs());
                }
            }
            // Bounds of the plastic radius.
            let (mut inside, mut outside) = (0.0_f64, f64::INFINITY);
            for e in 0..mesh.element_count() {
                let (x, first) = (mesh.element_coordinates(e), model.point_start(e));
                let points = trackbed_fem::element::stiffness_points(ElementKind::Hex20, Quadrature::Gauss2);
                for (i, p) in points.iter().enumerate() {
                    let at: [f64; 3] = std::array::from_fn(|k| (0..20).map(|a| p.shape[a] * x[a][k]).sum());
                    if state.points[first + i].kappa > 0.0 {
                        inside = inside.max(radius(&at));
                    } else {
                        outside = outside.min(radius(&at));
                    }
                }
            }
            println!(
                "sphere phi {phi} psi {psi} c {c}: wall {wall:.4e} m, miss {worst:.1e}; yields to {inside:.3}, not from {outside:.3}"
            );
            assert!(worst < 1e-2, "{worst:e}");
            assert!((0.5 * (inside + outside) / c - 1.0).abs() < 0.1, "{inside} {outside}");
        }
        println!("sphere: {:?}", solver.statistics());
    }
}
