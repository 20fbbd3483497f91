"""Rows of the verification matrix for the scripts of peers (`trackbed verify --peers`).

    benches/peers/environment.sh /tmp/peers          # pinned wheels; Debian packages with root
    trackbed verify --peers --python /tmp/peers/bin/python

Add a row: an entry `[[row]]` of inputs/verify/matrix.toml that names its `peers`. Impacts of one or two spheres need no more:
`impact` reads scene, overrides and quantity. Other rows need a function in `CASES` of the script.

Add a program: an entry `[[peer]]` and a script that calls `print_values(version, compute)`; `compute(row)` returns the value of
the row's quantity in its unit. The script gets the matrix file and names of rows; the last line of its standard output is

    {"version": "1.2", "rows": {"NAME": {"value": 0.36, "seconds": 0.1}, "OTHER": {"error": "reason"}}}

or {"missing": "reason"}. `explained` of a row states why an error exceeds the tolerance. Needs Python 3.11.
"""

import json, math, os, re, sys, time, tomllib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# First argument; the shipped one for other uses.
MATRIX = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "inputs", "verify", "matrix.toml")
PREFIX = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "m": 1e-3, "u": 1e-6, "c": 1e-2}


def si(value):
    """Value in SI units of a number or a text such as "48 GPa"; other values as they are."""
    if isinstance(value, list):
        return [si(v) for v in value]
    found = re.fullmatch(r"(-?[0-9.]+(?:e-?\d+)?) ([kMGmuc]?)(Pa|m|s|N|N/m|N m2|m/s|m/h|kg|kg/m|kg/m3|Hz|deg|N s/m)", value) if isinstance(value, str) else None
    if not found:
        return value
    number, prefix, unit = found.groups()
    if unit == "deg":
        return float(number) * 3.141592653589793 / 180
    if unit == "m/h":
        return float(number) * PREFIX[prefix] / 3600
    return float(number) * (1.0 if unit.startswith("kg") else PREFIX[prefix])


def scene(row):
    """Scene of a row as nested tables with its overrides, in SI units."""
    with open(os.path.join(os.path.dirname(MATRIX), row["scene"]), "rb") as file:
        tables = tomllib.load(file)
    for assignment in row.get("set", []):
        path, _, text = assignment.partition("=")
        *keys, last = [int(k) if k.isdigit() else k for k in path.split(".")]
        table = tables
        for key in keys:
            table = table[key] if isinstance(key, int) else table.setdefault(key, {})
        if text:
            table[last] = tomllib.loads(f"v = {text}")["v"]
        else:
            table.pop(last, None)
    return converted(tables)


def converted(value):
    if isinstance(value, dict):
        return {key: converted(v) for key, v in value.items()}
    if isinstance(value, list) and value and isinstance(value[0], (dict, list)):
        return [converted(v) for v in value]
    return si(value)


def taken(row, columns):
    """Quantity of a row from lists by column; `time` is the abscissa."""
    quantity = row["quantity"]
    time, values = columns["time"], columns[quantity["column"]]

    def at(t):
        k = next(k for k in range(1, len(time)) if time[k] >= t)
        return values[k - 1] + (values[k] - values[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1])

    zero = at(quantity["since"]) if "since" in quantity else 0.0
    kept = [(t, v - zero) for t, v in zip(time, values) if t >= quantity.get("from", time[0])]
    only = [v for _, v in kept]
    active = [t for t, v in kept if v != 0.0]
    take = quantity.get("take", "last")
    value = {
        "last": lambda: only[-1],
        "mean": lambda: sum(only) / len(only),
        "max": lambda: max(only),
        "min": lambda: min(only),
        "range": lambda: max(only) - min(only),
        "duration": lambda: active[-1] - active[0],
        "at": lambda: at(quantity["at"]) - zero,
    }[take]()
    return value * quantity.get("factor", 1.0)


def impact(row):
    """Impact of one sphere on a rigid plane at z = 0, or of two spheres: constants of the contact, bodies and time steps.

    Stiffnesses: F = normal R^(1/2) overlap^(3/2), tangential K = tangential R^(1/2) overlap^(1/2) (Hertz, Mindlin without slip).
    """
    tables = scene(row)
    materials = {m["name"]: m for m in tables["material"]}
    bodies = []
    for group in tables["grains"]:
        *place, radius = group["spheres"][0]
        bodies.append({
            "place": place,
            "radius": radius,
            "density": materials[group["material"]]["density"],
            "velocity": group.get("velocity", [0.0, 0.0, 0.0]),
            "spin": group.get("spin", [0.0, 0.0, 0.0]),
            "name": group["name"],
        })
    elastic = [m for m in materials.values() if "young" in m]
    modulus = 1 / sum((1 - m["poisson"] ** 2) / m["young"] for m in elastic)
    shear = 1 / sum(2 * (2 - m["poisson"]) * (1 + m["poisson"]) / m["young"] for m in elastic)
    return {
        "bodies": bodies,
        "plane": "walls" in tables,
        "young": elastic[0]["young"],
        "poisson": elastic[0]["poisson"],
        "normal": 4 / 3 * modulus,
        "tangential": 8 * shear,
        "friction": min(m["friction"] for m in materials.values()),
        "restitution": min(m["restitution"] for m in materials.values()),
        "gravity": tables.get("gravity", [0.0, 0.0, 0.0])[2],
        "step": tables["time"]["grain_step"],
        "steps": round(tables["time"]["end"] / tables["time"]["grain_step"]),
    }


