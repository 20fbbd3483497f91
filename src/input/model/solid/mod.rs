//! Solid of a scene: mesh, materials, supports, loads.

mod analysis;
mod boundary;
mod clamped;
mod common;
mod conditioning;
mod equations;
mod geometry;
mod initial_stress;
mod load;
mod location;
mod locking;
mod material;
mod motion;
mod moving;
mod selection;
mod sleepers;

pub use analysis::{Analysis, NewtonPlan, QuasiStaticPlan, StrengthReductionPlan, TimeMethod};
pub use equations::EquationPlan;
pub use geometry::{Geometry, geometry};
pub use initial_stress::{InitialStressKind, InitialStressPlan};
pub use load::NodalLoad;
pub use location::Locator;
pub use selection::find_node;
pub use sleepers::SleeperBodies;

use crate::model::track::sleeper::MeshedSleepers;
use crate::scene::history::TimeFunction;
use crate::scene::solid::{Integration, Mass, Solid};
use crate::scene::{Document, SceneError, Table};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_io::failure::Failure;
use trackbed_io::mesh_tools;
use trackbed_io::read::MeshFile;

/// Resolved solid.
pub struct SolidPart {
    /// Model.
    pub model: fem::model::Model,
    /// Nodal loads without gravity.
    pub loads: Vec<NodalLoad>,
    /// Moving and recorded supports.
    pub supports: SupportPlan,
    /// Analysis of a solid-only model.
    pub analysis: Analysis,
    /// Initial stress.
    pub initial_stress: Option<InitialStressPlan>,
    /// Newton options.
    pub newton: NewtonPlan,
    /// Linear solvers.
    pub equations: EquationPlan,
    /// Reduction in a coupled model.
    pub reduction: Option<fem::reduction::Reduction>,
    /// Material names by number.
    pub material_names: BTreeMap<u32, String>,
    /// Reader warnings.
    pub warnings: Vec<String>,
    /// Meshed sleepers.
    pub sleepers: Option<SleeperBodies>,
    /// Whether the ground itself has weight.
    heavy_ground: bool,
}

/// Moving and recorded supports.
pub struct SupportPlan {
    /// Moving supports: index of fixed dof, displacement [m], time history.
    pub moving: Vec<(usize, f64, TimeFunction)>,
    /// Named supports and their dofs.
    pub named: Vec<(String, Vec<u32>)>,
    /// Constraint file, for messages.
    pub file: PathBuf,
}

impl SolidPart {
    /// Converts a solver error: input error if unsolvable, else numerical.
    pub fn failure(&self, error: &SolveError) -> Failure {
        let file = self.supports.file.display();
        match error {
            SolveError::NoStiffness { node, pivot, .. } if conditioning::is_poor(&self.model) => {
                Failure::Input(format!("{file}: {}", conditioning::message(&self.model, *node, *pivot)))
            }
            SolveError::RigidBodyMotion { .. } | SolveError::NoStiffness { .. } => Failure::Input(format!(
                "{file}: constraints: found too few ({error}), expected supports that prevent rigid-body motion"
            )),
            SolveError::Stopped => Failure::Interrupted("interrupted".into()),
            SolveError::Newmark(_) | SolveError::TimeStep { .. } | SolveError::Theta { .. } => {
                Failure::Input(error.to_string())
            }
            _ => Failure::Numerical(format!("solid: {error}")),
        }
    }

    /// Returns the weight [N], shape `[3·nodes]`.
    pub fn dead_load(&self, model: &fem::Model) -> Vec<f64> {
        let mut load = model.gravity_load();
        if let (Some(sleepers), false) = (&self.sleepers, self.heavy_ground) {
            load[..3 * sleepers.ground_nodes()].fill(0.0);
        }
        load
    }

