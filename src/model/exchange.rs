//! `[coupling]` resolved: faces, scheme, transfer, and how long a window may be.

use super::grains::GrainsPart;
use super::solid::SolidPart;
use crate::scene::coupling::{Coupling, SchemeName, Substeps, TransferTable};
use crate::scene::{Document, SceneError};
use serde::{Deserialize, Serialize};
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::stability::{
    PointMasses, Stability, largest_d, largest_w, point_masses, window_masses,
};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::mesh::Face;

/// Most sub-steps that `"auto"` takes: beyond it the grains are nearly all of the cost.
const MOST: u32 = 20;
/// Passes of the iterated scheme, unless the scene says otherwise.
const PASSES: u32 = 20;
/// Tolerance of the iterated scheme, unless the scene says otherwise.
const TOLERANCE: f64 = 1e-6;

/// Implicitness of the solid's step with meshed sleepers, unless the scene says otherwise: with 0.5 the oscillations of a stiff
/// body that no window resolves go on for ever, and dashpots that see them a window late make them grow.
const WITH_SLEEPERS: f64 = 0.6;

/// The exchange, resolved.
pub struct CouplingPart {
    substeps: Option<u32>,
    /// Order of the exchange.
    pub scheme: Scheme,
    /// How contact forces reach the solid.
    pub transfer: TransferPlan,
    /// Implicitness of the solid's step.
    pub theta: f64,
    /// Faces that grains may touch: those of the ground, then those of the meshed sleepers, one after the other.
    pub faces: Vec<Face>,
    /// How many of them are the ground's.
    pub ground_faces: usize,
}

/// How contact forces reach the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransferPlan {
    /// At the contact point.
    Point,
    /// Over discs of this radius [m].
    Disc(f64),
    /// Over discs of this part of the stones' mean radius.
    Part(f64),
}

/// Contacts of the stones of one material with the solid of one material.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ContactClass {
    /// Material of the stones.
    pub grains: String,
    /// Material of the solid.
    pub solid: String,
    /// Contact stiffness Kₙ [N/m].
    pub stiffness: f64,
    /// Damping ratio ζ of the contact, for the stone's own mass.
    pub damping_ratio: f64,
    /// Masses that points of the surface offer [kg].
    pub masses: PointMasses,
    /// Mass of the lightest and the heaviest stone [kg].
    pub stones: [f64; 2],
    /// Damping ratio ζ' of the lightest and the heaviest stone against the lightest point.
    pub pair_damping: [f64; 2],
    /// W at the lightest point.
    pub w: f64,
    /// Largest W of the scheme for this class.
    pub w_limit: f64,
    /// D of the heaviest stone at the lightest point.
    pub d: f64,
    /// Largest D of the scheme; absent where it has none.
    pub d_limit: Option<f64>,
}

impl ContactClass {
    /// How far a class is beyond its limits: above 1 it may be unstable.
    pub fn excess(&self) -> f64 {
        (self.w / self.w_limit).max(self.d_limit.map_or(0.0, |limit| self.d / limit))
    }

    /// The class in a line.
    pub fn line(&self) -> String {
        let limit = |v: f64| if v < 1e-12 { "0".into() } else { format!("{v:.2}") };
        format!(
            "{} on {}: K = {:.3e} N/m, zeta = {:.2}; mass of a point {:.3e} kg at a corner, {:.3e} at a side, {:.3e} in the \
             middle, {:.3e} at the border; stones {:.3e} to {:.3e} kg{}; W = {:.3} (at most {}), D = {:.3}{}",
            self.grains,
            self.solid,
            self.stiffness,
            self.damping_ratio,
            self.masses.corner,
            self.masses.side,
            self.masses.middle,
            self.masses.border,
            self.stones[0],
            self.stones[1],
            if self.stones[0] < 0.3 * self.masses.least() {
                " (some lighter than 0.3 of the point)"
            } else {
                ""
            },
            self.w,
            limit(self.w_limit),
            self.d,
            self.d_limit.map_or(String::new(), |l| format!(" (at most {l})")),
        )
    }
}

