//! Inflow and outflow for summary and report.

use serde::{Deserialize, Serialize};

/// Number and mass of grains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Amount {
    /// Number.
    pub grains: u64,
    /// Mass [kg].
    pub mass: f64,
}

impl Amount {
    pub(super) fn add(&mut self, mass: f64) {
        self.grains += 1;
        self.mass += mass;
    }
}

/// Inflow and outflow of grains.
#[derive(Debug, Serialize)]
pub struct FlowRecord {
    /// Check interval [s].
    pub interval: f64,
    /// Initial grains of the main stage.
    pub at_start: Amount,
    /// Grains at the end.
    pub at_end: Amount,
    /// Inserted grains.
    pub came_in: Amount,
    /// Removed grains, counted on each removal.
    pub went_out: Amount,
    /// Net inflow of kinetic, gravitational (zero at the origin) and elastic energy [J], counted as wall
    /// work.
    pub energy_in: f64,
    /// Mean inflow rate [kg/s].
    pub mean_rate_in: f64,
    /// Mean outflow rate [kg/s].
    pub mean_rate_out: f64,
    /// Mean inflow rate, second half [kg/s].
    pub later_rate_in: f64,
    /// Mean outflow rate, second half [kg/s].
    pub later_rate_out: f64,
    /// Inlets.
    pub inlets: Vec<InletRecord>,
    /// Outlets.
    pub outlets: Vec<OutletRecord>,
}

/// Inlet.
#[derive(Debug, Serialize)]
pub struct InletRecord {
    /// Group name.
    pub group: String,
    /// Inserted amount.
    pub amount: Amount,
    /// Unit of `requested` and `owed`: `"kg"` or `"grains"`.
    pub unit: &'static str,
    /// Requested amount.
    #[serde(rename = "asked")]
    pub requested: f64,
    /// Backlog.
    pub owed: f64,
    /// Queued grains.
    pub waiting: usize,
    /// Checks without a free position.
    pub without_room: u64,
    /// Checks with an empty queue.
    pub without_grains: u64,
}

/// Outlet.
#[derive(Debug, Serialize)]
pub struct OutletRecord {
    /// Name.
    pub name: String,
    /// Removed amount.
    pub amount: Amount,
    /// Grains that crossed it between checks.
    pub missed: u64,
}

impl InletRecord {
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
    /// Formats report lines.
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
