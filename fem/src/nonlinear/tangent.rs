//! Global tangent: elastic matrix plus `∫ B^T (D_ep - D) B dV` at yielding Gauss points.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 2, chapter 3. An elastic fraction removes singularity:
//! [`REGULARISATION`], or [`STABILISATION`] for stalled unsymmetric tangents, which cycle between sets of
//! yielding points.

use super::internal_force::{InternalForce, context, element_increment};
use crate::assembly::Combination;
use crate::assumed::modes::{self, Amplitudes};
use crate::element::MAX_NODES;
use crate::material::{Points, REGULARISATION, ReturnRegion};
use crate::model::Model;
use crate::supports::CONSTRAINED;

/// Elastic fraction of a stalled unsymmetric tangent; on footings, less stalls and more converges slowly.
const STABILISATION: f64 = 1e-2;

const ROWS: usize = 3 * MAX_NODES;
const ELEMENT: usize = ROWS * ROWS;
const CHUNK: usize = 64;
const TASK: usize = 8;
const NONE: u32 = u32::MAX;

pub(crate) struct Tangent {
    symmetric: bool,
    upper: Vec<[f64; 9]>,
    /// Transposed blocks (q, p); empty if symmetric.
    mirrored: Vec<[f64; 9]>,
    slot_start: Vec<u32>,
    slots: Vec<u32>,
    yielding: Vec<u32>,
    element: Vec<f64>,
}

impl Tangent {
    pub fn new(model: &Model) -> Tangent {
        let (mesh, matrices, symmetric) = (model.mesh(), model.matrices(), model.symmetric_tangent());
        let (mut slot_start, mut slots) = (Vec::new(), Vec::new());
        for (e, nodes) in mesh.connectivity.iter().enumerate() {
            if model.material(e).is_linear() {
                slot_start.push(NONE);
                continue;
            }
            slot_start.push(slots.len() as u32);
            for (a, &p) in nodes.iter().enumerate() {
                slots.extend(nodes[a..].iter().map(|&q| matrices.slot(p.min(q), p.max(q)) as u32));
            }
        }
        let blocks = matrices.stiffness_blocks().len();
        Tangent {
            symmetric,
            upper: vec![[0.0; 9]; blocks],
            mirrored: vec![[0.0; 9]; if symmetric { 0 } else { blocks }],
            slot_start,
            slots,
            yielding: Vec::with_capacity(mesh.element_count()),
            element: vec![0.0; CHUNK * ELEMENT],
        }
    }

    /// Whether the tangent is always symmetric.
    pub fn symmetric(&self) -> bool {
        self.symmetric
    }

    /// Sets `(1 + stiffness) K + mass M + dashpots D`, K with boundary springs.
    pub fn set_elastic(&mut self, model: &Model, linear: Combination) {
        let (matrices, factor) = (model.matrices(), 1.0 + linear.stiffness);
        for ((block, k), m) in
            self.upper.iter_mut().zip(matrices.stiffness_blocks()).zip(matrices.mass_entries())
        {
            *block = k.map(|k| factor * k);
            for i in 0..3 {
                block[4 * i] += linear.mass * m;
            }
        }
        if linear.dashpots != 0.0 {
            for (slot, dashpot) in matrices.dashpot_blocks() {
                self.upper[slot].iter_mut().zip(dashpot).for_each(|(b, d)| *b += linear.dashpots * d);
            }
        }
        self.mirrored.copy_from_slice(if self.symmetric { &[] } else { &self.upper });
    }

    /// Assembles the tangent at the trial `increment` from `old`.
    pub fn assemble(
        &mut self,
        model: &Model,
        force: &InternalForce,
        old: &Points,
        increment: &[f64],
        linear: Combination,
        stalled: bool,
    ) {
        let share = if stalled && !self.symmetric { STABILISATION } else { REGULARISATION };
        self.set_elastic(model, linear);
        let mut yielding = std::mem::take(&mut self.yielding);
        yielding.clear();
        let elements = 0..model.mesh().element_count();
        yielding.extend(
            elements
                .filter(|&e| self.slot_start[e] != NONE && force.leaves_elastic_matrix(model, e))
                .map(|e| e as u32),
        );
        let input = Input { model, force, old, increment, symmetric: self.symmetric, share };
        let mut buffer = std::mem::take(&mut self.element);
        for chunk in yielding.chunks(CHUNK) {
            input.run(chunk, &mut buffer[..chunk.len() * ELEMENT]);
            for (&e, matrix) in chunk.iter().zip(buffer.chunks_exact(ELEMENT)) {
                self.add(
                    &model.mesh().connectivity[e as usize],
                    self.slot_start[e as usize] as usize,
                    matrix,
                );
            }
        }
        (self.yielding, self.element) = (yielding, buffer);
    }

