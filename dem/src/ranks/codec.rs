//! Message encoding, with reused buffers.

use serde::{Deserialize, Serialize};

pub(super) fn encode<T: Serialize + ?Sized>(out: &mut Vec<u8>, value: &T) {
    let room = std::mem::take(out);
    // Cannot fail for the types used here.
    *out = postcard::to_extend(value, room).expect("a value that can be written");
}

pub(super) fn write_numbers(out: &mut Vec<u8>, numbers: impl IntoIterator<Item = f64>) {
    numbers.into_iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes()));
}

/// `None` at the end of the message.
pub(super) fn decode<'a, T: Deserialize<'a>>(rest: &mut &'a [u8]) -> Option<T> {
    let (value, left) = postcard::take_from_bytes(rest).ok()?;
    *rest = left;
    Some(value)
}

pub(super) fn read_numbers<const N: usize>(rest: &mut &[u8]) -> Option<[f64; N]> {
    let (head, left) = rest.split_at_checked(8 * N)?;
    *rest = left;
    let (numbers, _) = head.as_chunks::<8>();
    Some(std::array::from_fn(|k| f64::from_le_bytes(numbers[k])))
}
