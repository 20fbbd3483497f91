//! Settlement laws of the summary.

use serde_json::Value;
use trackbed_track::settlement::settlement_after;

const POINTS: usize = 120;

/// Fitted settlement law.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// Name.
    pub name: String,
    /// s(N).
    pub form: String,
    /// Parameters by name; settlements [m].
    pub parameters: Vec<(String, f64)>,
    /// Standard errors of the parameters; empty if unknown.
    pub standard_errors: Vec<f64>,
    /// R².
    pub r2: f64,
    /// RMS residual [m].
    pub rms_error: f64,
    /// First and last cycle of the fit.
    pub range: [f64; 2],
}

impl Law {
    /// Reads an entry of `settlement.fits`, if complete.
    pub fn of(fit: &Value) -> Option<Law> {
        let parameter = |p: &Value| Some((p.get(0)?.as_str()?.to_string(), p.get(1)?.as_f64()?));
        Some(Law {
            name: fit["law"].as_str()?.into(),
            form: fit["form"].as_str()?.into(),
            parameters: fit["parameters"].as_array()?.iter().filter_map(parameter).collect(),
            standard_errors: fit["standard_errors"]
                .as_array()
                .map_or(Vec::new(), |all| all.iter().filter_map(Value::as_f64).collect()),
            r2: fit["r2"].as_f64()?,
            rms_error: fit["rms_error"].as_f64()?,
            range: [fit["range"].get(0)?.as_f64()?, fit["range"].get(1)?.as_f64()?],
        })
    }

    /// Returns settlement after N cycles [m]; none if unknown or a reformulation (Hettler's).
    pub fn at(&self, n: f64) -> Option<f64> {
        let values: Vec<f64> = self.parameters.iter().map(|p| p.1).collect();
        settlement_after(&self.name, &values, n)
    }

    /// Returns the curve over the fitted cycles, if any.
    pub fn curve(&self) -> Vec<[f64; 2]> {
        let [from, to] = self.range;
        if !(from > 0.0 && to > from) {
            return Vec::new();
        }
        let place = |k: usize| from * libm::pow(to / from, k as f64 / POINTS as f64);
        (0..=POINTS).filter_map(|k| Some([place(k), self.at(place(k))?])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_track::settlement;

    #[test]
    fn law_curves_match_fits() {
        // Residuals match the fit.
        let data: Vec<[f64; 2]> = (1..=400)
            .map(|n| {
                let n = f64::from(n);
                [n, 0.004 * (1.0 + 0.4 * libm::log10(n)) + 2e-6 * n + 2e-4 * libm::sin(0.3 * n)]
            })
            .collect();
        let fits = settlement::fits(&data, 30e3);
        let laws: Vec<Law> =
            fits.iter().map(|f| Law::of(&serde_json::to_value(f).unwrap()).unwrap()).collect();
        assert!(laws.len() >= 6, "{}", laws.len());
        for law in laws.iter().filter(|l| l.name != "Hettler") {
            let used: Vec<&[f64; 2]> = data.iter().filter(|p| p[0] >= law.range[0]).collect();
            let rest: f64 = used.iter().map(|p| (law.at(p[0]).unwrap() - p[1]).powi(2)).sum();
            let rms = (rest / used.len() as f64).sqrt();
            assert!((rms / law.rms_error - 1.0).abs() < 1e-6, "{}: {rms} {}", law.name, law.rms_error);
            assert_eq!(law.curve().len(), POINTS + 1);
        }
        let hettler = laws.iter().find(|l| l.name == "Hettler").expect("it goes with Alva-Hurtado & Selig");
        assert!(hettler.curve().is_empty());
    }
}
