//! Blocks of one element kind or of all kinds.

use crate::common::Random;
use trackbed_fem::{ElementKind, Mesh};

/// Filling of a block cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    /// One hexahedron.
    Hex,
    /// Two wedges along z, split by the diagonal of the bottom.
    Wedge,
    /// Six tetrahedra around the cell diagonal (Kuhn 1960).
    Tet,
    /// Central node joined to each face by a pyramid, or by two tetrahedra next to triangles.
    Pyramid,
}

pub fn cell_of(kind: ElementKind) -> Cell {
    match kind.linear() {
        ElementKind::Hex8 => Cell::Hex,
        ElementKind::Wedge6 => Cell::Wedge,
        ElementKind::Pyramid5 => Cell::Pyramid,
        _ => Cell::Tet,
    }
}

pub fn block(kind: ElementKind, counts: [usize; 3], size: [f64; 3]) -> Mesh {
    let mesh = cells(counts, size, |_| cell_of(kind));
    if kind.is_linear() { mesh } else { mesh.to_quadratic() }
}

/// 4 × 2 × 2 cells.
pub fn mixed(quadratic: bool) -> Mesh {
    let along = [Cell::Hex, Cell::Wedge, Cell::Pyramid, Cell::Tet];
    let mesh = cells([4, 2, 2], [2.0, 1.0, 1.0], |[i, _, _]| along[i]);
    if quadratic { mesh.to_quadratic() } else { mesh }
}

/// Linear elements of material 1.
pub fn cells(counts: [usize; 3], size: [f64; 3], cell: impl Fn([usize; 3]) -> Cell) -> Mesh {
    let nodes = counts.map(|n| n + 1);
    let mut mesh = Mesh::default();
    for k in 0..nodes[2] {
        for j in 0..nodes[1] {
            for i in 0..nodes[0] {
                let at = |i: usize, d: usize| size[d] * i as f64 / counts[d] as f64;
                mesh.coordinates.push([at(i, 0), at(j, 1), at(k, 2)]);
            }
        }
    }
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                fill(&mut mesh, [i, j, k], nodes, &|ijk| {
                    (0..3).all(|d| ijk[d] < counts[d]).then(|| cell(ijk))
                });
            }
        }
    }
    mesh.node_ids = (1..=mesh.node_count() as u32).collect();
    mesh
}

fn fill(mesh: &mut Mesh, ijk: [usize; 3], nodes: [usize; 3], cell: &dyn Fn([usize; 3]) -> Option<Cell>) {
    // Corner by its index 0 or 1 along each axis.
    let corner =
        |at: [usize; 3]| (((ijk[2] + at[2]) * nodes[1] + ijk[1] + at[1]) * nodes[0] + ijk[0] + at[0]) as u32;
    let place = ElementKind::Hex8.natural();
    let place = |c: usize| place[c].map(|x| usize::from(x > 0.0));
    let push = |mesh: &mut Mesh, kind: ElementKind, nodes: &[u32]| {
        let id = mesh.element_count() as u32 + 1;
        mesh.push_element(id, 1, kind, nodes);
    };
    match cell(ijk).expect("a cell of the block") {
        Cell::Hex => {
            let all: Vec<u32> = (0..8).map(|c| corner(place(c))).collect();
            push(mesh, ElementKind::Hex8, &all);
        }
        Cell::Wedge => {
            for triangle in [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]] {
                let at = |z: usize| triangle.map(|[x, y]| corner([x, y, z]));
                push(mesh, ElementKind::Wedge6, &[at(0), at(1)].concat());
            }
        }
        Cell::Tet => {
            for [a, b, even] in [[0, 1, 1], [1, 2, 1], [2, 0, 1], [1, 0, 0], [2, 1, 0], [0, 2, 0]] {
                let mut at = [0; 3];
                let mut path = vec![corner(at)];
                for axis in [a, b, 3 - a - b] {
                    at[axis] = 1;
                    path.push(corner(at));
                }
                if even == 0 {
                    path.swap(1, 2);
                }
                push(mesh, ElementKind::Tet4, &path);
            }
        }
        Cell::Pyramid => {
            let centre = mesh.coordinates.len() as u32;
            let ends = [corner([0; 3]), corner([1; 3])].map(|n| mesh.coordinates[n as usize]);
            mesh.coordinates.push(std::array::from_fn(|d| 0.5 * (ends[0][d] + ends[1][d])));
            for face in ElementKind::Hex8.faces() {
                let axis = (0..3).find(|&d| face.iter().all(|&c| place(c)[d] == place(face[0])[d])).unwrap();
                let mut neighbour = ijk;
                neighbour[axis] = (ijk[axis] + 2 * place(face[0])[axis]).wrapping_sub(1);
                let split = match cell(neighbour) {
                    Some(Cell::Tet) => true,
                    Some(Cell::Wedge) => axis == 2,
                    _ => false,
                };
                // From inside the order reverses; the lowest comes first.
                let mut around: Vec<[usize; 3]> = face.iter().rev().map(|&c| place(c)).collect();
                let lowest = (0..4).min_by_key(|&c| around[c].iter().sum::<usize>()).unwrap();
                around.rotate_left(lowest);
                let q: Vec<u32> = around.into_iter().map(corner).collect();
                if split {
                    push(mesh, ElementKind::Tet4, &[q[0], q[1], q[2], centre]);
                    push(mesh, ElementKind::Tet4, &[q[0], q[2], q[3], centre]);
                } else {
                    push(mesh, ElementKind::Pyramid5, &[q[0], q[1], q[2], q[3], centre]);
                }
            }
        }
    }
}

pub fn on_surface(mesh: &Mesh) -> Vec<bool> {
    let mut surface = vec![false; mesh.node_count()];
    for face in mesh.boundary_faces() {
        face.nodes().iter().for_each(|&n| surface[n as usize] = true);
    }
    surface
}

/// Moves chosen nodes randomly by up to `amount` [m] per axis.
pub fn distort(mesh: &mut Mesh, amount: f64, seed: u64, chosen: impl Fn(usize) -> bool) {
    let mut random = Random(seed);
    for n in 0..mesh.node_count() {
        let step = random.point();
        if chosen(n) {
            (0..3).for_each(|d| mesh.coordinates[n][d] += amount * step[d]);
        }
    }
}

/// Natural element of a kind.
pub fn single(kind: ElementKind) -> Mesh {
    let mut mesh = Mesh { coordinates: kind.natural().to_vec(), ..Mesh::default() };
    let nodes: Vec<u32> = (0..kind.node_count() as u32).collect();
    mesh.node_ids = nodes.iter().map(|n| n + 1).collect();
    mesh.push_element(1, 1, kind, &nodes);
    mesh
}
