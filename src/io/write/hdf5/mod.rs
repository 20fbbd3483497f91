//! Growing HDF5 files: groups, attributes and extensible datasets.
//!
//! The file is always valid: a commit appends data and metadata, then updates the superblock (48 bytes, one
//! sector).
//!
//! `hdf5-writer` 0.12 encodes whole files only, and `rust-hdf5` 0.7.9 writes no signature until the file is
//! closed.

mod checksum;
mod chunks;
mod message;

pub use message::{Attribute, Kind};

use super::error::WriteError;
use chunks::{Chunks, LEVEL};
use message::{NOWHERE, SUPERBLOCK};
use serde::{Deserialize, Serialize};
use std::fs::{self, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Group index in order of creation; 0 is the root.
pub type GroupId = usize;
/// Dataset index in order of creation.
pub type DatasetId = usize;

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Group {
    parent: GroupId,
    name: String,
    attributes: Vec<(String, Attribute)>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Dataset {
    parent: GroupId,
    name: String,
    chunks: Chunks,
    header: Option<(u64, u64)>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    end: u64,
    extension: u64,
    root: u64,
    groups: Vec<Group>,
    datasets: Vec<Dataset>,
}

/// Growing file.
#[derive(Debug)]
pub struct File {
    path: PathBuf,
    out: fs::File,
    state: State,
}

impl File {
    /// Creates a file, renamed to `path` by the first commit.
    ///
    /// # Errors
    /// I/O errors.
    pub fn create(path: &Path) -> Result<File, WriteError> {
        let out = fs::File::create(part(path)).map_err(WriteError::io(path))?;
        let root = Group { parent: 0, name: String::new(), attributes: Vec::new() };
        let end = SUPERBLOCK as u64;
        let state =
            State { end, extension: NOWHERE, root: NOWHERE, groups: vec![root], datasets: Vec::new() };
        let mut file = File { path: path.to_path_buf(), out, state };
        let header = message::object_header(&message::node_sizes());
        file.state.extension = file.put(&header).map_err(WriteError::io(path))?;
        Ok(file)
    }

    /// Resumes a file at a [`File::mark`]; later data are truncated.
    ///
    /// # Errors
    /// The file is shorter than at the mark; I/O errors.
    pub fn resume(path: &Path, mark: &[u8]) -> Result<File, WriteError> {
        let state: State = postcard::from_bytes(mark).map_err(|error| WriteError::format(path, error))?;
        if state.groups.is_empty() {
            return Err(WriteError::format(path, "is named by a mark without groups"));
        }
        let out = OpenOptions::new().write(true).open(path).map_err(WriteError::io(path))?;
        let length = out.metadata().map_err(WriteError::io(path))?.len();
        if length < state.end {
            let message =
                format!("is not the file of the checkpoint: {length} bytes, expected {} or more", state.end);
            return Err(WriteError::format(path, message));
        }
        let mut file = File { path: path.to_path_buf(), out, state };
        // Superblock first, so that it never points beyond the end.
        file.point().and_then(|()| file.out.set_len(file.state.end)).map_err(WriteError::io(path))?;
        Ok(file)
    }

    /// Returns the state of the last commit.
    pub fn mark(&self) -> Vec<u8> {
        postcard::to_allocvec(&self.state).expect("plain data can be serialized")
    }

    /// Returns the group, created if missing.
    pub fn group(&mut self, parent: GroupId, name: &str) -> GroupId {
        if let Some(id) = self.state.groups.iter().skip(1).position(|g| g.parent == parent && g.name == name)
        {
            return id + 1;
        }
        self.state.groups.push(Group { parent, name: name.into(), attributes: Vec::new() });
        self.state.groups.len() - 1
    }

    /// Sets an attribute of a group.
    pub fn set(&mut self, group: GroupId, name: &str, value: Attribute) {
        let attributes = &mut self.state.groups[group].attributes;
        match attributes.iter_mut().find(|(n, _)| n == name) {
            Some((_, old)) => *old = value,
            None => attributes.push((name.into(), value)),
        }
    }

    /// Returns the dataset, created if missing: one-dimensional, or of `columns` numbers per row.
    pub fn dataset(&mut self, parent: GroupId, name: &str, kind: Kind, columns: Option<u32>) -> DatasetId {
        if let Some(id) = self.state.datasets.iter().position(|d| d.parent == parent && d.name == name) {
            return id;
        }
        let chunks = Chunks::new(kind, columns);
        self.state.datasets.push(Dataset { parent, name: name.into(), chunks, header: None });
        self.state.datasets.len() - 1
    }

    /// Returns the number of rows.
    pub fn rows(&self, dataset: DatasetId) -> u64 {
        self.state.datasets[dataset].chunks.rows()
    }

    /// Appends rows as little-endian bytes.
    ///
    /// # Errors
    /// I/O errors.
    pub fn append(&mut self, dataset: DatasetId, bytes: &[u8]) -> Result<(), WriteError> {
        let File { out, state: State { end, datasets, .. }, path } = self;
        let written = datasets[dataset].chunks.append(bytes, &mut |bytes| put(out, end, bytes));
        written.map_err(WriteError::io(path))
    }

    /// Makes all additions part of the file.
    ///
    /// # Errors
    /// I/O errors; the file then keeps the last commit.
    pub fn commit(&mut self) -> Result<(), WriteError> {
        let path = self.path.clone();
        let first = self.state.root == NOWHERE;
        self.write_metadata().map_err(WriteError::io(&path))?;
        self.out.sync_data().and_then(|()| self.point()).map_err(WriteError::io(&path))?;
        if first {
            fs::rename(part(&path), &path).map_err(WriteError::io(&path))?;
        }
        Ok(())
    }

    fn write_metadata(&mut self) -> io::Result<()> {
        let File { out, state: State { end, datasets, .. }, .. } = self;
        for dataset in datasets.iter_mut() {
            let chunks = &dataset.chunks;
            if dataset.header.is_some_and(|(_, rows)| rows == chunks.rows()) {
                continue;
            }
            let index = chunks.index(&mut |bytes| put(out, end, bytes))?;
            let messages = message::dataset(chunks.kind(), &chunks.sizes(), &chunks.chunk(), index, LEVEL);
            dataset.header = Some((put(out, end, &message::object_header(&messages))?, chunks.rows()));
        }
        // Children have larger indices than parents.
        let mut headers = vec![NOWHERE; self.state.groups.len()];
        for id in (0..headers.len()).rev() {
            let State { groups, datasets, .. } = &self.state;
            let own = datasets.iter().filter(|d| d.parent == id);
            let own = own.map(|d| (d.name.as_str(), d.header.map_or(NOWHERE, |(address, _)| address)));
            let below = groups.iter().enumerate().skip(id + 1).filter(|(_, g)| g.parent == id);
            let below = below.map(|(k, g)| (g.name.as_str(), headers[k]));
            let mut messages = message::group(own.chain(below));
            let attributes = groups[id].attributes.iter();
            messages.extend(attributes.map(|(name, value)| (0x0c, value.message(name))));
            let header = message::object_header(&messages);
            headers[id] = self.put(&header)?;
        }
        self.state.root = headers[0];
        Ok(())
    }

    fn point(&mut self) -> io::Result<()> {
        let State { end, extension, root, .. } = self.state;
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&message::superblock(extension, end, root))?;
        self.out.sync_data()
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<u64> {
        put(&mut self.out, &mut self.state.end, bytes)
    }
}

/// Appends at a multiple of eight bytes; returns the address.
fn put(out: &mut fs::File, end: &mut u64, bytes: &[u8]) -> io::Result<u64> {
    let address = end.next_multiple_of(8);
    out.seek(SeekFrom::Start(address))?;
    out.write_all(bytes)?;
    *end = address + bytes.len() as u64;
    Ok(address)
}

fn part(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    PathBuf::from(name)
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
