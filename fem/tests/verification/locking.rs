//! Volumetric and shear locking: thick cylinder, cantilever, patch tests.

use crate::common::{difference, fix};
use crate::mixed::{block, distort, on_surface};
use crate::plastic_common::footing;
use std::f64::consts::FRAC_PI_2;
use trackbed_fem::TimeIntegrator;
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::nonlinear::{LoadFunctions, NewtonOptions, QuasiStatic, StepControl};
use trackbed_fem::{
    AssumedStrain, Constraint, Dilatation, DruckerPrager, Elastic, ElementKind, Material, Mesh, Model,
    ModelInput, MohrCoulomb, State, loads, statics, stress,
};

const RULES: [Quadrature; 3] = [Quadrature::Gauss2, Quadrature::Irons14, Quadrature::Gauss3];
const PLAIN: AssumedStrain = AssumedStrain { dilatation: Dilatation::Pointwise, incompatible_modes: false };
const ASSUMED: AssumedStrain = AssumedStrain { dilatation: Dilatation::Mean, incompatible_modes: true };

fn build(
    mesh: Mesh,
    constraints: Vec<Constraint>,
    material: Elastic,
    quadrature: Quadrature,
    assumed: AssumedStrain,
) -> Model {
    let materials = [(1, material.into())].into();
    Model::new(ModelInput { mesh, materials, quadrature, assumed, constraints, ..Default::default() })
        .unwrap()
}

/// Thick cylinder, radii 0.5 and 1 m, plane strain, 10 MPa (Lamé 1852; Timoshenko and Goodier, Theory of
/// Elasticity (1951), section 26): inner displacement over exact, error of nodal radial stress over the
/// pressure.
fn cylinder(
    kind: ElementKind,
    counts: [usize; 3],
    nu: f64,
    rule: Quadrature,
    assumed: AssumedStrain,
) -> (f64, f64) {
    let (young, p, a, b) = (200e9, 10e6, 0.5, 1.0);
    let mut mesh = block(kind, counts, [1.0; 3]);
    let mut constraints = fix(&mesh, &[1], |x| x[1] == 0.0);
    constraints.extend(fix(&mesh, &[0], |x| x[1] == 1.0));
    constraints.extend(fix(&mesh, &[2], |_| true));
    let inside: Vec<bool> = mesh.coordinates.iter().map(|x| x[0] == 0.0).collect();
    for c in &mut mesh.coordinates {
        let (r, (sin, cos)) = (a + (b - a) * c[0], (FRAC_PI_2 * c[1]).sin_cos());
        *c = [r * cos, r * sin, 0.25 * c[2]];
    }
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        if face.nodes().iter().all(|&n| inside[n as usize]) {
            loads::face_pressure(&mesh, &face, p, &mut load);
        }
    }
    let model = build(mesh, constraints, Elastic { young, poisson: nu, density: 1.0 }, rule, assumed);
    let u = statics::solve(&model, &load).unwrap().u;
    let factor = p * a * a / (b * b - a * a);
    let exact = (1.0 + nu) / young * factor * ((1.0 - 2.0 * nu) * a + b * b / a);
    let (mut widening, mut count, mut miss) = (0.0, 0.0, 0.0_f64);
    let stresses = stress::nodal(&model, &u);
    for (n, x) in model.mesh().coordinates.iter().enumerate() {
        let r = x[0].hypot(x[1]);
        let (c, s) = (x[0] / r, x[1] / r);
        if inside[n] {
            widening += u[3 * n] * c + u[3 * n + 1] * s;
            count += 1.0;
        }
        let t = stresses[n];
        let radial = t[0] * c * c + t[1] * s * s + 2.0 * t[3] * s * c;
        miss = miss.max((radial - factor * (1.0 - b * b / (r * r))).abs() / p);
    }
    (widening / count / exact, miss)
}

