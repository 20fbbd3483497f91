//! Writer of Gmsh meshes (`.msh`), text, formats 4.1 and 2.2.
//!
//! Materials are physical volumes (material 0, invalid in Gmsh, by name `read::gmsh::MATERIAL_0`).

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use trackbed_fem::mesh::Face;

use crate::read::MeshFile;
use crate::read::faces::key;
use crate::read::foreign_elements::foreign;
use crate::read::gmsh::MATERIAL_0;

use super::atomic;
use super::error::WriteError;

const POINT: i32 = 15;

type Group = Vec<u32>;

struct Sets<'a> {
    /// Node sets without face set.
    points: Vec<(&'a String, &'a [u32])>,
    surfaces: Vec<(&'a String, Vec<Face>)>,
}

impl<'a> Sets<'a> {
    fn of(file: &'a MeshFile, lost: &mut Vec<String>) -> Sets<'a> {
        let mesh = &file.mesh;
        let mut surfaces = Vec::new();
        for (name, members) in &file.face_sets {
            let mut faces: Vec<Face> =
                members.iter().map(|[e, s]| mesh.face(*e as usize, *s as usize)).collect();
            faces.sort_by_key(|face| key(face.corners()));
            faces.dedup_by_key(|face| key(face.corners()));
            surfaces.push((name, faces));
        }
        let stands = |name: &String, nodes: &[u32]| {
            let of = surfaces.iter().find(|(surface, _)| *surface == name);
            of.is_some_and(|(_, faces)| {
                let mut all: Vec<u32> = faces.iter().flat_map(|face| face.nodes().to_vec()).collect();
                all.sort_unstable();
                all.dedup();
                all == nodes
            })
        };
        let mut points: Vec<(&String, &[u32])> = Vec::new();
        for (name, nodes) in file.node_sets.iter().filter(|(name, nodes)| !stands(name, nodes)) {
            if file.face_sets.contains_key(name) {
                lost.push(format!("the set of nodes {name} gets the nodes of the faces of this name"));
            }
            points.push((name, nodes));
        }
        for (name, empty) in points
            .iter()
            .map(|(name, nodes)| (name, nodes.is_empty()))
            .chain(surfaces.iter().map(|(name, faces)| (name, faces.is_empty())))
        {
            if empty {
                lost.push(format!("set {name} is empty and is left out"));
            }
        }
        points.retain(|(_, nodes)| !nodes.is_empty());
        surfaces.retain(|(_, faces)| !faces.is_empty());
        Sets { points, surfaces }
    }

    fn count(&self) -> usize {
        self.points.iter().map(|(_, nodes)| nodes.len()).sum::<usize>()
            + self.surfaces.iter().map(|(_, faces)| faces.len()).sum::<usize>()
    }
}

pub(super) fn write_gmsh(path: &Path, file: &MeshFile, old: bool) -> Result<Vec<String>, WriteError> {
    let mut lost = Vec::new();
    let sets = Sets::of(file, &mut lost);
    // First id for material 0, then ids of element sets.
    let zero = file.mesh.materials.iter().copied().max().unwrap_or(0).saturating_add(1);
    let first_set = zero.saturating_add(1);
    let number_of = |material: &u32| if *material == 0 { zero } else { *material };
    let mut groups: Vec<Group> = file.mesh.materials.iter().map(|m| vec![number_of(m)]).collect();
    for (number, members) in file.element_sets.values().enumerate() {
        for element in members {
            groups[*element as usize].push(first_set + number as u32);
        }
    }
    let material_0 = MATERIAL_0.to_string();
    let named = file.mesh.materials.contains(&0).then_some((3, zero, &material_0));
    let points = sets.points.iter().enumerate().map(|(n, (name, _))| (0, n as u32 + 1, *name));
    let surfaces = sets.surfaces.iter().enumerate().map(|(n, (name, _))| (2, n as u32 + 1, *name));
    let elements = file.element_sets.keys().enumerate().map(|(n, name)| (3, first_set + n as u32, name));
    let rows: Vec<(u32, u32, &String)> = points.chain(surfaces).chain(named).chain(elements).collect();
    let mut names = String::new();
    for (dimension, number, name) in &rows {
        if name.contains(['"', '\n', '\r']) {
            lost.push(format!("set {name} has ' for its quotes and line ends in the file"));
        }
        names += &format!("{dimension} {number} \"{}\"\n", name.replace(['"', '\n', '\r'], "'"));
    }
    if !rows.is_empty() {
        names = format!("$PhysicalNames\n{}\n{names}$EndPhysicalNames\n", rows.len());
    }
    let body = if old { format2(file, &sets, &groups) } else { format4(file, &sets, &groups) };
    let body = body.map_err(|e| WriteError::format(path, e))?;
    let version = if old { "2.2" } else { "4.1" };
    let text = format!("$MeshFormat\n{version} 0 8\n$EndMeshFormat\n{names}{body}");
    atomic::write(path, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(path)))?;
    Ok(lost)
}

