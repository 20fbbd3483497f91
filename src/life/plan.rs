//! Resolved life of a track: traffic in periods, tampings between them.

use super::file::{AxleTable, LifeFile, Tamping};
use crate::study;
use std::path::PathBuf;
use trackbed_input::scene::track::{HeldMotion, Sleeper};
use trackbed_input::scene::{Document, SceneError};
use trackbed_io::failure::Failure;

/// Exponent of Hettler's law.
const EXPONENT: f64 = 1.6;
/// Default difference of the packings.
const TOLERANCE: f64 = 0.3;
/// Time of a run without load [s].
const REST: &str = "50 ms";
/// Smallest displacement of a push: resistance is its force at 2 mm [m].
const PUSH: f64 = 2e-3;
/// Largest exponent.
const STEEPEST: f64 = 20.0;
/// Most repetitions.
const REPETITIONS: u32 = 10;
/// Most passages of a period.
const MOST: f64 = 4e9;

/// Life of a track.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Title.
    pub title: String,
    /// Scene.
    pub scene: PathBuf,
    /// Seeds of the packings.
    pub packings: Vec<u64>,
    /// Overrides of each packing.
    pub sets: Vec<Vec<String>>,
    /// Traffic at the end of each period [MGT].
    pub ends: Vec<f64>,
    /// Load cycles of each period.
    pub cycles: Vec<u32>,
    /// Load cycles of the scene per MGT.
    pub cycles_per_mgt: f64,
    /// Axle passages per MGT.
    pub axles_per_mgt: f64,
    /// Traffic per year [MGT].
    pub per_year: Option<f64>,
    /// Overrides that add the stages of a tamping, per tamping so far.
    stages: Vec<String>,
    /// First stage of the first tamping.
    first_stage: usize,
    /// Override with a push.
    push: Option<String>,
    /// Override that frees sleepers in the direction of the push.
    free: Option<String>,
    /// Whether the scene has cycle jumps, with their first cycle and largest jump.
    pub jump: Option<(u32, f64)>,
    /// Largest difference of the packings.
    pub tolerance: f64,
    /// Repetitions with shorter jumps.
    pub repetitions: u32,
}

