//! A hash of texts, for checkpoints and for the identity of a scene.

/// 64-bit FNV-1a hash (Fowler, Noll, Vo) of a sequence of texts.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Adds some bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0 ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The hash as a number.
    pub fn value(self) -> u64 {
        self.0
    }

    /// The hash in hexadecimal.
    pub fn hex(self) -> String {
        format!("{:016x}", self.0)
    }
}
