//! Cavity expansion in a Mohr–Coulomb ball: plastic radius and wall displacement, tolerance 1 %.
//!
//! Yu and Houlsby, Géotechnique 41 (1991), 173–183, small strain, free outer surface; structure of Hill
//! (1950). Tension positive, `al = (1 + sin phi)/(1 - sin phi)`, `Y = 2 c cos phi/(1 - sin phi)`, yield
//! `al s_t - s_r = Y`.

use crate::collapse_common::{Builder, between, graded, mohr_coulomb};
use std::collections::BTreeMap;
use trackbed_fem::TimeIntegrator;
use trackbed_fem::element::stiffness_points;
use trackbed_fem::nonlinear::{QuasiStatic, StepControl};
use trackbed_fem::{Constraint, Elastic, ElementKind, Model, ModelInput, Quadrature, State, loads};

const SOIL: Elastic = Elastic { young: 80e6, poisson: 0.3, density: 2000.0 };
const COHESION: f64 = 25e3;
const PHI: f64 = 25.0;
/// Radii [m].
const INNER: f64 = 1.0;
const OUTER: f64 = 5.0;

/// Closed form for one plastic radius.
struct Exact {
    al: f64,
    y: f64,
    s: f64,
    radius: f64,
}

impl Exact {
    fn new(radius: f64) -> Exact {
        let (sin, cos) = PHI.to_radians().sin_cos();
        let (al, y) = ((1.0 + sin) / (1.0 - sin), 2.0 * COHESION * cos / (1.0 - sin));
        let s = y / ((al - 1.0) / OUTER.powi(3) + (0.5 * al + 1.0) / radius.powi(3));
        Exact { al, y, s, radius }
    }

    /// Plastic radius for the strength `s` of the elastic field [m].
    fn radius_of(&self, s: f64) -> f64 {
        ((0.5 * self.al + 1.0) / (self.y / s - (self.al - 1.0) / OUTER.powi(3))).cbrt()
    }

    /// Radial and tangential stress [Pa].
    fn stress(&self, r: f64) -> [f64; 2] {
        if r >= self.radius {
            return [self.s * (OUTER.powi(-3) - r.powi(-3)), self.s * (OUTER.powi(-3) + 0.5 * r.powi(-3))];
        }
        let (top, power) = (self.y / (self.al - 1.0), -2.0 * (self.al - 1.0) / self.al);
        let border = self.s * (OUTER.powi(-3) - self.radius.powi(-3));
        let radial = top + (border - top) * (r / self.radius).powf(power);
        [radial, (self.y + radial) / self.al]
    }

    fn elastic_strain(&self, r: f64) -> [f64; 2] {
        let ([radial, hoop], nu) = (self.stress(r), SOIL.poisson);
        [(radial - 2.0 * nu * hoop) / SOIL.young, ((1.0 - nu) * hoop - nu * radial) / SOIL.young]
    }