    /// Returns the solid without its free sleepers, if any.
    ///
    /// # Errors
    /// As [`fem::Model::new`].
    pub fn ground(&self) -> Result<Option<fem::Model>, fem::ModelError> {
        let Some(sleepers) = &self.sleepers else { return Ok(None) };
        let (whole, nodes) = (self.model.mesh(), sleepers.ground_nodes());
        let mut mesh = fem::mesh::Mesh {
            node_ids: whole.node_ids[..nodes].to_vec(),
            coordinates: whole.coordinates[..nodes].to_vec(),
            ..fem::mesh::Mesh::default()
        };
        for e in 0..sleepers.ground_elements() {
            let (id, material) = (whole.element_ids[e], whole.materials[e]);
            mesh.push_element(id, material, whole.connectivity.kind(e), &whole.connectivity[e]);
        }
        let mut materials = self.model.materials().clone();
        materials.remove(&sleepers.material);
        let of_ground = |c: &&fem::mesh::Constraint| (c.node as usize) < nodes;
        let model = fem::Model::new(fem::ModelInput {
            mesh,
            materials,
            quadrature: self.model.quadrature(),
            assumed: self.model.assumed(),
            constraints: self.model.constraints().iter().filter(of_ground).copied().collect(),
            gravity: if self.heavy_ground { self.model.gravity() } else { [0.0; 3] },
            rayleigh: self.model.rayleigh(),
            mass: self.model.mass(),
            boundaries: self.model.boundaries().to_vec(),
            methods: self.model.methods(),
        })?;
        Ok(Some(model))
    }

    /// Adds all loads at time `t` [s], shape `[3·nodes]`.
    pub fn add_loads(&self, t: f64, load: &mut [f64]) {
        self.loads.iter().for_each(|l| l.add(t, load));
    }

    /// Sets support displacements at time `t` [m], by fixed dof.
    pub fn prescribe(&self, t: f64, values: &mut [f64]) {
        for (position, value, function) in &self.supports.moving {
            values[*position] = value * function.factor(t);
        }
    }

    /// Returns reaction sums by support name. Shape of `reactions` `[3·nodes]`.
    pub fn named_sums<'a>(&'a self, reactions: &'a [f64]) -> impl Iterator<Item = (&'a str, [f64; 3])> {
        self.supports.named.iter().map(|(name, dofs)| {
            let mut sum = [0.0; 3];
            for &dof in dofs {
                sum[dof as usize % 3] += reactions.get(dof as usize).copied().unwrap_or(0.0);
            }
            (name.as_str(), sum)
        })
    }

    /// Whether linear solvers apply: no yield surface, no initial stress.
    pub fn is_linear(&self) -> bool {
        self.model.is_linear() && self.initial_stress.is_none()
    }
}

