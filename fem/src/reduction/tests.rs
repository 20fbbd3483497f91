use super::*;
use crate::boundary::BoundaryLayer;
use crate::energy;
use crate::mesh::{Constraint, Face, Mesh};
use crate::model::{Model, ModelInput};
use crate::state::State;
use crate::statics::StaticSolver;
use crate::theta::{ReducedTheta, ThetaMethod, ThetaSolver};
use crate::{Elastic, Quadrature, Rayleigh};
use std::sync::Arc;

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

/// 1 × 1 × 0.5 m on a clamped base.
fn block(rayleigh: Rayleigh, boundaries: Vec<BoundaryLayer>) -> Model {
    let mesh = Mesh::block([3, 3, 2], [1.0, 1.0, 0.5]);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&n| mesh.coordinates[n as usize][2] == 0.0)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    Model::new(ModelInput {
        mesh,
        materials: [(1, SOIL.into())].into(),
        quadrature: Quadrature::Gauss3,
        constraints,
        rayleigh,
        boundaries,
        ..Default::default()
    })
    .unwrap()
}

fn top(model: &Model) -> Vec<Face> {
    let mesh = model.mesh();
    mesh.boundary_faces().into_iter().filter(|f| f.centre(mesh)[2] > 0.5 - 1e-9).collect()
}

fn stepper(model: &Model, reduced: Arc<ReducedModel>, theta: f64, dt: f64) -> ReducedTheta {
    ReducedTheta::new(model, reduced, theta, dt, &vec![0.0; model.dof_count()]).unwrap()
}

fn load_on(model: &Model, faces: &[Face], t: f64) -> Vec<f64> {
    let mut load = vec![0.0; model.dof_count()];
    for (k, n) in faces.iter().flat_map(|f| f.nodes()).enumerate() {
        for d in 0..3 {
            load[3 * *n as usize + d] = 100.0 * (t * 40.0 + 1.3 * k as f64 + d as f64).sin();
        }
    }
    load
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let top = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / top
}

#[test]
fn surface_condensation_is_statically_exact() {
    let model = block(Rayleigh { alpha_m: 4000.0, beta_k: 0.0 }, Vec::new());
    let faces = top(&model);
    let reduced = ReducedModel::new(&model, &faces, &faces, Reduction::Surface { modes: 0 }).unwrap();
    let e = *reduced.estimate();
    println!("{e}");
    assert!(e.pressure.abs() < 1e-9 && e.point.iter().all(|p| p.abs() < 1e-9), "{e:?}");
    assert_eq!((e.dofs, e.shapes), (model.free_dof_count(), 3 * 40));
    let load = load_on(&model, &faces, 0.0);
    let rest = StaticSolver::new(&model).unwrap().solve(&model, &load).unwrap().u;
    let mut solver = stepper(&model, Arc::new(reduced), 1.0, 1.0);
    let mut state = State::new(&model);
    for _ in 0..400 {
        solver.step(&model, &mut state, &load).unwrap();
    }
    solver.recover(&mut state);
    println!("static displacement {:.1e} off", difference(&state.u, &rest));
    assert!(difference(&state.u, &rest) < 1e-8);
}

