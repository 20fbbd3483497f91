//! Checked, resolved and immutable model.

use super::check;
use super::collision;
use super::images::Images;
use super::input::ModelInput;
use super::steps::Steps;
use super::timestep::{self, DtLimit};
use crate::base::Vec3;
use crate::base::error::ModelError;
use crate::base::names::Names;
use crate::bodies::table::{Bodies, Body, BodyKind, for_members};
use crate::body_force::{self, BodyForce, Skin};
use crate::contact::narrow_phase::SheetView;
use crate::law::{History, Laws, Linearised};
use crate::shape::Shape;
use crate::shape::dilated::Core;
use crate::shape::plane::Plane;
use crate::spatial::patchwork::{Patch, Trees};
use crate::spatial::periodic::Periodic;
use crate::spatial::sheet::{Sheet, SheetFacet};
use crate::wall::{WallInput, set::Walls, shells::Shells};

/// Spheres per block, about. It orders sums, so it is a constant.
const BLOCK_SPHERES: usize = 1024;

/// Model ([`Model::new`]).
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) bodies: Bodies,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) cores: Vec<Core>,
    pub(crate) planes: Vec<Plane>,
    pub(crate) walls: Walls,
    pub(crate) shells: Shells,
    pub(crate) surface_material: Option<u32>,
    pub(crate) other_surface: Option<(u32, u32)>,
    pub(crate) laws: Laws,
    /// Largest expected overlap over effective radius, for overlap-dependent stiffness.
    pub(crate) expected: f64,
    pub(crate) gravity: Vec3,
    pub(crate) damping: f64,
    pub(crate) body_forces: Vec<BodyForce>,
    pub(crate) scarred: bool,
    /// Shape surfaces, if needed for body forces.
    pub(crate) skins: Vec<Skin>,
    pub(crate) skin: f64,
    /// Smallest and largest sphere [m].
    pub(crate) radii: (f64, f64),
    /// Any body is a clump; any is not made of spheres.
    pub(crate) clumps: bool,
    pub(crate) solids: bool,
    /// Of bodies, of planes, and of walls and external surface; ascending.
    pub(crate) body_materials: Vec<u32>,
    pub(crate) patch_materials: Vec<u32>,
    pub(crate) block: usize,
    pub(crate) bonds: Vec<crate::bond::Constants>,
    /// For bodies with faces.
    pub(crate) patches: Vec<Patch>,
    pub(crate) patch_trees: Trees,
    /// For bodies with faces.
    pub(crate) sheet: Sheet,
    pub(crate) periodic: Option<Periodic>,
    /// Images of patches; none without periodic axes.
    pub(crate) images: Option<Images>,
    steps: Steps,
    limit: DtLimit,
    names: Names,
}

struct Sizes {
    radii: (f64, f64),
    spheres: usize,
    /// Most spheres of a body.
    largest: usize,
    mean: f64,
}

impl Sizes {
    fn new(bodies: &Bodies, shapes: &[Shape]) -> Sizes {
        let mut radii = (f64::INFINITY, 0.0_f64);
        let (mut spheres, mut sum) = (0_usize, 0.0);
        for body in bodies.iter() {
            for_members(&shapes[body.shape], body.scale, |_, r| {
                radii = (radii.0.min(r), radii.1.max(r));
                spheres += 1;
                sum += r;
            });
        }
        if spheres == 0 {
            // Boxes only: length scale of search and speed bound.
            let size = bodies.iter().map(|b| b.radius).fold(f64::INFINITY, f64::min);
            radii = if size.is_finite() { (0.1 * size, 0.1 * size) } else { (1.0, 1.0) };
        }
        let largest = shapes.iter().map(|shape| shape.query(|s| s.sphere_count()));
        let largest = largest.max().unwrap_or(1).max(1);
        let mean = if spheres > 0 { sum / spheres as f64 } else { radii.0 };
        Sizes { radii, spheres, largest, mean }
    }
}

