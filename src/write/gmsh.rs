//! Gmsh meshes (`.msh`), text, formats 4.1 and 2.2.
//!
//! A material is a physical volume whose number is that of the material; sets of elements are physical volumes with
//! names, sets of nodes physical points with names.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use trackbed_fem::ElementKind;

use crate::read::MeshFile;
use crate::read::gmsh::{TYPES, order};

use super::atomic;
use super::error::WriteError;

/// Gmsh's number of a point element.
const POINT: i32 = 15;

/// Elements of one kind in the same groups: the first group is the material.
type Group = Vec<u32>;

/// Writes a mesh; returns what was changed.
pub(super) fn write_gmsh(path: &Path, file: &MeshFile, old: bool) -> Result<Vec<String>, WriteError> {
    let mut lost = Vec::new();
    if file.mesh.materials.contains(&0) {
        lost.push("elements of material 0 are in no physical volume".to_string());
    }
    let first_set = file.mesh.materials.iter().copied().max().unwrap_or(0).saturating_add(1);
    // Groups of each element: material, then sets.
    let mut groups: Vec<Group> = file.mesh.materials.iter().map(|m| vec![*m]).collect();
    for (number, members) in file.element_sets.values().enumerate() {
        for element in members {
            groups[*element as usize].push(first_set + number as u32);
        }
    }
    for of_element in &mut groups {
        of_element.retain(|group| *group != 0);
    }
    let mut names = String::new();
    let all = file.element_sets.len() + file.node_sets.len();
    let rows = file.node_sets.keys().enumerate().map(|(n, name)| (0, n as u32 + 1, name));
    let rows =
        rows.chain(file.element_sets.keys().enumerate().map(|(n, name)| (3, first_set + n as u32, name)));
    for (dimension, number, name) in rows {
        if name.contains('"') {
            lost.push(format!("set {name} has ' for its quotes in the file"));
        }
        names += &format!("{dimension} {number} \"{}\"\n", name.replace('"', "'"));
    }
    let names = if all == 0 { names } else { format!("$PhysicalNames\n{all}\n{names}$EndPhysicalNames\n") };
    let body = if old { format2(file, &groups) } else { format4(file, &groups) };
    let body = body.map_err(|e| WriteError::format(path, e))?;
    let version = if old { "2.2" } else { "4.1" };
    let text = format!("$MeshFormat\n{version} 0 8\n$EndMeshFormat\n{names}{body}");
    atomic::write(path, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(path)))?;
    Ok(lost)
}

fn number(kind: ElementKind) -> i32 {
    TYPES.iter().find(|(_, k)| *k == kind).map_or(0, |(number, _)| *number)
}

/// Node numbers of an element in Gmsh's order.
fn in_order(file: &MeshFile, element: usize) -> Vec<u32> {
    let mesh = &file.mesh;
    let mut nodes = vec![0; mesh.connectivity[element].len()];
    for (place, node) in order(mesh.connectivity.kind(element)).into_iter().zip(&mesh.connectivity[element]) {
        nodes[place] = mesh.node_ids[*node as usize];
    }
    nodes
}

/// A first number for the point elements, above those of the volumes.
fn above(file: &MeshFile) -> u64 {
    u64::from(file.mesh.element_ids.iter().copied().max().unwrap_or(0)) + 1
}

fn format2(file: &MeshFile, groups: &[Group]) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    let mut out = format!("$Nodes\n{}\n", mesh.node_count());
    for (id, [x, y, z]) in mesh.node_ids.iter().zip(&mesh.coordinates) {
        writeln!(out, "{id} {x:?} {y:?} {z:?}")?;
    }
    writeln!(out, "$EndNodes\n$Elements")?;
    let points: usize = file.node_sets.values().map(Vec::len).sum();
    // An element stands once for each of its groups.
    let more: usize = groups.iter().map(|g| g.len().saturating_sub(1)).sum();
    writeln!(out, "{}", mesh.element_count() + more + points)?;
    let mut next = above(file);
    let mut again = String::new();
    for (e, of_element) in groups.iter().enumerate() {
        let nodes = in_order(file, e).iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
        let kind = number(mesh.connectivity.kind(e));
        let material = mesh.materials[e];
        writeln!(out, "{} {kind} 2 {material} {} {nodes}", mesh.element_ids[e], material.max(1))?;
        for group in of_element.iter().skip(usize::from(material != 0)) {
            writeln!(again, "{next} {kind} 2 {group} {} {nodes}", material.max(1))?;
            next += 1;
        }
    }
    out += &again;
    for (set, members) in file.node_sets.values().enumerate() {
        for node in members {
            let (set, id) = (set + 1, mesh.node_ids[*node as usize]);
            writeln!(out, "{next} {POINT} 2 {set} {set} {id}")?;
            next += 1;
        }
    }
    writeln!(out, "$EndElements")?;
    Ok(out)
}

fn format4(file: &MeshFile, groups: &[Group]) -> Result<String, std::fmt::Error> {
    let mesh = &file.mesh;
    // A volume for each combination of groups.
    let combinations: BTreeSet<&Group> = groups.iter().collect();
    let volumes: BTreeMap<&Group, usize> =
        combinations.into_iter().enumerate().map(|(n, group)| (group, n + 1)).collect();
    let (low, high) = mesh.bounding_box();
    let mut out = format!("$Entities\n{} 0 0 {}\n", file.node_sets.len(), volumes.len());
    let [x, y, z] = mesh.coordinates.first().copied().unwrap_or_default();
    for set in 1..=file.node_sets.len() {
        writeln!(out, "{set} {x:?} {y:?} {z:?} 1 {set}")?;
    }
    for (group, volume) in &volumes {
        let physical: String = group.iter().map(|g| format!(" {g}")).collect();
        let [a, b, c, d, e, f] = [low[0], low[1], low[2], high[0], high[1], high[2]];
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
    // Blocks of neighbours in the file with the same volume and kind, so that the order of elements stays.
    let key = |e: usize| (volumes[&groups[e]], mesh.connectivity.kind(e));
    let elements: Vec<usize> = (0..mesh.element_count()).collect();
    let blocks: Vec<&[usize]> = elements.chunk_by(|a, b| key(*a) == key(*b)).collect();
    let points: usize = file.node_sets.values().map(Vec::len).sum();
    let sets = file.node_sets.values().filter(|set| !set.is_empty()).count();
    let (first, last) = (least(&mesh.element_ids), u64::from(most(&mesh.element_ids)) + points as u64);
    writeln!(out, "{} {} {first} {last}", blocks.len() + sets, mesh.element_count() + points)?;
    for block in blocks {
        let (volume, kind) = key(block[0]);
        writeln!(out, "3 {volume} {} {}", number(kind), block.len())?;
        for e in block {
            let nodes: String = in_order(file, *e).iter().map(|n| format!(" {n}")).collect();
            writeln!(out, "{}{nodes}", mesh.element_ids[*e])?;
        }
    }
    let mut next = above(file);
    for (set, members) in file.node_sets.values().enumerate().filter(|(_, m)| !m.is_empty()) {
        writeln!(out, "0 {} {POINT} {}", set + 1, members.len())?;
        for node in members {
            writeln!(out, "{next} {}", mesh.node_ids[*node as usize])?;
            next += 1;
        }
    }
    writeln!(out, "$EndElements")?;
    Ok(out)
}
