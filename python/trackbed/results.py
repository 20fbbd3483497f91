"""Results of a run."""

from __future__ import annotations

import csv
import importlib
import json
import os
import re
from functools import cached_property
from pathlib import Path
from typing import Any, Union
from xml.etree import ElementTree

import numpy as np

from .program import arguments
from .program import run_program


class Result:
    """Results of a run: `Result("results/box")`.

    Tables are pandas data frames where pandas is installed, else dictionaries of numpy arrays; columns are named with their units, as in the
    files.
    """

    def __init__(self, folder: Union[str, "os.PathLike[str]"]) -> None:
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ValueError(f"{self.folder}: found no such folder, expected the folder of the results of a run")

    def __repr__(self) -> str:
        return f"<trackbed.Result {str(self.folder)!r}: {self.status}>"

    @property
    def status(self) -> str:
        """"done", "interrupted" (stopped with a checkpoint), "failed: …", or "incomplete" without `summary.json`."""
        try:
            return str(self.summary.get("status"))
        except ValueError:
            return "incomplete"

    @property
    def checkpoint(self) -> Path | None:
        """Checkpoint of a stopped run, from which `run(…, resume=True)` continues; `None` of a complete run."""
        folder = self.folder / "checkpoint"
        return folder if folder.is_dir() else None

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`summary.json`: status, verdict, stages, model, energy, settlement, …"""
        file = self.folder / "summary.json"
        if not file.exists():
            raise ValueError(f"{file}: found no such file, expected the results of a run that has ended")
        summary: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        return summary

    @cached_property
    def log(self) -> str:
        """`log.txt`: what the program printed at the end."""
        return (self.folder / "log.txt").read_text(encoding="utf-8")

    @property
    def history(self) -> Any:
        """`history.csv`: quantities in time."""
        return self.table("history.csv")

    @property
    def cycles(self) -> Any:
        """`cycles.csv`: a row for each load cycle."""
        return self.table("cycles.csv")

    def table(self, name: str) -> Any:
        """A table of the folder by the name of its file, such as "history.csv" or "packing.csv"."""
        file = self._table_file(name)
        try:
            import pandas
        except ModuleNotFoundError:
            return columns(file)
        return pandas.read_csv(file)

    def dataset(self, name: str = "history.csv") -> Any:
        """A table as `xarray.Dataset`, which must be installed: variables by name, with the attribute `units`.

        The dimension is the first column if it ascends, as `time` of the history and `cycle` of the cycles; else `row`.
        """
        xarray = required("xarray")
        variables = {}
        for heading, values in columns(self._table_file(name)).items():
            label, unit = name_and_unit(heading)
            variables[label] = (values, {"units": unit} if unit else {})
        first, (index, _) = next(iter(variables.items()))
        ascends = index.dtype.kind == "f" and bool((np.diff(index) > 0).all())
        dimension = first if ascends else "row"
        data = {label: (dimension, values, attributes) for label, (values, attributes) in variables.items()}
        coordinates = {first: data.pop(first)} if ascends else {}
        title = self.summary.get("title", "") if (self.folder / "summary.json").exists() else ""
        return xarray.Dataset(data, coordinates, {"title": title, "source": str(self.folder / name)})

    def _table_file(self, name: str) -> Path:
        file = self.folder / name
        if not file.exists():
            there = ", ".join(sorted(path.name for path in self.folder.glob("*.csv"))) or "none"
            raise ValueError(f"{file}: found no such table, expected one of {there}")
        return file

    @cached_property
    def frames(self) -> list[dict[str, Any]]:
        """Frames in the order of time: `time` [s] and `files` by part ("grains", "walls", "solid", "chains", …)."""
        index = self.folder / "results.pvd"
        if not index.exists():
            return []
        by_time: dict[float, dict[str, Path]] = {}
        for entry in ElementTree.parse(index).getroot().iter("DataSet"):
            file = self.folder / entry.attrib["file"]
            part = file.stem.rsplit("_", 1)[0]
            by_time.setdefault(float(entry.attrib["timestep"]), {})[part] = file
        return [{"time": time, "files": files} for time, files in sorted(by_time.items())]

    def mesh(self, part: str, frame: int = -1) -> Any:
        """A part of a frame as a mesh of pyvista, which must be installed: `result.mesh("grains").plot()`. Parts: see `frames`."""
        pyvista = required("pyvista")
        files = self.frames[frame]["files"]
        if part not in files:
            raise ValueError(f"part: found {part!r}, expected one of {', '.join(sorted(files))}")
        return pyvista.read(files[part])

    def plot(self, frame: int = -1, **options: Any) -> Any:
        """A picture of a frame by pyvista: grains as spheres, the solid by its displacement. `options` are those of `Plotter.show`, such as
        `screenshot="bed.png"`."""
        pyvista = required("pyvista")
        plotter = pyvista.Plotter(off_screen=options.pop("off_screen", "screenshot" in options))
        files = self.frames[frame]["files"]
        if "grains" in files:
            grains = self.mesh("grains", frame)
            ball = pyvista.Sphere(radius=1.0, theta_resolution=16, phi_resolution=12)
            plotter.add_mesh(grains.glyph(geom=ball, scale="radius", orient=False, factor=1.0), color="#b7a98f", smooth_shading=True)
        for part in ("walls", "solid"):
            if part in files:
                mesh = self.mesh(part, frame)
                if part == "solid":
                    plotter.add_mesh(mesh.warp_by_vector("displacement"), scalars="displacement", show_edges=True)
                else:
                    plotter.add_mesh(mesh, color="#8899aa", opacity=0.3)
        return plotter.show(**options)

    def render(self, out: Union[str, "os.PathLike[str]"], **options: Any) -> Path:
        """Writes an image or a video with the program's renderer, without pyvista: `result.render("bed.png", frame="peak", deform=3)`.
        Options are those of `trackbed render`, with `_` in place of `-`; a list repeats an option. Returns the file."""
        run_program("render", self.folder, "--out", out, *arguments(options))
        return Path(out)

    def report(self, out: Union[str, "os.PathLike[str]"], *others: "Result", **options: Any) -> Path:
        """Writes an HTML report, with `others` a comparison. Options are those of `trackbed report`. Returns the file."""
        run_program("report", self.folder, *(other.folder for other in others), "--out", out, *arguments(options))
        return Path(out)


def required(package: str) -> Any:
    """Imports an optional package."""
    try:
        return importlib.import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise ModuleNotFoundError(f"found no package {package}, expected it: pip install {package}", name=package) from None


def name_and_unit(heading: str) -> tuple[str, str]:
    """Splits a heading such as `time [s]`."""
    found = re.fullmatch(r"(.*?) \[(.*)\]", heading)
    return (found[1], found[2]) if found else (heading, "")


def columns(file: Path) -> dict[str, np.ndarray]:
    """Columns of a table with a heading."""
    with open(file, newline="", encoding="utf-8") as rows:
        heading, *body = csv.reader(rows)
    values = list(zip(*body)) if body else [()] * len(heading)
    return {name: numbers(column) for name, column in zip(heading, values)}


def numbers(column: tuple[str, ...]) -> np.ndarray:
    """A column as numbers, empty places as not-a-number; as texts where it holds others."""
    try:
        return np.array([float(value) if value else np.nan for value in column])
    except ValueError:
        return np.array(column)
