//! Stiffness of grains with a spread: materials of grains in classes of equal probability.
//!
//! A class takes the mean of its part of the distribution, so the mean is kept; 16 classes keep 98.9 % of the standard deviation of a normal
//! distribution. In each group every class has as many grains as any other, within one, in random order.

use super::bonds::law;
use super::groups::GroupsPart;
use super::materials::MaterialsPart;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::bond::Spread;
use trackbed_dem::random::Random;
use trackbed_dem::{Material, PairOverride};
use trackbed_io::extremes::normal_quantile;

/// Number of classes.
const CLASSES: usize = 16;
/// Values of the distribution in one class.
const VALUES: usize = 256;
/// Stream of the order of grains.
const ORDER: u64 = 0x5d00;

/// Gives grains of materials with a spread one of its classes each.
pub(super) fn spread(
    scene: &Table<Scene>,
    groups: &mut GroupsPart,
    materials: &mut MaterialsPart,
) -> Result<(), SceneError> {
    for base in 0..scene.material.len() {
        let row = scene.row("material", &scene.material, base);
        let Some(table) = row.optional("stiffness_spread", &row.stiffness_spread) else { continue };
        let material = materials.all[base];
        if material.young.is_none() && material.stiffness.is_infinite() {
            return Err(row.no_effect("stiffness_spread", "`young` or `stiffness`"));
        }
        let replaced = |other: usize| {
            let of =
                |pair: &PairOverride| [pair.a, pair.b] == [base, other] || [pair.b, pair.a] == [base, other];
            materials.pairs.iter().any(|pair| of(pair) && pair.stiffness.is_some())
        };
        if material.young.is_none() && (0..scene.material.len()).all(replaced) {
            return Err(row.conflict("stiffness_spread", "`stiffness` of all [[contact]]"));
        }
        let spread = law(&table, table.kind, table.deviation, table.modulus)?;
        if !materials.of_grains.contains(&base) {
            return Err(row.no_effect("stiffness_spread", "[[grains]] of this material"));
        }
        let factors = factors(spread);
        let strength = materials.greatest_strength(base, factors[0]);
        row.check(
            "corner_strength",
            row.corner_strength,
            |s| s < strength,
            &format!("below {strength:.3e} Pa, the limit of the softest class"),
        )?;
        let first = materials.add_classes(base, &factors);
        assign(groups, base, first, table.seed.unwrap_or(1));
    }
    Ok(())
}

fn assign(groups: &mut GroupsPart, base: usize, first: usize, seed: u64) {
    for group in 0..groups.names.len() as u32 {
        let own: Vec<usize> = (0..groups.bodies.len())
            .filter(|&b| groups.bodies[b].part == group && groups.bodies[b].material == base)
            .collect();
        let order = Random::new(seed, ORDER + u64::from(group)).permutation(own.len());
        for (body, rank) in own.iter().zip(order) {
            // Middle of the grain's part of the probability.
            groups.bodies[*body].material = first + (2 * rank + 1) * CLASSES / (2 * own.len());
        }
    }
}

impl MaterialsPart {
    /// Appends a material with its pairs for each stiffness factor; returns the first.
    fn add_classes(&mut self, base: usize, factors: &[f64]) -> usize {
        let first = self.all.len();
        let material = self.all[base];
        self.all.extend(factors.iter().map(|factor| Material {
            young: material.young.map(|young| young * factor),
            stiffness: material.stiffness * factor,
            ..material
        }));
        let classes = first..self.all.len();
        self.of_grains.extend(classes.clone());
        self.names.extend(classes.clone().map(|_| self.names[base].clone()).collect::<Vec<_>>());
        self.factors.resize(first, 1.0);
        self.factors.extend(factors);
        let of = |material: usize| {
            let more = if material == base { classes.clone() } else { 0..0 };
            [material].into_iter().chain(more)
        };
        let pairs = self.pairs.iter().flat_map(|pair| {
            of(pair.a).flat_map(move |a| of(pair.b).map(move |b| PairOverride { a, b, ..*pair }))
        });
        self.pairs = pairs.collect();
        first
    }

    /// Returns the stiffness of a material over the mean of its spread.
    pub fn stiffness_factor(&self, material: usize) -> f64 {
        self.factors.get(material).copied().unwrap_or(1.0)
    }
}

/// Mean value of each class, ascending.
fn factors(spread: Spread) -> Vec<f64> {
    let value = |k: usize| quantile(spread, (k as f64 + 0.5) / (CLASSES * VALUES) as f64);
    let mean = |class: usize| (0..VALUES).map(|k| value(class * VALUES + k)).sum::<f64>() / VALUES as f64;
    (0..CLASSES).map(mean).collect()
}

/// Value below which a fraction `p` of the factors lies.
fn quantile(spread: Spread, p: f64) -> f64 {
    match spread {
        Spread::Constant => 1.0,
        Spread::Weibull { modulus } => libm::pow(-libm::log(1.0 - p), 1.0 / modulus),
        Spread::Normal { deviation } => {
            // Cut off at zero.
            let cut = 0.5 * libm::erfc(std::f64::consts::FRAC_1_SQRT_2 / deviation);
            1.0 + deviation * normal_quantile(cut + p * (1.0 - cut))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value}, expected {expected}");
    }

    fn moments(values: &[f64]) -> [f64; 2] {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64;
        [mean, square.sqrt()]
    }

    /// Quantiles of the standard normal distribution: Abramowitz & Stegun 1964, table 26.5.
    #[test]
    fn quantiles_are_those_of_tables() {
        let normal = Spread::Normal { deviation: 0.1 };
        for (p, z) in [(0.5, 0.0), (0.8, 0.84162), (0.975, 1.95996), (0.01, -2.32635)] {
            near(quantile(normal, p), 1.0 + 0.1 * z, 1e-6);
        }
        // Median (ln 2)^(1/m).
        near(quantile(Spread::Weibull { modulus: 3.0 }, 0.5), 0.884997, 1e-6);
    }

    /// Deviation between 16 classes over the whole deviation: from the means of a normal distribution between quantiles a < b,
    /// 16 (φ(a) − φ(b)); for Weibull by two million quantiles.
    #[test]
    fn classes_keep_mean_and_deviation() {
        let [mean, deviation] = moments(&factors(Spread::Normal { deviation: 0.2 }));
        near(mean, 1.0, 1e-4);
        near(deviation / 0.2, 0.988825, 2e-4);
        // Γ(1 + 1/m), and √(Γ(1 + 2/m) − Γ(1 + 1/m)²).
        let [mean, deviation] = moments(&factors(Spread::Weibull { modulus: 3.0 }));
        near(mean, 0.892980, 2e-4);
        near(deviation / 0.324582, 0.991608, 2e-4);
        // Most of a wide normal distribution is cut off: no factor is negative.
        assert!(factors(Spread::Normal { deviation: 5.0 }).iter().all(|f| *f > 0.0));
    }
}
