//! Stone library at unit scale: clumps, bonded spheres or dilated polyhedra.
//!
//! TOML, lengths in metres; stones of sieve size 1 m scale by the target size.
//!
//! ```toml
//! name = "ballast, 6 stones"
//! source = "where the shapes come from"
//! [[stones]]
//! name = "cubical"
//! spheres = [
//!     [0.1, 0.0, -0.2, 0.3], # x, y, z, radius
//! ]
//! ```
//!
//! Dilated polyhedron: `corners = [[x, y, z], …]` and `radius`. Breakable stone: `bonds = [[0, 1], …]`
//! (sphere indices); `density_factor` compensates its pores.

use crate::base::Vec3;
use crate::shape::clump::{Clump, ShapeError};
use crate::shape::cluster::{Cluster, ClusterError};
use crate::shape::dilated::{Dilated, DilatedError};
use serde::{Deserialize, Serialize};

/// Library file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoneLibrary {
    /// Title.
    pub name: String,
    /// Source of the shapes.
    pub source: String,
    /// Stones, at least one.
    pub stones: Vec<Stone>,
}

/// Stone of a library file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stone {
    /// Name for messages.
    pub name: String,
    /// Centre x, y, z and radius of each sphere [m].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spheres: Vec<[f64; 4]>,
    /// Polyhedron corners x, y, z [m].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<[f64; 3]>,
    /// Dilation radius [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Bonded sphere pairs, from 0; empty for a rigid clump.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bonds: Vec<[u32; 2]>,
    /// Sphere density over material density of a porous bonded stone, above 0, default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_factor: Option<f64>,
}

/// Invalid library.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LibraryError {
    /// No stone.
    #[error("stone library '{0}' contains no stone")]
    Empty(String),
    /// Invalid clump.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Stone {
        /// Library.
        library: String,
        /// Stone index.
        index: usize,
        /// Stone.
        name: String,
        /// Cause.
        source: ShapeError,
    },
    /// Invalid cluster.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Cluster {
        /// Library.
        library: String,
        /// Stone index.
        index: usize,
        /// Stone.
        name: String,
        /// Cause.
        source: ClusterError,
    },
    /// Invalid polyhedron.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Polyhedron {
        /// Library.
        library: String,
        /// Stone index.
        index: usize,
        /// Stone.
        name: String,
        /// Cause.
        source: DilatedError,
    },
}

impl StoneLibrary {
    /// Clumps in their union frames, in file order and size.
    ///
    /// # Errors
    /// [`LibraryError`] for no stone or an invalid clump.
    pub fn clumps(&self) -> Result<Vec<Clump>, LibraryError> {
        self.each(|index, stone| {
            Clump::from_spheres(&stone.balls()).map_err(|source| LibraryError::Stone {
                library: self.name.clone(),
                index,
                name: stone.name.clone(),
                source,
            })
        })
    }

    /// Clusters in their own frames, in file order and size.
    ///
    /// # Errors
    /// [`LibraryError`] for no stone or an invalid cluster.
    pub fn clusters(&self) -> Result<Vec<Cluster>, LibraryError> {
        self.each(|index, stone| {
            let factor = stone.density_factor.unwrap_or(1.0);
            Cluster::new(&stone.balls(), &stone.bonds, factor).map_err(|source| LibraryError::Cluster {
                library: self.name.clone(),
                index,
                name: stone.name.clone(),
                source,
            })
        })
    }

    /// Polyhedra in their own frames, in file order and size.
    ///
    /// # Errors
    /// [`LibraryError`] for no stone or an invalid polyhedron.
    pub fn polyhedra(&self) -> Result<Vec<Dilated>, LibraryError> {
        self.each(|index, stone| {
            let corners: Vec<Vec3> = stone.corners.iter().map(|c| Vec3::from(*c)).collect();
            let made = Dilated::new(&corners, stone.radius.unwrap_or(0.0));
            made.map(|(stone, _, _)| stone).map_err(|source| LibraryError::Polyhedron {
                library: self.name.clone(),
                index,
                name: stone.name.clone(),
                source,
            })
        })
    }

    fn each<T>(
        &self,
        build: impl Fn(usize, &Stone) -> Result<T, LibraryError>,
    ) -> Result<Vec<T>, LibraryError> {
        if self.stones.is_empty() {
            return Err(LibraryError::Empty(self.name.clone()));
        }
        self.stones.iter().enumerate().map(|(i, s)| build(i, s)).collect()
    }
}

