//! `[structure.hazard]` resolved.

use crate::scene::structure::{Hazard, HullForm, LevelIce, PeakLaw};
use crate::scene::{SceneError, Table};
use std::f64::consts::FRAC_PI_2;
use trackbed_io::extremes::Law;
use trackbed_io::ice_loads::{Cone, Ship, crushing};

const MOST: usize = 100;

/// Statistics of the horizontal load.
#[derive(Clone, Debug)]
pub struct HazardPlan {
    /// Load above which peaks are fitted [N].
    pub threshold: f64,
    /// Loads whose exceedance is recorded [N], ascending.
    pub loads: Vec<f64>,
    /// Shortest time below the threshold between two peaks [s].
    pub separation: f64,
    /// Beginning of the statistics [s].
    pub start: f64,
    /// Law of the peaks.
    pub law: Law,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Time in such ice per year [s].
    pub exposure: f64,
    /// Return periods [years].
    pub return_periods: Vec<f64>,
    /// Loads of the amber and red warnings [N].
    pub warnings: [Option<f64>; 2],
    /// Load of level ice [N].
    pub level_ice: Option<f64>,
}

pub(super) fn plan(hazard: &Table<Hazard>) -> Result<HazardPlan, SceneError> {
    let positive = "a load above 0";
    let threshold = hazard.check("threshold", hazard.threshold, |f| f > 0.0, positive)?.si;
    let loads: Vec<f64> = hazard.loads.iter().flatten().map(|f| f.si).collect();
    let ascend = loads.iter().all(|f| f.is_finite() && *f > 0.0) && loads.windows(2).all(|w| w[0] < w[1]);
    if !ascend || loads.len() > MOST {
        return Err(hazard.error("loads", format!("{loads:?}"), "at most 100 loads above 0, ascending"));
    }
    let time = |key: &str, value| hazard.check(key, value, |t| t >= 0.0, "a time of at least 0");
    let separation = time("separation", hazard.separation)?.map_or(0.0, |t| t.si);
    let start = time("start", hazard.start)?.map_or(0.0, |t| t.si);
    let confidence = hazard.confidence.unwrap_or(0.9);
    hazard.check("confidence", confidence, |c| c > 0.0 && c < 1.0, "between 0 and 1")?;
    let return_periods = hazard.return_periods.clone().unwrap_or_default();
    if return_periods.len() > MOST || !return_periods.iter().all(|t| t.is_finite() && *t > 0.0) {
        let expected = "at most 100 periods above 0";
        return Err(hazard.error("return_periods", format!("{return_periods:?}"), expected));
    }
    match (&hazard.exposure, &hazard.return_periods) {
        (Some(_), None) => return Err(hazard.requirement("exposure", "`return_periods`")),
        (None, Some(_)) => return Err(hazard.requirement("return_periods", "`exposure`")),
        _ => {}
    }
    if hazard.return_periods.is_none() {
        hazard.reject_without([("confidence", hazard.confidence.is_some())], "`return_periods`")?;
    }
    let exposure = hazard.check("exposure", hazard.exposure, |t| t > 0.0, "a time above 0")?;
    let amber = hazard.check("amber", hazard.amber, |f| f > 0.0, positive)?.map(|f| f.si);
    let above = |f: f64| f > amber.unwrap_or(0.0);
    let expected = if amber.is_some() { "a load above `amber`" } else { positive };
    let red = hazard.check("red", hazard.red, above, expected)?.map(|f| f.si);
    let ice = hazard.optional("level_ice", &hazard.level_ice);
    Ok(HazardPlan {
        threshold,
        loads,
        separation,
        start,
        law: match hazard.law {
            PeakLaw::Weibull => Law::Weibull,
            PeakLaw::Gumbel => Law::Gumbel,
        },
        confidence,
        exposure: exposure.map_or(0.0, |t| t.si),
        return_periods,
        warnings: [amber, red],
        level_ice: ice.map(|ice| level_ice(&ice)).transpose()?,
    })
}