/// Resolves `[solid]`. `coupled`: with grains; `sleepers`: meshed.
///
/// # Errors
/// Input errors.
pub fn build(
    document: &Document,
    solid: &Solid,
    gravity: [f64; 3],
    coupled: bool,
    sleepers: Option<MeshedSleepers>,
) -> Result<SolidPart, Failure> {
    let solid = &Table::top(document, "solid", solid);
    let geometry = geometry(solid)?;
    let mut materials = material::materials(solid)?;
    for (number, element) in geometry.mesh.materials.iter().zip(&geometry.mesh.element_ids) {
        if !materials.constants.contains_key(number) {
            let found = format!("no material {number}, which element {element} has");
            return Err(solid.error("material", found, "an entry with this id").into());
        }
    }
    let quadrature = quadrature(solid.integration);
    let assumed = locking::assumed(solid, &geometry.mesh)?;
    let loads = solid
        .rows("load", &solid.load)
        .map(|l| load::nodal_load(&l, &geometry))
        .collect::<Result<Vec<_>, _>>()?;
    let mut supports = boundary::supports(solid, &geometry)?;
    let boundaries = boundary::absorbing(solid, &geometry, &materials.constants)?;
    let linear = materials.constants.values().all(|m| m.is_linear());
    let plans = analysis::plans(solid, &materials, linear, coupled)?;
    initial_stress::check_overburden(solid, plans.initial_stress.as_ref(), &geometry.mesh, &materials)?;
    let Geometry { mut mesh, element_file, constraint_file, warnings, .. } = geometry;
    // Solvers tolerate some defects, such as an element inverted only at a corner.
    let faults = mesh_tools::check(&mesh, &supports.constraints);
    let inside_out = mesh_tools::all_inside_out(&mesh, &faults);
    let locking = locking::remarks(&mesh, &materials.constants, quadrature, assumed);
    let clamped = clamped::remarks(&mesh, &materials.constants, &supports.constraints);
    let faults = mesh_tools::sentences(&mesh, &faults);
    let warnings = warnings.into_iter().chain(faults).chain(locking).chain(clamped).collect();
    let weight = sleepers.as_ref().map_or(if solid.gravity { gravity } else { [0.0; 3] }, |s| s.gravity);
    let sleepers = sleepers
        .map(|plan| SleeperBodies::add(plan, &mut mesh, &mut materials.constants, &mut supports.constraints));
    if let Some(s) = &sleepers {
        materials.names.insert(s.material, "sleeper".into());
    }
    let equations = equations::plan(solid, &plans.analysis, linear, coupled, mesh.node_count())?;
    let model = fem::model::Model::new(fem::model::ModelInput {
        methods: equations.methods,
        mesh,
        materials: materials.constants,
        quadrature,
        assumed,
        mass: match solid.mass {
            Mass::Consistent => fem::Mass::Consistent,
            Mass::Lumped => fem::Mass::Lumped,
        },
        constraints: supports.constraints,
        boundaries,
        gravity: weight,
        rayleigh: motion::rayleigh(solid.optional("rayleigh", &solid.rayleigh))?,
    })
    .map_err(|e| refused(&element_file, &e, inside_out))?;
    let position = |dof: u32| {
        let fixed = model.supports().fixed();
        fixed.binary_search_by_key(&dof, |(d, _)| *d).expect("a support of the model")
    };
    let moving =
        supports.moving.iter().map(|(dof, (value, f))| (position(*dof), *value, f.clone())).collect();
    Ok(SolidPart {
        model,
        loads,
        supports: SupportPlan { moving, named: supports.named, file: constraint_file },
        analysis: plans.analysis,
        initial_stress: plans.initial_stress,
        newton: plans.newton,
        equations,
        reduction: motion::reduction(solid, linear, coupled)?,
        material_names: materials.names,
        warnings,
        sleepers,
        heavy_ground: solid.gravity,
    })
}

fn quadrature(integration: Integration) -> fem::Quadrature {
    match integration {
        Integration::Reduced => fem::Quadrature::Gauss2,
        Integration::Irons14 => fem::Quadrature::Irons14,
        Integration::Full => fem::Quadrature::Gauss3,
    }
}

/// Returns the mesh with constraints.
///
/// # Errors
/// As [`geometry`], and contradictory supports.
pub fn mesh_file(document: &Document, solid: &Solid) -> Result<MeshFile, Failure> {
    let solid = &Table::top(document, "solid", solid);
    let geometry = geometry(solid)?;
    let constraints = boundary::supports(solid, &geometry)?.constraints;
    let Geometry { mesh, node_sets, face_sets, element_types, warnings, .. } = geometry;
    Ok(MeshFile { mesh, constraints, node_sets, face_sets, element_types, warnings, ..MeshFile::default() })
}

fn refused(elements: &Path, error: &fem::ModelError, inside_out: Option<String>) -> SceneError {
    let (key, found, expected) = match error {
        fem::ModelError::Inverted { .. } if inside_out.is_some() => {
            ("mesh".into(), inside_out.unwrap_or_default(), "elements with a positive volume")
        }
        fem::ModelError::Inverted { element, point: [xi, eta, zeta], determinant } => (
            format!("element {element}"),
            format!(
                "a Jacobian determinant of {determinant:.6e} m3 at ({xi:.2}, {eta:.2}, {zeta:.2}): inverted or flat"
            ),
            "a determinant above 0",
        ),
        other => ("mesh".into(), other.to_string(), "a mesh that makes a model"),
    };
    SceneError::whole(elements, key, found, expected)
}
