//! Bed of 10,000 moving spheres against LAMMPS, both laws.

use crate::scene::{Run, plane, stone};
use crate::tables;
use trackbed_dem::{BodyInput, Material, ModelInput, Partner, Shape, TimeStep, Vec3, measure};

/// Step, translational and rotational energy [J], sphere contacts.
type Row = [f64; 4];

/// LAMMPS 2025.7.22.4: `granular hooke 1e5 0.5 tangential linear_history 28571.43 0 0.5 damping
/// coeff_restitution limit_damping`.
const HOOKE: [Row; 3] = [
    [100.0, 2.518890e-3, 2.843043e-3, 22613.0],
    [300.0, 1.396416e-3, 1.246152e-3, 22729.0],
    [500.0, 1.048952e-3, 6.700455e-4, 22976.0],
];

/// LAMMPS 2025.7.22.4: `granular hertz/material 5e7 0.5 0.25 tangential mindlin NULL 0 0.5 damping
/// coeff_restitution limit_damping`.
const HERTZ: [Row; 3] = [
    [100.0, 1.363379e-2, 4.757038e-4, 22985.0],
    [300.0, 1.019664e-1, 1.276847e-3, 22857.0],
    [500.0, 2.415534e-1, 3.270692e-3, 22757.0],
];

/// LAMMPS' dashpot for 0.5 without tension, ζ = −ln e/√(π² + ln² e): 0.550 (Schwager & Pöschel 2007).
fn restitution() -> f64 {
    let log = 0.5_f64.ln();
    let zeta = -log / std::f64::consts::PI.hypot(log);
    trackbed_dem::law::restitution::restitution(zeta)
}

fn compare(material: Material, lammps: &[Row], rotation_tolerance: f64) {
    let mut input = ModelInput {
        materials: vec![material],
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        time_step: TimeStep::Fixed(2e-5),
        ..ModelInput::default()
    };
    for row in tables::read("../benches/data/s1_10k.csv") {
        let position = Vec3::new(row[0], row[1], row[2]);
        input.bodies.push(BodyInput { position, scale: row[3], ..BodyInput::default() });
    }
    let far = Vec3::repeat(0.42);
    input.planes = vec![
        plane(Vec3::zeros(), Vec3::x()),
        plane(Vec3::zeros(), Vec3::y()),
        plane(Vec3::zeros(), Vec3::z()),
        plane(far, -Vec3::x()),
        plane(far, -Vec3::y()),
    ];
    let mut run = Run::new(input);
    for &[step, translation, rotation, contacts] in lammps {
        while run.state.steps < step as u64 {
            run.step();
        }
        let energies = measure::energies(&run.model, &run.state);
        let found = measure::contacts(&run.model, &run.state);
        let pairs = found.iter().filter(|c| matches!(c.b, Partner::Body(_))).count() as f64;
        println!(
            "{step}: {:.4e} + {:.4e} J, {pairs} contacts; LAMMPS {translation:.4e} + {rotation:.4e} J, {contacts}",
            energies.kinetic_translation, energies.kinetic_rotation
        );
        let off = |ours: f64, theirs: f64| (ours / theirs - 1.0).abs();
        assert!(off(energies.kinetic_translation, translation) < TOLERANCE, "{step}: {energies:?}");
        assert!(off(energies.kinetic_rotation, rotation) < rotation_tolerance, "{step}: {energies:?}");
        assert!(off(pairs, contacts) < 0.01, "{step}: {pairs}");
    }
}

/// Rearrangements of 10,000 spheres differ; the contact laws do not.
const TOLERANCE: f64 = 0.02;

#[test]
fn linear_bed_moves_as_in_lammps() {
    compare(
        Material { tangential_ratio: 2.0 / 7.0, restitution: restitution(), ..stone() },
        &HOOKE,
        TOLERANCE,
    );
}

/// Under growing overlap trackbed keeps the tangential force, LAMMPS' `mindlin` the spring length: possible
/// cause of 3 % in rotation.
#[test]
fn hertzian_bed_moves_as_in_lammps() {
    let material = Material { young: Some(5e7), poisson: 0.25, restitution: restitution(), ..stone() };
    compare(Material { stiffness: f64::INFINITY, ..material }, &HERTZ, 0.05);
}
