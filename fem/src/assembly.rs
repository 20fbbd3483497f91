//! Assembles the global stiffness and mass matrices.
//!
//! Upper halves over node pairs (p, q), q >= p, by rows with one pattern: 3×3 stiffness blocks, scalar
//! masses, all dofs.
//!
//! Chunks of fixed size are added in element order, for bitwise reproducibility.

use crate::assumed::modes::{self, HEX8_TERMS};
use crate::assumed::{AssumedStrain, Dilatation, ElementStrains};
use crate::boundary::{BoundaryLayer, FaceMatrix};
use crate::element::quadrature::Quadrature;
use crate::element::{mass_points, on_kind, stiffness_points};
use crate::kinematics::{gradient_products, mass_matrix, mean_gradients, stiffness_block};
use crate::mass::{Mass, lump};
use crate::material::elastic::Elastic;
use crate::mesh::Mesh;
use crate::supports::{CONSTRAINED, Supports};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Fixed chunk size for reproducibility.
const CHUNK: usize = 128;

/// Stiffness and mass over all dofs, upper half by node pairs.
#[derive(Clone, Debug)]
pub struct Matrices {
    row_start: Vec<usize>,
    column: Vec<u32>,
    stiffness: Vec<[f64; 9]>,
    mass: Vec<f64>,
    lumped: Option<Lumped>,
    springs: FaceMatrix,
    dashpots: FaceMatrix,
    /// Slot of each dashpot block, ascending.
    dashpot_slots: Vec<usize>,
}

#[derive(Clone, Debug)]
struct Lumped {
    /// Diagonal [kg]. Shape `[nodes]`.
    diagonal: Vec<f64>,
    /// Row sums `∫ rho N_a dV` [kg]. Shape `[nodes]`.
    shares: Vec<f64>,
}

/// Factors of `stiffness K + mass M + dashpots D`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// Stiffness factor, springs included.
    pub stiffness: f64,
    /// Mass factor.
    pub mass: f64,
    /// Dashpot factor.
    pub dashpots: f64,
}

impl Combination {
    /// Stiffness only.
    pub const STIFFNESS: Combination = Combination { stiffness: 1.0, mass: 0.0, dashpots: 0.0 };
}

/// Common element formulation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Formulation {
    /// Stiffness integration rule.
    pub quadrature: Quadrature,
    /// Assumed strains.
    pub assumed: AssumedStrain,
    /// Consistent or lumped mass.
    pub mass: Mass,
}

struct ElementContribution {
    /// 3×3 stiffness block and mass of each pair.
    pairs: Vec<([f64; 9], f64)>,
    /// `∫ rho N_a dV` of each node, if the mass is lumped.
    shares: Vec<f64>,
}

