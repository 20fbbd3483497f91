//! Packing measures against closed forms, balances and random points.

use crate::scene::{Run, plane, sphere, stone, weightless};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;
use trackbed_dem::insert::container::Container;
use trackbed_dem::insert::gradation::{Gradation, achieved_passing};
use trackbed_dem::insert::lattice::Lattice;
use trackbed_dem::insert::radius_expansion::{Growth, grow};
use trackbed_dem::insert::random_placement::scatter;
use trackbed_dem::measure::{self, BoxRegion};
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::{BodyInput, LocalDamping, Material, Model, Partner, Shape, State, Vec3};

/// Compressed beyond jamming: Love–Weber stress is minus the wall pressure to 1e-8.
#[test]
fn mean_stress_equals_wall_pressure() {
    let (low, high) = (Vec3::new(0.0, -0.05, 0.02), Vec3::new(0.1, 0.06, 0.11));
    let container = Container::Box { low, high };
    let radii: Vec<f64> = (0..200).map(|k| 0.0085 + 0.002 * f64::from(k % 5) / 4.0).collect();
    let solid: f64 = radii.iter().map(|r| 4.0 / 3.0 * PI * r.powi(3)).sum();
    let factor = (0.68 * container.volume() / solid).cbrt();
    let start: Vec<f64> = radii.iter().map(|r| 0.5 * factor * r).collect();
    let places = scatter(&container, &start, 2).unwrap();
    let shape = Shape::Sphere { radius: 1.0 };
    let body = |(p, r): (&Vec3, &f64)| BodyInput { position: *p, scale: factor * r, ..BodyInput::default() };
    let bodies: Vec<BodyInput> = places.iter().zip(&radii).map(body).collect();
    let how = Growth { unbalanced: 1e-4, ..Growth::default() };
    let grown = grow(&container, std::slice::from_ref(&shape), &bodies, stone(), &how).unwrap();

    let mut input = weightless(Material { friction: 0.0, ..stone() });
    input.shapes = vec![shape];
    input.bodies = grown.bodies;
    for n in [Vec3::x(), Vec3::y(), Vec3::z()] {
        input.planes.extend([plane(low, n), plane(high, -n)]);
    }
    input.damping = Some(LocalDamping { factor: 0.5 });
    let mut run = Run::new(input);
    let mut ratio = 1.0;
    while ratio > 1e-10 && run.state.steps < 200_000 {
        (0..200).for_each(|_| run.step());
        ratio = measure::unbalanced_ratio(&run.model, &run.state, &measure::contacts(&run.model, &run.state));
    }
    assert!(ratio < 1e-10, "{ratio:e} after {} steps", run.state.steps);

    let contacts = measure::contacts(&run.model, &run.state);
    let mut walls = [0.0; 6];
    for c in &contacts {
        if let Partner::Plane(k) = c.b {
            walls[k] += c.normal_force;
        }
    }
    let region = BoxRegion { low, high };
    let bodies = measure::mean_stress_of(&run.model, &run.state, &contacts);
    let stress = measure::region_stress(&run.model, &run.state, &bodies, &region);
    let side = high - low;
    for d in 0..3 {
        let area = side.iter().product::<f64>() / side[d];
        for force in &walls[2 * d..2 * d + 2] {
            let pressure = force / area;
            let error = (stress[d] + pressure).abs() / pressure;
            println!(
                "direction {d}: stress {:.9e}, pressure {pressure:.9e} Pa, difference {error:.1e}",
                stress[d]
            );
            assert!(pressure > 100.0 && error < 1e-8, "{d}: {} {pressure}", stress[d]);
        }
    }
    let middle = 0.5 * (low + high);
    let left = BoxRegion { low, high: Vec3::new(middle.x, high.y, high.z) };
    let right = BoxRegion { low: Vec3::new(middle.x, low.y, low.z), high };
    let [l, r] = [left, right].map(|b| measure::region_stress(&run.model, &run.state, &bodies, &b));
    for k in 0..6 {
        assert!((0.5 * (l[k] + r[k]) - stress[k]).abs() < 1e-12 * stress[0].abs(), "{k}");
    }
    assert!((l[0] / stress[0] - 1.0).abs() < 0.3);
}

