//! Columns of the result tables: name, unit and meaning, defined once for recorders and readers.

use std::fmt::{self, Display, Formatter};

/// Axes of the columns of a vector.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Components of the columns of a symmetric tensor.
const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// Number of columns of a definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One column.
    Scalar,
    /// Three columns with `_x`, `_y` and `_z` behind the name.
    Vector,
    /// Six columns with `_xx`, `_yy`, `_zz`, `_xy`, `_yz` and `_zx` behind the name.
    Tensor,
    /// Any number of columns with 0, 1, … behind the name.
    List,
}

/// Columns of one quantity: a scalar, a vector or a list.
#[derive(Debug)]
pub struct Definition {
    /// Name with the kind of item in angle brackets, such as `<wall>_force`. `<_n>` is `_1`, `_2`, … of several sleepers, else empty.
    pub name: &'static str,
    /// SI unit; empty for a count or a ratio without one.
    pub unit: &'static str,
    /// Meaning, at most 12 words.
    pub meaning: &'static str,
    /// Number of columns.
    pub kind: Kind,
}

impl Definition {
    /// Name of the columns of an item, such as the wall `plate`.
    pub fn of<'a>(&'static self, item: &'a str) -> Name<'a> {
        Name { definition: self, item, part: None }
    }

    /// Name of a component, without an item.
    pub fn at(&'static self, part: usize) -> Name<'static> {
        self.of("").at(part)
    }

    /// Text before, in and behind the angle brackets.
    fn parts(&self) -> [&'static str; 3] {
        let (before, rest) = self.name.split_once('<').unwrap_or((self.name, ">"));
        let (item, after) = rest.split_once('>').unwrap_or((rest, ""));
        [before, item, after]
    }
}

/// Name of a column in a table.
#[derive(Clone, Copy, Debug)]
pub struct Name<'a> {
    definition: &'static Definition,
    item: &'a str,
    part: Option<usize>,
}

impl From<&'static Definition> for Name<'_> {
    fn from(definition: &'static Definition) -> Self {
        definition.of("")
    }
}

impl Name<'_> {
    /// Name of a component: of a vector by axis, of a tensor or a list by number.
    pub fn at(self, part: usize) -> Self {
        Name { part: Some(part), ..self }
    }

    /// Name of the component of a vector along `x`, `y` or `z`.
    pub fn along(self, axis: &str) -> Option<Self> {
        AXES.iter().position(|known| *known == axis).map(|k| self.at(k))
    }

    /// Unit of the column.
    pub fn unit(&self) -> &'static str {
        self.definition.unit
    }

    /// Item of the column `head`, empty without one; `None` if the column is of another definition.
    pub fn item_in<'h>(&self, head: &'h str) -> Option<&'h str> {
        let [before, kind, after] = self.definition.parts();
        let head = match (self.definition.kind, self.part) {
            (Kind::Vector, Some(axis)) => head.strip_suffix(AXES[axis])?.strip_suffix('_')?,
            (Kind::Tensor, Some(part)) => head.strip_suffix(COMPONENTS[part])?.strip_suffix('_')?,
            (Kind::List, Some(number)) => head.strip_suffix(&number.to_string())?,
            _ => head,
        };
        let item = head.strip_prefix(before)?.strip_suffix(after)?;
        let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        let fits = match kind {
            "" => item.is_empty(),
            "_n" => item.is_empty() || item.strip_prefix('_').is_some_and(digits),
            _ => true,
        };
        fits.then_some(item)
    }
}

impl Display for Name<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [before, _, after] = self.definition.parts();
        write!(f, "{before}{}{after}", self.item)?;
        match (self.definition.kind, self.part) {
            (Kind::Vector, Some(axis)) => write!(f, "_{}", AXES[axis]),
            (Kind::Tensor, Some(part)) => write!(f, "_{}", COMPONENTS[part]),
            (Kind::List, Some(number)) => write!(f, "{number}"),
            _ => Ok(()),
        }
    }
}

