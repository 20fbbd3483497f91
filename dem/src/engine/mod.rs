//! Model, state, scratch, search and the step: the layer that composes the parts of all features.

pub(crate) mod applied;
mod arrange;
pub mod back_end;
mod block_work;
pub(crate) mod bonds;
pub(crate) mod candidates;
mod carry;
mod check;
mod check_periodic;
pub(crate) mod collision;
mod hulls;
pub mod input;
pub mod model;
pub(crate) mod neighbours;
pub(crate) mod order;
pub(crate) mod periodic;
pub(crate) mod place;
mod probe;
pub(crate) mod scarring;
pub(crate) mod start;
pub mod state;
pub mod step;
mod steps;
pub(crate) mod threads;
pub mod timestep;
pub(crate) mod walls;
pub mod work;
