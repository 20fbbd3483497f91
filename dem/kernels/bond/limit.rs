//! Contribution of bonds to the time step limit.
//!
//! ω² ≤ max λ(M⁻¹ K), K = 2 Σ k g gᵀ (Gershgorin's bound by blocks: one body on springs of twice the
//! stiffness). Dashpots likewise; stable for λ dt² + 2 γ dt < 4.

use super::Constants;
use super::kernel;
use crate::base::Vec3;
use crate::bodies::input::BodyInput;
use crate::bodies::table::Bodies;
use nalgebra::{Matrix6, Vector6};

/// λ [1/s²] and γ [1/s] of each body. Shape `[bodies]`.
pub fn stiffest(bonds: &[Constants], bodies: &Bodies, places: &[BodyInput]) -> Vec<[f64; 2]> {
    let mut sums = vec![[Matrix6::<f64>::zeros(); 2]; if bonds.is_empty() { 0 } else { bodies.len() }];
    for bond in bonds {
        let [a, b] = bond.ends.map(|e| e as usize);
        let k = &bond.values;
        let n = (places[a].position - places[b].position).normalize();
        let helper = if n.x.abs() < 0.7 { Vec3::x() } else { Vec3::y() };
        let t = n.cross(&helper).normalize();
        let u = n.cross(&t);
        for (body, sign) in [(a, 1.0), (b, -1.0)] {
            let constants = bodies.get(body);
            let (m, i) = (constants.mass.sqrt(), constants.inertia.min().sqrt());
            let arm = 0.5 * (k[kernel::LENGTH] + sign * k[kernel::OFFSET]);
            let mode = |translation: Vec3, rotation: Vec3| {
                let (x, w) = (translation / m, rotation / i);
                Vector6::new(x.x, x.y, x.z, w.x, w.y, w.z)
            };
            // Slip of a body rotating about t: ∓arm t × n.
            let modes = [
                (0, mode(n, Vec3::zeros())),
                (1, mode(t, n.cross(&t) * (-sign * arm))),
                (1, mode(u, n.cross(&u) * (-sign * arm))),
                (2, mode(Vec3::zeros(), t)),
                (2, mode(Vec3::zeros(), u)),
                (3, mode(Vec3::zeros(), n)),
            ];
            for (spring, g) in modes {
                sums[body][0] += g * g.transpose() * (2.0 * k[kernel::STIFFNESS + spring]);
                sums[body][1] += g * g.transpose() * (2.0 * k[kernel::DAMPING + spring]);
            }
        }
    }
    sums.iter().map(|pair| pair.map(|m| m.symmetric_eigenvalues().max())).collect()
}
