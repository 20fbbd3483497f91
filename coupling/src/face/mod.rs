//! Closest points on curved element faces x(ξ, η) = Σ Nᵢ(ξ, η) xᵢ.

mod domain;
mod form;
mod kind;
mod newton;
mod quad4;
mod quad8;
mod tri3;
mod tri6;

use domain::Domain;
pub use domain::Location;
pub use form::Form;
pub(crate) use form::{cross, dot};
use kind::FaceKind;
pub use newton::Closest;
use trackbed_fem::FaceShape;

/// Nodal values of a face; entries beyond its nodes are ignored.
pub type NodalValues = [[f64; 3]; 8];

/// Dispatches on the face kind at compile time.
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

/// Interpolates nodal vectors: Σ Nᵢ(ξ, η) qᵢ.
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

/// Closest point of the face with nodes `x` [m] to `centre`; the last step's `start` saves iterations.
pub fn closest_point(shape: FaceShape, x: &NodalValues, centre: [f64; 3], start: [f64; 2]) -> Closest {
    Form::new(shape, x).closest_point(shape, centre, start)
}

/// Natural coordinates of corners, then mid-sides. Side k joins corners k and k + 1.
pub fn landmarks(shape: FaceShape) -> &'static [[f64; 2]] {
    with_kind!(shape, K => <<K as FaceKind>::Domain as Domain>::LANDMARKS)
}

/// Bounding box of a face, which may bulge beyond its nodes.
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

impl Form {
    /// Field with the nodal values `q`.
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

    /// Closest point to `centre`, from the natural coordinates `start`.
    #[inline]
    pub fn closest_point(&self, shape: FaceShape, centre: [f64; 3], start: [f64; 2]) -> Closest {
        with_kind!(shape, K => K::closest_point(self, centre, start))
    }
}

#[cfg(test)]
mod tests;
