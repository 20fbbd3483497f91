//! Stability numbers of the assembled interface: all current contacts, taken as sticking.
//!
//! Theory manual: eq. (5.11). λmax by the locally optimal gradient method (Knyazev, SIAM J. Sci. Comput. 23
//! (2001) 517). With the predicted scheme, random linear systems (`docs/interface.py`) are stable for W ≤ 1,
//! D ≤ 1, Ω² ≤ 24 (θ − ½).

use crate::face::dot;
use crate::surface::SolidSurface;
use nalgebra::{Matrix3, Matrix6, Vector6};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_dem::surface::SurfaceContact;
use trackbed_fem as fem;
use trackbed_fem::surface_mass::SurfaceMass;

/// Damping ratio of undamped contact springs.
pub const UNDAMPED: f64 = 0.02;

/// Maximum iterations and relative change at convergence.
const ITERATIONS: usize = 80;
const CONVERGED: f64 = 1e-3;
/// Safety factor: eigenvalues converge from below.
const MARGIN: f64 = 1.02;

/// Stability numbers of the interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InterfaceStabilityNumbers {
    /// W = Δt √λmax(M⁻¹ B_K) [-].
    pub stiffness: f64,
    /// D = Δt λmax(M⁻¹ B_C) [-].
    pub damping: f64,
    /// Ω = Δt ω of bodies on undamped contacts [-].
    pub phase: f64,
}

impl InterfaceStabilityNumbers {
    /// Scales the numbers for 1 s to windows of `window` [s].
    pub fn at(&self, window: f64) -> InterfaceStabilityNumbers {
        InterfaceStabilityNumbers {
            stiffness: window * self.stiffness,
            damping: window * self.damping,
            phase: window * self.phase,
        }
    }

    /// Componentwise maximum.
    pub fn max(&self, other: &InterfaceStabilityNumbers) -> InterfaceStabilityNumbers {
        InterfaceStabilityNumbers {
            stiffness: self.stiffness.max(other.stiffness),
            damping: self.damping.max(other.damping),
            phase: self.phase.max(other.phase),
        }
    }
}

/// Matrix against the surface velocity.
pub(crate) struct PointMatrix {
    /// Shape functions are zero beyond the nodes of the face.
    pub nodes: [u32; 8],
    pub shape: [f64; 8],
    pub normal: [f64; 3],
    pub along: f64,
    pub across: f64,
}

#[derive(Default)]
pub(crate) struct PointMatrices {
    pub points: Vec<PointMatrix>,
    field: Vec<[f64; 3]>,
    mean: Vec<[f64; 3]>,
}

impl PointMatrices {
    /// Product with nodal velocities: calls `add` with surface node and force.
    pub fn times(
        &mut self,
        surface: &SolidSurface,
        velocity: impl Fn(usize) -> [f64; 3],
        add: impl FnMut(u32, [f64; 3]),
    ) {
        let PointMatrices { points, field, mean } = self;
        let nodes = surface.nodes().len();
        field.clear();
        field.extend((0..nodes).map(velocity));
        mean.resize(nodes, [0.0; 3]);
        match surface.spread() {
            None => mean.copy_from_slice(field),
            Some(s) => s.mean(field, mean),
        }
        field.fill([0.0; 3]);
        for p in points.iter() {
            let mut v = [0.0; 3];
            for (&n, share) in p.nodes.iter().zip(p.shape) {
                (0..3).for_each(|d| v[d] += share * mean[n as usize][d]);
            }
            let closing = dot(v, p.normal);
            let force = [0, 1, 2].map(|d| p.across * v[d] + (p.along - p.across) * closing * p.normal[d]);
            for (&n, share) in p.nodes.iter().zip(p.shape) {
                (0..3).for_each(|d| field[n as usize][d] += share * force[d]);
            }
        }
        distribute(surface, field, add);
    }
}

/// Load transfer: calls `add` with surface node and force.
pub(crate) fn distribute(surface: &SolidSurface, forces: &[[f64; 3]], mut add: impl FnMut(u32, [f64; 3])) {
    match surface.spread() {
        None => forces.iter().zip(0..).filter(|(f, _)| **f != [0.0; 3]).for_each(|(f, n)| add(n, *f)),
        Some(s) => s.distribute(forces, add),
    }
}

/// Surface contact: springs and dashpots along and across the normal [N/m, N s/m].
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Face.
    pub patch: u32,
    /// Natural coordinates.
    pub local: [f64; 2],
    /// Springs.
    pub stiffness: [f64; 2],
    /// Dashpots.
    pub damping: [f64; 2],
}