/// Result table.
pub struct Table {
    /// File name.
    pub file: &'static str,
    /// Columns in their order.
    pub columns: &'static [&'static Definition],
}

/// Tables that runs write.
pub const TABLES: [&Table; 16] = [
    history::TABLE,
    cycles::TABLE,
    push::TABLE,
    gradation::TABLE,
    radial::TABLE,
    breaks::TABLE,
    events::TABLE,
    outline::TABLE,
    fragments::TABLE,
    origins::TABLE,
    passage::TABLE,
    nodes::TABLE,
    gauss::TABLE,
    safety::TABLE,
    modes::TABLE,
    element::TABLE,
];

/// Lists the columns of all tables: file, name, unit and meaning.
pub fn list() -> String {
    let name = |column: &Definition| match column.kind {
        Kind::Scalar => column.name.to_string(),
        Kind::Vector => format!("{}_x, _y, _z", column.name),
        Kind::Tensor => format!("{}_xx, ..., _zx", column.name),
        Kind::List => format!("{}0, 1, ...", column.name),
    };
    let lines = TABLES.iter().flat_map(|table| table.columns.iter().map(|column| (table.file, *column)));
    lines.map(|(file, c)| format!("{file:<14} {:<38} {:<6} {}\n", name(c), c.unit, c.meaning)).collect()
}

/// Defines the columns of a file: constant, kind, name, unit, meaning.
macro_rules! columns {
    ($file:literal; $($constant:ident: $kind:ident $name:literal $unit:literal $meaning:literal;)*) => {
        use super::{Definition, Kind, Table};
        $(
            #[doc = $meaning]
            pub const $constant: &Definition =
                &Definition { name: $name, unit: $unit, meaning: $meaning, kind: Kind::$kind };
        )*
        /// The file and its columns.
        pub const TABLE: &Table = &Table { file: $file, columns: &[$($constant),*] };
    };
}

