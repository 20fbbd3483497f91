//! Basis vectors and matrices of a reduction.
//!
//! Theory manual: equation (4.19) of `docs/theory/solid.md`.

use super::orthonormal::{Orthonormal, orthonormal};
use super::{Estimate, MAX_SHAPES, OutOfBalance, Reduction, ReductionError};
use crate::loads;
use crate::mesh::Face;
use crate::modal;
use crate::model::Model;
use crate::newmark::check_density;
use crate::solver::kernels::{subtract_product, subtract_transposed};
use crate::state::{Coordinates, State};
use crate::statics::StaticSolver;
use crate::supports::CONSTRAINED;
use nalgebra::DMatrix;

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

/// Reduced solid with mass-orthonormal basis.
#[derive(Clone, Debug)]
pub struct ReducedModel {
    count: usize,
    /// V. Shape `[shapes][3 * nodes]`.
    pub(crate) shape: Vec<f64>,
    /// Squared circular frequencies [1/s²], ascending. Shape `[shapes]`.
    pub(crate) square: Vec<f64>,
    /// VᵀD V.
    pub(crate) dashpots: Option<DMatrix<f64>>,
    /// Free dofs of the contact surface, ascending.
    pub(crate) surface: Vec<u32>,
    estimate: Estimate,
}

impl ReducedModel {
    /// Predicts the values read per step, which determine the time.
    ///
    /// # Errors
    /// Failed analysis.
    pub fn cost(
        model: &Model,
        faces: &[Face],
        loaded: &[Face],
        reduction: Reduction,
    ) -> Result<Cost, ReductionError> {
        let rows = surface_dofs(model, faces).len();
        let shapes = match reduction {
            Reduction::Surface { modes } => surface_dofs(model, loaded).len() + modes,
            Reduction::Modes { modes } => 3 + loaded.len() + modes,
        };
        let demand = model.solver_demand(true)?;
        let blocks = model.matrices().stiffness_blocks().len() as f64;
        Ok(Cost {
            shapes,
            // Of the contact surface, for load and motion.
            reduced: 2.0 * (rows * shapes) as f64,
            // Factor twice; stiffness and mass for right-hand side and energy balance.
            full: 2.0 * demand.factor_len as f64 + 2.0 * 10.0 * blocks,
        })
    }

