//! Check for bond rotations beyond linear springs.

use super::{Check, Limits};
use trackbed_dem::measure::largest_rotation;
use trackbed_track::GrainsView;

/// Rotation [rad]: linear springs err by 2 % at the first limit, by half at the second.
const ROTATION: Limits = Limits { warn: 0.3, fail: Some(1.5) };

/// Checks the final unbroken bonds; none without rotational stiffness.
pub fn bond_rotation(view: GrainsView<'_>) -> Option<Check> {
    let found = largest_rotation(view.model, view.state)?;
    Some(Check::new("largest rotation of a bond [rad]", found.angle, ROTATION, || {
        format!(
            "bond {}: rotation {:.0} degrees, linear springs are valid to about {:.0} degrees. Use stiffer bonds, smaller loads, or a finite strength.",
            found.bond,
            found.angle.to_degrees(),
            ROTATION.warn.to_degrees()
        )
    }))
}
