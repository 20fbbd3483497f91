//! Stability numbers of the whole interface: all contacts on the solid's surface together, sticking, as they are now.
//!
//! With the linearised contacts B_K = Σ Nᵀ (Kₙ n nᵀ + Kₜ (1 − n nᵀ)) N, shape functions N of the touched faces (through the discs of a
//! distributed transfer), and B_C the same with the dashpots,
//!
//! W = Δt √λmax(M⁻¹ B_K),   D = Δt λmax(M⁻¹ B_C),
//!
//! M the consistent mass of the solid: contacts on one face or under one disc add up, discs cut by a border and the negative corner
//! terms of an 8-node face are in N, and springs across the normal count as those along it. The third number belongs to the grains,
//!
//! Ω = Δt max √λmax(M_b⁻¹ Σ Jᵀ K J),
//!
//! M_b mass and inertia of a body, J its motion at its contacts with the surface, K the springs that no dashpot damps. The mean force of a
//! window differs by Ω²/24 from the force at its middle, and that difference adds energy to an undamped contact at every window; the solid's
//! θ > ½ dissipates (θ − ½)|Δv|²_M per window. In linear systems drawn at random (`docs/interface.py`: up to five nodes, six
//! contacts, bodies of several contacts, all ratios of mass, any damping) the predicted scheme is stable where W ≤ 1, D ≤ 1 and
//! Ω² ≤ 24 (θ − ½).
//!
//! λmax by the locally optimal gradient method (Knyazev, SIAM J. Sci. Comput. 23 (2001) 517) with the diagonal of M, on the elements at
//! the surface. Limits: sliding contacts count as sticking; of the neighbours of a body only its own inertia counts in Ω.
//!
//! Theory manual: equation (5.11) of `docs/theory/coupling.md`.

use crate::face::dot;
use crate::surface::SolidSurface;
use nalgebra::{Matrix3, Matrix6, Vector6};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_dem::surface::SurfaceContact;
use trackbed_fem as fem;
use trackbed_fem::surface_mass::SurfaceMass;

/// Damping ratio of a contact below which its spring counts as undamped.
pub const UNDAMPED: f64 = 0.02;

/// Iterations of an eigenvalue at most, and the relative growth at which it is taken.
const ITERATIONS: usize = 80;
const CONVERGED: f64 = 1e-3;
/// Added to an eigenvalue found from below.
const MARGIN: f64 = 1.02;

/// W, D and Ω of the interface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InterfaceNumbers {
    /// W = Δt √λmax(M⁻¹ B_K) [-].
    pub stiffness: f64,
    /// D = Δt λmax(M⁻¹ B_C) [-].
    pub damping: f64,
    /// Ω = Δt ω of the bodies on undamped contacts [-].
    pub phase: f64,
}

impl InterfaceNumbers {
    /// The numbers for windows of `window` [s], given those for 1 s.
    pub fn at(&self, window: f64) -> InterfaceNumbers {
        InterfaceNumbers {
            stiffness: window * self.stiffness,
            damping: window * self.damping,
            phase: window * self.phase,
        }
    }

    /// Each the larger of two.
    pub fn max(&self, other: &InterfaceNumbers) -> InterfaceNumbers {
        InterfaceNumbers {
            stiffness: self.stiffness.max(other.stiffness),
            damping: self.damping.max(other.damping),
            phase: self.phase.max(other.phase),
        }
    }
}

/// A matrix against the velocity of a point of the surface: `along` its normal and `across` it.
pub(crate) struct PointMatrix {
    /// Surface nodes of the touched face and values of its shape functions there; zero beyond the nodes of its kind.
    pub nodes: [u32; 8],
    pub shape: [f64; 8],
    pub normal: [f64; 3],
    pub along: f64,
    pub across: f64,
}

/// Matrices at points of the surface, summed.
#[derive(Default)]
pub(crate) struct PointMatrices {
    pub points: Vec<PointMatrix>,
    field: Vec<[f64; 3]>,
    mean: Vec<[f64; 3]>,
}

