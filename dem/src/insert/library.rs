//! Stone library: shapes at unit scale, as clumps of spheres, as bonded spheres, or as dilated polyhedra.
//!
//! File form (TOML); lengths in metres at unit scale. A library whose stones all have sieve size 1 m is scaled by
//! the sieve size wanted.
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
//! A stone with `corners = [[x, y, z], …]` and `radius` is a dilated polyhedron: the convex hull of the corners, all of which must be
//! corners of it, rolled over by a sphere of that radius.
//!
//! A stone with `bonds = [[0, 1], …]`, pairs of spheres counted from 0, can break; `density_factor` makes up for its
//! pores.

use crate::base::Vec3;
use crate::shape::clump::{Clump, ShapeError};
use crate::shape::cluster::{Cluster, ClusterError};
use crate::shape::dilated::{Dilated, DilatedError};
use serde::{Deserialize, Serialize};

/// A library file as written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoneLibrary {
    /// What the library is.
    pub name: String,
    /// Where the shapes come from.
    pub source: String,
    /// The stones, at least one.
    pub stones: Vec<Stone>,
}

/// One stone of a library file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stone {
    /// Its name, for messages.
    pub name: String,
    /// x, y, z of the centre and radius of each sphere [m] in any frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spheres: Vec<[f64; 4]>,
    /// x, y, z of each corner of a polyhedron [m] in any frame.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<[f64; 3]>,
    /// Radius that a polyhedron is dilated by [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Pairs of bonded spheres, counted from 0, of a stone that can break; none for a rigid clump.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bonds: Vec<[u32; 2]>,
    /// Density of the spheres over that of the stone's material, above 0; 1 without it. A bonded stone is porous: with
    /// this factor its spheres have the mass of the solid stone. Rigid clumps do not use it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_factor: Option<f64>,
}

/// Why a library is of no use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LibraryError {
    /// It holds no stone.
    #[error("stone library '{0}' contains no stone")]
    Empty(String),
    /// A stone is not a clump.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Stone {
        /// Name of the library.
        library: String,
        /// Index of the stone, from 0.
        index: usize,
        /// Name of the stone.
        name: String,
        /// What is wrong with it.
        source: ShapeError,
    },
    /// A stone is not a bonded cluster.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Cluster {
        /// Name of the library.
        library: String,
        /// Index of the stone, from 0.
        index: usize,
        /// Name of the stone.
        name: String,
        /// What is wrong with it.
        source: ClusterError,
    },
    /// A stone is not a dilated polyhedron.
    #[error("stone {index} ('{name}') of library '{library}': {source}")]
    Polyhedron {
        /// Name of the library.
        library: String,
        /// Index of the stone, from 0.
        index: usize,
        /// Name of the stone.
        name: String,
        /// What is wrong with it.
        source: DilatedError,
    },
}

impl StoneLibrary {
    /// The stones as clumps, each in the frame of its union, in the file's order and size.
    ///
    /// # Errors
    /// [`LibraryError`] when there is no stone, or one whose spheres do not make a clump.
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

    /// The stones as bonded clusters, each in the frame of its spheres, in the file's order and size.
    ///
    /// # Errors
    /// [`LibraryError`] when there is no stone, or one whose spheres and bonds do not make a cluster.
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

    /// The stones as dilated polyhedra, each in its own frame, in the file's order and size.
    ///
    /// # Errors
    /// [`LibraryError`] when there is no stone, or one whose corners and radius do not make a dilated polyhedron.
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
    fn shipped_stones_have_sieve_size_one_in_their_own_frame() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../inputs/track/cyclic/stones.toml");
        let text = std::fs::read_to_string(file).unwrap();
        // The rows of numbers, stone by stone; the whole form is parsed where scenes are read.
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
    fn a_polyhedron_needs_corners_and_a_radius() {
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
