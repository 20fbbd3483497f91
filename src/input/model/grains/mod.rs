//! Grains of a scene: materials, shapes, bodies, walls, sleepers.

mod bonds;
mod check;
mod compaction;
mod deposition;
mod flow;
mod footprint;
mod groups;
mod growth;
mod hazard;
mod laws;
mod materials;
mod measure;
mod overlap;
mod own_law;
mod part;
mod periodic;
mod plates;
mod preview;
mod refused;
mod runout;
mod sources;
mod specimen;
mod spread;
mod steps;
mod structures;
mod tines;
mod track;
mod walls;
mod water;
mod wind;

use crate::scene::{Scene, Table};
use check::find;
pub(in crate::model) use check::region;
use steps::StepPlan;
use trackbed_dem::{BodyForce, Vec3};
use trackbed_io::failure::Failure;

pub use bonds::{check_gaps, check_joined};
pub use compaction::{CompactionPlan, Press};
pub use deposition::DepositionPlan;
pub use flow::{FlowPlan, InletPlan, OutletPlan, OutletRegion};
pub use footprint::Footprint;
pub use groups::{FilledGroup, GradedGroup, GroupsPart};
pub use growth::inside_of;
pub use hazard::HazardPlan;
pub use materials::{MaterialsPart, parameters};
pub use measure::{MeasurePlan, RadialPlan};
pub use overlap::{LARGEST_OVERLAP, check_overlaps, deepest_overlap, thrown};
pub use part::{GrainsPart, PackingPlan, SurfacePlan};
pub use preview::{Preview, check_steps, preview, with_sleepers};
pub use refused::refused;
pub use runout::{MOST_CELLS, RunoutPlan};
pub use specimen::{EventPlan, Platen, SpecimenPlan};
pub use structures::StructurePlan;
pub use tines::TinesPlan;
pub use walls::is_plain;
pub use water::of_scene as water_of;

/// Resolves `[[material]]`, `[[contact]]`, `[[grains]]`, `[[walls]]`, `[deposition]` and `[track]`.
///
/// # Errors
/// Input errors.
pub fn build(scene: &Table<Scene>, gravity: [f64; 3]) -> Result<GrainsPart, Failure> {
    let gravity = Vec3::from(gravity);
    let mut materials = materials::build(scene)?;
    let impact_speed = steps::impact_speed(scene, &materials)?;
    let of_coupling = scene.optional("coupling", &scene.coupling);
    let ground = of_coupling.map(|c| find(scene, &c, "material", &c.material)).transpose()?;
    let time = scene.below("time", &scene.time);
    let (step, skin) = (steps::time_step(&time)?, steps::search_skin(&time)?);
    let steps = StepPlan { step, impact_speed, skin, mass_factor: steps::mass_factor(scene)? };
    let mut bonds = bonds::kinds(scene)?;
    let mut groups = groups::build(scene, &mut materials, &mut bonds)?;
    spread::spread(scene, &mut groups, &mut materials)?;
    let periodic = periodic::build(scene, &groups)?;
    let flow = flow::build(scene, &groups, &periodic)?;
    let walls = walls::build(scene)?;
    let deposition = scene.optional("deposition", &scene.deposition);
    let deposition = deposition.map(|d| deposition::build(&d)).transpose()?;
    let settling = deposition.as_ref();
    let compaction = compaction::build(scene, settling, &walls, &mut groups)?;
    let wind = wind::build(scene)?;
    let water = water::build(scene, &gravity)?.map(BodyForce::Water);
    let measures = measure::build(scene)?;
    let runout = runout::build(scene, &groups)?;
    let specimen = specimen::build(scene, &groups, &walls)?;
    let events = specimen::events(scene)?;
    let structures = structures::build(scene, &walls, &groups.names)?;
    bonds::rules(scene, &groups.names, groups.bodies.len(), settling, &mut bonds)?;
    let fixed = match (bonds.is_empty(), periodic.iter().any(Option::is_some)) {
        (false, _) => Some("are bonded"),
        (true, true) => Some("cross a periodic border"),
        (true, false) => None,
    };
    let track = track::build(scene, &gravity, fixed, steps.mass_factor, &mut groups)?;
    periodic::check_sleepers(scene, &track, &periodic)?;
    Ok(GrainsPart {
        materials,
        groups,
        bonds,
        walls,
        surface: SurfacePlan { ground, sleepers: None, mesh: None },
        gravity,
        wind,
        water,
        steps,
        periodic,
        packing: PackingPlan { deposition, compaction },
        measures,
        runout,
        specimen,
        events,
        structures,
        track,
        flow,
    })
}
