//! Report sections in page order.

mod accounts;
mod bonds;
mod compare;
mod flow;
mod gradation;
mod hazard;
mod laws;
mod loads;
mod loops;
mod overlay;
mod overview;
mod packing;
mod picture;
mod profiles;
mod reproduce;
mod settlement;
mod slopes;
mod solid;
mod steps;
mod track;
mod verdict;
mod walls;

use super::data::RunData;
use super::page::Section;

type Make = fn(&[RunData]) -> Option<Section>;

/// Returns all sections with data; `axle_load` of a cycle [t].
pub fn all(runs: &[RunData], axle_load: Option<f64>) -> Vec<Section> {
    let sections: [Make; 27] = [
        verdict::verdict,
        compare::compare,
        picture::picture,
        overview::overview,
        settlement::settlement,
        loops::loops,
        track::pressure,
        track::sleepers,
        track::push,
        walls::applied,
        walls::walls,
        loads::loads,
        hazard::hazard,
        packing::packing,
        gradation::gradation,
        flow::flow,
        slopes::runout,
        slopes::specimen,
        bonds::bonds,
        solid::solid,
        profiles::profiles,
        solid::safety,
        solid::modes,
        accounts::energy,
        steps::steps,
        steps::timings,
        reproduce::reproduce,
    ];
    let mut all: Vec<Section> = sections.iter().filter_map(|section| section(runs)).collect();
    if let Some(section) = axle_load.and_then(|load| settlement::traffic(runs, load)) {
        let after = all.iter().position(|s| s.id == "settlement").map_or(all.len(), |k| k + 1);
        all.insert(after, section);
    }
    all
}
