"""Estimates of time against runs: how far off is `explain` for the scenes that are shipped?

    python3 tests/estimates.py BINARY [--threads N] [--cpu] [--only TEXT] [--most SECONDS] [--whole] [--set KEY=VALUE]

Runs `explain --json` and `run` for every scene in inputs/ and prints both times and their ratio, by stage. Long scenes
are shortened (SHORTER) unless --whole. --most: skip scenes estimated to take longer (900 s). --only TEXT (repeatable):
paths with this text. --set: for all scenes.

Wall times need an idle machine. --cpu: CPU seconds on one thread, robust to other load; `explain` still needs a free
core (`nice -n -15`). Exit code 1 if a ratio is outside 1/1.5 to 1.5 by more than a second, or a stage is unknown. Needs
Python 3.11.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time as clock
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FACTOR = 1.5
# Tolerance for other wall time.
FLOOR = 1.0
# Overrides that shorten long scenes.
SHORTER = {
    "ballast/triaxial-cyclic.toml": ["time.end=1.0"],
    "ice/pile.toml": ["time.end=5"],
    "track/bay/scene.toml": ["track.load.cycles=1"],
}
# Scenes of another command.
MODAL = ["verify/free_beam.toml"]


def scenes():
    """Scene files in inputs/."""
    for path in sorted((ROOT / "inputs").rglob("*.toml")):
        tables = tomllib.loads(path.read_text())
        if "scene" not in tables and "title" in tables:
            yield path


def explained(words):
    """Estimate, or None and the message."""
    done = subprocess.run(words, capture_output=True, text=True)
    time = json.loads(done.stdout)["time"] if done.returncode == 0 else None
    return time, done.stderr.strip()


def ran(words, cpu):
    """Seconds of a run and its stages."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        # CPU time needs no raised priority.
        calm = (lambda: os.nice(max(0, 5 - os.nice(0)))) if cpu else None
        begun = clock.monotonic()
        subprocess.run([*words, "--out", str(out), "--quiet"], check=True, stderr=subprocess.DEVNULL, preexec_fn=calm)
        summary = json.loads((out / "summary.json").read_text())
        elapsed = clock.monotonic() - begun
    # CPU fraction of the wall time, one thread.
    share = min(1.0, summary["cpu_seconds"] / elapsed) if cpu else 1.0
    took = {stage["name"]: share * stage["seconds"] for stage in summary["stages"]}
    return sum(took.values()), took


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binary")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--cpu", action="store_true")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--most", type=float, default=900.0)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    threads = 1 if arguments.cpu else arguments.threads
    threads = ["--threads", str(threads)] if threads else []
    wrong, count = [], 0
    print(f"{'scene':36} {'estimate [s]':>12} {'run [s]':>9} {'ratio':>6}  how it is known, stages: estimate/run")
    for scene in scenes():
        name = str(scene.relative_to(ROOT / "inputs"))
        if name in MODAL or arguments.only and not any(text in name for text in arguments.only):
            continue
        shorter = [] if arguments.whole else SHORTER.get(name, [])
        sets = [word for text in [*shorter, *arguments.set] for word in ("--set", text)]
        time, said = explained([arguments.binary, "explain", str(scene), "--json", *threads, *sets])
        if time is None:
            print(f"{name:36} no estimate: {said}")
            wrong.append(name)
            continue
        if time["seconds"] > arguments.most:
            print(f"{name:36} {time['seconds']:12.1f} {'':9} {'':6}  left out", flush=True)
            continue
        run, took = ran([arguments.binary, "run", str(scene), *threads, *sets], arguments.cpu)
        ratio = time["seconds"] / run if run > 0 else 1.0
        known = sorted({stage["known"] for stage in time["stages"]})
        far = not 1 / FACTOR <= ratio <= FACTOR and abs(time["seconds"] - run) > FLOOR
        if far or "unknown" in known and run > FLOOR:
            wrong.append(name)
        count += 1
        stages = ", ".join(f"{s['name']} {s['seconds']:.1f}/{took.get(s['name'], 0):.1f}" for s in time["stages"])
        how = " ".join(["with", *shorter]) + "; " if shorter else ""
        print(f"{name:36} {time['seconds']:12.1f} {run:9.1f} {ratio:6.2f}  {how}{', '.join(known)} ({stages})", flush=True)
    end = f"off by more than a factor of {FACTOR}: {', '.join(wrong)}" if wrong else f"all within a factor of {FACTOR}"
    print(f"{count} scenes compared, {end}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
