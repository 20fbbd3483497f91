//! Loops over bodies and contacts: contact laws, contact detection and forces, bonds, body forces, motion.
//!
//! `trackbed-dem` re-exports what users need; `dem/src/engine` calls the loops. Modules are layers, which
//! import only from earlier ones: `law`, `bodies`, `pairs`, `contact`, `integrate`, `body_force`, `bond`.

// Hidden modules are called by `trackbed-dem` only: complete interfaces would have no user.
#![allow(clippy::len_without_is_empty, clippy::new_without_default)]

#[doc(hidden)]
pub mod bodies;
pub mod body_force;
pub mod bond;
#[doc(hidden)]
pub mod contact;
pub mod integrate;
pub mod law;
#[doc(hidden)]
pub mod pairs;
#[cfg(test)]
#[path = "../geometry/shape/dilated/tables.rs"]
mod tables;

use trackbed_geometry::{base, lanes, shape, spatial};
