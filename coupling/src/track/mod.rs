//! Railway track on ballast: rails, trains, load cycles, settlement, push tests.
//!
//! [`load`] is the force on a row of sleepers against time: cyclic, measured, or of [axles](train) that pass, shared among
//! the sleepers by an [influence line](influence) or by a [rail with mass](rail), a [beam] on pads. [`rails`] joins such
//! rails to moving sleepers, [`sleepers`] applies all this to the [running system](system) and records the
//! [`extremes`], and [`push`] pushes a sleeper sideways. [`cycles`] records each load cycle, [`settlement`] fits the
//! laws of the literature to the cycles, and [`jump`] extrapolates over those that are not simulated one by one.

pub mod band;
pub mod beam;
pub mod cycles;
pub mod extremes;
pub mod influence;
pub mod jump;
pub mod load;
pub mod push;
pub mod rail;
pub mod rails;
pub mod row;
pub mod settlement;
pub mod sleepers;
pub mod system;
pub mod train;

pub use load::CyclicLoad;
pub use row::SleeperRow;
pub use sleepers::{Track, TrackInput};
pub use system::{GrainsView, MeshedSleeper, SleeperMotion, TrackSystem};
