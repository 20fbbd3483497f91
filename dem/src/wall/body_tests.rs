//! Principal axes.

use super::*;

#[test]
fn principal_axes() {
    let turn = UnitQuaternion::from_euler_angles(0.4, 0.9, -0.2).to_rotation_matrix();
    let tensor =
        turn.matrix() * Matrix3::from_diagonal(&Vec3::new(1.0, 2.0, 2.5)) * turn.matrix().transpose();
    let (moments, axes) = principal(&tensor);
    let q = axes.to_rotation_matrix();
    let back = q.matrix() * Matrix3::from_diagonal(&moments) * q.matrix().transpose();
    assert!((back - tensor).norm() < 1e-12, "{back}");
    assert!((q.matrix().determinant() - 1.0).abs() < 1e-12);
}