    fn add(&mut self, nodes: &[u32], first: usize, matrix: &[f64]) {
        let mut slots = self.slots[first..].iter();
        for a in 0..nodes.len() {
            for b in a..nodes.len() {
                let slot = slots.next().map_or(0, |s| *s as usize);
                let (p, q) = if nodes[a] <= nodes[b] { (a, b) } else { (b, a) };
                let upper = &mut self.upper[slot];
                if !self.symmetric {
                    let mirrored = &mut self.mirrored[slot];
                    for i in 0..3 {
                        for j in 0..3 {
                            upper[3 * i + j] += matrix[(3 * p + i) * ROWS + 3 * q + j];
                            mirrored[3 * i + j] += matrix[(3 * q + j) * ROWS + 3 * p + i];
                        }
                    }
                } else if p == a {
                    for i in 0..3 {
                        for j in 0..3 {
                            upper[3 * i + j] += matrix[(3 * a + i) * ROWS + 3 * b + j];
                        }
                    }
                } else {
                    for i in 0..3 {
                        for j in 0..3 {
                            upper[3 * i + j] += matrix[(3 * a + j) * ROWS + 3 * b + i];
                        }
                    }
                }
            }
        }
    }

    /// Writes free-dof entries in lower column order: `lower` (row, column); if unsymmetric, `upper` (column,
    /// row).
    pub fn write(&self, model: &Model, lower: &mut [f64], upper: &mut [f64]) {
        let (matrices, index) = (model.matrices(), model.supports().free_index());
        let mut at = 0;
        for &dof in model.supports().free() {
            let (p, i) = (dof as usize / 3, dof as usize % 3);
            for (slot, &q) in matrices.slots(p).zip(matrices.row(p)) {
                let q = q as usize;
                for j in if q == p { i } else { 0 }..3 {
                    if index[3 * q + j] != CONSTRAINED {
                        if self.symmetric {
                            lower[at] = self.upper[slot][3 * i + j];
                        } else {
                            lower[at] = self.mirrored[slot][3 * i + j];
                            upper[at] = self.upper[slot][3 * i + j];
                        }
                        at += 1;
                    }
                }
            }
        }
    }

    pub fn times(&self, model: &Model, x: &[f64], y: &mut [f64]) {
        let matrices = model.matrices();
        let (x, y) = (x.as_chunks::<3>().0, y.as_chunks_mut::<3>().0);
        y.fill([0.0; 3]);
        let mirrored = if self.symmetric { &self.upper } else { &self.mirrored };
        for (p, xp) in x.iter().enumerate() {
            let mut sum = [0.0; 3];
            for (slot, &q) in matrices.slots(p).zip(matrices.row(p)) {
                let (k, xq) = (&self.upper[slot], &x[q as usize]);
                for i in 0..3 {
                    sum[i] += k[3 * i] * xq[0] + k[3 * i + 1] * xq[1] + k[3 * i + 2] * xq[2];
                }
                if q as usize != p {
                    let (k, w) = (&mirrored[slot], &mut y[q as usize]);
                    for j in 0..3 {
                        w[j] += k[j] * xp[0] + k[3 + j] * xp[1] + k[6 + j] * xp[2];
                    }
                }
            }
            for i in 0..3 {
                y[p][i] += sum[i];
            }
        }
    }
}

struct Input<'a> {
    model: &'a Model,
    force: &'a InternalForce,
    old: &'a Points,
    increment: &'a [f64],
    symmetric: bool,
    share: f64,
}

