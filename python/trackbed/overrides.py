"""Overrides of keys of a scene, as `--set` takes them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Union

from .toml import literal

Overrides = Union[Mapping[str, Any], Iterable[str], None]


def assignments(overrides: Overrides) -> list[str]:
    """`key.path=value` for each override of a mapping, or of a list of such texts.

    Values of a mapping are numbers, texts, truth values, lists and tables (mappings) of them; `None` takes the key away.
    """
    if overrides is None:
        return []
    if isinstance(overrides, str):
        raise TypeError(f"set: found the text {overrides!r}, expected a mapping, or a list of texts key=value")
    if isinstance(overrides, Mapping):
        return [f"{key}={'' if value is None else literal(value, key)}" for key, value in overrides.items()]
    return [str(assignment) for assignment in overrides]
