//! The cap from the time of a collision.
//!
//! In a collision of two bodies at ω dt = x, ω = √(K/m*), the leapfrog errs, over all moments at which the first touch may
//! fall in a step: restitution e = 0.5 comes out 0.4993 to 0.5027 at x = 0.2 and up to 0.51 at x = 0.3; without a dashpot the
//! kinetic energy grows by about 0.0063 x³ per collision, which nothing takes away again. So x ≤ 0.2 where the restitution is
//! well below 1, and less where the growth would be more than a hundredth of what the collision takes, 1 − e²; 0.08 at least.
//!
//! Theory manual: equation (3.8) of `docs/theory/motion.md`.

use super::input::ModelInput;
use super::timestep::contact_radius;
use crate::bodies::table::Bodies;
use crate::law::Laws;

/// ω dt of collisions that lose much, and of those that lose nothing.
const LARGEST: f64 = 0.2;
const SMALLEST: f64 = 0.08;

/// What the cap is multiplied by in a packing, where the restitution of single collisions matters less than stability.
pub(crate) const PACKED: f64 = 4.0;

/// Growth of the energy in a collision without a dashpot over (ω dt)³.
const HEATING: f64 = 0.0063;

/// ω dt of a collision that takes the share `loss` of its energy.
fn collision(loss: f64) -> f64 {
    libm::cbrt(0.01 * loss / HEATING).clamp(SMALLEST, LARGEST)
}

/// Longest step [s] that the collisions of the lightest bodies of each material allow; infinite where nothing can collide.
/// `expected`: overlap over the radius for laws whose stiffness grows; `largest`: radius of the largest sphere [m].
pub(crate) fn longest(
    bodies: &Bodies,
    input: &ModelInput,
    laws: &Laws,
    partners: &[usize],
    expected: f64,
    largest: f64,
) -> f64 {
    // Mass and radius of the lightest body that can move, by material.
    let mut lightest = vec![(f64::INFINITY, 0.0); input.materials.len()];
    for body in bodies.iter().filter(|b| b.inverse_mass > 0.0) {
        let least = &mut lightest[body.material as usize];
        if body.mass < least.0 {
            *least = (body.mass, contact_radius(&body, &input.shapes[body.shape], largest));
        }
    }
    let mut longest = f64::INFINITY;
    for (a, &(mass, radius)) in lightest.iter().enumerate().filter(|(_, l)| l.0.is_finite()) {
        for &b in partners {
            // Of a partner without bodies, a wall, the mass is infinite.
            let together = 1.0 / (1.0 / mass + 1.0 / lightest[b].0);
            let stiffness = laws.stiffness(a as u32, b as u32, expected * radius, radius);
            if stiffness.is_finite() && stiffness > 0.0 {
                let x = collision(laws.loss(a as u32, b as u32));
                longest = longest.min(x * (together / stiffness).sqrt());
            }
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undamped_collisions_need_many_steps() {
        assert_eq!(collision(0.0), SMALLEST);
        assert_eq!(collision(0.75), LARGEST);
        let between = collision(0.002);
        assert!(SMALLEST < between && between < LARGEST, "{between}");
    }
}
