//! Inlets and outlets of a run.

use trackbed_dem::Vec3;
use trackbed_dem::measure::BoxRegion;

/// Inlets and outlets of a run.
#[derive(Clone, Debug)]
pub struct FlowPlan {
    /// Check interval [s].
    pub interval: f64,
    /// Inlets, at most one per group.
    pub inlets: Vec<InletPlan>,
    /// Outlets, in order of priority.
    pub outlets: Vec<OutletPlan>,
}

/// Inlet of a group.
#[derive(Clone, Debug)]
pub struct InletPlan {
    /// Group index.
    pub part: u32,
    /// Group name.
    pub group: String,
    /// Insertion box.
    pub region: BoxRegion,
    /// Insertion rate.
    pub rate: InletRate,
    /// Initial velocity [m/s].
    pub velocity: Vec3,
    /// Start time [s].
    pub start: f64,
    /// End time [s].
    pub stop: f64,
    /// Seed of positions and orientations.
    pub seed: u64,
}

/// Insertion rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InletRate {
    /// Mass per time [kg/s].
    Mass(f64),
    /// Grains per time [1/s].
    Number(f64),
}

impl InletRate {
    /// Returns the rate [kg/s or 1/s].
    pub fn value(&self) -> f64 {
        match self {
            InletRate::Mass(rate) | InletRate::Number(rate) => *rate,
        }
    }

    /// Returns a grain of `mass` [kg] in rate units.
    pub fn of(&self, mass: f64) -> f64 {
        match self {
            InletRate::Mass(_) => mass,
            InletRate::Number(_) => 1.0,
        }
    }

    /// Returns the unit for reports.
    pub fn unit(&self) -> &'static str {
        match self {
            InletRate::Mass(_) => "kg",
            InletRate::Number(_) => "grains",
        }
    }
}

/// Outlet.
#[derive(Clone, Debug)]
pub struct OutletPlan {
    /// Name.
    pub name: String,
    /// Region.
    pub region: OutletRegion,
    /// Groups that it removes.
    pub parts: Vec<u32>,
    /// Whether removed grains return to the inlet queue.
    pub recycle: bool,
}

/// Region of an outlet.
#[derive(Clone, Copy, Debug)]
pub enum OutletRegion {
    /// A box.
    Box(BoxRegion),
    /// Half-space on the side of the normal.
    Beyond {
        /// Point on the plane [m].
        point: Vec3,
        /// Unit normal.
        normal: Vec3,
    },
}

impl FlowPlan {
    /// Formats lines; `waiting`: initial queue length of a group.
    pub fn lines(&self, groups: &[String], waiting: impl Fn(u32) -> usize) -> Vec<String> {
        let mut lines = Vec::new();
        for i in &self.inlets {
            let per = if i.rate.unit() == "kg" { "kg/s" } else { "grains/s" };
            let stop = if i.stop.is_finite() { format!("to {} s", i.stop) } else { "on".into() };
            lines.push(format!(
                "inlet of {}: {} {per} from {} s {stop}, {} grains queued at the start",
                i.group,
                i.rate.value(),
                i.start,
                waiting(i.part)
            ));
        }
        for o in &self.outlets {
            let what = if o.recycle { "return to their inlet" } else { "are gone" };
            let names: Vec<&str> = o.parts.iter().map(|p| groups[*p as usize].as_str()).collect();
            lines.push(format!("{}: removes {}, which then {what}", o.name, names.join(", ")));
        }
        lines
    }
}

impl OutletRegion {
    /// Whether the region contains a point.
    pub fn holds(&self, x: &Vec3) -> bool {
        match self {
            OutletRegion::Box(region) => region.holds(x),
            OutletRegion::Beyond { point, normal } => (x - point).dot(normal) > 0.0,
        }
    }
}
