//! Closed forms, orientation, defects, distances, hulls.

use super::*;
use crate::base::random::Random;
use crate::spatial::distance::SurfaceDistance;
use approx::assert_relative_eq;
use nalgebra::Rotation3;
use std::f64::consts::PI;

/// Outward-oriented.
fn brick(lo: [f64; 3], hi: [f64; 3]) -> Surface {
    let vertices =
        (0..8).map(|i| std::array::from_fn(|k| if i >> k & 1 == 0 { lo[k] } else { hi[k] })).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    Surface { vertices, triangles }
}

fn icosphere(levels: usize) -> Surface {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        points.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    }
    let mut surface = convex_hull(&points).unwrap();
    for _ in 0..levels {
        let mut split = Surface::default();
        for t in 0..surface.triangles.len() {
            let [a, b, c] = surface.corners(t);
            let base = split.vertices.len() as u32;
            split
                .vertices
                .extend([a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5].map(<[f64; 3]>::from));
            for t in [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]] {
                split.triangles.push(t.map(|k| base + k));
            }
        }
        surface = split.merged(0.0);
    }
    for v in &mut surface.vertices {
        *v = Vector3::from(*v).normalize().into();
    }
    surface
}

/// Concave.
fn l_prism() -> Surface {
    joined(&[brick([0.0; 3], [2.0, 1.0, 1.0]), brick([0.0, 1.0, 0.0], [1.0, 2.0, 1.0])]).unwrap()
}

fn joined(bricks: &[Surface]) -> Option<Surface> {
    let mut quads: Vec<[[f64; 3]; 4]> = Vec::new();
    for b in bricks {
        let [lo, hi] = b.bounds().map(|p| p.map(|x| x as i32));
        for (i, j, k) in (lo[0]..hi[0])
            .flat_map(|i| (lo[1]..hi[1]).flat_map(move |j| (lo[2]..hi[2]).map(move |k| (i, j, k))))
        {
            let cell = brick([i, j, k].map(f64::from), [i + 1, j + 1, k + 1].map(f64::from));
            for pair in cell.triangles.chunks(2) {
                let quad =
                    [pair[0][0], pair[0][1], pair[0][2], pair[1][2]].map(|v| cell.vertices[v as usize]);
                let same = |q: &[[f64; 3]; 4]| quad.iter().all(|p| q.contains(p));
                match quads.iter().position(same) {
                    Some(at) => drop(quads.remove(at)),
                    None => quads.push(quad),
                }
            }
        }
    }
    let vertices = quads.iter().flatten().copied().collect();
    let triangles =
        (0..quads.len() as u32).flat_map(|q| [[4 * q, 4 * q + 1, 4 * q + 2], [4 * q, 4 * q + 2, 4 * q + 3]]);
    Some(Surface { vertices, triangles: triangles.collect() }.merged(0.0))
}

#[test]
fn box_moments_match_closed_form() {
    let (a, b, c) = (0.3, 0.5, 0.7);
    let body = Polyhedron::new(&brick([10.0, -4.0, 2.0], [10.0 + a, -4.0 + b, 2.0 + c])).unwrap();
    let turn = Rotation3::from_euler_angles(0.3, -1.0, 2.0).into_inner();
    let turned = body.mapped(&turn, &Vector3::new(3.0, 2.0, 1.0));
    let centre = Vector3::new(10.0 + a / 2.0, -4.0 + b / 2.0, 2.0 + c / 2.0);
    let v = a * b * c;
    let moments = [a * a + b * b, a * a + c * c, b * b + c * c].map(|s| v * s / 12.0);
    for (body, centre) in [(&body, centre), (&turned, turn * (centre - Vector3::new(3.0, 2.0, 1.0)))] {
        let m = body.moments();
        assert_relative_eq!(m.volume, v, max_relative = 1e-12);
        assert_relative_eq!(m.centroid, centre, max_relative = 1e-13);
        for k in 0..3 {
            assert_relative_eq!(m.principal()[k], moments[k], max_relative = 1e-10);
        }
        assert_relative_eq!(body.surface().area(), 2.0 * (a * b + b * c + c * a), max_relative = 1e-12);
        let mut extents = body.extents();
        assert_relative_eq!(extents[0], c, max_relative = 1e-9);
        extents.sort_by(f64::total_cmp);
        assert_relative_eq!(body.sieve_size(), b, max_relative = 1e-9);
    }
    // Wadell, cube: (π/6)^⅓.
    let cube = Polyhedron::new(&brick([0.0; 3], [2.0; 3])).unwrap();
    assert_relative_eq!(cube.sphericity(), (PI / 6.0).cbrt(), max_relative = 1e-12);
}

