//! Node and face selection.

use super::geometry::Geometry;
use crate::scene::solid::{Side, Support};
use crate::scene::units::{Length, Quantity, vector};
use crate::scene::{SceneError, Table};
use std::collections::HashMap;
use trackbed_fem::mesh::{Face, Mesh};

/// Tolerance relative to the largest edge of the bounding box.
const ON_SIDE: f64 = 1e-6;

/// Box in scene units, [low, high].
pub type SceneBox = [[Quantity<Length>; 3]; 2];

/// Returns the index of node number `id`.
///
/// # Errors
/// Missing nodes.
pub fn find_node<T>(table: &Table<T>, mesh: &Mesh, id: u32) -> Result<usize, SceneError> {
    mesh.node_ids
        .iter()
        .position(|&n| n == id)
        .ok_or_else(|| table.error("node", format!("node {id}"), "the number of a node of the mesh"))
}

/// Returns support nodes, ascending.
///
/// # Errors
/// Not exactly one key, or no node.
pub fn nodes(support: &Table<Support>, geometry: &Geometry) -> Result<Vec<u32>, SceneError> {
    let mesh = &geometry.mesh;
    let all = 0..mesh.node_count() as u32;
    let x = |n: &u32| mesh.coordinates[*n as usize];
    match (support.side, support.nodes_in, support.set.as_deref(), support.node) {
        (Some(side), None, None, None) => {
            let on = on_side(mesh, side);
            Ok(all.filter(|n| on(x(n))).collect())
        }
        (None, Some(within), None, None) => {
            let inside = in_box(mesh, within);
            let chosen: Vec<u32> = all.filter(|n| inside(x(n))).collect();
            if chosen.is_empty() {
                return Err(support.error("nodes_in", "no node in the box", "at least one"));
            }
            Ok(chosen)
        }
        (None, None, Some(name), None) => node_set(support, geometry, name).cloned(),
        (None, None, None, Some(id)) => Ok(vec![find_node(support, mesh, id)? as u32]),
        _ => Err(support.one_of(&[
            ("side", support.side.is_some()),
            ("nodes_in", support.nodes_in.is_some()),
            ("set", support.set.is_some()),
            ("node", support.node.is_some()),
        ])),
    }
}

/// Returns boundary faces of a table.
///
/// # Errors
/// Not exactly one key, or no face.
pub fn faces<T>(
    table: &Table<T>,
    geometry: &Geometry,
    list: Option<&[[u32; 2]]>,
    within: Option<SceneBox>,
    side: Option<Side>,
    set: Option<&str>,
) -> Result<Vec<Face>, SceneError> {
    let mesh = &geometry.mesh;
    let boundary = |key: &str, what: &str, keep: &dyn Fn(&Face) -> bool| {
        let faces: Vec<Face> = mesh.boundary_faces().into_iter().filter(keep).collect();
        if faces.is_empty() {
            Err(table.error(key, format!("no boundary face {what}"), "at least one"))
        } else {
            Ok(faces)
        }
    };
    match (list, within, side, set) {
        (Some(list), None, None, None) => listed(table, mesh, list),
        (None, Some(within), None, None) => {
            let inside = in_box(mesh, within);
            boundary("faces_in", "in the box", &|f| inside(f.centre(mesh)))
        }
        (None, None, Some(side), None) => {
            let on = on_side(mesh, side);
            boundary("side", "on this side", &|f| f.nodes().iter().all(|n| on(mesh.coordinates[*n as usize])))
        }
        (None, None, None, Some(name)) if geometry.face_sets.contains_key(name) => {
            let set = &geometry.face_sets[name];
            boundary("set", "in the set", &|f| set.binary_search(&[f.element, u32::from(f.side)]).is_ok())
        }
        (None, None, None, Some(name)) => {
            let set = node_set(table, geometry, name)?;
            let mut member = vec![false; mesh.node_count()];
            set.iter().for_each(|n| member[*n as usize] = true);
            boundary("set", "with all its nodes in the set", &|f| {
                f.nodes().iter().all(|n| member[*n as usize])
            })
        }
        _ => Err(table.one_of(&[
            ("faces", list.is_some()),
            ("faces_in", within.is_some()),
            ("side", side.is_some()),
            ("set", set.is_some()),
        ])),
    }
}

fn node_set<'g, T>(table: &Table<T>, geometry: &'g Geometry, name: &str) -> Result<&'g Vec<u32>, SceneError> {
    geometry.node_sets.get(name).ok_or_else(|| {
        let known: Vec<&str> = geometry.node_sets.keys().map(String::as_str).collect();
        let expected = if known.is_empty() {
            "the name of a node set (the mesh file contains no sets)".into()
        } else {
            format!("a node set of the mesh file: {}", known.join(", "))
        };
        table.error("set", format!("\"{name}\""), expected)
    })
}

fn listed<T>(table: &Table<T>, mesh: &Mesh, list: &[[u32; 2]]) -> Result<Vec<Face>, SceneError> {
    let elements: HashMap<u32, usize> = mesh.element_ids.iter().enumerate().map(|(i, &id)| (id, i)).collect();
    list.iter()
        .map(|&[element, side]| {
            let e = *elements.get(&element).ok_or_else(|| {
                table.error("faces", format!("element {element}"), "the number of an element of the mesh")
            })?;
            let faces = mesh.connectivity.kind(e).faces().len();
            if !(1..=faces as u32).contains(&side) {
                let expected = if faces == 6 {
                    "a SOLID186 face, 1 to 6".to_string()
                } else {
                    format!("a face of the {}, 1 to {faces}", mesh.connectivity.kind(e).name())
                };
                return Err(table.error("faces", format!("face {side}"), expected));
            }
            Ok(mesh.face(e, side as usize - 1))
        })
        .collect()
}

fn on_side(mesh: &Mesh, side: Side) -> impl Fn([f64; 3]) -> bool {
    let (low, high) = mesh.bounding_box();
    let (axis, upper) = side.axis();
    let near = ON_SIDE * (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let at = if upper { high[axis] } else { low[axis] };
    move |x| (x[axis] - at).abs() <= near
}

/// Tolerance relative to mesh size.
fn in_box(mesh: &Mesh, [low, high]: SceneBox) -> impl Fn([f64; 3]) -> bool {
    let (least, greatest) = mesh.bounding_box();
    let near = 1e-9 * (0..3).map(|k| greatest[k] - least[k]).fold(0.0, f64::max);
    let (low, high) = (vector(&low), vector(&high));
    move |x| (0..3).all(|d| low[d] - near <= x[d] && x[d] <= high[d] + near)
}
