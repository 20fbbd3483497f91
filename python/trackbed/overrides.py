"""Overrides of keys of a scene, as `--set` takes them."""

from __future__ import annotations

import json
import numbers
from collections.abc import Iterable, Mapping
from typing import Any, Union

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
        return [f"{key}={'' if value is None else literal(value)}" for key, value in overrides.items()]
    return [str(assignment) for assignment in overrides]


def literal(value: Any) -> str:
    """A value as a scene writes it (TOML)."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {literal(entry)}" for key, entry in value.items()) + " }"
    if hasattr(value, "tolist"):
        value = value.tolist()
        if not isinstance(value, list):
            return literal(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(literal(entry) for entry in value) + "]"
    raise TypeError(f"set: found {value!r}, expected a number, a text, a truth value, a list or a table of these")
