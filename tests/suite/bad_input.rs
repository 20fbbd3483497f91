//! Broken input is refused: exit code 2, one line on standard error that names file, line (where there is one), key,
//! what was found and what was expected, and nothing written.
//!
//! Each test takes a good scene, runs it, breaks one thing, and runs it again: once into a fresh folder, which must
//! not come into being, and once into the folder of the good run, which must keep every byte. The whole line is
//! compared. `check` must refuse the scene with the same line, except for what only a solve or a settled bed shows.

use super::support::{COUPLED, Folder, GRAINS, SOLID, run, scene_folder, snapshot, trackbed};
use std::fs;

const SCENE: &str = "scene.toml";
const NODES: &str = "NODECOORD.DAT";
const ELEMENTS: &str = "ELEMENTNUM.DAT";
const DOF: &str = "DOF.DAT";

/// The sphere list of [`GRAINS`], for tests that fill in grains in another way.
const SPHERES: &str = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
const FILL: &str = "fill = { low = [0, 0, 0], high = [0.3, 0.3] }";
const FACES: &str = "faces = [[5, 6], [6, 6], [7, 6], [8, 6]]";

/// A good scene in its folder, with the results of a run in `earlier`.
struct Good {
    folder: Folder,
    earlier: std::collections::BTreeMap<String, Vec<u8>>,
    set: Vec<&'static str>,
    check_sees_it: bool,
}

impl Good {
    fn new(text: &str) -> Good {
        let folder = scene_folder("bad_input", text);
        run(&folder.join(SCENE), &folder.join("earlier"), &[]).good();
        let earlier = snapshot(&folder.join("earlier"));
        assert!(earlier.contains_key("summary.json"));
        Good { folder, earlier, set: Vec::new(), check_sees_it: true }
    }

    /// Replaces a part of the scene that is there exactly once.
    fn scene(self, old: &str, new: &str) -> Good {
        self.folder.edit(SCENE, old, new);
        self
    }

    /// Replaces or adds a whole file.
    fn file(self, name: &str, text: &str) -> Good {
        self.folder.write(name, text);
        self
    }

    /// Adds a last line to a file.
    fn append(self, name: &str, line: &str) -> Good {
        let text = fs::read_to_string(self.folder.join(name)).unwrap();
        self.file(name, &format!("{text}{line}\n"))
    }

    /// Changes the fields of line `number` (from 1) of a list.
    fn line(self, name: &str, number: usize, change: impl Fn(&mut Vec<String>)) -> Good {
        let text = fs::read_to_string(self.folder.join(name)).unwrap();
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        let mut fields = lines[number - 1].split_whitespace().map(String::from).collect();
        change(&mut fields);
        lines[number - 1] = fields.join(" ");
        self.file(name, &(lines.join("\n") + "\n"))
    }

    /// Replaces field `column` (from 0) of line `number` (from 1) of a list.
    fn field(self, name: &str, number: usize, column: usize, value: &str) -> Good {
        self.line(name, number, |fields| fields[column] = value.into())
    }

    /// Removes a file.
    fn without(self, name: &str) -> Good {
        fs::remove_file(self.folder.join(name)).unwrap();
        self
    }

    /// Adds an override on the command line.
    fn set(mut self, assignment: &'static str) -> Good {
        self.set.push(assignment);
        self
    }

    /// Only a run finds this fault.
    fn only_run_sees_it(mut self) -> Good {
        self.check_sees_it = false;
        self
    }

