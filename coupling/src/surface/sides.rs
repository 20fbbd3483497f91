//! How the faces of a surface join at their sides, whatever their kinds: a side is known by its two corners, so that the
//! side of a triangle meets that of a quadrilateral, and one with a mid-side node one without.

use trackbed_fem::FaceShape;

/// Sides of the faces of a surface.
pub(super) struct Sides {
    /// Number of each side, the same for the faces that share it; triangles have three. Shape `[faces][4]`.
    pub number: Vec<[u32; 4]>,
    /// Whether each side is that face's alone. Shape `[faces][4]`.
    pub border: Vec<[bool; 4]>,
    /// Pairs of faces that share a side.
    pub seams: Vec<[u32; 2]>,
    /// Whether each surface node ends a side that belongs to one face alone; a triangle may touch the border with a
    /// corner and none of its sides. Shape `[surface nodes]`.
    pub rim: Vec<bool>,
}

impl Sides {
    /// The sides of faces with these shapes and nodes.
    pub fn new(shapes: &[FaceShape], nodes: &[[u32; 8]]) -> Sides {
        let mut all: Vec<([u32; 2], u32, usize)> = Vec::with_capacity(4 * shapes.len());
        for ((shape, nodes), face) in shapes.iter().zip(nodes).zip(0..) {
            let corners = shape.corner_count();
            all.extend((0..corners).map(|side| {
                let (a, b) = (nodes[side], nodes[(side + 1) % corners]);
                ([a.min(b), a.max(b)], face, side)
            }));
        }
        all.sort_unstable();
        let mut sides = Sides {
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

    /// A square, a triangle beside it and one beside that: two seams, of which the first joins kinds.
    #[test]
    fn sides_join_whatever_their_kinds() {
        let shapes = [FaceShape::Quad8, FaceShape::Tri3, FaceShape::Tri6];
        // 3─2
        // │ │╲4   5 is beyond 4.
        // 0─1
        let nodes = [[0, 1, 2, 3, 10, 11, 12, 13], [1, 4, 2, 1, 1, 1, 1, 1], [4, 5, 2, 14, 15, 16, 4, 4]];
        let sides = Sides::new(&shapes, &nodes);
        assert_eq!(sides.seams, [[0, 1], [1, 2]]);
        assert_eq!(sides.border[0], [true, false, true, true]);
        assert_eq!(sides.border[1][..3], [true, false, false]);
        assert_eq!(sides.border[2][..3], [true, true, false]);
        assert_eq!(sides.number[0][1], sides.number[1][2]);
        assert_eq!(sides.number[1][1], sides.number[2][2]);
        assert_ne!(sides.number[0][0], sides.number[1][0]);
        assert!(sides.rim[..6].iter().all(|r| *r));
        // A fourth triangle about node 2 closes the ring: the node is then within, which the sides of no face tell.
        let around = [[0, 1, 2, 0, 0, 0, 0, 0], [1, 3, 2, 1, 1, 1, 1, 1], [3, 0, 2, 3, 3, 3, 3, 3]];
        assert_eq!(Sides::new(&[FaceShape::Tri3; 3], &around).rim, [true, true, false, true]);
    }
}
