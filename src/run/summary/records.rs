//! The parts of `summary.json`.

use crate::model::exchange::ContactClass;
use crate::run::events::EventRecord;
use crate::run::system::SolidView;
use serde::{Deserialize, Serialize};
use trackbed_coupling::interface::InterfaceNumbers;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::scheme::{Passes, Scheme};
use trackbed_coupling::stability::Stability;
use trackbed_coupling::track::jump::JumpSummary;
use trackbed_coupling::track::settlement::Fit;
use trackbed_coupling::transfer::TransferAudit;
use trackbed_fem::nonlinear::Statistics;

/// One stage of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name.
    pub name: String,
    /// Wall time [s].
    pub seconds: f64,
    /// Steps of the grains.
    pub grain_steps: u64,
    /// Steps of the solid.
    pub solid_steps: u64,
    /// Windows: stretches of time after which something can be recorded; zero in stages without records.
    pub windows: u64,
}

/// Sizes of the model.
#[derive(Debug, Default, Serialize)]
pub struct ModelRecord {
    /// Nodes of the solid.
    pub nodes: usize,
    /// Elements of the solid.
    pub elements: usize,
    /// Unknowns of the solid.
    pub unknowns: usize,
    /// Bodies (grains and sleeper).
    pub bodies: usize,
    /// Spheres that carry the contacts.
    pub spheres: usize,
    /// Step of the grains [s].
    pub grain_step: Option<f64>,
    /// Limit of that step [s].
    pub grain_step_limit: Option<f64>,
    /// What sets the limit.
    pub grain_step_set_by: Option<String>,
    /// Step of the solid [s].
    pub solid_step: Option<f64>,
    /// Shapes and errors of a reduced solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reduction: Option<trackbed_fem::reduction::Estimate>,
    /// Memory that the solid was predicted to need [bytes].
    pub predicted_memory: Option<u64>,
    /// Mean number of touching partners per grain at the start of the run proper.
    pub coordination: Option<f64>,
}

/// Energy account.
#[derive(Debug, Serialize)]
pub struct EnergyRecord {
    /// Stored energy at the start [J].
    pub start: Stored,
    /// Stored energy at the end [J].
    pub end: Stored,
    /// Work and dissipation [J].
    pub spent: Spent,
    /// Δ stored + dissipated − work [J].
    pub error: f64,
    /// Work of the load [J].
    pub work: f64,
    /// The larger of the sum of all works and losses and the sum of all changes of stored energies, each by its size [J].
    pub turned_over: f64,
    /// |error| over the largest energy turned over so far, or over a floor where that is larger: a thousandth of what springs and
    /// motion hold and 1e-9 of gravity's potential.
    pub relative_error: f64,
    /// Largest |error| at any row of the history [J].
    pub largest_error: f64,
    /// The same of the largest error at any row.
    pub largest_relative_error: f64,
}

/// Momentum account: change of momentum against the impulses of all forces.
#[derive(Debug, Serialize)]
pub struct MomentumRecord {
    /// Largest deviation of linear momentum over the sum of |impulses|.
    pub linear: f64,
    /// Largest deviation of angular momentum about the origin over the sum of |angular impulses|.
    pub angular: f64,
}

/// Bonds between grains at the end.
#[derive(Debug, Serialize)]
pub struct BondSummary {
    /// Bonds at the start of the run proper.
    pub made: usize,
    /// Broken by tension and bending.
    pub broken_by_tension: u64,
    /// Broken by shear and twisting.
    pub broken_by_shear: u64,
    /// Energy set free by breaks [J].
    pub energy_of_breaks: f64,
    /// Pieces, unbonded bodies among them.
    pub fragments: usize,
    /// Bodies of the largest piece.
    pub largest_fragment: u32,
    /// Acoustic events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events: Option<EventRecord>,
    /// Sieve curves of the bonded stones before and after.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub breakage: Option<BreakageRecord>,
}

/// Breakage of bonded stones by their sieve curves.
#[derive(Debug, Serialize)]
pub struct BreakageRecord {
    /// Marsal's index: what sieves hold back less than before, as a share of the mass.
    pub marsal: f64,
    /// Ballast breakage index of Indraratna, Lackenby & Christie; absent where it is not defined.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ballast_index: Option<f64>,
    /// Sieves [m].
    pub sieves: Vec<f64>,
    /// Share of the mass that passed each at the start.
    pub passing_before: Vec<f64>,
    /// Share that passes at the end.
    pub passing_after: Vec<f64>,
}

/// Interface audit.
#[derive(Debug, Serialize)]
pub struct CouplingRecord {
    /// Largest relative errors of force and moment over all exchanges.
    pub transfer: TransferAudit,
    /// Order of the exchange.
    pub scheme: Scheme,
    /// Steps of the grains per step of the solid.
    pub substeps: u32,
    /// Implicitness of the solid's step.
    pub theta: f64,
    /// Largest numbers of the interface that the run has met, in the windows they were met in.
    pub interface: InterfaceNumbers,
    /// Parts that windows were divided into, 1 without.
    pub division: u32,
    /// Stability of the exchange: the largest numbers of all classes of contacts.
    pub stability: Stability,
    /// Every class of contacts with its numbers and limits.
    pub classes: Vec<ContactClass>,
    /// Windows, and how often they were repeated.
    pub passes: Passes,
    /// Interface work seen by grains plus that seen by the solid [J], which should vanish.
    pub interface_work_error: f64,
    /// How contact forces are transferred.
    pub transfer_kind: String,
}

