//! Vectors.

/// A vector of three components.
pub type Vec3 = nalgebra::Vector3<f64>;
