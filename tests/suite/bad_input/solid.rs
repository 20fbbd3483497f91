//! Bad input: solid mesh, yield criteria, supports, solution methods.

use super::*;

#[test]
fn two_sources_of_the_mesh() {
    plastic()
        .set("solid.mesh=some.msh")
        .refused("--set: solid.mesh: found together with `block`, expected only one of them");
}

#[test]
fn nodes_without_elements() {
    solid()
        .scene("elements = \"ELEMENTNUM.DAT\"\n", "")
        .refused("scene.toml:4: solid.nodes: found without `elements`, expected both");
}

#[test]
fn block_lines_that_turn_back() {
    plastic().scene("[0.0, 0.4, 1.0]", "[0.0, 0.4, 0.3]").refused(
        "scene.toml:9: solid.block.z.lines: found [0.0, 0.4, 0.3], expected two or more ascending coordinates",
    );
}

#[test]
fn block_counts_differ_from_intervals() {
    plastic().scene("counts = [1, 1]", "counts = [1]").refused(
        "scene.toml:9: solid.block.z.counts: found [1], expected 2 numbers of 1 or more, one for each interval of `lines`",
    );
}

#[test]
fn block_layer_above_the_top() {
    plastic()
        .scene("{ material = 2 }", "{ material = 2, top = 1.5 }")
        .refused("scene.toml:10: solid.block.layer.1.top: found 1.5 m, expected above 0.4 m, at most 1 m");
}

#[test]
fn block_inverted_by_crest() {
    plastic()
        .set("solid.block.crest=[0.9, 0.1]")
        .refused("--set: solid.block.crest: found 0.1, expected an end beyond its beginning");
}

#[test]
fn constraints_of_a_block() {
    plastic()
        .set("solid.constraints=DOF.DAT")
        .refused("--set: solid.constraints: found, but it has no effect without `nodes` and `elements`");
}

#[test]
fn friction_near_a_right_angle() {
    for angle in ["90", "89.99", "80.01"] {
        plastic().scene("\"25 deg\"", &format!("\"{angle} deg\"")).refused(&format!(
            "scene.toml:27: solid.material.1.friction: found {angle} deg, expected an angle of 80 degrees at most",
        ));
    }
}

#[test]
fn dilation_above_friction() {
    plastic().scene("\"5 deg\"", "\"26 deg\"").refused(
        "scene.toml:28: solid.material.1.dilation: found 26 deg, expected between 0 and the smallest friction angle",
    );
}

#[test]
fn tension_beyond_the_apex() {
    plastic().scene("\"5 deg\"", "\"5 deg\"\ntension = \"50 kPa\"").refused(
        "scene.toml:29: solid.material.1.tension: found 50000, expected at most c cot(phi), the apex",
    );
}

#[test]
fn no_strength_at_all() {
    plastic().scene("\"20 kPa\"", "0").scene("\"25 deg\"", "0").scene("\"5 deg\"", "0").refused(
        "scene.toml:26: solid.material.1.cohesion: found 0, expected a value above 0 if the friction angle is 0",
    );
}

#[test]
fn missing_dilation() {
    plastic().scene("dilation = \"5 deg\"\n", "").refused(
        "scene.toml:19: solid.material.1.dilation: found nothing, expected a value for the model `mohr_coulomb`",
    );
}

#[test]
fn cone_of_mohr_coulomb() {
    plastic().scene("\"5 deg\"", "\"5 deg\"\ncone = \"compression\"").refused(
        "scene.toml:29: solid.material.1.cone: found, but it has no effect without `model = \"drucker_prager\"`",
    );
}

#[test]
fn drucker_prager_without_a_cone() {
    plastic().scene("\"mohr_coulomb\"", "\"drucker_prager\"").refused(
        "scene.toml:19: solid.material.1.cone: found nothing, expected \"compression\", \"extension\" or \"plane_strain\"",
    );
}

#[test]
fn strength_of_an_elastic_material() {
    plastic().set("solid.material.0.cohesion=1").refused(
        "--set: solid.material.0.cohesion: found, but it has no effect without `model = \"mohr_coulomb\"` or `\"drucker_prager\"`",
    );
}

