"""Estimates of time against runs: how far off is `explain` for the scenes that are shipped?

    python3 tests/estimates.py BINARY [--threads N] [--only TEXT] [--most SECONDS]

Runs `explain --json` and then `run` for every scene in inputs/, one after the other, and prints the estimate, the time by the
clock of all stages, their ratio, and both times stage by stage. --most: leave out scenes that are estimated to take longer (900 s). --only TEXT (it may be
given again): scenes whose path contains the text. Exit code 1 where a ratio is outside 1/1.5 to 1.5 and more than a second is in
between. Nothing else should run on the machine meanwhile. Needs Python 3.11 and nothing else.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FACTOR = 1.5
# What a second by the clock may go to besides.
FLOOR = 1.0


def scenes():
    """Files in inputs/ that are scenes."""
    for path in sorted((ROOT / "inputs").rglob("*.toml")):
        tables = tomllib.loads(path.read_text())
        if "scene" not in tables and ("solid" in tables or "grains" in tables):
            yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("binary")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--most", type=float, default=900.0)
    arguments = parser.parse_args()
    threads = ["--threads", str(arguments.threads)] if arguments.threads else []
    wrong = []
    print(f"{'scene':42} {'estimate [s]':>12} {'run [s]':>9} {'ratio':>6}  how it is known")
    for scene in scenes():
        name = str(scene.relative_to(ROOT / "inputs"))
        if arguments.only and not any(text in name for text in arguments.only):
            continue
        words = [arguments.binary, "explain", str(scene), "--json", *threads]
        explained = subprocess.run(words, capture_output=True, text=True)
        time = json.loads(explained.stdout)["time"] if explained.returncode == 0 else None
        if time is None:
            print(f"{name:42} no estimate: {explained.stderr.strip()}")
            wrong.append(name)
            continue
        known = sorted({stage["known"] for stage in time["stages"]})
        if time["seconds"] > arguments.most:
            print(f"{name:42} {time['seconds']:12.1f} {'':9} {'':6}  left out", flush=True)
            continue
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            words = [arguments.binary, "run", str(scene), "--out", str(out), "--quiet", *threads]
            subprocess.run(words, check=True, stderr=subprocess.DEVNULL)
            summary = json.loads((out / "summary.json").read_text())
        run = sum(stage["seconds"] for stage in summary["stages"])
        ratio = time["seconds"] / run if run > 0 else 1.0
        if not 1 / FACTOR <= ratio <= FACTOR and abs(time["seconds"] - run) > FLOOR:
            wrong.append(name)
        took = {stage["name"]: stage["seconds"] for stage in summary["stages"]}
        stages = ", ".join(f"{s['name']} {s['seconds']:.1f}/{took.get(s['name'], 0):.1f}" for s in time["stages"])
        print(f"{name:42} {time['seconds']:12.1f} {run:9.1f} {ratio:6.2f}  {', '.join(known)} ({stages})", flush=True)
    print(f"{len(wrong)} off by more than a factor of {FACTOR}: {', '.join(wrong)}" if wrong else "all within the factor")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
