"""A run that is advanced step by step."""

from __future__ import annotations

import os
import sys
from types import TracebackType
from typing import Any, Union

from . import _trackbed
from .overrides import Overrides, assignments
from .results import Result
from .scene import SceneLike, source


class Simulation(_trackbed.Simulation):
    """A run that pauses between windows, the steps in which grains and solid exchange forces and motions.

        with trackbed.Simulation("scene.toml") as sim:
            x = sim.positions()                  # (bodies, 3), a new array
            while not sim.finished:
                sim.step(100)                    # a hundred windows
                sim.positions(out=x)             # the same array, filled in place
                sim.apply_force(0, [0.0, 0.0, -10.0])
        print(sim.result.summary["energy"])

    Making it fills, settles and compacts the bed; it pauses before the first window of the loading. Options are those of `run`. The
    bits are those of a run without pauses, as long as no force is applied. Arrays are copies: bodies are reordered in memory as they
    move, so there are no views. Row k is always the same body.

    At the end of the `with` block a simulation whose last window is done completes its results; another one is stopped with a
    checkpoint, from which `resume=True` continues. Ctrl-C during a step pauses after the present window and raises `KeyboardInterrupt`; the
    simulation can continue.
    """

    def __new__(
        cls,
        scene: SceneLike,
        out: Union[str, "os.PathLike[str]", None] = None,
        *,
        set: Overrides = None,
        threads: int | None = None,
        memory: str | None = None,
        resume: bool = False,
        from_run: Union[str, "os.PathLike[str]", None] = None,
        bed: bool = False,
        force: bool = False,
        strict: bool = False,
        progress: bool = False,
    ) -> Simulation:
        self = super().__new__(
            cls, *source(scene), out, assignments(set), threads, memory, resume, from_run, bed, force, strict, progress
        )
        self._result = None
        self._progress = progress
        return self

    _result: Result | None
    _progress: bool

    def finish(self) -> Result:
        """Completes the run and returns its results; the state is then no longer in memory."""
        if self._result is None:
            self._result = Result(super().finish())
        return self._result

    def stop(self) -> Result:
        """Stops the run with a checkpoint, from which `resume=True` continues, and returns the results so far, of the status
        "interrupted"; a complete run is finished. The state is then no longer in memory."""
        if self._result is None:
            folder, message = self.halt()
            self._result = Result(folder)
            if message is not None and self._progress:
                print(message, file=sys.stderr)
        return self._result

    @property
    def stopped(self) -> bool:
        """Whether `stop` has ended the run."""
        return self._result is not None and not self.finished

    @property
    def result(self) -> Result:
        """Results of the run, which is finished first unless it was stopped."""
        return self.finish()

    def energy(self) -> dict[str, float]:
        """Energy stored now and spent so far [J], by the names of `history.csv`."""
        return dict(super().energy())

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if kind is None and self.finished:
            self.finish()
        else:
            self.close()

    def __repr__(self) -> str:
        return f"<trackbed.Simulation at {self.time:.6g} s, window {self.windows} of {self.windows_in_all}>"
