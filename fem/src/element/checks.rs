//! Checks shared by the element tests; each panics on failure.

use super::quadrature::{FACE2, FACE3, FacePoint, TRIANGLE3, TRIANGLE6, VolumePoint};
use super::{quad4, quad8, tri3, tri6};

/// Generic interior points.
fn interior<const D: usize, const N: usize>(natural: &[[f64; D]; N]) -> [[f64; D]; 4] {
    [1.0, 2.3, 4.1, 5.6].map(|phase: f64| {
        let weights: [f64; N] = std::array::from_fn(|a| 1.2 + libm::sin(phase * (a + 1) as f64));
        let sum: f64 = weights.iter().sum();
        std::array::from_fn(|k| (0..N).map(|a| weights[a] * natural[a][k]).sum::<f64>() / sum)
    })
}

pub fn nodal<const D: usize, const N: usize>(natural: &[[f64; D]; N], shape: fn([f64; D]) -> [f64; N]) {
    for (b, &xi) in natural.iter().enumerate() {
        for (a, value) in shape(xi).into_iter().enumerate() {
            let expected = if a == b { 1.0 } else { 0.0 };
            assert!((value - expected).abs() < 1e-14, "N{a} at node {b} is {value}");
        }
    }
}

pub fn mid_sides<const D: usize, const N: usize>(
    natural: &[[f64; D]; N],
    first: usize,
    sides: &[(usize, usize)],
) {
    assert_eq!(first + sides.len(), N);
    for (m, &(a, b)) in sides.iter().enumerate() {
        for k in 0..D {
            assert_eq!(natural[first + m][k], (natural[a][k] + natural[b][k]) / 2.0, "node {}", first + m);
        }
    }
}

pub fn differences<const D: usize, const N: usize>(
    natural: &[[f64; D]; N],
    shape: fn([f64; D]) -> [f64; N],
    gradients: fn([f64; D]) -> [[f64; D]; N],
) {
    let h = 1e-5;
    for xi in interior(natural) {
        let exact = gradients(xi);
        for k in 0..D {
            let (mut up, mut down) = (xi, xi);
            up[k] += h;
            down[k] -= h;
            let (up, down) = (shape(up), shape(down));
            for a in 0..N {
                let difference = (up[a] - down[a]) / (2.0 * h);
                assert!((difference - exact[a][k]).abs() < 1e-9, "node {a} axis {k} at {xi:?}");
            }
        }
    }
}

/// Monomials up to `degree` are interpolated exactly on an affine element, some of the next not.
pub fn complete<const D: usize, const N: usize>(
    natural: &[[f64; D]; N],
    shape: fn([f64; D]) -> [f64; N],
    degree: i32,
) {
    let affine = |xi: [f64; D]| -> [f64; 3] {
        std::array::from_fn(|i| {
            let sum: f64 = (0..D).map(|k| (1.0 + 0.37 * libm::cos((i + 2 * k) as f64)) * xi[k]).sum();
            0.2 + 0.1 * i as f64 + 0.3 * sum + if i < D { 0.4 * xi[i] } else { 0.0 }
        })
    };
    let mut worst_beyond: f64 = 0.0;
    for [i, j, k] in monomials(degree + 1) {
        let value = |x: [f64; 3]| x[0].powi(i) * x[1].powi(j) * x[2].powi(k);
        for xi in interior(natural) {
            let n = shape(xi);
            let interpolated: f64 = (0..N).map(|a| n[a] * value(affine(natural[a]))).sum();
            let error = (interpolated - value(affine(xi))).abs();
            if i + j + k <= degree {
                assert!(error < 1e-14, "x^{i} y^{j} z^{k}: {error:e} at {xi:?}");
            } else {
                worst_beyond = worst_beyond.max(error);
            }
        }
    }
    assert!(worst_beyond > 1e-3, "degree {} should not be complete: {worst_beyond:e}", degree + 1);
}

pub fn monomials(degree: i32) -> Vec<[i32; 3]> {
    let up_to = move |n: i32| 0..=n;
    up_to(degree)
        .flat_map(|i| up_to(degree - i).flat_map(move |j| up_to(degree - i - j).map(move |k| [i, j, k])))
        .collect()
}

fn face_shape(nodes: usize, xi: [f64; 2]) -> Vec<f64> {
    match nodes {
        3 => tri3::shape_functions(xi).to_vec(),
        4 => quad4::shape_functions(xi).to_vec(),
        6 => tri6::shape_functions(xi).to_vec(),
        _ => quad8::shape_functions(xi).to_vec(),
    }
}

