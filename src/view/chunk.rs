//! What the page gets from the program: named arrays in one binary block.
//!
//! `TBV1`, the length of a JSON text as `u32`, the text, and the arrays, each from a multiple of four bytes counted from the
//! end of the text on; all little-endian. The text has `meta`, and for each array its name, type, components and place.
//! Compact arrays hold whole numbers `n` of 16 or 24 bits with value = low + n · step per component; their low, middle and high bytes lie
//! in planes one behind the other, which makes them shorter when they are deflated.

use serde_json::{Value, json};

/// How numbers go out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// As `f32`.
    Exact,
    /// In 16 or 24 bits between the smallest and the largest.
    Compact,
}

/// A block in the making.
pub struct Chunk {
    coding: Coding,
    meta: Value,
    arrays: Vec<Value>,
    bytes: Vec<u8>,
}

impl Chunk {
    /// A block without arrays.
    pub fn new(coding: Coding) -> Chunk {
        Chunk { coding, meta: json!({}), arrays: Vec::new(), bytes: Vec::new() }
    }

    /// With a value of `meta`.
    pub fn meta(&mut self, key: &str, value: Value) {
        self.meta[key] = value;
    }

    /// Notes an array that begins where the bytes end now.
    fn note(&mut self, name: &str, kind: &str, components: usize, count: usize) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.arrays.push(json!({ "name": name, "type": kind, "components": components, "count": count,
            "offset": self.bytes.len() }));
        self.arrays.len() - 1
    }

    /// Numbers in single precision, or in 16 bits where the block is compact.
    pub fn numbers(&mut self, name: &str, values: &[f64], components: usize) {
        self.put(name, values, components, 2);
    }

    /// Places: as [`Chunk::numbers`], but in 24 bits.
    pub fn places(&mut self, name: &str, values: &[f64], components: usize) {
        self.put(name, values, components, 3);
    }

    /// Numbers in single precision in every block.
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
        let steps: Vec<f64> = low.iter().zip(&high).map(|(l, h)| (h - l) / most).collect();
        let kind = if planes == 2 { "q16" } else { "q24" };
        let at = self.note(name, kind, components, values.len());
        self.arrays[at]["low"] = json!(low);
        self.arrays[at]["step"] = json!(steps);
        let whole: Vec<u32> = values
            .iter()
            .enumerate()
            .map(|(k, v)| match steps[k % components] {
                step if step > 0.0 => ((v - low[k % components]) / step).round() as u32,
                _ => 0,
            })
            .collect();
        for plane in 0..planes {
            self.bytes.extend(whole.iter().map(|n| (n >> (8 * plane)) as u8));
        }
    }

    /// Whole numbers.
    pub fn indices(&mut self, name: &str, values: &[u32], components: usize) {
        self.note(name, "u32", components, values.len());
        self.bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Small whole numbers.
    pub fn small(&mut self, name: &str, values: &[u8]) {
        self.note(name, "u8", 1, values.len());
        self.bytes.extend(values);
    }

    /// The block.
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
