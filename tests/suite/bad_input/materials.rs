//! Bad input: contact materials and laws.

use super::*;

#[test]
fn modulus_without_poisson() {
    grains_scene()
        .scene("stiffness = \"1 MN/m\"", "young = \"50 MPa\"")
        .refused("scene.toml:3: material.0.poisson: found nothing, expected Poisson's ratio with `young`");
}

#[test]
fn poisson_without_modulus() {
    grains_scene()
        .scene("friction = 0.5", "friction = 0.5\npoisson = 0.3")
        .refused("scene.toml:8: material.0.poisson: found without `young`, expected both");
    grains_scene()
        .scene("friction = 0.5", "friction = 0.5\nedge_factor = 2.0")
        .refused("scene.toml:8: material.0.edge_factor: found, but it has no effect without `young`");
    grains_scene()
        .scene("stiffness = \"1 MN/m\"", "young = \"10 GPa\"\npoisson = 0.2\nedge_factor = 0.0")
        .refused("scene.toml:8: material.0.edge_factor: found 0, expected 0.01 to 100");
}

#[test]
fn corners_out_of_place() {
    let elastic = "young = \"10 GPa\"\npoisson = 0.2";
    for (keys, message) in [
        (
            "corner_angle = \"80 deg\"",
            "scene.toml:8: material.0.corner_angle: found, but it has no effect without `corner_strength`",
        ),
        (
            "corner_strength = \"60 MPa\"",
            "scene.toml:3: material.0.corner_angle: found nothing, expected half the angle of the cones that crush",
        ),
        (
            "corner_strength = 0.0\ncorner_angle = 1.4",
            "scene.toml:8: material.0.corner_strength: found 0 Pa, expected above 0",
        ),
        (
            "corner_strength = 6e7\ncorner_angle = \"90 deg\"",
            "scene.toml:9: material.0.corner_angle: found 90 deg, expected above 0, below 90",
        ),
        (
            "corner_strength = \"2 GPa\"\ncorner_angle = \"85 deg\"",
            "scene.toml:8: material.0.corner_strength: found 2000000000, expected below 4.582e8 Pa with this modulus and angle, so that crushing dissipates energy",
        ),
    ] {
        grains_scene().scene("stiffness = \"1 MN/m\"", &format!("{elastic}\n{keys}")).refused(message);
    }
    let whole = format!("{elastic}\nnormal = \"hertz\"\ncorner_strength = 6e7\ncorner_angle = 1.4");
    grains_scene().scene("stiffness = \"1 MN/m\"", &whole).refused(
        "scene.toml:9: material.0.corner_strength: found, but it has no effect without a contact law with conical damage",
    );
    grains_scene()
        .scene("friction = 0.5", "friction = 0.5\ncorner_strength = 6e7\ncorner_angle = 1.4")
        .refused("scene.toml:8: material.0.corner_strength: found without `young`, expected both");
}

#[test]
fn two_laws_in_one_scene() {
    grains_scene()
        .scene("stiffness = \"1 MN/m\"", "stiffness = \"1 MN/m\"\nyoung = \"50 MPa\"\npoisson = 0.3")
        .refused(
            "scene.toml:6: material.0.stiffness: found together with `young` of \"stone\", expected only one of them",
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
        "scene.toml:24: time.impact_speed: found, but it has no effect without a material with `young`",
    );
}

#[test]
fn adhesion_below_zero() {
    let pair = "[[contact]]\nbetween = [\"stone\", \"stone\"]\nadhesion = -0.1\n";
    grains_scene()
        .scene("[time]", &format!("{pair}[time]"))
        .refused("scene.toml:24: contact.0.adhesion: found -0.1 J/m2, expected 0 or more");
}

const PAIR: &str = "[[contact]]\nbetween = [\"stone\", \"stone\"]\n";

#[test]
fn unknown_normal_law() {
    grains_scene().scene("friction = 0.5", "friction = 0.5\nnormal = \"herz\"").refused(
        "scene.toml:8: material.0.normal: found \"herz\", expected one of linear, hertz, walton_braun, conical_damage",
    );
}

#[test]
fn laws_that_do_not_go_together() {
    grains_scene().scene("[time]", &format!("{PAIR}normal = \"linear\"\ntangential = \"mindlin\"\n[time]")).refused(
        "scene.toml:24: contact.0.normal: found for \"stone\" and \"stone\" normal law \"linear\" with tangential law \"mindlin\", \
         an unsupported combination, expected a law for each pair of materials, from both or from `normal` of their [[contact]]",
    );
}

#[test]
fn different_laws_without_pair_law() {
    let glass = "[[material]]\nname = \"glass\"\nyoung = \"50 MPa\"\npoisson = 0.3\nfriction = 0.5\nrestitution = 0.4\n";
    grains_scene().scene("[time]", &format!("{glass}[time]")).refused(
        "scene.toml:22: material.1: found for \"stone\" and \"glass\" different normal laws, \"linear\" and \"hertz\", and none \
         for the pair, expected a law for each pair of materials, from both or from `normal` of their [[contact]]",
    );
}

#[test]
fn damping_ratio_without_its_part() {
    grains_scene().scene("[time]", &format!("{PAIR}damping_ratio = 0.2\n[time]")).refused(
        "scene.toml:24: contact.0.damping_ratio: found, but it has no effect without `damping = \"ratio\"`",
    );
}

#[test]
fn hertz_without_a_modulus() {
    grains_scene().scene("stiffness = \"1 MN/m\"", "normal = \"hertz\"").refused(
        "scene.toml:3: material.0.young: found nothing, expected a value for this key, which `normal = \"hertz\"` needs",
    );
}

#[test]
fn damping_without_dashpot() {
    let pair = format!("{PAIR}normal = \"walton_braun\"\ndamping = \"none\"\n[time]");
    grains_scene().scene("[time]", &pair).refused(
        "scene.toml:25: contact.0.damping: found, but it has no effect without a dashpot. The normal law \"walton_braun\" has no dashpot.",
    );
}
