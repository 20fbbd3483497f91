//! Bad input: meshed sleepers.

use super::{COUPLED, Good, SCENE};

const MESH: &str = "[track.sleeper.mesh]\nelements = [2, 2, 1]\nyoung = \"30 GPa\"\npoisson = 0.2";

/// Spheres on a block, meshed sleeper from line 36.
fn meshed() -> Good {
    Good::new(&COUPLED.replace("centre = [1.0, 1.0]", &format!("centre = [1.0, 1.0]\n\n{MESH}")))
}

#[test]
fn a_sleeper_without_elements() {
    meshed().scene("elements = [2, 2, 1]", "elements = [2, 0, 1]").refused(
        "scene.toml:37: track.sleeper.mesh.elements: found [2, 0, 1], expected three numbers of 1 or more, 100000 elements at most",
    );
}

#[test]
fn a_row_of_reduced_elements() {
    meshed().scene("elements = [2, 2, 1]", "elements = [4, 1, 1]").refused(
        "scene.toml:37: track.sleeper.mesh.elements: found [4, 1, 1], expected 2 or more along two axes, or `solid.integration = \
         \"full\"`: elements in a single row bend in ways that the reduced rule does not see",
    );
}

#[test]
fn a_sleeper_without_stiffness() {
    meshed()
        .scene("\"30 GPa\"", "0")
        .refused("scene.toml:38: track.sleeper.mesh.young: found 0, expected a modulus above 0");
    meshed()
        .scene("poisson = 0.2", "poisson = 0.5")
        .refused("scene.toml:39: track.sleeper.mesh.poisson: found 0.5, expected above -1 and below 0.5");
}

#[test]
fn missing_or_duplicate_sleeper_mass() {
    meshed().scene("poisson = 0.2", "poisson = 0.2\ndensity = 2400").refused(
        "scene.toml:40: track.sleeper.mesh.density: found together with track.sleeper.mass, expected only one of them",
    );
    meshed().scene("mass = 400\n", "").refused(
        "scene.toml:30: track.sleeper.mass: found nothing, expected it, or the density of a meshed sleeper",
    );
    meshed()
        .scene("mass = 400\n", "")
        .scene("poisson = 0.2", "poisson = 0.2\ndensity = -1")
        .refused("scene.toml:39: track.sleeper.mesh.density: found -1, expected a density above 0");
    Good::new(COUPLED)
        .scene("mass = 400\n", "")
        .refused("scene.toml:30: track.sleeper.mass: found nothing, expected the mass of a sleeper");
}

#[test]
fn a_sleeper_held_in_one_motion() {
    meshed().scene("centre = [1.0, 1.0]", "centre = [1.0, 1.0]\nhold = [\"y\", \"rx\"]").refused(
        "scene.toml:35: track.sleeper.hold: found [\"y\", \"rx\"], expected no key for a meshed sleeper, or a plane of symmetry: \
         [\"y\", \"rx\", \"rz\"] or [\"x\", \"ry\", \"rz\"], or both",
    );
}

#[test]
fn a_foot_beyond_the_edge() {
    meshed().scene("poisson = 0.2", "poisson = 0.2\nfoot = [0.2, 1.5]").refused(
        "scene.toml:40: track.sleeper.mesh.foot: found [0.2, 1.5], expected 0 to 1 and 0 to 1 m, which the seat at (0, 0) has \
         room for",
    );
}

#[test]
fn a_meshed_sleeper_without_a_solid() {
    meshed().set("solid=").refused("scene.toml:36: track.sleeper.mesh: found without [solid], expected both");
}

#[test]
fn keys_without_effect_on_meshed_sleeper() {
    meshed().append(SCENE, "[track.push]\ndirection = [1, 0]\nspeed = 0.01\ndisplacement = 0.01").refused(
        "scene.toml:61: track.push: found together with [track.sleeper.mesh], expected only one of them",
    );
    meshed()
        .append(SCENE, "[track.jump]\nmethod = \"displace\"")
        .refused(
            "scene.toml:62: track.jump.method: found \"displace\", expected \"extrapolate\". Meshed sleepers cannot be displaced",
        );
    meshed()
        .append(SCENE, "[track.rail]\nkind = \"beam\"\nbending_stiffness = 6e6\nfoundation = 2e7")
        .refused(
            "scene.toml:62: track.rail.kind: found \"beam\" on meshed sleepers, expected \"winkler\": a rail with mass needs rigid \
             sleepers",
        );
    meshed().append(SCENE, "[solid.reduction]\nkind = \"surface\"").refused(
        "scene.toml:61: solid.reduction: found together with [track.sleeper.mesh], expected only one of them",
    );
}
