//! Isotropic linear elasticity (Hooke).
//!
//! `sigma = lambda tr(eps) 1 + 2 mu eps`. Source: Timoshenko and Goodier, Theory of Elasticity (1970),
//! section 6. Limits: nu in (-1, 0.5); near 0.5 use the reduced rule against locking.

use serde::{Deserialize, Serialize};

/// Invalid constant: name, value, expectation.
pub type InvalidConstant = (&'static str, f64, &'static str);

/// Isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Elastic {
    /// Young's modulus E [Pa], above 0.
    pub young: f64,
    /// Poisson's ratio nu [-], in (-1, 0.5).
    pub poisson: f64,
    /// Density [kg/m³]; 0 allowed in statics.
    pub density: f64,
}

impl Elastic {
    /// Lamé constants lambda and mu [Pa].
    pub fn lame(&self) -> (f64, f64) {
        let (e, nu) = (self.young, self.poisson);
        (e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
    }

    /// Stress [Pa] of a strain (engineering shear).
    pub fn stress(&self, strain: &[f64; 6]) -> [f64; 6] {
        let (lambda, mu) = self.lame();
        let mean = lambda * (strain[0] + strain[1] + strain[2]);
        [
            mean + 2.0 * mu * strain[0],
            mean + 2.0 * mu * strain[1],
            mean + 2.0 * mu * strain[2],
            mu * strain[3],
            mu * strain[4],
            mu * strain[5],
        ]
    }

    /// Elastic matrix D [Pa], engineering shear.
    pub fn matrix(&self) -> [[f64; 6]; 6] {
        let (lambda, mu) = self.lame();
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..3 {
            for j in 0..3 {
                matrix[i][j] = lambda;
            }
            matrix[i][i] += 2.0 * mu;
            matrix[3 + i][3 + i] = mu;
        }
        matrix
    }

    /// Elastic energy `s : D^-1 s / 2` [J/m³].
    pub fn stored_energy(&self, s: &[f64; 6]) -> f64 {
        let trace = s[0] + s[1] + s[2];
        let square =
            s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
        0.5 * ((1.0 + self.poisson) * square - self.poisson * trace * trace) / self.young
    }

    /// Compression wave speed, `sqrt((lambda + 2 mu) / rho)` [m/s].
    pub fn compression_wave_speed(&self) -> f64 {
        let (lambda, mu) = self.lame();
        ((lambda + 2.0 * mu) / self.density).sqrt()
    }

    /// First invalid constant.
    pub fn invalid_constant(&self) -> Option<InvalidConstant> {
        if !(self.young > 0.0 && self.young.is_finite()) {
            return Some(("Young's modulus", self.young, "a finite number above 0"));
        }
        if !(self.poisson > -1.0 && self.poisson < 0.5) {
            return Some(("Poisson's ratio", self.poisson, "a number between -1 and 0.5 (both excluded)"));
        }
        if !(self.density >= 0.0 && self.density.is_finite()) {
            return Some(("density", self.density, "a finite number, 0 or above"));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniaxial_stress_recovers_constants() {
        let steel = Elastic { young: 210e9, poisson: 0.3, density: 7850.0 };
        let s = steel.stress(&[1e-3, -0.3e-3, -0.3e-3, 2e-4, 0.0, -1e-4]);
        assert!((s[0] - 210e6).abs() < 1e-3 && s[1].abs() < 1e-3 && s[2].abs() < 1e-3);
        assert!((s[3] - 210e9 / 2.6 * 2e-4).abs() < 1e-3 && s[4] == 0.0 && s[5] < 0.0);
    }

    #[test]
    fn the_matrix_gives_the_stress() {
        let steel = Elastic { young: 210e9, poisson: 0.3, density: 7850.0 };
        let e = [1e-3, -0.3e-3, 2e-3, 2e-4, 5e-4, -1e-4];
        let (matrix, s) = (steel.matrix(), steel.stress(&e));
        for i in 0..6 {
            let product: f64 = (0..6).map(|j| matrix[i][j] * e[j]).sum();
            assert!((product - s[i]).abs() < 1e-12 * s[0].abs());
        }
    }

    #[test]
    fn unusable_constants_are_named() {
        let good = Elastic { young: 1e7, poisson: 0.3, density: 2000.0 };
        assert!(good.invalid_constant().is_none());
        assert_eq!(Elastic { young: 0.0, ..good }.invalid_constant().unwrap().0, "Young's modulus");
        assert_eq!(Elastic { poisson: 0.5, ..good }.invalid_constant().unwrap().0, "Poisson's ratio");
        assert_eq!(Elastic { density: f64::NAN, ..good }.invalid_constant().unwrap().0, "density");
    }
}
