//! Bad input: walls.

use super::*;

const PLANE: &str = "kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]";

#[test]
fn cylinder_without_radius() {
    grains_scene()
        .scene(PLANE, "kind = \"cylinder\"\nbase = [0, 0, 0]\nheight = 1")
        .refused("scene.toml:16: walls.0.radius: found nothing, expected the radius");
}

#[test]
fn cone_without_area() {
    grains_scene()
        .scene(PLANE, "kind = \"cone\"\nbase = [0, 0, 0]\nheight = 0\nradii = [0.2, 0.2]")
        .refused("scene.toml:20: walls.0.radii: found [0.2, 0.2], expected radii that give the cone an area");
}

#[test]
fn radius_of_a_plane() {
    grains_scene()
        .scene(PLANE, &format!("{PLANE}\nradius = 0.1"))
        .refused("scene.toml:20: walls.0.radius: found, but it has no effect without `kind = \"cylinder\"` or `\"sphere\"`");
}

#[test]
fn plane_that_tilts() {
    grains_scene().scene(PLANE, &format!("{PLANE}\nangular_velocity = [1, 0, 0]")).refused(
        "scene.toml:20: walls.0.angular_velocity: found (1, 0, 0) rad/s, expected an angular velocity along the plane's \
         normal, or triangles for a floor that tilts",
    );
}

#[test]
fn centre_without_turning() {
    grains_scene()
        .scene(PLANE, &format!("{PLANE}\ncentre = [0, 0, 0]"))
        .refused("scene.toml:20: walls.0.centre: found, but it has no effect without `angular_velocity`");
}

#[test]
fn servo_without_area() {
    grains_scene()
        .scene(PLANE, &format!("{PLANE}\nservo = {{ pressure = \"1 kPa\", max_speed = 1 }}"))
        .refused(
            "scene.toml:20: walls.0.servo.area: found nothing, expected the area that the pressure acts on",
        );
}

#[test]
fn servo_that_also_moves() {
    grains_scene()
        .scene(PLANE, &format!("{PLANE}\nservo = {{ force = 1, max_speed = 1 }}\nvelocity = [0, 0, 1]"))
        .refused("scene.toml:21: walls.0.velocity: found together with `servo`, expected only one of them");
}

#[test]
fn servo_with_too_much_gain() {
    grains_scene()
        .scene(PLANE, &format!("{PLANE}\nservo = {{ force = 1, max_speed = 1, gain = 2 }}"))
        .refused("scene.toml:20: walls.0.servo.gain: found 2, expected above 0, at most 1");
}

#[test]
fn body_of_a_plane() {
    grains_scene().scene(PLANE, &format!("{PLANE}\nbody = {{ mass = 1 }}")).refused(
        "scene.toml:20: walls.0.body: found together with `kind = \"plane\"`, expected only one of them",
    );
}

fn ball(keys: &str) -> String {
    format!("kind = \"sphere\"\nbase = [0, 0, -1]\nradius = 0.5\nbody = {{ mass = 1, {keys} }}")
}

#[test]
fn mounts_of_bodies() {
    for (keys, words) in [
        ("spin = [0, 0, 1]", "spin: found, but it has no effect without `inertia`"),
        (
            "mount = {}",
            "mount.stiffness: found nothing, expected three stiffnesses, or three frequencies by `frequency`",
        ),
        ("mount = { stiffness = [1, -2, 0] }", "mount.stiffness: found -2, expected 0 or more"),
        (
            "mount = { stiffness = [1, 1, 1], frequency = [1, 1, 1] }",
            "mount.frequency: found together with `stiffness`, expected only one of them",
        ),
        (
            "mount = { stiffness = [1, 1, 1], damping = [1, 1, 1], damping_ratio = [1, 1, 1] }",
            "mount.damping_ratio: found together with `damping`, expected only one of them",
        ),
        (
            "hold = [\"y\"], mount = { frequency = [1, 1, 1] }",
            "mount.frequency: found 1, expected 0 along y, which the body holds",
        ),
    ] {
        grains_scene().scene(PLANE, &ball(keys)).refused(&format!("scene.toml:20: walls.0.body.{words}"));
    }
}

const WATER: &str = "[water]\ndrag = 0.6";
const PYRAMID: &str = "kind = \"triangles\"\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]\ntriangles = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]";

