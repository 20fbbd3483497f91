//! What the track needs of the system that it is part of.

use nalgebra::UnitQuaternion;
use trackbed_dem as dem;

/// The grains of a running system.
#[derive(Clone, Copy)]
pub struct GrainsView<'a> {
    /// Model.
    pub model: &'a dem::Model,
    /// Its state.
    pub state: &'a dem::State,
}

/// Displacement of a sleeper that consists of elements.
#[derive(Clone, Copy, Debug)]
pub struct SleeperMotion {
    /// Displacement of the centre of mass [m].
    pub way: [f64; 3],
    /// Angle between the normal of the base and the vertical [rad].
    pub tilt: f64,
    /// Rise of the seats, mean under the load [m].
    pub seats: f64,
    /// Rise of the ends of the base over its middle [m].
    pub bend: f64,
}

/// A sleeper that consists of elements, at one moment.
#[derive(Clone, Copy, Debug)]
pub struct MeshedSleeper {
    /// Centre of mass [m].
    pub place: [f64; 3],
    /// Height of the centre when it was set down and the rise of the seats since, together [m].
    pub height: f64,
    /// How it has moved.
    pub moved: SleeperMotion,
    /// Force of the grains on it, mean over the last window [N].
    pub contact: [f64; 3],
}

/// A system of grains, alone or on a solid, that is advanced in windows of one or more steps of the grains.
pub trait TrackSystem {
    /// Length of a window [s].
    fn window(&self) -> f64;

    /// The grains, if there are any.
    fn grains(&self) -> Option<GrainsView<'_>> {
        None
    }

    /// Sleeper `k`, where sleepers consist of elements.
    fn meshed_sleeper(&self, _k: usize) -> Option<MeshedSleeper> {
        None
    }

    /// Sets grains elsewhere: body, shift [m], rotation in world axes.
    fn relocate(&mut self, _moves: &[(usize, dem::Vec3, UnitQuaternion<f64>)]) {}
}
