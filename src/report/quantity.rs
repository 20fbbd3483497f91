//! Readable numbers: SI prefixes, four or five digits.

use trackbed_io::plot::minus;

/// Prefixed unit with factor from SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// Factor from SI units.
    pub factor: f64,
    /// Unit such as `kN/m`, or empty.
    pub unit: String,
}

const PREFIXES: [(i32, &str); 7] = [(-3, "n"), (-2, "µ"), (-1, "m"), (0, ""), (1, "k"), (2, "M"), (3, "G")];

/// Selects the prefix for values up to `largest`.
pub fn scale(unit: &str, largest: f64) -> Scale {
    let largest = largest.abs();
    // Other units are unscaled.
    let (base, steps, highest) = match unit {
        "N" | "Pa" | "J" | "N/m" | "N m" | "Hz" | "W" | "B" => (unit, true, 3),
        "m" | "m/s" | "s" | "rad" => (unit, true, 0),
        "kg" if largest > 0.0 && largest < 1e-3 => return Scale { factor: 1e6, unit: "mg".into() },
        "kg" if largest > 0.0 && largest < 1.0 => return Scale { factor: 1e3, unit: "g".into() },
        "kg/s" if largest > 0.0 && largest < 1.0 => return Scale { factor: 1e3, unit: "g/s".into() },
        other => (other, false, 0),
    };
    if !steps || largest == 0.0 || !largest.is_finite() {
        return Scale { factor: 1.0, unit: base.into() };
    }
    // Rounding to 1000 needs the next prefix.
    let power = (libm::log10(largest * 1.000_001) / 3.0).floor() as i32;
    // Lengths near a metre stay in millimetres.
    let power = power.clamp(-3, highest);
    let prefix = PREFIXES.iter().find(|p| p.0 == power).map_or("", |p| p.1);
    Scale { factor: 10.0_f64.powi(-3 * power), unit: format!("{prefix}{base}") }
}

/// Formats with at most five digits.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let size = value.abs();
    let text = if (1e-3..1e6).contains(&size) {
        let decimals = (4 - libm::log10(size).floor() as i32).clamp(0, 7) as usize;
        let text = format!("{value:.decimals$}");
        match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
            false => text,
        }
    } else {
        let text = format!("{value:.4e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        format!("{digits}e{power}")
    };
    minus(&text)
}

/// Formats such as `30.24 mm`.
pub fn with_unit(value: f64, unit: &str) -> String {
    let scale = scale(unit, value);
    format!("{} {}", number(value * scale.factor), scale.unit).trim_end().to_string()
}

/// Formats all digits, such as `0.0302412 m`.
pub fn exact(value: f64, unit: &str) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    let digits = if plain.len() <= scientific.len() + 4 { plain } else { scientific };
    format!("{digits} {unit}").trim_end().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_follow_the_size() {
        let text = |v: f64, unit: &str| with_unit(v, unit);
        assert_eq!(text(0.0302412, "m"), "30.241 mm");
        assert_eq!(text(30_000.0, "N"), "30 kN");
        assert_eq!(text(999.9999999, "N"), "1 kN");
        assert_eq!(text(-2.5e7, "N/m"), "\u{2212}25 MN/m");
        assert_eq!(text(0.0, "Pa"), "0 Pa");
        assert_eq!(text(1500.0, "m"), "1500 m");
        assert_eq!(text(0.25, "kg"), "250 g");
        assert_eq!(text(85.0, "kg"), "85 kg");
        assert_eq!(text(3.2e-15, ""), "3.2e\u{2212}15");
        assert_eq!(text(1165.0, ""), "1165");
        assert_eq!(text(1e-30, "J"), "1e\u{2212}21 nJ");
    }

    #[test]
    fn exact_numbers_read_back() {
        for v in [0.030241234567891, 1e-300, -2.5e17, 0.1, 12345.0] {
            assert_eq!(exact(v, "m").trim_end_matches(" m").parse::<f64>().unwrap(), v);
        }
        assert_eq!(exact(3.0, ""), "3");
    }
}
