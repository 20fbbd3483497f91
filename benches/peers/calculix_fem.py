"""Solids in CalculiX (Debian package `calculix-ccx`), on the meshes of the scenes where these are Abaqus files."""

import os, re, shutil, subprocess, tempfile

import common


def solve(text):
    """Content of the .dat file of an input."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "case.inp"), "w") as file:
            file.write(text)
        done = subprocess.run(["ccx", "case"], cwd=folder, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        with open(os.path.join(folder, "case.dat")) as file:
            found = file.read()
    if not found.strip():
        raise RuntimeError(done.stdout[-500:])
    return found


def mesh(row, without=()):
    """Nodes and elements of the scene's mesh as text, and the nodes; blocks of `without` are left out."""
    tables = common.scene(row)
    path = os.path.join(os.path.dirname(os.path.join(os.path.dirname(common.MATRIX), row["scene"])), tables["solid"]["mesh"])
    with open(path) as file:
        blocks = re.split(r"\n(?=\*)", file.read())
    kept = [b for b in blocks if b.split(",")[0].strip().split("\n")[0] not in without]
    lines = next(b for b in blocks if b.startswith("*NODE")).split("\n")[1:]
    nodes = {int(n): tuple(map(float, x)) for n, *x in (line.split(",") for line in lines if line.strip())}
    return "\n".join(kept) + "\n", nodes, tables


def fixed(nodes, direction, value):
    return "".join(f"{n}, {direction + 1}, {direction + 1}\n" for n, x in nodes.items() if abs(x[direction] - value) < 1e-9)


def quadratic_loads(faces, direction, stress, area):
    """Consistent forces of a uniform traction on 8-node faces: -1/12 at corners, 1/3 at mid-sides."""
    forces = {}
    for face in faces:
        for k, n in enumerate(face):
            forces[n] = forces.get(n, 0.0) + stress * area * (-1 / 12 if k < 4 else 1 / 3)
    return "".join(f"{n}, {direction + 1}, {f:.12g}\n" for n, f in forces.items())


def displacement(text, direction):
    """Last printed displacement of the only node."""
    lines = [line.split() for line in text.splitlines() if re.match(r"\s+\d+(\s+\S+){3}\s*$", line)]
    return float(lines[-1][1 + direction])


ENDING = "*NODE PRINT, NSET=PROBE\nU\n*END STEP\n"


def cook_membrane(row):
    """Same mesh of 20-node bricks."""
    text, nodes, _ = mesh(row)
    right = sorted((x[1], x[2], n) for n, x in nodes.items() if abs(x[0] - 48) < 1e-9)
    at = {(round(y, 6), z): n for y, z, n in right}
    levels = sorted({y for y, _ in at})
    faces = []
    for low, middle, high in zip(levels[::2], levels[1::2], levels[2::2]):
        faces.append([at[low, 0.0], at[high, 0.0], at[high, 1.0], at[low, 1.0], at[middle, 0.0], at[high, 0.5], at[middle, 1.0], at[low, 0.5]])
    probe = at[52.0, 0.0]
    clamp = fixed(nodes, 0, 0.0) + "".join(f"{n}, 2, 2\n" for n, x in nodes.items() if abs(x[0]) < 1e-9)
    text += f"*NSET, NSET=PROBE\n{probe}\n*BOUNDARY\n{clamp}{fixed(nodes, 2, 0.0)}*STEP\n*STATIC\n*CLOAD\n"
    text += quadratic_loads(faces, 1, 62500.0, levels[2] - levels[0]) + ENDING
    return displacement(solve(text), 1) * row["quantity"]["factor"]


