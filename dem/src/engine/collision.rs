//! Time step bound from collision duration.
//!
//! Leapfrog errors at ω dt = x, ω = √(K/m*): restitution e = 0.5 becomes 0.4993 to 0.5027 at x = 0.2, up to
//! 0.51 at x = 0.3; without dashpot the kinetic energy grows by about 0.0063 x³ per collision.
//!
//! Theory manual: equation (3.8) of `docs/theory/motion.md`.

use super::input::ModelInput;
use super::timestep::contact_radius;
use crate::bodies::table::Bodies;
use crate::law::Laws;

/// ω dt of strongly dissipative and of elastic collisions.
const LARGEST: f64 = 0.2;
const SMALLEST: f64 = 0.08;

/// Relaxation in a packing, where stability matters more than restitution.
pub(crate) const PACKED: f64 = 4.0;

/// Energy growth of an undamped collision over (ω dt)³.
const HEATING: f64 = 0.0063;

/// ω dt for the energy loss fraction `loss`.
fn collision(loss: f64) -> f64 {
    libm::cbrt(0.01 * loss / HEATING).clamp(SMALLEST, LARGEST)
}

/// Longest step [s] for collisions of the lightest bodies of each material; infinite without collisions.
/// `expected`: overlap over radius; `largest`: sphere radius [m].
pub(crate) fn longest(
    bodies: &Bodies,
    input: &ModelInput,
    laws: &Laws,
    partners: &[usize],
    expected: f64,
    largest: f64,
) -> f64 {
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
            // Walls have infinite mass.
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
