"""Makes hull.obj: a closed hull of triangles, along x, its waterline at z = 0.

    python3 make_hull.py > hull.obj

Below water the form of Wigley (1934), y = B/2 (1 - (2x/L)^2) (1 - (z/T)^2), but a keel as wide as a tenth of the frame above it; above it
vertical sides and a deck. Lengths in units of the length of the ship. Needs Python 3.11 and nothing else.
"""

LENGTH, BEAM, DRAFT, BOARD = 1.0, 0.2, 0.0625, 0.05
STATIONS, LEVELS = 44, 6

KEEL = 0.1


def half(x, z):
    """Half width at a place."""
    frame = 0.5 * BEAM * (1.0 - (2.0 * x / LENGTH) ** 2)
    below = max(0.0, -z / DRAFT)
    return frame * max(KEEL, 1.0 - below**2)


heights = [-DRAFT + DRAFT * k / LEVELS for k in range(LEVELS + 1)] + [0.5 * BOARD, BOARD]
vertices, faces, numbers = [], [], {}


def number(x, y, z):
    """Number of a vertex, from 1; the two sides share those at stem and stern."""
    key = (round(x, 6), round(y, 6) + 0.0, round(z, 6))
    if key not in numbers:
        vertices.append(key)
        numbers[key] = len(vertices)
    return numbers[key]


def quad(a, b, c, d):
    for t in ((a, b, c), (a, c, d)):
        if len(set(t)) == 3:
            faces.append(t)


for i in range(STATIONS):
    x0, x1 = (-0.5 + (i + k) / STATIONS for k in (0, 1))
    for side in (1.0, -1.0):
        for low, high in zip(heights, heights[1:]):
            at = [(x0, low), (x1, low), (x1, high), (x0, high)]
            quad(*(number(x, side * half(x, z), z) for x, z in (at if side < 0 else at[::-1])))
    for z in (heights[0], heights[-1]):
        at = [(x0, -1.0), (x1, -1.0), (x1, 1.0), (x0, 1.0)]
        quad(*(number(x, side * half(x, z), z) for x, side in (at if z > 0 else at[::-1])))

print(f"# Hull by make_hull.py: {len(faces)} triangles; length 1, along x, waterline at z = 0.")
for v in vertices:
    print("v {:.6g} {:.6g} {:.6g}".format(*v))
for f in faces:
    print("f", *f)