    /// The run is refused with this line; files are named relative to the folder.
    #[track_caller]
    fn refused(self, line: &str) {
        let scene = self.folder.join(SCENE);
        let said = |text: &str| text.replace(&format!("{}/", self.folder.path().display()), "");
        let expected = format!("error: {line}\n");
        for out in ["fresh", "earlier"] {
            let outcome = run(&scene, &self.folder.join(out), &self.set);
            assert_eq!((outcome.code, said(&outcome.stderr).as_str()), (2, expected.as_str()));
            assert_eq!(outcome.stdout, "");
        }
        assert!(!self.folder.join("fresh").exists(), "a refused run leaves nothing");
        assert!(
            snapshot(&self.folder.join("earlier")) == self.earlier,
            "results of the earlier run have changed"
        );
        if self.check_sees_it {
            let mut arguments = vec!["check".to_string(), scene.display().to_string()];
            self.set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.to_string()]));
            let outcome = trackbed(arguments);
            assert_eq!((outcome.code, said(&outcome.stderr).as_str()), (2, expected.as_str()), "by `check`");
        }
        assert!(line.contains(": ") && line.contains("found ") && line.contains(", expected "), "{line}");
    }
}

fn solid() -> Good {
    Good::new(SOLID)
}

fn grains() -> Good {
    Good::new(GRAINS)
}

fn coupled() -> Good {
    Good::new(COUPLED)
}

// --- files --------------------------------------------------------------------------------------------------------

#[test]
fn missing_scene() {
    solid()
        .without(SCENE)
        .refused("scene.toml: file: found No such file or directory (os error 2), expected a readable file");
}

#[test]
fn scene_that_is_no_text() {
    let good = solid();
    fs::write(good.folder.join(SCENE), b"title = \"\xff\"\n").unwrap();
    good.refused("scene.toml: file: found stream did not contain valid UTF-8, expected a readable file");
}

#[test]
fn missing_list() {
    solid()
        .without(ELEMENTS)
        .refused("ELEMENTNUM.DAT: element list: found no such file, expected a readable file");
}

#[test]
fn missing_library() {
    grains()
        .scene("shape = \"sphere\"", "shape = \"clump\"")
        .scene(SPHERES, &format!("library = \"stones.toml\"\ncount = 3\nsize = [0.1, 0.1]\n{FILL}"))
        .refused("stones.toml: file: found No such file or directory (os error 2), expected a readable file");
}

// --- lists --------------------------------------------------------------------------------------------------------

#[test]
fn truncated_element() {
    solid().line(ELEMENTS, 3, |fields| fields.truncate(15)).refused(
        "ELEMENTNUM.DAT:3: columns of an element: found 15, and 37 with the lines up to 4, expected 22 (id mat n1…n20)",
    );
}

#[test]
fn file_that_ends_within_an_element() {
    solid().line(ELEMENTS, 8, |fields| fields.truncate(15)).refused(
        "ELEMENTNUM.DAT:8: columns of the last element: found 15 and the end of the file (a truncated element), \
         expected 22 (id mat n1…n20)",
    );
}

#[test]
fn node_named_twice() {
    solid()
        .field(NODES, 5, 0, "3")
        .refused("NODECOORD.DAT:5: node 3: found it again after line 3, expected each number once");
}

#[test]
fn element_named_twice() {
    solid()
        .field(ELEMENTS, 5, 0, "3")
        .refused("ELEMENTNUM.DAT:5: element 3: found it again after line 3, expected each number once");
}

#[test]
fn absent_node() {
    solid()
        .field(ELEMENTS, 2, 4, "999")
        .refused("ELEMENTNUM.DAT:2: element 2, node n3: found 999, expected a node of the node list");
}

#[test]
fn inverted_element() {
    // Bottom and top changed over: I…L with M…P and Q…T with U…X.
    let turn = |fields: &mut Vec<String>| {
        fields[2..10].rotate_left(4);
        fields[10..18].rotate_left(4);
    };
    solid().line(ELEMENTS, 2, turn).refused(
        "ELEMENTNUM.DAT: element 2: found a Jacobian determinant of -6.250000e-2 m3 at (-0.77, -0.77, -0.77): \
         inverted or flat, expected a determinant above 0",
    );
}