#[test]
fn unit_tetrahedron_matches_closed_form() {
    // Unit corners: V = 1/6, centroid 1/4, ∫x² = 1/60, ∫xy = 1/120; central: 1/160, −1/480.
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let surface = Surface { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] };
    let m = Polyhedron::new(&surface).unwrap().moments();
    assert_relative_eq!(m.volume, 1.0 / 6.0, max_relative = 1e-14);
    assert_relative_eq!(m.centroid, Vector3::repeat(0.25), max_relative = 1e-14);
    assert_relative_eq!(m.inertia[(0, 0)], 2.0 / 160.0, max_relative = 1e-12);
    assert_relative_eq!(m.inertia[(0, 1)], 1.0 / 480.0, max_relative = 1e-12);
}

#[test]
fn an_icosphere_converges_to_the_ball() {
    let error = |levels| {
        let body = Polyhedron::new(&icosphere(levels)).unwrap();
        let m = body.moments();
        assert_eq!(body.surface().triangles.len(), 20 << (2 * levels));
        assert!(m.principal().iter().all(|i| (i / m.principal()[0] - 1.0).abs() < 1e-9));
        [m.volume / (4.0 / 3.0 * PI), m.principal()[0] / (8.0 / 15.0 * PI), body.sphericity()]
            .map(|r| 1.0 - r)
    };
    let (coarse, fine) = (error(2), error(3));
    for (c, f) in coarse.iter().zip(fine) {
        // Second order: a quarter per split.
        assert!(f > 0.0 && (c / f - 4.0).abs() < 0.2, "{coarse:?} {fine:?}");
    }
    assert!(fine[0] < 0.01 && fine[1] < 0.02);
}

#[test]
fn windings_are_made_alike_and_outwards() {
    // Deterministically flipped and shifted.
    let mut mixed = icosphere(2);
    let exact = Polyhedron::new(&mixed).unwrap().moments();
    for (i, t) in mixed.triangles.iter_mut().enumerate() {
        if i * i % 7 < 3 {
            t.swap(0, 2);
        }
        t.rotate_left(i % 3);
    }
    let found = mixed.topology().unwrap();
    assert!(found.is_closed_manifold() && found.turned_edges > 100 && found.pieces == 1, "{found:?}");
    let body = Polyhedron::new(&mixed).unwrap();
    assert_relative_eq!(body.moments().volume, exact.volume, max_relative = 1e-13);
    assert_eq!(body.surface().topology().unwrap().turned_edges, 0);
    let mut inward = brick([0.0; 3], [1.0; 3]);
    inward.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_relative_eq!(Polyhedron::new(&inward).unwrap().moments().volume, 1.0, max_relative = 1e-14);
}

fn both(a: &Surface, b: &Surface) -> Surface {
    let base = a.vertices.len() as u32;
    let mut all = a.clone();
    all.vertices.extend(&b.vertices);
    all.triangles.extend(b.triangles.iter().map(|t| t.map(|v| v + base)));
    all
}