impl Matrices {
    /// Assembles stiffness and consistent mass; `material_of` maps element indices.
    pub fn assemble<'m>(
        mesh: &Mesh,
        rule: Quadrature,
        material_of: impl Fn(usize) -> &'m Elastic + Sync,
    ) -> Matrices {
        let formulation = Formulation { quadrature: rule, ..Formulation::default() };
        Matrices::assemble_with(mesh, formulation, &[], |e| (material_of(e), false))
    }

    /// Assembles stiffness, mass, and boundary layers; `material_of` returns the material and whether it
    /// yields.
    pub fn assemble_with<'m>(
        mesh: &Mesh,
        formulation: Formulation,
        boundaries: &[BoundaryLayer],
        material_of: impl Fn(usize) -> (&'m Elastic, bool) + Sync,
    ) -> Matrices {
        let mass = formulation.mass;
        let mut matrices = Matrices::pattern(mesh);
        let mut shares = vec![0.0; if mass == Mass::Lumped { mesh.node_count() } else { 0 }];
        let elements: Vec<usize> = (0..mesh.element_count()).collect();
        for chunk in elements.chunks(CHUNK) {
            let contributions: Vec<ElementContribution> =
                chunk.par_iter().map(|&e| contribution(mesh, e, formulation, material_of(e))).collect();
            for (&e, contribution) in chunk.iter().zip(&contributions) {
                matrices.add(&mesh.connectivity[e], &contribution.pairs);
                for (&node, share) in mesh.connectivity[e].iter().zip(&contribution.shares) {
                    shares[node as usize] += share;
                }
            }
        }
        if mass == Mass::Lumped {
            matrices.lumped = Some(Lumped { diagonal: matrices.mass_diagonal(), shares });
        }
        matrices.springs = FaceMatrix::springs(mesh, boundaries);
        for ([p, q], block) in matrices.springs.entries() {
            let slot = slot(&matrices.row_start, &matrices.column, p, q);
            matrices.stiffness[slot].iter_mut().zip(block).for_each(|(k, s)| *k += s);
        }
        matrices.dashpots = FaceMatrix::dashpots(mesh, boundaries);
        matrices.dashpot_slots = matrices
            .dashpots
            .entries()
            .map(|([p, q], _)| slot(&matrices.row_start, &matrices.column, p, q))
            .collect();
        matrices
    }

    fn pattern(mesh: &Mesh) -> Matrices {
        let nodes = mesh.node_count();
        let mut elements_of = vec![Vec::new(); nodes];
        for (e, connectivity) in mesh.connectivity.iter().enumerate() {
            for &n in connectivity {
                elements_of[n as usize].push(e);
            }
        }
        let (mut row_start, mut column) = (vec![0], Vec::new());
        let mut row = Vec::new();
        for (p, elements) in elements_of.iter().enumerate() {
            row.clear();
            row.push(p as u32);
            for &e in elements {
                row.extend(mesh.connectivity[e].iter().filter(|&&q| q as usize > p));
            }
            row.sort_unstable();
            row.dedup();
            column.extend_from_slice(&row);
            row_start.push(column.len());
        }
        let entries = column.len();
        Matrices {
            row_start,
            column,
            stiffness: vec![[0.0; 9]; entries],
            mass: vec![0.0; entries],
            lumped: None,
            springs: FaceMatrix::default(),
            dashpots: FaceMatrix::default(),
            dashpot_slots: Vec::new(),
        }
    }

    fn add(&mut self, nodes: &[u32], pairs: &[([f64; 9], f64)]) {
        let mut pair = pairs.iter();
        for a in 0..nodes.len() {
            for b in a..nodes.len() {
                let Some((block, mass)) = pair.next() else { return };
                let (p, q) = (nodes[a].min(nodes[b]), nodes[a].max(nodes[b]));
                let slot = slot(&self.row_start, &self.column, p, q);
                self.mass[slot] += mass;
                let sum = &mut self.stiffness[slot];
                for i in 0..3 {
                    for j in 0..3 {
                        let transposed = nodes[a] > nodes[b];
                        sum[3 * i + j] += if transposed { block[3 * j + i] } else { block[3 * i + j] };
                    }
                }
            }
        }
    }

    /// Node count.
    pub fn node_count(&self) -> usize {
        self.row_start.len() - 1
    }

    /// Nodes q >= p that share an element with node `p`, ascending.
    pub fn row(&self, p: usize) -> &[u32] {
        &self.column[self.row_start[p]..self.row_start[p + 1]]
    }

    pub(crate) fn slot(&self, p: u32, q: u32) -> usize {
        let row = self.row_start[p as usize]..self.row_start[p as usize + 1];
        row.start + self.column[row].partition_point(|&c| c < q)
    }

    pub(crate) fn slots(&self, p: usize) -> std::ops::Range<usize> {
        self.row_start[p]..self.row_start[p + 1]
    }

    pub(crate) fn row_starts(&self) -> &[usize] {
        &self.row_start
    }

    pub(crate) fn row_of(&self, slot: usize) -> usize {
        self.row_start.partition_point(|&s| s <= slot) - 1
    }

    pub(crate) fn stiffness_blocks(&self) -> &[[f64; 9]] {
        &self.stiffness
    }

    /// Slots and blocks of the boundary dashpots [N s/m].
    pub(crate) fn dashpot_blocks(&self) -> impl Iterator<Item = (usize, &[f64; 9])> {
        self.dashpot_slots.iter().copied().zip(self.dashpots.entries().map(|(_, block)| block))
    }

    pub(crate) fn mass_entries(&self) -> &[f64] {
        &self.mass
    }

    /// `y = K x` [N]; `x` in m. Shapes `[3 * nodes]`.
    pub fn stiffness_times(&self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<3>().0, y.as_chunks_mut::<3>().0);
        y.fill([0.0; 3]);
        for (p, xp) in x.iter().enumerate() {
            let row = self.row_start[p]..self.row_start[p + 1];
            let mut sum = [0.0; 3];
            for (k, &q) in self.stiffness[row.clone()].iter().zip(&self.column[row]) {
                add_block(&mut sum, k, &x[q as usize]);
                if q as usize != p {
                    let w = &mut y[q as usize];
                    w[0] += k[0] * xp[0] + k[3] * xp[1] + k[6] * xp[2];
                    w[1] += k[1] * xp[0] + k[4] * xp[1] + k[7] * xp[2];
                    w[2] += k[2] * xp[0] + k[5] * xp[1] + k[8] * xp[2];
                }
            }
            add_scaled(&mut y[p], 1.0, &sum);
        }
    }

    /// `y = M x`. Shapes `[3 * nodes]`.
    pub fn mass_times(&self, x: &[f64], y: &mut [f64]) {
        let (x, y) = (x.as_chunks::<3>().0, y.as_chunks_mut::<3>().0);
        if let Some(lumped) = &self.lumped {
            for ((y, x), m) in y.iter_mut().zip(x).zip(&lumped.diagonal) {
                *y = x.map(|x| m * x);
            }
            return;
        }
        y.fill([0.0; 3]);
        for (p, xp) in x.iter().enumerate() {
            let row = self.row_start[p]..self.row_start[p + 1];
            let mut sum = [0.0; 3];
            for (&m, &q) in self.mass[row.clone()].iter().zip(&self.column[row]) {
                add_scaled(&mut sum, m, &x[q as usize]);
                if q as usize != p {
                    add_scaled(&mut y[q as usize], m, xp);
                }
            }
            add_scaled(&mut y[p], 1.0, &sum);
        }
    }

    /// `x·K x` [J], shape of x `[3 * nodes]`, at half the cost of a product.
    pub fn stiffness_form(&self, x: &[f64]) -> f64 {
        self.form(x, |row, columns, x, sum| {
            for (k, &q) in self.stiffness[row].iter().zip(columns) {
                add_block(sum, k, &x[q as usize]);
            }
        })
    }

    /// `x·M x` [J], shape of x `[3 * nodes]`, at half the cost of a product.
    pub fn mass_form(&self, x: &[f64]) -> f64 {
        if let Some(lumped) = &self.lumped {
            let square = |x: &[f64; 3]| x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
            return x.as_chunks::<3>().0.iter().zip(&lumped.diagonal).map(|(x, m)| m * square(x)).sum();
        }
        self.form(x, |row, columns, x, sum| {
            for (&m, &q) in self.mass[row].iter().zip(columns) {
                add_scaled(sum, m, &x[q as usize]);
            }
        })
    }

    /// Quadratic form from the upper half; `add(slots, columns, x, sum)` adds slot entries times x.
    #[inline]
    fn form(
        &self,
        x: &[f64],
        add: impl Fn(std::ops::Range<usize>, &[u32], &[[f64; 3]], &mut [f64; 3]),
    ) -> f64 {
        let x = x.as_chunks::<3>().0;
        let mut total = 0.0;
        for (p, xp) in x.iter().enumerate() {
            let (start, end) = (self.row_start[p], self.row_start[p + 1]);
            let (mut diagonal, mut above) = ([0.0; 3], [0.0; 3]);
            add(start..start + 1, &self.column[start..start + 1], x, &mut diagonal);
            add(start + 1..end, &self.column[start + 1..end], x, &mut above);
            for k in 0..3 {
                total += xp[k] * (diagonal[k] + 2.0 * above[k]);
            }
        }
        total
    }

    /// Diagonal of the mass matrix [kg]. Shape `[nodes]`.
    pub fn mass_diagonal(&self) -> Vec<f64> {
        self.row_start[..self.node_count()].iter().map(|&slot| self.mass[slot]).collect()
    }

    /// Columns and entries [kg] of a mass row, diagonal first.
    pub(crate) fn mass_row(&self, node: usize) -> impl Iterator<Item = (u32, f64)> {
        let row = self.row_start[node]..self.row_start[node + 1];
        let lumped = self.lumped.as_ref().map(|l| l.diagonal[node]);
        let entries = self.column[row.clone()].iter().zip(&self.mass[row]);
        entries.enumerate().map(move |(k, (&q, &m))| match lumped {
            Some(diagonal) => (q, if k == 0 { diagonal } else { 0.0 }),
            None => (q, m),
        })
    }

    /// Diagonal [kg] of a lumped mass. Shape `[nodes]`.
    pub fn lumped_mass(&self) -> Option<&[f64]> {
        self.lumped.as_ref().map(|l| l.diagonal.as_slice())
    }

    /// Row sums `∫ rho N_a dV` [kg] of a lumped mass. Shape `[nodes]`.
    pub fn lumped_fractions(&self) -> Option<&[f64]> {
        self.lumped.as_ref().map(|l| l.shares.as_slice())
    }

    /// Boundary springs, included in the stiffness.
    pub fn springs(&self) -> &FaceMatrix {
        &self.springs
    }

    /// Boundary dashpots.
    pub fn dashpots(&self) -> &FaceMatrix {
        &self.dashpots
    }

    /// Visits lower columns, rows ascending: `visit(column, row, stiffness, mass, dashpots)`, equation
    /// numbers.
    pub(crate) fn visit_free(&self, supports: &Supports, mut visit: impl FnMut(usize, usize, f64, f64, f64)) {
        let index = supports.free_index();
        for (column, &dof) in supports.free().iter().enumerate() {
            let (p, i) = (dof as usize / 3, dof as usize % 3);
            let row = self.row_start[p]..self.row_start[p + 1];
            let first_dashpot = self.dashpot_slots.partition_point(|&s| s < row.start);
            let mut dashpots = self.dashpot_slots[first_dashpot..].iter().zip(first_dashpot..).peekable();
            for (slot, &q) in row.clone().zip(&self.column[row]) {
                let q = q as usize;
                let first = if q == p { i } else { 0 };
                let dashpot = dashpots.next_if(|(s, _)| **s == slot).map(|(_, d)| self.dashpots.block(d));
                for j in first..3 {
                    let equation = index[3 * q + j];
                    if equation != CONSTRAINED {
                        let mass = if i == j { self.mass[slot] } else { 0.0 };
                        let dashpot = dashpot.map_or(0.0, |d| d[3 * i + j]);
                        visit(column, equation as usize, self.stiffness[slot][3 * i + j], mass, dashpot);
                    }
                }
            }
        }
    }
}

