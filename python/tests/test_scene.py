"""Scenes built and edited in Python: python -m pytest python/tests"""

import importlib.util
import os
from pathlib import Path

import numpy as np
import pytest

import trackbed
from trackbed.results import columns
from trackbed.scene import Table, tree
from trackbed.toml import document

PACKAGE = Path(__file__).resolve().parent.parent
INPUTS = PACKAGE.parent / "inputs"
BOX = INPUTS / "ballast" / "box.toml"
FALLING = """title = "falling"

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
spheres = [[0.0, 0.0, 0.2, 0.1], [0.5, 0.0, 0.3, 0.1]]

[[walls]]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "stone"

[time]
end = 0.2

[output]
frames = 2
"""


def test_types_match_schema():
    spec = importlib.util.spec_from_file_location("make_scene_types", PACKAGE / "make_scene_types.py")
    generator = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(generator)
    assert generator.FILE.read_text(encoding="utf-8") == generator.source(trackbed.schema()), "run trackbed schema | python3 python/make_scene_types.py"
    from trackbed import scene_types

    assert {"x", "y", "z"} <= set(scene_types.Block.__annotations__) and "from" in scene_types.ConeRegion.__annotations__


def test_scene_matches_file_bits(tmp_path, monkeypatch, balls):
    monkeypatch.chdir(tmp_path)
    scene = balls()
    assert scene.text == FALLING
    built = trackbed.run(scene)
    assert built.folder == Path("results/scene") and built.summary["title"] == "falling"
    Path("falling.toml").write_text(FALLING)
    read = trackbed.run("falling.toml")
    mapping = trackbed.run(tree(scene), tmp_path / "mapping")
    with trackbed.Simulation(scene, tmp_path / "steps") as sim:
        assert sim.out == tmp_path / "steps"
        sim.step(10)
        sim.finish()
    for result in [built, mapping, sim.result]:
        assert (result.folder / "history.csv").read_bytes() == (read.folder / "history.csv").read_bytes()
    # The results stand by themselves.
    assert list(tmp_path.iterdir()) and not Path("scene.toml").exists()
    assert built.report(tmp_path / "report.html").stat().st_size > 1000


def test_access_by_key_name_index(tmp_path):
    scene = trackbed.Scene.load(BOX)
    assert scene.path == BOX and scene.grains.ballast.count == scene.grains[0]["count"] == 410
    assert scene["track"].load.maximum == "40 kN" and "solid" not in scene
    scene.grains["ballast"].count = np.int64(60)
    scene.walls[2].point[0] = 0.4
    scene.walls.append({"kind": "plane", "point": [0, 0, 9], "normal": [0, 0, -1], "material": "box"})
    wall = scene.walls.pop()
    assert isinstance(wall, Table) and wall.point == [0, 0, 9] and len(scene.walls) == 5
    del scene.deposition.level
    scene.set({"output.frames": 2, "track.load.cycles": 3, "grains.0.seed": 4, "time.end": None, "grains.ballast.fill.high": [0.4, 0.3]})
    assert scene.output.frames == 2 and scene.grains.ballast.fill.high == [0.4, 0.3] and "end" not in scene.time
    other = scene.copy()
    other.grains[0].count = 1
    assert scene.grains[0].count == 60 and other != scene and other.path == scene.path
    assert "ballast" in dir(scene.grains) and "grains" in dir(scene) and trackbed.Scene(scene) == scene
    # Values are copied.
    plane = {"kind": "plane"}
    scene.walls = [plane, plane]
    scene.walls[0].kind = "mesh"
    assert scene.walls[1].kind == plane["kind"] == "plane"
    with pytest.raises(AttributeError, match="found no key 'garvity', expected one of title, include, material"):
        scene.garvity
    with pytest.raises(AttributeError, match="found no table 'sand', expected one of ballast"):
        scene.grains.sand
    with pytest.raises(AttributeError, match=r'clear: found a name of the class, expected table\["clear"\]'):
        scene.grains[0].clear = 0.1
    with pytest.raises(ValueError, match=r"title.key: found the value 'title', expected a table"):
        scene.set({"title.key": 1})


def test_edits_match_overrides(tmp_path):
    edits = {"grains.ballast.count": 100, "track.load.maximum": "30 kN", "measure": None}
    scene = trackbed.Scene.load(BOX).set(edits)
    expected = trackbed.check(BOX, set=edits)
    assert trackbed.check(scene)["lines"] == expected["lines"] != trackbed.check(BOX)["lines"]
    assert trackbed.check(trackbed.Scene.load(BOX), set=edits) == expected
    assert trackbed.explain(scene, trial=0)["grains"] == expected["grains"]