fn level_ice(ice: &Table<LevelIce>) -> Result<f64, SceneError> {
    let thickness = ice.check("thickness", ice.thickness, |x| x > 0.0, "a thickness above 0")?.si;
    let width = ice.check("width", ice.width, |x| x > 0.0, "a width above 0")?.si;
    let strength = "a strength above 0";
    let keys = ["strength", "flexural_strength"];
    let of_cone = [
        ("angle", ice.angle.is_some()),
        ("top_width", ice.top_width.is_some()),
        ("ride_up", ice.ride_up.is_some()),
    ];
    let of_bending = [
        ("friction", ice.friction.is_some()),
        ("density", ice.density.is_some()),
        ("hull", ice.hull.is_some()),
    ];
    match (ice.strength, ice.flexural_strength) {
        (Some(value), None) => {
            ice.reject_without(of_cone.into_iter().chain(of_bending), "`flexural_strength`")?;
            Ok(crushing(width, thickness, ice.check(keys[0], value, |x| x > 0.0, strength)?.si))
        }
        (None, Some(value)) => {
            let flexural_strength = ice.check(keys[1], value, |x| x > 0.0, strength)?.si;
            match ice.optional("hull", &ice.hull) {
                None => cone(ice, (width, thickness, flexural_strength)),
                Some(hull) => {
                    ice.reject_with(of_cone, "`hull`")?;
                    ship(ice, &hull, (width, thickness, flexural_strength))
                }
            }
        }
        (strength, _) => Err(ice.choice(keys, strength.is_some())),
    }
}

fn slope(angle: f64) -> bool {
    angle > 0.0 && angle < FRAC_PI_2
}

const SLOPE: &str = "an angle between 0 and 90 degrees";

fn cone(
    ice: &Table<LevelIce>,
    (width, thickness, flexural_strength): (f64, f64, f64),
) -> Result<f64, SceneError> {
    let angle = ice.need("angle", ice.angle, "the slope of the cone")?;
    let top_width = ice.need("top_width", ice.top_width, "the width at the top of the cone")?;
    let friction = ice.need("friction", ice.friction, "the friction of ice on the cone")?;
    let density = ice.need("density", ice.density, "the density of the ice")?;
    let ride_up = ice.check("ride_up", ice.ride_up, |x| x >= 0.0, "a thickness of at least 0")?;
    let cone = Cone {
        width,
        top_width: ice
            .check("top_width", top_width, |x| x >= 0.0 && x < width, "at least 0, below `width`")?
            .si,
        angle: ice.check("angle", angle, slope, SLOPE)?.si,
        friction: ice.check("friction", friction, |x| x >= 0.0, "at least 0")?,
        thickness,
        ride_up: ride_up.map_or(thickness, |x| x.si),
        flexural_strength,
        density: ice.check("density", density, |x| x > 0.0, "a density above 0")?.si,
    };
    if !cone.slides() {
        return Err(ice.error(
            "friction",
            friction.to_string(),
            "a friction at which ice slides up the cone",
        ));
    }
    Ok(cone.load().iter().sum())
}

fn ship(
    ice: &Table<LevelIce>,
    hull: &Table<HullForm>,
    (beam, thickness, flexural_strength): (f64, f64, f64),
) -> Result<f64, SceneError> {
    let friction = ice.need("friction", ice.friction, "the friction of ice on the hull")?;
    let density = ice.need("density", ice.density, "the density of the ice")?;
    let positive = |x: f64| x > 0.0;
    let ship = Ship {
        length: hull.check("length", hull.length, positive, "a length above 0")?.si,
        beam,
        draught: hull.check("draught", hull.draught, positive, "a draught above 0")?.si,
        stem_angle: hull.check("stem_angle", hull.stem_angle, slope, SLOPE)?.si,
        entrance_angle: hull.check("entrance_angle", hull.entrance_angle, slope, SLOPE)?.si,
        speed: hull.check("speed", hull.speed, |v| v >= 0.0, "a speed of at least 0")?.si,
        friction: ice.check("friction", friction, |x| x >= 0.0, "at least 0")?,
        thickness,
        flexural_strength,
        young: hull.check("young", hull.young, positive, "a modulus above 0")?.si,
        density: ice.check("density", density, positive, "a density above 0")?.si,
    };
    if !ship.slides() {
        let expected = "a friction at which ice slides along the stem";
        return Err(ice.error("friction", friction.to_string(), expected));
    }
    Ok(ship.resistance().iter().sum())
}