/// Columns of `history.csv`.
pub mod history {
    columns! { "history.csv";
        TIME: Scalar "time" "s" "time since the start of the main stage";
        LOAD: Scalar "load<_n>" "N" "force on the rail seats, downwards";
        SLEEPER: Vector "sleeper<_n>" "m" "centre of the sleeper";
        SLEEPER_TILT: Scalar "sleeper<_n>_tilt" "rad" "angle between axis of the sleeper and vertical";
        SLEEPER_SEATS: Scalar "sleeper<_n>_seats" "m" "uplift of the rail seats of a meshed sleeper";
        SLEEPER_BEND: Scalar "sleeper<_n>_bend" "m" "uplift of the ends of a meshed sleeper over its middle";
        SLEEPER_CONTACT: Vector "sleeper<_n>_contact" "N" "force of the grains on a meshed sleeper";
        CONTACT_FORCE_ON_SOLID: Vector "contact_force_on_solid" "N"
            "force of the grains on the solid, mean of a coupling window";
        PEAK_FORMATION_PRESSURE: Scalar "peak_formation_pressure" "Pa" "largest normal force over area of a face";
        GRAINS_KINETIC: Scalar "grains_kinetic" "J" "kinetic energy of the grains";
        CONTACT_SPRINGS: Scalar "contact_springs" "J" "elastic energy of the contacts";
        GRAINS_GRAVITY: Scalar "grains_gravity" "J" "potential energy of the grains";
        SOLID_KINETIC: Scalar "solid_kinetic" "J" "kinetic energy of the solid";
        SOLID_STRAIN: Scalar "solid_strain" "J" "strain energy of the solid";
        SOLID_GRAVITY: Scalar "solid_gravity" "J" "potential energy of the solid";
        WORK: Scalar "work" "J" "work of loads and moved bodies since the start";
        DISSIPATED_DASHPOT: Scalar "dissipated_dashpot" "J" "dissipation in the dashpots of contacts";
        DISSIPATED_FRICTION: Scalar "dissipated_friction" "J" "dissipation by friction";
        DISSIPATED_SOLID: Scalar "dissipated_solid" "J"
            "Rayleigh damping, absorbing boundaries, plastic flow and time integration";
        INTERFACE_ERROR: Scalar "interface_error" "J" "difference of the interface work of grains and solid";
        ENERGY_ERROR: Scalar "energy_error" "J" "error of the energy balance";
        RAIL: Scalar "rail<_n>" "m" "deflection of the rail over the sleeper, upwards";
        AXLE_FORCE: Scalar "axle<_n>_force" "N" "force of an axle of the vehicles on the track";
        RAIL_ENERGY: Scalar "rail_energy" "J" "elastic energy of rails, pads and far-field track";
        WHEELS_WORK: Scalar "wheels_work" "J" "work of the wheels and of the rail's weight";
        DISSIPATED_TRACK: Scalar "dissipated_track" "J" "dissipation in pads and far-field track";
        BONDS: Scalar "bonds" "" "unbroken bonds";
        BROKEN_BY_TENSION: Scalar "broken_by_tension" "" "bonds broken by tension or bending";
        BROKEN_BY_SHEAR: Scalar "broken_by_shear" "" "bonds broken by shear or twisting";
        FRAGMENTS: Scalar "fragments" "" "bonded pieces and single grains";
        BOND_ENERGY: Scalar "bond_energy" "J" "elastic energy of the bonds";
        DISSIPATED_BONDS: Scalar "dissipated_bonds" "J" "dissipation in the dashpots of bonds";
        RELEASED_BY_BREAKS: Scalar "released_by_breaks" "J" "energy released by broken bonds";
        GROUP: Vector "<group>" "m" "mean position of a recorded group";
        GROUP_FORCE: Vector "<group>_force" "N" "force of bonds and contacts on a recorded group";
        GROUP_TENSION: Scalar "<group>_tension" "N" "largest tension in the bonds of a recorded net";
        SUPPORT_REACTION: Vector "<support>_reaction" "N" "force of a named support on the solid";
        PROBE_U: Vector "<probe>_u" "m" "displacement of an observed node or point";
        PROBE_V: Vector "<probe>_v" "m/s" "velocity of an observed node or point, or mean of observed grains";
        PROBE_A: Vector "<probe>_a" "m/s2" "acceleration of an observed node or point";
        PROBE_STRESS: Tensor "<probe>_stress" "Pa" "stress at an observed node or point, tension positive";
        PROBE_STRAIN: Tensor "<probe>_strain" "" "strain tensor at an observed node or point, elongation positive";
        PROBE_VERTICAL_STRESS: Scalar "<probe>_vertical_stress" "Pa" "mean vertical stress of an observed area or box, tension positive";
        PROBE_VERTICAL_STRESS_LARGEST: Scalar "<probe>_vertical_stress_largest" "Pa" "vertical stress of largest magnitude of an observed area or box";
        PROBE_GRAINS: Scalar "<probe>_grains" "" "number of observed grains";
        PROBE_X: Vector "<probe>_x" "m" "mean position of observed grains";
        PROBE_SPIN: Vector "<probe>_spin" "rad/s" "mean angular velocity of observed grains";
        PROBE_MEAN_STRESS: Scalar "<probe>_mean_stress" "Pa" "mean stress of observed grains or a box, tension positive";
        PROBE_MEAN_STRESS_LARGEST: Scalar "<probe>_mean_stress_largest" "Pa" "mean stress of largest magnitude in an observed box";
        MEASURE_POROSITY: Scalar "<measure>_porosity" "" "porosity of a measured box";
        MEASURE_COORDINATION: Scalar "<measure>_coordination" "" "mean coordination number of grains in a measured box";
        MOUNT_ENERGY: Scalar "mount_energy" "J" "elastic energy of spring-dashpot supports";
        DISSIPATED_MOUNTS: Scalar "dissipated_mounts" "J" "dissipation in spring-dashpot supports";
        WALL_FORCE: Vector "<wall>_force" "N" "force of grains and other walls on a wall";
        WALL_MOMENT: Vector "<wall>_moment" "N m" "moment of that force about the centre of the wall";
        WALL_TARGET: Scalar "<wall>_target" "N" "target force of a servo-controlled wall, 0 under displacement control";
        WALL_DISPLACEMENT: Vector "<wall>_displacement" "m" "displacement of the centre of the wall";
        WALL_VELOCITY: Vector "<wall>_velocity" "m/s" "velocity of the centre of a floating wall";
        WALL_ROTATION: Vector "<wall>_rotation" "rad" "roll, pitch, heading of a floating wall since the start";
        WALL_WATER: Vector "<wall>_water" "N" "force of the water on a floating wall";
        WALL_WATER_MOMENT: Vector "<wall>_water_moment" "N m" "moment of that force about the centre of the wall";
        WALL_THRUST: Scalar "<wall>_thrust" "N" "thrust on a floating wall";
        WALL_RUDDER: Vector "<wall>_rudder" "N" "force on the rudder of a floating wall";
        WALL_RUDDER_ANGLE: Scalar "<wall>_rudder_angle" "rad" "rudder angle, positive to port";
        GRAINS_PRESENT: Scalar "grains_present" "" "number of grains in the model";
        MASS_PRESENT: Scalar "mass_present" "kg" "mass of the grains in the model";
        GRAINS_IN: Scalar "grains_in" "" "number of grains inserted since the start";
        MASS_IN: Scalar "mass_in" "kg" "mass inserted since the start";
        GRAINS_OUT: Scalar "grains_out" "" "number of grains removed since the start";
        MASS_OUT: Scalar "mass_out" "kg" "mass removed since the start";
        RUNOUT_FRONT: Scalar "runout_front" "m" "position of the front along the direction of the slide";
        RUNOUT_CENTRE: Vector "runout_centre" "m" "centre of mass of the slide";
        RUNOUT_KINETIC: Scalar "runout_kinetic" "J" "kinetic energy of the slide";
        RUNOUT_FASTEST: Scalar "runout_fastest" "m/s" "largest speed of a grain of the slide";
        SPECIMEN_STRAIN: Scalar "specimen_strain" "" "approach of the platens over their distance";
        SPECIMEN_STRESS: Scalar "specimen_stress" "Pa" "stress on the platens, compression positive";
        SPECIMEN_AXIAL_STRAIN: Scalar "specimen_axial_strain" "" "axial strain of the grains, compression positive";
        SPECIMEN_LATERAL_STRAIN: Scalar "specimen_lateral_strain" "" "mean lateral strain of the grains, bulging positive";
        SPECIMEN_CONFINEMENT: Scalar "specimen_confinement" "Pa" "mean pressure on the sides";
        STRUCTURE_MOTION: Vector "<structure>_motion" "m" "displacement of a rigid body";
        STRUCTURE_ACCELERATION: Vector "<structure>_acceleration" "m/s2" "acceleration of a rigid body in the last step";
        STRUCTURE_LOAD: Vector "<structure>_load" "N" "force of the grains on the structure";
        STRUCTURE_LOAD_LEVEL: Scalar "<structure>_load_level" "N" "horizontal component of that force";
        STRUCTURE_LOAD_MOMENT: Vector "<structure>_load_moment" "N m" "moment of that force about the axis at its foot";
        STRUCTURE_SECTOR: List "<structure>_sector" "N" "force on a sector, towards the axis";
        STRUCTURE_LAYER: List "<structure>_layer" "N" "horizontal force on a layer, from below";
    }
}

