//! What came in and went out, for the summary and the report.

use serde::{Deserialize, Serialize};

/// Number and mass [kg] of grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Amount {
    /// Number.
    pub grains: u64,
    /// Mass [kg].
    pub mass: f64,
}

impl Amount {
    /// Adds a grain of a mass [kg].
    pub(super) fn add(&mut self, mass: f64) {
        self.grains += 1;
        self.mass += mass;
    }
}

/// Grains that came and went.
#[derive(Debug, Serialize)]
pub struct FlowRecord {
    /// Time between two looks at inlets and outlets [s].
    pub interval: f64,
    /// Grains at the start of the run proper.
    pub at_start: Amount,
    /// Grains at its end.
    pub at_end: Amount,
    /// Grains that came in.
    pub came_in: Amount,
    /// Grains that were taken out; one that comes and goes again and again counts every time.
    pub went_out: Amount,
    /// Energy that they brought in less what they took out: kinetic, of gravity (zero at the origin) and of springs [J].
    /// The energy account counts it as work of walls.
    pub energy_in: f64,
    /// Mean mass flow in over the whole run [kg/s].
    pub mean_rate_in: f64,
    /// Mean mass flow out over the whole run [kg/s].
    pub mean_rate_out: f64,
    /// The same in its second half, in [kg/s].
    pub later_rate_in: f64,
    /// And out [kg/s].
    pub later_rate_out: f64,
    /// Inlets.
    pub inlets: Vec<InletRecord>,
    /// Outlets.
    pub outlets: Vec<OutletRecord>,
}

/// One inlet.
#[derive(Debug, Serialize)]
pub struct InletRecord {
    /// Its group.
    pub group: String,
    /// What it let in.
    pub amount: Amount,
    /// What `requested` and `owed` count: `"kg"` or `"grains"`.
    pub unit: &'static str,
    /// What its rate requests.
    #[serde(rename = "asked")]
    pub requested: f64,
    /// What of it has not come in.
    pub owed: f64,
    /// Grains that still wait.
    pub waiting: usize,
    /// Looks at which a grain that was due found no room.
    pub without_room: u64,
    /// Looks at which one was due and none waited.
    pub without_grains: u64,
}

/// One outlet.
#[derive(Debug, Serialize)]
pub struct OutletRecord {
    /// Its name.
    pub name: String,
    /// What it took.
    pub amount: Amount,
    /// Grains whose straight way between two looks led through it without their being seen there.
    pub missed: u64,
}

impl InletRecord {
    /// What to say about an inlet that fell behind.
    pub(super) fn remark(&self) -> Option<String> {
        (self.without_room + self.without_grains > 0).then(|| {
            format!(
                "inlet of \"{}\": inserted {:.4} {unit} less than the requested {:.4} {unit}. No free position at {} checks, empty queue at {}.",
                self.group,
                self.owed,
                self.requested,
                self.without_room,
                self.without_grains,
                unit = self.unit,
            )
        })
    }
}

impl OutletRecord {
    /// What to say about grains that were too fast for it.
    pub(super) fn remark(&self, interval: f64) -> Option<String> {
        (self.missed > 0).then(|| {
            format!(
                "outlet \"{1}\": {0} grains may have passed between two checks, {interval:.3e} s apart. Reduce time.flow_interval, or enlarge the box.",
                self.missed, self.name
            )
        })
    }
}

impl FlowRecord {
    /// Lines of the report.
    pub fn report(&self) -> Vec<String> {
        let (a, b) = (&self.came_in, &self.went_out);
        let mut lines = vec![format!(
            "flow: {} grains ({:.4} kg) inserted, {} ({:.4} kg) removed, {} at the start, {} at the end; {:.4} kg/s in and {:.4} kg/s out in the second half",
            a.grains,
            a.mass,
            b.grains,
            b.mass,
            self.at_start.grains,
            self.at_end.grains,
            self.later_rate_in,
            self.later_rate_out
        )];
        for i in &self.inlets {
            lines.push(format!(
                "  inlet of {}: {:.4} of {:.4} {}, {} grains queued",
                i.group,
                i.requested - i.owed,
                i.requested,
                i.unit,
                i.waiting
            ));
        }
        for o in &self.outlets {
            lines.push(format!("  {}: {} grains, {:.4} kg", o.name, o.amount.grains, o.amount.mass));
        }
        lines
    }
}
