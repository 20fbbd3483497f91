//! Material of the Hertz scene.

use crate::grains;
use trackbed_dem::Material;

/// E = 5e7 Pa, ν = 0.25.
pub fn elastic() -> Material {
    Material { stiffness: f64::INFINITY, young: Some(5e7), poisson: 0.25, ..grains::stone() }
}
