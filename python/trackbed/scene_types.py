"""Types of the tables of a scene, for editors and type checkers.

Generated from the schema by `python/make_scene_types.py`: do not edit. A quantity is a number in SI units or a string with a unit, such as
"20 MPa"; numpy scalars and arrays are accepted. Quotes in comments name values of other keys.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Union

import numpy as np
from numpy.typing import NDArray

if sys.version_info >= (3, 11):
    from typing import Required
elif TYPE_CHECKING:
    from typing_extensions import Required

Integer = Union[int, "np.integer[Any]"]
Float = Union[float, Integer, "np.floating[Any]"]
Quantity = Union[Float, str]
Bool = Union[bool, np.bool_]
File = Union[str, "os.PathLike[str]"]
Array = NDArray[Any]
Integers = Union[Sequence[Integer], Array]
Floats = Union[Sequence[Float], Array]
Quantities = Union[Sequence[Quantity], Array]
IntegerRows = Union[Sequence[Integers], Array]
FloatRows = Union[Sequence[Floats], Array]
Rows = Union[Sequence[Quantities], Array]


# Direction of the track.
# "x": Along x.
# "y": Along y.
Along = Literal["x", "y"]


# Contacts that the frames show.
# "all": All.
# "strong": Above mean normal force.
Chains = Literal["all", "strong"]


# What a stage of compaction does.
# "vibration": Oscillating planes.
# "tamping": Plate pressing from above.
# "squeeze": Plane moving in.
# "bedding": Sleepers placed and pressed.
# "pouring": Grains dropped around sleepers.
# "tines": Sleepers lifted and tamped by vibrating tines, one after the other.
# "stabilizing": Sleepers loaded and shaken across the track, held or not.
CompactionKind = Literal["vibration", "tamping", "squeeze", "bedding", "pouring", "tines", "stabilizing"]


# Meridian of Mohr–Coulomb that the cone of Drucker–Prager passes through.
# "compression": Compression.
# "extension": Extension.
# "plane_strain": Equal collapse load.
Cone = Literal["compression", "extension", "plane_strain"]


# When a bond breaks.
# "stress": Tensile or shear stress reaches strength.
# "sum": Load fractions add up to 1.
CriterionName = Literal["stress", "sum"]


# `contact.damping`.
# "restitution": Restitution.
# "ratio": Ratio.
# "none": None.
DampingKind = Literal["restitution", "ratio", "none"]


# Volumetric strain of quadratic elements.
# "pointwise": Pointwise.
# "mean": Average, for ν ≥ 0.49 and plastic flow without `"reduced"` hexahedra.
Dilatation = Literal["pointwise", "mean"]


# Area that drag belongs to.
# "projected": Wet part seen by the flow.
# "wetted": Whole wet surface, tenfold for floes.
DragArea = Literal["projected", "wetted"]


# What the columns of the element list are.
# "auto": By count (of 21, material first if values repeat).
# "id_material_nodes": `id material n1 … n20`.
# "id_nodes": `id n1 … n20`.
# "material_nodes": `material n1 … n20`.
# "nodes": `n1 … n20`.
ElementColumns = Literal["auto", "id_material_nodes", "id_nodes", "material_nodes", "nodes"]


# Source of the energies.
# "reference": `young` and `poisson`, work on the remaining strain.
# "library": SSE, SPD and SCD.
EnergySource = Literal["reference", "library"]


# How the equations of an elastic solid are solved.
# "auto": Iterative from 25,000 nodes (static), 100,000 (steps, lumped mass), else direct.
# "direct": Sparse Cholesky factor.
# "iterative": Conjugate gradients.
# "mumps": Factor by an optional library.
EquationMethod = Literal["auto", "direct", "iterative", "mumps"]


# What grains touch of the faces of the ground.
# "curved": As deformed (no polyhedra).
# "flat": Flat triangles, less accurate.
FacesName = Literal["curved", "flat"]


# Shape of a group of grains.
# "sphere": Sphere.
# "clump": Rigid cluster of spheres (`fill`, `region`, `packing`).
# "bonded": Breakable cluster of spheres (`fill`).
# "polyhedron": Dilated convex body (`fill`, `region`, `packing`, `floes`, `frustum`).
# "disk": Flat round body (`fill`, `region`, `packing`, `floes`).
GrainShape = Literal["sphere", "clump", "bonded", "polyhedron", "disk"]


# Shape of a load in time.
# "constant": Constant.
# "ramp": From 0 to 1 over `duration`.
# "sine": As sin 2πft.
# "haversine": As sin² πft.
# "table": Linear between points, constant beyond.
HistoryKind = Literal["constant", "ramp", "sine", "haversine", "table"]


# How the initial stress is found.
# "k0": Weight above, times K₀ sideways.
# "gravity": In steps.
# "uniform": Everywhere equal.
InitialStressMethod = Literal["k0", "gravity", "uniform"]


# Integration rule of the element stiffness.
# "reduced": 2 × 2 × 2 points.
# "irons14": 14 points.
# "full": 3 × 3 × 3 points.
Integration = Literal["reduced", "irons14", "full"]


# What a jump extrapolates.
# "extrapolate": Advances the settlement.
# "displace": Also displaces grains and sleepers.
JumpMethod = Literal["extrapolate", "displace"]


# Kind of a lattice.
# "loose": Simple cubic, 0.4764.
# "hexagonal": 0.2595.
# "face_centred": 0.2595.
LatticeKind = Literal["loose", "hexagonal", "face_centred"]


# How unsymmetric equations are solved.
# "auto": By size.
# "direct": LU.
# "krylov": GMRES on a kept factor.
LinearSolver = Literal["auto", "direct", "krylov"]


# Mass matrix of the solid.
# "consistent": Consistent.
# "lumped": Scaled diagonal.
Mass = Literal["consistent", "lumped"]


# Yield criterion of a material.
# "elastic": Elastic.
# "mohr_coulomb": Mohr–Coulomb.
# "drucker_prager": Drucker–Prager.
# "von_mises": Von Mises.
# "tresca": Tresca.
# "modified_cam_clay": Modified Cam clay.
# "umat": Routine of a shared library.
MaterialModel = Literal["elastic", "mohr_coulomb", "drucker_prager", "von_mises", "tresca", "modified_cam_clay", "umat"]


# One rigid-body motion in world axes.
# "x": Translation along x.
# "y": Translation along y.
# "z": Translation along z.
# "rx": Rotation about x.
# "ry": Rotation about y.
# "rz": Rotation about z.
Motion = Literal["x", "y", "z", "rx", "ry", "rz"]


# Side of a net.
# "start": Start of `along`.
# "end": End of `along`.
# "left": Start of `across`.
# "right": End of `across`.
NetSide = Literal["start", "end", "left", "right"]


# Which matrix the iteration takes.
# "full": Consistent tangent.
# "modified": Tangent of the step's start.
# "initial_stiffness": Elastic matrix.
NewtonVariant = Literal["full", "modified", "initial_stiffness"]


# Elements with or without mid-side nodes.
# "linear": Corners only, fast.
# "quadratic": With mid-side nodes, file constraints at corners.
Order = Literal["linear", "quadratic"]


# Law of peaks.
# "weibull": Of the excess over the threshold.
# "gumbel": Of the peaks.
PeakLaw = Literal["weibull", "gumbel"]


# Field of the solid at a node or point.
# "displacement": Displacement.
# "velocity": Velocity.
# "acceleration": Mean of the last step if coupled.
# "stress": Six components.
# "strain": Six tensor components.
ProbeField = Literal["displacement", "velocity", "acceleration", "stress", "strain"]


# How a rail works.
# "winkler": Quasi-static, on an elastic foundation.
# "beam": Beam with mass on pads.
RailKind = Literal["winkler", "beam"]


# What a solid is reduced to.
# "surface": Dofs of the surface near grains, exact for slow loads, and slowest modes.
# "modes": Slowest modes with static corrections.
ReductionKind = Literal["surface", "modes"]


# `contact.rolling` and `contact.twisting`.
# "spring": Spring.
# "none": None.
Resistance = Literal["spring", "none"]


# Threads of a routine.
# "one": One call at a time.
# "all": Thread-safe routine.
RoutineThreads = Literal["one", "all"]


# Coupling scheme.
# "predicted": Grains first, on predicted surface motion.
# "lagged": Solid first, with previous force.
# "stiffened": Predicted with contact stiffness (linear solids without reduction, no polyhedra).
# "iterated": Until both sides agree.
SchemeName = Literal["predicted", "lagged", "stiffened", "iterated"]


# Shape of one cycle.
# "sine": Starting at the mean.
# "haversine": (1 − cos 2πft)/2 from the minimum.
# "ramp": Half cosines, hold.
# "history": Measured.
# "gauss": Pulses Σ F exp(−((x − xᵢ − vt)/ℓ)²).
# "bogie": Two axles.
# "train": Axles of a train.
# "vehicle": Vehicles with suspensions on a `"beam"`.
SeatLoadKind = Literal["sine", "haversine", "ramp", "history", "gauss", "bogie", "train", "vehicle"]


# What a uniform law is uniform in.
# "number": Number.
# "volume": Volume.
Share = Literal["number", "volume"]


# A side of the bounding box of the mesh.
# "x-": Smallest x.
# "x+": Largest x.
# "y-": Smallest y.
# "y+": Largest y.
# "z-": Smallest z.
# "z+": Largest z.
Side = Literal["x-", "x+", "y-", "y+", "z-", "z+"]


# Kind of a load on the solid.
# "pressure": Normal to faces.
# "traction": On faces.
# "point": Force.
# "moving": Forces that move along a line.
SolidLoadKind = Literal["pressure", "traction", "point", "moving"]


# An axis.
# "x": x.
# "y": y.
# "z": z.
SpecimenAxis = Literal["x", "y", "z"]


# Which test a specimen is in.
# "compression": Force over `area`.
# "brazilian": Splitting, tension 2F/(πDt).
SpecimenTest = Literal["compression", "brazilian"]


# Distribution of strengths or stiffnesses.
# "normal": Cut off at zero.
# "weibull": Scale as given.
SpreadKind = Literal["normal", "weibull"]


# Source of the tangent.
# "library": DDSDDE, differences if it is 0.
# "differences": Central differences of the stress.
TangentSource = Literal["library", "differences"]


# Kind of a wall.
# "plane": Infinite, one-sided (others two-sided).
# "cylinder": Cylinder.
# "cone": Cone.
# "sphere": Sphere.
# "triangles": Triangles.
# "mesh": From a file.
WallKind = Literal["plane", "cylinder", "cone", "sphere", "triangles", "mesh"]


class SizesMonodisperse(TypedDict, total=False):
    """One size."""

    law: Required[Literal["monodisperse"]]

    # Size [m].
    size: Required[Quantity]


class SizesBidisperse(TypedDict, total=False):
    """Two sizes."""

    # Large size [m].
    large: Required[Quantity]

    # Volume fraction of large grains; 0–1.
    large_share: Required[Float]

    law: Required[Literal["bidisperse"]]

    # Small size [m].
    small: Required[Quantity]


class SizesUniform(TypedDict, total=False):
    """Uniform."""

    # Distributed quantity; default `"number"`.
    by: Share

    # Largest size [m].
    high: Required[Quantity]

    law: Required[Literal["uniform"]]

    # Smallest size [m].
    low: Required[Quantity]


class SizesNormal(TypedDict, total=False):
    """In number, truncated."""

    # Standard deviation [m].
    deviation: Required[Quantity]

    # Largest size [m].
    high: Required[Quantity]

    law: Required[Literal["normal"]]

    # Smallest size [m].
    low: Required[Quantity]

    # Mean [m].
    mean: Required[Quantity]


class SizesLogNormal(TypedDict, total=False):
    """In number, truncated."""

    # Standard deviation of ln(size).
    deviation: Required[Float]

    # Largest size [m].
    high: Required[Quantity]

    law: Required[Literal["log_normal"]]

    # Smallest size [m].
    low: Required[Quantity]

    # Median [m].
    median: Required[Quantity]


class Absorbing(TypedDict, total=False):
    """`[[solid.absorbing]]`: dashpots that absorb waves at normal incidence. Exactly one of `side`, `faces_in` and `set` chooses the faces."""

    # Box `[low, high]` of face centres [m]; or `side`.
    faces_in: Rows

    # Factor on normal dashpots ρ c_p; default 1; ≥ 0.
    normal: Float

    # Distance of the wave source, for springs [m]; default no springs; > 0.
    radius: Quantity

    # Face set, or node set around faces; or `side`.
    set: str

    # Side of the bounding box; or `faces_in`, `set`.
    side: Side

    # Factor on tangential dashpots ρ c_s; default 1; ≥ 0.
    tangential: Float


class Axis(TypedDict, total=False):
    """Grid planes along one axis."""

    # Elements in each interval; ≥ 1, ≤ 20 million in all.
    counts: Required[Integers]

    # Two or more ascending coordinates [m].
    lines: Required[Quantities]

    # Last over first element length in each interval; default 1; > 0.
    ratios: Floats


class Block(TypedDict, total=False):
    """`[solid.block]`: bricks between grid planes."""

    # Start and end of the top along x, for slopes [m]; default box.
    crest: Quantities

    # Layers from below; default material 1.
    layer: Sequence[Layer]

    # Grid planes along x.
    x: Required[Axis]

    # Grid planes along y.
    y: Required[Axis]

    # Grid planes along z.
    z: Required[Axis]


class Body(TypedDict, total=False):
    """Rigid body that a wall is."""

    # Centre of mass [m]; default of the enclosed volume.
    centre: Quantities

    # Motions at constant velocity; default none.
    hold: Sequence[Motion]

    # Inertia about the centre `[xx, yy, zz, xy, yz, zx]` [kg m²]; default of the enclosed volume, no rotation if round.
    inertia: Floats

    # Mass [kg]; > 0.
    mass: Required[Quantity]

    # Spring–dashpot support; default none.
    mount: Mount

    # Thrust and rudder; default none; with `water`.
    propulsion: Propulsion

    # Corner and edge radius against walls [m]; default smallest side/50 or less; > 0; with triangles.
    rounding: Quantity

    # Initial angular velocity [rad/s]; default none.
    spin: Quantities

    # Initial velocity [m/s]; default at rest.
    velocity: Quantities

    # Water forces; default none; with closed triangles, `[water]`.
    water: BodyWater


class BodyWater(TypedDict, total=False):
    """Water on a body of triangles: lift, wave forces, drag, added mass. Axes are x, y, z at the start and turn with the body."""

    # Added over own inertia; default 0; 0–100.
    added_inertia: Floats

    # Added over displaced mass; default `water.added_mass`; 0–100.
    added_mass: Floats

    # Damping over critical: heave, about x, y; default 0; 0–10.
    damping_ratio: Floats

    # Form drag along x, y, z; default `water.drag`; 0–100.
    drag: Floats

    # Moment coefficients; default `water.drag_moment`; 0–100.
    drag_moment: Floats

    # Skin drag; default `water.skin_drag`; 0–100.
    skin_drag: Float


class BondTable(TypedDict, total=False):
    """`[[bond]]`: a kind of bond, and which grains it joins."""

    # Names of both groups; default any; with `gap`.
    between: Sequence[str]

    # Whether contacts act before the break, with `face` always; default false.
    contact: Bool

    # Adhesive point without moments; or `parallel`.
    contact_point: ContactPoint

    # Fraction of critical damping, each spring; default 0; ≥ 0.
    damping: Float

    # List of dashpots: tension, shear [N s/m], bending, twisting [N m s]; or `damping`; ≥ 0.
    damping_coefficients: Floats

    # Given stiffnesses and strengths; or `parallel`.
    direct: Direct

    # Beam between floes with their face's section; or `parallel`.
    face: FaceTable

    # Surface distance of joined spheres [m]; or `pairs`, neither for stones, floes; ≥ 0, ≤ ten largest radii.
    gap: Quantity

    # Name in reports and `grains.bond`.
    name: Required[str]

    # CSV file of grain index pairs, from 0 over all groups; or `gap`; not with `deposition.level`.
    pairs: File

    # Cement disc with moments; or `contact_point`, `direct`, `face`.
    parallel: Parallel

    # Boxes with factors on bonds; default none.
    region: Sequence[StrengthRegion]

    # Spread of strengths; default none.
    spread: SpreadTable

    # Spread of stiffnesses, one factor a bond; default none.
    stiffness_spread: StiffnessSpreadTable


class Compaction(TypedDict, total=False):
    """`[[compaction]]`: a stage between settling and the main stage."""

    # Amplitude A of A sin 2πft [m]; > 0; with `"vibration"`.
    amplitude: Quantity

    # Successive plate positions `[[x, y], …]` [m]; with `"tamping"`.
    at: Rows

    # Cycles, at each position; ≥ 1; with `"vibration"`, `"tamping"`, `"bedding"`, `"stabilizing"`.
    cycles: Integer

    # Direction of motion; default up; with `"vibration"`.
    direction: Floats

    # Force F sin² πft, besides weight [N]; > 0; with `"tamping"` (plate), `"bedding"` (each rigid sleeper); constant with
    # `"stabilizing"`.
    force: Quantity

    # Frequency f [Hz]; > 0; with `"vibration"`, `"tamping"`, `"bedding"`, `"tines"`, `"stabilizing"`.
    frequency: Quantity

    # Friction between grains; default unchanged; ≥ 0.
    friction: Float

    # Names of waiting groups; with `"pouring"`; not bonded, with `prescribed_velocity`, or only an `inlet`.
    groups: Sequence[str]

    # Kind of stage.
    kind: Required[CompactionKind]

    # Parts dropped successively, `rest` each; default 1; 1–1000; with `"pouring"`.
    layers: Integer

    # Height above which centres are removed [m]; default none; with `"pouring"`.
    level: Quantity

    # Non-viscous damping; default 0; ≥ 0, < 1.
    local_damping: Float

    # Travel that ends it with a warning [m]; default half of `region`; > 0; with `"squeeze"`.
    max_travel: Quantity

    # Rigid box that moves vertically; with `"tamping"`.
    plate: Plate

    # Final porosity of `region`, up to the plane; > 0, < 1; with `"squeeze"`.
    porosity: Float

    # Box `[low, high]` of the measured porosity, inside the bed [m].
    region: Required[Rows]

    # Longest time to rest afterwards, as in `[deposition]` [s]; default 0.2; > 0.
    rest: Quantity

    # Speed along the normal [m/s]; > 0; with `"squeeze"`.
    speed: Quantity

    # Factor on contact stiffness, not corner strength; default 1; > 0, ≤ 1.
    stiffness_factor: Float

    # Force F sin 2πft on each rigid sleeper across the track [N]; > 0; with `"stabilizing"`.
    sway: Quantity

    # Tines of a tamping machine; with `"tines"`.
    tines: Tines

    # Index of a plane across an axis, from 0; with `"squeeze"`.
    wall: Integer

    # Indices of moving planes in `[[walls]]`, from 0; default all planes; with `"vibration"`.
    walls: Integers


# `from`: Middle of one end [m].
_ConeRegion = TypedDict("_ConeRegion", {"from": "Quantities"})


class ConeRegion(_ConeRegion, total=False):
    """A cylinder or a cone that is cut off at both ends."""

    # Radii at `from` and `to` [m]; ≥ 0, one > 0.
    radii: Required[Quantities]

    # Middle of the other end [m].
    to: Required[Quantities]


class ContactLawTable(TypedDict, total=False):
    """`[contact_law]`: an own normal law by formulas."""

    # Numbers by name; default none.
    constants: Mapping[str, Float]

    # Dashpot coefficient [N s/m], a formula; default none; not with `D` in `force`.
    damping: str

    # Spring energy [J], a formula; default integrated; needed with `D`.
    energy: str

    # Spring force [N], a formula.
    force: Required[str]

    # Energy dissipated in a step [J], a formula; with `D` in `force`.
    loss: str

    # Name, for `normal` of materials and pairs.
    name: Required[str]


class ContactPoint(TypedDict, total=False):
    """A contact-point bond."""

    # Normal stiffness [N/m]; > 0.
    normal_stiffness: Required[Quantity]

    # Largest shear force [N]; default unbreakable; > 0.
    shear_limit: Quantity

    # Shear stiffness [N/m]; ≥ 0.
    shear_stiffness: Required[Quantity]

    # Largest tension [N]; default unbreakable; > 0.
    tension_limit: Quantity


class Coupling(TypedDict, total=False):
    """DEM–FEM coupling."""

    # Direction that contact faces look in; default `[0, 0, 1]`.
    direction: Floats

    # Geometry of ground faces; default `"curved"`, with polyhedra `"flat"`.
    faces: FacesName

    # Name of the `[[material]]` of the surface.
    material: Required[str]

    # Largest angle between normals and `direction` [rad]; default `"75 deg"`; > 0, ≤ π.
    max_angle: Quantity

    # Largest number of passes, then the best; default 20; 2–1000; with `"iterated"`.
    max_passes: Integer

    # Coupling scheme; default `"predicted"`.
    scheme: SchemeName

    # DEM steps (as the first) in a window, or stable number up to 20; default 10; or `window`; 1–1000.
    substeps: Substeps

    # Implicitness: 0.5 conserves energy, 1 backward Euler; default by contacts (0.5–0.633), 0.6 with meshed sleepers; 0.5–1.
    theta: Float

    # Relative change of surface velocity at convergence; default 1e-4; > 0, < 1; with `"iterated"`.
    tolerance: Float

    # Load transfer at points, or over discs; default `"point"`.
    transfer: Transfer

    # Length of a coupling window [s]; or `substeps`; > 0.
    window: Quantity


class CycleJump(TypedDict, total=False):
    """`[track.jump]`: cycles that are not simulated one by one."""

    # Cycles before the first jump; default 100; ≥ 10, ≥ `measure` + 2, < `cycles`.
    first: Integer

    # Largest jump over preceding cycles, the first a quarter; default 1; > 0, ≤ 10.
    largest: Float

    # Cycles of a measured rate (`"extrapolate"`: a tenth of all or more); default 10; ≥ 2.
    measure: Integer

    # Method; default `"extrapolate"`; `"displace"` not with bonds, periodic axes, plastic solid, meshed sleepers.
    method: JumpMethod

    # Largest mean relative change of overlaps; default 0.5; > 0, ≤ 2; with `"displace"`.
    overlap: Float

    # Cycles after a jump without measured rate; default 3; with `"displace"`.
    settle: Integer

    # Relative error below which jumps double, else halve; default 0.02; > 0, ≤ 10.
    tolerance: Float


class Deposition(TypedDict, total=False):
    """`[deposition]`: the filled grains fall and come to rest before the main stage."""

    # Friction between grains: lower packs denser; default unchanged; ≥ 0.
    friction: Float

    # Equal parts dropped successively, `max_time` each; default 1; 1–1000.
    layers: Integer

    # Height above which centres are removed afterwards [m]; default none.
    level: Quantity

    # Non-viscous damping, above 0.4 with shorter steps; default 0; ≥ 0, < 1.
    local_damping: Float

    # Longest duration, then a warning [s]; > 0.
    max_time: Required[Quantity]

    # Root-mean-square speed at rest [m/s]; default 0.005; > 0.
    settled_speed: Quantity

    # Factor on contact stiffness, not corner strength; default 1; > 0, ≤ 1.
    stiffness_factor: Float

    # Mean unbalanced over contact force at rest, for or with `settled_speed`; default none; > 0, < 1.
    unbalanced_ratio: Float


class Dip(TypedDict, total=False):
    """Dipped joint: two parabolas that meet in a kink of 8 `depth`/`length`."""

    # Position from the first sleeper [m].
    at: Required[Quantity]

    # Depth [m]; > 0.
    depth: Required[Quantity]

    # Length [m]; > 0.
    length: Required[Quantity]


class Direct(TypedDict, total=False):
    """A bond by its own stiffnesses and strengths."""

    # Criterion of breakage; default `"stress"`.
    criterion: CriterionName

    # List: tension, shear [N/m], bending, twisting [N m/rad]; > 0 (tension), ≥ 0.
    stiffness: Required[Floats]

    # List: tension, shear [N], bending, twisting moment [N m]; default unbreakable; > 0.
    strength: Floats


# `from`: Start [s]; ≥ 0.
_DisplacementControl = TypedDict("_DisplacementControl", {"from": "Quantity"})


class DisplacementControl(_DisplacementControl, total=False):
    """Displacement control of a servo wall: the platen of a compression test after confinement."""

    # Speed along the direction of pressing [m/s].
    speed: Required[Quantity]


class Dynamics(TypedDict, total=False):
    """`[solid.dynamics]`: Newmark's method, or that of Hilber, Hughes and Taylor, for a solid that runs alone."""

    # Whether conditionally stable constants are accepted; default false.
    accept_conditional_stability: Bool

    # Newmark's β; default 0.25.
    beta: Float

    # Newmark's γ; default 0.5.
    gamma: Float

    # α of Hilber–Hughes–Taylor, instead of Newmark's; default none; −1/3 – 0.
    hht_alpha: Float


