//! Height of the surface of a bed over a rectangle.

use trackbed_dem::measure::BoxRegion;

/// Columns in a direction at most: enough for a mean.
const MOST: usize = 32;

/// Highest grain over each column of a rectangle [m].
#[derive(Clone, Debug)]
pub struct BedSurface {
    low: [f64; 2],
    size: [f64; 2],
    count: [usize; 2],
    floor: f64,
    top: Vec<f64>,
}

impl BedSurface {
    /// The rectangle below and above a box, in columns as wide as a grain of `size` [m].
    pub fn new(region: &BoxRegion, size: f64) -> BedSurface {
        let length = [0, 1].map(|d| region.high[d] - region.low[d]);
        let count = length.map(|l| ((l / size.max(1e-9 * l)).ceil() as usize).clamp(1, MOST));
        BedSurface {
            low: [region.low.x, region.low.y],
            size: [0, 1].map(|d| length[d] / count[d] as f64),
            count,
            floor: region.low.z,
            top: vec![f64::NEG_INFINITY; count[0] * count[1]],
        }
    }

    /// Adds a grain with its centre at `x` [m] and its radius [m]: it covers the columns whose axis it meets.
    pub fn add(&mut self, x: [f64; 3], radius: f64) {
        let range = |d: usize| {
            let place = |edge: f64| (edge - self.low[d]) / self.size[d] - 0.5;
            let last = self.count[d] as f64 - 1.0;
            let (from, to) = (place(x[d] - radius).ceil().max(0.0), place(x[d] + radius).floor().min(last));
            from as usize..if to < from { from as usize } else { to as usize + 1 }
        };
        for j in range(1) {
            for i in range(0) {
                let axis = [i, j].map(|k| k as f64 + 0.5);
                let away = [0, 1].map(|d| self.low[d] + axis[d] * self.size[d] - x[d]);
                let rest = radius * radius - away[0] * away[0] - away[1] * away[1];
                if rest >= 0.0 {
                    let top = &mut self.top[j * self.count[0] + i];
                    *top = top.max(x[2] + rest.sqrt());
                }
            }
        }
    }

    /// Mean height of the surface [m]; a column without a grain counts with the bottom of the box.
    pub fn height(&self) -> f64 {
        let tops = self.top.iter().map(|z| if z.is_finite() { *z } else { self.floor });
        tops.sum::<f64>() / self.top.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_dem::Vec3;

    fn unit() -> BoxRegion {
        BoxRegion { low: Vec3::zeros(), high: Vec3::new(1.0, 1.0, 1.0) }
    }

    #[test]
    fn a_layer_has_its_height_and_nothing_the_floor() {
        let mut surface = BedSurface::new(&unit(), 0.1);
        assert_eq!(surface.height(), 0.0);
        for k in 0..400 {
            surface.add([0.05 * f64::from(k % 20) + 0.025, 0.05 * f64::from(k / 20) + 0.025, 0.4], 0.1);
        }
        assert!((surface.height() - 0.5).abs() < 0.02, "{}", surface.height());
    }

    /// One grain on a wide floor is no bed.
    #[test]
    fn one_high_grain_does_not_raise_the_surface() {
        let mut surface = BedSurface::new(&unit(), 0.1);
        surface.add([0.5, 0.5, 0.9], 0.1);
        assert!(surface.height() > 0.0 && surface.height() < 0.1, "{}", surface.height());
        surface.add([5.0, 5.0, 0.9], 0.1);
        assert!(surface.height() < 0.1);
    }

    /// A bed that ends below the box has its own height, not that of the box.
    #[test]
    fn a_bed_below_the_box_has_its_height() {
        let mut surface = BedSurface::new(&BoxRegion { low: Vec3::new(0.0, 0.0, 0.6), ..unit() }, 0.1);
        for k in 0..400 {
            surface.add([0.05 * f64::from(k % 20) + 0.025, 0.05 * f64::from(k / 20) + 0.025, 0.4], 0.1);
        }
        assert!((surface.height() - 0.5).abs() < 0.02, "{}", surface.height());
    }
}
