//! Final packing and its files: `gradation.csv`, `gradation.svg`, `radial.csv`, `packing.csv`.

mod bed_stage;
mod files;
mod records;
mod report;
mod sieves;
mod stage_energy;

pub use bed_stage::BedStage;
pub use records::{
    CompactionRecord, FoulingRecord, GrownOverlap, GrowthRecord, MeasureRecord, PackingRecord, TampingRecord,
};
pub(super) use report::report;
pub use stage_energy::StageEnergy;

use super::system::GrainsView;
use super::validity::{BedExtent, Check, measure_box};
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::measure::{self, BoxRegion, ContactRecord};
use trackbed_input::model::Job;
use trackbed_input::model::grains::{GrainsPart, MeasurePlan};
use trackbed_io::failure::Failure;

/// Measures the final grains.
///
/// # Errors
/// I/O errors.
pub fn record(
    job: &Job,
    dir: &Path,
    view: GrainsView<'_>,
    grains: &GrainsPart,
) -> Result<PackingRecord, Failure> {
    let GrainsView { model, state } = view;
    let is_grain = grain_of(view, grains);
    let contacts = measure::contacts(model, state);
    let stress = measure::mean_stress_of(model, state, &contacts);
    let all = measure::coordination_of(model, state, &contacts, is_grain);
    let strong = measure::strong_network(&contacts);
    let ratio = measure::unbalanced_ratio(model, state, &contacts);
    let between = |c: &ContactRecord| matches!(c.b, dem::Partner::Body(b) if is_grain(b)) && is_grain(c.a);
    let measures = grains.measures.iter().map(|MeasurePlan { name, region, .. }| {
        let inside = |b: usize| is_grain(b) && region.holds(&model.wrap(&state.position(b)));
        let own = measure::coordination_of(model, state, &contacts, inside);
        MeasureRecord {
            name: name.clone(),
            porosity: porosity(view, region, is_grain),
            grains: (0..model.body_count()).filter(|&b| inside(b)).count(),
            coordination: own.mean,
            mechanical_coordination: own.mechanical,
            fabric: measure::fabric(&contacts, |c| between(c) && region.holds(&c.point)),
            stress: measure::region_stress(model, state, &stress, region),
        }
    });
    let gradations = grains.groups.graded.iter().map(|g| sieves::graded(view, g)).collect::<Vec<_>>();
    if !gradations.is_empty() {
        sieves::write(dir, &job.title, view, &grains.groups.graded)?;
    }
    if grains.measures.iter().any(|m| m.radial.is_some()) {
        files::write_radial(dir, view, &grains.measures, is_grain)?;
    }
    if job.output.packing {
        files::write_packings(dir, view, grains)?;
    }
    Ok(PackingRecord {
        coordination: all.mean,
        mechanical_coordination: all.mechanical,
        rattlers: all.rattlers,
        neighbours: all.distribution,
        fabric: measure::fabric(&contacts, between),
        mean_contact_force: strong.mean_force,
        strong_contacts: strong.contacts,
        strong_load: strong.load,
        unbalanced_ratio: ratio.is_finite().then_some(ratio),
        measures: measures.collect(),
        fouling: fouling(view, grains, is_grain),
        gradations,
    })
}

/// Box with columns in `history.csv`.
pub struct Measured<'a> {
    /// Name.
    pub name: &'a str,
    /// Porosity.
    pub porosity: f64,
    /// Mean coordination number.
    pub coordination: f64,
    /// Mean stress [Pa], tension positive.
    pub mean_stress: f64,
}

/// Measures the boxes with `history`, as [`record`] does at the end.
pub fn measured<'a>(view: GrainsView<'_>, grains: &'a GrainsPart) -> Vec<Measured<'a>> {
    if grains.measures.iter().all(|m| !m.history) {
        return Vec::new();
    }
    let GrainsView { model, state } = view;
    let is_grain = grain_of(view, grains);
    let contacts = measure::contacts(model, state);
    let stress = measure::mean_stress_of(model, state, &contacts);
    let of_box = |MeasurePlan { name, region, .. }: &'a MeasurePlan| {
        let inside = |b: usize| is_grain(b) && region.holds(&model.wrap(&state.position(b)));
        let [xx, yy, zz, ..] = measure::region_stress(model, state, &stress, region);
        Measured {
            name,
            porosity: porosity(view, region, is_grain),
            coordination: measure::coordination_of(model, state, &contacts, inside).mean,
            mean_stress: (xx + yy + zz) / 3.0,
        }
    };
    grains.measures.iter().filter(|m| m.history).map(of_box).collect()
}

/// Present, and no sleepers.
fn grain_of<'a>(view: GrainsView<'a>, grains: &GrainsPart) -> impl Fn(usize) -> bool + Copy + 'a {
    let sleeper = grains.track.rigid_sleeper().map(|_| grains.groups.names.len() as u32 - 1);
    move |b: usize| view.state.present(b) && Some(view.model.part(b)) != sleeper
}

/// Checks that the bed fills the measurement boxes.
pub fn checks(view: GrainsView<'_>, grains: &GrainsPart) -> Vec<Check> {
    if grains.measures.is_empty() {
        return Vec::new();
    }
    let is_grain = grain_of(view, grains);
    let boxes = grains.measures.iter();
    let above = boxes.clone().filter_map(|m| measure_box(&m.name, view, &m.region, is_grain));
    let bed = BedExtent::of(view, grains, is_grain);
    let sides = boxes.filter_map(|m| Some(bed?.check(&m.name, &m.region)));
    above.chain(sides).collect()
}

fn fouling(
    view: GrainsView<'_>,
    grains: &GrainsPart,
    is_grain: impl Fn(usize) -> bool,
) -> Option<FoulingRecord> {
    if grains.groups.fouling.is_empty() {
        return None;
    }
    let model = view.model;
    let fine = |b: usize| grains.groups.fouling.contains(&model.part(b));
    let sum = |of: fn(&dem::Model, usize) -> f64, fines: bool| -> f64 {
        (0..model.body_count()).filter(|&b| is_grain(b) && fine(b) == fines).map(|b| of(model, b)).sum()
    };
    let [stones, fines] = [false, true].map(|f| sum(dem::Model::mass, f));
    let boxes = grains.measures.iter().map(|MeasurePlan { name, region, .. }| {
        let skeleton = porosity(view, region, |b| is_grain(b) && !fine(b));
        let both = porosity(view, region, &is_grain);
        let share = if skeleton > 0.0 { (skeleton - both) / skeleton } else { 0.0 };
        (name.clone(), skeleton, share)
    });
    Some(FoulingRecord {
        fouling_index: share_of(fines, stones + fines),
        relative_fouling_ratio: share_of(sum(dem::Model::volume, true), sum(dem::Model::volume, false)),
        boxes: boxes.collect(),
    })
}

fn share_of(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

fn porosity(view: GrainsView<'_>, region: &BoxRegion, is_grain: impl Fn(usize) -> bool) -> f64 {
    let grains = (0..view.model.body_count()).filter(|&b| is_grain(b));
    let solid: f64 = grains.map(|b| measure::body_volume_in(view.model, view.state, b, region)).sum();
    1.0 - solid / region.volume()
}
