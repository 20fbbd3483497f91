"""Runs that are killed without warning at random moments, resumed and compared with runs without a break, byte by byte.

    python3 tests/random_kills.py BINARY [--kills N] [--threads N] [--seed N] [--only TEXT] [--device]

Uses the cases with `restart` of tests/scene_cases.toml: every stage of every kind of scene. A run saves twenty
checkpoints per second, is killed (SIGKILL) one to three times at uniformly random times, and completed. Comparison as in
tests/scene_hashes.py; exit code 1 on any difference. --device: killed runs use `--device gpu`, unsupported cases are
skipped; without a GPU, LD_LIBRARY_PATH may select tests/stand_in. Needs Python 3.11.
"""

import argparse
import collections
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import scene_hashes

# Static solution: no timed checkpoints.
STATIC = {"inputs/solid/slope.toml"}


def command(case, binary, out, threads):
    """Run of a case, with frequent checkpoints if supported."""
    more = [] if case["scene"] in STATIC else ["output.checkpoint=0.05"]
    sets = [f"--set={s}" for s in [*case.get("set", []), *more]]
    scene = str(scene_hashes.ROOT / case["scene"])
    return [binary, "run", scene, *sets, *case.get("more", []), "--threads", str(threads), "--out", str(out), "--quiet"]


def stage(folder):
    """Stage in the latest checkpoint header, or "none"."""
    heads = []
    for slot in sorted((folder / "checkpoint").glob("*")) if (folder / "checkpoint").is_dir() else []:
        lines = slot.read_bytes()[:4096].split(b"\n", 2)
        if len(lines) == 3 and b'"stage":"' in lines[1]:
            heads.append(lines[1].split(b'"stage":"')[1].split(b'"')[0].decode())
    return heads[-1] if heads else "none"


class Case:
    """A case and its uninterrupted results."""

    def __init__(self, case, binary, threads, work):
        self.case, self.binary, self.threads, self.work = case, binary, threads, work
        self.more = []
        whole = work / "whole"
        start = time.monotonic()
        _, self.status = scene_hashes.execute(command(case, binary, whole, threads), None)
        self.seconds = time.monotonic() - start
        self.files = scene_hashes.files(whole)

    def on_device(self):
        """Moves the killed runs to the GPU; whether the case is supported."""
        self.more = ["--device", "gpu"]
        out = self.work / "device"
        start = time.monotonic()
        done = subprocess.run([*command(self.case, self.binary, out, self.threads), *self.more], capture_output=True, text=True)
        self.seconds = time.monotonic() - start
        return "on a GPU" not in done.stderr or done.returncode != 2

    def attempt(self, rng, stages):
        """Kills one to three times, then completes; effective kills and differences."""
        out, done = self.work / "killed", 0
        shutil.rmtree(out, ignore_errors=True)
        words = [*command(self.case, self.binary, out, self.threads), *self.more]
        for _ in range(rng.randint(1, 3)):
            resume = ["--resume"] if out.is_dir() and any(out.iterdir()) else []
            process = subprocess.Popen([*words, *resume], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                if process.wait(rng.uniform(0.0, self.seconds)) != 0:
                    return done, [f"exit code {process.returncode}"]
                break
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                done += 1
                stages[stage(out)] += 1
        else:
            resume = ["--resume"] if out.is_dir() and any(out.iterdir()) else []
            finished = subprocess.run([*words, *resume], capture_output=True, text=True)
            if finished.returncode != 0:
                return done, [f"exit code {finished.returncode}: {finished.stderr.strip()}"]
        found = scene_hashes.files(out)
        return done, sorted(n for n in found.keys() | self.files.keys() if found.get(n) != self.files.get(n))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--device", action="store_true")
    options = parser.parse_args()
    rng, binary = random.Random(options.seed), str(pathlib.Path(options.binary).resolve())
    chosen = [c for c in scene_hashes.cases(options.only) if c.get("restart") and c.get("verb", "run") == "run"]
    kills, wrong, stages = 0, 0, collections.Counter()
    share = -(-options.kills // len(chosen))
    for at in chosen:
        work = pathlib.Path(tempfile.mkdtemp(prefix="random_kills_"))
        case, count = Case(at, binary, options.threads, work), 0
        if options.device and not case.on_device():
            print(f"{at['name']}: not on a device", file=sys.stderr, flush=True)
            shutil.rmtree(work)
            continue
        while count < share:
            done, differing = case.attempt(rng, stages)
            count += done
            if differing:
                wrong += 1
                print(f"{at['name']}: after {done} kills: {', '.join(differing)}", flush=True)
        shutil.rmtree(work)
        kills += count
        print(f"{at['name']}: {count} kills of runs of {case.seconds:.1f} s ({case.status})", file=sys.stderr, flush=True)
    where = ", ".join(f"{name} {n}" for name, n in stages.most_common())
    print(f"{kills} kills in {len(chosen)} cases, {wrong} runs differ afterwards; last checkpoint: {where}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
