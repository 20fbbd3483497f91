//! Inlets of `[[grains]]` and `[[outlet]]` resolved.

use super::compaction::region;
use super::{GrainsPart, check, groups};
use crate::failure::Failure;
use crate::scene::flow::{Inlet, Outlet};
use crate::scene::grains::Grains;
use crate::scene::units::vector;
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::insert::room::GAP;
use trackbed_dem::measure::BoxRegion;
use trackbed_dem::random::Random;
use trackbed_dem::{BodyInput, Vec3};

/// Time between two looks at inlets and outlets, unless the scene says otherwise [s].
const INTERVAL: f64 = 1e-3;
/// Purpose of the stream that the order of coming in is drawn from.
const ORDER: u64 = 8;

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
                "inlet of {}: {} {per} from {} s {stop}, {} grains wait for it at the start",
                i.group,
                i.rate.value(),
                i.start,
                waiting(i.part)
            ));
        }
        for o in &self.outlets {
            let what = if o.again { "come again" } else { "are gone" };
            let names: Vec<&str> = o.parts.iter().map(|p| groups[*p as usize].as_str()).collect();
            lines.push(format!("{}: takes out {}, which then {what}", o.name, names.join(", ")));
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

/// Adds grains that wait for their inlet: `count` of them, in random order.
pub(super) fn waiting(
    document: &Document,
    index: usize,
    group: &Grains,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    for (k, present) in [("velocity", group.velocity.is_some()), ("spin", group.spin.is_some())] {
        if present {
            let expected = "no such key for grains that wait for their inlet: see `inlet.velocity`";
            return Err(document.error(&format!("grains.{index}.{k}"), "a value", expected).into());
        }
    }
    let grains = groups::sampled(document, index, group, part, "the number of grains that may come in")?;
    // A range gives sizes in rising order: without this the small ones would come first.
    let order = Random::new(group.seed, ORDER).permutation(grains.len());
    part.bodies.extend(order.into_iter().map(|i| {
        let groups::Sampled { shape, scale } = grains[i];
        BodyInput { shape, scale, absent: true, ..model.clone() }
    }));
    Ok(())
}

/// Adds the inlets of all groups and the outlets, once all grains are there.
pub(super) fn add(document: &Document, scene: &Scene, part: &mut GrainsPart) -> Result<(), SceneError> {
    let inlets = scene.grains.iter().enumerate().filter_map(|(i, g)| Some((i, g, g.inlet.as_ref()?)));
    let inlets = inlets
        .map(|(i, g, inlet)| self::inlet(document, scene, part, i, g, inlet))
        .collect::<Result<Vec<_>, _>>()?;
    let outlets = scene.outlet.iter().enumerate();
    let outlets = outlets.map(|(i, o)| outlet(document, scene, i, o)).collect::<Result<Vec<_>, _>>()?;
    let interval = scene.time.flow_interval.map(|t| t.si);
    if inlets.is_empty() && outlets.is_empty() {
        return match interval {
            Some(_) => {
                let expected = "no such key without an `inlet` or an [[outlet]]";
                Err(document.error("time.flow_interval", "a value", expected))
            }
            None => Ok(()),
        };
    }
    check(document, "time.flow_interval", interval, |t| t > 0.0, "a time above 0")?;
    // A group that is there from the start needs an outlet that sends its grains to the inlet.
    for (i, group) in scene.grains.iter().enumerate().filter(|(_, g)| g.inlet.is_some()) {
        let fed = outlets.iter().any(|o| o.again && o.parts.contains(&(i as u32)));
        if !waits(group) && !fed {
            let expected = "an [[outlet]] with `again = true` for this group, or no grains at the start";
            return Err(document.error(
                &format!("grains.{i}.inlet"),
                "an inlet that nothing comes to",
                expected,
            ));
        }
    }
    let first = match scene.grains.iter().position(|g| g.inlet.is_some()) {
        Some(i) => format!("grains.{i}.inlet"),
        None => "outlet.0".into(),
    };
    for (other, present) in [
        ("[[bond]]: bonded grains neither come nor go", !scene.bond.is_empty()),
        (
            "[track.jump]: a jump knows no grains that come and go",
            scene.track.as_ref().is_some_and(|t| t.jump.is_some()),
        ),
    ] {
        if present {
            let (with, why) = other.split_once(": ").unwrap_or((other, ""));
            let expected = format!("no inlet or outlet beside {with}: {why}");
            return Err(document.error(&first, "grains that come or go", expected));
        }
    }
    part.flow = Some(FlowPlan { interval: interval.unwrap_or(INTERVAL), inlets, outlets });
    Ok(())
}

/// Whether all grains of a group wait for their inlet.
pub(super) fn waits(group: &Grains) -> bool {
    let sources = [group.spheres.is_some(), group.packing.is_some(), group.fill.is_some()];
    group.inlet.is_some() && !sources.contains(&true) && group.lattice.is_none() && group.region.is_none()
}

fn inlet(
    document: &Document,
    scene: &Scene,
    part: &GrainsPart,
    index: usize,
    group: &Grains,
    inlet: &Inlet,
) -> Result<InletPlan, SceneError> {
    let key = |k: &str| format!("grains.{index}.inlet{k}");
    if group.motion.is_some() {
        let expected = "no inlet for a group with `motion`";
        return Err(document.error(&key(""), "an inlet", expected));
    }
    let region = region(document, &key(".box"), &inlet.region)?;
    let own = part.bodies.iter().filter(|b| b.part == index as u32);
    let reach = own.map(|b| part.reach(b)).fold(0.0, f64::max);
    let (width, needed) = ((region.high - region.low).min(), 2.0 * reach * (1.0 + 2.0 * GAP));
    if width < needed {
        let found = format!("a box {width:.4} m wide");
        let expected = format!("at least {needed:.4} m, for the largest grain");
        return Err(document.error(&key(".box"), found, expected));
    }
    for (d, borders) in part.periodic.iter().enumerate() {
        let Some([low, high]) = borders else { continue };
        if region.low[d] < *low || region.high[d] > *high {
            let axis = ["x", "y", "z"][d];
            let found = format!("{axis} from {} to {}", region.low[d], region.high[d]);
            let expected = format!("a box between the borders {low} and {high} of `periodic`");
            return Err(document.error(&key(".box"), found, expected));
        }
    }
    let rate = match (inlet.rate, inlet.grains_per_second) {
        (Some(rate), None) => {
            check(document, &key(".rate"), Some(rate.si), |r| r > 0.0, "above 0")?;
            InletRate::Mass(rate.si)
        }
        (None, Some(rate)) => {
            check(document, &key(".grains_per_second"), Some(rate.si), |r| r > 0.0, "above 0")?;
            InletRate::Number(rate.si)
        }
        _ => {
            let found = "both or none of `rate` and `grains_per_second`";
            return Err(document.error(&key(".rate"), found, "one of them"));
        }
    };
    let (start, stop) = (inlet.start.map_or(0.0, |t| t.si), inlet.stop.map(|t| t.si));
    check(document, &key(".start"), Some(start), |t| t >= 0.0, "0 or more")?;
    check(document, &key(".stop"), stop, |t| t > start, "a time after the start")?;
    if let Some(end) = scene.time.end.map(|t| t.si).filter(|end| start >= *end) {
        let expected = format!("a time before the end at {end} s");
        return Err(document.error(&key(".start"), format!("{start} s"), expected));
    }
    Ok(InletPlan {
        part: index as u32,
        group: group.name.clone(),
        region,
        rate,
        velocity: inlet.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        start,
        stop: stop.unwrap_or(f64::INFINITY),
        seed: group.seed,
    })
}

fn outlet(
    document: &Document,
    scene: &Scene,
    index: usize,
    outlet: &Outlet,
) -> Result<OutletPlan, SceneError> {
    let key = |k: &str| format!("outlet.{index}.{k}");
    let named = |o: &Outlet, i: usize| o.name.clone().unwrap_or_else(|| format!("outlet{i}"));
    let name = named(outlet, index);
    if scene.outlet[..index].iter().enumerate().any(|(i, o)| named(o, i) == name) {
        return Err(document.error(&key("name"), format!("\"{name}\" again"), "each name once"));
    }
    let region = match (&outlet.region, &outlet.point, &outlet.normal) {
        (Some(corners), None, None) => OutletRegion::Box(region(document, &key("box"), corners)?),
        (None, Some(point), Some(normal)) => {
            let normal = Vec3::from(*normal);
            let length = normal.norm();
            check(document, &key("normal"), Some(length), |l| l > 0.0, "a vector that is not null")?;
            OutletRegion::Beyond { point: Vec3::from(vector(point)), normal: normal / length }
        }
        _ => {
            let expected = "either `box`, or `point` and `normal`";
            return Err(document.error(&format!("outlet.{index}"), "another choice of keys", expected));
        }
    };
    let free: Vec<usize> = (0..scene.grains.len()).filter(|&i| scene.grains[i].motion.is_none()).collect();
    let parts: Vec<usize> = match &outlet.groups {
        None => free,
        Some(names) => names
            .iter()
            .map(|name| {
                free.iter().copied().find(|&i| scene.grains[i].name == *name).ok_or_else(|| {
                    let free: Vec<&str> = free.iter().map(|&i| scene.grains[i].name.as_str()).collect();
                    let expected = format!("the name of a [[grains]] without `motion`: {}", free.join(", "));
                    document.error(&key("groups"), format!("\"{name}\""), expected)
                })
            })
            .collect::<Result<_, _>>()?,
    };
    if parts.is_empty() {
        return Err(document.error(&key("groups"), "none", "at least one group that moves freely"));
    }
    if outlet.again
        && let Some(&i) = parts.iter().find(|&&i| scene.grains[i].inlet.is_none())
    {
        let expected = format!("an `inlet` in the group \"{}\", which it takes", scene.grains[i].name);
        return Err(document.error(&key("again"), "true", expected));
    }
    let parts = parts.into_iter().map(|i| i as u32).collect();
    Ok(OutletPlan { name, region, parts, again: outlet.again })
}
