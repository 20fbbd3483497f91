//! What carries the kernels out.

use super::layout::{Arguments, Count, Number, Slot};
use crate::engine::beside;
use crate::engine::model::Model;

/// A launch: which array is where, and the numbers and counts.
#[derive(Clone, Debug)]
pub struct Call {
    /// Number of the buffer for each address that the text knows.
    pub buffers: Vec<usize>,
    numbers: [f64; Number::COUNT],
    counts: [u32; Count::COUNT],
}

impl Call {
    /// Buffers in their places, numbers and counts zero.
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

    /// The arguments as kernels take them: a structure by value on a device. `address`: of a buffer.
    pub fn arguments(&self, address: impl Fn(usize) -> u64) -> Arguments {
        let mut at = [0; Slot::COUNT];
        at.iter_mut().zip(&self.buffers).for_each(|(to, &buffer)| *to = address(buffer));
        Arguments { at, number: self.numbers, count: self.counts }
    }
}

/// A device: buffers by number, and kernels by name. Messages say what went wrong.
pub trait Machine {
    /// Makes a buffer hold these numbers, whatever its size was.
    ///
    /// # Errors
    /// No memory is left, or the device does not respond.
    fn put(&mut self, buffer: usize, numbers: &[f64]) -> Result<(), String>;

    /// Makes a buffer hold these counts.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn put_counts(&mut self, buffer: usize, counts: &[u32]) -> Result<(), String>;

    /// Puts numbers into a buffer from number `from` on, for which it has room; what else it holds stays.
    ///
    /// # Errors
    /// The device does not respond.
    fn fill(&mut self, buffer: usize, from: usize, numbers: &[f64]) -> Result<(), String>;

    /// The same of counts.
    ///
    /// # Errors
    /// As [`Machine::fill`].
    fn fill_counts(&mut self, buffer: usize, from: usize, counts: &[u32]) -> Result<(), String>;

    /// Makes a buffer hold so many numbers, whatever they are.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn reserve(&mut self, buffer: usize, numbers: usize) -> Result<(), String>;

    /// Makes a buffer hold so many counts, whatever they are.
    ///
    /// # Errors
    /// As [`Machine::put`].
    fn reserve_counts(&mut self, buffer: usize, counts: usize) -> Result<(), String>;

    /// Reads as many numbers of a buffer as there is room for, from number `from` on.
    ///
    /// # Errors
    /// The device does not respond.
    fn get(&mut self, buffer: usize, from: usize, numbers: &mut [f64]) -> Result<(), String>;

    /// Reads counts of a buffer, from the first on.
    ///
    /// # Errors
    /// As [`Machine::get`].
    fn get_counts(&mut self, buffer: usize, counts: &mut [u32]) -> Result<(), String>;

    /// Runs a kernel with so many threads, after all that was launched before.
    ///
    /// # Errors
    /// The device does not respond.
    fn launch(&mut self, kernel: &'static str, threads: usize, call: &Call) -> Result<(), String>;
}

/// The kernels of a model: a step, the search for neighbours, and with a part of the processor in each step the last.
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

/// The kernels that the text for a model has.
pub fn kernels(model: &Model) -> &'static [&'static str] {
    if beside::any(model) { &ALL } else { &ALL[..ALL.len() - 1] }
}
