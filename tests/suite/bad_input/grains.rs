//! Broken input: grains, walls and sleeper.

use super::*;

#[test]
fn unknown_kind_of_wall() {
    grains_scene()
        .scene("kind = \"plane\"", "kind = \"torus\"")
        .refused("scene.toml:17: walls.0.kind: found \"torus\", expected one of \"plane\", \"cylinder\", \"cone\", \"sphere\", \"triangles\", \"mesh\"");
}

#[test]
fn wall_without_area() {
    grains_scene()
        .scene(
            "kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]",
            "kind = \"triangles\"\nvertices = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\ntriangles = [[0, 1, 2]]",
        )
        .refused("scene.toml:16: walls: found triangle 0 of wall 0: it has no area, expected walls that can be built");
}

#[test]
fn unknown_material_name() {
    grains_scene()
        .scene("shape = \"sphere\"\nmaterial = \"stone\"", "shape = \"sphere\"\nmaterial = \"granite\"")
        .refused(
            "scene.toml:13: grains.0.material: found \"granite\", expected the name of a [[material]]: stone",
        );
}

#[test]
fn grains_without_density() {
    grains_scene().scene("density = 2650\n", "").refused(
        "scene.toml:3: material.0.density: found nothing, expected the density of a material of grains",
    );
}

#[test]
fn restitution_of_zero() {
    grains_scene()
        .scene("restitution = 0.4", "restitution = 0")
        .refused("scene.toml:8: material.0.restitution: found 0, expected above 0, at most 1");
}

#[test]
fn infinite_friction() {
    grains_scene()
        .scene("friction = 0.5", "friction = inf")
        .refused("scene.toml:7: material.0.friction: found inf, expected 0 or more");
}

#[test]
fn rigid_against_rigid() {
    grains_scene().scene("stiffness = \"1 MN/m\"\n", "").refused(
        "scene.toml:3: material: found no stiffness for body 0 against body 1, which may touch, expected `stiffness` \
         for one of their materials, or for the pair",
    );
}

#[test]
fn group_without_spheres() {
    grains_scene()
        .scene(SPHERES, "spheres = []")
        .refused("scene.toml:14: grains.0.spheres: found none, expected at least one sphere");
}

#[test]
fn negative_radius() {
    grains_scene()
        .scene("0.152, 0.05]", "0.152, -0.05]")
        .refused("scene.toml:14: grains.0.spheres: found -0.05, expected a radius above 0");
}

#[test]
fn packing_with_a_word() {
    grains_scene()
        .scene(SPHERES, "packing = \"packing.csv\"")
        .file("packing.csv", "x,y,z,r\n0,0,0.1,0.05\n0,0,high,0.05\n")
        .refused("packing.csv:3: z: found \"high\", expected a number");
}

#[test]
fn fill_box_too_small_for_a_stone() {
    grains_scene().scene(SPHERES, &format!("count = 3\nsize = [0.5, 0.6]\n{FILL}")).refused(
        "scene.toml:16: grains.0.fill: found stone 0 with bounding radius 0.2583333333333333 m does not fit into a box \
         0.3 m wide, expected a box that holds the grains",
    );
}

#[test]
fn absent_grade() {
    grains_scene()
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
    grains_scene()
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
    grains_scene()
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

#[test]
fn modulus_without_poisson() {
    grains_scene()
        .scene("stiffness = \"1 MN/m\"", "young = \"50 MPa\"")
        .refused("scene.toml:3: material.0.poisson: found nothing, expected Poisson's ratio beside `young`");
}

#[test]
fn poisson_without_modulus() {
    grains_scene()
        .scene("friction = 0.5", "friction = 0.5\npoisson = 0.3")
        .refused("scene.toml:8: material.0.poisson: found a value, expected no such key without `young`");
}

#[test]
fn two_laws_in_one_scene() {
    grains_scene()
        .scene("stiffness = \"1 MN/m\"", "stiffness = \"1 MN/m\"\nyoung = \"50 MPa\"\npoisson = 0.3")
        .refused(
            "scene.toml:6: material.0.stiffness: found a stiffness, expected no stiffness, as \"stone\" has a Young's modulus",
        );
}

#[test]
fn negative_rolling_friction() {
    grains_scene()
        .scene("friction = 0.5", "friction = 0.5\nrolling_friction = -1.0")
        .refused("scene.toml:8: material.0.rolling_friction: found -1, expected 0 or more");
}

#[test]
fn impact_speed_of_linear_contacts() {
    grains_scene().scene("end = \"20 ms\"", "end = \"20 ms\"\nimpact_speed = 1.0").refused(
        "scene.toml:24: time.impact_speed: found a value, expected no such key without a material with `young`",
    );
}
