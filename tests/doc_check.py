"""Checks the pages and the heads of inputs/: python3 tests/doc_check.py [PROGRAM]

Relative links and anchors must exist; at most WORDS words, README_WORDS in README outside tables and code.
Each TOML file of inputs/ begins with a comment that states purpose, time and sources (see `head`); docs/scenes.md lists each scene.
With PROGRAM, `trackbed check` must accept the examples of docs/scene.md, assembled into scenes.
"""
import os, re, shutil, subprocess, sys, tempfile, tomllib

WORDS = 50_000
README_WORDS = 600
HEAD_LINES = 5
LABELS = ["Shows", "Time", "Sources", "Use"]
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def lines(page):
    """Numbered lines outside code blocks."""
    code = False
    for number, line in enumerate(open(page, encoding="utf-8"), 1):
        if line.startswith("```"):
            code = not code
        elif not code:
            yield number, line


def anchors(page):
    found = {}
    for _, line in lines(page):
        if heading := re.match(r"#+ (.*)", line):
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1].strip()).lower()
            slug = "".join(c for c in text if c.isalnum() or c in " -_").replace(" ", "-")
            found[slug] = found.get(slug, 0) + 1
    return {s if k == 0 else f"{s}-{k}" for s, n in found.items() for k in range(n)}


def words(text):
    return sum(1 for word in text.split() if re.search("[A-Za-z0-9]", word))


def too_long():
    """Errors of page length."""
    text = {name: open(os.path.join(ROOT, name), encoding="utf-8").read() for name in pages()}
    prose = [line for _, line in lines(os.path.join(ROOT, "README.md")) if not line.startswith("|")]
    for name, found, most in [("pages", sum(map(words, text.values())), WORDS), ("README.md", words("".join(prose)), README_WORDS)]:
        if found > most:
            yield f"{name}: found {found} words, expected at most {most}"


def pages():
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in names.stdout.split() if os.path.exists(os.path.join(ROOT, name))]


def links():
    for name in pages():
        page = os.path.join(ROOT, name)
        for number, line in lines(page):
            for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
                path, _, anchor = target.partition("#")
                if re.match(r"https?:", target):
                    continue
                file = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                if not os.path.exists(file):
                    yield f"{name}:{number}: {target}: no such file"
                elif anchor and file.endswith(".md") and anchor not in anchors(file):
                    yield f"{name}:{number}: {target}: no such heading"


