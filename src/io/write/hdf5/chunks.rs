//! Dataset rows: compressed chunks with their B-tree.
//!
//! Source: HDF5 File Format Specification Version 3.0, III.A.1, version 1 B-trees, node type 1.

use super::message::{HALF_NODE, Kind, NOWHERE};
use flate2::{Compression, write::ZlibEncoder};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};

/// About one chunk [bytes].
const CHUNK: usize = 16384;
/// Compression level, as in the other writers.
pub const LEVEL: u32 = 1;
/// Children of a final node; one slot is left for a pending child.
const FULL: usize = 2 * HALF_NODE - 1;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Child {
    first_row: u64,
    address: u64,
    size: u32,
}

/// Appends; returns the address.
pub type Put<'a> = &'a mut dyn FnMut(&[u8]) -> io::Result<u64>;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chunks {
    kind: Kind,
    /// Numbers per row; `None` if one-dimensional.
    columns: Option<u32>,
    rows: u64,
    rest: Vec<u8>,
    /// Last node of each level, leaves first.
    levels: Vec<Vec<Child>>,
}

impl Chunks {
    pub fn new(kind: Kind, columns: Option<u32>) -> Chunks {
        Chunks { kind, columns, rows: 0, rest: Vec::new(), levels: vec![Vec::new()] }
    }

    pub fn kind(&self) -> Kind {
        self.kind
    }

    fn row_bytes(&self) -> usize {
        self.kind.size() * self.columns.unwrap_or(1) as usize
    }

    fn chunk_rows(&self) -> usize {
        (CHUNK / self.row_bytes()).max(1)
    }

    pub fn rows(&self) -> u64 {
        self.rows
    }

    pub fn sizes(&self) -> Vec<u64> {
        [self.rows].into_iter().chain(self.columns.map(u64::from)).collect()
    }

    pub fn chunk(&self) -> Vec<u64> {
        [self.chunk_rows() as u64].into_iter().chain(self.columns.map(u64::from)).collect()
    }

    /// Appends rows as little-endian bytes.
    ///
    /// # Errors
    /// I/O errors.
    pub fn append(&mut self, bytes: &[u8], put: Put<'_>) -> io::Result<()> {
        self.rows += (bytes.len() / self.row_bytes()) as u64;
        self.rest.extend_from_slice(bytes);
        let size = self.chunk_rows() * self.row_bytes();
        let whole = self.rest.len() / size * size;
        let rest = self.rest.split_off(whole);
        let full = std::mem::replace(&mut self.rest, rest);
        let mut first_row = self.rows - ((full.len() + self.rest.len()) / self.row_bytes()) as u64;
        for chunk in full.chunks_exact(size) {
            let packed = self.packed(chunk)?;
            let child = Child { first_row, address: put(&packed)?, size: packed.len() as u32 };
            self.push(0, child, put)?;
            first_row += self.chunk_rows() as u64;
        }
        Ok(())
    }

    /// Adds a child to the last node of a level; full nodes are written.
    fn push(&mut self, level: usize, child: Child, put: Put<'_>) -> io::Result<()> {
        if self.levels[level].len() == FULL {
            let full = std::mem::take(&mut self.levels[level]);
            let node =
                Child { first_row: full[0].first_row, address: put(&self.node(level, &full))?, size: 0 };
            if self.levels.len() == level + 1 {
                self.levels.push(Vec::new());
            }
            self.push(level + 1, node, put)?;
        }
        self.levels[level].push(child);
        Ok(())
    }

    /// Writes pending nodes; returns the root address.
    ///
    /// # Errors
    /// I/O errors.
    pub fn index(&self, put: Put<'_>) -> io::Result<u64> {
        if self.rows == 0 {
            return Ok(NOWHERE);
        }
        let mut last = None;
        if !self.rest.is_empty() {
            let mut chunk = self.rest.clone();
            chunk.resize(self.chunk_rows() * self.row_bytes(), 0);
            let packed = self.packed(&chunk)?;
            let first_row = self.rows - (self.rest.len() / self.row_bytes()) as u64;
            last = Some(Child { first_row, address: put(&packed)?, size: packed.len() as u32 });
        }
        let mut root = NOWHERE;
        for (level, children) in self.levels.iter().enumerate() {
            let children: Vec<Child> = children.iter().copied().chain(last).collect();
            root = put(&self.node(level, &children))?;
            last = Some(Child { first_row: children[0].first_row, address: root, size: 0 });
        }
        Ok(root)
    }

    /// Index node. Siblings move, so they are not linked.
    fn node(&self, level: usize, children: &[Child]) -> Vec<u8> {
        let mut out = b"TREE\x01".to_vec();
        out.push(level as u8);
        out.extend((children.len() as u16).to_le_bytes());
        out.extend([NOWHERE, NOWHERE].into_iter().flat_map(u64::to_le_bytes));
        let offsets = 2 + self.columns.is_some() as usize;
        let key = |out: &mut Vec<u8>, row: u64, size: u32| {
            out.extend(size.to_le_bytes());
            out.extend([0; 4]);
            out.extend(row.to_le_bytes());
            out.extend(vec![0; 8 * (offsets - 1)]);
        };
        for child in children {
            key(&mut out, child.first_row, child.size);
            out.extend(child.address.to_le_bytes());
        }
        key(&mut out, self.rows.next_multiple_of(self.chunk_rows() as u64), 0);
        let key_bytes = 8 + 8 * offsets;
        out.resize(24 + 2 * HALF_NODE * (key_bytes + 8) + key_bytes, 0);
        out
    }

    fn packed(&self, chunk: &[u8]) -> io::Result<Vec<u8>> {
        let size = self.kind.size();
        let count = chunk.len() / size;
        let mut shuffled = vec![0; chunk.len()];
        for (i, number) in chunk.chunks_exact(size).enumerate() {
            for (place, byte) in number.iter().enumerate() {
                shuffled[place * count + i] = *byte;
            }
        }
        let mut encoder = ZlibEncoder::new(Vec::with_capacity(chunk.len() / 2), Compression::new(LEVEL));
        encoder.write_all(&shuffled)?;
        encoder.finish()
    }
}
