//! Bed imported from another run: `trackbed run NEXT --from DIR --bed`.
//!
//! Grains keep positions, velocities, contact and bond history.

use super::stage::Settled;
use crate::checkpoint::Loaded;
use crate::system::SavedCoupling;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_input::model::grains::GrainsPart;
use trackbed_io::failure::Failure;

/// Imported bed.
pub struct Carried {
    begun: Option<Vec<BodyInput>>,
    state: dem::State,
    count: usize,
}

impl Carried {
    /// Reads a final state, `coupled` or DEM only.
    ///
    /// # Errors
    /// State of another program.
    pub fn read(loaded: &mut Loaded, coupled: bool) -> Result<Carried, Failure> {
        let bed: Option<Settled> = loaded.take()?;
        let state = match coupled {
            true => loaded.take::<SavedCoupling<'_>>()?.state.into_owned().grains,
            false => loaded.take()?,
        };
        Ok(Carried { begun: bed.map(|bed| bed.bodies), state, count: 0 })
    }

    /// Returns the initial grains; `part`: of the scene.
    pub fn bodies(&mut self, part: &GrainsPart) -> Vec<BodyInput> {
        let bodies = self.begun.take().unwrap_or_else(|| part.groups.bodies.clone());
        self.count = bodies.len();
        bodies
    }

    /// Returns the number of imported grains.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Restores contact history after contact detection.
    pub fn restore_history(&self, model: &dem::Model, state: &mut dem::State) {
        state.restore_history(model, &self.state, self.count);
    }

    /// Sets the bed in an initial state.
    ///
    /// # Errors
    /// Different grains.
    pub fn put(&self, model: &dem::Model, state: &mut dem::State) -> Result<(), Failure> {
        state.transfer_bodies(model, &self.state, self.count).map_err(|body| {
            Failure::Input(format!(
                "--from: found grain {body} different from the imported bed, expected the same [[grains]]"
            ))
        })
    }
}
