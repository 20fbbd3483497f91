//! A-priori limits of the coupling window: W = Δt √(Kₙ/m) and D = C Δt/m per contact class.
//!
//! m is the effective nodal mass 1/(Nᵀ M⁻¹ N). Limits depend on the damping ratio of the mass pair, ζ' = ζ
//! √((m + M_s)/m), grain mass M_s.
//!
//! Theory manual: eqs. (5.10), (5.12), limits in section 5.5. Not included: several grains per face,
//! radiation.

use crate::face::landmarks;
use crate::interface_stability::InterfaceStabilityNumbers;
use crate::scheme::Scheme;
use crate::surface::SolidSurface;
use serde::{Deserialize, Serialize};
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};

/// Stability numbers of the contact class with the largest W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactStabilityNumbers {
    /// W = Δt √(Kₙ/m), m the smallest effective nodal mass.
    pub stiffness: f64,
    /// D = C Δt/m, C of the heaviest grain; largest of all classes.
    pub damping: f64,
}

/// Smallest effective nodal masses [kg].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectiveMasses {
    /// Face corners.
    pub corner: f64,
    /// Mid-sides.
    pub side: f64,
    /// Face centres.
    pub middle: f64,
    /// Border; infinite without one.
    pub border: f64,
}

impl EffectiveMasses {
    /// Smallest mass off the border [kg].
    pub fn least(&self) -> f64 {
        self.corner.min(self.side).min(self.middle)
    }

    fn take(&mut self, place: Place, mass: f64) {
        let slot = match place {
            Place::Corner(_) => &mut self.corner,
            Place::Side(_) => &mut self.side,
            Place::Middle => &mut self.middle,
        };
        *slot = slot.min(mass);
    }
}

const NONE: EffectiveMasses = EffectiveMasses {
    corner: f64::INFINITY,
    side: f64::INFINITY,
    middle: f64::INFINITY,
    border: f64::INFINITY,
};

#[derive(Clone, Copy)]
enum Place {
    Corner(usize),
    Side(usize),
    Middle,
}

/// Sampled points of a face.
fn places(surface: &SolidSurface, patch: u32) -> impl Iterator<Item = (Place, [f64; 2])> {
    let shape = surface.shape(patch);
    let corners = shape.corner_count();
    let place = move |k: usize| if k < corners { Place::Corner(k) } else { Place::Side(k - corners) };
    let border = landmarks(shape).iter().enumerate().map(move |(k, xi)| (place(k), *xi));
    border.chain([(Place::Middle, shape.natural_centre())])
}

/// Faces whose inner corners have the smallest diagonal mass.
fn lightest_nodes(solid: &fem::Model, surface: &SolidSurface, own: impl Fn(&u32) -> bool) -> Vec<u32> {
    const MOST: usize = 3;
    let diagonal = solid.matrices().mass_diagonal();
    let free = |patch: &u32| surface.shape(*patch) != fem::FaceShape::Quad8;
    let mut faces: Vec<(f64, u32)> = (0..surface.faces().len() as u32)
        .filter(|k| own(k) && free(k))
        .map(|patch| {
            let nodes = surface.faces()[patch as usize].corners().iter().zip(0..);
            let within = nodes.filter(|&(_, k)| !surface.corner_on_border(patch, k));
            let least = within.map(|(&n, _)| diagonal[n as usize]).fold(f64::INFINITY, f64::min);
            (least, patch)
        })
        .collect();
    faces.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    faces.into_iter().take(MOST).map(|(_, patch)| patch).collect()
}

/// Returns the largest stable W for ζ' and the ratio of grain mass to nodal mass.
pub fn largest_stable_w(scheme: Scheme, damping: f64, mass_ratio: f64) -> f64 {
    match scheme {
        Scheme::Lagged => 1.2 * damping,
        Scheme::Iterated { .. } => 5.0,
        // Grows by 0.021 W⁴ per window.
        _ if damping < 0.02 => 0.2,
        Scheme::Predicted if damping >= 0.1 => 1.0,
        Scheme::Predicted => 0.5,
        Scheme::Stiffened if damping >= 0.05 && mass_ratio >= 1.0 => 2.0,
        Scheme::Stiffened => 1.0,
    }
}

