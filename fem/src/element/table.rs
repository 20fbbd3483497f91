//! Integration points with precomputed shape functions.
//!
//! Wedge15, pyramid13 and tet10 use 9, 18 or 4 points (the fewest without zero-energy modes), or a rule exact
//! for products of linear strains ("full"). The mass rule is exact for products of shape functions on
//! flat-faced elements.

use super::kind::{ElementKind, MAX_NODES};
use super::quadrature::{
    GAUSS2, GAUSS3, PYRAMID8, PYRAMID18, PYRAMID27, Quadrature, TET1, TET4, TET14, VolumePoint, WEDGE6,
    WEDGE9, WEDGE21,
};
use std::sync::OnceLock;

/// Integration point with shape functions.
#[derive(Clone, Copy, Debug)]
pub struct IntegrationPoint {
    /// Natural coordinates.
    pub xi: [f64; 3],
    /// Weight; sums to the natural volume.
    pub weight: f64,
    /// Shape functions, zero-padded.
    pub shape: [f64; MAX_NODES],
    /// Natural gradients, zero-padded.
    pub gradients: [[f64; 3]; MAX_NODES],
}

/// Integration points of the stiffness.
#[inline]
pub fn stiffness_points(kind: ElementKind, rule: Quadrature) -> &'static [IntegrationPoint] {
    static TABLES: [[OnceLock<Vec<IntegrationPoint>>; 3]; 8] = [const { [const { OnceLock::new() }; 3] }; 8];
    TABLES[kind as usize][rule as usize].get_or_init(|| table(kind, stiffness_rule(kind, rule)))
}

/// Integration points of the mass.
#[inline]
pub fn mass_points(kind: ElementKind) -> &'static [IntegrationPoint] {
    static TABLES: [OnceLock<Vec<IntegrationPoint>>; 8] = [const { OnceLock::new() }; 8];
    TABLES[kind as usize].get_or_init(|| table(kind, mass_rule(kind)))
}

fn stiffness_rule(kind: ElementKind, rule: Quadrature) -> &'static [VolumePoint] {
    let full = rule == Quadrature::Gauss3;
    match kind {
        ElementKind::Hex20 => rule.points(),
        ElementKind::Wedge15 if full => &WEDGE21,
        ElementKind::Wedge15 => &WEDGE9,
        ElementKind::Pyramid13 if full => &PYRAMID27,
        ElementKind::Pyramid13 => &PYRAMID18,
        ElementKind::Tet10 if full => &TET14,
        ElementKind::Tet10 => &TET4,
        ElementKind::Hex8 => &GAUSS2,
        ElementKind::Wedge6 => &WEDGE6,
        ElementKind::Pyramid5 => &PYRAMID8,
        ElementKind::Tet4 => &TET1,
    }
}

fn mass_rule(kind: ElementKind) -> &'static [VolumePoint] {
    match kind {
        ElementKind::Hex20 => &GAUSS3,
        ElementKind::Wedge15 => &WEDGE21,
        ElementKind::Pyramid13 | ElementKind::Pyramid5 => &PYRAMID27,
        ElementKind::Tet10 => &TET14,
        ElementKind::Hex8 => &GAUSS2,
        ElementKind::Wedge6 => &WEDGE6,
        ElementKind::Tet4 => &TET4,
    }
}

fn table(kind: ElementKind, rule: &[VolumePoint]) -> Vec<IntegrationPoint> {
    rule.iter()
        .map(|&(xi, weight)| IntegrationPoint {
            xi,
            weight,
            shape: kind.shape_functions(xi),
            gradients: kind.gradients(xi),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_natural_volume() {
        for kind in ElementKind::ALL {
            let rules = [Quadrature::Gauss2, Quadrature::Irons14, Quadrature::Gauss3]
                .map(|rule| stiffness_points(kind, rule));
            for points in rules.into_iter().chain([mass_points(kind)]) {
                let sum: f64 = points.iter().map(|p| p.weight).sum();
                assert!((sum / kind.natural_volume() - 1.0).abs() < 1e-13, "{}", kind.name());
            }
        }
    }
}