class Equations(TypedDict, total=False):
    """`[solid.equations]`: how the equations of an elastic solid are solved."""

    # Solver; default `"auto"`.
    method: EquationMethod

    # Whether the factor lies on disk, in `TMPDIR` (`/tmp`); default false; with `"mumps"`.
    out_of_core: Bool

    # Preconditioned residual over right-hand side; default 1e-8; 1e-13 – 1e-4.
    tolerance: Float


class Events(TypedDict, total=False):
    """`[events]`: how breaks of bonds are joined to acoustic events."""

    # Largest distance of breaks in an event [m]; ≥ 0.
    distance: Required[Quantity]

    # Longest time between breaks in an event [s]; ≥ 0.
    time: Required[Quantity]


class Excitation(TypedDict, total=False):
    """Forces of an uneven rail: Σ M a w² sin wt with w = 2πv/L."""

    # Unsprung axle mass M [kg]; > 0.
    mass: Required[Quantity]

    # Waves `[[L, a], …]` [m]; > 0 (L).
    waves: Required[Rows]


class FaceTable(TypedDict, total=False):
    """A bond that fills a face; its contact acts beside it."""

    # Criterion of breakage; default `"stress"`.
    criterion: CriterionName

    # Friction angle of the shear strength [rad]; default 0; ≥ 0, < 90°; with `shear_strength`.
    friction_angle: Quantity

    # Shear strength, cohesion with `friction_angle` [Pa]; default unbreakable; ≥ 0.
    shear_strength: Quantity

    # Normal over shear stiffness; default 2.5; > 0.
    stiffness_ratio: Float

    # Tensile or flexural strength [Pa]; default unbreakable; ≥ 0.
    tensile_strength: Quantity

    # Young's modulus [Pa]; > 0.
    young: Required[Quantity]


