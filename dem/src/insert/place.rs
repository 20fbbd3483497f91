//! First positions of stones, free of overlap, ready to fall into a box.
//!
//! Each stone is represented by its bounding sphere. The stones come in random order; for each, a few random points
//! of the plan are tried, the sphere is let down there until it meets the floor or a sphere below, and the lowest
//! of the tries is taken. The heap so rises evenly, layer by layer, as high as the stones need, and denser than a
//! lattice of the largest sphere would be: stones fall less far and settle sooner. With z₁ the height at which a
//! sphere of radius r at (x, y) rests on an earlier one (xⱼ, yⱼ, zⱼ, rⱼ):
//!
//! ```text
//! z₁ = zⱼ + √((r + rⱼ)² − (x − xⱼ)² − (y − yⱼ)²)
//! ```
//!
//! Orientations are uniform over all rotations. Positions and orientations depend on the seed alone.

use crate::base::random::Random;
use nalgebra::{UnitQuaternion, Vector3};

const PURPOSE: u64 = 2;
/// Random plan points tried per stone.
const TRIES: usize = 12;
/// Gap to neighbours and walls, as a share of a stone's radius: no contact at the start, whatever the rounding.
const GAP: f64 = 1e-3;

/// Where a stone starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Centre of mass [m].
    pub position: Vector3<f64>,
    /// Rotation from the stone's principal frame to the world.
    pub orientation: UnitQuaternion<f64>,
}

/// Why stones cannot be placed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// The box is empty or not finite.
    #[error("insertion box must have positive lengths along x and y: {lo:?} .. {hi:?} m")]
    Box {
        /// Lower corner in plan [m].
        lo: [f64; 2],
        /// Upper corner in plan [m].
        hi: [f64; 2],
    },
    /// A bounding radius is not positive and finite.
    #[error("stone {index}: bounding radius {radius} m; it must be positive")]
    Radius {
        /// Index of the stone, from 0.
        index: usize,
        /// Its bounding radius [m].
        radius: f64,
    },
    /// A stone is wider than the box.
    #[error("stone {index} with bounding radius {radius} m does not fit into a box of width {width} m")]
    TooWide {
        /// Index of the stone, from 0.
        index: usize,
        /// Its bounding radius [m].
        radius: f64,
        /// The smaller side of the box [m].
        width: f64,
    },
}

/// Places stones of the given bounding radii [m] loosely in a box without overlap, from its floor upwards.
///
/// `lo` is the lower corner [m] (its z is the floor), `hi_xy` the upper end in plan [m]; the box is open at the top.
/// The result has the order of `radii`.
///
/// # Errors
/// [`PlaceError`] for an empty box, a bad radius, or a stone wider than the box.
pub fn place_loose(
    lo: [f64; 3],
    hi_xy: [f64; 2],
    radii: &[f64],
    seed: u64,
) -> Result<Vec<Placement>, PlaceError> {
    let side: [f64; 2] = std::array::from_fn(|k| hi_xy[k] - lo[k]);
    let finite = lo.iter().chain(&hi_xy).all(|x| x.is_finite());
    if !(finite && side.iter().all(|s| *s > 0.0)) {
        return Err(PlaceError::Box { lo: [lo[0], lo[1]], hi: hi_xy });
    }
    let width = side[0].min(side[1]);
    for (index, &radius) in radii.iter().enumerate() {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(PlaceError::Radius { index, radius });
        }
        if 2.0 * radius * (1.0 + GAP) > width {
            return Err(PlaceError::TooWide { index, radius, width });
        }
    }

    let mut random = Random::new(seed, PURPOSE);
    let mut heap = Heap::new(side, radii);
    let mut placed =
        vec![Placement { position: Vector3::zeros(), orientation: UnitQuaternion::identity() }; radii.len()];
    for i in random.permutation(radii.len()) {
        let r = radii[i] * (1.0 + GAP);
        let mut best = [0.0, 0.0, f64::INFINITY];
        for _ in 0..TRIES {
            let x = r + random.uniform() * (side[0] - 2.0 * r);
            let y = r + random.uniform() * (side[1] - 2.0 * r);
            let z = heap.resting_height(x, y, r, best[2]);
            if z < best[2] {
                best = [x, y, z];
            }
        }
        heap.add(best, r);
        placed[i] = Placement {
            position: Vector3::from(lo) + Vector3::from(best),
            orientation: random.orientation(),
        };
    }
    Ok(placed)
}

/// A placed sphere, relative to the box's corner, and the greatest height of a centre in its column up to it.
struct Entry {
    centre: [f64; 3],
    radius: f64,
    highest: f64,
}

/// Spheres placed so far, in square columns at least as wide as the largest sphere.
struct Heap {
    columns: Vec<Vec<Entry>>,
    count: [usize; 2],
    width: [f64; 2],
    largest: f64,
}

