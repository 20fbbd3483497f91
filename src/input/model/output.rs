//! `[output]` resolved.

use super::duration::{TIME_INTEGRATION, counted_step};
use crate::scene::track::RailKind;
use crate::scene::{Chains, Output, Scene, SceneError, Table, setting};
use std::collections::BTreeSet;
use std::time::Duration;
use trackbed_io::write::{BODY_FIELDS, FORMATS, Format, FrameField, Needs, Part, SOLID_FIELDS, Written};

/// Default wall time between checkpoints [s].
const CHECKPOINT: f64 = 600.0;

/// Output of a run.
#[derive(Clone, Debug)]
pub struct OutputPlan {
    /// Main-stage frames, without the initial one.
    pub frames: u32,
    /// History interval [s].
    pub history_interval: f64,
    /// Wall time between checkpoints.
    pub checkpoint: Duration,
    /// Frame formats.
    pub formats: Vec<&'static Format>,
    /// Final nodes and Gauss points as CSV.
    pub tables: bool,
    /// Final grains as CSV.
    pub packing: bool,
    /// Complete final state.
    pub state: bool,
    /// Optional frame fields; default all.
    pub fields: Option<Vec<String>>,
    /// Additional grain fields.
    pub extra: Vec<&'static str>,
    /// Additional fields of the solid.
    pub solid_extra: Vec<&'static str>,
    /// Detailed last part: duration [s], frames.
    pub last: Option<(f64, u32)>,
    /// Times of additional frames [s].
    pub frames_at: Vec<f64>,
    /// An additional frame at the largest load of each cycle.
    pub frames_at_peaks: bool,
    /// Frames show contacts above the mean force.
    pub strong_chains: bool,
}

impl OutputPlan {
    /// Resolves `[output]` for a main stage of `end` [s].
    ///
    /// # Errors
    /// Values out of range, or keys without effect.
    pub fn new(scene: &Table<Scene>, end: f64) -> Result<OutputPlan, SceneError> {
        let o = scene.below("output", &scene.output);
        refuse_idle_keys(scene, &o, end)?;
        let frames = frames(scene, &o, end)?;
        let history_interval =
            match steps(scene, &o, "history", o.history_steps, o.history_interval.is_some())? {
                Some(interval) => interval,
                None => o.history_interval.map_or(end / 1000.0, |i| i.si),
            };
        if o.history_interval.is_some() && (history_interval <= 0.0 || !history_interval.is_finite()) {
            let found = history_interval.to_string();
            return Err(o.error("history_interval", found, "a time above 0"));
        }
        let checkpoint = o.checkpoint.map_or(CHECKPOINT, |c| c.si);
        let Some(checkpoint) = Duration::try_from_secs_f64(checkpoint).ok().filter(|c| !c.is_zero()) else {
            return Err(o.error("checkpoint", format!("{checkpoint} s"), "a time above 0"));
        };
        let selected = |format: &&'static Format| {
            let shown = scene.solid.is_some() || !of_solid_alone(format);
            shown && o.format(format.key).unwrap_or(format.default)
        };
        Ok(OutputPlan {
            frames,
            checkpoint,
            history_interval,
            formats: FORMATS.into_iter().filter(selected).collect(),
            tables: o.tables.unwrap_or(false),
            packing: o.packing.unwrap_or(false),
            state: o.state.unwrap_or(true),
            fields: fields(scene, &o)?,
            extra: extra(scene, &o, of_bodies(scene)),
            solid_extra: extra(scene, &o, of_solid(scene)),
            last: last(scene, &o, end, frames)?,
            frames_at: frames_at(&o, end)?,
            frames_at_peaks: frames_at_peaks(scene, &o)?,
            strong_chains: o.chains == Some(Chains::Strong),
        })
    }
}

fn steps(
    scene: &Table<Scene>,
    o: &Table<Output>,
    what: &str,
    steps: Option<u64>,
    other: bool,
) -> Result<Option<f64>, SceneError> {
    let Some(steps) = steps else { return Ok(None) };
    let key = format!("{what}_steps");
    if other {
        return Err(o.conflict(&key, "the key for times or numbers"));
    }
    let step = counted_step(scene, &format!("output.{key}"))?;
    o.check(&key, steps as f64, |n| n >= 1.0, "1 or more").map(|n| Some(n * step))
}

fn frames(scene: &Table<Scene>, o: &Table<Output>, end: f64) -> Result<u32, SceneError> {
    const MOST: f64 = 100_000.0;
    let (key, frames) = match steps(scene, o, "frame", o.frame_steps, o.frames.is_some())? {
        // The end may lie just below a whole step.
        Some(interval) => ("frame_steps", (end / interval * (1.0 + 1e-9)).floor()),
        None => ("frames", f64::from(o.frames.unwrap_or(20))),
    };
    o.check(key, frames, |n| n <= MOST, "at most 100000 frames").map(|n| n as u32)
}

fn fields(scene: &Scene, o: &Table<Output>) -> Result<Option<Vec<String>>, SceneError> {
    let offered = |field: &&FrameField| {
        field.written != Written::Always && field.written.needs().is_none_or(|needs| has(scene, needs))
    };
    let all = of_solid(scene).iter().chain(of_bodies(scene));
    let known: BTreeSet<&str> = all.filter(offered).map(|field| field.name).collect();
    for (k, name) in o.fields.iter().flatten().enumerate() {
        if !known.contains(name.as_str()) {
            let expected = format!("one of {}", known.iter().copied().collect::<Vec<_>>().join(", "));
            return Err(o.error(&format!("fields.{k}"), format!("\"{name}\""), expected));
        }
    }
    Ok(o.fields.clone())
}

