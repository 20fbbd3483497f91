//! Binary blocks of named arrays for the page.
//!
//! `TBV1`, length of a JSON text as `u32`, text, arrays aligned to four bytes after the text; little-endian.
//! The text has `meta` and each array's name, type, components and offset. Compact arrays store integers `n`
//! of 16 or 24 bits (value = low + n · step) in byte planes.

use serde_json::{Value, json};
use trackbed_io::failure::Failure;

/// Blocks of a page by name.
pub trait Blocks {
    /// Returns a block; `None` if unknown.
    ///
    /// # Errors
    /// Damaged file.
    fn block(&self, name: &str) -> Result<Option<Vec<u8>>, Failure>;

    /// Returns all block names.
    ///
    /// # Errors
    /// Damaged file.
    fn names(&self) -> Result<Vec<String>, Failure>;
}

/// Number encoding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// As `f32`.
    Exact,
    /// In 16 or 24 bits between minimum and maximum.
    Compact,
}

pub struct Chunk {
    coding: Coding,
    meta: Value,
    arrays: Vec<Value>,
    bytes: Vec<u8>,
}

impl Chunk {
    pub fn new(coding: Coding) -> Chunk {
        Chunk { coding, meta: json!({}), arrays: Vec::new(), bytes: Vec::new() }
    }

    pub fn meta(&mut self, key: &str, value: Value) {
        self.meta[key] = value;
    }

    fn note(&mut self, name: &str, kind: &str, components: usize, count: usize) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.arrays.push(json!({ "name": name, "type": kind, "components": components, "count": count,
            "offset": self.bytes.len() }));
        self.arrays.len() - 1
    }

    /// Adds numbers in single precision, or 16 bits if compact.
    pub fn numbers(&mut self, name: &str, values: &[f64], components: usize) {
        self.put(name, values, components, 2);
    }

    /// Adds positions; 24 bits if compact.
    pub fn places(&mut self, name: &str, values: &[f64], components: usize) {
        self.put(name, values, components, 3);
    }

    /// Adds numbers in single precision always.
    pub fn exact(&mut self, name: &str, values: &[f64], components: usize) {
        self.note(name, "f32", components, values.len());
        self.bytes.extend(values.iter().flat_map(|v| (*v as f32).to_le_bytes()));
    }

    fn put(&mut self, name: &str, values: &[f64], components: usize, planes: usize) {
        if self.coding == Coding::Exact || values.is_empty() {
            return self.exact(name, values, components);
        }
        let (mut low, mut high) = (vec![f64::INFINITY; components], vec![f64::NEG_INFINITY; components]);
        for (k, v) in values.iter().enumerate() {
            low[k % components] = low[k % components].min(*v);
            high[k % components] = high[k % components].max(*v);
        }
        let most = f64::from((1_u32 << (8 * planes)) - 1);
        // Numbers of groups and materials stay exact.
        let whole = values.iter().all(|v| v.fract() == 0.0);
        let step = |range: f64| if whole && range <= most { 1.0 } else { range / most };
        let steps: Vec<f64> = low.iter().zip(&high).map(|(l, h)| step(h - l)).collect();
        let kind = if planes == 2 { "q16" } else { "q24" };
        let at = self.note(name, kind, components, values.len());
        self.arrays[at]["low"] = json!(low);
        self.arrays[at]["step"] = json!(steps);
        let packed: Vec<u32> = values
            .iter()
            .enumerate()
            .map(|(k, v)| match steps[k % components] {
                step if step > 0.0 => ((v - low[k % components]) / step).round() as u32,
                _ => 0,
            })
            .collect();
        for plane in 0..planes {
            self.bytes.extend(packed.iter().map(|n| (n >> (8 * plane)) as u8));
        }
    }

    pub fn indices(&mut self, name: &str, values: &[u32], components: usize) {
        self.note(name, "u32", components, values.len());
        self.bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    }

    pub fn small(&mut self, name: &str, values: &[u8]) {
        self.note(name, "u8", 1, values.len());
        self.bytes.extend(values);
    }

    pub fn finish(self) -> Vec<u8> {
        let mut text = json!({ "meta": self.meta, "arrays": self.arrays }).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = Vec::with_capacity(8 + text.len() + self.bytes.len());
        out.extend(b"TBV1");
        out.extend((text.len() as u32).to_le_bytes());
        out.extend(text);
        out.extend(self.bytes);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_stay_exact() {
        let mut chunk = Chunk::new(Coding::Compact);
        chunk.numbers("part", &[0.0, 3.0, 2.0], 1);
        assert_eq!(chunk.arrays[0]["step"], json!([1.0]));
        assert_eq!(chunk.bytes, [0, 3, 2, 0, 0, 0]);
    }
}
