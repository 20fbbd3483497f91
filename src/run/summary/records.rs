//! Parts of `summary.json`.

use crate::events::EventRecord;
use crate::hash::Hash;
use crate::hazard::HazardRecord;
use crate::system::SolidView;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_coupling::interface_stability::InterfaceStabilityNumbers;
use trackbed_coupling::scheme::{IterationStats, Scheme};
use trackbed_coupling::stability::ContactStabilityNumbers;
use trackbed_coupling::transfer::TransferAudit;
use trackbed_fem::nonlinear::Statistics;
use trackbed_fem::{Law, Material};
use trackbed_input::model::exchange::ContactClass;
use trackbed_input::model::solid::SolidPart;
use trackbed_track::cycle_jump::JumpSummary;
use trackbed_track::settlement::Fit;

/// Stage of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name.
    pub name: String,
    /// Wall time [s].
    pub seconds: f64,
    /// DEM steps.
    pub grain_steps: u64,
    /// FEM steps.
    pub solid_steps: u64,
    /// Windows; zero in stages without records.
    pub windows: u64,
}

/// Sizes of the model.
#[derive(Debug, Default, Serialize)]
pub struct ModelRecord {
    /// Nodes.
    pub nodes: usize,
    /// Elements.
    pub elements: usize,
    /// Unknowns.
    pub unknowns: usize,
    /// Grains and sleepers.
    pub bodies: usize,
    /// Spheres in contact detection.
    pub spheres: usize,
    /// DEM time step [s].
    pub grain_step: Option<f64>,
    /// Critical DEM time step [s].
    pub grain_step_limit: Option<f64>,
    /// Origin of the limit.
    pub grain_step_set_by: Option<String>,
    /// FEM time step [s].
    pub solid_step: Option<f64>,
    /// Reduction of the solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<trackbed_fem::reduction::Estimate>,
    /// Predicted memory of the solid [bytes].
    pub predicted_memory: Option<u64>,
    /// Initial mean coordination number.
    pub coordination: Option<f64>,
}

/// Energy balance.
#[derive(Debug, Serialize)]
pub struct EnergyRecord {
    /// Initial stored energy [J].
    pub start: StoredEnergy,
    /// Final stored energy [J].
    pub end: StoredEnergy,
    /// Work and dissipation [J].
    pub flows: WorkAndDissipation,
    /// Δ stored + dissipated − work [J].
    pub error: f64,
    /// Load work [J].
    pub work: f64,
    /// Reference energy [J]: the larger of Σ|work| + Σ|dissipation| and Σ|Δ stored energy|.
    pub reference_energy: f64,
    /// Relative energy error: |error| over largest reference energy, at least a thousandth of elastic and
    /// kinetic plus 1e-9 of gravitational energy.
    pub relative_error: f64,
    /// Largest |error| at any history row [J].
    pub largest_error: f64,
    /// Largest relative error at any row.
    pub largest_relative_error: f64,
}

/// Momentum balance against impulses of all forces.
#[derive(Debug, Serialize)]
pub struct MomentumRecord {
    /// Largest linear momentum error over Σ|impulse|.
    pub linear: f64,
    /// Largest angular momentum error over Σ|angular impulse|.
    pub angular: f64,
}

/// Final bonds.
#[derive(Debug, Serialize)]
pub struct BondSummary {
    /// Initial bonds of the main stage.
    pub made: usize,
    /// Tension and bending breaks.
    pub broken_by_tension: u64,
    /// Shear and twisting breaks.
    pub broken_by_shear: u64,
    /// Energy released by breaks [J].
    pub energy_of_breaks: f64,
    /// Fragments, with single bodies.
    pub fragments: usize,
    /// Bodies of the largest fragment.
    pub largest_fragment: u32,
    /// Acoustic events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events: Option<EventRecord>,
    /// Sieve curves of bonded grains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub breakage: Option<BreakageRecord>,
}

/// Breakage of bonded grains by sieve curves.
#[derive(Debug, Serialize)]
pub struct BreakageRecord {
    /// Marsal's index.
    pub marsal: f64,
    /// Ballast breakage index (Indraratna, Lackenby & Christie).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ballast_index: Option<f64>,
    /// Sieves [m].
    pub sieves: Vec<f64>,
    /// Initial mass fraction passing.
    pub passing_before: Vec<f64>,
    /// Final mass fraction passing.
    pub passing_after: Vec<f64>,
}