#[test]
fn motion_in_span_matches_full_solid() {
    let model = block(Rayleigh { alpha_m: 30.0, beta_k: 2e-4 }, Vec::new());
    let faces = top(&model);
    let reduced =
        Arc::new(ReducedModel::new(&model, &faces, &faces, Reduction::Modes { modes: 12 }).unwrap());
    let modes = crate::modal::solve(&model, 12).unwrap();
    let mut pushed = vec![0.0; model.dof_count()];
    model.mass_times(&modes.shapes[7], &mut pushed);
    // This displacement is outside the basis and remains.
    let inner = model.mesh().coordinates.iter().position(|x| x[2] == 0.25).unwrap();
    let mut dead = vec![0.0; model.dof_count()];
    dead[3 * inner] = 5.0;
    let start = StaticSolver::new(&model).unwrap().solve(&model, &dead).unwrap().u;
    for theta in [0.5, 0.8] {
        let mut full = ThetaSolver::new(&model, theta, 1e-3).unwrap();
        let mut few = stepper(&model, reduced.clone(), theta, 1e-3);
        let (mut a, mut b) = (State::new(&model), State::new(&model));
        a.u.copy_from_slice(&start);
        b.u.copy_from_slice(&start);
        for step in 0..60 {
            let factor = if step < 20 { 10.0 } else { 0.0 };
            let load: Vec<f64> = dead.iter().zip(&pushed).map(|(d, p)| d + factor * p).collect();
            let (p, q) =
                (full.step(&model, &mut a, &load).unwrap(), few.step(&model, &mut b, &load).unwrap());
            let work = p.external_work.abs() + 1e-12;
            assert!((p.external_work - q.external_work).abs() < 1e-7 * work, "{p:?} {q:?}");
            assert!((p.damping_dissipation - q.damping_dissipation).abs() < 1e-7 * p.damping_dissipation);
            assert!(
                (p.numerical_dissipation - q.numerical_dissipation).abs()
                    <= 1e-7 * p.numerical_dissipation + 1e-15
            );
        }
        few.recover(&mut b);
        println!("theta {theta}: u {:.1e}, v {:.1e} off", difference(&b.u, &a.u), difference(&b.v, &a.v));
        assert!(difference(&b.u, &a.u) < 1e-7 && difference(&b.v, &a.v) < 1e-7);
    }
}

#[test]
fn energy_balances_in_the_span() {
    let sides =
        |mesh: &Mesh| mesh.boundary_faces().into_iter().filter(|f| f.centre(mesh)[0] < 1e-9).collect();
    let plain = block(Rayleigh::default(), Vec::new());
    let layer = BoundaryLayer {
        faces: sides(plain.mesh()),
        dashpot_normal: 2e5,
        dashpot_tangential: 1e5,
        spring_normal: 1e6,
        spring_tangential: 0.0,
    };
    let model = block(Rayleigh { alpha_m: 3.0, beta_k: 1e-4 }, vec![layer]);
    let faces = top(&model);
    for (reduction, theta) in [
        (Reduction::Surface { modes: 5 }, 0.5),
        (Reduction::Modes { modes: 20 }, 0.5),
        (Reduction::Modes { modes: 20 }, 0.7),
    ] {
        let reduced = Arc::new(ReducedModel::new(&model, &faces, &faces, reduction).unwrap());
        let mut solver = stepper(&model, reduced, theta, 1e-3);
        let mut state = State::new(&model);
        let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
        let (mut balance, mut work, mut absorbed) = (0.0, 0.0, 0.0);
        for step in 0..100 {
            let a =
                solver.step(&model, &mut state, &load_on(&model, &faces, 1e-3 * f64::from(step))).unwrap();
            balance +=
                a.external_work - a.damping_dissipation - a.boundary_dissipation - a.numerical_dissipation;
            work += a.external_work.abs();
            absorbed += a.boundary_dissipation;
        }
        let stored = solver.stored(&state).unwrap();
        solver.recover(&mut state);
        assert!((stored.kinetic + stored.strain - total(&state)).abs() < 1e-11 * work);
        println!("{reduction:?}: balance {:.1e} of the work", (balance - total(&state)) / work);
        assert!((balance - total(&state)).abs() < 1e-11 * work);
        assert!(absorbed > 0.0);
    }
}

