//! Flat facets in place of curved faces: the cheap choice of the trade.

use trackbed_fem::FaceShape;
use trackbed_fem::mesh::Face;

/// Corners of the triangles that a face is cut into, as numbers of its nodes, counter-clockwise seen from outside.
fn triangles(shape: FaceShape) -> &'static [[usize; 3]] {
    match shape {
        // The four corners are cut off, and the square between the mid-side nodes is halved.
        FaceShape::Quad8 => &[[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]],
        FaceShape::Tri6 => &[[0, 3, 5], [1, 4, 3], [2, 5, 4], [3, 4, 5]],
        FaceShape::Quad4 => &[[0, 1, 2], [0, 2, 3]],
        FaceShape::Tri3 => &[[0, 1, 2]],
    }
}

/// A face as flat triangles between its nodes, mid-side nodes among them: all nodes of the face keep taking up forces, sum and moment
/// of which stay exact. Between the nodes the facets miss the face by its bulge, s²/8R for a radius of curvature R and sides s
/// of the facets; their closest point is found at once, where a curved face needs Newton's iteration.
pub fn facets(face: &Face) -> impl Iterator<Item = Face> + '_ {
    triangles(face.shape).iter().map(|corners| {
        let mut nodes = [face.nodes[corners[0]]; 8];
        (0..3).for_each(|k| nodes[k] = face.nodes[corners[k]]);
        Face { shape: FaceShape::Tri3, nodes, ..*face }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::SolidSurface;
    use trackbed_fem::mesh::Mesh;

    /// The facets of each kind of flat face cover it once, with its outward side: their areas sum up to that of the face.
    #[test]
    fn facets_cover_a_face() {
        let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        let faces = SolidSurface::facing(&mesh, [0.0, 0.0, 1.0], 0.1);
        let quad8 = faces[0];
        let quad4 = Face { shape: FaceShape::Quad4, ..quad8 };
        // Half of the quadrilateral; the diagonal has no node of its own: a corner's place does for counting.
        let tri3 = Face { shape: FaceShape::Tri3, ..quad8 };
        for (face, count, area) in [(quad8, 6, 1.0), (quad4, 2, 1.0), (tri3, 1, 0.5)] {
            let own: Vec<Face> = facets(&face).collect();
            let surface = SolidSurface::new(&mesh, own.clone());
            let sum = (0..own.len() as u32).map(|k| surface.area_vector(k)[2]).sum::<f64>();
            assert_eq!(own.len(), count);
            assert!((sum - area).abs() < 1e-12, "{sum} of {area}");
            assert!((0..own.len() as u32).all(|k| surface.area_vector(k)[2] > 0.0));
            assert!(own.iter().all(|f| (f.element, f.side) == (face.element, face.side)));
        }
        // Six nodes of a triangle: each corner's facet holds the corner, and the middle one the mid-side nodes.
        let of_six: Vec<[usize; 3]> = triangles(FaceShape::Tri6).to_vec();
        let uses = |n: usize| of_six.iter().filter(|t| t.contains(&n)).count();
        assert_eq!([0, 1, 2, 3, 4, 5].map(uses), [1, 1, 1, 3, 3, 3]);
    }
}
