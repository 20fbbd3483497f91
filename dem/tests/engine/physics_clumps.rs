//! A bed of 1,000 clumps in motion against LAMMPS.

use crate::scene::{Run, plane, stone};
use crate::tables;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::{BodyInput, Material, ModelInput, Partner, Shape, TimeStep, Vec3, measure};

/// Step, translational and rotational energy [J], clump contacts: LAMMPS 2025.7.22.4, `fix rigid/small`,
/// `gran/hooke/history 1e5 28571.43 584.8 0 0.5 1` (584.8 1/s: e = 0.5 of two clumps), `fix gravity ...
/// disable`, mass and inertia of the union from 0.25 mm cubes.
const LAMMPS: [[f64; 4]; 5] = [
    [100.0, 0.095266, 0.055476, 3537.0],
    [300.0, 0.143807, 0.022757, 3475.0],
    [500.0, 0.170994, 0.015025, 3418.0],
    [700.0, 0.151869, 0.012982, 3258.0],
    [1000.0, 0.079173, 0.010797, 3041.0],
];

/// Initial differences: 4 µm (cubes' centre of mass) and wall dashpots; 5 % of energies, 1 % of contacts.
#[test]
fn clump_bed_matches_lammps() {
    let spheres: Vec<_> =
        tables::read("../benches/data/s2_clump.csv").iter().map(|s| ([s[0], s[1], s[2]], s[3])).collect();
    let clump = Clump::from_spheres(&spheres).unwrap();
    let mut input = ModelInput {
        materials: vec![Material { tangential_ratio: 2.0 / 7.0, ..stone() }],
        shapes: vec![Shape::Clump(clump)],
        time_step: TimeStep::Fixed(2e-5),
        ..ModelInput::default()
    };
    for row in tables::read("../benches/data/s2_1k.csv") {
        let turn = nalgebra::Quaternion::new(row[3], row[4], row[5], row[6]);
        input.bodies.push(BodyInput {
            position: Vec3::new(row[0], row[1], row[2]),
            orientation: nalgebra::UnitQuaternion::new_normalize(turn),
            ..BodyInput::default()
        });
    }
    let far = Vec3::repeat(0.4);
    input.planes = vec![
        plane(Vec3::zeros(), Vec3::x()),
        plane(Vec3::zeros(), Vec3::y()),
        plane(Vec3::zeros(), Vec3::z()),
        plane(far, -Vec3::x()),
        plane(far, -Vec3::y()),
    ];
    let mut run = Run::new(input);
    for [step, translation, rotation, contacts] in LAMMPS {
        while run.state.steps < step as u64 {
            run.step();
        }
        let energies = measure::energies(&run.model, &run.state);
        let found = measure::contacts(&run.model, &run.state);
        let pairs = found.iter().filter(|c| matches!(c.b, Partner::Body(_))).count() as f64;
        println!("{step}: {energies:?} {pairs}");
        let off = |ours: f64, theirs: f64| (ours / theirs - 1.0).abs();
        assert!(off(energies.kinetic_translation, translation) < 0.05, "{step}: {energies:?}");
        assert!(off(energies.kinetic_rotation, rotation) < 0.07, "{step}: {energies:?}");
        assert!(off(pairs, contacts) < 0.01, "{step}: {pairs}");
    }
}
