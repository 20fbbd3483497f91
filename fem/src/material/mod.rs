//! Materials at a Gauss point. Symmetric tensors are ordered xx, yy, zz, xy, yz, zx; tension is positive; shear
//! strains are engineering strains.
pub mod elastic;
