"""The package against the program: same bits, same sentences; python -m pytest python/tests"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import trackbed

REPOSITORY = Path(__file__).resolve().parent.parent.parent
BOX = REPOSITORY / "inputs" / "ballast" / "box.toml"
# A small bed: 60 stones, two cycles.
SMALL = {
    "walls.2.point": [0.3, 0, 0],
    "grains.0.count": 60,
    "grains.0.fill.high": [0.3, 0.3],
    "track.sleeper.size": [0.28, 0.28, 0.1],
    "track.sleeper.centre": [0.15, 0.15],
    "track.load.minimum": "1 kN",
    "track.load.maximum": "10 kN",
    "track.load.cycles": 2,
    "compaction.0.force": "10 kN",
    "compaction.0.cycles": 1,
    "compaction.0.region": [[0.05, 0.05, 0.02], [0.25, 0.25, 0.1]],
    "measure.core.box": [[0.05, 0.05, 0.02], [0.25, 0.25, 0.1]],
    "deposition.level": None,
    "output.frames": 2,
}
FALLING = """
title = "falling"
[[material]]
name = "stone"
density = 2600
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.5
[[grains]]
name = "balls"
shape = "sphere"
material = "stone"
spheres = [[0, 0, 1, 0.1], [0.5, 0, 1, 0.1], [5, 0, 1, 0.2]]
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"
[time]
end = 0.2
[output]
frames = 2
"""
BLOCK = """
title = "block"
[solid]
gravity = false
[solid.block]
x = { lines = [0.0, 1.0], counts = [2] }
y = { lines = [0.0, 1.0], counts = [2] }
z = { lines = [0.0, 1.0], counts = [2] }
[solid.dynamics]
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
[[solid.material]]
id = 1
name = "soil"
young = "50 MPa"
poisson = 0.3
density = 1900
[[solid.load]]
kind = "pressure"
faces_in = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0]]
pressure = "50 kPa"
[time]
solid_step = "1 ms"
end = 0.02
[output]
frames = 1
"""


@pytest.fixture
def falling(tmp_path):
    """Three spheres at rest, the last one far from the others."""

    scene = tmp_path / "falling.toml"
    scene.write_text(FALLING)
    return scene


def test_stepwise_run_matches_program_bits(tmp_path):
    whole = trackbed.run(BOX, tmp_path / "whole", set=SMALL, threads=2)
    seen = []
    with trackbed.Simulation(BOX, tmp_path / "steps", set=SMALL, threads=1) as sim:
        x = sim.positions()
        while not sim.finished:
            sim.step(37)
            assert sim.positions(out=x) is x
            seen.append((sim.time, x[:, 2].mean()))
            sim.contacts(), sim.energy(), sim.velocities(), sim.orientations(), sim.spins()
    stepped = sim.result
    assert len(seen) > 20 and seen[-1][1] < seen[0][1]
    for name in ["history.csv", "cycles.csv"]:
        assert (whole.folder / name).read_bytes() == (stepped.folder / name).read_bytes(), name
    for before, after in zip(whole.frames, stepped.frames):
        assert before["files"]["grains"].read_bytes() == after["files"]["grains"].read_bytes()
    program = tmp_path / "program"
    words = [f"--set={key}={'' if value is None else json.dumps(value)}" for key, value in SMALL.items()]
    subprocess.run([sys.executable, "-m", "trackbed", "run", str(BOX), "--quiet", "--out", str(program), *words], check=True)
    assert (program / "history.csv").read_bytes() == (whole.folder / "history.csv").read_bytes()
    assert whole.summary["status"] == "done" and len(whole.summary["settlement"]["per_cycle"]) == 2


def test_free_fall_and_holding_force(falling, tmp_path):
    with trackbed.Simulation(falling, tmp_path / "out") as sim:
        assert len(sim) == 3 and sim.present().all() and list(sim.radii()) == [0.1, 0.1, 0.2]
        mass = sim.masses()
        assert mass == pytest.approx(2600 * 4 / 3 * np.pi * np.array([0.1, 0.1, 0.2]) ** 3)
        sim.apply_force(2, [0.0, 0.0, 9.81 * mass[2]])
        sim.run_until(0.1)
        x = sim.positions()
        assert x[0, 2] == pytest.approx(1 - 9.81 * sim.time**2 / 2, abs=1e-9)
        # A force from the start misses half a step of the leapfrog: 0.2 mm.
        assert x[2] == pytest.approx([5, 0, 1], abs=3e-4)
        # Its work is zero so far; then it lifts, against gravity, by work that the account knows; all of it half a step late again.
        sim.apply_force(2, [0.0, 0.0, 20.0 * mass[2]])
        before, z, begun = sim.energy()["applied_work"], sim.positions()[2, 2], sim.time
        sim.run_until(0.15)
        rise = sim.positions()[2, 2] - z
        assert rise == pytest.approx((20 - 9.81) * (sim.time - begun) ** 2 / 2, rel=0.02)
        assert sim.energy()["applied_work"] - before == pytest.approx(20 * mass[2] * rise, rel=0.01)
        sim.clear_forces()
        sim.run_until(1.0)
        assert sim.finished and sim.time < 0.21
    assert sim.result.summary["energy"]["relative_error"] < 1e-3


def test_bad_input_raises_value_error(falling, tmp_path):
    with pytest.raises(ValueError, match=r"grains\.0\.count.*found"):
        trackbed.run(BOX, tmp_path / "out", set={"grains.0.count": -1})
    with pytest.raises(ValueError, match=r"found the unknown key `cuont`, expected `count`"):
        trackbed.check(BOX, set={"grains.0.cuont": 1})
    with pytest.raises(ValueError, match="nosuch.toml"):
        trackbed.run(tmp_path / "nosuch.toml")
    assert not (tmp_path / "out").exists()
    with trackbed.Simulation(falling, tmp_path / "out") as sim:
        with pytest.raises(ValueError, match=r"out: found shape \[2, 3\], expected \(3, 3\)"):
            sim.positions(out=np.zeros((2, 3)))
        with pytest.raises(ValueError, match="contiguous"):
            sim.positions(out=np.zeros((3, 6))[:, ::2])
        with pytest.raises(IndexError, match="body: found 3, expected 0 to 2"):
            sim.apply_force(3, [0, 0, 1])
        with pytest.raises(ValueError, match="finite"):
            sim.apply_force(0, [0, 0, float("nan")])
        with pytest.raises(ValueError, match="no solid"):
            sim.displacements()
    with pytest.raises(RuntimeError, match="has ended"):
        sim.positions()
    with pytest.raises(ValueError, match="--force"):
        trackbed.run(falling, tmp_path / "out", set={"time.end": 0.1})


def test_a_numerical_failure_is_named(falling, tmp_path):
    with pytest.raises(trackbed.NumericalError, match="energy|body|t ="):
        with trackbed.Simulation(falling, tmp_path / "out") as sim:
            sim.apply_force(0, [0, 0, -1e12])
            while not sim.finished:
                sim.step(50)


def test_a_block_under_pressure(tmp_path):
    scene = tmp_path / "block.toml"
    scene.write_text(BLOCK)
    with trackbed.Simulation(scene, tmp_path / "out") as sim:
        nodes = sim.nodes()
        sim.run_until(0.01)
        u = sim.displacements()
        assert nodes.shape == u.shape == (81, 3)
        assert u[nodes[:, 2] == 0].max() == 0 and u[nodes[:, 2] == 1][:, 2].max() < -1e-4
        with pytest.raises(ValueError, match="no grains"):
            sim.positions()


def test_closed_run_resumes(falling, tmp_path):
    whole = trackbed.run(falling, tmp_path / "whole")
    with trackbed.Simulation(falling, tmp_path / "parts") as sim:
        sim.run_until(0.05)
    assert not sim.finished
    rest = trackbed.run(falling, tmp_path / "parts", resume=True)
    assert (whole.folder / "history.csv").read_bytes() == (rest.folder / "history.csv").read_bytes()


@pytest.fixture
def interrupts():
    """Ctrl-C as at a terminal, also where the tests run in the background, which ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_pauses_and_keeps_run(falling, tmp_path, interrupts):
    long = {"time.end": 1000.0, "output.history_interval": 0.01}

    def press():
        time.sleep(0.5)
        os.kill(os.getpid(), signal.SIGINT)

    with trackbed.Simulation(falling, tmp_path / "steps", set=long) as sim:
        threading.Thread(target=press).start()
        begun = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            sim.step(10**9)
        assert time.monotonic() - begun < 2.0
        stopped = sim.time
        assert 0 < stopped < 1000 and sim.positions().shape == (3, 3)
        sim.step(5)
        assert sim.time > stopped
    threading.Thread(target=press).start()
    with pytest.raises(KeyboardInterrupt, match="--resume"):
        trackbed.run(falling, tmp_path / "run", set=long)


