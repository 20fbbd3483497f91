//! The bed at the end of another run, put into another scene: `trackbed run NEXT --from DIR --bed`.
//!
//! Both scenes have the same `[[grains]]`. Where the grains are, how they move, and what their contacts and bonds with each other
//! remember is carried over; walls, sleepers, solid and loads are those of the new scene, contacts with them begin anew.

use super::stage::Settled;
use crate::failure::Failure;
use crate::model::grains::GrainsPart;
use crate::run::checkpoint::Loaded;
use trackbed_coupling as coupling;
use trackbed_dem as dem;
use trackbed_dem::BodyInput;
use trackbed_fem as fem;

/// A bed.
pub struct Carried {
    /// Grains as their run began with them; none where these are the ones of the scene.
    begun: Option<Vec<BodyInput>>,
    /// What became of them, and of the bodies after them.
    state: dem::State,
    /// How many they are.
    count: usize,
}

impl Carried {
    /// Reads the end of a run, `coupled` or of grains alone.
    ///
    /// # Errors
    /// Bad input: a state of another program.
    pub fn read(loaded: &mut Loaded, coupled: bool) -> Result<Carried, Failure> {
        let bed: Option<Settled> = loaded.take()?;
        let state = if coupled {
            let (_, _, state, _) =
                loaded.take::<(Vec<f64>, Option<fem::nonlinear::Memory>, coupling::step::State, f64)>()?;
            state.grains
        } else {
            loaded.take()?
        };
        Ok(Carried { begun: bed.map(|bed| bed.bodies), state, count: 0 })
    }

    /// The grains as their run began with them; `part`: those of the scene.
    pub fn bodies(&mut self, part: &GrainsPart) -> Vec<BodyInput> {
        let bodies = self.begun.take().unwrap_or_else(|| part.groups.bodies.clone());
        self.count = bodies.len();
        bodies
    }

    /// Gives the contacts of the bed their memory back, once those of a state are found.
    pub fn remember(&self, model: &dem::Model, state: &mut dem::State) {
        state.remember(model, &self.state, self.count);
    }

    /// Puts the bed into the state that a model begins with.
    ///
    /// # Errors
    /// Bad input: the grains of the model are others.
    pub fn put(&self, model: &dem::Model, state: &mut dem::State) -> Result<(), Failure> {
        state.carry(model, &self.state, self.count).map_err(|body| {
            Failure::Input(format!(
                "--from: found grain {body} different from the imported bed, expected the same [[grains]]"
            ))
        })
    }
}
