"""Whole runs, checks, estimates and studies."""

from __future__ import annotations

import csv
import enum
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final, Union

from . import _trackbed
from .overrides import Overrides, assignments
from .program import arguments, run_program
from .results import Result
from .scene import Scene, SceneLike, source, tree, write
from .simulation import Simulation
from .toml import document

Folder = Union[str, "os.PathLike[str]"]


class Stop(enum.Enum):
    """Request of a callback."""

    STOP = "stop"


STOP: Final = Stop.STOP


def run(
    scene: SceneLike,
    out: Folder | None = None,
    *,
    set: Overrides = None,
    threads: int | None = None,
    memory: str | None = None,
    resume: bool = False,
    from_run: Folder | None = None,
    bed: bool = False,
    force: bool = False,
    strict: bool = False,
    progress: bool = False,
    callback: Callable[[Simulation], object] | None = None,
    every: int = 1,
) -> Result:
    """Runs a scene and returns its results.

    scene: a `Scene`, a mapping of its tables, or a scene file.
    out: folder of the results; default `results/<name>`, as of the program.
    set: overrides of keys: `{"track.load.cycles": 10}`, or `["track.load.cycles=10"]`; `None` as a value takes a key away.
    threads: default all cores. The results have the same bits for any number.
    memory: most that a solid may need, such as "8GB".
    resume: continue from the last checkpoint in `out`.
    from_run, bed: start from the end of a finished run in that folder, or with its bed only.
    force: replace what is in `out`.
    strict: refuse values that are not plausible.
    progress: show the program's progress on standard error.
    callback: called with the paused `Simulation` before the first window and after each `every` windows, the last included. If it
        returns `trackbed.STOP`, the run stops with a checkpoint, from which `resume=True` continues, and the results so far are
        returned, of the status "interrupted". Other values have no effect. An exception ends the run with a checkpoint.

    Raises `ValueError` (bad input; nothing is written), `NumericalError` (the last checkpoint is kept), `OSError` (the disk), and
    `KeyboardInterrupt` after Ctrl-C, with the command to resume.
    """
    given: dict[str, Any] = dict(
        out=out, threads=threads, memory=memory, resume=resume, from_run=from_run, bed=bed, force=force, strict=strict, progress=progress
    )
    if callback is None:
        file, text = source(scene)
        return Result(_trackbed.run(file, text, set=assignments(set), **paths(given)))
    with Simulation(scene, set=set, **given) as simulation:
        request = callback(simulation)
        while not simulation.finished:
            if request is STOP or simulation.stopped:
                return simulation.stop()
            simulation.step(every)
            request = callback(simulation)
        return simulation.finish()


def paths(options: dict[str, Any]) -> dict[str, Any]:
    """Options with their paths as texts."""
    return {name: os.fspath(value) if isinstance(value, os.PathLike) else value for name, value in options.items()}


def check(scene: SceneLike, *, set: Overrides = None, strict: bool = False) -> dict[str, Any]:
    """Reads and resolves a scene without running it, and reports what would happen, by name: `title`, `findings` (values that are not
    plausible), `solid`, `grains`, `coupling` and the `lines` that `trackbed check` prints. Raises `ValueError` for what a run would refuse."""
    report: dict[str, Any] = json.loads(_trackbed.check(*source(scene), assignments(set), strict))
    return report


def explain(scene: SceneLike, *, set: Overrides = None, threads: int | None = None, trial: float = 10.0) -> dict[str, Any]:
    """The report of `check` with the stages of a run, its memory, and `time`: seconds by stage, measured by a trial run of `trial` seconds."""
    report: dict[str, Any] = json.loads(_trackbed.explain(*source(scene), assignments(set), threads, trial))
    return report


def schema() -> dict[str, Any]:
    """JSON schema of scenes."""
    keys: dict[str, Any] = json.loads(_trackbed.schema())
    return keys


def study(
    study: Folder | Mapping[str, Any],
    out: Folder | None = None,
    *,
    jobs: int | None = None,
    threads: int | None = None,
    resume: bool = False,
    force: bool = False,
) -> list[dict[str, str]]:
    """Carries out a study as `trackbed study` does, every run a process of its own; the rows of its table (`study.csv`) by column.

    study: a study file, or a mapping of its tables, of which `scene` is a `Scene`, a mapping or a scene file. A mapping is saved beside
        `out`: `<out>.toml`, `<out>.scene.toml`.
    out: folder of the results; default `results/<name>`, of a mapping `results/study`.
    """
    name = "study" if isinstance(study, Mapping) else Path(study).stem
    folder = Path(out) if out is not None else Path("results") / name
    file = saved(study, folder, resume or force) if isinstance(study, Mapping) else study
    given = arguments({"jobs": jobs, "threads": threads, "resume": resume, "force": force, "quiet": True})
    run_program("study", file, "--out", folder, *given)
    with open(folder / "study.csv", newline="", encoding="utf-8") as rows:
        return list(csv.DictReader(rows))


def saved(tables: Mapping[str, Any], folder: Path, replace: bool) -> Path:
    """Writes the files of a study beside the folder of its results; returns the study file."""
    entries = tree(dict(tables))
    scene, file = tables.get("scene"), folder.with_name(f"{folder.name}.toml")
    folder.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(scene, Mapping):
        entries["scene"] = Scene(scene).save(folder.with_name(f"{folder.name}.scene.toml"), force=replace).name
    elif isinstance(scene, (str, os.PathLike)):
        entries["scene"] = Path(os.path.relpath(scene, folder.parent)).as_posix()
    else:
        raise ValueError(f"scene: found {scene!r}, expected a Scene, a mapping or a scene file")
    return write(file, document(entries), replace)


def new(template: str, folder: Folder | None = None) -> Scene:
    """Writes a template of the program, such as "footing", with its files into a folder (default of its name); returns its scene."""
    folder = Path(template if folder is None else folder)
    run_program("new", template, folder)
    return Scene.load(folder / "scene.toml")
