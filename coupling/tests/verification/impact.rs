//! Impact of a sphere on a free block: momentum, angular momentum, energy.

use crate::support::*;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::step;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::Surface;
use trackbed_fem as fem;

const SPHERE_MASS: f64 = 1.0;
const BLOCK_MASS: f64 = 20.0;
const SIDE: f64 = 0.2;
/// Impact of about 50 periods of the block's lowest mode.
const STIFFNESS: f64 = 1e6;

struct Impact<'a> {
    coupled: Coupled<'a>,
    /// Linear and angular momentum about the origin.
    momentum: (Vec3, Vec3),
    energy: f64,
    /// ∫ u × F dt, see [`angular`].
    geometric: Vec3,
}

/// Steel-like cube, 0.2 m, 20 kg.
fn cube() -> fem::Model {
    block([4, 4, 4], [SIDE; 3], 200e9, 0.3, BLOCK_MASS / SIDE.powi(3), Held::Free, fem::Rayleigh::default())
}

/// Spheres of 3 cm without gravity, windows of `substeps` steps of `dt` [s].
fn on_cube(
    solid: &fem::Model,
    friction: f64,
    bodies: Vec<dem::BodyInput>,
    (substeps, dt): (u32, f64),
) -> Coupled<'_> {
    let grains = dem::ModelInput {
        materials: vec![material(2650.0, STIFFNESS, friction, 1.0)],
        shapes: vec![dem::Shape::Sphere { radius: 0.03 }],
        bodies,
        gravity: Vec3::zeros(),
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(dt),
        ..Default::default()
    };
    Coupled::new(solid, grains, substeps)
}

/// Window with uniform upward acceleration [m/s²].
fn push(c: &mut Coupled, acceleration: f64) {
    let solid = c.model.solid;
    let (mut unit, mut force) = (vec![0.0; solid.dof_count()], vec![0.0; solid.dof_count()]);
    unit.iter_mut().skip(2).step_by(3).for_each(|a| *a = acceleration);
    solid.mass_times(&unit, &mut force);
    c.step_loaded(&[], |_, load| load.iter_mut().zip(&force).for_each(|(l, f)| *l += f));
}

fn momentum(c: &Coupled) -> (Vec3, Vec3) {
    let grains = dem::measure::momentum(&c.model.grains, &c.state.grains);
    let (linear, angular) = fem::energy::momentum(c.model.solid, &c.state.solid);
    (grains.linear + Vec3::from(linear), grains.angular + Vec3::from(angular))
}

