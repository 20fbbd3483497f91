"""Solids in OpenGeoSys (PyPI `ogs`), on the meshes of 20-node bricks of the scenes."""

import math, os, re, shutil, subprocess, sys, tempfile

import common

ROOT = os.path.dirname(sys.executable)
PROGRAM = next((p for p in (os.path.join(ROOT, "ogs"), shutil.which("ogs")) if p and os.path.exists(p)), None)
# Corners, then mid-sides, of the faces of a brick.
FACES = [(0, 1, 2, 3, 8, 9, 10, 11), (4, 5, 6, 7, 12, 13, 14, 15), (0, 1, 5, 4, 8, 17, 12, 16)]
FACES += [(1, 2, 6, 5, 9, 18, 13, 17), (2, 3, 7, 6, 10, 19, 14, 18), (3, 0, 4, 7, 11, 16, 15, 19)]


def mesh(row):
    """Nodes and bricks of the scene's Abaqus mesh, from 0."""
    tables = common.scene(row)
    path = os.path.join(os.path.dirname(os.path.join(os.path.dirname(common.MATRIX), row["scene"])), tables["solid"]["mesh"])
    with open(path) as file:
        text = file.read()
    body = lambda word: re.search(rf"^\*{word}\b[^\n]*\n(.*?)(?=^\*|\Z)", text, re.S | re.M)[1]
    places, index = [], {}
    for line in body("NODE").splitlines():
        number, *x = line.split(",")
        index[int(number)] = len(places)
        places.append(tuple(map(float, x)))
    numbers = [int(n) for n in re.findall(r"\d+", body("ELEMENT"))]
    return places, [[index[n] for n in numbers[k + 1 : k + 21]] for k in range(0, len(numbers), 21)], tables


def nodal_forces(places, bricks, inside, traction):
    """Consistent forces by node of a traction on 8-node faces; the program takes loaded faces as flat."""
    corners, forces = [(-1, -1), (1, -1), (1, 1), (-1, 1)], {}
    points = [(0.0, 8 / 9), (math.sqrt(0.6), 5 / 9), (-math.sqrt(0.6), 5 / 9)]

    def shapes(r, s):
        found = [(1 + r * a) * (1 + s * b) * (r * a + s * b - 1) / 4 for a, b in corners]
        return found + [(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2, (1 - r) * (1 - s * s) / 2]

    for face in [[b[k] for k in f] for b in bricks for f in FACES if all(inside(places[b[k]]) for k in f)]:
        place = lambda r, s: [sum(n * places[k][d] for n, k in zip(shapes(r, s), face)) for d in range(3)]
        for r, u in points:
            for s, v in points:
                # Quadratic along each axis: central differences are exact.
                a = [(p - q) / 2 for p, q in zip(place(r + 1, s), place(r - 1, s))]
                b = [(p - q) / 2 for p, q in zip(place(r, s + 1), place(r, s - 1))]
                area = u * v * math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
                stress = traction(place(r, s))
                for n, k in zip(shapes(r, s), face):
                    force = forces.setdefault(k, [0.0, 0.0, 0.0])
                    for d in range(3):
                        force[d] += n * area * stress[d]
    return forces


def vtu(path, places, cells, kind, data=None):
    """Writes a mesh of cells of a VTK type; `data`: nodes and elements of the whole mesh, forces."""
    array = lambda name, type, count, values: (
        f'<DataArray type="{type}" Name="{name}" NumberOfComponents="{count}" format="ascii">\n{" ".join(map(str, values))}\n</DataArray>\n'
    )
    size = len(cells[0])
    text = '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<UnstructuredGrid>\n'
    text += f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells)}">\n'
    if data:
        nodes, elements, forces = data
        text += "<PointData>\n" + array("bulk_node_ids", "UInt64", 1, nodes)
        text += "".join(array(f"force{d}", "Float64", 1, values) for d, values in enumerate(forces)) + "</PointData>\n"
        text += "<CellData>\n" + array("bulk_element_ids", "UInt64", 1, elements) + "</CellData>\n"
    text += "<Points>\n" + array("Points", "Float64", 3, [v for p in places for v in p]) + "</Points>\n<Cells>\n"
    text += array("connectivity", "Int64", 1, [n for c in cells for n in c]) + array("offsets", "Int64", 1, [size * (k + 1) for k in range(len(cells))])
    text += array("types", "UInt8", 1, [kind] * len(cells)) + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    with open(path, "w") as file:
        file.write(text)


PROJECT = """<?xml version="1.0" encoding="ISO-8859-1"?>
<OpenGeoSysProject>
<meshes>{meshes}</meshes>
<processes><process><name>SD</name><type>SMALL_DEFORMATION</type><integration_order>3</integration_order>
<constitutive_relation><type>LinearElasticIsotropic</type><youngs_modulus>E</youngs_modulus><poissons_ratio>nu</poissons_ratio></constitutive_relation>
<process_variables><process_variable>displacement</process_variable></process_variables>
<secondary_variables/><specific_body_force>0 0 0</specific_body_force></process></processes>
<media><medium id="0"><phases><phase><type>Solid</type>
<properties><property><name>density</name><type>Constant</type><value>1</value></property></properties></phase></phases></medium></media>
<time_loop><processes><process ref="SD"><nonlinear_solver>newton</nonlinear_solver>
<convergence_criterion><type>DeltaX</type><norm_type>NORM2</norm_type><reltol>1e-10</reltol></convergence_criterion>
<time_discretization><type>BackwardEuler</type></time_discretization>
<time_stepping><type>FixedTimeStepping</type><t_initial>0</t_initial><t_end>1</t_end>
<timesteps><pair><repeat>1</repeat><delta_t>1</delta_t></pair></timesteps></time_stepping></process></processes>
<output><type>VTK</type><prefix>out</prefix><timesteps><pair><repeat>1</repeat><each_steps>1</each_steps></pair></timesteps>
<data_mode>Ascii</data_mode><compress_output>false</compress_output><variables><variable>displacement</variable></variables></output></time_loop>
<parameters>{parameters}</parameters>
<process_variables><process_variable><name>displacement</name><components>3</components><order>2</order>
<initial_condition>u0</initial_condition><boundary_conditions>{conditions}</boundary_conditions>
<source_terms>{sources}</source_terms></process_variable></process_variables>
<nonlinear_solvers><nonlinear_solver>
<name>newton</name><type>Newton</type><max_iter>10</max_iter><linear_solver>lu</linear_solver></nonlinear_solver></nonlinear_solvers>
<linear_solvers><linear_solver><name>lu</name><eigen><solver_type>SparseLU</solver_type></eigen></linear_solver></linear_solvers>
</OpenGeoSysProject>
"""


