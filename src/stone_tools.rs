//! What the `stone` commands do: closed surfaces, read or random, made into stones of spheres.
//!
//! Every stone is brought to sieve size 1 m with its principal axes along x, y, z, as libraries hold it; scenes scale it
//! by the sieve size wanted. Nothing here depends on the number of threads: stones are made one by one, each in a fixed
//! order of operations, and only different stones run beside each other.

pub mod fill;
pub mod grow;
pub mod library_file;
pub mod measure;
pub mod random;
pub mod rough;

use rayon::prelude::*;
use trackbed_dem::distance::SurfaceDistance;
use trackbed_dem::insert::library::Stone;
use trackbed_dem::shape::clump::{Clump, ShapeError};
use trackbed_dem::shape::cluster::{Cluster, ClusterError};
use trackbed_dem::shape::polyhedron::Polyhedron;

pub use measure::StoneReport;

/// Least share of its bounding box that a body may fill.
const LEAST_SHARE: f64 = 1e-3;

/// What a stone is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Overlapping spheres, rigid.
    Clump(fill::Options),
    /// Separate spheres with bonds, breakable.
    Bonded(grow::Options),
}

/// A body to make a stone of.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Name of the stone.
    pub name: String,
    /// Its shape, any size, anywhere.
    pub body: Polyhedron,
}

/// A stone and how well it fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// As it stands in a library.
    pub stone: Stone,
    /// Its numbers.
    pub report: StoneReport,
}

/// Why no stone can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StoneError {
    /// The surface bounds several bodies.
    #[error("stone '{name}': the surface bounds {pieces} separate bodies, expected one")]
    Pieces {
        /// Name of the stone.
        name: String,
        /// Number of bodies.
        pieces: usize,
    },
    /// There is hardly any body in its bounding box.
    #[error("stone '{name}': volume is {share:e} of the bounding box, too thin to be filled with spheres")]
    Thin {
        /// Name of the stone.
        name: String,
        /// Volume over that of the bounding box.
        share: f64,
    },
    /// The spheres make no clump.
    #[error("stone '{name}': {source}")]
    Clump {
        /// Name of the stone.
        name: String,
        /// What is wrong.
        source: ShapeError,
    },
    /// The spheres make no bonded stone.
    #[error("stone '{name}': {source}; increase --gap or --spheres")]
    Cluster {
        /// Name of the stone.
        name: String,
        /// What is wrong.
        source: ClusterError,
    },
}

/// Makes a stone of each source, in their order.
///
/// # Errors
/// The first [`StoneError`] in that order.
pub fn make(sources: &[Source], kind: Kind) -> Result<Vec<Made>, StoneError> {
    let made: Vec<Result<Made, StoneError>> = sources.par_iter().map(|s| make_one(s, kind)).collect();
    made.into_iter().collect()
}

fn make_one(source: &Source, kind: Kind) -> Result<Made, StoneError> {
    let name = || source.name.clone();
    if source.body.pieces() != 1 {
        return Err(StoneError::Pieces { name: name(), pieces: source.body.pieces() });
    }
    // Sieve size 1 in its own frame, so that every tolerance means the same for every file.
    let body = source.body.in_principal_frame();
    let body = body.scaled(1.0 / body.sieve_size());
    let [lo, hi] = body.surface().bounds();
    let share = body.moments().volume / (0..3).map(|k| hi[k] - lo[k]).product::<f64>();
    let thin = || StoneError::Thin { name: name(), share };
    if share < LEAST_SHARE {
        return Err(thin());
    }
    let distance = SurfaceDistance::new(&body);
    let row = |(c, r): &([f64; 3], f64), s: f64| [c[0] * s, c[1] * s, c[2] * s, r * s];
    Ok(match kind {
        Kind::Clump(options) => {
            let spheres = fill::fill(&body, &distance, &options).ok_or_else(thin)?;
            let clump =
                Clump::from_spheres(&spheres).map_err(|source| StoneError::Clump { name: name(), source })?;
            let report = measure::clump(&body, &distance, &spheres, &clump);
            let s = 1.0 / clump.sieve_size();
            let spheres = clump.spheres.iter().map(|b| row(b, s)).collect();
            Made { stone: Stone { name: name(), spheres, ..Stone::default() }, report }
        }
        Kind::Bonded(options) => {
            let grown = grow::grow(&body, &distance, &options);
            let factor = grown.density_factor;
            let cluster = Cluster::new(&grown.spheres, &grown.bonds, factor)
                .map_err(|source| StoneError::Cluster { name: name(), source })?;
            let report = measure::cluster(&body, &distance, &grown.spheres, &cluster);
            let s = 1.0 / cluster.sieve_size();
            let spheres = cluster.spheres.iter().map(|b| row(b, s)).collect();
            Made {
                stone: Stone {
                    name: name(),
                    spheres,
                    bonds: cluster.bonds,
                    density_factor: Some(factor),
                    ..Stone::default()
                },
                report,
            }
        }
    })
}

#[cfg(test)]
#[path = "stone_tools/tests.rs"]
mod tests;