    fn wall_displacement(&self, psi: f64) -> f64 {
        let sin = psi.to_radians().sin();
        let m = 2.0 * (1.0 - sin) / (1.0 + sin);
        let source = |r: f64| {
            let [radial, hoop] = self.elastic_strain(r);
            r.powf(m) * (radial + m * hoop)
        };
        let (n, h) = (400, (self.radius - INNER) / 400.0);
        let weight = |i: i32| {
            if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let integral: f64 =
            (0..=n).map(|i| weight(i) * source(INNER + h * f64::from(i))).sum::<f64>() * h / 3.0;
        let border = self.radius * self.elastic_strain(self.radius * (1.0 + 1e-12))[1];
        (border * self.radius.powf(m) - integral) / INNER.powf(m)
    }
}

fn octant(psi: f64, across: usize, first: f64, ratio: f64) -> (Model, Vec<f64>) {
    let radii: Vec<f64> = graded(OUTER - INNER, first, ratio).iter().map(|r| INNER + r).collect();
    let mut builder = Builder::default();
    for axis in 0..3 {
        builder.block([across, across, radii.len() - 1], ElementKind::Hex20, |[i, j, k]| {
            let side = |i: usize| (std::f64::consts::FRAC_PI_8 * i as f64 / across as f64).tan();
            let mut x = [0.0; 3];
            (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (1.0, side(i), side(j));
            let scale = between(&radii, k) / x.iter().map(|x| x * x).sum::<f64>().sqrt();
            x.map(|x| x * scale)
        });
    }
    let mesh = builder.mesh;
    let mut constraints = Vec::new();
    for (node, x) in mesh.coordinates.iter().enumerate() {
        for direction in (0..3).filter(|d| x[*d as usize].abs() < 1e-9) {
            constraints.push(Constraint { node: node as u32, direction, value: 0.0 });
        }
    }
    let materials: BTreeMap<u32, _> = [(1, mohr_coulomb(SOIL, COHESION, PHI, psi))].into();
    let input =
        ModelInput { mesh, materials, quadrature: Quadrature::Gauss2, constraints, ..Default::default() };
    let model = Model::new(input).unwrap();
    let mut unit = vec![0.0; model.dof_count()];
    let radius = |n: &u32| model.mesh().coordinates[*n as usize].iter().map(|x| x * x).sum::<f64>().sqrt();
    for face in model.mesh().boundary_faces() {
        if face.nodes().iter().all(|n| radius(n) < INNER + 1e-9) {
            loads::face_pressure(model.mesh(), &face, 1.0, &mut unit);
        }
    }
    (model, unit)
}

/// Radius [m], radial and mean tangential stress [Pa] and yield flag per Gauss point.
fn points(model: &Model, state: &State) -> Vec<(f64, [f64; 2], bool)> {
    let mut all = Vec::new();
    for e in 0..model.mesh().element_count() {
        let (x, kind) = (model.mesh().element_coordinates(e), model.mesh().connectivity.kind(e));
        for (i, point) in stiffness_points(kind, model.quadrature()).iter().enumerate() {
            let n = kind.shape_functions(point.xi);
            let at: [f64; 3] = std::array::from_fn(|d| n.iter().zip(&x).map(|(n, x)| n * x[d]).sum());
            let r = at.iter().map(|x| x * x).sum::<f64>().sqrt();
            let d = at.map(|x| x / r);
            let p = &state.points[model.point_start(e) + i];
            let s = p.stress;
            let radial = s[0] * d[0] * d[0]
                + s[1] * d[1] * d[1]
                + s[2] * d[2] * d[2]
                + 2.0 * (s[3] * d[0] * d[1] + s[4] * d[1] * d[2] + s[5] * d[2] * d[0]);
            all.push((r, [radial, 0.5 * (s[0] + s[1] + s[2] - radial)], p.kappa > 0.0));
        }
    }
    all
}

fn check(psi: f64) {
    let (model, unit) = octant(psi, 2, 0.15, 1.2);
    let mut pressure = |time: f64, load: &mut [f64]| {
        load.iter_mut().zip(&unit).for_each(|(l, u)| *l = time * u);
    };
    let mut state = State::new(&model);
    let last = -Exact::new(3.0).stress(INNER)[0];
    let mut solver = QuasiStatic::new(&model, Default::default(), StepControl::fixed(last / 10.0)).unwrap();
    for radius in [1.5, 2.0, 3.0] {
        let exact = Exact::new(radius);
        let p = -exact.stress(INNER)[0];
        solver.integrate(&model, &mut state, p, &mut pressure, &mut |_, _, _| ()).unwrap();
        // Work-conjugate mean: corner and mid-side nodes deviate.
        let swept: f64 = unit.iter().zip(&state.u).map(|(f, u)| f * u).sum();
        let mean = swept / (0.5 * std::f64::consts::PI * INNER * INNER);
        let mut worst = 0.0_f64;
        for (n, x) in model.mesh().coordinates.iter().enumerate() {
            let r = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            if r < INNER + 1e-9 {
                let u = (0..3).map(|d| state.u[3 * n + d] * x[d] / r).sum::<f64>();
                worst = worst.max((u / mean - 1.0).abs());
            }
        }
        let wall = exact.wall_displacement(psi);
        let all = points(&model, &state);
        let yielded = all.iter().filter(|p| p.2).fold(0.0_f64, |m, p| m.max(p.0));
        let intact = all.iter().filter(|p| !p.2).fold(f64::INFINITY, |m, p| m.min(p.0));
        let outside: Vec<f64> = all
            .iter()
            .filter(|p| p.0 > radius + 0.4)
            .map(|(r, [radial, hoop], _)| (hoop - radial) * r.powi(3) / 1.5)
            .collect();
        let found = exact.radius_of(outside.iter().sum::<f64>() / outside.len() as f64);
        println!(
            "cavity psi {psi} R {radius}: p {p:.0} Pa, wall {wall:.4e} m, error {:+.2e} (nodes {worst:.1e}); R {found:.4} ({:+.2e}), yielded to {yielded:.3}, intact from {intact:.3}",
            mean / wall - 1.0,
            found / radius - 1.0
        );
        assert!((mean / wall - 1.0).abs() < 0.01);
        assert!((found / radius - 1.0).abs() < 0.01);
        // Plastic front at R, to half an element.
        assert!(yielded < radius + 0.25 && intact > radius - 0.25);
    }
    let s = solver.statistics();
    println!(
        "cavity psi {psi}: {} elements, {} dofs, {s:?}",
        model.mesh().element_count(),
        model.free_dof_count()
    );
}

#[test]
fn spherical_cavity_associated() {
    check(PHI);
}

#[test]
fn spherical_cavity_non_associated() {
    check(5.0);
}

/// First yield: Lamé, `u = p a/(2 E) ...`.
#[test]
fn closed_form_meets_lame() {
    let exact = Exact::new(INNER);
    let [radial, hoop] = exact.stress(INNER);
    let lame = INNER * ((1.0 - SOIL.poisson) * hoop - SOIL.poisson * radial) / SOIL.young;
    assert!((exact.wall_displacement(10.0) / lame - 1.0).abs() < 1e-9);
    // Equilibrium in the plastic part.
    let (exact, r, h) = (Exact::new(2.0), 1.4, 1e-4);
    let slope = (exact.stress(r + h)[0] - exact.stress(r - h)[0]) / (2.0 * h);
    let [radial, hoop] = exact.stress(r);
    assert!((slope + 2.0 * (radial - hoop) / r).abs() < 1e-6 * slope.abs());
}
