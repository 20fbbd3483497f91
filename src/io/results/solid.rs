//! Skin of the solid with displacements and fields.

use std::path::Path;

use nalgebra::Matrix3;
use trackbed_fem::mesh::{Face, Mesh};

use crate::failure::Failure;
use crate::read::vtk_arrays::Arrays;
use crate::read::{ReadError, read_vtu};

const TENSOR: [(&str, usize); 6] = [("xx", 0), ("yy", 4), ("zz", 8), ("xy", 1), ("yz", 5), ("zx", 6)];
const PRINCIPAL: [&str; 4] = ["1", "2", "3", "mean"];
const NUMBERS: [&str; 2] = ["node_id", "element_id"];
/// Prefix of element fields.
pub const CELL: &str = "element:";

/// Faces of single elements.
pub struct Skin {
    nodes: Vec<u32>,
    element: Vec<u32>,
    /// Skin nodes of triangles.
    pub triangles: Vec<u32>,
    /// Skin nodes of element edge segments.
    pub edges: Vec<u32>,
    /// Id of each skin node in the user's mesh.
    pub node_ids: Vec<u32>,
    /// Element id of each triangle in the user's mesh.
    pub element_ids: Vec<u32>,
    /// Node positions, three coordinates each [m].
    pub points: Vec<f64>,
    /// Mesh of the solid.
    pub mesh: Mesh,
}

/// Triangles of a face: corners first, then mid-side nodes.
pub(super) fn triangles(nodes: usize) -> &'static [[usize; 3]] {
    match nodes {
        8 => &[[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6], [4, 5, 6], [4, 6, 7]],
        6 => &[[0, 3, 5], [1, 4, 3], [2, 5, 4], [3, 4, 5]],
        4 => &[[0, 1, 2], [0, 2, 3]],
        _ => &[[0, 1, 2]],
    }
}

/// Faces as triangles, with their own numbering of nodes.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Mesh nodes.
    pub nodes: Vec<u32>,
    /// Mesh element of each triangle.
    pub element: Vec<u32>,
    /// Surface nodes of triangles.
    pub triangles: Vec<u32>,
    /// Surface nodes of element edge segments.
    pub edges: Vec<u32>,
}

impl Surface {
    /// Triangulates faces of a mesh.
    pub fn new(mesh: &Mesh, faces: &[Face]) -> Surface {
        let mut of_mesh = vec![u32::MAX; mesh.node_count()];
        let mut surface = Surface::default();
        let mut edges = Vec::new();
        for face in faces {
            let own: Vec<u32> = face
                .nodes()
                .iter()
                .map(|n| {
                    let place = &mut of_mesh[*n as usize];
                    if *place == u32::MAX {
                        *place = surface.nodes.len() as u32;
                        surface.nodes.push(*n);
                    }
                    *place
                })
                .collect();
            let corners = face.corners().len();
            for triangle in triangles(own.len()) {
                surface.triangles.extend(triangle.map(|k| own[k]));
                surface.element.push(face.element);
            }
            for k in 0..corners {
                let (a, b) = (own[k], own[(k + 1) % corners]);
                let along = match own.get(corners + k) {
                    Some(middle) => vec![[a, *middle], [*middle, b]],
                    None => vec![[a, b]],
                };
                edges.extend(along.into_iter().map(|[a, b]| [a.min(b), a.max(b)]));
            }
        }
        edges.sort_unstable();
        edges.dedup();
        surface.edges = edges.into_flattened();
        surface
    }
}

impl Skin {
    /// Reads the skin of a mesh.
    ///
    /// # Errors
    /// No mesh.
    pub fn open(file: &Path) -> Result<Skin, Failure> {
        let mesh = read_vtu(file)?.mesh;
        let Surface { nodes, element, triangles, edges } = Surface::new(&mesh, &mesh.boundary_faces());
        Ok(Skin {
            triangles,
            edges,
            node_ids: nodes.iter().map(|n| mesh.node_ids[*n as usize]).collect(),
            element_ids: element.iter().map(|e| mesh.element_ids[*e as usize]).collect(),
            points: nodes.iter().flat_map(|n| mesh.coordinates[*n as usize]).collect(),
            nodes,
            element,
            mesh,
        })
    }