#[test]
fn estimate_matches_run() {
    let model = block(Rayleigh { alpha_m: 4000.0, beta_k: 0.0 }, Vec::new());
    let faces = top(&model);
    let middle = faces
        .iter()
        .position(|f| {
            let c = f.centre(model.mesh());
            (c[0] - 0.5).abs() < 1e-9 && (c[1] - 0.5).abs() < 1e-9
        })
        .unwrap();
    let mut last = 1.0;
    for modes in [5, 40, 120] {
        let reduced =
            Arc::new(ReducedModel::new(&model, &faces, &faces, Reduction::Modes { modes }).unwrap());
        let e = *reduced.estimate();
        println!("{e}");
        assert!(e.pressure.abs() < 1e-9, "the pressure is one of the shapes");
        assert!(e.lowest < 1e-6 && e.point[2] > 0.0 && e.point[2] < last);
        last = e.point[2];
        let mut load = vec![0.0; model.dof_count()];
        crate::loads::face_point_load(&faces[middle], [0.0, 0.0], [0.0, 0.0, -1.0], &mut load);
        let rest = StaticSolver::new(&model).unwrap().solve(&model, &load).unwrap().u;
        let mut solver = stepper(&model, reduced, 1.0, 1.0);
        let mut state = State::new(&model);
        for _ in 0..400 {
            solver.step(&model, &mut state, &load).unwrap();
        }
        let under = |u: &[f64]| load.iter().zip(u).map(|(f, u)| f * u).sum::<f64>();
        let shown = 1.0 - under(&state.u) / under(&rest);
        println!("{modes} modes: point force {:.4} lost, estimated {:.4}", shown, e.point[2]);
        assert!((shown - e.point[2]).abs() < 1e-6);
    }
}

/// The static answer to the unbalanced forces is the error of slow motion, in displacement and energy.
#[test]
fn unbalanced_forces_show_error() {
    let model = block(Rayleigh { alpha_m: 40.0, beta_k: 1e-3 }, Vec::new());
    let faces = top(&model);
    let reduced = Arc::new(ReducedModel::new(&model, &faces, &faces, Reduction::Modes { modes: 5 }).unwrap());
    let (theta, dt) = (0.6, 2e-3);
    let mut full = ThetaSolver::new(&model, theta, dt).unwrap();
    let mut few = stepper(&model, reduced, theta, dt);
    let (mut a, mut b) = (State::new(&model), State::new(&model));
    let mut statics = StaticSolver::new(&model).unwrap();
    let mut found = FoundError::default();
    let (mut off, mut largest, mut energies) = (0.0_f64, 0.0_f64, [0.0_f64; 2]);
    let energy = |u: &[f64]| 0.5 * model.matrices().stiffness_form(u);
    for step in 0..200 {
        // A slow load of uneven forces.
        let rise = (f64::from(step) / 100.0).min(1.0);
        let load: Vec<f64> = load_on(&model, &faces, 0.0).iter().map(|f| f * rise).collect();
        full.step(&model, &mut a, &load).unwrap();
        few.step(&model, &mut b, &load).unwrap();
        if step % 20 == 19 {
            let out = few.out_of_balance(&model, &b, &load).unwrap();
            found.add(&model, &mut statics, &out).unwrap();
            few.recover(&mut b);
            let error: Vec<f64> = a.u.iter().zip(&b.u).map(|(a, b)| a - b).collect();
            off = error.iter().fold(off, |m, x| m.max(x.abs()));
            largest = a.u.iter().fold(largest, |m, x| m.max(x.abs()));
            energies = [energies[0].max(energy(&error)), energies[1].max(energy(&a.u))];
        }
    }
    let (shown, stress) = (off / largest, (energies[0] / energies[1]).sqrt());
    println!("displacement {shown:.3}, stress {stress:.3}; found {found:?}");
    assert!(shown > 0.05 && (found.of_displacement() / shown - 1.0).abs() < 0.1);
    assert!((found.of_stress() / stress - 1.0).abs() < 0.1);
}

#[test]
fn what_cannot_be_reduced_is_refused() {
    let model = block(Rayleigh::default(), Vec::new());
    let faces = top(&model);
    assert!(matches!(
        ReducedModel::new(&model, &faces, &faces, Reduction::Modes { modes: 0 }),
        Err(ReductionError::NoModes)
    ));
    assert!(matches!(
        ReducedModel::new(&model, &[], &[], Reduction::Surface { modes: 0 }),
        Err(ReductionError::NoSurface)
    ));
    let many = ReducedModel::new(&model, &faces, &faces, Reduction::Modes { modes: 5000 });
    assert!(matches!(many, Err(ReductionError::TooMany { shapes: 5012, .. })), "{many:?}");
}
