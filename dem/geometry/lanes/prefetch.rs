//! Prefetching of lists.

use super::machine;

/// `_MM_HINT_T0` and `_MM_HINT_T1`.
const FIRST_CACHE: i32 = 3;
const SECOND_CACHE: i32 = 2;

/// Into the second-level cache.
#[inline]
pub fn prefetch<T>(list: &[T]) {
    machine::prefetch::<SECOND_CACHE>(list.as_ptr().cast(), size_of_val(list));
}

/// First `count` elements.
#[inline]
pub fn prefetch_first<T>(list: &[T], count: usize) {
    prefetch(&list[..list.len().min(count)]);
}

/// `count` elements from `at`, possibly past the end, into the first-level cache: hardware prefetching stops
/// at page borders.
#[inline(always)]
pub fn ahead<T>(list: &[T], at: usize, count: usize) {
    machine::prefetch::<FIRST_CACHE>(list.as_ptr().wrapping_add(at).cast(), count * size_of::<T>());
}

/// Into the second-level cache.
#[inline(always)]
pub fn far_ahead<T>(list: &[T], at: usize, count: usize) {
    machine::prefetch::<SECOND_CACHE>(list.as_ptr().wrapping_add(at).cast(), count * size_of::<T>());
}