    /// Returns the bounding box [m].
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for (k, x) in self.points.iter().enumerate() {
            bounds[0][k % 3] = bounds[0][k % 3].min(*x);
            bounds[1][k % 3] = bounds[1][k % 3].max(*x);
        }
        bounds
    }

    /// Returns the displacement of skin nodes, three components each [m]; zero if absent.
    ///
    /// # Errors
    /// Different mesh, damaged file.
    pub fn displacement(&self, file: &Path) -> Result<Vec<f64>, Failure> {
        Ok(self.shown_places(&self.displacement_of_mesh(file)?))
    }

    /// Returns the displacement of all nodes.
    ///
    /// # Errors
    /// As [`Skin::displacement`].
    pub fn displacement_of_mesh(&self, file: &Path) -> Result<Vec<f64>, Failure> {
        let arrays = self.arrays(file)?;
        Ok(match arrays.components("PointData", "displacement") {
            Some(3) => arrays.values("PointData", "displacement")?,
            _ => vec![0.0; 3 * self.mesh.node_count()],
        })
    }

    /// Selects skin nodes or triangles.
    pub fn shown(&self, values: &[f64], of_elements: bool) -> Vec<f64> {
        let places = if of_elements { &self.element } else { &self.nodes };
        places.iter().map(|n| values[*n as usize]).collect()
    }

    /// Selects skin nodes from three values per mesh node.
    pub fn shown_places(&self, values: &[f64]) -> Vec<f64> {
        self.nodes.iter().flat_map(|n| &values[3 * *n as usize..3 * *n as usize + 3]).copied().collect()
    }

    fn arrays(&self, file: &Path) -> Result<Arrays, Failure> {
        let arrays = Arrays::open(file, "UnstructuredGrid")?;
        if arrays.points != self.mesh.node_count() {
            let (found, expected) = (format!("{} nodes", arrays.points), self.mesh.node_count());
            return Err(
                ReadError::whole(file, "mesh", found, format!("{expected} as in the first frame")).into()
            );
        }
        Ok(arrays)
    }

    /// Returns a field per skin node, or per triangle for element fields.
    ///
    /// # Errors
    /// As [`Skin::displacement`]; unknown field.
    pub fn field(&self, file: &Path, name: &str) -> Result<Vec<f64>, Failure> {
        Ok(self.shown(&self.field_of_mesh(file, name)?, name.starts_with(CELL)))
    }

    /// Returns a field of all nodes or elements.
    ///
    /// # Errors
    /// As [`Skin::field`].
    pub fn field_of_mesh(&self, file: &Path, name: &str) -> Result<Vec<f64>, Failure> {
        let arrays = self.arrays(file)?;
        let (section, stored, count) = match name.strip_prefix(CELL) {
            Some(stored) => ("CellData", stored, self.mesh.element_count()),
            None => ("PointData", name, self.mesh.node_count()),
        };
        let (stored, part) = match arrays.components(section, stored) {
            Some(_) => (stored, ""),
            None => stored.rsplit_once('_').unwrap_or((stored, "")),
        };
        let values = arrays.values(section, stored)?;
        let width = arrays.components(section, stored).unwrap_or(1);
        let found: Option<Vec<f64>> = values.chunks_exact(width).map(|item| reduced(item, part)).collect();
        Ok(found.filter(|f| f.len() == count).ok_or_else(|| {
            ReadError::whole(file, name, "no such field", "one of those that the frame has")
        })?)
    }
}

/// Returns the field names of a file. Element fields are prefixed.
///
/// # Errors
/// Not a solid file.
pub fn fields(file: &Path) -> Result<Vec<String>, Failure> {
    let arrays = Arrays::open(file, "UnstructuredGrid")?;
    let mut names = Vec::new();
    for (section, mark) in [("PointData", ""), ("CellData", CELL)] {
        for (name, components) in arrays.names(section).filter(|(name, _)| !NUMBERS.contains(name)) {
            let name = format!("{mark}{name}");
            match components {
                9 => {
                    names.extend(TENSOR.iter().map(|(part, _)| format!("{name}_{part}")));
                    names.extend(PRINCIPAL.iter().map(|part| format!("{name}_{part}")));
                }
                // Components of the displacement depend on its reference frame.
                3 if name == "displacement" => {}
                3 => {
                    names.extend(["x", "y", "z"].map(|part| format!("{name}_{part}")));
                    names.push(name);
                }
                _ => names.push(name),
            }
        }
    }
    Ok(names)
}

fn reduced(item: &[f64], part: &str) -> Option<f64> {
    match (item.len(), part) {
        (1, "") => Some(item[0]),
        (3, "") => Some(item.iter().map(|v| v * v).sum::<f64>().sqrt()),
        (3, _) => ["x", "y", "z"].iter().position(|p| *p == part).map(|k| item[k]),
        (9, "mean") => Some((item[0] + item[4] + item[8]) / 3.0),
        (9, "1" | "2" | "3") => {
            let mut values: Vec<f64> =
                Matrix3::from_row_slice(item).symmetric_eigenvalues().iter().copied().collect();
            values.sort_by(|a, b| b.total_cmp(a));
            part.parse::<usize>().ok().map(|k| values[k - 1])
        }
        (9, _) => TENSOR.iter().find(|(p, _)| *p == part).map(|(_, k)| item[*k]),
        _ => None,
    }
}
