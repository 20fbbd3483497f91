"""Writes cook.inp: Cook's membrane in N x N x 1 bricks of 20 nodes, for the scene beside it.

    python3 cook.py > cook.inp
"""

N, CORNERS = 8, ((0.0, 0.0), (48.0, 44.0), (48.0, 60.0), (0.0, 44.0))


def place(i, j, k):
    """Point at half-steps (i, j, k)."""
    s, t = i / (2 * N), j / (2 * N)
    shares = ((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t)
    return tuple(sum(a * c[d] for a, c in zip(shares, CORNERS)) for d in (0, 1)) + (k / 2,)


nodes, elements = {}, []


def node(i, j, k):
    return nodes.setdefault((i, j, k), len(nodes) + 1)


# Corners and mid-sides of a brick in half-steps, in the order of C3D20.
PLACES = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
PLACES += [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
PLACES += [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
for j in range(0, 2 * N, 2):
    for i in range(0, 2 * N, 2):
        elements.append([node(i + a, j + b, c) for a, b, c in PLACES])

print("*HEADING\nCook's membrane\n*NODE")
for key, number in nodes.items():
    print("%d, %.12g, %.12g, %.12g" % (number, *place(*key)))
print("*ELEMENT, TYPE=C3D20R, ELSET=MEMBRANE")
for number, e in enumerate(elements, 1):
    print("%d, %s,\n%s" % (number, ", ".join(map(str, e[:11])), ", ".join(map(str, e[11:]))))
print("*MATERIAL, NAME=MEMBRANE_1\n*ELASTIC\n1e9, 0.333333333333\n*SOLID SECTION, ELSET=MEMBRANE, MATERIAL=MEMBRANE_1")
