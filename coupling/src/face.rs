//! Closest point on a curved 8-node face, by Newton in the two face coordinates.
//!
//! The face is x(ξ, η) = Σ Nᵢ(ξ, η) xᵢ with the serendipity functions of the 8-node quadrilateral. The
//! closest point to `c` minimises g(ξ) = ½ |x(ξ) − c|² over the square [−1, 1]². Newton uses
//! ∂g/∂ξₐ = (x − c)·x,ₐ and ∂²g/∂ξₐ∂ξᵦ = x,ₐ·x,ᵦ + (x − c)·x,ₐᵦ; where that matrix is not positive definite
//! the Gauss–Newton part x,ₐ·x,ᵦ takes its place. Coordinates at a bound with the descent direction pointing
//! outward are held there (projected Newton; Bertsekas, SIAM J. Control Optim. 20(2), 1982), and a step that
//! does not lower g is halved, so a point outside the face ends on the border: this is the fallback that a
//! three-dimensional inverse map lacks for a point above the surface.
//!
//! Limit: a face folded so strongly that several local minima lie within reach yields the one nearest to the
//! start.

use trackbed_fem::element::quad8;

/// Distance from the border of the square within which a point counts as lying on the border.
const BORDER: f64 = 1e-9;
/// Newton stops when the step in natural coordinates is below this: convergence is quadratic, so the error left is
/// about its square.
const STEP: f64 = 1e-8;
const MAX_ITERATIONS: usize = 50;

/// Where the closest point of a face lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Inside the face.
    Inside,
    /// On side 0–3, from corner k to corner k+1.
    Side(u8),
    /// On corner 0–3.
    Corner(u8),
}

/// Closest point of a face to a given centre.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Natural coordinates (ξ, η) in [−1, 1]².
    pub natural: [f64; 2],
    /// The point itself [m].
    pub point: [f64; 3],
    /// Unit normal of the face there, outward for faces ordered as [`trackbed_fem::mesh::Face`].
    pub normal: [f64; 3],
    /// Inside, on a side or on a corner.
    pub location: Location,
    /// Newton iterations used.
    pub iterations: usize,
}

/// Σ Nᵢ(ξ, η) qᵢ of a nodal vector quantity on the face, shape `[8][3]`.
pub fn interpolate(values: &[[f64; 3]; 8], natural: [f64; 2]) -> [f64; 3] {
    let n = quad8::shape_functions(natural);
    let mut out = [0.0; 3];
    for i in 0..8 {
        for d in 0..3 {
            out[d] += n[i] * values[i][d];
        }
    }
    out
}

/// Closest point of the face with node coordinates `x` [m], shape `[8][3]`, to `centre`, starting from the
/// natural coordinates `start` (last step's result converges in one or two iterations).
pub fn closest_point(x: &[[f64; 3]; 8], centre: [f64; 3], start: [f64; 2]) -> Closest {
    Form::new(x).closest_point(centre, start)
}

/// A face in powers of its natural coordinates,
/// x(ξ, η) = c₀ + c₁ ξ + c₂ η + c₃ ξ² + c₄ η² + c₅ ξη + c₆ ξ²η + c₇ ξη²: the same field as Σ Nᵢ xᵢ with an eighth of the
/// work per evaluation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Form([[f64; 3]; 8]);

