"""Attacks on the program: hostile scenes, meshes, results, checkpoints, surroundings, kernels and clients, each with a verdict.

    python3 tests/attack.py PROGRAM [--short] [--seconds N] [--seed N] [--only KIND] [--keep FOLDER]

Failures: signal or panic, exit code other than 0, 2, 3 or 130, wrong number of lines for bad input, non-finite output,
changed unrelated files, timeout. All kinds take ten minutes (--seconds), with --short less than one; exit code 1 after a
failure. A seed gives the same attempts; their number depends on the time. Needs Python 3.11; clock and kernels need a C
compiler.
"""

import argparse
import pathlib
import random
import shutil
import sys
import tempfile
import time

from attacks import clients, files, kernels, outputs, scenes, surroundings
from attacks.verdict import Bench

# Kind: generator function (yields after each attempt), fraction of the time.
KINDS = {
    "keys": (scenes.keys, 5),
    "sizes": (scenes.sizes, 2),
    "materials": (scenes.materials, 2),
    "sleepers": (scenes.sleepers, 1),
    "borders": (scenes.borders, 1),
    "meshes": (files.meshes, 2),
    "surfaces": (files.surfaces, 1),
    "results": (outputs.results, 4),
    "checkpoints": (outputs.checkpoints, 3),
    "kills": (outputs.kills, 3),
    "clock": (surroundings.clock, 1),
    "limits": (surroundings.limits, 1),
    "clients": (clients.clients, 1),
    "kernels": (kernels.kernels, 3),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", action="append", default=[], choices=KINDS)
    parser.add_argument("--keep", help="folder for the files of attempts that fail")
    options = parser.parse_args()
    program = pathlib.Path(options.program).resolve()
    if not program.is_file():
        parser.error(f"PROGRAM: found no file {program}, expected target/release/trackbed")
    seconds = options.seconds or (30 if options.short else 600)
    chosen = {name: kind for name, kind in KINDS.items() if not options.only or name in options.only}
    total = sum(share for _, share in chosen.values())
    print(f"{'kind':12} {'attempts':>8} {'accepted':>8} {'rejected':>8} {'numerical':>9} {'stopped':>8} {'longest':>9} {'faults':>6}")
    faults = []
    for name, (attack, share) in chosen.items():
        work = pathlib.Path(tempfile.mkdtemp(prefix=f"attack_{name}_"))
        bench = Bench(program, work, options.short, options.keep)
        end = time.monotonic() + seconds * share / total
        try:
            for _ in attack(bench, random.Random(f"{options.seed} {name}")):
                if time.monotonic() > end:
                    break
        finally:
            shutil.rmtree(work, ignore_errors=True)
        print(bench.row(name), flush=True)
        faults += bench.faults
    print(f"{len(faults)} faults")
    for fault in faults:
        print(f"\n{fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