#[test]
fn counts_holes_and_pieces() {
    let hollow = both(&brick([0.2; 3], [0.8; 3]), &brick([0.0; 3], [1.0; 3]));
    let body = Polyhedron::new(&hollow).unwrap();
    assert_relative_eq!(body.moments().volume, 1.0 - 0.6_f64.powi(3), max_relative = 1e-13);
    assert_eq!((body.pieces(), body.holes()), (1, 1));
    let distance = SurfaceDistance::new(&body);
    assert!(!distance.contains([0.5; 3]) && distance.contains([0.1, 0.5, 0.5]));
    let apart = both(&brick([0.0; 3], [1.0; 3]), &brick([2.0; 3], [3.0; 3]));
    let body = Polyhedron::new(&apart).unwrap();
    assert_eq!((body.pieces(), body.holes()), (2, 0));
    assert_relative_eq!(body.moments().volume, 2.0, max_relative = 1e-13);
    let three = both(&hollow, &brick([0.4; 3], [0.6; 3]));
    let body = Polyhedron::new(&three).unwrap();
    assert_eq!((body.pieces(), body.holes()), (2, 1));
}

#[test]
fn rejects_surfaces_without_volume() {
    let mut open = brick([0.0; 3], [1.0; 3]);
    open.triangles.pop();
    let error = Polyhedron::new(&open).unwrap_err();
    assert!(matches!(error, SurfaceError::Open { edges: 3, .. }), "{error}");
    assert_eq!(open.topology().unwrap().open_edges, 3);

    // The common edge has four triangles.
    let pair = both(&brick([0.0; 3], [1.0; 3]), &brick([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])).merged(0.0);
    let error = Polyhedron::new(&pair).unwrap_err();
    assert!(matches!(error, SurfaceError::NonManifold { edges: 1, .. }), "{error}");
    assert_eq!(pair.topology().unwrap().branching_edges, 1);

    // Real projective plane on six vertices: closed, one-sided.
    let one_sided = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let vertices = (0..6).map(|i| [f64::from(i), f64::from(i * i), f64::from(i * i * i)]).collect();
    let plane = Surface { vertices, triangles: one_sided.to_vec() };
    assert!(plane.topology().unwrap().is_closed_manifold());
    assert!(matches!(Polyhedron::new(&plane), Err(SurfaceError::OneSided(_))));

    let flat = Surface { vertices: open.vertices.clone(), triangles: vec![[0, 1, 2], [0, 2, 1]] };
    assert_eq!(Polyhedron::new(&flat), Err(SurfaceError::Flat));
    let bad = Surface { vertices: vec![[0.0; 3]], triangles: vec![[0, 0, 7]] };
    assert_eq!(Polyhedron::new(&bad), Err(SurfaceError::Index { triangle: 0, vertex: 7, count: 1 }));
    let nan = Surface { vertices: vec![[0.0, f64::NAN, 0.0]], triangles: vec![] };
    assert_eq!(Polyhedron::new(&nan), Err(SurfaceError::NotFinite(0)));
    assert_eq!(Polyhedron::new(&Surface::default()), Err(SurfaceError::Empty));
}

