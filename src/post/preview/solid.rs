//! Solid of a preview: materials, contact surface, supports, loads, sets.

use super::context::Context;
use super::item::{Item, Shape};
use super::palette::{self, AXES};
use std::collections::{BTreeMap, HashSet};
use trackbed_dem::Vec3;
use trackbed_fem::mesh::{Face, Mesh};
use trackbed_input::model::solid::{self, SolidPart};
use trackbed_io::results::solid::Surface;

/// Arrows of a load.
const ARROWS: usize = 60;
/// Length of arrows and size of supports over the model size.
const ARROW: f64 = 0.07;
const SUPPORT: f64 = 0.012;
/// Size of supports over element size.
const OF_ELEMENT: f64 = 0.3;
/// Cell size over the model size.
const CELL: f64 = 0.035;
/// Radius of set nodes over the size of supports.
const NODE: f64 = 0.2;

/// Ground elements, which come before those of meshed sleepers.
fn ground(part: &SolidPart) -> usize {
    part.sleepers.as_ref().map_or(part.model.mesh().element_count(), |s| s.ground_elements())
}

/// Faces of single elements among those of a material, so that layers can be hidden one by one.
fn skin(mesh: &Mesh, elements: usize, material: u32) -> (usize, Vec<Face>) {
    let own: Vec<usize> = (0..elements).filter(|e| mesh.materials[*e] == material).collect();
    let mut keyed: Vec<([u32; 4], Face)> = own
        .iter()
        .flat_map(|&e| (0..mesh.connectivity.kind(e).faces().len()).map(move |s| (e, s)))
        .map(|(e, s)| {
            let face = mesh.face(e, s);
            let mut key = [u32::MAX; 4];
            key[..face.corners().len()].copy_from_slice(face.corners());
            key.sort_unstable();
            (key, face)
        })
        .collect();
    keyed.sort_unstable_by_key(|(key, _)| *key);
    let single = keyed.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() == 1);
    (own.len(), single.map(|group| group[0].1).collect())
}

fn surface(mesh: &Mesh, faces: &[Face]) -> Shape {
    let surface = Surface::new(mesh, faces);
    Shape {
        points: surface.nodes.iter().map(|n| mesh.coordinates[*n as usize]).collect(),
        triangles: surface.triangles.as_chunks().0.to_vec(),
        edges: surface.edges.as_chunks().0.to_vec(),
        ids: surface.nodes.iter().map(|n| mesh.node_ids[*n as usize]).collect(),
        ..Shape::default()
    }
}

pub fn materials(c: &Context) -> Vec<Item> {
    let (Some(part), Some(table)) = (&c.job.solid, &c.scene.solid) else { return Vec::new() };
    let (mesh, elements) = (part.model.mesh(), ground(part));
    let item = |(k, m): (usize, &trackbed_input::scene::solid::SolidMaterial)| {
        let (count, faces) = skin(mesh, elements, m.id);
        let item =
            Item::new(format!("solid.material.{k}"), &part.material_names[&m.id], surface(mesh, &faces));
        (count > 0).then(|| item.counted(count, "element").coloured(palette::ground(k)))
    };
    table.material.iter().enumerate().filter_map(item).collect()
}

pub fn contact(c: &Context) -> Vec<Item> {
    let (Some(part), Some(coupling)) = (&c.job.solid, &c.job.coupling) else { return Vec::new() };
    let faces = &coupling.faces[..coupling.ground_faces];
    let item = Item::new("coupling", "contact with grains", surface(part.model.mesh(), faces));
    vec![item.counted(faces.len(), "face")]
}

pub fn absorbing(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.solid else { return Vec::new() };
    let faces: Vec<Face> = part.model.boundaries().iter().flat_map(|b| b.faces.iter().copied()).collect();
    if faces.is_empty() {
        return Vec::new();
    }
    let item = Item::new("solid.absorbing", "absorbing", surface(part.model.mesh(), &faces));
    vec![item.counted(faces.len(), "face")]
}

/// Edge length of a mean element, limited by the size of the model [m].
fn mark_size(c: &Context, mesh: &Mesh) -> f64 {
    let ([low, high], count) = (c.bounds, mesh.element_count().max(1) as f64);
    let volume: f64 = (0..3).map(|k| high[k] - low[k]).product();
    (SUPPORT * c.size()).min(OF_ELEMENT * libm::cbrt(volume / count))
}

