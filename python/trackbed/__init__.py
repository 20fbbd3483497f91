"""Coupled DEM-FEM solver for ballasted railway track.

    import trackbed

    scene = trackbed.Scene.load("inputs/ballast/box.toml")
    scene.track.load.cycles = 10
    result = trackbed.run(scene, "results/box")
    print(result.summary["settlement"]["per_cycle"][-1])
    result.cycles.plot("cycle", "settlement [m]")

`run` accepts a file or a `Scene`; files and results are bitwise identical to the program's. `Simulation` advances a run window by window,
with the state as numpy arrays and forces on grains. Bad input is a `ValueError` with the program's message (file, key, found, expected), a
numerical failure a `NumericalError`; Ctrl-C and `STOP` keep a checkpoint. SI units throughout.
"""

from ._trackbed import NumericalError, __version__
from .functions import tabulate
from .results import Result
from .running import STOP, check, explain, new, run, schema, study
from .scene import Scene
from .simulation import Simulation

__all__ = [
    "NumericalError",
    "Result",
    "STOP",
    "Scene",
    "Simulation",
    "__version__",
    "check",
    "explain",
    "new",
    "run",
    "schema",
    "study",
    "tabulate",
]
