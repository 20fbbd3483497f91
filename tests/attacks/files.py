"""Attacks by randomly changed meshes and surfaces."""

import re

from .verdict import ROOT

NUMBERS = [b"0", b"-1", b"1", b"7", b"4294967295", b"4294967296", b"99999999999999999999", b"1e400", b"-1e308", b"nan", b"inf", b"1e-320", b"x", b""]


def damaged(rng, content):
    """Up to five changes of the bytes."""
    content = bytearray(content)
    for _ in range(1 + rng.randrange(5)):
        at = rng.randrange(len(content) + 1)
        kind = rng.randrange(7)
        if kind == 0 and content:
            content[min(at, len(content) - 1)] = rng.randrange(256)
        elif kind == 1:
            del content[at:]
        elif kind == 2:
            del content[at : at + rng.randrange(1, 200)]
        elif kind == 3:
            content[at:at] = content[at : at + rng.randrange(1, 400)]
        elif kind == 4:
            content[at:at] = rng.randbytes(rng.randrange(1, 16))
        elif found := re.compile(rb"[-+]?\d[\d.eE+-]*").search(content, at):
            content[found.start() : found.end()] = rng.choice(NUMBERS)
    return bytes(content)


def meshes(bench, rng):
    """`mesh info`, `mesh check`, `mesh convert`."""
    good = sorted(p for p in (ROOT / "tests/data/mesh").iterdir() if p.suffix in (".msh", ".vtu", ".vtk"))
    for ending in ("cdb", "inp", "msh"):
        made = bench.work / f"good.{ending}"
        bench.attempt("mesh", "convert", good[0], made, "--force", codes={0})
        good.append(made)
    while True:
        source = rng.choice(good)
        file, out = bench.work / f"bad{source.suffix}", bench.work / "converted.vtu"
        file.write_bytes(damaged(rng, source.read_bytes()))
        out.write_text("kept")
        for words in (["info", file], ["check", file]):
            bench.attempt("mesh", *words, untouched=[file, out], codes={0, 2}, faults=20, env={"RAYON_NUM_THREADS": "2"})
        bench.attempt("mesh", "convert", file, out, "--force", untouched=[file], codes={0, 2}, faults=20, out=out)
        yield


def surfaces(bench, rng):
    """`stone info`."""
    good = [ROOT / "tests/data/surface/stone.stl", ROOT / "inputs/data/hull.obj"]
    good += [ROOT / f"inputs/data/{name}.toml" for name in ("clumps", "polyhedra", "ballast_stones")]
    while True:
        source = rng.choice(good)
        file = bench.work / f"bad{source.suffix}"
        file.write_bytes(damaged(rng, source.read_bytes()))
        bench.attempt("stone", "info", file, untouched=[file], codes={0, 2}, faults=20)
        yield
