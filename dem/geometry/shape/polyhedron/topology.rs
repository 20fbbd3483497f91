//! Connectivity and consistent orientation of a surface.

use super::moments;
use super::surface::{Surface, SurfaceError};
use std::collections::HashMap;

/// Connectivity of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// Number of edges.
    pub edges: usize,
    /// Edges of one triangle.
    pub open_edges: usize,
    /// Edges of more than two triangles.
    pub branching_edges: usize,
    /// Edges with inconsistently oriented triangles.
    pub turned_edges: usize,
    /// Edge-connected pieces.
    pub pieces: usize,
}

impl Topology {
    /// Returns true if every edge has two triangles.
    pub fn is_closed_manifold(&self) -> bool {
        self.open_edges == 0 && self.branching_edges == 0
    }
}

/// Edges in order of appearance, by triangle.
struct Edges {
    order: Vec<(u32, u32)>,
    users: HashMap<(u32, u32), Vec<(u32, bool)>>,
}

fn edges(surface: &Surface) -> Edges {
    let mut found =
        Edges { order: Vec::new(), users: HashMap::with_capacity(surface.triangles.len() * 3 / 2) };
    for (t, [a, b, c]) in surface.triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let key = (*from.min(to), *from.max(to));
            let users = found.users.entry(key).or_default();
            if users.is_empty() {
                found.order.push(key);
            }
            users.push((t as u32, from < to));
        }
    }
    found
}

pub(super) fn check_indices(surface: &Surface) -> Result<(), SurfaceError> {
    let count = surface.vertices.len();
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|v| **v as usize >= count) {
            return Err(SurfaceError::Index { triangle, vertex, count });
        }
    }
    Ok(())
}

pub(super) fn topology(surface: &Surface) -> Result<Topology, SurfaceError> {
    check_indices(surface)?;
    let found = edges(surface);
    let mut topology = Topology { edges: found.order.len(), ..Topology::default() };
    let mut parts: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    for key in &found.order {
        let users = &found.users[key];
        match users.as_slice() {
            [_] => topology.open_edges += 1,
            [(_, one), (_, two)] => topology.turned_edges += usize::from(one == two),
            _ => topology.branching_edges += 1,
        }
        for pair in users.windows(2) {
            let (a, b) = (root(&mut parts, pair[0].0), root(&mut parts, pair[1].0));
            parts[a.max(b) as usize] = a.min(b);
        }
    }
    topology.pieces = (0..parts.len() as u32).filter(|t| parts[*t as usize] == *t).count();
    Ok(topology)
}

fn root(parts: &mut [u32], mut t: u32) -> u32 {
    while parts[t as usize] != t {
        parts[t as usize] = parts[parts[t as usize] as usize];
        t = parts[t as usize];
    }
    t
}

/// Orients all normals out of the material; returns the number of shells and of holes.
///
/// # Errors
/// An edge without exactly two triangles, or a one-sided surface.
pub(super) fn orient(surface: &mut Surface) -> Result<(usize, usize), SurfaceError> {
    let found = edges(surface);
    let ends = |key: &(u32, u32)| (surface.vertices[key.0 as usize], surface.vertices[key.1 as usize]);
    let open: Vec<_> = found.order.iter().filter(|k| found.users[k].len() == 1).collect();
    if let Some((from, to)) = open.first().map(|k| ends(k)) {
        return Err(SurfaceError::Open { edges: open.len(), from, to });
    }
    let branching: Vec<_> = found.order.iter().filter(|k| found.users[k].len() > 2).collect();
    if let Some((from, to)) = branching.first().map(|k| ends(k)) {
        return Err(SurfaceError::NonManifold { edges: branching.len(), from, to });
    }
    let shells = wind_alike(surface, &found)?;
    if shells.len() == 1 {
        if moments::moments(surface).volume < 0.0 {
            turn(surface, &shells[0]);
        }
        return Ok((1, 0));
    }

    // Shells in an odd number of others face inwards.
    let single = |surface: &Surface, shell: &[u32]| Surface {
        vertices: surface.vertices.clone(),
        triangles: shell.iter().map(|t| surface.triangles[*t as usize]).collect(),
    };
    for shell in &shells {
        if moments::moments(&single(surface, shell)).volume < 0.0 {
            turn(surface, shell);
        }
    }
    let alone: Vec<Surface> = shells.iter().map(|shell| single(surface, shell)).collect();
    let mut holes = 0;
    for (i, shell) in shells.iter().enumerate() {
        let [a, b, c] = alone[i].corners(0);
        let probe = ((a + b + c) / 3.0).into();
        let around = (0..shells.len()).filter(|j| *j != i && alone[*j].winding_number(probe) > 0.5).count();
        if around % 2 == 1 {
            turn(surface, shell);
            holes += 1;
        }
    }
    Ok((shells.len(), holes))
}

fn turn(surface: &mut Surface, shell: &[u32]) {
    shell.iter().for_each(|t| surface.triangles[*t as usize].swap(1, 2));
}

/// Orients each shell like its first triangle; returns the shells.
fn wind_alike(surface: &mut Surface, found: &Edges) -> Result<Vec<Vec<u32>>, SurfaceError> {
    let count = surface.triangles.len();
    let mut turned: Vec<Option<bool>> = vec![None; count];
    let original = surface.triangles.clone();
    let mut shells = Vec::new();
    for start in 0..count {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut shell = vec![start as u32];
        let mut next = 0;
        while let Some(&t) = shell.get(next) {
            next += 1;
            let own = turned[t as usize] == Some(true);
            let [a, b, c] = original[t as usize];
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let users = &found.users[&(from.min(to), from.max(to))];
                let (other, direction) = if users[0].0 == t { users[1] } else { users[0] };
                let wanted = own ^ (direction == (from < to));
                match turned[other as usize] {
                    None => {
                        turned[other as usize] = Some(wanted);
                        shell.push(other);
                    }
                    Some(is) if is != wanted => return Err(SurfaceError::OneSided(other as usize)),
                    Some(_) => {}
                }
            }
        }
        shell.sort_unstable();
        shells.push(shell);
    }
    for (t, turned) in turned.iter().enumerate() {
        if *turned == Some(true) {
            surface.triangles[t].swap(1, 2);
        }
    }
    Ok(shells)
}
