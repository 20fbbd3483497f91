"""Impacts in Kratos DEM (PyPI `KratosDEMApplication`): Hertz contacts with Coulomb friction."""

import json, os, sys, tempfile

import common

quiet = open(os.devnull, "w")
# The program prints on the standard output of the process.
output = os.dup(1)
os.dup2(quiet.fileno(), 1)
try:
    import KratosMultiphysics as Kratos
    import KratosMultiphysics.DEMApplication as DEM
    from KratosMultiphysics.DEMApplication.DEM_analysis_stage import DEMAnalysisStage
except ImportError as error:
    Kratos, DEMAnalysisStage, absent = None, object, error

LAW = "DEM_D_Hertz_viscous_Coulomb"


def files(case):
    """Project, materials and meshes of an impact, written to the working directory."""
    bodies = case["bodies"]
    span = 20 * max(b["radius"] for b in bodies)
    project = {
        "problem_name": "impact",
        "Dimension": 3,
        "BoundingBoxOption": True,
        **{f"BoundingBox{side}{axis}": sign * span for side, sign in (("Min", -1), ("Max", 1)) for axis in "XYZ"},
        "BoundingBoxStopTime": 1e9,
        "GravityX": 0.0,
        "GravityY": 0.0,
        "GravityZ": case["gravity"],
        "RotationOption": True,
        "CleanIndentationsOption": False,
        "solver_settings": {
            "RemoveBallsInitiallyTouchingWalls": False,
            "strategy": "sphere_strategy",
            "material_import_settings": {"materials_filename": "materials.json"},
        },
        "VirtualMassCoefficient": 1.0,
        "RollingFrictionOption": False,
        "GlobalDamping": 0.0,
        "ElementType": "SphericPartDEMElement3D",
        "TranslationalIntegrationScheme": "Symplectic_Euler",
        "RotationalIntegrationScheme": "Direct_Integration",
        "NeighbourSearchFrequency": 1,
        "MaxTimeStep": case["step"],
        "FinalTime": case["steps"] * case["step"],
        "OutputTimeStep": 1e9,
        "GraphExportFreq": 1e9,
        "VelTrapGraphExportFreq": 1e9,
    }
    friction = case["friction"]
    contact = {
        "COEFFICIENT_OF_RESTITUTION": case["restitution"],
        "STATIC_FRICTION": friction,
        "DYNAMIC_FRICTION": friction,
        "FRICTION_DECAY": 500.0,
        "ROLLING_FRICTION": 0.0,
        "ROLLING_FRICTION_WITH_WALLS": 0.0,
        "DEM_DISCONTINUUM_CONSTITUTIVE_LAW_NAME": LAW,
    }
    elastic = {"YOUNG_MODULUS": case["young"], "POISSON_RATIO": case["poisson"]}
    names = [f"sphere{k}" for k in range(len(bodies))]
    materials = [
        {"material_name": n, "material_id": k + 1, "Variables": {"PARTICLE_DENSITY": b["density"], **elastic}}
        for k, (n, b) in enumerate(zip(names, bodies))
    ]
    rigid = {"YOUNG_MODULUS": 1e9 * case["young"], "POISSON_RATIO": case["poisson"], "COMPUTE_WEAR": False}
    materials.append({"material_name": "plane", "material_id": 9, "Variables": rigid})
    relations = [
        {"material_names_list": [a["material_name"], b["material_name"]], "material_ids_list": [a["material_id"], b["material_id"]], "Variables": contact}
        for k, a in enumerate(materials)
        for b in materials[k:]
    ]
    table = [[f"SpheresPart.Part{k}", n] for k, n in enumerate(names)] + [["RigidFacePart", "plane"]]
    with open("materials.json", "w") as file:
        json.dump({"materials": materials, "material_relations": relations, "material_assignation_table": table}, file)
    data = "Begin ModelPartData\nEnd ModelPartData\n"
    text = data + "Begin Properties 0\nEnd Properties\nBegin Nodes\n"
    text += "".join("{} {} {} {}\n".format(k, *b["place"]) for k, b in enumerate(bodies, 1)) + "End Nodes\n"
    text += "Begin Elements SphericParticle3D\n" + "".join(f"{k} 0 {k}\n" for k in range(1, len(bodies) + 1)) + "End Elements\n"
    text += "Begin NodalData RADIUS\n" + "".join(f"{k} 0 {b['radius']}\n" for k, b in enumerate(bodies, 1)) + "End NodalData\n"
    for k in range(len(bodies)):
        text += f"Begin SubModelPart Part{k}\nBegin SubModelPartNodes\n{k + 1}\nEnd SubModelPartNodes\n"
        text += f"Begin SubModelPartElements\n{k + 1}\nEnd SubModelPartElements\nEnd SubModelPart\n"
    walls = data + "Begin Properties 0\nEnd Properties\n"
    if case["plane"]:
        half = span / 2
        walls += f"Begin Nodes\n101 {-half} {-half} 0\n102 {half} {-half} 0\n103 0 {half} 0\nEnd Nodes\n"
        walls += "Begin Conditions RigidFace3D3N\n101 0 101 102 103\nEnd Conditions\nBegin SubModelPart 1\nBegin SubModelPartData\n"
        walls += "FIXED_MESH_OPTION 0\nRIGID_BODY_MOTION 0\nFREE_BODY_MOTION 0\nIS_GHOST 0\nIDENTIFIER plane\nFORCE_INTEGRATION_GROUP 0\n"
        walls += "End SubModelPartData\nBegin SubModelPartNodes\n101\n102\n103\nEnd SubModelPartNodes\n"
        walls += "Begin SubModelPartConditions\n101\nEnd SubModelPartConditions\nEnd SubModelPart\n"
    for name, content in (("DEM", text), ("DEM_FEM_boundary", walls), ("DEM_Inlet", data), ("DEM_Clusters", data)):
        with open(f"impact{name}.mdpa", "w") as file:
            file.write(content)
    return Kratos.Parameters(json.dumps(project))


class Stage(DEMAnalysisStage):
    def __init__(self, model, project, case):
        super().__init__(model, project)
        self.case, self.records = case, []

    def Initialize(self):
        super().Initialize()
        for node, body in zip(self.spheres_model_part.Nodes, self.case["bodies"]):
            for d, axis in enumerate("XYZ"):
                node.SetSolutionStepValue(getattr(Kratos, f"VELOCITY_{axis}"), body["velocity"][d])
                node.SetSolutionStepValue(getattr(Kratos, f"ANGULAR_VELOCITY_{axis}"), body["spin"][d])
        self.record()

    def record(self):
        node = self.spheres_model_part.GetNode(1)
        values = [node.GetSolutionStepValue(v) for v in (Kratos.VELOCITY, Kratos.ANGULAR_VELOCITY, Kratos.TOTAL_FORCES)]
        place = (node.X, node.Y, node.Z)
        self.records.append((len(self.records) * self.case["step"], place, *map(tuple, values)))

    def FinalizeSolutionStep(self):
        super().FinalizeSolutionStep()
        self.record()


def compute(row):
    case = common.impact(row)
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            stage = Stage(Kratos.Model(), files(case), case)
            stage.Run()
        finally:
            os.chdir(before)
    return common.taken(row, common.history(case, stage.records))


if __name__ == "__main__":
    sys.stdout = os.fdopen(output, "w")
    if Kratos is None:
        common.missing(absent)
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    common.print_values(Kratos.KratosGlobals.Kernel.Version().split("--")[0].replace('"', ""), compute)
