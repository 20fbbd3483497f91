"""Natural frequencies of blocks of 20-node hexahedra, for the modal tests.

Two assemblies: scikit-fem (ElementHexS2 on straight-sided cells, 3 x 3 x 3 points) and plain numpy (isoparametric, curved
edges too). Both go to scipy's eigsh with shift and invert. Writes <case>.csv: number, frequency [Hz].

    pip install scikit-fem scipy && python reference.py

scikit-fem 12.0.2 has no boundary map for ElementHexS2, so only volume integrals and dofs by facets are used.
"""

import itertools

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh

E, NU, RHO = 20e6, 0.3, 2000.0
LAM, MU = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
COUNT = 20


def bend(x):
    """The smooth map of the distorted cases; x has shape [3, points]."""
    return np.array([
        x[0] + 0.06 * np.sin(2.1 * x[1] + 1.3 * x[2]),
        x[1] + 0.05 * np.sin(1.7 * x[0] - 2.3 * x[2]),
        x[2] + 0.04 * np.sin(2.9 * x[0] + 1.1 * x[1]),
    ])


def lowest(k, m, free, held):
    k, m = k[free][:, free].tocsc(), m[free][:, free].tocsc()
    # A free body needs a shift below 0.
    sigma = 0.0 if held else -1e3
    # A count beyond what is kept, and a tight tolerance, so that the last digits are good.
    values = np.sort(eigsh(k, COUNT + 6, m, sigma=sigma, tol=1e-13)[0])[:COUNT]
    return np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi)


def by_skfem(counts, size, held, distorted):
    from dataclasses import replace

    from skfem import Basis, BilinearForm, ElementHexS2, ElementVector, MeshHex
    from skfem.helpers import ddot, dot, eye, sym_grad, trace

    mesh = MeshHex.init_tensor(*[np.linspace(0, s, n + 1) for n, s in zip(counts, size)])
    base = mesh.facets_satisfying(lambda x: np.abs(x[2]) < 1e-9)
    if distorted:
        mesh = replace(mesh, doflocs=bend(mesh.doflocs))
    basis = Basis(mesh, ElementVector(ElementHexS2()), intorder=5)

    @BilinearForm
    def stiffness(u, v, _):
        e = sym_grad(u)
        return ddot(2 * MU * e + LAM * eye(trace(e), 3), sym_grad(v))

    @BilinearForm
    def mass(u, v, _):
        return RHO * dot(u, v)

    k, m = stiffness.assemble(basis), mass.assemble(basis)
    free = np.arange(basis.N)
    if held:
        free = np.setdiff1d(free, basis.get_dofs(base).all())
    return lowest(k.tocsr(), m.tocsr(), free, held)


# Nodes of the cube in the order corners, then mid-sides; any order will do for the frequencies.
NODES = [p for p in itertools.product((-1, 0, 1), repeat=3) if list(p).count(0) < 2]


def shape_gradients(xi):
    """Values and natural gradients of the 20 serendipity functions."""
    values, gradients = np.zeros(20), np.zeros((20, 3))
    for a, node in enumerate(NODES):
        if 0 not in node:
            f = [1 + xi[k] * node[k] for k in range(3)]
            s = sum(xi[k] * node[k] for k in range(3)) - 2
            values[a] = f[0] * f[1] * f[2] * s / 8
            for k in range(3):
                others = np.prod([f[j] for j in range(3) if j != k])
                gradients[a, k] = node[k] * others * (s + f[k]) / 8
        else:
            f = [1 - xi[k] ** 2 if node[k] == 0 else 1 + xi[k] * node[k] for k in range(3)]
            d = [-2 * xi[k] if node[k] == 0 else node[k] for k in range(3)]
            values[a] = f[0] * f[1] * f[2] / 4
            for k in range(3):
                gradients[a, k] = d[k] * np.prod([f[j] for j in range(3) if j != k]) / 4
    return values, gradients


