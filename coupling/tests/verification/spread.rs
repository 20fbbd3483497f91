//! Distributed load transfer over discs.

use crate::support::*;
use trackbed_coupling::step;
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::transfer::{Transfer, TransferAudit};
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_fem as fem;
use trackbed_fem::statics::StaticSolver;

const FORCE: f64 = 100.0;
const M: usize = 8;
const H: f64 = 1.0 / M as f64;

fn spread_top(model: &fem::Model, radius: f64) -> SolidSurface {
    top(model).distribute_over_discs(radius)
}

fn spread_load(model: &fem::Model, surface: &SolidSurface, c: &SurfaceContact) -> (Vec<f64>, TransferAudit) {
    let mut transfer = Transfer::new(surface);
    let mut audit = TransferAudit::default();
    let mut load = vec![0.0; model.dof_count()];
    transfer.add(surface, &[*c], 1.0, &mut audit);
    transfer.add_mean_load(surface, 1.0, &mut load);
    transfer.audit_spread(surface, 1.0, &load, &mut audit);
    (load, audit)
}

/// Deflection below a grain on the averaged surface [m].
fn seen(model: &fem::Model, surface: &mut SolidSurface, c: &SurfaceContact, u: &[f64]) -> f64 {
    let zero = vec![0.0; u.len()];
    surface.begin_window(model.mesh(), u, &zero, &zero, 1.0);
    let height = surface.place(c.patch, c.local)[2] - c.point[2];
    surface.begin_window(model.mesh(), &zero, &zero, &zero, 1.0);
    height
}

