//! Kinds and node indices of the elements.

use crate::element::ElementKind;
use std::ops::{Index, IndexMut};

/// Kind and 0-based node indices of each element.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Connectivity {
    kinds: Vec<ElementKind>,
    ends: Vec<u32>,
    nodes: Vec<u32>,
}

impl Connectivity {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Adds an element.
    ///
    /// # Panics
    /// If the number of nodes does not match the kind.
    pub fn push(&mut self, kind: ElementKind, nodes: &[u32]) {
        assert_eq!(nodes.len(), kind.node_count(), "nodes of a {}", kind.name());
        self.kinds.push(kind);
        self.nodes.extend_from_slice(nodes);
        self.ends.push(self.nodes.len() as u32);
    }

    /// Kind of an element (index).
    #[inline]
    pub fn kind(&self, element: usize) -> ElementKind {
        self.kinds[element]
    }

    /// Kinds of all elements. Shape `[elements]`.
    pub fn kinds(&self) -> &[ElementKind] {
        &self.kinds
    }

    /// Node indices, concatenated.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Mutable node indices, for renumbering.
    pub fn nodes_mut(&mut self) -> &mut [u32] {
        &mut self.nodes
    }

    /// Iterates over the node indices by element.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        (0..self.len()).map(|e| &self[e])
    }

    #[inline]
    fn range(&self, element: usize) -> std::ops::Range<usize> {
        let end = self.ends[element] as usize;
        end - self.kinds[element].node_count()..end
    }
}

impl Index<usize> for Connectivity {
    type Output = [u32];

    #[inline]
    fn index(&self, element: usize) -> &[u32] {
        &self.nodes[self.range(element)]
    }
}

impl IndexMut<usize> for Connectivity {
    #[inline]
    fn index_mut(&mut self, element: usize) -> &mut [u32] {
        let range = self.range(element);
        &mut self.nodes[range]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stores_mixed_kinds_in_order() {
        let mut c = Connectivity::default();
        c.push(ElementKind::Tet4, &[3, 1, 4, 0]);
        c.push(ElementKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!((c.len(), c.kind(1), &c[0]), (2, ElementKind::Hex8, &[3, 1, 4, 0][..]));
        c[1][7] = 9;
        assert_eq!(c.iter().map(|nodes| nodes[nodes.len() - 1]).collect::<Vec<_>>(), [0, 9]);
    }
}
