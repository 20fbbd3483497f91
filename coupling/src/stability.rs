//! How long a window of the exchange may be: W = Δt √(Kₙ/m) and D = C Δt/m for every class of contact, before a run.
//!
//! m is the mass that a point of the solid's surface offers, 1/(Nᵀ M⁻¹ N) with the shape functions N of the touched face
//! (and the spread, if there is one) and the mass matrix M of the solid: least at a corner of the lightest element, and
//! found there, at mid-sides and in the middle, for the lightest face and the lightest within. At the border of the surface
//! it is half of that, and a quarter at its corners; that mass is reported but not a criterion, since walls or slopes as a rule
//! keep stones from it by their radius. A stone with the
//! mass M_s and the dashpot C = 2 ζ √(M_s Kₙ) damps the pair of masses with
//! ζ' = C/(2 √(m' Kₙ)) = ζ √((m + M_s)/m), m' = m M_s/(m + M_s), which is the damping that the limits refer to.
//!
//! Limits of W by scheme, from the two-mass study and the runs of it with this program's own windows
//! (`docs/theory/coupling.md`, section 5.5): lagged 1.2 ζ'; predicted 1 with ζ' of 0.1 or more, else 0.5; stiffened 2 with ζ' of 0.05 or more and M_s of m
//! or more, else 1; both 0.2 with ζ' below 0.02, since without any damping predicted grows slowly, by 0.021 W⁴ per window;
//! iterated 5. D is at most 1 where the grains go on a motion that does not know their dashpot (predicted). The lagged scheme
//! errs in its energy long before it is unstable: W is at most 0.1 there and D 0.2.
//!
//! Limits: one contact on one point. Several stones on one face add their stiffness; a solid that carries energy away is
//! safer than the study's single node.
//!
//! Theory manual: equations (5.10), (5.12) of `docs/theory/coupling.md`.

use crate::face::landmarks;
use crate::interface::InterfaceNumbers;
use crate::scheme::Scheme;
use crate::surface::SolidSurface;
use serde::{Deserialize, Serialize};
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};

/// The two numbers that decide whether an exchange is stable, of the class of contacts with the largest W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// W = Δt √(Kₙ/m): window Δt, contact stiffness Kₙ, mass m of the lightest surface point.
    pub stiffness: f64,
    /// D = C Δt/m: the dashpot C of the heaviest grain on the same point; the largest of all classes.
    pub damping: f64,
}

/// Masses that points of a surface offer [kg]: within it, where there are such points, and at its border.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointMasses {
    /// At the corners of a face, the least.
    pub corner: f64,
    /// At the middles of its sides, the least.
    pub side: f64,
    /// In the middle, the least.
    pub middle: f64,
    /// At the border of the surface, the least; infinite where none of the faces looked at has a border.
    pub border: f64,
}

