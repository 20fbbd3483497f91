//! One-step returns and triaxial histories against the tables.

use super::*;
use std::collections::BTreeMap;

fn rows(file: &str) -> Vec<Vec<String>> {
    let path = format!("{}/tests/data/plasticity/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn law(name: &str) -> Material {
    let c = COHESION;
    match name {
        "mohr_coulomb" => Material::plastic(SOIL, mohr_coulomb(c, 30.0, 10.0, None)),
        "mohr_coulomb_associated" => Material::plastic(SOIL, mohr_coulomb(c, 30.0, 30.0, None)),
        name => {
            let cone = match name {
                "drucker_prager_outer" => Cone::Compression,
                "drucker_prager_inner" => Cone::Extension,
                "drucker_prager_plane_strain" => Cone::PlaneStrain,
                other => panic!("{other}"),
            };
            Material::plastic(SOIL, drucker_prager(c, 30.0, 10.0, cone, None))
        }
    }
}

#[test]
fn point_returns_of_the_table() {
    let mut worst = 0.0_f64;
    let mut counts: BTreeMap<(String, String), usize> = BTreeMap::new();
    let rows = rows("point_returns.csv");
    for row in &rows {
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        let strain: [f64; 6] = std::array::from_fn(|k| number(2 + k));
        let want: [f64; 6] = std::array::from_fn(|k| number(8 + k));
        let response = step(&law(&row[0]), &PointState::default(), &strain);
        let cone = row[0].starts_with("drucker");
        let region = match (row[1].as_str(), cone) {
            ("0", _) => ReturnRegion::Elastic,
            ("1", false) => ReturnRegion::Plane,
            ("2", false) => ReturnRegion::EdgeCompression,
            ("3", false) => ReturnRegion::EdgeExtension,
            ("4", false) => ReturnRegion::Apex,
            ("1", true) => ReturnRegion::Cone,
            ("4", true) => ReturnRegion::ConeApex,
            other => panic!("{other:?}"),
        };
        assert_eq!(response.region, region, "{row:?}");
        let error = (0..6).fold(0.0_f64, |m, k| m.max((response.state.stress[k] - want[k]).abs()));
        let relative = error / largest(&want).max(COHESION);
        worst = worst.max(relative);
        assert!(relative <= 1e-9, "{relative:.2e} {row:?} {:?}", response.state.stress);
        *counts.entry((row[0].clone(), row[1].clone())).or_default() += 1;
    }
    assert_eq!(rows.len(), 127);
    println!("point_returns.csv: {} rows, largest error {worst:.1e} (limit 1e-9)", rows.len());
    println!("{counts:?}");
}

/// Closed-form plateaus `s_a = -(k p0 + 2 c sqrt(k))`, `k = (1 + sin)/(1 - sin)`; dilatancy `k_psi - 1`,
/// `1 - 1/k_psi`; cones from `case.json`.
#[test]
fn triaxial_histories_plateaus_and_dilatancies() {
    let outer = "drucker_prager_outer";
    let inner = "drucker_prager_inner";
    let mc = "mohr_coulomb";
    let cases = [
        ("history_mc_compression.csv", mc, -1.0, 1.0, -369282.0323027551, 0.42027662546120603),
        ("history_mc_true_triaxial.csv", mc, -1.0, 1.3, -369282.0323027551, 0.42027662546120603),
        ("history_mc_extension.csv", mc, 1.0, 1.0, -10239.322565748304, 0.2959118089581526),
        ("history_dp_outer_compression.csv", outer, -1.0, 1.0, -369282.032302755, 0.4202766254612062),
        ("history_dp_outer_extension.csv", outer, 1.0, 1.0, 15406.585272609314, 0.32829381446040257),
        ("history_dp_inner_compression.csv", inner, -1.0, 1.0, -261569.219381653, 0.36863388972627376),
        ("history_dp_inner_extension.csv", inner, 1.0, 1.0, -10239.322565748298, 0.2959118089581526),
    ];
    for (file, name, sign, side, plateau, dilatancy) in cases {
        let material = law(name);
        let (sx, sy) = (-100e3, -100e3 * side);
        let mut state = PointState { stress: [sx, sy, -100e3, 0.0, 0.0, 0.0], ..PointState::default() };
        let (mut volume, mut worst, mut most) = (0.0, 0.0_f64, 0);
        let mut ratio = 0.0;
        for row in rows(file).iter().skip(1) {
            let number = |k: usize| row[k].parse::<f64>().unwrap();
            let guess = [-0.3e-3 * sign, -0.3e-3 * sign, sign * 1e-3];
            let (response, strain, iterations) =
                mixed_step(&material, &state, guess, [Some(sx), Some(sy), None], 1e-7);
            state = response.state;
            let step_volume: f64 = strain.iter().sum();
            volume += step_volume;
            ratio = step_volume / 1e-3;
            most = most.max(iterations);
            let stress_error = (state.stress[2] - number(1)).abs() / number(1).abs().max(COHESION);
            let volume_error = (volume - number(row.len() - 1)).abs() / 0.02;
            worst = worst.max(stress_error).max(volume_error);
            assert!(stress_error <= 1e-8, "{file}: {stress_error:.1e} {:?} {row:?}", state.stress);
            assert!(volume_error <= 1e-9, "{file}: {volume_error:.1e} {volume} {row:?}");
        }
        let error = (state.stress[2] - plateau).abs() / plateau.abs();
        println!(
            "{file}: plateau {:.8e} (closed form within {error:.1e}), dilatancy {ratio:.10} ({:.1e}), \
             history within {worst:.1e}, at most {most} iterations",
            state.stress[2],
            (ratio - dilatancy).abs()
        );
        assert!(error <= 1e-8 && (ratio - dilatancy).abs() <= 1e-8);
    }
}