class FillBox(TypedDict, total=False):
    """Where filled grains start."""

    # Upper corner `[x, y]` [m].
    high: Required[Quantities]

    # Lower corner `[x, y, z]` [m].
    low: Required[Quantities]


class Floes(TypedDict, total=False):
    """A field of ice floes: prisms from the Voronoi cells of random sites in a box, each made smaller about its centroid; or round ones."""

    # Circles `[[x, y, r], …]` without floes [m]; default none; ≥ 0 (r).
    clear: Rows

    # Floe area before rounding over field area, disks without `clear`; or `gap`; > 0, < 1 (disks 0.75).
    concentration: Float

    # Number of Voronoi cells; 1–100,000; with `"polyhedron"`.
    count: Integer

    # Height of the mid-plane [m]; default 0.
    elevation: Quantity

    # Distance between neighbours [m]; or `concentration`; > 0; with `"polyhedron"`.
    gap: Quantity

    # Upper corner `[x, y]` [m]; > `low`.
    high: Required[Quantities]

    # Lower corner `[x, y]` of the field [m].
    low: Required[Quantities]

    # Rounding radius, of disks half thickness [m]; > 0; with `"polyhedron"`.
    radius: Quantity

    # Moves to cell centroids: uniform floes; default 0; 0–10,000; with `"polyhedron"`.
    relax: Integer

    # Thickness [m]; > 2 `radius`, of disks < smallest diameter.
    thickness: Required[Quantity]


# `from`: Middle of one end [m].
_Frustum = TypedDict("_Frustum", {"from": "Quantities"})


class Frustum(_Frustum, total=False):
    """A frustum with regular ends."""

    # Mean of inscribed, circumscribed radius at `from`, `to` [m]; > 0.
    radii: Required[Quantities]

    # Rounding radius of edges [m]; default tenth of smaller; > 0, < half the length.
    radius: Quantity

    # Number of sides; default 24; 6–32.
    sides: Integer

    # Middle of the other end [m].
    to: Required[Quantities]


class GradationSource(TypedDict, total=False):
    """A row set of a gradation table."""

    # CSV file: `standard`, `grade`, `sieve_mm`, `passing_lo_pct`, `passing_hi_pct`; limits averaged.
    file: Required[File]

    # Value of that column, likewise.
    grade: Required[str]

    # Factor on sieve sizes; default 1; > 0.
    scale: Float

    # Value of that column, without regard to blanks, dashes, case.
    standard: Required[str]


class GrainMaterial(TypedDict, total=False):
    """`[[material]]`: contact by a linear spring and dashpot, or after Hertz and Mindlin where materials have a Young's modulus, unless `normal` names another law; with Coulomb friction."""

    # Friction μₐ of asperities in μ + μₐ/(1 + F/(p R²)); default 0; ≥ 0; with `"linear"`, `corner_strength`.
    asperity_friction: Float

    # Pressure p of it: force over R², with `corner_strength` over πR² [Pa]; > 0; with `asperity_friction`.
    asperity_pressure: Quantity

    # Half cone angle of corners [rad]; > 0, < 90°; with `corner_strength`.
    corner_angle: Quantity

    # Pressure at which corners crush [Pa]; default none; > 0, < limit by modulus, angle; with `young`.
    corner_strength: Quantity

    # Density [kg/m³]; > 0; needed for grains.
    density: Quantity

    # Factor on edge stiffness, 3.14 for line contact; default 1; 0.01–100; with `young`.
    edge_factor: Float

    # Friction coefficient μ, at large forces; ≥ 0.
    friction: Float

    # Name, each once.
    name: Required[str]

    # Normal law, see `[[contact]]`; default by `young`, `corner_strength`, `stiffness`.
    normal: str

    # Poisson's ratio; > −1, ≤ 0.5; with `young`.
    poisson: Float

    # Coefficient of restitution; 0.0001–1; shorter steps if small.
    restitution: Float

    # Largest rolling moment over R F; default 0; ≥ 0.
    rolling_friction: Float

    # Normal stiffness of two of this material [N/m]; default rigid; > 0.
    stiffness: Quantity

    # Spread of `young` or `stiffness` over the grains; default none.
    stiffness_spread: GrainStiffnessSpread

    # Tangential over normal dashpot; default 0; 0–1.
    tangential_damping_ratio: Float

    # Tangential over normal stiffness, linear law; default 0.5; 0–1.
    tangential_ratio: Float

    # Largest twisting moment over R F; default 0; ≥ 0.
    twisting_friction: Float

    # Young's modulus, of Hertzian laws [Pa]; default none; > 0.
    young: Quantity


class GrainStiffnessSpread(TypedDict, total=False):
    """Spread of stiffness over the grains of each group, in 16 classes of equal number."""

    # Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    deviation: Float

    # Distribution.
    kind: Required[SpreadKind]

    # Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    modulus: Float

    # Random seed; default 1.
    seed: Integer