impl Plan {
    /// Resolves a life file.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, file: &LifeFile) -> Result<Plan, Failure> {
        let folder = document.file().parent().map(PathBuf::from).unwrap_or_default();
        let path = folder.join(&file.scene);
        let mut scene = Document::open(&path)?;
        scene.set_all(&file.set)?;
        let parsed = scene.scene()?;
        let Some(track) = parsed.track.filter(|track| track.load.is_some()) else {
            return Err(document
                .error("scene", path.display().to_string(), "a scene with [track.load]")
                .into());
        };
        let mut distinct = file.packings.clone();
        distinct.sort_unstable();
        distinct.dedup();
        if file.packings.len() < 2 || distinct.len() < file.packings.len() {
            let found = format!("{:?}", file.packings);
            return Err(document.error("packings", found, "at least two seeds, each once").into());
        }
        let keys = study::seed_keys(&scene, &[])?;
        if keys.is_empty() {
            let expected = "a scene with grains at random places";
            return Err(document.error("scene", path.display().to_string(), expected).into());
        }
        let own = |seed: &u64| {
            file.set.iter().cloned().chain(keys.iter().map(|key| format!("{key}={seed}"))).collect()
        };
        let sets = file.packings.iter().map(own).collect();
        let [axles_per_mgt, cycles_per_mgt] = traffic(document, file)?;
        let ends = ends(document, file)?;
        let starts = std::iter::once(0.0).chain(ends.iter().copied());
        let cycles: Vec<f64> = starts.zip(&ends).map(|(a, b)| ((b - a) * cycles_per_mgt).round()).collect();
        if let Some(n) = cycles.iter().find(|n| !(1.0..=MOST).contains(*n)) {
            let expected = format!("periods of 1 to {MOST:.0} cycles");
            return Err(document.error("traffic.until", format!("a period of {n} cycles"), expected).into());
        }
        let tolerance = file.control.tolerance.unwrap_or(TOLERANCE);
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(document.error("control.tolerance", tolerance.to_string(), "above 0").into());
        }
        let repetitions = file.control.repetitions.unwrap_or(1);
        if repetitions > REPETITIONS {
            let expected = format!("at most {REPETITIONS}");
            return Err(document.error("control.repetitions", repetitions.to_string(), expected).into());
        }
        let stage = |table: &toml::Table| toml::Value::Table(table.clone()).to_string();
        let plan = Plan {
            title: if file.title.is_empty() { parsed.title } else { file.title.clone() },
            scene: path,
            packings: file.packings.clone(),
            sets,
            ends,
            cycles: cycles.into_iter().map(|n| n as u32).collect(),
            cycles_per_mgt,
            axles_per_mgt,
            per_year: file.traffic.per_year,
            stages: file.tamping.iter().flat_map(|t| &t.stages).map(stage).collect(),
            first_stage: parsed.compaction.len(),
            push: file.push.as_ref().map(stage),
            free: freed(&track.sleeper, pushed_axes(file)),
            jump: track.jump.map(|jump| (jump.first, jump.largest)),
            tolerance,
            repetitions,
        };
        plan.check_push(document, &scene)?;
        Ok(plan)
    }

    fn check_push(&self, document: &Document, scene: &Document) -> Result<(), SceneError> {
        let Some(push) = &self.push else { return Ok(()) };
        let mut scene = scene.clone();
        scene.set(&format!("track.push={push}"))?;
        let push = scene.scene()?.track.and_then(|track| track.push);
        match push.filter(|p| p.displacement.si <= PUSH) {
            Some(p) => {
                let expected = format!("more than {PUSH} m: resistance is the force at 2 mm");
                Err(document.error("push.displacement", format!("{} m", p.displacement.si), expected))
            }
            None => Ok(()),
        }
    }

    /// Overrides of a packing after `tampings`.
    fn bed(&self, packing: usize, tampings: usize) -> Vec<String> {
        let mut set = self.sets[packing].clone();
        let stages: Vec<&String> = (0..tampings).flat_map(|_| &self.stages).collect();
        let first = self.first_stage;
        set.extend(stages.iter().enumerate().map(|(k, s)| format!("compaction.{}={s}", first + k)));
        set
    }

    /// Overrides of a run without load, after `tampings`.
    pub fn at_rest(&self, packing: usize, tampings: usize) -> Vec<String> {
        let mut set = self.bed(packing, tampings);
        set.extend(["track.load=", "track.jump=", "track.push="].map(String::from));
        set.push(format!("time.end={REST}"));
        set
    }

    /// Overrides of a period of traffic; `shorter`: factor on the largest jump.
    pub fn under_traffic(&self, packing: usize, period: usize, shorter: f64) -> Vec<String> {
        let mut set = self.bed(packing, period);
        let cycles = self.cycles[period];
        set.push(format!("track.load.cycles={cycles}"));
        set.push("track.push=".into());
        match self.jump {
            Some((first, _)) if first >= cycles => set.push("track.jump=".into()),
            Some((_, largest)) if shorter != 1.0 => {
                set.push(format!("track.jump.largest={}", largest * shorter));
            }
            _ => {}
        }
        set
    }

    /// Overrides of a lateral push, if any.
    pub fn pushed(&self, packing: usize, tampings: usize) -> Option<Vec<String>> {
        let push = self.push.as_ref()?;
        let mut set = self.bed(packing, tampings);
        set.extend(["track.load=", "track.jump=", "time.end="].map(String::from));
        set.push(format!("track.push={push}"));
        set.extend(self.free.clone());
        Some(set)
    }

    /// Periods, tampings and runs, as text.
    pub fn listed(&self) -> String {
        let seeds: Vec<String> = self.packings.iter().map(u64::to_string).collect();
        let mut text = format!(
            "{}\n  packings with the seeds {}, {} runs of each at least\n",
            self.title,
            seeds.join(", "),
            self.steps()
        );
        let mut begun = 0.0;
        for (k, (end, cycles)) in self.ends.iter().zip(&self.cycles).enumerate() {
            let axles = (end - begun) * self.axles_per_mgt;
            text += &format!(
                "  period {}: {begun} to {end} MGT, {axles:.0} axles, {cycles} load cycles\n",
                k + 1
            );
            if k + 1 < self.ends.len() {
                text += &format!("  tamping {}: {} stages\n", k + 1, self.stages.len());
            }
            begun = *end;
        }
        match &self.push {
            Some(_) => text + "  lateral push of a copy of the bed after each\n",
            None => text,
        }
    }

    /// Runs of each packing without repetitions: bed, periods, tampings, a push after each.
    pub fn steps(&self) -> usize {
        2 * self.ends.len() * if self.push.is_some() { 2 } else { 1 }
    }
}

