//! Interface of a device that runs the kernels.

use super::layout::{Arguments, Count, Number, Slot};
use crate::engine::cpu_part;
use crate::engine::model::Model;

/// Launch: buffers by array, numbers and counts.
#[derive(Clone, Debug)]
pub struct Call {
    /// Buffer index of each array.
    pub buffers: Vec<usize>,
    numbers: [f64; Number::COUNT],
    counts: [u32; Count::COUNT],
}

impl Call {
    pub(super) fn new() -> Call {
        Call { buffers: (0..Slot::COUNT).collect(), numbers: [0.0; Number::COUNT], counts: [0; Count::COUNT] }
    }

    pub(super) fn buffer(&self, slot: Slot) -> usize {
        self.buffers[slot as usize]
    }

    pub(super) fn number(&mut self, which: Number, x: f64) {
        self.numbers[which as usize] = x;
    }

    pub(super) fn count(&mut self, which: Count, n: usize) {
        self.counts[which as usize] = n as u32;
    }

    /// Returns the kernel arguments; `address` maps a buffer index to its address.
    pub fn arguments(&self, address: impl Fn(usize) -> u64) -> Arguments {
        let mut at = [0; Slot::COUNT];
        at.iter_mut().zip(&self.buffers).for_each(|(to, &buffer)| *to = address(buffer));
        Arguments { at, number: self.numbers, count: self.counts }
    }
}

/// Device: buffers by index, kernels by name.
pub trait Machine {
    /// Fills a buffer with numbers, resizing it.
    ///
    /// # Errors
    /// Out of memory, or device not responding.
    fn put(&mut self, buffer: usize, numbers: &[f64]) -> Result<(), String>;

    /// Fills a buffer with counts, resizing it.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn put_counts(&mut self, buffer: usize, counts: &[u32]) -> Result<(), String>;

    /// Overwrites part of an existing buffer, starting at index `from`.
    ///
    /// # Errors
    /// Device not responding.
    fn fill(&mut self, buffer: usize, from: usize, numbers: &[f64]) -> Result<(), String>;

    /// As [`Machine::fill`], for counts.
    ///
    /// # Errors
    /// As [`Machine::fill`].
    fn fill_counts(&mut self, buffer: usize, from: usize, counts: &[u32]) -> Result<(), String>;

    /// Reserves space for `numbers` values; contents undefined.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn reserve(&mut self, buffer: usize, numbers: usize) -> Result<(), String>;

    /// Reserves space for `counts` counts; contents undefined.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn reserve_counts(&mut self, buffer: usize, counts: usize) -> Result<(), String>;

    /// Reads `numbers.len()` values, starting at index `from`.
    ///
    /// # Errors
    /// Device not responding.
    fn get(&mut self, buffer: usize, from: usize, numbers: &mut [f64]) -> Result<(), String>;

    /// Reads `counts.len()` counts, from the first.
    ///
    /// # Errors
    /// As [`Machine::get`].
    fn get_counts(&mut self, buffer: usize, counts: &mut [u32]) -> Result<(), String>;

    /// Runs a kernel with `threads` threads, after all earlier launches.
    ///
    /// # Errors
    /// Device not responding.
    fn launch(&mut self, kernel: &'static str, threads: usize, call: &Call) -> Result<(), String>;
}

/// Step, search, download (last, for a CPU part).
const ALL: [&str; 13] = [
    "bodies",
    "books",
    "clear_cells",
    "count_cells",
    "fill_cells",
    "count_partners",
    "totals",
    "list_partners",
    "enter_partners",
    "ranges",
    "sum_up",
    "sum_down",
    "pick",
];

/// Kernels of a model.
pub fn kernels(model: &Model) -> &'static [&'static str] {
    if cpu_part::any(model) { &ALL } else { &ALL[..ALL.len() - 1] }
}
