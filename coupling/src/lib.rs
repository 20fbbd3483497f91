//! Exchange of force and motion between the grains and the solid.
