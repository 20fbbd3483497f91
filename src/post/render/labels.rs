//! Field labels and units, legend numbers.

use trackbed_io::write::{body_field, solid_label};

pub fn grains(field: &str) -> (String, &'static str) {
    body_field(field).map_or_else(|| (field.to_string(), ""), |known| (known.label.to_string(), known.unit))
}

pub fn solid(field: &str) -> (String, &'static str) {
    let (label, unit) = solid_label(field);
    (label.to_string(), unit)
}

/// Factor and unit prefix that suit numbers up to `most`.
pub fn scaled(unit: &str, most: f64) -> (f64, String) {
    const PREFIXES: [(f64, &str); 6] =
        [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ")];
    let large = matches!(unit, "Pa" | "N");
    if !(large || matches!(unit, "m" | "m/s")) || most <= 0.0 {
        return (1.0, unit.to_string());
    }
    let known = || PREFIXES.iter().filter(|(f, _)| if large { *f >= 1.0 } else { *f <= 1.0 });
    let fits = known().find(|(f, _)| most >= 1.1 * f).or_else(|| known().next_back());
    fits.map_or((1.0, unit.to_string()), |(factor, prefix)| (*factor, format!("{prefix}{unit}")))
}

/// At most `most` round steps from `low` to `high`, and their decimals.
pub fn ticks(low: f64, high: f64, most: usize) -> (Vec<f64>, usize) {
    if high <= low || !(high - low).is_finite() {
        return (vec![low], 3);
    }
    let rough = (high - low) / most as f64;
    let mut exponent = libm::log10(rough).floor() as i32;
    let mut step = 10.0;
    for k in [1.0, 2.0, 5.0] {
        if k * libm::pow(10.0, f64::from(exponent)) >= rough * (1.0 - 1e-9) {
            step = k;
            break;
        }
    }
    if step == 10.0 {
        (step, exponent) = (1.0, exponent + 1);
    }
    let size = step * libm::pow(10.0, f64::from(exponent));
    let first = (low / size - 1e-6).ceil() as i64;
    let last = (high / size + 1e-6).floor() as i64;
    ((first..=last).map(|k| k as f64 * size).collect(), usize::try_from(-exponent).unwrap_or(0))
}

/// Number with typographic minus; exponents for very large and small values.
pub fn figure(value: f64, decimals: usize) -> String {
    let text = match value.abs() {
        a if a >= 1e6 || decimals > 6 => {
            let text = format!("{value:.2e}");
            text.replace(".00e", "e").replace("0e", "e")
        }
        // Rounding may give negative zero.
        _ => format!("{:.*}", decimals, value + 0.0),
    };
    let text = if text.trim_start_matches('-').bytes().all(|b| b == b'0' || b == b'.') {
        text.replace('-', "")
    } else {
        text
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(-93.0, 12.0, 6), (vec![-80.0, -60.0, -40.0, -20.0, 0.0], 0));
        let (found, decimals) = ticks(0.0, 0.31, 6);
        assert_eq!((found.len(), decimals), (4, 1));
        assert_eq!(figure(found[3], decimals), "0.3");
        assert_eq!(ticks(1.0, 1.0, 6).0, [1.0]);
        assert_eq!(ticks(0.0, 5.0, 5).0, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(figure(-0.0, 1), "0.0");
        assert_eq!(figure(-12.5, 1), "−12.5");
        assert_eq!(figure(3e9, 0), "3e9");
        assert_eq!(scaled("Pa", 93e3), (1e3, "kPa".to_string()));
        assert_eq!(scaled("m", 4e-3), (1e-3, "mm".to_string()));
        assert_eq!(solid("stress_xy"), ("Stress σxy".to_string(), "Pa"));
    }
}