/// Returns the largest W of automatic windows. Sticking contacts add energy below the stability limit: per
/// cycle, a bay of track gains 2.2 % of its dissipation at W = 1, and 0.13 % at 0.5 (Theory manual, section
/// 5.5).
pub fn largest_quiet_w(scheme: Scheme) -> f64 {
    if scheme == Scheme::Predicted { 0.5 } else { f64::INFINITY }
}

/// Returns the largest W for an energy error of 5 % per impact (Theory manual, section 5.5).
pub fn largest_accurate_w(scheme: Scheme) -> f64 {
    if scheme == Scheme::Lagged { 0.1 } else { f64::INFINITY }
}

/// Returns the largest D.
pub fn largest_stable_d(scheme: Scheme) -> f64 {
    match scheme {
        Scheme::Lagged => 0.2,
        Scheme::Predicted => 1.0,
        Scheme::Stiffened | Scheme::Iterated { .. } => f64::INFINITY,
    }
}

/// Returns the effective nodal masses on faces of `material` within reach of grains (`reached`).
///
/// `None` without unconstrained points.
pub fn effective_masses(
    solid: &fem::Model,
    surface: &SolidSurface,
    material: u32,
    reached: impl Fn(u32) -> bool,
) -> Option<EffectiveMasses> {
    let mesh = solid.mesh();
    let mass = |patch: u32| {
        let element = surface.faces()[patch as usize].element as usize;
        solid.elastic(element).density * mesh.element_volume(element)
    };
    let own = |patch: &u32| {
        let element = surface.faces()[*patch as usize].element as usize;
        mesh.materials[element] == material && reached(*patch)
    };
    let patches = || (0..surface.faces().len() as u32).filter(own);
    let lightest = patches().min_by(|a, b| mass(*a).total_cmp(&mass(*b)))?;
    let corners = |patch: u32| {
        (0..surface.shape(patch).corner_count()).filter(|&side| surface.on_border(patch, side)).count()
    };
    let inmost = patches().min_by(|&a, &b| corners(a).cmp(&corners(b)).then(mass(a).total_cmp(&mass(b))))?;
    let outermost = patches()
        .min_by(|&a, &b| corners(b).min(2).cmp(&corners(a).min(2)).then(mass(a).total_cmp(&mass(b))))?;
    let mut solver = MassSolver::new(solid);
    let mut masses = NONE;
    let mut outer = NONE;
    let mut tried = vec![lightest, inmost, outermost];
    tried.extend(lightest_nodes(solid, surface, own));
    tried.sort_unstable();
    tried.dedup();
    for patch in tried {
        for (place, natural) in places(surface, patch) {
            let at_border = match place {
                Place::Corner(k) => surface.corner_on_border(patch, k),
                Place::Side(k) => surface.on_border(patch, k),
                Place::Middle => false,
            };
            let own = if at_border { &mut outer } else { &mut masses };
            own.take(place, solver.at(surface, patch, natural));
        }
    }
    masses.border = outer.least();
    // Without inner corners or sides.
    if masses.corner.is_infinite() {
        masses.corner = outer.corner;
    }
    if masses.side.is_infinite() {
        masses.side = outer.side;
    }
    masses.least().is_finite().then_some(masses)
}

/// Limits of W and D of the interface: random systems are stable up to 1; a bed of 60 spheres vibrates above
/// 0.75.
pub const INTERFACE_LIMITS: [f64; 2] = [0.75, 0.75];

/// (Ω in a bed over Ω on surface contacts)²: neighbours stiffen a body. With 1, a bed of 60 spheres vibrates
/// at 3 mm/s.
const NEIGHBOURS: f64 = 4.0;

/// Returns the growth bound of undamped contacts per window, ½ W² (Ω²/24 − (θ − ½)), Ω among neighbours.
pub fn interface_growth(scheme: Scheme, theta: f64, n: &InterfaceStabilityNumbers) -> f64 {
    if !matches!(scheme, Scheme::Predicted | Scheme::Stiffened) {
        return 0.0;
    }
    (0.5 * n.stiffness.powi(2) * (NEIGHBOURS * n.phase.powi(2) / 24.0 - (theta - 0.5))).max(0.0)
}

