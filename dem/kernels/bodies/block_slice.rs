//! Sub-ranges indexed as the complete list.

#[derive(Debug)]
pub struct BlockSlice<'a, T> {
    pub first: usize,
    pub list: &'a [T],
}

impl<T> Clone for BlockSlice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for BlockSlice<'_, T> {}

impl<T> Default for BlockSlice<'_, T> {
    fn default() -> Self {
        BlockSlice { first: 0, list: &[] }
    }
}

impl<T> BlockSlice<'_, T> {
    #[inline(always)]
    pub fn get(&self, at: usize) -> Option<&T> {
        self.list.get(at.wrapping_sub(self.first))
    }
}

impl<T> std::ops::Index<usize> for BlockSlice<'_, T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, at: usize) -> &T {
        &self.list[at.wrapping_sub(self.first)]
    }
}
