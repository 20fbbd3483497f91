//! Closest points on the curved faces of elements.
//!
//! A face is x(ξ, η) = Σ Nᵢ(ξ, η) xᵢ with the shape functions of its kind. Each kind is a file here with one line in
//! `with_kind!`: it says what its field is in powers of the natural coordinates ([`Form`]), which points have a convex hull
//! that holds it, and over which domain they run. The search for the closest point is then common to all (`newton.rs`); only
//! the flat 3-node triangle has its result at once.

mod domain;
mod newton;
mod quad4;
mod quad8;
mod tri3;
mod tri6;

use domain::Domain;
pub use domain::Location;
use trackbed_fem::FaceShape;

/// Closest point of a face to a given centre.
#[derive(Clone, Copy, Debug)]
pub struct Closest {
    /// Natural coordinates (ξ, η): in [−1, 1]² on a quadrilateral; 0 or more with a sum of at most 1 on a triangle.
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

/// Values at the nodes of a face; those beyond the nodes of its kind are not read.
pub type NodalValues = [[f64; 3]; 8];

/// A kind of face.
trait FaceKind {
    /// Where the natural coordinates run.
    type Domain: Domain;

    /// The coefficients of [`Form`] of one component, from its nodal values.
    fn powers(q: [f64; 8]) -> [f64; 8];

    /// Calls `add` with numbers between whose least and largest one component lies everywhere on the face.
    fn hull(q: [f64; 8], add: impl FnMut(f64));

    /// Closest point of the face to `centre`, starting from the natural coordinates `start`.
    #[inline]
    fn closest_point(form: &Form, centre: [f64; 3], start: [f64; 2]) -> Closest {
        newton::closest_point::<Self::Domain>(form, centre, start)
    }
}

/// Code that knows the kind of a face when it is compiled. The list is that of all kinds.
macro_rules! with_kind {
    ($shape:expr, $name:ident => $body:expr) => {
        with_kind! { @ $shape, $name => $body;
            Quad8 => quad8::Quad8,
            Tri6 => tri6::Tri6,
            Quad4 => quad4::Quad4,
            Tri3 => tri3::Tri3,
        }
    };
    (@ $shape:expr, $name:ident => $body:expr; $($kind:ident => $own:path,)*) => {
        match $shape {
            $(FaceShape::$kind => {
                type $name = $own;
                $body
            })*
        }
    };
}

/// Σ Nᵢ(ξ, η) qᵢ of a nodal vector quantity on a face.
pub fn interpolate(shape: FaceShape, values: &NodalValues, natural: [f64; 2]) -> [f64; 3] {
    let n = shape.shape_functions(natural);
    let mut out = [0.0; 3];
    for i in 0..shape.node_count() {
        for d in 0..3 {
            out[d] += n[i] * values[i][d];
        }
    }
    out
}

/// Closest point of the face with node coordinates `x` [m] to `centre`, starting from the natural coordinates `start`
/// (last step's result converges in one or two iterations).
pub fn closest_point(shape: FaceShape, x: &NodalValues, centre: [f64; 3], start: [f64; 2]) -> Closest {
    Form::new(shape, x).closest_point(shape, centre, start)
}

/// Natural coordinates of the corners of a face, then of the middles of its sides. Side k goes from corner k to the next.
pub fn landmarks(shape: FaceShape) -> &'static [[f64; 2]] {
    with_kind!(shape, K => <<K as FaceKind>::Domain as Domain>::LANDMARKS)
}

/// Box that holds a face with the node coordinates `x` [m]: it may bulge beyond its nodes.
pub(crate) fn bounds(shape: FaceShape, x: &NodalValues) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for d in 0..3 {
        let q = x.map(|x| x[d]);
        let add = |c: f64| {
            low[d] = low[d].min(c);
            high[d] = high[d].max(c);
        };
        with_kind!(shape, K => K::hull(q, add));
    }
    (low, high)
}

/// A face in powers of its natural coordinates,
/// x(ξ, η) = c₀ + c₁ ξ + c₂ η + c₃ ξ² + c₄ η² + c₅ ξη + c₆ ξ²η + c₇ ξη²: the same field as Σ Nᵢ xᵢ with an eighth of the
/// work per evaluation. All of it is that of the 8-node quadrilateral; the 6-node triangle has no cubic terms, the 4-node
/// quadrilateral none but ξη, the 3-node triangle linear ones alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Form([[f64; 3]; 8]);

impl Form {
    /// The field with the nodal values `q`.
    pub fn new(shape: FaceShape, q: &NodalValues) -> Form {
        let mut c = [[0.0; 3]; 8];
        for d in 0..3 {
            let own = with_kind!(shape, K => K::powers(q.map(|q| q[d])));
            for k in 0..8 {
                c[k][d] = own[k];
            }
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

    /// ∂²x/∂ξ², ∂²x/∂η², ∂²x/∂ξ∂η at a natural point.
    #[inline]
    fn second(&self, xi: [f64; 2]) -> [[f64; 3]; 3] {
        let c = &self.0;
        [
            [0, 1, 2].map(|d| 2.0 * (c[3][d] + xi[1] * c[6][d])),
            [0, 1, 2].map(|d| 2.0 * (c[4][d] + xi[0] * c[7][d])),
            [0, 1, 2].map(|d| c[5][d] + 2.0 * (xi[0] * c[6][d] + xi[1] * c[7][d])),
        ]
    }

    /// Closest point of a face of this shape to `centre`, starting from the natural coordinates `start`.
    #[inline]
    pub fn closest_point(&self, shape: FaceShape, centre: [f64; 3], start: [f64; 2]) -> Closest {
        with_kind!(shape, K => K::closest_point(self, centre, start))
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests;
