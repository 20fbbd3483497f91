#!/usr/bin/env python3
"""Assumed and enhanced strains of the 8-node hexahedron on a clamped cantilever and a thick cylinder, independent of the program.

Simo and Rifai, Int. J. Numer. Methods Eng. 29 (1990) 1595-1638; Andelfinger and Ramm, 36 (1993) 1311-1337 (21 terms). Prints
computed over reference; the reference of the cantilever (20-node hexahedra of the program, refined to the clamped face) is a constant.
"""
import itertools

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float
)
TIP = {0.3: 0.04004, 0.4999: 0.03948}  # m, averaged by the load
TWO = [(-1 / 3**0.5, 1.0), (1 / 3**0.5, 1.0)]
THREE = [(-(0.6**0.5), 5 / 9), (0.0, 8 / 9), (0.6**0.5, 5 / 9)]


def rule(line):
    for points in itertools.product(line, repeat=3):
        yield np.array([x for x, _ in points]), np.prod([w for _, w in points])


def gradients(x):
    f = 1 + CORNERS * x
    products = [f[:, 1] * f[:, 2], f[:, 0] * f[:, 2], f[:, 0] * f[:, 1]]
    return np.stack([CORNERS[:, k] * products[k] for k in range(3)], 1) / 8


def enhanced(count, x):
    """Enhanced strains at a natural point, as tensors in natural axes."""
    terms = []

    def add(i, j, value):
        strain = np.zeros((3, 3))
        strain[i, j] += value / 2
        strain[j, i] += value / 2
        terms.append(strain)

    if count == 0:
        return terms
    for i, m in itertools.product(range(3), repeat=2):
        add(i, m, x[m])
    a, b, c = x
    if count == 12:
        terms.extend(np.eye(3) * v for v in (a * b, b * c, a * c))
    if count == 21:
        for i, j, v in [
            (0, 0, a * b), (0, 0, a * c), (1, 1, a * b), (1, 1, b * c), (2, 2, a * c), (2, 2, b * c),
            (0, 1, a * c), (0, 1, b * c), (1, 2, a * b), (1, 2, a * c), (0, 2, a * b), (0, 2, b * c),
        ]:
            add(i, j, v)
    return terms


def stiffness(x, young, nu, count, volume):
    """Stiffness [N/m] of an element with nodes at x; `volume`: 0 at the points, 1 its mean, 2 its linear part."""
    lam, mu = young * nu / (1 + nu) / (1 - 2 * nu), young / 2 / (1 + nu)
    one = np.array([1.0, 1, 1, 0, 0, 0])
    elastic = lam * np.outer(one, one) + mu * np.diag([2.0, 2, 2, 1, 1, 1])
    middle = x.T @ gradients(np.zeros(3))
    inverse, n = np.linalg.inv(middle), 24 + count
    operators, weights, places = [], [], []
    for p, w in rule(THREE if count > 9 else TWO):
        d = gradients(p)
        jacobian = x.T @ d
        det = np.linalg.det(jacobian)
        operator = np.zeros((6, n))
        for node, (gx, gy, gz) in enumerate(d @ np.linalg.inv(jacobian)):
            rows = [[gx, 0, 0], [0, gy, 0], [0, 0, gz], [gy, gx, 0], [0, gz, gy], [gz, 0, gx]]
            operator[:, 3 * node : 3 * node + 3] = rows
        for k, strain in enumerate(enhanced(count, p)):
            e = np.linalg.det(middle) / det * inverse.T @ strain @ inverse
            operator[:, 24 + k] = [e[0, 0], e[1, 1], e[2, 2], 2 * e[0, 1], 2 * e[1, 2], 2 * e[2, 0]]
        operators.append(operator)
        weights.append(w * det)
        places.append(np.prod(1 + CORNERS * p, axis=1) / 8 @ x)
    weights, places = np.array(weights), np.array(places)
    if volume:
        dilatation = np.array([b[:3].sum(0) for b in operators])
        basis = np.ones((len(weights), 1))
        if volume == 2:
            basis = np.hstack([basis, places - weights @ places / weights.sum()])
        weighted = weights[:, None] * basis
        projected = basis @ np.linalg.solve(basis.T @ weighted, weighted.T @ dilatation)
        for b, new, old in zip(operators, projected, dilatation):
            b[:3] += (new - old) / 3
    k = sum(w * b.T @ elastic @ b for w, b in zip(weights, operators))
    return k[:24, :24] - k[:24, 24:] @ np.linalg.solve(k[24:, 24:], k[24:, :24])