/// Assembled interface.
pub struct InterfaceStability {
    mass: SurfaceMass,
    inverse: Vec<[f64; 3]>,
    /// Mass row of each surface node.
    rows: Vec<u32>,
    matrices: PointMatrices,
}

impl InterfaceStability {
    /// Assembles the surface mass.
    pub fn new(solid: &fem::Model, surface: &SolidSurface) -> InterfaceStability {
        let mass = SurfaceMass::new(solid, surface.faces().iter().map(|f| f.element));
        let rows =
            surface.nodes().iter().map(|&n| mass.row(n).expect("nodes of its elements") as u32).collect();
        let inverse = mass.inverse_diagonal();
        InterfaceStability { mass, inverse, rows, matrices: PointMatrices::default() }
    }

    /// Returns the numbers for windows of 1 s; contacts with meshed sleepers are omitted.
    pub fn numbers(
        &mut self,
        model: &dem::Model,
        grains: &dem::State,
        surface: &SolidSurface,
        contacts: &[SurfaceContact],
    ) -> InterfaceStabilityNumbers {
        let own = || contacts.iter().filter(|c| !model.on_other_surface(c.patch));
        let points: Vec<SurfacePoint> = own().map(|c| point(model, grains, c)).collect();
        let [stiffness, damping] = self.of_points(surface, &points);
        let phase = phase(model, grains, surface, own().zip(&points));
        InterfaceStabilityNumbers { stiffness, damping, phase }
    }

    /// Returns W and D of `points` for windows of 1 s.
    pub fn of_points(&mut self, surface: &SolidSurface, points: &[SurfacePoint]) -> [f64; 2] {
        let mut largest = |values: fn(&SurfacePoint) -> [f64; 2]| {
            self.matrices.points.clear();
            self.matrices.points.extend(points.iter().filter(|p| values(p) != [0.0; 2]).map(|p| {
                let [along, across] = values(p);
                PointMatrix {
                    nodes: surface.padded_nodes(p.patch),
                    shape: surface.shape_functions(p.patch, p.local),
                    normal: surface.normal(p.patch, p.local),
                    along,
                    across,
                }
            }));
            self.largest(surface)
        };
        [largest(|p| p.stiffness).sqrt(), largest(|p| p.damping)]
    }

    fn largest(&mut self, surface: &SolidSurface) -> f64 {
        if self.matrices.points.is_empty() {
            return 0.0;
        }
        let InterfaceStability { mass, inverse, rows, matrices } = self;
        let n = mass.len();
        let mut product = |x: &[[f64; 3]], y: &mut [[f64; 3]]| {
            y.fill([0.0; 3]);
            let at = |k: usize| x[rows[k] as usize];
            matrices.times(surface, at, |k, f| (0..3).for_each(|d| y[rows[k as usize] as usize][d] += f[d]));
            y.iter_mut()
                .zip(inverse.iter())
                .for_each(|(y, i)| (0..3).for_each(|d| y[d] *= f64::from(i[d] > 0.0)));
        };
        let zero = || vec![[0.0; 3]; n];
        let mut basis: [[Vec<[f64; 3]>; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| zero()));
        let first = pseudo_random(n);
        product(&first, &mut basis[0][1]);
        for k in 0..n {
            basis[0][0][k] = [0, 1, 2].map(|d| inverse[k][d] * basis[0][1][k][d]);
        }
        let mut value = 0.0;
        for iteration in 0..ITERATIONS {
            let used = iteration.min(2) + 1;
            if iteration > 0 {
                for k in 0..n {
                    let [x, w] = basis.get_disjoint_mut([0, 1]).expect("two of three");
                    w[0][k] = [0, 1, 2].map(|d| inverse[k][d] * (x[1][k][d] - value * x[2][k][d]));
                }
            }
            let newest = usize::from(iteration > 0);
            let [v, bv, mv] = &mut basis[newest];
            product(v, bv);
            mass.times(v, mv);
            let Some((found, shares)) = best(&basis[..used]) else { break };
            let grown = found - value;
            value = found;
            advance(&mut basis, used, shares);
            if iteration > 3 && grown <= CONVERGED * value {
                break;
            }
        }
        MARGIN * value
    }
}

