//! What is written in a study file: TOML, unknown keys refused, like a scene.

use serde::Deserialize;
use std::path::PathBuf;

/// A whole study.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// One line that says what is studied; it heads the table.
    #[serde(default)]
    pub title: String,
    /// Scene file, relative to the folder of the study file.
    pub scene: PathBuf,
    /// Overrides of all runs, the reference among them.
    #[serde(default)]
    pub base: Base,
    /// What is varied.
    #[serde(default)]
    pub axis: Vec<AxisTable>,
    /// How the values of several axes make settings.
    #[serde(default)]
    pub combine: Combine,
    /// Runs of each setting with other random numbers.
    pub seeds: Option<Seeds>,
    /// What the settings are compared with; default: the first setting.
    pub reference: Option<Reference>,
    /// What is compared; default: what load cycles leave.
    #[serde(default)]
    pub quantity: Vec<QuantityTable>,
    /// Largest error of the recommended setting, 0 to 1, without unit; default 0.05.
    #[serde(default = "five_percent")]
    pub tolerance: f64,
    /// Runs at a time; default: as many as there are cores.
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

/// What is varied: either one key with its values, or named groups of overrides.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisTable {
    /// Name in labels; default: the last part of `key`.
    pub name: Option<String>,
    /// Key of the scene that takes each of the values.
    pub key: Option<String>,
    /// Values of the key; without it tables with `label` and `set`.
    pub values: Vec<toml::Value>,
}

/// How the values of several axes make settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Combine {
    /// Every value with every other.
    #[default]
    Grid,
    /// The first values together, the second ones, and so on; all axes have as many.
    List,
    /// All first values, and each axis varied about them alone.
    OneAtATime,
}

/// Runs of each setting with other random numbers.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seeds {
    /// The seeds.
    pub values: Vec<u64>,
    /// Keys that they are given to; default: the seed of each group of grains and every other key `seed` of the scene.
    pub keys: Option<Vec<String>>,
}

/// What the settings are compared with: one of them, or a run of its own.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Label of a setting.
    pub label: Option<String>,
    /// Overrides of a run of its own, behind those of `[base]`.
    pub set: Option<Vec<String>>,
}

/// What is compared: a number of `summary.json` or a column of a table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuantityTable {
    /// Name in the tables; default: the column, or the last part of the path.
    pub name: Option<String>,
    /// Unit after the multiplication by `factor`; default: that of the column, where `factor` is 1.
    pub unit: Option<String>,
    /// What values are multiplied by, not 0; default 1.
    #[serde(default = "one")]
    pub factor: f64,
    /// Path of a number in `summary.json`; an entry of a list by its index, its name or `last`.
    pub summary: Option<String>,
    /// Table that a run leaves, such as `cycles.csv`.
    pub file: Option<String>,
    /// Column of the table, without its unit.
    pub column: Option<String>,
    /// What is made of the column; default: its last value.
    pub take: Option<Take>,
    /// Abscissa of a curve; default: the first column.
    pub against: Option<String>,
    /// Whether a curve is compared over the logarithm of its abscissa; default false.
    pub log: Option<bool>,
    /// What the error is; default relative.
    #[serde(default)]
    pub norm: Norm,
    /// What a relative error is relative to, above 0, in the unit of the quantity; default: the size of the reference.
    pub scale: Option<f64>,
    /// Known value, in the unit of the quantity, that takes the place of the reference's.
    pub exact: Option<f64>,
    /// Largest error of the recommended setting: without unit if relative, else in the unit of the quantity; default: the study's.
    pub tolerance: Option<f64>,
}

/// What is made of a column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Take {
    /// The value in the last row.
    #[default]
    Last,
    /// The mean of all rows.
    Mean,
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
    /// All of it, over another column.
    Curve,
}

/// What the error of a quantity is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Norm {
    /// The difference over the size of the reference.
    #[default]
    Relative,
    /// The difference itself.
    Absolute,
}