impl CouplingPart {
    /// The ground's surface that grains touch. `grains` tells the size of the discs where it goes with the stones.
    pub fn ground(&self, solid: &SolidPart, grains: &GrainsPart) -> SolidSurface {
        let faces = self.faces[..self.ground_faces].to_vec();
        self.spread(SolidSurface::new(solid.model.mesh(), faces), grains)
    }

    /// The whole surface that grains touch, of `model`, where the sleepers are set down.
    pub fn surface(&self, model: &fem::Model, grains: &GrainsPart) -> SolidSurface {
        self.spread(SolidSurface::new(model.mesh(), self.faces.clone()), grains)
    }

    fn spread(&self, surface: SolidSurface, grains: &GrainsPart) -> SolidSurface {
        match self.transfer {
            TransferPlan::Point => surface,
            TransferPlan::Disc(radius) => surface.spread_over(radius),
            TransferPlan::Part(part) => surface.spread_over(part * grains.groups.mean_reach()),
        }
    }

    /// The transfer in words.
    pub fn transfer_kind(&self, surface: &SolidSurface) -> String {
        match surface.spread() {
            None => "point, through the shape functions of the touched face".into(),
            Some(spread) => format!("spread over discs of {:.4e} m", spread.radius()),
        }
    }

    /// The classes of contacts, and the steps of the grains per window: as the scene says, or as many as the limits of all
    /// classes leave room for. `surface` is the ground's.
    pub fn classes(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        surface: &SolidSurface,
    ) -> (Vec<ContactClass>, u32) {
        let ground = self.ground_classes(grains, model, solid, surface);
        let dt = model.dt();
        let mut substeps = self.substeps.unwrap_or_else(|| {
            // W and D are proportional to the window.
            let excess = ground.iter().map(|c| c.at(dt).excess()).fold(0.0, f64::max);
            if excess > 0.0 { ((1.0 / excess) as u32).clamp(1, MOST) } else { MOST }
        });
        loop {
            let window = f64::from(substeps) * dt;
            let sleepers = self.sleeper_classes(grains, model, solid, window);
            if self.substeps.is_some() || substeps == 1 || sleepers.iter().all(|c| c.excess() <= 1.0) {
                return (ground.iter().map(|c| c.at(window)).chain(sleepers).collect(), substeps);
            }
            substeps -= 1;
        }
    }

    /// Whether the scene leaves the number of steps to the program.
    pub fn automatic(&self) -> bool {
        self.substeps.is_none()
    }

    /// The classes of contacts with the ground for windows of 1 s; [`ContactClass::at`] gives them for others.
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
        // A solid that grains lie on without a mass is refused elsewhere.
        let places = ids.iter().filter_map(|&id| Some((id, point_masses(&solid.model, surface, id)?)));
        let places: Vec<_> = places.collect();
        self.with_stones(grains, model, solid, own, &places)
    }

    /// The classes of contacts with meshed sleepers, whose masses depend on the window [s].
    fn sleeper_classes(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        window: f64,
    ) -> Vec<ContactClass> {
        let (Some(sleepers), Some(first)) = (&solid.sleepers, self.faces.get(self.ground_faces)) else {
            return Vec::new();
        };
        debug_assert!(first.element as usize >= sleepers.ground_elements());
        // The whole solid was made of such bodies and steps with such matrices.
        let Ok((body, surface)) = sleepers.alone(&solid.model) else { return Vec::new() };
        let surface = self.spread(surface, grains);
        let faces = sleepers.telling_faces(&surface);
        let Ok(masses) = window_masses(&body, &surface, &faces, self.theta, window) else {
            return Vec::new();
        };
        let own = model.patch_material(self.ground_faces as u32);
        let mut classes = self.with_stones(grains, model, solid, own, &[(sleepers.material, masses)]);
        for class in &mut classes {
            // Of a motion that a window does not resolve θ leaves −(1 − θ)/θ, and a dashpot that sees it a window late
            // −D/2θ of it.
            let own = (1e6 * (4.0 * self.theta - 2.0)).round() / 1e6;
            class.d_limit = class.d_limit.map(|limit| limit.min(own));
            *class = class.at(window);
        }
        classes
    }

    /// Classes of all stones on materials of the solid with their masses of points, for windows of 1 s.
    fn with_stones(
        &self,
        grains: &GrainsPart,
        model: &dem::Model,
        solid: &SolidPart,
        own: usize,
        places: &[(u32, PointMasses)],
    ) -> Vec<ContactClass> {
        let mut classes = Vec::new();
        for (material, name) in grains.materials.touching() {
            let masses = grains.masses_of(model, material);
            let Some(stones) = masses else { continue };
            let (stiffness, damping_ratio) = model.contact_stiffness(material, own);
            for (id, masses) in places {
                let m = masses.least();
                let pair = stones.map(|stone| damping_ratio * ((m + stone) / m).sqrt());
                let limit = |k: usize| largest_w(self.scheme, pair[k], stones[k] / m);
                let d_limit = largest_d(self.scheme);
                classes.push(ContactClass {
                    grains: name.clone(),
                    solid: solid.material_names.get(id).cloned().unwrap_or_else(|| id.to_string()),
                    stiffness,
                    damping_ratio,
                    masses: *masses,
                    stones,
                    pair_damping: pair,
                    w: (stiffness / m).sqrt(),
                    w_limit: limit(0).min(limit(1)),
                    d: 2.0 * damping_ratio * (stones[1] * stiffness).sqrt() / m,
                    d_limit: d_limit.is_finite().then_some(d_limit),
                });
            }
        }
        classes
    }
}