def test_interpreter_lock_is_released(falling, tmp_path):
    counted = []
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counted.append(1)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    with trackbed.Simulation(falling, tmp_path / "out", set={"time.end": 1000.0, "output.history_interval": 0.01}) as sim:
        thread.start()
        begun = time.monotonic()
        while time.monotonic() - begun < 0.5:
            sim.step(2000)
        stop.set()
        thread.join()
    assert len(counted) > 50


def test_callback_tables_and_reports(tmp_path):
    times = []
    result = trackbed.run(BOX, tmp_path / "out", set=SMALL, callback=lambda sim: times.append(sim.time), every=500)
    assert times[0] == 0 and times == sorted(times) and len(times) > 5
    history, cycles = result.history, result.cycles
    assert "time [s]" in history and len(cycles["settlement [m]"]) == 2
    assert result.frames[0]["time"] == 0 and set(result.frames[0]["files"]) >= {"grains"}
    report = trackbed.check(BOX, set=SMALL)
    assert report["title"] and report["grains"] and report["solid"] is None
    assert trackbed.schema()["$schema"]
    with pytest.raises(ValueError, match="nosuch.csv"):
        result.table("nosuch.csv")


def test_a_study(falling, tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        'title = "heights"\nscene = "falling.toml"\n[[axis]]\nname = "end"\nkey = "time.end"\nvalues = [0.05, 0.1]\n'
        '[[quantity]]\nname = "gravity"\nfile = "history.csv"\ncolumn = "grains_gravity"\ntake = "last"\nunit = "J"\n'
    )
    rows = trackbed.study(file, tmp_path / "study", jobs=1, threads=1)
    assert [row["end"] for row in rows] == ["0.05", "0.1"] and all(row["done"] == "1" for row in rows)
    file.write_text("nonsense = 1\n")
    with pytest.raises(ValueError, match="nonsense"):
        trackbed.study(file, tmp_path / "other")