/// Returns the largest ratio of interface numbers to limits, 0 for unlimited schemes.
///
/// For θ = ½ undamped contacts always grow, so Ω is omitted.
pub fn interface_excess(scheme: Scheme, theta: f64, n: &InterfaceStabilityNumbers) -> f64 {
    if !matches!(scheme, Scheme::Predicted | Scheme::Stiffened) {
        return 0.0;
    }
    let [w, d] = INTERFACE_LIMITS;
    let phase = if theta > 0.5 { n.phase / largest_phase(theta) } else { 0.0 };
    (n.stiffness / w).max(n.damping / d).max(phase)
}

/// Returns the largest Ω for θ: √(24 (θ − ½)) among neighbours.
pub fn largest_phase(theta: f64) -> f64 {
    (24.0 / NEIGHBOURS * (theta - 0.5)).max(0.0).sqrt()
}

/// Returns θ for Ω with a margin of 10 %, rounded up to 0.0005.
pub fn theta_for_phase(phase: f64) -> f64 {
    0.5 + (1.1 * NEIGHBOURS * phase.powi(2) / 24.0 * 2000.0).ceil() / 2000.0
}

/// Returns the effective nodal masses of a free body within a window of `window` [s].
///
/// Impulse of a constant normal force over the computed velocity: rigid-body mass in long windows,
/// [`effective_masses`] in short ones.
///
/// # Errors
/// Plastic body, or singular matrix.
pub fn effective_masses_in_window(
    body: &fem::Model,
    surface: &SolidSurface,
    patches: &[u32],
    theta: f64,
    window: f64,
) -> Result<EffectiveMasses, SolveError> {
    let mut solver = ThetaSolver::new(body, theta, window)?;
    let mut masses = NONE;
    for &patch in patches {
        for (place, natural) in places(surface, patch) {
            let load = push(body, surface, patch, natural);
            let mut state = fem::State::new(body);
            solver.step(body, &mut state, &load)?;
            let speed: f64 = load.iter().zip(&state.v).map(|(f, v)| f * v).sum();
            masses.take(place, window / speed);
        }
    }
    Ok(masses)
}

/// Nodal loads of a unit normal force, shape `[3·nodes]`.
fn push(solid: &fem::Model, surface: &SolidSurface, patch: u32, place: [f64; 2]) -> Vec<f64> {
    let normal = surface.normal(patch, place);
    let mut forces = vec![[0.0; 3]; surface.nodes().len()];
    for (&n, s) in surface.face_nodes(patch).iter().zip(surface.shape_functions(patch, place)) {
        forces[n as usize] = normal.map(|c| s * c);
    }
    let mut load = vec![0.0; solid.dof_count()];
    let nodes = surface.nodes();
    let mut add = |n: u32, f: [f64; 3]| {
        (0..3).for_each(|d| load[3 * nodes[n as usize] as usize + d] += f[d]);
    };
    match surface.spread() {
        None => forces.iter().zip(0..).for_each(|(f, n)| add(n, *f)),
        Some(spread) => spread.distribute(&forces, add),
    }
    load
}

/// Diagonally preconditioned CG; the condition number is mesh-independent (Wathen, IMA J. Numer. Anal. 7
/// (1987) 449).
struct MassSolver<'a> {
    solid: &'a fem::Model,
    inverse: Vec<f64>,
}

