#!/usr/bin/env python3
"""Random beds at rest on undamped elastic ground: whether kinetic energy grows, and what the interface adds.

    python3 -m venv venv && venv/bin/pip install numpy
    venv/bin/python docs/studies/resting_beds.py PROGRAM [FIRST:]SEEDS [SECONDS]
    venv/bin/python docs/studies/resting_beds.py trackbed 30 5

Each seed draws a box of walls on 20-node hexahedra, stones of 20 to 100 mm, materials, transfer and contact law. All runs have the
predicted scheme, `substeps = "auto"` and no Rayleigh damping. Two run at once. Columns: mean kinetic energy [J] of grains and solid in
the third and the last fifth of the time, the energy gained without work in between [J], and the elastic energy of ground and contacts [J].
A bed grows if its kinetic energy rises by more than 5 % and 1e-10 J and half of that is gained without work.
"""

import concurrent.futures
import csv
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

NU, RHO = (0.0, 0.45), (1500.0, 2500.0)
SCENE = """
walls = [
    {{ kind = "plane", point = [0, 0, 0], normal = [1, 0, 0], material = "v" }},
    {{ kind = "plane", point = [{side}, 0, 0], normal = [-1, 0, 0], material = "v" }},
    {{ kind = "plane", point = [0, 0, 0], normal = [0, 1, 0], material = "v" }},
    {{ kind = "plane", point = [0, {side}, 0], normal = [0, -1, 0], material = "v" }},
]
grains = [{{ name = "g", shape = "sphere", material = "s", count = {count}, size = ["{small} mm", "{large} mm"], seed = {seed}, fill = {{ low = [0, 0, 0], high = [{side}, {side}] }} }}]
deposition = {{ max_time = 1.5, settled_speed = "1 mm/s" }}
time = {{ end = "{seconds} s" }}
coupling = {{ material = "w", substeps = "auto", transfer = {transfer} }}
output = {{ frames = 0, vtk = false, history_interval = "10 ms" }}
[solid.block]
x = {{ lines = [0, {side}], counts = [{n}] }}
y = {{ lines = [0, {side}], counts = [{n}] }}
z = {{ lines = [-{depth}, 0], counts = [2] }}
[[solid.material]]
id = 1
young = {young}
poisson = {poisson}
density = {ground}
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
"""
MATERIAL = """[[material]]
name = "{name}"
{elastic}
friction = {friction}
restitution = {restitution}
tangential_damping_ratio = {ratio}
"""


def draw(seed, attempt, seconds):
    """Scene of a seed, and its values in words; one whose contacts are too stiff for its elements is drawn again."""
    random = np.random.default_rng([seed, attempt])
    log = lambda low, high: float(np.exp(random.uniform(np.log(low), np.log(high))))
    large = log(30, 100)
    small = max(20.0, large * random.uniform(0.4, 0.95))
    count = int(random.integers(10, 121))
    # Between one and three layers.
    side = round(1e-3 * large * np.sqrt(count / random.uniform(0.7, 3)) + 1e-3 * large, 4)
    young, friction = log(5e6, 1e9), float(random.uniform(0, 0.9))
    ratio = float(random.integers(0, 2))
    hertz = random.random() < 0.4
    stiffness, modulus = log(0.5e6, 8e6), log(2e7, 4e8)
    spread = random.random() < 0.5
    transfer = f"{{ spread_factor = {random.uniform(1, 3):.2f} }}" if spread else '"point"'
    values = dict(
        side=side, count=count, small=round(small, 2), large=round(large, 2), seed=seed, seconds=seconds, transfer=transfer,
        n=int(random.integers(2, 4)), depth=round(side * random.uniform(0.3, 1), 4), young=round(young),
        poisson=round(random.uniform(*NU), 3), ground=round(random.uniform(*RHO)),
    )
    restitution = round(float(random.uniform(0.1, 0.7)), 3)
    text = SCENE.format(**values)
    stone = f"young = {modulus:.4g}\npoisson = 0.2" if hertz else f"stiffness = {stiffness:.4g}"
    partner = f"young = {modulus:.4g}\npoisson = 0.2" if hertz else ""
    for name, elastic in (("s", f"density = 2650\n{stone}"), ("w", partner), ("v", partner)):
        text += MATERIAL.format(name=name, elastic=elastic, friction=round(friction, 3), restitution=restitution, ratio=ratio)
    law = f"E {modulus / 1e6:4.0f} MPa" if hertz else f"K {stiffness / 1e6:4.1f} MN/m"
    words = (
        f"{count:3d} of {small:3.0f}-{large:3.0f} mm, {law}, mu {friction:4.2f}, beta {ratio:.0f}, "
        f"{'spread' if spread else 'point '}, {young / 1e6:4.0f} MPa"
    )
    return text, words


def run(program, seed, seconds):
    """The row of a seed, and whether kinetic energy grew."""
    for attempt in range(10):
        row, grown, code = run_once(program, *draw(seed, attempt, seconds))
        if code != 2:
            break
    return f"{seed:4d} {row}", grown


def run_once(program, text, words):
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w") as file:
            file.write(text)
        out = os.path.join(folder, "out")
        done = subprocess.run([program, "run", scene, "--out", out, "--threads", "1"], capture_output=True, text=True)
        if not os.path.exists(os.path.join(out, "history.csv")):
            return f"{words} | code {done.returncode}: {done.stderr.strip()[-200:]}", None, done.returncode
        with open(os.path.join(out, "history.csv")) as file:
            rows = list(csv.DictReader(file))
        with open(os.path.join(out, "summary.json")) as file:
            coupling = json.load(file)["coupling"]
    value = lambda key: np.array([float(row[key + " [J]"]) for row in rows])
    kinetic = value("grains_kinetic") + value("solid_kinetic")
    part = len(kinetic) // 5
    third, last = kinetic[2 * part : 3 * part].mean(), kinetic[-part:].mean()
    error = value("energy_error")
    gain = error[-part:].mean() - error[2 * part : 3 * part].mean()
    held = value("solid_strain")[-1] + value("contact_springs")[-1]
    numbers = coupling["interface"]
    # Kinetic energy also comes and goes with the potential one; growth is the part without work.
    risen = last - third
    grown = bool(done.returncode != 0 or (risen > 0.05 * third and risen > 1e-10 and gain > 0.5 * risen))
    row = (
        f"{words} | code {done.returncode} W {numbers['stiffness']:4.2f} D {numbers['damping']:4.2f} phase {numbers['phase']:4.2f} "
        f"parts {coupling['division']:2d} theta {coupling['theta']:6.4f} | {third:7.1e} {last:7.1e} gain {gain:8.1e} of {held:7.1e}"
        f"{'  GROWS' if grown else ''}"
    )
    return row, grown, done.returncode


def main():
    program, seeds = sys.argv[1], sys.argv[2].split(":")
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 5.0
    first = int(seeds[0]) if len(seeds) > 1 else 1
    last = int(seeds[-1])
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = []
        for row, grown in pool.map(lambda seed: run(program, seed, seconds), range(first, last + 1)):
            print(row, flush=True)
            results.append(grown)
    ran = [g for g in results if g is not None]
    print(f"{len(ran)} of {len(results)} beds ran, {sum(ran)} grow or stop")


if __name__ == "__main__":
    main()
