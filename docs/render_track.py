"""Draws the picture of the README from the results of the main job.

    cargo run --release -- run inputs/track/cyclic/scene.toml
    python3 -m venv venv && venv/bin/pip install vtk numpy
    venv/bin/python docs/render_track.py results/cyclic docs/track.png

A third argument picks the frame; default is the frame with the largest sum of contact forces in the
later half of the run, near full load. Off-screen: no display needed (VTK falls back to a software renderer).

Shown: the solid for |x| <= 2.6 m and z >= -1.5 m, its colour the change of vertical stress since the start of the run
(frame 0), which is in equilibrium with the weight of solid and bed; the stones on the left (x < 0), each in its own
shade; on the right the forces between them, tubes whose area grows with the normal force; the sleeper as a box.
Displacements are not magnified.
"""

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIZE = (1600, 900)
HALF_WIDTH = 2.6  # of what is shown of the solid [m]
DEPTH = -1.5  # lowest z that is shown [m]
SPLIT = 0.0  # stones are shown below this x, chains above [m]
LEAST_CHAIN = 20.0  # smallest normal force of a chain [N]
STONES = (0.80, 0.77, 0.72)
CONCRETE = (0.55, 0.57, 0.60)


def read(file, reader):
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def frames(folder):
    """Times and files of each frame, as {time: {kind: file}} in order."""
    found = {}
    for item in ElementTree.parse(folder / "results.pvd").iter("DataSet"):
        found.setdefault(float(item.get("timestep")), {})[item.get("name")] = folder / item.get("file")
    return sorted(found.items())


def chains_of(files):
    return read(files["force chains"], vtk.vtkXMLPolyDataReader())


def busiest(series):
    """The frame of the largest sum of contact forces in the later half of the run."""
    total = [vtk_to_numpy(chains_of(f).GetCellData().GetArray("normal_force")).sum() for _, f in series]
    half = len(series) // 2
    return half + int(np.argmax(total[half:]))


def load(folder, time):
    """Load on the sleeper at the row of the history nearest to `time` [N]."""
    with open(folder / "history.csv") as rows:
        column = next(rows).strip().split(",").index("load [N]")
        table = [[float(row.split(",")[c]) for c in (0, column)] for row in rows]
    return min(table, key=lambda row: abs(row[0] - time))[1]


def vertical_stress(solid):
    stress = vtk_to_numpy(solid.GetPointData().GetArray("stress"))
    return stress.reshape(-1, 9)[:, 8]


SHOWN = [((1, 0, 0), (-HALF_WIDTH, 0, 0)), ((-1, 0, 0), (HALF_WIDTH, 0, 0)), ((0, 0, 1), (0, 0, DEPTH))]


def plane(normal, origin):
    function = vtk.vtkPlane()
    function.SetNormal(normal)
    function.SetOrigin(origin)
    return function


def clip(data, normal, origin):
    cut = vtk.vtkClipDataSet()
    cut.SetInputData(data)
    cut.SetClipFunction(plane(normal, origin))
    cut.Update()
    return cut.GetOutput()


def actor(source, colour=None, table=None, limits=None, specular=0.1):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    # Lines win over the surface that they lie on.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(2.0, 2.0)
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-2.0, -2.0)
    if table is None:
        mapper.ScalarVisibilityOff()
    else:
        mapper.SetLookupTable(table)
        mapper.SetScalarRange(*limits)
        mapper.InterpolateScalarsBeforeMappingOn()
    item = vtk.vtkActor()
    item.SetMapper(mapper)
    look = item.GetProperty()
    if colour is not None:
        look.SetColor(colour)
    look.SetInterpolationToPhong()
    look.SetAmbient(0.25)
    look.SetDiffuse(0.75)
    look.SetSpecular(specular)
    look.SetSpecularPower(20)
    return item


def colours(stops, bands=None):
    """A lookup table through the given RGB stops."""
    table = vtk.vtkLookupTable()
    count = bands or 256
    table.SetNumberOfTableValues(count)
    x = np.linspace(0.0, 1.0, len(stops))
    for i in range(count):
        t = i / (count - 1)
        table.SetTableValue(i, *(float(np.interp(t, x, [s[k] for s in stops])) for k in range(3)), 1.0)
    table.Build()
    return table