impl<'a> Impact<'a> {
    fn new(solid: &'a fem::Model, offset: f64, speed: f64, substeps: u32, dt: f64) -> Impact<'a> {
        let sphere = dem::BodyInput {
            position: Vec3::new(0.5 * SIDE + offset, 0.5 * SIDE, 0.03 + 1e-5 * speed),
            velocity: Vec3::new(0.0, 0.0, -speed),
            mass: Some(SPHERE_MASS),
            ..Default::default()
        };
        let coupled = on_cube(solid, 0.0, vec![sphere], (substeps, dt));
        let momentum = momentum(&coupled);
        let energy = step::stored_energy(&coupled.model, &coupled.state).total();
        Impact { coupled, momentum, energy, geometric: Vec3::zeros() }
    }

    /// Until 20 % after separation.
    fn run(&mut self) {
        let window = self.coupled.model.window();
        let contact_time =
            std::f64::consts::PI * (SPHERE_MASS * BLOCK_MASS / (SPHERE_MASS + BLOCK_MASS) / STIFFNESS).sqrt();
        for _ in 0..(1.4 * contact_time / window) as usize {
            self.coupled.step(&[]);
            if self.coupled.model.substeps == 1 {
                for c in self.coupled.work.grains.surface_contacts() {
                    let mesh = self.coupled.model.solid.mesh();
                    let face = self.coupled.work.surface.faces()[c.patch as usize];
                    let reference = face.point_and_area(mesh, c.local).0;
                    let u = Vec3::from(c.point) - Vec3::from(reference);
                    self.geometric += u.cross(&Vec3::from(c.force)) * window;
                }
            }
        }
        assert!(self.coupled.work.grains.surface_contacts().is_empty(), "the sphere has left");
    }

    fn sphere(&self) -> Vec3 {
        self.coupled.state.grains.velocity(0)
    }

    /// Relative drift of momentum, angular momentum, and angular momentum with the geometric term.
    fn drift(&self) -> (f64, f64, f64) {
        let now = momentum(&self.coupled);
        let scale = self.momentum.0.norm();
        let arm = 0.06 * scale;
        let angular = now.1 - self.momentum.1;
        (
            (now.0 - self.momentum.0).norm() / scale,
            angular.norm() / arm,
            (angular + self.geometric).norm() / arm,
        )
    }

    /// With the interface work error.
    fn energy_error(&self) -> f64 {
        let spent = step::work_and_dissipation(&self.coupled.state);
        let now = step::stored_energy(&self.coupled.model, &self.coupled.state).total();
        (now + spent.dissipated() - self.energy).abs() / self.energy
    }

    /// Vibration energy of the block over the impact energy.
    fn vibration(&self) -> f64 {
        let stored = step::stored_energy(&self.coupled.model, &self.coupled.state);
        let (p, _) = fem::energy::momentum(self.coupled.model.solid, &self.coupled.state.solid);
        let rigid = Vec3::from(p).norm_squared() / (2.0 * BLOCK_MASS);
        (stored.solid_kinetic + stored.solid_strain - rigid) / self.energy
    }
}

/// Momentum to 1e-10; rebound within 0.5 % of (m − M)/(m + M), rigid elastic; vibration below 1 %; energy to
/// 1e-5.
#[test]
fn central_impact_keeps_momentum_and_energy() {
    let solid = cube();
    let mut impact = Impact::new(&solid, 0.0, 1.0, 1, 5e-6);
    impact.run();
    let (linear, _, _) = impact.drift();
    let after = -impact.sphere().z;
    let rigid = (SPHERE_MASS - BLOCK_MASS) / (SPHERE_MASS + BLOCK_MASS);
    println!(
        "momentum drift {linear:.1e}, sphere {after:.5} against {rigid:.5} m/s, vibration {:.2e}, energy error {:.1e}",
        impact.vibration(),
        impact.energy_error()
    );
    assert!(linear < 1e-10);
    assert!((after / rigid - 1.0).abs() < 0.005);
    assert!(impact.vibration() < 0.01);
    assert!(impact.energy_error() < 1e-5);
}

/// Impulse J = (1 + e) v/(1/m + 1/M + d²/I) within 1 %.
///
/// Small strains: forces act at undeformed positions. The missing moment ∫ u × F dt is checked to 1e-8 at
/// v = 1 m/s.
#[test]
fn off_centre_impact_keeps_angular_momentum() {
    let solid = cube();
    let d = 0.06;
    let inertia = BLOCK_MASS * SIDE * SIDE / 6.0;
    for (speed, plain) in [(1.0, 1e-3), (1e-6, 1e-8)] {
        let mut impact = Impact::new(&solid, d, speed, 1, 5e-6);
        impact.run();
        let impulse = SPHERE_MASS * (impact.sphere().z + speed);
        let exact = 2.0 * speed / (1.0 / SPHERE_MASS + 1.0 / BLOCK_MASS + d * d / inertia);
        let (linear, angular, with_geometry) = impact.drift();
        println!(
            "v = {speed} m/s: impulse/exact - 1 = {:.1e}, momentum {linear:.1e}, angular momentum {angular:.1e}, with u x F {with_geometry:.1e}",
            impulse / exact - 1.0
        );
        assert!((impulse / exact - 1.0).abs() < 0.01);
        assert!(linear < 1e-10 && angular < plain && with_geometry < 1e-8);
    }
}

#[test]
fn energy_drift_of_subcycling_is_small() {
    let solid = cube();
    for (substeps, bound) in [(1, 2e-6), (10, 2e-6), (100, 1e-4)] {
        let mut impact = Impact::new(&solid, 0.0, 1.0, substeps, 2e-6);
        impact.run();
        let error = impact.energy_error();
        let interface = step::work_and_dissipation(&impact.coupled.state).interface() / impact.energy;
        println!("{substeps} sub-steps: energy error {error:.2e}, of it at the interface {interface:.2e}");
        assert!(error < bound);
        assert!(impact.drift().0 < 1e-10);
    }
}

/// 36 spheres on a block of 1 MPa for ten seconds, W = 0.3, C Δt/m = 0.5: maximum kinetic energy falls every
/// half second, to 1e-6 of the initial potential energy.
#[test]
fn quiet_packing_gains_no_energy() {
    let rayleigh = fem::Rayleigh { alpha_m: 2.0, beta_k: 1e-4 };
    let solid = block([4, 4, 2], [1.0, 1.0, 0.5], 1e6, 0.3, 2000.0, Held::Base, rayleigh);
    let wall = |at: f64, normal: Vec3| dem::Plane {
        point: Vec3::new(at, at, 0.0),
        normal,
        material: 0,
        velocity: Vec3::zeros(),
    };
    let bodies: Vec<dem::BodyInput> = (0..36)
        .map(|k| dem::BodyInput {
            position: Vec3::new(0.1 + 0.16 * f64::from(k % 6), 0.1 + 0.16 * f64::from(k / 6), 0.0795),
            ..Default::default()
        })
        .collect();
    let mut c = Coupled::new(
        &solid,
        dem::ModelInput {
            materials: vec![material(2650.0, 1e6, 0.5, 0.3)],
            shapes: vec![dem::Shape::Sphere { radius: 0.08 }],
            bodies,
            planes: vec![
                wall(0.02, Vec3::x()),
                wall(0.98, -Vec3::x()),
                wall(0.02, Vec3::y()),
                wall(0.98, -Vec3::y()),
            ],
            surface_material: Some(0),
            time_step: dem::TimeStep::Fixed(1e-4),
            ..Default::default()
        },
        2,
    );
    let potential = 36.0 * c.model.grains.mass(0) * 9.81 * 0.08;
    let windows = (0.5 / c.model.window()) as usize;
    let mut largest = [0.0_f64; 20];
    for slot in &mut largest {
        for _ in 0..windows {
            c.step(&[]);
            let stored = step::stored_energy(&c.model, &c.state);
            *slot = slot.max(stored.grains_kinetic + stored.solid_kinetic);
        }
    }
    println!(
        "largest kinetic energy per half second over the potential: {:?}",
        largest.map(|k| k / potential)
    );
    assert!(largest.windows(2).all(|pair| pair[1] < pair[0]));
    assert!(largest[19] < 1e-6 * potential);
}

#[test]
fn the_surface_moves_within_a_window() {
    let solid = cube();
    let speed = 1.0;
    let (overlap, dt) = (1e-6, 2e-6);
    let sphere = dem::BodyInput {
        // Velocities lag by half a step.
        position: Vec3::new(0.53 * SIDE, 0.48 * SIDE, 0.03 - overlap + 0.5 * dt * speed),
        velocity: Vec3::new(0.0, 0.0, speed),
        // Heavy, so unaffected by the force.
        mass: Some(1e9),
        ..Default::default()
    };
    let mut c = on_cube(&solid, 0.0, vec![sphere], (10, dt));
    c.state.solid.v.iter_mut().skip(2).step_by(3).for_each(|v| *v = speed);
    c.step(&[]);
    let force = -c.work.mean_contact_force(c.model.window())[2];
    println!("mean force over K times overlap: {}", force / (STIFFNESS * overlap));
    assert!((force / (STIFFNESS * overlap) - 1.0).abs() < 1e-6);
}

#[test]
fn lagged_surface_velocity_is_linear() {
    let solid = cube();
    let (speed, dt) = (1.0, 2e-6);
    let position = Vec3::new(0.5 * SIDE, 0.5 * SIDE, 1.0);
    let far = dem::BodyInput { position, ..Default::default() };
    let mut c = on_cube(&solid, 0.0, vec![far], (10, dt));
    c.model.scheme = Scheme::Lagged;
    c.state.solid.v.iter_mut().skip(2).step_by(3).for_each(|v| *v = speed);
    // 10,000 g: uniform acceleration.
    let acceleration = 1e5;
    push(&mut c, acceleration);
    let at = [0.5 * SIDE, 0.5 * SIDE, 0.0];
    let patch = contact(&c.work.surface, at, [0.0; 3]).patch;
    let found = c.work.surface.closest_point(patch, at, [0.0; 2]).velocity[2];
    let expected = speed + 0.95 * acceleration * 10.0 * dt;
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
}

#[test]
fn detects_contact_after_surface_jump() {
    let solid = cube();
    let (dt, substeps) = (2e-6, 10);
    let window = dt * f64::from(substeps);
    let leap = 2e-3;
    let position = Vec3::new(0.53 * SIDE, 0.48 * SIDE, 0.03 + 0.9 * leap);
    let above = dem::BodyInput { position, ..Default::default() };
    let mut c = on_cube(&solid, 0.0, vec![above], (substeps, dt));
    push(&mut c, 2.0 * leap / (window * window));
    assert!((c.state.solid.u[2] / leap - 1.0).abs() < 1e-6 && c.work.grains.surface_contacts().is_empty());
    // Only the jump causes contact.
    c.state.solid.v.fill(0.0);
    c.step(&[]);
    let mean = -c.work.mean_contact_force(window)[2];
    let all = STIFFNESS * 0.1 * leap;
    println!("mean force over that of ten sub-steps in touch: {:.4}", mean / all);
    assert!(mean > 0.95 * all, "{mean} {all}");
}

#[test]
fn stiffened_prediction_includes_slip_and_spin() {
    let solid = cube();
    let overlap = 1e-4;
    for (velocity, spin) in [(Vec3::x(), Vec3::zeros()), (Vec3::zeros(), 30.0 * Vec3::y())] {
        let missed = |scheme: Scheme| {
            let sphere = dem::BodyInput {
                position: Vec3::new(0.53 * SIDE, 0.48 * SIDE, 0.03 - overlap),
                velocity,
                spin,
                mass: Some(1e9),
                ..Default::default()
            };
            let mut c = on_cube(&solid, 1e3, vec![sphere], (10, 2e-6));
            c.model.scheme = scheme;
            // No prediction in the first window.
            c.step(&[]);
            let before = step::work_and_dissipation(&c.state).interface();
            c.step(&[]);
            step::work_and_dissipation(&c.state).interface() - before
        };
        let (stiffened, present) = (missed(Scheme::Stiffened), missed(Scheme::Predicted));
        println!(
            "velocity {velocity:?}, spin {spin:?}: interface {stiffened:.2e} J stiffened, {present:.2e} J predicted"
        );
        assert!(stiffened.abs() < 1e-3 * present.abs(), "{stiffened} {present}");
    }
}

#[test]
fn removed_grain_exerts_no_force() {
    let solid = cube();
    let iterated = Scheme::Iterated { tolerance: 1e-9, passes: 30 };
    for scheme in [Scheme::Predicted, Scheme::Lagged, Scheme::Stiffened, iterated] {
        let sphere = |x: f64| dem::BodyInput {
            position: Vec3::new(x * SIDE, 0.5 * SIDE, 0.03 - 1e-5),
            mass: Some(1e6),
            ..Default::default()
        };
        let mut c = on_cube(&solid, 0.0, vec![sphere(0.3), sphere(0.7)], (10, 2e-6));
        c.model.scheme = scheme;
        (0..2).for_each(|_| c.step(&[]));
        let both = c.work.mean_contact_force(c.model.window())[2];
        step::exchange(&c.model, &mut c.state, &mut c.work, &[0], &[]).unwrap();
        c.step(&[]);
        let one = c.work.mean_contact_force(c.model.window())[2];
        assert!(c.work.grains.surface_contacts().iter().all(|c| c.body == 1));
        assert!((one / both - 0.5).abs() < 0.01, "{scheme:?}: {one} of {both}");
    }
}
