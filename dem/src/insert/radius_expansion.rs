//! Radius expansion: small grains at random positions grow to full size.
//!
//! Each round scales all lengths by one step from `start` to 1, then relaxes without gravity, with local
//! damping (Cundall & Strack 1979).
//!
//! Limits: frictionless equal spheres jam near n = 0.36, bidisperse ones lower.
//!
//! Theory manual: equation (3.13) of `docs/theory/motion.md`.

use super::container::Container;
use crate::base::error::{ModelError, StepError};
use crate::measure::{contacts, unbalanced_ratio};
use crate::spatial::surface::NoSurface;
use crate::{
    BodyInput, LocalDamping, Material, Model, ModelInput, Plane, Shape, State, TimeStep, TriangleSurface,
    Vec3, Work, step,
};
use std::f64::consts::PI;

/// Strips around a cone.
const STRIPS: usize = 96;
/// Steps between two convergence checks.
const STRIDE: u64 = 25;
/// Overlap over radius that counts as no contact.
const APART: f64 = 1e-3;

/// Parameters of radius expansion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Initial length fraction, in (0, 1].
    pub start: f64,
    /// Rounds, at least 1.
    pub rounds: usize,
    /// Friction during expansion; more friction gives looser packing.
    pub friction: f64,
    /// Final unbalanced-force ratio; earlier rounds use 100 times it, at most 0.1.
    pub unbalanced: f64,
    /// Most steps of the last relaxation; earlier rounds use a tenth.
    pub steps: u64,
}

impl Default for Growth {
    /// Half size, 20 rounds, frictionless, ratio 1e-3 within 20,000 steps.
    fn default() -> Growth {
        Growth { start: 0.5, rounds: 20, friction: 0.0, unbalanced: 1e-3, steps: 20_000 }
    }
}

/// Result of radius expansion.
#[derive(Clone, Debug)]
pub struct Grown {
    /// Full-size grains at rest, in input order.
    pub bodies: Vec<BodyInput>,
    /// Total steps.
    pub steps: u64,
    /// Porosity, overlaps counted once [-].
    pub porosity: f64,
    /// Final unbalanced-force ratio; 0 without contacts.
    pub unbalanced: f64,
    /// Largest overlap over reduced radius [-].
    pub overlap: f64,
}

/// Failed radius expansion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GrowError {
    /// Invalid model.
    #[error("radius expansion: {0}")]
    Model(#[from] ModelError),
    /// Failed step: too many grains or too few rounds.
    #[error("radius expansion, round {round}: {source} Increase `rounds` or the porosity.")]
    Step {
        /// Round, from 1.
        round: usize,
        /// Cause.
        source: StepError,
    },
    /// Grain outside the container.
    #[error("grain {0} left the container during radius expansion. Increase `rounds` or the porosity.")]
    Escaped(usize),
}

