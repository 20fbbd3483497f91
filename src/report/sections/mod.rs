//! Report sections in page order.

mod accounts;
mod bonds;
mod compare;
mod flow;
mod gradation;
mod laws;
mod loads;
mod loops;
mod overlay;
mod overview;
mod packing;
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

/// Returns all sections with data.
pub fn all(runs: &[RunData]) -> Vec<Section> {
    let sections: [Make; 23] = [
        verdict::verdict,
        compare::compare,
        overview::overview,
        settlement::settlement,
        loops::loops,
        track::pressure,
        track::sleepers,
        track::push,
        walls::walls,
        loads::loads,
        packing::packing,
        gradation::gradation,
        flow::flow,
        slopes::runout,
        slopes::specimen,
        bonds::bonds,
        solid::solid,
        solid::safety,
        solid::modes,
        accounts::energy,
        steps::steps,
        steps::timings,
        reproduce::reproduce,
    ];
    sections.iter().filter_map(|section| section(runs)).collect()
}
