//! Rotations of bonds, whose springs are linear: those of a cemented joint or of a slab in bending stay small.

use super::{Check, Limits};
use trackbed_coupling::track::GrainsView;
use trackbed_dem::measure::largest_rotation;

/// Rotation of a bond [rad]: linear springs err by 2 % of it at the first limit, and by half of it at the second.
const ROTATION: Limits = Limits { warn: 0.3, fail: Some(1.5) };

/// Checks the unbroken bonds at the end of a run; none without bonds that resist rotation.
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