#[test]
fn nearly_incompressible_cylinders_match_lame() {
    let nu = 0.4999;
    for kind in [
        ElementKind::Hex20,
        ElementKind::Wedge15,
        ElementKind::Pyramid13,
        ElementKind::Tet10,
        ElementKind::Hex8,
    ] {
        for rule in RULES {
            let (widening, stress) = cylinder(kind, [6, 12, 1], nu, rule, ASSUMED);
            let (plain, plain_stress) = cylinder(kind, [3, 6, 1], nu, rule, PLAIN);
            println!(
                "cylinder {} {rule:?}: widening {:+.3} %, stress {stress:.3}; plain 3 × 6 {:+.2} %, {plain_stress:.3}",
                kind.name(),
                100.0 * (widening - 1.0),
                100.0 * (plain - 1.0)
            );
            assert!((widening - 1.0).abs() < 0.01, "{} {rule:?}: {widening}", kind.name());
            assert!(kind == ElementKind::Hex8 || stress < 0.05, "{} {rule:?}: {stress}", kind.name());
            let locks = match kind {
                ElementKind::Hex8 => continue,
                ElementKind::Hex20 => rule != Quadrature::Gauss2,
                _ => true,
            };
            assert_eq!(locks, plain < 0.97 || plain_stress > 0.33, "{} {rule:?}: {plain}", kind.name());
        }
    }
}

/// Tip deflection of a cantilever l = 10 h, over Euler-Bernoulli with Timoshenko's shear.
fn cantilever(
    kind: ElementKind,
    counts: [usize; 3],
    nu: f64,
    rule: Quadrature,
    assumed: AssumedStrain,
    skew: f64,
) -> f64 {
    let (l, b, h, young, force) = (10.0, 1.0, 1.0, 1e7, 100.0);
    let mut mesh = block(kind, counts, [l, b, h]);
    let constraints = {
        let mut c = fix(&mesh, &[0], |x| x[0] == 0.0);
        c.extend(fix(&mesh, &[2], |x| x[0] == 0.0 && (x[2] - 0.5 * h).abs() < 1e-9));
        c.extend(fix(&mesh, &[1], |x| x[0] == 0.0 && (x[1] - 0.5 * b).abs() < 1e-9));
        c
    };
    for c in &mut mesh.coordinates {
        let s = (c[0] / l) * (1.0 - c[0] / l) * 4.0;
        c[0] += skew * s * (c[2] - 0.5 * h);
    }
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        if face.nodes().iter().all(|&n| mesh.coordinates[n as usize][0] == l) {
            loads::face_traction(&mesh, &face, [0.0, 0.0, force / (b * h)], &mut load);
        }
    }
    let ends: Vec<usize> = (0..mesh.node_count()).filter(|&n| mesh.coordinates[n][0] == l).collect();
    let model = build(mesh, constraints, Elastic { young, poisson: nu, density: 1.0 }, rule, assumed);
    let u = statics::solve(&model, &load).unwrap().u;
    let inertia = b * h * h * h / 12.0;
    let shear = young / (2.0 * (1.0 + nu));
    let exact = force * l.powi(3) / (3.0 * young * inertia) + 1.2 * force * l / (shear * b * h);
    ends.iter().map(|&n| u[3 * n + 2]).sum::<f64>() / ends.len() as f64 / exact
}

#[test]
fn hex8_with_incompatible_modes_matches_beam() {
    for (nu, skew) in [(0.0, 0.0), (0.3, 0.0), (0.4999, 0.0), (0.0, 0.5), (0.3, 0.5), (0.4999, 0.5)] {
        let tip = |assumed| cantilever(ElementKind::Hex8, [10, 2, 4], nu, Quadrature::Gauss2, assumed, skew);
        let (found, plain) = (tip(ASSUMED), tip(PLAIN));
        println!("cantilever ν = {nu}, skew {skew}: {found:.4} of beam theory, plain {plain:.4}");
        assert!((found - 1.0).abs() < 0.02 && plain < 0.8, "{nu} {skew}: {found} {plain}");
    }
    for nu in [0.3, 0.4999] {
        for rule in RULES {
            let found = cantilever(ElementKind::Hex20, [5, 2, 2], nu, rule, ASSUMED, 0.5);
            assert!((found - 1.0).abs() < 0.01, "hex20 {rule:?} {nu}: {found}");
        }
    }
}

/// Tip deflection [m] of a fully clamped 10 × 1 × 1 cantilever; `stations` are fractions of its length.
fn clamped(kind: ElementKind, stations: &[f64], across: usize, nu: f64, assumed: AssumedStrain) -> f64 {
    let mut mesh = block(kind.linear(), [stations.len() - 1, across, across], [10.0, 1.0, 1.0]);
    for c in &mut mesh.coordinates {
        c[0] = 10.0 * stations[(c[0] / 10.0 * (stations.len() - 1) as f64).round() as usize];
    }
    let mesh = if kind.is_linear() { mesh } else { mesh.to_quadratic() };
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[0] == 0.0);
    let mut load = vec![0.0; 3 * mesh.node_count()];
    for face in mesh.boundary_faces() {
        if face.nodes().iter().all(|&n| mesh.coordinates[n as usize][0] == 10.0) {
            loads::face_traction(&mesh, &face, [0.0, 0.0, 100.0], &mut load);
        }
    }
    let elastic = Elastic { young: 1e7, poisson: nu, density: 1.0 };
    let model = build(mesh, constraints, elastic, Quadrature::Gauss2, assumed);
    let u = statics::solve(&model, &load).unwrap().u;
    u.iter().zip(&load).map(|(u, f)| u * f).sum::<f64>() / 100.0
}