class Grains(TypedDict, total=False):
    """`[[grains]]`: a group of grains."""

    # Whether initial overlaps may exceed 10 % of a radius; default false.
    accept_overlap: Bool

    # Thickness over diameter; > 0, < 1; with `"disk"`; not with `floes`.
    aspect: Float

    # Name of a `[[bond]]`; default none; with `"bonded"` (needed), polyhedral `floes`, `net`.
    bond: str

    # Number of grains; or `solid_fraction`, `target_height`, `target_mass`; 1–10,000,000; with `fill`, `region`, only an `inlet`
    # (queue); optional with `growth`.
    count: Integer

    # Box with a contact-free stack up to 200 m; or another source.
    fill: FillBox

    # Field of ice floes; or another source.
    floes: Floes

    # Whether grains are fines in voids, for the summary; default false.
    fouling: Bool

    # Pile or cone, a polyhedron; or another source.
    frustum: Frustum

    # Sieve table; or `size`, `sizes`; with `fill`, `region`, only an `inlet`, floes of disks.
    gradation: GradationSource

    # Radius expansion to a porosity; default none; with `region`.
    growth: GrowthSource

    # Insertion during the run; default none.
    inlet: Inlet

    # Regular packing of spheres; or another source.
    lattice: LatticeFill

    # Stone library; with `"clump"`, `"bonded"`, `"polyhedron"`; not with `floes`, `frustum`.
    library: File

    # Name of a `[[material]]` with density.
    material: Required[str]

    # Name in reports.
    name: Required[str]

    # Net or geogrid of bonded spheres; or another source.
    net: Net

    # CSV file as of `output.packing`; or another source; columns `x, y, z, r` or `x, y, z, qw, qx, qy, qz, scale, stone` (disks:
    # diameter, 0).
    packing: File

    # Expected porosity of the settled bed; default 0.4, more between walls; > 0, < 1; with `fill`.
    porosity: Float

    # Without rotation, 0 during deposition [m/s]; default free.
    prescribed_velocity: Quantities

    # Whether mean position and force are recorded; default true with `prescribed_velocity`.
    record: Bool

    # Container with grains at random; or another source.
    region: Region

    # Seed of sizes, positions, orientations; default 1.
    seed: Integer

    # Shape (and sources).
    shape: Required[GrainShape]

    # Smallest and largest size, uniform in number [m]; or `gradation`; > 0.
    size: Quantities

    # Law of sizes; or `gradation`.
    sizes: Sizes

    # Solid fraction, 0.3 at random positions; or `count`; > 0, < 1; with `region`; not with `growth`.
    solid_fraction: Float

    # Spheres `[[x, y, z, r], …]` [m]; or another source; > 0 (r).
    spheres: Rows

    # Initial angular velocity [rad/s]; default none; not with `prescribed_velocity`.
    spin: Quantities

    # Expected height of the settled bed above its floor [m]; or `count`; > 0, ≤ 200; with `fill`.
    target_height: Quantity

    # Total mass, met within one grain [kg]; or `count`; > 0; with `fill`.
    target_mass: Quantity

    # Initial velocity [m/s]; default at rest; not with `prescribed_velocity`.
    velocity: Quantities


class GrowthSource(TypedDict, total=False):
    """Growth of grains to a porosity."""

    # Friction meanwhile: more packs looser; default 0; ≥ 0.
    friction: Float

    # Final porosity of the container; > 0, < 1; `count` scales sizes.
    porosity: Required[Float]

    # Growth steps, each relaxed; default 20; 1–1000.
    rounds: Integer

    # Final unbalanced over contact force, means; default 1e-3; > 0, < 1.
    unbalanced_ratio: Float


class Hanging(TypedDict, total=False):
    """Sleeper over a void."""

    # Height by which its seats are too low for the rail [m]; > 0, ≤ 50 mm.
    gap: Required[Quantity]

    # Number of the sleeper, from 1.
    sleeper: Required[Integer]


class Hazard(TypedDict, total=False):
    """Statistics of the horizontal load on a structure: exceedance, peaks with a fitted law, loads of return periods, warning levels."""

    # Load of the amber warning [N]; default none; > 0.
    amber: Quantity

    # Confidence of the intervals; default 0.9; > 0, < 1.
    confidence: Float

    # Time in ice per year [s]; > 0; with `return_periods`.
    exposure: Quantity

    # Law of the peaks; default `"weibull"`.
    law: PeakLaw

    # Level ice whose load is the reference; default none.
    level_ice: LevelIce

    # Ascending loads whose exceedance is recorded [N]; default none; > 0.
    loads: Quantities

    # Load of the red warning [N]; default none; > `amber`.
    red: Quantity

    # Return periods in years; default none; > 0; with `exposure`.
    return_periods: Floats

    # Shortest time below the threshold between two peaks [s]; default 0; ≥ 0.
    separation: Quantity

    # Beginning of the statistics [s]; default 0; ≥ 0.
    start: Quantity

    # Load above which peaks are fitted [N]; > 0.
    threshold: Required[Quantity]


class History(TypedDict, total=False):
    """A dimensionless factor as a function of time."""

    # Number of periods, then 0; default unlimited; with `"sine"`, `"haversine"`.
    cycles: Float

    # Rise time [s]; > 0; with `"ramp"`.
    duration: Quantity

    # CSV file `time, factor`, header optional (`time [ms]`) [s]; or `points`; with `"table"`.
    file: File

    # Frequency [Hz]; > 0; with `"sine"`, `"haversine"`.
    frequency: Quantity

    # Factor on the load.
    kind: Required[HistoryKind]

    # Points `[[time, factor], …]`, ascending [s]; or `file`; with `"table"`.
    points: Rows

    # Time before which it is 0 [s]; default 0.
    start: Quantity


class HullForm(TypedDict, total=False):
    """Ship of beam `width` in level ice, for its resistance after Lindqvist (1989)."""

    # Draught [m]; > 0.
    draught: Required[Quantity]

    # Waterline from the centre plane [rad]; > 0, < π/2.
    entrance_angle: Required[Quantity]

    # Length of the waterline [m]; > 0.
    length: Required[Quantity]

    # Speed [m/s]; ≥ 0.
    speed: Required[Quantity]

    # Stem from the horizontal [rad]; > 0, < π/2.
    stem_angle: Required[Quantity]

    # Young's modulus of the ice [Pa]; > 0.
    young: Required[Quantity]


class InitialStress(TypedDict, total=False):
    """`[solid.initial_stress]`: stress that the solid has before the run."""

    # Horizontal over vertical stress without material `k0`; ≥ 0; with `"k0"`.
    k0: Float

    # Layers `[[top, density], …]` downwards, needed for different densities [m, kg/m³]; or `surface`; with `"k0"`.
    layers: Rows

    # Whether loads at time 0 take part and stay; default false; not under grains.
    loads: Bool

    # Method.
    method: Required[InitialStressMethod]

    # Steps to equilibrium; default 10; 1–10,000.
    steps: Integer

    # Stress `[xx, yy, zz, xy, yz, zx]`, tension positive [Pa]; with `"uniform"`.
    stress: Quantities

    # Surface of ground of one density [m]; default mesh top; with `"k0"`.
    surface: Quantity


class Inlet(TypedDict, total=False):
    """`inlet` of a `[[grains]]`: where and how fast grains of the group are inserted during the main stage."""

    # Box `[low, high]` of contact-free positions, wider than a grain [m].
    box: Required[Rows]

    # Grain rate [1/s]; or `rate`; > 0.
    grains_per_second: Quantity

    # Mass rate [kg/s]; or `grains_per_second`; > 0.
    rate: Quantity

    # Time of the first insertion [s]; default 0; ≥ 0.
    start: Quantity

    # Time of the last insertion [s]; default none; > `start`.
    stop: Quantity

    # Velocity of inserted grains, without spin [m/s]; default at rest.
    velocity: Quantities


class Irregularity(TypedDict, total=False):
    """`[track.rail.irregularity]`: height of the running surface, the sum of all that is given."""

    # Dipped joints; default none.
    dips: Sequence[Dip]

    # CSV file `position, height` [m] from the first sleeper, level beyond; default none.
    file: File

    # Waves a sin 2πx/L as `[[L, a], …]` [m]; default none; > 0 (L).
    waves: Rows


class Last(TypedDict, total=False):
    """Last part of a run, with frames of its own."""

    # Number of its frames; 1–100,000 with `frames`.
    frames: Required[Integer]

    # Length of that part [s]; > 0, < duration.
    time: Required[Quantity]


class LatticeFill(TypedDict, total=False):
    """Equal spheres on a lattice."""

    # Numbers of columns, rows, layers; or `high`.
    counts: Integers

    # Upper corner of the box [m]; or `counts`.
    high: Quantities

    # Packing, and its porosity.
    kind: Required[LatticeKind]

    # Lower corner of the box [m].
    low: Required[Quantities]

    # Diameter [m]; > 0.
    size: Required[Quantity]


class Layer(TypedDict, total=False):
    """A layer of one material."""

    # Material number.
    material: Required[Integer]

    # Height of the top [m]; needed except in the last.
    top: Quantity


class LevelIce(TypedDict, total=False):
    """Level ice: crushing with `strength`, bending on a cone with `flexural_strength`, or on a ship with `hull` too."""

    # Slope of the cone from the horizontal [rad]; > 0, < π/2; with `flexural_strength`, not `hull`.
    angle: Quantity

    # Density of the ice [kg/m³]; > 0; with `flexural_strength`.
    density: Quantity

    # Flexural strength [Pa]; or `strength`; > 0.
    flexural_strength: Quantity

    # Friction of ice on cone or hull; ≥ 0; with `flexural_strength`.
    friction: Float

    # Ship, after Lindqvist; default none; with `flexural_strength`, not `angle`.
    hull: HullForm

    # Thickness of the ridden-up ice [m]; default `thickness`; ≥ 0; with `angle`.
    ride_up: Quantity

    # Strength coefficient of crushing after ISO 19906 [Pa]; or `flexural_strength`; > 0.
    strength: Quantity

    # Ice thickness [m]; > 0.
    thickness: Required[Quantity]

    # Width at the top of the cone [m]; ≥ 0, < `width`; with `angle`.
    top_width: Quantity

    # Width at the waterline [m]; > 0.
    width: Required[Quantity]


class ListLayout(TypedDict, total=False):
    """Keys of a scene for the lists."""

    # Columns of the element list; default `"auto"`.
    columns: ElementColumns

    # Material number without such a column; default 1.
    material: Integer


class Measure(TypedDict, total=False):
    """`[[measure]]`: a box whose packing is measured at the end of the main stage, with `history` during it."""

    # Box `[low, high]` [m].
    box: Required[Rows]

    # Whether `history.csv` has porosity, coordination number, mean stress; default false.
    history: Bool

    # Name in the summary.
    name: Required[str]

    # Radial distribution function, to `radial.csv`; default none.
    radial: Radial


class Mount(TypedDict, total=False):
    """Springs and dashpots that hold a body, along x, y, z. Each is given by its constants or by what the body's mass makes of them."""

    # Damping along x, y, z [N s/m]; default 0; ≥ 0.
    damping: Quantities

    # Ratios ζ of damping 2ζ √(k m); or `damping`; ≥ 0.
    damping_ratio: Floats

    # Frequencies f of stiffness m (2πf)² [Hz]; or `stiffness`; ≥ 0.
    frequency: Quantities

    # Stiffness along x, y, z, 0 along held axes [N/m]; or `frequency`; ≥ 0.
    stiffness: Quantities


