"""Makes icebreaker.obj: a closed hull of triangles, its bow towards +x, its waterline at z = 0. Lengths in metres.

    python3 make_icebreaker.py > icebreaker.obj

Wedge bow of two planes (stem angle 25 degrees, waterline angle 30 degrees), parallel middle body with a bilge, raked stern with a transom.
Needs Python 3.11 and nothing else.
"""

from math import radians, tan

BEAM, DRAFT, AFT, FORE = 6.0, 2.0, -12.0, 12.0
STEM, ENTRANCE = tan(radians(25.0)), tan(radians(30.0))
LEVELS = [-2.0, -1.7, -1.2, -0.8, -0.4, 0.0, 0.4, 1.0]
BILGE = {-2.0: 2.3, -1.7: 2.75}
RAKED = -0.8


def waterline(z):
    """Places and half widths from stern to stem."""
    half = BILGE.get(z, 0.5 * BEAM)
    stem, stern = FORE + z / STEM, AFT + max(0.0, RAKED - z) * 4.0 / 1.2
    shoulder = stem - half / ENTRANCE
    points = [(stern, 0.7 * half), (stern + 0.25 * (-5.0 - stern), 0.83 * half), (stern + 0.6 * (-5.0 - stern), 0.95 * half)]
    points += [(-5.0 + (shoulder + 5.0) * k / 3, half) for k in range(4)]
    return points + [(shoulder + (stem - shoulder) * k / 4, half * (1.0 - k / 4)) for k in range(1, 5)]


vertices, faces, numbers = [], [], {}


def number(x, y, z):
    """Number of a vertex, from 1; both sides share vertices on the centre plane."""
    key = (round(x, 4), round(y, 4) + 0.0, round(z, 4))
    if key not in numbers:
        vertices.append(key)
        numbers[key] = len(vertices)
    return numbers[key]


def quad(*corners):
    a, b, c, d = (number(*p) for p in corners)
    faces.extend(t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3)


lines = [[(x, y, z) for x, y in waterline(z)] for z in LEVELS]
for low, high in zip(lines, lines[1:]):
    for k in range(len(low) - 1):
        a, b, c, d = low[k], low[k + 1], high[k + 1], high[k]
        quad(*((x, -y, z) for x, y, z in (a, b, c, d)))
        quad(d, c, b, a)
    (x, y, z), (u, v, w) = low[0], high[0]
    quad((x, y, z), (x, -y, z), (u, -v, w), (u, v, w))
for line, up in ((lines[0], False), (lines[-1], True)):
    for (x, y, z), (u, v, w) in zip(line, line[1:]):
        corners = [(x, -y, z), (u, -v, w), (u, v, w), (x, y, z)]
        quad(*(corners if up else corners[::-1]))


def below(z):
    """Volume and its first moment along x below a height, by cutting at the levels."""
    volume = moment = 0.0
    for low, high in zip(lines, lines[1:]):
        if high[0][2] <= z:
            for line in (low, high):
                for (x, y, _), (u, v, _) in zip(line, line[1:]):
                    area = (u - x) * (y + v)
                    volume += area * 0.5 * (high[0][2] - low[0][2])
                    moment += area * 0.5 * (high[0][2] - low[0][2]) * (x + u) / 2
    return volume, moment / volume


print(f"# Hull by make_icebreaker.py: {len(faces)} triangles in metres; bow towards +x, waterline at z = 0.")
print("# Displaces about {:.0f} m3, centre of buoyancy at x = {:.2f} m.".format(*below(0.0)))
for v in vertices:
    print("v {:.6g} {:.6g} {:.6g}".format(*v))
for f in faces:
    print("f", *f)
