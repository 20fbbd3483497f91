"""Results in other packages: python -m pytest python/tests"""

import sys

import numpy as np
import pytest

import trackbed


@pytest.fixture(scope="module")
def result(tmp_path_factory, balls):
    return trackbed.run(balls(), tmp_path_factory.mktemp("results") / "falling")


def test_dataset(result):
    xarray = pytest.importorskip("xarray")
    history = result.dataset()
    assert isinstance(history, xarray.Dataset) and history.attrs["title"] == "falling"
    assert history.time.attrs["units"] == "s" and history.time.dims == ("time",)
    assert history.grains_kinetic.attrs["units"] == "J" and float(history.grains_kinetic.sel(time=0.0, method="nearest")) < 1e-3
    total = sum(history[name] for name in ["grains_kinetic", "grains_gravity", "contact_springs"])
    assert float(abs(total.diff("time")).max()) < float(history.grains_kinetic.max())
    with pytest.raises(ValueError, match="expected one of history.csv"):
        result.dataset("cycles.csv")


def test_dataset_of_other_tables(tmp_path):
    pytest.importorskip("xarray")
    (tmp_path / "cycles.csv").write_text("cycle,settlement [m],resilient_modulus [Pa]\n1,0.001,\n2,0.0015,1e8\n")
    cycles = trackbed.Result(tmp_path).dataset("cycles.csv")
    assert cycles.settlement.dims == ("cycle",) and float(cycles.settlement.sel(cycle=2)) == 0.0015
    assert cycles.resilient_modulus.attrs["units"] == "Pa" and np.isnan(cycles.resilient_modulus[0])
    (tmp_path / "grains.csv").write_text("stone,x [m]\nb,1\na,2\n")
    grains = trackbed.Result(tmp_path).dataset("grains.csv")
    assert grains.stone.dims == ("row",) and list(grains.stone.values) == ["b", "a"]


def test_mesh(result):
    pyvista = pytest.importorskip("pyvista")
    grains = result.mesh("grains")
    assert isinstance(grains, pyvista.DataSet) and grains.n_points == 2 and "radius" in grains.point_data
    assert result.mesh("grains", 0).points[:, 2] == pytest.approx([0.2, 0.3])
    with pytest.raises(ValueError, match="part: found 'solid', expected one of .*grains"):
        result.mesh("solid")


def test_mesh_of_solid(column, tmp_path):
    pytest.importorskip("pyvista")
    scene, settlement = column
    solid = trackbed.run(scene, tmp_path / "out").mesh("solid", -1)
    top = solid.points[:, 2] == 2.0
    assert solid.n_cells == 2 and solid["displacement"][top, 2] == pytest.approx(-settlement, rel=1e-5)
    assert solid.warp_by_vector("displacement").bounds[5] == pytest.approx(2.0 - settlement, rel=1e-5)


def test_missing_package_is_named(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    monkeypatch.setitem(sys.modules, "pyvista", None)
    for call, package in [(result.dataset, "xarray"), (result.plot, "pyvista"), (lambda: result.mesh("grains"), "pyvista")]:
        with pytest.raises(ModuleNotFoundError, match=f"found no package {package}, expected it: pip install {package}") as error:
            call()
        assert error.value.name == package


def test_render_and_report(result, tmp_path):
    picture = result.render(tmp_path / "picture.png", frame=0, size="320x240", hide=["edges", "legends"])
    assert picture.read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(ValueError, match="picture.png"):
        result.render(picture)
    assert result.render(picture, force=True, size="320x240") == picture
    assert "falling" in result.report(tmp_path / "both.html", result).read_text(encoding="utf-8")