    /// Reduces a model with contact surface `faces`, of which contacts load those in `loaded`, and estimates the
    /// error.
    ///
    /// # Errors
    /// Plasticity, insufficient constraints, no density, no free surface dofs, too many basis vectors,
    /// unconverged modes.
    pub fn new(
        model: &Model,
        faces: &[Face],
        loaded: &[Face],
        reduction: Reduction,
    ) -> Result<ReducedModel, ReductionError> {
        check_density(model)?;
        let dofs = surface_dofs(model, loaded);
        let (statics, modes) = match reduction {
            Reduction::Surface { modes } => (dofs.len(), modes),
            Reduction::Modes { modes: 0 } => return Err(ReductionError::NoModes),
            Reduction::Modes { modes } => (3 + loaded.len(), modes),
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
        // Moved supports belong to the state, not to the basis.
        let still = vec![0.0; model.supports().fixed().len()];
        let mut columns = Vec::with_capacity(model.dof_count() * shapes);
        for load in static_loads(model, loaded, &dofs, reduction) {
            columns.extend(solver.solve_prescribed(model, &load, Some(&still))?.u);
        }
        if matches!(reduction, Reduction::Surface { .. }) {
            columns = surface_motions(&dofs, columns)?;
        }
        natural.shapes[..modes.min(natural.shapes.len())].iter().for_each(|s| columns.extend(s));
        let Orthonormal { shape, square, dashpots } = orthonormal(model, columns)?;
        let mut reduced = ReducedModel {
            count: square.len(),
            estimate: Estimate::of_frequencies(model, &square, &natural),
            shape,
            square,
            dashpots,
            surface: surface_dofs(model, faces).iter().map(|&d| d as u32).collect(),
        };
        let mut estimate = reduced.estimate;
        estimate.static_errors(model, loaded, &mut solver, &reduced)?;
        reduced.estimate = estimate;
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

    /// Vᵀ x. Shape `[shapes]`.
    pub(crate) fn project(&self, x: &[f64]) -> Vec<f64> {
        let mut negative = vec![0.0; self.count];
        subtract_transposed::<1>(&self.shape, x.len(), &mut negative, x);
        negative.iter().map(|q| -q).collect()
    }

    /// Coordinates of a motion that begins with `state`; velocity outside the basis is lost.
    pub(crate) fn coordinates(&self, model: &Model, state: &State) -> Coordinates {
        let mut momentum = vec![0.0; state.v.len()];
        model.mass_times(&state.v, &mut momentum);
        let velocity = self.project(&momentum);
        Coordinates { velocity, ..Coordinates::at_rest(state.u.clone(), self.count) }
    }

    /// Writes the motion of all dofs but those in `current`.
    pub(crate) fn recover(&self, state: &mut State, current: &[bool]) {
        let q = &state.reduced;
        if q.position.is_empty() {
            return;
        }
        let mut negative = vec![0.0; 3 * self.count];
        q.negate_into(&mut negative);
        let all = self.expand(&negative);
        for (d, &[u, v, a]) in all.as_chunks::<3>().0.iter().enumerate().filter(|(d, _)| !current[*d]) {
            state.u[d] = state.reduced.rest[d] + u;
            (state.v[d], state.a[d]) = (v, a);
        }
    }

    /// V of three vectors of coordinates, interleaved with opposite sign.
    fn expand(&self, negative: &[f64]) -> Vec<f64> {
        let n = self.shape.len() / self.count;
        let mut all = vec![0.0; 3 * n];
        subtract_product::<3>(&self.shape, n, negative, &mut all);
        all
    }

    /// Force that the basis leaves unbalanced by mean displacement, velocity, acceleration, see
    /// `expand`.
    pub(crate) fn out_of_balance(
        &self,
        model: &Model,
        state: &State,
        load: &[f64],
        negative: &[f64],
    ) -> OutOfBalance {
        let (n, c) = (load.len(), model.rayleigh());
        let all = self.expand(negative);
        let part = |k: usize| all.as_chunks::<3>().0.iter().map(move |x| x[k]);
        let (moved, v, a): (Vec<f64>, Vec<f64>, Vec<f64>) =
            (part(0).collect(), part(1).collect(), part(2).collect());
        let rest = &state.reduced.rest;
        let strained: Vec<f64> = (0..n).map(|d| rest[d] + moved[d] + c.beta_k * v[d]).collect();
        let pushed: Vec<f64> = (0..n).map(|d| a[d] + c.alpha_m * v[d]).collect();
        let mut force = load.to_vec();
        let mut product = vec![0.0; n];
        model.stiffness_times(&strained, &mut product);
        force.iter_mut().zip(&product).for_each(|(f, p)| *f -= p);
        model.mass_times(&pushed, &mut product);
        force.iter_mut().zip(&product).for_each(|(f, p)| *f -= p);
        product.fill(0.0);
        model.dashpot_times(&v, &mut product);
        force.iter_mut().zip(&product).for_each(|(f, p)| *f -= p);
        model.supports().fixed().iter().for_each(|(d, _)| force[*d as usize] = 0.0);
        OutOfBalance { force, moved }
    }
}

/// Static responses to unit forces on `dofs`, combined to unit displacements of them: columns of similar size.
fn surface_motions(dofs: &[usize], columns: Vec<f64>) -> Result<Vec<f64>, ReductionError> {
    let responses = DMatrix::from_vec(columns.len() / dofs.len(), dofs.len(), columns);
    let flexibility = DMatrix::from_fn(dofs.len(), dofs.len(), |i, k| responses[(dofs[i], k)]);
    let symmetric = 0.5 * (&flexibility + flexibility.transpose());
    let stiffness = symmetric.cholesky().ok_or(ReductionError::NotDefinite)?.inverse();
    Ok((responses * stiffness).data.into())
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
