//! Which nodes each element has: kinds of elements and their node indices, one after the other.

use crate::element::ElementKind;
use std::ops::{Index, IndexMut};

/// The elements of a mesh: kind and nodes of each, in the node order of its kind.
///
/// `connectivity[e]` is the slice of node indices (0-based) of element `e`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Connectivity {
    kinds: Vec<ElementKind>,
    /// End of each element in `nodes`.
    ends: Vec<u32>,
    nodes: Vec<u32>,
}

impl Connectivity {
    /// Number of elements.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Adds an element.
    ///
    /// # Panics
    /// When the number of nodes is not that of the kind.
    pub fn push(&mut self, kind: ElementKind, nodes: &[u32]) {
        assert_eq!(nodes.len(), kind.node_count(), "nodes of a {}", kind.name());
        self.kinds.push(kind);
        self.nodes.extend_from_slice(nodes);
        self.ends.push(self.nodes.len() as u32);
    }

    /// Kind of element `element` (index).
    #[inline]
    pub fn kind(&self, element: usize) -> ElementKind {
        self.kinds[element]
    }

    /// Kinds of all elements. Shape `[elements]`.
    pub fn kinds(&self) -> &[ElementKind] {
        &self.kinds
    }

    /// Node indices of all elements, one after the other.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The same, to renumber them.
    pub fn nodes_mut(&mut self) -> &mut [u32] {
        &mut self.nodes
    }

    /// Node indices element by element.
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
    fn elements_of_different_kinds_lie_one_after_the_other() {
        let mut c = Connectivity::default();
        c.push(ElementKind::Tet4, &[3, 1, 4, 0]);
        c.push(ElementKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!((c.len(), c.kind(1), &c[0]), (2, ElementKind::Hex8, &[3, 1, 4, 0][..]));
        c[1][7] = 9;
        assert_eq!(c.iter().map(|nodes| nodes[nodes.len() - 1]).collect::<Vec<_>>(), [0, 9]);
    }
}