class Net(TypedDict, total=False):
    """Rectangular meshes of spheres along ribs. Groups of equal meshes, place and bond form one net. Sides: `"start"`, `"end"` along; `"left"`, `"right"` across."""

    # Vector of the second side [m]; with meshes across.
    across: Quantities

    # Vector of the first side [m].
    along: Required[Quantities]

    # Corner between `"start"` and `"left"` [m].
    corner: Required[Quantities]

    # Numbers of meshes along and across; ≥ 1, ≥ 0 (0: one strand).
    meshes: Required[Integers]

    # Sides that the group consists of; default all spheres.
    only: Sequence[NetSide]

    # Radius of spheres [m]; > 0, ≤ half their distance.
    radius: Required[Quantity]

    # Spheres per rib, one node included; default 1; 1–100.
    spheres_per_rib: Integer

    # Sides left out; default none.
    without: Sequence[NetSide]


class Newton(TypedDict, total=False):
    """`[solid.newton]`: how equilibrium is found in a plastic solid."""

    # Whether a line search shortens iterations; default true.
    line_search: Bool

    # Largest number of iterations; default 50 full, 60 modified, 400 initial, 100 strength reduction; 1–10,000.
    max_iterations: Integer

    # Solver of unsymmetric equations (dilation below friction); default `"auto"`.
    solver: LinearSolver

    # Residual over largest force; default 1e-5 quasi-static, 1e-3 strength reduction, else 1e-6; 1e-12 – 0.01.
    tolerance: Float

    # Matrix of the iteration; default `"full"`.
    variant: NewtonVariant


class Oscillation(TypedDict, total=False):
    """Sine in time."""

    # Amplitude a [m]; > 0.
    amplitude: Required[Quantity]

    # Direction.
    direction: Required[Floats]

    # Frequency f [Hz]; > 0.
    frequency: Required[Quantity]

    # Phase φ [rad]; default 0.
    phase: Quantity


class Outlet(TypedDict, total=False):
    """`[[outlet]]`: grains whose centre gets there are taken out."""

    # Box `[low, high]` that removes centres inside [m]; or `point`.
    box: Rows

    # Names of removed groups; default all without `prescribed_velocity`.
    groups: Sequence[str]

    # Name in reports; default `outlet<number>`, from 0.
    name: str

    # Normal towards removed grains; with `point`.
    normal: Floats

    # Point of a plane that removes centres beyond [m]; or `box`.
    point: Quantities

    # Whether removed grains queue at their inlet; default false.
    recycle: Bool


class Output(TypedDict, total=False):
    """What a run writes."""

    # Contacts in frames; default `"all"`; with `[[grains]]`.
    chains: Chains

    # Wall time between checkpoints, for `--resume` [s]; default `"10 min"`; > 0.
    checkpoint: Quantity

    # Fields in frames, see below; default unmarked.
    fields: Sequence[str]

    # Steps between frames; or `frames`; ≥ 1; with `grain_step`, `solid_step`.
    frame_steps: Integer

    # Frames of the run, after the first; default 20; 0–100,000.
    frames: Integer

    # Times of additional frames, each at the end of the nearest step [s]; default none; > 0, ≤ duration.
    frames_at: Quantities

    # Whether each load cycle has an additional frame at its largest load; default false; with `[track.load]`, not with `"beam"`.
    frames_at_peaks: Bool

    # Interval of `history.csv`, rows within 64 steps shorten them [s]; default duration/1000; > 0.
    history_interval: Quantity

    # Steps between rows; or `history_interval`; ≥ 1; with `grain_step`, `solid_step`.
    history_steps: Integer

    # Separate frames of the last part; default none; not with `[track.jump]`.
    last: Last

    # Whether `packing.csv` (`packing_0.csv`, … by group) is written; default false.
    packing: Bool

    # Whether `end.state` is written, for `run --from`; default true; with `[[grains]]`.
    state: Bool

    # Whether `nodes.csv`, `gauss.csv` are written; default false; with `[solid]`.
    tables: Bool

    # Whether `tecplot/` is written; default false; with `[solid]`.
    tecplot: Bool

    # Whether `results.pvd`, `frames/` are written; default true.
    vtk: Bool

    # Whether `grains.vtkhdf`, `solid.vtkhdf` are written; default false.
    vtkhdf: Bool


class PairContact(TypedDict, total=False):
    """`[[contact]]`: constants of one pair of materials."""

    # Work of adhesion w, force 2π w R in contact [J/m²]; default 0; ≥ 0; not with boxes, bonds, rigid bodies.
    adhesion: Quantity

    # Names of the two materials.
    between: Required[Sequence[str]]

    # Damping; default `"restitution"`; not with `"walton_braun"`.
    damping: DampingKind

    # Damping ratio C/(2 √(m* K)); ≥ 0; with `"ratio"`.
    damping_ratio: Float

    # Friction coefficient; default the smaller; ≥ 0.
    friction: Float

    # Normal law, `"linear"` and others; default by materials.
    normal: str

    # Coefficient of restitution; default the smaller; 0.0001–1; not with `"none"`.
    restitution: Float

    # Rolling resistance; default `"spring"`.
    rolling: Resistance

    # Coefficient of `rolling`; default the smaller; ≥ 0.
    rolling_friction: Float

    # Normal stiffness [N/m]; default mixed; > 0; with `"linear"`, `"walton_braun"`.
    stiffness: Quantity

    # Tangential law, `"none"` or others; default by normal law.
    tangential: str

    # Twisting resistance; default `"spring"`.
    twisting: Resistance

    # Coefficient of `twisting`; default the smaller; ≥ 0.
    twisting_friction: Float


class Parallel(TypedDict, total=False):
    """A parallel bond."""

    # Criterion of breakage; default `"stress"`.
    criterion: CriterionName

    # Friction angle of the shear strength [rad]; default 0; ≥ 0, < 90°; with `shear_strength`.
    friction_angle: Quantity

    # Bending moment fraction in the tensile stress; default 1; 0–1.
    moment_factor: Float

    # Normal stiffness per area [Pa/m]; or `young`; > 0.
    normal_stiffness: Float

    # Disc radius over smaller sphere radius; default 1; > 0.
    radius_factor: Float

    # Shear stiffness per area [Pa/m]; ≥ 0; with `normal_stiffness`.
    shear_stiffness: Float

    # Shear strength, cohesion with `friction_angle` [Pa]; default unbreakable; ≥ 0.
    shear_strength: Quantity

    # Normal over shear stiffness; default 1; > 0; with `young`.
    stiffness_ratio: Float

    # Tensile strength [Pa]; default unbreakable; ≥ 0.
    tensile_strength: Quantity

    # Young's modulus: stiffness per area times length [Pa]; or `normal_stiffness`; > 0.
    young: Quantity


class Periodic(TypedDict, total=False):
    """`[periodic]`: lower and upper border [m] of the axes along which the grains repeat themselves."""

    # Borders `[low, high]` along x [m]; default not periodic.
    x: Quantities

    # Borders `[low, high]` along y [m]; default not periodic.
    y: Quantities

    # Borders `[low, high]` along z [m]; default not periodic.
    z: Quantities


class Plate(TypedDict, total=False):
    """A rigid plate that presses."""

    # Mass [kg]; > 0.
    mass: Required[Quantity]

    # Name of a `[[material]]`.
    material: Required[str]

    # Edge lengths [m]; > 0.
    size: Required[Quantities]


class Probe(TypedDict, total=False):
    """What is observed in `history.csv`: a node or point of the solid, an area or a box in it, a grain, a group, or the grains in a box."""

    # Point of the undeformed solid, without `fields` its nearest node [m]; or `node`.
    at: Quantities

    # Box `[low, high]` of the undeformed solid: mean, largest vertical and mean stress [m]; or `node`.
    box: Rows

    # Fields of a node or point, with the values of frames; default displacement, velocity; with `node`, `at`, `line`.
    fields: Sequence[ProbeField]

    # Index of a grain, from 0: position, velocity, spin, mean stress; or `node`.
    grain: Integer

    # Name of a group: number, means of these; or `node`.
    group: str

    # From, to: equally spaced points of the undeformed solid, `<name>_1`, … [m]; or `node`.
    line: Rows

    # Header of columns; default `n<number>`, `point`, `line`, `plane`, `box`, `grain<number>`, group, `region`.
    name: str

    # Number of a node of the solid; or `at`, `line`, `plane`, `box`, `grain`, `group`, `region`.
    node: Integer

    # Horizontal rectangle `[low, high]` in the undeformed solid: mean, largest vertical stress [m]; or `node`.
    plane: Rows

    # Points of the `line`; default 11; 2–1000; with `line`.
    points: Integer

    # Box `[low, high]`: number, means of centres inside [m]; or `node`.
    region: Rows


class Propulsion(TypedDict, total=False):
    """Prescribed thrust, and a rudder."""

    # Propeller diameter, for its race [m]; default none; > 0; with `rudder`.
    diameter: Quantity

    # Direction at the start; default `[1, 0, 0]`.
    direction: Floats

    # Factors `[[time, factor], …]`, linear between [s]; default 1.
    history: Rows

    # Propeller at the start [m].
    point: Required[Quantities]

    # Rudder; default none; not with vertical `direction`.
    rudder: Rudder

    # Thrust [N]; none above water.
    thrust: Required[Quantity]


class Pulses(TypedDict, total=False):
    """Haversines on top of the force of a servo: force · (1 + (peak − 1) (1 − cos 2πf(t − start))/2)."""

    # Number of pulses; 1–1,000,000.
    count: Required[Integer]

    # Frequency [Hz]; > 0.
    frequency: Required[Quantity]

    # Largest factor; ≥ 0.
    peak: Required[Float]

    # Time of the first [s]; default 0; ≥ 0.
    start: Quantity


class Push(TypedDict, total=False):
    """`[track.push]`: a ram pushes a sleeper sideways when the cycles are over."""

    # Direction in plan `[x, y]`, not held.
    direction: Required[Floats]

    # Actuator displacement [m]; > 0.
    displacement: Required[Quantity]

    # Height above the sleeper's centre [m]; default 0.
    height: Quantity

    # Vertical force on the sleeper, besides weight [N]; default 0; ≥ 0.
    load: Quantity

    # Preceding time, in which force becomes `load` [s]; default 0.1; ≥ 0.
    rest: Quantity

    # Actuator speed [m/s]; > 0.
    speed: Required[Quantity]

    # Actuator stiffness (0.7 of critical damping), limited by the step [N/m]; default `"20 MN/m"`; > 0.
    stiffness: Quantity


class QuasiStatic(TypedDict, total=False):
    """`[solid.quasi_static]`: equilibrium at every step of a pseudo-time, in which loads and supports vary."""

    # Fraction of `solid_step` at which the run stops; default 1/1024; 1e-9 – 1.
    smallest_step: Float

    # Iterations above which the next step is shorter; default 40; 2–1000.
    target_iterations: Integer


