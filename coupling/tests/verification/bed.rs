//! Point forces as a pressure; bed of spheres in a box on block B.

use crate::support::*;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;

/// Oedometric modulus E (1 − ν)/((1 + ν)(1 − 2ν)) of block B [Pa].
const OEDOMETRIC: f64 = 20e6 * 0.7 / (1.3 * 0.4);

/// Rollers on the sides, m = 8, 1000 N in n × n forces. Tolerance 0.1 %.
#[test]
fn point_forces_converge_to_pressure() {
    let solid = block_b(8, Held::BaseAndSides, fem::Rayleigh::default());
    let surface = top(&solid);
    let mut solver = fem::statics::StaticSolver::new(&solid).unwrap();
    let total = 1000.0;
    for (n, reference) in [(8_usize, 1.0969), (10, 1.0212), (16, 1.0061), (20, 1.0020), (40, 1.0002)] {
        let place = |k: usize| (k as f64 + 0.5) / n as f64;
        let force = [0.0, 0.0, -total / (n * n) as f64];
        let contacts: Vec<_> =
            (0..n * n).map(|k| contact(&surface, [place(k % n), place(k / n), 0.01], force)).collect();
        let (load, _) = nodal_load(&solid, &surface, &contacts);
        let u = solver.solve(&solid, &load).unwrap().u;
        let work: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
        let ratio = work / total / (total * 0.5 / OEDOMETRIC);
        println!("n = {n}: {ratio:.5}, reference {reference}");
        assert!((ratio / reference - 1.0).abs() < 1e-3);
    }
}

fn wall(corner: [f64; 3], along: [f64; 3], up: f64) -> dem::TriangleSurface {
    let (a, d) = (Vec3::from(corner), Vec3::from(along));
    let h = Vec3::new(0.0, 0.0, up);
    dem::TriangleSurface {
        vertices: vec![a, a + d, a + d + h, a + h],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material: 0,
        velocity: Vec3::zeros(),
    }
}

/// Contact forces equal bed weight minus wall friction within 1e-4 of the weight.
fn bed_at_rest(counts: [usize; 3], time: f64) {
    let rayleigh = fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 };
    let solid = block_b(4, Held::BaseAndSides, rayleigh);
    let spacing = 1.0 / counts[0] as f64;
    let radius = 0.49 * spacing;
    let mut random = Scatter::new(3);
    let bodies: Vec<dem::BodyInput> = (0..counts.iter().product::<usize>())
        .map(|k| {
            let at = [k % counts[0], k / counts[0] % counts[1], k / (counts[0] * counts[1])];
            let place = at.map(|i| (i as f64 + 0.5) * spacing + 0.009 * spacing * random.symmetric());
            dem::BodyInput { position: Vec3::from(place), ..Default::default() }
        })
        .collect();
    let high = (counts[2] + 1) as f64 * spacing;
    let triangles = vec![
        wall([0.0, 0.0, -0.1], [1.0, 0.0, 0.0], high + 0.1),
        wall([0.0, 1.0, -0.1], [1.0, 0.0, 0.0], high + 0.1),
        wall([0.0, 0.0, -0.1], [0.0, 1.0, 0.0], high + 0.1),
        wall([1.0, 0.0, -0.1], [0.0, 1.0, 0.0], high + 0.1),
    ];
    let stone = dem::Material { tangential_damping_ratio: 1.0, ..material(2650.0, 1e5, 0.5, 0.3) };
    let mut c = Coupled::new(
        &solid,
        dem::ModelInput {
            materials: vec![stone],
            shapes: vec![dem::Shape::Sphere { radius }],
            bodies,
            triangles,
            surface_material: Some(0),
            damping: Some(dem::LocalDamping { factor: 0.3 }),
            time_step: dem::TimeStep::Fixed(1e-4),
            ..Default::default()
        },
        5,
    );
    let window = c.model.window();
    for _ in 0..(time / window) as usize {
        c.step(&[]);
    }
    let count = c.model.grains.body_count();
    let weight: f64 = (0..count).map(|b| c.model.grains.mass(b)).sum::<f64>() * 9.81;
    let on_block: f64 = c.work.grains.surface_contacts().iter().map(|s| s.force[2]).sum();
    let on_walls: f64 = (0..4).map(|w| c.state.grains.wall_force(w).0.z).sum();
    let mean = mean_top(&solid, &c.work.surface, &c.state.solid.u);
    let exact = on_block * 0.5 / OEDOMETRIC;
    println!(
        "{count} spheres of {weight:.3} N: on the block {:.4} N, on the walls {:.4} N, balance {:.1e}; mean settlement {:.6e} m, \
         {:.1e} off; kinetic energy {:.1e} J",
        -on_block,
        -on_walls,
        (weight + on_block + on_walls) / weight,
        -mean,
        mean / exact - 1.0,
        dem::measure::energies(&c.model.grains, &c.state.grains).kinetic(),
    );
    assert!(on_walls < -1e-3 * weight, "walls with friction carry a part");
    assert!(((weight + on_block + on_walls) / weight).abs() < 1e-4);
    assert!((mean / exact - 1.0).abs() < 1e-6);
}

#[test]
#[ignore = "2,000 spheres come to rest, about 20 s"]
fn a_bed_in_a_box_rests() {
    bed_at_rest([20, 20, 5], 6.0);
}

#[test]
fn small_bed_in_a_box_rests() {
    bed_at_rest([6, 6, 3], 4.0);
}
