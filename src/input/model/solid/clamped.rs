//! Warnings about 8-node hexahedra too deep for the boundary layer at a clamped face.
//!
//! A clamped face suppresses the lateral strain ν σ/E over about a third of the section width.

use std::collections::BTreeMap;
use trackbed_fem::mesh::Face;
use trackbed_fem::{Constraint, ElementKind, Material, Mesh};

/// Poisson's ratio from which it warns.
const LATERAL_STRAIN: f64 = 0.45;
/// Largest element depth over section width.
const DEPTH: f64 = 0.25;

#[derive(Default)]
struct Section {
    area: f64,
    /// Length of edges shared with free faces [m].
    free: f64,
    depths: Vec<f64>,
}

/// Warns about too deep 8-node hexahedra at a clamped face.
pub fn remarks(mesh: &Mesh, materials: &BTreeMap<u32, Material>, constraints: &[Constraint]) -> Vec<String> {
    let stiff = |e: usize| {
        let poisson = materials.get(&mesh.materials[e]).map_or(0.0, |m| m.elastic.poisson);
        mesh.connectivity.kind(e) == ElementKind::Hex8 && poisson >= LATERAL_STRAIN
    };
    if !(0..mesh.element_count()).any(stiff) {
        return Vec::new();
    }
    let mut held = vec![0_u8; mesh.node_count()];
    constraints.iter().for_each(|c| held[c.node as usize] |= 1 << c.direction);
    let mut sections: BTreeMap<u32, Section> = BTreeMap::new();
    for face in mesh.boundary_faces().iter().filter(|f| stiff(f.element as usize)) {
        let section = sections.entry(mesh.materials[face.element as usize]).or_default();
        if face.corners().iter().all(|&n| held[n as usize] == 7) {
            let area = area(mesh, face);
            section.area += area;
            section.depths.push(mesh.element_volume(face.element as usize) / area);
        }
        section.free += free_edge(mesh, face, &held);
    }
    sections.iter().filter_map(|(number, s)| remark(*number, materials[number].elastic.poisson, s)).collect()
}

fn area(mesh: &Mesh, face: &Face) -> f64 {
    let (_, area) = face.point_and_area(mesh, face.shape.natural_centre());
    4.0 * area.iter().map(|a| a * a).sum::<f64>().sqrt()
}

/// Length [m] of the edge shared with a clamped face, if other corners are free; else 0.
fn free_edge(mesh: &Mesh, face: &Face, held: &[u8]) -> f64 {
    let corners = face.corners();
    let of = |k: usize| corners[k % corners.len()] as usize;
    let edge = (0..corners.len())
        .find(|&k| held[of(k)] == 7 && held[of(k + 1)] == 7 && held[of(k + 2)] == 0 && held[of(k + 3)] == 0);
    edge.map_or(0.0, |k| {
        let (a, b) = (mesh.coordinates[of(k)], mesh.coordinates[of(k + 1)]);
        (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
    })
}

/// Warns below a quarter of the hydraulic diameter 4 A/P.
fn remark(number: u32, poisson: f64, section: &Section) -> Option<String> {
    let width = 4.0 * section.area / section.free;
    // Infinite width without a free edge, NaN without a clamped face.
    let deep = |d: &&f64| **d > DEPTH * width * (1.0 + 1e-9);
    let count = section.depths.iter().filter(deep).count();
    let deepest = section.depths.iter().copied().fold(0.0, f64::max);
    (count > 0).then(|| {
        format!(
            "material {number} has Poisson's ratio {poisson}, and {count} of its hex8 elements are up to {:.2} widths of the section \
             deep at a clamped face: displacements come out too small, in a cantilever or a column by 6 % at a depth of 1, 2 % at 0.5; \
             make the elements there at most {DEPTH} widths deep",
            deepest / width
        )
    })
}
