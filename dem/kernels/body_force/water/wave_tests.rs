use super::*;
use crate::tables::rows;

const G: f64 = 9.81;

/// Table checked by 40-digit differences of the potential.
#[test]
fn waves_are_those_of_the_table() {
    let table = rows(include_str!("../../../tests/data/water/airy.csv"));
    assert!(table.len() >= 120, "{}", table.len());
    for (case, row) in &table {
        let [height, period, depth, direction, phase, x, y, z, t] = row[..9].try_into().unwrap();
        let wave = Wave::new(height, Measured::Period(period), direction, phase, depth, [0.0; 2], G).unwrap();
        let found = wave.at(x, y, z, t);
        let a = 0.5 * height;
        let w = wave.frequency;
        for (found, exact, unit) in [
            (found.elevation, row[9], a),
            (found.velocity.x, row[10], a * w),
            (found.velocity.y, row[11], a * w),
            (found.velocity.z, row[12], a * w),
            (found.acceleration.x, row[16], a * w * w),
            (found.acceleration.y, row[17], a * w * w),
            (found.acceleration.z, row[18], a * w * w),
        ] {
            assert!((found - exact).abs() <= 1e-11 * unit.max(exact.abs()), "{case}: {found} for {exact}");
        }
    }
}

#[test]
fn lengths_are_those_of_the_table() {
    let table = rows(include_str!("../../../tests/data/water/dispersion.csv"));
    let mut blocked = 0;
    for (period, row) in &table {
        let (period, depth, current) = (period.parse::<f64>().unwrap(), row[0], row[1]);
        let along = [current * 0.7_f64.cos(), current * 0.7_f64.sin()];
        let wave = |height, measured| Wave::new(height, measured, 0.7, 0.0, depth, along, G);
        let found = wave(0.0, Measured::Period(period));
        if row[2].is_nan() || row[2] == 0.0 {
            assert_eq!(found, Err(WaveError::Blocked));
            blocked += 1;
            continue;
        }
        let found = found.unwrap();
        assert!(
            (found.number / row[2] - 1.0).abs() < 1e-12,
            "{period} {depth}: {} for {}",
            found.number,
            row[2]
        );
        let back = wave(0.0, Measured::Length(found.length())).unwrap();
        assert!((back.frequency / found.frequency - 1.0).abs() < 1e-12);
        let limit = row[6];
        assert!(wave(limit * (1.0 - 1e-9), Measured::Period(period)).is_ok());
        let steep = wave(limit * (1.0 + 1e-9), Measured::Period(period));
        assert!(matches!(steep, Err(WaveError::Breaks { .. })), "{steep:?}");
    }
    assert!(blocked == 2 && table.len() > 20, "{blocked} {}", table.len());
}

#[test]
fn endless_depth_is_deep_water() {
    let wave = |depth| Wave::new(0.2, Measured::Period(4.0), 0.0, 0.3, depth, [0.0; 2], G).unwrap();
    let (deep, endless) = (wave(1e4).at(1.0, 2.0, -3.0, 5.0), wave(f64::INFINITY).at(1.0, 2.0, -3.0, 5.0));
    assert!((deep.velocity - endless.velocity).norm() < 1e-15 && endless.velocity.norm() > 0.01);
}
