//! Integration points of each kind of element, with the shape functions there worked out once.
//!
//! The stiffness of the 20-node hexahedron takes the rule that the user names. The companions have two rules: the lean
//! one that leaves no mode without stiffness (9 points for the wedge, 18 for the pyramid, 4 for the tetrahedron), and
//! under the full rule one that is exact for the products of linear strains. Linear elements have
//! one rule. The mass takes a rule that is exact for products of shape functions on elements with flat faces.

use super::kind::{ElementKind, MAX_NODES};
use super::quadrature::{
    GAUSS2, GAUSS3, PYRAMID8, PYRAMID18, PYRAMID27, Quadrature, TET1, TET4, TET14, VolumePoint, WEDGE6,
    WEDGE9, WEDGE21,
};
use std::sync::OnceLock;

/// An integration point and the shape functions there.
#[derive(Clone, Copy, Debug)]
pub struct IntegrationPoint {
    /// Natural coordinates.
    pub xi: [f64; 3],
    /// Weight; the sum is the volume of the natural shape.
    pub weight: f64,
    /// Values of the shape functions; zero beyond the nodes of the kind.
    pub shape: [f64; MAX_NODES],
    /// Natural gradients of the shape functions; zero beyond the nodes of the kind.
    pub gradients: [[f64; 3]; MAX_NODES],
}

/// Points that integrate the stiffness of a kind of element under a rule.
#[inline]
pub fn stiffness_points(kind: ElementKind, rule: Quadrature) -> &'static [IntegrationPoint] {
    static TABLES: [[OnceLock<Vec<IntegrationPoint>>; 3]; 8] = [const { [const { OnceLock::new() }; 3] }; 8];
    TABLES[kind as usize][rule as usize].get_or_init(|| table(kind, stiffness_rule(kind, rule)))
}

/// Points that integrate the mass of a kind of element.
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
    fn weights_add_up_to_the_natural_volume() {
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
