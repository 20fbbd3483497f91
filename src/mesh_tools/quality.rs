//! Shape of one element.
//!
//! Scaled Jacobian: the least of det J / (|g1| |g2| |g3|) over the corners and the Gauss points of the mass, g the
//! columns of J = dx/dξ (Knupp 2000 takes the corners only, which misses curved edges), so that it is 1 for a
//! brick and for the natural tetrahedron. It is not positive for an element that is turned inside out at one of these
//! points. At the apex of a pyramid, where the gradients depend on the direction, the limits along the four uprights count.
//!
//! Aspect ratio: longest over shortest of the edges, measured from corner to corner.
//!
//! Volume: by the rule of the mass; for hexahedra 3x3x3 Gauss points, exact, since det J has degree 5 at most in each
//! natural coordinate.

use trackbed_fem::Mesh;
use trackbed_fem::element::{ElementKind, mass_points};
use trackbed_fem::kinematics::ElementCoordinates;

/// Shape and size of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Least scaled Jacobian, at most 1.
    pub scaled_jacobian: f64,
    /// Longest over shortest edge, at least 1; infinite where an edge has no length.
    pub aspect_ratio: f64,
    /// Volume [m³]; negative for an element numbered inside out.
    pub volume: f64,
    /// Least determinant of the Jacobian matrix [m³].
    pub determinant: f64,
    /// Where that is: below the number of corners that corner, else the Gauss point plus that number.
    pub worst_point: usize,
}

/// Shape and size of element `element` (index) of a mesh.
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

/// dx/dξ for each natural coordinate ξ.
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

    /// Coordinate along x, y, z of a node of a brick whose node I is at the origin, J along x, L along y.
    fn hex20_axis(xi: [f64; 3], axis: usize) -> f64 {
        let [i, j, l, m] = [0, 1, 3, 4].map(|n| hex20::NATURAL[n]);
        let ahead = [j, l, m][axis];
        // The natural axis in which the neighbour of I differs from I.
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
    fn a_sheared_brick_has_the_sine_of_its_angle() {
        let sheared = brick([1.0; 3]).map(|[x, y, z]| [x + y, y, z]);
        let found = quality(ElementKind::Hex20, &sheared);
        assert!((found.scaled_jacobian - 0.5_f64.sqrt()).abs() < 1e-13);
        assert!((found.volume - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_curved_element_has_the_volume_of_its_curved_body() {
        // Mid-sides of all four edges along x are raised by h: a parabolic arch, whose volume stays that of
        // the brick (top and bottom rise alike); raising the top ones alone adds 2/3 h.
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
    fn an_element_turned_inside_out_is_found_at_a_corner() {
        // A mid-side node beyond a quarter of the edge from its corner: det J turns negative at that corner.
        let mut x = brick([1.0; 3]);
        x[8][0] = 0.2;
        let found = quality(ElementKind::Hex20, &x);
        assert!(found.scaled_jacobian < 0.0 && found.worst_point == 0, "{found:?}");
        x[8][0] = 0.3;
        assert!(quality(ElementKind::Hex20, &x).scaled_jacobian > 0.0);
        // The same at the apex of a pyramid, which is its fifth corner: upright 0-4.
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
