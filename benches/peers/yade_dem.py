"""Impacts and bulk processes in YADE (Debian package `yade`): Hertz-Mindlin.

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


def facets(wall, material):
    """Wall of triangles: cylinder, or cone without height (a flat ring)."""
    from yade import geom, utils

    count, base = 64, Vector3(wall["base"])
    # Mean radius of the polygon as of the circle.
    mean = math.sqrt(2 * math.pi / count / math.sin(2 * math.pi / count))
    if wall["kind"] == "cylinder":
        axis = Vector3(wall.get("axis", [0, 0, 1]))
        turn = Quaternion()
        turn.setFromTwoVectors(Vector3(0, 0, 1), axis)
        mask = 7 if wall.get("caps") == [True, True] else 4
        return geom.facetCylinder(base + 0.5 * wall["height"] * axis, wall["radius"] * mean, wall["height"], turn, count, mask, material=material)
    inner, outer = (
        [base + Vector3(mean * r * math.cos(2 * math.pi * k / count), mean * r * math.sin(2 * math.pi * k / count), 0) for k in range(count + 1)]
        for r in wall["radii"]
    )
    quads = zip(inner, outer, outer[1:], inner[1:])
    return [utils.facet(corners, material=material) for a, b, c, d in quads for corners in ((a, b, c), (a, c, d))]


def bulk(row):
    from yade import utils

    case = common.bulk(row)
    O.reset()
    numbers = []
    for m in case["materials"]:
        young = m.get("young", 1e6 * case["materials"][0]["young"])
        poisson = m.get("poisson", 0.2)
        numbers.append(O.materials.append(FrictMat(young=young, poisson=poisson, density=m.get("density", 1.0), frictionAngle=math.atan(m["friction"]))))
    matches = lambda value: MatchMaker(matches=tuple((numbers[a - 1], numbers[b - 1], value(law)) for (a, b), law in case["laws"].items()))
    law = Ip2_FrictMat_FrictMat_MindlinPhys(frictAngle=matches(lambda l: math.atan(l["friction"])), en=matches(lambda l: l["restitution"]))
    for place, radius, _, velocity, kind in case["bodies"]:
        body = utils.sphere(place, radius, material=numbers[kind - 1])
        body.state.vel = velocity
        O.bodies.append(body)
    engines = []
    for wall in case["walls"]:
        if wall["kind"] == "plane":
            axis = next(d for d in range(3) if wall["normal"][d] != 0)
            O.bodies.append(utils.wall(wall["point"][axis], axis, sense=int(wall["normal"][axis]), material=numbers[-1]))
            continue
        ids = O.bodies.append(facets(wall, numbers[-1]))
        if "angular_velocity" in wall:
            spin = Vector3(wall["angular_velocity"])
            engines.append(RotationEngine(rotateAroundZero=True, zeroPoint=wall["base"], rotationAxis=spin.normalized(), angularVelocity=spin.norm(), ids=ids))
    smallest = min(b[1] for b in case["bodies"])
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()], verletDist=0.2 * smallest),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(hertzian=True), Ig2_Facet_Sphere_ScGeom(hertzian=True)],
            [law],
            [Law2_ScGeom_MindlinPhys_Mindlin(preventGranularRatcheting=False)],
        ),
        *engines,
        NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
    ]
    O.dt = case["step"]
    places = lambda: [tuple(O.bodies[k].state.pos) for k in range(len(case["bodies"]))]
    count, frames = 200, [(0.0, places())]
    for _ in range(count):
        O.run(case["steps"] // count, True)
        frames.append((O.time, places()))
    return common.bulk_value(row, case, frames)


def compute(row):
    return bulk(row) if row["group"] == "bulk" else impact(row)


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
