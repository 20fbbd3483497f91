//! Internal force `f_a = ∫ sigma·g_a dV` with return mapping and assumed strains ([`crate::assumed`]).
//!
//! Fixed chunks are added in element order, for bitwise reproducibility.

use super::points::{Moved, PointTable};
use crate::element::MAX_NODES;
use crate::material::{Point, PointState, Points, ReturnError, ReturnRegion, UpdateContext};
use crate::mesh::Mesh;
use crate::model::Model;

const CHUNK: usize = 32;

/// Failed return: element (index) and local point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointFailure {
    pub element: usize,
    pub point: usize,
    pub cause: ReturnError,
}

pub(crate) struct InternalForce {
    pub table: PointTable,
    /// Trial state of the points. Shape `[points]`.
    pub points: Points,
    /// Region of each point. Shape `[points]`.
    pub regions: Vec<ReturnRegion>,
    /// Nodal forces [N]. Shape `[3 * nodes]`.
    pub force: Vec<f64>,
    pub plastic: usize,
    /// Start and length of the step [s].
    pub step: [f64; 2],
    element_force: Vec<[f64; 3]>,
}

struct Slice<'a> {
    first: usize,
    end: usize,
    points: &'a mut [PointState],
    values: &'a mut [f64],
    first_value: usize,
    regions: &'a mut [ReturnRegion],
    forces: &'a mut [[f64; 3]],
}

struct Input<'a> {
    model: &'a Model,
    table: &'a PointTable,
    old: &'a Points,
    increment: &'a [f64],
    step: [f64; 2],
}

/// Context of point `i` of element `e` in a step [start, length] [s].
#[inline]
pub(crate) fn context(mesh: &Mesh, [time, time_step]: [f64; 2], e: usize, i: usize) -> UpdateContext {
    UpdateContext { time, time_step, element: mesh.element_ids[e], point: i as u32 + 1 }
}

impl InternalForce {
    pub fn new(model: &Model) -> InternalForce {
        let points = model.point_count();
        InternalForce {
            table: PointTable::new(model),
            points: Points::new(points, model.value_count()),
            regions: vec![ReturnRegion::Elastic; points],
            force: vec![0.0; model.dof_count()],
            plastic: 0,
            step: [0.0; 2],
            element_force: vec![[0.0; 3]; model.mesh().connectivity.nodes().len()],
        }
    }

    /// Evaluates the increment `increment` [m] (shape `[3 * nodes]`) from `old`.
    pub fn evaluate(&mut self, model: &Model, old: &Points, increment: &[f64]) -> Result<(), PointFailure> {
        let input = Input { model, table: &self.table, old, increment, step: self.step };
        let (points, values) = self.points.split_mut();
        let all = Slice {
            first: 0,
            end: model.mesh().element_count(),
            points,
            values,
            first_value: 0,
            regions: &mut self.regions,
            forces: &mut self.element_force,
        };
        self.plastic = input.run(all)?;
        self.gather(model.mesh());
        Ok(())
    }

    /// Forces of given stresses, shape `[points]`.
    pub fn of_states(&mut self, model: &Model, states: &[PointState]) {
        for e in 0..model.mesh().element_count() {
            let mut forces = Moved::default();
            for (i, p) in self.table.points(e).enumerate() {
                self.table.add_force(e, i, self.table.volume(p), &states[p].stress, &mut forces);
            }
            self.table.condense(e, &mut forces);
            let of_nodes = &mut self.element_force[self.table.nodes(e)];
            of_nodes.copy_from_slice(&forces[..of_nodes.len()]);
        }
        self.gather(model.mesh());
    }

    fn gather(&mut self, mesh: &Mesh) {
        let force = self.force.as_chunks_mut::<3>().0;
        force.fill([0.0; 3]);
        for (f, &node) in self.element_force.iter().zip(mesh.connectivity.nodes()) {
            let sum = &mut force[node as usize];
            for k in 0..3 {
                sum[k] += f[k];
            }
        }
    }