#[test]
fn hex8_resolves_a_clamped_face() {
    let even = |n: usize| (0..=n).map(|k| k as f64 / n as f64).collect::<Vec<_>>();
    let graded = |n: usize| even(n).iter().map(|s| 0.4 * s + 0.6 * s * s).collect::<Vec<_>>();
    for (nu, coarse, quadratic) in [(0.3, 0.984, 0.996), (0.4999, 0.943, 0.971)] {
        let reference = clamped(ElementKind::Hex20, &graded(24), 4, nu, PLAIN);
        let hex8 =
            |stations: &[f64], assumed| clamped(ElementKind::Hex8, stations, 2, nu, assumed) / reference;
        let (deep, thin, plain) =
            (hex8(&even(10), ASSUMED), hex8(&graded(20), ASSUMED), hex8(&even(10), PLAIN));
        let hex20 = clamped(ElementKind::Hex20, &even(10), 2, nu, PLAIN) / reference;
        println!(
            "clamped, ν = {nu}: hex8 deep {deep:.4}, thin {thin:.4}, without modes {plain:.4}; hex20 {hex20:.4}"
        );
        assert!((deep - coarse).abs() < 2e-3 && (hex20 - quadratic).abs() < 2e-3, "{nu}: {deep} {hex20}");
        assert!((thin - 1.0).abs() < 5e-3 && plain < 0.8, "{nu}: {thin} {plain}");
    }
}

/// Linear surface displacement of distorted blocks gives constant stress (Irons and Razzaque 1972).
#[test]
fn patches_pass_with_assumed_strains() {
    let gradient = [[1e-3, 2e-4, -3e-4], [5e-4, -7e-4, 1e-4], [-2e-4, 6e-4, 4e-4]];
    let soil = Elastic { young: 30e6, poisson: 0.3, density: 2000.0 };
    let firm = Material::plastic(soil, DruckerPrager::von_mises(1e9));
    for kind in ElementKind::ALL {
        let mut mesh = block(kind.linear(), [2; 3], [1.0; 3]);
        let surface = on_surface(&mesh);
        distort(&mut mesh, 0.07, 11, |n| !surface[n]);
        let mesh = if kind.is_linear() { mesh } else { mesh.to_quadratic() };
        let surface = on_surface(&mesh);
        let exact: Vec<f64> = mesh
            .coordinates
            .iter()
            .flat_map(|x| gradient.map(|g: [f64; 3]| g[0] * x[0] + g[1] * x[1] + g[2] * x[2]))
            .collect();
        let constraints: Vec<Constraint> = (0..exact.len())
            .filter(|dof| surface[dof / 3])
            .map(|dof| Constraint { node: dof as u32 / 3, direction: (dof % 3) as u8, value: exact[dof] })
            .collect();
        let g = gradient;
        let shear = [g[0][1] + g[1][0], g[1][2] + g[2][1], g[2][0] + g[0][2]];
        let expected = soil.stress(&[g[0][0], g[1][1], g[2][2], shear[0], shear[1], shear[2]]);
        for rule in RULES {
            let model = build(mesh.clone(), constraints.clone(), soil, rule, ASSUMED);
            let u = statics::solve(&model, &vec![0.0; model.dof_count()]).unwrap().u;
            let points = (0..model.mesh().element_count()).flat_map(|e| stress::gauss(&model, &u, e));
            let miss = points.chain(stress::nodal(&model, &u)).map(|s| difference(&s, &expected));
            let miss = miss.fold(difference(&u, &exact), f64::max);
            assert!(miss < 1e-10, "{} {rule:?}: {miss:e}", kind.name());
        }
        // By Newton's method, in a material that could yield.
        let input = ModelInput {
            mesh,
            materials: [(1, firm.clone())].into(),
            assumed: ASSUMED,
            constraints,
            ..Default::default()
        };
        let model = Model::new(input).unwrap();
        let mut state = State::new(&model);
        state.u.fill(0.0);
        let mut solver = QuasiStatic::new(&model, NewtonOptions::default(), StepControl::fixed(1.0)).unwrap();
        let mut driven =
            LoadFunctions { load: |_: f64, _: &mut [f64]| {}, prescribed: |_: f64, _: &mut [f64]| {} };
        solver.integrate(&model, &mut state, 1.0, &mut driven, &mut |_, _, _| {}).unwrap();
        let miss = difference(&state.u, &exact);
        assert!(miss < 1e-10, "{} plastic: {miss:e}", kind.name());
    }
}