/// Gmsh type and node ids: corners, then mid-sides.
fn surface_element(file: &MeshFile, face: &Face) -> (i32, String) {
    let number = match face.nodes().len() {
        3 => 2,
        4 => 3,
        6 => 9,
        _ => 16,
    };
    let nodes: String =
        face.nodes().iter().map(|n| format!(" {}", file.mesh.node_ids[*n as usize])).collect();
    (number, nodes)
}

fn in_order(file: &MeshFile, element: usize) -> Vec<u32> {
    let mesh = &file.mesh;
    let ids: Vec<u32> = mesh.connectivity[element].iter().map(|n| mesh.node_ids[*n as usize]).collect();
    let kind = mesh.connectivity.kind(element);
    foreign(kind).gmsh.1.write(kind, &ids)
}

/// First id for point elements.
fn above(file: &MeshFile) -> u64 {
    u64::from(file.mesh.element_ids.iter().copied().max().unwrap_or(0)) + 1
}

fn format2(file: &MeshFile, sets: &Sets, groups: &[Group]) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let mut out = format!("$Nodes\n{}\n", mesh.node_count());
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.coordinates) {
        writeln!(out, "{id} {x:?} {y:?} {z:?}")?;
    }
    writeln!(out, "$EndNodes\n$Elements")?;
    // Elements are repeated for each group.
    let more: usize = groups.iter().map(|g| g.len().saturating_sub(1)).sum();
    writeln!(out, "{}", mesh.element_count() + more + sets.count())?;
    let mut next = above(file);
    let mut again = String::new();
    for (e, of_element) in groups.iter().enumerate() {
        let nodes = in_order(file, e).iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
        let kind = foreign(mesh.connectivity.kind(e)).gmsh.0;
        let entity = of_element[0];
        writeln!(out, "{} {kind} 2 {entity} {entity} {nodes}", mesh.element_ids[e])?;
        for group in &of_element[1..] {
            writeln!(again, "{next} {kind} 2 {group} {entity} {nodes}")?;
            next += 1;
        }
    }
    out += &again;
    for (set, (_, members)) in (1..).zip(&sets.points) {
        for node in *members {
            writeln!(out, "{next} {POINT} 2 {set} {set} {}", mesh.node_ids[*node as usize])?;
            next += 1;
        }
    }
    for (set, (_, faces)) in (1..).zip(&sets.surfaces) {
        for face in faces {
            let (kind, nodes) = surface_element(file, face);
            writeln!(out, "{next} {kind} 2 {set} {set}{nodes}")?;
            next += 1;
        }
    }
    writeln!(out, "$EndElements")?;
    Ok(out)
}

