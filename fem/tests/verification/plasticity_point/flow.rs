//! Plastic flow: closest points (associated), multipliers (non-associated), objectivity.

use super::*;

/// Mohr–Coulomb and cut-off surfaces in unordered principal axes: gradient, flow, bound.
fn surfaces(c: f64, phi: f64, psi: f64, tension: Option<f64>) -> Vec<([f64; 3], [f64; 3], f64)> {
    let mut list = Vec::new();
    let (sin, cos) = rad(phi).sin_cos();
    let flow = rad(psi).sin();
    for i in 0..3 {
        for j in (0..3).filter(|&j| j != i) {
            let (mut n, mut m) = ([0.0; 3], [0.0; 3]);
            (n[i], n[j]) = (1.0 + sin, -(1.0 - sin));
            (m[i], m[j]) = (1.0 + flow, -(1.0 - flow));
            list.push((n, m, 2.0 * c * cos));
        }
        if let Some(t) = tension {
            let mut n = [0.0; 3];
            n[i] = 1.0;
            list.push((n, n, t));
        }
    }
    list
}

fn dot(x: &[f64; 3], y: &[f64; 3]) -> f64 {
    (0..3).map(|i| x[i] * y[i]).sum()
}

/// Whether `e` is a non-negative combination of at most three `flows` (Carathéodory): the largest of the
/// smallest factors, relative to `e`.
fn cone_margin(e: &[f64; 3], flows: &[[f64; 3]]) -> f64 {
    let size = dot(e, e).sqrt();
    let mut best = f64::NEG_INFINITY;
    let count = flows.len();
    let e_vector = nalgebra::Vector3::from(*e) / size;
    for i in 0..count {
        for j in i..count {
            for k in j..count {
                let mut columns = vec![flows[i]];
                if j > i {
                    columns.push(flows[j]);
                }
                if k > j {
                    columns.push(flows[k]);
                }
                let m = nalgebra::DMatrix::from_fn(3, columns.len(), |r, c| columns[c][r]);
                let normal = m.transpose() * &m;
                let Some(inverse) = normal.clone().try_inverse() else { continue };
                if normal.determinant().abs() < 1e-9 {
                    continue;
                }
                let x = inverse * m.transpose() * nalgebra::DVector::from_column_slice(e_vector.as_slice());
                let rest = (&m * &x - nalgebra::DVector::from_column_slice(e_vector.as_slice())).norm();
                if rest < 1e-7 {
                    best = best.max(x.min());
                }
            }
        }
    }
    best
}

/// Kuhn–Tucker conditions for any dilation and cut-off.
#[test]
fn multipliers_are_not_negative() {
    let c = COHESION;
    let mut checked = 0;
    for (phi, psi) in [(30.0, 30.0), (30.0, 10.0), (40.0, 1.0), (5.0, 0.0), (0.0, 0.0), (60.0, 20.0)] {
        for tension in [None, Some(0.3 * c), Some(0.0)] {
            let material = Material::plastic(SOIL, mohr_coulomb(c, phi, psi, tension));
            assert_eq!(material.invalid_constant(), None);
            let surfaces = surfaces(c, phi, psi, tension);
            let mut random = Random(3 + phi as u64);
            for _ in 0..400 {
                let mut e = random_strain(&mut random, 3e-3, 6e-3);
                e[3..].fill(0.0);
                let response = step(&material, &PointState::default(), &e);
                if response.region == ReturnRegion::Elastic
                    || response.region == ReturnRegion::Apex && psi == 0.0
                {
                    continue;
                }
                let state = response.state;
                let s = [state.stress[0], state.stress[1], state.stress[2]];
                let size = largest(&s).max(c);
                let values: Vec<f64> = surfaces.iter().map(|(n, _, k)| dot(n, &s) - k).collect();
                assert!(values.iter().all(|f| *f <= 1e-10 * size), "{values:?}");
                let reached: Vec<[f64; 3]> = surfaces
                    .iter()
                    .zip(&values)
                    .filter(|(_, f)| **f > -1e-9 * size)
                    .map(|((_, m, _), _)| *m)
                    .collect();
                let flow = [state.plastic_strain[0], state.plastic_strain[1], state.plastic_strain[2]];
                // Plastic strain of rounding size.
                if largest(&flow) < 1e-9 {
                    continue;
                }
                let margin = cone_margin(&flow, &reached);
                assert!(
                    margin > -1e-7,
                    "phi {phi} psi {psi} {tension:?} {:?}: {margin:.1e} {e:?}",
                    response.region
                );
                checked += 1;
            }
        }
    }
    println!("{checked} returns with multipliers >= 0");
    assert!(checked > 4000);
}

