//! Checks that all tables of the grains share.

use crate::scene::units::{Length, Quantity, vector};
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::Vec3;
use trackbed_dem::measure::BoxRegion;

/// Refuses a value that is there and is not finite or not good.
pub(super) fn check(
    document: &Document,
    key: &str,
    value: Option<f64>,
    good: impl Fn(f64) -> bool,
    expected: &str,
) -> Result<(), SceneError> {
    match value {
        Some(v) if !(v.is_finite() && good(v)) => Err(document.error(key, v.to_string(), expected)),
        _ => Ok(()),
    }
}

/// Number of a material.
pub(super) fn find(document: &Document, scene: &Scene, key: &str, name: &str) -> Result<usize, SceneError> {
    let names: Vec<&str> = scene.material.iter().map(|m| m.name.as_str()).collect();
    let found = names.iter().position(|n| *n == name);
    found.ok_or_else(|| {
        let expected = format!("the name of a [[material]]: {}", names.join(", "));
        document.error(key, format!("\"{name}\""), expected)
    })
}

/// A box with a volume.
pub(super) fn region(
    document: &Document,
    key: &str,
    corners: &[[Quantity<Length>; 3]; 2],
) -> Result<BoxRegion, SceneError> {
    let [low, high] = corners.map(|c| Vec3::from(vector(&c)));
    if (0..3).all(|d| low[d] < high[d] && (high[d] - low[d]).is_finite()) {
        return Ok(BoxRegion { low, high });
    }
    Err(document.error(key, "corners in another order", "the lower corner, then the upper"))
}