def solve(places, bricks, material, fixed, forces, probe):
    """Displacement of a node. `fixed`: (test of places, directions)."""
    parameter = lambda name, values: f"<parameter><name>{name}</name><type>Constant</type><values>{values}</values></parameter>"
    parameters = parameter("E", material["young"]) + parameter("nu", material["poisson"]) + parameter("u0", "0 0 0") + parameter("zero", 0)
    meshes, conditions, sources = ["bulk"], "", ""
    with tempfile.TemporaryDirectory() as folder:

        def surface(name, inside):
            found = [([b[k] for k in f], e) for e, b in enumerate(bricks) for f in FACES if all(inside(places[b[k]]) for k in f)]
            cells, elements = [c for c, _ in found], [e for _, e in found]
            own = sorted({n for c in cells for n in c})
            local = {n: k for k, n in enumerate(own)}
            vtu(os.path.join(folder, f"{name}.vtu"), [places[n] for n in own], [[local[n] for n in c] for c in cells], 23, (own, elements, []))
            meshes.append(name)

        vtu(os.path.join(folder, "bulk.vtu"), places, bricks, 25)
        for k, (inside, directions) in enumerate(fixed):
            surface(f"fixed{k}", inside)
            for d in directions:
                conditions += f"<boundary_condition><mesh>fixed{k}</mesh><type>Dirichlet</type><component>{d}</component>"
                conditions += "<parameter>zero</parameter></boundary_condition>"
        own = sorted(forces)
        points = [places[n] for n in own]
        vtu(os.path.join(folder, "loads.vtu"), points, [[k] for k in range(len(own))], 1, (own, [0] * len(own), zip(*(forces[n] for n in own))))
        meshes.append("loads")
        for d in range(3):
            parameters += f"<parameter><name>force{d}</name><type>MeshNode</type><mesh>loads</mesh><field_name>force{d}</field_name></parameter>"
            sources += f"<source_term><mesh>loads</mesh><type>Nodal</type><component>{d}</component><parameter>force{d}</parameter></source_term>"
        with open(os.path.join(folder, "case.prj"), "w") as file:
            listed = "".join(f"<mesh>{name}.vtu</mesh>" for name in meshes)
            file.write(PROJECT.format(meshes=listed, parameters=parameters, conditions=conditions, sources=sources))
        done = subprocess.run([PROGRAM, "case.prj"], cwd=folder, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
        found = [name for name in os.listdir(folder) if name.startswith("out_ts_1_")]
        if not found:
            raise RuntimeError((done.stdout + done.stderr)[-500:])
        with open(os.path.join(folder, found[0])) as file:
            text = file.read()
    values = re.search(r'<DataArray[^>]*Name="displacement"[^>]*>(.*?)</DataArray>', text, re.S)[1].split()
    return [float(v) for v in values[3 * probe : 3 * probe + 3]]


def at(places, point):
    return min(range(len(places)), key=lambda n: sum((a - b) ** 2 for a, b in zip(places[n], point)))


def plane(direction, value):
    return lambda x: abs(x[direction] - value) < 1e-6


def cook_membrane(row):
    places, bricks, tables = mesh(row)
    fixed = [(plane(0, 0.0), (0, 1)), (plane(2, 0.0), (2,))]
    forces = nodal_forces(places, bricks, plane(0, 48.0), lambda x: (0.0, 62500.0, 0.0))
    u = solve(places, bricks, tables["solid"]["material"][0], fixed, forces, at(places, (48, 52, 0)))
    return u[1] * row["quantity"]["factor"]


def thick_cylinder(row):
    places, bricks, tables = mesh(row)
    load = tables["solid"]["load"][0]
    pressure = load["pressure"] * load["history"]["points"][1][1]
    heights = [x[2] for x in places]
    fixed = [(plane(0, 0.0), (0,)), (plane(1, 0.0), (1,)), (plane(2, min(heights)), (2,)), (plane(2, max(heights)), (2,))]
    bore = lambda x: x[0] ** 2 + x[1] ** 2 < 0.5001**2
    forces = nodal_forces(places, bricks, bore, lambda x: (pressure * x[0] / math.hypot(*x[:2]), pressure * x[1] / math.hypot(*x[:2]), 0.0))
    u = solve(places, bricks, tables["solid"]["material"][0], fixed, forces, at(places, (0.5, 0, 0)))
    return u[0] * row["quantity"]["factor"]


CASES = {"cook-membrane": cook_membrane, "thick-cylinder": thick_cylinder}

if __name__ == "__main__":
    if PROGRAM is None:
        common.missing("found no program ogs")
    version = re.search(r"version: (\S+)", subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout)
    common.print_values(version and version[1], lambda row: CASES[row["name"]](row))
