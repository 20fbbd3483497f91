//! `[[grains]]` inlets and `[[outlet]]` resolved.

mod plan;

pub use plan::{FlowPlan, InletPlan, InletRate, OutletPlan, OutletRegion};

use super::check::region;
use super::groups::{GroupsPart, waits};
use super::periodic::Borders;
use crate::scene::flow::{Inlet, Outlet};
use crate::scene::units::vector;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::Vec3;
use trackbed_dem::insert::free_space::GAP;

/// Default check interval [s].
const INTERVAL: f64 = 1e-3;

/// Resolved after all grains are known.
pub(super) fn build(
    scene: &Table<Scene>,
    groups: &GroupsPart,
    borders: &Borders,
) -> Result<Option<FlowPlan>, SceneError> {
    let mut inlets = Vec::new();
    for (i, group) in scene.rows("grains", &scene.grains).enumerate() {
        if let Some(inlet) = group.optional("inlet", &group.inlet) {
            inlets.push(self::inlet(scene, (groups, borders), i, &inlet)?);
        }
    }
    let outlets = scene.rows("outlet", &scene.outlet).enumerate();
    let outlets = outlets.map(|(i, o)| outlet(scene, i, &o)).collect::<Result<Vec<_>, _>>()?;
    let time = scene.below("time", &scene.time);
    let interval = time.flow_interval.map(|t| t.si);
    if inlets.is_empty() && outlets.is_empty() {
        time.reject_without([("flow_interval", interval.is_some())], "an `inlet` or an [[outlet]]")?;
        return Ok(None);
    }
    time.check("flow_interval", interval, |t| t > 0.0, "a time above 0")?;
    // A group present at the start is fed by a recirculating outlet.
    for (i, group) in scene.rows("grains", &scene.grains).enumerate().filter(|(_, g)| g.inlet.is_some()) {
        let fed = outlets.iter().any(|o| o.recycle && o.parts.contains(&(i as u32)));
        if !waits(&group) && !fed {
            let expected = "an [[outlet]] with `recycle = true` for this group, or no grains at the start";
            return Err(group.error("inlet", "an inlet without grains to insert", expected));
        }
    }
    for (present, with) in [
        (!scene.bond.is_empty(), "[[bond]]"),
        (!inlets.is_empty() && scene.track.as_ref().is_some_and(|t| t.jump.is_some()), "[track.jump]"),
    ] {
        if present {
            let first = scene.rows("grains", &scene.grains).find(|g| g.inlet.is_some());
            return Err(match first {
                Some(group) => group.conflict("inlet", with),
                None => scene.conflict("outlet.0", with),
            });
        }
    }
    Ok(Some(FlowPlan { interval: interval.unwrap_or(INTERVAL), inlets, outlets }))
}

fn inlet(
    scene: &Table<Scene>,
    (groups, borders): (&GroupsPart, &Borders),
    index: usize,
    inlet: &Table<Inlet>,
) -> Result<InletPlan, SceneError> {
    let group = &scene.grains[index];
    if group.prescribed_velocity.is_some() {
        let expected = "no inlet for a group with `prescribed_velocity`";
        return Err(inlet.here("an inlet", expected));
    }
    let region = region(inlet, "box", &inlet.region)?;
    let own = groups.bodies.iter().filter(|b| b.part == index as u32);
    let reach = own.map(|b| groups.reach(b)).fold(0.0, f64::max);
    let (width, needed) = ((region.high - region.low).min(), 2.0 * reach * (1.0 + 2.0 * GAP));
    if width < needed {
        let found = format!("a box {width:.4} m wide");
        let expected = format!("at least {needed:.4} m, for the largest grain");
        return Err(inlet.error("box", found, expected));
    }
    for (d, borders) in borders.iter().enumerate() {
        let Some([low, high]) = borders else { continue };
        if region.low[d] < *low || region.high[d] > *high {
            let axis = ["x", "y", "z"][d];
            let found = format!("{axis} from {} to {}", region.low[d], region.high[d]);
            let expected = format!("a box between the borders {low} and {high} of `periodic`");
            return Err(inlet.error("box", found, expected));
        }
    }
    let rate = match (inlet.rate, inlet.grains_per_second) {
        (Some(rate), None) => {
            inlet.check("rate", rate, |r| r > 0.0, "above 0")?;
            InletRate::Mass(rate.si)
        }
        (None, Some(rate)) => {
            inlet.check("grains_per_second", rate, |r| r > 0.0, "above 0")?;
            InletRate::Number(rate.si)
        }
        (rate, _) => return Err(inlet.choice(["rate", "grains_per_second"], rate.is_some())),
    };
    let (start, stop) = (inlet.start.map_or(0.0, |t| t.si), inlet.stop.map(|t| t.si));
    inlet.check("start", start, |t| t >= 0.0, "0 or more")?;
    inlet.check("stop", stop, |t| t > start, "a time after the start")?;
    if let Some(end) = scene.time.end.map(|t| t.si).filter(|end| start >= *end) {
        let expected = format!("a time before the end at {end} s");
        return Err(inlet.error("start", format!("{start} s"), expected));
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

fn outlet(scene: &Table<Scene>, index: usize, outlet: &Table<Outlet>) -> Result<OutletPlan, SceneError> {
    let named = |o: &Outlet, i: usize| o.name.clone().unwrap_or_else(|| format!("outlet{i}"));
    let name = named(outlet, index);
    if scene.outlet[..index].iter().enumerate().any(|(i, o)| named(o, i) == name) {
        return Err(outlet.error("name", format!("\"{name}\" again"), "each name once"));
    }
    let region = match (&outlet.region, &outlet.point, &outlet.normal) {
        (Some(corners), None, None) => OutletRegion::Box(region(outlet, "box", corners)?),
        (None, Some(point), Some(normal)) => {
            let normal = Vec3::from(*normal);
            let length = normal.norm();
            outlet.check("normal", length, |l| l > 0.0, "a vector that is not null")?;
            OutletRegion::Beyond { point: Vec3::from(vector(point)), normal: normal / length }
        }
        _ => {
            let expected = "either `box`, or `point` and `normal`";
            return Err(outlet.here("another choice of keys", expected));
        }
    };
    let free: Vec<usize> =
        (0..scene.grains.len()).filter(|&i| scene.grains[i].prescribed_velocity.is_none()).collect();
    let parts: Vec<usize> = match &outlet.groups {
        None => free,
        Some(names) => names
            .iter()
            .map(|name| {
                free.iter().copied().find(|&i| scene.grains[i].name == *name).ok_or_else(|| {
                    let free: Vec<&str> = free.iter().map(|&i| scene.grains[i].name.as_str()).collect();
                    let expected = format!(
                        "the name of a [[grains]] without `prescribed_velocity`: {}",
                        free.join(", ")
                    );
                    outlet.error("groups", format!("\"{name}\""), expected)
                })
            })
            .collect::<Result<_, _>>()?,
    };
    if parts.is_empty() {
        return Err(outlet.error("groups", "none", "at least one group that moves freely"));
    }
    if outlet.recycle
        && let Some(&i) = parts.iter().find(|&&i| scene.grains[i].inlet.is_none())
    {
        let expected = format!("an `inlet` in the group \"{}\", which it takes", scene.grains[i].name);
        return Err(outlet.error("recycle", "true", expected));
    }
    let parts = parts.into_iter().map(|i| i as u32).collect();
    Ok(OutletPlan { name, region, parts, recycle: outlet.recycle })
}
