//! Bad input: inlets and outlets.

use super::*;

const INLET: &str = "inlet = { box = [[0, 0, 1], [1, 1, 2]], rate = \"2 kg/s\" }";
const OUTLET: &str = "[[outlet]]\npoint = [0, 0, -1]\nnormal = [0, 0, -1]\nrecycle = true\n\n[[walls]]";

fn flow() -> Good {
    grains_scene().scene(SPHERES, &format!("{SPHERES}\n{INLET}")).scene("[[walls]]", OUTLET)
}

fn waiting() -> Good {
    let source = format!("count = 5\nsize = [0.02, 0.03]\n{INLET}");
    grains_scene().scene(SPHERES, &source).scene("[[walls]]", OUTLET)
}

#[test]
fn box_of_an_inlet_inside_out() {
    flow().scene("[1, 1, 2]]", "[1, 1, 0.5]]").refused(
        "scene.toml:15: grains.0.inlet.box: found corners in another order, expected the lower corner, then the upper",
    );
}

#[test]
fn inlet_box_smaller_than_grain() {
    waiting().scene("[1, 1, 2]]", "[1, 1, 1.025]]").refused(
        "scene.toml:16: grains.0.inlet.box: found a box 0.0250 m wide, expected at least 0.0291 m, for the largest grain",
    );
}

#[test]
fn two_rates() {
    flow().scene("rate = \"2 kg/s\"", "rate = 2, grains_per_second = 3").refused(
        "scene.toml:15: grains.0.inlet.rate: found together with `grains_per_second`, expected only one of them",
    );
}

#[test]
fn rate_of_zero() {
    flow()
        .scene("rate = \"2 kg/s\"", "rate = 0")
        .refused("scene.toml:15: grains.0.inlet.rate: found 0, expected above 0");
    flow()
        .scene("rate = \"2 kg/s\"", "grains_per_second = -1")
        .refused("scene.toml:15: grains.0.inlet.grains_per_second: found -1, expected above 0");
}

#[test]
fn rate_in_another_unit() {
    flow().scene("2 kg/s", "2 kg").refused(
        "scene.toml:15: grains.0.inlet.rate: found string \"2 kg\", expected a mass per time in kg/s, such as 2 or \"2 kg/s\"",
    );
}

#[test]
fn inlet_start_outside_run() {
    flow()
        .scene("rate = \"2 kg/s\"", "rate = 2, start = -1")
        .refused("scene.toml:15: grains.0.inlet.start: found -1, expected 0 or more");
    flow()
        .scene("rate = \"2 kg/s\"", "rate = 2, start = 1")
        .refused("scene.toml:15: grains.0.inlet.start: found 1 s, expected a time before the end at 0.02 s");
}

#[test]
fn inlet_that_stops_before_it_starts() {
    flow()
        .scene("rate = \"2 kg/s\"", "rate = 2, start = 0.01, stop = 0.01")
        .refused("scene.toml:15: grains.0.inlet.stop: found 0.01, expected a time after the start");
}

#[test]
fn inlet_that_nothing_comes_to() {
    flow().scene("recycle = true", "recycle = false").refused(
        "scene.toml:15: grains.0.inlet: found an inlet without grains to insert, expected an [[outlet]] with `recycle = true` for \
         this group, or no grains at the start",
    );
}

#[test]
fn inlet_of_a_grip() {
    flow().scene(INLET, &format!("prescribed_velocity = [0, 0, 0]\n{INLET}")).refused(
        "scene.toml:16: grains.0.inlet: found an inlet, expected no inlet for a group with `prescribed_velocity`",
    );
}

#[test]
fn inlet_of_bonded_stones() {
    waiting()
        .scene("shape = \"sphere\"", "shape = \"bonded\"")
        .refused("scene.toml:12: grains.0.shape: found \"bonded\", expected no inlet for bonded stones");
}

#[test]
fn grains_that_wait_without_a_number() {
    waiting()
        .scene("count = 5\n", "")
        .refused("scene.toml:10: grains.0.count: found nothing, expected the number of grains to insert");
}

#[test]
fn grains_that_wait_with_a_velocity() {
    waiting().scene("count = 5", "count = 5\nvelocity = [0, 0, 1]").refused(
        "scene.toml:15: grains.0.velocity: found together with `inlet`, expected only one of them. Use `inlet.velocity`.",
    );
}

#[test]
fn inlet_across_a_border() {
    flow().scene("[[walls]]", "[periodic]\nx = [-0.5, 0.5]\n\n[[walls]]").refused(
        "scene.toml:15: grains.0.inlet.box: found x from 0 to 1, expected a box between the borders -0.5 and 0.5 of `periodic`",
    );
}