#[test]
fn flat_element() {
    // The middle node of the block raised far above its top folds the elements around it.
    solid().field(NODES, 41, 3, "2.5").refused(
        "ELEMENTNUM.DAT: element 1: found a Jacobian determinant of -7.736875e-3 m3 at (-0.77, 0.00, -0.77): \
         inverted or flat, expected a determinant above 0",
    );
}

#[test]
fn degenerate_element() {
    solid().line(ELEMENTS, 2, |fields| fields[5] = fields[4].clone()).refused(
        "ELEMENTNUM.DAT:2: element 2: found node 13 more than once (19 different nodes: no known form), expected 20 \
         different nodes (wedges, pyramids and tetrahedra are not supported in this version)",
    );
}

#[test]
fn empty_element_list() {
    solid()
        .file(ELEMENTS, "")
        .refused("ELEMENTNUM.DAT: elements: found none, expected at least one row of id mat n1…n20");
}

#[test]
fn node_list_of_comments() {
    solid()
        .file(NODES, "! nothing here\n")
        .refused("NODECOORD.DAT: nodes: found none, expected at least 20 rows of id x y z");
}

#[test]
fn unreadable_number() {
    solid()
        .field(NODES, 7, 2, "0.5O")
        .refused("NODECOORD.DAT:7: coordinate y: found \"0.5O\", expected a number");
}

#[test]
fn coordinate_that_is_not_a_number() {
    solid()
        .field(NODES, 7, 2, "NaN")
        .refused("NODECOORD.DAT:7: coordinate y: found \"NaN\", expected a finite number");
}

#[test]
fn wrong_number_of_columns() {
    solid()
        .line(NODES, 9, |fields| fields.push("3".into()))
        .refused("NODECOORD.DAT:9: columns of a node: found 5, expected 4 (id x y z)");
}

#[test]
fn constraint_with_two_values() {
    solid()
        .append(DOF, "1 1 0.5")
        .refused("DOF.DAT:64: constraint of node 1 in x: found 0.5 after 0 on line 1, expected one value");
}

#[test]
fn constraint_in_a_fourth_direction() {
    solid()
        .append(DOF, "1 4 0")
        .refused("DOF.DAT:64: direction: found \"4\", expected 1, 2, 3, UX, UY, UZ or ALL");
}

#[test]
fn constraint_of_an_absent_node() {
    solid()
        .append(DOF, "1000 1 0")
        .refused("DOF.DAT:64: constrained node: found 1000, expected a node of the node list");
}

#[test]
fn unsupported_body() {
    solid().scene("constraints = \"DOF.DAT\"\n", "").refused(
        "ELEMENTNUM.DAT: constraints: found too few (the body is not held: node 1 is free to move in x; add supports), \
         expected a body that is held",
    );
}

#[test]
fn unsupported_body_under_grains() {
    coupled().scene("constraints = \"DOF.DAT\"\n", "").refused(
        "ELEMENTNUM.DAT: constraints: found too few (the body is not held: node 1 is free to move in x; add supports), \
         expected a body that is held",
    );
}

#[test]
fn body_held_at_one_node() {
    solid().file(DOF, "1 1 0\n1 2 0\n1 3 0\n").refused(
        "DOF.DAT: constraints: found too few (the body is not held: node 77 is free to move in x; add supports), \
         expected a body that is held",
    );
}

// --- the form of a scene ------------------------------------------------------------------------------------------

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
    solid()
        .scene("young = \"20 MPa\"\n", "")
        .refused("scene.toml:8: solid.material.0.young: found nothing, expected a value for this key");
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
    grains()
        .scene("normal = [0, 0, 1]", "normal = [0, 1]")
        .refused("scene.toml:19: walls.0.normal: found 2, expected an array of length 3");
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
        "--set: solid.material.4.young: found solid.material.4.young, expected an index below 1 after `material`",
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