def grid(counts):
    ids = np.arange(np.prod([n + 1 for n in counts])).reshape([n + 1 for n in counts])
    lines = [np.linspace(0, 1, n + 1) for n in counts]
    x = np.stack(np.meshgrid(*lines, indexing="ij"), -1).reshape(-1, 3)
    up = (CORNERS > 0).astype(int)
    cells = itertools.product(*map(range, counts))
    return x, np.array([[ids[tuple(np.array(cell) + u)] for u in up] for cell in cells])


def solve(x, elements, element_stiffness, force, fixed):
    dofs = (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), 24)
    values = np.array([element_stiffness(x[e]) for e in elements]).ravel()
    rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, (1, 24)).ravel()
    matrix = sparse.csr_matrix((values, (rows, columns)))
    free = np.setdiff1d(np.arange(3 * len(x)), fixed)
    u = np.zeros(3 * len(x))
    u[free] = spsolve(matrix[free][:, free].tocsc(), force[free])
    return u


def cantilever(counts, nu, count, volume):
    x, elements = grid(counts)
    x = x * [10, 1, 1]
    force = np.zeros(3 * len(x))
    for e in elements:
        for node in e[x[e][:, 0] > 10 - 1e-9]:
            force[3 * node + 2] += 100 / (4 * counts[1] * counts[2])
    fixed = np.concatenate([3 * np.flatnonzero(x[:, 0] == 0) + k for k in range(3)])
    k = stiffness(x[elements[0]], 1e7, nu, count, volume)
    return force @ solve(x, elements, lambda _: k, force, fixed) / 100 / TIP[nu]


def cylinder(counts, nu, count, volume):
    """Widening of a quarter of radii 0.5 and 1 m over Lamé's."""
    y, elements = grid(counts)
    r, t = 0.5 + 0.5 * y[:, 0], np.pi / 2 * y[:, 1]
    x = np.stack([r * np.cos(t), r * np.sin(t), 0.25 * y[:, 2]], 1)
    inside, force = np.flatnonzero(y[:, 0] == 0), np.zeros(3 * len(x))
    chord = np.pi / 2 / counts[1]
    for e in elements:
        face = e[y[e][:, 0] == 0]
        if len(face):
            angle = t[face].mean()
            size = 1e7 * 2 * 0.5 * np.sin(chord / 2) * 0.25 / counts[2]
            for node in face:
                force[3 * node : 3 * node + 2] += size / 4 * np.array([np.cos(angle), np.sin(angle)])
    low, high = np.flatnonzero(y[:, 1] == 0), np.flatnonzero(y[:, 1] == 1)
    fixed = np.concatenate([3 * low + 1, 3 * high, 3 * np.arange(len(x)) + 2])
    u = solve(x, elements, lambda e: stiffness(e, 2e11, nu, count, volume), force, fixed)
    widening = np.mean(u[3 * inside] * np.cos(t[inside]) + u[3 * inside + 1] * np.sin(t[inside]))
    return widening / ((1 + nu) / 2e11 * 1e7 / 3 * ((1 - 2 * nu) * 0.5 + 2))


print(f"{'strains':42} {'bending 0.3':>12} {'0.4999':>8} {'halved':>8} {'cylinder 3 x 6':>15} {'6 x 12':>8}")
for name, count, volume in [
    ("plain", 0, 0),
    ("mean volume strain", 0, 1),
    ("9 terms, volume strain at the points", 9, 0),
    ("9 terms, mean volume strain", 9, 1),
    ("9 terms, linear volume strain (trackbed)", 9, 2),
    ("12 terms", 12, 0),
    ("21 terms", 21, 0),
]:
    row = [
        cantilever((10, 2, 2), 0.3, count, volume),
        cantilever((10, 2, 2), 0.4999, count, volume),
        cantilever((20, 4, 4), 0.4999, count, volume),
        cylinder((3, 6, 1), 0.4999, count, volume),
        cylinder((6, 12, 1), 0.4999, count, volume),
    ]
    print(f"{name:42} {row[0]:12.4f} {row[1]:8.4f} {row[2]:8.4f} {row[3]:15.4f} {row[4]:8.4f}", flush=True)
