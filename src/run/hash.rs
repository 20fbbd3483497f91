//! Hash of texts for checkpoints and scene identity.

use std::path::Path;
use trackbed_io::read::source;

/// 64-bit FNV-1a hash (Fowler, Noll, Vo).
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Returns the hash of a file in hexadecimal; of no bytes if it cannot be read.
    pub fn of_file(path: &Path) -> String {
        let mut hash = Hash::default();
        hash.add(&source::bytes(path, source::LARGEST).unwrap_or_default());
        hash.hex()
    }

    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0 ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Returns the value.
    pub fn value(self) -> u64 {
        self.0
    }

    /// Returns the value in hexadecimal.
    pub fn hex(self) -> String {
        format!("{:016x}", self.0)
    }
}
