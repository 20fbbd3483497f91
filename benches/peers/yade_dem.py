"""Impacts and a bonded beam in YADE (Debian package `yade`): Hertz-Mindlin, cohesive contacts with moments.

Started by python3, the script starts itself in YADE.
"""

import os, shutil, subprocess, sys

import common


def impact(row):
    from yade import utils

    case = common.impact(row)
    O.reset()
    # The law takes its moduli from `young`; the stiffnesses of the case are set in each step, as for planes they would be mixed otherwise.
    rigid = FrictMat(young=1e6 * case["young"], poisson=case["poisson"], density=1.0, frictionAngle=math.atan(case["friction"]))
    for body in case["bodies"]:
        material = FrictMat(young=case["young"], poisson=case["poisson"], density=body["density"], frictionAngle=math.atan(case["friction"]))
        number = O.bodies.append(utils.sphere(body["place"], body["radius"], material=material))
        state = O.bodies[number].state
        state.vel, state.angVel = body["velocity"], body["spin"]
    if case["plane"]:
        O.bodies.append(utils.wall(0, 2, material=rigid))
    radius = 1 / sum(1 / body["radius"] for body in case["bodies"])
    constants = (case["normal"] * math.sqrt(radius), case["tangential"] * math.sqrt(radius))
    law = Ip2_FrictMat_FrictMat_MindlinPhys(en=case["restitution"], es=1.0) if case["restitution"] < 1 else Ip2_FrictMat_FrictMat_MindlinPhys()
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [law], [Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False)]),
        NewtonIntegrator(gravity=(0, 0, case["gravity"]), damping=0),
    ]
    O.dt = case["step"]
    records, first = [], O.bodies[0].state
    for k in range(case["steps"] + 1):
        force = O.forces.f(0) if k else (0, 0, 0)
        records.append((k * O.dt, tuple(first.pos), tuple(first.vel), tuple(first.angVel), tuple(force)))
        O.step()
        for contact in O.interactions:
            contact.phys.kno, contact.phys.kso = constants
    return common.taken(row, common.history(case, records))


def beam(row):
    """Bonds of the scene as cohesive contacts with the stiffnesses of a beam of length 2 cm."""
    from yade import utils

    tables = common.scene(row)
    bond = tables["bond"][0]["parallel"]
    O.reset()
    radius, density = tables["grains"][0]["spheres"][0][3], tables["material"][0]["density"]
    for group in tables["grains"]:
        for *place, r in group["spheres"]:
            O.bodies.append(utils.sphere(place, r, fixed=group["name"] == "wall"))
    area, length = math.pi * radius**2, 2 * radius
    inertia = math.pi * radius**4 / 4
    for body in O.bodies:
        body.state.mass = density * 4 / 3 * math.pi * radius**3
        body.state.inertia = (Vector3.Ones) * 0.4 * body.state.mass * radius**2
    normal, shear = bond["young"] * area / length, bond["young"] * area / length / bond["stiffness_ratio"]
    bending, twist = bond["young"] * inertia / length, 2 * bond["young"] * inertia / length / bond["stiffness_ratio"]
    material = CohFrictMat(isCohesive=True, momentRotationLaw=True, normalCohesion=1e12, shearCohesion=1e12, young=1e9, poisson=0.4, etaRoll=-1, etaTwist=-1)
    O.materials.append(material)
    for body in O.bodies:
        body.material = material
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()]),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True, setCohesionOnNewContacts=True)],
                        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()]),
        NewtonIntegrator(gravity=tables["gravity"], damping=0.2),
    ]
    O.dt = 0.0
    O.step()
    for contact in O.interactions:
        contact.phys.kn, contact.phys.ks, contact.phys.kr, contact.phys.ktw = normal, shear, bending, twist
    O.dt = 0.2 * math.sqrt(O.bodies[0].state.mass / normal)
    tip = O.bodies[len(O.bodies) - 1].state
    start = tip.pos[2]
    records = {"time": [], "tip_z": []}
    for _ in range(4000):
        O.run(50, True)
        records["time"].append(O.time)
        records["tip_z"].append(tip.pos[2] - start)
    # At rest by local damping.
    return records["tip_z"][-1] * row["quantity"]["factor"]


def compute(row):
    return beam(row) if row["group"] == "bonds" else impact(row)


if "O" in globals():
    import math

    from yade import config

    common.print_values(config.version, compute)
    sys.stdout.flush()
    os._exit(0)
elif shutil.which("yade") is None:
    common.missing("found no program yade")
else:
    # The script has no path of its own in YADE.
    environment = {**os.environ, "PYTHONPATH": os.path.dirname(os.path.abspath(__file__))}
    words = ["yade", "-n", "-x", "-j1", os.path.abspath(__file__), *sys.argv[1:]]
    done = subprocess.run(words, capture_output=True, text=True, env=environment)
    last = [line for line in done.stdout.splitlines() if line.startswith("{")]
    print(last[-1] if last else '{"missing": "yade ended without values"}')
    sys.stderr.write("" if last else done.stderr[-2000:])
