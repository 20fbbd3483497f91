"""The compiled part of the package; use `trackbed`."""

import os
from pathlib import Path
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self, disjoint_base

__all__ = ["NumericalError", "Simulation", "__version__", "check", "command", "explain", "read", "run", "schema"]

__version__: str

_Path = Union[str, "os.PathLike[str]"]
_Array = NDArray[np.float64]

class NumericalError(RuntimeError):
    """The computation failed: what, where and when. The last checkpoint is kept."""

@disjoint_base
class Simulation:
    """A run that pauses between windows."""

    def __new__(
        cls,
        scene: _Path,
        text: Optional[str],
        out: Optional[_Path],
        set: Sequence[str],
        threads: Optional[int],
        memory: Optional[str],
        resume: bool,
        from_run: Optional[_Path],
        bed: bool,
        force: bool,
        strict: bool,
        progress: bool,
    ) -> Self: ...
    @property
    def time(self) -> float:
        """Time since loading began [s]."""
    @property
    def windows(self) -> int:
        """Windows done: steps in which forces and motions of grains and solid are exchanged, and rows may be written."""
    @property
    def windows_in_all(self) -> int:
        """Windows of the whole run, as far as is known."""
    @property
    def finished(self) -> bool:
        """Whether the last window is done. The results are complete after `finish`."""
    @property
    def out(self) -> Path:
        """Results directory, also of a run in progress."""
    @property
    def folder(self) -> Optional[Path]:
        """Folder of the results, once they are complete."""
    def step(self, windows: int = 1) -> None:
        """Advances by so many windows, or to the last one if that comes first. Ctrl-C pauses after the present window."""
    def run_until(self, time: float) -> None:
        """Advances to the end of the first window at or after `time` [s], or to the last one if that comes first."""
    def finish(self) -> Any:
        """Goes on to the end of the run, where its results are written; their folder (of `trackbed.Simulation`: their `Result`). The state is
        not in memory any more."""
    def close(self) -> None:
        """Stops a run that is not done; a checkpoint is kept, from which it can be resumed."""
    def halt(self) -> tuple[Path, Optional[str]]:
        """Stops the run with a checkpoint, of the first window at the earliest, and writes its results so far: their folder, and the
        message of the stop; no message if the run was complete."""
    def __len__(self) -> int:
        """Number of bodies: grains and sleepers, those that have not come yet and those that have left included."""
    def positions(self, out: Optional[_Array] = None) -> _Array:
        """Centres of mass [m], shape (bodies, 3); `out`: an array that is filled and returned."""
    def velocities(self, out: Optional[_Array] = None) -> _Array:
        """Velocities of the centres of mass [m/s], shape (bodies, 3), half a step before the present time."""
    def spins(self, out: Optional[_Array] = None) -> _Array:
        """Angular velocities [rad/s] in world axes, shape (bodies, 3)."""
    def orientations(self, out: Optional[_Array] = None) -> _Array:
        """Unit quaternions (w, x, y, z) that turn principal axes into those of the world, shape (bodies, 4)."""
    def radii(self) -> _Array:
        """Radii of the spheres around each body, or of the sphere that it is [m]."""
    def masses(self) -> _Array:
        """Masses [kg]."""
    def present(self) -> NDArray[np.bool_]:
        """Which bodies are there."""
    def contacts(self) -> tuple[NDArray[np.int64], _Array, _Array, _Array]:
        """Contacts: bodies (contacts, 2), the second -1 where it is a wall, the solid or another thing that is no body; points [m]
        (contacts, 3); forces on the first body [N] (contacts, 3); overlaps [m]."""
    def nodes(self, out: Optional[_Array] = None) -> _Array:
        """Nodes of the solid as its mesh has them [m], shape (nodes, 3)."""
    def displacements(self, out: Optional[_Array] = None) -> _Array:
        """Displacements of the nodes of the solid [m], shape (nodes, 3), as frames show them."""
    def energy(self) -> Any:
        """Energy stored now and spent so far [J], by name."""
    def apply_force(self, body: int, force: Union[Sequence[float], _Array]) -> None:
        """Pushes a body with a force [N] through its centre of mass in every step from now on; a further call replaces it, zero takes it
        away."""
    def apply_forces(self, forces: ArrayLike) -> None:
        """Applies forces [N], shape (bodies, 3), through the centres of mass in every step from now on, in place of all earlier ones."""
    def clear_forces(self) -> None:
        """Takes all applied forces away."""

def run(
    scene: _Path,
    text: Optional[str],
    out: Optional[_Path],
    set: Sequence[str],
    threads: Optional[int],
    memory: Optional[str],
    resume: bool,
    from_run: Optional[_Path],
    bed: bool,
    force: bool,
    strict: bool,
    progress: bool,
) -> Path: ...
def check(scene: _Path, text: Optional[str], set: Sequence[str], strict: bool) -> str: ...
def explain(scene: _Path, text: Optional[str], set: Sequence[str], threads: Optional[int], trial: float) -> str: ...
def schema() -> str: ...
def read(file: _Path) -> tuple[str, dict[str, Any]]: ...
def command(words: Sequence[str]) -> int: ...