/// Columns of `cycles.csv`.
pub mod cycles {
    columns! { "cycles.csv";
        CYCLE: Scalar "cycle" "" "number of the load cycle, from 1";
        SETTLEMENT: Scalar "settlement" "m" "settlement of the sleeper since the start of cycle 1";
        RESILIENT_DEFLECTION: Scalar "resilient_deflection" "m" "rise from the lowest position to the end of the cycle";
        SECANT_STIFFNESS: Scalar "secant_stiffness" "N/m" "load range over resilient deflection";
        DISSIPATED_ENERGY: Scalar "dissipated_energy" "J" "work of the load over the cycle";
        PEAK_FORMATION_PRESSURE: Scalar "peak_formation_pressure" "Pa" "largest formation pressure of the cycle";
        RATE: Scalar "rate" "m" "settlement per cycle since the last row";
        BED_STIFFNESS: Scalar "bed_stiffness" "N/m" "loading slope between two loads; 0 if they are not passed";
        TOTAL_SETTLEMENT: Scalar "total_settlement" "m" "settlement since seating began";
        RESILIENT_MODULUS: Scalar "resilient_modulus" "Pa" "pressure range over resilient strain of the bed";
        SIMULATED: Scalar "simulated" "" "cycles simulated, without jumps";
        JUMP_ERROR: Scalar "jump_error" "m" "estimated settlement error of cycle jumps";
        BROKEN_BY_TENSION: Scalar "broken_by_tension" "" "bonds broken by tension or bending since the start";
        BROKEN_BY_SHEAR: Scalar "broken_by_shear" "" "bonds broken by shear or twisting since the start";
        STRESS_PEAK: Scalar "<stress>_peak" "Pa" "value of largest magnitude of a probe's stress in the cycle";
        STRESS_MEAN: Scalar "<stress>_mean" "Pa" "mean of a probe's stress over the cycle";
    }
}

