//! Packing fraction and coordination of poured spheres by friction.

use crate::scene::{Random, Run, plane, stone, weightless};
use trackbed_dem::{BodyInput, Material, Partner, Shape, TimeStep, Vec3, measure};

const D: f64 = 0.01;
const WIDTH: f64 = 0.12;

/// Packing fraction and coordination, without rattlers (fewer than `least` contacts).
fn pour(mu: f64, least: usize) -> (f64, f64) {
    let mut input = weightless(Material { stiffness: 1e5, friction: mu, restitution: 0.5, ..stone() });
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    input.time_step = TimeStep::Auto { fraction: 0.5 };
    input.shapes[0] = Shape::Sphere { radius: 0.5 * D };
    let mut random = Random::new(3);
    let pitch = 0.012;
    for k in 0..2500 {
        let cell = Vec3::new(f64::from(k % 10), f64::from(k / 10 % 10), f64::from(k / 100));
        input.bodies.push(BodyInput {
            position: (cell + Vec3::repeat(0.5)) * pitch + random.vector() * 4e-4,
            scale: 1.0 + 0.05 * (2.0 * random.unit() - 1.0),
            velocity: random.vector() * 0.2,
            ..BodyInput::default()
        });
    }
    let far = Vec3::repeat(WIDTH);
    input.planes = vec![
        plane(Vec3::zeros(), Vec3::x()),
        plane(Vec3::zeros(), Vec3::y()),
        plane(Vec3::zeros(), Vec3::z()),
        plane(far, -Vec3::x()),
        plane(far, -Vec3::y()),
    ];
    let mut run = Run::new(input);
    while run.state.time < 1.0 {
        run.step();
    }
    let kinetic = measure::energies(&run.model, &run.state).kinetic();
    let centres: Vec<(Vec3, f64)> =
        (0..run.model.body_count()).map(|b| (run.state.position(b), run.model.radius(b))).collect();
    let top = {
        let mut z: Vec<f64> = centres.iter().map(|c| c.0.z).collect();
        z.sort_by(f64::total_cmp);
        z[z.len() * 9 / 10]
    };
    let (low, high) = (Vec3::repeat(2.0 * D), Vec3::new(WIDTH - 2.0 * D, WIDTH - 2.0 * D, top - D));
    let inside = |p: &Vec3| (0..3).all(|k| p[k] > low[k] && p[k] < high[k]);

    // Solid fraction by points.
    let near: Vec<_> =
        centres.iter().filter(|c| (0..3).all(|k| c.0[k] > low[k] - D && c.0[k] < high[k] + D)).collect();
    let mut inside_solid = 0;
    let points = 40_000;
    for _ in 0..points {
        let p = low + (high - low).component_mul(&Vec3::new(random.unit(), random.unit(), random.unit()));
        inside_solid += usize::from(near.iter().any(|(c, r)| (p - c).norm_squared() < r * r));
    }
    let fraction = f64::from(inside_solid as u32) / f64::from(points);

    // Removes rattlers iteratively.
    let pairs: Vec<[usize; 2]> = measure::contacts(&run.model, &run.state)
        .iter()
        .filter_map(|c| if let Partner::Body(b) = c.b { Some([c.a, b]) } else { None })
        .collect();
    let mut loose = vec![false; centres.len()];
    let counts = loop {
        let mut counts = vec![0; centres.len()];
        for &[a, b] in pairs.iter().filter(|p| !loose[p[0]] && !loose[p[1]]) {
            counts[a] += 1;
            counts[b] += 1;
        }
        let new: Vec<usize> =
            (0..centres.len()).filter(|&b| !loose[b] && counts[b] < least && inside(&centres[b].0)).collect();
        if new.is_empty() {
            break counts;
        }
        new.iter().for_each(|&b| loose[b] = true);
    };
    let held: Vec<usize> = (0..centres.len()).filter(|&b| !loose[b] && inside(&centres[b].0)).collect();
    let coordination = held.iter().map(|&b| counts[b] as f64).sum::<f64>() / held.len() as f64;
    println!(
        "mu = {mu}: phi = {fraction:.4}, Z = {coordination:.3} of {} spheres, kinetic {kinetic:.2e} J",
        held.len()
    );
    (fraction, coordination)
}

/// Frictionless: random close packing, φ = 0.64, Z = 6 (isostatic). μ = 0.5: φ ≈ 0.59, Z ≈ 4.6 (Silbert,
/// Ertaş, Grest, Halsey & Levine 2002, Phys. Rev. E 65, 031304; Silbert 2010, Soft Matter 6, 2918).
#[test]
#[ignore = "two beds of 2,500 spheres for 1 s: 30 s"]
fn friction_loosens_packings_as_published() {
    let frictionless = pour(0.0, 4);
    let rough = pour(0.5, 2);
    assert!((frictionless.0 - 0.64).abs() < 0.015, "{frictionless:?}");
    assert!((frictionless.1 - 6.0).abs() < 0.35, "{frictionless:?}");
    assert!((rough.0 - 0.59).abs() < 0.02, "{rough:?}");
    assert!((rough.1 - 4.6).abs() < 0.35, "{rough:?}");
}