impl PointMatrices {
    /// Product with the velocity of the surface nodes: calls `add` with surface node and force.
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

/// Forces at the surface nodes as the solid's nodes get them: calls `add` with surface node and force.
pub(crate) fn distribute(surface: &SolidSurface, forces: &[[f64; 3]], mut add: impl FnMut(u32, [f64; 3])) {
    match surface.spread() {
        None => forces.iter().zip(0..).filter(|(f, _)| **f != [0.0; 3]).for_each(|(f, n)| add(n, *f)),
        Some(s) => s.distribute(forces, add),
    }
}

/// A contact with the surface as springs and dashpots, along and across the normal [N/m, N s/m].
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Face.
    pub patch: u32,
    /// Natural coordinates on it.
    pub local: [f64; 2],
    /// Springs.
    pub stiffness: [f64; 2],
    /// Dashpots.
    pub damping: [f64; 2],
}

/// Computes the numbers of an interface, with the mass matrix at the surface.
pub struct Interface {
    mass: SurfaceMass,
    inverse: Vec<[f64; 3]>,
    /// Row of the mass for each surface node.
    rows: Vec<u32>,
    matrices: PointMatrices,
}

impl Interface {
    /// For a surface of a solid.
    pub fn new(solid: &fem::Model, surface: &SolidSurface) -> Interface {
        let mass = SurfaceMass::new(solid, surface.faces().iter().map(|f| f.element));
        let rows =
            surface.nodes().iter().map(|&n| mass.row(n).expect("nodes of its elements") as u32).collect();
        let inverse = mass.inverse_diagonal();
        Interface { mass, inverse, rows, matrices: PointMatrices::default() }
    }

    /// Numbers of the present contacts for windows of 1 s; contacts with the second surface (meshed sleepers) are left out.
    pub fn numbers(
        &mut self,
        model: &dem::Model,
        grains: &dem::State,
        surface: &SolidSurface,
        contacts: &[SurfaceContact],
    ) -> InterfaceNumbers {
        let own = || contacts.iter().filter(|c| !model.on_other_surface(c.patch));
        let points: Vec<SurfacePoint> = own().map(|c| point(model, grains, c)).collect();
        let [stiffness, damping] = self.of_points(surface, &points);
        let phase = phase(model, grains, surface, own().zip(&points));
        InterfaceNumbers { stiffness, damping, phase }
    }

    /// W and D of points with springs and dashpots, for windows of 1 s.
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

    /// λmax of M⁻¹ B with the matrices in hand.
    fn largest(&mut self, surface: &SolidSurface) -> f64 {
        if self.matrices.points.is_empty() {
            return 0.0;
        }
        let Interface { mass, inverse, rows, matrices } = self;
        let n = mass.len();
        let mut product = |x: &[[f64; 3]], y: &mut [[f64; 3]]| {
            y.fill([0.0; 3]);
            let at = |k: usize| x[rows[k] as usize];
            matrices.times(surface, at, |k, f| (0..3).for_each(|d| y[rows[k as usize] as usize][d] += f[d]));
            y.iter_mut()
                .zip(inverse.iter())
                .for_each(|(y, i)| (0..3).for_each(|d| y[d] *= f64::from(i[d] > 0.0)));
        };
        // Bases x, residual direction w, last direction p, each with its products by B and M.
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

/// Rayleigh quotient of the best combination of bases, and its shares; none where they are no basis.
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

/// The best combination becomes the first basis, its step from the old one the third.
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

/// A start that no mode is likely to be orthogonal to; the same in every run.
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

/// A contact linearised.
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

/// Springs of a contact that no dashpot damps, along and across, for the mass of a body [kg].
pub fn undamped(stiffness: [f64; 2], damping: [f64; 2], mass: f64) -> [f64; 2] {
    [0, 1].map(|k| {
        let critical = 2.0 * (mass * stiffness[k]).sqrt();
        if damping[k] < UNDAMPED * critical { stiffness[k] } else { 0.0 }
    })
}

/// Ω of the bodies on undamped contacts, for windows of 1 s.
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
        // Velocity of the point by unit motions, scaled by the roots of the inverse masses.
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