def solid_actors(files, start, limits):
    grid = read(files["solid"], vtk.vtkXMLUnstructuredGridReader())
    before = read(start["solid"], vtk.vtkXMLUnstructuredGridReader())
    change = (vertical_stress(grid) - vertical_stress(before)) / 1e3
    scalar = numpy_to_vtk(change, deep=True)
    scalar.SetName("change")
    grid.GetPointData().SetScalars(scalar)
    for normal, origin in SHOWN:
        grid = clip(grid, normal, origin)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.SetNonlinearSubdivisionLevel(2)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(surface.GetOutputPort())
    normals.SetFeatureAngle(30)
    table = colours([(0.10, 0.20, 0.45), (0.15, 0.45, 0.65), (0.45, 0.75, 0.70), (0.90, 0.90, 0.70), (0.97, 0.96, 0.90)])
    body = actor(normals, table=table, limits=limits, specular=0.0)
    body.GetProperty().SetAmbient(0.80)
    body.GetProperty().SetDiffuse(0.22)

    # Edges of the elements, on the surface that is shown.
    flat = vtk.vtkDataSetSurfaceFilter()
    flat.SetInputData(read(files["solid"], vtk.vtkXMLUnstructuredGridReader()))
    flat.SetNonlinearSubdivisionLevel(0)
    edges = vtk.vtkExtractEdges()
    edges.SetInputConnection(flat.GetOutputPort())
    for normal, origin in SHOWN:
        cut = vtk.vtkClipPolyData()
        cut.SetInputConnection(edges.GetOutputPort())
        cut.SetClipFunction(plane(normal, origin))
        edges = cut
    lines = actor(edges, colour=(0.12, 0.14, 0.18))
    lines.GetProperty().SetLineWidth(1.2)
    lines.GetProperty().SetOpacity(0.45)
    return [body, lines], table


def stones_actor(files):
    grains = read(files["grains"], vtk.vtkXMLPolyDataReader())
    x = vtk_to_numpy(grains.GetPoints().GetData())
    radius = vtk_to_numpy(grains.GetPointData().GetArray("radius"))
    body = vtk_to_numpy(grains.GetPointData().GetArray("id"))
    centre = np.bincount(body, weights=x[:, 0]) / np.maximum(np.bincount(body), 1)
    keep = centre[body] < SPLIT
    # Each stone its own shade, so that stones can be distinguished.
    shade = np.random.default_rng(1).random(body.max() + 1)[body[keep]]
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(x[keep], deep=True))
    data.SetPoints(points)
    for name, values in [("radius", radius[keep]), ("shade", shade)]:
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    ball = vtk.vtkSphereSource()
    ball.SetRadius(1.0)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(16)
    mapper = vtk.vtkGlyph3DMapper()
    mapper.SetInputData(data)
    mapper.SetSourceConnection(ball.GetOutputPort())
    mapper.SetScaleArray("radius")
    mapper.SetScaleModeToScaleByMagnitude()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("shade")
    dark, light = np.array(STONES) * 0.62, np.array(STONES) * 1.12
    mapper.SetLookupTable(colours([tuple(dark), tuple(np.minimum(light, 1.0))]))
    mapper.SetScalarRange(0.0, 1.0)
    item = vtk.vtkActor()
    item.SetMapper(mapper)
    item.GetProperty().SetAmbient(0.25)
    item.GetProperty().SetDiffuse(0.75)
    item.GetProperty().SetInterpolationToPhong()
    return item


def chain_actor(files, limits):
    chains = chains_of(files)
    force = vtk_to_numpy(chains.GetCellData().GetArray("normal_force"))
    ends = vtk_to_numpy(chains.GetPoints().GetData()).reshape(-1, 2, 3)
    ids = [i for i in np.argsort(force) if force[i] > LEAST_CHAIN and ends[i, :, 0].mean() > SPLIT]
    append = vtk.vtkAppendPolyData()
    for i in ids:
        line = vtk.vtkLineSource()
        line.SetPoint1(ends[i, 0])
        line.SetPoint2(ends[i, 1])
        tube = vtk.vtkTubeFilter()
        tube.SetInputConnection(line.GetOutputPort())
        tube.SetRadius(float(0.003 + 0.015 * np.sqrt(min(force[i] / limits[1] / 1e3, 1.5))))
        tube.SetNumberOfSides(12)
        tube.CappingOn()
        tube.Update()
        out = tube.GetOutput()
        values = numpy_to_vtk(np.full(out.GetNumberOfPoints(), force[i] / 1e3), deep=True)
        values.SetName("force")
        out.GetPointData().SetScalars(values)
        append.AddInputData(out)
    table = colours([(0.98, 0.78, 0.25), (0.95, 0.45, 0.10), (0.80, 0.08, 0.10), (0.45, 0.0, 0.12)])
    return actor(append, table=table, limits=limits), table