#[test]
fn merges_vertices_within_tolerance() {
    let exact = icosphere(1);
    let soup = |shift: f64| {
        let mut soup = Surface::default();
        for t in 0..exact.triangles.len() {
            for c in exact.corners(t) {
                let at = soup.vertices.len();
                soup.vertices.push([c.x + shift * (at % 3) as f64, c.y, c.z - shift * (at % 2) as f64]);
            }
            let n = soup.vertices.len() as u32;
            soup.triangles.push([n - 3, n - 2, n - 1]);
        }
        soup
    };
    let merged = soup(0.0).merged(0.0);
    assert_eq!((merged.vertices.len(), merged.triangles.len()), (42, 80));
    let torn = soup(1e-9).merged(0.0);
    assert!(torn.topology().unwrap().open_edges > 0);
    let mended = soup(1e-9).merged(1e-6);
    assert_eq!(mended.vertices.len(), 42);
    assert!(mended.topology().unwrap().is_closed_manifold());
    // −0 equals 0; degenerate triangles vanish.
    let zero =
        Surface { vertices: vec![[0.0; 3], [-0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], triangles: vec![[0, 1, 2]] };
    assert_eq!(zero.merged(0.0), Surface::default());
}

#[test]
fn depth_matches_closed_form() {
    let body = Polyhedron::new(&brick([-1.0; 3], [1.0; 3])).unwrap();
    let distance = SurfaceDistance::new(&body);
    let mut random = Random::new(5, 99);
    for _ in 0..3000 {
        let p: [f64; 3] = std::array::from_fn(|_| 4.0 * random.uniform() - 2.0);
        let out = Vector3::from(p.map(|x| (x.abs() - 1.0).max(0.0)));
        let inside = p.iter().map(|x| 1.0 - x.abs()).fold(f64::INFINITY, f64::min);
        let exact = if inside > 0.0 { inside } else { -out.norm() };
        assert!((distance.depth(p) - exact).abs() < 1e-12, "{p:?}");
    }
    let ball = SurfaceDistance::new(&Polyhedron::new(&icosphere(4)).unwrap());
    for _ in 0..300 {
        let p: [f64; 3] = std::array::from_fn(|_| 3.0 * random.uniform() - 1.5);
        assert!((ball.depth(p) - (1.0 - Vector3::from(p).norm())).abs() < 2e-3, "{p:?}");
    }
}

#[test]
fn side_matches_winding_number() {
    let body = Polyhedron::new(&l_prism()).unwrap();
    assert_relative_eq!(body.moments().volume, 3.0, max_relative = 1e-13);
    let distance = SurfaceDistance::new(&body);
    let mut random = Random::new(6, 99);
    let mut inside = 0;
    for _ in 0..4000 {
        let p: [f64; 3] = std::array::from_fn(|_| 2.6 * random.uniform() - 0.3);
        let winding = body.surface().winding_number(p);
        assert!((winding - winding.round()).abs() < 1e-9);
        assert_eq!(distance.contains(p), winding > 0.5, "{p:?}");
        inside += usize::from(winding > 0.5);
    }
    let share = inside as f64 / 4000.0 * 2.6_f64.powi(3);
    assert!((share - 3.0).abs() < 0.4, "{share}");
}

#[test]
fn surface_points_are_spread_by_area() {
    let body = Polyhedron::new(&brick([0.0; 3], [1.0, 1.0, 9.0])).unwrap();
    let points = body.surface_points(3800);
    let at_end = points.iter().filter(|p| p[2] == 0.0 || p[2] == 9.0).count();
    assert_eq!(at_end, 200);
    let mean = points.iter().map(|p| Vector3::from(*p)).sum::<Vector3<f64>>() / 3800.0;
    assert!((mean - Vector3::new(0.5, 0.5, 4.5)).norm() < 0.02, "{mean}");
}

#[test]
fn hulls_are_closed_and_convex() {
    for seed in 0..20 {
        let mut random = Random::new(seed, 98);
        let points: Vec<[f64; 3]> =
            (0..60).map(|_| std::array::from_fn(|k| (k + 1) as f64 * random.uniform())).collect();
        let hull = convex_hull(&points).unwrap();
        let body = Polyhedron::new(&hull).unwrap();
        assert_eq!(hull.triangles.len(), 2 * hull.vertices.len() - 4);
        assert_eq!(body.surface().triangles, hull.triangles, "wound outwards as they are");
        for t in 0..hull.triangles.len() {
            let [a, b, c] = hull.corners(t);
            let normal = (b - a).cross(&(c - a)).normalize();
            assert!(points.iter().all(|p| normal.dot(&(Vector3::from(*p) - a)) < 1e-9));
        }
    }
    let lattice: Vec<[f64; 3]> =
        (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(|n| f64::from(n) / 3.0)).collect();
    let cube = Polyhedron::new(&convex_hull(&lattice).unwrap()).unwrap();
    assert_relative_eq!(cube.moments().volume, 1.0, max_relative = 1e-9);
    assert_eq!(convex_hull(&lattice[..16]), Err(HullError::Flat(16)));
    assert_eq!(convex_hull(&[[0.0, 0.0, f64::INFINITY]]), Err(HullError::NotFinite(0)));
}