def bulk(row):
    """Scene of many spheres: bodies (position, radius, density, velocity, type from 1), laws by pairs of types, walls, steps.

    The last type is the rigid material of the walls; constants of laws as in `impact`.
    """
    tables = scene(row)
    folder = os.path.dirname(os.path.join(os.path.dirname(MATRIX), row["scene"]))
    materials = tables["material"]
    types = {m["name"]: k for k, m in enumerate(materials, 1)}
    pairs = {tuple(sorted(types[n] for n in c["between"])): c for c in tables.get("contact", [])}
    laws = {}
    for a, first in enumerate(materials, 1):
        for b, second in enumerate(materials[a - 1 :], a):
            elastic = [m for m in (first, second) if "young" in m]
            own = pairs.get((a, b), {})
            if elastic:
                laws[a, b] = {
                    "normal": 4 / 3 / sum((1 - m["poisson"] ** 2) / m["young"] for m in elastic),
                    "tangential": 8 / sum(2 * (2 - m["poisson"]) * (1 + m["poisson"]) / m["young"] for m in elastic),
                    **{key: own.get(key, min(first[key], second[key])) for key in ("friction", "restitution")},
                }
    bodies = []
    for group in tables["grains"]:
        spheres = group.get("spheres")
        if spheres is None:
            with open(os.path.join(folder, group["packing"])) as file:
                spheres = [[float(v) for v in line.split(",")] for line in file.readlines()[1:]]
        density, velocity = materials[types[group["material"]] - 1]["density"], group.get("velocity", [0.0, 0.0, 0.0])
        bodies += [(s[:3], s[3], density, velocity, types[group["material"]]) for s in spheres]
    step = tables["time"]["grain_step"]
    return {
        "bodies": bodies,
        "materials": materials,
        "laws": laws,
        "walls": tables["walls"],
        "step": step,
        "steps": round(tables["time"]["end"] / step),
        "masses": [density * 4 / 3 * math.pi * r**3 for _, r, density, _, _ in bodies],
    }


def bulk_value(row, case, frames):
    """Quantity of a scene of many spheres from frames (time, positions), the first at the start."""
    masses = case["masses"]
    if "summary" in row["quantity"]:
        # Outflow below z = 0 in the second half.
        out = [sum(m for m, x in zip(masses, places) if x[2] < 0) for _, places in frames]
        middle = len(frames) // 2
        return (out[-1] - out[middle]) / (frames[-1][0] - frames[middle][0])
    columns = {
        "time": [t for t, _ in frames],
        "ball_x_z": [places[-1][2] for _, places in frames],
        # On the drum: moment of the weight.
        "drum_moment_y": [9.81 * sum(m * x[0] for m, x in zip(masses, places)) for _, places in frames],
    }
    return taken(row, columns)


def history(case, records):
    """Columns of `taken` from records (time, x, v, spin, force on the first sphere) of an impact."""
    name = case["bodies"][0]["name"]
    columns = {"time": [r[0] for r in records]}
    for d, axis in enumerate("xyz"):
        columns[f"{name}_x_{axis}"] = [r[1][d] for r in records]
        columns[f"{name}_v_{axis}"] = [r[2][d] for r in records]
        columns[f"{name}_spin_{axis}"] = [r[3][d] for r in records]
        columns[f"plane_force_{axis}"] = [-r[4][d] for r in records]
    # Not zero while in contact, as the energy of the springs.
    columns["contact_springs"] = [abs(r[4][0]) + abs(r[4][1]) + abs(r[4][2]) for r in records]
    return columns


def rows(names):
    with open(MATRIX, "rb") as file:
        return [row for row in tomllib.load(file)["row"] if row["name"] in names]


def print_values(version, compute):
    """Prints the values of the rows that the command line names."""
    found = {}
    for row in rows(sys.argv[2:]):
        start = time.perf_counter()
        try:
            value = compute(row)
            found[row["name"]] = {"value": float(value), "seconds": time.perf_counter() - start}
        except Exception as error:
            found[row["name"]] = {"error": f"{type(error).__name__}: {error}"}
    print("\n" + json.dumps({"version": version, "rows": found}), flush=True)


def missing(reason):
    """Ends a script whose program is not installed."""
    print(json.dumps({"missing": str(reason)}))
    sys.exit(0)
