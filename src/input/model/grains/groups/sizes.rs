//! Grain sizes: sieve curve, distribution, or range.

use crate::model::tables::{self, Grading};
use crate::scene::grains::{Grains, Share, Sizes};
use crate::scene::units::{Length, Quantity};
use crate::scene::{SceneError, Table};
use trackbed_dem::insert::sizes::SizeLaw;

/// Sample size for means without a closed form.
const SAMPLES: usize = 10_000;

pub(super) enum SizeSource {
    Graded(Grading),
    Law(SizeLaw),
    /// Evenly spaced sizes in order [m].
    Range(f64, f64),
}

impl SizeSource {
    /// Reads the size source of a group.
    pub fn of(group: &Table<Grains>) -> Result<SizeSource, SceneError> {
        match (&group.gradation, &group.size, &group.sizes) {
            (Some(g), None, None) => {
                group.check("gradation.scale", g.scale, |s| s > 0.0, "above 0")?;
                let grading = tables::gradation(&group.locate(&g.file), &g.standard, &g.grade);
                let grading = grading.map_err(|e| match e.line {
                    // The whole gradation: report the scene key.
                    None if e.key == "gradation" => group.problem("gradation", e.problem),
                    _ => e,
                })?;
                Ok(SizeSource::Graded(grading.scaled(g.scale)))
            }
            (None, Some([low, high]), None) => {
                group.check("size", *low, |s| s > 0.0, "sizes above 0")?;
                group.check("size", *high, |s| s >= low.si, "the larger size last")?;
                Ok(SizeSource::Range(low.si, high.si))
            }
            (None, None, Some(sizes)) => {
                let law = law(sizes);
                let expected = "sizes above 0 in rising order, and positive deviations";
                law.check().map_err(|e| group.error("sizes", e.to_string(), expected))?;
                Ok(SizeSource::Law(law))
            }
            (gradation, size, sizes) => Err(group.one_of(&[
                ("gradation", gradation.is_some()),
                ("size", size.is_some()),
                ("sizes", sizes.is_some()),
            ])),
        }
    }

    /// Draws sieve sizes [m]. Shape `[count]`.
    pub fn sample(&self, count: usize, seed: u64) -> Vec<f64> {
        match self {
            SizeSource::Graded(g) => g.curve.sample(count, seed),
            SizeSource::Law(law) => law.sample(count, seed),
            SizeSource::Range(low, high) => {
                (0..count).map(|i| low + (high - low) * (i as f64 + 0.5) / count as f64).collect()
            }
        }
    }

    /// Returns the mean of size³ [m³].
    pub fn mean_cube(&self) -> f64 {
        match self {
            SizeSource::Graded(g) => g.curve.mean_cube(),
            _ => self.sample(SAMPLES, 1).iter().map(|s| s.powi(3)).sum::<f64>() / SAMPLES as f64,
        }
    }
}

fn law(sizes: &Sizes) -> SizeLaw {
    let ends = |low: &Quantity<Length>, high: &Quantity<Length>| (low.si, high.si);
    match sizes {
        Sizes::Monodisperse { size } => SizeLaw::Equal(size.si),
        Sizes::Bidisperse { small, large, large_share } => {
            SizeLaw::Two { small: small.si, large: large.si, large_share: *large_share }
        }
        Sizes::Uniform { low, high, by: Share::Number } => {
            let (low, high) = ends(low, high);
            SizeLaw::ByNumber { low, high }
        }
        Sizes::Uniform { low, high, by: Share::Volume } => {
            let (low, high) = ends(low, high);
            SizeLaw::ByVolume { low, high }
        }
        Sizes::Normal { mean, deviation, low, high } => {
            let (low, high) = ends(low, high);
            SizeLaw::Normal { mean: mean.si, deviation: deviation.si, low, high }
        }
        Sizes::LogNormal { median, deviation, low, high } => {
            let (low, high) = ends(low, high);
            SizeLaw::LogNormal { median: median.si, deviation: *deviation, low, high }
        }
    }
}
