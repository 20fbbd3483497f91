"""Coupled DEM-FEM solver for ballasted railway track.

    import trackbed

    result = trackbed.run("inputs/ballast/box.toml", set={"track.load.cycles": 10})
    print(result.summary["settlement"]["per_cycle"][-1])
    result.cycles.plot("cycle", "settlement [m]")

`run` carries a scene out as the program does, with the same files and the same bits; `Simulation` advances it window by window, with the
state as numpy arrays in between and forces on grains on request. Bad input is a `ValueError` with the program's sentence (file, line, key,
found, expected), a numerical failure a `NumericalError`; Ctrl-C keeps a checkpoint. SI units throughout.
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
