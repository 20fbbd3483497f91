"""Beam under a moving force, wave in a column, track in STEM (PyPI `stem-vibrations`). It brings its own Kratos: environment `stem` within the other."""

import importlib.util, json, math, os, sys, tempfile

import common

NESTED = os.path.join(sys.prefix, "stem", "bin", "python")
if importlib.util.find_spec("stem") is None and os.path.exists(NESTED):
    os.execv(NESTED, [NESTED, *sys.argv])
# Kratos prints to descriptor 1, also at its end.
sys.stdout = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
try:
    from stem import boundary, load, model_part, output, solver, structural_material
    from stem.__version__ import __version__
    from stem.model import Model
    from stem.soil_material import LinearElasticSoil, OnePhaseSoil, SaturatedBelowPhreaticLevelLaw, SoilMaterial
    from stem.stem import Stem
    from stem.table import Table

    absent = None
except ImportError as error:
    absent = error


def histories(model, analysis, step, end, places, what, initial="NONE"):
    """Times and, by point of the model, histories of the results `what`."""
    settings = solver.SolverSettings(
        analysis_type=analysis,
        solution_type=solver.SolutionType.DYNAMIC,
        stress_initialisation_type=solver.StressInitialisationType[initial],
        time_integration=solver.TimeIntegration(0.0, end, step, 1.0, 1.0, 1000),
        is_stiffness_matrix_constant=True,
        are_mass_and_damping_constant=True,
        convergence_criteria=solver.DisplacementConvergenceCriteria(1e-9, 1e-15),
        strategy_type=solver.LinearNewtonRaphsonStrategy(),
        linear_solver_settings=solver.Amgcl(tolerance=1e-12),
        rayleigh_k=0.0,
        rayleigh_m=0.0,
    )
    model.project_parameters = solver.Problem(problem_name="case", number_of_threads=1, settings=settings)
    # Slightly less than a step, against rounding.
    wanted = output.JsonOutputParameters(0.99 * step, what, [])
    for k, place in enumerate(places):
        model.add_output_settings_by_coordinates([place], wanted, f"found{k}")
    found = []
    with tempfile.TemporaryDirectory() as folder:
        stem = Stem(model, folder)
        stem.write_all_input_files()
        stem.run_calculation()
        for k in range(len(places)):
            with open(os.path.join(folder, f"found{k}.json")) as file:
                found.append(json.load(file))
    nodes = [next(value for key, value in f.items() if key.startswith("NODE_")) for f in found]
    return [0.0, *found[0]["TIME"]], [{w.name: [0.0, *node[w.name]] for w in what} for node in nodes]


def solved(model, row, analysis, step, end, place, what):
    """Quantity of the row from the displacement `what` at a point of the model."""
    times, (found,) = histories(model, analysis, step, end, [place], [what])
    return common.taken(row, {"time": times, row["quantity"]["column"]: found[what.name]})


def moving_force(row):
    """40 beam elements (Euler); the force moves along the line."""
    model, length, step = Model(2), 20.0, 1e-3
    beam = structural_material.EulerBeam(2, 30e9, 0.0, 2500.0, 1.0, 1 / 12)
    model.gmsh_io.generate_geometry({"beam": {"coordinates": [(0, 0, 0), (length, 0, 0)], "ndim": 1}}, "")
    part = model_part.BodyModelPart("beam")
    part.material = structural_material.StructuralMaterial("beam", beam)
    part.get_geometry_from_geo_data(model.gmsh_io.geo_data, "beam")
    model.body_model_parts.append(part)
    moving = load.MovingLoad(load=["0.0", "-1e5", "0.0"], direction_signs=[1, 1, 1], velocity=40.0, origin=[0.0, 0.0, 0.0], offset=0.0)
    model.add_load_by_geometry_ids([1], moving, "force")
    held = boundary.DisplacementConstraint(is_fixed=[True, True, True], value=[0, 0, 0])
    model.add_boundary_condition_by_geometry_ids(0, [1, 2], held, "ends")
    model.synchronise_geometry()
    model.set_mesh_size(element_size=length / 40)
    kind = solver.AnalysisType.MECHANICAL
    return solved(model, row, kind, step, 0.5, (length / 2, 0.0, 0.0), output.NodalOutput.DISPLACEMENT_Y)


