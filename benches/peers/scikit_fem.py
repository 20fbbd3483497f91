"""Linear solids in scikit-fem (PyPI `scikit-fem`)."""

import math

import common

try:
    import numpy as np
    import skfem
    from scipy.sparse.linalg import eigsh
    from skfem.models.elasticity import lame_parameters, linear_elasticity
except ImportError as error:
    skfem, absent = None, error


def plane(mesh, lame, fixed, traction):
    """Displacements of a plane solid with 9-node elements: basis and solution."""
    element = skfem.ElementVector(skfem.ElementQuad2())
    basis = skfem.Basis(mesh, element, intorder=6)
    stiffness = linear_elasticity(*lame).assemble(basis)
    load = traction(element)
    return basis, skfem.solve(*skfem.condense(stiffness, load, D=fixed(basis)))


def at_node(basis, u, point, direction):
    """Displacement at a point that is a node of the mesh."""
    node = int(np.argmin(np.linalg.norm(basis.mesh.p - np.array(point)[:, None], axis=0)))
    return u[basis.nodal_dofs[direction, node]]


def cook_membrane(row):
    """16 x 16 elements of 9 nodes in plane stress."""
    n, corners = 16, np.array([[0, 0], [48, 44], [48, 60], [0, 44]], dtype=float)
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    s, t = mesh.p
    shares = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    mesh = skfem.MeshQuad((corners.T @ shares), mesh.t)
    young, poisson = 1e9, 1 / 3
    lame = (young * poisson / (1 - poisson**2), young / (2 * (1 + poisson)))

    def traction(element):
        edge = skfem.FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: np.isclose(x[0], 48)), intorder=6)
        return skfem.LinearForm(lambda v, w: 62500.0 * v[1]).assemble(edge)

    basis, u = plane(mesh, lame, lambda b: b.get_dofs(lambda x: np.isclose(x[0], 0)).all(), traction)
    return at_node(basis, u, (48, 52), 1) * row["quantity"]["factor"]


def thick_cylinder(row):
    """Quarter in plane strain, 24 x 24 curved elements of 9 nodes."""
    tables = common.scene(row)
    soil, load = tables["solid"]["material"][0], tables["solid"]["load"][0]
    pressure, n = load["history"]["points"][1][1] * load["pressure"], 24
    mesh = skfem.MeshQuad2.from_mesh(skfem.MeshQuad.init_tensor(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1)))
    turned = lambda x: np.array([(0.5 + x[0]) * np.cos(0.5 * np.pi * x[1]), (0.5 + x[0]) * np.sin(0.5 * np.pi * x[1])])
    mesh = skfem.MeshQuad2(turned(mesh.doflocs), mesh.t)
    straight = turned(skfem.MeshQuad.init_tensor(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1)).p)
    element = skfem.ElementVector(skfem.ElementQuad2())
    basis = skfem.Basis(mesh, element, intorder=6)
    bore = mesh.facets_satisfying(lambda x: np.linalg.norm(x, axis=0) < 0.51)
    edge = skfem.FacetBasis(mesh, element, facets=bore, intorder=6)
    force = skfem.LinearForm(lambda v, w: -pressure * (v[0] * w.n[0] + v[1] * w.n[1])).assemble(edge)
    stiffness = linear_elasticity(*lame_parameters(soil["young"], soil["poisson"])).assemble(basis)
    dofs = lambda d, name: basis.get_dofs(mesh.facets_satisfying(lambda x: np.abs(x[d]) < 1e-9)).all(name)
    fixed = np.unique(np.concatenate([dofs(0, "u^1"), dofs(1, "u^2")]))
    u = skfem.solve(*skfem.condense(stiffness, force, D=fixed))
    node = int(np.argmin(np.linalg.norm(straight - np.array([[0.5], [0.0]]), axis=0)))
    return u[basis.nodal_dofs[0, node]] * row["quantity"]["factor"]


def beam_mode(row):
    """24 x 2 x 2 hexahedra of 27 nodes."""
    tables = common.scene(row)
    steel = tables["solid"]["material"][0]
    mesh = skfem.MeshHex.init_tensor(np.linspace(0, 2, 25), np.linspace(0, 0.05, 3), np.linspace(0, 0.1, 3))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex2()), intorder=5)
    stiffness = linear_elasticity(*lame_parameters(steel["young"], steel["poisson"])).assemble(basis)
    density = steel["density"]
    mass = skfem.BilinearForm(lambda u, v, w: density * (u[0] * v[0] + u[1] * v[1] + u[2] * v[2])).assemble(basis)
    free = basis.complement_dofs(basis.get_dofs(lambda x: np.isclose(x[0], 0)))
    found = eigsh(stiffness[free][:, free], 4, mass[free][:, free], sigma=0.0, return_eigenvectors=False)
    return math.sqrt(sorted(found)[round(row["quantity"]["at"]) - 1]) / (2 * math.pi)


CASES = {"cook-membrane": cook_membrane, "thick-cylinder": thick_cylinder, "beam-mode-1": beam_mode, "beam-mode-2": beam_mode}

if __name__ == "__main__":
    if skfem is None:
        common.missing(absent)
    common.print_values(skfem.__version__, lambda row: CASES[row["name"]](row))
