//! Mesh defects beyond reader errors.

use std::collections::HashMap;

use serde::Serialize;
use trackbed_fem::ElementKind;
use trackbed_fem::element::mass_points;
use trackbed_fem::mesh::{Constraint, Mesh};

use super::{element_quality, unused_nodes};

/// Tolerance of coincident nodes over the mesh size.
const COINCIDENT: f64 = 1e-9;

const CORNERS: [&str; 8] = ["I", "J", "K", "L", "M", "N", "O", "P"];

/// Defect or suspect property of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[serde(rename_all = "snake_case", tag = "problem")]
pub enum Problem {
    /// No elements.
    #[error("the mesh has no elements")]
    Empty,
    /// Jacobian determinant not positive.
    #[error("element {element} is inverted at {place}: Jacobian determinant {determinant:e} m³")]
    Inverted {
        /// Element id.
        element: u32,
        /// Corner or Gauss point of the least determinant.
        place: String,
        /// Determinant [m³].
        determinant: f64,
        /// Element volume [m³]; negative if inverted.
        volume: f64,
    },
    /// Two nodes at one position: elements are not connected.
    #[error("nodes {first} and {second} coincide: distance {distance:e} m")]
    Coincident {
        /// Node id.
        first: u32,
        /// Other node id.
        second: u32,
        /// Distance [m].
        distance: f64,
    },
    /// Bodies without common nodes.
    #[error("the mesh has {} unconnected parts: {}", parts.len(), name(parts))]
    Disconnected {
        /// Parts, by first element.
        parts: Vec<Part>,
    },
    /// Body without constraint.
    #[error("no constraint in the part of {}", name(std::slice::from_ref(part)))]
    Unconstrained {
        /// Unconstrained part.
        part: Part,
    },
    /// Nodes without stiffness.
    #[error("nodes in no element: {count}, the first is node {first}")]
    Unused {
        /// Number of nodes.
        count: usize,
        /// First node id.
        first: u32,
    },
}

/// Elements connected by nodes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Part {
    /// Number of elements.
    pub elements: usize,
    /// First element id.
    pub first_element: u32,
}

fn name(parts: &[Part]) -> String {
    let one = |p: &Part| format!("element {} ({} in all)", p.first_element, p.elements);
    let shown = parts.iter().take(5).map(one).collect::<Vec<_>>().join(", ");
    if parts.len() > 5 { format!("{shown}, …") } else { shown }
}

/// Returns the defects of a mesh, in fixed order.
pub fn check(mesh: &Mesh, constraints: &[Constraint]) -> Vec<Problem> {
    if mesh.element_count() == 0 {
        return vec![Problem::Empty];
    }
    let mut problems: Vec<Problem> = (0..mesh.element_count()).filter_map(|e| inverted(mesh, e)).collect();
    problems.extend(coincident(mesh));
    problems.extend(parts(mesh, constraints));
    let unused = unused_nodes(mesh);
    if let Some(&first) = unused.first() {
        problems.push(Problem::Unused { count: unused.len(), first });
    }
    problems
}

const SHOWN: usize = 10;

/// Reports a mesh whose elements are all inverted.
pub fn all_inside_out(mesh: &Mesh, problems: &[Problem]) -> Option<String> {
    let negative = |p: &&Problem| matches!(p, Problem::Inverted { volume, .. } if *volume < 0.0);
    let all = mesh.element_count();
    if all == 0 || problems.iter().filter(negative).count() != all {
        return None;
    }
    let bricks = mesh.connectivity.kinds().iter().all(|kind| kind.linear() == ElementKind::Hex8);
    let order = if bricks { "; right: M N O P I J K L, U V W X Q R S T, Y Z A B" } else { "" };
    let elements = if all == 1 { "the only element".to_string() } else { format!("all {all} elements") };
    Some(format!(
        "{elements} inverted: bottom and top faces are exchanged (order of the nodes, or a mirrored mesh){order}"
    ))
}

/// Returns one sentence per cause, with at most ten ids.
pub fn sentences(mesh: &Mesh, problems: &[Problem]) -> Vec<String> {
    let (mut all, mut at) = (Vec::new(), 0);
    let same = |a: &Problem, b: &Problem| std::mem::discriminant(a) == std::mem::discriminant(b);
    while at < problems.len() {
        let group: Vec<&Problem> = problems[at..].iter().take_while(|p| same(p, &problems[at])).collect();
        at += group.len();
        let whole =
            matches!(group[0], Problem::Inverted { .. }).then(|| all_inside_out(mesh, problems)).flatten();
        match whole {
            Some(sentence) => all.push(sentence),
            None if group.len() == 1 => all.push(group[0].to_string()),
            None => all.extend(joined(&group)),
        }
    }
    all
}

