//! Kinds of volume elements.

use super::hex20::FACE_NODES;
use super::{hex8, hex20, pyramid5, pyramid13, tet4, tet10, wedge6, wedge15};
use serde::{Deserialize, Serialize};

/// Largest number of nodes of a kind.
pub const MAX_NODES: usize = 20;

/// Kind of volume element; node order as in its module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ElementKind {
    /// 20-node serendipity hexahedron.
    Hex20,
    /// 15-node wedge.
    Wedge15,
    /// 13-node pyramid.
    Pyramid13,
    /// 10-node tetrahedron.
    Tet10,
    /// 8-node hexahedron.
    Hex8,
    /// 6-node wedge.
    Wedge6,
    /// 5-node pyramid.
    Pyramid5,
    /// 4-node tetrahedron.
    Tet4,
}

const HEX20_FACES: [&[usize]; 6] =
    [&FACE_NODES[0], &FACE_NODES[1], &FACE_NODES[2], &FACE_NODES[3], &FACE_NODES[4], &FACE_NODES[5]];

/// Edges in the order of mid-side nodes.
const HEX_EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
const WEDGE_EDGES: [[usize; 2]; 9] = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];
const PYRAMID_EDGES: [[usize; 2]; 8] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]];
const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

macro_rules! on_kind {
    ($kind:expr, $module:ident => $value:expr) => {
        match $kind {
            ElementKind::Hex20 => {
                use hex20 as $module;
                $value
            }
            ElementKind::Wedge15 => {
                use wedge15 as $module;
                $value
            }
            ElementKind::Pyramid13 => {
                use pyramid13 as $module;
                $value
            }
            ElementKind::Tet10 => {
                use tet10 as $module;
                $value
            }
            ElementKind::Hex8 => {
                use hex8 as $module;
                $value
            }
            ElementKind::Wedge6 => {
                use wedge6 as $module;
                $value
            }
            ElementKind::Pyramid5 => {
                use pyramid5 as $module;
                $value
            }
            ElementKind::Tet4 => {
                use tet4 as $module;
                $value
            }
        }
    };
}

impl ElementKind {
    /// All kinds.
    pub const ALL: [ElementKind; 8] = [
        ElementKind::Hex20,
        ElementKind::Wedge15,
        ElementKind::Pyramid13,
        ElementKind::Tet10,
        ElementKind::Hex8,
        ElementKind::Wedge6,
        ElementKind::Pyramid5,
        ElementKind::Tet4,
    ];

    /// Node count.
    #[inline]
    pub const fn node_count(self) -> usize {
        match self {
            ElementKind::Hex20 => 20,
            ElementKind::Wedge15 => 15,
            ElementKind::Pyramid13 => 13,
            ElementKind::Tet10 => 10,
            ElementKind::Hex8 => 8,
            ElementKind::Wedge6 => 6,
            ElementKind::Pyramid5 => 5,
            ElementKind::Tet4 => 4,
        }
    }

    /// Number of corners.
    pub const fn corner_count(self) -> usize {
        self.linear().node_count()
    }

    /// Whether all nodes are corners.
    #[inline]
    pub const fn is_linear(self) -> bool {
        matches!(self, ElementKind::Hex8 | ElementKind::Wedge6 | ElementKind::Pyramid5 | ElementKind::Tet4)
    }

    /// Kind of the same shape without mid-side nodes.
    pub const fn linear(self) -> ElementKind {
        match self {
            ElementKind::Hex20 | ElementKind::Hex8 => ElementKind::Hex8,
            ElementKind::Wedge15 | ElementKind::Wedge6 => ElementKind::Wedge6,
            ElementKind::Pyramid13 | ElementKind::Pyramid5 => ElementKind::Pyramid5,
            ElementKind::Tet10 | ElementKind::Tet4 => ElementKind::Tet4,
        }
    }

    /// Kind of the same shape with mid-side nodes.
    pub const fn quadratic(self) -> ElementKind {
        match self {
            ElementKind::Hex20 | ElementKind::Hex8 => ElementKind::Hex20,
            ElementKind::Wedge15 | ElementKind::Wedge6 => ElementKind::Wedge15,
            ElementKind::Pyramid13 | ElementKind::Pyramid5 => ElementKind::Pyramid13,
            ElementKind::Tet10 | ElementKind::Tet4 => ElementKind::Tet10,
        }
    }