// --- the solid of a scene -----------------------------------------------------------------------------------------

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
        .scene("[[solid.load]]", "[solid.dynamics]\nalpha = 0.1\n\n[[solid.load]]")
        .scene("[output]", "[time]\nend = 0.1\nsolid_step = 0.01\n\n[output]")
        .refused(
            "scene.toml:15: solid.dynamics: found Newmark with alpha = 0.1, delta = 0.5 is not unconditionally stable: \
             it needs delta >= 0.5 and alpha >= 0.25 (0.5 + delta)^2 = 0.25, expected stable constants",
        );
}

#[test]
fn mixed_rayleigh_damping() {
    coupled().scene("damping_ratio = 0.05, ", "damping_ratio = 0.05, alpha_m = 3, ").refused(
        "scene.toml:7: solid.rayleigh: found a mixture of keys, expected either alpha_m and beta_k, or damping_ratio \
         and frequencies",
    );
}

// --- grains, walls, sleeper ---------------------------------------------------------------------------------------

#[test]
fn unknown_kind_of_wall() {
    grains()
        .scene("kind = \"plane\"", "kind = \"cone\"")
        .refused("scene.toml:17: walls.0.kind: found \"cone\", expected \"plane\" or \"triangles\"");
}

#[test]
fn wall_without_area() {
    grains()
        .scene(
            "kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]",
            "kind = \"triangles\"\nvertices = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\ntriangles = [[0, 1, 2]]",
        )
        .refused("scene.toml:16: walls: found triangle 0 of surface 0: it has no area, expected walls with an area");
}

#[test]
fn unknown_material_name() {
    grains()
        .scene("shape = \"sphere\"\nmaterial = \"stone\"", "shape = \"sphere\"\nmaterial = \"granite\"")
        .refused(
            "scene.toml:13: grains.0.material: found \"granite\", expected the name of a [[material]]: stone",
        );
}

#[test]
fn grains_without_density() {
    grains().scene("density = 2650\n", "").refused(
        "scene.toml:3: material.0.density: found nothing, expected the density of a material of grains",
    );
}

#[test]
fn restitution_of_zero() {
    grains()
        .scene("restitution = 0.4", "restitution = 0")
        .refused("scene.toml:8: material.0.restitution: found 0, expected above 0, at most 1");
}

#[test]
fn infinite_friction() {
    grains()
        .scene("friction = 0.5", "friction = inf")
        .refused("scene.toml:7: material.0.friction: found inf, expected 0 or more");
}

#[test]
fn rigid_against_rigid() {
    grains().scene("stiffness = \"1 MN/m\"\n", "").refused(
        "scene.toml:3: material: found no stiffness for body 0 against body 1, which may touch, expected `stiffness` \
         for one of their materials, or for the pair",
    );
}

#[test]
fn group_without_spheres() {
    grains()
        .scene(SPHERES, "spheres = []")
        .refused("scene.toml:14: grains.0.spheres: found none, expected at least one sphere");
}

#[test]
fn negative_radius() {
    grains()
        .scene("0.152, 0.05]", "0.152, -0.05]")
        .refused("scene.toml:14: grains.0.spheres: found -0.05, expected a radius above 0");
}

#[test]
fn packing_with_a_word() {
    grains()
        .scene(SPHERES, "packing = \"packing.csv\"")
        .file("packing.csv", "x,y,z,r\n0,0,0.1,0.05\n0,0,high,0.05\n")
        .refused("packing.csv:3: z: found \"high\", expected a number");
}

#[test]
fn fill_box_too_small_for_a_stone() {
    grains().scene(SPHERES, &format!("count = 3\nsize = [0.5, 0.6]\n{FILL}")).refused(
        "scene.toml:16: grains.0.fill: found stone 0 with bounding radius 0.2583333333333333 m does not fit into a box \
         0.3 m wide, expected a box that holds the grains",
    );
}

#[test]
fn absent_grade() {
    grains()
        .scene(
            SPHERES,
            &format!(
                "count = 3\ngradation = {{ file = \"g.csv\", standard = \"X\", grade = \"B\" }}\n{FILL}"
            ),
        )
        .file(
            "g.csv",
            "standard,grade,sieve_mm,passing_lo_pct,passing_hi_pct\nX,A,63,100,100\nX,A,31.5,0,0\n",
        )
        .refused("g.csv: gradation: found no row of X B, expected rows of this grade");
}