fn last(scene: &Scene, o: &Table<Output>, end: f64, frames: u32) -> Result<Option<(f64, u32)>, SceneError> {
    let Some(last) = o.optional("last", &o.last) else { return Ok(None) };
    if scene.track.as_ref().is_some_and(|t| t.jump.is_some()) {
        let error = o.conflict("last", "[track.jump]");
        return Err(error.remedy("A run with cycle jumps has no fixed end"));
    }
    let time = last.time.si;
    last.check("time", time, |t| t > 0.0 && t < end, &format!("above 0, below the end at {end} s"))?;
    let most = 100_000 - frames.min(100_000);
    last.check(
        "frames",
        f64::from(last.frames),
        |n| (1.0..=f64::from(most)).contains(&n),
        "1 or more, 100000 with the others",
    )?;
    Ok(Some((time, last.frames)))
}

fn frames_at(o: &Table<Output>, end: f64) -> Result<Vec<f64>, SceneError> {
    let times = o.frames_at.iter().flatten().enumerate().map(|(k, time)| {
        let expected = format!("above 0, at most the end at {end} s");
        o.check(&format!("frames_at.{k}"), time.si, |t| t > 0.0 && t <= end, &expected)
    });
    times.collect()
}

fn frames_at_peaks(scene: &Scene, o: &Table<Output>) -> Result<bool, SceneError> {
    let track = scene.track.as_ref();
    let given = ("frames_at_peaks", o.frames_at_peaks.is_some());
    if track.is_none_or(|t| t.load.is_none()) {
        o.reject_without([given], "[track.load]")?;
    }
    if track.and_then(|t| t.rail.as_ref()).is_some_and(|r| r.kind == RailKind::Beam) {
        let error = o.reject_with([given], &setting("track.rail.kind", &["beam"]));
        error.map_err(|e| e.remedy("The seat loads of a rail with mass are not known in advance"))?;
    }
    Ok(o.frames_at_peaks.unwrap_or(false))
}

fn of_solid(scene: &Scene) -> &'static [FrameField] {
    if scene.solid.is_some() { &SOLID_FIELDS } else { &[] }
}

fn of_bodies(scene: &Scene) -> &'static [FrameField] {
    if scene.grains.is_empty() { &[] } else { &BODY_FIELDS }
}

fn has(scene: &Scene, needs: Needs) -> bool {
    match needs {
        Needs::Nothing => true,
        // Periodic wrapping invalidates the initial position.
        Needs::NoBorders => scene.periodic.is_none(),
        // No other forces.
        Needs::ContactForcesOnly => {
            let held = scene.grains.iter().any(|g| g.prescribed_velocity.is_some());
            !held && scene.wind.is_none() && scene.water.is_none() && scene.track.is_none()
        }
        Needs::Spread => scene.material.iter().any(|m| m.stiffness_spread.is_some()),
        Needs::Bonds => !scene.bond.is_empty(),
    }
}

fn extra(scene: &Scene, o: &Output, fields: &'static [FrameField]) -> Vec<&'static str> {
    let wanted = |field: &FrameField| match &o.fields {
        Some(named) => named.iter().any(|n| n == field.name),
        None => match field.written {
            Written::OnRequest(needs) => needs == Needs::NoBorders && scene.runout.is_some(),
            _ => true,
        },
    };
    let possible = |field: &FrameField| field.written.needs().is_some_and(|needs| has(scene, needs));
    fields.iter().filter(|field| possible(field) && wanted(field)).map(|field| field.name).collect()
}

fn of_solid_alone(format: &Format) -> bool {
    format.parts.iter().all(|part| *part == Part::Solid)
}

fn refuse_idle_keys(scene: &Scene, o: &Table<Output>, end: f64) -> Result<(), SceneError> {
    let formats = FORMATS.into_iter().filter(|format| of_solid_alone(format));
    let mut of_solid: Vec<(&str, bool)> =
        formats.map(|format| (format.key, o.format(format.key).is_some())).collect();
    of_solid.push(("tables", o.tables.is_some()));
    let of_grains =
        [("packing", o.packing.is_some()), ("state", o.state.is_some()), ("chains", o.chains.is_some())];
    let of_time = [
        ("frames", o.frames.is_some()),
        ("frames_at", o.frames_at.is_some()),
        ("history_interval", o.history_interval.is_some()),
        ("frame_steps", o.frame_steps.is_some()),
        ("history_steps", o.history_steps.is_some()),
        ("checkpoint", o.checkpoint.is_some()),
    ];
    let of_solid = of_solid.into_iter().map(|(key, given)| (key, given && scene.solid.is_none(), "[solid]"));
    let of_grains =
        of_grains.into_iter().map(|(key, given)| (key, given && scene.grains.is_empty(), "[[grains]]"));
    let of_time = of_time.into_iter().map(|(key, given)| (key, given && end == 0.0, TIME_INTEGRATION));
    match of_solid.chain(of_grains).chain(of_time).find(|(_, idle, _)| *idle) {
        None => Ok(()),
        Some((key, _, without)) => Err(o.no_effect(key, without)),
    }
}
