use super::*;

fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let vertices = (0..8).map(|k| Vec3::from_fn(|d, _| f64::from(k >> d & 1))).collect();
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    (vertices, quads.iter().flat_map(|q: &[u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect())
}

fn same(vertices: &[Vec3]) -> Vec<u32> {
    (0..vertices.len() as u32).collect()
}

#[test]
fn a_cube() {
    let (vertices, triangles) = cube();
    let all = facets(&vertices, &triangles, &same(&vertices));
    let edges = || all.iter().flat_map(|f| f.edges.iter());
    assert_eq!(edges().filter(|e| e.share.press == 1.0).count(), 12);
    assert_eq!(edges().filter(|e| e.share.press > 0.0).count(), 12);
    let tips = || all.iter().flat_map(|f| f.tips.iter());
    assert_eq!(tips().filter(|t| t.press == 1.0).count(), 8);
    let [shared, corners] = [edges().map(|e| e.share.count).sum::<f64>(), tips().map(|t| t.count).sum()];
    assert_eq!((all.len() as f64 + shared + corners, shared, corners), (2.0, -18.0, 8.0));
}

#[test]
fn borders_folds_and_fins() {
    let square = |height: f64| {
        vec![
            Vec3::zeros(),
            Vec3::x(),
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::new(0.0, 1.0, height),
            Vec3::new(0.5, 0.5, 1.0),
        ]
    };
    let pressed = |vertices: &[Vec3], triangles: &[[u32; 3]]| -> (Vec<f64>, f64) {
        let all = facets(vertices, triangles, &same(vertices));
        let edges = all.iter().flat_map(|f| f.edges.map(|e| e.share.press)).filter(|p| *p > 0.0).collect();
        (edges, all.iter().flat_map(|f| f.tips.map(|t| t.press)).sum())
    };
    let two = [[0, 1, 2], [0, 2, 3]];
    assert_eq!(pressed(&square(0.0), &two), (vec![1.0; 4], 4.0));
    let bend: f64 = 0.1_f64.to_radians();
    let (mut folded, _) = pressed(&square(bend * 0.5_f64.sqrt()), &two);
    folded.sort_by(f64::total_cmp);
    assert!(folded.len() == 5 && (folded[0] - bend / FULL).abs() < 1e-3, "{folded:?}");
    let (fin, _) = pressed(&square(0.0), &[[0, 1, 2], [0, 2, 3], [0, 2, 4]]);
    assert_eq!(fin, vec![1.0; 7]);
}

#[test]
fn a_straight_border_has_no_corner() {
    let vertices = [Vec3::zeros(), Vec3::x(), Vec3::x() * 2.0, Vec3::y()];
    let all = facets(&vertices, &[[0, 1, 3], [1, 2, 3]], &same(&vertices));
    let pressing: f64 = all.iter().flat_map(|f| f.tips.map(|t| t.press)).sum();
    assert_eq!(pressing, 3.0);
}
