//! Grains of spheres from closed surfaces.
//!
//! Sieve size 1 m and principal axes along x, y, z; scenes scale them.

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

/// Volume over bounding box.
const LEAST_SHARE: f64 = 1e-3;

/// Grain type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Rigid, overlapping spheres.
    Clump(fill::Options),
    /// Breakable, bonded spheres.
    Bonded(grow::Options),
}

/// Body of a grain.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Name.
    pub name: String,
    /// Shape of any size and position.
    pub body: Polyhedron,
}

/// Grain with its accuracy.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// Library entry.
    pub stone: Stone,
    /// Measures.
    pub report: StoneReport,
}

/// Error for a grain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StoneError {
    /// Several bodies.
    #[error("stone '{name}': the surface bounds {pieces} separate bodies, expected one")]
    Pieces {
        /// Name.
        name: String,
        /// Number of bodies.
        pieces: usize,
    },
    /// Too thin.
    #[error("stone '{name}': volume is {share:e} of the bounding box, too thin to be filled with spheres")]
    Thin {
        /// Name.
        name: String,
        /// Volume over bounding box.
        share: f64,
    },
    /// Not a valid clump.
    #[error("stone '{name}': {source}")]
    Clump {
        /// Name.
        name: String,
        /// Cause.
        source: ShapeError,
    },
    /// Not a valid bonded grain.
    #[error("stone '{name}': {source}; increase --gap or --spheres")]
    Cluster {
        /// Name.
        name: String,
        /// Cause.
        source: ClusterError,
    },
}

/// Makes a grain of each source.
///
/// # Errors
/// First [`StoneError`] in order.
pub fn make(sources: &[Source], kind: Kind) -> Result<Vec<Made>, StoneError> {
    let made: Vec<Result<Made, StoneError>> = sources.par_iter().map(|s| make_one(s, kind)).collect();
    made.into_iter().collect()
}

fn make_one(source: &Source, kind: Kind) -> Result<Made, StoneError> {
    let name = || source.name.clone();
    if source.body.pieces() != 1 {
        return Err(StoneError::Pieces { name: name(), pieces: source.body.pieces() });
    }
    // Tolerances are then the same for all files.
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
