use super::super::choice::Choice;
use super::*;
use crate::write::{sample, vtu};
use std::time::Instant;

#[test]
fn writes_symmetric_tensor_by_rows() {
    // xx, yy, zz, xy, yz, zx
    let matrix = matrices(&[[11.0, 22.0, 33.0, 12.0, 23.0, 31.0]]);
    assert_eq!(matrix, [11.0, 12.0, 31.0, 12.0, 22.0, 23.0, 31.0, 23.0, 33.0]);
}

#[test]
fn first_field_is_active() {
    let mut fields = Fields::of_points(Path::new("a.vtu"), 1);
    fields.vector("displacement", &[0.0; 3]).unwrap();
    fields.vector("velocity", &[0.0; 3]).unwrap();
    fields.scalar("von_mises", &[0.0]).unwrap();
    let section = fields.finish();
    assert_eq!(
        section.active,
        [("Vectors", "displacement".to_string()), ("Scalars", "von_mises".to_string())]
    );
}

/// Prints times of a vector field and a solid frame.
#[test]
#[ignore = "prints times"]
fn time_of_field_and_frame() {
    let noise = |i: usize| (0.37 * i as f64).sin() * 1e-3;
    let field: Vec<f64> = (0..3 * 13_480).map(noise).collect();
    let array = Array::doubles("velocity", &field, 3);
    let fastest = |act: &dyn Fn()| {
        let times = (0..20).map(|_| {
            let begun = Instant::now();
            act();
            begun.elapsed()
        });
        times.min().unwrap()
    };
    let one = fastest(&|| drop(array.encoded().unwrap()));
    let dir = sample::folder("vtk_time");
    let mesh = sample::block([15, 15, 12]);
    let n = mesh.node_count();
    let vector: Vec<f64> = (0..3 * n).map(noise).collect();
    let stress: Vec<[f64; 6]> = (0..n).map(|i| [0, 1, 2, 3, 4, 5].map(|c| noise(6 * i + c))).collect();
    let scalar: Vec<f64> = (0..n).map(noise).collect();
    let frame = sample::solid(&mesh, &vector, &stress, &scalar);
    let file = dir.join("solid.vtu");
    let whole = fastest(&|| vtu::write_solid(&file, &frame, Choice::default()).unwrap());
    let size = std::fs::metadata(&file).unwrap().len();
    println!("field of 13480 vectors: {one:?}; frame of a solid of {n} nodes: {whole:?}, {size} bytes");
    std::fs::remove_dir_all(&dir).unwrap();
}
