//! Checks shared by all grain tables.

use crate::scene::units::{Length, Quantity, vector};
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::Vec3;
use trackbed_dem::measure::BoxRegion;

pub(super) fn find<T>(
    scene: &Table<Scene>,
    table: &Table<T>,
    key: &str,
    name: &str,
) -> Result<usize, SceneError> {
    let names: Vec<&str> = scene.material.iter().map(|m| m.name.as_str()).collect();
    let found = names.iter().position(|n| *n == name);
    found.ok_or_else(|| {
        let expected = format!("the name of a [[material]]: {}", names.join(", "));
        table.error(key, format!("\"{name}\""), expected)
    })
}

pub(in crate::model) fn region<T>(
    table: &Table<T>,
    key: &str,
    corners: &[[Quantity<Length>; 3]; 2],
) -> Result<BoxRegion, SceneError> {
    let [low, high] = corners.map(|c| Vec3::from(vector(&c)));
    if (0..3).all(|d| low[d] < high[d] && (high[d] - low[d]).is_finite()) {
        return Ok(BoxRegion { low, high });
    }
    Err(table.error(key, "corners in another order", "the lower corner, then the upper"))
}