def sleeper_actor(files):
    """The last wall is the sleeper; planes have one polygon each, the sleeper six."""
    walls = read(files["walls and sleeper"], vtk.vtkXMLPolyDataReader())
    number = vtk_to_numpy(walls.GetCellData().GetArray("id"))
    threshold = vtk.vtkThreshold()
    threshold.SetInputData(walls)
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "id")
    threshold.SetLowerThreshold(float(number.max()))
    threshold.SetUpperThreshold(float(number.max()))
    surface = vtk.vtkGeometryFilter()
    surface.SetInputConnection(threshold.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(surface.GetOutputPort())
    normals.SplittingOn()
    normals.SetFeatureAngle(30)
    return actor(normals, colour=CONCRETE)


def legend(table, limits, title, left, width=0.29):
    bar = vtk.vtkScalarBarActor()
    shown = vtk.vtkLookupTable()
    shown.DeepCopy(table)
    shown.SetRange(*limits)
    bar.SetLookupTable(shown)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("{:.3g}" if vtk.vtkVersion().GetVTKVersion() >= "9.6" else "%.3g")
    bar.SetTitle(title)
    bar.UnconstrainedFontSizeOn()
    bar.SetVerticalTitleSeparation(10)
    bar.SetPosition(left, 0.015)
    bar.SetWidth(width)
    bar.SetHeight(0.13)
    bar.SetTextPositionToSucceedScalarBar()
    for text, size in [(bar.GetTitleTextProperty(), 22), (bar.GetLabelTextProperty(), 20)]:
        text.SetColor(0.1, 0.1, 0.12)
        text.SetFontSize(size)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontFamilyToArial()
    return bar


def caption(text):
    item = vtk.vtkTextActor()
    item.SetInput(text)
    look = item.GetTextProperty()
    look.SetColor(0.1, 0.1, 0.12)
    look.SetFontSize(24)
    look.SetFontFamilyToArial()
    item.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    item.SetPosition(0.02, 0.945)
    return item


def main():
    folder, picture = Path(sys.argv[1]), sys.argv[2]
    series = frames(folder)
    index = int(sys.argv[3]) if len(sys.argv) > 3 else busiest(series)
    time, files = series[index]

    renderer = vtk.vtkRenderer()
    renderer.SetBackground(0.97, 0.975, 0.98)
    stress_limits, chain_limits = (-40.0, 0.0), (0.0, 1.6)
    solid, stress_table = solid_actors(files, series[0][1], stress_limits)
    chain, chain_table = chain_actor(files, chain_limits)
    for item in [*solid, stones_actor(files), chain, sleeper_actor(files)]:
        renderer.AddActor(item)
    renderer.AddViewProp(legend(stress_table, stress_limits, "vertical stress, change since the start [kPa]", 0.06))
    renderer.AddViewProp(legend(chain_table, chain_limits, "normal contact force [kN]", 0.64))
    renderer.AddViewProp(caption(f"t = {time:.3f} s, load {load(folder, time) / 1e3:.1f} kN"))

    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0.0, 0.3, -0.62)
    camera.SetPosition(1.65, -6.75, 2.4)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(23)
    renderer.ResetCameraClippingRange()
    lights = vtk.vtkLightKit()
    lights.SetKeyLightIntensity(0.85)
    lights.AddLightsToRenderer(renderer)

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.SetInputBufferTypeToRGB()
    image.ReadFrontBufferOff()
    image.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    print(f"frame {index}, t = {time:.4f} s: {picture}")


if __name__ == "__main__":
    main()
