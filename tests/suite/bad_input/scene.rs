//! Bad input: syntax, solid, coupling, time, output.

use super::*;

#[test]
fn bad_toml() {
    solid()
        .scene("[solid]\n", "[solid\n")
        .refused("scene.toml:3: syntax: found unclosed table, expected `]`");
}

#[test]
fn key_given_twice() {
    solid()
        .scene("poisson = 0.3", "poisson = 0.3\npoisson = 0.2")
        .refused("scene.toml:13: syntax: found duplicate key, expected valid TOML");
}

#[test]
fn unknown_key() {
    solid().scene("poisson", "poison").refused(
        "scene.toml:12: solid.material.0.poison: found the unknown key `poison`, expected `poisson`",
    );
}

#[test]
fn unknown_table() {
    solid()
        .scene("[output]", "[outputs]")
        .refused("scene.toml:23: outputs: found the unknown key `outputs`, expected `output`");
}

#[test]
fn missing_key() {
    solid().scene("young = \"20 MPa\"\n", "").refused(
        "scene.toml:8: solid.material.0.young: found nothing, expected a value for the model `elastic`",
    );
}

#[test]
fn wrong_unit() {
    solid().scene("\"20 MPa\"", "\"20 kg\"").refused(
        "scene.toml:11: solid.material.0.young: found string \"20 kg\", expected a stress in Pa, such as 2e7 or \"20 MPa\"",
    );
}

#[test]
fn wrong_type() {
    solid()
        .scene("poisson = 0.3", "poisson = \"soft\"")
        .refused("scene.toml:12: solid.material.0.poisson: found string \"soft\", expected a number");
}

#[test]
fn vector_of_two() {
    grains_scene()
        .scene("normal = [0, 0, 1]", "normal = [0, 1]")
        .refused("scene.toml:19: walls.0.normal: found a list of 2, expected a list of 3");
}

/// The parser would use three components.
#[test]
fn vector_of_four() {
    grains_scene()
        .scene("normal = [0, 0, 1]", "normal = [0, 0, 1, 5]")
        .refused("scene.toml:19: walls.0.normal: found a list of 4, expected a list of 3");
}

/// The parser would assign list values by position.
#[test]
fn list_instead_of_table() {
    grains_scene()
        .set("deposition=[1.0, 0.005, 0.5, 1, 0.3, 0.0, 1.0]")
        .refused("--set: deposition: found a list, expected a table");
}

#[test]
fn number_instead_of_word() {
    solid()
        .set("solid.integration=14")
        .refused("--set: solid.integration: found a number, expected a word in quotes");
}

#[test]
fn empty_scene() {
    solid()
        .file(SCENE, "title = \"nothing\"\n")
        .refused("scene.toml: scene: found neither [solid] nor [[grains]], expected at least one of them");
}

#[test]
fn override_without_a_value() {
    solid()
        .set("solid.integration")
        .refused("--set: solid.integration: found solid.integration, expected key.path=value");
}

#[test]
fn override_below_a_value() {
    solid()
        .set("title.x=3")
        .refused("--set: title.x: found `title`, which is a value, expected a table there");
}

#[test]
fn override_of_an_absent_entry() {
    solid().set("solid.material.4.young=3").refused(
        "--set: solid.material.4.young: found solid.material.4.young, expected an index below 1, or the name of a table, after `material`",
    );
}

#[test]
fn override_that_appends_a_table() {
    // The list has one table; its own errors follow.
    solid()
        .set("solid.material.1={id=2,name=\"rock\"}")
        .refused("--set: solid.material.1.density: found nothing, expected a value for this key");
    solid().set("solid.material.2={id=2,name=\"rock\"}").refused(
        "--set: solid.material.2: found solid.material.2, expected an index below 1, or the name of a table, after `material`",
    );
    solid()
        .set("outlet.0={name=\"a\"}")
        .refused("--set: outlet: found, but it has no effect without [[grains]]");
    solid().set("solid.material.1=3").refused(
        "--set: solid.material.1: found solid.material.1, expected an index below 1, or the name of a table, after `material`",
    );
}

