//! Programs in `examples/`.

#[path = "../../examples/mesh.rs"]
mod mesh;
#[path = "../../examples/parameter_study.rs"]
mod parameter_study;

use approx::assert_relative_eq;

#[test]
fn friction_leaves_fewer_contacts() {
    let [smooth, rough] = parameter_study::study(&[0.1, 0.5]).unwrap()[..] else { panic!("two values") };
    // Isostatic: 6 contacts without friction, 4 with high friction; fewer at boundaries.
    assert!(smooth < 6.0 && rough < smooth - 0.3 && rough > 3.0, "{smooth}, {rough}");
    parameter_study::main().unwrap();
}

#[test]
fn meshes_keep_their_volume() {
    mesh::main().unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let [before, after] = mesh::round_trip(&root.join("inputs/track/cyclic"), "cdb").unwrap();
    assert_relative_eq!(before, after, max_relative = 1e-12);
    assert!(before > 1.0);
}