fn format4(file: &MeshFile, sets: &Sets, groups: &[Group]) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let combinations: BTreeSet<&Group> = groups.iter().collect();
    let volumes: BTreeMap<&Group, usize> =
        combinations.into_iter().enumerate().map(|(n, group)| (group, n + 1)).collect();
    let (low, high) = mesh.bounding_box();
    let (points, surfaces) = (sets.points.len(), sets.surfaces.len());
    let mut out = format!("$Entities\n{points} 0 {surfaces} {}\n", volumes.len());
    let [x, y, z] = mesh.coordinates.first().copied().unwrap_or_default();
    let [a, b, c, d, e, f] = [low[0], low[1], low[2], high[0], high[1], high[2]];
    for set in 1..=points {
        writeln!(out, "{set} {x:?} {y:?} {z:?} 1 {set}")?;
    }
    for set in 1..=surfaces {
        writeln!(out, "{set} {a:?} {b:?} {c:?} {d:?} {e:?} {f:?} 1 {set} 0")?;
    }
    for (group, volume) in &volumes {
        let physical: String = group.iter().map(|g| format!(" {g}")).collect();
        writeln!(out, "{volume} {a:?} {b:?} {c:?} {d:?} {e:?} {f:?} {}{physical} 0", group.len())?;
    }
    writeln!(out, "$EndEntities\n$Nodes")?;
    let least = |ids: &[u32]| ids.iter().copied().min().unwrap_or(0);
    let most = |ids: &[u32]| ids.iter().copied().max().unwrap_or(0);
    let (first, last, count) = (least(&mesh.node_ids), most(&mesh.node_ids), mesh.node_count());
    writeln!(out, "1 {count} {first} {last}\n3 1 0 {count}")?;
    mesh.node_ids.iter().try_for_each(|id| writeln!(out, "{id}"))?;
    for [x, y, z] in &mesh.coordinates {
        writeln!(out, "{x:?} {y:?} {z:?}")?;
    }
    writeln!(out, "$EndNodes\n$Elements")?;
    // Blocks of consecutive elements of equal volume and kind, to keep the order.
    let key = |e: usize| (volumes[&groups[e]], mesh.connectivity.kind(e));
    let elements: Vec<usize> = (0..mesh.element_count()).collect();
    let blocks: Vec<&[usize]> = elements.chunk_by(|a, b| key(*a) == key(*b)).collect();
    let kinds = |faces: &[Face]| faces.chunk_by(|a, b| a.nodes().len() == b.nodes().len()).count();
    let of_faces: usize = sets.surfaces.iter().map(|(_, faces)| kinds(faces)).sum();
    let (first, last) = (least(&mesh.element_ids), u64::from(most(&mesh.element_ids)) + sets.count() as u64);
    let (blocks_in_all, elements) = (blocks.len() + points + of_faces, mesh.element_count() + sets.count());
    writeln!(out, "{blocks_in_all} {elements} {first} {last}")?;
    for block in blocks {
        let (volume, kind) = key(block[0]);
        writeln!(out, "3 {volume} {} {}", foreign(kind).gmsh.0, block.len())?;
        for e in block {
            let nodes: String = in_order(file, *e).iter().map(|n| format!(" {n}")).collect();
            writeln!(out, "{}{nodes}", mesh.element_ids[*e])?;
        }
    }
    let mut next = above(file);
    for (set, (_, members)) in (1..).zip(&sets.points) {
        writeln!(out, "0 {set} {POINT} {}", members.len())?;
        for node in *members {
            writeln!(out, "{next} {}", mesh.node_ids[*node as usize])?;
            next += 1;
        }
    }
    for (set, (_, faces)) in (1..).zip(&sets.surfaces) {
        for block in faces.chunk_by(|a, b| a.nodes().len() == b.nodes().len()) {
            writeln!(out, "2 {set} {} {}", surface_element(file, &block[0]).0, block.len())?;
            for face in block {
                writeln!(out, "{next}{}", surface_element(file, face).1)?;
                next += 1;
            }
        }
    }
    writeln!(out, "$EndElements")?;
    Ok(out)
}
