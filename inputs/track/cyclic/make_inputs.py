"""Writes the inputs of the scene track/cyclic: stones.toml and the lists NODECOORD.DAT, ELEMENTNUM.DAT, DOF.DAT.

Provenance of the committed files; nothing else needs it.    python3 make_inputs.py    (numpy, scipy)

Stones. A stone is the convex hull of points near an ellipsoid of given axes (Zingg's b/a and c/b). Spheres inscribed
in the hull (but for a small margin) are taken greedily, each the one that covers most of the hull's volume not yet
covered; so the first is the large one in the middle and the next ones reach into the corners. Turned to the principal axes of the union and
scaled to sieve size 1 (intermediate extent of the bounding box in that frame).

Mesh. A slice of track, 20-node hexahedra, node order of SOLID186 (I..P corners, Q..B mid-sides on straight edges).
"""

from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

HERE = Path(__file__).parent
SEED = 20

# --- stones ----------------------------------------------------------------------------------------------------------

# name, b/a, c/b, points on the ellipsoid, spheres, margin (see fill)
STONES = [
    ("equant, blunt", 0.92, 0.92, 14, 10, 0.025),
    ("equant, sharp", 0.88, 0.85, 12, 12, 0.04),
    ("slightly elongated", 0.72, 0.90, 16, 11, 0.05),
    ("slightly flat", 0.88, 0.70, 16, 12, 0.05),
    ("wedge", 0.80, 0.78, 10, 12, 0.05),
    ("slightly flat and elongated", 0.74, 0.74, 18, 12, 0.05),
]


def polyhedron(rng, b_over_a, c_over_b, points):
    """Hull of points spread over an ellipsoid with semi-axes 1, b/a, c/a, pushed 10 % in or out."""
    p = rng.normal(size=(points, 3))
    for _ in range(60):  # repel the points from each other, but stop before they are regular
        p /= np.linalg.norm(p, axis=1)[:, None]
        d = p[:, None] - p[None]
        r = np.linalg.norm(d, axis=2) + np.eye(points)
        p = p + 0.01 * (d / r[..., None] ** 3).sum(axis=1)
    p /= np.linalg.norm(p, axis=1)[:, None]
    p *= 1.0 + 0.1 * rng.uniform(-1.0, 1.0, size=(points, 1))
    return ConvexHull(p * [1.0, b_over_a, b_over_a * c_over_b])


