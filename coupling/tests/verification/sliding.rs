//! Sphere pressed with 100 N and moved at 0.1 m/s across the elements of block B.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;
use trackbed_fem::statics::StaticSolver;

const FORCE: f64 = 100.0;
const M: usize = 8;

/// Quasi-static traverse along element borders (y = 0.5) and mid-lines (y = 0.5 + h/2). Force and moment
/// within 1e-12.
#[test]
fn a_moving_point_load_is_continuous() {
    let solid = block_b(M, Held::Base, fem::Rayleigh::default());
    let surface = top(&solid);
    let mut solver = StaticSolver::new(&solid).unwrap();
    let h = 1.0 / M as f64;
    let dx = h / 80.0;
    let mut worst_sum = (0.0_f64, 0.0_f64);
    for y in [0.5, 0.5 + 0.5 * h] {
        let mut before: Option<Vec<f64>> = None;
        let mut extremes = (f64::INFINITY, 0.0_f64);
        // Two borders, away from the block's sides.
        let steps = (2.0 * h / dx) as usize;
        for k in 0..=steps {
            let x = 0.5 - h + k as f64 * dx;
            let c = contact(&surface, [x, y, 0.05], [0.0, 0.0, -FORCE]);
            let (load, audit) = nodal_load(&solid, &surface, &[c]);
            worst_sum = (worst_sum.0.max(audit.force), worst_sum.1.max(audit.moment));
            if let Some(before) = &before {
                let jump = load.iter().zip(before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // Steepest shape function: mid-side node, |dN/dξ| = 2, ξ = 2 x/h.
                assert!(jump < 1.5 * (4.0 / h) * dx * FORCE, "x = {x}: jump {jump} N");
            }
            before = Some(load.clone());
            let d = -deflection(&surface, &c, &solver.solve(&solid, &load).unwrap().u) / FORCE;
            extremes = (extremes.0.min(d), extremes.1.max(d));
        }
        println!("y = {y}: compliance {:.4e} to {:.4e} m/N", extremes.0, extremes.1);
        if y > 0.5 {
            assert!((extremes.0 / 0.4358e-6 - 1.0).abs() < 0.005, "least {:e}", extremes.0);
            assert!((extremes.1 / 0.6739e-6 - 1.0).abs() < 0.005, "most {:e}", extremes.1);
        }
        let mut side = |x: f64| {
            let c = contact(&surface, [x, y, 0.05], [0.0, 0.0, -FORCE]);
            let (load, _) = nodal_load(&solid, &surface, &[c]);
            deflection(&surface, &c, &solver.solve(&solid, &load).unwrap().u)
        };
        let (left, right) = (side(0.5 - 1e-9), side(0.5 + 1e-9));
        println!("y = {y}: jump over the border {:.1e} of the deflection", (left / right - 1.0).abs());
        assert!((left / right - 1.0).abs() < 1e-6);
    }
    println!("largest error of force {:.1e}, of moment {:.1e}", worst_sum.0, worst_sum.1);
    assert!(worst_sum.0 < 1e-12 && worst_sum.1 < 1e-12);
}

#[test]
fn sliding_load_is_continuous_at_borders() {
    let solid = block_b(M, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 });
    let h = 1.0 / M as f64;
    for y in [0.5, 0.5 + 0.5 * h] {
        let mut c = Coupled::new(
            &solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 1e5, 0.0, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
                bodies: vec![dem::BodyInput {
                    position: Vec3::new(0.5 - 0.03, y, 0.05),
                    velocity: Vec3::new(0.1, 0.0, 0.0),
                    fixed: [true, true, false, true, true, true],
                    ..Default::default()
                }],
                gravity: Vec3::zeros(),
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(4e-5),
                ..Default::default()
            },
            5,
        );
        // At rest after 260 ms, border x = 0.5 at 300 ms.
        let mut extremes = (f64::INFINITY, 0.0_f64);
        for k in 0..1750 {
            c.step(&[(0, [0.0, 0.0, -FORCE])]);
            if k >= 1300 {
                assert_eq!(c.work.grains.surface_contacts().len(), 1, "step {k}");
                let force = c.work.mean_contact_force(c.model.window())[2].abs();
                extremes = (extremes.0.min(force), extremes.1.max(force));
            }
        }
        let x = c.state.grains.position(0).x;
        println!(
            "y = {y}: to x = {x:.4} m, force {:.4} to {:.4} N, {:?}",
            extremes.0, extremes.1, c.state.audit
        );
        assert!((x - 0.505).abs() < 1e-6, "moved to {x}");
        assert!(extremes.0 > FORCE - 0.5 && extremes.1 < FORCE + 0.5);
        assert!(c.state.audit.force < 1e-12 && c.state.audit.moment < 1e-12);
    }
}