impl Input<'_> {
    fn run(&self, elements: &[u32], matrices: &mut [f64]) {
        if elements.len() > TASK {
            let (low, high) = elements.split_at(elements.len() / 2);
            let (m, n) = matrices.split_at_mut(low.len() * ELEMENT);
            rayon::join(|| self.run(low, m), || self.run(high, n));
            return;
        }
        for (&e, matrix) in elements.iter().zip(matrices.chunks_exact_mut(ELEMENT)) {
            self.element(e as usize, matrix);
        }
    }

    /// Sum of `B^T (D_ep - D) B dV`; upper blocks only if symmetric.
    fn element(&self, e: usize, matrix: &mut [f64]) {
        let (table, material) = (&self.force.table, self.model.material(e));
        let mut moved = element_increment(self.model.mesh(), e, self.increment);
        table.extend(e, &mut moved);
        let (elastic, constant) = (material.elastic.matrix(), material.law.has_constant_elasticity());
        let mut values = vec![0.0; self.model.values(e, 0).len()];
        matrix.fill(0.0);
        for (i, p) in table.points(e).enumerate() {
            if constant && self.force.regions[p] == ReturnRegion::Elastic {
                continue;
            }
            // Succeeded for the force.
            let (mut old, strain) = (self.model.point(self.old, e, i), table.strain(e, i, &moved));
            old.context = context(self.model.mesh(), self.force.step, e, i);
            let Ok(response) = material.law.update(&material.elastic, old, &strain, true, &mut values) else {
                continue;
            };
            let factor = (1.0 - self.share) * table.volume(p);
            let d: [[f64; 6]; 6] = std::array::from_fn(|r| {
                std::array::from_fn(|c| factor * (response.tangent[r][c] - elastic[r][c]))
            });
            add_point(matrix, table.gradients(e, i), table.means(e, i), &d, self.symmetric);
        }
        if let Some(amplitudes) = table.amplitudes(e) {
            eliminate_modes(matrix, table.nodes(e).len(), amplitudes, self.symmetric);
        }
    }
}

/// Condenses the modes: `T^T K T`, `T = [1; A]`.
fn eliminate_modes(matrix: &mut [f64], nodes: usize, amplitudes: &Amplitudes, symmetric: bool) {
    let (first, end) = (3 * nodes, 3 * (nodes + modes::COUNT));
    if symmetric {
        for r in 1..end {
            (0..r).for_each(|c| matrix[r * ROWS + c] = matrix[c * ROWS + r]);
        }
    }
    let value = |row: usize, column: usize| amplitudes[row / 3][column / 3][3 * (row % 3) + column % 3];
    for r in 0..end {
        for c in 0..first {
            let sum: f64 = (0..end - first).map(|k| matrix[r * ROWS + first + k] * value(k, c)).sum();
            matrix[r * ROWS + c] += sum;
        }
    }
    for r in 0..first {
        for c in 0..first {
            let sum: f64 = (0..end - first).map(|k| value(k, r) * matrix[(first + k) * ROWS + c]).sum();
            matrix[r * ROWS + c] += sum;
        }
    }
}

/// Adds `B^T d B`; `means` give mean dilatation.
fn add_point(matrix: &mut [f64], g: &[[f64; 3]], means: &[[f64; 3]], d: &[[f64; 6]; 6], symmetric: bool) {
    let mut c = [[0.0; ROWS]; 6];
    for (r, d) in d.iter().enumerate() {
        for (b, g) in g.iter().enumerate() {
            c[r][3 * b] = d[0] * g[0] + d[3] * g[1] + d[5] * g[2];
            c[r][3 * b + 1] = d[1] * g[1] + d[3] * g[0] + d[4] * g[2];
            c[r][3 * b + 2] = d[2] * g[2] + d[4] * g[1] + d[5] * g[0];
        }
        let third = (d[0] + d[1] + d[2]) / 3.0;
        for (b, (m, g)) in means.iter().zip(g).enumerate() {
            for k in 0..3 {
                c[r][3 * b + k] += third * (m[k] - g[k]);
            }
        }
    }
    let end = 3 * g.len();
    for (a, g) in g.iter().enumerate() {
        let first = if symmetric { 3 * a } else { 0 };
        let rows = [[(0, 0), (3, 1), (5, 2)], [(1, 1), (3, 0), (4, 2)], [(2, 2), (4, 1), (5, 0)]];
        for (i, row) in rows.iter().enumerate() {
            let out = &mut matrix[(3 * a + i) * ROWS..][first..end];
            let [(x, gx), (y, gy), (z, gz)] = row.map(|(r, k)| (&c[r][first..end], g[k]));
            for (((out, x), y), z) in out.iter_mut().zip(x).zip(y).zip(z) {
                *out += gx * x + gy * y + gz * z;
            }
            if let Some(m) = means.get(a) {
                let third = (m[i] - g[i]) / 3.0;
                for (k, out) in out.iter_mut().enumerate() {
                    *out += third * (c[0][first + k] + c[1][first + k] + c[2][first + k]);
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "tangent_tests.rs"]
mod tests;
