//! Vectors.

/// Three-component vector.
pub type Vec3 = nalgebra::Vector3<f64>;
