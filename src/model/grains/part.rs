//! The resolved grains of a scene, from which models are built.

use super::bonds::BondPart;
use super::compaction::CompactionPlan;
use super::deposition::DepositionPlan;
use super::flow::FlowPlan;
use super::groups::GroupsPart;
use super::materials::MaterialsPart;
use super::measure::MeasurePlan;
use super::periodic::Borders;
use super::runout::RunoutPlan;
use super::specimen::{EventPlan, SpecimenPlan};
use super::steps::{StepPlan, add_inertia};
use super::structures::StructurePlan;
use super::track::{SleeperPlan, TrackPart};
use super::walls::WallsPart;
use std::sync::Arc;
use trackbed_dem::sheet::SurfaceMesh;
use trackbed_dem::{BodyForce, BodyInput, LocalDamping, Material, Model, ModelInput, TimeStep, Vec3};

/// The grains, ready to build models of.
#[derive(Clone)]
pub struct GrainsPart {
    /// Materials, and what pairs of them have of their own.
    pub materials: MaterialsPart,
    /// Groups of grains, and all grains where they start.
    pub groups: GroupsPart,
    /// Bonds between grains.
    pub bonds: BondPart,
    /// Walls.
    pub walls: WallsPart,
    /// The solid's surface.
    pub surface: SurfacePlan,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Wind of the run proper.
    pub wind: Option<BodyForce>,
    /// Water, which is there from the start.
    pub water: Option<BodyForce>,
    /// Steps in time.
    pub steps: StepPlan,
    /// Periodic borders.
    pub periodic: Borders,
    /// What is done before the run proper.
    pub packing: PackingPlan,
    /// Boxes that are measured.
    pub measures: Vec<MeasurePlan>,
    /// What of a slide is measured.
    pub runout: Option<RunoutPlan>,
    /// A specimen between platens.
    pub specimen: Option<SpecimenPlan>,
    /// How breaks are joined to acoustic events.
    pub events: Option<EventPlan>,
    /// Structures whose loads are recorded.
    pub structures: Vec<StructurePlan>,
    /// Sleepers, rail and load.
    pub track: TrackPart,
    /// Inlets and outlets.
    pub flow: Option<FlowPlan>,
}

/// The surface of a solid that grains touch.
#[derive(Clone, Debug)]
pub struct SurfacePlan {
    /// That of the ground; none without a solid.
    pub ground: Option<usize>,
    /// First face of meshed sleepers in the surface, and their material.
    pub sleepers: Option<(u32, usize)>,
    /// The ground's surface as triangles, where there are polyhedra.
    pub mesh: Option<Arc<SurfaceMesh>>,
}

/// What is done with grains before the run proper.
#[derive(Clone, Default)]
pub struct PackingPlan {
    /// Settling.
    pub deposition: Option<DepositionPlan>,
    /// Compaction of the settled bed.
    pub compaction: Vec<CompactionPlan>,
}

/// Takes a share of the stiffness of all contacts.
fn soften(input: &mut ModelInput, factor: f64) {
    for material in &mut input.materials {
        material.stiffness *= factor;
        material.young = material.young.map(|young| young * factor);
        // Corners crush under the forces that the true ones bear, which go as strength³ / modulus².
        material.corner_strength *= libm::cbrt(factor * factor);
    }
    for pair in &mut input.contacts {
        pair.stiffness = pair.stiffness.map(|stiffness| stiffness * factor);
    }
}

impl GrainsPart {
    /// Body forces of the run proper.
    pub fn body_forces(&self) -> impl Iterator<Item = BodyForce> {
        self.wind.into_iter().chain(self.water)
    }

    /// Whether grains scar a wall.
    pub fn scarred(&self) -> bool {
        self.walls.others.iter().any(|w| w.scarring.is_some())
    }

    /// The model in which filled grains settle: no sleeper, friction and damping of the deposition.
    pub fn deposition_input(&self, plan: &DepositionPlan) -> ModelInput {
        let contacts = self.materials.pairs_with(plan.friction);
        let damping = (plan.local_damping > 0.0).then_some(LocalDamping { factor: plan.local_damping });
        // Sleepers are not there yet.
        let alone = ModelInput {
            other_surface: None,
            body_forces: self.water.into_iter().collect(),
            ..self.true_input(self.groups.bodies.clone())
        };
        let mut input = ModelInput { contacts, damping, ..alone };
        soften(&mut input, plan.stiffness_factor);
        // How grains bounce on their way into the bed does not matter.
        if let TimeStep::Measured { longest, collisions, .. } = &mut input.time_step {
            (*longest, *collisions) = (f64::INFINITY, false);
        }
        // Walls wait for the run proper, which starts with them in their first place; driven walls and rigid bodies come
        // in only then.
        input.planes.iter_mut().for_each(|p| p.velocity = Vec3::zeros());
        input.walls.retain(|w| w.servo.is_none() && w.body.is_none());
        input.walls.iter_mut().for_each(|w| *w = w.at_rest());
        for moving in &self.groups.moving {
            let grip = input.bodies.iter_mut().filter(|b| b.part == moving.part);
            grip.for_each(|b| b.velocity = Vec3::zeros());
        }
        self.bonds.add_stones_to(&mut input);
        input
    }

