//! Random sequential addition (Widom 1966) in a container, large spheres first.
//!
//! Limits: equal spheres jam near a solid fraction of 0.38 (Torquato 2002).

use super::container::Container;
use crate::base::Vec3;
use crate::base::random::Random;
use nalgebra::UnitQuaternion;

const PURPOSE: u64 = 4;
const TURNS: u64 = 5;
/// Trials per sphere.
const TRIES: usize = 20_000;

/// Failed random placement.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScatterError {
    /// Invalid radius.
    #[error("grain {index}: radius {radius} m; it must be positive")]
    Radius {
        /// Index of the grain.
        index: usize,
        /// Radius [m].
        radius: f64,
    },
    /// No free position.
    #[error(
        "no free position for a grain of radius {radius} m after {placed} of {count} grains (solid fraction {share:.3}; random insertion reaches about 0.38)"
    )]
    Full {
        /// Grains placed.
        placed: usize,
        /// Grains requested.
        count: usize,
        /// Radius of the failed grain [m].
        radius: f64,
        /// Solid fraction of bounding spheres [-].
        share: f64,
    },
}

/// Overlap-free centres [m] for spheres of `radii` [m], in their order.
///
/// # Errors
/// [`ScatterError`] for an invalid radius or a full container.
pub fn scatter(container: &Container, radii: &[f64], seed: u64) -> Result<Vec<Vec3>, ScatterError> {
    if let Some(index) = radii.iter().position(|r| !(*r > 0.0 && r.is_finite())) {
        return Err(ScatterError::Radius { index, radius: radii[index] });
    }
    let (low, high) = container.bounds();
    let mut random = Random::new(seed, PURPOSE);
    let mut order: Vec<usize> = (0..radii.len()).collect();
    order.sort_by(|&a, &b| radii[b].total_cmp(&radii[a]));
    let largest = order.first().map_or(1.0, |&i| radii[i]);
    let mean = radii.iter().sum::<f64>() / radii.len().max(1) as f64;
    let mut grid = Grid::new(low, high, 2.0 * mean, largest);
    let mut centres = vec![Vec3::zeros(); radii.len()];
    let mut volume = 0.0;
    for (placed, &i) in order.iter().enumerate() {
        let r = radii[i];
        let free = (0..TRIES).find_map(|_| {
            let p = Vec3::from_fn(|d, _| {
                let (a, b) = (low[d] + r, high[d] - r);
                a + random.uniform() * (b - a)
            });
            (container.holds(&p, r) && grid.free(&p, r)).then_some(p)
        });
        let Some(p) = free else {
            let share = volume / container.volume();
            return Err(ScatterError::Full { placed, count: radii.len(), radius: r, share });
        };
        grid.add(p, r);
        centres[i] = p;
        volume += 4.0 / 3.0 * std::f64::consts::PI * r * r * r;
    }
    Ok(centres)
}

/// `n` uniform random rotations, reproducible by `seed`.
pub fn orientations(n: usize, seed: u64) -> Vec<UnitQuaternion<f64>> {
    let mut random = Random::new(seed, TURNS);
    (0..n).map(|_| random.orientation()).collect()
}

/// Outside spheres go to boundary cells.
pub(super) struct Grid {
    low: Vec3,
    width: f64,
    counts: [usize; 3],
    cells: Vec<Vec<(Vec3, f64)>>,
    largest: f64,
}

impl Grid {
    pub fn new(low: Vec3, high: Vec3, width: f64, largest: f64) -> Grid {
        let counts = std::array::from_fn(|d| (((high[d] - low[d]) / width) as usize).clamp(1, 200));
        let cells = vec![Vec::new(); counts.iter().product()];
        // Wider cells limit their number.
        let width = (0..3).map(|d| (high[d] - low[d]) / counts[d] as f64).fold(width, f64::max);
        Grid { low, width, counts, cells, largest }
    }

    fn cell(&self, p: &Vec3) -> [usize; 3] {
        std::array::from_fn(|d| {
            (((p[d] - self.low[d]) / self.width).max(0.0) as usize).min(self.counts[d] - 1)
        })
    }

    fn index(&self, c: [usize; 3]) -> usize {
        (c[0] * self.counts[1] + c[1]) * self.counts[2] + c[2]
    }

    pub fn free(&self, p: &Vec3, r: f64) -> bool {
        let reach = r + self.largest;
        let (from, to) = (self.cell(&p.add_scalar(-reach)), self.cell(&p.add_scalar(reach)));
        for i in from[0]..=to[0] {
            for j in from[1]..=to[1] {
                for k in from[2]..=to[2] {
                    let overlaps = |(q, s): &(Vec3, f64)| (p - q).norm_squared() < (r + s) * (r + s);
                    if self.cells[self.index([i, j, k])].iter().any(overlaps) {
                        return false;
                    }
                }
            }
        }
        true
    }

    pub fn add(&mut self, p: Vec3, r: f64) {
        let at = self.index(self.cell(&p));
        self.cells[at].push((p, r));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scattered_spheres_are_inside_and_apart() {
        let containers = [
            Container::Box { low: Vec3::new(-1.0, 0.0, 2.0), high: Vec3::new(0.0, 0.5, 4.0) },
            Container::Cone {
                from: Vec3::zeros(),
                to: Vec3::new(0.0, 0.3, 1.0),
                from_radius: 0.2,
                to_radius: 0.6,
            },
        ];
        for container in &containers {
            let radii: Vec<f64> = (0..800).map(|i| 0.01 + 0.03 * f64::from(i % 7) / 7.0).collect();
            let centres = scatter(container, &radii, 9).unwrap();
            for (i, (p, r)) in centres.iter().zip(&radii).enumerate() {
                assert!(container.holds(p, *r), "{i}");
                assert!(centres[..i].iter().zip(&radii).all(|(q, s)| (p - q).norm() >= r + s), "{i}");
            }
            assert_eq!(centres, scatter(container, &radii, 9).unwrap());
            assert_ne!(centres, scatter(container, &radii, 10).unwrap());
        }
    }

    #[test]
    fn scatters_up_to_jamming() {
        let container = Container::Box { low: Vec3::zeros(), high: Vec3::repeat(1.0) };
        let count = |share: f64| (share / (4.0 / 3.0 * std::f64::consts::PI * 0.03_f64.powi(3))) as usize;
        assert!(scatter(&container, &vec![0.03; count(0.29)], 1).is_ok());
        let error = scatter(&container, &vec![0.03; count(0.45)], 1).unwrap_err();
        let ScatterError::Full { share, .. } = error else { panic!("{error}") };
        assert!((0.28..0.39).contains(&share), "{share}");
        let bad = scatter(&container, &[0.1, -1.0], 1).unwrap_err();
        assert_eq!(bad, ScatterError::Radius { index: 1, radius: -1.0 });
    }
}
