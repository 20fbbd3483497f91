//! Kinds of volume elements.

use super::natural_shape::NaturalShape;
use super::properties::Properties;
use super::{ElementKind, on_kind};

/// Makes [`ElementKind`] and the dispatch to its modules, from a list `Kind = module`.
macro_rules! elements {
    ($d:tt $($(#[$doc:meta])* $kind:ident = $module:ident;)+) => {
        /// Kind of volume element; node order as in its module.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum ElementKind {
            $($(#[$doc])* $kind,)+
        }

        impl ElementKind {
            /// All kinds.
            pub const ALL: [ElementKind; [$($module::NODES),+].len()] = [$(ElementKind::$kind),+];

            /// Name in scenes and reports.
            pub const fn name(self) -> &'static str {
                match self {
                    $(ElementKind::$kind => stringify!($module),)+
                }
            }
        }

        /// Evaluates an expression with the module of a kind; the module is a constant of each arm.
        macro_rules! on_kind {
            ($d kind:expr, $d module:ident => $d value:expr) => {
                match $d kind {
                    $($crate::element::ElementKind::$kind => {
                        use $crate::element::$module as $d module;
                        $d value
                    })+
                }
            };
        }
        pub(crate) use on_kind;
    };
}
pub(super) use elements;

/// Largest number of nodes of a kind.
pub const MAX_NODES: usize = {
    let (mut most, mut k) = (0, 0);
    while k < ElementKind::ALL.len() {
        let nodes = ElementKind::ALL[k].node_count();
        if nodes > most {
            most = nodes;
        }
        k += 1;
    }
    most
};

impl ElementKind {
    /// Node count.
    #[inline]
    pub const fn node_count(self) -> usize {
        on_kind!(self, element => element::NODES)
    }

    /// Rules and terms of stiffness, mass and stress.
    #[inline]
    pub const fn properties(self) -> &'static Properties {
        on_kind!(self, element => &element::PROPERTIES)
    }

    /// Natural shape.
    #[inline]
    pub const fn shape(self) -> NaturalShape {
        self.properties().shape
    }

    /// Number of corners.
    pub const fn corner_count(self) -> usize {
        self.linear().node_count()
    }

    /// Whether all nodes are corners.
    #[inline]
    pub const fn is_linear(self) -> bool {
        self as usize == self.linear() as usize
    }

    /// Whether it has a node on each edge.
    #[inline]
    pub const fn has_mid_sides(self) -> bool {
        self as usize == self.quadratic() as usize
    }

    /// Returns its mid-side nodes among `nodes`, in the order of [`ElementKind::edges`].
    pub fn mid_sides(self, nodes: &[u32]) -> &[u32] {
        if self.has_mid_sides() { &nodes[self.corner_count()..] } else { &[] }
    }

    /// Kind of the same shape without mid-side nodes.
    #[inline]
    pub const fn linear(self) -> ElementKind {
        match self.shape() {
            NaturalShape::Hexahedron => ElementKind::Hex8,
            NaturalShape::Wedge => ElementKind::Wedge6,
            NaturalShape::Pyramid => ElementKind::Pyramid5,
            NaturalShape::Tetrahedron => ElementKind::Tet4,
        }
    }

    /// Kind of the same shape with mid-side nodes.
    pub const fn quadratic(self) -> ElementKind {
        match self.shape() {
            NaturalShape::Hexahedron => ElementKind::Hex20,
            NaturalShape::Wedge => ElementKind::Wedge15,
            NaturalShape::Pyramid => ElementKind::Pyramid13,
            NaturalShape::Tetrahedron => ElementKind::Tet10,
        }
    }

    /// Natural node coordinates. Shape `[nodes][3]`.
    pub fn natural(self) -> &'static [[f64; 3]] {
        on_kind!(self, element => &element::NATURAL)
    }

    /// Points at which the Jacobian of local node `node` is checked. For an apex, four points just below.
    pub fn limits_at_node(self, node: usize) -> &'static [[f64; 3]] {
        let limits = self.shape().limits_at_corner(node);
        limits.unwrap_or_else(|| std::slice::from_ref(&self.natural()[node]))
    }

    /// Face nodes: corners counter-clockwise from outside, then mid-sides.
    pub fn faces(self) -> &'static [&'static [usize]] {
        on_kind!(self, element => &element::FACES)
    }

    /// Corners of each edge, in the order of mid-side nodes.
    pub fn edges(self) -> &'static [[usize; 2]] {
        self.shape().edges()
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
        self.shape().volume()
    }

    /// Centre of the natural shape.
    pub fn natural_centre(self) -> [f64; 3] {
        self.shape().centre()
    }

    /// Whether a natural point is inside the shape, with tolerance `slack`.
    pub fn contains(self, xi: [f64; 3], slack: f64) -> bool {
        self.shape().contains(xi, slack)
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
    use crate::element::checks;
    use crate::element::quadrature::{GAUSS3, PYRAMID8, TET24, VolumePoint, WEDGE21};

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
            let quadratic = kind.quadratic();
            assert!(quadratic.has_mid_sides() && quadratic.linear() == kind.linear());
            assert_eq!(kind.edges().len() + kind.corner_count(), quadratic.node_count());
        }
    }

    #[test]
    fn shape_functions_and_faces_are_valid() {
        for kind in ElementKind::ALL {
            let [reduced, middle, full] = kind.properties().stiffness_rules;
            // Volumes that fewer points integrate exactly.
            let fewer = match kind {
                ElementKind::Hex20 | ElementKind::Wedge15 | ElementKind::Tet10 => 1e-3,
                _ => 1e-13,
            };
            let also: &[(&[VolumePoint], f64)] = match kind {
                ElementKind::Hex8 => &[(&GAUSS3, 1e-13)],
                ElementKind::Wedge6 => &[(&WEDGE21, 1e-13)],
                ElementKind::Pyramid13 => &[(&PYRAMID8, 1e-3)],
                ElementKind::Tet10 => &[(&TET24, 1e-13)],
                _ => &[],
            };
            let own =
                [(kind.properties().mass_rule, 1e-13), (full, 1e-13), (middle, fewer), (reduced, fewer)];
            on_kind!(kind, element => {
                checks::nodal(&element::NATURAL, element::shape_functions);
                checks::complete(&element::NATURAL, element::shape_functions, 1 + i32::from(kind.has_mid_sides()));
                checks::differences(&element::NATURAL, element::shape_functions, element::gradients);
                checks::faces(&element::NATURAL, element::shape_functions, &element::FACES);
                for (rule, tolerance) in own.iter().chain(also) {
                    checks::volume(&element::NATURAL, element::gradients, &element::FACES, rule, *tolerance);
                }
            });
        }
    }

    #[test]
    fn mid_sides_follow_the_edges() {
        for kind in ElementKind::ALL.into_iter().filter(|k| k.has_mid_sides()) {
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
        for kind in ElementKind::ALL.into_iter().filter(|k| k.has_mid_sides()) {
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
