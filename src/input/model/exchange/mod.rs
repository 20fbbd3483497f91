//! `[coupling]` resolved: faces, scheme, load transfer, window length.

mod class;
mod layer;
mod table;

pub use class::{ContactClass, remarks, stability};
pub use table::build;

use super::grains::GrainsPart;
use super::solid::SolidPart;
use crate::scene::{Document, Scene, SceneError, Table};
use trackbed_coupling::interface_stability::InterfaceStabilityNumbers;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::stability::{
    EffectiveMasses, effective_masses, effective_masses_in_window, largest_accurate_w, largest_phase,
    largest_quiet_w, largest_stable_d, largest_stable_w, theta_for_phase,
};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::sheet::SurfaceMesh;
use trackbed_fem as fem;
use trackbed_fem::mesh::Face;

/// Largest Ω of undamped contacts. Beyond it windows are divided.
const LARGEST_PHASE: f64 = 0.85;

/// Above 20 sub-steps the DEM part dominates the cost.
const MOST: u32 = 20;

/// Excess at which the shortest window is rejected. Of 109 impacts at 0.5 to 5 m/s (predicted scheme) 3 % err
/// by more than 5 % of the energy within the limits, 7 % up to twice them, 29 % beyond.
const BEYOND: f64 = 2.0;

/// Resolved coupling.
pub struct CouplingPart {
    window: WindowPlan,
    /// Coupling scheme.
    pub scheme: Scheme,
    /// Load transfer to the solid.
    pub transfer: TransferPlan,
    theta: Option<f64>,
    /// Whether θ is given and automatic without.
    removable: bool,
    /// Contact faces: ground, then meshed sleepers in order.
    pub faces: Vec<Face>,
    /// Number of ground faces.
    pub ground_faces: usize,
}

/// Coupling windows derived from the contact classes.
pub struct Windows {
    /// Contact classes.
    pub classes: Vec<ContactClass>,
    /// Initial number of DEM sub-steps per window.
    pub substeps: u32,
    /// Implicitness θ of the FEM time integration.
    pub theta: f64,
}

/// Window length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindowPlan {
    /// Longest stable window.
    Auto,
    /// Number of initial DEM time steps.
    Steps(u32),
    /// Seconds, rounded to initial DEM time steps.
    Seconds(f64),
}

/// Load transfer to the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransferPlan {
    /// At the contact point.
    Point,
    /// Distributed over discs of this radius [m].
    Disc(f64),
    /// Distributed over discs, fraction of the mean grain radius.
    Part(f64),
}

impl CouplingPart {
    /// Returns the ground surface; `grains` sizes relative discs.
    pub fn ground(&self, solid: &SolidPart, grains: &GrainsPart) -> SolidSurface {
        let faces = self.faces[..self.ground_faces].to_vec();
        self.spread(SolidSurface::new(solid.model.mesh(), faces), grains)
    }

    /// Checks that the ground surface fills the box along periodic axes.
    ///
    /// # Errors
    /// A narrower or wider surface.
    pub fn check_periodic(
        &self,
        scene: &Table<Scene>,
        solid: &SolidPart,
        grains: &GrainsPart,
    ) -> Result<(), SceneError> {
        let mesh = solid.model.mesh();
        for (d, borders) in grains.periodic.iter().enumerate() {
            let Some([low, high]) = *borders else { continue };
            let nodes = self.faces[..self.ground_faces].iter().flat_map(|face| face.nodes());
            let along = nodes.map(|n| mesh.coordinates[*n as usize][d]);
            let [from, to] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            let slack = 1e-6 * (high - low);
            if (from - low).abs() > slack || (to - high).abs() > slack {
                let expected = format!("the ends of the contact surface of the solid, [{from}, {to}]");
                let key = format!("periodic.{}", ["x", "y", "z"][d]);
                return Err(scene.error(&key, format!("[{low}, {high}]"), expected));
            }
        }
        Ok(())
    }

    /// Returns the ground surface as flat triangles, for polyhedra.
    pub fn surface_mesh(&self, solid: &SolidPart) -> Option<SurfaceMesh> {
        SolidSurface::new(solid.model.mesh(), self.faces[..self.ground_faces].to_vec()).triangles()
    }

    /// Returns the contact surface of `model`.
    pub fn surface(&self, model: &fem::Model, grains: &GrainsPart) -> SolidSurface {
        self.spread(SolidSurface::new(model.mesh(), self.faces.clone()), grains)
    }

    fn spread(&self, surface: SolidSurface, grains: &GrainsPart) -> SolidSurface {
        match self.transfer {
            TransferPlan::Point => surface,
            TransferPlan::Disc(radius) => surface.distribute_over_discs(radius),
            TransferPlan::Part(part) => surface.distribute_over_discs(part * grains.groups.mean_reach()),
        }
    }

    /// Describes the load transfer as text.
    pub fn transfer_kind(&self, surface: &SolidSurface) -> String {
        match surface.spread() {
            None => "point, by the shape functions of the face".into(),
            Some(spread) => format!("distributed over discs of radius {:.4e} m", spread.radius()),
        }
    }