#[test]
fn override_of_an_unknown_key() {
    solid()
        .set("solid.material.0.yung=1")
        .refused("--set: solid.material.0.yung: found the unknown key `yung`, expected `young`");
}

#[test]
fn override_out_of_range() {
    solid()
        .set("solid.material.0.poisson=0.7")
        .refused("--set: solid.material.0.poisson: found 0.7, expected above -1 and below 0.5");
}

#[test]
fn negative_density() {
    solid()
        .scene("\"2000 kg/m3\"", "-2000")
        .refused("scene.toml:13: solid.material.0.density: found -2000, expected a density above 0");
}

#[test]
fn incompressible_material() {
    solid()
        .scene("poisson = 0.3", "poisson = 0.5")
        .refused("scene.toml:12: solid.material.0.poisson: found 0.5, expected above -1 and below 0.5");
}

#[test]
fn poisson_that_is_not_a_number() {
    solid()
        .scene("poisson = 0.3", "poisson = nan")
        .refused("scene.toml:12: solid.material.0.poisson: found NaN, expected above -1 and below 0.5");
}

#[test]
fn element_without_a_material() {
    solid().field(ELEMENTS, 3, 1, "7").refused(
        "scene.toml:8: solid.material: found no material 7, which element 3 has, expected an entry with this id",
    );
}

#[test]
fn seventh_face() {
    solid()
        .scene("[8, 6]", "[8, 7]")
        .refused("scene.toml:18: solid.load.0.faces: found face 7, expected a SOLID186 face, 1 to 6");
}

#[test]
fn face_of_an_absent_element() {
    solid().scene("[8, 6]", "[80, 6]").refused(
        "scene.toml:18: solid.load.0.faces: found element 80, expected the number of an element of the mesh",
    );
}

#[test]
fn box_without_faces() {
    solid().scene(FACES, "faces_in = [[5, 5, 5], [6, 6, 6]]").refused(
        "scene.toml:18: solid.load.0.faces_in: found no boundary face in the box, expected at least one",
    );
}

#[test]
fn point_load_outside_the_solid() {
    solid()
        .scene(
            "kind = \"pressure\"\npressure = \"10 kPa\"\n",
            "kind = \"point\"\nat = [1, 1, 0.5]\nforce = [0, 0, -1]\n",
        )
        .scene(&format!("{FACES}\n"), "")
        .refused("scene.toml:17: solid.load.0.at: found (1, 1, 0.5), expected a point of the solid");
}

#[test]
fn load_history_without_frequency() {
    solid().scene("pressure = \"10 kPa\"", "pressure = 1e4\nhistory = { kind = \"sine\" }").refused(
        "scene.toml:18: solid.load.0.history.frequency: found nothing, expected a frequency for this kind of history",
    );
}

#[test]
fn probe_at_an_absent_node() {
    solid()
        .scene("node = 1\n", "node = 1000\n")
        .refused("scene.toml:21: probe.0.node: found node 1000, expected the number of a node of the mesh");
}

#[test]
fn unstable_newmark_constants() {
    solid()
        .scene("[[solid.load]]", "[solid.dynamics]\nbeta = 0.1\n\n[[solid.load]]")
        .scene("[output]", "[time]\nend = 0.1\nsolid_step = 0.01\n\n[output]")
        .refused(
            "scene.toml:15: solid.dynamics: found Newmark with beta = 0.1, gamma = 0.5 is not unconditionally stable: \
             it needs gamma >= 0.5 and beta >= 0.25 (0.5 + gamma)^2 = 0.25, expected stable constants",
        );
}

#[test]
fn reduction_without_modes() {
    let key = "reduction = { kind = \"modes\", modes = 0 }\n\n[[solid.material]]";
    coupled()
        .scene("\n[[solid.material]]", key)
        .refused("scene.toml:8: solid.reduction.modes: found 0, expected 1 or more");
}