#[test]
fn hardening_table_that_turns_back() {
    let table = "hardening_table = [[0.0, 20e3], [0.1, 30e3], [0.05, 40e3]]";
    let good = plastic().scene("cohesion = \"20 kPa\"", table);
    let outcome = run(&good.folder.join(SCENE), &good.folder.join("fresh"), &[]);
    assert!(
        outcome.code == 2
            && outcome.stderr.contains("scene.toml:26: solid.material.1.hardening_table: found"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn support_in_a_fourth_direction() {
    plastic().scene("[\"x\", \"y\", \"z\"]", "[\"x\", \"w\"]").refused(
        "scene.toml:33: solid.support.0.directions: found \"w\", expected one or more of \"x\", \"y\", \"z\", each once",
    );
}

#[test]
fn support_without_a_place() {
    plastic().scene("side = \"z-\"\n", "").refused(
        "scene.toml:30: solid.support.0.side: found nothing, expected `side`, `nodes_in`, `set` or `node`",
    );
}

#[test]
fn support_where_no_node_is() {
    plastic()
        .scene("side = \"z-\"", "nodes_in = [[0, 0, 2], [1, 1, 3]]")
        .refused("scene.toml:32: solid.support.0.nodes_in: found no node in the box, expected at least one");
}

#[test]
fn set_missing_in_mesh() {
    plastic().scene("side = \"z-\"", "set = \"bottom\"").refused(
        "scene.toml:32: solid.support.0.set: found \"bottom\", expected the name of a node set (the mesh file contains no sets)",
    );
}

#[test]
fn two_courses_for_one_node() {
    plastic().scene("side = \"z-\"", "nodes_in = [[0, 0, 0], [1, 1, 1]]").refused(
        "scene.toml:35: solid.support.1: found node 39 in z, which solid.support.0 holds already, expected one time history for \
         each direction of a node",
    );
}

#[test]
fn an_unheld_block() {
    plastic().scene("[\"x\", \"y\", \"z\"]", "[\"z\"]").refused(
        "scene.toml: constraints: found too few (insufficiently constrained: rigid-body motion of node 1 in x; add supports), expected supports that prevent rigid-body motion",
    );
}

#[test]
fn absorbing_faces_inside() {
    let absorbing =
        "[[solid.absorbing]]\nfaces_in = [[0.2, 0.2, 0.2], [0.3, 0.3, 0.3]]\n\n[solid.quasi_static]";
    plastic().scene("[solid.quasi_static]", absorbing).refused(
        "scene.toml:43: solid.absorbing.0.faces_in: found no boundary face in the box, expected at least one",
    );
}

#[test]
fn a_plastic_solid_without_steps() {
    plastic()
        .scene("[solid.quasi_static]\n", "")
        .scene("[time]\nend = 1.0\nsolid_step = 0.1\n", "")
        .refused(
            "scene.toml:3: solid: found a material that yields, and one static solve, expected [solid.quasi_static], \
             [solid.dynamics] or [solid.strength_reduction]",
        );
}

#[test]
fn two_ways_to_solve() {
    plastic().set("solid.dynamics={}").refused(
        "scene.toml:42: solid.quasi_static: found together with `dynamics`, expected only one of them",
    );
}

#[test]
fn newton_of_an_elastic_solid() {
    solid().set("solid.newton.tolerance=1e-8").refused(
        "--set: solid.newton: found, but it has no effect without a plastic material or [solid.initial_stress]",
    );
}

#[test]
fn newton_tolerance_of_two_per_cent() {
    plastic()
        .set("solid.newton.tolerance=0.02")
        .refused("--set: solid.newton.tolerance: found 0.02, expected 1e-12 to 0.01");
}

#[test]
fn strength_reduction_of_an_elastic_solid() {
    solid().set("solid.strength_reduction={}").refused(
        "--set: solid.strength_reduction: found elastic materials only, expected a material that yields",
    );
}

#[test]
fn hht_beside_newmark() {
    solid()
        .set("solid.dynamics={hht_alpha=-0.1, gamma=0.6}")
        .refused("--set: solid.dynamics.gamma: found together with `hht_alpha`, expected only one of them");
}

#[test]
fn hht_above_zero() {
    solid()
        .set("solid.dynamics={hht_alpha=0.1}")
        .refused("--set: solid.dynamics.hht_alpha: found 0.1, expected -1/3 to 0");
}

#[test]
fn k0_of_gravity() {
    plastic()
        .set("solid.initial_stress={method=\"gravity\", k0=0.5}")
        .refused("--set: solid.initial_stress.k0: found, but it has no effect without `method = \"k0\"`");
}

#[test]
fn k0_missing() {
    plastic().set("solid.initial_stress={method=\"k0\"}").refused(
        "--set: solid.initial_stress.k0: found nothing, expected a value, or a separate one for base",
    );
}

#[test]
fn history_table_that_turns_back() {
    plastic()
        .scene("{ kind = \"ramp\", duration = 1.0 }", "{ kind = \"table\", points = [[0, 0], [1, 1], [0.5, 2]] }")
        .refused(
            "scene.toml:40: solid.support.1.history.points: found 3 points, expected points with ascending times",
        );
}

#[test]
fn history_file_with_a_word() {
    plastic()
        .file("course.csv", "time,factor\n0,0\n1,much\n")
        .scene("{ kind = \"ramp\", duration = 1.0 }", "{ kind = \"table\", file = \"course.csv\" }")
        .refused("course.csv:3: factor: found \"much\", expected a number");
}

#[test]
fn a_solid_that_will_not_fit() {
    let good = plastic();
    let scene = good.folder.join(SCENE);
    for command in ["run", "check"] {
        let outcome = trackbed([command, &scene.display().to_string(), "--memory", "1MB"].map(String::from));
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""));
        assert!(
            outcome.stderr.starts_with("error: memory: found ")
                && outcome.stderr.contains("expected at most 1 MB (--memory)"),
            "{}",
            outcome.stderr
        );
    }
}
