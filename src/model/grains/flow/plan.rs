//! Inlets and outlets of a run.

use trackbed_dem::Vec3;
use trackbed_dem::measure::BoxRegion;

/// Inlets and outlets of a run.
#[derive(Clone, Debug)]
pub struct FlowPlan {
    /// Time between two looks at them [s].
    pub interval: f64,
    /// Inlets, at most one for each group.
    pub inlets: Vec<InletPlan>,
    /// Outlets; a grain in several is taken out by the first.
    pub outlets: Vec<OutletPlan>,
}

/// Where grains of a group come in.
#[derive(Clone, Debug)]
pub struct InletPlan {
    /// Number of the group.
    pub part: u32,
    /// Its name.
    pub group: String,
    /// Box that they come in at.
    pub region: BoxRegion,
    /// How fast.
    pub rate: InletRate,
    /// At which velocity [m/s].
    pub velocity: Vec3,
    /// From when on [s].
    pub start: f64,
    /// Until when [s].
    pub stop: f64,
    /// Seed of places and orientations.
    pub seed: u64,
}

/// How fast grains come in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InletRate {
    /// Mass per time [kg/s].
    Mass(f64),
    /// Grains per time [1/s].
    Number(f64),
}

impl InletRate {
    /// Rate in its own measure: kg/s or 1/s.
    pub fn value(&self) -> f64 {
        match self {
            InletRate::Mass(rate) | InletRate::Number(rate) => *rate,
        }
    }

    /// A grain of a mass [kg] in this measure: kg, or one.
    pub fn of(&self, mass: f64) -> f64 {
        match self {
            InletRate::Mass(_) => mass,
            InletRate::Number(_) => 1.0,
        }
    }

    /// What it counts, for reports.
    pub fn unit(&self) -> &'static str {
        match self {
            InletRate::Mass(_) => "kg",
            InletRate::Number(_) => "grains",
        }
    }
}

/// Where grains are taken out.
#[derive(Clone, Debug)]
pub struct OutletPlan {
    /// Name.
    pub name: String,
    /// Where.
    pub region: OutletRegion,
    /// Groups that it takes.
    pub parts: Vec<u32>,
    /// Whether what it takes waits at the inlet of its group.
    pub again: bool,
}

/// Where an outlet is.
#[derive(Clone, Copy, Debug)]
pub enum OutletRegion {
    /// A box.
    Box(BoxRegion),
    /// All that lies beyond a plane, on the side that its unit normal points to.
    Beyond {
        /// A point of the plane [m].
        point: Vec3,
        /// The normal.
        normal: Vec3,
    },
}

impl FlowPlan {
    /// Lines that tell of it before a run, with the names of all groups; `waiting` is the number of grains of a group that wait
    /// at the start.
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
            let what = if o.again { "come again" } else { "are gone" };
            let names: Vec<&str> = o.parts.iter().map(|p| groups[*p as usize].as_str()).collect();
            lines.push(format!("{}: removes {}, which then {what}", o.name, names.join(", ")));
        }
        lines
    }
}

impl OutletRegion {
    /// Whether it holds a point.
    pub fn holds(&self, x: &Vec3) -> bool {
        match self {
            OutletRegion::Box(region) => region.holds(x),
            OutletRegion::Beyond { point, normal } => (x - point).dot(normal) > 0.0,
        }
    }
}