#[test]
fn water_on_bodies() {
    let open = PYRAMID.replace(", [0, 2, 3]", "");
    let drive = |keys: &str| format!("water = {{}}, propulsion = {{ point = [0, 0, 0], {keys} }}");
    let rudder = |keys: &str| drive(&format!("thrust = 1, rudder = {{ point = [0, 0, 0], {keys} }}"));
    for (shape, keys, words) in [
        (PYRAMID, "water = { drag = [1, -1, 1] }", "water.drag: found -1, expected 0 to 100"),
        (PYRAMID, "water = { skin_drag = 101 }", "water.skin_drag: found 101, expected 0 to 100"),
        (
            PYRAMID,
            "water = { damping_ratio = [0, 11, 0] }",
            "water.damping_ratio: found 11, expected 0 to 10",
        ),
        (
            &open,
            "inertia = [1, 1, 1, 0, 0, 0], centre = [0, 0, 0], water = {}",
            "water: found an open surface, expected a closed surface, each edge of exactly two triangles",
        ),
        (
            PYRAMID,
            "propulsion = { thrust = 1, point = [0, 0, 0] }",
            "propulsion: found, but it has no effect without `water`",
        ),
        (
            PYRAMID,
            &drive("thrust = 1, diameter = 1"),
            "propulsion.diameter: found, but it has no effect without `rudder`",
        ),
        (
            PYRAMID,
            &drive("thrust = 1, history = [[1, 0], [0, 1]]"),
            "propulsion.history: found times that do not rise, expected points with rising times",
        ),
        (
            PYRAMID,
            &rudder("area = 0, history = [[0, 0]]"),
            "propulsion.rudder.area: found 0, expected an area above 0",
        ),
        (
            PYRAMID,
            &rudder("area = 1, history = [[0, \"100 deg\"]]"),
            "propulsion.rudder.history: found 1.7453292519943295, expected angles of -90 to 90 degrees",
        ),
        (
            PYRAMID,
            &drive(
                "thrust = 1, direction = [0, 0, 1], rudder = { point = [0, 0, 0], area = 1, history = [[0, 0]] }",
            ),
            "propulsion.direction: found vertical, expected a direction that is not vertical, with `rudder`",
        ),
    ] {
        let text = format!("{shape}\nbody = {{ mass = 1, {keys} }}");
        let scene = grains_scene().scene(PLANE, &text).append(SCENE, WATER);
        scene.refused(&format!("scene.toml:20: walls.0.body.{words}"));
    }
    let text = format!("{PYRAMID}\nbody = {{ mass = 1, water = {{}} }}");
    grains_scene()
        .scene(PLANE, &text)
        .refused("scene.toml:20: walls.0.body.water: found without [water], expected both");
    grains_scene().scene(PLANE, &ball("water = {}")).append(SCENE, WATER).refused(
        "scene.toml:20: walls.0.body.water: found, but it has no effect without `kind = \"triangles\"` or `\"mesh\"`",
    );
}

fn ground(wall: &str, scarring: &str) -> String {
    format!(
        "kind = \"triangles\"\nvertices = [[0, 0, -1], [1, 0, -1], [0, 1, -1]]\ntriangles = [[0, 1, 2]]\n{wall}\nscarring = {{ {scarring} }}"
    )
}

#[test]
fn ground_that_is_scarred() {
    for (keys, words) in [
        ("strength = 0", "strength: found 0, expected a strength above 0"),
        ("strength = 1e7, drag = -1", "drag: found -1, expected 0 or more"),
        (
            "strength = 1e7, friction = [0.5, 0.4]",
            "friction: found [0.5, 0.4], expected two coefficients of 0 or more, the second not below the first",
        ),
        ("drag = 1", "strength: found nothing, expected a value for this key"),
    ] {
        let text = ground("", keys);
        grains_scene().scene(PLANE, &text).refused(&format!("scene.toml:21: walls.0.scarring.{words}"));
    }
    grains_scene().scene(PLANE, &ground("velocity = [1, 0, 0]", "strength = 1e7")).refused(
        "scene.toml:20: walls.0.velocity: found together with `scarring`, expected only one of them. A wall with scarring is fixed.",
    );
    grains_scene().scene(PLANE, &format!("{PLANE}\nscarring = {{ strength = 1e7 }}")).refused(
        "scene.toml:20: walls.0.scarring: found, but it has no effect without `kind = \"triangles\"` or `\"mesh\"`",
    );
    // Spheres cannot scar.
    grains_scene().scene(PLANE, &ground("", "strength = 1e7")).refused(
        "scene.toml:16: walls: found wall 0: scarring supports only dilated polyhedra and disks, expected valid walls",
    );
}

#[test]
fn mount_beside_a_factor_on_masses() {
    grains_scene()
        .scene(PLANE, &ball("mount = { frequency = [1, 1, 1] }"))
        .set("time.mass_factor=4")
        .refused(
            "--set: time.mass_factor: found together with a `mount`, expected only one of them. Mass scaling is valid for quasi-static loading only.",
        );
}

#[test]
fn body_with_a_hole() {
    grains_scene()
        .scene(
            PLANE,
            "kind = \"triangles\"\nvertices = [[0, 0, -1], [1, 0, -1], [0, 1, -1]]\ntriangles = [[0, 1, 2]]\nbody = { \
             mass = 1 }",
        )
        .refused(
            "scene.toml:16: walls: found wall 0: its surface is not closed: give the centre and the inertia of the body, \
             expected valid walls",
        );
}

#[test]
fn oscillation_without_frequency() {
    grains_scene()
        .scene(
            PLANE,
            &format!("{PLANE}\noscillation = {{ amplitude = 0.001, direction = [0, 0, 1], frequency = 0 }}"),
        )
        .refused("scene.toml:20: walls.0.oscillation.frequency: found 0, expected above 0");
}

#[test]
fn mesh_that_is_not_there() {
    grains_scene().scene(PLANE, "kind = \"mesh\"\nfile = \"hull.ply\"").refused(
        "hull.ply: file extension: found \".ply\", expected .stl, .obj, .asc, .tif, a mesh such as .cdb, or .dat, .txt, .tri or .srf with a list of \
         vertices and triangles",
    );
}

#[test]
fn recorded_names_twice() {
    grains_scene()
        .scene(
            "material = \"stone\"\n\n[time]",
            "material = \"stone\"\nrecord = true\nname = \"a\"\n\n[[walls]]\nkind = \"sphere\"\nbase = [0, 0, 0]\nradius = \
             9\nmaterial = \"stone\"\nname = \"a\"\nrecord = true\n\n[time]",
        )
        .refused("scene.toml:29: walls.1.name: found \"a\", expected a unique name");
}

#[test]
fn sleeper_on_a_recorded_plane() {
    coupled()
        .append(SCENE, "[[walls]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"stone\"\nrecord = true")
        .refused(
            "scene.toml:56: walls.0: found a plane with other keys, expected a plane with no key but `velocity`: sleepers contact only such planes",
        );
}