    /// The step, or how it is found; not longer than the track's springs on sleepers allow.
    fn time_step(&self) -> TimeStep {
        match self.steps.step {
            TimeStep::Measured { share, .. } => {
                TimeStep::Measured { share, longest: self.track.longest_step(), collisions: true }
            }
            fixed => fixed,
        }
    }

    /// Whether grains are packed before the run proper.
    pub fn is_packed(&self) -> bool {
        let PackingPlan { deposition, compaction } = &self.packing;
        deposition.is_some() || !self.groups.growths.is_empty() || !compaction.is_empty()
    }

    /// The model of the run proper with the given bodies, which have their true masses.
    pub fn input(&self, bodies: Vec<BodyInput>) -> ModelInput {
        let mut input = self.true_input(bodies);
        add_inertia(&mut input, self.steps.mass_factor);
        input
    }

    /// The same without a factor on the masses: beds are made with the true ones, for falling is no quasi-static motion.
    fn true_input(&self, mut bodies: Vec<BodyInput>) -> ModelInput {
        for moving in &self.groups.moving {
            for body in bodies.iter_mut().filter(|b| b.part == moving.part) {
                (body.velocity, body.fixed) = (moving.velocity, [true; 6]);
            }
        }
        let mut input = ModelInput {
            materials: self.materials.all.clone(),
            contacts: self.materials.pairs.clone(),
            shapes: self.groups.shapes.clone(),
            bodies,
            planes: self.walls.planes.clone(),
            triangles: Vec::new(),
            walls: self.walls.others.clone(),
            surface_material: self.surface.ground,
            other_surface: self.surface.sleepers,
            surface_mesh: self.surface.mesh.clone(),
            gravity: self.gravity,
            body_forces: self.body_forces().collect(),
            time_step: self.time_step(),
            impact_speed: self.steps.impact_speed,
            skin: self.steps.skin,
            damping: None,
            periodic: self.periodic,
            ..ModelInput::default()
        };
        self.bonds.add_to(&mut input);
        input
    }

    /// Stiffness, density and the like of the material of a body.
    pub fn material(&self, body: &BodyInput) -> Material {
        self.materials.all[body.material]
    }

    /// Number of groups that are no sleepers; theirs come first.
    pub fn stone_groups(&self) -> u32 {
        self.groups.names.len() as u32 - u32::from(self.track.rigid_sleeper().is_some())
    }

    /// Masses of the lightest and the heaviest grain of a material in a model of these grains [kg]; none without any.
    pub fn masses_of(&self, model: &Model, material: usize) -> Option<[f64; 2]> {
        let grains = self.stone_groups();
        let own = (0..model.body_count())
            .filter(|&b| model.part(b) < grains && model.material(b) == material)
            .map(|b| model.mass(b));
        let ends = own.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], m| [low.min(m), high.max(m)]);
        (ends[1] > 0.0).then_some(ends)
    }

    /// Puts a plane elsewhere [m].
    pub fn place_plane(&mut self, plane: usize, point: Vec3) {
        self.walls.planes[plane].point = point;
    }

    /// Tells from which face of the solid's surface on the faces are those of meshed sleepers.
    pub fn set_sleeper_faces(&mut self, first: u32) {
        let meshed = self.track.sleeper.as_ref().filter(|s| s.row.meshed);
        self.surface.sleepers = meshed.map(|s| (first, s.material));
    }

    /// A sleeper as a body with its centre above `centre` at height `z` [m], with its true mass.
    pub fn sleeper_body(&self, plan: &SleeperPlan, centre: [f64; 2], z: f64) -> BodyInput {
        BodyInput {
            shape: plan.shape,
            material: plan.material,
            part: self.groups.names.len() as u32 - 1,
            position: Vec3::new(centre[0], centre[1], z),
            fixed: plan.row.held,
            mass: Some(plan.row.mass / self.steps.mass_factor),
            ..BodyInput::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A corner crushes at the force π³ σ³ R²/(6 E*²) (Hertz), so softened corners crush at the force of the true ones.
    #[test]
    fn softened_corners_crush_at_the_same_force() {
        let granite = Material { young: Some(50e9), corner_strength: 800e6, ..Material::RIGID };
        let mut input = ModelInput { materials: vec![granite], ..ModelInput::default() };
        soften(&mut input, 0.02);
        let force = |m: &Material| m.corner_strength.powi(3) / m.young.expect("a modulus").powi(2);
        let soft = &input.materials[0];
        assert_eq!(soft.young, Some(1e9));
        assert!((force(soft) / force(&granite) - 1.0).abs() < 1e-12, "{soft:?}");
    }
}