#[test]
fn library_with_disconnected_spheres() {
    grains()
        .scene("shape = \"sphere\"", "shape = \"clump\"")
        .scene(SPHERES, &format!("library = \"stones.toml\"\ncount = 3\nsize = [0.1, 0.1]\n{FILL}"))
        .file(
            "stones.toml",
            "name = \"l\"\nsource = \"s\"\n[[stones]]\nname = \"two\"\nspheres = [[0, 0, 0, 0.1], [1, 0, 0, 0.1]]\n",
        )
        .refused(
            "stones.toml:3: stones: found stone 0 ('two') of library 'l': sphere 1 of the clump does not touch the \
             piece that holds sphere 0; a clump must be connected, expected connected spheres with positive radii",
        );
}

#[test]
fn level_below_all_grains() {
    grains()
        .append(SCENE, "[deposition]\nmax_time = 0.01\nlevel = -5")
        .only_run_sees_it()
        .refused("scene.toml:29: deposition.level: found no grain below it, expected at least one");
}

#[test]
fn deposition_without_grains() {
    solid().append(SCENE, "[deposition]\nmax_time = 1").refused(
        "scene.toml:25: deposition: found a table for grains, expected [[grains]] beside it, or no such table",
    );
}

#[test]
fn load_with_maximum_below_minimum() {
    coupled()
        .scene("maximum = \"5 kN\"", "maximum = \"500 N\"")
        .refused("scene.toml:39: track.load.maximum: found 500, expected more than the minimum");
}

#[test]
fn seat_beside_the_sleeper() {
    coupled()
        .scene("ramp = \"20 ms\"", "ramp = \"20 ms\"\nseats = [[2, 0]]")
        .refused("scene.toml:44: track.load.seats: found (2, 0), expected points on the sleeper's top");
}

#[test]
fn unknown_held_motion() {
    coupled()
        .scene("mass = 400", "mass = 400\nhold = [\"w\"]")
        .refused("scene.toml:33: track.sleeper.hold.0: found \"w\", expected one of \"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"");
}

// --- coupling, time, output ---------------------------------------------------------------------------------------

#[test]
fn grain_step_above_the_limit() {
    // Limit of the step: that of two like spheres, of which one touches; the message gives it.
    grains().scene("end = \"20 ms\"", "end = \"20 ms\"\ngrain_step = \"1 ms\"").refused(
        "scene.toml:24: time.grain_step: found 0.001 s, expected at most 1.374298e-4 s, set by body 0 (effective mass \
         7.929e-1 kg) in contact with material 0 (stiffness 1.000e6 N/m), or `accept_step_above_limit = true`",
    );
}

#[test]
fn grain_step_above_the_limit_under_a_sleeper() {
    coupled().scene("[output]", "[time]\ngrain_step = \"1 ms\"\n\n[output]").refused(
        "scene.toml:54: time.grain_step: found 0.001 s, expected at most 3.887101e-4 s, set by body 0 (effective mass \
         6.343e0 kg) in contact with material 0 (stiffness 1.000e6 N/m), or `accept_step_above_limit = true`",
    );
}

#[test]
fn no_substeps() {
    coupled()
        .scene("substeps = 10", "substeps = 0")
        .refused("scene.toml:46: coupling.substeps: found 0, expected 1 to 1000");
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
    grains()
        .scene("[time]", "[coupling]\nmaterial = \"stone\"\n\n[time]")
        .refused("scene.toml:22: coupling: found only one side, expected both [solid] and [[grains]]");
}

#[test]
fn no_end_of_time() {
    grains()
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
    grains()
        .scene("frames = 2", "history_interval = 0")
        .refused("scene.toml:26: output.history_interval: found 0, expected a time above 0");
}
