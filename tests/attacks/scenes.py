"""Attacks by scene values."""

import math
import tomllib

from .verdict import ROOT, SOON

INPUTS = ROOT / "inputs"
# Fast scenes with overrides.
TINY = [
    ("grains/box.toml", ["grains.0.count=30", "time.end=0.02", "output.frames=2"]),
    ("grains/bonded_stone/scene.toml", ["time.end=0.001", "output.frames=2"]),
    ("grains/polyhedra.toml", ["grains.0.count=5", "deposition.max_time=0.02", "time.end=0.01", "output.frames=2"]),
    ("solid/footing.toml", ["output.frames=2"]),
    ("solid/triaxial_drained.toml", ["output.frames=2"]),
    ("verify/bounce.toml", ["output.frames=2"]),
    ("coupled/slab_mixed/scene.toml", ["output.frames=2"]),
    ("ballast/box.toml", ["grains.0.count=20", "deposition.max_time=0.01", "track.load.cycles=1", "output.frames=2"]),
]
# Values of wrong type, size or sign.
VALUES = ["0", "-0.0", "1", "-1", "2", "1e-3", "1e3", "1e-9", "1e9", "-1e9", "1e-300", "1e300", "-1e300", "1e308", "5e-324", "1e-160", "1e160"]
VALUES += ["nan", "-nan", "inf", "-inf", "4294967296", "9223372036854775807", '""', '"x"', '"1 parsec"', "true", "[]", "[0]", "[1, 2, 3]", "{}"]
FACTORS = [0.5, 2.0, 0.1, 10.0, 1e-3, 1e3, 1e-6, 1e6, -1.0, 1e12, 1e-12, 1e50, 1e-50]


def leaves(path, value):
    """Paths and values of a scene."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from leaves(f"{path}.{key}" if path else key, item)
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for at, item in enumerate(value):
            yield from leaves(f"{path}.{at}", item)
    else:
        yield path, value


def scaled(value, factor):
    """Scaled number, with its unit if any; else None."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int):
        return str(int(value * factor)) if abs(value * factor) < 1e18 else None
    if isinstance(value, float):
        return repr(value * factor)
    if isinstance(value, str) and " " in value:
        number, unit = value.split(" ", 1)
        try:
            return f'"{float(number) * factor!r} {unit}"'
        except ValueError:
            return None
    return None


def change(rng, all_leaves):
    """Random override."""
    path, value = rng.choice(all_leaves)
    kind = rng.randrange(8)
    if kind == 0:
        return f"{path}="
    if kind < 5 and (text := scaled(value, rng.choice(FACTORS))):
        return f"{path}={text}"
    if kind == 5 and isinstance(value, list) and value and not any(isinstance(v, (list, dict)) for v in value):
        items = [f'"{v}"' if isinstance(v, str) else str(v) for v in value]
        items[rng.randrange(len(items))] = rng.choice(VALUES)
        return f"{path}=[{', '.join(items)}]"
    return f"{path}={rng.choice(VALUES)}"


def both(bench, scene, sets, stop=3.0, faults=None):
    """Checks a scene and, if valid, runs it."""
    words = [f"--set={s}" for s in sets]
    faults = faults or max(1, len(sets))
    code, _ = bench.attempt("check", scene, *words, faults=faults, untouched=[scene], codes={0, 2})
    if code == 0:
        out = bench.fresh()
        bench.attempt("run", scene, *words, "--quiet", "--out", out, out=out, stop=stop, faults=faults)


