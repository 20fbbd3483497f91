//! Railway track on ballast: rails, trains, load cycles, settlement, push tests.
//!
//! Sees grains only through `trackbed-dem`; SI units.

pub mod band;
pub mod beam;
mod change;
pub mod cycle_jump;
pub mod cycles;
pub mod extrapolation;
pub mod extremes;
pub mod influence;
pub mod irregularity;
pub mod load;
pub mod push_test;
pub mod rail;
pub mod rails;
pub mod rolling;
pub mod row;
pub mod settlement;
pub mod sleepers;
pub mod system;
pub mod train;
pub mod vehicle;

pub use load::CyclicLoad;
pub use row::SleeperRow;
pub use sleepers::{Track, TrackInput};
pub use system::{GrainsView, MeshedSleeper, SleeperMotion, TrackSystem};