impl ContactClass {
    /// The same for windows of `window` [s], given that for 1 s.
    pub fn at(&self, window: f64) -> ContactClass {
        ContactClass { w: window * self.w, d: window * self.d, ..self.clone() }
    }
}

/// The largest W and D of all classes.
pub fn stability(classes: &[ContactClass]) -> Stability {
    Stability {
        stiffness: classes.iter().map(|c| c.w).fold(0.0, f64::max),
        damping: classes.iter().map(|c| c.d).fold(0.0, f64::max),
    }
}

/// What to say about classes beyond their limits.
pub fn remarks(classes: &[ContactClass], scheme: Scheme, substeps: u32) -> Vec<String> {
    let beyond = classes.iter().filter(|c| c.excess() > 1.0);
    beyond
        .map(|c| {
            let fitting = (f64::from(substeps) / c.excess()) as u32;
            // Only a meshed sleeper's limit is lower than that of the scheme.
            let lax = c.d > c.d_limit.unwrap_or(f64::INFINITY) && c.d <= largest_d(scheme);
            let fewer = match fitting {
                _ if lax => {
                    let theta = (20.0 * (0.5 + 0.25 * c.d)).ceil() / 20.0;
                    format!("coupling.theta = {:.2} would do", theta.max(WITH_SLEEPERS))
                }
                0 => "not even coupling.substeps = 1 would do".into(),
                1.. => format!("coupling.substeps = {fitting} would do (or \"auto\")"),
            };
            let other = match scheme {
                Scheme::Lagged => ", and so may scheme = \"predicted\"",
                Scheme::Predicted => ", and so may scheme = \"stiffened\" or \"iterated\", a wider transfer.spread",
                Scheme::Stiffened => ", and so may scheme = \"iterated\"",
                Scheme::Iterated { .. } => "",
            };
            let damping = c.d_limit.map_or(String::new(), |limit| format!(", D = {:.2} (at most {limit})", c.d));
            format!(
                "the exchange may be unstable for {} on {}: W = {:.2} (at most {:.2} here){damping}; {fewer}{other}, or \
                 softer contacts",
                c.grains, c.solid, c.w, c.w_limit
            )
        })
        .collect()
}

