//! What the grains are like at the end of a run, as it stands in the summary.

use serde::{Deserialize, Serialize};

/// A group after growth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GrowthRecord {
    /// Name of the group.
    pub group: String,
    /// Porosity of its container, overlaps counted once.
    pub porosity: f64,
    /// Largest overlap over the reduced radius of the contact.
    pub largest_overlap: f64,
    /// Mean unbalanced force over mean contact force.
    pub unbalanced_ratio: f64,
}

/// A stage of compaction.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompactionRecord {
    /// What was done.
    pub kind: String,
    /// Porosity of its region before.
    pub porosity_before: f64,
    /// The same after, of the region cut off at a plane that has moved in.
    pub porosity_after: f64,
    /// Force on the plane that has moved [N]. Written even where there is none: checkpoints have no names of fields.
    pub wall_force: Option<f64>,
}

/// The grains at the end of a run; the sleeper is none.
#[derive(Debug, Serialize)]
pub struct PackingRecord {
    /// Mean number of neighbours.
    pub coordination: f64,
    /// The same without the grains that have no or one neighbour, and without their contacts.
    pub mechanical_coordination: f64,
    /// Share of the grains with no or one neighbour.
    pub rattlers: f64,
    /// Number of grains with 0, 1, 2, … neighbours.
    pub neighbours: Vec<usize>,
    /// Mean of n ⊗ n over the contacts of grains with each other: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean normal force of the contacts [N].
    pub mean_contact_force: f64,
    /// Share of the contacts that carry more than the mean.
    pub strong_contacts: f64,
    /// Share of the sum of normal forces that they carry.
    pub strong_load: f64,
    /// Mean unbalanced force over mean contact force; absent without contacts.
    pub unbalanced_ratio: Option<f64>,
    /// Boxes that the scene asks for.
    pub measures: Vec<MeasureRecord>,
    /// Fines in the bed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fouling: Option<FoulingRecord>,
    /// Sieve curves of the groups filled by one.
    pub gradations: Vec<GradationRecord>,
}

/// Fines in the bed (Selig & Waters 1994; Indraratna, Su & Rujikiatkamjorn, Can. Geotech. J. 48, 2011).
#[derive(Debug, Serialize)]
pub struct FoulingRecord {
    /// Mass of the fines over that of all grains: the fouling index with the fines for what passes the sieve of 4.75 mm.
    pub fouling_index: f64,
    /// Solid volume of the fines over that of the other grains: relative ballast fouling ratio.
    pub relative_fouling_ratio: f64,
    /// Name of each measured box, porosity of the other grains alone, and solid volume of the fines over the voids that the
    /// others leave. The void contaminant index is 1 + e_f times the last, e_f the void ratio of the fines.
    pub boxes: Vec<(String, f64, f64)>,
}

/// What a box holds.
#[derive(Debug, Serialize)]
pub struct MeasureRecord {
    /// Its name.
    pub name: String,
    /// Share that no grain fills.
    pub porosity: f64,
    /// Number of grains with their centre inside.
    pub grains: usize,
    /// Their mean number of neighbours, and without those with no or one.
    pub coordination: f64,
    /// The same without rattlers.
    pub mechanical_coordination: f64,
    /// Fabric of the contacts inside: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean stress, voids included [Pa]: xx, yy, zz, xy, yz, zx, tension positive.
    pub stress: [f64; 6],
}

/// How well a group meets its sieve curve.
#[derive(Debug, Serialize)]
pub struct GradationRecord {
    /// Name of the group.
    pub group: String,
    /// Number of stones.
    pub stones: usize,
    /// Sieves [m].
    pub sieves: Vec<f64>,
    /// Mass fraction passing that was asked for.
    pub target: Vec<f64>,
    /// Mass fraction passing that the stones have.
    pub achieved: Vec<f64>,
    /// Largest |achieved − target| over all sizes, not the sieves alone.
    pub largest_deviation: f64,
}