/// Pushes a strip footing 0.3 m into Tresca clay: pressure [Pa] and residuals of steps with many yielding
/// points.
fn push(linear: bool, rule: Quadrature, assumed: AssumedStrain) -> (f64, Vec<Vec<f64>>) {
    let clay = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
    let slab = footing(Material::plastic(clay, MohrCoulomb::tresca(10e3)), [3, 5, 5]).model;
    let (mut mesh, mut constraints) = (slab.mesh().clone(), slab.constraints().to_vec());
    if linear {
        let map = mesh.linear_node_map();
        let corner = |c: &Constraint| map[c.node as usize].map(|node| Constraint { node, ..*c });
        constraints = constraints.iter().filter_map(corner).collect();
        mesh = mesh.to_linear();
    }
    let materials = slab.materials().clone();
    let input = ModelInput { mesh, materials, quadrature: rule, assumed, constraints, ..Default::default() };
    let model = Model::new(input).unwrap();
    let under = |dof: u32| {
        let x = model.mesh().coordinates[dof as usize / 3];
        dof % 3 == 2 && x[2] == 0.0 && x[0] <= 1.0
    };
    let pushed: Vec<bool> = model.supports().fixed().iter().map(|(dof, _)| under(*dof)).collect();
    let mut driven = LoadFunctions {
        load: |_: f64, _: &mut [f64]| {},
        prescribed: |time: f64, values: &mut [f64]| {
            values.iter_mut().zip(&pushed).filter(|(_, p)| **p).for_each(|(v, _)| *v = -time);
        },
    };
    let options =
        NewtonOptions { force_tolerance: 1e-10, energy_tolerance: 1e-12, ..NewtonOptions::default() };
    let mut solver = QuasiStatic::new(&model, options, StepControl::fixed(0.01)).unwrap();
    let (mut state, mut residuals) = (State::new(&model), Vec::new());
    solver
        .integrate(&model, &mut state, 0.3, &mut driven, &mut |_, report, _| {
            if report.plastic_points > 20 {
                residuals.push(report.residuals.clone());
            }
        })
        .unwrap();
    let down = model.supports().fixed().iter().zip(&pushed).filter(|(_, p)| **p);
    (-down.map(|((dof, _), _)| solver.reactions()[*dof as usize]).sum::<f64>() / 0.5, residuals)
}

/// Prandtl's pressure (2 + π) c, from above on 3 + 5 by 5 elements.
#[test]
fn isochoric_plastic_flow_does_not_lock() {
    // The cohesion is half the yield stress.
    let prandtl = (2.0 + std::f64::consts::PI) * 5e3;
    let (plain, _) = push(false, Quadrature::Gauss3, PLAIN);
    for (linear, rule) in
        [(false, Quadrature::Gauss3), (false, Quadrature::Irons14), (true, Quadrature::Gauss2)]
    {
        let (pressure, steps) = push(linear, rule, ASSUMED);
        let mut last = Vec::new();
        for r in &steps {
            let r: Vec<f64> = r.iter().copied().filter(|r| *r > 1e-12).collect();
            if let [.., a, b, c] = r[..]
                && b < 1e-3
            {
                last.push((c / b).ln() / (b / a).ln());
            }
        }
        println!(
            "footing linear {linear} {rule:?}: {:.4} of Prandtl, plain full {:.4}; orders {last:.2?}",
            pressure / prandtl,
            plain / prandtl
        );
        // Below 2: the yielding set changes.
        let mean = last.iter().sum::<f64>() / last.len() as f64;
        assert!(mean > 1.6 && last.iter().all(|o| *o > 1.1), "{last:?}");
        assert!(
            (1.0..if linear { 1.35 } else { 1.2 }).contains(&(pressure / prandtl)),
            "{linear} {rule:?}: {pressure}"
        );
        assert!(linear || pressure < 0.95 * plain, "{rule:?}: {pressure} {plain}");
    }
}
