"""Scene of the tests."""

import numpy as np
import pytest

import trackbed


@pytest.fixture(scope="session")
def balls():
    """Function that builds two falling spheres from Python objects."""

    def build() -> trackbed.Scene:
        """The same scene from Python objects."""
        return trackbed.Scene(
            title="falling",
            material=[{"name": "stone", "density": 2600, "stiffness": "1 MN/m", "friction": 0.5, "restitution": np.float64(0.5)}],
            grains=[{"name": "balls", "shape": "sphere", "material": "stone", "spheres": np.array([[0, 0, 0.2, 0.1], [0.5, 0, 0.3, 0.1]])}],
            walls=[{"kind": "plane", "point": np.zeros(3), "normal": (0.0, 0.0, 1.0), "material": "stone"}],
            time={"end": 0.2},
            output={"frames": np.int32(2)},
        )

    return build


@pytest.fixture
def column():
    """Column without lateral strain under the pressure p, and its settlement p h / M."""
    young, poisson, height, pressure = 50e6, 0.3, 2.0, 80e3
    scene = trackbed.Scene(
        title="column",
        solid={
            "gravity": False,
            "block": {
                "x": {"lines": [0.0, 0.5], "counts": [1]},
                "y": {"lines": [0.0, 0.5], "counts": [1]},
                "z": {"lines": [0.0, height], "counts": [2]},
            },
            "material": [{"id": 1, "name": "soil", "young": young, "poisson": poisson, "density": 1900}],
            "support": [{"side": side, "directions": [side[0]]} for side in ["x-", "x+", "y-", "y+", "z-"]],
            "load": [{"kind": "pressure", "faces_in": [[0, 0, height], [0.5, 0.5, height]], "pressure": pressure}],
            "quasi_static": {},
        },
        probe=[{"name": "top", "at": [0, 0, height]}],
        time={"end": 1.0, "solid_step": 0.01},
        output={"frames": 1, "history_interval": 0.01},
    )
    modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    return scene, pressure * height / modulus
