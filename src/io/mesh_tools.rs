//! Mesh measures and checks of the `mesh` commands.

mod check;
mod quality;

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::{Constraint, Mesh};

pub use check::{Part, Problem, all_inside_out, check, sentences};
pub use quality::{Quality, element_quality};

/// Mesh summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshInfo {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of elements.
    pub elements: usize,
    /// Element kinds in the order of [`ElementKind::ALL`].
    pub kinds: Vec<KindInfo>,
    /// Lowest and highest node coordinates [m]; zero without nodes.
    pub bounds: [[f64; 3]; 2],
    /// Total volume [m³].
    pub volume: f64,
    /// Materials in ascending order.
    pub materials: Vec<MaterialInfo>,
    /// Scaled Jacobian: 1 for a brick, at most 0 if inverted anywhere.
    pub scaled_jacobian: Range,
    /// Longest over shortest edge; null in JSON for a zero edge.
    pub aspect_ratio: Range,
    /// Inverted elements (negative volume).
    pub inside_out: usize,
    /// Boundary faces.
    pub boundary_faces: usize,
    /// Constrained degrees of freedom.
    pub constrained_dofs: usize,
    /// Unused node numbers.
    pub unused_nodes: Vec<u32>,
}

/// Elements of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindInfo {
    /// Kind.
    pub kind: ElementKind,
    /// Number of elements.
    pub elements: usize,
    /// Volume [m³].
    pub volume: f64,
    /// Scaled Jacobian.
    pub scaled_jacobian: Range,
    /// Longest over shortest edge.
    pub aspect_ratio: Range,
}

/// Material of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialInfo {
    /// Material number.
    pub id: u32,
    /// Number of elements.
    pub elements: usize,
    /// Volume [m³].
    pub volume: f64,
}

/// Extremes with element numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Least value.
    pub least: f64,
    /// Element of the least value.
    pub least_element: u32,
    /// Greatest value.
    pub greatest: f64,
    /// Element of the greatest value.
    pub greatest_element: u32,
}

impl Range {
    /// First of equal values; zeros without elements.
    fn over(values: impl Iterator<Item = (u32, f64)>) -> Range {
        let none = Range { least: 0.0, least_element: 0, greatest: 0.0, greatest_element: 0 };
        values
            .fold(None, |range: Option<Range>, (id, value)| {
                let mut range = range.unwrap_or(Range {
                    least: value,
                    least_element: id,
                    greatest: value,
                    greatest_element: id,
                });
                if value < range.least {
                    (range.least, range.least_element) = (value, id);
                }
                if value > range.greatest {
                    (range.greatest, range.greatest_element) = (value, id);
                }
                Some(range)
            })
            .unwrap_or(none)
    }
}

fn unused_nodes(mesh: &Mesh) -> Vec<u32> {
    let mut used = vec![false; mesh.node_count()];
    for node in mesh.connectivity.nodes() {
        used[*node as usize] = true;
    }
    used.iter().zip(&mesh.node_ids).filter(|(used, _)| !**used).map(|(_, id)| *id).collect()
}

/// Computes counts, sizes and quality.
pub fn info(mesh: &Mesh, constraints: &[Constraint]) -> MeshInfo {
    let qualities: Vec<Quality> = (0..mesh.element_count()).map(|e| element_quality(mesh, e)).collect();
    let mut materials: BTreeMap<u32, MaterialInfo> = BTreeMap::new();
    for (id, quality) in mesh.materials.iter().zip(&qualities) {
        let material = materials.entry(*id).or_insert(MaterialInfo { id: *id, elements: 0, volume: 0.0 });
        material.elements += 1;
        material.volume += quality.volume;
    }
    let mut bounds = match mesh.coordinates.first() {
        Some(first) => [*first; 2],
        None => [[0.0; 3]; 2],
    };
    for point in &mesh.coordinates {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(point[axis]);
            bounds[1][axis] = bounds[1][axis].max(point[axis]);
        }
    }
    let mut dofs: Vec<(u32, u8)> = constraints.iter().map(|c| (c.node, c.direction)).collect();
    dofs.sort_unstable();
    dofs.dedup();
    let by_element = |measure: fn(&Quality) -> f64| {
        Range::over(mesh.element_ids.iter().copied().zip(qualities.iter().map(measure)))
    };
    let of_kind = |kind: ElementKind| {
        let members = || {
            let all = mesh.connectivity.kinds().iter().zip(&mesh.element_ids).zip(&qualities);
            all.filter(move |((k, _), _)| **k == kind).map(|((_, id), quality)| (*id, quality))
        };
        KindInfo {
            kind,
            elements: members().count(),
            volume: members().map(|(_, q)| q.volume).sum(),
            scaled_jacobian: Range::over(members().map(|(id, q)| (id, q.scaled_jacobian))),
            aspect_ratio: Range::over(members().map(|(id, q)| (id, q.aspect_ratio))),
        }
    };
    MeshInfo {
        nodes: mesh.node_count(),
        elements: mesh.element_count(),
        kinds: ElementKind::ALL.into_iter().map(of_kind).filter(|k| k.elements > 0).collect(),
        bounds,
        volume: qualities.iter().map(|q| q.volume).sum(),
        materials: materials.into_values().collect(),
        scaled_jacobian: by_element(|q| q.scaled_jacobian),
        aspect_ratio: by_element(|q| q.aspect_ratio),
        inside_out: qualities.iter().filter(|q| q.volume < 0.0).count(),
        boundary_faces: mesh.boundary_faces().len(),
        constrained_dofs: dofs.len(),
        unused_nodes: unused_nodes(mesh),
    }
}

