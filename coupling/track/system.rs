//! Interface of the track to the coupled system.

use nalgebra::UnitQuaternion;
use trackbed_dem as dem;

/// Grains of a running system.
#[derive(Clone, Copy)]
pub struct GrainsView<'a> {
    /// Model.
    pub model: &'a dem::Model,
    /// State.
    pub state: &'a dem::State,
}

/// Motion of a meshed sleeper.
#[derive(Clone, Copy, Debug)]
pub struct SleeperMotion {
    /// Displacement of the centre of mass [m].
    pub translation: [f64; 3],
    /// Angle between base normal and vertical [rad].
    pub tilt: f64,
    /// Load-weighted mean seat displacement, upwards [m].
    pub seats: f64,
    /// Height of the base ends above its middle [m].
    pub bend: f64,
}

/// Meshed sleeper.
#[derive(Clone, Copy, Debug)]
pub struct MeshedSleeper {
    /// Centre of mass [m].
    pub place: [f64; 3],
    /// Initial centre height plus seat displacement [m].
    pub height: f64,
    /// Motion.
    pub moved: SleeperMotion,
    /// Mean force of the grains in the last window [N].
    pub contact: [f64; 3],
}

/// System that is advanced in windows.
pub trait TrackSystem {
    /// Window length [s].
    fn window(&self) -> f64;

    /// Grains, if any.
    fn grains(&self) -> Option<GrainsView<'_>> {
        None
    }

    /// Meshed sleeper `k`.
    fn meshed_sleeper(&self, _k: usize) -> Option<MeshedSleeper> {
        None
    }

    /// Displaces grains: body, displacement [m], rotation in global axes.
    fn relocate(&mut self, _moves: &[(usize, dem::Vec3, UnitQuaternion<f64>)]) {}
}
