//! Samples of the unit cube: Latin hypercube (McKay, Beckman and Conover 1979), Sobol sequence (Joe and Kuo 2008).

use trackbed_dem::random::Random;

/// Most dimensions of the Sobol sequence.
pub const SOBOL_DIMENSIONS: usize = 10;
/// Latin hypercubes compared.
const CANDIDATES: usize = 200;
/// Most samples of compared hypercubes.
const MOST_COMPARED: usize = 1000;
/// Bits of the Sobol sequence: at most 2³⁰ samples.
const BITS: u32 = 30;

/// Primitive polynomials from the second dimension on: degree, coefficients, initial numbers (`new-joe-kuo-6.21201`).
const POLYNOMIALS: [(u32, u32, &[u32]); SOBOL_DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
];

/// Returns `count` points of a random Latin hypercube: one in each of `count` equal intervals of each dimension.
///
/// Of several hypercubes, the one with the least correlation between its dimensions.
pub fn latin_hypercube(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let hypercube = |candidate: usize| -> Vec<Vec<f64>> {
        let column = |d: usize| {
            let mut random = Random::new(seed, (candidate * dimensions + d) as u64);
            let order = random.permutation(count);
            order.into_iter().map(|k| (k as f64 + random.uniform()) / count as f64).collect()
        };
        (0..dimensions).map(column).collect()
    };
    let candidates = if dimensions < 2 || count > MOST_COMPARED { 1 } else { CANDIDATES };
    let (mut columns, mut least) = (hypercube(0), f64::INFINITY);
    for candidate in (0..candidates).map(hypercube).filter(|_| candidates > 1) {
        let correlation = largest_correlation(&candidate);
        if correlation < least {
            (columns, least) = (candidate, correlation);
        }
    }
    (0..count).map(|k| columns.iter().map(|column| column[k]).collect()).collect()
}

/// Largest covariance between two columns of uniform numbers.
fn largest_correlation(columns: &[Vec<f64>]) -> f64 {
    let covariance = |a: &[f64], b: &[f64]| {
        let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum();
        sum.abs()
    };
    let pairs = columns.iter().enumerate().flat_map(|(k, a)| columns[..k].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| covariance(a, b)).fold(0.0, f64::max)
}

/// Returns the first `count` points of the Sobol sequence; with `seed` under a random digital shift.
pub fn sobol(count: usize, dimensions: usize, seed: Option<u64>) -> Vec<Vec<f64>> {
    let directions: Vec<[u32; BITS as usize]> = (0..dimensions).map(directions).collect();
    let scale = f64::from(1_u32 << BITS);
    let shift = |d: usize| seed.map_or(0, |seed| (Random::new(seed, d as u64).uniform() * scale) as u32);
    let mut point: Vec<u32> = (0..dimensions).map(shift).collect();
    let mut points = Vec::with_capacity(count);
    for k in 0..count {
        points.push(point.iter().map(|x| f64::from(*x) / scale).collect());
        // Gray code (Antonov and Saleev 1979).
        let bit = k.trailing_ones() as usize;
        point.iter_mut().zip(&directions).for_each(|(x, direction)| *x ^= direction[bit]);
    }
    points
}