/// Traverse of 100 N, m = 8, discs of 0.6 and 1 element edges: compliance ripple below 10 % (point load 54.7
/// %); force and moment to 1e-12.
#[test]
fn the_ripple_of_discs_is_small() {
    let solid = block_b(M, Held::Base, fem::Rayleigh::default());
    let mut solver = StaticSolver::new(&solid).unwrap();
    for (radius, published) in [(0.6 * H, [0.052, 0.087]), (1.0 * H, [0.022, 0.038])] {
        let mut surface = spread_top(&solid, radius);
        for (y, published) in [0.5, 0.5 + 0.5 * H].into_iter().zip(published) {
            let mut extremes = (f64::INFINITY, 0.0_f64);
            let mut before: Option<Vec<f64>> = None;
            let mut worst = (0.0_f64, 0.0_f64);
            let dx = H / 16.0;
            for k in 0..=32 {
                let x = 0.5 - H + k as f64 * dx;
                let c = contact(&surface, [x, y, 0.05], [0.0, 0.0, -FORCE]);
                let (load, audit) = spread_load(&solid, &surface, &c);
                worst = (worst.0.max(audit.force), worst.1.max(audit.moment));
                if let Some(before) = &before {
                    let jump = load.iter().zip(before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(jump < 1.5 * (4.0 / H) * dx * FORCE, "x = {x}: jump {jump} N");
                }
                before = Some(load.clone());
                let d = -seen(&solid, &mut surface, &c, &solver.solve(&solid, &load).unwrap().u) / FORCE;
                extremes = (extremes.0.min(d), extremes.1.max(d));
            }
            let ripple = extremes.1 / extremes.0 - 1.0;
            println!(
                "radius {radius:.4} m, y = {y}: compliance {:.4e} to {:.4e} m/N, ripple {:.1} %, errors {:.1e}, {:.1e}",
                extremes.0,
                extremes.1,
                100.0 * ripple,
                worst.0,
                worst.1
            );
            assert!(ripple < 0.1 && (ripple - published).abs() < 0.005, "{ripple} against {published}");
            assert!(worst.0 < 1e-12 && worst.1 < 1e-12, "{worst:?}");
            let mut side = |x: f64| {
                let c = contact(&surface, [x, y, 0.05], [0.0, 0.0, -FORCE]);
                let (load, _) = spread_load(&solid, &surface, &c);
                seen(&solid, &mut surface, &c, &solver.solve(&solid, &load).unwrap().u)
            };
            let (left, right) = (side(0.5 - 1e-9), side(0.5 + 1e-9));
            assert!((left / right - 1.0).abs() < 1e-6, "{left} and {right}");
        }
    }
}

#[test]
fn distributed_load_conserves_force_and_moment() {
    let size = [0.6, 0.6, 0.3];
    let mut mesh = fem::Mesh::block([4, 4, 2], size);
    for x in &mut mesh.coordinates {
        x[2] -= size[2];
        if x[2] > -1e-9 {
            let (a, b) = (x[0], x[1]);
            x[0] += 0.008 * (11.0 * b + 5.0 * a).sin();
            x[1] += 0.008 * (13.0 * a + 7.0 * b).sin();
            x[2] += 0.010 * (9.0 * a + 11.0 * b).sin();
        }
    }
    let solid = model(mesh, size, 20e6, 0.3, 2000.0, Held::Free, fem::Rayleigh::default());
    let mut surface = spread_top(&solid, 0.1);
    let mut worst = (0.0_f64, 0.0_f64);
    let mut wide = 0;
    for k in 0..400 {
        let t = f64::from(k);
        // Every fourth point on a side, some on the border.
        let mut local = [(0.917 * t).sin(), (1.313 * t).cos()];
        if k % 4 == 0 {
            local[k as usize / 4 % 2] = 1.0 - 2.0 * f64::from(k / 8 % 2);
        }
        let force = [30.0 * (0.3 * t).sin(), 20.0 * (0.7 * t).cos(), -100.0];
        let patch = k % surface.faces().len() as u32;
        let point = surface.place(patch, local);
        let c = SurfaceContact {
            sphere: 0,
            body: 0,
            patch,
            local,
            point,
            force,
            dashpot: [0.0; 3],
            couple: [0.0; 3],
            overlap: 0.0,
        };
        let (load, audit) = spread_load(&solid, &surface, &c);
        worst = (worst.0.max(audit.force), worst.1.max(audit.moment));
        let outside = surface.faces()[patch as usize].nodes;
        let beyond =
            load.chunks(3).enumerate().any(|(n, l)| *l != [0.0; 3] && !outside.contains(&(n as u32)));
        wide += i32::from(beyond);
    }
    // Curved borders have no disc.
    assert!(wide > 350, "{wide} of 400 loads go beyond the touched face");
    println!("largest error of force {:.1e}, of moment {:.1e}", worst.0, worst.1);
    assert!(worst.0 < 1e-12 && worst.1 < 1e-12);
    // u = t + w × x.
    let (t, w) = (Vec3::new(1e-3, -2e-3, 5e-4), Vec3::new(2e-3, 1e-3, -3e-3));
    let rigid = |x: [f64; 3]| t + w.cross(&Vec3::from(x));
    let u: Vec<f64> = solid.mesh().coordinates.iter().flat_map(|x| <[f64; 3]>::from(rigid(*x))).collect();
    let zero = vec![0.0; u.len()];
    let x: Vec<Vec3> = (0..surface.nodes().len() as u32).map(|n| surface.position(n).into()).collect();
    surface.begin_window(solid.mesh(), &u, &zero, &zero, 1.0);
    for (n, x) in (0..).zip(&x) {
        let error = Vec3::from(surface.position(n)) - x - rigid((*x).into());
        assert!(error.norm() < 1e-14, "node {n}: {error:?}");
    }
}

#[test]
fn motion_comes_back_by_the_transpose() {
    let solid = block_b(4, Held::Free, fem::Rayleigh::default());
    let mut surface = spread_top(&solid, 0.3);
    let force = [3.0, -5.0, -11.0];
    let v: Vec<f64> = (0..solid.dof_count()).map(|i| (0.37 * i as f64).sin()).collect();
    let zero = vec![0.0; v.len()];
    for centre in [[0.5, 0.5, 0.1], [0.03, 0.61, 0.1], [0.0, 0.0, 0.1], [0.99, 0.97, 0.1]] {
        surface.begin_window(solid.mesh(), &zero, &zero, &zero, 1.0);
        let c = contact(&surface, centre, force);
        let (load, _) = spread_load(&solid, &surface, &c);
        let on_solid: f64 = load.iter().zip(&v).map(|(f, v)| f * v).sum();
        surface.begin_window(solid.mesh(), &zero, &zero, &v, 1e-9);
        let seen = surface.closest_point(c.patch, centre, c.local).velocity;
        let on_grains: f64 = force.iter().zip(seen).map(|(f, v)| f * v).sum();
        assert!((on_solid - on_grains).abs() < 1e-12 * 30.0, "{on_solid} and {on_grains}");
    }
}

#[test]
fn spreading_adds_no_energy() {
    for (radius, substeps, bound) in [(0.0, 5, 3e-4), (0.15, 5, 3e-4), (0.0, 1, 1e-5)] {
        let solid = block(
            [4, 4, 2],
            [1.0, 1.0, 0.5],
            2e6,
            0.3,
            2000.0,
            Held::Base,
            fem::Rayleigh { alpha_m: 0.0, beta_k: 1e-3 },
        );
        let mut c = Coupled::with_surface(
            &solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 1e5, 0.3, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
                bodies: vec![dem::BodyInput {
                    position: Vec3::new(0.31, 0.47, 0.09),
                    velocity: Vec3::new(1.0, 0.05, 0.0),
                    ..Default::default()
                }],
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(4e-5),
                ..Default::default()
            },
            substeps,
            spread_top(&solid, radius),
        );
        let start = step::stored_energy(&c.model, &c.state).total();
        let at_start =
            step::stored_energy(&c.model, &c.state).grains_kinetic + c.model.grains.mass(0) * 9.81 * 0.04;
        for _ in 0..7500 / substeps {
            c.step(&[]);
        }
        let spent = step::work_and_dissipation(&c.state);
        let error =
            step::stored_energy(&c.model, &c.state).total() - start + spent.dissipated() - spent.work();
        println!(
            "radius {radius}, {substeps} sub-steps: to x = {:.3}, energy error {:.1e} of {at_start:.3} J, interface {:.1e}, dashpot and friction {:.3}, {:?}",
            c.state.grains.position(0).x,
            error / at_start,
            spent.interface() / at_start,
            (spent.dashpot + spent.friction) / at_start,
            c.state.audit
        );
        assert!(error.abs() < bound * at_start && spent.interface().abs() < 0.01 * at_start);
        assert!(c.state.audit.force < 1e-12 && c.state.audit.moment < 1e-12);
        assert!(c.state.grains.position(0).x > 0.45);
    }
}
