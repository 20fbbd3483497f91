//! Overlap-free initial positions for gravity deposition.
//!
//! Bounding spheres are dropped in random order at several random plan points; the lowest position is
//! selected. Rest height of a sphere of radius r at (x, y) on (xⱼ, yⱼ, zⱼ, rⱼ):
//!
//! ```text
//! z₁ = zⱼ + √((r + rⱼ)² − (x − xⱼ)² − (y − yⱼ)²)
//! ```

use crate::base::random::Random;
use nalgebra::{UnitQuaternion, Vector3};

const PURPOSE: u64 = 2;
/// Trial points per stone.
const TRIES: usize = 12;
/// Relative gap against initial contacts by rounding.
const GAP: f64 = 1e-3;

/// Initial position of a stone.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Centre of mass [m].
    pub position: Vector3<f64>,
    /// Rotation from principal frame to world.
    pub orientation: UnitQuaternion<f64>,
}

/// Failed placement.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// Empty or non-finite box.
    #[error("insertion box must have positive lengths along x and y: {lo:?} .. {hi:?} m")]
    Box {
        /// Lower plan corner [m].
        lo: [f64; 2],
        /// Upper plan corner [m].
        hi: [f64; 2],
    },
    /// Invalid bounding radius.
    #[error("stone {index}: bounding radius {radius} m; it must be positive")]
    Radius {
        /// Index of the stone.
        index: usize,
        /// Bounding radius [m].
        radius: f64,
    },
    /// Stone wider than the box.
    #[error("stone {index} with bounding radius {radius} m does not fit into a box of width {width} m")]
    TooWide {
        /// Index of the stone.
        index: usize,
        /// Bounding radius [m].
        radius: f64,
        /// Smaller box side [m].
        width: f64,
    },
}

/// Places stones of bounding `radii` [m], in their order, in a box open at the top.
///
/// `lo` is the lower corner [m] (z: floor), `hi_xy` the upper plan corner [m].
///
/// # Errors
/// [`PlaceError`] for an empty box, an invalid radius or too wide a stone.
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

struct Entry {
    centre: [f64; 3],
    radius: f64,
    highest: f64,
}

/// Column of a point and those around it: a support found early ends the search of the others near the top.
const NEAREST_FIRST: [[isize; 2]; 9] =
    [[0, 0], [-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [-1, 1], [1, -1], [1, 1]];

/// In columns at least as wide as the largest sphere.
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

    /// Rest height at (x, y); `give_up` or above if not lower.
    fn resting_height(&self, x: f64, y: f64, r: f64, give_up: f64) -> f64 {
        let [i, j] = self.column(x, y);
        let mut z = r;
        for [a, b] in NEAREST_FIRST {
            let column = i.checked_add_signed(a).zip(j.checked_add_signed(b));
            let Some((a, b)) = column.filter(|(a, b)| *a < self.count[0] && *b < self.count[1]) else {
                continue;
            };
            for e in self.columns[a * self.count[1] + b].iter().rev() {
                // Earlier spheres of the column cannot support higher positions.
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
    fn placement_is_dense_without_overlap() {
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
        // Each entry: mean 0, mean square 1/3.
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
