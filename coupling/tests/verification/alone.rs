//! Without contact, each side is bitwise identical to its uncoupled run.

use crate::support::*;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::step;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::NoSurface;
use trackbed_fem as fem;
use trackbed_fem::newmark::{Newmark, NewmarkSolver, initial_acceleration};
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};

/// Spheres tumbling in a box above the block.
fn heap() -> dem::ModelInput {
    let wall = |point: [f64; 3], normal: [f64; 3]| dem::Plane {
        point: point.into(),
        normal: normal.into(),
        material: 0,
        velocity: Vec3::zeros(),
    };
    let sphere = |k: u32| {
        let shift = 0.004 * (1.7 * f64::from(k)).sin();
        dem::BodyInput {
            position: Vec3::new(
                0.35 + 0.1 * f64::from(k % 4) + shift,
                0.35 + 0.1 * f64::from(k / 4 % 4) - shift,
                1.06 + 0.11 * f64::from(k / 16),
            ),
            velocity: Vec3::new(shift, 2.0 * shift, -1.0),
            ..Default::default()
        }
    };
    dem::ModelInput {
        materials: vec![material(2650.0, 1e5, 0.5, 0.5)],
        shapes: vec![dem::Shape::Sphere { radius: 0.045 }],
        bodies: (0..48).map(sphere).collect(),
        planes: vec![
            wall([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]),
            wall([0.3, 0.0, 0.0], [1.0, 0.0, 0.0]),
            wall([0.7, 0.0, 0.0], [-1.0, 0.0, 0.0]),
            wall([0.0, 0.3, 0.0], [0.0, 1.0, 0.0]),
            wall([0.0, 0.7, 0.0], [0.0, -1.0, 0.0]),
        ],
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(4e-5),
        ..Default::default()
    }
}

fn ground() -> fem::Model {
    let damping = fem::Rayleigh { alpha_m: 1.0, beta_k: 1e-4 };
    block([3, 3, 2], [1.0, 1.0, 0.5], 5e6, 0.3, 2000.0, Held::Base, damping)
}

#[test]
fn separate_sides_match_uncoupled_runs_bitwise() {
    let solid = ground();
    let load = solid.gravity_load().len();
    let push = |load: &mut [f64]| load[load.len() - 1] -= 1e3;
    const WINDOWS: usize = 300;

    let mut alone = fem::State::new(&solid);
    let mut f = vec![0.0; load];
    push(&mut f);
    let grains = dem::Model::new(heap()).unwrap();
    let window = 5.0 * grains.dt();
    let mut solver = ThetaSolver::new(&solid, 0.5, window).unwrap();
    let mut bed = dem::State::new(&grains);
    let mut scratch = dem::Work::new(&grains, &bed);
    for _ in 0..WINDOWS {
        solver.step(&solid, &mut alone, &f).unwrap();
        for _ in 0..5 {
            dem::step(&grains, &mut bed, &mut scratch, &NoSurface, &[]).unwrap();
        }
    }
    assert!(bed.balance.dissipated() > 0.1 && alone.u.iter().any(|u| u.abs() > 1e-5));
    let places = |state: &dem::State| -> Vec<[u64; 9]> {
        let three = |v: Vec3| [v.x, v.y, v.z];
        (0..48)
            .map(|b| {
                let all = [state.position(b), state.velocity(b), state.spin(b)].map(three);
                std::array::from_fn(|k| all[k / 3][k % 3].to_bits())
            })
            .collect()
    };
    let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for (scheme, radius) in [
        (Scheme::Predicted, 0.0),
        (Scheme::Predicted, 0.2),
        (Scheme::Lagged, 0.0),
        (Scheme::Stiffened, 0.0),
        (Scheme::Iterated { tolerance: 1e-6, passes: 5 }, 0.0),
    ] {
        let mut c = Coupled::with_surface(&solid, heap(), 5, top(&solid).distribute_over_discs(radius));
        c.model.scheme = scheme;
        for _ in 0..WINDOWS {
            c.step_loaded(&[], |_, load| push(load));
        }
        assert!(places(&c.state.grains) == places(&bed), "grains, {scheme:?}");
        assert!(bits(&c.state.solid.u) == bits(&alone.u), "displacements, {scheme:?}");
        assert!(bits(&c.state.solid.v) == bits(&alone.v), "velocities, {scheme:?}");
        assert_eq!(c.state.audit.exchanges, 0);
    }
}

/// Newmark ¼, ½ and the window step with mean load are the same for a load linear in each step: difference
/// below 1e-13 of the largest displacement and velocity over 500 steps, with damping.
#[test]
fn solid_without_contact_follows_newmark() {
    let solid = ground();
    const STEPS: usize = 500;
    let n = solid.dof_count();
    let load = |t: f64, load: &mut [f64]| {
        load[n - 1] -= 2e4 * t;
        load[n - 3] += 300.0;
    };
    let mut c = Coupled::new(&solid, heap(), 5);
    let window = c.model.window();
    let newmark = |beta: f64, gamma: f64| {
        let mut solver = NewmarkSolver::new(&solid, Newmark { beta, gamma }, window).unwrap();
        let mut state = fem::State::new(&solid);
        let at = |t: f64| {
            let mut f = vec![0.0; n];
            load(t, &mut f);
            f
        };
        initial_acceleration(&solid, &mut state, &at(0.0)).unwrap();
        let mut course = Vec::new();
        for k in 1..=STEPS {
            solver.step(&solid, &mut state, &at(k as f64 * window)).unwrap();
            course.push((state.u.clone(), state.v.clone()));
        }
        course
    };
    let mut coupled = Vec::new();
    for _ in 0..STEPS {
        c.step_loaded(&[], load);
        coupled.push((c.state.solid.u.clone(), c.state.solid.v.clone()));
    }
    assert_eq!(c.state.audit.exchanges, 0);
    assert!(c.state.grains.balance.dissipated() > 0.1);
    // Energy balance of the solid.
    let (stored, spent) = (step::stored_energy(&c.model, &c.state), step::work_and_dissipation(&c.state));
    let kept = stored.solid_kinetic + stored.solid_strain + spent.rayleigh;
    assert!((spent.solid_load_work / kept - 1.0).abs() < 1e-10, "{} {kept}", spent.solid_load_work);
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off = |course: &[(Vec<f64>, Vec<f64>)]| {
        let (mut u, mut v, mut du, mut dv) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        for (a, b) in coupled.iter().zip(course) {
            (u, v) = (u.max(largest(&a.0)), v.max(largest(&a.1)));
            let apart =
                |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            (du, dv) = (du.max(apart(&a.0, &b.0)), dv.max(apart(&a.1, &b.1)));
        }
        (du / u, dv / v)
    };
    let (same, other) = (off(&newmark(0.25, 0.5)), off(&newmark(0.3025, 0.6)));
    println!(
        "apart from Newmark's 1/4, 1/2: {:.1e} of u, {:.1e} of v; from 0.3025, 0.6: {:.1e} of u",
        same.0, same.1, other.0
    );
    assert!(same.0 < 1e-13 && same.1 < 1e-13, "{same:?}");
    assert!(other.0 > 1e-3, "{other:?}");
}
