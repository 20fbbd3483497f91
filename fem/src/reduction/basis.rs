//! Basis vectors and matrices of a reduction.
//!
//! Theory manual: equation (4.19) of `docs/theory/solid.md`.

use super::{Estimate, MAX_SHAPES, Reduction, ReductionError};
use crate::loads;
use crate::mesh::Face;
use crate::modal::{self, Modes};
use crate::model::Model;
use crate::newmark::check_density;
use crate::statics::StaticSolver;
use crate::supports::CONSTRAINED;
use nalgebra::{DMatrix, DVector};

/// Relative part of a dependent vector.
const DEPENDENT: f64 = 1e-7;
const COMPARED: usize = 10;

/// Values read per step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Basis vectors.
    pub shapes: usize,
    /// Reduced solid.
    pub reduced: f64,
    /// Full solid.
    pub full: f64,
}

/// Reduced solid with mass-orthonormal basis; rows are dofs.
#[derive(Clone, Debug)]
pub struct ReducedModel {
    count: usize,
    /// V. Shape `[3 * nodes][shapes]`.
    pub(crate) shape: Vec<f64>,
    /// K V. Shape `[3 * nodes][shapes]`.
    pub(crate) force: Vec<f64>,
    /// M V. Shape `[3 * nodes][shapes]`.
    pub(crate) momentum: Vec<f64>,
    /// Squared circular frequencies [1/s²], ascending. Shape `[shapes]`.
    pub(crate) square: Vec<f64>,
    /// VᵀD V.
    pub(crate) dashpots: Option<DMatrix<f64>>,
    estimate: Estimate,
}

impl ReducedModel {
    /// Predicts the values read per step, which determine the time.
    ///
    /// # Errors
    /// Failed analysis.
    pub fn cost(model: &Model, faces: &[Face], reduction: Reduction) -> Result<Cost, ReductionError> {
        let shapes = match reduction {
            Reduction::Surface { modes } => surface_dofs(model, faces).len() + modes,
            Reduction::Modes { modes } => 3 + faces.len() + modes,
        };
        let demand = model.solver_demand(true)?;
        let blocks = model.matrices().stiffness_blocks().len() as f64;
        Ok(Cost {
            shapes,
            // Vectors twice, their forces and momenta once.
            reduced: 4.0 * (model.dof_count() * shapes) as f64,
            // Factor twice; stiffness and mass for right-hand side and energy balance.
            full: 2.0 * demand.factor_len as f64 + 2.0 * 10.0 * blocks,
        })
    }

    /// Reduces a model with contact surface `faces` and estimates the error.
    ///
    /// # Errors
    /// Plasticity, insufficient constraints, no density, no free surface dofs, too many basis vectors,
    /// unconverged modes.
    pub fn new(model: &Model, faces: &[Face], reduction: Reduction) -> Result<ReducedModel, ReductionError> {
        check_density(model)?;
        let dofs = surface_dofs(model, faces);
        let (statics, modes) = match reduction {
            Reduction::Surface { modes } => (dofs.len(), modes),
            Reduction::Modes { modes: 0 } => return Err(ReductionError::NoModes),
            Reduction::Modes { modes } => (3 + faces.len(), modes),
        };
        let shapes = statics + modes;
        if dofs.is_empty() {
            return Err(ReductionError::NoSurface);
        }
        if shapes > MAX_SHAPES || 2 * shapes > model.free_dof_count() {
            return Err(ReductionError::TooMany { shapes, dofs: model.free_dof_count() });
        }
        let mut solver = StaticSolver::new(model)?;
        let natural = modal::solve(model, modes.max(COMPARED))?;
        let mut span = Span::new(model);
        for shape in &natural.shapes[..modes.min(natural.shapes.len())] {
            span.add(shape.clone());
        }
        for load in static_loads(model, faces, &dofs, reduction) {
            // Moved supports belong to the state, not to the basis.
            let zero = vec![0.0; model.supports().fixed().len()];
            span.add(solver.solve_prescribed(model, &load, Some(&zero))?.u);
        }
        let mut reduced = span.finish(&natural)?;
        reduced.estimate.static_errors(model, faces, &mut solver, &reduced.square, &reduced.shape)?;
        Ok(reduced)
    }

    /// Number of basis vectors.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Reduced frequencies [Hz], ascending. Shape `[shapes]`.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        self.square.iter().map(|s| s.sqrt() / std::f64::consts::TAU)
    }

    /// Error estimate.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }
}