    /// Determines windows and θ. `surface` is the ground.
    pub fn windows(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        surface: &SolidSurface,
    ) -> Windows {
        let ground = self.ground_classes(grains, model, solid, surface);
        let dt = model.dt();
        let mut substeps = match self.window {
            WindowPlan::Steps(n) => n,
            WindowPlan::Seconds(window) => ((window / dt).round() as u32).max(1),
            WindowPlan::Auto => {
                // Adaptive steps grow beyond the initial step.
                let growth = if model.measured().is_some() {
                    (model.longest(true) / dt).clamp(1.0, 50.0)
                } else {
                    1.0
                };
                let most = (f64::from(MOST) * growth) as u32;
                let of_one = |c: ContactClass| c.excess().max(c.w / largest_quiet_w(self.scheme));
                let excess = ground.iter().map(|c| of_one(c.at(dt))).fold(0.0, f64::max);
                if excess > 0.0 { ((1.0 / excess) as u32).clamp(1, most) } else { most }
            }
        };
        loop {
            let window = f64::from(substeps) * dt;
            let ground = || ground.iter().map(|c| c.at(window));
            let theta = self.theta.unwrap_or_else(|| match self.scheme {
                Scheme::Lagged | Scheme::Iterated { .. } => 0.5,
                _ => {
                    theta_for_phase(ground().map(|c| c.numbers.phase).fold(0.0, f64::max).min(LARGEST_PHASE))
                }
            });
            let sleepers = self.sleeper_classes(grains, model, solid, theta, window);
            if !self.automatic() || substeps == 1 || sleepers.iter().all(|c| c.excess() <= 1.0) {
                return Windows { classes: ground().chain(sleepers).collect(), substeps, theta };
            }
            substeps -= 1;
        }
    }

    /// Rejects automatic windows if one DEM time step is too long.
    ///
    /// # Errors
    /// Excess of at least `BEYOND`.
    pub fn refuse(
        &self,
        document: &Document,
        classes: &[ContactClass],
        substeps: u32,
        dt: f64,
    ) -> Result<(), SceneError> {
        let worst = classes.iter().max_by(|a, b| a.excess().total_cmp(&b.excess()));
        let Some(c) = worst.filter(|c| self.automatic() && substeps == 1 && c.excess() > BEYOND) else {
            return Ok(());
        };
        let found = format!(
            "\"auto\" with W = {:.2} (limit {:.2}), D = {:.2}{} for {} on {} in windows of one DEM step, {dt:.2e} s",
            c.w,
            c.w_limit,
            c.d,
            c.d_limit.map_or(String::new(), |l| format!(" (limit {l})")),
            c.grains,
            c.solid
        );
        let expected = format!(
            "time.grain_step of {:.2e} s or less, softer contacts, a wider transfer.spread, larger elements{}",
            0.99 * dt / c.excess(),
            if self.scheme == Scheme::Predicted { ", or scheme = \"stiffened\"" } else { "" }
        );
        Err(document.error("coupling.substeps", found, &expected))
    }

    /// Returns remedies for undamped contacts with a `phase` per window.
    pub fn phase_remedies(&self, phase: f64, theta: f64, substeps: u32) -> String {
        let mut ways = Vec::new();
        if self.removable {
            ways.push("remove coupling.theta".to_string());
        }
        let fitting = theta_for_phase(phase);
        if fitting > theta && fitting <= 1.0 {
            ways.push(format!("set coupling.theta to {fitting:.3}"));
        } else {
            let least = theta_for_phase(LARGEST_PHASE);
            let part = 0.9 * largest_phase(theta.max(least)) / phase;
            let fewer = (part * f64::from(substeps)) as u32;
            let shorter = match self.window {
                WindowPlan::Seconds(window) => Some(format!("coupling.window to {:.2e} s", part * window)),
                _ if fewer > 0 => Some(format!("coupling.substeps to {fewer}")),
                _ => None,
            };
            let given =
                self.theta.filter(|t| *t < least).map(|_| format!("coupling.theta to {least:.3} and "));
            ways.extend(shorter.map(|shorter| format!("set {}{shorter}", given.unwrap_or_default())));
        }
        ways.push("set tangential_damping_ratio".into());
        let last = ways.pop().unwrap_or_default();
        let text = if ways.is_empty() { last } else { format!("{}, or {last}", ways.join(", ")) };
        text[..1].to_uppercase() + &text[1..]
    }

    /// Whether the number of sub-steps is chosen automatically.
    pub fn automatic(&self) -> bool {
        self.window == WindowPlan::Auto
    }

