//! Element types and node orders of other programs, one row per kind.
//!
//! Sources: VTK's vtkCellType.h; Gmsh Reference Manual, "MSH file format" and "Node ordering"; Abaqus
//! Analysis User's Guide, "Three-dimensional solid element library"; ANSYS Mechanical APDL Element Reference,
//! SOLID185 to SOLID187.

use trackbed_fem::ElementKind;

use self::Layout::{Brick, Order, Own};
use super::degenerate::to_brick;

/// Nodes of an element in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// In the order of the kind.
    Own,
    /// Place of each node of the kind.
    Order(&'static [usize]),
    /// Brick with repeated nodes ([`to_brick`]).
    Brick,
}

impl Layout {
    /// Node ids of an element in the order of the file.
    pub fn write(self, kind: ElementKind, nodes: &[u32]) -> Vec<u32> {
        match self {
            Own => nodes.to_vec(),
            Order(places) => {
                let mut placed = vec![0; nodes.len()];
                places.iter().zip(nodes).for_each(|(place, node)| placed[*place] = *node);
                placed
            }
            Brick => to_brick(kind, nodes),
        }
    }

    /// Node ids of a file in the order of the kind; bricks by [`super::degenerate::from_brick`].
    pub fn read(self, ids: &[u32]) -> Vec<u32> {
        match self {
            Order(places) => places.iter().map(|place| ids[*place]).collect(),
            Own | Brick => ids.to_vec(),
        }
    }
}

/// Types of a kind in files of other programs.
pub(crate) struct ForeignElement {
    pub kind: ElementKind,
    /// VTK number and name; nodes in the order of the kind.
    pub vtk: (u8, &'static str),
    /// Gmsh number.
    pub gmsh: (i32, Layout),
    /// Abaqus type that is written.
    pub abaqus: (&'static str, Layout),
    /// Number of the ANSYS type that is written.
    pub ansys: (u32, Layout),
}

/// Types of a kind.
pub(crate) fn foreign(kind: ElementKind) -> &'static ForeignElement {
    &FOREIGN[kind as usize]
}

/// Names of all kinds for messages, each once.
pub(crate) fn listed(name: impl Fn(&'static ForeignElement) -> &'static str) -> String {
    let mut names: Vec<&str> = Vec::new();
    for name in FOREIGN.iter().map(name) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.join(", ")
}

/// All kinds, in the order of [`ElementKind::ALL`].
pub(crate) static FOREIGN: [ForeignElement; ElementKind::ALL.len()] = [
    ForeignElement {
        kind: ElementKind::Hex20,
        vtk: (25, "VTK_QUADRATIC_HEXAHEDRON"),
        gmsh: (17, Order(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15])),
        abaqus: ("C3D20R", Own),
        ansys: (186, Brick),
    },
    ForeignElement {
        kind: ElementKind::Wedge15,
        vtk: (26, "VTK_QUADRATIC_WEDGE"),
        gmsh: (18, Order(&[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11])),
        abaqus: ("C3D15", Own),
        ansys: (186, Brick),
    },
    ForeignElement {
        kind: ElementKind::Pyramid13,
        vtk: (27, "VTK_QUADRATIC_PYRAMID"),
        gmsh: (19, Order(&[0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12])),
        abaqus: ("C3D20R", Brick),
        ansys: (186, Brick),
    },
    ForeignElement {
        kind: ElementKind::Tet10,
        vtk: (24, "VTK_QUADRATIC_TETRA"),
        gmsh: (11, Order(&[0, 1, 2, 3, 4, 5, 6, 7, 9, 8])),
        abaqus: ("C3D10", Own),
        ansys: (187, Own),
    },
    ForeignElement {
        kind: ElementKind::Hex8,
        vtk: (12, "VTK_HEXAHEDRON"),
        gmsh: (5, Own),
        abaqus: ("C3D8", Own),
        ansys: (185, Brick),
    },
    ForeignElement {
        kind: ElementKind::Wedge6,
        vtk: (13, "VTK_WEDGE"),
        gmsh: (6, Own),
        abaqus: ("C3D6", Own),
        ansys: (185, Brick),
    },
    ForeignElement {
        kind: ElementKind::Pyramid5,
        vtk: (14, "VTK_PYRAMID"),
        gmsh: (7, Own),
        abaqus: ("C3D5", Own),
        ansys: (185, Brick),
    },
    ForeignElement {
        kind: ElementKind::Tet4,
        vtk: (10, "VTK_TETRA"),
        gmsh: (4, Own),
        abaqus: ("C3D4", Own),
        ansys: (185, Brick),
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_a_row_of_its_own() {
        assert!(FOREIGN.iter().map(|row| row.kind).eq(ElementKind::ALL));
        for (i, a) in FOREIGN.iter().enumerate() {
            for b in &FOREIGN[..i] {
                let pair = format!("{} and {}", a.kind.name(), b.kind.name());
                assert!(a.vtk.0 != b.vtk.0 && a.vtk.1 != b.vtk.1 && a.gmsh.0 != b.gmsh.0, "{pair}");
                assert!(a.abaqus != b.abaqus, "{pair}");
            }
        }
    }

    #[test]
    fn orders_are_permutations() {
        for row in &FOREIGN {
            let nodes: Vec<u32> = (0..row.kind.node_count() as u32).collect();
            for layout in [row.gmsh.1, row.abaqus.1, row.ansys.1].into_iter().filter(|l| *l != Brick) {
                let written = layout.write(row.kind, &nodes);
                assert_eq!(layout.read(&written), nodes, "{}", row.kind.name());
                assert!(nodes.iter().all(|n| written.contains(n)), "{}", row.kind.name());
            }
        }
    }
}
