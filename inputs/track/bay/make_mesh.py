"""Writes the mesh of the scene track/bay: NODECOORD.DAT, ELEMENTNUM.DAT, DOF.DAT.

Provenance of the committed files; nothing else needs it.    python3 make_mesh.py    (numpy, scipy)

The slice of ../cyclic/make_inputs.py with a crest for the full width of the ballast, and of it the half x >= 0.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "cyclic"))
import make_inputs as slice_of_track  # noqa: E402

slice_of_track.HALF_WIDTH = 8.0
slice_of_track.TOP = 3.1
slice_of_track.TOE = 3.1 + slice_of_track.SLOPE * 1.0
slice_of_track.INNER, slice_of_track.N_INNER = 2.6, 22

points, elements = slice_of_track.grid()
elements = [(m, nodes) for m, nodes in elements if points[np.array(nodes) - 1, 0].mean() > 0.0]
kept = sorted({n for _, nodes in elements for n in nodes})
number = {n: i + 1 for i, n in enumerate(kept)}
elements = [(m, [number[n] for n in nodes]) for m, nodes in elements]
slice_of_track.write_mesh(HERE, points[np.array(kept) - 1], elements, (0.0, slice_of_track.HALF_WIDTH))
