"""Compares the direct solver with CHOLMOD (METIS) and MKL PARDISO on one matrix, in turns.

usage: factor_peers.py BENCH SIDE [--cholmod PROGRAM] [--pardiso "PYTHON SCRIPT"] [--turns 3]

BENCH: output of `cargo bench --bench factor --no-run`; SIDE: elements per edge (16: 53,856 equations). Calls
`PROGRAM FILE metis` and `SCRIPT FILE pardiso_spd THREADS`, which print `factor2=SECONDS cpu2=SECONDS solve=SECONDS`
(repeated factorisation, its CPU time, solve).
"""
import argparse
import os
import re
import statistics
import subprocess
import tempfile


def figures(command, threads):
    environment = dict(os.environ, OPENBLAS_NUM_THREADS=str(threads), OMP_NUM_THREADS=str(threads))
    output = subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout
    return {key: float(value) for key, value in re.findall(r"(\w+)=([-+.\deE]+)(?:\s|$)", output)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bench")
    parser.add_argument("side")
    parser.add_argument("--cholmod")
    parser.add_argument("--pardiso", help="Python and script, separated by a blank")
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        matrix = os.path.join(folder, "matrix.bin")
        subprocess.run([options.bench, "write", matrix, options.side], check=True)
        for threads in (1, 2):
            programs = {"trackbed": [options.bench, "peer", options.side, str(threads)]}
            if options.cholmod:
                programs["CHOLMOD"] = [options.cholmod, matrix, "metis"]
            if options.pardiso:
                programs["PARDISO"] = [*options.pardiso.split(), matrix, "pardiso_spd", str(threads)]
            runs = {name: [] for name in programs}
            for _ in range(options.turns):
                for name, command in programs.items():
                    runs[name].append(figures(command, threads))
            print(f"{threads} thread(s), medians of {options.turns}:")
            median = {
                name: {key: statistics.median(run[key] for run in found) for key in found[0]}
                for name, found in runs.items()
            }
            ours = median["trackbed"]
            for name, theirs in median.items():
                cells = []
                for key in ("analyze", "factor1", "factor2", "cpu2", "solve"):
                    cells.append(f"{key} {theirs[key]:.4f} s (ours {ours[key] / theirs[key]:.2f} x)")
                print(f"  {name}: " + ", ".join(cells))


if __name__ == "__main__":
    main()