def scenes(page):
    """Scenes assembled from examples, by name, and all examples."""
    blocks = {}
    for part in re.split(r"\n(?=#{2,3} )", page):
        blocks[part.split("\n")[0].split(":")[0].lstrip("# ")] = re.findall(r"```toml\n(.*?)```", part, re.S)
    e = lambda heading, k=0: blocks[heading][k] + "\n"
    top, supports, walls = e("Top level"), e("`[[solid.support]]`").split("[[solid.support]]"), e("`[[walls]]`")
    base, footing = ("[[solid.support]]" + s for s in supports[1:])
    plastic = e("`[solid.block]`") + e("`[[solid.material]]`")
    elastic = re.sub(r"(model|cohesion|friction|dilation) = .*\n", "", plastic)
    solid = 'young = "100 MPa"\npoisson = 0.3\ndensity = 2000\n'
    lists = '[solid]\nnodes = "NODECOORD.DAT"\nelements = "ELEMENTNUM.DAT"\nconstraints = "DOF.DAT"\n'
    lists += "".join(f"[[solid.material]]\nid = {k}\n{solid}" for k in (1, 2))
    contacts = e("`[[material]]`") + e("`[[contact]]`")
    spheres = '[[grains]]\nname = "a"\nshape = "sphere"\nmaterial = "stone"\nspheres = [[0.1, 0.1, 0.05, 0.01], [0.119, 0.1, 0.05, 0.01]]\n'
    group = '[[grains]]\nname = "a"\nshape = "sphere"\nmaterial = "stone"\n'
    box = "region = { box = [[0.0, 0.0, 0.0], [2.0, 2.0, 2.0]] }\n"
    size, count, end = 'size = ["90 mm", "110 mm"]\n', "count = 100\n", '[time]\nend = "0.01 s"\n'
    plane = 'kind = "plane"\npoint = [0.0, 0.0, -0.2]\nnormal = [0.0, 0.0, 1.0]\nmaterial = "steel"\n'
    tetrahedron = 'kind = "triangles"\nmaterial = "stone"\nvertices = [[0, 0, 1], [1, 0, 1], [0, 1, 1], [0, 0, 2]]\n'
    tetrahedron += "triangles = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]\n"
    others = "".join(f'[[material]]\nname = "{n}"\ndensity = 2500\nstiffness = 1e7\nfriction = 0.5\nrestitution = 0.3\n' for n in ("concrete", "formation"))
    stones = e("`[[grains]]`").replace("[0.0, 0.0, 0.0], high = [0.5, 0.5]", "[-1.4, 0.0, 0.0], high = [1.4, 0.6]").replace('"A" }', '"A", scale = 2.2 }')
    bed = top + lists + others + contacts + stones + e("`[deposition]`") + e("`[coupling]`") + e("`[track.sleeper]`")
    bogie = '[track.load]\nkind = "bogie"\naxle_load = 14e4\nwheelbase = 2.5\nspeed = 50.0\nseats = [[-0.75, 0.0], [0.75, 0.0]]\n'
    history = re.sub("history = .*", lambda _: e("`[[solid.load]]`", 1).strip(), e("`[[solid.load]]`"))
    servo = re.sub("servo = .*", lambda _: e("`[[walls]]`", 1).strip(), walls)
    floor = walls.split('[[walls]]\nname = "drum"')[0]
    platen = '[[walls]]\nkind = "plane"\nmaterial = "steel"\nrecord = true\n'
    platens = platen + 'name = "bottom"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n'
    platens += platen + 'name = "top"\npoint = [0, 0, 0.1]\nnormal = [0, 0, -1]\n'
    grains = lambda text: top + contacts + text + end
    made = {
        "quasi_static": top + plastic + base + footing + e("`[solid.initial_stress]`") + e("`[solid.quasi_static]`") + e("`[solid.newton]`") + e("`[output]`") + e("`[[probe]]`"),
        "dynamics": top + elastic + base + e("`[[solid.absorbing]]`") + e("`solid.rayleigh`") + e("`[solid.dynamics]`") + e("`[solid.equations]`") + e("`[[solid.load]]`"),
        "history": top + elastic + base + e("`[solid.dynamics]`") + history,
        "strength_reduction": top + plastic + base + e("`[solid.strength_reduction]`"),
        "mesh": e("`[solid]`") + "[[solid.material]]\nid = 1\n" + solid + base,
        "layout": lists + e("`[solid.layout]`"),
        "bed": top + contacts + e("`[[grains]]`") + floor + e("`[deposition]`") + e("`[[compaction]]`") + e("`[[measure]]`") + e("`[time]`"),
        "walls": grains(spheres + walls),
        "servo": grains(spheres + servo),
        "body": grains(spheres + "[[walls]]\n" + tetrahedron + e("`[[walls]]`", 2) + "[[walls]]\n" + plane),
        "mount": grains(spheres + '[[walls]]\nkind = "cylinder"\nmaterial = "steel"\nbase = [25, 25, -3]\nheight = 6\nradius = 2\n' + e("`[[walls]]`", 3)),
        "scarring": grains(group.replace("sphere", "polyhedron") + e("`[[grains]]`", 3) + '[[walls]]\nkind = "triangles"\nmaterial = "steel"\nvertices = [[0, 0, -3], [50, 0, -3], [0, 50, -3]]\ntriangles = [[0, 1, 2]]\n' + e("`[[walls]]`", 4)),
        "structure": grains(spheres + '[[walls]]\nkind = "cylinder"\nname = "pile"\nmaterial = "steel"\nbase = [25, 25, -3]\nheight = 6\nradius = 2\n' + e("`[[structure]]`") + e("`[[structure]]`", 1)),
        "flow": grains(e("`[[outlet]]` and `inlet`") + "[[walls]]\n" + plane),
        "bond": grains(spheres + e("`[[bond]]`") + floor + e("`[events]`")),
        "slide": grains(spheres + floor + e("`[runout]`")),
        "specimen": grains(spheres + platens + e("`[specimen]`")),
        "contact_point": grains(spheres + '[[bond]]\nname = "b"\ngap = 1e-4\n' + e("`[[bond]]`", 1)),
        "direct": grains(spheres + '[[bond]]\nname = "b"\ngap = 1e-4\n' + e("`[[bond]]`", 2)),
        "face": grains(group.replace("sphere", "polyhedron") + e("`[[grains]]`", 3) + 'bond = "b"\n[[bond]]\nname = "b"\n' + e("`[[bond]]`", 3)),
        "contact_law": top + e("`[contact_law]`") + '[[material]]\nname = "glass"\ndensity = 2500\nyoung = "1 GPa"\npoisson = 0.2\nfriction = 0.3\nrestitution = 1\nnormal = "viscoelastic"\n[[grains]]\nname = "pair"\nshape = "sphere"\nmaterial = "glass"\nspheres = [[0, 0, 0, 0.005]]\n' + end,
        "periodic": grains(spheres + e("`[periodic]`") + floor + e("`[wind]`")),
        "water": grains(spheres + floor + e("`[water]`")),
        "lattice": grains(group + e("`[[grains]]`", 1)),
        "region": grains(group + count + 'size = ["9 mm", "11 mm"]\n' + e("`[[grains]]`", 2)),
        "floes": grains(group.replace("sphere", "polyhedron") + e("`[[grains]]`", 3)),
        "frustum": grains(group.replace("sphere", "polyhedron") + e("`[[grains]]`", 4)),
        "growth": grains(group + size + box + e("`[[grains]]`", 5)),
        "sizes": grains(group + count + box + e("`[[grains]]`", 6)),
        "gradation": grains(group + count + box + e("`[[grains]]`", 7)),
        "track": bed + e("`[track.load]`").replace("cycles = 10", "cycles = 1000") + e("`[track.load.seating]`") + e("`[track.jump]`") + e("`[track.push]`"),
        "load": bed + e("`[track.load]`") + e("`[solid.reduction]`"),
        "rail": bed.replace("hold =", "spacing = 0.6\nhold =") + bogie + e("`[track.rail]`"),
        "meshed_sleeper": bed + e("`[track.sleeper.mesh]`") + e("`[track.load]`"),
    }
    # Stone libraries are separate files.
    return made, [b for heading in blocks for b in blocks[heading] if not b.startswith("name = ")]


