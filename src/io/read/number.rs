//! Numbers as printed by Fortran.
//!
//! Exponents may be `D` (`1.0D+03`) or have three digits (`1.0E+002`), also without letter
//! (`7.547503+002`). The latter requires a decimal point: integers may be reals (`12.`).

/// Reads a real; overflow gives infinity, which callers reject.
pub fn real(text: &str) -> Option<f64> {
    let plain = text.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'E'));
    if plain && let Ok(value) = text.parse() {
        return Some(value);
    }
    let lower = text.to_ascii_lowercase();
    if matches!(lower.trim_start_matches(['+', '-']), "nan" | "inf" | "infinity") {
        return lower.parse().ok();
    }
    if !lower.bytes().all(|b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b'e' | b'd')) {
        return None;
    }
    let mut fortran = lower.replace('d', "e");
    if !fortran.contains('e') {
        let sign = fortran.rfind(['+', '-']).filter(|at| *at > 0)?;
        if !fortran[..sign].contains('.') {
            return None;
        }
        fortran.insert(sign, 'e');
    }
    fortran.parse().ok()
}

/// Reads an identifier ≥ 0, also printed as a real (`12.`, `1.2E+01`).
pub fn whole(text: &str) -> Option<u32> {
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let value = real(text)?;
    (value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value)).then_some(value as u32)
}

/// Whether a field starts with a digit after optional sign and point.
pub fn looks_numeric(text: &str) -> bool {
    text.trim_start_matches(['+', '-', '.']).starts_with(|c: char| c.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_every_fortran_form() {
        for (text, value) in [
            ("1", 1.0),
            ("-.5", -0.5),
            ("+3.", 3.0),
            ("1.0D+03", 1000.0),
            ("1.0d3", 1000.0),
            ("-2.5D-01", -0.25),
            ("1.0E+002", 100.0),
            ("7.547503+002", 754.7503),
            ("-7.5-002", -0.075),
        ] {
            assert_eq!(real(text), Some(value), "{text}");
        }
    }

    #[test]
    fn refuses_what_is_no_number() {
        for text in ["1.2.3", "abc", "", "-", "1-20", "1.0E", "0x10", "1.0+", "1,5", "***", "1e5e5", "1_0"] {
            assert_eq!(real(text), None, "{text}");
        }
    }

    #[test]
    fn returns_infinity_on_overflow() {
        assert!(real("NaN").unwrap().is_nan());
        assert_eq!(real("-Infinity"), Some(f64::NEG_INFINITY));
        assert_eq!(real("1.0E+999"), Some(f64::INFINITY));
    }

    #[test]
    fn whole_numbers() {
        assert_eq!(whole("17"), Some(17));
        assert_eq!(whole("17."), Some(17));
        assert_eq!(whole("1.7E+01"), Some(17));
        assert_eq!(whole("4294967295"), Some(u32::MAX));
        for text in ["-1", "1.5", "4294967296", "x", "NaN"] {
            assert_eq!(whole(text), None, "{text}");
        }
    }

    #[test]
    fn a_header_does_not_look_numeric() {
        assert!(looks_numeric("1x") && looks_numeric("-.5") && looks_numeric("+1"));
        assert!(
            !looks_numeric("NODE") && !looks_numeric("----") && !looks_numeric("*1") && !looks_numeric("N1")
        );
    }
}
