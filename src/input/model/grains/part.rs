//! Resolved grains of a scene, from which models are built.

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
use trackbed_dem::law::conical_damage;
use trackbed_dem::sheet::SurfaceMesh;
use trackbed_dem::{BodyForce, BodyInput, LocalDamping, Material, Model, ModelInput, Names, TimeStep, Vec3};

/// Resolved grains.
#[derive(Clone)]
pub struct GrainsPart {
    /// Materials and pair overrides.
    pub materials: MaterialsPart,
    /// Groups with all grains.
    pub groups: GroupsPart,
    /// Bonds between grains.
    pub bonds: BondPart,
    /// Walls.
    pub walls: WallsPart,
    /// Contact surface of the solid.
    pub surface: SurfacePlan,
    /// Acceleration of gravity [m/s²].
    pub gravity: Vec3,
    /// Wind during the main stage.
    pub wind: Option<BodyForce>,
    /// Water, in all stages.
    pub water: Option<BodyForce>,
    /// DEM time stepping.
    pub steps: StepPlan,
    /// Periodic borders.
    pub periodic: Borders,
    /// Stages before the main stage.
    pub packing: PackingPlan,
    /// Measurement boxes.
    pub measures: Vec<MeasurePlan>,
    /// Runout measurement.
    pub runout: Option<RunoutPlan>,
    /// Specimen between platens.
    pub specimen: Option<SpecimenPlan>,
    /// Acoustic event clustering.
    pub events: Option<EventPlan>,
    /// Structures with recorded loads.
    pub structures: Vec<StructurePlan>,
    /// Sleepers, rail and load.
    pub track: TrackPart,
    /// Inlets and outlets.
    pub flow: Option<FlowPlan>,
}

/// Contact surface of the solid.
#[derive(Clone, Debug)]
pub struct SurfacePlan {
    /// DEM material of the ground.
    pub ground: Option<usize>,
    /// First meshed sleeper face, material.
    pub sleepers: Option<(u32, usize)>,
    /// Ground surface as triangles, for polyhedra.
    pub mesh: Option<Arc<SurfaceMesh>>,
}

/// Packing stages before the main stage.
#[derive(Clone, Default)]
pub struct PackingPlan {
    /// Deposition.
    pub deposition: Option<DepositionPlan>,
    /// Compaction of the deposited bed.
    pub compaction: Vec<CompactionPlan>,
}

fn soften(input: &mut ModelInput, factor: f64) {
    for material in &mut input.materials {
        material.stiffness *= factor;
        material.young = material.young.map(|young| young * factor);
        // Corners crush at true forces, proportional to strength³/modulus².
        material.corner_strength *= libm::cbrt(factor * factor);
        // Crushing must dissipate energy.
        if let Some(young) = material.young.filter(|_| material.corner_strength.is_finite()) {
            let modulus = 0.5 * young / (1.0 - material.poisson * material.poisson);
            let greatest = conical_damage::greatest_strength(modulus, material.corner_angle);
            if material.corner_strength >= greatest {
                material.corner_strength = 0.99 * greatest;
            }
        }
    }
    for pair in &mut input.contacts {
        pair.stiffness = pair.stiffness.map(|stiffness| stiffness * factor);
    }
}

impl GrainsPart {
    /// Returns the body forces of the main stage.
    pub fn body_forces(&self) -> impl Iterator<Item = BodyForce> {
        self.wind.into_iter().chain(self.water)
    }

    /// Whether grains scar a wall.
    pub fn scarred(&self) -> bool {
        self.walls.others.iter().any(|w| w.scarring.is_some())
    }