fn joined(group: &[&Problem]) -> Vec<String> {
    let list = |names: Vec<String>| {
        let end = if group.len() > SHOWN { format!(", … ({} in all)", group.len()) } else { String::new() };
        names.join(", ") + &end
    };
    let shown = || group.iter().take(SHOWN);
    let sentence = match group[0] {
        Problem::Inverted { .. } => {
            let ids = shown().filter_map(|p| match p {
                Problem::Inverted { element, .. } => Some(element.to_string()),
                _ => None,
            });
            let determinant = |p: &Problem| match p {
                Problem::Inverted { determinant, .. } => *determinant,
                _ => 0.0,
            };
            let worst = group.iter().min_by(|a, b| determinant(a).total_cmp(&determinant(b)));
            let worst = worst.map_or(String::new(), |p| p.to_string());
            format!("elements {} are inverted; the worst: {worst}", list(ids.collect()))
        }
        Problem::Coincident { .. } => {
            let pairs = shown().filter_map(|p| match p {
                Problem::Coincident { first, second, .. } => Some(format!("{first} and {second}")),
                _ => None,
            });
            format!("{} pairs of nodes coincide: {}", group.len(), list(pairs.collect()))
        }
        Problem::Unconstrained { .. } => {
            let parts = shown().filter_map(|p| match p {
                Problem::Unconstrained { part } => Some(name(std::slice::from_ref(part))),
                _ => None,
            });
            format!("no constraint in {} parts: {}", group.len(), list(parts.collect()))
        }
        _ => return group.iter().map(ToString::to_string).collect(),
    };
    vec![sentence]
}

fn inverted(mesh: &Mesh, element: usize) -> Option<Problem> {
    let (quality, kind) = (element_quality(mesh, element), mesh.connectivity.kind(element));
    let place = match quality.worst_point.checked_sub(kind.corner_count()) {
        None if kind.linear() == ElementKind::Hex8 => format!("corner {}", CORNERS[quality.worst_point]),
        None => format!("corner {}", quality.worst_point + 1),
        Some(point) => format!("integration point {} of {}", point + 1, mass_points(kind).len()),
    };
    let (element, determinant) = (mesh.element_ids[element], quality.determinant);
    let volume = quality.volume;
    (determinant <= 0.0).then_some(Problem::Inverted { element, place, determinant, volume })
}