impl Heap {
    fn new(side: [f64; 2], radii: &[f64]) -> Heap {
        let largest = (1.0 + GAP) * radii.iter().copied().fold(0.0, f64::max);
        let count =
            side.map(|s| if largest > 0.0 { ((s / (2.0 * largest)) as usize).clamp(1, 1000) } else { 1 });
        let columns = (0..count[0] * count[1]).map(|_| Vec::new()).collect();
        Heap { columns, count, width: [side[0] / count[0] as f64, side[1] / count[1] as f64], largest }
    }

    fn column(&self, x: f64, y: f64) -> [usize; 2] {
        let index = |v: f64, k: usize| ((v / self.width[k]) as usize).min(self.count[k] - 1);
        [index(x, 0), index(y, 1)]
    }

    /// Lowest height of the centre of a sphere let down at (x, y); `give_up` or above when it is not below that.
    fn resting_height(&self, x: f64, y: f64, r: f64, give_up: f64) -> f64 {
        let [i, j] = self.column(x, y);
        let mut z = r;
        for a in i.saturating_sub(1)..=(i + 1).min(self.count[0] - 1) {
            for b in j.saturating_sub(1)..=(j + 1).min(self.count[1] - 1) {
                for e in self.columns[a * self.count[1] + b].iter().rev() {
                    // No earlier sphere of the column can hold the new one higher than this.
                    if e.highest + r + self.largest <= z || z >= give_up {
                        break;
                    }
                    let reach = r + e.radius;
                    let rise = reach * reach - (x - e.centre[0]).powi(2) - (y - e.centre[1]).powi(2);
                    if rise > 0.0 {
                        z = z.max(e.centre[2] + rise.sqrt());
                    }
                }
            }
        }
        z
    }

    fn add(&mut self, centre: [f64; 3], radius: f64) {
        let [i, j] = self.column(centre[0], centre[1]);
        let column = &mut self.columns[i * self.count[1] + j];
        let highest = column.last().map_or(centre[2], |e| e.highest.max(centre[2]));
        column.push(Entry { centre, radius, highest });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    const LO: [f64; 3] = [-1.7, 0.0, 0.5];
    const HI: [f64; 2] = [1.7, 0.6];

    fn radii(n: usize) -> Vec<f64> {
        (0..n).map(|i| 0.03 + 0.05 * ((i * 7919) % 1000) as f64 / 1000.0).collect()
    }

    #[test]
    fn no_overlaps_inside_the_box_and_not_needlessly_high() {
        let radii = radii(1000);
        let placed = place_loose(LO, HI, &radii, 11).unwrap();
        let mut top = 0.0_f64;
        for (i, (p, r)) in placed.iter().zip(&radii).enumerate() {
            let c = p.position;
            assert!(
                c.x - r >= LO[0]
                    && c.x + r <= HI[0]
                    && c.y - r >= LO[1]
                    && c.y + r <= HI[1]
                    && c.z - r >= LO[2]
            );
            top = top.max(c.z + r - LO[2]);
            for (q, s) in placed[..i].iter().zip(&radii) {
                assert!((c - q.position).norm() > r + s, "stone {i}");
            }
        }
        let solid: f64 = radii.iter().map(|r| 4.19 * r.powi(3)).sum();
        let share = solid / (3.4 * 0.6 * top);
        assert!(share > 0.25, "bounding spheres fill {share} of the heap");
    }

    #[test]
    fn same_seed_same_bits() {
        let run = |seed| place_loose(LO, HI, &radii(200), seed).unwrap();
        let bits = |p: &Placement| (p.position.map(f64::to_bits), p.orientation.coords.map(f64::to_bits));
        assert!(run(3).iter().zip(&run(3)).all(|(a, b)| bits(a) == bits(b)));
        assert_ne!(run(3), run(4));
    }

    #[test]
    fn orientations_are_uniform() {
        let n = 4000;
        let placed = place_loose([0.0; 3], [10.0, 10.0], &vec![0.05; n], 1).unwrap();
        let rotations: Vec<Matrix3<f64>> =
            placed.iter().map(|p| p.orientation.to_rotation_matrix().into_inner()).collect();
        // Each entry has mean 0 and mean square 1/3; the standard errors are 0.009 and 0.005.
        let mean = rotations.iter().sum::<Matrix3<f64>>() / n as f64;
        let square = rotations.iter().map(|m| m.component_mul(m)).sum::<Matrix3<f64>>() / n as f64;
        assert!(mean.iter().all(|x| x.abs() < 0.04), "{mean}");
        assert!(square.iter().all(|x| (x - 1.0 / 3.0).abs() < 0.02), "{square}");
    }

    #[test]
    fn bad_input_is_refused_by_number() {
        let wide = PlaceError::TooWide { index: 1, radius: 0.4, width: 0.6 };
        assert_eq!(place_loose(LO, HI, &[0.1, 0.4], 1), Err(wide));
        assert_eq!(place_loose(LO, HI, &[0.0], 1), Err(PlaceError::Radius { index: 0, radius: 0.0 }));
        assert!(matches!(place_loose(LO, [-1.7, 1.0], &[0.1], 1), Err(PlaceError::Box { .. })));
        assert_eq!(place_loose(LO, HI, &[], 1), Ok(vec![]));
    }
}