impl Form {
    /// The field with the nodal values `q`, shape `[8][3]`.
    pub fn new(q: &[[f64; 3]; 8]) -> Form {
        let mut c = [[0.0; 3]; 8];
        for d in 0..3 {
            let [q0, q1, q2, q3, m4, m5, m6, m7] = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| q[i][d]);
            let quarter = 0.25 * (q0 + q1 + q2 + q3);
            c[0][d] = 0.5 * (m4 + m5 + m6 + m7) - quarter;
            c[1][d] = 0.5 * (m5 - m7);
            c[2][d] = 0.5 * (m6 - m4);
            c[3][d] = quarter - 0.5 * (m4 + m6);
            c[4][d] = quarter - 0.5 * (m5 + m7);
            c[5][d] = 0.25 * (q0 - q1 + q2 - q3);
            c[6][d] = 0.25 * (q2 + q3 - q0 - q1) + 0.5 * (m4 - m6);
            c[7][d] = 0.25 * (q1 + q2 - q0 - q3) + 0.5 * (m7 - m5);
        }
        Form(c)
    }

    /// This field plus `factor` times another.
    #[inline]
    pub fn plus(&self, factor: f64, other: &Form) -> Form {
        let mut c = self.0;
        for k in 0..8 {
            for d in 0..3 {
                c[k][d] += factor * other.0[k][d];
            }
        }
        Form(c)
    }

    /// The field at a natural point.
    #[inline]
    pub fn at(&self, [a, b]: [f64; 2]) -> [f64; 3] {
        let c = &self.0;
        [0, 1, 2].map(|d| {
            c[0][d]
                + a * (c[1][d] + a * (c[3][d] + b * c[6][d]) + b * c[5][d])
                + b * (c[2][d] + b * (c[4][d] + a * c[7][d]))
        })
    }

    /// ∂x/∂ξ × ∂x/∂η at a natural point: the normal, outward for faces ordered as [`trackbed_fem::mesh::Face`], not of
    /// unit length.
    pub fn area(&self, natural: [f64; 2]) -> [f64; 3] {
        let tangent = self.tangents(natural);
        cross(tangent[0], tangent[1])
    }

    #[inline]
    fn tangents(&self, [a, b]: [f64; 2]) -> [[f64; 3]; 2] {
        let c = &self.0;
        [
            [0, 1, 2]
                .map(|d| c[1][d] + a * (2.0 * c[3][d] + 2.0 * b * c[6][d]) + b * (c[5][d] + b * c[7][d])),
            [0, 1, 2]
                .map(|d| c[2][d] + b * (2.0 * c[4][d] + 2.0 * a * c[7][d]) + a * (c[5][d] + a * c[6][d])),
        ]
    }

    /// Closest point of the face to `centre`, starting from the natural coordinates `start`.
    pub fn closest_point(&self, centre: [f64; 3], start: [f64; 2]) -> Closest {
        let mut xi = [start[0].clamp(-1.0, 1.0), start[1].clamp(-1.0, 1.0)];
        let mut iterations = 0;
        let mut here = Local::at(self, centre, xi);
        while iterations < MAX_ITERATIONS {
            iterations += 1;
            let step = here.projected_step(xi);
            let mut scale = 1.0;
            let mut moved = [0.0; 2];
            loop {
                let next =
                    [(xi[0] + scale * step[0]).clamp(-1.0, 1.0), (xi[1] + scale * step[1]).clamp(-1.0, 1.0)];
                let there = Local::at(self, centre, next);
                // Rounding may raise g by a few ulps at the minimum itself: that still counts as no worse.
                if there.distance2 <= here.distance2 * (1.0 + 1e-14) {
                    moved = [next[0] - xi[0], next[1] - xi[1]];
                    xi = next;
                    here = there;
                    break;
                }
                scale *= 0.5;
                if scale < 1e-6 {
                    break;
                }
            }
            if moved[0].abs().max(moved[1].abs()) < STEP {
                break;
            }
        }
        let n = cross(here.tangent[0], here.tangent[1]);
        let length = dot(n, n).sqrt();
        Closest {
            natural: xi,
            point: here.point,
            normal: n.map(|c| c / length),
            location: locate(xi),
            iterations,
        }
    }
}

/// Side or corner on which a natural point lies; sides and corners are counted as the nodes are.
fn locate(xi: [f64; 2]) -> Location {
    let low = xi.map(|c| c <= -1.0 + BORDER);
    let high = xi.map(|c| c >= 1.0 - BORDER);
    match (low[0], high[0], low[1], high[1]) {
        (true, _, true, _) => Location::Corner(0),
        (_, true, true, _) => Location::Corner(1),
        (_, true, _, true) => Location::Corner(2),
        (true, _, _, true) => Location::Corner(3),
        (_, _, true, _) => Location::Side(0),
        (_, true, _, _) => Location::Side(1),
        (_, _, _, true) => Location::Side(2),
        (true, _, _, _) => Location::Side(3),
        _ => Location::Inside,
    }
}