/// Constrained nodes by direction.
pub fn supports(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.solid else { return Vec::new() };
    let (mesh, fixed) = (part.model.mesh(), part.model.supports().fixed());
    let nodes = part.sleepers.as_ref().map_or(mesh.node_count(), |s| s.ground_nodes());
    let moving: HashSet<usize> = part.supports.moving.iter().map(|(position, ..)| *position).collect();
    let size = mark_size(c, mesh);
    let middle = [0, 1, 2].map(|k| 0.5 * (c.bounds[0][k] + c.bounds[1][k]));
    let mut items = Vec::new();
    for (direction, colour) in (0..3).zip(AXES) {
        for moves in [false, true] {
            let (mut marked, mut count) = (BTreeMap::new(), 0);
            for (position, (dof, value)) in fixed.iter().enumerate() {
                let (node, along) = (*dof as usize / 3, *dof as usize % 3);
                let own = *value != 0.0 || moving.contains(&position);
                if along != direction || own != moves || node >= nodes {
                    continue;
                }
                let far = |n: usize| (mesh.coordinates[n][direction] - middle[direction]).abs();
                let cell = mesh.coordinates[node].map(|x| (x / (CELL * c.size())).floor() as i64);
                let outermost = marked.entry(cell).or_insert(node);
                if far(node) > far(*outermost) {
                    *outermost = node;
                }
                count += 1;
            }
            let mut shape = Shape::default();
            for node in marked.into_values() {
                let x = mesh.coordinates[node];
                let mut outwards = Vec3::zeros();
                outwards[direction] = if x[direction] > middle[direction] { 1.0 } else { -1.0 };
                shape.support(x, outwards, size);
                shape.ids.resize(shape.points.len(), mesh.node_ids[node]);
            }
            if count > 0 {
                let name = format!(
                    "{} {}",
                    if moves { "displaced in" } else { "fixed in" },
                    ["x", "y", "z"][direction]
                );
                items.push(Item::new("solid.support", name, shape).counted(count, "node").coloured(colour));
            }
        }
    }
    items
}

pub fn loads(c: &Context) -> Vec<Item> {
    let (Some(part), Some(table)) = (&c.job.solid, &c.scene.solid) else { return Vec::new() };
    let mesh = part.model.mesh();
    let item = |(k, (load, row)): (usize, (&solid::NodalLoad, &trackbed_input::scene::solid::SolidLoad))| {
        let mut shape = surface(mesh, &load.faces);
        shape.ids.clear();
        let step = load.forces.len().div_ceil(ARROWS).max(1);
        for (place, force) in load.forces.iter().step_by(step) {
            shape.arrow(*place, Vec3::from(*force), ARROW * c.size());
        }
        let total = [0, 1, 2].map(|d| load.forces.iter().map(|(_, f)| f[d]).sum::<f64>());
        let size = total.iter().map(|f| f * f).sum::<f64>().sqrt();
        let kind = format!("{:?}", row.kind).to_lowercase();
        let item =
            Item::new(format!("solid.load.{k}"), format!("{kind} {k}, {} kN", size.round() / 1e3), shape);
        match load.faces.len() {
            0 => item,
            faces => item.counted(faces, "face"),
        }
    };
    part.loads.iter().zip(&table.load).enumerate().map(item).collect()
}

/// Node and face sets of the mesh file.
pub fn sets(c: &Context) -> Vec<Item> {
    let (Some(part), Some(table)) = (&c.job.solid, &c.scene.solid) else { return Vec::new() };
    let Some(file) = table.mesh.as_ref().and_then(|_| solid::mesh_file(c.document, table).ok()) else {
        return Vec::new();
    };
    let mesh = &file.mesh;
    let radius = NODE * mark_size(c, part.model.mesh());
    let nodes =
        file.node_sets.iter().filter(|(name, _)| !file.face_sets.contains_key(*name)).map(|(name, nodes)| {
            let at = |n: &u32| mesh.coordinates[*n as usize];
            let spheres = nodes.iter().map(at).map(|[x, y, z]| [x, y, z, radius]).collect();
            let ids = nodes.iter().map(|n| mesh.node_ids[*n as usize]).collect();
            let shape = Shape { spheres, ids, ..Shape::default() };
            Item::new("solid.mesh", name, shape).counted(nodes.len(), "node")
        });
    let faces = file.face_sets.iter().map(|(name, set)| {
        let faces: Vec<Face> = set.iter().map(|[e, side]| mesh.face(*e as usize, *side as usize)).collect();
        Item::new("solid.mesh", name, surface(mesh, &faces)).counted(faces.len(), "face")
    });
    nodes.chain(faces).enumerate().map(|(k, item)| item.coloured(palette::group(k))).collect()
}
