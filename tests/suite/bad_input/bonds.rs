//! Bad input: bonds.

use super::*;

const CEMENT: &str =
    "[[bond]]\nname = \"cement\"\ngap = \"5 mm\"\n[bond.parallel]\nyoung = \"1 MPa\"\n\n[[walls]]";

fn bonded() -> Good {
    grains_scene().scene("[[walls]]", CEMENT)
}

#[test]
fn bonds_that_join_nothing() {
    bonded().scene("gap = \"5 mm\"", "gap = \"0.1 mm\"").only_run_sees_it().refused(
        "scene.toml:16: bond.0: found no pair for \"cement\", expected a bond that joins grains: a larger `gap`, or other \
         groups",
    );
}

#[test]
fn bonds_across_many_spheres() {
    bonded().scene("gap = \"5 mm\"", "gap = \"0.6 m\"").refused(
        "scene.toml:18: bond.0.gap: found 0.6 m, expected at most 10 times the largest radius, which is 5.000e-2 m",
    );
}

#[test]
fn two_kinds_of_bond() {
    bonded()
        .scene("[bond.parallel]", "[bond.direct]\nstiffness = [1, 1, 1, 1]\n[bond.parallel]")
        .refused("scene.toml:21: bond.0.parallel: found together with `direct`, expected only one of them");
}

#[test]
fn strength_below_zero() {
    bonded()
        .scene("young = \"1 MPa\"", "young = \"1 MPa\"\ntensile_strength = -1")
        .refused("scene.toml:21: bond.0.parallel.tensile_strength: found -1, expected 0 or more");
}

#[test]
fn bonds_between_unknown_groups() {
    bonded()
        .scene("gap = ", "between = [\"pair\", \"other\"]\ngap = ")
        .refused("scene.toml:18: bond.0.between: found \"other\", expected the name of a [[grains]]: pair");
}

#[test]
fn pair_of_one_grain() {
    bonded()
        .scene("gap = \"5 mm\"", "pairs = \"pairs.csv\"")
        .file("pairs.csv", "a,b\n0,0\n")
        .refused("pairs.csv:2: pair: found 0, 0, expected two different numbers of grains, 0 to 1");
}

#[test]
fn spread_without_its_number() {
    bonded().scene("young = \"1 MPa\"", "young = \"1 MPa\"\n[bond.spread]\nkind = \"weibull\"\ndeviation = 0.1").refused(
        "scene.toml:21: bond.0.spread: found other keys, expected `deviation` for `normal`, `modulus` for `weibull`",
    );
}

#[test]
fn bonded_stones_without_their_bond() {
    grains_scene().scene("shape = \"sphere\"", "shape = \"bonded\"").refused(
        "scene.toml:12: grains.0.shape: found \"bonded\", expected `fill`, which bonded stones need",
    );
}

#[test]
fn velocity_of_a_grip() {
    bonded()
        .scene("shape = \"sphere\"", "shape = \"sphere\"\nprescribed_velocity = [0, 0, 0]\nvelocity = [0, 0, 1]")
        .refused("scene.toml:14: grains.0.velocity: found together with `prescribed_velocity`, expected only one of them");
}

#[test]
fn replaced_key_of_strength_spread() {
    let spread = "young = \"1 MPa\"\n[bond.spread]\nkind = \"normal\"\ndeviation = 0.1\ntogether = true\ncorrelated = true";
    bonded().scene("young = \"1 MPa\"", spread).refused(
        "scene.toml:24: bond.0.spread.together: found together with `correlated`, expected only one of them",
    );
}
