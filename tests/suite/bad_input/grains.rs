//! Bad input: grains, walls and sleeper.

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
        .refused("scene.toml:16: walls: found triangle 0 of wall 0: it has no area, expected valid walls");
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
        .refused("scene.toml:8: material.0.restitution: found 0, expected 0.0001 to 1");
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
        "scene.toml:3: material: found no stiffness for body 0 of \"pair\" against body 1 of \"pair\", which can be in contact, expected `stiffness` \
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
fn fill_box_smaller_than_grain() {
    grains_scene().scene(SPHERES, &format!("count = 3\nsize = [0.5, 0.6]\n{FILL}")).refused(
        "scene.toml:16: grains.0.fill: found stone 0 with bounding radius 0.2583333333333333 m does not fit into a box \
         of width 0.3 m, expected a box that holds the grains",
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
        .refused("scene.toml:15: grains.0.gradation: found \"X\" \"B\", expected one of X A");
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
            "stones.toml:3: stones: found stone 0 ('two') of library 'l': sphere 1 of the clump is not connected to sphere 0; a clump must be connected, expected connected spheres with positive radii",
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
    solid()
        .append(SCENE, "[deposition]\nmax_time = 1")
        .refused("scene.toml:25: deposition: found, but it has no effect without [[grains]]");
}

#[test]
fn load_with_maximum_below_minimum() {
    coupled()
        .scene("maximum = \"5 kN\"", "maximum = \"500 N\"")
        .refused("scene.toml:39: track.load.maximum: found 500, expected more than the minimum");
}

#[test]
fn sleepers_without_a_spacing() {
    coupled().scene("mass = 400", "mass = 400\ncount = 2").refused(
        "scene.toml:30: track.sleeper.spacing: found nothing, expected the distance of the sleepers",
    );
}

#[test]
fn sleepers_one_in_another() {
    coupled().scene("mass = 400", "mass = 400\ncount = 2\nspacing = 0.9").refused(
        "scene.toml:34: track.sleeper.spacing: found 0.9, expected more than the sleeper's width of 1 m along the track",
    );
}

#[test]
fn no_sleeper() {
    coupled()
        .scene("mass = 400", "mass = 400\ncount = 0")
        .refused("scene.toml:33: track.sleeper.count: found 0, expected 1 to 1000");
}

#[test]
fn a_track_upwards() {
    coupled()
        .scene("mass = 400", "mass = 400\nalong = \"z\"")
        .refused("scene.toml:33: track.sleeper.along: found \"z\", expected \"x\" or \"y\"");
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

const LATTICE: &str = "lattice = { kind = \"loose\", size = 0.1, low = [0, 0, 0.1], counts = [2, 2, 2] }";

#[test]
fn lattice_of_both_counts_and_corner() {
    grains_scene().scene(SPHERES, &LATTICE.replace("counts", "high = [1, 1, 1], counts")).refused(
        "scene.toml:14: grains.0.lattice.counts: found together with `high`, expected only one of them",
    );
}

#[test]
fn size_without_a_fill() {
    grains_scene()
        .scene(SPHERES, &format!("{LATTICE}\nsize = [0.1, 0.2]"))
        .refused("scene.toml:15: grains.0.size: found, but it has no effect without `fill` or `region`");
}

#[test]
fn two_sources_of_grains() {
    grains_scene()
        .scene(SPHERES, &format!("{SPHERES}\n{LATTICE}"))
        .refused("scene.toml:14: grains.0.spheres: found together with `lattice`, expected only one of them");
}

const SCATTER: &str = "region = { box = [[0, 0, 0], [1, 1, 1]] }\nsizes = { law = \"monodisperse\", size = 0.1 }\nsolid_fraction = 0.1";

#[test]
fn container_that_is_too_full() {
    let full = SCATTER.replace("solid_fraction = 0.1", "solid_fraction = 0.6");
    let line = "scene.toml:14: grains.0.region: found no free position for a grain of radius 0.05 m after ";
    let folder = scene_folder("bad_input", super::super::support::GRAINS);
    folder.edit(SCENE, SPHERES, &full);
    let said = trackbed(["check", &folder.join(SCENE).display().to_string()]);
    assert_eq!(said.code, 2);
    assert!(
        said.stderr
            .replace(&format!("{}/", folder.path().display()), "")
            .starts_with(&format!("error: {line}")),
        "{}",
        said.stderr
    );
}

#[test]
fn rejects_growth_with_solid_fraction() {
    grains_scene().scene(SPHERES, &format!("{SCATTER}\ngrowth = {{ porosity = 0.5 }}")).refused(
        "scene.toml:16: grains.0.solid_fraction: found together with `growth`, expected only one of them",
    );
}

#[test]
fn porosity_above_one() {
    let growth = SCATTER.replace("solid_fraction = 0.1", "growth = { porosity = 1.5 }");
    grains_scene()
        .scene(SPHERES, &growth)
        .refused("scene.toml:16: grains.0.growth.porosity: found 1.5, expected above 0, below 1");
}

#[test]
fn sizes_in_the_wrong_order() {
    let sizes = SCATTER.replace("\"monodisperse\", size = 0.1", "\"uniform\", low = 0.2, high = 0.1");
    grains_scene().scene(SPHERES, &sizes).refused(
        "scene.toml:15: grains.0.sizes: found sizes from 0.2 m to 0.1 m: the first must be the smaller, expected sizes \
         above 0 in rising order, and positive deviations",
    );
}

#[test]
fn open_surface() {
    let open = SCATTER.replace("box = [[0, 0, 0], [1, 1, 1]]", "surface = \"sheet.obj\"");
    grains_scene().scene(SPHERES, &open).file("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").refused(
        "scene.toml:14: grains.0.region.surface: found the surface is not closed: 3 edges join an odd number of triangles, \
         one at (0.5, 0, 0) m, expected a closed surface",
    );
}

#[test]
fn clump_packing_with_an_unknown_stone() {
    grains_scene()
        .scene("shape = \"sphere\"", "shape = \"clump\"")
        .scene(SPHERES, "packing = \"bed.csv\"\nlibrary = \"stones.toml\"")
        .file(
            "stones.toml",
            "name = \"a\"\nsource = \"b\"\n[[stones]]\nname = \"c\"\nspheres = [[0, 0, 0, 0.5]]\n",
        )
        .file("bed.csv", "x,y,z,qw,qx,qy,qz,scale,stone\n0,0,1,1,0,0,0,0.1,0\n0,0,2,1,0,0,0,0.1,1\n")
        .refused("bed.csv:3: stone: found 1, expected the number of a stone of the library, 0 to 0");
}

#[test]
fn ratio_of_forces_above_one() {
    grains_scene()
        .scene("[time]", "[deposition]\nmax_time = 1\nunbalanced_ratio = 2\n\n[time]")
        .refused("scene.toml:24: deposition.unbalanced_ratio: found 2, expected above 0, below 1");
}

#[test]
fn no_layers() {
    grains_scene()
        .scene("[time]", "[deposition]\nmax_time = 1\nlayers = 0\n\n[time]")
        .refused("scene.toml:24: deposition.layers: found 0, expected 1 to 1000");
}

const VIBRATION: &str = "[[compaction]]\nkind = \"vibration\"\nregion = [[0, 0, 0], [1, 1, 1]]\namplitude = 0.001\n\
                         frequency = 30\ncycles = 5\n\n[time]";

#[test]
fn vibration_of_missing_wall() {
    grains_scene().scene("[time]", &VIBRATION.replace("cycles = 5", "cycles = 5\nwalls = [0, 1]")).refused(
        "scene.toml:28: compaction.0.walls: found 1, expected the number of a plane in [[walls]], counted from 0",
    );
}

#[test]
fn vibration_of_recorded_plane() {
    grains_scene()
        .scene("[[walls]]\n", "[[walls]]\nrecord = true\n")
        .scene("[time]", &VIBRATION.replace("cycles = 5", "cycles = 5\nwalls = [0]"))
        .refused(
            "scene.toml:29: compaction.0.walls: found 0, a plane with other keys, expected a plane without `servo`, `body`, \
             `oscillation`, `angular_velocity` and `record`",
        );
}

#[test]
fn vibration_without_an_amplitude() {
    grains_scene()
        .scene("[time]", &VIBRATION.replace("amplitude = 0.001\n", ""))
        .refused("scene.toml:22: compaction.0.amplitude: found nothing, expected an amplitude");
}

#[test]
fn plate_of_a_vibration() {
    grains_scene().scene("[time]", &VIBRATION.replace("cycles = 5", "cycles = 5\nforce = 100")).refused(
        "scene.toml:28: compaction.0.force: found, but it has no effect without `kind = \"tamping\"`, `\"bedding\"` or \
         `\"stabilizing\"`",
    );
}

#[test]
fn region_upside_down() {
    grains_scene().scene("[time]", &VIBRATION.replace("[1, 1, 1]", "[1, 1, -1]")).refused(
        "scene.toml:24: compaction.0.region: found corners in another order, expected the lower corner, then the upper",
    );
}

#[test]
fn two_measures_of_one_name() {
    let measure = "[[measure]]\nname = \"core\"\nbox = [[0, 0, 0], [1, 1, 1]]\n\n";
    grains_scene()
        .scene("[time]", &format!("{measure}{measure}[time]"))
        .refused("scene.toml:27: measure.1.name: found \"core\" again, expected each name once");
}

#[test]
fn periodic_axes_that_cannot_be() {
    const END: &str = "[time]\nend = \"20 ms\"";
    for (table, words) in [
        ("", "periodic: found no axis, expected `x`, `y` or `z` with its two borders"),
        ("x = [1, 0]", "periodic.x: found [1, 0], expected two lengths, the second the larger"),
        (
            "x = [0, 0.2]",
            "periodic: found x is 0.2 m long; at least 2.200e-1 m (two diameters of the largest body and twice the search skin) are needed, expected axes along which the scene can be periodic",
        ),
        (
            "x = [0.005, 1]",
            "grains.0: found a grain from x = 0 to 0, expected grains between the borders 0.005 and 1 of `periodic`",
        ),
        (
            "z = [0, 1]",
            "periodic: found the normal of plane 0 has a component along z, which is periodic, expected axes along which the scene can be periodic",
        ),
    ] {
        let line = if words.starts_with("grains") {
            10
        } else if words.contains("periodic.x") {
            23
        } else {
            22
        };
        grains_scene()
            .scene(END, &format!("[periodic]\n{table}\n\n{END}"))
            .refused(&format!("scene.toml:{line}: {words}"));
    }
}

#[test]
fn radial_distribution_without_room() {
    let measure = "[[measure]]\nname = \"core\"\nbox = [[0, 0, 0], [1, 1, 0.5]]\n";
    grains_scene()
        .scene("[time]", &format!("{measure}radial = {{ reach = 0.3, bins = 10 }}\n[time]"))
        .refused(
            "scene.toml:25: measure.0.radial.reach: found 0.3, expected above 0, at most half the shortest side of the box, \
             0.25",
        );
    grains_scene()
        .scene("[time]", &format!("{measure}radial = {{ reach = 0.2, bins = 0 }}\n[time]"))
        .refused("scene.toml:25: measure.0.radial.bins: found 0, expected 1 to 100000");
}

#[test]
fn growth_through_a_wall() {
    let region = "count = 20\nsize = [0.03, 0.04]\nregion = { box = [[-0.1, -0.1, -0.02], [0.1, 0.1, 0.2]] }\n\
                  growth = { porosity = 0.5 }";
    grains_scene().scene(SPHERES, region).refused(
        "scene.toml:16: grains.0.region: found a region 2.000e-2 m behind wall0, expected a region within the walls: grains \
         grow up to its sides",
    );
}

#[test]
fn growth_across_a_sphere() {
    let region = "count = 20\nsize = [0.03, 0.04]\nregion = { box = [[0, 0, 0], [0.3, 0.3, 0.3]] }\ngrowth = { porosity = 0.5 }";
    grains_scene()
        .scene(SPHERES, region)
        .scene("[time]", "[[walls]]\nname = \"shell\"\nkind = \"sphere\"\nbase = [0.15, 0.15, 0.15]\nradius = 0.15\nmaterial = \"stone\"\n\n[time]")
        .refused(
            "scene.toml:16: grains.0.region: found a region across wall \"shell\", expected a region within the walls: grains \
             grow up to its sides",
        );
}

const TAMPING: &str = "[[compaction]]\nkind = \"tamping\"\nregion = [[-0.1, -0.1, 0.01], [0.1, 0.1, 0.05]]\n\
    plate = { size = [0.2, 0.2, 0.05], mass = 20, material = \"stone\" }\nforce = 100\nfrequency = 20\ncycles = 1\n\
    at = [[0, 0]]\n\n[time]";

#[test]
fn plate_through_a_wall() {
    let beside = "[[walls]]\nkind = \"plane\"\npoint = [-0.06, 0, 0]\nnormal = [1, 0, 0]\nmaterial = \"stone\"\n\n[[walls]]\n";
    grains_scene().scene("[[walls]]\n", beside).scene("[time]", TAMPING).refused(
        "scene.toml:35: compaction.0.at: found the plate at (0, 0) m 4.000e-2 m through wall0, expected plates between the \
         walls",
    );
}

#[test]
fn rigid_plate_on_rigid_wall() {
    let rigid = "[[material]]\nname = \"rigid\"\nfriction = 0.4\nrestitution = 0.5\n\n[[grains]]";
    grains_scene()
        .scene("[[grains]]", rigid)
        .scene("normal = [0, 0, 1]\nmaterial = \"stone\"", "normal = [0, 0, 1]\nmaterial = \"rigid\"")
        .scene("[time]", &TAMPING.replace("\"stone\"", "\"rigid\""))
        .refused(
            "scene.toml:30: compaction.0.plate.material: found no stiffness for the plate against wall0, which can be in \
             contact, expected `stiffness` for one of their materials, or for the pair",
        );
}
