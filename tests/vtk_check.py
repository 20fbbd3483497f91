"""Opens result files with VTK, the reader behind ParaView, and checks what it finds in them.

    python3 tests/vtk_check.py [--volume V] FILE...

FILE: .pvd (all listed files), .vtu, .vtk or .vtp. Readable, arrays of its kind with their components, finite. Cells must
not be inverted for VTK; --volume: total of every .vtu is V [m^3] to 1e-9. Exit code 0 if all pass.

Needs the Python package `vtk`, without its graphics libraries.
"""

import argparse
import math
import os
import sys
import xml.etree.ElementTree as ElementTree

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
import numpy

QUADRATIC_PYRAMID = 27

# Parametric shapes of VTK cell types.
CELLS = {
    25: "hexahedron", 26: "wedge", 27: "pyramid", 24: "tetrahedron",
    12: "hexahedron", 13: "wedge", 14: "pyramid", 10: "tetrahedron",
}

# Arrays by file kind: location, name, components.
KINDS = {
    "solid": (
        [("displacement", 3), ("velocity", 3), ("stress", 9), ("von_mises", 1)]
        + [("equivalent_plastic_strain", 1), ("yield_function", 1), ("node_id", 1)],
        [("material", 1), ("element_id", 1)],
    ),
    "mesh": ([("node_id", 1), ("constraint", 1)], [("material", 1), ("element_id", 1)]),
    "grains": (
        [("radius", 1), ("velocity", 3), ("spin", 3), ("orientation", 4), ("id", 1), ("part", 1)]
        + [("mean_stress", 1), ("force", 3), ("coordination", 1), ("fragment", 1)],
        [],
    ),
    "chains": ([], [("normal_force", 1), ("tangential_force", 1), ("magnitude", 1), ("kind", 1), ("strong", 1)]),
    "walls": ([], [("id", 1), ("kind", 1)]),
}


class Failure(Exception):
    """Invalid file."""


def expect(condition, message):
    if not condition:
        raise Failure(message)


def read(path):
    """Reads a file; VTK errors are failures."""
    if path.endswith(".vtk"):
        reader = vtkUnstructuredGridReader()
        reader.ReadAllFieldsOn()
    else:
        reader = vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtkXMLPolyDataReader()
    complaints = []
    for event in ("ErrorEvent", "WarningEvent"):
        # Requests the message text from VTK.
        def observer(_object, _event, text="?"):
            complaints.append(text)

        observer.CallDataType = "string0"
        reader.AddObserver(event, observer)
    expect(path.endswith(".vtk") or reader.CanReadFile(path), "VTK does not take it for a file of this kind")
    reader.SetFileName(path)
    reader.Update()
    expect(not complaints and reader.GetErrorCode() == 0, "; ".join(map(str, complaints)) or "VTK error")
    return reader.GetOutput()


def kind_of(data, path):
    names = {data.GetPointData().GetArrayName(i) for i in range(data.GetPointData().GetNumberOfArrays())}
    cells = {data.GetCellData().GetArrayName(i) for i in range(data.GetCellData().GetNumberOfArrays())}
    if path.endswith((".vtu", ".vtk")):
        return "solid" if "displacement" in names else "mesh"
    if "normal_force" in cells:
        return "chains"
    return "grains" if "radius" in names else "walls"


def check_arrays(attributes, expected, count, where):
    for name, components in expected:
        array = attributes.GetArray(name)
        expect(array is not None, f"no {where} array {name}")
        found = array.GetNumberOfComponents()
        expect(found == components, f"{where} array {name} has {found} components, expected {components}")
        found = array.GetNumberOfTuples()
        expect(found == count, f"{where} array {name} has {found} tuples, expected {count}")
    for index in range(attributes.GetNumberOfArrays()):
        values = vtk_to_numpy(attributes.GetArray(index))
        expect(numpy.isfinite(values).all(), f"{where} array {attributes.GetArrayName(index)} is not finite")


def gauss(count):
    """Points and weights on the unit interval."""
    points, weights = numpy.polynomial.legendre.leggauss(count)
    return list(zip(0.5 * (points + 1.0), 0.5 * weights))


def rule(shape):
    """Points and weights on VTK's parametric shape; triangles and tetrahedra by collapsed coordinates."""
    for u, weight_u in gauss(6):
        for v, weight_v in gauss(6):
            for w, weight_w in gauss(6):
                weight = weight_u * weight_v * weight_w
                if shape == "wedge":
                    yield (u, v * (1 - u), w), weight * (1 - u)
                elif shape == "tetrahedron":
                    yield (u, v * (1 - u), w * (1 - u) * (1 - v)), weight * (1 - u) ** 2 * (1 - v)
                else:
                    yield (u, v, w), weight


