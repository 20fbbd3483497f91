"""Writes the Gmsh samples: python3 make_gmsh.py (package gmsh 4.15).

Hexahedra, tetrahedra on top with pyramids between, and a layer of prisms, curved by a smooth map. The volumes are
integrals of Gmsh's Jacobian determinants by Gmsh's rules, by kind in ascending order.
"""

import json
import math

import gmsh


# Gmsh element types.
NAMES = {4: "tet4", 5: "hex8", 6: "wedge6", 7: "pyramid5", 11: "tet10", 17: "hex20", 18: "wedge15", 19: "pyramid13"}


def body(order, name, version, binary):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    model, geo = gmsh.model, gmsh.model.geo
    p = [geo.addPoint(x, y, 0.0) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)]]
    lines = [geo.addLine(p[i], p[(i + 1) % 4]) for i in range(4)]
    bottom = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.mesh.setTransfiniteSurface(bottom)
    geo.mesh.setRecombine(2, bottom)
    for line in lines:
        geo.mesh.setTransfiniteCurve(line, 3)
    hexes = geo.extrude([(2, bottom)], 0, 0, 0.5, numElements=[1], recombine=True)
    top, block = hexes[0][1], hexes[1][1]
    side = hexes[3][1]
    # Tetrahedra between the top and an apex.
    geo.synchronize()
    edges = [abs(tag) for _, tag in model.getBoundary([(2, top)], oriented=False)]
    apex = geo.addPoint(0.5, 0.5, 1.3, 0.6)
    ends = {}
    for edge in edges:
        for _, point in model.getBoundary([(1, edge)], oriented=False):
            ends.setdefault(point, geo.addLine(point, apex))
    faces = [top]
    for edge in edges:
        (_, a), (_, b) = model.getBoundary([(1, edge)], oriented=False)
        faces.append(geo.addPlaneSurface([geo.addCurveLoop([edge, ends[b], -ends[a]], reorient=True)]))
    roof = geo.addVolume([geo.addSurfaceLoop(faces)])
    # Extruded prisms at the side.
    q = [geo.addPoint(x, y, 0.0) for x, y in [(3, 0), (4, 0), (3, 1)]]
    triangle = geo.addPlaneSurface([geo.addCurveLoop([geo.addLine(q[i], q[(i + 1) % 3]) for i in range(3)])])
    wing = geo.extrude([(2, triangle)], 0, 0, 0.7, numElements=[1], recombine=True)[1][1]
    geo.synchronize()
    model.addPhysicalGroup(3, [block], 7, name="ballast bed")
    model.addPhysicalGroup(3, [roof], 3)
    model.addPhysicalGroup(3, [wing], 4, name="wing")
    model.addPhysicalGroup(2, [bottom], 11, name="base")
    model.addPhysicalGroup(2, [side], 12)
    model.addPhysicalGroup(0, [apex], 1, name="apex")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.2)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.option.setNumber("Mesh.SecondOrderLinear", 1)
    model.mesh.generate(3)
    tags, coordinates, _ = model.mesh.getNodes()
    for i, tag in enumerate(tags):
        x, y, z = coordinates[3 * i : 3 * i + 3]
        moved = [x + 0.08 * math.sin(2 * y) + 0.05 * z * z, y + 0.06 * x * z, z + 0.07 * math.sin(1.5 * x + y)]
        model.mesh.setNode(tag, moved, [])
    volumes = {}
    for kind in model.mesh.getElementTypes(3):
        points, weights = model.mesh.getIntegrationPoints(kind, "Gauss10")
        elements, _ = model.mesh.getElementsByType(kind)
        _, determinants, _ = model.mesh.getJacobians(kind, points)
        n = len(weights)
        for e in range(len(elements)):
            volume = sum(w * d for w, d in zip(weights, determinants[n * e : n * e + n]))
            volumes.setdefault(NAMES[kind], []).append(float(volume))
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(name + ".msh")
    gmsh.finalize()
    return {kind: sorted(of_kind) for kind, of_kind in volumes.items()}


if __name__ == "__main__":
    found = {}
    for order in (1, 2):
        for version, short in ((2.2, "2"), (4.1, "4")):
            for binary in (0, 1):
                name = f"gmsh{short}_order{order}" + ("_binary" if binary else "")
                volumes = body(order, name, version, binary)
                found.setdefault(f"order{order}", volumes)
                assert found[f"order{order}"] == volumes
    with open("gmsh_volumes.json", "w") as out:
        json.dump(found, out, indent=0)
        out.write("\n")
