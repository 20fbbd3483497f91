//! `[track.jump]`, `[track.push]` and `track.bed_stiffness` resolved.

use super::part::{AfterPlan, TrackPart};
use crate::scene::after::{CycleJump, JumpMethod, Push};
use crate::scene::track::TrackTable;
use crate::scene::{SceneError, Table};
use trackbed_dem::Vec3;
use trackbed_track::CyclicLoad;
use trackbed_track::cycle_jump::CycleJumpOptions;
use trackbed_track::push_test::PushTestOptions;

/// `fixed`: reason why a jump cannot move grains.
///
/// # Errors
/// Input errors.
pub(super) fn build(
    track: &Table<TrackTable>,
    part: &TrackPart,
    fixed: Option<&str>,
) -> Result<AfterPlan, SceneError> {
    let jump = track.optional("jump", &track.jump).map(|j| jump(track, &j, part, fixed)).transpose()?;
    let push = track.optional("push", &track.push).map(|p| push(track, &p, part)).transpose()?;
    let range = part.load.as_ref().map(CyclicLoad::range);
    let between = match (track.bed_stiffness, range) {
        (Some(_), None) => {
            return Err(track.no_effect("bed_stiffness", "a [track.load] with cycles"));
        }
        (Some(loads), Some([least, most])) => {
            let [low, high] = loads.map(|f| f.si);
            if !(least <= low && low < high && high <= most) {
                let expected = format!("two rising loads from {least} to {most}, the loads of the cycles");
                return Err(track.error("bed_stiffness", format!("{low} and {high}"), expected));
            }
            Some([low, high])
        }
        (None, range) => range.map(|[a, b]| [a + 0.25 * (b - a), a + 0.75 * (b - a)]),
    };
    Ok(AfterPlan { jump, push, between })
}

fn jump(
    track: &Table<TrackTable>,
    j: &Table<CycleJump>,
    part: &TrackPart,
    fixed: Option<&str>,
) -> Result<CycleJumpOptions, SceneError> {
    let Some(load) = &part.load else {
        return Err(track.requirement("jump", "[track.load] with cycles"));
    };
    let grains = j.method == JumpMethod::Displace;
    if !grains {
        let idle = [("settle", j.settle.is_some()), ("overlap", j.overlap.is_some())];
        j.reject_without(idle, "`method = \"displace\"`")?;
    }
    if let Some(why) = fixed.filter(|_| grains) {
        let expected = format!("\"extrapolate\". Grains that {why} cannot be displaced");
        return Err(j.error("method", "\"displace\"", expected));
    }
    j.check("measure", j.measure, |n| n >= 2.0, "2 or more")?;
    let least = f64::from(j.measure) + 2.0;
    j.check("first", j.first, |n| n >= least.max(10.0), "10 or more, and more than `measure` by 2")?;
    j.check("tolerance", j.tolerance, |t| t > 0.0 && t <= 10.0, "above 0, at most 10")?;
    j.check("largest", j.largest, |g| g > 0.0 && g <= 10.0, "above 0, at most 10")?;
    j.check("overlap", j.overlap, |o| o > 0.0 && o <= 2.0, "above 0, at most 2")?;
    if j.first >= load.cycles() {
        let expected = format!("fewer than the {} cycles of the load", load.cycles());
        return Err(j.error("first", j.first.to_string(), expected));
    }
    Ok(CycleJumpOptions {
        grains,
        first: j.first,
        measure: j.measure,
        settle: if grains { j.settle.unwrap_or(3) } else { 0 },
        tolerance: j.tolerance,
        largest: j.largest,
        overlap: j.overlap.unwrap_or(0.5),
    })
}

fn push(track: &Table<TrackTable>, p: &Table<Push>, part: &TrackPart) -> Result<PushTestOptions, SceneError> {
    let direction = Vec3::new(p.direction[0], p.direction[1], 0.0);
    let found = format!("({}, {})", p.direction[0], p.direction[1]);
    let Some(direction) = direction.try_normalize(0.0).filter(|d| d.iter().all(|x| x.is_finite())) else {
        return Err(p.error("direction", found, "a direction"));
    };
    if part.rail.is_some() {
        return Err(track.conflict("push", "a rail with `mass`"));
    }
    if part.sleeper.as_ref().is_some_and(|s| s.row.centres.len() > 1) {
        return Err(track.conflict("push", "several sleepers"));
    }
    let held = part.sleeper.as_ref().map_or([false; 6], |s| s.row.held);
    if let Some(d) = (0..2).find(|&d| held[d] && direction[d] != 0.0) {
        let expected = format!("a direction that track.sleeper.hold leaves free, not {}", ["x", "y"][d]);
        return Err(p.error("direction", found, expected));
    }
    p.check("speed", p.speed, |v| v > 0.0, "above 0")?;
    p.check("displacement", p.displacement, |l| l > 0.0, "above 0")?;
    p.check("load", p.load, |f| f >= 0.0, "0 or more")?;
    p.check("rest", p.rest, |t| t >= 0.0, "0 or more")?;
    p.check("height", p.height, |_| true, "a length")?;
    p.check("stiffness", p.stiffness, |k| k > 0.0, "above 0")?;
    Ok(PushTestOptions {
        direction,
        speed: p.speed.si,
        displacement: p.displacement.si,
        load: p.load.si,
        rest: p.rest.si,
        height: p.height.si,
        stiffness: p.stiffness.si,
    })
}
