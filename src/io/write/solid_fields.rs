//! Nodal fields of the solid. A new field needs a row here and an arm of `solid_values` in `run/frames.rs`.

use super::fields::Needs::Nothing;
use super::fields::Written::{Always, ByDefault, OnRequest};
use super::fields::{FrameField, field};

/// All fields, in the order of files.
pub const SOLID_FIELDS: [FrameField; 8] = [
    field("displacement", "Displacement", "m", Always),
    field("velocity", "Speed", "m/s", ByDefault),
    field("stress", "Stress", "Pa", ByDefault),
    field("von_mises", "Von Mises stress", "Pa", ByDefault),
    field("equivalent_plastic_strain", "Equivalent plastic strain", "", ByDefault),
    field("yield_function", "Yield function", "Pa", ByDefault),
    field("strain", "Strain", "", OnRequest(Nothing)),
    field("plastic_strain", "Plastic strain", "", OnRequest(Nothing)),
];

/// Parts with labels of their own, and fields of elements.
pub const SOLID_PARTS: [FrameField; 18] = [
    field("displacement_x", "Displacement x", "m", Always),
    field("displacement_y", "Displacement y", "m", Always),
    field("displacement_z", "Displacement z", "m", Always),
    field("velocity_x", "Velocity x", "m/s", ByDefault),
    field("velocity_y", "Velocity y", "m/s", ByDefault),
    field("velocity_z", "Velocity z", "m/s", ByDefault),
    field("stress_xx", "Stress σxx", "Pa", ByDefault),
    field("stress_yy", "Stress σyy", "Pa", ByDefault),
    field("stress_zz", "Vertical stress σzz", "Pa", ByDefault),
    field("stress_xy", "Stress σxy", "Pa", ByDefault),
    field("stress_yz", "Stress σyz", "Pa", ByDefault),
    field("stress_zx", "Stress σzx", "Pa", ByDefault),
    field("stress_1", "Largest principal stress", "Pa", ByDefault),
    field("stress_2", "Middle principal stress", "Pa", ByDefault),
    field("stress_3", "Smallest principal stress", "Pa", ByDefault),
    field("stress_mean", "Mean stress", "Pa", ByDefault),
    field("element:material", "Material of the element", "", Always),
    field("element:yielded", "Yielded", "", Always),
];

/// Returns label and unit of a field, or of a part such as `strain_xx`.
pub fn solid_label(name: &str) -> (&str, &'static str) {
    let row = |name: &str| SOLID_FIELDS.iter().chain(&SOLID_PARTS).find(|field| field.name == name);
    if let Some(field) = row(name) {
        return (field.label, field.unit);
    }
    let whole = name.rsplit_once('_').and_then(|(whole, _)| row(whole));
    (name, whole.map_or("", |field| field.unit))
}
