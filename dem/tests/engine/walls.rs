//! Moving or opening walls, fixed bodies, applied forces, external surface.

use crate::scene::{Run, plane, sphere, stone, weightless};
use trackbed_dem::material::PairOverride;
use trackbed_dem::surface::{Feature, PatchPoint, Surface};
use trackbed_dem::{
    AppliedForce, BodyInput, Model, Shape, State, StepError, TimeStep, TriangleSurface, Vec3, Work, measure,
};

/// Until it rolls with 2/7 of the belt's speed.
#[test]
fn belt_drags_a_sphere() {
    for triangles in [false, true] {
        let mut input =
            weightless(trackbed_dem::Material { tangential_damping_ratio: 1.0, stiffness: 1e6, ..stone() });
        input.gravity = Vec3::new(0.0, 0.0, -9.81);
        let velocity = Vec3::new(0.2, 0.0, 0.0);
        if triangles {
            let vertices = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            input.triangles.push(TriangleSurface {
                vertices: vertices.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
                material: 0,
                velocity,
            });
        } else {
            input.planes.push(trackbed_dem::Plane { velocity, ..plane(Vec3::zeros(), Vec3::z()) });
        }
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01), Vec3::zeros()));
        let mut run = Run::new(input);
        while run.state.time < 0.3 {
            run.step();
        }
        let found = run.state.velocity(0).x / 0.2;
        assert!((found - 2.0 / 7.0).abs() < 1e-3, "{found}");
        assert!(run.state.balance.work_walls > 0.0);
    }
}

#[test]
fn opened_walls_let_grains_pass() {
    let mut input = weightless(stone());
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let vertices = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, -0.05)).to_vec();
    input.triangles.push(TriangleSurface {
        vertices,
        triangles: vec![[0, 1, 2]],
        ..TriangleSurface::default()
    });
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01), Vec3::zeros()));
    let mut run = Run::new(input);
    let until = |run: &mut Run, t: f64| {
        while run.state.time < t {
            run.step();
        }
        run.state.position(0).z
    };
    assert!((until(&mut run, 0.1) - 0.01).abs() < 1e-4);
    run.state.open_plane(0, true);
    assert!((until(&mut run, 0.5) + 0.04).abs() < 1e-4);
    run.state.open_wall(0, true);
    assert!(until(&mut run, 0.6) < -0.06);
}

#[test]
fn moving_plane_pushes_at_its_speed() {
    let mut input = weightless(trackbed_dem::Material { restitution: 0.2, ..stone() });
    input.planes.push(trackbed_dem::Plane { velocity: Vec3::x(), ..plane(Vec3::zeros(), Vec3::x()) });
    input.bodies.push(sphere(Vec3::new(0.012, 0.0, 0.0), Vec3::zeros()));
    let mut run = Run::new(input);
    while run.state.time < 0.05 {
        run.step();
    }
    let speed = run.state.velocity(0).x;
    assert!((speed - 1.2).abs() < 5e-3, "{speed}");
    run.state.set_plane_velocity(0, Vec3::zeros());
    let at = run.state.plane_point(&run.model, 0).x;
    run.steps(10);
    assert_eq!(run.state.plane_point(&run.model, 0).x, at);
}

#[test]
fn applied_force_and_its_torque() {
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::new(1.0, 2.0, 3.0), Vec3::zeros()));
    input.shapes.push(Shape::Box { half: [0.1, 0.2, 0.3] });
    input.bodies.push(BodyInput { shape: 1, ..BodyInput::default() });
    let mut run = Run::new(input);
    let n = 100;
    for _ in 0..n {
        let on = |body: usize, arm: Vec3| AppliedForce {
            body,
            force: Vec3::new(0.0, 0.0, 1e-3),
            point: run.state.position(body) + arm,
        };
        let loads = [on(1, Vec3::new(0.1, 0.0, 0.0)), on(0, Vec3::zeros()), on(1, Vec3::new(-0.1, 0.0, 0.0))];
        run.step_under(&loads);
    }
    let t = f64::from(n) * run.model.dt();
    let v = run.state.velocity(0).z;
    assert!((v - 1e-3 * t / run.model.mass(0)).abs() < 1e-12 * v.abs());
    let v = run.state.velocity(1).z;
    assert!((v - 2e-3 * t / run.model.mass(1)).abs() < 1e-12 * v.abs());
    assert!(run.state.spin(1).norm() < 1e-15);
    let e = measure::energies(&run.model, &run.state).total();
    assert!((run.state.balance.work_applied / e - 1.0).abs() < 1e-12);
}

struct Lift {
    height: f64,
    speed: f64,
}

impl Surface for Lift {
    fn candidates(&self, lo: [f64; 3], hi: [f64; 3], out: &mut Vec<u32>) {
        if lo[2] <= self.height && hi[2] >= self.height {
            out.push(0);
        }
    }
    fn closest_point(&self, _: u32, c: [f64; 3], _: [f64; 2]) -> PatchPoint {
        PatchPoint {
            point: [c[0], c[1], self.height],
            normal: [0.0, 0.0, 1.0],
            velocity: [0.0, 0.0, self.speed],
            local: [c[0], c[1]],
            feature: Feature::Face,
        }
    }
    fn max_speed(&self) -> f64 {
        self.speed.abs()
    }
    fn one_sided(&self) -> bool {
        true
    }
}