/// Direction numbers of a dimension, from 0.
fn directions(dimension: usize) -> [u32; BITS as usize] {
    let mut v = [0; BITS as usize];
    let Some((degree, coefficients, initial)) = dimension.checked_sub(1).map(|d| POLYNOMIALS[d]) else {
        (0..BITS).for_each(|k| v[k as usize] = 1 << (BITS - 1 - k));
        return v;
    };
    let degree = degree as usize;
    for k in 0..BITS as usize {
        v[k] = match initial.get(k) {
            Some(m) => m << (BITS as usize - 1 - k),
            None => {
                let mut next = v[k - degree] ^ (v[k - degree] >> degree);
                for j in 1..degree {
                    if coefficients >> (degree - 1 - j) & 1 == 1 {
                        next ^= v[k - j];
                    }
                }
                next
            }
        };
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of distinct intervals of length 1 / `count` with points, by dimension.
    fn occupied(points: &[Vec<f64>], d: usize, count: usize) -> usize {
        let all: std::collections::BTreeSet<usize> =
            points.iter().map(|p| (p[d] * count as f64) as usize).collect();
        assert!(points.iter().all(|p| (0.0..1.0).contains(&p[d])));
        all.len()
    }

    #[test]
    fn latin_hypercube_fills_each_stratum() {
        for (count, seed) in [(1, 1), (7, 1), (100, 5)] {
            let points = latin_hypercube(count, 4, seed);
            assert!((0..4).all(|d| occupied(&points, d, count) == count), "{count}");
        }
        let points = latin_hypercube(100, 2, 1);
        assert_eq!(points, latin_hypercube(100, 2, 1));
        assert_ne!(points, latin_hypercube(100, 2, 2));
        let r: f64 = points.iter().map(|p| 12.0 * (p[0] - 0.5) * (p[1] - 0.5)).sum::<f64>() / 100.0;
        assert!(r.abs() < 0.01, "{r}");
        // Positions within the strata vary.
        let offset = |p: &Vec<f64>| (p[0] * 100.0).fract();
        let mean = points.iter().map(offset).sum::<f64>() / 100.0;
        assert!((0.35..0.65).contains(&mean), "{mean}");
    }

    /// First points of F. Y. Kuo's program `sobol.cc` in three dimensions.
    #[test]
    fn sobol_matches_published_points() {
        let published = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
            [0.1875, 0.3125, 0.9375],
            [0.6875, 0.8125, 0.4375],
        ];
        assert_eq!(sobol(10, 3, None), published);
    }

    /// First points, times 16, of `scipy.stats.qmc.Sobol(10, scramble=False)`.
    #[test]
    fn sobol_matches_scipy_in_ten_dimensions() {
        let reference = [
            [0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
            [8, 8, 8, 8, 8, 8, 8, 8, 8, 8],
            [12, 4, 4, 4, 12, 12, 4, 12, 12, 12],
            [4, 12, 12, 12, 4, 4, 12, 4, 4, 4],
            [6, 6, 10, 14, 6, 2, 6, 14, 14, 10],
            [14, 14, 2, 6, 14, 10, 14, 6, 6, 2],
            [10, 2, 14, 10, 10, 14, 2, 2, 2, 6],
            [2, 10, 6, 2, 2, 6, 10, 10, 10, 14],
            [3, 5, 15, 7, 9, 5, 7, 15, 15, 5],
            [11, 13, 7, 15, 1, 13, 15, 7, 7, 13],
            [15, 1, 11, 3, 5, 9, 3, 3, 3, 9],
            [7, 9, 3, 11, 13, 1, 11, 11, 11, 1],
            [5, 3, 5, 9, 15, 7, 1, 1, 1, 15],
            [13, 11, 13, 1, 7, 15, 9, 9, 9, 7],
            [9, 7, 1, 13, 3, 11, 5, 13, 13, 3],
            [1, 15, 9, 5, 11, 3, 13, 5, 5, 11],
        ];
        let points = sobol(16, 10, None);
        for (point, expected) in points.iter().zip(reference) {
            let sixteenths: Vec<i32> = point.iter().map(|x| (16.0 * x) as i32).collect();
            assert_eq!(sixteenths, expected);
        }
    }

    #[test]
    fn sobol_is_net_in_ten_dimensions() {
        for seed in [None, Some(3)] {
            let points = sobol(256, SOBOL_DIMENSIONS, seed);
            assert!((0..SOBOL_DIMENSIONS).all(|d| occupied(&points, d, 256) == 256), "{seed:?}");
            for (a, b) in (0..SOBOL_DIMENSIONS).flat_map(|a| (0..a).map(move |b| (a, b))) {
                let cell = |p: &Vec<f64>| 16 * (p[a] * 16.0) as usize + (p[b] * 16.0) as usize;
                let cells: std::collections::BTreeSet<usize> = points.iter().map(cell).collect();
                assert!(cells.len() >= 64, "{a} {b}: {}", cells.len());
            }
        }
        let shifted = sobol(8, 2, Some(1));
        assert_ne!(shifted, sobol(8, 2, None));
        assert_eq!(shifted[..4], sobol(4, 2, Some(1)), "more samples extend the sequence");
    }
}
