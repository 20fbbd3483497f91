//! Sub-ranges indexed as the complete list.

#[derive(Debug)]
pub(crate) struct Part<'a, T> {
    pub first: usize,
    pub list: &'a [T],
}

impl<T> Clone for Part<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Part<'_, T> {}

impl<T> Default for Part<'_, T> {
    fn default() -> Self {
        Part { first: 0, list: &[] }
    }
}

impl<T> Part<'_, T> {
    #[inline(always)]
    pub fn get(&self, at: usize) -> Option<&T> {
        self.list.get(at.wrapping_sub(self.first))
    }
}

impl<T> std::ops::Index<usize> for Part<'_, T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, at: usize) -> &T {
        &self.list[at.wrapping_sub(self.first)]
    }
}