impl PointMasses {
    /// The least within the surface [kg].
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

/// No points yet.
const NONE: PointMasses =
    PointMasses { corner: f64::INFINITY, side: f64::INFINITY, middle: f64::INFINITY, border: f64::INFINITY };

/// Where on a face a point lies: corners and sides by number.
#[derive(Clone, Copy)]
enum Place {
    Corner(usize),
    Side(usize),
    Middle,
}

/// The points of a face that are looked at, with their natural coordinates.
fn places(surface: &SolidSurface, patch: u32) -> impl Iterator<Item = (Place, [f64; 2])> {
    let shape = surface.shape(patch);
    let corners = shape.corner_count();
    let place = move |k: usize| if k < corners { Place::Corner(k) } else { Place::Side(k - corners) };
    let border = landmarks(shape).iter().enumerate().map(move |(k, xi)| (place(k), *xi));
    border.chain([(Place::Middle, shape.natural_centre())])
}

/// The few faces whose corners within the surface have the least entries in the diagonal of the mass matrix. In a free mesh
/// the lightest points need not belong to the lightest element, since a point's mass comes from all elements around it;
/// faces of 20-node bricks need no such search.
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

/// Largest W of a scheme, for the damping ratio ζ' of the pair of masses and the ratio of the stone's mass to the point's.
pub fn largest_w(scheme: Scheme, damping: f64, mass_ratio: f64) -> f64 {
    match scheme {
        Scheme::Lagged => 1.2 * damping,
        // Neutral without damping.
        Scheme::Iterated { .. } => 5.0,
        // Predicted grows slowly without damping: by 0.021 W⁴ per window.
        _ if damping < 0.02 => 0.2,
        Scheme::Predicted if damping >= 0.1 => 1.0,
        Scheme::Predicted => 0.5,
        Scheme::Stiffened if damping >= 0.05 && mass_ratio >= 1.0 => 2.0,
        Scheme::Stiffened => 1.0,
    }
}

/// Largest W that windows of the program's own choice have: with contacts that stick, several on a face, the predicted scheme brings energy in
/// long before it is unstable. A bay of track gains 2.2 % of what it dissipates in a cycle at W = 1, and 0.13 % at 0.5
/// (`docs/theory/coupling.md`, section 5.5).
pub fn quiet_w(scheme: Scheme) -> f64 {
    if scheme == Scheme::Predicted { 0.5 } else { f64::INFINITY }
}

/// Largest W of a scheme for its energy: a force that does its work a window late errs by more than 5 % of an impact's
/// energy beyond it, long before the exchange is unstable (`docs/theory/coupling.md`, section 5.5).
pub fn accurate_w(scheme: Scheme) -> f64 {
    if scheme == Scheme::Lagged { 0.1 } else { f64::INFINITY }
}

/// Largest D of a scheme; of the lagged one for its energy, as [`accurate_w`].
pub fn largest_d(scheme: Scheme) -> f64 {
    match scheme {
        Scheme::Lagged => 0.2,
        Scheme::Predicted => 1.0,
        Scheme::Stiffened | Scheme::Iterated { .. } => f64::INFINITY,
    }
}

/// Masses that the surface offers where it belongs to elements of the material `material` and stones can come, which
/// `reached` says of a face by number; none where there are no such faces, or where all such points are held.
pub fn point_masses(
    solid: &fem::Model,
    surface: &SolidSurface,
    material: u32,
    reached: impl Fn(u32) -> bool,
) -> Option<PointMasses> {
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
    // A corner of the surface before its sides before its middle.
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
    // A surface so small that it has no corner or side within.
    if masses.corner.is_infinite() {
        masses.corner = outer.corner;
    }
    if masses.side.is_infinite() {
        masses.side = outer.side;
    }
    masses.least().is_finite().then_some(masses)
}

/// Largest W and D of the whole interface, all contacts together ([`crate::interface`]): systems drawn at random are stable up to 1, and a bed
/// of 60 spheres still trembles above this.
pub const INTERFACE: [f64; 2] = [0.75, 0.75];

/// (Ω of a body in a bed over Ω on its contacts with the surface alone)²: neighbours stiffen it. With 1, a bed of 60 spheres that satisfies all
/// limits still trembles at 3 mm/s.
const NEIGHBOURS: f64 = 4.0;

/// Relative growth of an undamped contact per window, from above: ½ W² (Ω²/24 − (θ − ½)), Ω that of a body among others; zero where θ
/// covers it.
pub fn interface_growth(scheme: Scheme, theta: f64, n: &InterfaceNumbers) -> f64 {
    if !matches!(scheme, Scheme::Predicted | Scheme::Stiffened) {
        return 0.0;
    }
    (0.5 * n.stiffness.powi(2) * (NEIGHBOURS * n.phase.powi(2) / 24.0 - (theta - 0.5))).max(0.0)
}

/// How far the whole interface is beyond its limits: above 1 it may be unstable. 0 for schemes that it does not bound. Under a θ of ½
/// undamped contacts grow in windows of any length ([`interface_growth`]), so Ω does not count.
pub fn interface_excess(scheme: Scheme, theta: f64, n: &InterfaceNumbers) -> f64 {
    if !matches!(scheme, Scheme::Predicted | Scheme::Stiffened) {
        return 0.0;
    }
    let [w, d] = INTERFACE;
    let phase = if theta > 0.5 { n.phase / largest_phase(theta) } else { 0.0 };
    (n.stiffness / w).max(n.damping / d).max(phase)
}

/// Largest Ω of undamped contacts that θ covers: √(24 (θ − ½)) for a body among others.
pub fn largest_phase(theta: f64) -> f64 {
    (24.0 / NEIGHBOURS * (theta - 0.5)).max(0.0).sqrt()
}

/// θ that covers Ω, with a margin of a tenth, to the next 0.0005.
pub fn theta_for(phase: f64) -> f64 {
    0.5 + (1.1 * NEIGHBOURS * phase.powi(2) / 24.0 * 2000.0).ceil() / 2000.0
}

/// Masses that points of some faces of a free body offer within a window of length `window` [s]: the impulse of a constant
/// push along the normal over the velocity that the body's step with `theta` gives the point. What it holds against the
/// push by its stiffness counts, which makes the mass that of a rigid body where waves cross the body many times in a
/// window, and that of [`point_masses`] in very short ones. `surface` is of that body alone.
///
/// # Errors
/// A plastic body, or one whose matrix cannot be factored.
pub fn window_masses(
    body: &fem::Model,
    surface: &SolidSurface,
    patches: &[u32],
    theta: f64,
    window: f64,
) -> Result<PointMasses, SolveError> {
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

/// The nodal loads of a unit push along the normal at a point of a face, shape `[3·nodes]`.
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

/// Solves with the mass matrix, by conjugate gradients preconditioned by its diagonal: the condition does not depend on
/// the mesh (Wathen, IMA J. Numer. Anal. 7 (1987) 449).
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

    /// Mass of a point of a face against a push along its normal [kg].
    fn at(&mut self, surface: &SolidSurface, patch: u32, place: [f64; 2]) -> f64 {
        const ACCURACY: f64 = 1e-4;
        let size = self.inverse.len();
        let mut load = push(self.solid, surface, patch, place);
        // Held dofs take no part: neither their load nor their motion counts.
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

    /// Ground of one material, and its top.
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

    /// Shares of one element's mass that points of a block's top offer, against the reference study (consistent mass,
    /// 4 × 4 × 2 elements): mid-face 0.101, mid-edge 0.042, corner 0.018, of points within the block; those at
    /// its border are lighter.
    #[test]
    fn masses_of_points_are_those_of_the_study() {
        let (solid, surface) = ground(Mesh::block([4, 4, 2], [1.0, 1.0, 0.5]));
        let element = 2000.0 / 64.0;
        let mut solver = MassSolver::new(&solid);
        // The face at the inner side of x = y = 0.5: its first corner is the middle of the top.
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
        let least = point_masses(&solid, &surface, 1, |_| true).unwrap();
        println!("least of the block: {least:?} kg, share of a corner {:.4}", least.corner / element);
        // The nearer to the border, the lighter: a corner one element away from it has a tenth less than the middle one.
        let share = least.corner / (found[0] * element);
        assert!(share > 0.85 && share < 1.0 + 1e-9 && least.least() == least.corner, "{share}");
        assert!(least.border < 0.5 * least.corner && least.side > least.corner);
        assert!(point_masses(&solid, &surface, 2, |_| true).is_none());
        assert!(point_masses(&solid, &surface, 1, |_| false).is_none());
        // Spread over a disc, a corner of the inside offers more.
        let faces = surface.faces().to_vec();
        let wide = SolidSurface::new(solid.mesh(), faces).spread_over(0.2);
        assert!(solver.at(&wide, inner, [-1.0, -1.0]) > 3.0 * found[0] * element);
    }

    /// A strip of thin elements sets the least mass only where stones come to it: without it the points of the others are as heavy
    /// as their width says.
    #[test]
    fn faces_out_of_reach_do_not_count() {
        let mut mesh = Mesh::block([6, 4, 2], [1.2, 0.8, 0.4]);
        // Elements of 0.2 m, those beyond x = 0.8 of 0.05 m.
        for x in &mut mesh.coordinates {
            x[0] = if x[0] > 0.8 { 0.8 + 0.25 * (x[0] - 0.8) } else { x[0] };
        }
        let (solid, surface) = ground(mesh);
        let all = point_masses(&solid, &surface, 1, |_| true).unwrap();
        let within = |k: u32| surface.face_nodes(k).iter().any(|&n| surface.position(n)[0] < 0.6 - 1e-9);
        let some = point_masses(&solid, &surface, 1, within).unwrap();
        let ratio = some.least() / all.least();
        println!("all {all:?}, within reach {some:?}");
        assert!((2.5..6.0).contains(&ratio), "{ratio}");
    }
}
