"""Hashes of everything that the scenes write: does a change of the program change any result?

    python3 tests/scene_hashes.py record BINARY TABLE [--threads N] [--jobs N] [--only TEXT] [--keep FOLDER] [--device]
    python3 tests/scene_hashes.py compare BINARY TABLE [the same options]
    python3 tests/scene_hashes.py list

`record` runs the cases of tests/scene_cases.toml and writes TABLE: case, file, SHA-256. `compare` lists rows that
differ, are missing or new (exit code 1). --keep FOLDER: keep the files. --only TEXT (repeatable): cases with this text.
--device: `--device gpu`, without unsupported cases; without a GPU, LD_LIBRARY_PATH may select tests/stand_in.

* .vtu, .vtp: elements, attributes, decoded arrays bitwise; not the storage: `format`, `offset`, `encoding`,
  `compressor`, `header_type`, `version`, ranges, white space.
* summary.json: without wall times, threads, memory, `version`, `scene_hash`, compiled libraries (MACHINE_KEYS).
* run.json: without `version` and scene path.
* log.txt: without wall times.
* `check`, `explain`: without memory, trial speed, vector instructions.
* checkpoint/, end.state: ignored; cases with `restart` are interrupted twice and must write the same files.
* Others (.csv, .dat, .svg, .pvd, .toml, .stl): byte by byte.

Needs Python 3.11.
"""

import argparse
import base64
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import tomllib
import xml.etree.ElementTree as ElementTree
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "tests" / "scene_cases.toml"
STORAGE = {"format", "offset", "encoding", "compressor", "header_type", "version", "RangeMin", "RangeMax"}
MACHINE_KEYS = {"stages.seconds", "newton.assembly_seconds", "newton.factor_seconds", "newton.solve_seconds"}
MACHINE_KEYS |= {"threads", "peak_memory", "cpu_seconds", "model.predicted_memory", "version", "scene_hash"}
MACHINE_KEYS |= {"libraries.path", "libraries.hash"}
HEADERS = {"UInt32": "I", "UInt64": "Q"}
NUMBERS = {"Float64": "d", "Float32": "f", "Int8": "b", "UInt8": "B", "Int16": "h", "UInt16": "H"}
NUMBERS |= {"Int32": "i", "UInt32": "I", "Int64": "q", "UInt64": "Q"}


class Unreadable(Exception):
    """Invalid result file."""