def fill(hull, count, margin, cells=46):
    """`count` spheres, greedily by the volume of the hull they add; returns centres, radii, share of the hull covered.

    A sphere may stand out over the faces by `margin` times the largest inscribed radius, about what it leaves
    empty in the corners.
    """
    lo, hi = hull.points.min(axis=0), hull.points.max(axis=0)
    h = (hi - lo).max() / cells
    axes = [np.arange(lo[k] + h / 2, hi[k], h) for k in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    depth = -(grid @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
    inside = grid[depth > 0]
    radius = depth[depth > 0] + margin * depth.max()
    uncovered = np.ones(len(inside), bool)
    # Small spheres in the tips add little volume but count as much in the contact search.
    candidates = np.flatnonzero(radius > 0.35 * radius.max())
    chosen = []
    for _ in range(count):
        left = inside[uncovered]
        best, best_gain = None, -1
        for block in np.array_split(candidates, max(1, len(candidates) * len(left) // 20_000_000)):
            d2 = (
                (inside[block] ** 2).sum(axis=1)[:, None] - 2.0 * inside[block] @ left.T + (left**2).sum(axis=1)[None]
            )
            gain = (d2 < radius[block][:, None] ** 2).sum(axis=1)
            if gain.max() > best_gain:
                best, best_gain = block[gain.argmax()], gain.max()
        chosen.append(best)
        uncovered &= ((inside - inside[best]) ** 2).sum(axis=1) >= radius[best] ** 2
    return inside[chosen], radius[chosen], 1.0 - uncovered.mean()


def union_moments(centres, radii, cells=900):
    """Volume, centroid and central second moments of the union; exact along z, midpoint rule in x and y."""
    lo, hi = (centres - radii[:, None]).min(axis=0), (centres + radii[:, None]).max(axis=0)
    x, y = (lo[k] + (np.arange(cells) + 0.5) * (hi[k] - lo[k]) / cells for k in (0, 1))
    area = (hi[0] - lo[0]) * (hi[1] - lo[1]) / cells**2
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for xi in x:
        h2 = radii**2 - (xi - centres[:, 0]) ** 2 - (y[:, None] - centres[:, 1]) ** 2
        half = np.sqrt(np.maximum(h2, 0.0))
        start = np.where(h2 > 0, centres[:, 2] - half, np.inf)
        end = np.where(h2 > 0, centres[:, 2] + half, -np.inf)
        order = np.argsort(start, axis=1)
        start, end = np.take_along_axis(start, order, 1), np.take_along_axis(end, order, 1)
        reached = np.maximum.accumulate(end, axis=1)
        before = np.concatenate([np.full((cells, 1), -np.inf), reached[:, :-1]], axis=1)
        a = np.maximum(start, before)
        ok = end > a
        a, b = np.where(ok, a, 0.0), np.where(ok, end, 0.0)
        m0, m1, m2 = (((b**n - a**n) / n).sum(axis=1) * area for n in (1, 2, 3))
        volume += m0.sum()
        first += [xi * m0.sum(), (y * m0).sum(), m1.sum()]
        xx, yy, zz = xi * xi * m0.sum(), (y * y * m0).sum(), m2.sum()
        xy, yz, zx = xi * (y * m0).sum(), (y * m1).sum(), xi * m1.sum()
        second += [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]
    centroid = first / volume
    return volume, centroid, second - volume * np.outer(centroid, centroid)


def make_stones():
    rng = np.random.default_rng(SEED)
    text = [
        "# Shows: Six ballast-like stones as clumps of ten to twelve spheres; sieve size 1 m, so scale = sieve size in metres. Frame: centroid and principal axes of the",
        "#   union.",
        "# Sources: Written by make_inputs.py; shapes chosen, not measured.",
        'name = "ballast, six stones"',
        'source = "convex hulls of random points near ellipsoids, filled greedily with spheres"',
    ]
    for name, b_over_a, c_over_b, points, count, margin in STONES:
        hull = polyhedron(rng, b_over_a, c_over_b, points)
        centres, radii, covered = fill(hull, count, margin)
        volume, centroid, second = union_moments(centres, radii)
        # The least moment of inertia is about the axis of the largest second moment: x is the long axis.
        axes = np.linalg.eigh(second)[1][:, ::-1]
        axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
        centres = (centres - centroid) @ axes
        extents = (centres + radii[:, None]).max(axis=0) - (centres - radii[:, None]).min(axis=0)
        sieve = np.sort(extents)[1]
        share = volume / hull.volume
        assert covered >= 0.85 and 0.85 <= share <= 1.0, (name, covered, share)
        e = np.sort(extents)[::-1]
        note = f"b/a {e[1] / e[0]:.2f}, c/b {e[2] / e[1]:.2f}; volume {volume / sieve**3:.4f}, "
        note += f"{100 * share:.1f} % of its polyhedron, of which it covers {100 * covered:.1f} %"
        print(f"{name}: {count} spheres, {note}")
        text += ["", "[[stones]]", f'name = "{name}"', f"# {note}", "spheres = ["]
        text += ["    [%.9f, %.9f, %.9f, %.9f]," % (*(c / sieve), r / sieve) for c, r in zip(centres, radii)]
        text += ["]"]
    (HERE / "stones.toml").write_text("\n".join(text) + "\n")


# --- mesh ------------------------------------------------------------------------------------------------------------

HALF_WIDTH, TOP, SLOPE = 7.0, 2.4, 1.5  # subgrade, embankment's top [m]; horizontal run per unit height
TOE = TOP + SLOPE * 1.0
LENGTH, NY = 0.6, 3
INNER, N_INNER = 1.9, 16  # columns under the ballast stand upright
N_BAND, N_OUTER = 3, 3  # shoulder, ground beside the embankment
EMBANKMENT = [-1.0, -0.75, -0.5, -0.25, 0.0]
SUBGRADE = [-4.0, -3.0, -2.3, -1.75, -1.3, -1.0]

# Natural coordinates of the 20 nodes.
CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
NATURAL = np.array(CORNERS + [tuple((np.array(CORNERS[a]) + CORNERS[b]) // 2) for a, b in EDGES], float)
FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def column_lines(z):
    """x of the column borders at height z."""
    edge = TOE if z <= -1.0 else TOP - SLOPE * z
    inner = np.linspace(-INNER, INNER, N_INNER + 1)
    band = np.linspace(INNER, edge, N_BAND + 1)[1:]
    outer = np.linspace(TOE, HALF_WIDTH, N_OUTER + 1)[1:] if z <= -1.0 else []
    right = np.concatenate([band, outer])
    return np.concatenate([-right[::-1], inner, right])


def shape_gradients(xi):
    """Serendipity functions of the 20-node hexahedron: d N / d xi, 20 x 3."""
    g = np.empty((20, 3))
    for a, n in enumerate(NATURAL):
        f, slope = 1.0 + n * xi, n
        if a < 8:
            s = n @ xi - 2.0
            for k in range(3):
                rest = np.prod(np.delete(f, k))
                g[a, k] = 0.125 * (slope[k] * rest * s + f.prod() * n[k])
        else:
            m = int(np.flatnonzero(n == 0.0)[0])
            f = f.copy()
            f[m] = 1.0 - xi[m] ** 2
            slope = slope.copy()
            slope[m] = -2.0 * xi[m]
            for k in range(3):
                g[a, k] = 0.25 * slope[k] * np.prod(np.delete(f, k))
    return g


def grid():
    """Points, numbered from 1, and elements (material, their 20 nodes) of the slice."""
    levels = SUBGRADE + EMBANKMENT[1:]
    lines = [column_lines(z) for z in levels]
    ys = np.linspace(0.0, LENGTH, NY + 1)
    # Corner points are named by (column counted from the middle, j, k), twice as fine so that mid-sides have names.
    position, elements = {}, []
    for k in range(len(levels) - 1):
        columns = len(lines[k + 1]) - 1 if k >= len(SUBGRADE) - 1 else len(lines[k]) - 1
        for j in range(NY):
            for i in range(columns):
                names = []
                for n in NATURAL:
                    c = 2 * i - columns + 1 + int(n[0])
                    names.append((2 * k + 1 + int(n[2]), 2 * j + 1 + int(n[1]), c))
                for name, n in zip(names[:8], NATURAL):
                    level = lines[k + (n[2] > 0)]
                    x = level[(name[2] + len(level) - 1) // 2]
                    position[name] = np.array([x, ys[name[1] // 2], levels[name[0] // 2]])
                for name, (a, b) in zip(names[8:], EDGES):
                    position[name] = 0.5 * (position[names[a]] + position[names[b]])
                elements.append((1 if k < len(SUBGRADE) - 1 else 2, names))
    number = {name: i + 1 for i, name in enumerate(sorted(position))}
    points = np.array([position[name] for name in sorted(position)])
    elements = [(material, [number[n] for n in names]) for material, names in elements]

    check(points, elements)
    return points, elements


def write_mesh(folder, points, elements, sides):
    """The three lists; the base is fixed, planes across x at `sides` and the ends of the slice are planes of symmetry."""
    x, y, z = points.T
    fixed = []
    for i in range(len(points)):
        base = z[i] == SUBGRADE[0]
        held = [base or x[i] in sides, base or y[i] in (0.0, LENGTH), base]
        fixed += [(i + 1, k + 1) for k in range(3) if held[k]]

    def write(name, lines):
        (folder / name).write_text("\n".join(lines) + "\n")

    write("NODECOORD.DAT", ("%8d%22.13e%22.13e%22.13e" % (i + 1, *p) for i, p in enumerate(points)))
    write("ELEMENTNUM.DAT", ("%8d%5d" % (i + 1, m) + "%8d" * 20 % tuple(n) for i, (m, n) in enumerate(elements)))
    write("DOF.DAT", ("%8d%3d%22.13e" % (node, k, 0.0) for node, k in fixed))
    print(f"mesh: {len(points)} nodes, {len(elements)} elements, {len(fixed)} constraints")


def check(points, elements):
    """Positive Jacobians, conforming faces, exact volumes."""
    g, w = np.polynomial.legendre.leggauss(3)
    rule = [(np.array([a, b, c]), u * v * t) for a, u in zip(g, w) for b, v in zip(g, w) for c, t in zip(g, w)]
    rule += [(n, 0.0) for n in NATURAL]  # nodes too, without weight
    tables = [(shape_gradients(xi), weight) for xi, weight in rule]
    volume, least = {1: 0.0, 2: 0.0}, np.inf
    shared = {}
    for material, nodes in elements:
        p = points[np.array(nodes) - 1]
        for gradients, weight in tables:
            det = np.linalg.det(p.T @ gradients)
            least = min(least, det)
            volume[material] += weight * det
        for face in FACES:
            key = tuple(sorted(nodes[a] for a in face))
            shared.setdefault(key, []).append(material)
    assert least > 0.0, least
    depth = SUBGRADE[-1] - SUBGRADE[0]
    exact = {1: 2 * HALF_WIDTH * depth * LENGTH, 2: (TOP + TOE) * LENGTH}
    for m in (1, 2):
        assert abs(volume[m] / exact[m] - 1.0) < 1e-12, (m, volume[m], exact[m])
    assert max(map(len, shared.values())) == 2
    area = 0.0  # of the faces used once: the whole surface, no crack inside
    for key in (k for k, v in shared.items() if len(v) == 1):
        a, b, c, d = face_loop(points[np.array(key) - 1])
        area += 0.5 * np.linalg.norm(np.cross(c - a, d - b))
    slope = np.hypot(1.0, SLOPE)
    section = 2 * HALF_WIDTH * depth + TOP + TOE
    exact_area = 2 * section + LENGTH * (2 * HALF_WIDTH + 2 * depth + 2 * (HALF_WIDTH - TOE) + 2 * slope + 2 * TOP)
    assert abs(area / exact_area - 1.0) < 1e-12, (area, exact_area)
    print(f"volumes {volume[1]:.6f} and {volume[2]:.6f} m3, least Jacobian {least:.3e} m3, surface {area:.6f} m2")


def face_loop(p):
    """The four corners of a flat convex face in cyclic order."""
    q = p - p.mean(axis=0)
    axes = np.linalg.svd(q)[2]
    return p[np.argsort(np.arctan2(q @ axes[1], q @ axes[0]))]


if __name__ == "__main__":
    write_mesh(HERE, *grid(), (-HALF_WIDTH, HALF_WIDTH))
    make_stones()
