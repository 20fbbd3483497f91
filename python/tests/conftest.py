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