/// Cells are somewhat larger than the tolerance, so few neighbours are searched.
fn coincident(mesh: &Mesh) -> Vec<Problem> {
    let extent = (0..3).map(|axis| {
        let values = mesh.coordinates.iter().map(|x| x[axis]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    });
    let size = extent.fold(0.0, f64::max);
    if size == 0.0 {
        return Vec::new();
    }
    let (near, side) = (COINCIDENT * size, 1e3 * COINCIDENT * size);
    let cell = |x: f64| (x / side).floor() as i64;
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut found = Vec::new();
    for (node, x) in mesh.coordinates.iter().enumerate() {
        let span = x.map(|c| cell(c - near)..=cell(c + near));
        for i in span[0].clone() {
            for j in span[1].clone() {
                for k in span[2].clone() {
                    for &other in cells.get(&[i, j, k]).into_iter().flatten() {
                        let y = mesh.coordinates[other];
                        let distance = (0..3).map(|a| (x[a] - y[a]).powi(2)).sum::<f64>().sqrt();
                        if distance <= near {
                            let (first, second) = (mesh.node_ids[other], mesh.node_ids[node]);
                            found.push(Problem::Coincident { first, second, distance });
                        }
                    }
                }
            }
        }
        cells.entry(x.map(cell)).or_default().push(node);
    }
    found
}

fn parts(mesh: &Mesh, constraints: &[Constraint]) -> Vec<Problem> {
    let mut parent: Vec<usize> = (0..mesh.node_count()).collect();
    for element in mesh.connectivity.iter() {
        let first = root(&mut parent, element[0] as usize);
        for node in &element[1..] {
            let other = root(&mut parent, *node as usize);
            parent[other] = first;
        }
    }
    let mut order: Vec<usize> = Vec::new();
    let mut found: HashMap<usize, Part> = HashMap::new();
    for (element, id) in mesh.connectivity.iter().zip(&mesh.element_ids) {
        let at = root(&mut parent, element[0] as usize);
        let part = found.entry(at).or_insert_with(|| {
            order.push(at);
            Part { elements: 0, first_element: *id }
        });
        part.elements += 1;
    }
    let held: Vec<usize> = constraints.iter().map(|c| root(&mut parent, c.node as usize)).collect();
    let mut problems = Vec::new();
    if order.len() > 1 {
        problems.push(Problem::Disconnected { parts: order.iter().map(|at| found[at].clone()).collect() });
    }
    let free = order.iter().filter(|at| !held.contains(at));
    problems.extend(free.map(|at| Problem::Unconstrained { part: found[at].clone() }));
    problems
}

fn root(parent: &mut [usize], mut node: usize) -> usize {
    while parent[node] != node {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample;

    fn held(mesh: &Mesh) -> Vec<Constraint> {
        let node = mesh.connectivity[0][0];
        vec![Constraint { node, direction: 2, value: 0.0 }]
    }

    fn sentences(problems: &[Problem]) -> Vec<String> {
        problems.iter().map(Problem::to_string).collect()
    }

    #[test]
    fn one_cause_is_one_sentence() {
        let mut mesh = sample::straight_block([4, 3, 2]);
        mesh.coordinates.iter_mut().for_each(|x| x[0] = -x[0]);
        let problems = check(&mesh, &held(&mesh));
        let found = super::sentences(&mesh, &problems);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("all 24 elements inverted: bottom and top faces"), "{found:?}");

        let mut mesh = sample::straight_block([4, 3, 2]);
        for element in 0..12 {
            mesh.connectivity[element][..8].rotate_left(4);
            mesh.connectivity[element][8..16].rotate_left(4);
        }
        let found = super::sentences(&mesh, &check(&mesh, &held(&mesh)));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains(", … (12 in all) are inverted; the worst: element "), "{found:?}");
        assert_eq!(found[0].split(" are inverted").next().unwrap().matches(", ").count(), 10, "{found:?}");
    }

    #[test]
    fn a_good_mesh_has_no_problems() {
        let mesh = sample::block([3, 2, 2]);
        assert_eq!(check(&mesh, &held(&mesh)), []);
        assert_eq!(check(&Mesh::default(), &[]), [Problem::Empty]);
    }

    #[test]
    fn reports_position_of_inversion() {
        let mut mesh = sample::straight_block([2, 1, 1]);
        let middle = mesh.connectivity[0][8] as usize;
        mesh.coordinates[middle][0] = 0.2;
        let found = sentences(&check(&mesh, &held(&mesh)));
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("element 1000 is inverted at corner I: "), "{found:?}");
    }

    #[test]
    fn reports_unconstrained_body_and_unused_nodes() {
        let mut mesh = sample::block([2, 1, 1]);
        mesh.node_ids.push(5000);
        mesh.coordinates.push([9.0; 3]);
        let expected = [
            "no constraint in the part of element 1000 (2 in all)",
            "nodes in no element: 1, the first is node 5000",
        ];
        assert_eq!(sentences(&check(&mesh, &[])), expected);
    }

    #[test]
    fn reports_coincident_nodes_of_two_parts() {
        let mut mesh = sample::straight_block([2, 1, 1]);
        // Separate nodes on the shared face, one slightly displaced.
        let shared: Vec<u32> =
            mesh.connectivity[1].iter().copied().filter(|n| mesh.connectivity[0].contains(n)).collect();
        for (copy, node) in shared.iter().enumerate() {
            let mut x = mesh.coordinates[*node as usize];
            x[1] += if copy == 0 { 1e-6 } else { 1e-10 };
            let new = mesh.node_count() as u32;
            mesh.coordinates.push(x);
            mesh.node_ids.push(10_000 + copy as u32);
            mesh.connectivity[1].iter_mut().filter(|n| *n == node).for_each(|n| *n = new);
        }
        let problems = check(&mesh, &held(&mesh));
        let coincident = problems.iter().filter(|p| matches!(p, Problem::Coincident { .. })).count();
        assert_eq!((shared.len(), coincident), (8, 7));
        let text = sentences(&problems[7..]);
        let expected = [
            "the mesh has 2 unconnected parts: element 1000 (1 in all), element 999 (1 in all)",
            "no constraint in the part of element 999 (1 in all)",
        ];
        assert_eq!(text, expected);
    }
}
