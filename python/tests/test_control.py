"""Control of runs from callbacks: python -m pytest python/tests"""

from pathlib import Path

import numpy as np
import pytest

import trackbed

BOX = Path(__file__).resolve().parent.parent.parent / "inputs" / "ballast" / "box.toml"

STAGES = {
    "walls.2.point": [0.3, 0, 0],
    "grains.0.count": 60,
    "grains.0.fill.high": [0.3, 0.3],
    "track.sleeper.size": [0.28, 0.28, 0.1],
    "track.sleeper.centre": [0.15, 0.15],
    "track.load.minimum": "1 kN",
    "track.load.maximum": "10 kN",
    "track.load.cycles": 2,
    "compaction": None,
    "measure": None,
    "deposition.level": None,
    "output.frames": 2,
}


def test_stop_keeps_checkpoint(tmp_path, capfd, balls):
    def stop(sim):
        if sim.time >= 0.1:
            times.append(sim.time)
            return trackbed.STOP
        return False

    times = []
    whole = trackbed.run(balls(), tmp_path / "whole")
    part = trackbed.run(balls(), tmp_path / "part", callback=stop, progress=True)
    assert len(times) == 1 and part.status == part.summary["status"] == "interrupted"
    assert part.checkpoint == tmp_path / "part" / "checkpoint" and "interrupted" in repr(part)
    message = capfd.readouterr().err
    assert 'interrupted: stage "run"' in message and "trackbed.run(scene, " in message and "resume=True)" in message
    rows = trackbed.results.columns(part.folder / "history.csv")["time [s]"]
    assert 0.09 < rows[-1] <= times[0] and part.frames[0]["time"] == 0
    rest = trackbed.run(balls(), tmp_path / "part", resume=True)
    assert rest.status == "done" and rest.checkpoint is None
    assert (whole.folder / "history.csv").read_bytes() == (rest.folder / "history.csv").read_bytes()


def test_stop_called_in_callback(tmp_path, balls):
    def stop(sim):
        if sim.windows == 50:
            sim.stop()

    result = trackbed.run(balls(), tmp_path / "out", callback=stop, every=50)
    assert result.status == "interrupted" and result.checkpoint


@pytest.mark.parametrize("when", ["first", "last"])
def test_stop_at_ends(tmp_path, when, balls):
    def stop(sim):
        return trackbed.STOP if when == "first" or sim.finished else None

    result = trackbed.run(balls(), tmp_path / "out", callback=stop)
    assert result.status == ("interrupted" if when == "first" else "done")


def test_stopped_simulation(tmp_path, balls):
    with trackbed.Simulation(BOX, tmp_path / "out", set=STAGES) as sim:
        sim.step(5)
        done = sim.windows
        result = sim.stop()
        assert sim.stop() is sim.result is result
        assert result.status == "interrupted" and result.folder == sim.out == tmp_path / "out"
        with pytest.raises(RuntimeError, match="resume=True"):
            sim.step()
    with trackbed.Simulation(BOX, tmp_path / "out", set=STAGES, resume=True) as sim:
        assert sim.windows == done
    sim = trackbed.Simulation(balls(), tmp_path / "closed")
    sim.close()
    with pytest.raises(RuntimeError, match="has ended"):
        sim.stop()


def test_forces_on_all_bodies(tmp_path, balls):
    def hold(sim):
        if sim.time == 0:
            sim.apply_forces(np.outer(sim.masses(), [0, 0, 9.81]))
            heights.append(sim.positions()[:, 2])
        elif sim.finished:
            heights.append(sim.positions()[:, 2])
            with pytest.raises(ValueError, match=r"forces: found shape \[3, 3\], expected \(2, 3\)"):
                sim.apply_forces(np.zeros((3, 3)))
            with pytest.raises(ValueError, match="forces: found .* on body 1, expected finite numbers"):
                sim.apply_forces([[0, 0, 0], [0, 0, np.nan]])
            sim.apply_forces(np.zeros((2, 3), dtype=int))

    heights = []
    trackbed.run(balls(), tmp_path / "out", callback=hold, every=50)
    # Half a step of free fall before the first force.
    assert heights[1] == pytest.approx(heights[0], abs=1e-3)