impl fmt::Display for MeshInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.bounds;
        writeln!(f, "nodes             {:>10}", self.nodes)?;
        writeln!(f, "elements          {:>10}", self.elements)?;
        for k in &self.kinds {
            let (jacobian, aspect) = (k.scaled_jacobian, k.aspect_ratio);
            writeln!(
                f,
                "  {:<15} {:>10}   {:.4} m³, scaled Jacobian {:.4} to {:.4}, aspect ratio {:.4} to {:.4}",
                k.kind.name(),
                k.elements,
                k.volume,
                jacobian.least,
                jacobian.greatest,
                aspect.least,
                aspect.greatest
            )?;
        }
        writeln!(f, "boundary faces    {:>10}", self.boundary_faces)?;
        writeln!(f, "constrained dofs  {:>10}", self.constrained_dofs)?;
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            writeln!(f, "{name}                 {:>10.4} to {:.4} m", low[axis], high[axis])?;
        }
        writeln!(f, "volume            {:>10.4} m³", self.volume)?;
        if self.inside_out > 0 {
            let all = if self.inside_out == self.elements { ", all" } else { "" };
            writeln!(f, "inverted          {:>10}   elements{all}: negative volume", self.inside_out)?;
        }
        for m in &self.materials {
            writeln!(f, "  material {:<6} {:>10.4} m³   {} elements", m.id, m.volume, m.elements)?;
        }
        for (name, range) in
            [("scaled Jacobian", &self.scaled_jacobian), ("aspect ratio", &self.aspect_ratio)]
        {
            writeln!(
                f,
                "{name:<18}{:>10.4} (element {}) to {:.4} (element {})",
                range.least, range.least_element, range.greatest, range.greatest_element
            )?;
        }
        if let Some(first) = self.unused_nodes.first() {
            writeln!(f, "unused nodes      {:>10}   first: {first}", self.unused_nodes.len())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::write::sample;

    #[test]
    fn a_straight_block_in_numbers() {
        let mut mesh = sample::straight_block([2, 3, 3]);
        mesh.node_ids.push(90_000);
        mesh.coordinates.push([1.0, 1.0, 4.0]);
        let constraint = |node, direction| Constraint { node, direction, value: 0.0 };
        let info = info(&mesh, &[constraint(0, 0), constraint(0, 1), constraint(0, 0)]);
        // Corners and edges of an nx x ny x nz lattice.
        assert_eq!((info.nodes, info.elements), (3 * 4 * 4 + 2 * 16 + 3 * 12 + 3 * 12 + 1, 18));
        assert_eq!(info.bounds, [[0.0; 3], [2.0, 3.0, 4.0]]);
        assert!((info.volume - 18.0).abs() < 1e-12);
        let volumes: Vec<(u32, usize)> = info.materials.iter().map(|m| (m.id, m.elements)).collect();
        assert_eq!(volumes, [(1, 6), (2, 6), (3, 6)]);
        assert!(info.materials.iter().all(|m| (m.volume - 6.0).abs() < 1e-12));
        assert_eq!(info.boundary_faces, 2 * (6 + 6 + 9));
        assert_eq!(info.constrained_dofs, 2);
        assert_eq!(info.unused_nodes, [90_000]);
        assert!((info.scaled_jacobian.least - 1.0).abs() < 1e-12);
        assert!((info.aspect_ratio.greatest - 1.0).abs() < 1e-12);
        let text = info.to_string();
        assert!(text.contains("material 2") && text.contains("unused nodes"), "{text}");
    }

    /// Embankment of the FEM verification: volumes from its drawing (see `case.json`).
    #[test]
    fn an_embankment_in_numbers() {
        let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/fem/E3_embankment_patch");
        let list = |name: &str| dir.join(name);
        let (nodes, elements, dof) = (list("NODECOORD.DAT"), list("ELEMENTNUM.DAT"), list("DOF.DAT"));
        let lists = crate::read::read_lists(&nodes, &elements, Some(&dof), &Default::default()).unwrap();
        let info = info(&lists.mesh, &lists.constraints);
        assert_eq!(info.bounds, [[-10.0, 0.0, -5.0], [10.0, 3.6, 1.7]]);
        let volumes = [20.0 * 5.0, (4.75 + 2.95) * 1.2, (2.95 + 2.2) * 0.5].map(|area| 3.6 * area);
        for (material, volume) in info.materials.iter().zip(volumes) {
            assert!((material.volume - volume).abs() < 1e-9, "{material:?}, expected {volume}");
        }
        assert_eq!((info.constrained_dofs, info.unused_nodes.len()), (1547, 0));
        assert_eq!(check(&lists.mesh, &lists.constraints), []);
    }

    #[test]
    fn the_worst_element_is_named() {
        let mut mesh = sample::straight_block([3, 1, 1]);
        // Element 999: upper far corner moved.
        let corner = mesh.connectivity[1][6] as usize;
        mesh.coordinates[corner][0] += 0.3;
        let info = info(&mesh, &[]);
        assert!(info.scaled_jacobian.least < 0.9);
        assert!([999, 998].contains(&info.scaled_jacobian.least_element), "{info}");
        assert!(info.aspect_ratio.greatest > 1.2);
    }

    #[test]
    fn an_empty_mesh_has_no_numbers() {
        let info = info(&Mesh::default(), &[]);
        assert_eq!((info.nodes, info.volume, info.scaled_jacobian.least), (0, 0.0, 0.0));
    }
}