/// Columns of `push.csv`.
pub mod push {
    columns! { "push.csv";
        DISPLACEMENT: Scalar "displacement" "m" "lateral displacement of the sleeper";
        FORCE: Scalar "force" "N" "actuator force";
        UPLIFT: Scalar "uplift" "m" "uplift of the sleeper";
    }
}

/// Columns of `gradation.csv`.
pub mod gradation {
    columns! { "gradation.csv";
        GROUP: Scalar "group" "" "number of the group";
        SIEVE: Scalar "sieve" "m" "sieve size";
        LOWER_LIMIT: Scalar "lower_limit" "" "least mass fraction passing";
        UPPER_LIMIT: Scalar "upper_limit" "" "largest mass fraction passing";
        TARGET: Scalar "target" "" "requested mass fraction passing";
        ACHIEVED: Scalar "achieved" "" "mass fraction passing of the grains";
    }
}

/// Columns of `radial.csv`.
pub mod radial {
    columns! { "radial.csv";
        MEASURE: Scalar "measure" "" "number of the measured box";
        DISTANCE: Scalar "distance" "m" "distance at the middle of the shell";
        G: Scalar "g" "" "radial distribution function";
    }
}

/// Columns of `breaks.csv`.
pub mod breaks {
    columns! { "breaks.csv";
        TIME: Scalar "time" "s" "time of the break";
        BOND: Scalar "bond" "" "number of the bond";
        A: Scalar "a" "" "first grain";
        B: Scalar "b" "" "second grain";
        X: Scalar "x" "m" "middle of the bond";
        Y: Scalar "y" "m" "middle of the bond";
        Z: Scalar "z" "m" "middle of the bond";
        SHEAR: Scalar "shear" "" "1 if broken by shear or twisting, else 0";
        ENERGY: Scalar "energy" "J" "released energy";
    }
}

/// Columns of `events.csv`.
pub mod events {
    columns! { "events.csv";
        TIME: Scalar "time" "s" "time of the first break";
        DURATION: Scalar "duration" "s" "time to the last break";
        X: Scalar "x" "m" "mean position of the breaks, weighted by energy";
        Y: Scalar "y" "m" "mean position of the breaks, weighted by energy";
        Z: Scalar "z" "m" "mean position of the breaks, weighted by energy";
        BREAKS: Scalar "breaks" "" "number of breaks";
        SHEAR: Scalar "shear" "" "number of breaks by shear";
        ENERGY: Scalar "energy" "J" "released energy";
        MAGNITUDE: Scalar "magnitude" "" "magnitude of the event";
    }
}

