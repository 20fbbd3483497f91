"""Scenes as Python objects."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Iterable, Iterator, Mapping, MutableMapping, MutableSequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union, overload

from . import _trackbed
from .toml import document, is_list

if TYPE_CHECKING:
    from .scene_types import SceneTables

    if sys.version_info >= (3, 11):
        from typing import Unpack
    else:
        from typing_extensions import Unpack

UNSAVED = Path("scene.toml")


class Table(MutableMapping[str, Any]):
    """Table of a scene: `table.key` is `table["key"]`. Values are copied when they are set; `None` leaves a key out."""

    _entries: dict[str, Any]

    def __init__(self, entries: Mapping[str, Any] | None = None) -> None:
        object.__setattr__(self, "_entries", {})
        self.update(entries or {})

    def __getitem__(self, key: str) -> Any:
        return self._entries[key]

    def __setitem__(self, key: str, value: Any) -> None:
        if not isinstance(key, str):
            raise TypeError(f"found the key {key!r}, expected a text")
        self._entries[key] = kept(value)

    def __delitem__(self, key: str) -> None:
        del self._entries[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_") or key not in self._entries:
            keys = ", ".join(self.__dict__.get("_entries", {})) or "no keys"
            raise AttributeError(f"found no key {key!r}, expected one of {keys}")
        return self._entries[key]

    def __setattr__(self, key: str, value: Any) -> None:
        own = getattr(type(self), key, None)
        if isinstance(own, property):
            object.__setattr__(self, key, value)
        elif own is not None or key.startswith("_"):
            raise AttributeError(f'{key}: found a name of the class, expected table["{key}"] = …')
        else:
            self[key] = value

    def __delattr__(self, key: str) -> None:
        if key not in self._entries:
            raise AttributeError(f"found no key {key!r}")
        del self._entries[key]

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self._entries]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mapping) and tree(self) == tree(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(tree(self))


class Tables(MutableSequence[Table]):
    """List of tables of a scene, by index or by the value of `name`: `scene.grains[0]`, `scene.grains.ballast`."""

    _rows: list[Table]

    def __init__(self, rows: Iterable[Mapping[str, Any]] = ()) -> None:
        self._rows = [Table(row) for row in rows]

    def named(self, name: str) -> Table:
        """Returns the table of this name."""
        for row in self._rows:
            if row.get("name") == name:
                return row
        names = ", ".join(str(row["name"]) for row in self._rows if "name" in row) or "no names"
        raise KeyError(f"found no table {name!r}, expected one of {names}")

    @overload
    def __getitem__(self, index: int | str) -> Table: ...
    @overload
    def __getitem__(self, index: slice) -> Tables: ...
    def __getitem__(self, index: int | str | slice) -> Table | Tables:
        if isinstance(index, str):
            return self.named(index)
        return Tables(self._rows[index]) if isinstance(index, slice) else self._rows[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        if isinstance(index, str):
            index = self._rows.index(self.named(index))
        self._rows[index] = [Table(row) for row in value] if isinstance(index, slice) else Table(value)

    def __delitem__(self, index: int | str | slice) -> None:
        del self._rows[self._rows.index(self.named(index)) if isinstance(index, str) else index]

    def insert(self, index: int, value: Mapping[str, Any]) -> None:
        """Inserts a table."""
        self._rows.insert(index, Table(value))

    def __len__(self) -> int:
        return len(self._rows)

    def __getattr__(self, name: str) -> Table:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self.named(name)
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *(str(row["name"]) for row in self._rows if "name" in row)]

    def __eq__(self, other: object) -> bool:
        return is_list(other) and tree(self) == tree(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(tree(self))


class Scene(Table):
    """Scene built from Python objects, or loaded from a file and edited.

        scene = trackbed.Scene.load("inputs/ballast/box.toml")
        scene.grains.ballast.count = 200
        scene.track.load.maximum = "30 kN"
        result = trackbed.run(scene, "results/small")

        scene = trackbed.Scene(title="column", material=[{"name": "stone", …}], grains=[…], time={"end": 0.2})

    `run`, `check`, `explain` and `Simulation` accept it in place of a file. Types of the tables: `trackbed.scene_types`.
    Paths in a scene are relative to the folder of `path`.
    """

    _path: Path
    _original: tuple[str, dict[str, Any]] | None

    def __init__(self, tables: Mapping[str, Any] | None = None, /, **keys: Unpack[SceneTables]) -> None:
        super().__init__(tables)
        self.update(keys)
        object.__setattr__(self, "_path", tables.path if isinstance(tables, Scene) else UNSAVED)
        object.__setattr__(self, "_original", None)

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"]) -> Scene:
        """Reads a scene file. Included files stay included: a key of the scene takes precedence over theirs."""
        text, entries = _trackbed.read(path)
        scene = cls(entries)
        object.__setattr__(scene, "_path", Path(path))
        object.__setattr__(scene, "_original", (text, entries))
        return scene

    @property
    def path(self) -> Path:
        """File of the scene, `scene.toml` before it is saved: names it in messages; paths in the scene are relative to its folder."""
        return self._path

    @path.setter
    def path(self, path: Union[str, "os.PathLike[str]"]) -> None:
        object.__setattr__(self, "_path", Path(path))

    @property
    def text(self) -> str:
        """The scene as TOML; the text of its file if nothing has changed."""
        if self._original is not None and self._original[1] == tree(self):
            return self._original[0]
        return document(tree(self))

    def copy(self) -> Scene:
        """Returns an independent copy."""
        other = Scene(self)
        object.__setattr__(other, "_original", self._original)
        return other

    def set(self, overrides: Mapping[str, Any]) -> Scene:
        """Sets keys by their paths, as `set` of `run` does: `scene.set({"track.load.cycles": 10})`; `None` removes a key."""
        for path, value in overrides.items():
            *parents, last = path.split(".")
            table: Any = self
            for part in parents:
                if isinstance(table, Tables):
                    table = table[int(part)] if part.isdigit() else table[part]
                else:
                    table = table[part] if part in table else created(table, part)
                if not isinstance(table, (Table, Tables)):
                    raise ValueError(f"{path}: found the value {part!r}, expected a table")
            if isinstance(table, Tables):
                raise ValueError(f"{path}: found a list of tables, expected a key of a table")
            if value is None:
                table.pop(last, None)
            else:
                table[last] = value
        return self

    def save(self, path: Union[str, "os.PathLike[str]"], *, force: bool = False) -> Path:
        """Writes the scene to a file, completely or not at all, and returns it. Relative paths are adapted to its folder; comments
        are kept if nothing has changed. `force`: replaces another file."""
        path = Path(path)
        force = force or same(path, self.path)
        refuse(path, force)
        if path.parent.resolve() != self.path.parent.resolve():
            keys = relocated(tree(self), _schema(), self.path.parent, path.parent)
            self._entries.clear()
            self.update(keys)
        text = self.text
        self.path = write(path, text, force)
        object.__setattr__(self, "_original", (text, tree(self)))
        return path


SceneLike = Union[str, "os.PathLike[str]", Scene, Mapping[str, Any]]


def source(scene: SceneLike) -> tuple[str, str | None]:
    """Returns the file of a scene, and the text in its place unless the file has it."""
    if isinstance(scene, (str, os.PathLike)):
        return os.fspath(scene), None
    if not isinstance(scene, Mapping):
        raise TypeError(f"scene: found {scene!r}, expected a file, a Scene or a mapping")
    scene = scene if isinstance(scene, Scene) else Scene(scene)
    text = scene.text
    try:
        saved = scene.path.read_text(encoding="utf-8") == text
    except (OSError, ValueError):
        saved = False
    return os.fspath(scene.path), None if saved else text


def write(path: Path, text: str, replace: bool) -> Path:
    """Writes a text file, completely or not at all, and returns its path."""
    refuse(path, replace)
    target = path.resolve()
    part = target.with_name(f"{target.name}.{os.getpid()}.part")
    try:
        part.write_text(text, encoding="utf-8", newline="\n")
        if target.exists():
            shutil.copymode(target, part)
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)
    return path


def refuse(path: Path, replace: bool) -> None:
    """Refuses to replace a file."""
    if path.exists() and not replace:
        raise ValueError(f"{path}: found a file, expected none, or force=True to replace it")


def kept(value: Any) -> Any:
    """Returns a value as a table keeps it: a copy."""
    if isinstance(value, Mapping):
        return Table(value)
    if isinstance(value, Tables):
        return Tables(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if is_list(value):
        return Tables(value) if value and all(isinstance(row, Mapping) for row in value) else [kept(item) for item in value]
    return value


def tree(value: Any) -> Any:
    """Returns dictionaries and lists in place of tables."""
    if isinstance(value, Mapping):
        return {key: tree(entry) for key, entry in value.items() if entry is not None}
    return [tree(item) for item in value] if is_list(value) else value


def created(table: Table, key: str) -> Table:
    """Adds an empty table."""
    table[key] = {}
    added: Table = table[key]
    return added


def same(one: Path, other: Path) -> bool:
    """Whether two paths name the same existing file."""
    return one.exists() and other.exists() and one.samefile(other)


@lru_cache(maxsize=1)
def _schema() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(_trackbed.schema())
    return schema


def relocated(value: Any, kind: Mapping[str, Any], before: Path, after: Path) -> Any:
    """Returns a value of the schema `kind` with paths relative to the folder `before` as paths relative to `after`."""
    if "$ref" in kind:
        kind = _schema()["$defs"][str(kind["$ref"]).rsplit("/", 1)[1]]
    if isinstance(value, Mapping):
        keys = {key: below for part in [kind, *kind.get("oneOf", ()), *kind.get("anyOf", ())] for key, below in properties(part).items()}
        return {key: relocated(entry, keys.get(key, {}), before, after) for key, entry in value.items()}
    if is_list(value):
        return [relocated(item, kind.get("items", {}), before, after) for item in value]
    # A file that is not there may lie in the folder of an included file.
    if kind.get("format") != "path" or not isinstance(value, str) or os.path.isabs(value) or not (before / value).exists():
        return value
    try:
        return Path(os.path.relpath(before / value, after)).as_posix()
    except ValueError:  # other drive
        return os.fspath((before / value).resolve())


def properties(kind: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the keys of a table, or of the table that it refers to."""
    if "$ref" in kind:
        kind = _schema()["$defs"][str(kind["$ref"]).rsplit("/", 1)[1]]
    keys: dict[str, Any] = kind.get("properties", {})
    return keys