#[inline]
fn slot(row_start: &[usize], column: &[u32], p: u32, q: u32) -> usize {
    let row = row_start[p as usize]..row_start[p as usize + 1];
    row.start + column[row].partition_point(|&c| c < q)
}

#[inline]
fn add_block(sum: &mut [f64; 3], k: &[f64; 9], v: &[f64; 3]) {
    sum[0] += k[0] * v[0] + k[1] * v[1] + k[2] * v[2];
    sum[1] += k[3] * v[0] + k[4] * v[1] + k[5] * v[2];
    sum[2] += k[6] * v[0] + k[7] * v[1] + k[8] * v[2];
}

#[inline]
fn add_scaled(sum: &mut [f64; 3], factor: f64, v: &[f64; 3]) {
    for k in 0..3 {
        sum[k] += factor * v[k];
    }
}

fn contribution(
    mesh: &Mesh,
    element: usize,
    formulation: Formulation,
    material: (&Elastic, bool),
) -> ElementContribution {
    on_kind!(mesh.connectivity.kind(element), of_kind => {
        contribution_of::<{ of_kind::NODES }>(mesh, element, formulation, material)
    })
}

fn contribution_of<const N: usize>(
    mesh: &Mesh,
    element: usize,
    formulation: Formulation,
    (material, yields): (&Elastic, bool),
) -> ElementContribution {
    let Formulation { quadrature, assumed, mass } = formulation;
    let (coordinates, kind) = (mesh.element_coordinates(element), mesh.connectivity.kind(element));
    let mut masses = mass_matrix::<N>(&coordinates, mass_points(kind), material.density);
    let mut shares = Vec::new();
    if mass == Mass::Lumped {
        shares = masses.iter().map(|row| row.iter().sum()).collect();
        let diagonal = lump(&masses);
        masses = [[0.0; N]; N];
        (0..N).for_each(|a| masses[a][a] = diagonal[a]);
    }
    let points = stiffness_points(kind, quadrature);
    let (lambda, mu) = material.lame();
    let blocks = if assumed.has_modes(kind) {
        let strains = ElementStrains::new(kind, coordinates, points, assumed, material.poisson, yields);
        blocks_with_modes::<N>(&strains, lambda, mu)
    } else if kind.is_linear() {
        // B-bar: deviatoric part at the points, volumetric strain as its mean.
        let products = gradient_products::<N>(&coordinates, points);
        let (mean, volume) = mean_gradients(&coordinates, points);
        let bulk = (lambda + 2.0 / 3.0 * mu) * volume;
        upper_blocks::<N>(|a, b| {
            let mut block = stiffness_block(&products, -2.0 / 3.0 * mu, mu, a, b);
            for i in 0..3 {
                for j in 0..3 {
                    block[3 * i + j] += bulk * mean[a][i] * mean[b][j];
                }
            }
            block
        })
    } else if assumed.dilatation == Dilatation::Mean {
        let strains = ElementStrains::new(kind, coordinates, points, assumed, material.poisson, yields);
        let products = strains.products::<N>();
        upper_blocks::<N>(|a, b| strains.block(&products, lambda, mu, a, b))
    } else {
        let products = gradient_products::<N>(&coordinates, points);
        upper_blocks::<N>(|a, b| stiffness_block(&products, lambda, mu, a, b))
    };
    let masses = (0..N).flat_map(|a| masses[a][a..].iter().copied());
    ElementContribution { pairs: blocks.into_iter().zip(masses).collect(), shares }
}