/// Static equilibrium.
#[derive(Debug, Serialize)]
pub struct StaticsRecord {
    /// Sum of all loads [N].
    pub load: [f64; 3],
    /// Sum of all reactions [N].
    pub reaction: [f64; 3],
    /// |Σ load + Σ reaction| over the sum of their absolute values.
    pub equilibrium_error: f64,
    /// Largest displacement [m] and its node number.
    pub largest_displacement: (f64, u32),
    /// Strain energy [J].
    pub strain_energy: f64,
}

/// How far a solid has yielded at the end.
#[derive(Debug, Serialize)]
pub struct PlasticRecord {
    /// Share of the Gauss points with plastic strain.
    pub yielded_share: f64,
    /// Largest equivalent plastic strain at a Gauss point.
    pub largest_plastic_strain: f64,
    /// Number of the element that it is in.
    pub element: u32,
    /// Middle of that element [m].
    pub place: [f64; 3],
}

impl PlasticRecord {
    /// Of a solid; none of one that cannot yield.
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

/// How equilibrium was found in a plastic solid.
#[derive(Debug, Serialize)]
pub struct NewtonRecord {
    /// Steps accepted.
    pub steps: u64,
    /// Steps given up and halved.
    pub halvings: u64,
    /// Iterations in all.
    pub iterations: u64,
    /// Factorizations of a symmetric matrix.
    pub factorizations_symmetric: u64,
    /// Factorizations of an unsymmetric matrix.
    pub factorizations_unsymmetric: u64,
    /// Seconds in stresses and matrices.
    pub assembly_seconds: f64,
    /// Seconds in factorizations.
    pub factor_seconds: f64,
    /// Seconds in solves.
    pub solve_seconds: f64,
}

impl NewtonRecord {
    /// Of the counts of a solver.
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

/// Sum of the reactions of a named support.
#[derive(Debug, Serialize)]
pub struct ReactionRecord {
    /// Name.
    pub name: String,
    /// Force of the support on the solid [N].
    pub force: [f64; 3],
}

/// Search for the factor of safety.
#[derive(Debug, Serialize)]
pub struct SafetyRecord {
    /// Largest factor at which the solid found equilibrium.
    pub stands_at: f64,
    /// Smallest factor at which it did not.
    pub fails_at: f64,
    /// Every factor tried.
    pub trials: Vec<TrialRecord>,
}

/// One factor tried.
#[derive(Debug, Serialize)]
pub struct TrialRecord {
    /// Factor by which the strength was divided.
    pub factor: f64,
    /// Whether equilibrium was found.
    pub stands: bool,
    /// Share of the load that was carried.
    pub share_of_load: f64,
    /// Newton iterations.
    pub iterations: u64,
    /// Largest displacement reached [m].
    pub largest_displacement: f64,
}

/// Settlement under a cyclic load.
#[derive(Debug, Serialize)]
pub struct SettlementRecord {
    /// Settlement of the sleeper by the pulses that seat it, which the other figures leave out [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seating: Option<f64>,
    /// Settlement of the sleeper after each cycle [m].
    pub per_cycle: Vec<f64>,
    /// Increase of settlement in each cycle [m].
    pub increments: Vec<f64>,
    /// Mean increment of the second half of the cycles over that of the first half.
    pub slowing: Option<f64>,
    /// Settlement laws fitted to the cycles from the tenth on.
    pub fits: Vec<Fit>,
    /// Slope of the loading branch between two loads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bed_stiffness: Option<BedStiffness>,
    /// Cycle jumps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jump: Option<JumpSummary>,
}

/// Stiffness of the bed under a sleeper.
#[derive(Debug, Serialize)]
pub struct BedStiffness {
    /// The two loads [N].
    pub between: [f64; 2],
    /// In the last cycle [N/m].
    pub last: f64,
    /// Mean of the last ten cycles [N/m].
    pub mean_of_last_ten: f64,
}

/// The level load on a structure over a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct LoadRecord {
    /// Name of the structure.
    pub name: String,
    /// Largest level load at any row of the history [N], and when [s].
    pub largest: f64,
    pub time: f64,
    /// Mean level load over the rows, as a vector [N].
    pub mean: [f64; 2],
    /// Largest load of each sector, towards the axis [N].
    pub sectors: Vec<f64>,
    /// Rows so far.
    pub rows: u64,
    /// Motion, of one that moves by the forces on it. Written also where there is none: checkpoints hold the record, field by field.
    #[serde(default)]
    pub motion: Option<MotionRecord>,
}

/// The level motion of a structure over a run, at the rows of the history.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct MotionRecord {
    /// Largest displacement from the start [m].
    pub largest_displacement: f64,
    /// Mean displacement, as a vector [m].
    pub mean_displacement: [f64; 2],
    /// Largest acceleration [m/s²].
    pub largest_acceleration: f64,
    /// Root of the mean square of the acceleration [m/s²].
    pub rms_acceleration: f64,
}
