//! Nodal weights of a sleeper.

use super::ON_PLANE;
use crate::model::track::sleeper::MeshedSleepers;
use std::collections::BTreeMap;
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::Mesh;

/// Three-point Gauss rule on −1 to 1.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Elements along an axis on a line from `low` to `high`: number, natural coordinates and weights.
fn along_line(low: f64, high: f64, half: f64, count: usize) -> Vec<(usize, f64, f64)> {
    let step = 2.0 * half / count as f64;
    let begin = |i: usize| -half + i as f64 * step;
    if high - low <= ON_PLANE * half {
        let i = (((low + half) / step) as usize).min(count - 1);
        return vec![(i, 2.0 * (low - begin(i)) / step - 1.0, 1.0)];
    }
    let mut out = Vec::new();
    for i in 0..count {
        let (from, to) = (low.max(begin(i)), high.min(begin(i) + step));
        if to > from {
            for (xi, w) in GAUSS {
                let x = 0.5 * (from + to) + 0.5 * xi * (to - from);
                out.push((i, 2.0 * (x - begin(i)) / step - 1.0, 0.5 * w * (to - from) / (high - low)));
            }
        }
    }
    out
}

/// Pressure on the rail seats.
pub(super) fn seats(plan: &MeshedSleepers, mesh: &Mesh) -> Vec<(u32, f64)> {
    let [nx, ny, nz] = plan.elements;
    let mut shares: BTreeMap<u32, f64> = BTreeMap::new();
    for (seat, foot) in plan.seats.iter().zip(&plan.feet) {
        let [x, y] = [0, 1].map(|d| {
            let (low, high) = (seat[d] - 0.5 * foot[d], seat[d] + 0.5 * foot[d]);
            let (low, high) = (low.max(-plan.half[d]), high.min(plan.half[d]));
            along_line(low, high, plan.half[d], plan.elements[d])
        });
        for &(i, xi, wx) in &x {
            for &(j, eta, wy) in &y {
                let element = ((nz - 1) * ny + j) * nx + i;
                let n = ElementKind::Hex20.shape_functions([xi, eta, 1.0]);
                for (&node, n) in mesh.connectivity[element].iter().zip(n) {
                    *shares.entry(node).or_default() += n * wx * wy / plan.seats.len() as f64;
                }
            }
        }
    }
    shares.into_iter().filter(|(_, share)| *share != 0.0).collect()
}

/// Volume mean of equal bricks.
pub(super) fn volume(mesh: &Mesh) -> Vec<f64> {
    let mut shares = vec![0.0; mesh.node_count()];
    let count = mesh.element_count() as f64;
    for nodes in mesh.connectivity.iter() {
        for (k, &n) in nodes.iter().enumerate() {
            shares[n as usize] += if k < 8 { -1.0 / 8.0 } else { 1.0 / 6.0 } / count;
        }
    }
    shares
}

/// Mean base slope along an axis.
pub(super) fn slope(mesh: &Mesh, axis: usize) -> Vec<(u32, f64)> {
    let mut weights: BTreeMap<u32, f64> = BTreeMap::new();
    for face in mesh.boundary_faces() {
        let on_base = face.nodes().iter().all(|n| mesh.coordinates[*n as usize][2] == 0.0);
        if on_base {
            for (k, &n) in face.nodes().iter().enumerate() {
                *weights.entry(n).or_default() += if k < 4 { -1.0 / 12.0 } else { 1.0 / 3.0 };
            }
        }
    }
    let x = |n: u32| mesh.coordinates[n as usize][axis];
    let square: f64 = weights.iter().map(|(&n, w)| w * x(n) * x(n)).sum();
    weights.into_iter().map(|(n, w)| (n, w * x(n) / square)).collect()
}

/// Uplift of the base ends over the middle.
pub(super) fn bend(plan: &MeshedSleepers, mesh: &Mesh) -> Vec<(u32, f64)> {
    let axis = usize::from(plan.half[1] > plan.half[0]);
    let at = |place: f64| -> Vec<u32> {
        let on = |x: &[f64; 3]| x[2] == 0.0 && (x[axis].abs() - place).abs() <= ON_PLANE * plan.half[axis];
        (0..).zip(&mesh.coordinates).filter(|(_, x)| on(x)).map(|(n, _)| n).collect()
    };
    let (ends, middle) = (at(plan.half[axis]), at(0.0));
    let share = |nodes: Vec<u32>, sign: f64| {
        let each = sign / nodes.len() as f64;
        nodes.into_iter().map(move |n| (n, each))
    };
    share(ends, 1.0).chain(share(middle, -1.0)).collect()
}
