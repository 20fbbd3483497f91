//! Wall shapes: all that other files compute from the kind.

use super::enclosed::enclosed;
use crate::base::Vec3;
use crate::shape::body_shape::Outline;
use crate::spatial::round::Round;

/// Points around a ring of an outline.
const AROUND: u32 = 48;

/// Wall shape.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// Two-sided triangles.
    Triangles {
        /// Vertices [m].
        vertices: Vec<Vec3>,
        /// Vertex indices, any order.
        triangles: Vec<[u32; 3]>,
    },
    /// Infinite plane, grains on its normal's side.
    Plane {
        /// Point on it [m].
        point: Vec3,
        /// Normal, nonzero.
        normal: Vec3,
    },
    /// Two-sided side of a conical frustum: cylinder for equal radii, ring for zero height.
    Frustum {
        /// First end's centre [m].
        base: Vec3,
        /// Axis, from first to second end, nonzero.
        axis: Vec3,
        /// Height [m].
        height: f64,
        /// End radii [m], at most one zero.
        radii: [f64; 2],
        /// Whether discs close the ends.
        caps: [bool; 2],
    },
    /// Two-sided sphere.
    Sphere {
        /// Centre [m].
        centre: Vec3,
        /// Radius [m].
        radius: f64,
    },
}

/// Upright round wall in plan.
#[derive(Clone, Copy, Debug)]
pub struct PlanCircle {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Largest and mean radius [m].
    pub radii: [f64; 2],
    /// Highest point [m].
    pub top: f64,
}

impl WallShape {
    /// Point and normal of a plane.
    pub fn plane(&self) -> Option<(&Vec3, &Vec3)> {
        if let WallShape::Plane { point, normal } = self { Some((point, normal)) } else { None }
    }

    /// Vertices [m] and triangles of a triangulated wall.
    pub fn triangulated(&self) -> Option<(&[Vec3], &[[u32; 3]])> {
        if let WallShape::Triangles { vertices, triangles } = self {
            Some((vertices, triangles))
        } else {
            None
        }
    }

    /// Whether its triangles enclose a volume.
    pub fn is_closed(&self) -> bool {
        self.triangulated().is_some_and(|(vertices, triangles)| enclosed(vertices, triangles).is_some())
    }

