//! Precomputed gradients and volumes of all Gauss points.
//!
//! Memory per hex20: 3.9 kB (reduced) or 13.2 kB (full), twice that with mean dilatation; hex8 with modes 4
//! kB: a few per cent of the factor. Reading takes a fifth of recomputation.

use crate::assumed::modes::{self, Amplitudes};
use crate::element::{MAX_NODES, stiffness_points};
use crate::model::Model;

pub(crate) type Moved = [[f64; 3]; MAX_NODES];

#[derive(Clone, Copy, Debug)]
enum Volume {
    /// At the points.
    Pointwise,
    /// Constant in the element; start index.
    Mean(usize),
    /// Per point; start index.
    Projected(usize),
}

#[derive(Clone, Debug)]
pub(crate) struct PointTable {
    /// Shape `[elements + 1]`.
    start: Vec<u32>,
    /// Shape `[elements + 1]`.
    gradient_start: Vec<usize>,
    /// Gradients of nodes and modes [1/m] by element, point, term.
    gradients: Vec<[f64; 3]>,
    volume: Vec<f64>,
    /// Shape `[elements + 1]`.
    node_start: Vec<u32>,
    /// Shape `[elements]`.
    dilatation: Vec<Volume>,
    means: Vec<[f64; 3]>,
    /// Amplitude index, or [`NONE`]. Shape `[elements]`.
    modes: Vec<u32>,
    amplitudes: Vec<Amplitudes>,
}

const NONE: u32 = u32::MAX;

impl PointTable {
    pub fn new(model: &Model) -> PointTable {
        let mesh = model.mesh();
        let mut table = PointTable {
            start: vec![0],
            gradient_start: vec![0],
            gradients: Vec::new(),
            volume: Vec::with_capacity(model.point_count()),
            node_start: vec![0],
            dilatation: Vec::with_capacity(mesh.element_count()),
            means: Vec::new(),
            modes: Vec::with_capacity(mesh.element_count()),
            amplitudes: Vec::new(),
        };
        for e in 0..mesh.element_count() {
            let kind = mesh.connectivity.kind(e);
            let strains = model.element_strains(e);
            let (terms, first_mean) = (strains.terms(), table.means.len());
            let mut dilatation = Volume::Pointwise;
            for (i, point) in stiffness_points(kind, model.quadrature()).iter().enumerate() {
                let at = strains.at_point(point);
                table.gradients.extend_from_slice(&at.gradients[..terms]);
                table.volume.push(point.weight * at.determinant);
                if let Some(volume) = at.dilatation {
                    let mean = strains.has_mean_dilatation();
                    dilatation = if mean { Volume::Mean(first_mean) } else { Volume::Projected(first_mean) };
                    if i == 0 || !mean {
                        table.means.extend_from_slice(&volume[..terms]);
                    }
                }
            }
            table.dilatation.push(dilatation);
            table.modes.push(strains.internal().map_or(NONE, |_| table.amplitudes.len() as u32));
            table.amplitudes.extend(strains.internal().map(|i| *i.amplitudes()));
            table.start.push(table.volume.len() as u32);
            table.gradient_start.push(table.gradients.len());
            table.node_start.push(table.node_start[e] + kind.node_count() as u32);
        }
        table
    }

    #[inline]
    pub fn points(&self, e: usize) -> std::ops::Range<usize> {
        self.start[e] as usize..self.start[e + 1] as usize
    }

    /// Nodes of element `e`, concatenated.
    #[inline]
    pub fn nodes(&self, e: usize) -> std::ops::Range<usize> {
        self.node_start[e] as usize..self.node_start[e + 1] as usize
    }

    #[inline]
    fn terms(&self, e: usize) -> usize {
        self.nodes(e).len() + if self.modes[e] == NONE { 0 } else { modes::COUNT }
    }

    #[inline]
    pub fn amplitudes(&self, e: usize) -> Option<&Amplitudes> {
        self.amplitudes.get(self.modes[e] as usize)
    }

    #[inline]
    pub fn extend(&self, e: usize, u: &mut Moved) {
        if let Some(amplitudes) = self.amplitudes(e) {
            modes::extend(amplitudes, u);
        }
    }

    #[inline]
    pub fn condense(&self, e: usize, force: &mut Moved) {
        if let Some(amplitudes) = self.amplitudes(e) {
            modes::condense(amplitudes, force);
        }
    }

    /// Gradients of point `i`. Shape `[terms]`.
    #[inline]
    pub fn gradients(&self, e: usize, i: usize) -> &[[f64; 3]] {
        let terms = self.terms(e);
        &self.gradients[self.gradient_start[e] + i * terms..][..terms]
    }

    /// Volumetric gradients of point `i`; empty if pointwise. Shape `[terms]`.
    #[inline]
    pub fn means(&self, e: usize, i: usize) -> &[[f64; 3]] {
        match self.dilatation[e] {
            Volume::Pointwise => &[],
            Volume::Mean(first) => &self.means[first..][..self.terms(e)],
            Volume::Projected(first) => {
                let terms = self.terms(e);
                &self.means[first + i * terms..][..terms]
            }
        }
    }

    #[inline]
    pub fn volume(&self, point: usize) -> f64 {
        self.volume[point]
    }

    /// Strain (engineering shear) of displacements `u` [m].
    #[inline]
    pub fn strain(&self, e: usize, i: usize, u: &Moved) -> [f64; 6] {
        let mut s = [0.0; 6];
        for (g, u) in self.gradients(e, i).iter().zip(u) {
            s[0] += g[0] * u[0];
            s[1] += g[1] * u[1];
            s[2] += g[2] * u[2];
            s[3] += g[1] * u[0] + g[0] * u[1];
            s[4] += g[2] * u[1] + g[1] * u[2];
            s[5] += g[0] * u[2] + g[2] * u[0];
        }
        let means = self.means(e, i);
        if !means.is_empty() {
            let mean: f64 = means.iter().zip(u).map(|(m, u)| m[0] * u[0] + m[1] * u[1] + m[2] * u[2]).sum();
            let correction = (mean - s[0] - s[1] - s[2]) / 3.0;
            s[..3].iter_mut().for_each(|s| *s += correction);
        }
        s
    }

    /// Adds `dV B^T sigma` [N] of a point: transpose of [`PointTable::strain`].
    #[inline]
    pub fn add_force(&self, e: usize, i: usize, volume: f64, stress: &[f64; 6], force: &mut [[f64; 3]]) {
        let s = stress.map(|s| volume * s);
        let g = self.gradients(e, i);
        for (f, g) in force.iter_mut().zip(g) {
            f[0] += s[0] * g[0] + s[3] * g[1] + s[5] * g[2];
            f[1] += s[3] * g[0] + s[1] * g[1] + s[4] * g[2];
            f[2] += s[5] * g[0] + s[4] * g[1] + s[2] * g[2];
        }
        let means = self.means(e, i);
        if !means.is_empty() {
            let mean_stress = (s[0] + s[1] + s[2]) / 3.0;
            for ((f, g), m) in force.iter_mut().zip(g).zip(means) {
                for k in 0..3 {
                    f[k] += mean_stress * (m[k] - g[k]);
                }
            }
        }
    }
}
