//! A bed of 10,000 spheres in motion against LAMMPS, under both laws.

use crate::scene::{Run, plane, stone};
use crate::tables;
use trackbed_dem::{BodyInput, Material, ModelInput, Partner, Shape, TimeStep, Vec3, measure};

/// Step, kinetic energy of translation and of rotation [J], contacts between spheres.
type Row = [f64; 4];

/// LAMMPS 2025.7.22.4: `granular hooke 1e5 0.5 tangential linear_history 28571.43 0 0.5 damping coeff_restitution`.
const HOOKE: [Row; 3] = [
    [100.0, 2.505871e-3, 2.831145e-3, 22626.0],
    [300.0, 1.387611e-3, 1.237311e-3, 22743.0],
    [500.0, 1.042335e-3, 6.630995e-4, 22991.0],
];

/// LAMMPS 2025.7.22.4: `granular hertz/material 5e7 0.5 0.25 tangential mindlin NULL 0 0.5 damping coeff_restitution`.
const HERTZ: [Row; 3] = [
    [100.0, 1.363241e-2, 4.748859e-4, 22992.0],
    [300.0, 1.019576e-1, 1.273837e-3, 22870.0],
    [500.0, 2.415391e-1, 3.265150e-3, 22771.0],
];

fn compare(material: Material, lammps: &[Row]) {
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
        assert!(off(energies.kinetic_rotation, rotation) < TOLERANCE, "{step}: {energies:?}");
        assert!(off(pairs, contacts) < 0.01, "{step}: {pairs}");
    }
}

/// The dashpots differ: that of LAMMPS is exact for a contact that may pull, ours for one that may not, and the
/// energies follow.
const TOLERANCE: f64 = 0.05;

/// The bed starts without tangential springs, slides a little, and comes to rest again.
#[test]
fn linear_bed_moves_as_in_lammps() {
    compare(Material { tangential_ratio: 2.0 / 7.0, ..stone() }, &HOOKE);
}

/// Another law than the one it was settled with: the bed springs apart.
#[test]
fn hertzian_bed_moves_as_in_lammps() {
    compare(Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..stone() }, &HERTZ);
}
