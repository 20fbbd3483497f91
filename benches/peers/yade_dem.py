"""Impacts in YADE (Debian package `yade`): Hertz-Mindlin.

Started by python3, the script starts itself in YADE.
"""

import os, shutil, subprocess, sys

import common


def impact(row):
    from yade import utils

    case = common.impact(row)
    O.reset()
    # Stiffnesses are set in each step; the law would mix those of a plane.
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
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [law], [Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False)]
        ),
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


if "O" in globals():
    import math

    from yade import config

    common.print_values(config.version, impact)
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