/// The face and the distance function at one natural point.
struct Local {
    point: [f64; 3],
    distance2: f64,
    tangent: [[f64; 3]; 2],
    gradient: [f64; 2],
    metric: [f64; 3],
    curvature: [f64; 3],
}

impl Local {
    #[inline]
    fn at(form: &Form, centre: [f64; 3], xi: [f64; 2]) -> Local {
        let (c, point, tangent) = (&form.0, form.at(xi), form.tangents(xi));
        let second = [
            [0, 1, 2].map(|d| 2.0 * (c[3][d] + xi[1] * c[6][d])),
            [0, 1, 2].map(|d| 2.0 * (c[4][d] + xi[0] * c[7][d])),
            [0, 1, 2].map(|d| c[5][d] + 2.0 * (xi[0] * c[6][d] + xi[1] * c[7][d])),
        ];
        let r = [point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]];
        Local {
            point,
            distance2: dot(r, r),
            gradient: [dot(r, tangent[0]), dot(r, tangent[1])],
            metric: [dot(tangent[0], tangent[0]), dot(tangent[1], tangent[1]), dot(tangent[0], tangent[1])],
            curvature: [dot(r, second[0]), dot(r, second[1]), dot(r, second[2])],
            tangent,
        }
    }

    /// Newton step with the coordinates held that sit at a bound and want to leave the square.
    fn projected_step(&self, xi: [f64; 2]) -> [f64; 2] {
        let g = self.gradient;
        let held = [0, 1].map(|a| (xi[a] >= 1.0 && g[a] < 0.0) || (xi[a] <= -1.0 && g[a] > 0.0));
        let full = [0, 1, 2].map(|k| self.metric[k] + self.curvature[k]);
        match held {
            [true, true] => [0.0, 0.0],
            [true, false] => [0.0, -g[1] / if full[1] > 0.0 { full[1] } else { self.metric[1] }],
            [false, true] => [-g[0] / if full[0] > 0.0 { full[0] } else { self.metric[0] }, 0.0],
            [false, false] => {
                let definite = full[0] > 0.0 && full[0] * full[1] - full[2] * full[2] > 0.0;
                let h = if definite { full } else { self.metric };
                let det = h[0] * h[1] - h[2] * h[2];
                [-(h[1] * g[0] - h[2] * g[1]) / det, -(h[0] * g[1] - h[2] * g[0]) / det]
            }
        }
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    const NATURAL: [[f64; 2]; 8] =
        [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.], [0., -1.], [1., 0.], [0., 1.], [-1., 0.]];

    fn curved_face(random: &mut Random) -> [[f64; 3]; 8] {
        NATURAL.map(|p| {
            [p[0] + 0.15 * random.symmetric(), p[1] + 0.15 * random.symmetric(), 0.15 * random.symmetric()]
        })
    }

    fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
        let r = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        dot(r, r).sqrt()
    }

    /// The powers of the natural coordinates are the field of the shape functions, and their derivatives its derivatives.
    #[test]
    fn powers_give_the_field_of_the_shape_functions() {
        let mut random = Random::new(29);
        for _ in 0..100 {
            let x = curved_face(&mut random);
            let form = Form::new(&x);
            let xi = [random.symmetric(), random.symmetric()];
            assert!(distance(form.at(xi), interpolate(&x, xi)) < 1e-15 * 8.0);
            let here = Local::at(&form, [0.0; 3], xi);
            let (d1, d2) = (quad8::gradients(xi), quad8::second_gradients(xi));
            let sum = |w: &dyn Fn(usize) -> f64, d: usize| (0..8).map(|i| w(i) * x[i][d]).sum::<f64>();
            for d in 0..3 {
                for a in 0..2 {
                    assert!((here.tangent[a][d] - sum(&|i| d1[i][a], d)).abs() < 1e-14);
                }
            }
            for k in 0..3 {
                let second = [0, 1, 2].map(|d| sum(&|i| d2[i][k], d));
                assert!((here.curvature[k] - dot(here.point, second)).abs() < 1e-13);
            }
            let moved = form.plus(0.5, &form);
            assert!(distance(moved.at(xi), form.at(xi).map(|c| 1.5 * c)) < 1e-14);
        }
    }

    /// V0.4: points 0.02 edges off the face, some beyond its border, against a fine scan with local refinement.
    #[test]
    fn closest_point_matches_a_fine_scan() {
        let mut random = Random::new(11);
        for _ in 0..200 {
            let x = curved_face(&mut random);
            let over = [1.1 * random.symmetric(), 1.1 * random.symmetric()];
            let on = interpolate(&x, over);
            let centre = [on[0], on[1], on[2] + 0.04];
            let found = closest_point(&x, centre, [0.0, 0.0]);
            let mut best = (f64::INFINITY, [0.0; 2]);
            let mut half = 1.0;
            let mut middle = [0.0, 0.0];
            for _ in 0..8 {
                for i in 0..=40 {
                    for j in 0..=40 {
                        let xi = [i, j].map(|k| half * (f64::from(k) / 20.0 - 1.0));
                        let xi = [(middle[0] + xi[0]).clamp(-1.0, 1.0), (middle[1] + xi[1]).clamp(-1.0, 1.0)];
                        let d = distance(interpolate(&x, xi), centre);
                        if d < best.0 {
                            best = (d, xi);
                        }
                    }
                }
                middle = best.1;
                half *= 0.15;
            }
            let d = distance(found.point, centre);
            assert!((d - best.0).abs() < 1e-6 * 2.0, "{d} against {}", best.0);
        }
    }

    #[test]
    fn a_warm_start_gives_the_same_point_in_two_iterations() {
        let mut random = Random::new(5);
        for _ in 0..100 {
            let x = curved_face(&mut random);
            let on = interpolate(&x, [0.8 * random.symmetric(), 0.8 * random.symmetric()]);
            let centre = [on[0], on[1], on[2] + 0.05];
            let cold = closest_point(&x, centre, [0.0, 0.0]);
            // A stone at 1 m/s moves so far in a step of 5 µs on a face with half-edges of 1 m.
            let near = [cold.natural[0] + 5e-6, cold.natural[1] - 5e-6];
            let warm = closest_point(&x, centre, near);
            assert!(warm.iterations <= 2, "{} iterations", warm.iterations);
            assert!(distance(warm.point, cold.point) < 1e-13);
        }
    }

    #[test]
    fn normal_points_out_and_residual_is_along_it() {
        let mut random = Random::new(17);
        for _ in 0..100 {
            let x = curved_face(&mut random);
            let on = interpolate(&x, [0.7 * random.symmetric(), 0.7 * random.symmetric()]);
            let found = closest_point(&x, [on[0], on[1], on[2] + 0.03], [0.0, 0.0]);
            assert_eq!(found.location, Location::Inside);
            let r = [on[0] - found.point[0], on[1] - found.point[1], on[2] + 0.03 - found.point[2]];
            assert!(dot(r, found.normal) > 0.0);
            assert!(dot(cross(r, found.normal), cross(r, found.normal)).sqrt() < 1e-12);
        }
    }

    #[test]
    fn borders_are_named_as_the_nodes_are() {
        let x = NATURAL.map(|p| [p[0], p[1], 0.0]);
        let at = |p: [f64; 3]| closest_point(&x, p, [0.0, 0.0]).location;
        assert_eq!(at([0.3, -1.4, 0.1]), Location::Side(0));
        assert_eq!(at([1.2, 0.1, 0.1]), Location::Side(1));
        assert_eq!(at([0.0, 1.5, 0.1]), Location::Side(2));
        assert_eq!(at([-1.0, 0.2, 0.1]), Location::Side(3));
        assert_eq!(at([-1.2, -1.2, 0.1]), Location::Corner(0));
        assert_eq!(at([1.2, 1.1, 0.1]), Location::Corner(2));
        assert_eq!(at([0.999, 0.1, 0.1]), Location::Inside);
    }
}
