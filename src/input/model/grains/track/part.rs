//! Sleepers, rail, and loads.

use crate::scene::{Document, SceneError};
use trackbed_track::CyclicLoad;
use trackbed_track::cycle_jump::CycleJumpOptions;
use trackbed_track::push_test::PushTestOptions;
use trackbed_track::rail::RailInput;
use trackbed_track::rolling::RollingInput;
use trackbed_track::{SleeperRow, TrackInput};

/// The track of a scene.
#[derive(Clone, Default)]
pub struct TrackPart {
    /// Sleepers; rigid ones are the last main-stage bodies.
    pub sleeper: Option<SleeperPlan>,
    /// Load on the sleepers.
    pub load: Option<CyclicLoad>,
    /// Cycle jumps and final push.
    pub after: AfterPlan,
    /// Beam rail, one per seat.
    pub rail: Option<RailInput>,
    /// Vehicles on it.
    pub vehicles: Option<RollingInput>,
}

/// Sleepers among the grains.
#[derive(Clone, Debug)]
pub struct SleeperPlan {
    /// Shape index of rigid sleepers.
    pub shape: usize,
    /// Material index.
    pub material: usize,
    /// The sleepers.
    pub row: SleeperRow,
}

/// Cycle jumps and final push.
#[derive(Clone, Debug, Default)]
pub struct AfterPlan {
    /// Cycle jumps.
    pub jump: Option<CycleJumpOptions>,
    /// Lateral push at the end.
    pub push: Option<PushTestOptions>,
    /// Loads for bed stiffness [N].
    pub between: Option<[f64; 2]>,
}

impl TrackPart {
    /// Returns the longest step [s] accepted by [`TrackPart::check_pads`] and [`TrackPart::check_ram`].
    pub fn longest_step(&self) -> f64 {
        let pads = self.pads().map(|(pad, lightness)| {
            let stiff = (0.25 / (pad[0] * lightness)).sqrt();
            stiff.min(0.5 / (pad[1] * lightness))
        });
        let ram = self.after.push.as_ref().zip(self.sleeper.as_ref());
        let ram = ram.map(|(push, sleeper)| PushTestOptions::longest_step(push.stiffness, sleeper.row.mass));
        pads.unwrap_or(f64::INFINITY).min(ram.unwrap_or(f64::INFINITY))
    }

    /// Pad stiffness and damping, and 1/m of a seat with both rotations.
    fn pads(&self) -> Option<([f64; 2], f64)> {
        let (rail, sleeper) = (self.rail.as_ref()?, &self.sleeper.as_ref()?.row);
        let [a, b, c] = sleeper.half;
        let third = |x: f64, y: f64| 3.0 / (sleeper.mass * (x * x + y * y));
        let seat = |s: &[f64; 3]| 1.0 / sleeper.mass + s[0] * s[0] * third(a, c) + s[1] * s[1] * third(b, c);
        Some((rail.pad, sleeper.seats.iter().map(seat).sum()))
    }

    /// Rejects pads too stiff or damped for steps of `dt` [s].
    ///
    /// # Errors
    /// Half a radian or half a damping time constant of the fastest sleeper motion is below `dt`.
    pub fn check_pads(&self, document: &Document, dt: f64) -> Result<(), SceneError> {
        let Some((pad, lightness)) = self.pads() else { return Ok(()) };
        for (key, value, most) in [
            ("pad_stiffness", pad[0], 0.25 / (dt * dt * lightness)),
            ("pad_damping", pad[1], 0.5 / (dt * lightness)),
        ] {
            if value > most {
                let expected = format!("at most {most:.4e} with DEM time steps of {dt:.4e} s");
                return Err(document.error(&format!("track.rail.{key}"), value.to_string(), expected));
            }
        }
        Ok(())
    }

    /// Rejects too stiff a ram for steps of `dt` [s].
    ///
    /// # Errors
    /// Input errors.
    pub fn check_ram(&self, document: &Document, dt: f64) -> Result<(), SceneError> {
        let (Some(push), Some(sleeper)) = (&self.after.push, &self.sleeper) else { return Ok(()) };
        let most = PushTestOptions::largest_stiffness(sleeper.row.mass, dt);
        if push.stiffness > most {
            let expected = format!("at most {most:.3e} N/m, the limit of the time step of {dt:.3e} s");
            let found = format!("{:.3e} N/m", push.stiffness);
            return Err(document.error("track.push.stiffness", found, expected));
        }
        Ok(())
    }

    /// Returns the main-stage track input.
    pub fn input(&self) -> TrackInput<'_> {
        TrackInput {
            sleepers: self.sleeper.as_ref().map(|s| &s.row),
            load: self.load.as_ref(),
            rail: self.rail,
            vehicles: self.vehicles.as_ref(),
            push: self.after.push.as_ref(),
        }
    }

    /// Returns the rigid sleepers, if any.
    pub fn rigid_sleeper(&self) -> Option<&SleeperPlan> {
        self.sleeper.as_ref().filter(|s| !s.row.meshed)
    }
}