/// Expands `bodies` (full size, at initial positions) in a container; `material` also for the sides.
///
/// # Errors
/// [`GrowError`] for an invalid model, a failed step or an expelled grain.
pub fn grow(
    container: &Container,
    shapes: &[Shape],
    bodies: &[BodyInput],
    material: Material,
    how: &Growth,
) -> Result<Grown, GrowError> {
    let (planes, triangles) = sides(container);
    let rounds = how.rounds.max(1);
    let mut current = bodies.to_vec();
    let mut grown = Grown { bodies: Vec::new(), steps: 0, porosity: 0.0, unbalanced: 0.0, overlap: 0.0 };
    for round in 1..=rounds {
        let factor = how.start + (1.0 - how.start) * round as f64 / rounds as f64;
        let small = current.iter().zip(bodies).map(|(now, full)| BodyInput {
            material: 0,
            scale: full.scale * factor,
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            ..now.clone()
        });
        let model = Model::new(ModelInput {
            materials: vec![springs(&material, how.friction)],
            shapes: shapes.to_vec(),
            bodies: small.collect(),
            planes: planes.clone(),
            triangles: triangles.clone(),
            gravity: Vec3::zeros(),
            time_step: TimeStep::Auto { fraction: 0.8 },
            damping: Some(LocalDamping { factor: 0.7 }),
            ..ModelInput::default()
        })?;
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        let last = round == rounds;
        let (ratio, most) = if last {
            (how.unbalanced, how.steps)
        } else {
            ((100.0 * how.unbalanced).min(0.1), how.steps / 10)
        };
        while state.steps < most.max(STRIDE) {
            for _ in 0..STRIDE {
                step(&model, &mut state, &mut work, &NoSurface, &[])
                    .map_err(|source| GrowError::Step { round, source })?;
            }
            let found = contacts(&model, &state);
            grown.overlap = found.iter().map(|c| c.overlap / c.radius).fold(0.0, f64::max);
            grown.unbalanced =
                if grown.overlap > 0.0 { unbalanced_ratio(&model, &state, &found) } else { 0.0 };
            if grown.overlap < APART || grown.unbalanced < ratio {
                break;
            }
        }
        grown.steps += state.steps;
        for (b, (now, full)) in current.iter_mut().zip(bodies).enumerate() {
            *now = BodyInput {
                position: state.position(b),
                orientation: state.orientation(&model, b),
                ..full.clone()
            };
            if !container.holds(&now.position, 0.0) {
                return Err(GrowError::Escaped(b));
            }
        }
        if last {
            let solid: f64 = (0..model.body_count()).map(|b| model.volume(b)).sum();
            let shared: f64 =
                contacts(&model, &state).iter().map(|c| PI * c.overlap * c.overlap * c.radius).sum();
            grown.porosity = 1.0 - (solid - shared) / container.volume();
        }
    }
    grown.bodies = current;
    Ok(grown)
}

/// Linear springs: initial overlaps are deep, and stiffness does not affect the rest position.
fn springs(material: &Material, friction: f64) -> Material {
    let one = material.with_friction(friction);
    match material.young {
        // Modulus times 1 cm.
        Some(young) => Material {
            stiffness: 0.01 * young,
            young: None,
            corner_strength: f64::INFINITY,
            normal: None,
            ..one
        },
        None => one,
    }
}

fn sides(container: &Container) -> (Vec<Plane>, Vec<TriangleSurface>) {
    let plane =
        |point: &Vec3, normal: Vec3| Plane { point: *point, normal, material: 0, velocity: Vec3::zeros() };
    match container {
        Container::Box { low, high } => {
            let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
            (axes.iter().flat_map(|n| [plane(low, *n), plane(high, -n)]).collect(), Vec::new())
        }
        Container::Cone { from, to, from_radius, to_radius } => {
            let axis = (to - from).normalize();
            let helper = if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
            let u = axis.cross(&helper).normalize();
            let v = axis.cross(&u);
            // Strips circumscribe the cone.
            let reach = 1.0 / libm::cos(PI / STRIPS as f64);
            let ring = |end: &Vec3, radius: f64| {
                let at = move |k: usize| {
                    let a = 2.0 * PI * k as f64 / STRIPS as f64;
                    (u * libm::cos(a) + v * libm::sin(a)) * (radius * reach)
                };
                (0..STRIPS).map(|k| end + at(k)).collect::<Vec<_>>()
            };
            let mut vertices = ring(from, *from_radius);
            vertices.extend(ring(to, *to_radius));
            let n = STRIPS as u32;
            let triangles = (0..n)
                .flat_map(|k| {
                    let l = (k + 1) % n;
                    [[k, l, n + l], [k, n + l, n + k]]
                })
                .filter(|t| {
                    let [a, b, c] = t.map(|v| vertices[v as usize]);
                    (b - a).cross(&(c - a)).norm() > 1e-12 * (to - from).norm_squared()
                })
                .collect();
            let surface = TriangleSurface { vertices, triangles, material: 0, velocity: Vec3::zeros() };
            (vec![plane(from, axis), plane(to, -axis)], vec![surface])
        }
        Container::Surface(surface) => {
            let (vertices, triangles) = (surface.vertices().to_vec(), surface.triangles().to_vec());
            (Vec::new(), vec![TriangleSurface { vertices, triangles, material: 0, velocity: Vec3::zeros() }])
        }
    }
}

#[cfg(test)]
#[path = "radius_expansion_tests.rs"]
mod tests;