def test_saved_scene_finds_its_files(tmp_path, balls):
    scene = trackbed.Scene.load(BOX)
    scene.grains.ballast.count = 100
    before = trackbed.check(scene)
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    file = scene.save(folder / "mine.toml")
    assert scene.path == file and os.path.relpath(INPUTS / "data" / "gradations.csv", folder) in file.read_text().replace("/", os.sep)
    assert trackbed.check(file) == trackbed.check(scene) == before
    assert trackbed.Scene.load(file) == scene and [path.name for path in folder.iterdir()] == ["mine.toml"]
    with pytest.raises(ValueError, match="mine.toml: found a file, expected none, or force=True to replace it"):
        balls().save(file)
    balls().save(file, force=True)
    assert file.read_text() == FALLING


def test_save_is_complete_or_absent(tmp_path):
    file = tmp_path / "falling.toml"
    text = "# Two balls.\n" + FALLING
    file.write_text(text)
    scene = trackbed.Scene.load(file)
    scene.save(file)
    assert file.read_text() == text
    scene.walls[0].point = object()
    with pytest.raises(TypeError, match=r"walls.point: found <object"):
        scene.save(file)
    assert file.read_text() == text and len(list(tmp_path.iterdir())) == 1
    scene.walls[0].point = [0, 0, -1]
    scene.save(file)
    assert file.read_text() == FALLING.replace("point = [0.0, 0.0, 0.0]", "point = [0, 0, -1]")


def test_errors_name_file_and_key(tmp_path, monkeypatch, balls):
    monkeypatch.chdir(tmp_path)
    scene = balls()
    scene.walls[0].kind = "plain"
    with pytest.raises(ValueError, match=r"^scene.toml: walls.0.kind: found .*plain"):
        trackbed.run(scene)
    scene = balls()
    scene.grains[0].cuont = 3
    with pytest.raises(ValueError, match=r"^scene.toml: grains.0.cuont: found the unknown key"):
        trackbed.check(scene)
    Path("balls.toml").write_text(FALLING)
    scene = trackbed.Scene.load("balls.toml")
    scene.time.end = -1
    with pytest.raises(ValueError, match=r"^balls.toml: time.end: found -1"):
        trackbed.Simulation(scene)
    scene.save("balls.toml")
    with pytest.raises(ValueError, match=r"^balls.toml:23: time.end: found -1"):
        trackbed.run(scene)
    with pytest.raises(ValueError, match="none.toml"):
        trackbed.Scene.load("none.toml")
    Path("broken.toml").write_text("title = \n")
    with pytest.raises(ValueError, match=r"^broken.toml:1: syntax"):
        trackbed.Scene.load("broken.toml")
    with pytest.raises(TypeError, match="scene: found 3"):
        trackbed.run(3)
    assert not Path("results").exists()


@pytest.mark.parametrize("file", sorted(INPUTS.rglob("*.toml")), ids=lambda file: file.stem)
def test_text_keeps_all_values(file, tmp_path):
    try:
        scene = trackbed.Scene.load(file)
    except ValueError:
        pytest.skip("not valid by itself")
    copy = tmp_path / "include.toml"
    copy.write_text(document({**scene, "include": None}), encoding="utf-8")
    again = trackbed.Scene.load(copy)
    assert {key: value for key, value in scene.items() if key != "include"} == again and len(again) > 0


def test_text_of_unusual_values(tmp_path):
    values = {
        "title": 'a "b" \\ \n\x7f ü',
        "odd key": {"x.y": [True, 1e-300, float("inf"), -0.0, 2**40]},
        "long": list(range(100)),
        "rows": np.arange(90.0).reshape(30, 3),
        "empty": [],
        "nested": {"inner": {"deep": {}}, "text": "x" * 200},
        "mixed": [{"a": 1}, 2],
        "none": None,
    }
    file = tmp_path / "values.toml"
    file.write_text(document(values), encoding="utf-8")
    assert max(map(len, file.read_text().splitlines())) < 220
    loaded = tree(trackbed.Scene.load(file))
    del values["none"]
    assert loaded == {**values, "rows": values["rows"].tolist()}
    assert type(loaded["long"][0]) is int and type(loaded["rows"][0][0]) is float