impl<'a> MassSolver<'a> {
    fn new(solid: &'a fem::Model) -> MassSolver<'a> {
        let mut inverse: Vec<f64> =
            solid.matrices().mass_diagonal().iter().flat_map(|m| [1.0 / m; 3]).collect();
        solid.supports().fixed().iter().for_each(|(dof, _)| inverse[*dof as usize] = 0.0);
        MassSolver { solid, inverse }
    }

    /// Effective nodal mass along the normal [kg].
    fn at(&mut self, surface: &SolidSurface, patch: u32, place: [f64; 2]) -> f64 {
        const ACCURACY: f64 = 1e-4;
        let size = self.inverse.len();
        let mut load = push(self.solid, surface, patch, place);
        // Constrained dofs neither load nor move.
        for (l, i) in load.iter_mut().zip(&self.inverse) {
            if *i == 0.0 {
                *l = 0.0;
            }
        }
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (mut x, mut r) = (vec![0.0; size], load.clone());
        let mut z: Vec<f64> = r.iter().zip(&self.inverse).map(|(r, i)| r * i).collect();
        let mut p = z.clone();
        let mut q = vec![0.0; size];
        let mut rz = product(&r, &z);
        let first = rz;
        if first <= 0.0 {
            return f64::INFINITY;
        }
        for _ in 0..200 {
            self.solid.mass_times(&p, &mut q);
            let alpha = rz / product(&p, &q);
            for i in 0..size {
                x[i] += alpha * p[i];
                if self.inverse[i] != 0.0 {
                    r[i] -= alpha * q[i];
                }
            }
            (0..size).for_each(|i| z[i] = r[i] * self.inverse[i]);
            let next = product(&r, &z);
            if next <= ACCURACY * ACCURACY * first {
                break;
            }
            let beta = next / rz;
            rz = next;
            (0..size).for_each(|i| p[i] = z[i] + beta * p[i]);
        }
        1.0 / product(&load, &x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_fem::mesh::Mesh;
    use trackbed_fem::{Elastic, ModelInput, Quadrature};

    fn ground(mesh: Mesh) -> (fem::Model, SolidSurface) {
        let solid = fem::Model::new(ModelInput {
            mesh,
            materials: [(1, Elastic { young: 2e7, poisson: 0.3, density: 2000.0 }.into())].into(),
            quadrature: Quadrature::Gauss3,
            ..Default::default()
        })
        .unwrap();
        let faces = SolidSurface::facing(solid.mesh(), [0.0, 0.0, 1.0], 0.3);
        let surface = SolidSurface::new(solid.mesh(), faces);
        (solid, surface)
    }

    /// Reference study (consistent mass, 4 × 4 × 2 elements, inner points), over the element mass.
    #[test]
    fn nodal_masses_match_reference_study() {
        let (solid, surface) = ground(Mesh::block([4, 4, 2], [1.0, 1.0, 0.5]));
        let element = 2000.0 / 64.0;
        let mut solver = MassSolver::new(&solid);
        // Its first corner is the centre of the top.
        let inner = (0..16)
            .find(|&k| {
                let x = surface.position(surface.face_nodes(k)[0]);
                (x[0] - 0.5).abs() + (x[1] - 0.5).abs() < 1e-9
            })
            .unwrap();
        let share = |solver: &mut MassSolver<'_>, place| solver.at(&surface, inner, place) / element;
        let found = [[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0]].map(|p| share(&mut solver, p));
        println!(
            "shares of an element's mass: corner {:.4}, mid-edge {:.4}, mid-face {:.4}",
            found[0], found[1], found[2]
        );
        for (f, study) in found.iter().zip([0.018, 0.042, 0.101]) {
            assert!((f - study).abs() < 6e-4, "{f} against {study}");
        }
        let least = effective_masses(&solid, &surface, 1, |_| true).unwrap();
        println!("least of the block: {least:?} kg, share of a corner {:.4}", least.corner / element);
        // A corner one element from the border has a tenth less.
        let share = least.corner / (found[0] * element);
        assert!(share > 0.85 && share < 1.0 + 1e-9 && least.least() == least.corner, "{share}");
        assert!(least.border < 0.5 * least.corner && least.side > least.corner);
        assert!(effective_masses(&solid, &surface, 2, |_| true).is_none());
        assert!(effective_masses(&solid, &surface, 1, |_| false).is_none());
        let faces = surface.faces().to_vec();
        let wide = SolidSurface::new(solid.mesh(), faces).distribute_over_discs(0.2);
        assert!(solver.at(&wide, inner, [-1.0, -1.0]) > 3.0 * found[0] * element);
    }

    #[test]
    fn ignores_unreachable_faces() {
        let mut mesh = Mesh::block([6, 4, 2], [1.2, 0.8, 0.4]);
        for x in &mut mesh.coordinates {
            x[0] = if x[0] > 0.8 { 0.8 + 0.25 * (x[0] - 0.8) } else { x[0] };
        }
        let (solid, surface) = ground(mesh);
        let all = effective_masses(&solid, &surface, 1, |_| true).unwrap();
        let within = |k: u32| surface.face_nodes(k).iter().any(|&n| surface.position(n)[0] < 0.6 - 1e-9);
        let some = effective_masses(&solid, &surface, 1, within).unwrap();
        let ratio = some.least() / all.least();
        println!("all {all:?}, within reach {some:?}");
        assert!((2.5..6.0).contains(&ratio), "{ratio}");
    }
}