def enclosed_volume(cell):
    """Volume within VTK's faces of a cell, by the divergence theorem; negative if inverted."""
    volume = 0.0
    for index in range(cell.GetNumberOfFaces()):
        face = cell.GetFace(index)
        points = vtk_to_numpy(face.GetPoints().GetData())
        weights, derivatives = [0.0] * len(points), [0.0] * (2 * len(points))
        for u, weight_u in gauss(6):
            for v, weight_v in gauss(6):
                triangle = len(points) in (3, 6)
                place = (u, v * (1 - u), 0.0) if triangle else (u, v, 0.0)
                weight = weight_u * weight_v * ((1 - u) if triangle else 1.0)
                face.InterpolateFunctions(place, weights)
                face.InterpolateDerivs(place, derivatives)
                tangents = numpy.array(derivatives).reshape(2, len(points)) @ points
                volume += weight * numpy.dot(numpy.array(weights) @ points, numpy.cross(*tangents)) / 3.0
    return volume


def cell_volume(cell):
    """Volume by VTK's derivatives at Gauss points, and the smallest determinant.

    VTK's quadratic pyramid is a collapsed hexahedron, with another volume than its faces enclose: uses the latter.
    """
    if cell.GetCellType() == QUADRATIC_PYRAMID:
        volume = enclosed_volume(cell)
        return volume, volume
    points = vtk_to_numpy(cell.GetPoints().GetData())
    volume, least = 0.0, math.inf
    derivatives = [0.0] * (3 * len(points))
    for place, weight in rule(CELLS[cell.GetCellType()]):
        cell.InterpolateDerivs(place, derivatives)
        determinant = numpy.linalg.det(numpy.array(derivatives).reshape(3, len(points)) @ points)
        volume += weight * determinant
        least = min(least, determinant)
    return volume, least


def check_solid(data, volume):
    total = 0.0
    for index in range(data.GetNumberOfCells()):
        expect(data.GetCellType(index) in CELLS, f"cell {index} is no volume of a known kind")
        part, least = cell_volume(data.GetCell(index))
        expect(least > 0.0, f"cell {index} is turned inside out: determinant {least}")
        total += part
    if volume is not None:
        expect(abs(total - volume) <= 1e-9 * abs(volume), f"volume {total!r}, expected {volume!r}")
    return total


def check_file(path, volume):
    data = read(path)
    kind = kind_of(data, path)
    points, cells = data.GetNumberOfPoints(), data.GetNumberOfCells()
    # Contacts may be absent, grains or solid not.
    expect(kind == "chains" or (points > 0 and cells > 0), f"{points} points and {cells} cells")
    if points:
        expect(numpy.isfinite(vtk_to_numpy(data.GetPoints().GetData())).all(), "a point is not finite")
    point_arrays, cell_arrays = KINDS[kind]
    check_arrays(data.GetPointData(), point_arrays, points, "point")
    check_arrays(data.GetCellData(), cell_arrays, cells, "cell")
    if kind == "grains":
        radius, orientation = (vtk_to_numpy(data.GetPointData().GetArray(n)) for n in ("radius", "orientation"))
        expect((radius > 0.0).all(), "a radius is not positive")
        expect(numpy.allclose(numpy.linalg.norm(orientation, axis=1), 1.0), "an orientation is no unit quaternion")
    if kind == "chains":
        parts = [vtk_to_numpy(data.GetCellData().GetArray(name)) for name, _ in cell_arrays[:3]]
        expect(numpy.allclose(numpy.hypot(parts[0], parts[1]), parts[2]), "magnitude is not that of its parts")
    found = f"{kind}: {points} points, {cells} cells"
    if path.endswith((".vtu", ".vtk")):
        found += f", volume {check_solid(data, volume):.12g}"
    return found


def frames(path):
    """Files of a series, with valid times."""
    root = ElementTree.parse(path).getroot()
    expect(root.tag == "VTKFile" and root.get("type") == "Collection", "not a collection")
    rows = root.findall("./Collection/DataSet")
    expect(rows, "an empty collection")
    last = {}
    for row in rows:
        time, part = float(row.get("timestep")), row.get("part")
        expect(math.isfinite(time), f"time {time}")
        expect(last.get(part, -math.inf) < time, f"part {part}: time {time} after {last.get(part)}")
        last[part] = time
        expect(not os.path.isabs(row.get("file")), f"{row.get('file')} is not relative")
    return [os.path.join(os.path.dirname(path), row.get("file")) for row in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+")
    parser.add_argument("--volume", type=float, help="summed volume of every .vtu [m^3]")
    arguments = parser.parse_args()
    failed = 0
    queue = list(arguments.files)
    checked = set()
    while queue:
        path = queue.pop(0)
        if path in checked:
            continue
        checked.add(path)
        try:
            expect(os.path.isfile(path), "no such file")
            if path.endswith(".pvd"):
                listed = frames(path)
                queue[:0] = listed
                found = f"series: {len(listed)} files"
            else:
                expect(path.endswith((".vtu", ".vtk", ".vtp")), "neither .pvd nor .vtu, .vtk, .vtp")
                found = check_file(path, arguments.volume)
            print(f"ok   {path}: {found}")
        except (Failure, ElementTree.ParseError, ValueError) as error:
            failed += 1
            print(f"FAIL {path}: {error}")
    print(f"{len(checked) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