def test_included_keys_are_replaced(tmp_path, balls):
    (tmp_path / "stone.toml").write_text('[[material]]\nname = "stone"\ndensity = 2600\nstiffness = "1 MN/m"\nfriction = 0.5\nrestitution = 0.5\n')
    scene = balls()
    scene.include = ["stone.toml"]
    scene.material = [{"name": "stone", "friction": 0.2}]
    scene.path = tmp_path / "scene.toml"
    assert trackbed.run(scene, tmp_path / "out").status == "done"
    (tmp_path / "below").mkdir()
    scene.save(tmp_path / "below" / "scene.toml")
    assert scene.include == ["../stone.toml"] and trackbed.check(scene)["title"] == "falling"


def test_start_from_run_of_scene(tmp_path, balls):
    first = trackbed.run(balls(), tmp_path / "first")
    second = trackbed.run(balls(), tmp_path / "second", from_run=first.folder)
    assert second.status == "done"
    z = [result.mesh("grains").points[:, 2] for result in [first, second]] if importlib.util.find_spec("pyvista") else None
    assert z is None or not np.array_equal(*z)


def test_template(tmp_path):
    scene = trackbed.new("footing", tmp_path / "footing")
    assert scene.path == tmp_path / "footing" / "scene.toml" and scene.solid.material.soil.cohesion == "20 kPa"
    assert "unknowns" in "".join(trackbed.check(scene)["lines"])
    with pytest.raises(ValueError, match="new: found foting, expected one of track, box"):
        trackbed.new("foting", tmp_path / "other")


def test_tabulated_load_matches_closed_form(tmp_path, column):
    """Error of linear interpolation: at most h² max|f''| / 8."""

    def pulse(t):
        return np.sin(np.pi * t) ** 2

    times = np.linspace(0.0, 1.0, 21)
    scene, settlement = column
    scene.solid.load[0].history = {"kind": "table", "points": trackbed.tabulate(pulse, times)}
    history = columns(trackbed.run(scene, tmp_path / "out").folder / "history.csv")
    found = -history["top_u_z [m]"] / settlement
    error = np.abs(found - pulse(history["time [s]"]))
    bound = 0.05**2 * 2 * np.pi**2 / 8
    assert 0.5 * bound < error.max() < 1.001 * bound
    assert np.abs(found - np.interp(history["time [s]"], times, pulse(times))).max() < 1e-9


def test_tabulate_checks_values():
    assert trackbed.tabulate(lambda t: 2.0, [0, 1]) == [[0.0, 2.0], [1.0, 2.0]]
    assert trackbed.tabulate(np.sin, np.array([0.0])) == [[0.0, 0.0]]
    with pytest.raises(ValueError, match="times: found .* expected ascending, finite times"):
        trackbed.tabulate(np.sin, [0.0, 0.0])
    with pytest.raises(ValueError, match=r"function: found values of shape \(2,\), expected \(3,\)"):
        trackbed.tabulate(lambda t: t[1:], [0.0, 1.0, 2.0])
    with pytest.raises(ValueError, match="function: found inf at 0.0 s"), np.errstate(divide="ignore"):
        trackbed.tabulate(lambda t: 1 / t, [0.0, 1.0])


def test_type_checkers_find_wrong_keys(tmp_path):
    api = pytest.importorskip("mypy.api")
    file = tmp_path / "user.py"
    file.write_text(
        "import numpy as np, trackbed\n"
        "from trackbed import scene_types\n"
        "wall: scene_types.Wall = {'kind': 'plane', 'point': np.zeros(3), 'normal': [0, 0, 1], 'material': 'stone'}\n"
        "scene = trackbed.Scene(walls=[wall], gravity=[0, 0, '-9.81 m/s2'], time={'end': np.float32(1.0)})\n"
        "scene = trackbed.Scene(grains=[{'name': 'b', 'shape': 'spher', 'material': 'stone'}])\n"
        "scene = trackbed.Scene(time={'ned': 1.0})\n"
        "scene = trackbed.Scene(tiem={'end': 1.0})\n"
    )
    output, _, _ = api.run(["--strict", "--cache-dir", str(tmp_path / "cache"), str(file)])
    lines = [line.split(": error: ") for line in output.splitlines() if ": error: " in line]
    assert [place.rsplit(":", 1)[1] for place, _ in lines] == ["5", "6", "7"], output
    assert "'spher'" in lines[0][1] and '"ned"' in lines[1][1] and '"tiem"' in lines[2][1]
