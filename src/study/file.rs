//! Study file: TOML; unknown keys are errors.

use serde::Deserialize;
use serde::de::{self, Deserializer, SeqAccess, Visitor};
use std::fmt;
use std::path::PathBuf;

/// Study.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// Title of the study and its table.
    #[serde(default)]
    pub title: String,
    /// Scene file, relative to the study file.
    pub scene: PathBuf,
    /// Overrides of all runs.
    #[serde(default)]
    pub base: Base,
    /// Varied parameters with listed values.
    #[serde(default)]
    pub axis: Vec<AxisTable>,
    /// Combination of axes; default: grid.
    pub combine: Option<Combine>,
    /// Varied parameters with a range.
    #[serde(default)]
    pub parameter: Vec<ParameterTable>,
    /// Samples of the parameters.
    pub sampling: Option<Sampling>,
    /// Repetitions with other seeds.
    pub seeds: Option<Seeds>,
    /// Reference; default: the first set.
    pub reference: Option<Reference>,
    /// Compared quantities; default: results of load cycles.
    #[serde(default)]
    pub quantity: Vec<QuantityTable>,
    /// Measured values of quantities.
    #[serde(default)]
    pub target: Vec<TargetTable>,
    /// Quantities with values of return periods.
    #[serde(default)]
    pub extreme: Vec<ExtremeTable>,
    /// Largest error of the recommended set [-]; default 0.05.
    pub tolerance: Option<f64>,
    /// Concurrent runs; default: number of cores.
    pub jobs: Option<usize>,
    /// Maps of reach, energy and depth over the runs of each case.
    pub hazard: Option<HazardTable>,
}

/// Maps over the runs of each case.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HazardTable {
    /// Quantile of the energy map; default 0.95.
    pub quantile: Option<f64>,
    /// Energies whose exceedance is mapped [J]; default 30 and 300 kJ.
    pub energies: Option<Vec<f64>>,
}

fn one() -> f64 {
    1.0
}

/// Overrides of all runs.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Base {
    /// As `--set` of `run`: `key.path=value`.
    #[serde(default)]
    pub set: Vec<String>,
}

/// Varied key with values, or named groups of overrides.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisTable {
    /// Name; default: last part of `key`.
    pub name: Option<String>,
    /// Varied scene key.
    pub key: Option<String>,
    /// Values, or tables with `label` and `set`.
    pub values: Vec<toml::Value>,
}

/// Combination of axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Combine {
    /// All combinations.
    #[default]
    Grid,
    /// First values together, second values, and so on.
    List,
    /// First values, then each axis varied alone.
    OneAtATime,
}

/// Varied key with a range.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterTable {
    /// Name; default: last part of `key`.
    pub name: Option<String>,
    /// Varied scene key.
    pub key: String,
    /// Smallest and largest value, in `unit`.
    pub range: [f64; 2],
    /// Unit of the range; default: SI.
    pub unit: Option<String>,
    /// Distribution over the range; default linear.
    #[serde(default)]
    pub scale: Scale,
    /// Whole numbers only, each equally likely on a linear scale; default false.
    #[serde(default)]
    pub integer: bool,
}

/// Distribution over a range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Uniform in the value.
    #[default]
    Linear,
    /// Uniform in its logarithm.
    Log,
}

/// Samples of all parameters.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sampling {
    /// Method.
    pub method: Method,
    /// Number of samples.
    pub samples: usize,
    /// Seed; default: 1, or the Sobol sequence without shift.
    pub seed: Option<u64>,
}

/// Sampling method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Random Latin hypercube.
    LatinHypercube,
    /// Sobol sequence, with a seed under a random digital shift.
    Sobol,
}

/// Measured value of a quantity.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetTable {
    /// Name of the quantity.
    pub quantity: String,
    /// Value, in the unit of the quantity.
    pub value: f64,
    /// Standard deviation, in the unit of the quantity.
    pub tolerance: f64,
}

/// Values of return periods from the largest value of each seed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExtremeTable {
    /// Name of the quantity.
    pub quantity: String,
    /// Number of events per year, each like a run.
    pub events_per_year: f64,
    /// Return periods in years.
    pub return_periods: Vec<f64>,
    /// Confidence of the intervals; default 0.9.
    pub confidence: Option<f64>,
}

/// Repetitions with other seeds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// Seeds.
    pub values: Vec<u64>,
    /// Seed keys; default: all grain groups and every other `seed`.
    pub keys: Option<Vec<String>>,
}

/// Reference: a set, or a separate run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Label of a set.
    pub label: Option<String>,
    /// Overrides of a separate run, after `[base]`.
    pub set: Option<Vec<String>>,
}

/// Number of `summary.json`, or table column.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuantityTable {
    /// Name; default: column or path.
    pub name: Option<String>,
    /// Unit after scaling; default: of the column.
    pub unit: Option<String>,
    /// Scale factor, not 0; default 1.
    #[serde(default = "one")]
    pub factor: f64,
    /// Path in `summary.json`; lists by index, name or `last`.
    pub summary: Option<String>,
    /// Results table, such as `cycles.csv`.
    pub file: Option<String>,
    /// Column without unit, or several whose sum counts.
    pub column: Option<Columns>,
    /// Reduction of the column; default: last value.
    pub take: Option<Take>,
    /// Value of `against` at which `"at"` is read.
    pub at: Option<f64>,
    /// Smallest value of `against`; default: all rows.
    pub from: Option<f64>,
    /// Value of `against` at which the column counts as 0; default: none.
    pub since: Option<f64>,
    /// Abscissa of a curve, of `at`, `from` and `since`; default: first column.
    pub against: Option<String>,
    /// Logarithmic abscissa; default false.
    pub log: Option<bool>,
    /// Error norm; default relative.
    pub norm: Option<Norm>,
    /// Scale of relative errors, above 0; default: the reference.
    pub scale: Option<f64>,
    /// Exact value instead of the reference.
    pub exact: Option<f64>,
    /// Largest error of the recommended set; default: of the study.
    pub tolerance: Option<f64>,
}

/// Names of one or several columns.
#[derive(Clone, Debug)]
pub struct Columns(pub Vec<String>);

impl<'de> Deserialize<'de> for Columns {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Columns, D::Error> {
        struct Names;
        impl<'de> Visitor<'de> for Names {
            type Value = Columns;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a column or a list of columns")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<Columns, E> {
                Ok(Columns(vec![name.to_string()]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Columns, A::Error> {
                let mut names = Vec::new();
                while let Some(name) = list.next_element()? {
                    names.push(name);
                }
                Ok(Columns(names))
            }
        }
        deserializer.deserialize_any(Names)
    }
}

/// Reduction of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Take {
    /// Last row.
    #[default]
    Last,
    /// Mean of all rows.
    Mean,
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
    /// Largest less smallest value.
    Range,
    /// Abscissa from the first to the last value that is not 0.
    Duration,
    /// Value at `at`, linear between rows.
    At,
    /// Curve over another column.
    Curve,
}

/// Error norm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Norm {
    /// Difference over reference size.
    #[default]
    Relative,
    /// Difference.
    Absolute,
}