#[test]
fn outlet_of_two_forms() {
    flow().scene("recycle = true", "recycle = true\nbox = [[0, 0, 0], [1, 1, 1]]").refused(
        "scene.toml:17: outlet.0: found another choice of keys, expected either `box`, or `point` and `normal`",
    );
    flow().scene("normal = [0, 0, -1]\n", "").refused(
        "scene.toml:17: outlet.0: found another choice of keys, expected either `box`, or `point` and `normal`",
    );
}

#[test]
fn outlet_without_direction_or_volume() {
    flow()
        .scene("normal = [0, 0, -1]", "normal = [0, 0, 0]")
        .refused("scene.toml:19: outlet.0.normal: found 0, expected a vector that is not null");
    flow().scene("point = [0, 0, -1]\nnormal = [0, 0, -1]", "box = [[0, 0, 0], [1, 0, 1]]").refused(
        "scene.toml:18: outlet.0.box: found corners in another order, expected the lower corner, then the upper",
    );
}

#[test]
fn outlet_of_unknown_groups() {
    flow().scene("recycle = true", "recycle = true\ngroups = [\"other\"]").refused(
        "scene.toml:21: outlet.0.groups: found \"other\", expected the name of a [[grains]] without `prescribed_velocity`: pair",
    );
    flow()
        .scene("recycle = true", "recycle = true\ngroups = []")
        .refused("scene.toml:21: outlet.0.groups: found none, expected at least one group that moves freely");
}

#[test]
fn outlet_that_sends_grains_nowhere() {
    flow().scene(INLET, "").refused(
        "scene.toml:20: outlet.0.recycle: found true, expected an `inlet` in the group \"pair\", which it takes",
    );
}

#[test]
fn outlets_of_one_name() {
    let again = "recycle = true\nname = \"outlet1\"\n\n[[outlet]]\npoint = [0, 0, -1]\nnormal = [1, 0, 0]";
    flow()
        .scene("recycle = true", again)
        .refused("scene.toml:23: outlet.1.name: found \"outlet1\" again, expected each name once");
}

#[test]
fn flow_beside_bonds() {
    let bond = "[[bond]]\nname = \"cement\"\ngap = \"5 mm\"\n[bond.parallel]\nyoung = \"1 MPa\"\n\n[[walls]]";
    flow()
        .scene("[[walls]]", bond)
        .refused("scene.toml:15: grains.0.inlet: found together with [[bond]], expected only one of them");
}

#[test]
fn inlet_beside_cycle_jumps() {
    let sleeper = "[track.sleeper]\nsize = [0.1, 0.1, 0.1]\nmass = 1\nmaterial = \"stone\"\ncentre = [0.1, 0.1]\n\n[track.jump]\n\n[time]";
    flow().scene("[time]", sleeper).refused(
        "scene.toml:15: grains.0.inlet: found together with [track.jump], expected only one of them",
    );
    // Outlets trim slopes, so they are accepted.
    let jump = "[[outlet]]\npoint = [9, 0, 0]\nnormal = [1, 0, 0]\n\n[track.jump]\n\n[coupling]";
    coupled()
        .scene("[coupling]", jump)
        .refused("scene.toml:49: track.jump.first: found 100, expected fewer than the 2 cycles of the load");
}

#[test]
fn interval_without_flow() {
    grains_scene().scene("end = \"20 ms\"", "end = \"20 ms\"\nflow_interval = 0.001").refused(
        "scene.toml:24: time.flow_interval: found, but it has no effect without an `inlet` or an [[outlet]]",
    );
    flow()
        .scene("end = \"20 ms\"", "end = \"20 ms\"\nflow_interval = 0")
        .refused("scene.toml:30: time.flow_interval: found 0, expected a time above 0");
    solid()
        .scene("[output]", "[time]\nflow_interval = 1\n\n[output]")
        .refused("scene.toml:24: time.flow_interval: found, but it has no effect without [[grains]]");
}

#[test]
fn outlet_without_grains() {
    solid()
        .scene("[output]", "[[outlet]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n\n[output]")
        .refused("scene.toml:23: outlet: found, but it has no effect without [[grains]]");
}

#[test]
fn replaced_key_of_outlet() {
    flow()
        .scene("recycle = true", "again = true\nrecycle = true")
        .refused("scene.toml:20: outlet.0.again: found together with `recycle`, expected only one of them");
}
