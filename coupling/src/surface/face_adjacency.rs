//! Connectivity of faces of any kind by the corners of their sides.

use trackbed_fem::FaceShape;

pub(super) struct FaceAdjacency {
    /// Index of each side, shared by its faces. Shape `[faces][4]`.
    pub number: Vec<[u32; 4]>,
    /// Whether each side is free. Shape `[faces][4]`.
    pub border: Vec<[bool; 4]>,
    /// Pairs of faces with a common side.
    pub seams: Vec<[u32; 2]>,
    /// Whether each node ends a free side. Shape `[surface nodes]`.
    pub rim: Vec<bool>,
}

impl FaceAdjacency {
    pub fn new(shapes: &[FaceShape], nodes: &[[u32; 8]]) -> FaceAdjacency {
        let mut all: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(4 * shapes.len());
        for ((shape, nodes), face) in shapes.iter().zip(nodes).zip(0..) {
            let corners = shape.corner_count();
            all.extend((0..corners).map(|side| {
                let (a, b) = (nodes[side], nodes[(side + 1) % corners]);
                ([a.min(b), a.max(b)], face, side)
            }));
        }
        all.sort_unstable();
        let mut sides = FaceAdjacency {
            number: vec![[0; 4]; shapes.len()],
            border: vec![[true; 4]; shapes.len()],
            seams: Vec::new(),
            rim: vec![false; nodes.iter().flatten().map(|n| *n as usize + 1).max().unwrap_or(0)],
        };
        for (group, number) in all.chunk_by(|a, b| a.0 == b.0).zip(0..) {
            for &(_, face, side) in group {
                sides.number[face as usize][side] = number;
                sides.border[face as usize][side] = group.len() == 1;
            }
            if group.len() == 1 {
                group[0].0.iter().for_each(|&n| sides.rim[n as usize] = true);
            }
            sides.seams.extend(group.windows(2).map(|pair| [pair[0].1, pair[1].1]));
        }
        sides
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joins_sides_of_different_kinds() {
        let shapes = [FaceShape::Quad8, FaceShape::Tri3, FaceShape::Tri6];
        // 3─2
        // │ │╲4   5 is beyond 4.
        // 0─1
        let nodes = [[0, 1, 2, 3, 10, 11, 12, 13], [1, 4, 2, 1, 1, 1, 1, 1], [4, 5, 2, 14, 15, 16, 4, 4]];
        let sides = FaceAdjacency::new(&shapes, &nodes);
        assert_eq!(sides.seams, [[0, 1], [1, 2]]);
        assert_eq!(sides.border[0], [true, false, true, true]);
        assert_eq!(sides.border[1][..3], [true, false, false]);
        assert_eq!(sides.border[2][..3], [true, true, false]);
        assert_eq!(sides.number[0][1], sides.number[1][2]);
        assert_eq!(sides.number[1][1], sides.number[2][2]);
        assert_ne!(sides.number[0][0], sides.number[1][0]);
        assert!(sides.rim[..6].iter().all(|r| *r));
        // The fourth triangle closes the ring about node 2.
        let around = [[0, 1, 2, 0, 0, 0, 0, 0], [1, 3, 2, 1, 1, 1, 1, 1], [3, 0, 2, 3, 3, 3, 3, 3]];
        assert_eq!(FaceAdjacency::new(&[FaceShape::Tri3; 3], &around).rim, [true, true, false, true]);
    }
}
