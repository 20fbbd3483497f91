//! Stone library: shapes at unit scale, as clumps of spheres.
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

use crate::shape::clump::{Clump, ShapeError};
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stone {
    /// Its name, for messages.
    pub name: String,
    /// x, y, z of the centre and radius of each sphere [m] in any frame.
    pub spheres: Vec<[f64; 4]>,
}

/// Why a library is of no use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LibraryError {
    /// It holds no stone.
    #[error("stone library '{0}' holds no stone")]
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
}

impl StoneLibrary {
    /// The stones as clumps, each in the frame of its union, in the file's order and size.
    ///
    /// # Errors
    /// [`LibraryError`] when there is no stone, or one whose spheres do not make a clump.
    pub fn clumps(&self) -> Result<Vec<Clump>, LibraryError> {
        if self.stones.is_empty() {
            return Err(LibraryError::Empty(self.name.clone()));
        }
        let build = |(index, stone): (usize, &Stone)| {
            let spheres: Vec<_> = stone.spheres.iter().map(|&[x, y, z, r]| ([x, y, z], r)).collect();
            Clump::from_spheres(&spheres).map_err(|source| LibraryError::Stone {
                library: self.name.clone(),
                index,
                name: stone.name.clone(),
                source,
            })
        };
        self.stones.iter().enumerate().map(build).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library(stones: &[(&str, &[[f64; 4]])]) -> StoneLibrary {
        StoneLibrary {
            name: "test".into(),
            source: "here".into(),
            stones: stones.iter().map(|(n, s)| Stone { name: (*n).into(), spheres: s.to_vec() }).collect(),
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
    fn a_bad_stone_is_named() {
        assert_eq!(library(&[]).clumps(), Err(LibraryError::Empty("test".into())));
        let split = [[0.0, 0.0, 0.0, 0.5], [1.5, 0.0, 0.0, 0.5]];
        let error = library(&[("good", &split[..1]), ("bad", &split)]).clumps().unwrap_err();
        let text = error.to_string();
        assert!(text.contains("stone 1 ('bad')") && text.contains("connected"), "{text}");
    }
}
