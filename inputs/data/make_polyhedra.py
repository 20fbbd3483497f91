"""Makes polyhedra.toml: convex stones with corners at random places of ellipsoids, none too close to another.

    python3 make_polyhedra.py > polyhedra.toml

Needs Python 3.11 and nothing else; the same stones every time.
"""

import math
import random

STONES = [("cubical", 14, (1.0, 0.95, 0.9)), ("flat", 14, (1.1, 1.0, 0.55)), ("elongated", 14, (1.6, 0.95, 0.8)),
          ("bladed", 16, (1.5, 1.0, 0.6)), ("angular", 10, (1.1, 0.95, 0.85))]
RADIUS = 0.12

random.seed(20)
print("# Shows: Five convex stones with rounded edges; unit: half of the middle axis.")
print("# Sources: Written by make_polyhedra.py; proportions chosen, not measured.")
print('name = "five convex stones"\nsource = "corners at random places of ellipsoids"')
for name, count, half in STONES:
    corners = []
    while len(corners) < count:
        p = [random.gauss(0.0, 1.0) for _ in range(3)]
        p = [x / math.hypot(*p) for x in p]
        if all(math.dist(p, q) > 1.9 / math.sqrt(count) for q in corners):
            corners.append(p)
    print(f'\n[[stones]]\nname = "{name}"\nradius = {RADIUS}\ncorners = [')
    for p in corners:
        print("    [" + ", ".join(f"{x * h:.4f}" for x, h in zip(p, half)) + "],")
    print("]")
