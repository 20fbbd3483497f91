"""Writes the VTK samples: python3 make_vtk.py (package vtk 9.7).

One curved cell of each of eight kinds, at VTK's parametric coordinates.
"""

import vtk

KINDS = [
    vtk.vtkQuadraticHexahedron, vtk.vtkQuadraticWedge, vtk.vtkQuadraticPyramid, vtk.vtkQuadraticTetra,
    vtk.vtkHexahedron, vtk.vtkWedge, vtk.vtkPyramid, vtk.vtkTetra,
]

grid = vtk.vtkUnstructuredGrid()
points = vtk.vtkPoints()
points.SetDataTypeToDouble()
grid.SetPoints(points)
material = vtk.vtkIntArray()
material.SetName("MaterialIds")
for place, make in enumerate(KINDS):
    cell = make()
    natural = cell.GetParametricCoords()
    ids = []
    for node in range(cell.GetNumberOfPoints()):
        r, s, t = natural[3 * node : 3 * node + 3]
        ids.append(points.InsertNextPoint(r + 0.1 * s * s + 2 * place, s + 0.12 * t * t, t + 0.09 * r * r))
    grid.InsertNextCell(cell.GetCellType(), len(ids), ids)
    material.InsertNextValue(place % 3 + 1)
grid.GetCellData().AddArray(material)


def vtu(name, mode, zlib=False, wide=False, encode=False, big=False, lz4=False):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(name)
    {"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary,
     "appended": writer.SetDataModeToAppended}[mode]()
    writer.SetCompressorTypeToLZ4() if lz4 else writer.SetCompressorTypeToZLib() if zlib else writer.SetCompressorTypeToNone()
    writer.SetBlockSize(512)
    writer.SetHeaderTypeToUInt64() if wide else writer.SetHeaderTypeToUInt32()
    writer.SetEncodeAppendedData(encode)
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    assert writer.Write() == 1


vtu("vtk_ascii.vtu", "ascii")
vtu("vtk_binary.vtu", "binary", wide=True)
vtu("vtk_binary_zlib.vtu", "binary", zlib=True)
vtu("vtk_appended_raw.vtu", "appended")
vtu("vtk_appended_raw_zlib64.vtu", "appended", zlib=True, wide=True)
vtu("vtk_appended_base64.vtu", "appended", encode=True)
vtu("vtk_appended_base64_zlib.vtu", "appended", zlib=True, encode=True)
vtu("vtk_big_endian.vtu", "binary", big=True)
vtu("vtk_lz4.vtu", "binary", lz4=True)
for name, binary, version in [("vtk_ascii.vtk", False, 51), ("vtk_binary.vtk", True, 51), ("vtk_binary42.vtk", True, 42)]:
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(name)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    writer.SetFileVersion(version)
    assert writer.Write() == 1