    /// Name in scenes and reports.
    pub const fn name(self) -> &'static str {
        match self {
            ElementKind::Hex20 => "hex20",
            ElementKind::Wedge15 => "wedge15",
            ElementKind::Pyramid13 => "pyramid13",
            ElementKind::Tet10 => "tet10",
            ElementKind::Hex8 => "hex8",
            ElementKind::Wedge6 => "wedge6",
            ElementKind::Pyramid5 => "pyramid5",
            ElementKind::Tet4 => "tet4",
        }
    }

    /// Natural node coordinates. Shape `[nodes][3]`.
    pub fn natural(self) -> &'static [[f64; 3]] {
        on_kind!(self, element => &element::NATURAL)
    }

    /// Points at which the Jacobian of local node `node` is checked. For an apex, four points just below.
    pub fn limits_at_node(self, node: usize) -> &'static [[f64; 3]] {
        if matches!(self.linear(), ElementKind::Pyramid5) && node == 4 {
            &pyramid13::APEX_LIMITS
        } else {
            std::slice::from_ref(&self.natural()[node])
        }
    }

    /// Face nodes: corners counter-clockwise from outside, then mid-sides.
    pub fn faces(self) -> &'static [&'static [usize]] {
        match self {
            ElementKind::Hex20 => &HEX20_FACES,
            ElementKind::Wedge15 => &wedge15::FACES,
            ElementKind::Pyramid13 => &pyramid13::FACES,
            ElementKind::Tet10 => &tet10::FACES,
            ElementKind::Hex8 => &hex8::FACES,
            ElementKind::Wedge6 => &wedge6::FACES,
            ElementKind::Pyramid5 => &pyramid5::FACES,
            ElementKind::Tet4 => &tet4::FACES,
        }
    }

    /// Corners of each edge, in the order of mid-side nodes.
    pub fn edges(self) -> &'static [[usize; 2]] {
        match self.linear() {
            ElementKind::Hex8 => &HEX_EDGES,
            ElementKind::Wedge6 => &WEDGE_EDGES,
            ElementKind::Pyramid5 => &PYRAMID_EDGES,
            _ => &TET_EDGES,
        }
    }

    /// Shape functions at the natural point `xi`, padded with zeros.
    #[inline]
    pub fn shape_functions(self, xi: [f64; 3]) -> [f64; MAX_NODES] {
        on_kind!(self, element => padded(element::shape_functions(xi)))
    }

    /// Derivatives by the natural coordinates, padded with zeros.
    #[inline]
    pub fn gradients(self, xi: [f64; 3]) -> [[f64; 3]; MAX_NODES] {
        on_kind!(self, element => padded(element::gradients(xi)))
    }

    /// Volume of the natural shape.
    pub fn natural_volume(self) -> f64 {
        match self.linear() {
            ElementKind::Hex8 => 8.0,
            ElementKind::Wedge6 => 1.0,
            ElementKind::Pyramid5 => 4.0 / 3.0,
            _ => 1.0 / 6.0,
        }
    }

    /// Centre of the natural shape.
    pub fn natural_centre(self) -> [f64; 3] {
        const THIRD: f64 = 1.0 / 3.0;
        match self.linear() {
            ElementKind::Hex8 => [0.0; 3],
            ElementKind::Wedge6 => [THIRD, THIRD, 0.0],
            ElementKind::Pyramid5 => [0.0, 0.0, 0.25],
            _ => [0.25; 3],
        }
    }

    /// Whether a natural point is inside the shape, with tolerance `slack`.
    pub fn contains(self, [r, s, t]: [f64; 3], slack: f64) -> bool {
        let low = -slack;
        match self.linear() {
            ElementKind::Hex8 => [r, s, t].iter().all(|c| c.abs() <= 1.0 + slack),
            ElementKind::Wedge6 => r >= low && s >= low && r + s <= 1.0 + slack && t.abs() <= 1.0 + slack,
            ElementKind::Pyramid5 => t >= low && t <= 1.0 + slack && r.abs().max(s.abs()) <= 1.0 - t + slack,
            _ => r >= low && s >= low && t >= low && r + s + t <= 1.0 + slack,
        }
    }
}

#[inline]
fn padded<T: Copy + Default, const N: usize>(values: [T; N]) -> [T; MAX_NODES] {
    let mut all = [T::default(); MAX_NODES];
    all[..N].copy_from_slice(&values);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_agree_with_their_modules() {
        for kind in ElementKind::ALL {
            let n = kind.node_count();
            assert_eq!(kind.natural().len(), n);
            assert!(kind.natural().iter().all(|xi| kind.contains(*xi, 1e-12)));
            assert!(kind.contains(kind.natural_centre(), 0.0));
            let shape = kind.shape_functions(kind.natural_centre());
            assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(shape[n..].iter().all(|v| *v == 0.0));
            assert_eq!(kind.linear().edges().len() + kind.corner_count(), {
                let quadratic =
                    ElementKind::ALL.iter().find(|k| !k.is_linear() && k.linear() == kind.linear());
                quadratic.unwrap().node_count()
            });
        }
    }

    #[test]
    fn mid_sides_follow_the_edges() {
        for kind in ElementKind::ALL.into_iter().filter(|k| !k.is_linear()) {
            for (m, [a, b]) in kind.edges().iter().enumerate() {
                let x = kind.natural();
                for k in 0..3 {
                    let middle = (x[*a][k] + x[*b][k]) / 2.0;
                    assert!((x[kind.corner_count() + m][k] - middle).abs() < 1e-15, "{} {m}", kind.name());
                }
            }
        }
    }

    #[test]
    fn faces_contain_mid_sides_of_edges() {
        for kind in ElementKind::ALL.into_iter().filter(|k| !k.is_linear()) {
            for face in kind.faces() {
                let corners = face.len() / 2;
                for c in 0..corners {
                    let (a, b) = (face[c], face[(c + 1) % corners]);
                    let edge = kind.edges().iter().position(|e| *e == [a, b] || *e == [b, a]).unwrap();
                    assert_eq!(face[corners + c], kind.corner_count() + edge, "{}", kind.name());
                }
            }
        }
    }
}