def thick_cylinder(row):
    """Same mesh of 20-node bricks, elastic."""
    text, nodes, tables = mesh(row, without=("*BOUNDARY", "*MATERIAL", "*ELASTIC", "*SOLID SECTION", "*DENSITY"))
    soil, load = tables["solid"]["material"][0], tables["solid"]["load"][0]
    pressure = load["pressure"] * load["history"]["points"][1][1]
    elements = re.search(r"\*ELEMENT[^\n]*\n(.*?)(?=\n\*|\Z)", text, re.S)[1]
    numbers = [int(n) for n in re.findall(r"\d+", elements)]
    bore = {n for n, x in nodes.items() if x[0] ** 2 + x[1] ** 2 < 0.5001**2}
    # Corners of the faces of a brick in CalculiX.
    sides = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
    loads = ""
    for k in range(0, len(numbers), 21):
        element, *own = numbers[k : k + 21]
        loads += "".join(f"{element}, P{s + 1}, {pressure:.12g}\n" for s, side in enumerate(sides) if all(own[c] in bore for c in side))
    probe = next(n for n, x in nodes.items() if abs(x[0] - 0.5) < 1e-9 and abs(x[1]) < 1e-9 and abs(x[2]) < 1e-9)
    name = re.search(r"ELSET=(\w+)", text)[1]
    heights = sorted({x[2] for x in nodes.values()})
    text += f"*MATERIAL, NAME=OWN\n*ELASTIC\n{soil['young']}, {soil['poisson']}\n*SOLID SECTION, ELSET={name}, MATERIAL=OWN\n"
    text += f"*NSET, NSET=PROBE\n{probe}\n*BOUNDARY\n{fixed(nodes, 0, 0.0)}{fixed(nodes, 1, 0.0)}{fixed(nodes, 2, heights[0])}{fixed(nodes, 2, heights[-1])}"
    text += f"*STEP\n*STATIC\n*DLOAD\n{loads}{ENDING}"
    return displacement(solve(text), 0) * row["quantity"]["factor"]


