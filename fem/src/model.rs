//! Immutable model: mesh, materials, supports and assembled matrices.

mod checks;

use crate::assembly::{Combination, Formulation, Matrices};
use crate::assumed::{AssumedStrain, ElementStrains};
use crate::boundary::{self, BoundaryLayer};
use crate::damping::Rayleigh;
use crate::element::quadrature::Quadrature;
use crate::element::stiffness_points;
use crate::equations::method::{Method, Methods, Regime};
use crate::equations::system::{Equations, SystemSolver};
pub use crate::error::ModelError;
use crate::error::SolveError;
use crate::mass::Mass;
use crate::material::{Elastic, Material, Point, PointState, Points};
use crate::mesh::{Constraint, Mesh};
use crate::solver::analysis::Analysis;
use crate::supports::Supports;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Model input; default: empty mesh, reduced rule.
#[derive(Clone, Debug, Default)]
pub struct ModelInput {
    /// Mesh [m].
    pub mesh: Mesh,
    /// Materials by number.
    pub materials: BTreeMap<u32, Material>,
    /// Stiffness integration rule.
    pub quadrature: Quadrature,
    /// Assumed strains.
    pub assumed: AssumedStrain,
    /// Supports and prescribed displacements.
    pub constraints: Vec<Constraint>,
    /// Gravity [m/s²].
    pub gravity: [f64; 3],
    /// Rayleigh damping.
    pub rayleigh: Rayleigh,
    /// Consistent or lumped mass.
    pub mass: Mass,
    /// Springs and dashpots on faces.
    pub boundaries: Vec<BoundaryLayer>,
    /// Solution methods.
    pub methods: Methods,
}

/// Cost of a factorisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverDemand {
    /// Memory of factor and fronts [bytes].
    pub bytes: usize,
    /// Floating-point operations.
    pub flops: f64,
    /// Entries of a triangular factor.
    pub factor_len: usize,
}

/// Checked solid with its matrices.
#[derive(Clone, Debug)]
pub struct Model {
    mesh: Mesh,
    materials: BTreeMap<u32, Material>,
    quadrature: Quadrature,
    assumed: AssumedStrain,
    constraints: Vec<Constraint>,
    gravity: [f64; 3],
    rayleigh: Rayleigh,
    mass: Mass,
    boundaries: Vec<BoundaryLayer>,
    methods: Methods,
    supports: Supports,
    /// Shared by copies: independent of position.
    matrices: Arc<Matrices>,
    analysis: OnceLock<Arc<Analysis>>,
    /// First Gauss point per element. Shape `[elements + 1]`.
    point_start: Vec<u32>,
    /// First state value per element. Shape `[elements + 1]`.
    value_start: Vec<u32>,
}

