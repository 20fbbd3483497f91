"""Writes trackbed/scene_types.py from the schema of scenes: trackbed schema | python3 python/make_scene_types.py"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any

FILE = Path(__file__).resolve().parent / "trackbed" / "scene_types.py"
HEAD = '''"""Types of the tables of a scene, for editors and type checkers.

Generated from the schema by `python/make_scene_types.py`: do not edit. A quantity is a number in SI units or a string with a unit, such as
"20 MPa"; numpy scalars and arrays are accepted. Quotes in comments name values of other keys.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

import numpy as np
from numpy.typing import NDArray

if sys.version_info >= (3, 11):
    from typing import Required
elif TYPE_CHECKING:
    from typing_extensions import Required

Integer = Union[int, "np.integer[Any]"]
Float = Union[float, Integer, "np.floating[Any]"]
Quantity = Union[Float, str]
Bool = Union[bool, np.bool_]
File = Union[str, "os.PathLike[str]"]
Array = NDArray[Any]
Integers = Union[Sequence[Integer], Array]
Floats = Union[Sequence[Float], Array]
Quantities = Union[Sequence[Quantity], Array]
IntegerRows = Union[Sequence[Integers], Array]
FloatRows = Union[Sequence[Floats], Array]
Rows = Union[Sequence[Quantities], Array]
'''
LISTS = {"Integer": "Integers", "Float": "Floats", "Quantity": "Quantities", "Integers": "IntegerRows", "Floats": "FloatRows", "Quantities": "Rows"}
SCALARS = {"integer": "Integer", "number": "Float", "boolean": "Bool", "string": "str"}


def source(schema: dict[str, Any]) -> str:
    """Returns the text of the file."""
    tables = {**schema["$defs"], "SceneTables": schema}
    enumerations = {name: table for name, table in tables.items() if all("const" in choice for choice in table.get("oneOf", [{}]))}
    classes = {name: table for name, table in tables.items() if "properties" in table}
    unions = {name: table for name, table in tables.items() if name not in enumerations and name not in classes}
    own = {part: choice for name, table in unions.items() for part, choice in parts(name, table).items()}
    texts = [HEAD.rstrip()]
    texts += [enumeration(name, table) for name, table in enumerations.items()]
    texts += [typed_dict(name, table) for name, table in {**own, **classes}.items()]
    texts += [union(name, table) for name, table in unions.items()]
    return "\n\n\n".join(texts) + "\n"


def enumeration(name: str, table: dict[str, Any]) -> str:
    """Returns the type of a text with given values."""
    notes = [f'"{choice["const"]}": {choice.get("description", "")}' for choice in table["oneOf"]]
    values = ", ".join(json.dumps(choice["const"]) for choice in table["oneOf"])
    head = comment(table.get("description", name), "")
    return head + "".join(comment(note, "") for note in notes) + f"{name} = Literal[{values}]"


def parts(name: str, table: dict[str, Any]) -> dict[str, Any]:
    """Returns the tables of a choice of tables, with names."""
    choices = [choice for choice in table.get("oneOf", table.get("anyOf", [])) if "properties" in choice]
    constants = [next(value["const"] for value in choice["properties"].values() if "const" in value) for choice in choices]
    return {name + constant.title().replace("_", ""): choice for constant, choice in zip(constants, choices)}


def union(name: str, table: dict[str, Any]) -> str:
    """Returns the type of a choice."""
    others = [expression(choice) for choice in table.get("oneOf", table.get("anyOf", [])) if "properties" not in choice]
    return comment(table.get("description", name), "") + f"{name} = Union[{', '.join([*parts(name, table), *others])}]"


def typed_dict(name: str, table: dict[str, Any]) -> str:
    """Returns the class of a table."""
    required = table.get("required", [])
    keys = {key: expression(value) for key, value in table["properties"].items()}
    reserved = [key for key in keys if keyword.iskeyword(key)]
    notes = {key: value.get("description", "") for key, value in table["properties"].items()}
    text, base = "", "TypedDict"
    if reserved:
        entries = ", ".join(f'"{key}": "{keys[key]}"' for key in reserved)
        text = "".join(comment(f"`{key}`: {notes[key]}", "") for key in reserved)
        total = "" if set(reserved) <= set(required) else ", total=False"
        text += f'_{name} = TypedDict("_{name}", {{{entries}}}{total})\n\n\n'
        base = "_" + name
    text += f'class {name}({base}, total=False):\n    """{one_line(table.get("description", name))}"""\n'
    for key in keys:
        if key not in reserved:
            kind = f"Required[{keys[key]}]" if key in required else keys[key]
            text += "\n" + comment(notes[key], "    ") + f"    {key}: {kind}\n"
    return text.rstrip()


def expression(value: dict[str, Any]) -> str:
    """Returns the type of a value."""
    if "$ref" in value:
        return str(value["$ref"]).rsplit("/", 1)[1]
    if "const" in value:
        return f"Literal[{json.dumps(value['const'])}]"
    choices = [choice for choice in value.get("anyOf", []) if choice.get("type") != "null"]
    if any("pattern" in choice for choice in choices):
        return "Quantity"
    if choices:
        kinds = list(dict.fromkeys(expression(choice) for choice in choices))
        return kinds[0] if len(kinds) == 1 else f"Union[{', '.join(kinds)}]"
    kinds = [kind for kind in (value["type"] if isinstance(value["type"], list) else [value["type"]]) if kind != "null"]
    if kinds == ["array"]:
        return list_of(value)
    if value.get("format") == "path":
        return "File"
    if kinds == ["object"]:
        return f"Mapping[str, {expression(value['additionalProperties'])}]"
    return SCALARS[kinds[0]]


def list_of(value: dict[str, Any]) -> str:
    """Returns the type of a list."""
    if "prefixItems" in value:
        items = {expression(item) for item in value["prefixItems"]}
        item = "Quantity" if items <= {"Quantity", "Float"} and "Quantity" in items else items.pop()
    else:
        item = expression(value["items"])
    return LISTS.get(item, f"Sequence[{item}]")


def one_line(text: str) -> str:
    """Returns a text without line breaks."""
    return " ".join(text.split())


def comment(text: str, indent: str) -> str:
    """Returns a comment."""
    lines = textwrap.wrap(one_line(text), 130, initial_indent=indent + "# ", subsequent_indent=indent + "# ")
    return "".join(line + "\n" for line in lines)


if __name__ == "__main__":
    FILE.write_text(source(json.loads(sys.stdin.buffer.read())), encoding="utf-8")