impl Model {
    /// Checks and resolves an input.
    ///
    /// # Errors
    /// [`ModelError`] of the first invalid entry.
    pub fn new(input: ModelInput) -> Result<Model, ModelError> {
        check::input(&input)?;
        let bodies = Bodies::new(&input.bodies, &input.shapes, &input.materials)?;
        let dilated = bodies.iter().any(|b| matches!(input.shapes[b.shape], Shape::Polyhedron(_)));
        let given: Vec<WallInput> = input.all_walls().collect();
        let scarred = given.iter().any(|w| w.scarring.is_some());
        let mut walls = Walls::afloat(&given, input.triangles.len(), &input.body_forces, &input.gravity)?;
        let shells = Shells::new(&given, &walls)?;
        let laws = if dilated || !shells.pairs.is_empty() { Laws::with_edges } else { Laws::new };
        let laws = laws(&input.materials, &input.contacts);
        let faces = bodies.iter().any(|b| input.shapes[b.shape].dilated());
        let patches = if faces { walls.patchwork(&given) } else { Vec::new() };
        check::rigid_pairs(&bodies, &input, &laws)?;
        let Sizes { radii, spheres, largest, mean } = Sizes::new(&bodies, &input.shapes);
        let round = (0..bodies.len()).filter(|&b| bodies.kind(b) != BodyKind::Solid).count();
        let skin = input.skin.distance(mean);
        check::adhesion(&input)?;
        check::scarring(&bodies, &input)?;
        check::polyhedra(&bodies, &input, &laws)?;
        check::shells(&walls, &shells, &laws)?;
        super::check_periodic::check(&input, &bodies, &patches, skin)?;
        let periodic = Periodic::new(&input.periodic);
        let bonds = crate::bond::resolve(&input.bond_kinds, &input.bonds, &input.bodies, &bodies)?;
        check::absent_bonds(&input)?;
        let expected = timestep::expected_overlap(&bodies, &input, &laws);
        let mut limit = timestep::limit(&bodies, &input, &laws, expected, &bonds, radii);
        let rigid = timestep::walls(&mut walls, &mut limit, &bodies, &input, &laws, expected, radii);
        let rigid = rigid.min(timestep::shells(&mut walls, &mut limit, &shells, &laws));
        let partners = timestep::partners(&bodies, &input);
        let collision = collision::longest(&bodies, &input, &laws, &partners, expected, radii.1);
        let fluids = timestep::fluids(&input, &bodies, &walls);
        check::fluid_step(&input.time_step, fluids)?;
        let landing = timestep::landing(&bodies, &input, &laws, expected);
        let longest = rigid.min(landing).min(body_force::RESOLVED * fluids);
        let cause = limit.describe(&input.names, |body| input.bodies.get(body).map(|b| b.part));
        let steps = input.time_step.damped(input.damping);
        let steps = Steps::new(&steps, (&limit, &cause), longest, collision)?;
        let walls_and_surface = walls.walls.iter().map(|w| w.material);
        let (clumps, solids) = (bodies.iter().any(|b| b.kind == BodyKind::Clump), round < bodies.len());
        let body_materials = sorted(bodies.iter().map(|b| b.material));
        let patch_materials = sorted(walls_and_surface.chain(check::surfaces(&input).map(|m| m as u32)));
        let planes = input.planes.iter().map(|p| Plane { normal: p.normal.normalize(), ..*p }).collect();
        Ok(Model {
            // Sphere indices of a block have 16 bits.
            block: (BLOCK_SPHERES * round / spheres.max(1))
                .clamp(16, BLOCK_SPHERES)
                .min(65_535 / largest)
                .max(1),
            clumps,
            solids,
            body_materials,
            patch_materials,
            bodies,
            cores: input.shapes.iter().map(Shape::core).collect(),
            planes,
            walls,
            shells,
            surface_material: input.surface_material.map(|m| m as u32),
            other_surface: input.other_surface.map(|(first, m)| (first, m as u32)),
            laws,
            expected,
            gravity: input.gravity,
            damping: input.damping.map_or(0.0, |d| d.factor),
            skins: body_force::skins(&input.body_forces, scarred, &input.shapes),
            scarred,
            body_forces: input.body_forces,
            shapes: input.shapes,
            skin,
            patch_trees: Trees::new(&patches),
            patches,
            sheet: Sheet::new(input.surface_mesh.as_deref().filter(|_| faces)),
            periodic,
            images: periodic.as_ref().map(Images::new),
            bonds,
            radii,
            steps,
            limit,
            names: input.names,
        })
    }

