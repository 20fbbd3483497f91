//! Discs of distributed load transfer (see [`distributed_transfer`](crate::distributed_transfer)).

use crate::distributed_transfer::{DistributedTransfer, EccentricDisc};
use crate::face::{Closest, Location, cross, dot};
use crate::surface::SolidSurface;
use std::collections::BTreeMap;

/// Gauss points in the squared radius with their area fractions.
const RINGS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Pairs of opposite points per ring.
const PAIRS: usize = 6;
/// Tolerated tangential distance from the surface, over the radius.
const MISSED: f64 = 1e-7;
/// Offset over the radius below which centroid and node coincide.
const CENTRED: f64 = 1e-14;

struct Point {
    patch: u32,
    natural: [f64; 2],
    place: [f64; 3],
    weight: f64,
}

impl SolidSurface {
    /// Distributes each contact force over a disc of `radius` [m]; zero disables it.
    pub fn distribute_over_discs(mut self, radius: f64) -> SolidSurface {
        self.spread = (radius > 0.0).then(|| operator(&self, radius));
        self
    }
}

fn operator(surface: &SolidSurface, radius: f64) -> DistributedTransfer {
    let n = surface.nodes().len();
    let border = border(surface);
    let normals = normals(surface);
    let mut spread = DistributedTransfer {
        radius,
        first: vec![0],
        weights: Vec::with_capacity(30 * n),
        eccentric: Vec::new(),
    };
    for i in 0..n as u32 {
        let x = surface.position(i);
        let points = disc(surface, x, normals[i as usize], &border, radius);
        let mut own: BTreeMap<u32, f64> = BTreeMap::new();
        let c = [0, 1, 2].map(|d| points.iter().map(|p| p.weight * p.place[d]).sum::<f64>());
        let arm = [0, 1, 2].map(|d| x[d] - c[d]);
        let centred = dot(arm, arm).sqrt() <= CENTRED * radius;
        let inverse = if centred { None } else { inertia(&points, c).and_then(|j| inverse(&j, radius)) };
        if centred || inverse.is_some() {
            for p in &points {
                let shape = surface.shape_functions(p.patch, p.natural);
                for (&node, s) in surface.face_nodes(p.patch).iter().zip(shape) {
                    *own.entry(node).or_default() += p.weight * s;
                }
            }
        } else {
            // Collinear points off the node: no couple restores the moment.
            own.insert(i, 1.0);
        }
        if let Some(inverse) = inverse {
            let mut levers: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
            for p in &points {
                let shape = surface.shape_functions(p.patch, p.natural);
                for (&node, s) in surface.face_nodes(p.patch).iter().zip(shape) {
                    let b = levers.entry(node).or_default();
                    (0..3).for_each(|d| b[d] += p.weight * s * (p.place[d] - c[d]));
                }
            }
            spread.eccentric.push(EccentricDisc {
                node: i,
                arm,
                inverse,
                levers: levers.into_iter().collect(),
            });
        }
        spread.weights.extend(own.into_iter().filter(|(_, w)| *w != 0.0));
        spread.first.push(spread.weights.len() as u32);
    }
    spread
}

/// Free sides of faces, split at mid-side nodes.
fn border(surface: &SolidSurface) -> Vec<[[f64; 3]; 2]> {
    let mut out = Vec::new();
    for patch in 0..surface.faces().len() as u32 {
        let nodes = surface.face_nodes(patch);
        let (x, corners) = (|k: usize| surface.position(nodes[k]), surface.shape(patch).corner_count());
        for side in (0..corners).filter(|&side| surface.on_border(patch, side)) {
            let [first, last] = [x(side), x((side + 1) % corners)];
            if nodes.len() > corners {
                let middle = x(corners + side);
                out.extend([[first, middle], [middle, last]]);
            } else {
                out.push([first, last]);
            }
        }
    }
    out
}

/// Area-weighted unit normals at the surface nodes.
fn normals(surface: &SolidSurface) -> Vec<[f64; 3]> {
    let mut out = vec![[0.0; 3]; surface.nodes().len()];
    for patch in 0..surface.faces().len() as u32 {
        let area = surface.area_vector(patch);
        for &n in surface.face_nodes(patch) {
            (0..3).for_each(|d| out[n as usize][d] += area[d]);
        }
    }
    out.into_iter().map(|n| n.map(|c| c / dot(n, n).sqrt())).collect()
}