/// Columns of `outline.csv`.
pub mod outline {
    columns! { "outline.csv";
        LINE: Scalar "line" "" "number of the outline";
        X: Scalar "x" "m" "corner of the outline, deposit on its left";
        Y: Scalar "y" "m" "corner of the outline, deposit on its left";
    }
}

/// Columns of `fragments.csv`.
pub mod fragments {
    columns! { "fragments.csv";
        BODIES: Scalar "bodies" "" "number of bodies of the fragment";
        VOLUME: Scalar "volume" "m3" "volume of its grains";
        MASS: Scalar "mass" "kg" "mass of its grains";
        DIAMETER: Scalar "diameter" "m" "diameter of the sphere of equal volume";
        X: Scalar "x" "m" "centre of mass";
        Y: Scalar "y" "m" "centre of mass";
        Z: Scalar "z" "m" "centre of mass";
    }
}

/// Columns of `origins.csv`.
pub mod origins {
    columns! { "origins.csv";
        ID: Scalar "id" "" "index of the grain";
        X0: Scalar "x0" "m" "position at the start";
        Y0: Scalar "y0" "m" "position at the start";
        Z0: Scalar "z0" "m" "position at the start";
        X: Scalar "x" "m" "position at the end";
        Y: Scalar "y" "m" "position at the end";
        Z: Scalar "z" "m" "position at the end";
        FRAGMENT: Scalar "fragment" "" "number of the fragment";
    }
}

/// Columns of `passage.csv`.
pub mod passage {
    columns! { "passage.csv";
        X: Scalar "x" "m" "middle of the cell";
        Y: Scalar "y" "m" "middle of the cell";
        GROUND: Scalar "ground" "m" "height of the ground; 0 without";
        ENTRIES: Scalar "entries" "" "number of grains that entered the cell";
        ENERGY: Scalar "energy" "J" "largest kinetic energy of a grain in the cell";
        DEPTH: Scalar "depth" "m" "depth of the deposit";
    }
}

/// Columns of `nodes.csv`.
pub mod nodes {
    columns! { "nodes.csv";
        NODE: Scalar "node" "" "number of the node";
        UX: Scalar "ux" "m" "displacement";
        UY: Scalar "uy" "m" "displacement";
        UZ: Scalar "uz" "m" "displacement";
        RX: Scalar "rx" "N" "reaction";
        RY: Scalar "ry" "N" "reaction";
        RZ: Scalar "rz" "N" "reaction";
    }
}

/// Columns of `gauss.csv`, state values of constitutive laws last.
pub mod gauss {
    columns! { "gauss.csv";
        ELEMENT: Scalar "element" "" "number of the element";
        XI: Scalar "xi" "" "local coordinate of the integration point";
        ETA: Scalar "eta" "" "local coordinate of the integration point";
        ZETA: Scalar "zeta" "" "local coordinate of the integration point";
        SXX: Scalar "sxx" "Pa" "stress, tension positive";
        SYY: Scalar "syy" "Pa" "stress, tension positive";
        SZZ: Scalar "szz" "Pa" "stress, tension positive";
        SXY: Scalar "sxy" "Pa" "shear stress";
        SYZ: Scalar "syz" "Pa" "shear stress";
        SZX: Scalar "szx" "Pa" "shear stress";
        EQUIVALENT_PLASTIC_STRAIN: Scalar "equivalent_plastic_strain" "" "equivalent plastic strain of a plastic solid";
        PRECONSOLIDATION_PRESSURE: Scalar "preconsolidation_pressure" "Pa" "state value of modified Cam clay";
        STATE: Scalar "state_<name>" "" "state variable of a user material, with its unit";
        TOTAL_STRAIN: Tensor "total_strain" "" "strain of a user material, with the steps of the initial stress";
        INCREMENTS: Scalar "increments" "" "accepted increments of a user material";
        ELASTIC_ENERGY: Scalar "elastic_energy" "J/m3" "SSE of a user material with energies of the library";
        PLASTIC_DISSIPATION: Scalar "plastic_dissipation" "J/m3" "SPD of a user material with energies of the library";
        CREEP_DISSIPATION: Scalar "creep_dissipation" "J/m3" "SCD of a user material with energies of the library";
    }
}

