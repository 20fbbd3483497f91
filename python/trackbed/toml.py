"""TOML text of scenes."""

from __future__ import annotations

import json
import numbers
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

WIDTH = 110
BARE = re.compile(r"[A-Za-z0-9_-]+")


def document(tables: Mapping[str, Any]) -> str:
    """Returns a file with these tables; keys with the value `None` are left out."""
    return "\n".join(blocks("", tables, root=True)).lstrip("\n") + "\n"


def blocks(name: str, table: Mapping[str, Any], root: bool = False, header: str = "[{}]") -> Iterator[str]:
    """Yields the lines of a table and the tables in it."""
    present = {key: value for key, value in table.items() if value is not None}
    long = {key for key, value in present.items() if is_block(key, value, root)}
    # A header of its own only for tables that have more than tables.
    if not root and (len(long) < len(present) or not present or header != "[{}]"):
        yield "\n" + header.format(name)
    for key, value in present.items():
        if key not in long:
            yield f"{word(key)} = {value_lines(value, joined(name, key))}"
    for key in present:
        if key in long:
            below = joined(name, word(key))
            if isinstance(present[key], Mapping):
                yield from blocks(below, present[key])
            else:
                for row in present[key]:
                    yield from blocks(below, row, header="[[{}]]")


def is_block(key: str, value: Any, root: bool) -> bool:
    """Whether a value has a header: tables at the top, tables that do not fit on a line, lists of tables."""
    if isinstance(value, Mapping):
        return root or any(is_block(k, v, False) for k, v in value.items()) or len(f"{key} = {literal(value)}") > WIDTH
    return is_list(value) and len(value) > 0 and all(isinstance(row, Mapping) for row in value)


def is_list(value: Any) -> bool:
    """Whether a value is a list, tuple or the like."""
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def value_lines(value: Any, path: str) -> str:
    """Returns a value on one line, or a long list with one element on each."""
    line = literal(value, path)
    rows = plain(value)
    if len(line) <= WIDTH or not is_list(rows):
        return line
    if any(isinstance(row, Mapping) or is_list(plain(row)) for row in rows):
        return "[\n" + "".join(f"    {literal(row, path)},\n" for row in rows) + "]"
    return "[\n" + "".join(f"    {row},\n" for row in filled([literal(row, path) for row in rows])) + "]"


def filled(items: list[str]) -> Iterator[str]:
    """Yields lines of items, separated by commas."""
    line = ""
    for item in items:
        if line and len(line) + len(item) + 2 > WIDTH:
            yield line
            line = ""
        line = f"{line}, {item}" if line else item
    yield line


def joined(name: str, key: str) -> str:
    """Returns the path of a key."""
    return f"{name}.{key}" if name else key


def word(key: Any) -> str:
    """Returns a key, in quotes if needed."""
    if not isinstance(key, str):
        raise TypeError(f"found the key {key!r}, expected a text")
    return key if BARE.fullmatch(key) else quoted(key)


def quoted(text: str) -> str:
    """Returns a basic string."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def plain(value: Any) -> Any:
    """Returns numpy arrays and scalars as Python values, paths as texts."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.tolist() if hasattr(value, "tolist") else value


def literal(value: Any, path: str = "set") -> str:
    """Returns a value on one line; `path` names it in errors."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Mapping):
        entries = ((key, entry) for key, entry in value.items() if entry is not None)
        return "{ " + ", ".join(f"{word(key)} = {literal(entry, joined(path, key))}" for key, entry in entries) + " }"
    if is_list(value):
        return "[" + ", ".join(literal(entry, path) for entry in value) + "]"
    raise TypeError(f"{path}: found {value!r}, expected a number, a text, a truth value, a list or a table of these")
