//! Parameters with a range, and their samples.

use super::axis::{MOST_RUNS, Setting};
use super::design::{SOBOL_DIMENSIONS, latin_hypercube, sobol};
use super::factor::Factor;
use super::file::{Method, ParameterTable, Sampling, Scale, StudyFile};
use trackbed_input::scene::{Document, Problem, SceneError};

/// Largest number up to which all whole numbers are exact.
const LARGEST: f64 = 9_007_199_254_740_992.0;

/// Samples of the parameters.
#[derive(Debug)]
pub struct Samples {
    /// Parameters.
    pub factors: Vec<Factor>,
    /// Values by sample.
    pub values: Vec<Vec<f64>>,
    /// Overrides of each sample alone.
    pub settings: Vec<Setting>,
}

/// Resolves parameters and samples; none without parameters.
///
/// # Errors
/// Input errors.
pub fn resolve(document: &Document, file: &StudyFile) -> Result<Option<Samples>, SceneError> {
    let Some(sampling) = &file.sampling else {
        return match file.parameter.is_empty() {
            true => Ok(None),
            false => Err(document.problem("parameter", Problem::requirement("`sampling`"))),
        };
    };
    if file.parameter.is_empty() {
        return Err(document.problem("sampling", Problem::requirement("`parameter`")));
    }
    let others = [
        ("combine", file.combine.is_some()),
        ("reference", file.reference.is_some()),
        ("tolerance", file.tolerance.is_some()),
    ];
    if let Some((key, _)) = others.iter().find(|(_, given)| *given) {
        return Err(document.problem(key, Problem::conflict("`parameter`")));
    }
    let tables = file.parameter.iter().enumerate();
    let factors = tables.map(|(k, table)| factor(document, k, table)).collect::<Result<Vec<_>, _>>()?;
    for (k, factor) in factors.iter().enumerate() {
        if factors[..k].iter().any(|earlier| earlier.name == factor.name) {
            let found = format!("\"{}\" twice", factor.name);
            return Err(document.error(&format!("parameter.{k}.name"), found, "distinct names"));
        }
    }
    for (k, table) in file.parameter.iter().enumerate() {
        if file.parameter[..k].iter().any(|earlier| earlier.key.trim() == table.key.trim()) {
            let found = format!("{:?} twice", table.key);
            return Err(document.error(&format!("parameter.{k}.key"), found, "distinct keys"));
        }
    }
    let points = points(document, sampling, factors.len())?;
    let of_point = |point: &Vec<f64>| {
        let all = factors.iter().zip(&file.parameter).zip(point);
        all.map(|((factor, table), u)| value(factor, table.integer, *u)).collect()
    };
    let values: Vec<Vec<f64>> = points.iter().map(of_point).collect();
    let settings = values.iter().enumerate().map(|(k, row)| setting(file, &factors, k, row)).collect();
    Ok(Some(Samples { factors, values, settings }))
}

/// Value at `u` of the unit interval.
fn value(factor: &Factor, integer: bool, u: f64) -> f64 {
    // Each whole number has an interval of length 1.
    let [low, high] = if integer { [factor.range[0] - 0.5, factor.range[1] + 0.5] } else { factor.range };
    let value = match factor.log {
        true => low * libm::pow(high / low, u),
        false => low + u * (high - low),
    };
    let value = if integer { value.round() } else { value };
    value.clamp(factor.range[0], factor.range[1])
}

fn factor(document: &Document, index: usize, table: &ParameterTable) -> Result<Factor, SceneError> {
    let fault = |key: &str, found: String, expected: &str| {
        Err(document.error(&format!("parameter.{index}.{key}"), found, expected))
    };
    if table.key.trim().is_empty() || table.key.contains('=') {
        return fault("key", format!("{:?}", table.key), "a key of the scene");
    }
    let last = table.key.rsplit('.').next().unwrap_or(&table.key);
    let name = table.name.clone().unwrap_or_else(|| last.into());
    if name.trim().is_empty() || name.contains(['=', ',', '|', '"', '\n']) {
        return fault("name", format!("{name:?}"), "a name without = , | or quotes");
    }
    let unit = table.unit.clone().unwrap_or_default();
    if unit.chars().any(|c| c.is_control() || "\"\\[]".contains(c)) {
        return fault("unit", format!("{unit:?}"), "a unit such as \"GPa\"");
    }
    let [low, high] = table.range;
    let found = || format!("[{low:?}, {high:?}]");
    if !(low.is_finite() && high.is_finite() && low < high) {
        return fault("range", found(), "two finite numbers, ascending");
    }
    if !(high - low).is_finite() {
        return fault("range", found(), "a smaller range");
    }
    let log = table.scale == Scale::Log;
    if log && !(low > 0.0 && (high / low).is_finite()) {
        return fault("range", found(), "two numbers above 0 with scale = \"log\"");
    }
    if table.integer && (low.fract() != 0.0 || high.fract() != 0.0 || low.abs().max(high.abs()) > LARGEST) {
        return fault("range", found(), "two whole numbers of at most 2⁵³ with integer = true");
    }
    Ok(Factor { name, unit, log, range: table.range, random: last == "seed", ..Factor::default() })
}

fn points(document: &Document, sampling: &Sampling, dimensions: usize) -> Result<Vec<Vec<f64>>, SceneError> {
    let samples = sampling.samples;
    if !(2..=MOST_RUNS).contains(&samples) {
        let expected = format!("2 to {MOST_RUNS}");
        return Err(document.error("sampling.samples", samples.to_string(), expected));
    }
    match sampling.method {
        Method::LatinHypercube => Ok(latin_hypercube(samples, dimensions, sampling.seed.unwrap_or(1))),
        Method::Sobol if dimensions > SOBOL_DIMENSIONS => {
            let expected = format!("at most {SOBOL_DIMENSIONS} with method = \"sobol\"");
            Err(document.error("parameter", format!("{dimensions} parameters"), expected))
        }
        Method::Sobol => Ok(sobol(samples, dimensions, sampling.seed)),
    }
}

fn setting(file: &StudyFile, factors: &[Factor], index: usize, values: &[f64]) -> Setting {
    let assignment = |(table, (factor, value)): (&ParameterTable, (&Factor, &f64))| {
        let quote = if factor.unit.is_empty() { "" } else { "\"" };
        let number = if table.integer { format!("{value:.0}") } else { format!("{value:?}") };
        let text = format!("{number} {}", factor.unit);
        format!("{}={quote}{}{quote}", table.key, text.trim_end())
    };
    let own = file.parameter.iter().zip(factors.iter().zip(values)).map(assignment);
    Setting {
        label: format!("sample={:03}", index + 1),
        levels: values.iter().map(ToString::to_string).collect(),
        set: own.collect(),
    }
}
