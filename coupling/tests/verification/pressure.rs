//! Contact forces on block B: settlement and compliance against references.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;

/// Reciprocity: with rollers on the sides, the mean top displacement is Σ F H/(A E_oed) for any vertical
/// forces. Tolerance 1e-8.
#[test]
fn mean_settlement_matches_oedometers() {
    let solid = block_b(4, Held::BaseAndSides, fem::Rayleigh::default());
    let surface = top(&solid);
    let (young, poisson) = (20e6, 0.3);
    let oedometric = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    let contacts: Vec<_> = (0..23)
        .map(|k| {
            let t = f64::from(k);
            let at = [0.5 + 0.49 * (1.7 * t).sin(), 0.5 + 0.49 * (2.9 * t).cos(), 0.03];
            contact(&surface, at, [0.0, 0.0, -(1.0 + (0.6 * t).sin().abs())])
        })
        .collect();
    let total: f64 = contacts.iter().map(|c| c.force[2]).sum();
    let (load, _) = nodal_load(&solid, &surface, &contacts);
    let u = fem::statics::solve(&solid, &load).unwrap().u;
    let (mean, exact) = (mean_top(&solid, &surface, &u), total * 0.5 / oedometric);
    println!("mean settlement {mean:.10e} m, exact {exact:.10e} m, difference {:.1e}", mean / exact - 1.0);
    assert!((mean / exact - 1.0).abs() < 1e-8);
}

#[test]
fn point_load_compliance_matches_reference() {
    for (m, corner, face, edge) in
        [(4, 5.10e-7, 2.03e-7, 3.20e-7), (8, 1.053e-6, 4.36e-7, 6.73e-7), (12, 1.598e-6, 6.72e-7, 1.028e-6)]
    {
        let solid = block_b(m, Held::Base, fem::Rayleigh::default());
        let surface = top(&solid);
        let mut solver = fem::statics::StaticSolver::new(&solid).unwrap();
        let h = 1.0 / m as f64;
        let mut compliance = |x: f64, y: f64| {
            let c = contact(&surface, [x, y, 0.01], [0.0, 0.0, -1.0]);
            let (load, _) = nodal_load(&solid, &surface, &[c]);
            -deflection(&surface, &c, &solver.solve(&solid, &load).unwrap().u)
        };
        for (name, x, y, reference) in [
            ("corner", 0.5, 0.5, corner),
            ("mid-face", 0.5 + 0.5 * h, 0.5 + 0.5 * h, face),
            ("mid-edge", 0.5 + 0.5 * h, 0.5, edge),
        ] {
            let value = compliance(x, y);
            println!("m = {m}, {name}: {value:.4e} m/N, reference {reference:.4e}");
            assert!((value / reference - 1.0).abs() < 0.005);
        }
    }
}

struct Patch {
    solid: fem::Model,
    surface: trackbed_coupling::surface::SolidSurface,
    /// 2,500 N on a patch of 0.5 × 0.5 m.
    consistent: Vec<f64>,
}

const TOTAL: f64 = 2500.0;

impl Patch {
    fn new(m: usize) -> Patch {
        let solid = block_b(m, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 });
        let surface = top(&solid);
        let mut consistent = vec![0.0; solid.dof_count()];
        for f in surface.faces() {
            let centre = f.centre(solid.mesh());
            if (centre[0] - 0.5).abs() < 0.25 && (centre[1] - 0.5).abs() < 0.25 {
                fem::loads::face_pressure(solid.mesh(), f, TOTAL / 0.25, &mut consistent);
            }
        }
        Patch { solid, surface, consistent }
    }

    /// Mean patch settlement [m].
    fn mean(&self, u: &[f64]) -> f64 {
        self.consistent.iter().zip(u).map(|(f, u)| f * u).sum::<f64>() / TOTAL
    }

    /// Settlement of the nearest top node [m].
    fn at(&self, u: &[f64], x: f64, y: f64) -> f64 {
        let node = self
            .solid
            .mesh()
            .coordinates
            .iter()
            .position(|p| (p[0] - x).abs() + (p[1] - y).abs() + p[2].abs() < 1e-9)
            .expect("a node there");
        -u[3 * node + 2]
    }
}

#[test]
fn patch_settlement_meets_the_reference() {
    for (m, mean, centre, corner) in
        [(8, 1.3420e-4, 1.6890e-4, 5.8181e-5), (12, 1.3495e-4, 1.6924e-4, 5.8227e-5)]
    {
        let patch = Patch::new(m);
        let u = fem::statics::solve(&patch.solid, &patch.consistent).unwrap().u;
        let found = [patch.mean(&u), patch.at(&u, 0.5, 0.5), patch.at(&u, 0.25, 0.25)];
        println!("m = {m}: patch mean {:.5e}, centre {:.5e}, corner {:.5e} m", found[0], found[1], found[2]);
        for (value, reference) in found.into_iter().zip([mean, centre, corner]) {
            assert!((value / reference - 1.0).abs() < 1e-4, "{value:e} against {reference:e}");
        }
        if m != 8 {
            continue;
        }
        for (n, ratio) in [(4, 1.0331), (8, 1.0083), (12, 1.0037), (24, 1.0009), (48, 1.0002)] {
            let place = |k: usize| 0.25 + (k as f64 + 0.5) * 0.5 / n as f64;
            let force = [0.0, 0.0, -TOTAL / (n * n) as f64];
            let contacts: Vec<_> = (0..n * n)
                .map(|k| contact(&patch.surface, [place(k % n), place(k / n), 0.01], force))
                .collect();
            let (load, _) = nodal_load(&patch.solid, &patch.surface, &contacts);
            let u = fem::statics::solve(&patch.solid, &load).unwrap().u;
            let measured = patch.mean(&u) / found[0];
            println!("n = {n}: {measured:.4} of the consistent load's, reference {ratio}");
            assert!((measured / ratio - 1.0).abs() < 0.002);
        }
    }
}

#[test]
fn spheres_settle_as_point_forces() {
    let patch = Patch::new(8);
    let consistent = patch.mean(&fem::statics::solve(&patch.solid, &patch.consistent).unwrap().u);
    for (n, ratio) in [(4_usize, 1.0331), (8, 1.0083)] {
        let place = |k: usize| 0.25 + (k as f64 + 0.5) * 0.5 / n as f64;
        let radius = 0.025;
        let bodies: Vec<dem::BodyInput> = (0..n * n)
            .map(|k| dem::BodyInput {
                position: Vec3::new(place(k % n), place(k / n), radius),
                fixed: [true, true, false, true, true, true],
                mass: Some(1.0),
                ..Default::default()
            })
            .collect();
        let mut c = Coupled::new(
            &patch.solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 1e5, 0.0, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius }],
                bodies,
                gravity: Vec3::zeros(),
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(4e-5),
                ..Default::default()
            },
            5,
        );
        let applied: Vec<_> = (0..n * n).map(|b| (b, [0.0, 0.0, -TOTAL / (n * n) as f64])).collect();
        for _ in 0..2500 {
            c.step(&applied);
        }
        let (load, _) = nodal_load(&patch.solid, &c.work.surface, c.work.grains.surface_contacts());
        let alone = patch.mean(&fem::statics::solve(&patch.solid, &load).unwrap().u);
        let settled = patch.mean(&c.state.solid.u);
        println!(
            "n = {n}: {:.4} of the consistent load's, reference {ratio}; solid alone {:.1e} off",
            settled / consistent,
            settled / alone - 1.0
        );
        assert!((settled / consistent / ratio - 1.0).abs() < 0.002);
        assert!((settled / alone - 1.0).abs() < 1e-9);
    }
}