class Radial(TypedDict, total=False):
    """`radial = { reach = …, bins = … }` of a measure."""

    # Shells of equal width; 1–100,000.
    bins: Required[Integer]

    # Largest distance, with periodic images [m]; > 0, ≤ half the shortest side.
    reach: Required[Quantity]


class RailTable(TypedDict, total=False):
    """The rail."""

    # Bending stiffness EI of one rail [N m²]; > 0.
    bending_stiffness: Required[Quantity]

    # Elements between sleepers; default 4; 1–100; with `"beam"`.
    elements: Integer

    # Rail beyond outer sleepers, load rising over two spacings [m]; ≥ three spacings; with `"beam"`.
    extension: Quantity

    # Stiffness of pad and bed, with `"beam"` of outer beds [N/m]; > 0.
    foundation: Required[Quantity]

    # Damping of that bed [N s/m]; default 0; ≥ 0; with `"beam"`.
    foundation_damping: Quantity

    # Sleepers that the rail lifts off the bed with the ramp; default none; with `"beam"`.
    hanging: Sequence[Hanging]

    # Uneven running surface; default even; with `"vehicle"`.
    irregularity: Irregularity

    # Model of the rail.
    kind: Required[RailKind]

    # Mass of one rail [kg/m]; > 0; with `"beam"`.
    mass: Quantity

    # Damping of a pad, limited by the step [N s/m]; default 0; ≥ 0; with `"beam"`.
    pad_damping: Quantity

    # Stiffness of a pad, limited by the step [N/m]; > 0; with `"beam"`.
    pad_stiffness: Quantity


class Rayleigh(TypedDict, total=False):
    """`solid.rayleigh`: Rayleigh damping, by its coefficients or by a damping ratio at two frequencies."""

    # Mass coefficient α [1/s]; default 0; ≥ 0.
    alpha_m: Quantity

    # Stiffness coefficient β [s]; default 0; ≥ 0.
    beta_k: Quantity

    # Damping ratio; or `alpha_m`, `beta_k`; ≥ 0, < 1.
    damping_ratio: Float

    # Two rising frequencies [Hz]; > 0; with `damping_ratio`.
    frequencies: Quantities


class Reduction(TypedDict, total=False):
    """`[solid.reduction]`: an elastic solid under grains is stepped in the span of a few shapes."""

    # Basis of the model.
    kind: Required[ReductionKind]

    # Natural modes; default 60; ≤ 2000 with static shapes, ≤ half the dofs.
    modes: Integer


class Region(TypedDict, total=False):
    """A container: one of its keys."""

    # Box `[low, high]` [m]; or `cone`, `surface`.
    box: Rows

    # Cylinder or cut cone; or `box`.
    cone: ConeRegion

    # Factor on coordinates; default 1; > 0; with `surface`.
    scale: Float

    # Shift after scaling [m]; default none; with `surface`.
    shift: Quantities

    # File of a closed surface, or mesh; or `box`.
    surface: File


class Rudder(TypedDict, total=False):
    """Rudder with the normal force of Fujii & Tuda (1961), without stall."""

    # Area [m²]; > 0.
    area: Required[Float]

    # Squared height over area; default 1.5; > 0.
    aspect_ratio: Float

    # Angles to port `[[time, angle], …]`, linear between [s, rad]; −π/2 to π/2.
    history: Required[Rows]

    # Position at the start [m].
    point: Required[Quantities]


class Runout(TypedDict, total=False):
    """`[runout]`: how far a slide runs and what it leaves."""

    # Cell of the depth map [m]; default twice mean diameter; > 0.
    cell: Quantity

    # Smallest depth of the deposit [m]; default half mean diameter; > 0.
    depth: Quantity

    # Direction in plan `[x, y]`.
    direction: Required[Floats]

    # Names of sliding groups; default all without `prescribed_velocity`.
    groups: Sequence[str]

    # Whether cells that grains pass are written to `passage.csv`; default false; with `cell`.
    passage: Bool

    # Mass fraction behind the front; default 0.99; 0.5–1.
    share: Float


class Scarring(TypedDict, total=False):
    """Ground that polyhedra and disks scar: soil over hard ground."""

    # Decay of that distance without contact [1/s]; default 185; ≥ 0.
    decay: Float

    # Soil density [kg/m³]; default 1700; ≥ 0.
    density: Quantity

    # Soil drag coefficient; default 2.5; ≥ 0.
    drag: Float

    # Initial and final friction; default `[0.55, 2]`; ≥ 0, rising.
    friction: Floats

    # Growth of friction with sliding distance [1/m]; default 3; ≥ 0.
    growth: Float

    # Mechanical strength of the soil [Pa]; > 0.
    strength: Required[Quantity]


class SeatLoad(TypedDict, total=False):
    """Vertical load on the sleepers' tops, or wheels on the rail."""

    # Axle load, all rails together [N]; > 0; with `"bogie"`, `"train"` (default table).
    axle_load: Quantity

    # Distances behind the first pulse, ascending from 0 [m]; default `[0]`; with `"gauss"`.
    axles: Quantities

    # Number of cars; default 1; 1–1000; with `"train"`, `"vehicle"`.
    cars: Integer

    # Cycles or passes; default 1; ≥ 1; needed with `"sine"`, `"haversine"`.
    cycles: Integer

    # Uneven rail: Σ M a w² sin wt, w = 2πv/L; default none; with `"bogie"`, `"train"`.
    excitation: Excitation

    # Factor on the force, not 0; default 1; with `"history"`.
    factor: Float

    # Fall time [s]; default stays; > 0; with `"ramp"`.
    fall: Quantity

    # CSV file `time, force` [s, N], header optional; for `"train"`, `"vehicle"` a table; with `"history"`, `"train"`,
    # `"vehicle"`.
    file: File

    # Frequency f [Hz]; > 0; with `"sine"`, `"haversine"`.
    frequency: Quantity

    # Time at the maximum [s]; ≥ 0; with `"ramp"`.
    hold: Quantity

    # Kind of cycle.
    kind: Required[SeatLoadKind]

    # Largest downward force, or pulse [N]; > `minimum`; with `"sine"`, `"haversine"`, `"ramp"`, `"gauss"`.
    maximum: Quantity

    # Smallest downward force, negative pulls [N]; with `"sine"`, `"haversine"`, `"ramp"` (default 0).
    minimum: Quantity

    # Time to reach first load and rail weight [s]; default 0.1; ≥ 0.
    ramp: Quantity

    # Time at rest, before the rail is laid [s]; default 0.1; ≥ 0.
    rest: Quantity

    # Rise time [s]; > 0; with `"ramp"`.
    rise: Quantity

    # Pulses before the first cycle; default none.
    seating: SeatingTable

    # Rail seats `[[x, y], …]` from the centre, with equal force [m]; default centre.
    seats: Rows

    # Part of its weight on the modelled rails; default 1; > 0, ≤ 1; 0.5 for half a track; with `"vehicle"`.
    share: Float

    # Speed along the track [m/s]; > 0; with `"gauss"`, `"bogie"`, `"train"`, `"vehicle"`, `"history"` (default infinite).
    speed: Quantity

    # Name of the train; with `"train"`.
    train: str

    # Name of the vehicle; with `"vehicle"`.
    vehicle: str

    # Axle distance [m]; > 0; with `"bogie"`.
    wheelbase: Quantity

    # Half width ℓ of a pulse at 1/e [m]; > 0; with `"gauss"`.
    width: Quantity


class SeatingTable(TypedDict, total=False):
    """`[track.load.seating]`: pulses from the load of the first instant to `maximum` and back."""

    # Number of pulses; 1–1,000,000.
    cycles: Required[Integer]

    # Frequency [Hz]; > 0.
    frequency: Required[Quantity]

    # Largest downward force on each sleeper [N]; > first load.
    maximum: Required[Quantity]


class Servo(TypedDict, total=False):
    """Drive that holds a force."""

    # Area of `pressure` [m²]; > 0; with `pressure`.
    area: Float

    # Direction of pressing; default plane normal.
    direction: Floats

    # Constant speed after a time, in place of the force.
    displacement_control: DisplacementControl

    # Target force [N]; or `pressure`.
    force: Quantity

    # Gain, smaller against oscillation; default 0.5; > 0, ≤ 1.
    gain: Float

    # Factors on the force `[[time, factor], …]`, linear between [s]; default 1; or `pulses`.
    history: Rows

    # Largest speed, rising by a tenth per step [m/s]; > 0.
    max_speed: Required[Quantity]

    # Target pressure [Pa]; or `force`.
    pressure: Quantity

    # Haversine factors from 1 to `peak`; or `history`.
    pulses: Pulses


class Sleeper(TypedDict, total=False):
    """Sleepers as boxes, rigid or meshed, placed on the settled grains."""

    # Direction of the track; default `"y"`.
    along: Along

    # Position `[x, y]` of the first centre [m].
    centre: Required[Quantities]

    # Number of sleepers; default 1; 1–1000.
    count: Integer

    # Fixed motions, meshed `["y", "rx", "rz"]`, `["x", "ry", "rz"]` or both; default none.
    hold: Sequence[Motion]

    # Mass of the modelled part [kg]; or `mesh.density`; > 0.
    mass: Quantity

    # Name of a `[[material]]`.
    material: Required[str]

    # Elastic sleepers; default rigid.
    mesh: SleeperMesh

    # Edge lengths in x, y, z [m]; > 0.
    size: Required[Quantities]

    # Distance of centres [m]; > width; with `count`, `[track.rail]`.
    spacing: Quantity


class SleeperMesh(TypedDict, total=False):
    """`[track.sleeper.mesh]`: 20-node hexahedra of which each sleeper consists."""

    # Density [kg/m³]; or `mass`; > 0.
    density: Quantity

    # Elements along x, y, z; ≥ 1 (reduced: two ≥ 2), ≤ 100,000 in all.
    elements: Required[Integers]

    # Area `[x, y]` that spreads the force of a seat, within edges [m]; default 0.15 across track, full width along; ≥ 0.
    foot: Quantities

    # Poisson's ratio; > −1, < 0.5.
    poisson: Required[Float]

    # Young's modulus [Pa]; > 0.
    young: Required[Quantity]