fn surface_dofs(model: &Model, faces: &[Face]) -> Vec<usize> {
    let free = |dof: &usize| model.supports().free_index()[*dof] != CONSTRAINED;
    let mut dofs: Vec<usize> =
        faces.iter().flat_map(|f| f.nodes()).flat_map(|&n| (0..3).map(move |d| 3 * n as usize + d)).collect();
    dofs.sort_unstable();
    dofs.dedup();
    dofs.retain(free);
    dofs
}

/// Loads of static basis vectors. Shape `[loads][3 * nodes]`.
fn static_loads<'a>(
    model: &'a Model,
    faces: &'a [Face],
    dofs: &'a [usize],
    reduction: Reduction,
) -> Box<dyn Iterator<Item = Vec<f64>> + 'a> {
    let zero = || vec![0.0; model.dof_count()];
    match reduction {
        Reduction::Surface { .. } => Box::new(dofs.iter().map(move |&dof| {
            let mut load = zero();
            load[dof] = 1.0;
            load
        })),
        Reduction::Modes { .. } => {
            let uniform = (0..3).map(move |d| {
                let mut load = zero();
                let mut traction = [0.0; 3];
                traction[d] = 1.0;
                faces.iter().for_each(|f| loads::face_traction(model.mesh(), f, traction, &mut load));
                load
            });
            Box::new(uniform.chain(faces.iter().map(move |f| {
                let mut load = zero();
                loads::face_pressure(model.mesh(), f, 1.0, &mut load);
                load
            })))
        }
    }
}

struct Span<'m> {
    model: &'m Model,
    shapes: Vec<Vec<f64>>,
    momenta: Vec<Vec<f64>>,
}

impl<'m> Span<'m> {
    fn new(model: &'m Model) -> Span<'m> {
        Span { model, shapes: Vec::new(), momenta: Vec::new() }
    }

    /// Adds a vector by Gram–Schmidt, twice.
    fn add(&mut self, mut shape: Vec<f64>) {
        let mut momentum = vec![0.0; shape.len()];
        let norm = |model: &Model, x: &[f64], m: &mut [f64]| {
            model.mass_times(x, m);
            dot(x, m).max(0.0).sqrt()
        };
        let before = norm(self.model, &shape, &mut momentum);
        for _ in 0..2 {
            for (v, mv) in self.shapes.iter().zip(&self.momenta) {
                let part = dot(&shape, mv);
                shape.iter_mut().zip(v).for_each(|(x, v)| *x -= part * v);
            }
        }
        let after = norm(self.model, &shape, &mut momentum);
        if after <= DEPENDENT * before {
            return;
        }
        shape.iter_mut().for_each(|x| *x /= after);
        momentum.iter_mut().for_each(|x| *x /= after);
        self.shapes.push(shape);
        self.momenta.push(momentum);
    }

    fn finish(self, natural: &Modes) -> Result<ReducedModel, ReductionError> {
        let (n, count) = (self.model.dof_count(), self.shapes.len());
        let columns = DMatrix::from_fn(n, count, |d, k| self.shapes[k][d]);
        let images = |times: &dyn Fn(&[f64], &mut [f64])| {
            let mut out = DMatrix::zeros(n, count);
            for k in 0..count {
                let mut column = vec![0.0; n];
                times(columns.column(k).as_slice(), &mut column);
                out.set_column(k, &DVector::from_vec(column));
            }
            out
        };
        let forces = images(&|x, y| self.model.stiffness_times(x, y));
        let stiffness = columns.transpose() * &forces;
        let eigen = (0.5 * (&stiffness + stiffness.transpose())).symmetric_eigen();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let square: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
        if !square.iter().all(|s| *s > 0.0) {
            return Err(ReductionError::NotDefinite);
        }
        let turn = DMatrix::from_fn(count, count, |i, k| eigen.eigenvectors[(i, order[k])]);
        let shapes = &columns * &turn;
        let momenta = DMatrix::from_fn(n, count, |d, k| self.momenta[k][d]) * &turn;
        let dashpots = (!self.model.matrices().dashpots().is_empty()).then(|| {
            let mut damping = DMatrix::zeros(n, count);
            for k in 0..count {
                let mut column = vec![0.0; n];
                self.model.dashpot_times(shapes.column(k).as_slice(), &mut column);
                damping.set_column(k, &DVector::from_vec(column));
            }
            shapes.transpose() * damping
        });
        Ok(ReducedModel {
            count,
            force: by_rows(&(forces * &turn)),
            momentum: by_rows(&momenta),
            shape: by_rows(&shapes),
            estimate: Estimate::of_frequencies(self.model, &square, natural),
            square,
            dashpots,
        })
    }
}

fn by_rows(matrix: &DMatrix<f64>) -> Vec<f64> {
    matrix.transpose().as_slice().to_vec()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
