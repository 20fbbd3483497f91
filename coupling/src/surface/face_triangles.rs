//! Flat facets instead of curved faces.

use trackbed_fem::FaceShape;
use trackbed_fem::mesh::Face;

/// Triangles of a face by node index, counter-clockwise seen from outside.
fn triangles(shape: FaceShape) -> &'static [[usize; 3]] {
    match shape {
        // Four corners cut off, the inner square halved.
        FaceShape::Quad8 => &[[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]],
        FaceShape::Tri6 => &[[0, 3, 5], [1, 4, 3], [2, 5, 4], [3, 4, 5]],
        FaceShape::Quad4 => &[[0, 1, 2], [0, 2, 3]],
        FaceShape::Tri3 => &[[0, 1, 2]],
    }
}

/// Splits a face into flat triangles between its nodes, mid-side nodes included.
///
/// Force and moment stay exact. Closest points need no Newton iteration.
pub fn face_triangles(face: &Face) -> impl Iterator<Item = Face> + '_ {
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

    #[test]
    fn facets_cover_a_face() {
        let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        let faces = SolidSurface::facing(&mesh, [0.0, 0.0, 1.0], 0.1);
        let quad8 = faces[0];
        let quad4 = Face { shape: FaceShape::Quad4, ..quad8 };
        // Half of the quadrilateral; a corner replaces the missing mid-node.
        let tri3 = Face { shape: FaceShape::Tri3, ..quad8 };
        for (face, count, area) in [(quad8, 6, 1.0), (quad4, 2, 1.0), (tri3, 1, 0.5)] {
            let own: Vec<Face> = face_triangles(&face).collect();
            let surface = SolidSurface::new(&mesh, own.clone());
            let sum = (0..own.len() as u32).map(|k| surface.area_vector(k)[2]).sum::<f64>();
            assert_eq!(own.len(), count);
            assert!((sum - area).abs() < 1e-12, "{sum} of {area}");
            assert!((0..own.len() as u32).all(|k| surface.area_vector(k)[2] > 0.0));
            assert!(own.iter().all(|f| (f.element, f.side) == (face.element, face.side)));
        }
        // Each corner in one facet, each mid-side node in three.
        let of_six: Vec<[usize; 3]> = triangles(FaceShape::Tri6).to_vec();
        let uses = |n: usize| of_six.iter().filter(|t| t.contains(&n)).count();
        assert_eq!([0, 1, 2, 3, 4, 5].map(uses), [1, 1, 1, 3, 3, 3]);
    }
}
