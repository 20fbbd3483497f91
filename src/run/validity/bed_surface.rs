//! Surface height of a bed over a rectangle.

use trackbed_dem::measure::BoxRegion;

/// Enough for a mean.
const MOST: usize = 32;

/// Highest grain per column [m].
#[derive(Clone, Debug)]
pub struct BedSurface {
    low: [f64; 2],
    size: [f64; 2],
    count: [usize; 2],
    floor: f64,
    top: Vec<f64>,
}

impl BedSurface {
    /// Creates columns of width `size` [m] over a box.
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

    /// Adds a grain with centre and radius [m] to its columns.
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

    /// Returns the mean surface height [m]; empty columns count as bottom.
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
    fn measures_layer_and_empty_floor() {
        let mut surface = BedSurface::new(&unit(), 0.1);
        assert_eq!(surface.height(), 0.0);
        for k in 0..400 {
            surface.add([0.05 * f64::from(k % 20) + 0.025, 0.05 * f64::from(k / 20) + 0.025, 0.4], 0.1);
        }
        assert!((surface.height() - 0.5).abs() < 0.02, "{}", surface.height());
    }

    /// A single grain on a wide floor is no bed.
    #[test]
    fn single_high_grain_is_ignored() {
        let mut surface = BedSurface::new(&unit(), 0.1);
        surface.add([0.5, 0.5, 0.9], 0.1);
        assert!(surface.height() > 0.0 && surface.height() < 0.1, "{}", surface.height());
        surface.add([5.0, 5.0, 0.9], 0.1);
        assert!(surface.height() < 0.1);
    }

    /// A bed below the box keeps its height.
    #[test]
    fn measures_bed_below_box() {
        let mut surface = BedSurface::new(&BoxRegion { low: Vec3::new(0.0, 0.0, 0.6), ..unit() }, 0.1);
        for k in 0..400 {
            surface.add([0.05 * f64::from(k % 20) + 0.025, 0.05 * f64::from(k / 20) + 0.025, 0.4], 0.1);
        }
        assert!((surface.height() - 0.5).abs() < 0.02, "{}", surface.height());
    }
}