def keys(bench, rng):
    """Random changes of one to three keys."""
    trees = {name: list(leaves("", tomllib.loads((INPUTS / name).read_text()))) for name, _ in TINY}
    while True:
        name, sets = rng.choice(TINY)
        changes = [change(rng, trees[name]) for _ in range(1 + rng.randrange(5) // 3)]
        both(bench, INPUTS / name, [*sets, *changes], stop=1.0 if bench.short else 3.0)
        yield


def sizes(bench, rng):
    """Huge counts, lengths and times: finite results or an error, soon."""
    box, solid = INPUTS / "grains/box.toml", INPUTS / "solid/footing.toml"
    cases = [(box, f"grains.0.count={n}") for n in (10_000_000, 9_999_999, 100_000_000, 2**32, 2**63 - 1)]
    for key in ("material.0.density", "material.0.stiffness", "time.end", "time.grain_step", "gravity"):
        cases += [(box, f"{key}={v}") for v in ("1e300", "1e-300", "1e-320", "1e160", "1e-160", "1e60", "1e-60")]
    for key in ("grains.0.size", "grains.0.fill.high"):
        cases += [(box, f"{key}=[{v}, {v}]") for v in ("1e300", "1e-300", "1e160", "1e-160", "1e30", "1e-30")]
    tree = tomllib.loads(solid.read_text())
    for path, value in leaves("solid", tree["solid"]):
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            cases += [(solid, f"{path}={v}") for v in ("1e300", "1e-300", "1e160", "1e-160")]
    rng.shuffle(cases)
    for scene, change_ in cases:
        bench.attempt("check", scene, f"--set={change_}", codes={0, 2}, soon=SOON, echo=False)
        yield


def materials(bench, rng):
    """Nearly incompressible and softening materials."""
    block = (INPUTS / "solid/triaxial_drained.toml", ["output.frames=1"])
    slope = (INPUTS / "solid/footing.toml", ["output.frames=1"])
    cases = []
    for scene, sets in (block, slope):
        for nu in ("0.49", "0.4999", "0.499999", "0.4999999999", "0.5", "-0.99", "-1", "0.51"):
            cases.append((scene, [*sets, f"solid.material.0.poisson={nu}"]))
        for more in (
            ["friction=45 deg", "dilation=0 deg"],
            ["friction=60 deg", "dilation=60 deg"],
            ["cohesion=0"],
            ["cohesion=1e-12", "friction=0.001 deg"],
            ["residual_cohesion=0", "softening_strain=1e-6"],
            ["young=1 Pa"],
            ["young=1e20"],
            ["friction=89.999 deg"],
            ["tension=0"],
        ):
            texts = [m.split("=") for m in more]
            quoted = [f"{k}={v}" if " " not in v else f'{k}="{v}"' for k, v in texts]
            cases.append((scene, [*sets, *(f"solid.material.0.{q}" for q in quoted)]))
    rng.shuffle(cases)
    for scene, sets in cases:
        both(bench, scene, sets, stop=2.0 if bench.short else 6.0)
        yield


def sleepers(bench, rng):
    """Sleepers in ground or wall, inverted, without mass."""
    scene = INPUTS / "ballast/box.toml"
    tiny = dict(TINY)["ballast/box.toml"]
    tree = tomllib.loads(scene.read_text())
    track = [(p, v) for p, v in leaves("", tree) if p.startswith("track.sleeper")]
    cases = []
    for path, value in track:
        if isinstance(value, list):
            for at in range(len(value)):
                for v in ("-0.3", "0", "5", "-1e3", "1e-9"):
                    items = [f'"{x}"' if isinstance(x, str) else str(x) for x in value]
                    items[at] = v
                    cases.append(f"{path}=[{', '.join(items)}]")
        else:
            cases += [f"{path}={v}" for v in ("-0.3", "0", "1e-9", "1e9")]
    cases += [f"track.sleeper.{key}={v}" for key in ("height", "bottom", "tilt", "embedment", "depth") for v in ("-0.2", "10")]
    rng.shuffle(cases)
    for case in cases:
        both(bench, scene, [*tiny, case], stop=1.5)
        yield


def borders(bench, rng):
    """Too narrow periodic boxes."""
    scene = INPUTS / "grains/shear.toml"
    tree = tomllib.loads(scene.read_text())
    periodic = [p for p, _ in leaves("", tree) if "periodic" in p] or ["periodic.x", "periodic.y"]
    widths = [0.0, 1e-12, 1e-3, 0.01, 0.019, 0.02, 0.021, 0.03, 0.039, 0.04, 0.041, -1.0, 1e9, math.inf]
    cases = [f"{path}=[0.0, {width}]" for path in periodic for width in widths]
    cases += [f"{path}=[{a}, {b}]" for path in periodic for a, b in ((1.0, 0.0), (1e9, 1e9 + 1e-6), (-1e-3, 1e-3), ("nan", 1.0))]
    rng.shuffle(cases)
    for case in cases:
        both(bench, scene, [case, "output.frames=1"], stop=1.5)
        yield
