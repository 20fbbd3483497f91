"""Time functions of scenes from Python functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def tabulate(function: Callable[[Any], ArrayLike], times: ArrayLike) -> list[list[float]]:
    """Returns points `[[time, factor], …]` of a function of time, for the time histories of a scene, which are linear between points
    and constant beyond.

        times = np.linspace(0.0, 0.2, 201)
        scene.solid.load[0].history = {"kind": "table", "points": trackbed.tabulate(lambda t: np.sin(40 * t) ** 2, times)}
        scene.walls[5].servo.history = trackbed.tabulate(pulse, times)

    function: called once with the array of times [s]; returns an array of the same shape, or a constant.
    times: ascending times [s], from the start of the history. The error between points at a distance h is at most h² max|f″| / 8.
    """
    t = np.asarray(times, dtype=float)
    if t.ndim != 1 or t.size == 0 or not np.isfinite(t).all() or (np.diff(t) <= 0).any():
        raise ValueError(f"times: found an array of shape {t.shape}, expected ascending, finite times")
    factors = np.asarray(function(t), dtype=float)
    if factors.shape not in ((), t.shape):
        raise ValueError(f"function: found values of shape {factors.shape}, expected {t.shape}, one for each time")
    factors = np.broadcast_to(factors, t.shape)
    if not np.isfinite(factors).all():
        first = int(np.argmin(np.isfinite(factors)))
        raise ValueError(f"function: found {factors[first]} at {t[first]} s, expected finite values")
    return np.column_stack([t, factors]).tolist()  # type: ignore[no-any-return]
