//! Conjugate gradients for the symmetric equations `A = k K + m M + d D` of large solids, where a factor takes too much time or memory.
//!
//! [`crate::solver::conjugate`] is the method, over an operator and a preconditioner. [`product`] multiplies with A straight from
//! the half-stored matrices of the model, which take no further memory. [`block_jacobi`] inverts the 3x3 blocks of the nodes:
//! enough for the window matrix with a lumped mass, whose condition is of the order of `1 + (c dt / h)^2`, c being the speed of
//! waves and h the size of an element.
//! [`aggregation`] is for the stiffness alone.
//!
//! Vectors are nodal, shape `[3 * nodes]`, 0 at constrained dofs. Determinism: nodes are cut into parts of a fixed size;
//! each part is computed by one thread, and contributions of other parts and partial sums are added in the order of parts, so
//! that the bits do not depend on the number of threads.
//!
//! Source: Saad, Iterative Methods for Sparse Linear Systems, 2nd ed. (2003), algorithm 9.1.

pub mod aggregation;
pub mod block_jacobi;
pub mod product;
mod upper;
