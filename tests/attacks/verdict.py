"""Program runs and their checks."""

import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
import scene_hashes  # noqa: E402

CODES = {0, 2, 3, 130}
NOT_FINITE = re.compile(r"(?<![\w./\"'-])[-+]?(nan|inf|infinity)(?![\w./\"'-])", re.IGNORECASE)
# Time limit of commands without computation, on a loaded machine [s].
SOON = 20


def digest(folder):
    """Digests of a file, or of all files below a directory."""
    paths = [folder] if folder.is_file() else sorted(folder.rglob("*"))
    return {str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in paths if p.is_file()}


def not_finite(path):
    """Position of a non-finite number, if any."""
    if path.suffix in (".vtu", ".vtp"):
        root = ElementTree.fromstring(path.read_bytes())
        appended = root.find("AppendedData")
        appended = "" if appended is None else "".join((appended.text or "").split())[1:]
        for element in root.iter("DataArray"):
            kind = scene_hashes.NUMBERS[element.get("type")]
            content = scene_hashes.array(element, root, appended)
            count = len(content) // struct.calcsize(kind)
            if kind in "df" and any(v - v != 0 for v in struct.unpack(f"<{count}{kind}", content[: count * struct.calcsize(kind)])):
                return f"array {element.get('Name')}"
    elif path.suffix in (".csv", ".dat", ".json", ".txt", ".svg", ".pvd"):
        text = path.read_text(errors="replace")
        found = NOT_FINITE.search(text)
        if path.suffix == ".json":
            # JSON has no non-finite numbers, but strings may contain the words.
            found = NOT_FINITE.search(re.sub(r'"(\\.|[^"\\])*"', '""', text))
            json.loads(text)
        if found:
            return found.string[max(0, found.start() - 60) : found.end() + 20].replace("\n", " ")
    return None


class Bench:
    """Directory and counters of one kind."""

    def __init__(self, program, work, short, keep=None):
        self.program, self.work, self.short, self.keep = program, work, short, keep
        self.codes, self.faults, self.longest, self.attempts = {}, [], 0.0, 0

    def row(self, name):
        count = [self.codes.get(code, 0) for code in (0, 2, 3, 130)]
        cells = " ".join(f"{n:{w}}" for n, w in zip(count, (8, 8, 9, 8)))
        return f"{name:12} {self.attempts:8} {cells} {self.longest:7.1f} s {len(self.faults):6}"

    def fresh(self, name="out"):
        """Unused path."""
        path = self.work / name
        shutil.rmtree(path, ignore_errors=True)
        return path

    def fault(self, words, what):
        self.faults.append(f"{what}\n    {shlex.join(map(str, words))}")
        if self.keep:
            shutil.copytree(self.work, pathlib.Path(self.keep) / f"{self.work.name}_{len(self.faults)}", dirs_exist_ok=True)

    def attempt(self, *words, out=None, untouched=(), faults=1, stop=None, codes=CODES, env=None, wrap=(), soon=SOON, echo=True):
        """Runs the program; returns exit code and output, or None after a timeout.

        `out`: results directory, must be finite, unchanged after exit code 2; `untouched`: always unchanged. `stop`: interrupt
        after [s]. `faults`: allowed lines of bad input. `echo`: messages may quote non-finite numbers. `wrap`: command prefix.
        """
        command = [*map(str, wrap), str(self.program), *map(str, words)]
        before = {p: digest(p) for p in [*untouched, *([out] if out and out.exists() else [])]}
        begun = time.monotonic()
        environment = {k: v for k, v in os.environ.items() if k != "RUST_BACKTRACE"} | (env or {})
        process = subprocess.Popen(
            command, cwd=self.work, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        self.attempts += 1
        try:
            outputs = process.communicate(timeout=stop or soon)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT if stop else signal.SIGKILL)
            try:
                outputs = process.communicate(timeout=SOON)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                self.fault(command, f"no end {SOON} s after an interrupt")
                return None, ""
            if not stop:
                self.fault(command, f"no end within {soon} s")
                return None, ""
        took, code = time.monotonic() - begun, process.returncode
        self.codes[code] = self.codes.get(code, 0) + 1
        self.longest = max(self.longest, took)
        stdout, stderr = (text.decode(errors="replace") for text in outputs)
        for what in self.wrong(code, stdout, stderr, faults, codes, echo):
            self.fault(command, what)
        self.compare(command, code, before, out, untouched)
        return code, stdout + stderr

    def wrong(self, code, stdout, stderr, faults, codes, echo):
        """Errors in exit code and messages."""
        if code not in codes:
            yield f"exit code {code}: {stderr[-400:]}"
            return
        if "panicked" in stderr or "internal error" in stderr:
            yield f"a panic: {stderr[-400:]}"
        errors = [line for line in stderr.splitlines() if line.startswith("error: ")]
        if code in (2, 3) and not 1 <= len(errors) <= max(1, faults):
            yield f"{len(errors)} lines of error: {stderr[-400:]}"
        if code == 0 and errors:
            yield f"exit code 0 with an error: {stderr[-400:]}"
        text = stdout + ("" if code == 2 and echo else stderr)
        if found := NOT_FINITE.search(text):
            yield f"a number that is not finite: {text[max(0, found.start() - 80) : found.end() + 40]!r}"

    def compare(self, command, code, before, out, untouched):
        """Compares with expected files."""
        for path in untouched:
            if digest(path) != before[path]:
                self.fault(command, f"{path} differs afterwards")
        if not out:
            return
        if code == 2 and (digest(out) if out.exists() else {}) != before.get(out, {}):
            self.fault(command, f"bad input, but {out} differs afterwards")
        paths = [out] if out.is_file() else sorted(out.rglob("*"))
        for path in paths if code in (0, 3, 130) else []:
            try:
                where = not_finite(path) if path.is_file() and path.name != "log.txt" else None
            except (scene_hashes.Unreadable, ElementTree.ParseError, ValueError, KeyError, struct.error) as error:
                where = f"unreadable: {error}"
            if where:
                self.fault(command, f"{path}: not finite: {where}")