def examples(program):
    made, all_examples = scenes(open(os.path.join(ROOT, "docs/scene.md"), encoding="utf-8").read())
    whole = "".join(made.values())
    for example in all_examples:
        if example.strip() not in whole:
            yield f"docs/scene.md: in no scene of this script: {example.splitlines()[0]}"
    with tempfile.TemporaryDirectory() as folder:
        for name in ("coupled/embankment_tet10/embankment.msh", "data/gradations.csv", "track/cyclic/stones.toml", "track/cyclic/NODECOORD.DAT",
                     "track/cyclic/ELEMENTNUM.DAT", "track/cyclic/DOF.DAT"):
            shutil.copy(os.path.join(ROOT, "inputs", name), folder)
        for name, text in made.items():
            scene = os.path.join(folder, name + ".toml")
            open(scene, "w", encoding="utf-8").write(text)
            done = subprocess.run([program, "check", scene], capture_output=True, text=True)
            if done.returncode:
                yield f"docs/scene.md: the examples as scene {name}: {done.stderr.strip()}"


def inputs():
    """Name and text of each TOML file of inputs/; True for scenes, not for studies, libraries and included files."""
    folder = os.path.join(ROOT, "inputs")
    for path, _, files in sorted(os.walk(folder)):
        for file in sorted(f for f in files if f.endswith(".toml")):
            text = open(os.path.join(path, file), encoding="utf-8").read()
            tables = tomllib.loads(text)
            scene = "scene" not in tables and "title" in tables
            yield os.path.relpath(os.path.join(path, file), folder).replace(os.sep, "/"), text, scene


