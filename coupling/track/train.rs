//! Axle layouts of trains and forces of uneven rails.

use std::f64::consts::TAU;

/// Car with two bogies of two axles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarLayout {
    /// Axle spacing of a bogie [m].
    pub wheelbase: f64,
    /// Bogie spacing [m].
    pub bogie_spacing: f64,
    /// Length over couplers [m].
    pub car_length: f64,
}

impl CarLayout {
    /// Axle distances of `cars` cars behind the first axle [m], ascending unless bogies overlap.
    pub fn axles(&self, cars: u32) -> Vec<f64> {
        let (base, bogies) = (self.wheelbase, self.bogie_spacing);
        let car = [0.0, base, bogies, bogies + base];
        (0..cars).flat_map(|c| car.map(|a| f64::from(c) * self.car_length + a)).collect()
    }
}

/// Axle distances of a universal train of high speed (HSLM-A) [m]: power car, end coach, `coaches` coaches on
/// shared bogies, end coach, power car. EN 1991-2:2003, figure 6.12.
pub fn universal(coaches: u32, coach: f64, wheelbase: f64) -> Vec<f64> {
    // Axles of the power car; its last to the first of the next car.
    const POWER: [f64; 4] = [0.0, 3.0, 14.0, 17.0];
    const GAP: f64 = 3.525;
    let begin = POWER[3] + GAP;
    let bogies = (0..coaches + 3).map(|k| begin + coach * f64::from(k));
    let end = begin + coach * f64::from(coaches + 2) + wheelbase + GAP;
    let mut axles = POWER.to_vec();
    axles.extend(bogies.flat_map(|x| [x, x + wheelbase]));
    axles.extend(POWER.map(|x| end + x));
    axles
}

/// Line load of `force` [N/m] as axles at the centres of equal parts of at most 0.25 m: position [m], force [N].
pub fn line_load(from: f64, to: f64, force: f64) -> impl Iterator<Item = [f64; 2]> {
    let parts = ((to - from) / 0.25).ceil().max(1.0);
    let step = (to - from) / parts;
    (0..parts as usize).map(move |k| [from + (k as f64 + 0.5) * step, force * step])
}

/// Force amplitude [N], M a w² with w = 2πv/L, and `length` [m] of a rail wave under an unsprung `mass` [kg].
/// `amplitude` [m], `speed` [m/s].
pub fn excitation(mass: f64, amplitude: f64, length: f64, speed: f64) -> [f64; 2] {
    let turn = TAU * speed / length;
    [mass * amplitude * turn * turn, length]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CRH2: 2.5 m wheelbase, bogies 17.5 m and cars 25 m apart.
    #[test]
    fn axles_of_two_cars() {
        let car = CarLayout { wheelbase: 2.5, bogie_spacing: 17.5, car_length: 25.0 };
        assert_eq!(car.axles(2), [0.0, 2.5, 17.5, 20.0, 25.0, 27.5, 42.5, 45.0]);
    }

    #[test]
    fn universal_train_is_symmetric() {
        let axles = universal(18, 18.0, 2.0);
        let length = axles[axles.len() - 1];
        assert_eq!(axles.len(), 50);
        assert!((length - 403.05).abs() < 1e-9, "{length}");
        for (a, b) in axles.iter().zip(axles.iter().rev()) {
            assert!((a + b - length).abs() < 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn uneven_rail_excites_unsprung_mass() {
        let [force, length] = excitation(750.0, 3.5e-3, 10.0, 200.0 / 3.6);
        assert!((force - 3198.5).abs() < 1.0 && length == 10.0, "{force}");
    }
}