impl Model {
    /// Checks the input and assembles the matrices.
    ///
    /// # Errors
    /// [`ModelError`]; rigid-body motion is checked by [`crate::statics`] only.
    pub fn new(input: ModelInput) -> Result<Model, ModelError> {
        let ModelInput {
            mesh,
            materials,
            quadrature,
            assumed,
            constraints,
            gravity,
            rayleigh,
            mass,
            boundaries,
            methods,
        } = input;
        checks::check_mesh(&mesh)?;
        checks::check_materials(&mesh, &materials)?;
        checks::check_shape(&mesh, quadrature)?;
        if gravity.iter().any(|g| !g.is_finite()) {
            return Err(ModelError::Gravity { gravity });
        }
        for (name, value) in [("alpha_m", rayleigh.alpha_m), ("beta_k", rayleigh.beta_k)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(ModelError::Damping { name, value });
            }
        }
        let supports = Supports::new(&mesh, &constraints)?;
        boundary::check(&mesh, &boundaries)?;
        let material = |e: usize| {
            let material = &materials[&mesh.materials[e]];
            (&material.elastic, !material.is_linear())
        };
        let formulation = Formulation { quadrature, assumed, mass };
        let matrices = Arc::new(Matrices::assemble_with(&mesh, formulation, &boundaries, material));
        let point_start = checks::point_start(&mesh, quadrature);
        let value_start = checks::value_start(&mesh, quadrature, &materials);
        Ok(Model {
            mesh,
            materials,
            quadrature,
            assumed,
            constraints,
            gravity,
            rayleigh,
            mass,
            boundaries,
            methods,
            supports,
            matrices,
            analysis: OnceLock::new(),
            point_start,
            value_start,
        })
    }

    /// Mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Materials by number.
    pub fn materials(&self) -> &BTreeMap<u32, Material> {
        &self.materials
    }

    /// Material of an element.
    pub fn material(&self, element: usize) -> &Material {
        &self.materials[&self.mesh.materials[element]]
    }

    /// Elastic constants and density of an element.
    pub fn elastic(&self, element: usize) -> &Elastic {
        &self.material(element).elastic
    }

    /// Whether all stresses are linear in strain, as linear solvers require.
    pub fn is_linear(&self) -> bool {
        self.plastic_material().is_none()
    }

    /// First plastic material number in use.
    pub fn plastic_material(&self) -> Option<u32> {
        let used = |number: &u32| self.mesh.materials.contains(number);
        self.materials.iter().find(|(number, m)| !m.is_linear() && used(number)).map(|(&number, _)| number)
    }

    /// Whether the tangent is always symmetric.
    pub fn symmetric_tangent(&self) -> bool {
        self.materials.values().all(Material::symmetric_tangent)
    }

    /// Replaces the material laws; elastic constants must be unchanged.
    ///
    /// # Errors
    /// Constant out of range or missing material.
    pub(crate) fn with_laws(&self, materials: BTreeMap<u32, Material>) -> Result<Model, ModelError> {
        checks::check_materials(&self.mesh, &materials)?;
        Ok(Model { materials, ..self.clone() })
    }

    /// Moves the bodies of `nodes` by `way` [m].
    ///
    /// # Panics
    /// If an element joins these nodes to others.
    pub fn with_displaced_bodies(&self, nodes: Range<usize>, way: [f64; 3]) -> Model {
        let inside = |n: &u32| nodes.contains(&(*n as usize));
        let whole = |e: &[u32]| e.iter().all(inside) || !e.iter().any(inside);
        assert!(self.mesh.connectivity.iter().all(whole), "only whole bodies can be moved");
        let mut moved = self.clone();
        for x in &mut moved.mesh.coordinates[nodes] {
            (0..3).for_each(|d| x[d] += way[d]);
        }
        moved
    }

    /// First Gauss point of an element in [`crate::State::points`], ordered as [`stiffness_points`].
    pub fn point_start(&self, element: usize) -> usize {
        self.point_start[element] as usize
    }

    /// State value range of point `i` of an element in [`Points::values`].
    #[inline]
    pub fn values(&self, element: usize, i: usize) -> Range<usize> {
        let (first, end) = (self.value_start[element] as usize, self.value_start[element + 1] as usize);
        if first == end {
            return first..end;
        }
        let count = (end - first) / (self.point_start(element + 1) - self.point_start(element));
        first + i * count..first + (i + 1) * count
    }

    /// Total number of state values.
    pub fn value_count(&self) -> usize {
        self.value_start[self.mesh.element_count()] as usize
    }

    /// Unstressed points with initial state values.
    pub fn new_points(&self) -> Points {
        let mut points = Points::new(self.point_count(), self.value_count());
        let (states, values) = points.split_mut();
        for e in 0..self.mesh.element_count() {
            for (i, p) in (self.point_start(e)..self.point_start(e + 1)).enumerate() {
                self.material(e).law.initial_values(
                    self.elastic(e),
                    &states[p].stress,
                    &mut values[self.values(e, i)],
                );
            }
        }
        points
    }

    /// Point `i` of an element.
    #[inline]
    pub fn point<'a>(&self, points: &'a Points, element: usize, i: usize) -> Point<'a> {
        let state: &PointState = &points[self.point_start(element) + i];
        Point::new(state, &points.values()[self.values(element, i)])
    }

    /// Distinct references of the nonlinear laws.
    pub fn law_sources(&self) -> Vec<&'static str> {
        let mut sources = Vec::new();
        for (number, material) in &self.materials {
            let source = material.law.source();
            if !material.is_linear() && self.mesh.materials.contains(number) && !sources.contains(&source) {
                sources.push(source);
            }
        }
        sources
    }

    /// Whether elastic steps always have the assembled matrix.
    pub fn has_constant_elasticity(&self) -> bool {
        self.materials.values().all(|m| m.law.has_constant_elasticity())
    }

    /// Number of Gauss points.
    pub fn point_count(&self) -> usize {
        self.point_start(self.mesh.element_count())
    }

    /// Stiffness integration rule.
    pub fn quadrature(&self) -> Quadrature {
        self.quadrature
    }

    /// Assumed strains.
    pub fn assumed(&self) -> AssumedStrain {
        self.assumed
    }

    /// Assumed strains of an element.
    pub fn element_strains(&self, element: usize) -> ElementStrains {
        let kind = self.mesh.connectivity.kind(element);
        let rule = stiffness_points(kind, self.quadrature);
        let (coordinates, material) = (self.mesh.element_coordinates(element), self.material(element));
        let (poisson, yields) = (material.elastic.poisson, !material.is_linear());
        ElementStrains::new(kind, coordinates, rule, self.assumed, poisson, yields)
    }

    /// Constraints as given.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Supports.
    pub fn supports(&self) -> &Supports {
        &self.supports
    }

    /// Damping constants.
    pub fn rayleigh(&self) -> Rayleigh {
        self.rayleigh
    }

    /// Consistent or lumped mass.
    pub fn mass(&self) -> Mass {
        self.mass
    }

    /// Springs and dashpots on faces.
    pub fn boundaries(&self) -> &[BoundaryLayer] {
        &self.boundaries
    }

    /// Solution methods of elastic equations.
    pub fn methods(&self) -> Methods {
        self.methods
    }

    /// Gravity [m/s²].
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity
    }

    /// Number of dofs, `3 * nodes`.
    pub fn dof_count(&self) -> usize {
        3 * self.mesh.node_count()
    }

    /// Number of free dofs.
    pub fn free_dof_count(&self) -> usize {
        self.supports.free().len()
    }

    /// Assembled matrices.
    pub fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// `y = K x` with boundary springs. Shapes `[3 * nodes]`.
    pub fn stiffness_times(&self, x: &[f64], y: &mut [f64]) {
        self.matrices.stiffness_times(x, y);
    }

    /// `y = M x`. Shapes `[3 * nodes]`.
    pub fn mass_times(&self, x: &[f64], y: &mut [f64]) {
        self.matrices.mass_times(x, y);
    }

    /// `y += K_s x` of the boundary springs, included in [`Model::stiffness_times`].
    pub fn boundary_spring_times(&self, x: &[f64], y: &mut [f64]) {
        self.matrices.springs().add_times(x, y);
    }

    /// `y += D v` of the boundary dashpots, without Rayleigh damping.
    pub fn dashpot_times(&self, v: &[f64], y: &mut [f64]) {
        self.matrices.dashpots().add_times(v, y);
    }

    /// Consistent gravity load `∫ rho N_a g dV` [N]. Shape `[3 * nodes]`.
    pub fn gravity_load(&self) -> Vec<f64> {
        if let Some(shares) = self.matrices.lumped_fractions() {
            return shares.iter().flat_map(|m| self.gravity.map(|g| m * g)).collect();
        }
        let uniform: Vec<f64> = self.gravity.iter().copied().cycle().take(self.dof_count()).collect();
        let mut load = vec![0.0; self.dof_count()];
        self.mass_times(&uniform, &mut load);
        load
    }

    /// Total mass [kg].
    pub fn total_mass(&self) -> f64 {
        (0..self.mesh.element_count()).map(|e| self.elastic(e).density * self.mesh.element_volume(e)).sum()
    }

    /// Predicts the cost of a factorisation.
    ///
    /// # Errors
    /// Failed analysis.
    pub fn solver_demand(&self, symmetric: bool) -> Result<SolverDemand, SolveError> {
        let analysis = self.analysis()?;
        Ok(SolverDemand {
            bytes: analysis.memory(symmetric),
            flops: analysis.flops() * if symmetric { 1.0 } else { 2.0 },
            factor_len: analysis.factor_len(),
        })
    }

    /// Predicts the memory of a method [bytes].
    ///
    /// # Errors
    /// Failed analysis; [`SolveError::Library`].
    pub fn solver_memory(&self, method: Method, regime: Regime) -> Result<usize, SolveError> {
        method.memory(&self.equations(Combination::STIFFNESS), regime)
    }

    pub(crate) fn equations(&self, combination: Combination) -> Equations<'_> {
        let Model { mesh, matrices, supports, analysis, .. } = self;
        Equations { mesh, matrices, supports, combination, analysis }
    }

    /// Solver for time steps.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`], [`SolveError::Library`], or out of memory.
    pub(crate) fn step_solver(&self, combination: Combination) -> Result<Box<dyn SystemSolver>, SolveError> {
        self.methods.dynamics.solver(&self.equations(combination), Regime::Dynamics)
    }

    pub(crate) fn analysis(&self) -> Result<Arc<Analysis>, SolveError> {
        self.equations(Combination::STIFFNESS).analysis()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input() -> ModelInput {
        ModelInput {
            mesh: Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]),
            materials: [(1, Elastic { young: 1e7, poisson: 0.3, density: 2000.0 }.into())].into(),
            quadrature: Quadrature::Gauss3,
            constraints: Vec::new(),
            gravity: [0.0, 0.0, -9.81],
            ..Default::default()
        }
    }

    fn refused(change: impl FnOnce(&mut ModelInput)) -> ModelError {
        let mut input = input();
        change(&mut input);
        Model::new(input).expect_err("the model is faulty")
    }

    #[test]
    fn faults_are_named() {
        assert!(matches!(refused(|i| i.mesh = Mesh::default()), ModelError::EmptyMesh { what: "nodes" }));
        let e = refused(|i| i.mesh.materials[1] = 7);
        assert_eq!(e, ModelError::MissingMaterial { element: 2, material: 7 });
        let e = refused(|i| i.materials.get_mut(&1).unwrap().elastic.poisson = 0.5);
        assert!(e.to_string().contains("Poisson's ratio is 0.5"), "{e}");
        let e = refused(|i| i.mesh.connectivity[1].swap(0, 6));
        assert!(
            matches!(e, ModelError::Inverted { element: 2, determinant, .. } if determinant <= 0.0),
            "{e}"
        );
        let e = refused(|i| i.mesh.connectivity[0][3] = i.mesh.connectivity[0][2]);
        assert!(matches!(e, ModelError::RepeatedNode { element: 1, .. }), "{e}");
        let e = refused(|i| {
            i.mesh.coordinates.push([9.0; 3]);
            i.mesh.node_ids.push(77);
        });
        assert_eq!(e, ModelError::UnusedNode { node: 77 });
        let e = refused(|i| i.mesh.connectivity[0][3] = 99);
        assert!(matches!(e, ModelError::NodeRange { index: 99, .. }), "{e}");
        assert!(matches!(
            refused(|i| i.mesh.coordinates[2][1] = f64::NAN),
            ModelError::Coordinate { node: 3 }
        ));
        assert!(matches!(refused(|i| i.gravity[0] = f64::INFINITY), ModelError::Gravity { .. }));
        assert!(matches!(refused(|i| i.rayleigh.beta_k = -1.0), ModelError::Damping { name: "beta_k", .. }));
        assert!(matches!(refused(|i| i.mesh.node_ids.truncate(3)), ModelError::Length { found: 3, .. }));
    }

    #[test]
    fn gravity_adds_up_to_the_weight() {
        let model = Model::new(input()).unwrap();
        let weight: f64 = model.gravity_load().iter().skip(2).step_by(3).sum();
        assert!(
            (weight / (-9.81 * 4000.0) - 1.0).abs() < 1e-14 && (model.total_mass() - 4000.0).abs() < 1e-9
        );
        assert_eq!((model.dof_count(), model.free_dof_count()), (96, 96));
    }
}