fn upper_blocks<const N: usize>(block: impl Fn(usize, usize) -> [f64; 9]) -> Vec<[f64; 9]> {
    (0..N).flat_map(|a| (a..N).map(move |b| (a, b))).map(|(a, b)| block(a, b)).collect()
}

/// Blocks after elimination of the incompatible modes: `K_uu + K_uα A`.
fn blocks_with_modes<const N: usize>(strains: &ElementStrains, lambda: f64, mu: f64) -> Vec<[f64; 9]> {
    let products = strains.products::<HEX8_TERMS>();
    upper_blocks::<N>(|a, b| {
        let mut block = strains.block(&products, lambda, mu, a, b);
        for m in 0..modes::COUNT {
            let with = strains.block(&products, lambda, mu, a, N + m);
            let Some(amplitudes) = strains.internal().map(|i| &i.amplitudes()[m][b]) else { continue };
            for i in 0..3 {
                for j in 0..3 {
                    for k in 0..3 {
                        block[3 * i + j] += with[3 * i + k] * amplitudes[3 * k + j];
                    }
                }
            }
        }
        block
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrices(mesh: &Mesh) -> Matrices {
        let soil = Elastic { young: 5e7, poisson: 0.3, density: 1900.0 };
        Matrices::assemble(mesh, Quadrature::Gauss3, |_| &soil)
    }

    #[test]
    fn rigid_motions_have_inertia_only() {
        let mut mesh = Mesh::block([2, 2, 1], [2.0, 2.0, 1.0]);
        for c in &mut mesh.coordinates {
            *c = [c[0] + 0.1 * c[1] * c[2], c[1] - 0.1 * c[0], c[2] + 0.05 * c[0] * c[1]];
        }
        let m = matrices(&mesh);
        let dofs = 3 * mesh.node_count();
        let (mut force, mut momentum) = (vec![0.0; dofs], vec![0.0; dofs]);
        let volume: f64 = (0..mesh.element_count()).map(|e| mesh.element_volume(e)).sum();
        for motion in 0..6 {
            let x: Vec<f64> = mesh
                .coordinates
                .iter()
                .flat_map(|c| match motion {
                    0 => [1.0, 0.0, 0.0],
                    1 => [0.0, 1.0, 0.0],
                    2 => [0.0, 0.0, 1.0],
                    3 => [0.0, -c[2], c[1]],
                    4 => [c[2], 0.0, -c[0]],
                    _ => [-c[1], c[0], 0.0],
                })
                .collect();
            m.stiffness_times(&x, &mut force);
            assert!(force.iter().all(|f| f.abs() < 5e7 * 1e-13), "motion {motion}");
            if motion < 3 {
                m.mass_times(&x, &mut momentum);
                let total: f64 = momentum.iter().skip(motion).step_by(3).sum();
                assert!((total / (1900.0 * volume) - 1.0).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn products_agree_with_the_equation_matrix() {
        let mesh = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
        let m = matrices(&mesh);
        let supports = Supports::new(&mesh, &[]).unwrap();
        let n = 3 * mesh.node_count();
        let x: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        let (mut kx, mut mx) = (vec![0.0; n], vec![0.0; n]);
        m.stiffness_times(&x, &mut kx);
        m.mass_times(&x, &mut mx);
        let dot = |a: &[f64]| a.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>();
        assert!((m.stiffness_form(&x) / dot(&kx) - 1.0).abs() < 1e-13);
        assert!((m.mass_form(&x) / dot(&mx) - 1.0).abs() < 1e-13);
        m.visit_free(&supports, |column, row, k, mass, _| {
            kx[row] -= k * x[column];
            mx[row] -= mass * x[column];
            if row != column {
                kx[column] -= k * x[row];
                mx[column] -= mass * x[row];
            }
        });
        assert!(kx.iter().all(|v| v.abs() < 1e-6) && mx.iter().all(|v| v.abs() < 1e-10));
    }

    #[test]
    fn is_bitwise_independent_of_threads() {
        let mesh = Mesh::block([4, 4, 9], [1.0, 1.0, 2.0]);
        let bits = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let m = pool.install(|| matrices(&mesh));
            let k: Vec<u64> = m.stiffness.iter().flatten().map(|v| v.to_bits()).collect();
            (k, m.mass.iter().map(|v| v.to_bits()).collect::<Vec<_>>())
        };
        assert!(bits(1) == bits(2) && bits(1) == bits(3));
    }
}