impl Stone {
    /// Centre [m] and radius [m] of each sphere.
    pub fn balls(&self) -> Vec<([f64; 3], f64)> {
        self.spheres.iter().map(|&[x, y, z, r]| ([x, y, z], r)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(name: &str, spheres: &[[f64; 4]]) -> Stone {
        Stone { name: name.into(), spheres: spheres.to_vec(), ..Stone::default() }
    }

    fn library(stones: &[(&str, &[[f64; 4]])]) -> StoneLibrary {
        StoneLibrary {
            name: "test".into(),
            source: "here".into(),
            stones: stones.iter().map(|(n, s)| plain(n, s)).collect(),
        }
    }

    #[test]
    fn stones_keep_their_order_and_size() {
        let pair = [[0.0, 0.0, 0.0, 0.5], [0.5, 0.0, 0.0, 0.5]];
        let clumps = library(&[("one", &pair[..1]), ("two", &pair)]).clumps().unwrap();
        assert_eq!((clumps[0].spheres.len(), clumps[1].spheres.len()), (1, 2));
        assert!((clumps[1].extents()[0] - 1.5).abs() < 1e-9);
        assert!((clumps[1].sieve_size() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn shipped_stones_have_unit_sieve_size() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../inputs/track/cyclic/stones.toml");
        let text = std::fs::read_to_string(file).unwrap();
        let row = |line: &str| {
            let numbers =
                line.trim().strip_prefix('[')?.strip_suffix("],")?.split(',').map(|x| x.trim().parse());
            numbers.collect::<Result<Vec<f64>, _>>().ok()?.try_into().ok()
        };
        let stones: Vec<Vec<[f64; 4]>> =
            text.split("[[stones]]").skip(1).map(|s| s.lines().filter_map(row).collect()).collect();
        assert_eq!(stones.len(), 6);
        let named: Vec<(&str, &[[f64; 4]])> = stones.iter().map(|s| ("stone", s.as_slice())).collect();
        for (clump, spheres) in library(&named).clumps().unwrap().iter().zip(&stones) {
            assert!((8..=12).contains(&spheres.len()));
            assert!((clump.sieve_size() - 1.0).abs() < 1e-6, "{}", clump.sieve_size());
            assert!(
                clump.spheres.iter().zip(spheres).all(|(a, b)| (0..3).all(|k| (a.0[k] - b[k]).abs() < 1e-5))
            );
            assert!((0.3..0.75).contains(&clump.volume));
        }
    }

    #[test]
    fn a_bonded_stone_needs_its_bonds() {
        let row = [[0.0, 0.0, 0.0, 0.5], [1.0, 0.0, 0.0, 0.5]];
        let mut file = library(&[("pair", &row)]);
        let error = file.clusters().unwrap_err().to_string();
        assert!(error.contains("stone 0 ('pair')") && error.contains("bonds"), "{error}");
        file.stones[0].bonds = vec![[0, 1]];
        file.stones[0].density_factor = Some(2.0);
        let cluster = &file.clusters().unwrap()[0];
        assert!((cluster.volume - 2.0 * std::f64::consts::PI / 3.0).abs() < 1e-12);
        assert_eq!(library(&[]).clusters(), Err(LibraryError::Empty("test".into())));
    }

    #[test]
    fn rejects_polyhedron_without_radius() {
        let mut file = library(&[("tetrahedron", &[])]);
        assert!(file.polyhedra().unwrap_err().to_string().contains("0 m; it must be positive"));
        file.stones[0].radius = Some(0.1);
        assert!(file.polyhedra().unwrap_err().to_string().contains("0 corners"));
        file.stones[0].corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let stone = &file.polyhedra().unwrap()[0];
        assert!(stone.core.faces.len() == 4 && stone.volume > 1.0 / 6.0);
        assert!(file.clumps().is_err());
    }

    #[test]
    fn a_bad_stone_is_named() {
        assert_eq!(library(&[]).clumps(), Err(LibraryError::Empty("test".into())));
        let split = [[0.0, 0.0, 0.0, 0.5], [1.5, 0.0, 0.0, 0.5]];
        let error = library(&[("good", &split[..1]), ("bad", &split)]).clumps().unwrap_err();
        let text = error.to_string();
        assert!(text.contains("stone 1 ('bad')") && text.contains("connected"), "{text}");
    }
}
