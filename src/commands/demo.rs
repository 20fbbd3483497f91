//! `trackbed demo`: a small track from template to viewer.

use crate::cli::{DemoArgs, RunArgs, ViewArgs};
use crate::failure::Failure;
use crate::message;
use crate::start;
use std::num::NonZeroUsize;

/// Template.
const TEMPLATE: &str = "track";

/// Overrides: a quarter of the stones, one load cycle.
const SET: [&str; 14] = [
    "grains.0.count=400",
    "grains.1.count=50",
    "grains.2.count=50",
    "compaction.0.rest=\"0.2 s\"",
    "compaction.1.rest=\"0.2 s\"",
    "compaction.2.rest=\"0.2 s\"",
    "compaction.0.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.08]]",
    "compaction.1.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.08]]",
    "compaction.2.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.08]]",
    "track.load.cycles=1",
    "track.load.frequency=\"16 Hz\"",
    "track.load.ramp=\"50 ms\"",
    "track.load.rest=\"20 ms\"",
    "output.frames=20",
];

/// Writes the scene unless it exists, runs it by `run` and shows the results by `view`.
///
/// # Errors
/// See [`Failure`].
pub fn demo(
    args: DemoArgs,
    run: impl FnOnce(RunArgs) -> Result<(), Failure>,
    view: impl FnOnce(&ViewArgs) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let folder = args.out.join("scene");
    let scene = folder.join(start::SCENE);
    if !scene.exists() {
        start::make(TEMPLATE, &folder)?;
    }
    let results = args.out.join("results");
    message::say(&format!("{}: small track, about one minute", scene.display()));
    run(RunArgs {
        scene,
        out: Some(results.clone()),
        threads: args.threads,
        set: SET.map(String::from).into(),
        // The second time the completed run is shown.
        resume: results.exists(),
        ..RunArgs::default()
    })?;
    if args.no_view {
        return Ok(());
    }
    view(&ViewArgs {
        dir: results,
        port: 0,
        export: None,
        every: NonZeroUsize::MIN,
        force: false,
        no_open: false,
    })
}
