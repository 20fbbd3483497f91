//! Lists that the processor fetches before they are needed.

use super::machine;

/// Hints of the instruction, `_MM_HINT_T0` and `_MM_HINT_T1`.
const FIRST_CACHE: i32 = 3;
const SECOND_CACHE: i32 = 2;

/// Has the processor fetch a list into its second cache, where it can be asked to.
#[inline]
pub(crate) fn prefetch<T>(list: &[T]) {
    machine::prefetch::<SECOND_CACHE>(list.as_ptr().cast(), size_of_val(list));
}

/// The same for the first `count` of a list.
#[inline]
pub(crate) fn prefetch_first<T>(list: &[T], count: usize) {
    prefetch(&list[..list.len().min(count)]);
}

/// Has the processor fetch `count` of a list from place `at` on, which may lie beyond its end, into its first cache. Its own
/// foresight stops at every page.
#[inline(always)]
pub(crate) fn ahead<T>(list: &[T], at: usize, count: usize) {
    machine::prefetch::<FIRST_CACHE>(list.as_ptr().wrapping_add(at).cast(), count * size_of::<T>());
}

/// The same into its second cache.
#[inline(always)]
pub(crate) fn far_ahead<T>(list: &[T], at: usize, count: usize) {
    machine::prefetch::<SECOND_CACHE>(list.as_ptr().wrapping_add(at).cast(), count * size_of::<T>());
}
