//! Bad input: missing files and mesh lists.

use super::*;

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
    grains_scene()
        .scene("shape = \"sphere\"", "shape = \"clump\"")
        .scene(SPHERES, &format!("library = \"stones.toml\"\ncount = 3\nsize = [0.1, 0.1]\n{FILL}"))
        .refused("stones.toml: file: found No such file or directory (os error 2), expected a readable file");
}

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
    // Bottom and top swapped: I…L with M…P, Q…T with U…X.
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
    solid().field(NODES, 41, 3, "2.5").refused(
        "ELEMENTNUM.DAT: element 1: found a Jacobian determinant of -7.736875e-3 m3 at (-0.77, 0.00, -0.77): \
         inverted or flat, expected a determinant above 0",
    );
}

#[test]
fn degenerate_element() {
    solid().line(ELEMENTS, 2, |fields| fields[5] = fields[4].clone()).refused(
        "ELEMENTNUM.DAT:2: element 2: found node 13 more than once, expected different nodes, or those of a wedge \
         (K = L, O = P), a pyramid (M = N = O = P) or a tetrahedron (both)",
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
        .refused("NODECOORD.DAT: nodes: found none, expected at least 4 rows of id x y z");
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
        "ELEMENTNUM.DAT: constraints: found too few (insufficiently constrained: rigid-body motion of node 1 in x; add supports), expected supports that prevent rigid-body motion",
    );
}

#[test]
fn unsupported_body_under_grains() {
    coupled().scene("constraints = \"DOF.DAT\"\n", "").refused(
        "ELEMENTNUM.DAT: constraints: found too few (insufficiently constrained: rigid-body motion of node 1 in x; add supports), expected supports that prevent rigid-body motion",
    );
}

#[test]
fn body_held_at_one_node() {
    solid().file(DOF, "1 1 0\n1 2 0\n1 3 0\n").refused(
        "DOF.DAT: constraints: found too few (insufficiently constrained: rigid-body motion of node 77 in x; add supports), expected supports that prevent rigid-body motion",
    );
}
