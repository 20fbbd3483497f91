//! Inverse mapping on a distorted surface of many elements.

use crate::support::Scatter;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::surface::Surface;
use trackbed_fem::Mesh;

const CELLS: usize = 6;
const EDGE: f64 = 1.0 / CELLS as f64;

fn distorted_top() -> (Mesh, SolidSurface) {
    let mut mesh = Mesh::block([CELLS, CELLS, CELLS / 2], [1.0, 1.0, 0.5]);
    let mut random = Scatter::new(7);
    for x in &mut mesh.coordinates {
        x[2] -= 0.5;
        if x[2] > -1e-9 {
            let corner = (0..2).all(|d| (x[d] / EDGE - (x[d] / EDGE).round()).abs() < 1e-6);
            let most = if corner { 0.10 } else { 0.15 };
            x.iter_mut().for_each(|c| *c += most * EDGE * random.symmetric());
        }
    }
    let faces = SolidSurface::facing(&mesh, [0.0, 0.0, 1.0], 1.3);
    let surface = SolidSurface::new(&mesh, faces);
    (mesh, surface)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt()
}

/// Nearest patch, distance and natural coordinates.
fn nearest(
    surface: &SolidSurface,
    patches: impl Iterator<Item = u32>,
    point: [f64; 3],
) -> Option<(u32, f64, [f64; 2])> {
    patches
        .map(|patch| {
            let found = surface.closest_point(patch, point, [0.0; 2]);
            (patch, distance(found.point, point), found.local)
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

#[test]
fn finds_points_on_distorted_surface() {
    let (_, surface) = distorted_top();
    let faces = surface.faces().len() as u32;
    assert_eq!(faces, 36);
    let mut random = Scatter::new(11);
    let (mut found, mut worst, mut apart) = (0, 0.0_f64, 0.0_f64);
    let mut patches = Vec::new();
    for k in 0..10_000 {
        let patch = k % faces;
        let local = [0.9999 * random.symmetric(), 0.9999 * random.symmetric()];
        let point = surface.place(patch, local);
        patches.clear();
        surface.candidates(point.map(|c| c - 1e-9), point.map(|c| c + 1e-9), &mut patches);
        let Some((element, residual, natural)) = nearest(&surface, patches.iter().copied(), point) else {
            continue;
        };
        let (brute, _, _) = nearest(&surface, 0..faces, point).expect("there are faces");
        assert_eq!(element, brute, "point {k}");
        assert_eq!(element, patch, "point {k}");
        found += 1;
        worst = worst.max(residual / EDGE);
        apart = apart.max((0..2).map(|d| (natural[d] - local[d]).abs()).fold(0.0, f64::max));
    }
    println!(
        "{found} of 10000 points found, residual {worst:.1e} of the edge, natural coordinates {apart:.1e} off"
    );
    assert_eq!(found, 10_000);
    assert!(worst < 1e-12 && apart < 1e-10);
}

#[test]
fn surface_follows_predicted_motion() {
    let (mesh, mut surface) = distorted_top();
    let mut random = Scatter::new(29);
    let n = 3 * mesh.node_count();
    let mut field = |size: f64| -> Vec<f64> { (0..n).map(|_| size * random.symmetric()).collect() };
    let (u, reference, v) = (field(0.01 * EDGE), field(0.01 * EDGE), field(EDGE));
    let duration = 0.2;
    surface.begin_window(&mesh, &u, &reference, &v, duration);
    let mut random = Scatter::new(31);
    let (mut fastest, mut patches) = (0.0_f64, Vec::new());
    for k in 0..2000_u32 {
        let patch = k % surface.faces().len() as u32;
        let tau = duration * f64::from(k % 5) / 4.0;
        surface.advance(tau);
        let local = [0.99 * random.symmetric(), 0.99 * random.symmetric()];
        let shape = surface.shape_functions(patch, local);
        let face = surface.faces()[patch as usize];
        let sum = |of: &dyn Fn(usize, usize) -> f64| {
            [0, 1, 2]
                .map(|d| face.nodes().iter().zip(shape).map(|(&i, s)| s * of(i as usize, d)).sum::<f64>())
        };
        let velocity = sum(&|i, d| v[3 * i + d]);
        let place = sum(&|i, d| {
            let dof = 3 * i + d;
            mesh.coordinates[i][d] + u[dof] - reference[dof] + v[dof] * tau
        });
        let norm = |a: [f64; 3]| a.iter().map(|c| c * c).sum::<f64>().sqrt();
        let apart = |a: [f64; 3], b: [f64; 3]| norm([0, 1, 2].map(|d| a[d] - b[d]));
        assert!(apart(surface.place(patch, local), place) < 1e-13);
        fastest = fastest.max(norm(velocity));
        patches.clear();
        surface.candidates(place.map(|c| c - 1e-9), place.map(|c| c + 1e-9), &mut patches);
        assert!(patches.contains(&patch), "point {k} at {tau} s");
        let centre = place.map(|c| c + 0.3 * EDGE * random.symmetric());
        let nearest = surface.closest_point(patch, centre, local).point;
        assert!(surface.clearance(patch, centre) <= apart(nearest, centre) + 1e-12, "centre {k}");
        assert!(norm(velocity) <= surface.max_speed());
    }
    // Mid-sides against corners: triple nodal speed at the centre of a face.
    let mut v = vec![0.0; n];
    for face in surface.faces() {
        face.nodes()
            .iter()
            .enumerate()
            .for_each(|(k, &i)| v[3 * i as usize + 2] = if k < 4 { -1.0 } else { 1.0 });
    }
    let zero = vec![0.0; n];
    surface.begin_window(&mesh, &zero, &zero, &v, duration);
    let middle = surface.velocity(0, [0.0; 2])[2];
    println!("random nodes: up to {fastest:.3} m/s; mid-sides against corners: {middle} m/s in the middle");
    assert!((middle - 3.0).abs() < 1e-12 && surface.max_speed() >= middle - 1e-12);
}