class Solid(TypedDict, total=False):
    """`[solid]`: a mesh, its materials, supports and loads, and how it is solved. The mesh comes from `mesh` (any mesh file), from `nodes` and `elements` (ANSYS lists), or from `block`."""

    # Absorbing boundaries.
    absorbing: Sequence[Absorbing]

    # Generated hexahedra; or `mesh`.
    block: Block

    # Constraint list `node direction value` (1, 2, 3, `UX`, `UY`, `UZ`, `ALL`; value 0 if absent) [m]; default none; with
    # `nodes`.
    constraints: File

    # Volumetric strain of quadratic elements; default `"pointwise"`.
    dilatation: Dilatation

    # Time integration; or `quasi_static`, `strength_reduction`.
    dynamics: Dynamics

    # Element list `id material n1 … n20`, SOLID186 order; with `nodes`.
    elements: File

    # Solver of elastic solids; default by size.
    equations: Equations

    # Whether gravity acts on the solid; default true.
    gravity: Bool

    # Whether 8-node hexahedra have bending modes; default true.
    incompatible_modes: Bool

    # Initial stress; default none.
    initial_stress: InitialStress

    # Integration rule; default `"reduced"`.
    integration: Integration

    # Columns of the lists; default recognised.
    layout: ListLayout

    # Loads.
    load: Sequence[SolidLoad]

    # Mass matrix; default `"consistent"`.
    mass: Mass

    # Materials.
    material: Sequence[SolidMaterial]

    # Mesh file (`.cdb`, `.msh`, `.inp`, `.vtu`, `.vtk`), or directory of the three lists; or `nodes`, `block`.
    mesh: File

    # Iteration of plastic solids.
    newton: Newton

    # Node list `id x y z` [m]; or `mesh`.
    nodes: File

    # Order of elements; default of the mesh.
    order: Order

    # Equilibrium in steps; or `dynamics`.
    quasi_static: QuasiStatic

    # Rayleigh damping; default none.
    rayleigh: Rayleigh

    # Reduced model under grains; default none.
    reduction: Reduction

    # Boxes with another material than in the mesh; default none.
    region: Sequence[SolidRegion]

    # Factor from file lengths to metres, displacements too; default 1; > 0 (0.001 for mm).
    scale: Float

    # Factor of safety; or `dynamics`.
    strength_reduction: StrengthReduction

    # Supports.
    support: Sequence[Support]


class SolidLoad(TypedDict, total=False):
    """A load on the solid."""

    # Point of the solid [m]; or `node`; with `"point"`.
    at: Quantities

    # Distances behind the first axle, ascending from 0 [m]; default `[0]`; with `"moving"`.
    axles: Quantities

    # Faces `[[element, face], …]`, numbered as SOLID186; or `faces_in`, `side`, `set`; with `"pressure"`, `"traction"`.
    faces: IntegerRows

    # Box `[low, high]` of face centres [m]; or `faces`.
    faces_in: Rows

    # Force vector, with `"moving"` of each axle [N]; with `"point"`, `"moving"`.
    force: Quantities

    # Time history; default constant.
    history: History

    # Kind of load.
    kind: Required[SolidLoadKind]

    # Node number; or `at`; with `"point"`.
    node: Integer

    # Start and end of the line on the solid [m]; with `"moving"`.
    path: Rows

    # Pressure, compression positive [Pa]; with `"pressure"`.
    pressure: Quantity

    # Face set, or node set around faces; or `faces`.
    set: str

    # Side of the bounding box; or `faces`.
    side: Side

    # Length and width that spread the force [m]; default a point; with `"moving"`.
    size: Quantities

    # Speed along `path` [m/s]; > 0; with `"moving"`.
    speed: Quantity

    # Time at which the first axle enters [s]; default 0; with `"moving"`.
    start: Quantity

    # Traction vector [Pa]; with `"traction"`.
    traction: Quantities


# `lambda`: Slope of normal compression over ln p; > `kappa`; with `"modified_cam_clay"`.
_SolidMaterial = TypedDict("_SolidMaterial", {"lambda": "Float"}, total=False)


class SolidMaterial(_SolidMaterial, total=False):
    """`[[solid.material]]`: one for each material number of the mesh."""

    # Cohesion c [Pa]; ≥ 0, > 0 without friction; with `"mohr_coulomb"`, `"drucker_prager"`.
    cohesion: Quantity

    # Meridian shared with Mohr–Coulomb; with `"drucker_prager"`.
    cone: Cone

    # Critical stress ratio M, 6 sin φ/(3 − sin φ) in compression; > 0, < 3; with `"modified_cam_clay"`.
    critical_ratio: Float

    # Density [kg/m³]; > 0.
    density: Required[Quantity]

    # Dilation angle [rad]; 0 – `friction`; with `"mohr_coulomb"`, `"drucker_prager"`.
    dilation: Quantity

    # Friction angle φ [rad]; 0–80°; with `"mohr_coulomb"`, `"drucker_prager"`.
    friction: Quantity

    # Friction angle `[[strain, angle], …]`; or `friction`; with `"mohr_coulomb"`, `"drucker_prager"`.
    friction_table: Rows

    # Strength slope over plastic strain, softening to 1 % [Pa]; default 0; with all but elastic, clay.
    hardening: Quantity

    # Strength over plastic strain `[[strain, Pa], …]`; or `cohesion`, `yield_stress`.
    hardening_table: Rows

    # Material number.
    id: Required[Integer]

    # Horizontal over vertical initial stress; default of `initial_stress`; ≥ 0.
    k0: Float

    # Slope of swelling lines over ln p; > 0; with `"modified_cam_clay"`.
    kappa: Float

    # Lower bound of pressure in stiffness and p_c [Pa]; default 1 kPa; > 0; with `"modified_cam_clay"`.
    minimum_pressure: Quantity

    # Yield criterion; default `"elastic"`.
    model: MaterialModel

    # Name in reports; default `material <id>`.
    name: str

    # p_c over the ellipse of the initial stress; or `preconsolidation`; ≥ 1; with `"modified_cam_clay"`.
    overconsolidation: Float

    # Poisson's ratio; or `shear_modulus` (clay); > −1, < 0.5.
    poisson: Float

    # Initial preconsolidation pressure p_c [Pa]; or `overconsolidation`; > 0; with `"modified_cam_clay"`.
    preconsolidation: Quantity

    # Constant shear modulus [Pa]; or `poisson`; > 0; with `"modified_cam_clay"`.
    shear_modulus: Quantity

    # Tension cut-off: principal, with `"drucker_prager"` mean stress [Pa]; default apex; 0 – c cot φ; with `"mohr_coulomb"`,
    # `"drucker_prager"`.
    tension: Quantity

    # Routine of a shared library; with `"umat"`.
    umat: UserTable

    # Initial void ratio e₀; > 0; with `"modified_cam_clay"`.
    void_ratio: Float

    # Yield stress in tension [Pa]; > 0; with `"von_mises"`, `"tresca"`.
    yield_stress: Quantity

    # Young's modulus [Pa]; > 0; not with `"modified_cam_clay"`.
    young: Quantity


class SolidRegion(TypedDict, total=False):
    """`[[solid.region]]`: elements with their centre in a box have another material."""

    # Box `[low, high]` of element centres [m].
    box: Required[Rows]

    # Number of a `[[solid.material]]`.
    material: Required[Integer]


class Specimen(TypedDict, total=False):
    """`[specimen]`: stress and strain of a specimen between two platens."""

    # Cross-section [m²]; > 0; with `"compression"`.
    area: Float

    # Axis of loading; default `"z"`.
    axis: SpecimenAxis

    # Peak stress fractions of the elastic constants; default `[0.2, 0.5]`; 0–1, rising.
    between: Floats

    # Recorded wall, or group with `prescribed_velocity`, at the lower end.
    bottom: Required[str]

    # Groups of the specimen; default all without `prescribed_velocity`.
    groups: Sequence[str]

    # Distance of platens, or disc diameter [m]; > 0.
    length: Required[Quantity]

    # Area of each side [m²]; > 0; with `sides`.
    side_area: Float

    # Recorded walls whose pressure confines; default none.
    sides: Sequence[str]

    # Kind of test.
    test: Required[SpecimenTest]

    # Disc thickness [m]; > 0; with `"brazilian"`.
    thickness: Quantity

    # Recorded wall, or group with `prescribed_velocity`, at the upper end.
    top: Required[str]


class SpreadTable(TypedDict, total=False):
    """Spread of the strengths."""

    # Whether tension and shear share a factor; default false.
    correlated: Bool

    # Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    deviation: Float

    # Distribution.
    kind: Required[SpreadKind]

    # Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    modulus: Float

    # Random seed; default 1.
    seed: Integer


class SpreadTable2(TypedDict, total=False):
    """Size of the discs: one of both."""

    # Radius of the discs [m]; or `spread_factor`; > 0.
    spread: Quantity

    # Radius over mean bounding radius of grains; or `spread`; > 0, ≤ 100.
    spread_factor: Float


class StiffnessSpreadTable(TypedDict, total=False):
    """Spread of the stiffnesses: one factor for all of a bond."""

    # Standard deviation over mean; > 0, ≤ 10; with `"normal"`.
    deviation: Float

    # Distribution.
    kind: Required[SpreadKind]

    # Weibull modulus; > 0.05, ≤ 1000; with `"weibull"`.
    modulus: Float

    # Random seed; default 1.
    seed: Integer


class StrengthReduction(TypedDict, total=False):
    """`[solid.strength_reduction]`: the factor by which cohesion and tan φ can be divided before the solid fails."""

    # Largest trial factor, and reciprocal of the smallest; default 16; > `start`, ≤ 10,000.
    largest: Float

    # First trial factor; default 1; 0.001–1000.
    start: Float

    # Width of the final bracket; default 0.02; 0.0001–10.
    tolerance: Float


class StrengthRegion(TypedDict, total=False):
    """A box in which bonds differ. Of several that hold a bond's middle, all factors apply."""

    # Upper corner [m]; > `low`.
    high: Required[Quantities]

    # Lower corner [m].
    low: Required[Quantities]

    # Factor on their stiffness; default 1; > 0.
    stiffness: Float

    # Factor on strength of bonds with middle inside; default 1; > 0.
    strength: Float


class Structure(TypedDict, total=False):
    """`[[structure]]`: walls and groups of grains that stand for one structure; the load on it goes to `history.csv`, whole, by sectors around a vertical axis, and by height."""

    # Position `[x, y]` of the fixed axis [m].
    axis: Required[Quantities]

    # Height that moments refer to [m]; default 0.
    foot: Quantity

    # Statistics of the horizontal load, warning levels; default none.
    hazard: Hazard

    # Ascending heights between layers [m]; default none.
    levels: Quantities

    # Prefix of columns, each once.
    name: Required[str]

    # Names of groups and walls (planes recorded); at most one rigid body.
    parts: Required[Sequence[str]]

    # Sectors of equal angle, from x towards y; default 0; 0–360.
    sectors: Integer


class Support(TypedDict, total=False):
    """`[[solid.support]]`: nodes whose displacement is given. Exactly one of `side`, `nodes_in`, `set` and `node` chooses them."""

    # Fixed directions, of `"x"`, `"y"`, `"z"`.
    directions: Required[Sequence[str]]

    # Displacement in each direction [m]; default 0.
    displacement: Quantity

    # Time history; default constant.
    history: History

    # Name of the recorded reaction sum; default not recorded.
    name: str

    # Node number; or `side`.
    node: Integer

    # Box `[low, high]` of nodes [m]; or `side`.
    nodes_in: Rows

    # Node set of the mesh; or `side`.
    set: str

    # Side of the bounding box; or `nodes_in`, `set`, `node`.
    side: Side


