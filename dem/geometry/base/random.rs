//! Random number stream of the generators.
//!
//! PCG XSL-RR 128/64 (M. E. O'Neill, HMC-CS-2014-0905, 2014).

use nalgebra::{Quaternion, UnitQuaternion};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Random stream; different purposes of one seed are independent.
pub struct Random(Pcg64);

impl Random {
    /// Creates the stream of `seed` and `purpose`.
    pub fn new(seed: u64, purpose: u64) -> Random {
        // An odd multiplier separates (seed, purpose) pairs.
        Random(Pcg64::seed_from_u64(seed ^ purpose.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Random permutation of 0..n (Fisher–Yates).
    pub fn permutation(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            let j = (self.uniform() * (i + 1) as f64) as usize;
            order.swap(i, j);
        }
        order
    }

    /// Uniform random orientation (K. Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
    pub fn orientation(&mut self) -> UnitQuaternion<f64> {
        let (u, a, b) = (self.uniform(), TAU * self.uniform(), TAU * self.uniform());
        let (s, c) = ((1.0 - u).sqrt(), u.sqrt());
        UnitQuaternion::from_quaternion(Quaternion::new(
            c * libm::cos(b),
            s * libm::sin(a),
            s * libm::cos(a),
            c * libm::sin(b),
        ))
    }
}
