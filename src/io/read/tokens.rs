//! Numbers of text or binary sections.

use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::number;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

pub(super) struct Tokens<'a> {
    file: PathBuf,
    bytes: &'a [u8],
    at: usize,
    line: usize,
    counted: usize,
    pub encoding: Encoding,
}

macro_rules! binary {
    ($self:ident, $key:expr, $type:ty) => {{
        let bytes = $self.take(size_of::<$type>(), $key)?;
        let mut array = [0; size_of::<$type>()];
        array.copy_from_slice(bytes);
        match $self.encoding {
            Encoding::BigEndian => <$type>::from_be_bytes(array),
            _ => <$type>::from_le_bytes(array),
        }
    }};
}

impl<'a> Tokens<'a> {
    pub fn new(file: &Path, bytes: &'a [u8]) -> Tokens<'a> {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Tokens { file: file.to_path_buf(), bytes, at, line: 1, counted: 0, encoding: Encoding::Text }
    }

    /// Current line, from 1; meaningless after binary numbers.
    pub fn line(&mut self) -> usize {
        let new = &self.bytes[self.counted..self.at.min(self.bytes.len())];
        self.line += new.iter().filter(|b| **b == b'\n').count();
        self.counted = self.at.min(self.bytes.len());
        self.line
    }

    pub fn fault(&mut self, key: &str, found: impl Into<String>, expected: impl Into<String>) -> ReadError {
        let line = self.line();
        ReadError::at(&self.file, line, key, found, expected)
    }

    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    pub fn rest_of_line(&mut self) -> Option<&'a str> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.at = (self.at + end + 1).min(self.bytes.len());
        Some(std::str::from_utf8(&rest[..end]).unwrap_or("\u{fffd}").trim())
    }

    pub fn next_line(&mut self) -> Option<&'a str> {
        loop {
            let line = self.rest_of_line()?;
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    pub fn next_is(&self, word: &str) -> bool {
        let rest = &self.bytes[self.at..];
        let skip = rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(rest.len());
        rest[skip..].starts_with(word.as_bytes())
    }

    pub fn word(&mut self, key: &str) -> Result<&'a str, ReadError> {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if end == 0 {
            return Err(self.fault(key, "the end of the file", "a number"));
        }
        self.at += end;
        Ok(std::str::from_utf8(&rest[..end]).unwrap_or("\u{fffd}"))
    }

    pub fn take(&mut self, count: usize, key: &str) -> Result<&'a [u8], ReadError> {
        if count > self.left() {
            return Err(self.fault(key, "the end of the file", "more bytes"));
        }
        self.at += count;
        Ok(&self.bytes[self.at - count..self.at])
    }

    fn text_number<T>(
        &mut self,
        key: &str,
        parse: impl Fn(&str) -> Option<T>,
        expected: &str,
    ) -> Result<T, ReadError> {
        let word = self.word(key)?;
        let mut shown: String = word.chars().take(40).collect();
        shown = format!("\"{shown}\"");
        parse(word).ok_or_else(|| self.fault(key, shown, expected))
    }

    pub fn int(&mut self, key: &str) -> Result<i32, ReadError> {
        if self.encoding == Encoding::Text {
            return self.text_number(key, |w| w.parse().ok(), "a whole number");
        }
        Ok(binary!(self, key, i32))
    }

    pub fn size(&mut self, key: &str) -> Result<u64, ReadError> {
        if self.encoding == Encoding::Text {
            return self.text_number(key, |w| w.parse().ok(), "a whole number of 0 or more");
        }
        Ok(binary!(self, key, u64))
    }

    pub fn real(&mut self, key: &str) -> Result<f64, ReadError> {
        if self.encoding == Encoding::Text {
            return self.text_number(key, number::real, "a number");
        }
        Ok(binary!(self, key, f64))
    }

    /// Count of items of at least one byte each: damaged counts fail immediately.
    pub fn count(&mut self, key: &str) -> Result<usize, ReadError> {
        let count = self.size(key)?;
        self.plausible(count, key)
    }

    /// `count` of a 4-byte integer.
    pub fn int_count(&mut self, key: &str) -> Result<usize, ReadError> {
        let count = self.int(key)?;
        self.plausible(u64::try_from(count).unwrap_or(u64::MAX), key)
    }

    /// Count limited by the remaining bytes.
    pub fn plausible(&mut self, count: u64, key: &str) -> Result<usize, ReadError> {
        if count > self.left() as u64 {
            let expected = format!("a count that {} bytes can hold", self.left());
            return Err(self.fault(key, count.to_string(), expected));
        }
        Ok(count as usize)
    }

    pub fn id(&mut self, key: &str) -> Result<u32, ReadError> {
        let id = self.size(key)?;
        u32::try_from(id).map_err(|_| self.fault(key, id.to_string(), "a number below 4294967296"))
    }

    /// `id` of a 4-byte integer.
    pub fn int_id(&mut self, key: &str) -> Result<u32, ReadError> {
        let id = self.int(key)?;
        u32::try_from(id).map_err(|_| self.fault(key, id.to_string(), "a whole number of 0 or more"))
    }
}