def block(counts, size=None, borders=None):
    """20-node bricks of equal size, or between borders along x, y, z: text and nodes."""
    borders = borders or [[s * k / c for k in range(c + 1)] for s, c in zip(size, counts)]
    halves = [[x for pair in zip(b, [(p + q) / 2 for p, q in zip(b, b[1:])]) for x in pair] + b[-1:] for b in borders]
    nodes, elements = {}, []

    def node(*place):
        return nodes.setdefault(place, len(nodes) + 1)

    places = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0)]
    places += [(1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
    for k in range(counts[2]):
        for j in range(counts[1]):
            for i in range(counts[0]):
                elements.append([node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in places])
    points = {n: tuple(h[p] for h, p in zip(halves, place)) for place, n in nodes.items()}
    text = "*NODE\n" + "".join("%d, %.12g, %.12g, %.12g\n" % (n, *x) for n, x in points.items())
    text += "*ELEMENT, TYPE=C3D20R, ELSET=BLOCK\n"
    for n, e in enumerate(elements, 1):
        text += f"{n}, {', '.join(map(str, e[:11]))},\n{', '.join(map(str, e[11:]))}\n"
    return text, points


def beam_mode(row):
    """24 x 2 x 2 bricks of 20 nodes."""
    steel = common.scene(row)["solid"]["material"][0]
    text, nodes = block((24, 2, 2), (2.0, 0.05, 0.1))
    clamp = "".join(f"{n}, 1, 3\n" for n, x in nodes.items() if x[0] == 0.0)
    text += f"*MATERIAL, NAME=OWN\n*ELASTIC\n{steel['young']}, {steel['poisson']}\n*DENSITY\n{steel['density']}\n"
    text += f"*SOLID SECTION, ELSET=BLOCK, MATERIAL=OWN\n*BOUNDARY\n{clamp}*STEP\n*FREQUENCY\n4\n*END STEP\n"
    lines = re.findall(r"^\s+(\d+)((?:\s+\S+){4})\s*$", solve(text).split("P A R T I C I P A T I O N")[0], re.M)
    found = {int(n): float(values.split()[2]) for n, values in lines}
    return found[round(row["quantity"]["at"])]


def von_mises(row):
    """One 20-node brick, sides at 100 kPa, shortened by 2 %: axial less lateral stress."""
    soil = next(m for m in common.scene(row)["material"] if m["name"] == "von_mises")
    text, nodes = block((1, 1, 1), (1.0, 1.0, 1.0))
    text += f"*MATERIAL, NAME=OWN\n*ELASTIC\n{soil['young']}, {soil['poisson']}\n*PLASTIC\n{soil['yield_stress']}, 0.\n"
    text += "*SOLID SECTION, ELSET=BLOCK, MATERIAL=OWN\n*BOUNDARY\n" + "".join(fixed(nodes, d, 0.0) for d in range(3))
    sides = "1, P4, 100000.\n1, P5, 100000.\n"
    text += f"*STEP, INC=200\n*STATIC\n1., 1.\n*DLOAD\n{sides}1, P2, 100000.\n*END STEP\n"
    top = "".join(f"{n}, 3, 3, -0.02\n" for n, x in nodes.items() if x[2] == 1.0)
    text += f"*STEP, INC=400\n*STATIC\n0.05, 1., 1e-6, 0.05\n*DLOAD, OP=NEW\n{sides}*BOUNDARY\n{top}*EL PRINT, ELSET=BLOCK\nS\n*END STEP\n"
    stresses = re.findall(r"^\s+1\s+\d+((?:\s+\S+){6})\s*$", solve(text), re.M)
    values = [list(map(float, s.split())) for s in stresses]
    return max(v[0] - v[2] for v in values) * row["quantity"]["factor"]


def hertz_pressure(row):
    """Same mesh of 20-node bricks and pressures by faces."""
    solid = common.scene(row)["solid"]
    borders = []
    for axis in "xyz":
        table, found = solid["block"][axis], []
        for low, high, count, ratio in zip(table["lines"], table["lines"][1:], table["counts"], table["ratios"]):
            lengths = [ratio ** (k / (count - 1)) for k in range(count)]
            found += [low + (high - low) * sum(lengths[:k]) / sum(lengths) for k in range(count)]
        borders.append(found + table["lines"][-1:])
    counts = [len(b) - 1 for b in borders]
    text, nodes = block(counts, borders=borders)
    soil, loads = solid["material"][0], ""
    for load in solid["load"]:
        middle = [(p + q) / 2 for p, q in zip(*load["faces_in"])]
        i, j = (sum(b <= m for b in borders[d]) - 1 for d, m in enumerate(middle[:2]))
        loads += f"{((counts[2] - 1) * counts[1] + j) * counts[0] + i + 1}, P2, {load['pressure']}\n"
    probe = next(n for n, x in nodes.items() if x == (0.0, 0.0, 0.0))
    last = [borders[0][-1], borders[1][-1], borders[2][0]]
    far = "".join(f"{n}, 1, 3\n" for n, x in nodes.items() if any(p == q for p, q in zip(x, last)))
    text += f"*MATERIAL, NAME=OWN\n*ELASTIC\n{soil['young']}, {soil['poisson']}\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=OWN\n"
    text += f"*NSET, NSET=PROBE\n{probe}\n*BOUNDARY\n{fixed(nodes, 0, 0.0)}{fixed(nodes, 1, 0.0)}{far}"
    text += f"*STEP\n*STATIC\n*DLOAD\n{loads}{ENDING}"
    return displacement(solve(text), 2) * row["quantity"]["factor"]


CASES = {
    "hertz-pressure": hertz_pressure,
    "cook-membrane": cook_membrane,
    "thick-cylinder": thick_cylinder,
    "beam-mode-1": beam_mode,
    "beam-mode-2": beam_mode,
    "von-mises": von_mises,
}

if __name__ == "__main__":
    if shutil.which("ccx") is None:
        common.missing("found no program ccx")
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout.split()
    common.print_values(version[-1] if version else None, lambda row: CASES[row["name"]](row))