/// σ_zz = −F 2r/V, other components zero.
#[test]
fn one_sphere_between_two_planes() {
    let (r, overlap) = (0.01, 1e-4);
    let mut input = weightless(stone());
    input.bodies = vec![sphere(Vec3::zeros(), Vec3::zeros())];
    input.planes =
        vec![plane(Vec3::z() * -(r - overlap), Vec3::z()), plane(Vec3::z() * (r - overlap), -Vec3::z())];
    let mut run = Run::new(input);
    run.step();
    let force = 1e5 * overlap;
    let volume = 4.0 / 3.0 * PI * r.powi(3);
    let stress = measure::mean_stress(&run.model, &run.state)[0];
    let expected = -force * 2.0 * (r - overlap) / volume;
    assert!((stress[2] / expected - 1.0).abs() < 1e-12, "{stress:?} {expected}");
    assert!([0, 1, 3, 4, 5].iter().all(|&k| stress[k].abs() < 1e-9 * stress[2].abs()));
    let contacts = measure::contacts(&run.model, &run.state);
    assert!(measure::unbalanced_ratio(&run.model, &run.state, &contacts) < 1e-12);
    assert_eq!(measure::fabric(&contacts, |_| true), [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let c = measure::coordination_of(&run.model, &run.state, &contacts, |_| true);
    assert_eq!((c.mean, c.mechanical, c.rattlers, c.distribution), (2.0, 2.0, 0.0, vec![0, 0, 1]));
}

/// Half the overlap leaves half the weight unbalanced.
#[test]
fn unbalanced_force_of_a_resting_sphere() {
    for (share, expected) in [(1.0, 0.0), (0.5, 1.0), (2.0, 0.5)] {
        let mut input = weightless(stone());
        input.gravity = Vec3::new(0.0, 0.0, -9.81);
        input.bodies = vec![sphere(Vec3::zeros(), Vec3::zeros())];
        let weight = 2600.0 * 4.0 / 3.0 * PI * 1e-6 * 9.81;
        input.planes = vec![plane(Vec3::z() * -(0.01 - share * weight / 1e5), Vec3::z())];
        let mut run = Run::new(input);
        trackbed_dem::find_contacts(
            &run.model,
            &mut run.state,
            &mut run.work,
            &trackbed_dem::surface::NoSurface,
        )
        .unwrap();
        let contacts = measure::contacts(&run.model, &run.state);
        let ratio = measure::unbalanced_ratio(&run.model, &run.state, &contacts);
        // The dashpot adds 1 %: half a step of free fall.
        assert!((ratio - expected).abs() < 0.02, "{share}: {ratio}");
    }
}

#[test]
fn coordination_and_fabric_of_lattices() {
    for (lattice, inside) in [(Lattice::Simple, 6), (Lattice::Hexagonal, 12), (Lattice::FaceCentred, 12)] {
        let n = 8;
        let mut input = weightless(stone());
        let at = |p: Vec3| BodyInput { scale: 1.0 + 1e-6, ..sphere(p, Vec3::zeros()) };
        input.bodies = lattice.block(Vec3::zeros(), 0.01, [n; 3]).into_iter().map(at).collect();
        // Rattlers: one alone, two in contact.
        input.bodies.push(sphere(Vec3::repeat(-1.0), Vec3::zeros()));
        input.bodies.push(sphere(Vec3::repeat(-2.0), Vec3::zeros()));
        input.bodies.push(sphere(Vec3::repeat(-2.0) + Vec3::x() * 0.0199, Vec3::zeros()));
        let mut run = Run::new(input);
        trackbed_dem::find_contacts(
            &run.model,
            &mut run.state,
            &mut run.work,
            &trackbed_dem::surface::NoSurface,
        )
        .unwrap();
        let contacts = measure::contacts(&run.model, &run.state);
        let all = measure::coordination_of(&run.model, &run.state, &contacts, |_| true);
        assert_eq!(all.distribution.iter().sum::<usize>(), 515);
        assert_eq!(all.distribution[..2], [1, 2]);
        assert!((all.rattlers - 3.0 / 515.0).abs() < 1e-15);
        assert!((all.mechanical * 512.0 - (all.mean * 515.0 - 2.0)).abs() < 1e-9);
        let core = measure::coordination_of(&run.model, &run.state, &contacts, |b| {
            b < 512 && [b % n, b / n % n, b / n / n].iter().all(|k| (1..n - 1).contains(k))
        });
        assert_eq!((core.mean, core.distribution.len()), (f64::from(inside), inside as usize + 1));
        if lattice == Lattice::Simple {
            let expected = [1, 2, 0, 8, 12 * 6, 6 * 36, 216];
            assert_eq!(all.distribution, expected);
            let fabric = measure::fabric(&contacts, |c| c.a < 512);
            assert!(fabric[..3].iter().all(|f| (f - 1.0 / 3.0).abs() < 1e-12), "{fabric:?}");
        }
        let strong = measure::strong_network(&contacts);
        assert!(strong.mean_force > 0.0 && strong.load <= 1.0);
    }
}

#[test]
fn clumps_cut_by_a_region() {
    let clump = Clump::from_spheres(&[
        ([0.0; 3], 0.4),
        ([0.3, 0.1, 0.0], 0.3),
        ([-0.1, 0.3, 0.2], 0.25),
        ([0.0, -0.2, -0.3], 0.2),
    ])
    .unwrap();
    let whole = clump.volume;
    let mut input = weightless(stone());
    input.shapes = vec![Shape::Clump(clump)];
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.8, 2.0);
    input.bodies =
        vec![BodyInput { orientation: turn, position: Vec3::new(1.0, 2.0, 3.0), ..BodyInput::default() }];
    let model = Model::new(input).unwrap();
    let state = State::new(&model);
    let spheres = state.spheres(&model, 0);
    let mut rng = Pcg64Mcg::new(8);
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let everywhere = BoxRegion { low: Vec3::repeat(-9.0), high: Vec3::repeat(9.0) };
    assert_eq!(measure::solid_volume(&model, &state, &everywhere), whole);
    for low in [Vec3::new(0.9, 2.05, 2.8), Vec3::new(1.1, 1.5, 3.0), Vec3::new(0.3, 1.9, 2.9)] {
        let region = BoxRegion { low, high: low + Vec3::new(0.8, 0.5, 0.6) };
        let n = 1_000_000;
        let mut inside = 0;
        for _ in 0..n {
            let p = region.low + Vec3::new(unit() * 0.8, unit() * 0.5, unit() * 0.6);
            inside += usize::from(spheres.iter().any(|(c, r)| (p - c).norm_squared() < r * r));
        }
        let share = f64::from(inside as u32) / n as f64;
        let sampled = region.volume() * share;
        let error = 4.0 * region.volume() * (share * (1.0 - share) / n as f64).sqrt();
        let found = measure::solid_volume(&model, &state, &region);
        assert!((found - sampled).abs() < error + 5e-4 * whole, "{found} {sampled} {error}");
        assert!(found > 0.05 * whole);
    }
    let parts: f64 = [-9.0, 1.1]
        .map(|x| {
            let high = Vec3::new(if x < 0.0 { 1.1 } else { 9.0 }, 9.0, 9.0);
            measure::solid_volume(&model, &state, &BoxRegion { low: Vec3::new(x, -9.0, -9.0), high })
        })
        .iter()
        .sum();
    assert!((parts / whole - 1.0).abs() < 1e-3, "{parts} {whole}");
}

#[test]
fn porosity_of_spheres_against_random_points() {
    let container = Container::Box { low: Vec3::zeros(), high: Vec3::repeat(0.2) };
    let radii: Vec<f64> = (0..150).map(|k| 0.01 + 0.01 * f64::from(k % 4) / 3.0).collect();
    let places = scatter(&container, &radii, 6).unwrap();
    let mut input = weightless(stone());
    let body = |(p, r): (&Vec3, &f64)| BodyInput { scale: r / 0.01, ..sphere(*p, Vec3::zeros()) };
    input.bodies = places.iter().zip(&radii).map(body).collect();
    let model = Model::new(input).unwrap();
    let state = State::new(&model);
    let region = BoxRegion { low: Vec3::new(0.03, 0.05, 0.02), high: Vec3::new(0.15, 0.17, 0.16) };
    let mut rng = Pcg64Mcg::new(2);
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let n = 1_000_000;
    let mut void = 0;
    for _ in 0..n {
        let p = region.low + Vec3::from_fn(|d, _| unit() * (region.high[d] - region.low[d]));
        void += usize::from(places.iter().zip(&radii).all(|(c, r)| (p - c).norm_squared() >= r * r));
    }
    let sampled = f64::from(void as u32) / n as f64;
    let found = measure::porosity(&model, &state, &region);
    println!("porosity {found:.6}, by {n} random points {sampled:.6}");
    // Four standard errors.
    assert!((found - sampled).abs() < 4.0 * (0.25 / n as f64).sqrt(), "{found} {sampled}");
}

#[test]
fn sieve_sizes_match_gradation() {
    let curve = Gradation::new(&[0.02, 0.03, 0.05], &[0.0, 0.4, 1.0]).unwrap();
    let clump = Clump::from_spheres(&[([0.0; 3], 0.4), ([0.5, 0.0, 0.0], 0.35)]).unwrap();
    let unit = 1.0 / clump.sieve_size();
    let mut input = weightless(stone());
    input.shapes = vec![Shape::Clump(clump), Shape::Box { half: [0.1; 3] }];
    let at = |k: usize| Vec3::x() * k as f64;
    let body = |(k, size): (usize, f64)| BodyInput { scale: size * unit, ..sphere(at(k), Vec3::zeros()) };
    input.bodies = curve.sample(1000, 4).into_iter().enumerate().map(body).collect();
    input.bodies.push(BodyInput { shape: 1, ..sphere(at(2000), Vec3::zeros()) });
    let model = Model::new(input).unwrap();
    let stones = measure::stones(&model, |_| true);
    assert_eq!(stones.len(), 1000);
    for (found, target) in achieved_passing(curve.sizes(), &stones).iter().zip(curve.passing()) {
        assert!((found - target).abs() < 2e-3, "{found} {target}");
    }
}
