//! Shape quality of elements.
//!
//! Scaled Jacobian: least det J / (|g1| |g2| |g3|) over corners and Gauss points of the mass, g the columns
//! of J = dx/dξ. At a pyramid's apex the limits along the four uprights count.
//!
//! Aspect ratio: longest over shortest edge, between corners. Volume: integration rule of the mass.

use trackbed_fem::Mesh;
use trackbed_fem::element::{ElementKind, mass_points};
use trackbed_fem::kinematics::ElementCoordinates;

/// Shape and size of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Least scaled Jacobian, at most 1.
    pub scaled_jacobian: f64,
    /// Aspect ratio, at least 1; infinite for an edge without length.
    pub aspect_ratio: f64,
    /// Volume [m³]; negative if inverted.
    pub volume: f64,
    /// Least determinant of the Jacobian matrix [m³].
    pub determinant: f64,
    /// Its corner, or Gauss point plus the number of corners.
    pub worst_point: usize,
}

/// Returns the quality of element `element` (index).
pub fn element_quality(mesh: &Mesh, element: usize) -> Quality {
    let (x, kind) = (mesh.element_coordinates(element), mesh.connectivity.kind(element));
    quality(kind, &x)
}

fn quality(kind: ElementKind, x: &ElementCoordinates) -> Quality {
    let corners = kind.corner_count();
    let at_corners = (0..corners).flat_map(|corner| {
        kind.limits_at_node(corner).iter().map(move |xi| (corner, kind.gradients(*xi), 0.0))
    });
    let at_points = mass_points(kind).iter().enumerate().map(|(i, p)| (corners + i, p.gradients, p.weight));
    let mut quality = Quality {
        scaled_jacobian: f64::INFINITY,
        aspect_ratio: aspect_ratio(kind, x),
        volume: 0.0,
        determinant: f64::INFINITY,
        worst_point: 0,
    };
    for (point, gradients, weight) in at_corners.chain(at_points) {
        let columns = columns(x, &gradients);
        let determinant = determinant(&columns);
        let size: f64 = columns.iter().map(norm).product();
        let scaled = if size > 0.0 { determinant / size } else { 0.0 };
        quality.scaled_jacobian = quality.scaled_jacobian.min(scaled);
        quality.volume += weight * determinant;
        if determinant < quality.determinant {
            (quality.determinant, quality.worst_point) = (determinant, point);
        }
    }
    quality
}

fn columns(x: &ElementCoordinates, gradients: &ElementCoordinates) -> [[f64; 3]; 3] {
    let mut columns = [[0.0; 3]; 3];
    for (gradient, point) in gradients.iter().zip(x) {
        for natural in 0..3 {
            for axis in 0..3 {
                columns[natural][axis] += gradient[natural] * point[axis];
            }
        }
    }
    columns
}

fn determinant(g: &[[f64; 3]; 3]) -> f64 {
    let [a, b, c] = g;
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn norm(v: &[f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

fn aspect_ratio(kind: ElementKind, x: &ElementCoordinates) -> f64 {
    let length = |[a, b]: [usize; 2]| norm(&[0, 1, 2].map(|axis| x[b][axis] - x[a][axis]));
    let (least, greatest) = kind
        .edges()
        .iter()
        .map(|edge| length(*edge))
        .fold((f64::INFINITY, 0.0_f64), |(l, g), length| (l.min(length), g.max(length)));
    if least > 0.0 { greatest / least } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_fem::element::hex20;

    fn brick(size: [f64; 3]) -> ElementCoordinates {
        hex20::NATURAL.map(|xi| [0, 1, 2].map(|axis| 0.5 * size[axis] * (1.0 + hex20_axis(xi, axis))))
    }

    fn hex20_axis(xi: [f64; 3], axis: usize) -> f64 {
        let [i, j, l, m] = [0, 1, 3, 4].map(|n| hex20::NATURAL[n]);
        let ahead = [j, l, m][axis];
        let natural = (0..3).find(|a| ahead[*a] != i[*a]).unwrap();
        xi[natural]
    }

    #[test]
    fn a_brick() {
        let found = quality(ElementKind::Hex20, &brick([2.0, 3.0, 0.5]));
        assert!((found.volume - 3.0).abs() < 1e-13);
        assert!((found.scaled_jacobian - 1.0).abs() < 1e-13);
        assert!((found.aspect_ratio - 6.0).abs() < 1e-13);
        assert!((found.determinant - 3.0 / 8.0).abs() < 1e-13);
    }

    #[test]
    fn sheared_brick_gives_sine_of_angle() {
        let sheared = brick([1.0; 3]).map(|[x, y, z]| [x + y, y, z]);
        let found = quality(ElementKind::Hex20, &sheared);
        assert!((found.scaled_jacobian - 0.5_f64.sqrt()).abs() < 1e-13);
        assert!((found.volume - 1.0).abs() < 1e-13);
    }

    #[test]
    fn curved_element_volume_is_exact() {
        let h = 0.15;
        let mut x = brick([1.0; 3]);
        for (point, [a, b]) in x[8..].iter_mut().zip(ElementKind::Hex20.edges()) {
            if matches!([*a, *b], [4, 5] | [6, 7]) {
                point[2] += h;
            }
        }
        assert!((quality(ElementKind::Hex20, &x).volume - (1.0 + 2.0 / 3.0 * h)).abs() < 1e-13);
    }

    #[test]
    fn detects_inversion_at_corner() {
        let mut x = brick([1.0; 3]);
        x[8][0] = 0.2;
        let found = quality(ElementKind::Hex20, &x);
        assert!(found.scaled_jacobian < 0.0 && found.worst_point == 0, "{found:?}");
        x[8][0] = 0.3;
        assert!(quality(ElementKind::Hex20, &x).scaled_jacobian > 0.0);
        // Likewise at the apex, the fifth corner of a pyramid: upright 0-4.
        let mut x = ElementCoordinates::default();
        x[..13].copy_from_slice(ElementKind::Pyramid13.natural());
        assert!((quality(ElementKind::Pyramid13, &x).scaled_jacobian - 1.0).abs() < 1e-6);
        for (along, inverted) in [(0.70, false), (0.80, true)] {
            x[9] = [along - 1.0, along - 1.0, along];
            let found = quality(ElementKind::Pyramid13, &x);
            assert_eq!(found.scaled_jacobian <= 0.0, inverted, "{found:?}");
            assert_eq!(found.worst_point, 4, "{found:?}");
        }
        let mirrored = brick([1.0; 3]).map(|[x, y, z]| [x, y, -z]);
        assert!(quality(ElementKind::Hex20, &mirrored).volume < 0.0);
    }
}