    /// Initial time step [s]; current value: [`State::dt`](crate::State::dt).
    pub fn dt(&self) -> f64 {
        self.steps.first
    }

    /// Stability limit and its cause.
    pub fn dt_limit(&self) -> &DtLimit {
        &self.limit
    }

    /// Formats the stability limit and its cause.
    pub fn describe_limit(&self) -> String {
        self.limit.describe(&self.names, |body| self.group(body))
    }

    /// Replaces indices of bodies and walls of a message by names.
    pub fn name_objects(&self, message: &impl std::fmt::Display) -> String {
        self.names.replace(&message.to_string(), |body| self.group(body))
    }

    fn group(&self, body: usize) -> Option<u32> {
        (body < self.body_count()).then(|| self.part(body))
    }

    /// Whether the stiffness of a contact grows with the overlap.
    pub(crate) fn stiffens(&self) -> bool {
        self.expected > 0.0
    }

    /// Fraction of the critical time step of current contacts, if steps follow it ([`crate::stability`]).
    pub fn measured(&self) -> Option<f64> {
        self.steps.share
    }

    /// Longest step [s] for collisions, rigid-body walls and the input; `packed`: most contacts last
    /// ([`crate::stability`]).
    pub fn longest(&self, packed: bool) -> f64 {
        self.steps.longest.min(if packed { self.steps.lasting } else { self.steps.collision })
    }

    /// Discards the initial positions (24 bytes per body), which
    /// [`State::new`](crate::engine::state::State::new) needs.
    pub fn forget_start(&mut self) {
        self.bodies.forget_positions();
    }

    /// Constants of a body.
    #[inline]
    pub(crate) fn body(&self, body: usize) -> Body {
        self.bodies.get(body)
    }

    /// Returns true if any shape is a dilated polyhedron or disk.
    pub fn has_faces(&self) -> bool {
        self.shapes.iter().any(Shape::dilated)
    }

    pub(crate) fn acts_on_bodies(&self) -> bool {
        self.scarred || !self.body_forces.is_empty()
    }

    /// Number of bodies.
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// Number of initial bonds.
    pub fn bond_count(&self) -> usize {
        self.bonds.len()
    }

    /// Bodies of a bond.
    pub fn bond_ends(&self, bond: usize) -> [usize; 2] {
        self.bonds[bond].ends.map(|b| b as usize)
    }

    /// Number of spheres, clump members included.
    pub fn sphere_count(&self) -> usize {
        (0..self.bodies.len()).map(|b| self.member_count(b) as usize).sum()
    }

    /// Mass of a body [kg].
    pub fn mass(&self, body: usize) -> f64 {
        self.body(body).mass
    }

    /// Principal moments of inertia of a body [kg m²].
    pub fn inertia(&self, body: usize) -> Vec3 {
        self.body(body).inertia
    }

    /// Bounding radius about the centre of mass [m].
    pub fn radius(&self, body: usize) -> f64 {
        self.body(body).radius
    }

    /// Group of a body.
    pub fn part(&self, body: usize) -> u32 {
        self.body(body).part
    }

    /// Unscaled shape of a body.
    pub fn shape(&self, body: usize) -> &Shape {
        &self.shapes[self.body(body).shape]
    }

    /// Input index of a body's shape.
    pub fn shape_number(&self, body: usize) -> usize {
        self.body(body).shape
    }

    /// Length scale factor of a body's shape.
    pub fn scale(&self, body: usize) -> f64 {
        self.body(body).scale
    }

    /// Volume of a body [m³].
    pub fn volume(&self, body: usize) -> f64 {
        self.shape(body).query(|s| s.volume()) * self.body(body).scale.powi(3)
    }