def head(text):
    """Texts of the first comment by label, and its errors.

    Each text begins with "# LABEL: " and continues with "#   ". Order of LABELS; `Use` (commands, options) may repeat. Scenes need
    Shows, Time and Sources, other files Shows and Sources: at most HEAD_LINES lines without `Use`.
    """
    found, labels, lines = {}, [], 0
    for line in text.split("\n"):
        if not line.startswith("#"):
            break
        start = re.match(rf"# ({'|'.join(LABELS)}): (?=\S)", line)
        if start:
            labels.append(start[1])
        elif not (labels and re.match(r"#   \S", line)):
            return found, f"found the comment line {line!r}, expected \"# LABEL: \" with {', '.join(LABELS)}, or \"#   \" to continue"
        found[labels[-1]] = f"{found.get(labels[-1], '')} {line[start.end() if start else 4:]}".strip()
        lines += labels[-1] != "Use"
    order = [LABELS.index(label) for label in labels]
    if order != sorted(order) or any(labels.count(label) > 1 for label in LABELS[:3]):
        return found, f"found {', '.join(labels)}, expected the order {', '.join(LABELS)}"
    return found, f"found {lines} lines, expected at most {HEAD_LINES}" if lines > HEAD_LINES else None


def numbers(text):
    return re.findall(r"\d[\d.,]*(?<=\d)", text)


def table():
    """CPU time by scene in docs/scenes.md; None in tables without it."""
    folder, times = "", {}
    for _, line in lines(os.path.join(ROOT, "docs/scenes.md")):
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if cells and cells[0].startswith("scene"):
            folder, timed = ("verify/" if "inputs/verify" in cells[0] else ""), "CPU" in cells[-1]
        # A second name of a row is in the folder of the first.
        beside = folder
        for name in re.findall(r"`([^`]*\.toml)`", cells[0] if cells else ""):
            name = name if "/" in name and not folder else beside + name
            times[name], beside = cells[-1] if timed else None, beside or os.path.dirname(name) + "/"
    return times


def heads():
    """Errors of the heads of inputs/ and of the table of scenes."""
    times = table()
    for name, text, scene in inputs():
        found, error = head(text)
        missing = [label for label in ("Shows", "Time", "Sources") if label not in found and (scene or label != "Time")]
        if error or missing:
            yield f"inputs/{name}:1: {error or 'found no ' + ', '.join(missing) + ' in the first comment'}"
        elif scene and name not in times:
            yield f"docs/scenes.md: found no row of {name}"
        elif scene and times[name] is not None and not numbers(times[name]):
            yield f"docs/scenes.md: found no CPU time of {name}"
        elif scene and (other := set(numbers((times[name] or "").split("(")[0])) - set(numbers(found["Time"]))):
            yield f"docs/scenes.md: found {name} with {', '.join(sorted(other))} s, expected a time of its head: {found['Time']}"
        times.pop(name, None)
    yield from (f"docs/scenes.md: found {name}, expected a file of inputs/" for name in times)


faults = list(links()) + list(too_long()) + list(heads()) + (list(examples(sys.argv[1])) if len(sys.argv) > 1 else [])
print("\n".join(faults) or "links, heads" + (" and examples" if len(sys.argv) > 1 else "") + " are right")
sys.exit(bool(faults))
