"""Unused features cost nothing: python3 tests/pays_only.py PROGRAM

Each feature is added to a scene and removed by an override (`--set KEY=`). Removed: same stages, contact kernels,
predicted memory and files, instructions within 1 %, peak memory within 6 % (system scatter: 4). Added: something must
change. Instructions by `perf stat`, else `valgrind`, one thread. Exit code 0 if all hold.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
GRAINS = ("inputs/grains/box.toml", ["grains.0.count=1500", "time.end=0.05", "output.frames=1", "output.state=false"])
SOLID = ("inputs/solid/pulse.toml", ["output.frames=1"])
COLUMN = ("inputs/verify/wave_column.toml", ["output.frames=1"])
COUPLED = ("inputs/coupled/slab_mixed/scene.toml", ["time.end=0.05", "deposition.max_time=0.05", "output.frames=1", "output.state=false"])

# Name, scene, added key, value.
FEATURES = [
    ("rolling resistance", GRAINS, "material.0.rolling_friction", "0.1"),
    ("twisting resistance", GRAINS, "material.0.twisting_friction", "0.1"),
    ("adhesion", GRAINS, "contact.0.adhesion", "0.05"),
    ("dashpots of sliding", GRAINS, "material.0.tangential_damping_ratio", "0.5"),
    ("Walton and Braun's law", GRAINS, "contact.0.normal", '"walton_braun"'),
    ("wind", GRAINS, "wind", "{ drag = 0.9 }"),
    ("water", GRAINS, "water", "{ drag = 0.6 }"),
    ("settling", GRAINS, "deposition", '{ max_time = "10 ms", settled_speed = 0.01 }'),
    ("compaction", GRAINS, "compaction",
     '[{ kind = "vibration", region = [[0.03, 0.03, 0.0], [0.17, 0.17, 0.1]], amplitude = "0.1 mm", frequency = 200, cycles = 2, rest = "5 ms" }]'),
    ("outlet", GRAINS, "outlet", '[{ name = "below", point = [0, 0, -1], normal = [0, 0, -1] }]'),
    ("porosity in a box", GRAINS, "measure", '[{ name = "core", box = [[0.03, 0.03, 0.0], [0.17, 0.17, 0.1]] }]'),
    ("chains of strong contacts alone", GRAINS, "output.chains", '"strong"'),
    ("VTKHDF", GRAINS, "output.vtkhdf", "true"),
    ("Tecplot", SOLID, "output.tecplot", "true"),
    ("tables", SOLID, "output.tables", "true"),
    ("damping of the solid", COLUMN, "solid.rayleigh", "{ damping_ratio = 0.05, frequencies = [10, 100] }"),
    ("spread transfer", COUPLED, "coupling.transfer", '{ spread = "60 mm" }'),
    ("iterated exchange", COUPLED, "coupling.scheme", '"iterated"'),
]


PERF = ["perf", "stat", "-x", ",", "-e", "instructions:u"]
EMULATOR = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]


def counted(counter, command):
    done = subprocess.run(counter + command, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}: {done.stderr}")
    return done.stderr


def run(program, scene, sets, out):
    """Instructions; stages, contact kernels, predicted memory, file sizes; peak bytes."""
    scene = os.path.join(ROOT, scene)
    sets = [part for s in sets for part in ("--set", s)]
    command = [program, "run", scene, "--threads", "1", "--quiet", "--force", "--out", os.path.join(out, "results")] + sets
    count = os.path.join(out, "count")
    counted(PERF + ["-o", count], command)
    found = [int(line.split(",")[0]) for line in open(count) if re.match(r"[0-9]+,", line)]
    if not found:
        # Without counters of the processor: an emulator, then a run for memory and files.
        said = counted(EMULATOR, command)
        found = [int(re.search(r"refs:\s*([0-9,]+)", said).group(1).replace(",", ""))]
        counted([], command)
    instructions = found[0]
    summary = json.load(open(os.path.join(out, "results", "summary.json")))
    said = subprocess.run([program, "explain", scene, "--trial", "0"] + sets, capture_output=True, text=True, check=True).stdout
    lines = [line.strip() for line in said.splitlines() if re.match(r"\s*(stages|contact kernels|packed bed):", line)]
    # Machine-dependent speed.
    lines = [re.sub(r"; [0-9.]+ M sphere-steps/s.*", "", line) for line in lines]
    # Files with times.
    kept = lambda names: (f for f in names if f not in ("summary.json", "log.txt", "run.json"))
    paths = [os.path.join(base, f) for base, _, names in os.walk(os.path.join(out, "results")) for f in kept(names)]
    files = sorted(f"{path[len(out) + 9:]} {os.path.getsize(path)}" for path in paths)
    return instructions, lines + files, summary["peak_memory"]


def main():
    program, bad = os.path.abspath(sys.argv[1]), []
    base = {}
    print(f"{'feature':34} {'without':>9} {'with':>8} {'removed':>9} {'memory':>9}  what else is there with it")
    for name, (scene, sets), key, value in FEATURES:
        with tempfile.TemporaryDirectory() as out:
            if scene not in base:
                base[scene] = run(program, scene, sets, out)
        without = base[scene]
        with tempfile.TemporaryDirectory() as out:
            there = run(program, scene, sets + [f"{key}={value}"], out)
        # Memory is granted in portions: minimum of several runs.
        for turn in range(4):
            with tempfile.TemporaryDirectory() as out:
                again = run(program, scene, sets + [f"{key}={value}", f"{key}="], out)
            gone = again if turn == 0 or again[2] < gone[2] else gone
            if gone[2] < 1.03 * without[2]:
                break
        more, less, memory = there[0] / without[0] - 1, gone[0] / without[0] - 1, gone[2] / without[2] - 1
        other = [line for line in there[1] if line not in without[1]]
        good = abs(less) < 0.01 and gone[1] == without[1] and abs(memory) < 0.06 and (other or abs(more) > 1e-3)
        if not good:
            bad.append(name)
        shown = "; ".join(other)[:90]
        print(f"{name:34} {without[0] / 1e6:7.0f} M {100 * more:+7.2f}% {100 * less:+8.4f}% {100 * memory:+8.2f}%  {shown}{'' if good else '  FAILS'}", flush=True)
    print(f"{len(FEATURES)} features, {len(bad)} fail{': ' + ', '.join(bad) if bad else ''}")
    return 1 if bad else 0


sys.exit(main())