    /// Spheres in the body frame: centre [m], radius [m]; empty for a box.
    pub fn members(&self, body: usize) -> Vec<(Vec3, f64)> {
        let mut members = Vec::new();
        for_members(self.shape(body), self.body(body).scale, |c, r| members.push((c, r)));
        members
    }

    pub(crate) fn member_count(&self, body: usize) -> u32 {
        self.shape(body).query(|s| s.sphere_count()) as u32
    }

    /// Planes with unit normals.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// Body forces other than gravity.
    pub fn body_forces(&self) -> &[BodyForce] {
        &self.body_forces
    }

    /// Gravity [m/s²].
    pub fn gravity(&self) -> Vec3 {
        self.gravity
    }

    /// Search skin [m].
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Number of walls, triangle surfaces included.
    pub fn wall_count(&self) -> usize {
        self.walls.walls.len()
    }

    /// Normal stiffness K [N/m] and damping ratio of a material pair, at the expected overlap of the largest
    /// sphere or the longest edge, whichever is stiffer.
    pub fn contact_stiffness(&self, a: usize, b: usize) -> (f64, f64) {
        let (a, b) = (a as u32, b as u32);
        let radius = self.radii.1;
        let point = self.laws.stiffness(a, b, self.expected * radius, radius);
        let edge = self.laws.edges([a, b]).map_or(0.0, |[a, b]| {
            let longest = |body: Body| body.scale * self.shapes[body.shape].query(|s| s.longest_edge());
            self.bodies.iter().map(longest).fold(0.0, f64::max) * self.laws.stiffness(a, b, 0.0, 0.0)
        });
        (point.max(edge), self.laws.damping_ratio(a, b))
    }

    /// Normal spring force [N] and stiffness [N/m] at an overlap and an effective radius [m].
    pub fn contact_spring(&self, a: usize, b: usize, overlap: f64, radius: f64) -> (f64, f64) {
        self.laws.loading(a as u32, b as u32, overlap, radius)
    }

    /// Springs and dashpots of a new contact at an overlap and effective radius [m]; `mass`: effective mass
    /// [kg].
    pub fn linearised(&self, a: usize, b: usize, mass: f64, radius: f64, overlap: f64) -> Linearised {
        let materials = [a as u32, b as u32];
        // The stored rate is a radius, or a speed, which springs do not depend on.
        let history = History { rate: radius, ..History::NONE };
        let law = self.laws.linearised(materials, mass, radius, overlap, &history);
        let (limit, _) = self.laws.friction_limit(materials, None, overlap, radius, &history);
        match limit > 0.0 {
            true => law,
            false => {
                Linearised { tangential: 0.0, tangential_damping: 0.0, rolling: 0.0, twisting: 0.0, ..law }
            }
        }
    }

    /// Returns true if a patch belongs to the second external surface ([`Model::patch_material`]).
    pub fn on_other_surface(&self, patch: u32) -> bool {
        self.other_surface.is_some_and(|(first, _)| patch >= first)
    }

    /// Ratio of tangential to normal stiffness.
    pub fn tangential_ratio(&self, a: usize, b: usize) -> f64 {
        self.laws.tangential_ratio(a as u32, b as u32)
    }

    /// Material of the external surface.
    pub fn surface_material(&self) -> Option<usize> {
        self.surface_material.map(|m| m as usize)
    }

    /// Material of an external surface patch.
    #[inline]
    pub fn patch_material(&self, patch: u32) -> usize {
        match self.other_surface {
            Some((first, material)) if patch >= first => material as usize,
            _ => self.surface_material.unwrap_or(0) as usize,
        }
    }

    pub(crate) fn sheet_at<'a>(&self, facets: &'a [SheetFacet]) -> SheetView<'a> {
        SheetView { facets, materials: (self.surface_material.unwrap_or(0), self.other_surface) }
    }

    /// Material of a body.
    pub fn material(&self, body: usize) -> usize {
        self.body(body).material as usize
    }
}

fn sorted(numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut all: Vec<u32> = numbers.collect();
    all.sort_unstable();
    all.dedup();
    all
}
