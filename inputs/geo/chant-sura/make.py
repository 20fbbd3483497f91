"""Makes the files of scene.toml: plate.toml, ground.obj and impact1.csv to impact4.csv.

    python3 make.py

Four impacts of a plate of 780 kg that Lu, Caviezel, Christen, Demmel, Ringenbach, Bühler, Dinneen, Gerber and Bartelt measured at Chant Sura (Landslides
16, 2019, 2353-2367, table 2 and figure 8). Places and velocities are those of their table, along the line of the four impacts; the ground runs straight from
impact to impact, since no map of it is printed. Needs Python 3.8 and nothing else.
"""

import math

GRAVITY = 9.81
# Place [m] and velocity [m/s] at the start of each of their simulations, and how long after it the rock meets the ground [s].
STARTS = [
    ((293.57, 191.09, 2307.06), (5.56, -14.62, -11.20), 0.32),
    ((297.18, 181.46, 2299.46), (5.30, -12.70, -10.74), 0.28),
    ((300.21, 173.11, 2292.43), (5.34, -12.31, -10.36), 0.22),
    ((303.71, 163.68, 2286.58), (5.34, -14.19, -8.52), 0.36),
]
# Half of the outer sizes of the plate, radius of its edges, distance of its centre from the ground when it meets it [m].
WIDE, THICK, ROUND, REACH = 0.465, 0.235, 0.03, 0.45
# Plates of an impact side by side, and lanes of the impacts [m].
PHASES, APART, LANE = 24, 3.0, 100.0


def fly(place, velocity, time):
    x, y, z = (p + v * time for p, v in zip(place, velocity))
    return x, y, z - 0.5 * GRAVITY * time * time


hits = [fly(*start) for start in STARTS]
first, last = hits[0], hits[-1]
way = math.hypot(last[0] - first[0], last[1] - first[1])
line = ((last[0] - first[0]) / way, (last[1] - first[1]) / way)


def along(p):
    """Distance along the line of the impacts, and height above the last."""
    return (p[0] - first[0]) * line[0] + (p[1] - first[1]) * line[1], p[2] - last[2]


profile = [along(p) for p in hits]
slopes = [math.atan2(a[1] - b[1], b[0] - a[0]) for a, b in zip(profile, profile[1:])]
local = [slopes[0], *(0.5 * (a + b) for a, b in zip(slopes, slopes[1:])), slopes[-1]]
ground = [(x - REACH * math.sin(t), z - REACH * math.cos(t)) for (x, z), t in zip(profile, local)]
ground.insert(0, (ground[0][0] - 20.0, ground[0][1] + 20.0 * math.tan(slopes[0])))
ground.append((ground[-1][0] + 20.0, ground[-1][1] - 20.0 * math.tan(slopes[-1])))

with open("ground.obj", "w", encoding="utf-8") as out:
    out.write("# Ground through four impacts, by make.py.\n")
    for x, z in ground:
        for y in (-5.0, PHASES * APART + 2.0):
            out.write(f"v {x:.4f} {y:.1f} {z:.4f}\n")
    for k in range(len(ground) - 1):
        a, b, c, d = (2 * k + n for n in (1, 2, 3, 4))
        out.write(f"f {a} {c} {d}\nf {a} {d} {b}\n")

with open("plate.toml", "w", encoding="utf-8") as out:
    out.write("# Shows: Plate of ETAG 027 as used at Chant Sura, 0.93 x 0.93 x 0.47 m.\n")
    out.write("# Sources: Outer sizes: Lu et al. 2019; written by make.py.\n")
    out.write('name = "plate of ETAG 027"\nsource = "outer sizes: Lu and others 2019"\n\n[[stones]]\nname = "plate"\n')
    out.write(f"radius = {ROUND}\ncorners = [\n")
    for axis in range(3):
        for signs in range(8):
            p = [0.5 * WIDE, 0.5 * WIDE, 0.5 * THICK]
            p[axis] = 2.0 * p[axis] - ROUND
            p = [-x if signs >> d & 1 else x for d, x in enumerate(p)]
            out.write("    [" + ", ".join(f"{x:.4f}" for x in p) + "],\n")
    out.write("]\n")

# The plate rolls like a wheel, as measured; where its corners are when it hits is not known: a quarter of a turn in equal steps.
for number, (place, velocity, _) in enumerate(STARTS, 1):
    x, z = along(place)
    with open(f"impact{number}.csv", "w", encoding="utf-8") as out:
        for k in range(PHASES):
            half = 0.25 * math.pi * k / PHASES
            c, s, r = math.cos(half), math.sin(half), math.sqrt(0.5)
            # First the axis of the plate from z to y, then the phase about it.
            turn = (c * r, -c * r, s * r, s * r)
            out.write(f"{x:.4f},{k * APART + (number - 1) * LANE:.1f},{z:.4f}," + ",".join(f"{q:.8f}" for q in turn) + ",1,0\n")
    speed = velocity[0] * line[0] + velocity[1] * line[1]
    aside = velocity[0] * -line[1] + velocity[1] * line[0]
    print(f"impact {number}: velocity [{speed:.3f}, {aside:.3f}, {velocity[2]:.3f}]")
