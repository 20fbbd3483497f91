//! Checks of the conformance suite.

use super::paths::{Case, Owned, Random, rotated, work};
use trackbed_fem::{PointState, Points, ReturnRegion};

const SEEDS: [u64; 3] = [1, 7, 42];
const STEPS: usize = 60;

/// Tolerance 1e-5 of the stiffness: truncation and rounding.
pub fn tangent(case: &Case) {
    let (mut compared, mut plastic, mut worst) = (0, 0, 0.0_f64);
    let h = 1e-6 * case.walk;
    for seed in SEEDS {
        case.walk(seed, STEPS, |old, increment| {
            let (response, _) = case.step(old, increment, true);
            for j in 0..6 {
                let side = |sign: f64| {
                    let mut e = *increment;
                    e[j] += sign * h;
                    case.step(old, &e, false).0
                };
                let (ahead, back) = (side(1.0), side(-1.0));
                if ahead.region != response.region || back.region != response.region {
                    continue;
                }
                compared += 1;
                plastic += usize::from(response.region.is_plastic());
                for i in 0..6 {
                    let slope = (ahead.state.stress[i] - back.state.stress[i]) / (2.0 * h);
                    let miss = (response.tangent[i][j] - slope).abs() / case.stiffness(old);
                    worst = worst.max(miss);
                    assert!(
                        miss < 1e-5,
                        "{:?} [{i}][{j}]: {} {slope}",
                        response.region,
                        response.tangent[i][j]
                    );
                }
            }
        });
    }
    assert!(compared > 6 * STEPS * SEEDS.len() * 9 / 10, "only {compared} compared");
    assert!(case.material.is_linear() || plastic > compared / 8, "only {plastic} of {compared} yielded");
}

/// Tolerance 1e-9: a nearly singular return amplifies rounding.
pub fn objectivity(case: &Case) {
    let mut random = Random(3);
    case.walk(5, STEPS, |old, increment| {
        let q = random.rotation();
        let turned = |s: &PointState| PointState {
            stress: rotated(&s.stress, &q, 1.0),
            plastic_strain: rotated(&s.plastic_strain, &q, 2.0),
            kappa: s.kappa,
        };
        let there = Owned { state: turned(&old.state), values: old.values.clone() };
        let (_, new) = case.step(old, increment, false);
        let (_, other) = case.step(&there, &rotated(increment, &q, 2.0), false);
        let expected = turned(&new.state);
        let size = case.stiffness(old) * case.walk;
        for k in 0..6 {
            let stress = (other.state.stress[k] - expected.stress[k]).abs() / size;
            let strain = (other.state.plastic_strain[k] - expected.plastic_strain[k]).abs() / case.walk;
            assert!(stress < 1e-9 && strain < 1e-9, "component {k}: {stress:e} {strain:e}");
        }
        for (value, (a, b)) in
            case.material.law.state_values().iter().zip(other.values.iter().zip(&new.values))
        {
            let scale = if value.unit == "J/m3" { b.abs().max(size * case.walk) } else { b.abs() };
            let turns = value.name.starts_with("total_strain");
            assert!(turns || (a - b).abs() <= 1e-9 * scale, "{}: {a} {b}", value.name);
        }
    });
}

/// Closed triangles of elastic strain.
pub fn elastic_cycles(case: &Case) {
    let (mut random, mut largest) = (Random(11), 0.0_f64);
    for _ in 0..4 {
        let corners = [random.strain(), random.strain(), [0.0; 6]];
        let (mut at, mut from) = (case.start(), [0.0; 6]);
        let energy = |at: &Owned| case.material.law.stored_energy(&case.material.elastic, at.point());
        let (begin, mut done, mut moved) = (energy(&at), 0.0, 0.0_f64);
        for corner in corners {
            const PARTS: usize = 500;
            for _ in 0..PARTS {
                let increment: [f64; 6] =
                    std::array::from_fn(|k| case.elastic * (corner[k] - from[k]) / PARTS as f64);
                let (response, new) = case.step(&at, &increment, false);
                assert_eq!(response.region, ReturnRegion::Elastic, "the cycle leaves the elastic range");
                let mean: [f64; 6] =
                    std::array::from_fn(|k| 0.5 * (at.state.stress[k] + new.state.stress[k]));
                done += work(&mean, &increment);
                moved = moved.max(case.stiffness(&at) * case.elastic * case.elastic);
                at = new;
                if case.material.law.is_conservative() {
                    let miss = (energy(&at) - begin - done).abs() / moved;
                    assert!(miss < 1e-5, "stored energy misses the work by {miss:e}");
                }
            }
            from = corner;
        }
        largest = largest.max(done.abs() / moved);
        assert!(at.state.kappa == 0.0 && at.state.plastic_strain == [0.0; 6]);
    }
    if case.material.law.is_conservative() {
        assert!(largest < 1e-5, "an elastic cycle leaves {largest:e} of its energy");
    } else {
        assert!(largest > 1e-5, "the law says that cycles leave energy, and they do not: {largest:e}");
    }
}

