//! A row of equal sleepers.

/// Equal sleepers in a row.
#[derive(Clone, Debug)]
pub struct SleeperRow {
    /// Whether they consist of elements of the solid, and are no bodies among the grains.
    pub meshed: bool,
    /// Mass of a sleeper [kg].
    pub mass: f64,
    /// Motions that are held: along x, y, z, about x, y, z.
    pub held: [bool; 6],
    /// Half edge lengths [m].
    pub half: [f64; 3],
    /// Direction of the track: 0 or 1.
    pub axis: usize,
    /// Places of the centres in x and y [m], along the track.
    pub centres: Vec<[f64; 2]>,
    /// Points of the top that share the load, in the sleeper's frame [m].
    pub seats: Vec<[f64; 3]>,
}
