//! Materials, meshes and options of the elastoplastic cases.

use crate::common::model;
use trackbed_fem::nonlinear::{NewtonOptions, Variant};
use trackbed_fem::{
    Cone, Constraint, DruckerPrager, Elastic, Material, Mesh, Model, MohrCoulomb, Quadrature,
};

/// Angles [°].
pub fn mohr_coulomb(elastic: Elastic, c: f64, phi: f64, psi: f64) -> Material {
    Material::plastic(
        elastic,
        MohrCoulomb {
            cohesion: c.into(),
            friction: phi.to_radians().into(),
            dilation: psi.to_radians(),
            tension: None,
        },
    )
}

/// Angles [°].
pub fn drucker_prager(elastic: Elastic, c: f64, phi: f64, psi: f64, cone: Cone) -> Material {
    Material::plastic(
        elastic,
        DruckerPrager {
            cohesion: c.into(),
            friction: phi.to_radians().into(),
            dilation: psi.to_radians(),
            cone,
            tension: None,
        },
    )
}

pub fn tight() -> NewtonOptions {
    NewtonOptions { force_tolerance: 1e-10, energy_tolerance: 1e-12, ..NewtonOptions::new(Variant::Full) }
}

/// One element thick in y, with the given element boundaries.
pub fn slab(x: &[f64], z: &[f64], thickness: f64) -> Mesh {
    let (nx, nz) = (x.len() - 1, z.len() - 1);
    let mut mesh = Mesh::block([nx, 1, nz], [nx as f64, thickness, nz as f64]);
    let at = |lines: &[f64], s: f64| {
        let i = (s.floor() as usize).min(lines.len() - 2);
        lines[i] + (s - i as f64) * (lines[i + 1] - lines[i])
    };
    for c in &mut mesh.coordinates {
        *c = [at(x, c[0]), c[1], at(z, c[2])];
    }
    mesh
}

/// Grid lines from `from` to `to`, growth `ratio`.
pub fn graded(from: f64, to: f64, count: usize, ratio: f64) -> Vec<f64> {
    let weight =
        |i: usize| if ratio == 1.0 { i as f64 } else { (ratio.powi(i as i32) - 1.0) / (ratio - 1.0) };
    (0..=count).map(|i| from + (to - from) * weight(i) / weight(count)).collect()
}

/// Half of a rough strip footing, width 2 m, on a weightless slab.
pub struct Footing {
    pub model: Model,
    /// Vertical dofs under the footing, among the constrained ones.
    pub pushed: Vec<bool>,
}

pub fn footing(material: Material, [under, beside, down]: [usize; 3]) -> Footing {
    let mut x = graded(0.0, 1.0, under, 0.75);
    x.extend(&graded(1.0, 6.0, beside, 1.35)[1..]);
    let mut z = graded(0.0, -5.0, down, 1.3);
    z.reverse();
    let mesh = slab(&x, &z, 0.5);
    let mut constraints = Vec::new();
    for (n, c) in mesh.coordinates.iter().enumerate() {
        let mut hold = |directions: &[u8]| {
            constraints.extend(directions.iter().map(|&direction| Constraint {
                node: n as u32,
                direction,
                value: 0.0,
            }));
        };
        hold(&[1]);
        if c[2] == -5.0 || (c[2] == 0.0 && c[0] <= 1.0) {
            hold(&[0, 2]);
        } else if c[0] == 0.0 || c[0] == 6.0 {
            hold(&[0]);
        }
    }
    let model = model(mesh, constraints, material, Quadrature::Gauss2);
    let under = |dof: u32| {
        let c = model.mesh().coordinates[dof as usize / 3];
        dof % 3 == 2 && c[2] == 0.0 && c[0] <= 1.0
    };
    let pushed = model.supports().fixed().iter().map(|(dof, _)| under(*dof)).collect();
    Footing { model, pushed }
}

impl Footing {
    /// Mean pressure [Pa].
    pub fn pressure(&self, reactions: &[f64]) -> f64 {
        let pushed = self.model.supports().fixed().iter().zip(&self.pushed).filter(|(_, pushed)| **pushed);
        -pushed.map(|((dof, _), _)| reactions[*dof as usize]).sum::<f64>() / 0.5
    }

    /// Time is the settlement [m].
    pub fn loading(&self) -> impl trackbed_fem::nonlinear::Loading + '_ {
        trackbed_fem::nonlinear::LoadFunctions {
            load: |_: f64, _: &mut [f64]| (),
            prescribed: |time: f64, values: &mut [f64]| {
                values.iter_mut().zip(&self.pushed).filter(|(_, p)| **p).for_each(|(v, _)| *v = -time);
            },
        }
    }
}

/// CPU time of this thread [s].
pub fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok()).map_or(f64::NAN, |ns| 1e-9 * ns)
}
