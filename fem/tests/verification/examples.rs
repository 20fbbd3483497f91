//! Examples of the crate as tests.

#[path = "../../examples/cantilever.rs"]
mod cantilever;
#[path = "../../examples/free_vibration.rs"]
mod free_vibration;
#[path = "../../examples/triaxial_point.rs"]
mod triaxial_point;

#[test]
fn cantilever_bends_as_timoshenko_says() {
    cantilever::main().unwrap();
}

#[test]
fn every_method_reproduces_column_period() {
    free_vibration::main().unwrap();
}

#[test]
fn triaxial_point_reaches_its_strength() {
    triaxial_point::main().unwrap();
}
