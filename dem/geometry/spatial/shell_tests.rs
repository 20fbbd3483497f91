use super::*;

fn prism(polygon: &[[f64; 2]], caps: &[[u32; 3]], height: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let n = polygon.len() as u32;
    let at = |z: f64| polygon.iter().map(move |p| Vec3::new(p[0], p[1], z));
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        faces.extend([[k, next, n + next], [k, n + next, n + k]]);
    }
    faces.extend(caps.iter().map(|[a, b, c]| [*c, *b, *a]));
    faces.extend(caps.iter().map(|t| t.map(|v| n + v)));
    (at(0.0).chain(at(height)).collect(), faces)
}

fn own(count: usize) -> Vec<u32> {
    (0..count as u32).collect()
}

#[test]
fn corners_of_an_angle() {
    let polygon = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    let (vertices, faces) = prism(&polygon, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 1.5);
    let shell = Shell::rounded(&vertices, &faces, &own(12), 0.1).unwrap();
    let at = |k: usize| {
        let face = faces.iter().position(|f| f.contains(&(k as u32))).unwrap();
        let corner = faces[face].iter().position(|v| *v == k as u32).unwrap();
        shell.facets[face].corners[corner]
    };
    for (k, x) in [(0, [0.1, 0.1, 0.1]), (2, [1.9, 0.9, 0.1]), (3, [0.9, 0.9, 0.1]), (10, [0.9, 2.9, 1.4])] {
        assert!((at(k) - Vec3::from(x)).norm() < 1e-14, "{k}: {}", at(k));
    }
    assert!((Vec3::from(shell.bounds.1) - Vec3::new(1.9, 2.9, 1.4)).norm() < 1e-14);
    let pressing: f64 = shell.facets.iter().flat_map(|f| f.edges).map(|e| e.share.press).sum();
    assert_eq!(pressing, 18.0);
    let [tips, length] = shell.flattest(1e-6);
    assert!(tips >= 5.0 && (length - 9.2).abs() < 1e-12, "{tips} {length}");
}

#[test]
fn what_is_too_thin() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (vertices, faces) = prism(&square, &[[0, 1, 2], [0, 2, 3]], 0.1);
    assert!(Shell::rounded(&vertices, &faces, &own(8), 0.049).is_some());
    assert!(Shell::rounded(&vertices, &faces, &own(8), 0.051).is_none());
    let wedge = [[0.0, 0.0], [1.0, -0.02], [1.0, 0.02]];
    let (vertices, faces) = prism(&wedge, &[[0, 1, 2]], 1.0);
    let shell = Shell::rounded(&vertices, &faces, &own(6), 0.005).unwrap();
    let tip = shell.bounds.0[0];
    assert!((tip - 0.02).abs() < 1e-3, "{tip}");
}
