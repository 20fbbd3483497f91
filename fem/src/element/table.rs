//! Integration points with precomputed shape functions.

use super::ElementKind;
use super::kind::MAX_NODES;
use super::quadrature::{Quadrature, VolumePoint};
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
    static TABLES: [[OnceLock<Vec<IntegrationPoint>>; 3]; ElementKind::ALL.len()] =
        [const { [const { OnceLock::new() }; 3] }; ElementKind::ALL.len()];
    let rules = &kind.properties().stiffness_rules;
    TABLES[kind as usize][rule as usize].get_or_init(|| table(kind, rules[rule as usize]))
}

/// Integration points of the mass.
#[inline]
pub fn mass_points(kind: ElementKind) -> &'static [IntegrationPoint] {
    static TABLES: [OnceLock<Vec<IntegrationPoint>>; ElementKind::ALL.len()] =
        [const { OnceLock::new() }; ElementKind::ALL.len()];
    TABLES[kind as usize].get_or_init(|| table(kind, kind.properties().mass_rule))
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
