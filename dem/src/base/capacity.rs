//! Allocated memory of lists.

pub(crate) fn capacity_bytes<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}
