"""Prints the first, middle and last item of each array of a VTKHDF file at every time, read by VTK.

Usage: vtkhdf_check.py FILE
"""

import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader


def number(value):
    """Formats like Rust's {:.17e}."""
    mantissa, exponent = f"{float(value):.17e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def show(name, array):
    values = vtk_to_numpy(array).reshape(array.GetNumberOfTuples(), array.GetNumberOfComponents())
    count = len(values)
    items = [0, count // 2, count - 1] if count else []
    text = "".join(f" {number(value)}" for item in items for value in values[item])
    print(f"  {name} {array.GetNumberOfComponents()}{text}")


def main():
    reader = vtkHDFReader()
    reader.SetFileName(sys.argv[1])
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    for time in times:
        reader.UpdateTimeStep(time)
        data = reader.GetOutputDataObject(0)
        print(f"t = {number(time)}: {data.GetNumberOfPoints()} points, {data.GetNumberOfCells()} cells")
        show("points", data.GetPoints().GetData())
        for attributes, of in ((data.GetPointData(), ""), (data.GetCellData(), " of cells")):
            arrays = [attributes.GetArray(k) for k in range(attributes.GetNumberOfArrays())]
            for array in sorted(arrays, key=lambda array: array.GetName()):
                show(array.GetName() + of, array)


if __name__ == "__main__":
    main()