def wave_column(row):
    """Triangles of 6 nodes, 0.5 m, plane strain; absorbing base."""
    step, height, model = 5e-4, 20.0, Model(2)
    soil = SoilMaterial(
        "soil",
        OnePhaseSoil(2, IS_DRAINED=True, DENSITY_SOLID=2000.0, POROSITY=0.0),
        LinearElasticSoil(YOUNG_MODULUS=50e6, POISSON_RATIO=0.3),
        SaturatedBelowPhreaticLevelLaw(),
    )
    model.add_soil_layer_by_coordinates([(0, 0, 0), (1, 0, 0), (1, height, 0), (0, height, 0)], soil, "column")
    model.set_mesh_size(element_size=0.5)
    model.mesh_settings.element_order = 2
    times = [k * step for k in range(round(0.3 / step) + 1)]
    pulse = [-10e3 * math.sin(math.pi * 40 * t) ** 2 if t < 1 / 40 else 0.0 for t in times]
    pressure = load.LineLoad(active=[False, True, False], value=[0, Table(times=times, values=pulse), 0])
    model.add_load_by_coordinates([(0.0, height, 0), (1.0, height, 0)], pressure, "pulse")
    # Lines: 1 base, 2 and 4 sides.
    base = boundary.AbsorbingBoundary(absorbing_factors=[1.0, 1.0], virtual_thickness=1e6)
    model.add_boundary_condition_by_geometry_ids(1, [1], base, "base")
    sides = boundary.DisplacementConstraint(is_fixed=[True, False, False], value=[0, 0, 0])
    model.add_boundary_condition_by_geometry_ids(1, [2, 4], sides, "sides")
    model.synchronise_geometry()
    kind = solver.AnalysisType.MECHANICAL_GROUNDWATER_FLOW
    return solved(model, row, kind, step, 0.3, (0.0, height, 0.0), output.NodalOutput.DISPLACEMENT_Y)


def track(row):
    """Rail (Euler) on pads, sleepers and beds under gravity and two forces that move, or with one sleeper free of its bed and no force."""
    tables = common.scene(row)
    rail, sleeper, axles = (tables["track"][key] for key in ("rail", "sleeper", "load"))
    spacing, young, density, height, step = sleeper["spacing"], 210e9, 7850.0, 0.1, 2e-3
    beyond = round(rail["extension"] / spacing)
    beam = structural_material.EulerBeam(2, young, 0.3, density, rail["mass"] / density, rail["bending_stiffness"] / young)
    spring = lambda k, c: structural_material.ElasticSpringDamper([0, k, 0], [0, 0, 0], [0, c, 0], [0, 0, 0])
    pad, bed = spring(rail["pad_stiffness"], rail["pad_damping"]), spring(rail["foundation"], rail["foundation_damping"])
    mass = structural_material.NodalConcentrated([0, 0, 0], sleeper["mass"], [0, 0, 0])
    model, count = Model(2), sleeper["count"] + 2 * beyond
    model.generate_extended_straight_track(spacing, count, beam, mass, pad, height, [0.0, 0.0, 0.0], bed, 0.5, [1, 0, 0], "rail")
    place = lambda number: (beyond + number - 1) * spacing
    for free in rail.get("hanging", []):
        beds = model.get_model_part_by_name("soil_equivalent_rail").geometry
        below = lambda line: all(abs(beds.points[p].coordinates[0] - place(free["sleeper"])) < 1e-6 for p in line.point_ids)
        lines = [key for key, line in beds.lines.items() if below(line)]
        none = structural_material.StructuralMaterial("free", spring(0.0, 0.0))
        model.split_model_part("soil_equivalent_rail", "free", lines, none)
    middle = place(int(row["quantity"]["column"].removeprefix("load_")))
    # From 4 m before until both wheels have passed; the force grows within some 0.1 s.
    for k, behind in enumerate((0.0, axles["wheelbase"]) if "hanging" not in rail else ()):
        force = ["0.0", f"{-axles['axle_load']}*(1-exp(-50*t))", "0.0"]
        moving = load.MovingLoad(force, [1, 1, 1], axles["speed"], [0.0, height, 0.0], middle - 4.0 - behind)
        model.add_load_on_line_model_part("rail", moving, f"wheel{k}")
    model.set_mesh_size(element_size=spacing / 6)
    places = [(middle, 0.0, 0.0), (middle, height, 0.0)]
    moves, speeds = output.NodalOutput.DISPLACEMENT_Y, output.NodalOutput.VELOCITY_Y
    kind, what = solver.AnalysisType.MECHANICAL, [moves, speeds]
    times, (low, high) = histories(model, kind, step, 0.7, places, what, "GRAVITY_LOADING")
    between = lambda w: [a - b for a, b in zip(low[w.name], high[w.name])]
    forces = [rail["pad_stiffness"] * u + rail["pad_damping"] * v for u, v in zip(between(moves), between(speeds))]
    # Springs without a gap: the free sleeper must not reach its bed.
    assert all(-min(low[moves.name]) < free["gap"] for free in rail.get("hanging", []))
    return common.taken(row, {"time": times, row["quantity"]["column"]: forces})


CASES = {"moving-force": moving_force, "wave-column": wave_column, "rail-seat": track, "hanging-sleeper": track}


if __name__ == "__main__":
    if absent:
        common.missing(absent)
    common.print_values(__version__, lambda row: CASES[row["name"]](row))