/// Rayleigh quotient and coefficients of the best combination; `None` for dependent bases.
fn best(basis: &[[Vec<[f64; 3]>; 3]]) -> Option<(f64, [f64; 3])> {
    let product = |a: &[[f64; 3]], b: &[[f64; 3]]| a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum::<f64>();
    let size = basis.iter().map(|b| product(&b[0], &b[2]).sqrt()).collect::<Vec<_>>();
    let count = (0..basis.len()).take_while(|&k| size[k] > 0.0).count();
    for used in (1..=count).rev() {
        let gram = |which: usize| {
            Matrix3::from_fn(|i, j| match i < used && j < used {
                true => {
                    let symmetric =
                        product(&basis[i][0], &basis[j][which]) + product(&basis[j][0], &basis[i][which]);
                    0.5 * symmetric / (size[i] * size[j])
                }
                false => f64::from(i == j && which == 2),
            })
        };
        let Some(root) = gram(2).cholesky() else { continue };
        let inverse = root.l().try_inverse()?;
        if inverse.norm() > 1e6 {
            continue;
        }
        let eigen = (inverse * gram(1) * inverse.transpose()).symmetric_eigen();
        let top = eigen.eigenvalues.imax();
        let shares = inverse.transpose() * eigen.eigenvectors.column(top);
        let shares = [0, 1, 2].map(|k| if k < used { shares[k] / size[k] } else { 0.0 });
        return Some((eigen.eigenvalues[top], shares));
    }
    None
}

fn advance(basis: &mut [[Vec<[f64; 3]>; 3]; 3], used: usize, shares: [f64; 3]) {
    let [x, w, p] = basis;
    for which in 0..3 {
        for k in 0..x[which].len() {
            for d in 0..3 {
                let step = if used > 1 { shares[1] * w[which][k][d] } else { 0.0 }
                    + if used > 2 { shares[2] * p[which][k][d] } else { 0.0 };
                p[which][k][d] = step;
                x[which][k][d] = shares[0] * x[which][k][d] + step;
            }
        }
    }
}

/// Reproducible start.
fn pseudo_random(n: usize) -> Vec<[f64; 3]> {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        // Xorshift (Marsaglia, Journal of Statistical Software 8, 2003).
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..n).map(|_| [next(), next(), next()]).collect()
}

fn point(model: &dem::Model, grains: &dem::State, c: &SurfaceContact) -> SurfacePoint {
    let body = c.body as usize;
    let sphere = grains.spheres(model, body).get(c.sphere as usize).map(|s| s.1);
    let radius = sphere.unwrap_or_else(|| model.radius(body));
    let (a, b) = (model.material(body), model.patch_material(c.patch));
    let law = model.linearised(a, b, model.mass(body), radius, c.overlap.max(0.0));
    SurfacePoint {
        patch: c.patch,
        local: c.local,
        stiffness: [law.normal, law.tangential],
        damping: [law.damping, law.tangential_damping],
    }
}

/// Returns the undamped springs, along and across, for a body mass [kg].
pub fn undamped(stiffness: [f64; 2], damping: [f64; 2], mass: f64) -> [f64; 2] {
    [0, 1].map(|k| {
        let critical = 2.0 * (mass * stiffness[k]).sqrt();
        if damping[k] < UNDAMPED * critical { stiffness[k] } else { 0.0 }
    })
}

/// Ω for windows of 1 s.
fn phase<'a>(
    model: &dem::Model,
    grains: &dem::State,
    surface: &SolidSurface,
    contacts: impl Iterator<Item = (&'a SurfaceContact, &'a SurfacePoint)>,
) -> f64 {
    let mut bodies: std::collections::BTreeMap<u32, Matrix6<f64>> = std::collections::BTreeMap::new();
    for (c, p) in contacts {
        let body = c.body as usize;
        let (mass, inertia) = (model.mass(body), model.inertia(body).min());
        let [along, across] = undamped(p.stiffness, p.damping, mass);
        if along == 0.0 && across == 0.0 || !(mass > 0.0 && inertia > 0.0) {
            continue;
        }
        let arm = dem::Vec3::from(c.point) - grains.position(body);
        let normal = dem::Vec3::from(surface.normal(p.patch, p.local));
        let [m, j] = [1.0 / mass.sqrt(), 1.0 / inertia.sqrt()];
        let own = bodies.entry(c.body).or_insert_with(Matrix6::zeros);
        // Unit motions, scaled by the roots of the inverse masses.
        let columns: [dem::Vec3; 6] = std::array::from_fn(|k| {
            let mut unit = dem::Vec3::zeros();
            unit[k % 3] = 1.0;
            if k < 3 { unit * m } else { unit.cross(&arm) * j }
        });
        for a in 0..6 {
            for b in 0..6 {
                let [na, nb] = [a, b].map(|k| normal.dot(&columns[k]));
                own[(a, b)] += across * columns[a].dot(&columns[b]) + (along - across) * na * nb;
            }
        }
    }
    let largest = |m: &Matrix6<f64>| {
        let values: Vector6<f64> = m.symmetric_eigenvalues();
        values.max().max(0.0)
    };
    bodies.values().map(largest).fold(0.0, f64::max).sqrt()
}