/// Axes of a push.
fn pushed_axes(file: &LifeFile) -> [bool; 2] {
    let direction = file.push.as_ref().and_then(|push| push.get("direction")?.as_array());
    [0, 1].map(|d| {
        let part =
            direction.and_then(|list| list.get(d)?.as_float().or(list[d].as_integer().map(|i| i as f64)));
        part.is_some_and(|x| x != 0.0)
    })
}

/// Override that frees motions, if any is held.
fn freed(sleeper: &Sleeper, axes: [bool; 2]) -> Option<String> {
    let freed =
        |motion: &HeldMotion| axes[0] && *motion == HeldMotion::X || axes[1] && *motion == HeldMotion::Y;
    sleeper.hold.iter().any(freed).then(|| {
        let left: Vec<String> =
            sleeper.hold.iter().filter(|m| !freed(m)).map(|m| format!("\"{}\"", m.name())).collect();
        format!("track.sleeper.hold=[{}]", left.join(", "))
    })
}

/// Axles per MGT, and load cycles with the same settlement.
fn traffic(document: &Document, file: &LifeFile) -> Result<[f64; 2], SceneError> {
    let t = &file.traffic;
    let exponent = t.exponent.unwrap_or(EXPONENT);
    let positive = [
        ("cycle", Some(t.cycle)),
        ("until", Some(t.until)),
        ("per_year", t.per_year),
        ("exponent", Some(exponent)),
    ];
    for (key, value) in positive {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(document.error(&format!("traffic.{key}"), value.to_string(), "above 0"));
        }
    }
    if exponent > STEEPEST {
        let expected = format!("at most {STEEPEST}");
        return Err(document.error("traffic.exponent", exponent.to_string(), expected));
    }
    let all = [AxleTable { load: t.cycle, share: 1.0 }];
    let axles = if t.axles.is_empty() { &all } else { t.axles.as_slice() };
    for (k, axle) in axles.iter().enumerate() {
        for (key, value) in [("load", axle.load), ("share", axle.share)] {
            if !(value.is_finite() && value > 0.0) {
                let key = format!("traffic.axles.{k}.{key}");
                return Err(document.error(&key, value.to_string(), "above 0"));
            }
        }
    }
    let sum: f64 = axles.iter().map(|a| a.share).sum();
    if (sum - 1.0).abs() > 1e-6 {
        return Err(document.error("traffic.axles", format!("shares with the sum {sum}"), "the sum 1"));
    }
    let mean: f64 = axles.iter().map(|a| a.share * a.load).sum();
    let equivalent: f64 = axles.iter().map(|a| a.share * libm::pow(a.load / t.cycle, exponent)).sum();
    Ok([1e6 / mean, 1e6 / mean * equivalent])
}

fn ends(document: &Document, file: &LifeFile) -> Result<Vec<f64>, SceneError> {
    let none = Tamping { at: Vec::new(), stages: Vec::new() };
    let tamping = file.tamping.as_ref().unwrap_or(&none);
    let rising = tamping.at.windows(2).all(|p| p[0] < p[1]);
    let within = tamping.at.iter().all(|at| *at > 0.0 && *at < file.traffic.until);
    if !(rising && within) {
        let expected = format!("rising values between 0 and `until`, {}", file.traffic.until);
        return Err(document.error("tamping.at", format!("{:?}", tamping.at), expected));
    }
    if file.tamping.is_some() && (tamping.at.is_empty() || tamping.stages.is_empty()) {
        let key = if tamping.at.is_empty() { "tamping.at" } else { "tamping.stages" };
        return Err(document.error(key, "none", "at least one"));
    }
    Ok(tamping.at.iter().copied().chain([file.traffic.until]).collect())
}