def test_a_study_of_a_scene(falling, tmp_path):
    quantity = {"name": "gravity", "file": "history.csv", "column": "grains_gravity", "take": "last", "unit": "J"}
    axis = [{"key": "time.end", "values": [0.05, 0.1]}]
    tables = {"title": "heights", "scene": trackbed.Scene.load(falling), "axis": axis, "quantity": [quantity]}
    rows = trackbed.study(tables, tmp_path / "new" / "heights", jobs=1, threads=1)
    assert [row["end"] for row in rows] == ["0.05", "0.1"] and all(row["done"] == "1" for row in rows)
    assert {path.name for path in (tmp_path / "new").iterdir()} == {"heights", "heights.toml", "heights.scene.toml"}
    with pytest.raises(ValueError, match="heights.scene.toml: found a file"):
        trackbed.study(tables, tmp_path / "new" / "heights")
    again = trackbed.study({**tables, "scene": falling}, tmp_path / "new" / "heights", jobs=1, threads=1, force=True)
    assert [row["gravity [J]"] for row in again] == [row["gravity [J]"] for row in rows]
    with pytest.raises(ValueError, match="scene: found None"):
        trackbed.study({"axis": axis}, tmp_path / "none")


def test_help_reads_well():
    for item in [trackbed.run, trackbed.check, trackbed.explain, trackbed.study, trackbed.Simulation, trackbed.Result]:
        assert item.__doc__ and len(item.__doc__) > 40, item
    for name in ["positions", "velocities", "spins", "orientations", "radii", "masses", "present", "contacts", "displacements", "energy"]:
        assert getattr(trackbed.Simulation, name).__doc__, name
