//! Summary records of the final packing.

use crate::validity::{Check, Limits};
use serde::{Deserialize, Serialize};
use trackbed_input::model::grains::LARGEST_OVERLAP;

/// Group after growth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GrowthRecord {
    /// Group name.
    pub group: String,
    /// Container porosity, overlaps counted once.
    pub porosity: f64,
    /// Largest overlap over the effective contact radius.
    pub largest_overlap: f64,
    /// Mean unbalanced over mean contact force.
    pub unbalanced_ratio: f64,
}

/// Overlap after growth: large ones eject grains.
const GROWN: Limits = Limits { warn: LARGEST_OVERLAP, fail: Some(0.5) };

/// Deepest contact of the grown grains in the walls of the scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GrownOverlap {
    /// Both partners.
    pub between: String,
    /// Overlap over the smaller radius.
    pub share: f64,
    /// Energy of all contact springs [J].
    pub springs: f64,
}

impl GrownOverlap {
    /// Compares the overlap with the limit of given grains.
    pub fn check(&self) -> Check {
        let GrownOverlap { between, share, springs } = self;
        Check::new("largest overlap after growth over the smaller radius", *share, GROWN, || {
            format!(
                "{between}: overlap {:.0} % of the smaller radius after growth, {springs:.3e} J in contact springs. Grow within the walls, or to a higher porosity.",
                100.0 * share
            )
        })
    }
}

/// Compaction stage.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompactionRecord {
    /// Stage type.
    pub kind: String,
    /// Porosity before.
    pub porosity_before: f64,
    /// Porosity after, cut at a moved plane.
    pub porosity_after: f64,
    /// Force on the moved plane [N]. Always written: fields are unnamed.
    pub wall_force: Option<f64>,
}

/// Tamping of a sleeper. Always written in full: fields are unnamed in checkpoints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TampingRecord {
    /// Number of the sleeper, from 1.
    pub sleeper: usize,
    /// Largest upward force on a blade during insertion, mean of a period of vibration [N].
    pub insertion_force: f64,
    /// Largest force of a blade towards the sleeper, mean of a period of vibration [N].
    pub squeeze_force: f64,
    /// Mean way of the blades towards the sleeper [m].
    pub travel: f64,
    /// Work of the blades on the grains [J].
    pub work: f64,
    /// Rise of the sleeper, after release [m].
    pub raised: f64,
}

/// Final grains, without sleepers.
#[derive(Debug, Serialize)]
pub struct PackingRecord {
    /// Mean coordination number.
    pub coordination: f64,
    /// Mean coordination number without rattlers.
    pub mechanical_coordination: f64,
    /// Fraction of grains with at most one neighbour.
    pub rattlers: f64,
    /// Number of grains by coordination number.
    pub neighbours: Vec<usize>,
    /// Fabric n ⊗ n of grain contacts: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean normal contact force [N].
    pub mean_contact_force: f64,
    /// Fraction of contacts above the mean force.
    pub strong_contacts: f64,
    /// Fraction of normal force that they bear.
    pub strong_load: f64,
    /// Mean unbalanced over mean contact force.
    pub unbalanced_ratio: Option<f64>,
    /// Measurement boxes.
    pub measures: Vec<MeasureRecord>,
    /// Fouling.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fouling: Option<FoulingRecord>,
    /// Sieve curves of graded groups.
    pub gradations: Vec<GradationRecord>,
}

/// Fouling (Selig & Waters 1994; Indraratna, Su & Rujikiatkamjorn, Can. Geotech. J. 48, 2011).
#[derive(Debug, Serialize)]
pub struct FoulingRecord {
    /// Fouling index: mass fraction of fines, if they pass the 4.75 mm sieve.
    pub fouling_index: f64,
    /// Relative ballast fouling ratio: solid volume of fines over other grains.
    pub relative_fouling_ratio: f64,
    /// Name, porosity without fines, solid volume of fines over remaining voids. Void contaminant index: 1 +
    /// e_f times the latter, e_f the void ratio of fines.
    pub boxes: Vec<(String, f64, f64)>,
}

/// Measured box.
#[derive(Debug, Serialize)]
pub struct MeasureRecord {
    /// Name.
    pub name: String,
    /// Porosity.
    pub porosity: f64,
    /// Grains with centre inside.
    pub grains: usize,
    /// Mean coordination number.
    pub coordination: f64,
    /// Without rattlers.
    pub mechanical_coordination: f64,
    /// Fabric: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean stress [Pa]: xx, yy, zz, xy, yz, zx, tension positive.
    pub stress: [f64; 6],
}

/// Sieve curve of a group.
#[derive(Debug, Serialize)]
pub struct GradationRecord {
    /// Group name.
    pub group: String,
    /// Number of grains.
    pub stones: usize,
    /// Sieves [m].
    pub sieves: Vec<f64>,
    /// Target fraction passing by mass.
    pub target: Vec<f64>,
    /// Achieved fraction passing by mass.
    pub achieved: Vec<f64>,
    /// Largest |achieved − target| over all sizes.
    pub largest_deviation: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    #[test]
    fn deep_growth_is_not_passed() {
        let check = |share: f64| {
            let between = "grain 3 of \"g\" and plane 1".to_string();
            GrownOverlap { between, share, springs: 36_331.0 }.check()
        };
        assert_eq!(
            [0.01, 0.2, 0.7].map(|s| check(s).status),
            [Outcome::Passed, Outcome::Warned, Outcome::Failed]
        );
        let message = check(0.67).message;
        assert!(
            message.starts_with(
                "grain 3 of \"g\" and plane 1: overlap 67 % of the smaller radius after growth, 3.633e4 J"
            ),
            "{message}"
        );
    }
}
