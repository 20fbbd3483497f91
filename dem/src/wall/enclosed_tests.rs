//! Enclosed solids.

use super::*;

fn cuboid(corner: Vec3, size: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let vertices =
        (0..8).map(|k| corner + Vec3::from_fn(|d, _| if k >> d & 1 == 1 { size[d] } else { 0.0 })).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads
        .iter()
        .enumerate()
        .flat_map(|(k, q)| [[q[0], q[1], q[2]], if k < 2 { [q[0], q[3], q[2]] } else { [q[0], q[2], q[3]] }])
        .collect();
    (vertices, triangles)
}

#[test]
fn enclosed_box() {
    let size = Vec3::new(0.3, 0.5, 0.7);
    let (vertices, mut triangles) = cuboid(Vec3::new(10.0, -20.0, 5.0), size);
    let Enclosed { volume, centre, inertia, faces } = enclosed(&vertices, &triangles).unwrap();
    let v = 0.3 * 0.5 * 0.7;
    assert!((volume / v - 1.0).abs() < 1e-12);
    assert!((centre - Vec3::new(10.15, -19.75, 5.35)).norm() < 1e-12);
    let s = size.component_mul(&size);
    let exact = Matrix3::from_diagonal(&Vec3::new(s.y + s.z, s.z + s.x, s.x + s.y)) * (v / 12.0);
    assert!((inertia - exact).norm() < 1e-12 * exact.norm(), "{inertia}");
    assert_eq!(faces.len(), 12);
    for face in &faces {
        let [a, b, c] = face.map(|v| vertices[v as usize]);
        assert!((b - a).cross(&(c - a)).dot(&(a - centre)) > 0.0);
    }
    // Unwelded vertices.
    let soup: Vec<Vec3> = triangles.iter().flatten().map(|&v| vertices[v as usize]).collect();
    let separate: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    assert!((enclosed(&soup, &separate).unwrap().volume / v - 1.0).abs() < 1e-12);
    triangles.pop();
    assert!(enclosed(&vertices, &triangles).is_none());
}
