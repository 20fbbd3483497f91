//! Predictor of the stiffened scheme: contacts of the last sub-step, linearised over the next window.
//!
//! Theory manual: eq. (5.8). Grains keep their velocity, sliding contacts count as sticking, tensile
//! contacts are omitted.

use super::model::Model;
use crate::face::dot;
use crate::interface_stability::{PointMatrices, PointMatrix, distribute};
use crate::surface::SolidSurface;
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::theta::ThetaMethod;

/// Contact of the last sub-step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct LinearisedContact {
    body: u32,
    sphere: u32,
    patch: u32,
    local: [f64; 2],
    force: [f64; 3],
}

impl LinearisedContact {
    pub fn body(&self) -> usize {
        self.body as usize
    }
}

impl From<&SurfaceContact> for LinearisedContact {
    fn from(c: &SurfaceContact) -> LinearisedContact {
        LinearisedContact { body: c.body, sphere: c.sphere, patch: c.patch, local: c.local, force: c.force }
    }
}

impl PointMatrix {
    /// Linearised contact and its force on the solid; `None` if open or tensile.
    fn of(
        model: &Model<'_>,
        grains: &dem::State,
        surface: &SolidSurface,
        c: &LinearisedContact,
    ) -> Option<(PointMatrix, [f64; 3])> {
        let body = c.body as usize;
        let (material, own) = (model.grains.material(body), model.grains.patch_material(c.patch));
        // Current surface, not the end of the last window.
        let &(centre, radius) = grains.spheres(&model.grains, body).get(c.sphere as usize)?;
        let near = surface.closest_point(c.patch, centre.into(), c.local);
        let offset = centre - dem::Vec3::from(near.point);
        let overlap = radius - offset.norm();
        if overlap <= 0.0 || offset.dot(&dem::Vec3::from(near.normal)) <= 0.0 {
            return None;
        }
        let normal: [f64; 3] = (offset / offset.norm()).into();
        let (spring, stiffness) = model.grains.contact_spring(material, own, overlap, radius);
        let tangential = stiffness * model.grains.tangential_ratio(material, own);
        let (_, ratio) = model.grains.contact_stiffness(material, own);
        let dashpot = 2.0 * ratio * (model.grains.mass(body) * stiffness).sqrt();
        let arm = dem::Vec3::from(near.point) - grains.position(body);
        let stone = grains.velocity(body) + grains.spin(body).cross(&arm);
        let slip = [0, 1, 2].map(|d| near.velocity[d] - stone[d]);
        let closing = dot(slip, normal);
        let half = 0.5 * model.window();
        let pressure = spring + (half * stiffness + dashpot) * closing;
        if pressure <= 0.0 {
            return None;
        }
        let pressed = dot(c.force, normal);
        let force = [0, 1, 2].map(|d| {
            let held = c.force[d] - pressed * normal[d];
            let across = slip[d] - closing * normal[d];
            held - half * tangential * across - pressure * normal[d]
        });
        let (shape, nodes) = (surface.shape_functions(c.patch, near.local), surface.padded_nodes(c.patch));
        let (along, across) = (half * stiffness + dashpot, half * tangential);
        Some((PointMatrix { nodes, shape, normal, along, across }, force))
    }
}

#[derive(Default)]
pub(crate) struct Stiffened {
    contacts: PointMatrices,
    field: Vec<[f64; 3]>,
}

impl Stiffened {
    /// Computes the mean nodal velocity of the next window [m/s] in `rate`, shape `[3·nodes]`. Adds predicted
    /// contact forces to `load`, which holds all others. Returns the solver iterations.
    pub fn predict(
        &mut self,
        model: &Model<'_>,
        grains: &dem::State,
        held: &[LinearisedContact],
        surface: &SolidSurface,
        solver: &mut dyn ThetaMethod,
        solid: &fem::state::State,
        load: &mut [f64],
        rate: &mut [f64],
    ) -> Result<u32, SolveError> {
        let Stiffened { contacts, field } = self;
        contacts.points.clear();
        field.clear();
        field.resize(surface.nodes().len(), [0.0; 3]);
        for c in held {
            let Some((spring, force)) = PointMatrix::of(model, grains, surface, c) else { continue };
            for (&n, s) in spring.nodes.iter().zip(spring.shape) {
                (0..3).for_each(|d| field[n as usize][d] += s * force[d]);
            }
            contacts.points.push(spring);
        }
        let nodes = surface.nodes();
        distribute(surface, field, |n, f| {
            (0..3).for_each(|d| load[3 * nodes[n as usize] as usize + d] += f[d]);
        });
        let mut product = |w: &[f64], out: &mut [f64]| {
            let velocity = |k: usize| [0, 1, 2].map(|d| w[3 * nodes[k] as usize + d]);
            contacts.times(surface, velocity, |n, f| {
                (0..3).for_each(|d| out[3 * nodes[n as usize] as usize + d] += f[d]);
            });
        };
        solver.solve_with_contact_stiffness(model.solid, solid, load, &mut product, rate)
    }
}
