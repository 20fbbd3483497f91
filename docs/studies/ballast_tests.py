"""Figures of the ballast tests from their folders of results, one line each, and the mean and spread of the main ones.

    python3 docs/studies/ballast_tests.py box|shear|triaxial|cyclic|blind|oedometer|push|crushing FOLDER...

FOLDER holds what `trackbed run` left: cycles.csv, history.csv, push.csv, summary.json. Needs Python 3 and nothing else.
"""

import csv
import json
import math
import os
import re
import sys


def table(folder, name):
    """Columns of a table by their names without units; folders that have none are skipped by the caller."""
    with open(os.path.join(folder, name)) as file:
        rows = list(csv.DictReader(file))
    return {key.split(" [")[0]: [float(row[key]) for row in rows] for key in rows[0]}


def mean(values):
    return sum(values) / len(values)


def smooth(times, values, half):
    """Mean over the rows within `half` seconds."""
    n = max(1, round(half / (times[1] - times[0])))
    return [mean(values[max(0, i - n) : i + n + 1]) for i in range(len(values))]


def slope(x, y):
    mx, my = mean(x), mean(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def degrees(value):
    return math.degrees(math.atan(value))


def box(folder):
    """Settlement, its exponent in each decade of cycles, and means over the second half of the cycles. Bed 0.24 m, plate 0.78 m x 0.29 m, 5 Hz."""
    c = table(folder, "cycles.csv")
    with open(os.path.join(folder, "summary.json")) as file:
        summary = json.load(file)
    s, n = [1e3 * v for v in c["settlement"]], len(c["settlement"])
    last = range(n // 2, n)
    d = mean([1e3 * c["resilient_deflection"][i] for i in last])
    decades = [range(a, min(n, 10 * a) + 1) for a in (10, 100) if n > a]
    return {
        "settlement 1, 10, 100, 1000 [mm]": [s[i - 1] for i in (1, 10, 100, 1000) if i <= n],
        "exponent from 10, 100 on": [slope([math.log(i) for i in d], [math.log(s[i - 1]) for i in d]) for d in decades],
        "resilient deflection [mm]": d,
        "secant modulus [MPa]": mean([c["resilient_modulus"][i] / 1e6 for i in last]),
        "modulus of the loading branch [MPa]": mean([c["bed_stiffness"][i] for i in last]) * 0.24 / (0.78 * 0.29) / 1e6,
        "acceleration [g]": (2 * math.pi * 5) ** 2 * d / 2e3 / 9.81,
        "porosity, settled and bedded": [summary["compaction"][0]["porosity_before"], summary["compaction"][0]["porosity_after"]],
    }


def shear(folder):
    """Peak of shear over normal stress, means over 40 ms, once the plate presses with four fifths of its mean."""
    h, area = table(folder, "history.csv"), 0.64 * 0.22
    t = h["time"]
    force = [(lo + fl - up - pl) / 2 for lo, fl, up, pl in
             zip(h["lower_force_x"], h["floor_force_x"], h["upper_force_x"], h["plate_force_x"])]
    tau, sigma = smooth(t, [v / area / 1e3 for v in force], 0.02), smooth(t, [v / area / 1e3 for v in h["plate_force_z"]], 0.02)
    way, rise = [-1e3 * v for v in h["lower_displacement_x"]], [1e3 * v for v in h["plate_displacement_z"]]
    late = [i for i in range(len(t)) if way[i] > 20]
    normal = mean([sigma[i] for i in late])
    firm = [i for i in range(len(t)) if sigma[i] > 0.8 * normal]
    peak = max(firm, key=lambda i: tau[i] / sigma[i])
    end = [i for i in range(len(t)) if way[i] > 30]
    return {
        "peak angle [deg]": degrees(tau[peak] / sigma[peak]),
        "at [mm]": way[peak] - way[firm[0]],
        "shear, normal stress [kPa]": [tau[peak], sigma[peak]],
        "angle of the last 10 mm [deg]": degrees(mean([tau[i] for i in end]) / mean([sigma[i] for i in end])),
        "rise [mm]": rise[-1] - min(rise),
    }


def side(h, name, column, combine):
    """Column of a side: of a plane, or of its strips name1, name2, ... combined row by row."""
    if f"{name}_{column}" in h:
        return h[f"{name}_{column}"]
    strips = [h[k] for k in h if re.fullmatch(rf"{name}\d+_{column}", k)]
    return [combine(row) for row in zip(*strips)]


def triaxial(folder):
    """Peak angle against the cell pressure at it, means over 20 ms; volume strain, dilation negative. Cube of 0.3 m, shear from 0.15 s on.

    Sides are planes or strips of equal height.
    """
    h = table(folder, "history.csv")
    t = h["time"]
    forces = h["top_force_z"], side(h, "side_x", "force_x", sum), side(h, "side_y", "force_y", sum)
    ways = side(h, "side_x", "displacement_x", mean), side(h, "side_y", "displacement_y", mean), h["top_displacement_z"]
    top, x, y = (smooth(t, values, 0.01) for values in forces)
    a, b, c = ([0.3 + v for v in values] for values in ways)
    start = next(i for i in range(len(t)) if t[i] >= 0.15)
    axial = [abs(top[i]) / (a[i] * b[i]) / 1e3 for i in range(len(t))]
    cell = [(abs(x[i]) / (b[i] * c[i]) + abs(y[i]) / (a[i] * c[i])) / 2e3 for i in range(len(t))]
    angle = [math.degrees(math.asin((p - q) / (p + q))) if p + q > 0 else 0.0 for p, q in zip(axial, cell)]
    strain = [100 * (c[start] - v) / c[start] for v in c]
    volume = [100 * (1 - a[i] * b[i] * c[i] / (a[start] * b[start] * c[start])) for i in range(len(t))]
    peak = max((i for i in range(start, len(t)) if strain[i] > 0.2), key=lambda i: angle[i])
    def near(value, half):
        return [i for i in range(start, len(t)) if abs(strain[i] - value) <= half]

    def dilation(span):
        return -slope([strain[i] for i in span], [volume[i] for i in span]) if len(span) > 2 else None

    late = near(strain[-1], 0.2 * strain[-1])
    at_five = near(5.0, 0.05)
    result = {
        "peak angle [deg]": angle[peak],
        "at strain [%]": strain[peak],
        "cell, axial stress [kPa]": [cell[peak], axial[peak]],
        "cell pressure of all the shear [kPa]": mean(cell[start:]),
        "rate of dilation at the peak": dilation(near(strain[peak], 0.5)),
        "angle of the last fifth [deg]": mean([angle[i] for i in late]),
        "volume strain at the end [%]": volume[-1],
        "rate of dilation in the last fifth": dilation(late),
    }
    if at_five:
        result["volume strain at 5 % [%]"] = mean([volume[i] for i in at_five])
    if strain[-1] > 10.5:
        result["rate of dilation at 10 %"] = dilation(near(10.0, 0.5))
    return result


def cyclic(folder):
    """Permanent axial strain, unloading strain, resilient modulus and volume strain (dilation negative) against the number of pulses.

    Cube of 0.48 m; pulses at 5 Hz from 0.2 s on, or at the frequency that an override names.
    """
    with open(os.path.join(folder, "summary.json")) as file:
        text = " ".join(json.load(file)["overrides"])
    changed = re.search(r'frequency *= *"?([0-9.]+)', text)
    frequency, start = float(changed[1]) if changed else 5.0, 0.2
    h, side = table(folder, "history.csv"), 0.48
    t, z = h["time"], h["top_displacement_z"]
    x, y, force = h["side_x_displacement_x"], h["side_y_displacement_y"], h["top_force_z"]
    at = lambda time: min(range(len(t)), key=lambda i: abs(t[i] - time))
    first, rows = at(start - 0.005), {}
    height = side + z[first]
    volume = lambda i: (side + x[i]) * (side + y[i]) * (side + z[i])
    for n in range(1, round((t[-1] - start) * frequency + 1e-6) + 1):
        low, peak = at(start + n / frequency), at(start + (n - 0.5) / frequency)
        strain = 100 * (z[low] - z[peak]) / height
        stress = (abs(force[peak]) - abs(force[low])) / side**2 / 1e3
        rows[n] = [100 * (z[first] - z[low]) / height, strain, stress / strain / 10 if strain else 0.0, 100 * (1 - volume(low) / volume(first))]
    shown = [n for n in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if n in rows]
    result = {f"N = {n}: strain, unloading strain [%], modulus [MPa], volume [%]": rows[n] for n in shown}
    if 100 in rows:
        d = range(10, 101)
        result["exponent from 10 to 100"] = slope([math.log(i) for i in d], [math.log(max(rows[i][0], 1e-9)) for i in d])
    return result


def blind(folders):
    """Predictions in the form of inputs/ballast/blind/predictions.csv, by the name of the test in the names of the folders."""
    tests = {}
    for folder in folders:
        name = re.search(r"p(\d+)_q(\d+)_(\d+)Hz", os.path.basename(os.path.normpath(folder)))
        tests.setdefault(name[0], (name.groups(), []))[1].append(cyclic(folder))
    print("test,pressure [kPa],deviator [kPa],frequency [Hz],N,strain,value [%],low [%],high [%]")
    for name, (numbers, found) in tests.items():
        for strain, column in ("axial", 0), ("volumetric", 3):
            for n in 1, 10, 50, 100:
                values = [rows[column] for rows in ([v for k, v in f.items() if k.startswith(f"N = {n}:")][0] for f in found)]
                cells = ",".join(f"{v:.3f}" for v in (mean(values), min(values), max(values)))
                print(f"{name},{','.join(numbers)},{n},{strain},{cells}")


def oedometer(folder):
    """Constrained moduli between pressures on the way up and up again. Height 0.29 m less what the plate has come."""
    h = table(folder, "history.csv")
    t, p = h["time"], [v / 0.09 / 1e3 for v in smooth(h["time"], h["plate_force_z"], 0.003)]
    z = smooth(t, h["plate_displacement_z"], 0.003)
    top = max((i for i in range(len(t)) if t[i] < 0.8), key=lambda i: p[i])
    low = min((i for i in range(top, len(t)) if t[i] < 0.95), key=lambda i: p[i])

    def modulus(span, first, second):
        i = min(span, key=lambda k: abs(p[k] - first))
        j = min(span, key=lambda k: abs(p[k] - second))
        return (p[j] - p[i]) / ((z[i] - z[j]) / (0.29 + z[i])) / 1e3

    up, again = range(top + 1), range(low, len(t))
    up = range(max(i for i in up if p[i] < 25), top + 1)
    return {
        "modulus 50 to 100 kPa [MPa]": modulus(up, 50, 100),
        "100 to 200": modulus(up, 100, 200),
        "200 to 400": modulus(up, 200, 390),
        "up again, 100 to 390": modulus(again, 100, 390),
        "side over plate at the top": abs(smooth(t, h["side_force_x"], 0.003)[top]) / 0.09 / 1e3 / p[top],
    }


def push(folder):
    """Force on the half sleeper at some ways, means over 0.3 mm."""
    c = table(folder, "push.csv")
    way, force = [1e3 * v for v in c["displacement"]], [v / 1e3 for v in c["force"]]
    return {
        f"{mm} mm [kN]": mean([f for w, f in zip(way, force) if abs(w - mm) < 0.15]) for mm in (0.5, 1, 2, 3, 4, 4.8)
    }


def crushing(folder):
    """Crushing force: the largest before the force falls to half of it with a tenth of the bonds broken. Nominal strength F/d2 by the sieve size and
    by the distance of the platens at that moment; the upper platen starts where the scene or an override puts it."""
    with open(os.path.join(folder, "summary.json")) as file:
        text = " ".join(json.load(file)["overrides"])
    size, top = re.search(r"size=\[([0-9.e-]+)", text), re.search(r"walls\.(?:upper|1)\.point=\[0, 0, ([0-9.e-]+)", text)
    size, top = float(size[1]) if size else 0.045, float(top[1]) if top else 0.07
    h = table(folder, "history.csv")
    force, bonds = h["upper_force_z"], h["bonds"]
    peak = 0
    for i in range(len(force)):
        if force[i] > force[peak]:
            peak = i
        elif force[i] < 0.5 * force[peak] and bonds[i] < 0.9 * bonds[0]:
            break  # what comes after is its rubble
    force, gap = force[peak], top + h["upper_displacement_z"][peak]
    return {"sieve size [mm]": 1e3 * size, "force [kN]": force / 1e3, "F/d2 [MPa]": force / size**2 / 1e6, "by the platens [MPa]": force / gap**2 / 1e6}


def weibull(strengths):
    """Modulus and scale of Weibull's law, by least squares of ln ln 1/P on ln of the strength; P = 1 - i/(n + 1) survive the i-th."""
    ranked = sorted(strengths)
    x = [math.log(v) for v in ranked]
    y = [math.log(-math.log(1 - (i + 1) / (len(ranked) + 1))) for i in range(len(ranked))]
    modulus = slope(x, y)
    fit = slope(x, y) * slope(y, x)
    return [modulus, math.exp(mean(x) - mean(y) / modulus), fit]


def crushing_sizes(found):
    """Of each size: force, strengths, and Weibull's modulus, scale and R2; then how the scale falls with the size."""
    sizes = sorted({f["sieve size [mm]"] for f in found})
    scales = {}
    for key in ("F/d2 [MPa]", "by the platens [MPa]"):
        for d in sizes:
            own = [f for f in found if f["sieve size [mm]"] == d]
            forces, strengths = [f["force [kN]"] for f in own], [f[key] for f in own]
            modulus, scale, fit = weibull(strengths)
            scales[key, d] = scale
            print(f"  {d:g} mm, {len(own)} stones, {key}: force {mean(forces):.3g} kN ({min(forces):.3g} to {max(forces):.3g}), strength mean {mean(strengths):.3g}, "
                  f"Weibull modulus {modulus:.2f}, scale {scale:.3g} MPa, R2 {fit:.3f}")
        if len(sizes) > 1:
            print(f"  {key}: scale grows as d^{slope([math.log(d) for d in sizes], [math.log(scales[key, d]) for d in sizes]):.2f}")


def written(value):
    return ", ".join(f"{v:.3g}" for v in value) if isinstance(value, list) else f"{value:.3g}"


def main():
    test, folders = globals()[sys.argv[1]], [f for f in sys.argv[2:] if os.path.isdir(f)]
    if test is blind:
        return blind(folders)
    found = []
    for folder in folders:
        found.append(test(folder))
        print(os.path.basename(os.path.normpath(folder)) + ": " + "; ".join(f"{k} {written(v)}" for k, v in found[-1].items()))
    if test is crushing and len(found) > 2:
        return crushing_sizes(found)
    for key in found[0] if len(found) > 1 else []:
        columns = zip(*(f[key] if isinstance(f[key], list) else [f[key]] for f in found))
        print(f"  {key}: " + "; ".join(f"mean {mean(v):.3g}, {min(v):.3g} to {max(v):.3g}" for v in columns))


main()