def by_numpy(counts, size, held, distorted, curved):
    grid, points, cells = {}, [], []
    for cell in itertools.product(*[range(n) for n in counts]):
        nodes = []
        for node in NODES:
            key = tuple(2 * c + p + 1 for c, p in zip(cell, node))
            if key not in grid:
                grid[key] = len(points)
                points.append([key[k] * size[k] / (2 * counts[k]) for k in range(3)])
            nodes.append(grid[key])
        cells.append(nodes)
    x0 = np.array(points)
    x = bend(x0.T).T if distorted else x0.copy()
    if distorted and not curved:
        for key, n in grid.items():
            odd = [k for k in range(3) if key[k] % 2]
            if odd:
                ends = [tuple(key[j] + s * (j == odd[0]) for j in range(3)) for s in (-1, 1)]
                x[n] = (x[grid[ends[0]]] + x[grid[ends[1]]]) / 2
    gauss = [(-np.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (np.sqrt(0.6), 5 / 9)]
    rule = [((a[0], b[0], c[0]), a[1] * b[1] * c[1]) for a in gauss for b in gauss for c in gauss]
    d = np.diag([2 * MU] * 3 + [MU] * 3)
    d[:3, :3] += LAM
    rows, columns, stiffness, mass = [], [], [], []
    for nodes in cells:
        ke, me = np.zeros((60, 60)), np.zeros((20, 20))
        for xi, weight in rule:
            n, dn = shape_gradients(xi)
            j = x[nodes].T @ dn
            volume = weight * np.linalg.det(j)
            g = dn @ np.linalg.inv(j)
            b = np.zeros((6, 60))
            for a in range(20):
                gx, gy, gz = g[a]
                b[:, 3 * a:3 * a + 3] = [[gx, 0, 0], [0, gy, 0], [0, 0, gz], [gy, gx, 0], [0, gz, gy], [gz, 0, gx]]
            ke += volume * b.T @ d @ b
            me += volume * RHO * np.outer(n, n)
        dofs = np.array([[3 * n, 3 * n + 1, 3 * n + 2] for n in nodes]).ravel()
        rows.append(np.repeat(dofs, 60))
        columns.append(np.tile(dofs, 60))
        stiffness.append(ke.ravel())
        mass.append(np.kron(me, np.eye(3)).ravel())
    n = 3 * len(points)
    index = (np.concatenate(rows), np.concatenate(columns))
    k = sp.coo_matrix((np.concatenate(stiffness), index), (n, n)).tocsr()
    m = sp.coo_matrix((np.concatenate(mass), index), (n, n)).tocsr()
    free = np.arange(n)
    if held:
        free = np.array([d for d in range(n) if abs(x0[d // 3, 2]) > 1e-9])
    return lowest(k, m, free, held)


for name, counts, size, held, distorted, curved in [
    ("clamped", (3, 2, 4), (1.0, 0.8, 1.5), True, False, False),
    ("free", (2, 2, 3), (1.0, 0.9, 1.3), False, False, False),
    ("distorted", (3, 2, 4), (1.0, 0.8, 1.5), True, True, False),
    ("distorted_free", (3, 2, 4), (1.0, 0.8, 1.5), False, True, False),
    ("curved", (3, 2, 4), (1.0, 0.8, 1.5), True, True, True),
]:
    found = by_numpy(counts, size, held, distorted, curved)
    source = "numpy"
    if not curved:
        skfem = by_skfem(counts, size, held, distorted)
        start = 0 if held else 6
        print(name, "scikit-fem against numpy:", np.max(np.abs(found[start:] / skfem[start:] - 1)))
        found, source = skfem, "scikit-fem"
    if not held:
        found[:6] = 0.0
    with open(f"{name}.csv", "w") as out:
        out.write(f"mode,frequency_hz_{source}\n")
        out.writelines(f"{i + 1},{f:.12g}\n" for i, f in enumerate(found))
    print(name, found[:8])
