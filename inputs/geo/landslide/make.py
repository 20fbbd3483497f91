"""Writes the terrain and the key block of this folder: python3 inputs/geo/landslide/make.py

Terrain: heights on a grid of 20 m, a slope of 32 degrees that bends into a valley floor, a trough along the slide and low
bumps. Key block: 11 x 13 x 42 spheres of 15 m, hexagonal, on the slope: 42 along the dip, 13 along the strike, 11 layers.
"""

import math
import pathlib

FOLDER = pathlib.Path(__file__).parent
CELL, COLUMNS, ROWS = 20.0, 181, 61  # x from 0 to 3600 m, y from -600 to 600 m
DIP = math.radians(32.0)
BEND = (1000.0, 400.0)  # where the slope ends in plan, and the width of the bend
DIAMETER, LONG, WIDE, LAYERS = 15.0, 42, 13, 11
# Uphill end of the block in plan.
HEAD = 120.0


def profile(x):
    """Height along the slide: slope, then floor, with a parabola between; the floor lies at 0."""
    begin, end = BEND[0] - 0.5 * BEND[1], BEND[0] + 0.5 * BEND[1]
    fall = math.tan(DIP)
    if x >= end:
        return 0.0
    if x >= begin:
        return fall * (end - x) ** 2 / (2.0 * (end - begin))
    return fall * (BEND[0] - x)


def height(x, y):
    """The profile in a trough whose sides rise, with bumps below the foot of the block."""
    side = 120.0 * (max(0.0, abs(y) - 200.0) / 400.0) ** 2
    rough = max(0.0, min(1.0, (x - 750.0) / 150.0))
    bumps = 4.0 * math.sin(x / 45.0) * math.cos(y / 38.0) + 3.0 * math.sin((x + 2.0 * y) / 71.0)
    return profile(x) + side + rough * bumps


def terrain():
    rows = []
    for row in range(ROWS):
        y = 600.0 - CELL * row
        rows.append(" ".join(f"{height(CELL * c, y):.3f}" for c in range(COLUMNS)))
    head = [
        f"ncols {COLUMNS}",
        f"nrows {ROWS}",
        "xllcenter 0",
        "yllcenter -600",
        f"cellsize {CELL:g}",
        "NODATA_value -9999",
    ]
    (FOLDER / "terrain.asc").write_text("\n".join(head + rows) + "\n")
    return COLUMNS * ROWS


def block():
    """Rows x, y, z, r. Layers of a hexagonal packing lie on the slope, rows of a layer along the strike."""
    r = 0.5 * DIAMETER
    down = (math.cos(DIP), -math.sin(DIP))
    up = (math.sin(DIP), math.cos(DIP))
    start = (HEAD, math.tan(DIP) * (BEND[0] - HEAD))
    lines = ["x,y,z,r"]
    for k in range(LAYERS):
        height_of_layer = r + 0.02 + k * DIAMETER * math.sqrt(2.0 / 3.0)
        for i in range(LONG):
            along = r + i * DIAMETER * math.sqrt(0.75) + (k % 2) * DIAMETER / math.sqrt(12.0)
            for j in range(WIDE):
                across = (j - 0.5 * (WIDE - 1)) * DIAMETER + ((i + k) % 2) * r - 0.5 * r
                x = start[0] + along * down[0] + height_of_layer * up[0]
                z = start[1] + along * down[1] + height_of_layer * up[1]
                lines.append(f"{x:.6f},{across:.6f},{z:.6f},{r}")
    (FOLDER / "block.csv").write_text("\n".join(lines) + "\n")
    return len(lines) - 1


if __name__ == "__main__":
    print(terrain(), "vertices,", block(), "spheres")