/// Columns of `safety.csv`.
pub mod safety {
    columns! { "safety.csv";
        FACTOR: Scalar "factor" "" "factor that divides the strength";
        STANDS: Scalar "stands" "" "1 if stable, else 0";
        SHARE_OF_LOAD: Scalar "share_of_load" "" "fraction of the load at the last converged step";
        ITERATIONS: Scalar "iterations" "" "iterations, also of rejected steps";
        LARGEST_DISPLACEMENT: Scalar "largest_displacement" "m" "largest displacement at that fraction";
    }
}

/// Columns of `modes.csv`.
pub mod modes {
    columns! { "modes.csv";
        MODE: Scalar "mode" "" "number of the mode, from 1";
        FREQUENCY: Scalar "frequency" "Hz" "natural frequency";
        RESIDUAL: Scalar "residual" "" "residual of the eigenvalue equation";
        EFFECTIVE_MASS_X: Scalar "effective_mass_x" "kg" "effective modal mass";
        EFFECTIVE_MASS_Y: Scalar "effective_mass_y" "kg" "effective modal mass";
        EFFECTIVE_MASS_Z: Scalar "effective_mass_z" "kg" "effective modal mass";
    }
}

/// Columns of `trackbed element`, one table per test and material; compression positive.
pub mod element {
    columns! { "element tests";
        STEP: Scalar "step" "" "step, 0 at the start";
        AXIAL_STRAIN: Scalar "axial_strain" "" "strain zz";
        VOLUMETRIC_STRAIN: Scalar "volumetric_strain" "" "sum of the normal strains";
        DEVIATORIC_STRAIN: Scalar "deviatoric_strain" "" "square root of 2/3 e : e";
        P: Scalar "p" "Pa" "mean effective stress";
        Q: Scalar "q" "Pa" "square root of 3 J2; negative in axial extension";
        STRESS: Tensor "stress" "Pa" "effective stress";
        STRAIN: Tensor "strain" "" "strain, engineering shear";
        EQUIVALENT_PLASTIC_STRAIN: Scalar "equivalent_plastic_strain" "" "accumulated square root of 2/3 de_p : de_p";
        PLASTIC_WORK: Scalar "plastic_work" "J/m3" "dissipated energy density: plastic work since the start";
        PORE_PRESSURE: Scalar "pore_pressure" "Pa" "excess pore pressure of an undrained test, else 0";
    }
}

/// Columns of `trackbed convert`: packings, force chains and animations.
pub mod converted {
    columns! { "converted tables";
        TIME: Scalar "time" "s" "time of the moment";
        ID: Scalar "id" "" "number of the sphere";
        X: Scalar "x" "m" "centre";
        Y: Scalar "y" "m" "centre";
        Z: Scalar "z" "m" "centre";
        R: Scalar "r" "m" "radius";
        VX: Scalar "vx" "m/s" "velocity";
        VY: Scalar "vy" "m/s" "velocity";
        VZ: Scalar "vz" "m/s" "velocity";
        PART: Scalar "part" "" "group of the sphere";
        I: Scalar "i" "" "first partner of the contact";
        J: Scalar "j" "" "second partner of the contact";
        NORMAL_FORCE: Scalar "normal_force" "N" "normal force";
        TANGENTIAL_FORCE: Scalar "tangential_force" "N" "tangential force";
    }
}