#[test]
fn reduction_of_a_stressed_solid() {
    let keys = "reduction = { kind = \"surface\" }\ninitial_stress = { method = \"k0\", k0 = 0.5 }\n\n[[solid.material]]";
    coupled().scene("\n[[solid.material]]", keys).refused(
        "scene.toml:8: solid.reduction: found together with [solid.initial_stress], expected only one of them",
    );
}

#[test]
fn reduction_of_a_solid_alone() {
    solid()
        .scene("[[solid.material]]", "reduction = { kind = \"surface\" }\n\n[[solid.material]]")
        .refused("scene.toml:8: solid.reduction: found, but it has no effect without [[grains]]");
}

#[test]
fn mixed_rayleigh_damping() {
    coupled().scene("damping_ratio = 0.05, ", "damping_ratio = 0.05, alpha_m = 3, ").refused(
        "scene.toml:7: solid.rayleigh: found a mixture of keys, expected either alpha_m and beta_k, or damping_ratio \
         and frequencies",
    );
}

#[test]
fn grain_step_above_the_limit() {
    // Limit for two equal spheres.
    grains_scene().scene("end = \"20 ms\"", "end = \"20 ms\"\ngrain_step = \"1 ms\"").refused(
        "scene.toml:24: time.grain_step: found 0.001 s, expected at most 1.374298e-4 s, set by body 0 of \"pair\" (effective mass \
         7.929e-1 kg) in contact with stone (stiffness 1.000e6 N/m), or `accept_step_above_limit = true`",
    );
}

#[test]
fn step_above_limit_under_sleeper() {
    coupled().scene("[output]", "[time]\ngrain_step = \"1 ms\"\n\n[output]").refused(
        "scene.toml:54: time.grain_step: found 0.001 s, expected at most 3.887101e-4 s, set by body 0 of \"bed\" (effective mass \
         6.343e0 kg) in contact with stone (stiffness 1.000e6 N/m), or `accept_step_above_limit = true`",
    );
}

#[test]
fn no_substeps() {
    coupled()
        .scene("substeps = 10", "substeps = 0")
        .refused("scene.toml:46: coupling.substeps: found 0, expected 1 to 1000, or \"auto\"");
}

#[test]
fn substeps_in_words() {
    coupled()
        .scene("substeps = 10", "substeps = \"many\"")
        .refused("scene.toml:46: coupling.substeps: found string \"many\", expected 1 to 1000, or \"auto\"");
}

#[test]
fn substeps_that_are_no_whole_number() {
    coupled().scene("substeps = 10", "substeps = 2.5").refused(
        "scene.toml:46: coupling.substeps: found floating point 2.5, expected 1 to 1000, or \"auto\"",
    );
}

#[test]
fn scheme_that_is_none() {
    coupled().scene("substeps = 10", "substeps = 10\nscheme = \"strong\"").refused(
        "scene.toml:47: coupling.scheme: found \"strong\", expected one of \"predicted\", \"lagged\", \"stiffened\", \
         \"iterated\"",
    );
}

#[test]
fn tolerance_without_iteration() {
    coupled().scene("substeps = 10", "substeps = 10\ntolerance = 1e-3").refused(
        "scene.toml:47: coupling.tolerance: found, but it has no effect without `scheme = \"iterated\"`",
    );
}

#[test]
fn passes_without_iteration() {
    coupled().scene("substeps = 10", "substeps = 10\nmax_passes = 3").refused(
        "scene.toml:47: coupling.max_passes: found, but it has no effect without `scheme = \"iterated\"`",
    );
}

#[test]
fn tolerance_of_nothing() {
    coupled()
        .scene("substeps = 10", "scheme = \"iterated\"\ntolerance = 0")
        .refused("scene.toml:47: coupling.tolerance: found 0, expected above 0, below 1");
}

