"""Writes octant.inp: an eighth of a thick sphere in 20-node bricks, for the scene beside it.

    python3 octant.py > octant.inp

Three patches meet on the diagonal; each is a grid of N x N cells, projected onto the sphere, times LAYERS shells whose
radii grow by a constant factor. Set BORE holds the nodes of the inner surface.
"""

N, LAYERS, INNER, OUTER = 2, 8, 1.0, 8.0

# Corners of the three patches on the unit octant: axis, two edge middles, and the diagonal.
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
XY, YZ, ZX, XYZ = (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1)
PATCHES = [(X, XY, XYZ, ZX), (Y, YZ, XYZ, XY), (Z, ZX, XYZ, YZ)]


def unit(v):
    length = sum(c * c for c in v) ** 0.5
    return tuple(c / length for c in v)


def direction(patch, s, t):
    """Direction at (s, t) of the unit square; the corners are on the sphere already."""
    a, b, c, d = (unit(v) for v in patch)
    return unit(
        tuple((1 - s) * (1 - t) * a[k] + s * (1 - t) * b[k] + s * t * c[k] + (1 - s) * t * d[k] for k in range(3))
    )


nodes, elements, bore = {}, [], set()


def node(patch, i, j, k):
    """Number of the node at half-steps (i, j) of the patch and k of the shells."""
    r = INNER * (OUTER / INNER) ** (k / (2 * LAYERS))
    x = tuple(round(r * c, 12) + 0.0 for c in direction(patch, i / (2 * N), j / (2 * N)))
    number = nodes.setdefault(x, len(nodes) + 1)
    if k == 0:
        bore.add(number)
    return number


# Corners and mid-sides of a brick in half-steps, in the order of C3D20.
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
SIDES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
SIDES += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
for patch in PATCHES:
    for k in range(0, 2 * LAYERS, 2):
        for j in range(0, 2 * N, 2):
            for i in range(0, 2 * N, 2):
                elements.append([node(patch, i + a, j + b, k + c) for a, b, c in CORNERS + SIDES])

print("*HEADING\nEighth of a thick sphere, radii %g and %g\n*NODE" % (INNER, OUTER))
for (x, y, z), number in nodes.items():
    print("%d, %.12g, %.12g, %.12g" % (number, x, y, z))
print("*ELEMENT, TYPE=C3D20R, ELSET=GROUND")
for number, e in enumerate(elements, 1):
    print("%d, %s,\n%s" % (number, ", ".join(map(str, e[:11])), ", ".join(map(str, e[11:]))))
print("*NSET, NSET=BORE")
bore = sorted(bore)
for start in range(0, len(bore), 12):
    print(", ".join(map(str, bore[start : start + 12])))
print("*MATERIAL, NAME=GROUND_1\n*ELASTIC\n5e7, 0.3\n*SOLID SECTION, ELSET=GROUND, MATERIAL=GROUND_1")
