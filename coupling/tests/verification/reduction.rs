//! Reduced against full solid in the coupled step.

use crate::support::*;
use std::sync::Arc;
use trackbed_coupling::step;
use trackbed_fem as fem;
use trackbed_fem::reduction::{ReducedModel, Reduction};

const PULSE: f64 = 0.05;
const SETTLING: f64 = 0.3;

fn pulse(solid: &fem::Model, reduction: Option<Reduction>) -> (f64, f64, f64) {
    let mut c = Coupled::new(solid, sleeper_on_a_bed(2, 5e-5), 5);
    if let Some(reduction) = reduction {
        let faces = c.work.surface.faces();
        let reduced = Arc::new(ReducedModel::new(solid, faces, faces, reduction).expect("a reduction"));
        println!("{reduction:?}: {}", reduced.estimate());
        c.work.reduce(&c.model, reduced).expect("the same solid");
        assert!(c.work.reduction().is_some());
    }
    let node = solid
        .mesh()
        .coordinates
        .iter()
        .position(|x| (x[0] - 0.5).abs() + (x[1] - 0.5).abs() + x[2].abs() < 1e-9)
        .expect("a node in the middle of the top");
    let start = c.work.stored_energy(&c.model, &c.state);
    let (mut ground, mut sleeper, mut rest) = (0.0_f64, 0.0_f64, 0.0);
    while c.state.solid.time < SETTLING + PULSE {
        let time = c.state.solid.time;
        let on = if time < SETTLING {
            rest = c.state.grains.position(0).z;
            0.0
        } else {
            5000.0 * (std::f64::consts::PI * (time - SETTLING) / PULSE).sin()
        };
        c.step(&[(0, [0.0, 0.0, -on])]);
        if time >= SETTLING {
            ground = ground.max(-c.state.solid.u[3 * node + 2]);
            sleeper = sleeper.max(rest - c.state.grains.position(0).z);
        }
    }
    let (now, spent) = (c.work.stored_energy(&c.model, &c.state), step::work_and_dissipation(&c.state));
    let error = now.total() - start.total() + spent.dissipated() - spent.work();
    (ground, sleeper, error.abs() / (start.grains_gravity - now.grains_gravity + spent.work()))
}

#[test]
fn a_reduced_block_matches_full() {
    let solid = block_b(4, Held::Base, fem::Rayleigh { alpha_m: 20.0, beta_k: 2e-4 });
    let full = pulse(&solid, None);
    println!("full: ground {:.4e} m, sleeper {:.4e} m, energy {:.1e}", full.0, full.1, full.2);
    for (reduction, ground, sleeper) in
        [(Reduction::Surface { modes: 20 }, 0.01, 0.01), (Reduction::Modes { modes: 60 }, 0.1, 0.1)]
    {
        let few = pulse(&solid, Some(reduction));
        println!(
            "{reduction:?}: ground {:.4e} m ({:+.2} %), sleeper {:.4e} m ({:+.2} %), energy {:.1e}",
            few.0,
            100.0 * (few.0 / full.0 - 1.0),
            few.1,
            100.0 * (few.1 / full.1 - 1.0),
            few.2
        );
        assert!((few.0 / full.0 - 1.0).abs() < ground && (few.1 / full.1 - 1.0).abs() < sleeper);
        assert!(few.2 < 0.01 && full.2 < 0.01);
    }
}