    /// Whether element `e` has an inelastic tangent.
    pub fn leaves_elastic_matrix(&self, model: &Model, e: usize) -> bool {
        let yields = || self.regions[self.table.points(e)].iter().any(|r| *r != ReturnRegion::Elastic);
        !model.material(e).law.has_constant_elasticity() || (self.plastic > 0 && yields())
    }
}

impl Input<'_> {
    fn run(&self, slice: Slice<'_>) -> Result<usize, PointFailure> {
        let Slice { first, end, points, values, first_value, regions, forces } = slice;
        if end - first > CHUNK {
            let middle = first + (end - first) / 2;
            let (at, node) = (self.table.points(first).start, self.table.nodes(first).start);
            let (p, q) = points.split_at_mut(self.table.points(middle).start - at);
            let (r, s) = regions.split_at_mut(self.table.points(middle).start - at);
            let (f, g) = forces.split_at_mut(self.table.nodes(middle).start - node);
            let middle_value = self.model.values(middle, 0).start;
            let (v, w) = values.split_at_mut(middle_value - first_value);
            let low = Slice { first, end: middle, points: p, values: v, first_value, regions: r, forces: f };
            let high = Slice {
                first: middle,
                end,
                points: q,
                values: w,
                first_value: middle_value,
                regions: s,
                forces: g,
            };
            let (low, high) = rayon::join(|| self.run(low), || self.run(high));
            return Ok(low? + high?);
        }
        let (mut at, mut node, mut plastic) = (0, 0, 0);
        for e in first..end {
            let (p, n) = (self.table.points(e).len(), self.table.nodes(e).len());
            let (points, regions) = (&mut points[at..at + p], &mut regions[at..at + p]);
            let own = self.model.values(e, 0).start - first_value..;
            plastic += self.element(e, points, &mut values[own], regions, &mut forces[node..node + n])?;
            (at, node) = (at + p, node + n);
        }
        Ok(plastic)
    }

    fn element(
        &self,
        e: usize,
        points: &mut [PointState],
        values: &mut [f64],
        regions: &mut [ReturnRegion],
        forces: &mut [[f64; 3]],
    ) -> Result<usize, PointFailure> {
        let mut moved = element_increment(self.model.mesh(), e, self.increment);
        self.table.extend(e, &mut moved);
        let (material, at) = (self.model.material(e), self.table.points(e).start);
        let (linear, first_value) = (material.is_linear(), self.model.values(e, 0).start);
        let mut sums = Moved::default();
        let mut plastic = 0;
        for i in 0..points.len() {
            let (old, strain) = (&self.old[at + i], self.table.strain(e, i, &moved));
            if linear {
                let step = material.elastic.stress(&strain);
                points[i] = PointState { stress: std::array::from_fn(|k| old.stress[k] + step[k]), ..*old };
            } else {
                let own = self.model.values(e, i);
                let old = Point {
                    state: old,
                    values: &self.old.values()[own.clone()],
                    context: context(self.model.mesh(), self.step, e, i),
                };
                let new = &mut values[own.start - first_value..own.end - first_value];
                let response = material
                    .law
                    .update(&material.elastic, old, &strain, false, new)
                    .map_err(|cause| PointFailure { element: e, point: i, cause })?;
                (points[i], regions[i]) = (response.state, response.region);
                plastic += usize::from(response.region != ReturnRegion::Elastic);
            }
            self.table.add_force(e, i, self.table.volume(at + i), &points[i].stress, &mut sums);
        }
        self.table.condense(e, &mut sums);
        forces.copy_from_slice(&sums[..forces.len()]);
        if forces.iter().flatten().sum::<f64>().is_finite() {
            Ok(plastic)
        } else {
            Err(PointFailure { element: e, point: 0, cause: ReturnError::NotFinite })
        }
    }
}

#[inline]
pub(crate) fn element_increment(mesh: &Mesh, e: usize, increment: &[f64]) -> Moved {
    let mut moved = [[0.0; 3]; MAX_NODES];
    for (m, &n) in moved.iter_mut().zip(&mesh.connectivity[e]) {
        let n = 3 * n as usize;
        *m = [increment[n], increment[n + 1], increment[n + 2]];
    }
    moved
}
