//! Row of equal sleepers.

/// Row of equal sleepers.
#[derive(Clone, Debug)]
pub struct SleeperRow {
    /// Elements of the solid instead of rigid bodies.
    pub meshed: bool,
    /// Mass of a sleeper [kg].
    pub mass: f64,
    /// Constrained motions: along x, y, z, about x, y, z.
    pub held: [bool; 6],
    /// Half edge lengths [m].
    pub half: [f64; 3],
    /// Track direction: 0 or 1.
    pub axis: usize,
    /// Centres in x and y along the track [m].
    pub centres: Vec<[f64; 2]>,
    /// Rail seats in the sleeper frame [m].
    pub seats: Vec<[f64; 3]>,
    /// Height by which each sleeper's seats are too low for a rail with mass [m].
    pub gaps: Vec<f64>,
}
