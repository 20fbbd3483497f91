//! HDF5 metadata as bytes.
//!
//! Source: HDF5 File Format Specification Version 3.0 (The HDF Group): superblock II.A, object headers
//! IV.A.1.b, messages IV.A.2.

use super::checksum::lookup3;
use serde::{Deserialize, Serialize};

pub const NOWHERE: u64 = u64::MAX;

pub const HALF_NODE: usize = 16;

pub const SUPERBLOCK: usize = 48;

/// Number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Double precision.
    F64,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 32 bits.
    U32,
    /// Unsigned, 8 bits.
    U8,
}

impl Kind {
    /// Returns the size [bytes].
    pub fn size(self) -> usize {
        match self {
            Kind::F64 | Kind::I64 => 8,
            Kind::U32 => 4,
            Kind::U8 => 1,
        }
    }

    /// Returns the datatype message.
    pub fn message(self) -> Vec<u8> {
        let size = self.size() as u8;
        let integer = |signed: u8| vec![0x10, signed, 0, 0, size, 0, 0, 0, 0, 0, 8 * size, 0];
        match self {
            // Little endian, implied first mantissa bit, sign at bit 63, 11-bit exponent at 52, bias 1023.
            Kind::F64 => vec![0x11, 0x20, 63, 0, size, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52, 0xff, 3, 0, 0],
            Kind::I64 => integer(8),
            Kind::U32 | Kind::U8 => integer(0),
        }
    }
}

/// Value of an attribute.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Attribute {
    /// Fixed-length ASCII.
    Text(String),
    /// Scalar.
    Integer(i64),
    /// Array.
    Integers(Vec<i64>),
}

impl Attribute {
    /// Returns the attribute message.
    pub fn message(&self, name: &str) -> Vec<u8> {
        let (datatype, space, data) = match self {
            Attribute::Text(text) => {
                let mut datatype = vec![0x13, 1, 0, 0];
                datatype.extend((text.len() as u32).to_le_bytes());
                (datatype, dataspace(&[], &[]), text.as_bytes().to_vec())
            }
            Attribute::Integer(n) => (Kind::I64.message(), dataspace(&[], &[]), n.to_le_bytes().to_vec()),
            Attribute::Integers(list) => {
                let count = [list.len() as u64];
                let data = list.iter().flat_map(|n| n.to_le_bytes()).collect();
                (Kind::I64.message(), dataspace(&count, &count), data)
            }
        };
        let mut out = vec![3, 0];
        for length in [name.len() + 1, datatype.len(), space.len()] {
            out.extend((length as u16).to_le_bytes());
        }
        out.push(0);
        out.extend(name.bytes().chain([0]));
        [out, datatype, space, data].concat()
    }
}

/// Scalar (no sizes) or array, with current and largest sizes.
pub fn dataspace(sizes: &[u64], most: &[u64]) -> Vec<u8> {
    let rank = sizes.len() as u8;
    let mut out = vec![2, rank, u8::from(rank > 0), u8::from(rank > 0)];
    out.extend(sizes.iter().chain(most).flat_map(|n| n.to_le_bytes()));
    out
}

pub fn dataset(kind: Kind, sizes: &[u64], chunk: &[u64], index: u64, level: u32) -> Vec<(u8, Vec<u8>)> {
    let mut most = sizes.to_vec();
    most[0] = u64::MAX;
    let mut layout = vec![3, 2, sizes.len() as u8 + 1];
    layout.extend(index.to_le_bytes());
    let size = kind.size() as u64;
    layout.extend(chunk.iter().chain([&size]).flat_map(|n| (*n as u32).to_le_bytes()));
    // Shuffle, then deflate.
    let mut filters = vec![2, 2];
    for (id, value) in [(2_u16, kind.size() as u32), (1, level)] {
        filters.extend([id, 0, 1].into_iter().flat_map(u16::to_le_bytes));
        filters.extend(value.to_le_bytes());
    }
    vec![
        (0x01, dataspace(sizes, &most)),
        (0x03, kind.message()),
        // Late allocation, undefined fill value.
        (0x05, vec![3, 0x0b]),
        (0x08, layout),
        (0x0b, filters),
    ]
}

pub fn group<'a>(members: impl Iterator<Item = (&'a str, u64)>) -> Vec<(u8, Vec<u8>)> {
    let nowhere = [NOWHERE, NOWHERE].into_iter().flat_map(u64::to_le_bytes);
    let mut out = vec![(0x02, [0, 0].into_iter().chain(nowhere).collect()), (0x0a, vec![0, 0])];
    for (name, address) in members {
        let mut link = vec![1, 0, name.len() as u8];
        link.extend(name.bytes().chain(address.to_le_bytes()));
        out.push((0x06, link));
    }
    out
}

pub fn node_sizes() -> Vec<(u8, Vec<u8>)> {
    let widths = [HALF_NODE as u16, 16, 4];
    vec![(0x13, [0].into_iter().chain(widths.into_iter().flat_map(u16::to_le_bytes)).collect())]
}

pub fn object_header(messages: &[(u8, Vec<u8>)]) -> Vec<u8> {
    let length: usize = messages.iter().map(|(_, body)| 4 + body.len()).sum();
    let mut out = b"OHDR\x02\x02".to_vec();
    out.extend((length as u32).to_le_bytes());
    for (kind, body) in messages {
        out.push(*kind);
        out.extend((body.len() as u16).to_le_bytes());
        out.push(0);
        out.extend(body);
    }
    with_checksum(out)
}

pub fn superblock(extension: u64, end: u64, root: u64) -> Vec<u8> {
    let mut out = b"\x89HDF\r\n\x1a\n\x02\x08\x08\x00".to_vec();
    out.extend([0, extension, end, root].into_iter().flat_map(u64::to_le_bytes));
    with_checksum(out)
}

fn with_checksum(mut bytes: Vec<u8>) -> Vec<u8> {
    let sum = lookup3(&bytes);
    bytes.extend(sum.to_le_bytes());
    bytes
}