    /// Returns the deposition model, without sleepers.
    pub fn deposition_input(&self, plan: &DepositionPlan) -> ModelInput {
        let contacts = self.materials.pairs_with(plan.friction);
        let damping = (plan.local_damping > 0.0).then_some(LocalDamping { factor: plan.local_damping });
        // Sleepers are placed later.
        let alone = ModelInput {
            other_surface: None,
            body_forces: self.water.into_iter().collect(),
            ..self.true_input(self.groups.bodies.clone())
        };
        let mut input = ModelInput { contacts, damping, ..alone };
        soften(&mut input, plan.stiffness_factor);
        // Restitution does not matter during deposition.
        if let TimeStep::Measured { longest, collisions, .. } = &mut input.time_step {
            (*longest, *collisions) = (f64::INFINITY, false);
        }
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

    /// Limited by track springs on sleepers.
    fn time_step(&self) -> TimeStep {
        match self.steps.step {
            TimeStep::Measured { share, .. } => {
                TimeStep::Measured { share, longest: self.track.longest_step(), collisions: true }
            }
            fixed => fixed,
        }
    }

    /// Whether grains are packed before the main stage.
    pub fn is_packed(&self) -> bool {
        let PackingPlan { deposition, compaction } = &self.packing;
        deposition.is_some() || !self.groups.growths.is_empty() || !compaction.is_empty()
    }

    /// Returns the main-stage model of bodies of true mass.
    pub fn input(&self, bodies: Vec<BodyInput>) -> ModelInput {
        let mut input = self.true_input(bodies);
        add_inertia(&mut input, self.steps.mass_factor);
        input
    }

    /// Without mass scaling: falling is not quasi-static.
    fn true_input(&self, mut bodies: Vec<BodyInput>) -> ModelInput {
        for moving in &self.groups.moving {
            for body in bodies.iter_mut().filter(|b| b.part == moving.part) {
                (body.velocity, body.fixed) = (moving.velocity, [true; 6]);
            }
        }
        let mut input = ModelInput {
            names: self.names(),
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

    /// Returns the names of groups, walls and materials.
    pub fn names(&self) -> Names {
        Names {
            groups: self.groups.names.clone(),
            planes: self.walls.plane_names.clone(),
            walls: self.walls.names.clone(),
            materials: self.materials.names.clone(),
        }
    }

    /// Returns the material of a body.
    pub fn material(&self, body: &BodyInput) -> Material {
        self.materials.all[body.material]
    }

    /// Returns the number of grain groups, which come first.
    pub fn stone_groups(&self) -> u32 {
        self.groups.names.len() as u32 - u32::from(self.track.rigid_sleeper().is_some())
    }

    /// Returns smallest and largest grain mass [kg].
    pub fn masses_of(&self, model: &Model, material: usize) -> Option<[f64; 2]> {
        let grains = self.stone_groups();
        let own = (0..model.body_count())
            .filter(|&b| model.part(b) < grains && model.material(b) == material)
            .map(|b| model.mass(b));
        let ends = own.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], m| [low.min(m), high.max(m)]);
        (ends[1] > 0.0).then_some(ends)
    }

    /// Moves a plane [m].
    pub fn place_plane(&mut self, plane: usize, point: Vec3) {
        self.walls.planes[plane].point = point;
    }

    /// Sets the first face of meshed sleepers.
    pub fn set_sleeper_faces(&mut self, first: u32) {
        let meshed = self.track.sleeper.as_ref().filter(|s| s.row.meshed);
        self.surface.sleepers = meshed.map(|s| (first, s.material));
    }

    /// Returns a sleeper of true mass above `centre` at height `z` [m].
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

    /// Crushing force π³ σ³ R²/(6 E*²) (Hertz); softening must preserve it.
    #[test]
    fn softening_preserves_crushing_force() {
        let granite =
            Material { young: Some(50e9), corner_strength: 800e6, corner_angle: 1.0, ..Material::RIGID };
        let mut input = ModelInput { materials: vec![granite], ..ModelInput::default() };
        soften(&mut input, 0.02);
        let force = |m: &Material| m.corner_strength.powi(3) / m.young.expect("a modulus").powi(2);
        let soft = &input.materials[0];
        assert_eq!(soft.young, Some(1e9));
        assert!((force(soft) / force(&granite) - 1.0).abs() < 1e-12, "{soft:?}");
        // A strength close to the limit of dissipation stays below it.
        let mut brittle = ModelInput { materials: vec![granite], ..ModelInput::default() };
        brittle.materials[0].corner_angle = 1.4;
        soften(&mut brittle, 0.001);
        let greatest = conical_damage::greatest_strength(0.5 * 50e6, 1.4);
        assert!(
            brittle.materials[0].corner_strength < greatest,
            "{} of {greatest}",
            brittle.materials[0].corner_strength
        );
    }
}