def blocks(text, header, compressed):
    """Bytes of an array: base64 header and data, plain or compressed."""
    width = struct.calcsize(header)

    def head(count):
        letters = 4 * ((count * width + 2) // 3)
        return struct.unpack_from(f"<{count}{header}", base64.b64decode(text[:letters])), letters

    if not compressed:
        # One stream, or two with padding between.
        (size,), letters = head(1)
        whole = base64.b64decode(text) if "=" not in text[:letters] else b""
        return whole[width : width + size] if whole else base64.b64decode(text[letters:])[:size]
    (count,), _ = head(1)
    sizes, letters = head(3 + count)
    data, at, parts = base64.b64decode(text[letters:]), 0, []
    for size in sizes[3:]:
        parts.append(zlib.decompress(data[at : at + size]))
        at += size
    return b"".join(parts)


def array(element, root, appended):
    """DataArray as little-endian bytes."""
    kind = NUMBERS.get(element.get("type"))
    if kind is None:
        raise Unreadable(f"an array of {element.get('type')}")
    form, text = element.get("format", "ascii"), "".join((element.text or "").split())
    if form == "ascii":
        values = [(float if kind in "df" else int)(word) for word in (element.text or "").split()]
        return struct.pack(f"<{len(values)}{kind}", *values)
    if form == "appended":
        text = appended[int(element.get("offset")) :]
    compressor = root.get("compressor")
    if compressor not in (None, "vtkZLibDataCompressor"):
        raise Unreadable(f"compressor {compressor}")
    return blocks(text, HEADERS[root.get("header_type", "UInt32")], compressor) if text else b""


def vtk(content):
    """Structure and decoded numbers of VTK XML."""
    root, digest = ElementTree.fromstring(content), hashlib.sha256()
    appended = root.find("AppendedData")
    if appended is not None and appended.get("encoding") != "base64":
        raise Unreadable("raw appended data")
    appended = "" if appended is None else "".join((appended.text or "").split())[1:]

    def walk(element):
        kept = sorted((k, v) for k, v in element.attrib.items() if k not in STORAGE)
        digest.update(f"<{element.tag} {kept}>".encode())
        if element.tag == "DataArray":
            digest.update(array(element, root, appended))
        for child in element:
            if child.tag != "AppendedData":
                walk(child)
        digest.update(b"</>")

    walk(root)
    return digest.hexdigest()


def summary(content):
    """Summary without times and machine data; numbers as text."""

    def clean(value, path):
        if isinstance(value, dict):
            return {k: clean(v, path + [k]) for k, v in value.items()}
        if isinstance(value, list):
            return [clean(v, path) for v in value]
        return None if ".".join(path) in MACHINE_KEYS else value

    tree = json.loads(content, parse_float=lambda t: "float " + t, parse_int=lambda t: "int " + t)
    return json.dumps(clean(tree, [])).encode()


def report(text):
    """Output of `check` and `explain` without machine data."""
    text = text.replace(str(ROOT), ".")
    text = re.sub(r"memory: [0-9.]+ [kMG]?B.*", "memory", text)
    text = re.sub(r"packed bed: .*", "packed bed", text)
    return re.sub(r"(four|eight) at a time \(.*?\)", "at a time", text).encode()


def digest_of(path):
    content = path.read_bytes()
    try:
        if path.suffix in (".vtu", ".vtp"):
            return vtk(content)
        if path.name == "summary.json":
            content = summary(content)
        if path.name == "run.json":
            content = json.dumps(json.loads(content) | {"version": "", "scene": ""}).encode()
    except (Unreadable, ElementTree.ParseError, ValueError, KeyError, struct.error, zlib.error) as error:
        return f"unreadable: {error}"
    if path.name == "log.txt":
        content = re.sub(rb"; time: assembly .*", b"", content)
        content = re.sub(rb"(?m)^(.+): [0-9.]+ s, ([0-9]+ (?:DEM|FEM) steps)", rb"\1: \2", content)
    return hashlib.sha256(content).hexdigest()


def files(folder):
    """Digests of all files below a directory."""
    found = sorted(p for p in folder.rglob("*") if p.is_file())
    names = [(p.relative_to(folder).as_posix(), p) for p in found]
    return {name: digest_of(p) for name, p in names if not name.startswith(("checkpoint/", "end.state"))}


def execute(command, cwd):
    done = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    errors = [line.strip() for line in done.stderr.replace("\r", "\n").splitlines() if "error" in line]
    return done, ": ".join([f"exit code {done.returncode}", *errors])


def interrupted(command, folder, seconds):
    """Runs with interruptions at the given times; their number."""
    count = 0
    for pause in seconds:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(pause)
        process.send_signal(signal.SIGINT)
        process.communicate()
        count += process.returncode == 130
        if (folder / "checkpoint").is_dir() and "--resume" not in command:
            command = command + ["--resume"]
    return count, execute(command, None)[1]


class NotOnDevice(Exception):
    """Case not supported on the device."""


def scene_rows(case, binary, threads, work, device):
    """Rows of a scene: reports and results."""
    scene, sets = str(ROOT / case["scene"]), [f"--set={s}" for s in case.get("set", [])]
    rows = {}
    for word, more in (("check", []), ("explain", ["--trial", "0"])):
        done, status = execute([binary, word, scene, *sets, *more], None)
        rows[f"({word})"] = hashlib.sha256(report(status + done.stdout)).hexdigest()
    verb, more = case.get("verb", "run"), case.get("more", [])
    out = work / "whole"
    command = [binary, verb, scene, *sets, *more, "--threads", str(threads)]
    if device:
        if verb != "run":
            raise NotOnDevice
        command += ["--device", "gpu"]
    start = time.monotonic()
    done, status = execute([*command, "--out", str(out)], None)
    if device and done.returncode == 2 and "on a GPU" in done.stderr:
        raise NotOnDevice
    seconds = time.monotonic() - start
    rows |= {"(exit)": status.replace(str(ROOT), ".")} | files(out)
    if case.get("restart"):
        again = work / "restarted"
        pauses = [0.35 * seconds, 0.4 * seconds]
        count, status = interrupted([*command, "--out", str(again)], again, pauses)
        found, whole = files(again), files(out)
        differing = sorted(n for n in found.keys() | whole.keys() if found.get(n) != whole.get(n))
        rows["(restart)"] = ", ".join(differing) + f" {status}" if differing else status
        if differing:
            print(f"{case['name']}: after a restart {rows['(restart)']}", file=sys.stderr)
        if count == 0:
            print(f"{case['name']}: was over before it could be interrupted", file=sys.stderr)
    return rows


def command_rows(case, binary, work):
    """Rows of other commands; `@`: repository root."""
    out = work / "whole"
    out.mkdir()
    rows = {}
    for number, words in enumerate(case["commands"]):
        done, status = execute([binary, *(w.replace("@", str(ROOT)) for w in words)], out)
        text = (status + done.stdout).replace(str(ROOT), ".")
        rows[f"({number}: {' '.join(words[:2])})"] = hashlib.sha256(text.encode()).hexdigest()
    return rows | files(out)


def run_case(case, binary, options):
    """Name, rows (None if unsupported) and seconds of a case."""
    threads, keep, device = options.threads, options.keep, options.device
    work = pathlib.Path(tempfile.mkdtemp(prefix="scene_hashes_"))
    start = time.monotonic()
    try:
        if "scene" in case:
            rows = scene_rows(case, binary, threads, work, device)
        elif device:
            raise NotOnDevice
        else:
            rows = command_rows(case, binary, work)
        for folder in work.iterdir() if keep else ():
            shutil.copytree(folder, pathlib.Path(keep) / case["name"] / folder.name, dirs_exist_ok=True)
    except NotOnDevice:
        rows = {}
    finally:
        shutil.rmtree(work)
    return case["name"], rows, time.monotonic() - start


def is_scene(path):
    """Scenes have a title, stone libraries and trains have none; studies name a scene."""
    content = tomllib.loads(path.read_text())
    return "title" in content and "scene" not in content


def cases(only):
    found = tomllib.loads(CASES.read_text())["case"]
    names = [c["name"] for c in found]
    assert len(set(names)) == len(names), "two cases have one name"
    scenes = {p.relative_to(ROOT).as_posix() for p in (ROOT / "inputs").rglob("*.toml") if is_scene(p)}
    without = scenes - {c.get("scene") for c in found}
    assert not without, f"{', '.join(sorted(without))}: no case in {CASES.name}"
    chosen = [c for c in found if not only or any(text in c["name"] for text in only)]
    for case in chosen:
        if "build" in case:
            subprocess.run(case["build"], cwd=ROOT, check=True)
    return chosen


def run_all(chosen, binary, options):
    """Rows of all cases, {(case, file): digest}, and the number of cases with rows."""
    table, count = {}, 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        tasks = [pool.submit(run_case, c, binary, options) for c in chosen]
        for task in tasks:
            name, rows, seconds = task.result()
            table |= {(name, file): digest for file, digest in rows.items()}
            count += bool(rows)
            status = rows.get("(exit)", "exit code 0") if rows else "not on a device"
            print(f"{seconds:6.1f} s  {name}: {len(rows)} rows, {status}", file=sys.stderr, flush=True)
    return table, count


def compare(found, expected):
    """Prints differing rows; their number."""
    differing = sorted(key for key in found.keys() | expected.keys() if found.get(key) != expected.get(key))
    for key in differing:
        word = "new" if key not in expected else "missing" if key not in found else "differs"
        values = [table.get(key, "") for table in (expected, found)]
        readable = [v if not re.fullmatch("[0-9a-f]{64}", v) else v[:8] for v in values]
        value = f": {readable[0]} -> {readable[1]}" if readable != [v[:8] for v in values] else ""
        print(f"{word:8} {key[0]}  {key[1]}{value}")
    print(f"{len(found)} rows, {len(differing)} differ")
    return len(differing)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mode", choices=["record", "compare", "list"])
    parser.add_argument("binary", nargs="?")
    parser.add_argument("table", nargs="?")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--keep")
    parser.add_argument("--device", action="store_true")
    options = parser.parse_args()
    chosen = cases(options.only)
    if options.mode == "list":
        print("\n".join(f"{c['name']}: {c.get('scene', 'commands')} {' '.join(c.get('set', []))}" for c in chosen))
        return 0
    if not options.table or not chosen:
        parser.error("BINARY and TABLE are needed" if chosen else "no case has such a name")
    start = time.monotonic()
    found, count = run_all(chosen, str(pathlib.Path(options.binary).resolve()), options)
    print(f"{count} of {len(chosen)} cases in {time.monotonic() - start:.0f} s", file=sys.stderr)
    if options.mode == "record":
        lines = [f"{case}\t{file}\t{digest}\n" for (case, file), digest in sorted(found.items())]
        pathlib.Path(options.table).write_text("".join(lines))
        return 0
    rows = [line.split("\t") for line in pathlib.Path(options.table).read_text().splitlines()]
    names = {name for name, _ in found} if options.device else {c["name"] for c in chosen}
    expected = {(case, file): digest for case, file, digest in rows if case in names}
    return 1 if compare(found, expected) else 0


if __name__ == "__main__":
    sys.exit(main())
