"""Writes the nodes and strands of the net in this folder: python3 inputs/geo/net/make.py

Net of 6 m x 3 m in the plane x = 0, nodes every 0.3 m; the border is the frame. Pairs: neighbours along rows and columns.
"""

import pathlib

FOLDER = pathlib.Path(__file__).parent
SPACING, RADIUS = 0.3, 0.03
COLUMNS, ROWS = 21, 11  # along y, along z

nodes = [(i, j) for j in range(ROWS) for i in range(COLUMNS)]
border = [node for node in nodes if node[0] in (0, COLUMNS - 1) or node[1] in (0, ROWS - 1)]
inner = [node for node in nodes if node not in set(border)]
number = {node: k for k, node in enumerate(inner + border)}


def write(name, head, rows):
    (FOLDER / name).write_text("\n".join([head, *(",".join(map(str, row)) for row in rows)]) + "\n")


def place(node):
    return 0.0, round((node[0] - (COLUMNS - 1) / 2) * SPACING, 9), round(node[1] * SPACING, 9), RADIUS


write("net.csv", "x,y,z,r", map(place, inner))
write("frame.csv", "x,y,z,r", map(place, border))
neighbours = [(node, (node[0] + a, node[1] + b)) for node in nodes for a, b in ((1, 0), (0, 1))]
pairs = [(number[a], number[b]) for a, b in neighbours if b in number and not {a, b} <= set(border)]
write("pairs.csv", "a,b", pairs)