/// Interface record.
#[derive(Debug, Serialize)]
pub struct CouplingRecord {
    /// Largest relative load transfer errors.
    pub transfer: TransferAudit,
    /// Coupling scheme.
    pub scheme: Scheme,
    /// DEM sub-steps per FEM step.
    pub substeps: u32,
    /// Implicitness θ.
    pub theta: f64,
    /// Largest interface numbers in their windows.
    pub interface: InterfaceStabilityNumbers,
    /// Window division, 1 without.
    pub division: u32,
    /// Largest stability numbers of all contact classes.
    pub stability: ContactStabilityNumbers,
    /// Contact classes with numbers and limits.
    pub classes: Vec<ContactClass>,
    /// Windows and repetitions.
    pub passes: IterationStats,
    /// Interface work on grains plus solid [J], ideally zero.
    pub interface_work_error: f64,
    /// Load transfer method.
    pub transfer_kind: String,
    /// Errors of a reduced solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<ReductionRecord>,
}

/// Largest errors of a reduced solid, found at frames: static answers to its unbalanced forces.
#[derive(Debug, Serialize)]
pub struct ReductionRecord {
    /// Windows examined.
    pub windows: u64,
    /// Of a displacement, over the largest displacement since the start.
    pub displacement: f64,
    /// Of the stress, over the largest stress since the start, in the energy norm.
    pub stress: f64,
}

impl From<&trackbed_fem::reduction::FoundError> for ReductionRecord {
    fn from(found: &trackbed_fem::reduction::FoundError) -> ReductionRecord {
        ReductionRecord {
            windows: found.steps,
            displacement: found.of_displacement(),
            stress: found.of_stress(),
        }
    }
}

/// Static equilibrium.
#[derive(Debug, Serialize)]
pub struct StaticsRecord {
    /// Sum of all loads [N].
    pub load: [f64; 3],
    /// Sum of all reactions [N].
    pub reaction: [f64; 3],
    /// |Σ load + Σ reaction| over the sum of sizes.
    pub equilibrium_error: f64,
    /// Largest displacement [m] and node number.
    pub largest_displacement: (f64, u32),
    /// Strain energy [J].
    pub strain_energy: f64,
}

/// Final plastic state.
#[derive(Debug, Serialize)]
pub struct PlasticRecord {
    /// Fraction of Gauss points with plastic strain.
    pub yielded_share: f64,
    /// Largest equivalent plastic strain at Gauss points.
    pub largest_plastic_strain: f64,
    /// Its element number.
    pub element: u32,
    /// Element centre [m].
    pub place: [f64; 3],
}

impl PlasticRecord {
    /// Evaluates a solid; none if elastic.
    pub fn of(view: SolidView<'_>) -> Option<PlasticRecord> {
        let SolidView { model, state } = view;
        if model.is_linear() || state.points.is_empty() {
            return None;
        }
        let kappa = |p: usize| state.points[p].kappa;
        let count = state.points.len();
        let yielded = (0..count).filter(|p| kappa(*p) > 0.0).count();
        let worst = (0..count).max_by(|a, b| kappa(*a).total_cmp(&kappa(*b)))?;
        let mesh = model.mesh();
        let element = (0..mesh.element_count()).rfind(|e| model.point_start(*e) <= worst)?;
        let nodes = &mesh.connectivity[element];
        let mean = |d: usize| {
            nodes.iter().map(|n| mesh.coordinates[*n as usize][d]).sum::<f64>() / nodes.len() as f64
        };
        Some(PlasticRecord {
            yielded_share: yielded as f64 / count as f64,
            largest_plastic_strain: kappa(worst),
            element: mesh.element_ids[element],
            place: [mean(0), mean(1), mean(2)],
        })
    }
}

/// Newton statistics of a plastic solid.
#[derive(Debug, Serialize)]
pub struct NewtonRecord {
    /// Accepted steps.
    pub steps: u64,
    /// Halved steps.
    pub halvings: u64,
    /// Iterations.
    pub iterations: u64,
    /// Symmetric factorizations.
    pub factorizations_symmetric: u64,
    /// Unsymmetric factorizations.
    pub factorizations_unsymmetric: u64,
    /// Assembly time [s].
    pub assembly_seconds: f64,
    /// Factorization time [s].
    pub factor_seconds: f64,
    /// Solve time [s].
    pub solve_seconds: f64,
}

impl NewtonRecord {
    /// Converts solver statistics.
    pub fn of(s: &Statistics) -> NewtonRecord {
        NewtonRecord {
            steps: s.steps,
            halvings: s.halvings,
            iterations: s.iterations,
            factorizations_symmetric: s.factorizations_symmetric,
            factorizations_unsymmetric: s.factorizations_unsymmetric,
            assembly_seconds: s.assembly_seconds,
            factor_seconds: s.factor_seconds,
            solve_seconds: s.solve_seconds,
        }
    }
}

/// Reaction of a named support.
#[derive(Debug, Serialize)]
pub struct ReactionRecord {
    /// Name.
    pub name: String,
    /// Support force on the solid [N].
    pub force: [f64; 3],
}

