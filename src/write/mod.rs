//! Result files, one writer per file.
//!
//! Every file appears whole or not at all ([`atomic`]), except the history ([`csv`]), which grows by whole
//! rows. No writer writes a number that is not finite: it names the field and the index instead.

pub mod ansys_lists;
pub mod atomic;
pub mod csv;
pub mod error;
pub mod pvd;
#[cfg(test)]
pub(crate) mod sample;
pub mod svg;
pub mod tecplot;
mod vtk;
#[cfg(test)]
mod vtk_oracle;
pub mod vtp;
pub mod vtu;

pub use error::WriteError;
pub use vtp::{ChainFrame, GrainFrame, WallFrame};
pub use vtu::SolidFrame;
