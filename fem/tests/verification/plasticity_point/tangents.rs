//! Consistent tangents against central differences on every branch.

use super::*;
use std::collections::BTreeMap;

/// Error over `lambda + 2 mu`, best of three step widths.
fn tangent_error(
    material: &Material,
    old: &PointState,
    increment: &[f64; 6],
    response: &Response,
) -> Option<f64> {
    let (lambda, mu) = material.elastic.lame();
    let mut best: Option<f64> = None;
    'width: for width in [1e-7, 1e-8, 1e-9] {
        let mut worst = 0.0_f64;
        for j in 0..6 {
            let mut ends = [[0.0; 6]; 2];
            for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
                let mut moved = *increment;
                moved[j] += sign * width;
                let near = step(material, old, &moved);
                if near.region != response.region {
                    continue 'width;
                }
                *end = near.state.stress;
            }
            for i in 0..6 {
                let difference = (ends[0][i] - ends[1][i]) / (2.0 * width);
                worst = worst.max((difference - response.tangent[i][j]).abs());
            }
        }
        let error = worst / (lambda + 2.0 * mu);
        best = Some(best.map_or(error, |b| b.min(error)));
    }
    best
}

#[test]
fn tangents_match_central_differences() {
    for (name, material, regions) in laws() {
        assert_eq!(material.invalid_constant(), None, "{name}");
        let mut random = Random(17);
        let mut seen: BTreeMap<String, (usize, f64)> = BTreeMap::new();
        let (mut trials, mut left_out) = (0, 0);
        let wanted = |seen: &BTreeMap<String, (usize, f64)>, region: &ReturnRegion| {
            seen.get(&format!("{region:?}")).is_some_and(|s| s.0 >= 20)
        };
        while !regions.iter().all(|r| wanted(&seen, r)) {
            trials += 1;
            assert!(trials < 40_000, "{name}: not reached: {seen:?}");
            let first = random_strain(&mut random, 1e-3, 4e-3);
            let old = step(&material, &PointState::default(), &first).state;
            let (shear, volume) = if trials % 2 == 0 { (4e-3, 4e-3) } else { (3e-4, 4e-3) };
            let increment = random_strain(&mut random, shear, volume);
            let response = step(&material, &old, &increment);
            assert!(response.region == ReturnRegion::Elastic || regions.contains(&response.region));
            if wanted(&seen, &response.region) {
                continue;
            }
            // Kinks of tables are between regions too.
            match tangent_error(&material, &old, &increment, &response) {
                None => left_out += 1,
                Some(error) => {
                    assert!(error <= 1e-6, "{name} {:?}: {error:.2e} {increment:?} {old:?}", response.region);
                    let entry = seen.entry(format!("{:?}", response.region)).or_default();
                    *entry = (entry.0 + 1, entry.1.max(error));
                }
            }
        }
        let list: Vec<String> =
            seen.iter().map(|(region, (count, worst))| format!("{region} {count}x {worst:.0e}")).collect();
        println!("{name} ({trials} states, {left_out} between regions): {}", list.join(", "));
    }
}

#[test]
fn tangents_with_equal_principal_values() {
    let c = COHESION;
    let cut = Material::plastic(SOIL, mohr_coulomb(c, 30.0, 10.0, Some(0.4 * c)));
    let open = Material::plastic(SOIL, mohr_coulomb(c, 30.0, 10.0, None));
    let cone = Material::plastic(SOIL, drucker_prager(c, 30.0, 10.0, Cone::Compression, Some(0.4 * c)));
    let cases = [
        (&open, [1e-3, 1e-3, -4e-3], ReturnRegion::EdgeCompression),
        (&open, [3e-3, -3e-3, -3e-3], ReturnRegion::EdgeExtension),
        (&open, [2e-3, 2e-3, 2e-3], ReturnRegion::Apex),
        (&cut, [4e-4, -2e-4, -2e-4], ReturnRegion::TensionPlane),
        (&cut, [4e-4, 4e-4, 0.0], ReturnRegion::TensionEdge),
        (&cut, [2e-3, 2e-3, 2e-3], ReturnRegion::TensionCorner),
        (&cut, [2e-3, -1e-3, -1e-3], ReturnRegion::EdgeExtensionTension),
        (&cone, [3e-4, 3e-4, 3e-4], ReturnRegion::Cap),
    ];
    for (material, e, region) in cases {
        let increment = [e[0], e[1], e[2], 0.0, 0.0, 0.0];
        let response = step(material, &PointState::default(), &increment);
        assert_eq!(response.region, region, "{e:?}");
        let error =
            tangent_error(material, &PointState::default(), &increment, &response).expect("one region");
        println!("{region:?} with equal values: {error:.1e}");
        assert!(error <= 1e-6, "{region:?}: {error:.2e}");
    }
}

#[test]
fn declared_symmetry_matches_tangent() {
    for (name, material, _) in laws() {
        let mut random = Random(5);
        let mut worst = 0.0_f64;
        for _ in 0..2000 {
            let response = step(&material, &PointState::default(), &random_strain(&mut random, 3e-3, 3e-3));
            for i in 0..6 {
                for j in 0..i {
                    worst = worst.max((response.tangent[i][j] - response.tangent[j][i]).abs());
                }
            }
        }
        let relative = worst / SOIL.young;
        assert_eq!(material.symmetric_tangent(), relative < 1e-9, "{name}: {relative:.1e}");
    }
}

#[test]
fn regularised_edge_tangent_is_regular() {
    let material = Material::plastic(SOIL, mohr_coulomb(COHESION, 30.0, 10.0, None));
    let mut response = step(&material, &PointState::default(), &[1e-3, 1e-3, -4e-3, 0.0, 0.0, 0.0]);
    let lateral = |t: &[[f64; 6]; 6]| (t[0][0] * t[1][1] - t[0][1] * t[1][0]) / (SOIL.young * SOIL.young);
    assert!(lateral(&response.tangent).abs() < 1e-15);
    let elastic = SOIL.matrix();
    let mut mixed = response.tangent;
    regularise(&mut mixed, &SOIL, 1e-6);
    assert!(lateral(&mixed).abs() > 1e-8);
    assert!((0..36).all(|k| {
        let (i, j) = (k / 6, k % 6);
        let want = (1.0 - 1e-6) * response.tangent[i][j] + 1e-6 * elastic[i][j];
        (mixed[i][j] - want).abs() <= 1e-15 * SOIL.young
    }));
    regularise(&mut response.tangent, &SOIL, 1.0);
    assert!((response.tangent[0][0] - elastic[0][0]).abs() < 1e-6);
}