/// Library of a user material.
#[derive(Debug, Serialize)]
pub struct LibraryRecord {
    /// Material.
    pub material: String,
    /// Absolute path.
    pub path: PathBuf,
    /// 64-bit FNV-1a hash of the file.
    pub hash: String,
    /// Symbol of the routine.
    pub routine: String,
}

impl LibraryRecord {
    /// Libraries of a solid, by material number.
    pub fn of(solid: &SolidPart) -> Vec<LibraryRecord> {
        let record = |(number, material): (&u32, &Material)| {
            let Law::UserMaterial(law) = &material.law else { return None };
            let (path, routine) = (law.routine().path().to_path_buf(), law.routine().name().into());
            let material = solid.material_names.get(number).cloned().unwrap_or_default();
            Some(LibraryRecord { material, hash: Hash::of_file(&path), path, routine })
        };
        solid.model.materials().iter().filter_map(record).collect()
    }
}

/// Factor of safety search.
#[derive(Debug, Serialize)]
pub struct SafetyRecord {
    /// Largest stable factor.
    pub stable_at: f64,
    /// Smallest unstable factor.
    pub unstable_at: f64,
    /// Trials.
    pub trials: Vec<TrialRecord>,
}

/// Trial factor.
#[derive(Debug, Serialize)]
pub struct TrialRecord {
    /// Strength reduction factor.
    pub factor: f64,
    /// Whether equilibrium was reached.
    pub stands: bool,
    /// Fraction of the load applied.
    pub share_of_load: f64,
    /// Newton iterations.
    pub iterations: u64,
    /// Largest displacement [m].
    pub largest_displacement: f64,
}

/// Settlement under a cyclic load.
#[derive(Debug, Serialize)]
pub struct SettlementRecord {
    /// Seating settlement, excluded below [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seating: Option<f64>,
    /// Settlement after each cycle [m].
    pub per_cycle: Vec<f64>,
    /// Settlement increment per cycle [m].
    pub increments: Vec<f64>,
    /// Mean increment, second over first half of cycles.
    pub slowing: Option<f64>,
    /// Settlement laws fitted from cycle ten.
    pub fits: Vec<Fit>,
    /// Bed stiffness on loading between two loads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bed_stiffness: Option<BedStiffness>,
    /// Cycle jumps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jump: Option<JumpSummary>,
}

/// Bed stiffness under a sleeper.
#[derive(Debug, Serialize)]
pub struct BedStiffness {
    /// Loads [N].
    pub between: [f64; 2],
    /// Last cycle [N/m].
    pub last: f64,
    /// Mean of ten cycles [N/m].
    pub mean_of_last_ten: f64,
}

/// Horizontal load on a structure.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LoadRecord {
    /// Structure name.
    pub name: String,
    /// Largest horizontal load [N], and time [s].
    pub largest: f64,
    pub time: f64,
    /// Mean horizontal load vector [N].
    pub mean: [f64; 2],
    /// Largest and mean load towards the axis per sector [N].
    pub sectors: Vec<f64>,
    pub mean_sectors: Vec<f64>,
    /// Largest and mean horizontal load per layer, from below [N].
    pub layers: Vec<f64>,
    pub mean_layers: Vec<f64>,
    /// Number of rows.
    pub rows: u64,
    /// Motion, if it moves. Always written: fields are unnamed.
    #[serde(default)]
    pub motion: Option<MotionRecord>,
    /// Statistics at the end of the run, if the scene has them.
    #[serde(default)]
    pub hazard: Option<HazardRecord>,
}

/// Floating wall at history rows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct FloatingRecord {
    /// Wall name.
    pub name: String,
    /// Number of rows.
    pub rows: u64,
    /// Displacement of the centre [m], and roll, pitch, heading at the end [rad].
    pub travel: [f64; 3],
    pub rotation: [f64; 3],
    /// Mean horizontal speed [m/s].
    pub mean_speed: f64,
    /// Mean force of grains and walls, and of the water without thrust, rudder and added mass [N].
    pub mean_contact_force: [f64; 3],
    pub mean_water_force: [f64; 3],
    /// Thrust and rudder, if it has them. Always written: fields are unnamed.
    #[serde(default)]
    pub propulsion: Option<PropulsionRecord>,
}

/// Thrust and rudder at history rows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct PropulsionRecord {
    /// Mean requested and applied thrust [N].
    pub mean_requested: f64,
    pub mean_applied: f64,
    /// Largest rudder angle, either way [rad].
    pub largest_rudder_angle: f64,
    /// Largest force on the rudder [N].
    pub largest_rudder_force: f64,
}

/// Horizontal motion at history rows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct MotionRecord {
    /// Largest displacement [m].
    pub largest_displacement: f64,
    /// Mean displacement vector [m].
    pub mean_displacement: [f64; 2],
    /// Largest acceleration [m/s²].
    pub largest_acceleration: f64,
    /// RMS acceleration [m/s²].
    pub rms_acceleration: f64,
}
