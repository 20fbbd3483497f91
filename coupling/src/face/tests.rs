use super::*;
use crate::testing::Random;
use trackbed_fem::element;

const SHAPES: [FaceShape; 4] = [FaceShape::Quad8, FaceShape::Tri6, FaceShape::Quad4, FaceShape::Tri3];

/// Nodes displaced by up to 15 % of a half-edge.
fn curved_face(shape: FaceShape, random: &mut Random) -> NodalValues {
    let mut x = [[0.0; 3]; 8];
    for (x, p) in x.iter_mut().zip(landmarks(shape)).take(shape.node_count()) {
        // Triangles of the size of the squares.
        let scale = if shape.corner_count() == 3 { 2.0 } else { 1.0 };
        *x = [scale * p[0], scale * p[1], 0.0].map(|c| c + 0.15 * random.symmetric());
    }
    x
}

/// Natural point within `reach` times the border.
fn natural(shape: FaceShape, random: &mut Random, reach: f64) -> [f64; 2] {
    let [a, b] = [random.symmetric(), random.symmetric()];
    match shape.corner_count() {
        4 => [reach * a, reach * b],
        _ => {
            let (r, s) = (0.5 * (a + 1.0), 0.5 * (b + 1.0));
            let [r, s] = if r + s > 1.0 { [1.0 - r, 1.0 - s] } else { [r, s] };
            [r, s].map(|c| 1.0 / 3.0 + reach * (c - 1.0 / 3.0))
        }
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot(r, r).sqrt()
}

#[test]
fn power_form_matches_shape_functions() {
    let mut random = Random::new(29);
    for shape in SHAPES {
        for _ in 0..100 {
            let x = curved_face(shape, &mut random);
            let form = Form::new(shape, &x);
            let xi = natural(shape, &mut random, 1.0);
            let point = form.at(xi);
            assert!(distance(point, interpolate(shape, &x, xi)) < 1e-15 * 8.0);
            let first = shape.gradients(xi);
            for (a, tangent) in form.tangents(xi).into_iter().enumerate() {
                for d in 0..3 {
                    let sum: f64 = (0..shape.node_count()).map(|i| first[i][a] * x[i][d]).sum();
                    assert!((tangent[d] - sum).abs() < 1e-14);
                }
            }
            let h = 1e-4;
            let at = |a: f64, b: f64| form.at([xi[0] + h * a, xi[1] + h * b]);
            for d in 0..3 {
                let [uu, vv, uv] = form.second(xi).map(|s| s[d] * h * h);
                assert!((at(1., 0.)[d] + at(-1., 0.)[d] - 2.0 * point[d] - uu).abs() < 1e-14);
                assert!((at(0., 1.)[d] + at(0., -1.)[d] - 2.0 * point[d] - vv).abs() < 1e-14);
                let mixed = at(1., 1.)[d] - at(1., -1.)[d] - at(-1., 1.)[d] + at(-1., -1.)[d];
                assert!((0.25 * mixed - uv).abs() < 1e-14);
            }
            assert!(distance(form.plus(0.5, &form).at(xi), point.map(|c| 1.5 * c)) < 1e-14);
            let (low, high) = bounds(shape, &x);
            assert!((0..3).all(|d| low[d] <= point[d] + 1e-14 && point[d] <= high[d] + 1e-14));
        }
    }
}

#[test]
fn closest_point_matches_a_fine_scan() {
    let mut random = Random::new(11);
    for shape in SHAPES {
        for _ in 0..200 {
            let x = curved_face(shape, &mut random);
            let on = interpolate(shape, &x, natural(shape, &mut random, 1.2));
            let centre = [on[0], on[1], on[2] + 0.04];
            let found = closest_point(shape, &x, centre, [0.0, 0.0]);
            let mut best = (f64::INFINITY, [0.0; 2]);
            let (mut half, mut middle) = (1.0, [0.0, 0.0]);
            for _ in 0..8 {
                for i in 0..=40 {
                    for j in 0..=40 {
                        let xi = [i, j].map(|k| half * (f64::from(k) / 20.0 - 1.0));
                        let xi = [middle[0] + xi[0], middle[1] + xi[1]];
                        let xi = with_kind!(shape, K => <<K as FaceKind>::Domain as Domain>::clamp(xi));
                        let d = distance(interpolate(shape, &x, xi), centre);
                        if d < best.0 {
                            best = (d, xi);
                        }
                    }
                }
                middle = best.1;
                half *= 0.15;
            }
            let d = distance(found.point, centre);
            assert!((d - best.0).abs() < 1e-6 * 2.0, "{shape:?}: {d} against {}", best.0);
        }
    }
}

#[test]
fn warm_start_converges_in_two_iterations() {
    let mut random = Random::new(5);
    for shape in SHAPES {
        for _ in 0..100 {
            let x = curved_face(shape, &mut random);
            let on = interpolate(shape, &x, natural(shape, &mut random, 0.8));
            let centre = [on[0], on[1], on[2] + 0.05];
            let cold = closest_point(shape, &x, centre, [0.0, 0.0]);
            // Grain at 1 m/s, step 5 µs, half-edges of 1 m.
            let near = [cold.natural[0] + 5e-6, cold.natural[1] - 5e-6];
            let warm = closest_point(shape, &x, centre, near);
            assert!(warm.iterations <= 2, "{shape:?}: {} iterations", warm.iterations);
            assert!(distance(warm.point, cold.point) < 1e-13);
        }
    }
}

#[test]
fn normal_is_outward_and_along_residual() {
    let mut random = Random::new(17);
    for shape in SHAPES {
        for _ in 0..100 {
            let x = curved_face(shape, &mut random);
            let on = interpolate(shape, &x, natural(shape, &mut random, 0.7));
            let found = closest_point(shape, &x, [on[0], on[1], on[2] + 0.03], [0.0, 0.0]);
            assert_eq!(found.location, Location::Inside);
            let r = [on[0] - found.point[0], on[1] - found.point[1], on[2] + 0.03 - found.point[2]];
            assert!(dot(r, found.normal) > 0.0);
            assert!(dot(cross(r, found.normal), cross(r, found.normal)).sqrt() < 1e-12);
        }
    }
}

#[test]
fn borders_follow_nodal_order() {
    let flat = |shape: FaceShape| {
        let mut x = [[0.0; 3]; 8];
        x.iter_mut().zip(landmarks(shape)).for_each(|(x, p)| *x = [p[0], p[1], 0.0]);
        x
    };
    for shape in SHAPES {
        let x = flat(shape);
        let at = |p: [f64; 3]| closest_point(shape, &x, p, [0.0, 0.0]).location;
        if shape.corner_count() == 4 {
            assert_eq!(at([0.3, -1.4, 0.1]), Location::Side(0));
            assert_eq!(at([1.2, 0.1, 0.1]), Location::Side(1));
            assert_eq!(at([0.0, 1.5, 0.1]), Location::Side(2));
            assert_eq!(at([-1.0, 0.2, 0.1]), Location::Side(3));
            assert_eq!(at([-1.2, -1.2, 0.1]), Location::Corner(0));
            assert_eq!(at([1.2, 1.1, 0.1]), Location::Corner(2));
            assert_eq!(at([0.999, 0.1, 0.1]), Location::Inside);
        } else {
            assert_eq!(at([0.3, -0.4, 0.1]), Location::Side(0));
            assert_eq!(at([0.6, 0.7, 0.1]), Location::Side(1));
            assert_eq!(at([-0.2, 0.4, 0.1]), Location::Side(2));
            assert_eq!(at([-0.2, -0.2, 0.1]), Location::Corner(0));
            assert_eq!(at([1.4, -0.1, 0.1]), Location::Corner(1));
            assert_eq!(at([0.1, 1.4, 0.1]), Location::Corner(2));
            assert_eq!(at([0.499, 0.5, 0.1]), Location::Inside);
        }
    }
    // Landmarks are the nodes.
    assert_eq!(
        (landmarks(FaceShape::Quad4), landmarks(FaceShape::Tri3)),
        (&element::quad8::NATURAL[..], &element::tri6::NATURAL[..])
    );
}

/// Corners at heights h and −h, seen from height Z. For large Z the Hessian is indefinite with a positive
/// diagonal, so Newton steps uphill.
#[test]
fn finds_far_corner_of_saddle() {
    let (h, z) = (1.0, 3.0);
    let mut x = [[0.0; 3]; 8];
    for (x, [a, b]) in x.iter_mut().zip([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) {
        *x = [a, b, h * a * b];
    }
    for start in [[0.3, 0.1], [0.1, 0.4], [-0.2, -0.3], [0.6, 0.05]] {
        let found = closest_point(FaceShape::Quad4, &x, [0.0, 0.0, z], start);
        let exact = (2.0 + (h - z) * (h - z)).sqrt();
        let d = distance(found.point, [0.0, 0.0, z]);
        assert!((d - exact).abs() < 1e-12, "from {start:?}: {:?} at {d}, expected {exact}", found.natural);
    }
}

#[test]
fn corners_are_named_by_both_sides() {
    for shape in SHAPES {
        let corners = shape.corner_count();
        let mut x = [[0.0; 3]; 8];
        x.iter_mut().zip(landmarks(shape)).for_each(|(x, p)| *x = [p[0], p[1], 0.0]);
        let centre = shape.natural_centre();
        for k in 0..corners {
            let out = |k: usize, by: f64| [0, 1].map(|d| centre[d] + by * (x[k % corners][d] - centre[d]));
            let [a, b] = out(k, 1.5);
            assert_eq!(closest_point(shape, &x, [a, b, 0.1], centre).location, Location::Corner(k as u8));
            let (from, to) = (out(k, 1.2), out(k + 1, 1.2));
            let [a, b] = [0, 1].map(|d| 0.5 * (from[d] + to[d]));
            assert_eq!(closest_point(shape, &x, [a, b, 0.1], centre).location, Location::Side(k as u8));
        }
    }
}

#[test]
fn bounds_enclose_bulging_face() {
    for sign in [1.0, -1.0] {
        let heights = [0.0, 1.0, 1.0, 1.0, 0.75, 1.0, 1.0, 0.75].map(|c| sign * c);
        let mut x = [[0.0; 3]; 8];
        for ((x, p), z) in x.iter_mut().zip(landmarks(FaceShape::Quad8)).zip(heights) {
            *x = [p[0], p[1], z];
        }
        let top = interpolate(FaceShape::Quad8, &x, [1.0 / 3.0; 2])[2];
        assert!((top - sign * (1.0 + 1.0 / 27.0)).abs() < 1e-14, "{top}");
        let (low, high) = bounds(FaceShape::Quad8, &x);
        assert!(low[2] <= top && top <= high[2], "{top} in {} to {}", low[2], high[2]);
        assert!(low[2] >= -1.25 && high[2] <= 1.25 && low[0] == -1.0 && high[1] == 1.0);
    }
}

#[test]
fn clamps_points_outside_domain() {
    let mut random = Random::new(23);
    for shape in SHAPES {
        for _ in 0..200 {
            let start = [3.0 * random.symmetric(), 3.0 * random.symmetric()];
            let [a, b] = with_kind!(shape, K => <<K as FaceKind>::Domain as Domain>::clamp(start));
            match shape.corner_count() {
                4 => assert!(a.abs() <= 1.0 && b.abs() <= 1.0, "{start:?}: {a} {b}"),
                _ => assert!(a >= 0.0 && b >= 0.0 && a + b <= 1.0 + 1e-15, "{start:?}: {a} {b}"),
            }
        }
    }
}

#[test]
fn flat_triangles_agree_with_elementary_geometry() {
    let mut random = Random::new(31);
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|d| a[d] - b[d]);
    let (mut within, mut beyond) = (0, 0);
    while within + beyond < 1000 {
        let mut corner = |spread: f64| [0, 1, 2].map(|_| spread * random.symmetric());
        let (c, p) = ([corner(1.0), corner(1.0), corner(1.0)], corner(2.0));
        let normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
        if dot(normal, normal) < 0.01 {
            continue;
        }
        let sides = [(c[0], c[1]), (c[1], c[2]), (c[2], c[0])];
        let left = |(a, b)| dot(cross(minus(b, a), minus(p, a)), normal) >= 0.0;
        let exact = if sides.into_iter().all(left) {
            within += 1;
            dot(minus(p, c[0]), normal).abs() / dot(normal, normal).sqrt()
        } else {
            beyond += 1;
            let along = |(a, b)| {
                let (side, to) = (minus(b, a), minus(p, a));
                let t = (dot(side, to) / dot(side, side)).clamp(0.0, 1.0);
                distance(to, side.map(|s| t * s))
            };
            sides.into_iter().map(along).fold(f64::INFINITY, f64::min)
        };
        for shape in [FaceShape::Tri3, FaceShape::Tri6] {
            let mut x = [[0.0; 3]; 8];
            x[..3].copy_from_slice(&c);
            for (k, (a, b)) in sides.into_iter().enumerate() {
                x[3 + k] = [0, 1, 2].map(|d| 0.5 * (a[d] + b[d]));
            }
            let found = closest_point(shape, &x, p, shape.natural_centre());
            let d = distance(found.point, p);
            assert!((d - exact).abs() < 1e-12, "{shape:?} {c:?} from {p:?}: {d} against {exact}");
        }
    }
    assert!(within > 20 && beyond > 500, "{within} {beyond}");
}