fn face_gradients(nodes: usize, xi: [f64; 2]) -> Vec<[f64; 2]> {
    match nodes {
        3 => tri3::gradients(xi).to_vec(),
        4 => quad4::gradients(xi).to_vec(),
        6 => tri6::gradients(xi).to_vec(),
        _ => quad8::gradients(xi).to_vec(),
    }
}

fn face_rule(nodes: usize) -> &'static [FacePoint] {
    match nodes {
        3 => &TRIANGLE3,
        4 => &FACE2,
        6 => &TRIANGLE6,
        _ => &FACE3,
    }
}

fn point_and_area<const N: usize>(x: &[[f64; 3]; N], face: &[usize], xi: [f64; 2]) -> ([f64; 3], [f64; 3]) {
    let (n, d) = (face_shape(face.len(), xi), face_gradients(face.len(), xi));
    let sum = |w: &dyn Fn(usize) -> f64| -> [f64; 3] {
        std::array::from_fn(|k| face.iter().enumerate().map(|(a, &node)| w(a) * x[node][k]).sum())
    };
    let (p, u, v) = (sum(&|a| n[a]), sum(&|a| d[a][0]), sum(&|a| d[a][1]));
    (p, [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// On each face, functions equal the 2-D element's, area vectors point outward, mid-side nodes follow their
/// corner.
pub fn faces<const N: usize>(natural: &[[f64; 3]; N], shape: fn([f64; 3]) -> [f64; N], faces: &[&[usize]]) {
    let middle: [f64; 3] = std::array::from_fn(|k| natural.iter().map(|x| x[k]).sum::<f64>() / N as f64);
    for face in faces {
        let corners = if face.len() % 4 == 0 { 4 } else { 3 };
        for m in corners..face.len() {
            let (a, b) = (face[m - corners], face[(m - corners + 1) % corners]);
            for k in 0..3 {
                assert_eq!(natural[face[m]][k], (natural[a][k] + natural[b][k]) / 2.0, "face {face:?}");
            }
        }
        for xi in [[0.23, 0.41], [0.55, 0.12], [0.08, 0.67]] {
            let (point, area) = point_and_area(natural, face, xi);
            assert!(
                dot(area, std::array::from_fn(|k| point[k] - middle[k])) > 0.0,
                "face {face:?} looks inward"
            );
            let (n, on_face) = (shape(point), face_shape(face.len(), xi));
            for a in 0..N {
                let expected = face.iter().position(|&node| node == a).map_or(0.0, |f| on_face[f]);
                assert!((n[a] - expected).abs() < 1e-14, "N{a} on face {face:?}: {} for {expected}", n[a]);
            }
        }
    }
}

/// Volume of a distorted element equals the surface integral of x · n / 3 over `faces` within `tolerance`;
/// area vectors sum to zero; determinants are positive.
pub fn volume<const N: usize>(
    natural: &[[f64; 3]; N],
    gradients: fn([f64; 3]) -> [[f64; 3]; N],
    faces: &[&[usize]],
    rule: &[VolumePoint],
    tolerance: f64,
) {
    let distorted: [[f64; 3]; N] = std::array::from_fn(|a| {
        std::array::from_fn(|k| {
            let shear: f64 = (0..3).map(|m| 0.2 * libm::sin((2 * k + m) as f64) * natural[a][m]).sum();
            natural[a][k] + shear + 0.05 * libm::sin(1.7 * ((a + 1) * (k + 1)) as f64) + 0.3
        })
    });
    for (x, tolerance) in [(natural, 1e-13), (&distorted, tolerance)] {
        let mut inside = 0.0;
        for &(xi, w) in rule {
            let d = gradients(xi);
            let j: [[f64; 3]; 3] = std::array::from_fn(|r| {
                std::array::from_fn(|c| (0..N).map(|a| x[a][r] * d[a][c]).sum::<f64>())
            });
            let det = nalgebra::Matrix3::from(j).determinant();
            assert!(det > 0.0, "determinant {det} at {xi:?}");
            inside += w * det;
        }
        let (mut around, mut closure) = (0.0, [0.0; 3]);
        for face in faces {
            for &(xi, w) in face_rule(face.len()) {
                let (point, area) = point_and_area(x, face, xi);
                around += w * dot(point, area) / 3.0;
                for k in 0..3 {
                    closure[k] += w * area[k];
                }
            }
        }
        assert!(closure.iter().all(|c| c.abs() < 1e-13), "faces do not close: {closure:?}");
        assert!((inside - around).abs() < tolerance * around, "volume {inside} by points, {around} by faces");
    }
}
