"""Attacks on results: damage, damaged checkpoints, kills."""

import shutil
import signal
import subprocess
import time

import scene_hashes

from .files import damaged
from .scenes import INPUTS, TINY
from .verdict import SOON


def command(scene, sets, out):
    return ["run", INPUTS / scene, *(f"--set={s}" for s in sets), "--quiet", "--threads", "1", "--out", out]


def good_results(bench, scenes):
    """Results by scene name."""
    found = {}
    for scene, sets in scenes:
        out = bench.fresh("good_" + scene.replace("/", "_"))
        bench.attempt(*command(scene, sets, out), out=out, codes={0}, soon=120)
        found[scene] = out
    return found


def results(bench, rng):
    """Commands on results with one damaged file."""
    sets = ["output.frames=2"]
    scenes = [TINY[0], ("verify/bounce.toml", [*sets, "output.vtkhdf=true"]), TINY[3]]
    good = good_results(bench, [s for s in scenes if s])
    while True:
        scene, whole = rng.choice(sorted(good.items()))
        out = bench.fresh("damaged")
        shutil.copytree(whole, out)
        file = rng.choice(sorted(p for p in out.rglob("*") if p.is_file() and p.suffix != ".py"))
        file.write_bytes(damaged(rng, file.read_bytes()))
        page, picture = bench.work / "page.html", bench.work / "picture.png"
        page.write_text("kept")
        for words in (
            ["view", out, "--export", page, "--force"],
            ["report", out, "--out", page, "--force"],
            ["render", out, picture],
        ):
            before = page.read_bytes()
            code, _ = bench.attempt(*words, untouched=[file], faults=20, codes={0, 2}, soon=60)
            if code == 2 and page.read_bytes() != before:
                bench.fault(words, "bad input, but the page differs afterwards")
        yield


def checkpoints(bench, rng):
    """Resuming from a damaged checkpoint: an error, or the files of an uninterrupted run."""
    scene, sets = "grains/box.toml", ["grains.0.count=300", "time.end=0.03", "output.frames=3", "output.checkpoint=0.02"]
    whole = good_results(bench, [(scene, sets)])[scene]
    files = scene_hashes.files(whole)
    broken = bench.fresh("broken")
    # Interrupted after its first checkpoint.
    process = subprocess.Popen([bench.program, *map(str, command(scene, sets, broken))], stderr=subprocess.DEVNULL)
    end = time.monotonic() + 10 * SOON
    while process.poll() is None and time.monotonic() < end and not list((broken / "checkpoint").glob("*.checkpoint")):
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    process.wait()
    if not list((broken / "checkpoint").glob("*")):
        bench.fault([scene], "no checkpoint after an interrupt")
        return
    while True:
        out = bench.fresh("resumed")
        shutil.copytree(broken, out)
        for file in sorted((out / "checkpoint").iterdir()):
            if file.is_file() and rng.random() < 0.7:
                file.write_bytes(damaged(rng, file.read_bytes()))
        code, _ = bench.attempt(*command(scene, sets, out), "--resume", codes={0, 2}, soon=60, out=out)
        if code == 0 and scene_hashes.files(out) != files:
            bench.fault(command(scene, sets, out), "a run from a damaged checkpoint ends with other results")
        yield


def kills(bench, rng):
    """Killed and resumed runs equal uninterrupted ones."""
    scenes = [
        ("grains/box.toml", ["grains.0.count=200", "time.end=0.05", "output.frames=3", "output.checkpoint=0.02"]),
        ("verify/bounce.toml", ["output.frames=3", "output.checkpoint=0.01"]),
        (TINY[6][0], [*TINY[6][1], "output.checkpoint=0.02"]),
    ]
    good = {}
    while True:
        scene, sets = rng.choice(scenes)
        if scene not in good:
            begun = time.monotonic()
            good[scene] = scene_hashes.files(good_results(bench, [(scene, sets)])[scene]), time.monotonic() - begun
        files, seconds = good[scene]
        out = bench.fresh("killed")
        words = command(scene, sets, out)
        process = subprocess.Popen([bench.program, *map(str, words)], stderr=subprocess.DEVNULL)
        try:
            process.wait(rng.uniform(0.0, seconds))
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        finished = process.returncode == 0
        there = out.is_dir() and any(out.iterdir())
        if not finished:
            code, _ = bench.attempt(*words, *(["--resume"] if there else []), out=out, codes={0}, soon=120)
            if code == 0 and scene_hashes.files(out) != files:
                bench.fault(words, "a run that was killed and gone on with ends with other results")
        else:
            bench.attempt(*words, untouched=[out], codes={2})
        yield
