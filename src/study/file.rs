//! Study file: TOML; unknown keys are errors.

use serde::Deserialize;
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
    /// Varied parameters.
    #[serde(default)]
    pub axis: Vec<AxisTable>,
    /// Combination of axes.
    #[serde(default)]
    pub combine: Combine,
    /// Repetitions with other seeds.
    pub seeds: Option<Seeds>,
    /// Reference; default: the first set.
    pub reference: Option<Reference>,
    /// Compared quantities; default: results of load cycles.
    #[serde(default)]
    pub quantity: Vec<QuantityTable>,
    /// Largest error of the recommended set [-]; default 0.05.
    #[serde(default = "five_percent")]
    pub tolerance: f64,
    /// Concurrent runs; default: number of cores.
    pub jobs: Option<usize>,
}

fn five_percent() -> f64 {
    0.05
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
    /// Column without unit.
    pub column: Option<String>,
    /// Reduction of the column; default: last value.
    pub take: Option<Take>,
    /// Abscissa of a curve; default: first column.
    pub against: Option<String>,
    /// Logarithmic abscissa; default false.
    pub log: Option<bool>,
    /// Error norm; default relative.
    #[serde(default)]
    pub norm: Norm,
    /// Scale of relative errors, above 0; default: the reference.
    pub scale: Option<f64>,
    /// Exact value instead of the reference.
    pub exact: Option<f64>,
    /// Largest error of the recommended set; default: of the study.
    pub tolerance: Option<f64>,
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
