//! Regular packings of equal spheres.
//!
//! | lattice | layers along z | porosity |
//! |---|---|---|
//! | simple cubic ("loose") | square, d apart | 1 − π/6 = 0.4764 |
//! | hexagonal close packed | ABAB…, d √(2/3) apart | 1 − π/(3√2) = 0.2595 |
//! | face-centred cubic | ABCABC…, d √(2/3) apart | 1 − π/(3√2) = 0.2595 |
//!
//! Bulk porosities; a gap of [`GAP`] diameters prevents contacts by rounding.

use crate::base::Vec3;

/// Relative gap between neighbours.
pub const GAP: f64 = 1e-9;

/// Lattice of equal spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lattice {
    /// Simple cubic.
    Simple,
    /// Hexagonal close packed.
    Hexagonal,
    /// Face-centred cubic, close-packed plane horizontal.
    FaceCentred,
}

impl Lattice {
    /// Relative position of column i, row j, layer k, in diameters.
    fn site(self, i: usize, j: usize, k: usize) -> Vec3 {
        let (x, y, z) = (i as f64, j as f64, k as f64);
        let third = 1.0 / 3.0_f64.sqrt(); // layer shift in y over √3/2
        let row = |shift_x: f64, shift_y: f64| {
            // Alternate rows shift by half a sphere, so a finite block stays upright.
            let odd = (j % 2) as f64;
            Vec3::new(
                x + 0.5 * ((odd + shift_x) % 2.0),
                (y + shift_y / 3.0) * 1.5 * third,
                z * (2.0_f64 / 3.0).sqrt(),
            )
        };
        match self {
            Lattice::Simple => Vec3::new(x, y, z),
            Lattice::Hexagonal => row((k % 2) as f64, (k % 2) as f64),
            Lattice::FaceCentred => row((k % 3 % 2) as f64, (k % 3) as f64),
        }
    }

    /// Sphere centres [m] of `counts` columns, rows and layers (slowest); `low`: bounding box corner [m].
    pub fn block(self, low: Vec3, radius: f64, counts: [usize; 3]) -> Vec<Vec3> {
        let d = 2.0 * radius * (1.0 + GAP);
        let mut sites = Vec::with_capacity(counts.iter().product());
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    sites.push(low.add_scalar(radius) + self.site(i, j, k) * d);
                }
            }
        }
        sites
    }

    /// As [`Lattice::block`], all spheres between `low` and `high` [m].
    pub fn fill(self, low: Vec3, high: Vec3, radius: f64) -> Vec<Vec3> {
        let d = 2.0 * radius * (1.0 + GAP);
        let most = (high - low).map(|l| ((l.max(0.0) / (0.8 * d)) as usize).saturating_add(2));
        let slack = 2.0 * GAP * (high - low).max();
        let mut sites = self.block(low, radius, [most.x, most.y, most.z]);
        sites.retain(|c| (0..3).all(|k| c[k] + radius <= high[k] + slack));
        sites
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::input::BodyInput;
    use crate::engine::input::ModelInput;
    use crate::measure::{BoxRegion, porosity};
    use crate::shape::Shape;
    use crate::testing::SOFT;
    use crate::{Model, State};
    use std::f64::consts::PI;

    const ALL: [Lattice; 3] = [Lattice::Simple, Lattice::Hexagonal, Lattice::FaceCentred];

    /// Both close packings have second-shell squared distance 2 (in d²); only hcp has √(8/3) d.
    #[test]
    fn neighbours_are_those_of_the_lattice() {
        for lattice in ALL {
            let sites = lattice.block(Vec3::new(3.0, -1.0, 0.5), 0.05, [7, 7, 7]);
            assert_eq!(sites.len(), 343);
            let middle = sites.iter().sum::<Vec3>() / 343.0;
            let centre =
                sites.iter().min_by(|a, b| (*a - middle).norm().total_cmp(&(*b - middle).norm())).unwrap();
            let mut distances: Vec<f64> = sites.iter().map(|s| (s - centre).norm() / 0.1).collect();
            distances.sort_by(f64::total_cmp);
            let near = |from: f64, to: f64| distances.iter().filter(|d| (from..to).contains(*d)).count();
            let expected = if lattice == Lattice::Simple { 6 } else { 12 };
            assert_eq!((near(0.5, 0.999_999), near(0.999_999, 1.000_001)), (0, expected), "{lattice:?}");
            assert_eq!(near(1.63, 1.64), if lattice == Lattice::Hexagonal { 2 } else { 0 }, "{lattice:?}");
            assert_eq!(near(1.41, 1.42), if lattice == Lattice::Simple { 12 } else { 6 }, "{lattice:?}");
        }
    }

    #[test]
    fn bulk_porosity_is_the_closed_form() {
        let radius = 0.01;
        for lattice in ALL {
            let counts = [10, 12, 14];
            let at = |position| BodyInput { position, ..BodyInput::default() };
            let model = Model::new(ModelInput {
                materials: vec![SOFT],
                shapes: vec![Shape::Sphere { radius }],
                bodies: lattice.block(Vec3::zeros(), radius, counts).into_iter().map(at).collect(),
                ..ModelInput::default()
            })
            .unwrap();
            let state = State::new(&model);
            let d = 2.0 * radius * (1.0 + GAP);
            let period = match lattice {
                Lattice::Simple => Vec3::new(d, d, d),
                Lattice::Hexagonal => Vec3::new(d, d * 3.0_f64.sqrt(), 2.0 * d * (2.0_f64 / 3.0).sqrt()),
                Lattice::FaceCentred => Vec3::new(d, d * 3.0_f64.sqrt(), 3.0 * d * (2.0_f64 / 3.0).sqrt()),
            };
            let low = Vec3::new(2.3, 2.1, 2.7) * d;
            let region = BoxRegion { low, high: low + period.component_mul(&Vec3::new(4.0, 2.0, 2.0)) };
            let exact =
                if lattice == Lattice::Simple { 1.0 - PI / 6.0 } else { 1.0 - PI / (3.0 * 2.0_f64.sqrt()) };
            let found = porosity(&model, &state, &region);
            assert!((found - exact).abs() < 1e-8, "{lattice:?}: {found} {exact}");
        }
    }

    #[test]
    fn fills_box_without_overflow() {
        for lattice in ALL {
            let (low, high) = (Vec3::new(-0.2, 0.1, 0.0), Vec3::new(0.21, 0.5, 0.4));
            let sites = lattice.fill(low, high, 0.02);
            for (i, c) in sites.iter().enumerate() {
                assert!((0..3).all(|k| c[k] - 0.02 > low[k] - 1e-9 && c[k] + 0.02 < high[k] + 2e-9));
                assert!(sites[..i].iter().all(|q| (q - c).norm() > 0.04));
            }
            let least = 1000;
            assert!(sites.len() >= least, "{lattice:?}: {}", sites.len());
        }
        assert_eq!(Lattice::Simple.fill(Vec3::zeros(), Vec3::new(0.41, 0.41, 0.41), 0.02).len(), 1000);
        assert!(Lattice::Hexagonal.fill(Vec3::zeros(), Vec3::repeat(0.01), 0.02).is_empty());
    }
}