#[test]
fn a_single_pass() {
    coupled()
        .scene("substeps = 10", "scheme = \"iterated\"\nmax_passes = 1")
        .refused("scene.toml:47: coupling.max_passes: found 1, expected 2 to 1000");
}

#[test]
fn stiffened_exchange_with_a_plastic_solid() {
    coupled()
        .scene("substeps = 10", "scheme = \"stiffened\"")
        .scene("density = 2000", "density = 2000\nmodel = \"mohr_coulomb\"\ncohesion = 2000\nfriction = 0.6\ndilation = 0.1")
        .refused(
            "scene.toml:50: coupling.scheme: found \"stiffened\" with a plastic solid or initial stress, expected \"predicted\", \"lagged\" or \"iterated\"",
        );
}

#[test]
fn transfer_that_is_none() {
    coupled().scene("substeps = 10", "transfer = \"disc\"").refused(
        "scene.toml:46: coupling.transfer: found string \"disc\", expected \"point\", or a table with `spread` or \
         `spread_factor`",
    );
}

#[test]
fn transfer_with_two_sizes() {
    coupled().scene("substeps = 10", "transfer = { spread = 0.1, spread_factor = 2 }").refused(
        "scene.toml:46: coupling.transfer.spread: found together with `spread_factor`, expected only one of them",
    );
}

#[test]
fn spread_over_nothing() {
    coupled()
        .scene("substeps = 10", "transfer = { spread = \"0 mm\" }")
        .refused("scene.toml:46: coupling.transfer.spread: found 0 m, expected a radius above 0");
}

#[test]
fn spread_factor_below_zero() {
    coupled()
        .scene("substeps = 10", "transfer = { spread_factor = -1 }")
        .refused("scene.toml:46: coupling.transfer.spread_factor: found -1, expected above 0, at most 100");
}

#[test]
fn theta_that_is_not_a_number() {
    coupled()
        .scene("substeps = 10", "substeps = 10\ntheta = nan")
        .refused("scene.toml:47: coupling.theta: found NaN, expected 0.5 to 1");
}

#[test]
fn both_sides_without_coupling() {
    coupled().scene("[coupling]\nsubsteps = 10\nmaterial = \"stone\"\n", "").refused(
        "scene.toml: coupling: found nothing, expected [coupling], since the scene has [solid] and [[grains]]",
    );
}

#[test]
fn coupling_with_one_side() {
    grains_scene()
        .scene("[time]", "[coupling]\nmaterial = \"stone\"\n\n[time]")
        .refused("scene.toml:22: coupling: found without [solid], expected both");
}

#[test]
fn no_end_of_time() {
    grains_scene()
        .scene("[time]\nend = \"20 ms\"\n", "")
        .refused("scene.toml: time.end: found nothing, expected the time to simulate");
}

#[test]
fn end_before_the_last_cycle() {
    coupled().scene("[output]", "[time]\nend = 0.01\n\n[output]").refused(
        "scene.toml:54: time.end: found 0.01 s, expected at least 0.08 s, when the last load cycle ends",
    );
}

#[test]
fn negative_number_of_frames() {
    solid()
        .scene("tables = true", "frames = -1")
        .refused("scene.toml:24: output.frames: found integer -1, expected a whole number of 0 or more");
}

#[test]
fn history_interval_of_zero() {
    grains_scene()
        .scene("frames = 2", "history_interval = 0")
        .refused("scene.toml:26: output.history_interval: found 0, expected a time above 0");
}

#[test]
fn keys_without_effect() {
    let scene = "scene.toml";
    solid()
        .set("time.grain_step_fraction=0.5")
        .refused("--set: time.grain_step_fraction: found, but it has no effect without [[grains]]");
    solid().set("output.frames=3").refused(
        "--set: output.frames: found, but it has no effect without [solid.dynamics] or [solid.quasi_static]",
    );
    grains_scene()
        .append(scene, "tecplot = true")
        .refused("scene.toml:27: output.tecplot: found, but it has no effect without [solid]");
    coupled().scene("[solid]\n", "[solid]\ndynamics = {}\n").refused(
        "scene.toml:4: solid.dynamics: found together with [[grains]], expected only one of them. `coupling.theta` \
         sets the time integration of a coupled solid.",
    );
}

