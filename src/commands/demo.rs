//! `trackbed demo`: a small track from template to viewer.

use crate::cli::{DemoArgs, RunArgs, ViewArgs};
use crate::start;
use std::num::NonZeroUsize;
use trackbed_io::failure::Failure;
use trackbed_io::message;

/// Template.
const TEMPLATE: &str = "track";

/// Overrides: half a sleeper on a thinner bed, one load cycle.
const SET: &[&str] = &[
    "grains.0.count=420",
    "grains.1.count=45",
    "grains.2.count=45",
    "grains.0.fill={ low = [-0.7, 0.0, 0.0], high = [0.7, 0.6] }",
    "grains.1.fill={ low = [-0.7, 0.0, 0.0], high = [0.7, 0.22] }",
    "grains.2.fill={ low = [-0.7, 0.38, 0.0], high = [0.7, 0.6] }",
    "walls.2.point=[-0.7, 0.0, 0.0]",
    "walls.3.point=[0.7, 0.0, 0.0]",
    "deposition.level=\"0.17 m\"",
    "compaction.0.region=[[-0.5, 0.1, 0.03], [0.5, 0.5, 0.13]]",
    "compaction.1.region=[[-0.5, 0.1, 0.03], [0.5, 0.5, 0.13]]",
    "compaction.2.region=[[-0.5, 0.1, 0.03], [0.5, 0.5, 0.13]]",
    "compaction.0.force=\"20 kN\"",
    "compaction.2.force=\"20 kN\"",
    "compaction.1.level=\"0.32 m\"",
    "compaction.1.rest=\"1.0 s\"",
    "track.sleeper.size=[1.2, 0.28, 0.2]",
    "track.sleeper.mass=\"170 kg\"",
    "track.load.seats=[[-0.35, 0.0], [0.35, 0.0]]",
    "track.load.maximum=\"40 kN\"",
    "track.load.cycles=1",
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
        set: SET.iter().map(ToString::to_string).collect(),
        // The second time the completed run is shown.
        resume: results.exists(),
        ..RunArgs::default()
    })?;
    if args.no_view {
        return Ok(());
    }
    view(&ViewArgs {
        dir: results,
        set: Vec::new(),
        port: 0,
        export: None,
        every: NonZeroUsize::MIN,
        force: false,
        no_open: false,
    })
}
