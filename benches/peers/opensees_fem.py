"""Solids, beams and a track in OpenSees (PyPI `openseespy`)."""

import math

import common

try:
    import openseespy.opensees as ops
except ImportError as error:
    ops, absent = None, error


def grid(lines, counts):
    """Points of a line of `counts` equal parts between `lines`."""
    points = [lines[0]]
    for start, end, count in zip(lines, lines[1:], counts):
        points += [start + (end - start) * (k + 1) / count for k in range(count)]
    return points


def bricks(axes, material, element="bbarBrick"):
    """8-node bricks on a grid; numbers of nodes by index."""
    xs, ys, zs = axes
    number = lambda i, j, k: 1 + i + len(xs) * (j + len(ys) * k)
    for k, z in enumerate(zs):
        for j, y in enumerate(ys):
            for i, x in enumerate(xs):
                ops.node(number(i, j, k), x, y, z)
    count = 0
    for k in range(len(zs) - 1):
        for j in range(len(ys) - 1):
            for i in range(len(xs) - 1):
                count += 1
                corners = [number(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                ops.element(element, count, *corners, material)
    return number


def start(dimensions, unknowns):
    ops.wipe()
    ops.model("basic", "-ndm", dimensions, "-ndf", unknowns)


def solver(kind, numberer="RCM"):
    ops.constraints("Transformation")
    ops.numberer(numberer)
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-9, 50)
    ops.algorithm("Newton")
    if kind == "static":
        ops.integrator("LoadControl", 1.0)
        ops.analysis("Static")
    else:
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")


def cook_membrane(row):
    """9-node quadrilaterals in plane stress, as many per side as the bricks of the scene."""
    n, corners = 16, ((0.0, 0.0), (48.0, 44.0), (48.0, 60.0), (0.0, 44.0))
    start(2, 2)
    ops.nDMaterial("ElasticIsotropic", 1, 1e9, 1 / 3)
    number = lambda i, j: 1 + i + (n + 1) * j
    for j in range(n + 1):
        for i in range(n + 1):
            s, t = i / n, j / n
            shares = ((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t)
            ops.node(number(i, j), *(sum(a * c[d] for a, c in zip(shares, corners)) for d in (0, 1)))
            if i == 0:
                ops.fix(number(i, j), 1, 1)
    places = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))
    count = 0
    for j in range(0, n, 2):
        for i in range(0, n, 2):
            count += 1
            ops.element("quad9n", count, *(number(i + a, j + b) for a, b in places), 1.0, "PlaneStress", 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for j in range(0, n, 2):
        for b, share in ((0, 1 / 6), (1, 4 / 6), (2, 1 / 6)):
            ops.load(number(n, j + b), 0.0, 62500.0 * 16 * 2 / n * share)
    solver("static")
    assert ops.analyze(1) == 0
    return ops.nodeDisp(number(n, n // 2), 2) * row["quantity"]["factor"]


def beam_mode(row):
    """20 beam elements in space."""
    n, length, width, height, young, density = 20, 2.0, 0.05, 0.1, 210e9, 7850.0
    start(3, 6)
    area, weak, strong = width * height, height * width**3 / 12, width * height**3 / 12
    ops.geomTransf("Linear", 1, 0, 0, 1)
    for k in range(n + 1):
        ops.node(k + 1, length * k / n, 0.0, 0.0)
    ops.fix(1, 1, 1, 1, 1, 1, 1)
    for k in range(n):
        ops.element("elasticBeamColumn", k + 1, k + 1, k + 2, area, young, young / 2.6, weak + strong, strong, weak, 1, "-mass", density * area, "-cMass")
    found = sorted(ops.eigen("-fullGenLapack", 4))
    return math.sqrt(found[round(row["quantity"]["at"]) - 1]) / (2 * math.pi)


def moving_force(row):
    """40 beam elements; the force and its moments by the shape functions of the beam (Hermite)."""
    n, length, force, speed, step = 40, 20.0, -1e5, 40.0, 1e-3
    start(2, 3)
    ops.geomTransf("Linear", 1)
    for k in range(n + 1):
        ops.node(k + 1, length * k / n, 0.0)
    ops.fix(1, 1, 1, 0)
    ops.fix(n + 1, 0, 1, 0)
    for k in range(n):
        ops.element("elasticBeamColumn", k + 1, k + 1, k + 2, 1.0, 30e9, 1 / 12, 1, "-mass", 2500.0, "-cMass")
    times = [k * step for k in range(round(0.5 / step) + 1)]
    h = length / n

    def share(k, t):
        """Force and moment on node k at time t."""
        s = (speed * t - k * h) / h
        if abs(s) >= 1:
            return 0.0, 0.0
        a = abs(s)
        return 1 - 3 * a**2 + 2 * a**3, math.copysign(h * (a - 2 * a**2 + a**3), s)

    for k in range(n + 1):
        for direction in (0, 1):
            series = 1 + 2 * k + direction
            ops.timeSeries("Path", series, "-dt", step, "-values", *(share(k, t)[direction] for t in times))
            ops.pattern("Plain", series, series)
            ops.load(k + 1, 0.0, force * (1 - direction), force * direction)
    solver("transient")
    found = [0.0]
    for _ in times[1:]:
        assert ops.analyze(1, step) == 0
        found.append(ops.nodeDisp(n // 2 + 1, 2))
    return common.taken(row, {"time": times, row["quantity"]["column"]: found})


def column(lengths, modulus, density, direction):
    """Column of bricks in one direction of motion; node numbers by level."""
    start(3, 3)
    young, poisson = modulus
    ops.nDMaterial("ElasticIsotropic", 1, young, poisson, density)
    number = bricks(([0.0, 1.0], [0.0, 1.0], lengths), 1, "stdBrick")
    for k in range(len(lengths)):
        for i in (0, 1):
            for j in (0, 1):
                ops.fix(number(i, j, k), *(int(d != direction) for d in range(3)))
    return number


def history(row, times, pulse, act, watched):
    """Value of a row from the displacement of the `watched` (node, direction) of a column; `act(i, j)` at four nodes follows `pulse`."""
    step = times[1]
    ops.timeSeries("Path", 1, "-dt", step, "-values", *pulse)
    ops.pattern("Plain", 1, 1)
    for i in (0, 1):
        for j in (0, 1):
            act(i, j)
    solver("transient")
    found = [0.0]
    for _ in times[1:]:
        assert ops.analyze(1, step) == 0
        found.append(ops.nodeDisp(*watched))
    return common.taken(row, {"time": times, row["quantity"]["column"]: found})


def shear_column(row):
    """40 bricks of 8 nodes; the base follows the pulse of the scene."""
    n, step = 40, 5e-4
    number = column(grid([-10.0, 0.0], [n]), (50e6, 0.25), 2000.0, 0)
    times = [k * step for k in range(round(0.6 / step) + 1)]
    pulse = [0.01 * math.sin(math.pi * t / 0.1) ** 4 if t < 0.1 else 0.0 for t in times]
    return history(row, times, pulse, lambda i, j: ops.sp(number(i, j, 0), 1, 1.0), (number(0, 0, n), 1))


def wave_column(row):
    """40 bricks of 8 nodes with dashpots rho c below."""
    n, step, young, poisson, density = 40, 5e-4, 50e6, 0.3, 2000.0
    number = column(grid([-20.0, 0.0], [n]), (young, poisson), density, 2)
    speed = math.sqrt(young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson) * density))
    ops.uniaxialMaterial("Viscous", 2, density * speed / 4, 1.0)
    for c, (i, j) in enumerate(((0, 0), (1, 0), (0, 1), (1, 1))):
        ops.node(10000 + c, float(i), float(j), -20.0)
        ops.fix(10000 + c, 1, 1, 1)
        ops.element("zeroLength", 10000 + c, 10000 + c, number(i, j, 0), "-mat", 2, "-dir", 3)
    times = [k * step for k in range(round(0.3 / step) + 1)]
    pulse = [math.sin(math.pi * 40 * t) ** 2 if t < 1 / 40 else 0.0 for t in times]
    return history(row, times, pulse, lambda i, j: ops.load(number(i, j, n), 0.0, 0.0, -10e3 / 4), (number(0, 0, n), 3))


def triaxial(row):
    """One brick, sides at 100 kPa, shortened by 2 %: largest deviatoric stress."""
    tables = common.scene(row)
    name = row["quantity"]["file"].removeprefix("drained_").removesuffix(".csv")
    soil = next(m for m in tables["material"] if m["name"] == name)
    young, poisson = soil["young"], soil["poisson"]
    bulk, shear = young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    start(3, 3)
    if name == "von_mises":
        ops.nDMaterial("J2Plasticity", 1, bulk, shear, soil["yield_stress"], soil["yield_stress"], 0.0, 0.0)
    else:
        # sqrt(2/3) q - 3 rho p = sqrt(2/3) strength in this program: cone through the compression meridian.
        sine = math.sin(soil["friction"])
        slope = 2 * math.sqrt(2 / 3) * sine / (3 - sine) * 1.0
        cohesive = 6 * soil["cohesion"] * math.cos(soil["friction"]) / (3 - sine)
        flow = 2 * math.sqrt(2 / 3) * math.sin(soil["dilation"]) / (3 - math.sin(soil["dilation"]))
        ops.nDMaterial("DruckerPrager", 1, bulk, shear, cohesive, slope, flow, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 101e3)
    number = bricks(([0.0, 1.0],) * 3, 1, "stdBrick")
    for i in (0, 1):
        for j in (0, 1):
            for k in (0, 1):
                ops.fix(number(i, j, k), int(i == 0), int(j == 0), int(k == 0))
    cell = 100e3
    ops.timeSeries("Path", 1, "-time", 0.0, 1.0, 100.0, "-values", 0.0, 1.0, 1.0)
    ops.pattern("Plain", 1, 1)
    for a in (0, 1):
        for b in (0, 1):
            ops.load(number(1, a, b), -cell / 4, 0.0, 0.0)
            ops.load(number(a, 1, b), 0.0, -cell / 4, 0.0)
            ops.load(number(a, b, 1), 0.0, 0.0, -cell / 4)
    ops.constraints("Penalty", 1e14, 1e14)
    ops.numberer("Plain")
    ops.system("UmfPack")
    ops.test("NormDispIncr", 1e-10, 100)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 0.1)
    ops.analysis("Static")
    assert ops.analyze(10) == 0
    settled = ops.nodeDisp(number(0, 0, 1), 3)
    steps = 200
    ops.timeSeries("Path", 2, "-time", 0.0, 1.0, 2.0, "-values", settled, settled, settled - 0.02)
    ops.pattern("Plain", 2, 2)
    for i in (0, 1):
        for j in (0, 1):
            ops.sp(number(i, j, 1), 3, 1.0)
    ops.integrator("LoadControl", 1 / steps)
    found = []
    for _ in range(steps):
        assert ops.analyze(1) == 0
        stress = ops.eleResponse(1, "material", "1", "stress")
        found.append(stress[0] - stress[2])
    return common.taken(row, {"time": list(range(steps)), "q": found})


def track(row, hanging):
    """Rail on springs under two wheels or with one sleeper free of its bed: largest or standing rail-seat force of the second sleeper."""
    tables = common.scene(row)
    rail, load = tables["track"]["rail"], tables["track"]["load"]
    spacing, extension, parts, bed = 0.6, rail["extension"], 12, rail["foundation"]
    bending, pad, mass = rail["bending_stiffness"], rail["pad_stiffness"], rail["mass"] * 9.81
    weight = tables["track"]["sleeper"]["mass"] * 9.81
    low, high = -extension, 2 * spacing + extension
    step = spacing / parts
    n = round((high - low) / step)
    start(2, 3)
    ops.geomTransf("Linear", 1)
    for k in range(n + 1):
        ops.node(k + 1, low + k * step, 0.0)
        ops.fix(k + 1, 1, 0, 0)
    for k in range(n):
        ops.element("elasticBeamColumn", k + 1, k + 1, k + 2, 1.0, 1.0, bending, 1)
    ops.uniaxialMaterial("Elastic", 1, bed)
    ops.uniaxialMaterial("Elastic", 2, pad)
    ops.uniaxialMaterial("Elastic", 3, 1e-3)
    at = lambda y: round((y - low) / step) + 1
    seats = [round((-extension + spacing * j) / spacing) * spacing for j in range(round((high - low) / spacing) + 1)]
    for s, y in enumerate(seats):
        ops.node(5000 + s, y, 0.0)
        ops.fix(5000 + s, 1, 0, 1)
        ops.node(6000 + s, y, 0.0)
        ops.fix(6000 + s, 1, 1, 1)
        free = hanging and abs(y - spacing) < 1e-9
        ops.element("zeroLength", 7000 + s, 6000 + s, 5000 + s, "-mat", 3 if free else 1, "-dir", 2)
        ops.element("zeroLength", 8000 + s, 5000 + s, at(y), "-mat", 2, "-dir", 2)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for k in range(n + 1):
        ops.load(k + 1, 0.0, -mass * step, 0.0)
    for s in range(len(seats)):
        ops.load(5000 + s, 0.0, -weight, 0.0)
    middle = min(range(len(seats)), key=lambda s: abs(seats[s] - spacing))
    if not hanging:
        for y in (spacing, spacing + load["wheelbase"]):
            k = (y - low) / step
            first = int(k)
            ops.load(first + 1, 0.0, -load["axle_load"] * (1 - (k - first)), 0.0)
            ops.load(first + 2, 0.0, -load["axle_load"] * (k - first), 0.0)
    solver("static", "Plain")
    assert ops.analyze(1) == 0
    force = pad * (ops.nodeDisp(5000 + middle, 2) - ops.nodeDisp(at(spacing), 2))
    return force * row["quantity"].get("factor", 1.0)


CASES = {
    "cook-membrane": cook_membrane,
    "beam-mode-1": beam_mode,
    "beam-mode-2": beam_mode,
    "moving-force": moving_force,
    "shear-column": shear_column,
    "wave-column": wave_column,
    "von-mises": triaxial,
    "drucker-prager": triaxial,
    "rail-seat": lambda row: track(row, False),
    "hanging-sleeper": lambda row: track(row, True),
}

if __name__ == "__main__":
    if ops is None:
        common.missing(absent)
    common.print_values(str(ops.version()), lambda row: CASES[row["name"]](row))