fn disc(
    surface: &SolidSurface,
    x: [f64; 3],
    normal: [f64; 3],
    border: &[[[f64; 3]; 2]],
    radius: f64,
) -> Vec<Point> {
    let (across, squeeze) = nearest_border(x, normal, border, radius);
    let along = cross(across, normal);
    let mut points = Vec::with_capacity(RINGS.len() * PAIRS * 2);
    for (ring, (share, weight)) in RINGS.iter().enumerate() {
        for pair in 0..PAIRS {
            let angle = std::f64::consts::PI * (pair as f64 + 0.5 * (ring % 2) as f64) / PAIRS as f64;
            let (s, c) = libm::sincos(angle);
            let reach = radius * share.sqrt();
            let offset = [0, 1, 2].map(|d| reach * (c * along[d] + s * squeeze * across[d]));
            let both = |part: f64| {
                let at = |sign: f64| {
                    let point = [0, 1, 2].map(|d| x[d] + sign * part * offset[d]);
                    place(surface, point, radius)
                };
                Some([at(1.0)?, at(-1.0)?])
            };
            let found = both(1.0).or_else(|| {
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    if both(middle).is_some() { low = middle } else { high = middle }
                }
                both(low)
            });
            // The node lies on the surface, so the shortest pair does too.
            for (patch, closest) in found.into_iter().flatten() {
                points.push(Point {
                    patch,
                    natural: closest.natural,
                    place: closest.point,
                    weight: 0.5 * weight / PAIRS as f64,
                });
            }
        }
    }
    let sum: f64 = points.iter().map(|p| p.weight).sum();
    points.iter_mut().for_each(|p| p.weight /= sum);
    points
}

/// Surface point above or below `point`; `None` beyond the border.
fn place(surface: &SolidSurface, point: [f64; 3], radius: f64) -> Option<(u32, Closest)> {
    let (patch, closest) = surface.nearest(point, radius)?;
    let off = [0, 1, 2].map(|d| point[d] - closest.point[d]);
    let along = dot(off, closest.normal);
    let beside = [0, 1, 2].map(|d| off[d] - along * closest.normal[d]);
    let missed = dot(beside, beside).sqrt() > MISSED * radius;
    let outside = match closest.location {
        Location::Inside => false,
        Location::Side(side) => missed && surface.on_border(patch, side as usize),
        Location::Corner(_) => missed,
    };
    (!outside).then_some((patch, closest))
}

/// Tangential unit vector to the nearest border (arbitrary if none is near), and its distance over the
/// radius, at most 1.
fn nearest_border(x: [f64; 3], normal: [f64; 3], border: &[[[f64; 3]; 2]], radius: f64) -> ([f64; 3], f64) {
    let tangential = |v: [f64; 3]| {
        let along = dot(v, normal);
        let t = [0, 1, 2].map(|d| v[d] - along * normal[d]);
        let length = dot(t, t).sqrt();
        (t.map(|c| c / length), length)
    };
    let mut best = (radius, None);
    for [a, b] in border {
        let (side, r) = ([0, 1, 2].map(|d| b[d] - a[d]), [0, 1, 2].map(|d| x[d] - a[d]));
        let t = (dot(side, r) / dot(side, side)).clamp(0.0, 1.0);
        let to = [0, 1, 2].map(|d| t * side[d] - r[d]);
        let distance = dot(to, to).sqrt();
        if distance < best.0 {
            let (direction, length) = tangential(to);
            let near = length < 1e-9 * radius;
            best = (distance, Some(if near { tangential(cross(normal, side)).0 } else { direction }));
        }
    }
    let any = || {
        let axis = if normal[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        tangential(axis).0
    };
    let squeeze = best.0 / radius;
    (best.1.unwrap_or_else(any), if squeeze < 1e-9 { 0.0 } else { squeeze })
}

fn inertia(points: &[Point], c: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let mut j = [[0.0; 3]; 3];
    for p in points {
        let r = [0, 1, 2].map(|d| p.place[d] - c[d]);
        let r2 = dot(r, r);
        for a in 0..3 {
            for b in 0..3 {
                j[a][b] += p.weight * (if a == b { r2 } else { 0.0 } - r[a] * r[b]);
            }
        }
    }
    (points.len() > 2).then_some(j)
}

/// Inverse of a symmetric matrix; `None` for collinear points.
fn inverse(j: &[[f64; 3]; 3], radius: f64) -> Option<[[f64; 3]; 3]> {
    let rows = [cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])];
    let det = dot(j[0], rows[0]);
    (det > 1e-9 * radius.powi(6)).then(|| {
        // Transposed cofactors.
        [0, 1, 2].map(|a| [0, 1, 2].map(|b| rows[b][a] / det))
    })
}