/// `(tau - sigma) : d eps_p <= 0` for every admissible `tau` (Simo and Hughes 1998, section 2.6.3).
#[test]
fn associated_returns_are_closest_points() {
    let c = COHESION;
    let mut states = 0;
    let mut worst = f64::NEG_INFINITY;
    for (name, material, _) in laws() {
        // Hardening moves the admissible set.
        if !material.symmetric_tangent() || name.contains("hardening") {
            continue;
        }
        let mut random = Random(11);
        let mut points: Vec<[f64; 6]> = vec![[0.0; 6]];
        while points.len() < 300 {
            let state =
                step(&material, &PointState::default(), &random_strain(&mut random, 5e-3, 5e-3)).state;
            let shrink = if points.len().is_multiple_of(3) { 0.5 + 0.5 * random.next() } else { 1.0 };
            points.push(state.stress.map(|s| s * shrink));
        }
        for _ in 0..60 {
            let e = random_strain(&mut random, 3e-3, 5e-3);
            let response = step(&material, &PointState::default(), &e);
            if response.region == ReturnRegion::Elastic {
                continue;
            }
            states += 1;
            let (s, flow) = (response.state.stress, response.state.plastic_strain);
            let scale = norm(&flow) * norm(&s).max(c);
            let energy = |difference: [f64; 6]| {
                // sigma : D^-1 sigma, shear counted twice.
                let trace = difference[0] + difference[1] + difference[2];
                let square: f64 =
                    (0..6).map(|k| if k < 3 { 1.0 } else { 2.0 } * difference[k] * difference[k]).sum();
                ((1.0 + SOIL.poisson) * square - SOIL.poisson * trace * trace) / SOIL.young
            };
            let trial = SOIL.stress(&e);
            let least = energy(std::array::from_fn(|k| trial[k] - s[k]));
            for tau in &points {
                let work: f64 = (0..6).map(|k| (tau[k] - s[k]) * flow[k]).sum();
                worst = worst.max(work / scale);
                assert!(work <= 1e-9 * scale, "{name} {:?}: {:.1e}", response.region, work / scale);
                let other = energy(std::array::from_fn(|k| trial[k] - tau[k]));
                assert!(least <= other * (1.0 + 1e-9));
            }
        }
    }
    println!("{states} closest points, largest (tau - sigma):d eps_p = {worst:.1e} of |sigma||d eps_p|");
    assert!(states >= 200);
}

/// Corners and rays span all admissible stresses.
#[test]
fn mohr_coulomb_returns_maximise_dissipation() {
    let (c, phi, t) = (COHESION, 30.0, 0.4 * COHESION);
    let (sin, cos) = rad(phi).sin_cos();
    let s3 = ((1.0 + sin) * t - 2.0 * c * cos) / (1.0 - sin);
    let apex = c * cos / sin;
    let rays = [[sin - 1.0, sin - 1.0, -1.0 - sin], [sin - 1.0, -1.0 - sin, -1.0 - sin]];
    let permutations = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    for (tension, corners) in [(None, vec![[apex; 3]]), (Some(t), vec![[t, t, t], [t, t, s3], [t, s3, s3]])] {
        let material = Material::plastic(SOIL, mohr_coulomb(c, phi, phi, tension));
        let mut random = Random(23);
        let mut count = 0;
        while count < 300 {
            let response = step(&material, &PointState::default(), &random_strain(&mut random, 3e-3, 5e-3));
            if response.region == ReturnRegion::Elastic {
                continue;
            }
            count += 1;
            let (s, _) = eigen(&response.state.stress);
            let p = response.state.plastic_strain;
            let (e, _) = eigen(&[p[0], p[1], p[2], p[3] / 2.0, p[4] / 2.0, p[5] / 2.0]);
            let size = dot(&e, &e).sqrt();
            for order in permutations {
                for corner in &corners {
                    let work: f64 = (0..3).map(|i| (corner[order[i]] - s[i]) * e[i]).sum();
                    assert!(work <= 1e-9 * size * largest(&s).max(c), "{:?} corner {work}", response.region);
                }
                for ray in &rays {
                    let work: f64 = (0..3).map(|i| ray[order[i]] * e[i]).sum();
                    assert!(work <= 1e-9 * size, "{:?} ray {work}", response.region);
                }
            }
        }
    }
}

#[test]
fn objectivity() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let rotate = |v: &[f64; 6], shear: f64| {
        let (a, b, c) = (v[3] * shear, v[4] * shear, v[5] * shear);
        let m = nalgebra::Matrix3::new(v[0], a, c, a, v[1], b, c, b, v[2]);
        let m = turn.matrix() * m * turn.matrix().transpose();
        [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)] / shear, m[(1, 2)] / shear, m[(0, 2)] / shear]
    };
    let mut worst = 0.0_f64;
    for (name, material, _) in laws() {
        let mut random = Random(29);
        for _ in 0..100 {
            let (first, second) =
                (random_strain(&mut random, 2e-3, 3e-3), random_strain(&mut random, 2e-3, 3e-3));
            let run = |first: &[f64; 6], second: &[f64; 6]| {
                let old = step(&material, &PointState::default(), first).state;
                step(&material, &old, second)
            };
            let (here, there) = (run(&first, &second), run(&rotate(&first, 0.5), &rotate(&second, 0.5)));
            let size = norm(&here.state.stress).max(COHESION);
            let turned = rotate(&here.state.stress, 1.0);
            let difference =
                largest(&std::array::from_fn::<f64, 6, _>(|k| turned[k] - there.state.stress[k]));
            worst = worst.max(difference / size);
            assert!(difference <= 1e-10 * size, "{name}: {:.1e}", difference / size);
            assert!((here.state.kappa - there.state.kappa).abs() <= 1e-13);
            let turned = rotate(&here.state.plastic_strain, 0.5);
            let difference =
                largest(&std::array::from_fn::<f64, 6, _>(|k| turned[k] - there.state.plastic_strain[k]));
            assert!(difference <= 1e-13, "{name}: {difference:.1e}");
        }
    }
    println!("objectivity: largest relative difference {worst:.1e}");
}