    /// Returns what is wrong with its numbers.
    pub(super) fn fault(&self) -> Option<&'static str> {
        let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
        match self {
            WallShape::Triangles { triangles, .. } => triangles.is_empty().then_some("it has no triangles"),
            WallShape::Plane { point, normal } => (!(finite(point) && finite(normal) && normal.norm() > 0.0))
                .then_some("its point must be finite and its normal have a length above zero"),
            WallShape::Frustum { base, axis, height, radii, .. } => {
                let positive = |x: &f64| *x >= 0.0 && x.is_finite();
                if !(finite(base) && finite(axis) && axis.norm() > 0.0) {
                    Some("its base must be finite and its axis have a length above zero")
                } else if !(positive(height) && radii.iter().all(positive)) {
                    Some("its height and radii must be zero or positive, and finite")
                } else if radii[0].max(radii[1]) == 0.0 || (*height == 0.0 && radii[0] == radii[1]) {
                    Some("it has no area")
                } else {
                    None
                }
            }
            WallShape::Sphere { centre, radius } => {
                (!(finite(centre) && *radius > 0.0 && radius.is_finite()))
                    .then_some("its radius must be positive")
            }
        }
    }

    /// Returns the default centre of rotation [m].
    pub fn own_centre(&self) -> Vec3 {
        match self {
            WallShape::Triangles { vertices, triangles } => {
                let mut bounds = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
                for &v in triangles.iter().flatten() {
                    bounds = (bounds.0.inf(&vertices[v as usize]), bounds.1.sup(&vertices[v as usize]));
                }
                if triangles.is_empty() { Vec3::zeros() } else { (bounds.0 + bounds.1) * 0.5 }
            }
            WallShape::Plane { point, .. } => *point,
            WallShape::Frustum { base, .. } => *base,
            WallShape::Sphere { centre, .. } => *centre,
        }
    }

    pub(super) fn middle(&self) -> Vec3 {
        match self {
            WallShape::Frustum { base, axis, height, .. } => base + axis.normalize() * (0.5 * height),
            _ => self.own_centre(),
        }
    }

    /// Returns its patches; none of triangles.
    pub(super) fn rounds(&self) -> Vec<Round> {
        match self {
            WallShape::Triangles { .. } => Vec::new(),
            WallShape::Plane { point, normal } => {
                vec![Round::Plane { point: *point, normal: normal.normalize() }]
            }
            WallShape::Frustum { base, axis, height, radii, caps } => {
                let axis = axis.normalize();
                let side = |far| Round::Frustum { base: *base, axis, height: *height, radii: *radii, far };
                let mut out = vec![side(false), side(true)];
                for (k, end) in [*base, base + axis * *height].into_iter().enumerate() {
                    if caps[k] && radii[k] > 0.0 {
                        let axis = if k == 0 { -axis } else { axis };
                        out.push(Round::Disc { centre: end, axis, radius: radii[k] });
                    }
                }
                out
            }
            WallShape::Sphere { centre, radius } => vec![Round::Sphere { centre: *centre, radius: *radius }],
        }
    }

    /// Returns centres and radii [m] of balls that its ends reach; none of a plane.
    pub fn balls(&self) -> Vec<(Vec3, f64)> {
        match self {
            WallShape::Plane { .. } => Vec::new(),
            WallShape::Triangles { vertices, .. } => vertices.iter().map(|v| (*v, 0.0)).collect(),
            WallShape::Frustum { base, axis, height, radii, .. } => {
                vec![(*base, radii[0]), (base + axis.normalize() * *height, radii[1])]
            }
            WallShape::Sphere { centre, radius } => vec![(*centre, *radius)],
        }
    }

    /// Returns its circle in plan; none of planes, triangles, inclined walls.
    pub fn plan_circle(&self) -> Option<PlanCircle> {
        match self {
            WallShape::Plane { .. } | WallShape::Triangles { .. } => None,
            WallShape::Sphere { centre: c, radius } => {
                Some(PlanCircle { centre: [c.x, c.y], radii: [*radius; 2], top: c.z + radius })
            }
            WallShape::Frustum { base, axis, height, radii, .. } => {
                let axis = axis.normalize();
                let upright = axis.z.abs() > 1.0 - 1e-6 && *height > 0.0;
                upright.then(|| PlanCircle {
                    centre: [base.x, base.y],
                    radii: [radii[0].max(radii[1]), 0.5 * (radii[0] + radii[1])],
                    top: base.z.max(base.z + axis.z * height),
                })
            }
        }
    }

    /// Whether an end of a round wall is open.
    pub fn open_end(&self) -> bool {
        matches!(self, WallShape::Frustum { caps, .. } if *caps != [true, true])
    }

    /// Whether it has an inside that [`Self::contains`] knows.
    pub fn encloses(&self) -> bool {
        match self {
            WallShape::Plane { .. } | WallShape::Triangles { .. } => false,
            WallShape::Sphere { .. } => true,
            WallShape::Frustum { height, .. } => *height > 0.0,
        }
    }

    /// Whether a round wall contains `x`; `None` beyond its open ends.
    pub fn contains(&self, x: &Vec3) -> Option<bool> {
        match self {
            WallShape::Plane { .. } | WallShape::Triangles { .. } => None,
            WallShape::Sphere { centre, radius } => Some((x - centre).norm() < *radius),
            WallShape::Frustum { base, axis, height, radii, caps } => {
                let axis = axis.normalize();
                let along = (x - base).dot(&axis);
                let between = (0.0..=*height).contains(&along);
                let radius = radii[0] + (radii[1] - radii[0]) * along / height;
                let within = (x - base - axis * along).norm() < radius;
                (*caps == [true, true] || between).then_some(between && within)
            }
        }
    }

    /// Returns its outline moved by `place`; of planes near `extent`: centre, half side [m].
    pub fn outline(&self, place: impl Fn(Vec3) -> Vec3, extent: (Vec3, f64)) -> Outline {
        match self {
            WallShape::Triangles { vertices, triangles } => {
                (vertices.iter().map(|v| place(*v)).collect(), triangles.iter().map(|t| t.to_vec()).collect())
            }
            WallShape::Plane { point, normal } => square(&place(*point), &normal.normalize(), extent),
            WallShape::Frustum { base, axis, height, radii, caps } => {
                let k = axis.normalize();
                let (u, v) = across(&k);
                let ring = |end: usize| {
                    let (middle, r) = (base + k * (*height * end as f64), radii[end]);
                    (0..AROUND).map(move |i| {
                        let (sin, cos) =
                            libm::sincos(f64::from(i) / f64::from(AROUND) * std::f64::consts::TAU);
                        middle + (u * cos + v * sin) * r
                    })
                };
                let points = ring(0).chain(ring(1)).map(place).collect();
                let mut polygons: Vec<Vec<u32>> = (0..AROUND)
                    .map(|i| {
                        let j = (i + 1) % AROUND;
                        vec![i, j, j + AROUND, i + AROUND]
                    })
                    .collect();
                for end in (0..2).filter(|&end| caps[end]) {
                    polygons.push((0..AROUND).map(|i| i + end as u32 * AROUND).collect());
                }
                (points, polygons)
            }
            WallShape::Sphere { centre, radius } => {
                // Polar caps are separate polygons.
                let rings = AROUND / 2 - 1;
                let mut points = Vec::new();
                for j in 1..=rings {
                    let (sin, cos) = libm::sincos(f64::from(j) / f64::from(rings + 1) * std::f64::consts::PI);
                    for i in 0..AROUND {
                        let (s, c) = libm::sincos(f64::from(i) / f64::from(AROUND) * std::f64::consts::TAU);
                        points.push(place(centre + Vec3::new(c * sin, s * sin, cos) * *radius));
                    }
                }
                let mut polygons: Vec<Vec<u32>> =
                    vec![(0..AROUND).collect(), (0..AROUND).map(|i| (rings - 1) * AROUND + i).collect()];
                for j in 1..rings {
                    for i in 0..AROUND {
                        let (a, b) = ((j - 1) * AROUND + i, (j - 1) * AROUND + (i + 1) % AROUND);
                        polygons.push(vec![a, b, b + AROUND, a + AROUND]);
                    }
                }
                (points, polygons)
            }
        }
    }
}

fn across(k: &Vec3) -> (Vec3, Vec3) {
    let helper = if k.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let u = k.cross(&helper).normalize();
    (u, k.cross(&u))
}

/// Returns a square of a plane next to the grains.
pub fn square(point: &Vec3, normal: &Vec3, (centre, half): (Vec3, f64)) -> Outline {
    let middle = centre - normal * (centre - point).dot(normal);
    let (u, v) = across(normal);
    let corner = |a: f64, b: f64| middle + (u * a + v * b) * half;
    (vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)], vec![vec![0, 1, 2, 3]])
}