class TimeControl(TypedDict, total=False):
    """Time steps and duration."""

    # Whether `grain_step` may exceed the limit; default false; with `grain_step`.
    accept_step_above_limit: Bool

    # Duration of the main stage [s]; default end of cycles or push; > 0; not with a static solid.
    end: Quantity

    # Interval between checks of inlets, outlets [s]; default 1 ms; > 0.
    flow_interval: Quantity

    # Fixed DEM time step, within the limit of possible contacts [s]; default follows contacts; > 0, ≤ 10¹² steps.
    grain_step: Quantity

    # Fraction of the critical time step, below 0.8 for collisions too; default 0.8; 1e-6 – 1; not with `grain_step`.
    grain_step_fraction: Float

    # Impact speed of the step limit, larger under loads [m/s]; default from motion, fall, weight; ≥ 0; with `young`.
    impact_speed: Quantity

    # Factor on inertia at constant weight, for quasi-static results; default 1; 1–10,000; not with `[wind]`, `[water]`,
    # `[runout]`, inlets, outlets, `scarring`, `mount`, rail mass.
    mass_factor: Float

    # Neighbour cut-off over mean sphere radius, affects speed only; default 0.2; 0.01–2.
    search_skin: Float

    # FEM time step without `[[grains]]` [s]; > 0, ≤ `end`, ≤ 10⁹ steps; with `dynamics`, `quasi_static`.
    solid_step: Quantity

    # Number of FEM steps, with grains DEM steps; or `end`; 1–10¹²; with `solid_step`, `grain_step`; rounded up to whole windows.
    steps: Integer


class Tines(TypedDict, total=False):
    """`[compaction.tines]`: pairs of blades that enter beside a lifted sleeper and press the stones below it."""

    # Amplitude A of A sin 2πft along the track [m]; ≥ 0.
    amplitude: Required[Quantity]

    # Positions of the pairs from the centre of a sleeper, across the track [m].
    at: Required[Quantities]

    # Depth of the tips below the base of the lifted sleeper [m].
    depth: Required[Quantity]

    # Force at which a blade closes no further, but vibrates [N]; default none; > 0.
    force: Quantity

    # Distance of a blade from the sleeper before it closes [m]; > `travel` + `amplitude`.
    gap: Required[Quantity]

    # Time closed, before the blades leave [s]; default 0.1; ≥ 0.
    hold: Quantity

    # Speed of insertion [m/s]; default 1; > 0.
    insertion: Quantity

    # Lift of the sleeper [m]; ≥ 0.
    lift: Required[Quantity]

    # Name of a `[[material]]`.
    material: Required[str]

    # Width across the track, thickness along it, length of a blade [m]; > 0.
    size: Required[Quantities]

    # Speed of lift and of closing [m/s]; default 0.1; > 0.
    squeeze: Quantity

    # Longest way of a blade towards the sleeper [m]; > 0.
    travel: Required[Quantity]


class Track(TypedDict, total=False):
    """`[track]`: what stands on the ballast."""

    # Two loads between which bed stiffness is evaluated [N]; default 25 %, 75 % of range; with cycles.
    bed_stiffness: Quantities

    # Extrapolated cycles.
    jump: CycleJump

    # Forces or wheels.
    load: SeatLoad

    # Lateral push.
    push: Push

    # Rail on the seats.
    rail: RailTable

    # Sleepers.
    sleeper: Required[Sleeper]


class UserState(TypedDict, total=False):
    """State variable of a routine."""

    # Initial value; default 0.
    initial: Float

    # Name; `state_NAME` in `gauss.csv`.
    name: Required[str]

    # Unit of the column; default none.
    unit: str


class UserTable(TypedDict, total=False):
    """`[solid.material.umat]`: routine of a shared library by the interface UMAT of Abaqus."""

    # PROPS [SI units]; default none; at most 1000.
    constants: Floats

    # Stored and dissipated energy; default `"reference"`.
    energy: EnergySource

    # Shared library.
    library: Required[str]

    # Symbol of the routine; default `"umat_"`.
    routine: str

    # STATEV; default none; at most 1000.
    states: Sequence[UserState]

    # Tangent of the law; default `"library"`.
    tangent: TangentSource

    # Threads that call the routine simultaneously; default `"one"`.
    threads: RoutineThreads


class Wall(TypedDict, total=False):
    """`[[walls]]`: a plane, a round shape, or triangles."""

    # Angular velocity, of planes along the normal [rad/s]; default none.
    angular_velocity: Quantities

    # Direction to the second end; default up; with `"cylinder"`, `"cone"`.
    axis: Floats

    # Middle of the first end, or of the sphere [m]; with `"cylinder"`, `"cone"`, `"sphere"`.
    base: Quantities

    # Rigid body; default none; not with motions, `servo`, `"plane"`.
    body: Body

    # Whether discs close the ends; default `[false, false]`; with `"cylinder"`, `"cone"`.
    caps: Sequence[Bool]

    # Centre of rotation at the start [m]; default `point`, `base`, middle of vertices; with `angular_velocity`.
    centre: Quantities

    # File of a surface, terrain or mesh; with `"mesh"`.
    file: File

    # Distance of the ends [m]; > 0 (`"cone"` ≥ 0); with `"cylinder"`, `"cone"`.
    height: Quantity

    # Shape.
    kind: Required[WallKind]

    # Name of a `[[material]]`.
    material: Required[str]

    # Name in `history.csv`; default `wall<number>`, from 0.
    name: str

    # Normal towards grains; with `"plane"`.
    normal: Floats

    # Displacement a (sin(2πft + φ) − sin φ); default none.
    oscillation: Oscillation

    # Point of the plane [m]; with `"plane"`.
    point: Quantities

    # Radii of both ends [m]; ≥ 0; with `"cone"`.
    radii: Quantities

    # Radius [m]; > 0; with `"cylinder"`, `"sphere"`.
    radius: Quantity

    # Whether force, moment, displacement go to `history.csv`; default false.
    record: Bool

    # Factor on file lengths; default 1; > 0; with `"mesh"`.
    scale: Float

    # Ground that grains penetrate; default none; with `"triangles"`, `"mesh"`; not with motions, `servo`, `body`.
    scarring: Scarring

    # Servo-controlled force; default none; not with motions, `body`.
    servo: Servo

    # Shift after scaling [m]; default none; with `"mesh"`.
    translation: Quantities

    # Vertex indices `[[a, b, c], …]`, from 0; with `"triangles"`.
    triangles: IntegerRows

    # Velocity [m/s]; default at rest.
    velocity: Quantities

    # Vertices `[[x, y, z], …]` [m]; with `"triangles"`.
    vertices: Rows


class Water(TypedDict, total=False):
    """`[water]`: water below a level, still, streaming or with waves; grains float, sink and drift in it, while they settle too."""

    # Added mass over wet volume's, translation only (sphere 0.5); default 0; 0–100.
    added_mass: Float

    # Velocity `[x, y]` of the current [m/s]; default `[0, 0]`; ≤ 20.
    current: Quantities

    # Density (sea water 1025) [kg/m³]; default 1000; > 0, ≤ 20,000.
    density: Quantity

    # Depth that waves feel, without bed [m]; default deep; > 0; with `wave`.
    depth: Quantity

    # Drag coefficient on `drag_area` (floes 0.6); 0–100.
    drag: Required[Float]

    # Drag area; default `"projected"`.
    drag_area: DragArea

    # Coefficient of the moment against rotation; default 0.1; 0–100.
    drag_moment: Float

    # Level of still water [m]; default 0.
    level: Quantity

    # Drag coefficient of the wet surface (ice 0.001–0.005); default 0; 0–100.
    skin_drag: Float

    # Linear (Airy) wave; default none.
    wave: Wave


class Wave(TypedDict, total=False):
    """Regular waves."""

    # Direction, from x to y [rad]; default 0.
    direction: Quantity

    # Height from trough to crest [m]; > 0, ≤ 0.142 L tanh kh.
    height: Required[Quantity]

    # Wavelength L [m]; or `period`; > 0.
    length: Quantity

    # Period at a fixed position [s]; or `length`; > 0.
    period: Quantity

    # Phase at origin and start, 0 crest [rad]; default 0.
    phase: Quantity


class Wind(TypedDict, total=False):
    """`[wind]`: a fluid with one velocity everywhere, which drags grains along or holds them back during the main stage."""

    # Density of the fluid [kg/m³]; default 1.225; > 0, ≤ 20,000.
    density: Quantity

    # Drag coefficient C, sphere of equal volume; > 0, ≤ 100.
    drag: Required[Float]

    # Velocity of the fluid [m/s]; default `[0, 0, 0]`; ≤ 1000.
    velocity: Quantities


class SceneTables(TypedDict, total=False):
    """A whole scene."""

    # Bonds between grains.
    bond: Sequence[BondTable]

    # Stages of compaction.
    compaction: Sequence[Compaction]

    # Constants of material pairs.
    contact: Sequence[PairContact]

    # Own contact law by formulas.
    contact_law: ContactLawTable

    # Coupling of grains and solid.
    coupling: Coupling

    # Deposition under gravity.
    deposition: Deposition

    # Acoustic events of bond breaks.
    events: Events

    # Groups of grains.
    grains: Sequence[Grains]

    # Gravity [m/s²]; default `[0, 0, -9.81]`.
    gravity: Quantities

    # Files with tables used where the scene has none; paths relative to it.
    include: Sequence[File]

    # Contact materials.
    material: Sequence[GrainMaterial]

    # Boxes of packing measurements.
    measure: Sequence[Measure]

    # Removal of grains.
    outlet: Sequence[Outlet]

    # Written files.
    output: Output

    # Periodic axes of grains.
    periodic: Periodic

    # Nodes, grains, boxes in `history.csv`.
    probe: Sequence[Probe]

    # Run-out of a slide.
    runout: Runout

    # Finite element model.
    solid: Solid

    # Stress and strain between platens.
    specimen: Specimen

    # Structures with recorded loads.
    structure: Sequence[Structure]

    # Duration and time steps.
    time: TimeControl

    # Title of the summary; default file name.
    title: str

    # Sleepers, load and rail; default none.
    track: Track

    # Walls and rigid bodies.
    walls: Sequence[Wall]

    # Water with waves.
    water: Water

    # Uniform flow of a fluid.
    wind: Wind


# A law of sizes.
Sizes = Union[SizesMonodisperse, SizesBidisperse, SizesUniform, SizesNormal, SizesLogNormal]


# Substeps
Substeps = Union[Integer, Literal["auto"]]


# Transfer
Transfer = Union[Literal["point"], SpreadTable2]
