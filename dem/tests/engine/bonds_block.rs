//! Compression of a block of 6331 bonded spheres against other programs.
//!
//! Block of `inputs/geo/rock-ucs`: 0.36 m cube, 19,480 bonds at gaps below 1 mm, fixed grips. LAMMPS
//! (2025-07-22, `bond_style bpm/rotational`, same bonds, step and speed 0.01 m/s):
//! (F_top − F_bottom)/2 = 7.858e7 N per unit strain between 6.94e-5 and 2.22e-4, peak 2.906e4 N at 4.03e-4.
//! YADE: 7.61e7 N, Kratos: 8.89e7 N.

use crate::scene::Run;
use std::path::Path;
use trackbed_dem::bond::{Bond, BondDamping, BondInput, Criterion, DirectBond, within_gap};
use trackbed_dem::{BodyInput, Material, ModelInput, Shape, TimeStep, Vec3};

const LAMMPS_SLOPE: f64 = 7.858e7;
const LAMMPS_PEAK: f64 = 2.906e4;
const HEIGHT: f64 = 0.36;

fn block(speed: f64) -> ModelInput {
    let mut input = ModelInput {
        materials: vec![Material {
            density: 2600.0,
            stiffness: 1e6,
            tangential_ratio: 2.0 / 7.0,
            friction: 0.5,
            restitution: 0.5,
            ..Material::default()
        }],
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        gravity: Vec3::zeros(),
        time_step: TimeStep::Fixed(2e-6),
        ..ModelInput::default()
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../inputs/geo/rock-ucs");
    for (part, name) in ["rock", "bottom", "top"].into_iter().enumerate() {
        let text = std::fs::read_to_string(folder.join(format!("{name}.csv"))).expect("a packing");
        for line in text.lines().skip(1) {
            let v: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
            input.bodies.push(BodyInput {
                position: Vec3::new(v[0], v[1], v[2]),
                scale: v[3],
                part: part as u32,
                fixed: [part > 0; 6],
                velocity: if part == 2 { -Vec3::z() * speed } else { Vec3::zeros() },
                ..BodyInput::default()
            });
        }
    }
    let spheres: Vec<_> = input.bodies.iter().map(|b| (b.position, b.scale)).collect();
    let pairs = within_gap(&spheres, 1e-3, |_, _| true);
    assert_eq!((spheres.len(), pairs.len()), (6331, 19480));
    input.bonds = pairs.iter().map(|&[a, b]| BondInput::new(a, b, 0)).collect();
    input.bond_kinds.push(Bond::Direct(DirectBond {
        stiffness: [1.5708e7, 6.2832e6, 392.70, 314.16],
        strength: [62.83, 125.66, 0.15708, 0.31416],
        criterion: Criterion::Sum,
        damping: BondDamping::Coefficients([80.0, 80.0, 4e-5, 2e-3]),
        contact: false,
    }));
    input
}

fn compress(speed: f64, to: f64) -> (Run, Vec<(f64, f64)>) {
    let mut run = Run::new(block(speed));
    let parts: Vec<u32> = (0..run.model.body_count()).map(|b| run.model.part(b)).collect();
    let mut curve = Vec::new();
    while run.state.time * speed / HEIGHT < to {
        run.steps(25);
        let mut force = [0.0; 3];
        for (b, part) in parts.iter().enumerate() {
            force[*part as usize] += run.work.contact_force(&run.state, b).z;
        }
        curve.push((run.state.time * speed / HEIGHT, 0.5 * (force[2] - force[1])));
    }
    (run, curve)
}

fn slope(curve: &[(f64, f64)], from: f64, to: f64) -> f64 {
    let points: Vec<_> = curve.iter().filter(|p| p.0 >= from && p.0 <= to).collect();
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let (xy, xx) =
        points.iter().fold((0.0, 0.0), |s, p| (s.0 + (p.0 - x) * (p.1 - y), s.1 + (p.0 - x) * (p.0 - x)));
    xy / xx
}

#[test]
fn stiffness_of_a_bonded_block() {
    let (run, curve) = compress(0.02, 2.22e-4);
    let found = slope(&curve, 6.94e-5, 2.22e-4);
    println!(
        "block: {found:.4e} N per unit strain, {:.3} of LAMMPS; limit of the step {:.2e} s",
        found / LAMMPS_SLOPE,
        run.model.dt_limit().dt
    );
    assert!((found / LAMMPS_SLOPE - 1.0).abs() < 0.05, "{found:e}");
}

#[test]
#[ignore = "50 million sphere-steps, about 15 s"]
fn strength_of_a_bonded_block() {
    let (mut run, curve) = compress(0.01, 6e-4);
    let found = slope(&curve, 6.94e-5, 2.22e-4);
    let peak = curve.iter().fold((0.0, 0.0), |m, p| if p.1 > m.1 { *p } else { m });
    let breaks = run.state.take_breaks();
    println!(
        "block: {found:.4e} N per unit strain; peak {:.4e} N at strain {:.3e}; {} bonds left, {:?} broken by tension and shear; \
         energy of the breaks {:.3} J",
        peak.1,
        peak.0,
        run.state.bond_count(),
        run.state.broken_bonds(),
        breaks.iter().map(|b| b.energy).sum::<f64>()
    );
    for p in curve.iter().step_by(10) {
        println!("{:.4e} {:.1}", p.0, p.1);
    }
    assert!((found / LAMMPS_SLOPE - 1.0).abs() < 0.05, "{found:e}");
    // LAMMPS gives broken pairs the contact of their total overlap.
    assert!((peak.1 / LAMMPS_PEAK - 1.0).abs() < 0.1, "{}", peak.1);
    assert!((peak.0 / 4.03e-4 - 1.0).abs() < 0.1, "{}", peak.0);
}
