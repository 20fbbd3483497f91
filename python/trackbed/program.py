"""Commands of the program, each in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from typing import Any, Union

from ._trackbed import NumericalError


def run_program(*words: Union[str, "os.PathLike[str]"]) -> str:
    """Runs a command and returns its output; a failure is an exception with the message of the program."""
    command = [sys.executable, "-m", "trackbed", *(os.fspath(word) for word in words)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8")
    if done.returncode == 0:
        return done.stdout
    kind = {2: ValueError, 3: NumericalError}.get(done.returncode, OSError)
    raise kind(done.stderr.strip().removeprefix("error: "))


def arguments(values: Mapping[str, Any]) -> list[str]:
    """Returns options of a command: `True` is a flag, `None` and `False` leave an option out, a list repeats it."""
    words = []
    for name, value in values.items():
        option = "--" + name.replace("_", "-")
        for item in value if isinstance(value, (list, tuple)) else [value]:
            if item is True:
                words.append(option)
            elif item is not None and item is not False:
                words.append(f"{option}={item}")
    return words
