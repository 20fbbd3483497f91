use super::*;
use crate::write::sample::{self, folder};
use crate::write::vtk_oracle::python;
use std::fmt::Write as _;
use std::process::Command;

fn read(python: &Path, file: &Path) -> String {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/vtkhdf_check.py");
    let output = Command::new(python).arg(script).arg(file).output().expect("the interpreter starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn picked(count: usize) -> Vec<usize> {
    if count == 0 { Vec::new() } else { vec![0, count / 2, count - 1] }
}

fn array(out: &mut String, name: &str, components: usize, values: &[f64]) {
    let items = picked(values.len() / components);
    let numbers = items.into_iter().flat_map(|i| &values[components * i..components * (i + 1)]);
    let text: String = numbers.map(|v| format!(" {v:.17e}")).collect();
    writeln!(out, "  {name} {components}{text}").unwrap();
}

fn grains(count: usize, time: f64) -> GrainFrame {
    let v = |i: usize, d: f64| [i as f64 + d, time * d, -(i as f64)];
    let mut frame = sample::grains(count, |i| v(i, 0.25));
    for (k, (name, values)) in frame.fields.iter_mut().enumerate() {
        match values {
            FieldValues::Vectors(values) => *values = (0..count).map(|i| v(i, k as f64)).collect(),
            FieldValues::Quaternions(values) => {
                *values = (0..count).map(|i| [1.0, time, 0.0, i as f64]).collect();
            }
            FieldValues::Numbers(values) => {
                *values = (0..count).map(|i| 0.1 * k as f64 + i as f64 - time).collect()
            }
            FieldValues::Counts(values) if *name == "id" => *values = (0..count as u32).collect(),
            FieldValues::Counts(values) => *values = vec![k as u32; count],
        }
    }
    frame
}

fn expected_grains(count: usize, time: f64) -> String {
    let f = grains(count, time);
    let mut out = format!("t = {time:.17e}: {count} points, {count} cells\n");
    array(&mut out, "points", 3, f.position.as_flattened());
    let by_name: std::collections::BTreeMap<_, _> =
        f.fields.iter().map(|(name, values)| (name, values)).collect();
    for (name, values) in by_name {
        match values {
            FieldValues::Vectors(values) => array(&mut out, name, 3, values.as_flattened()),
            FieldValues::Quaternions(values) => array(&mut out, name, 4, values.as_flattened()),
            FieldValues::Numbers(values) => array(&mut out, name, 1, values),
            FieldValues::Counts(values) => {
                array(&mut out, name, 1, &values.iter().map(|n| f64::from(*n)).collect::<Vec<_>>());
            }
        }
    }
    out
}

fn write(writer: &mut dyn Writer, number: usize, grains: &GrainFrame) {
    let frame = Frame { number, time: 0.5 * number as f64, grains: Some(grains), ..Frame::default() };
    writer.frame(&frame).unwrap();
}

#[test]
fn vtk_reads_changing_grain_number() {
    let Some(python) = python() else { return };
    let dir = folder("vtkhdf_grains");
    let counts = [3, 3, 5, 0, 5, 1];
    let mut writer = begin(&dir, None).unwrap();
    for (number, count) in counts.into_iter().enumerate() {
        write(&mut *writer, number, &grains(count, 0.5 * number as f64));
    }
    let times = counts.iter().enumerate();
    let expected: String = times.map(|(k, count)| expected_grains(*count, 0.5 * k as f64)).collect();
    assert_eq!(read(&python, &dir.join("grains.vtkhdf")), expected);
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn vtk_reads_index_of_three_levels() {
    let Some(python) = python() else { return };
    let dir = folder("vtkhdf_long");
    let (count, steps) = (9_000, 80);
    let mut writer = begin(&dir, None).unwrap();
    (0..60).for_each(|k| write(&mut *writer, k, &grains(count, 0.5 * k as f64)));
    let mark = writer.mark();
    (60..70).for_each(|k| write(&mut *writer, k, &grains(count, -1.0)));
    drop(writer);
    let mut writer = begin(&dir, Some(&mark)).unwrap();
    (60..steps).for_each(|k| write(&mut *writer, k, &grains(count, 0.5 * k as f64)));
    let expected: String = (0..steps).map(|k| expected_grains(count, 0.5 * k as f64)).collect();
    assert!(read(&python, &dir.join("grains.vtkhdf")) == expected, "VTK finds other values");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn vtk_reads_solid_at_all_times() {
    let Some(python) = python() else { return };
    let dir = folder("vtkhdf_solid");
    let mesh = sample::block([2, 1, 1]);
    let n = mesh.node_count();
    let mut writer = begin(&dir, None).unwrap();
    let mut expected = String::new();
    let whole = |list: &[u32]| list.iter().map(|n| f64::from(*n)).collect::<Vec<_>>();
    for number in 0..3 {
        let time = 0.5 * number as f64;
        let vector: Vec<f64> = (0..3 * n).map(|i| time + i as f64).collect();
        let stress: Vec<[f64; 6]> = (0..n).map(|i| [time, 1.0, 2.0, 3.0, 4.0, i as f64]).collect();
        let scalar: Vec<f64> = (0..n).map(|i| time * i as f64).collect();
        let solid = sample::solid(&mesh, &vector, &stress, &scalar);
        writer.frame(&Frame { number, time, solid: Some(&solid), ..Frame::default() }).unwrap();
        writeln!(expected, "t = {time:.17e}: {n} points, 2 cells").unwrap();
        array(&mut expected, "points", 3, mesh.coordinates.as_flattened());
        array(&mut expected, "displacement", 3, &vector);
        array(&mut expected, "equivalent_plastic_strain", 1, &scalar);
        array(&mut expected, "node_id", 1, &whole(&mesh.node_ids));
        array(&mut expected, "stress", 9, &matrices(&stress));
        array(&mut expected, "velocity", 3, &vector);
        array(&mut expected, "von_mises", 1, &scalar);
        array(&mut expected, "yield_function", 1, &scalar);
        array(&mut expected, "element_id of cells", 1, &whole(&mesh.element_ids));
        array(&mut expected, "material of cells", 1, &whole(&mesh.materials));
    }
    assert_eq!(read(&python, &dir.join("solid.vtkhdf")), expected);
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn drops_frame_with_nonfinite_value() {
    let dir = folder("vtkhdf_nan");
    let file = dir.join("grains.vtkhdf");
    let mut writer = begin(&dir, None).unwrap();
    write(&mut *writer, 0, &grains(4, 0.0));
    let before = std::fs::read(&file).unwrap();
    let mut bad = grains(4, 0.5);
    let force = bad.fields.iter().position(|field| field.0 == "force").unwrap();
    let FieldValues::Vectors(values) = &mut bad.fields[force].1 else { unreachable!() };
    values[2][1] = f64::NAN;
    let frame = Frame { number: 1, time: 0.5, grains: Some(&bad), ..Frame::default() };
    let error = writer.frame(&frame).unwrap_err();
    assert_eq!(error.to_string(), format!("{}: force at index 2 is NaN: not written", file.display()));
    assert!(std::fs::read(&file).unwrap() == before);
    std::fs::remove_dir_all(&dir).unwrap();
}