    /// For windows of 1 s; see [`ContactClass::at`].
    fn ground_classes(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        surface: &SolidSurface,
    ) -> Vec<ContactClass> {
        let Some(own) = model.surface_material() else { return Vec::new() };
        let faces = &self.faces[..self.ground_faces];
        let mut ids: Vec<u32> =
            faces.iter().map(|f| solid.model.mesh().materials[f.element as usize]).collect();
        ids.sort_unstable();
        ids.dedup();
        // Massless solids are rejected elsewhere.
        let within = |face: u32| reached(model, surface, face);
        let places =
            ids.iter().filter_map(|&id| Some((id, effective_masses(&solid.model, surface, id, within)?)));
        let places: Vec<_> = places.collect();
        let mut classes = self.with_stones(grains, model, solid, own, &places);
        layer::add_numbers(&mut classes, (grains, model, own), (&solid.model, surface), within);
        classes
    }

    fn sleeper_classes(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        theta: f64,
        window: f64,
    ) -> Vec<ContactClass> {
        let (Some(sleepers), Some(first)) = (&solid.sleepers, self.faces.get(self.ground_faces)) else {
            return Vec::new();
        };
        debug_assert!(first.element as usize >= sleepers.ground_elements());
        // Cannot fail: the whole model has the same bodies.
        let Ok((body, surface)) = sleepers.alone(&solid.model) else { return Vec::new() };
        let surface = self.spread(surface, grains);
        let faces = sleepers.telling_faces(&surface);
        let Ok(masses) = effective_masses_in_window(&body, &surface, &faces, theta, window) else {
            return Vec::new();
        };
        let own = model.patch_material(self.ground_faces as u32);
        let mut classes = self.with_stones(grains, model, solid, own, &[(sleepers.material, masses)]);
        for class in &mut classes {
            // θ leaves −(1 − θ)/θ of an unresolved motion.
            let own = (1e6 * (4.0 * theta - 2.0)).round() / 1e6;
            class.d_limit = class.d_limit.map(|limit| limit.min(own));
            *class = class.at(window);
        }
        classes
    }

    fn with_stones(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        own: usize,
        places: &[(u32, EffectiveMasses)],
    ) -> Vec<ContactClass> {
        let mut classes = Vec::new();
        for (material, name) in grains.materials.touching() {
            let masses = grains.masses_of(model, material);
            let Some(stones) = masses else { continue };
            let (stiffness, damping_ratio) = model.contact_stiffness(material, own);
            for (id, masses) in places {
                let m = masses.least();
                let pair = stones.map(|stone| damping_ratio * ((m + stone) / m).sqrt());
                let limit = |k: usize| largest_stable_w(self.scheme, pair[k], stones[k] / m);
                let d_limit = largest_stable_d(self.scheme);
                classes.push(ContactClass {
                    grains: name.clone(),
                    solid: solid.material_names.get(id).cloned().unwrap_or_else(|| id.to_string()),
                    stiffness,
                    damping_ratio,
                    masses: *masses,
                    stones,
                    pair_damping: pair,
                    w: (stiffness / m).sqrt(),
                    w_limit: limit(0).min(limit(1)).min(largest_accurate_w(self.scheme)),
                    d: 2.0 * damping_ratio * (stones[1] * stiffness).sqrt() / m,
                    d_limit: d_limit.is_finite().then_some(d_limit),
                    numbers: InterfaceStabilityNumbers::default(),
                });
            }
        }
        classes
    }
}

/// Whether grains can reach a face, not wholly behind a fixed plane.
fn reached(model: &dem::Model, surface: &SolidSurface, face: u32) -> bool {
    let nodes: Vec<_> = surface.face_nodes(face).iter().map(|&n| surface.mesh_position(n)).collect();
    model
        .planes()
        .iter()
        .filter(|p| p.velocity == dem::Vec3::zeros())
        .all(|plane| nodes.iter().any(|&x| (dem::Vec3::from(x) - plane.point).dot(&plane.normal) > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(window: WindowPlan, theta: Option<f64>, removable: bool) -> CouplingPart {
        let (scheme, transfer) = (Scheme::Stiffened, TransferPlan::Point);
        CouplingPart { window, scheme, transfer, theta, removable, faces: Vec::new(), ground_faces: 0 }
    }

    #[test]
    fn remedies_are_possible() {
        let auto = plan(WindowPlan::Auto, None, false).phase_remedies(2.5, 0.6325, 105);
        assert_eq!(auto, "Set coupling.substeps to 33, or set tangential_damping_ratio");
        let seconds = plan(WindowPlan::Seconds(1e-3), None, false).phase_remedies(2.5, 0.6325, 105);
        assert_eq!(seconds, "Set coupling.window to 3.21e-4 s, or set tangential_damping_ratio");
        let given = plan(WindowPlan::Steps(10), Some(0.5), true).phase_remedies(2.5, 0.5, 10);
        assert_eq!(
            given,
            "Remove coupling.theta, set coupling.theta to 0.633 and coupling.substeps to 3, or set tangential_damping_ratio"
        );
        let small = plan(WindowPlan::Steps(10), Some(0.5), true).phase_remedies(0.6, 0.5, 10);
        assert_eq!(
            small,
            "Remove coupling.theta, set coupling.theta to 0.566, or set tangential_damping_ratio"
        );
        let one = plan(WindowPlan::Steps(1), None, false).phase_remedies(2.5, 0.6325, 1);
        assert_eq!(one, "Set tangential_damping_ratio");
    }
}