#[test]
fn jumps_pushes_and_fouling() {
    let bed = super::super::support::COUPLED;
    let with = |more: &str| bed.replace("\n[coupling]", &format!("{more}\n\n[coupling]"));
    let jump = "\n[track.jump]\nfirst = 12\nmeasure = 4";
    let push = "\n[track.push]\ndirection = [1, 0]\nspeed = 0.02\ndisplacement = 0.005";
    for (more, set, words) in [
        (
            jump,
            "track.jump.first=12",
            "track.jump.first: found 12, expected fewer than the 2 cycles of the load",
        ),
        (
            jump,
            "track.jump.first=9",
            "track.jump.first: found 9, expected 10 or more, and more than `measure` by 2",
        ),
        (jump, "track.jump.measure=1", "track.jump.measure: found 1, expected 2 or more"),
        (jump, "track.jump.tolerance=0", "track.jump.tolerance: found 0, expected above 0, at most 10"),
        (jump, "track.jump.largest=11", "track.jump.largest: found 11, expected above 0, at most 10"),
        (
            jump,
            "track.jump.overlap=0.5",
            "track.jump.overlap: found, but it has no effect without `method = \"displace\"`",
        ),
        (
            jump,
            "track.jump.settle=1",
            "track.jump.settle: found, but it has no effect without `method = \"displace\"`",
        ),
        (jump, "track.jump.method=\"all\"", "expected"),
        (
            "\n[track.jump]\nmethod = \"displace\"\noverlap = 3.0",
            "track.jump.first=12",
            "track.jump.overlap: found 3, expected above 0, at most 2",
        ),
        (push, "track.push.direction=[0, 0]", "track.push.direction: found (0, 0), expected a direction"),
        (
            push,
            "track.sleeper.hold=[\"x\"]",
            "expected a direction that track.sleeper.hold leaves free, not x",
        ),
        (push, "track.push.speed=0", "track.push.speed: found 0, expected above 0"),
        (push, "track.push.displacement=-1", "track.push.displacement: found -1, expected above 0"),
        (push, "track.push.load=-1", "track.push.load: found -1, expected 0 or more"),
        (push, "track.push.rest=-1", "track.push.rest: found -1, expected 0 or more"),
        (push, "track.push.stiffness=0", "track.push.stiffness: found 0, expected above 0"),
        (push, "track.push.height=\"1 s\"", "track.push.height"),
        (push, "time.end=0.1", "time.end: found 0.1 s, expected at least"),
        (
            "",
            "track.bed_stiffness=[2000, 6000]",
            "expected two rising loads from 1000 to 5000, the loads of the cycles",
        ),
        (
            "",
            "grains.0.fouling=true",
            "grains.0.fouling: found true for all groups, expected a second group without `fouling`",
        ),
    ] {
        let folder = super::super::support::scene_folder("after", &with(more));
        let out = folder.join("out");
        let outcome = super::super::support::run(&folder.join("scene.toml"), &out, &[set]);
        assert_eq!(outcome.code, 2, "{set}: {outcome:?}");
        assert!(outcome.stderr.contains(words), "{set}: {}", outcome.stderr);
        assert!(!out.exists(), "{set}");
    }
    // Too stiff an actuator is detected during setup.
    let folder = super::super::support::scene_folder("ram", &with(push));
    let set = ["track.push.stiffness=\"1e6 GN/m\"", "time.grain_step=1e-6"];
    let outcome = super::super::support::run(&folder.join("scene.toml"), &folder.join("out"), &set);
    assert!(outcome.code == 2 && outcome.stderr.contains("the limit of the time step of"), "{outcome:?}");
}
