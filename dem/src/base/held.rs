//! Memory that lists hold.

/// Bytes that a list holds, room for more included.
pub(crate) fn held<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}
