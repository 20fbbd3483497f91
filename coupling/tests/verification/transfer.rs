//! Nodal loads of a point force on the surface.

use crate::support::*;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_fem::{Mesh, Rayleigh};

/// Distorted, curved faces.
fn rough_block() -> trackbed_fem::Model {
    let size = [0.6, 0.6, 0.3];
    let mut mesh = Mesh::block([3, 3, 2], size);
    let wave = |a: f64, b: f64| (7.3 * a + 3.1 * b).sin();
    for x in &mut mesh.coordinates {
        x[2] -= size[2];
        if x[2] > -1e-9 {
            let (a, b) = (x[0], x[1]);
            x[0] += 0.012 * wave(11.0 * b, 5.0 * a);
            x[1] += 0.012 * wave(13.0 * a, 7.0 * b);
            x[2] += 0.010 * wave(9.0 * a + 1.0, 11.0 * b);
        }
    }
    model(mesh, size, 20e6, 0.3, 2000.0, Held::Free, Rayleigh::default())
}

fn at(surface: &SolidSurface, patch: u32, local: [f64; 2], force: [f64; 3]) -> SurfaceContact {
    let point = surface.place(patch, local);
    SurfaceContact {
        sphere: 0,
        body: 0,
        patch,
        local,
        point,
        force,
        couple: [0.0; 3],
        dashpot: [0.0; 3],
        overlap: 0.0,
    }
}

/// Σ Fᵢ = F and Σ xᵢ × Fᵢ = p × F to 1e-13; only nodes of the face.
#[test]
fn conserves_force_and_moment() {
    let model = rough_block();
    let surface = top(&model);
    let mut worst = (0.0_f64, 0.0_f64);
    for k in 0..1000 {
        let t = f64::from(k);
        let local = [(0.917 * t).sin(), (1.313 * t).cos()];
        let force = [30.0 * (0.3 * t).sin(), 20.0 * (0.7 * t).cos(), -100.0];
        let patch = k % surface.faces().len() as u32;
        let (load, audit) = nodal_load(&model, &surface, &[at(&surface, patch, local, force)]);
        worst = (worst.0.max(audit.force), worst.1.max(audit.moment));
        let sum = load.iter().skip(2).step_by(3).sum::<f64>();
        assert!((sum - force[2]).abs() < 1e-13 * 100.0);
        let face = surface.faces()[patch as usize];
        for (n, l) in load.chunks(3).enumerate() {
            assert!(l == [0.0; 3] || face.nodes.contains(&(n as u32)));
        }
    }
    println!("largest error of force {:.1e}, of moment {:.1e}", worst.0, worst.1);
    assert!(worst.0 < 1e-13 && worst.1 < 1e-13);
}

#[test]
fn the_audit_sees_a_moment_error() {
    let model = rough_block();
    let surface = top(&model);
    let mut wrong = at(&surface, 0, [0.2, 0.3], [0.0, 0.0, -100.0]);
    wrong.point[0] += 1e-3;
    let (_, audit) = nodal_load(&model, &surface, &[wrong]);
    assert!(audit.force < 1e-13 && audit.moment > 1e-4, "{audit:?}");
}

#[test]
fn shared_edges_give_equal_loads() {
    let model = rough_block();
    let surface = top(&model);
    let force = [10.0, -5.0, -100.0];
    let (mut shared, mut worst) = (0, 0.0_f64);
    for (a, fa) in surface.faces().iter().enumerate() {
        for side in 0..4 {
            for s in [-1.0, -0.6, 0.0, 0.37, 1.0] {
                let local = [[s, -1.0], [1.0, s], [-s, 1.0], [-1.0, -s]][side];
                let here = at(&surface, a as u32, local, force);
                let (load, _) = nodal_load(&model, &surface, &[here]);
                for (b, fb) in surface.faces().iter().enumerate() {
                    let neighbour = b != a && fb.nodes.contains(&fa.nodes[4 + side]);
                    let corner = s.abs() == 1.0 && {
                        let k = if s < 0.0 { side } else { (side + 1) % 4 };
                        b != a && fb.nodes.contains(&fa.nodes[k])
                    };
                    if !(neighbour || corner) {
                        continue;
                    }
                    let there = surface.closest_point(b as u32, here.point, [0.0; 2]);
                    let (other, _) =
                        nodal_load(&model, &surface, &[at(&surface, b as u32, there.local, force)]);
                    let difference = load.iter().zip(&other).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                    worst = worst.max(difference / 100.0);
                    shared += 1;
                }
            }
        }
    }
    println!("{shared} shared points, largest difference {worst:.1e} F");
    assert!(shared > 100 && worst < 1e-14);
}

#[test]
fn face_pressure_is_impulse_per_area() {
    let solid = block_b(4, Held::Base, Rayleigh::default());
    let surface = top(&solid);
    let mut transfer = trackbed_coupling::transfer::Transfer::new(&surface);
    let at = |x: f64, y: f64, down: f64| contact(&surface, [x, y, 0.01], [30.0, -20.0, -down]);
    let contacts = [at(0.3, 0.3, 100.0), at(0.45, 0.4, 60.0), at(0.6, 0.3, 150.0)];
    transfer.add(&surface, &contacts, 1e-3, &mut Default::default());
    let found = transfer.peak_face_pressure(&surface, 2e-3);
    assert!((found / (160.0 * 1e-3 / 2e-3 / 0.0625) - 1.0).abs() < 1e-12, "{found}");
}

/// Interface dashpot error of force D in four sub-steps h, predicted v after w, computed s: 4 D h (v − s) + D
/// h (v − w)/2, in every window.
#[test]
fn dashpot_error_matches_closed_form() {
    let solid = block_b(4, Held::Base, Rayleigh::default());
    let surface = top(&solid);
    let mut transfer = trackbed_coupling::transfer::Transfer::new(&surface);
    let dashpot = [3.0, -2.0, -7.0];
    let touch = SurfaceContact { dashpot, ..contact(&surface, [0.3, 0.4, 0.01], [3.0, -2.0, -50.0]) };
    let (h, v, w, s) = (1e-3, [0.5, 0.1, 0.3], [0.2, -0.1, 0.7], [0.4, 0.3, -0.2]);
    let exact = |strength: f64| -> f64 {
        (0..3).map(|d| strength * dashpot[d] * h * (4.0 * (v[d] - s[d]) + 0.5 * (v[d] - w[d]))).sum()
    };
    for strength in [1.0, 2.0, -0.5] {
        transfer.begin_window();
        for _ in 0..4 {
            let touch = SurfaceContact { dashpot: dashpot.map(|c| strength * c), ..touch };
            transfer.add(&surface, &[touch], h, &mut Default::default());
        }
        let found = transfer.interface_dashpot_error(&surface, |i| v[i % 3], |i| w[i % 3], |i| s[i % 3]);
        assert!((found / exact(strength) - 1.0).abs() < 1e-12, "{found} against {}", exact(strength));
    }
}
