//! Random strain walks: admissible stress, non-negative plastic work, finite values.

use super::*;
use trackbed_fem::material::yield_function;

/// Largest `f` over the stress and smallest plastic work over `|sigma||d eps_p|`.
fn walk(name: &str, material: &Material, strength: f64, size: f64, steps: usize, seed: u64) -> (f64, f64) {
    let mut random = Random(seed);
    let mut state = PointState::default();
    let (mut outside, mut work) = (f64::NEG_INFINITY, f64::INFINITY);
    for count in 0..steps {
        // A pull to the origin bounds the mean stress.
        let jump = if count % 50 == 0 { 100.0 } else { 1.0 };
        let mut increment = random_strain(&mut random, size * jump, size * jump);
        let p = (state.stress[0] + state.stress[1] + state.stress[2]) / 3.0;
        if p.abs() > 30.0 * strength {
            increment[..3].iter_mut().for_each(|e| *e -= p.signum() * size * 5.0);
        }
        // Keeps all digits of this step's plastic strain.
        state.plastic_strain = [0.0; 6];
        let response =
            update(material, &state, &increment, count % 7 == 0).unwrap_or_else(|e| panic!("{name}: {e}"));
        let new = response.state;
        let all = new.stress.iter().chain(&new.plastic_strain).chain(response.tangent.iter().flatten());
        assert!(all.into_iter().all(|x| x.is_finite()), "{name}: {response:?}");
        let stress = norm(&new.stress).max(strength);
        let f = yield_function(material, &new) / stress;
        outside = outside.max(f);
        assert!(f <= 1e-9, "{name} step {count}: f {f:.1e} {response:?}");
        let flow = new.plastic_strain;
        let elastic = material.elastic.stress(&std::array::from_fn(|k| increment[k] - flow[k]));
        let (lambda, mu) = material.elastic.lame();
        // Rounding of the mean stress is amplified by the bulk modulus.
        let stiff = (lambda.abs() + 2.0 * mu) / mu;
        let trial = stiff * norm(&material.elastic.stress(&increment)).max(stress).max(norm(&state.stress));
        assert!(
            (0..6).all(|k| (state.stress[k] + elastic[k] - new.stress[k]).abs() <= 1e-14 * trial),
            "{name}"
        );
        let square: f64 = (0..6).map(|k| if k < 3 { 1.0 } else { 0.5 } * flow[k] * flow[k]).sum();
        let growth = (2.0 / 3.0 * square).sqrt();
        let rounding = 1e-15 * (new.kappa + trial / (lambda.abs() + 2.0 * mu));
        assert!((new.kappa - state.kappa - growth).abs() <= 1e-12 * growth + rounding, "{name}: {growth:e}");
        if !response.region.is_plastic() {
            assert!(growth == 0.0);
            state = new;
            continue;
        }
        assert!(f >= -1e-9, "{name} step {count}: inside {f:.1e} {response:?}");
        let done: f64 = (0..6).map(|k| new.stress[k] * flow[k]).sum::<f64>() / (norm(&flow) * stress);
        // Above rounding.
        if norm(&flow) > 1e-9 * norm(&increment) {
            work = work.min(done);
            assert!(done >= -1e-9, "{name} step {count}: {done:.1e} {response:?}");
        }
        state = new;
    }
    (outside, work)
}

#[test]
fn walks_of_all_laws() {
    let (mut outside, mut work, mut steps) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for (name, material, _) in laws() {
        let (f, w) = walk(name, &material, COHESION, 2e-4, 10_000, 41);
        (outside, work, steps) = (outside.max(f), work.min(w), steps + 10_000);
    }
    println!(
        "{steps} steps: largest f/|sigma| {outside:.1e}, smallest sigma:d eps_p/(|sigma||d eps_p|) {work:.1e}"
    );
}

#[test]
fn walks_at_the_extremes() {
    let (mut outside, mut work, mut count) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for (phi, psi) in
        [(60.0, 60.0), (60.0, 0.0), (85.0, 30.0), (1e-9, 0.0), (1e-9, 1e-9), (0.01, 0.0), (0.0, 0.0)]
    {
        for (unit, poisson) in [(1.0, 0.3), (1e-9, 0.3), (1e12, 0.3), (1.0, 0.4999), (1.0, 0.0), (1.0, -0.5)]
        {
            for tension in [None, Some(0.05), Some(0.0)] {
                let elastic = Elastic { young: 2500.0 * unit, poisson, density: 0.0 };
                let tension = tension.map(|t| t * unit);
                let mc = mohr_coulomb(unit, phi, psi, tension);
                let dp = drucker_prager(unit, phi, psi, Cone::Compression, tension);
                for material in [Material::plastic(elastic, mc), Material::plastic(elastic, dp)] {
                    assert_eq!(material.invalid_constant(), None);
                    let name = format!("phi {phi} psi {psi} unit {unit:e} nu {poisson} {tension:?}");
                    let (f, w) = walk(&name, &material, unit, 2e-4, 1000, 43);
                    (outside, work, count) = (outside.max(f), work.min(w), count + 1);
                }
            }
        }
    }
    println!(
        "{count} walks of 1000 steps: largest f/|sigma| {outside:.1e}, smallest plastic work {work:.1e}"
    );
}

#[test]
fn rejects_non_finite_numbers() {
    for (_, material, _) in laws() {
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e305] {
            let result = update(&material, &PointState::default(), &[bad, 0.0, 0.0, 0.0, 0.0, 0.0], true);
            assert_eq!(result, Err(trackbed_fem::ReturnError::NotFinite), "{bad}");
        }
    }
}

#[test]
fn rejects_steep_friction_softening() {
    let law = |until: f64| MohrCoulomb {
        friction: Hardening::Table(vec![(0.0, rad(35.0)), (until, rad(25.0))]),
        ..mohr_coulomb(COHESION, 35.0, 0.0, None)
    };
    let old = PointState { stress: [-4e5, -4e5, -4e5, 0.0, 0.0, 0.0], ..PointState::default() };
    let run = |until: f64| {
        let material = Material::plastic(SOIL, law(until));
        assert_eq!(material.invalid_constant(), None);
        let mut state = old;
        for _ in 0..40 {
            state = update(&material, &state, &[0.0, 0.0, 0.0, 2e-3, 0.0, 0.0], false)?.state;
        }
        Ok(state)
    };
    assert!(matches!(run(1e-3), Err(trackbed_fem::ReturnError::Softening { .. })));
    let state = run(2e-2).expect("mild softening");
    assert!(state.kappa > 2e-2);
}