/// Resolves `[coupling]`.
///
/// # Errors
/// Bad input.
pub fn build(document: &Document, c: &Coupling, solid: &SolidPart) -> Result<CouplingPart, SceneError> {
    let substeps = match c.substeps {
        Substeps::Auto => None,
        Substeps::Count(n) if (1..=1000).contains(&n) => Some(n as u32),
        Substeps::Count(n) => {
            return Err(document.error("coupling.substeps", n.to_string(), "1 to 1000, or \"auto\""));
        }
    };
    let theta = c.theta.unwrap_or(if solid.sleepers.is_some() { WITH_SLEEPERS } else { 0.5 });
    if !(0.5..=1.0).contains(&theta) {
        return Err(document.error("coupling.theta", theta.to_string(), "0.5 to 1"));
    }
    let scheme = scheme(document, c, solid)?;
    let transfer = transfer(document, c)?;
    if c.direction.iter().map(|d| d * d).sum::<f64>() <= 0.0 {
        return Err(document.error("coupling.direction", "the null vector", "a direction"));
    }
    if !(c.max_angle.si > 0.0 && c.max_angle.si <= std::f64::consts::PI) {
        return Err(document.error("coupling.max_angle", c.max_angle.si.to_string(), "above 0, at most pi"));
    }
    let mesh = solid.model.mesh();
    let ground = solid.sleepers.as_ref().map_or(mesh.element_count(), |s| s.ground_elements());
    let mut faces = SolidSurface::facing(mesh, c.direction, c.max_angle.si);
    faces.retain(|f| (f.element as usize) < ground);
    if faces.is_empty() {
        return Err(document.error(
            "coupling.direction",
            "no boundary face that looks this way",
            "at least one",
        ));
    }
    let ground_faces = faces.len();
    if solid.sleepers.is_some() {
        // On all sides: in the order of their elements, so sleeper by sleeper.
        faces.extend(mesh.boundary_faces().into_iter().filter(|f| f.element as usize >= ground));
    }
    Ok(CouplingPart { substeps, scheme, transfer, theta, faces, ground_faces })
}

fn scheme(document: &Document, c: &Coupling, solid: &SolidPart) -> Result<Scheme, SceneError> {
    if c.scheme != SchemeName::Iterated {
        for (key, present) in [("tolerance", c.tolerance.is_some()), ("max_passes", c.max_passes.is_some())] {
            if present {
                let expected = "no such key but with scheme = \"iterated\"";
                return Err(document.error(&format!("coupling.{key}"), "a value", expected));
            }
        }
    }
    Ok(match c.scheme {
        SchemeName::Predicted => Scheme::Predicted,
        SchemeName::Lagged => Scheme::Lagged,
        SchemeName::Stiffened => {
            if !solid.is_linear() {
                let expected = "another scheme for a plastic solid or one with initial stress: this one needs a constant matrix";
                return Err(document.error("coupling.scheme", "\"stiffened\"", expected));
            }
            if solid.reduction.is_some() {
                let expected = "another scheme beside [solid.reduction]: this one needs the whole matrix";
                return Err(document.error("coupling.scheme", "\"stiffened\"", expected));
            }
            Scheme::Stiffened
        }
        SchemeName::Iterated => {
            let tolerance = c.tolerance.unwrap_or(TOLERANCE);
            if !(tolerance > 0.0 && tolerance < 1.0) {
                let found = tolerance.to_string();
                return Err(document.error("coupling.tolerance", found, "above 0, below 1"));
            }
            let passes = c.max_passes.unwrap_or(PASSES);
            if !(2..=1000).contains(&passes) {
                return Err(document.error("coupling.max_passes", passes.to_string(), "2 to 1000"));
            }
            Scheme::Iterated { tolerance, passes }
        }
    })
}

fn transfer(document: &Document, c: &Coupling) -> Result<TransferPlan, SceneError> {
    let TransferTable::Spread(table) = c.transfer else { return Ok(TransferPlan::Point) };
    match (table.spread, table.spread_factor) {
        (Some(radius), None) if radius.si > 0.0 => Ok(TransferPlan::Disc(radius.si)),
        (Some(radius), None) => {
            Err(document.error("coupling.transfer.spread", format!("{} m", radius.si), "a radius above 0"))
        }
        (None, Some(factor)) if factor > 0.0 && factor <= 100.0 => Ok(TransferPlan::Part(factor)),
        (None, Some(factor)) => {
            Err(document.error("coupling.transfer.spread_factor", factor.to_string(), "above 0, at most 100"))
        }
        _ => Err(document.error(
            "coupling.transfer",
            "both or none of `spread` and `spread_factor`",
            "one of them",
        )),
    }
}
