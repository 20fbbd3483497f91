use super::*;
use approx::assert_relative_eq;
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

fn cube(n: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for d in 0..3 {
        for side in [0.0, 1.0] {
            for i in 0..n {
                for j in 0..n {
                    let first = vertices.len() as u32;
                    for (a, b) in [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)] {
                        let mut p = Vec3::zeros();
                        p[d] = side;
                        p[(d + 1) % 3] = a as f64 / n as f64;
                        p[(d + 2) % 3] = b as f64 / n as f64;
                        vertices.push(p);
                    }
                    triangles.push([first, first + 1, first + 2]);
                    triangles.push([first + 3, first + 2, first]);
                }
            }
        }
    }
    (vertices, triangles)
}

fn ball(centre: Vec3, n: usize) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for i in 0..=n {
        for j in 0..2 * n {
            let (a, b) = (PI * i as f64 / n as f64, PI * j as f64 / n as f64);
            let pole = i == 0 || i == n;
            let s = if pole { 0.0 } else { a.sin() };
            vertices.push(centre + Vec3::new(s * b.cos(), s * b.sin(), if i == n { -1.0 } else { a.cos() }));
        }
    }
    let at = |i: usize, j: usize| (i * 2 * n + j % (2 * n)) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..2 * n {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (vertices, triangles)
}

fn random() -> impl FnMut() -> f64 {
    let mut rng = Pcg64Mcg::new(3);
    move || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn counts_rays_through_edges_and_vertices() {
    let (vertices, triangles) = cube(4);
    let surface = ClosedSurface::new(&vertices, &triangles).unwrap();
    assert_relative_eq!(surface.volume(), 1.0, max_relative = 1e-13);
    for i in -4..=12_i32 {
        for j in -4..=12_i32 {
            for k in -4..=12_i32 {
                let p = Vec3::new(f64::from(i), f64::from(j), f64::from(k)) / 8.0;
                let inside = [i, j, k].iter().all(|n| (1..8).contains(n));
                let outside = [i, j, k].iter().any(|n| !(0..=8).contains(n));
                if inside || outside {
                    assert_eq!(surface.contains(&p), inside, "{p}");
                }
            }
        }
    }
    assert!(
        surface.holds(&Vec3::new(0.5, 0.5, 0.5), 0.49) && !surface.holds(&Vec3::new(0.5, 0.5, 0.5), 0.51)
    );
    assert!(!surface.holds(&Vec3::new(3.0, 0.5, 0.5), 0.1));
}

#[test]
fn hollow_ball_against_the_closed_form() {
    let n = 60;
    let centre = Vec3::new(0.3, -2.0, 7.0);
    let (mut vertices, mut triangles) = ball(centre, n);
    let (inner, faces) = ball(centre, n);
    let first = vertices.len() as u32;
    vertices.extend(inner.iter().map(|v| centre + (v - centre) * 0.5));
    triangles.extend(faces.iter().map(|t| [t[2] + first, t[1] + first, t[0] + first]));
    let surface = ClosedSurface::new(&vertices, &triangles).unwrap();
    // Faceting error: 1 − cos(π/2n).
    assert_relative_eq!(surface.volume(), 4.0 / 3.0 * PI * (1.0 - 0.125), max_relative = 3e-3);
    let mut unit = random();
    let mut found = [0; 2];
    for _ in 0..20_000 {
        let p = Vec3::new(unit(), unit(), unit()) * 2.4 - Vec3::repeat(1.2);
        let r = p.norm();
        if (r - 1.0).abs() > 4e-3 && (r - 0.5).abs() > 4e-3 {
            let inside = r > 0.5 && r < 1.0;
            assert_eq!(surface.contains(&(centre + p)), inside, "{p}");
            found[usize::from(inside)] += 1;
        }
    }
    assert!(found[0] > 5000 && found[1] > 4000);
    assert!(surface.holds(&(centre + Vec3::new(0.75, 0.0, 0.0)), 0.24));
    assert!(!surface.holds(&(centre + Vec3::new(0.75, 0.0, 0.0)), 0.26));
}

#[test]
fn borders_and_bad_indices_are_refused() {
    let (vertices, mut triangles) = cube(1);
    triangles.pop();
    let error = ClosedSurface::new(&vertices, &triangles).unwrap_err();
    assert!(matches!(error, SurfaceError::Open { edges: 3, .. }), "{error}");
    assert!(error.to_string().contains("3 edges join an odd number"), "{error}");
    assert_eq!(ClosedSurface::new(&vertices, &[]).unwrap_err(), SurfaceError::Empty);
    assert_eq!(ClosedSurface::new(&vertices, &[[0, 1, 99]]).unwrap_err(), SurfaceError::Index(0));
    let bad = [Vec3::new(f64::NAN, 0.0, 0.0)];
    assert_eq!(ClosedSurface::new(&bad, &[[0, 0, 0]]).unwrap_err(), SurfaceError::NotFinite(0));
}