/// `sigma : d eps_p >= 0` for associated flow.
pub fn dissipation(case: &Case) {
    let mut yielded = 0;
    for seed in SEEDS {
        case.walk(seed, STEPS, |old, increment| {
            let (response, new) = case.step(old, increment, false);
            let flow: [f64; 6] =
                std::array::from_fn(|k| new.state.plastic_strain[k] - old.state.plastic_strain[k]);
            let square: f64 = (0..6).map(|k| if k < 3 { 1.0 } else { 0.5 } * flow[k] * flow[k]).sum();
            let grown = new.state.kappa - old.state.kappa;
            let size = (2.0 / 3.0 * square).sqrt();
            assert!((grown - size).abs() <= 1e-9 * case.walk, "kappa grows by {grown}, the strain by {size}");
            if response.region.is_plastic() {
                yielded += 1;
                let done = work(&new.state.stress, &flow);
                let scale = case.stiffness(old) * case.walk * case.walk;
                let associated = case.material.law.is_associated();
                assert!(!associated || done >= -1e-10 * scale, "plastic work {done:e}");
            }
        });
    }
    assert!(case.material.is_linear() || yielded > STEPS / 4);
}

/// Tolerance 1e-9 of the step stress.
pub fn admissibility(case: &Case) {
    for seed in SEEDS {
        case.walk(seed, STEPS, |old, increment| {
            let (_, new) = case.step(old, increment, false);
            let f = case.material.law.yield_function(new.point());
            assert!(f <= 1e-9 * case.stiffness(old) * case.walk, "yield function {f:e} Pa");
        });
    }
}

pub fn round_trip(case: &Case) {
    case.walk(9, STEPS, |old, increment| {
        let mut points = Points::new(1, old.values.len());
        let (states, values) = points.split_mut();
        states[0] = old.state;
        values.copy_from_slice(&old.values);
        let bytes = postcard::to_stdvec(&points).expect("bytes");
        let read: Points = postcard::from_bytes(&bytes).expect("the same points");
        assert_eq!(read, points);
        let again = Owned { state: read[0], values: read.values().to_vec() };
        assert_eq!(case.step(&again, increment, true), case.step(old, increment, true));
    });
}

pub fn statements(case: &Case) {
    let (law, elastic) = (&case.material.law, &case.material.elastic);
    assert!(case.material.invalid_constant().is_none() && !law.source().is_empty());
    assert!(case.material.with_strength_divided_by(1.3).invalid_constant().is_none());
    let start = case.start();
    let tiny = [1e-9 * case.elastic; 6];
    let (response, _) = case.step(&start, &tiny, true);
    let (rate, stiffness) = (law.elastic_tangent(elastic, start.point()), case.stiffness(&start));
    for i in 0..6 {
        for j in 0..6 {
            assert!((response.tangent[i][j] - rate[i][j]).abs() < 1e-6 * stiffness, "[{i}][{j}]");
            if law.has_constant_elasticity() {
                assert_eq!(rate[i][j], elastic.matrix()[i][j]);
            }
        }
    }
    case.walk(13, STEPS, |old, increment| {
        let ((with, a), (without, b)) = (case.step(old, increment, true), case.step(old, increment, false));
        assert_eq!((with.state, with.region, &a), (without.state, without.region, &b));
        assert!(a.values.iter().all(|v| v.is_finite()), "a value was not written");
        assert!(!law.is_linear() || with.region == ReturnRegion::Elastic);
        if law.has_symmetric_tangent() {
            for i in 0..6 {
                for j in 0..i {
                    let gap = (with.tangent[i][j] - with.tangent[j][i]).abs();
                    assert!(gap < 1e-9 * stiffness, "{:?} [{i}][{j}]: {gap:e}", with.region);
                }
            }
        }
    });
}
