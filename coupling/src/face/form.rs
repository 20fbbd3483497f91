//! Polynomial form of a face field.

/// x(ξ, η) = c₀ + c₁ ξ + c₂ η + c₃ ξ² + c₄ η² + c₅ ξη + c₆ ξ²η + c₇ ξη².
#[derive(Clone, Copy, Debug, Default)]
pub struct Form(pub(super) [[f64; 3]; 8]);

impl Form {
    /// This field plus `factor` times `other`.
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

    /// Field at a natural point.
    #[inline]
    pub fn at(&self, [a, b]: [f64; 2]) -> [f64; 3] {
        let c = &self.0;
        [0, 1, 2].map(|d| {
            c[0][d]
                + a * (c[1][d] + a * (c[3][d] + b * c[6][d]) + b * c[5][d])
                + b * (c[2][d] + b * (c[4][d] + a * c[7][d]))
        })
    }

    /// Area vector ∂x/∂ξ × ∂x/∂η, outward for faces ordered as [`trackbed_fem::mesh::Face`], not normalised.
    pub fn area(&self, natural: [f64; 2]) -> [f64; 3] {
        let tangent = self.tangents(natural);
        cross(tangent[0], tangent[1])
    }

    #[inline]
    pub(super) fn tangents(&self, [a, b]: [f64; 2]) -> [[f64; 3]; 2] {
        let c = &self.0;
        [
            [0, 1, 2]
                .map(|d| c[1][d] + a * (2.0 * c[3][d] + 2.0 * b * c[6][d]) + b * (c[5][d] + b * c[7][d])),
            [0, 1, 2]
                .map(|d| c[2][d] + b * (2.0 * c[4][d] + 2.0 * a * c[7][d]) + a * (c[5][d] + a * c[6][d])),
        ]
    }

    /// ∂²x/∂ξ², ∂²x/∂η², ∂²x/∂ξ∂η.
    #[inline]
    pub(super) fn second(&self, xi: [f64; 2]) -> [[f64; 3]; 3] {
        let c = &self.0;
        [
            [0, 1, 2].map(|d| 2.0 * (c[3][d] + xi[1] * c[6][d])),
            [0, 1, 2].map(|d| 2.0 * (c[4][d] + xi[0] * c[7][d])),
            [0, 1, 2].map(|d| c[5][d] + 2.0 * (xi[0] * c[6][d] + xi[1] * c[7][d])),
        ]
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