/// The power of the reported dashpot force equals the recorded loss.
#[test]
fn the_force_of_dashpots_is_distinguished() {
    let young =
        trackbed_dem::Material { young: Some(1e7), poisson: 0.3, stiffness: f64::INFINITY, ..stone() };
    for material in [stone(), young] {
        for (restitution, tangential, friction, adhesion) in [
            (1.0, 0.0, 0.5, None),
            (1.0, 0.0, 0.05, None),
            (1.0, 0.0, 0.5, Some(2.0)),
            (0.4, 0.0, 0.5, None),
            (0.4, 0.5, 1e3, None),
            (0.4, 0.5, 1e3, Some(2.0)),
        ] {
            let mut input = weightless(trackbed_dem::Material {
                restitution,
                tangential_damping_ratio: tangential,
                friction,
                ..material
            });
            input.contacts.push(PairOverride { a: 0, b: 0, adhesion, ..PairOverride::default() });
            input.surface_material = Some(0);
            input.time_step = TimeStep::Auto { fraction: 0.005 };
            input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.3, 0.0, -0.5)));
            let model = Model::new(input).unwrap();
            let (mut state, surface) = (State::new(&model), Lift { height: 0.0, speed: 0.0 });
            let mut work = Work::new(&model, &state);
            let (mut power, mut force, mut met) = (0.0, 0.0_f64, false);
            while state.time < 0.3 * std::f64::consts::PI * (model.mass(0) / 1e5).sqrt() {
                let motion = |state: &State| {
                    let arm = Vec3::new(0.0, 0.0, -state.position(0).z);
                    state.velocity(0) + state.spin(0).cross(&arm)
                };
                let before = motion(&state);
                trackbed_dem::step(&model, &mut state, &mut work, &surface, &[]).unwrap();
                for c in work.surface_contacts() {
                    let dashpot = Vec3::from(c.dashpot);
                    power += dashpot.dot(&(0.5 * (before + motion(&state)))) * model.dt();
                    // Adhesion develops within the first step.
                    if adhesion.is_none() || met {
                        force = force.max(dashpot.norm() / Vec3::from(c.force).norm());
                    }
                    met = true;
                }
            }
            let lost = state.balance.dissipated_dashpot;
            if restitution == 1.0 {
                assert!(force < 1e-9 && lost == 0.0, "{friction} {adhesion:?}: {force} {lost}");
            } else {
                let ratio = power / lost;
                assert!((ratio - 1.0).abs() < 0.01, "{restitution} {tangential} {adhesion:?}: {ratio}");
            }
        }
    }
}

#[test]
fn external_surface_lifts_grain() {
    let mut input = weightless(trackbed_dem::Material { tangential_damping_ratio: 0.5, ..stone() });
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.surface_material = Some(0);
    input.bodies.push(sphere(Vec3::new(0.3, 0.2, 0.01), Vec3::zeros()));
    let model = Model::new(input.clone()).unwrap();
    let (mut state, mut surface) = (State::new(&model), Lift { height: 0.0, speed: 0.0 });
    let mut work = Work::new(&model, &state);
    let before = measure::momentum(&model, &state);
    let total = |state: &State| {
        measure::energies(&model, state).total() + state.balance.dissipated() - state.balance.work()
    };
    let start = total(&state);
    while state.time < 0.4 {
        surface.speed = if state.time > 0.2 { 0.1 } else { 0.0 };
        trackbed_dem::step(&model, &mut state, &mut work, &surface, &[]).unwrap();
        surface.height += surface.speed * model.dt();
    }
    let contacts = work.surface_contacts();
    assert_eq!(contacts.len(), 1);
    assert_eq!((contacts[0].body, contacts[0].sphere, contacts[0].patch), (0, 0, 0));
    let weight = model.mass(0) * 9.81;
    assert!((contacts[0].force[2] / weight + 1.0).abs() < 1e-3, "{contacts:?}");
    // Lifting from rest costs m v², half of it in the impact.
    let lifted = weight * 0.1 * (state.time - 0.2) + model.mass(0) * 0.01;
    assert!((state.balance.work_surface / lifted - 1.0).abs() < 5e-3, "{}", state.balance.work_surface);
    assert!((total(&state) - start).abs() < 2e-3 * lifted, "{} {lifted}", total(&state) - start);
    let change = measure::momentum(&model, &state).linear - before.linear - state.balance.impulse().linear;
    assert!(change.norm() < 1e-12);
    assert!(state.balance.surface.linear.z > 0.0);

    input.surface_material = None;
    let model = Model::new(input).unwrap();
    let error = trackbed_dem::step(&model, &mut State::new(&model), &mut work, &surface, &[]);
    assert_eq!(error, Err(StepError::SurfaceMaterial));
}
