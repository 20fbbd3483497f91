//! The solid of a scene: mesh read, materials and loads resolved.

use crate::failure::Failure;
use crate::scene::history::TimeFunction;
use crate::scene::solid::{Integration, Rayleigh, Solid, SolidLoad, SolidLoadKind};
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use crate::{mesh_tools, read};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use trackbed_coupling::inverse_map;
use trackbed_fem as fem;
use trackbed_fem::mesh::{Face, Mesh};
use trackbed_fem::solver::SolveError;

/// The solid, ready to run.
pub struct SolidPart {
    /// Checked model.
    pub model: fem::model::Model,
    /// Nodal loads other than gravity, each with its course in time.
    pub loads: Vec<NodalLoad>,
    /// File of the constraints, for messages.
    pub constraint_file: PathBuf,
    /// Newmark's method, for a solid that runs alone and dynamically.
    pub newmark: Option<fem::newmark::Newmark>,
    /// Names of the materials by number, for reports.
    pub material_names: BTreeMap<u32, String>,
    /// Remarks of the readers.
    pub warnings: Vec<String>,
}

/// A load pattern and how it varies in time.
pub struct NodalLoad {
    /// (degree of freedom, force [N]) pairs.
    pub entries: Vec<(usize, f64)>,
    /// Factor against time.
    pub function: TimeFunction,
}

impl NodalLoad {
    /// Adds the load at time `t` [s] to `load`, shape `[3·nodes]`.
    pub fn add(&self, t: f64, load: &mut [f64]) {
        let factor = self.function.factor(t);
        if factor != 0.0 {
            for &(dof, value) in &self.entries {
                load[dof] += factor * value;
            }
        }
    }
}

impl SolidPart {
    /// A failure of a solver: bad input when the model cannot be solved by anyone, else numerical.
    pub fn failure(&self, error: &SolveError) -> Failure {
        let file = self.constraint_file.display();
        match error {
            SolveError::NotHeld { .. } | SolveError::NoStiffness { .. } => Failure::Input(format!(
                "{file}: constraints: found too few ({error}), expected a body that is held"
            )),
            SolveError::Newmark(_) | SolveError::TimeStep { .. } | SolveError::Theta { .. } => {
                Failure::Input(error.to_string())
            }
            _ => Failure::Numerical(format!("solid: {error}")),
        }
    }

    /// Adds all loads at time `t` [s] to `load`, shape `[3·nodes]`.
    pub fn add_loads(&self, t: f64, load: &mut [f64]) {
        self.loads.iter().for_each(|l| l.add(t, load));
    }
}

/// Reads the mesh of a scene's solid.
///
/// # Errors
/// A list is missing, unreadable or contradictory.
pub fn read_mesh(document: &Document, solid: &Solid) -> Result<read::Lists, Failure> {
    let constraints = solid.constraints.as_ref().map(|c| document.resolve(c));
    read::read_lists(
        &document.resolve(&solid.nodes),
        &document.resolve(&solid.elements),
        constraints.as_deref(),
        &solid.layout,
    )
    .map_err(|e| Failure::Input(e.to_string()))
}

/// Resolves `[solid]`.
///
/// # Errors
/// Bad input in the scene or in the mesh files.
pub fn build(document: &Document, solid: &Solid, gravity: [f64; 3]) -> Result<SolidPart, Failure> {
    let lists = read_mesh(document, solid)?;
    let mut materials = BTreeMap::new();
    let mut material_names = BTreeMap::new();
    for (i, m) in solid.material.iter().enumerate() {
        let key = |k: &str| format!("solid.material.{i}.{k}");
        check(document, &key("young"), m.young.si, m.young.si > 0.0, "a modulus above 0")?;
        check(
            document,
            &key("poisson"),
            m.poisson,
            m.poisson > -1.0 && m.poisson < 0.5,
            "above -1 and below 0.5",
        )?;
        check(document, &key("density"), m.density.si, m.density.si > 0.0, "a density above 0")?;
        let elastic =
            fem::material::elastic::Elastic { young: m.young.si, poisson: m.poisson, density: m.density.si };
        if materials.insert(m.id, elastic.into()).is_some() {
            return Err(document
                .error(&key("id"), format!("material {} again", m.id), "each number once")
                .into());
        }
        let name = if m.name.is_empty() { format!("material {}", m.id) } else { m.name.clone() };
        material_names.insert(m.id, name);
    }
    for (number, element) in lists.mesh.materials.iter().zip(&lists.mesh.element_ids) {
        if !materials.contains_key(number) {
            let found = format!("no material {number}, which element {element} has");
            return Err(document.error("solid.material", found, "an entry with this id").into());
        }
    }
    let quadrature = match solid.integration {
        Integration::Reduced => fem::element::quadrature::Quadrature::Gauss2,
        Integration::Irons14 => fem::element::quadrature::Quadrature::Irons14,
        Integration::Full => fem::element::quadrature::Quadrature::Gauss3,
    };
    let loads = solid
        .load
        .iter()
        .enumerate()
        .map(|(i, l)| nodal_load(document, &lists.mesh, i, l))
        .collect::<Result<Vec<_>, _>>()?;
    let newmark = match &solid.dynamics {
        None => None,
        Some(d) => {
            let method = fem::newmark::Newmark { alpha: d.alpha, delta: d.delta };
            let checked = if d.accept_conditional_stability { method.check_range() } else { method.check() };
            checked.map_err(|e| document.error("solid.dynamics", e.to_string(), "stable constants"))?;
            Some(method)
        }
    };
    let model = fem::model::Model::new(fem::model::ModelInput {
        mesh: lists.mesh,
        materials,
        quadrature,
        constraints: lists.constraints,
        gravity: if solid.gravity { gravity } else { [0.0; 3] },
        rayleigh: rayleigh(document, solid.rayleigh.as_ref())?,
        ..Default::default()
    })
    .map_err(|e| refused(&document.resolve(&solid.elements), &e))?;
    // Faults that a solver can live with, such as an element turned inside out at a corner only, are said aloud.
    let faults = mesh_tools::check(model.mesh(), model.constraints());
    let warnings = lists.warnings.into_iter().chain(faults.iter().map(ToString::to_string)).collect();
    let constraint_file = document.resolve(solid.constraints.as_deref().unwrap_or(&solid.elements));
    Ok(SolidPart { model, loads, newmark, constraint_file, material_names, warnings })
}

/// What is wrong with the mesh, which shows only when its model is made.
fn refused(elements: &Path, error: &fem::ModelError) -> SceneError {
    let (key, found, expected) = match error {
        fem::ModelError::Inverted { element, point: [xi, eta, zeta], determinant } => (
            format!("element {element}"),
            format!(
                "a Jacobian determinant of {determinant:.6e} m3 at ({xi:.2}, {eta:.2}, {zeta:.2}): inverted or flat"
            ),
            "a determinant above 0",
        ),
        other => ("mesh".into(), other.to_string(), "a mesh that makes a model"),
    };
    SceneError { file: elements.to_path_buf(), line: None, key, found, expected: expected.into() }
}

fn check(document: &Document, key: &str, value: f64, good: bool, expected: &str) -> Result<(), SceneError> {
    if good { Ok(()) } else { Err(document.error(key, value.to_string(), expected)) }
}

fn rayleigh(document: &Document, rayleigh: Option<&Rayleigh>) -> Result<fem::damping::Rayleigh, SceneError> {
    let Some(r) = rayleigh else { return Ok(fem::damping::Rayleigh { alpha_m: 0.0, beta_k: 0.0 }) };
    let result = match (r.alpha_m, r.beta_k, r.damping_ratio, r.frequencies) {
        (alpha, beta, None, None) => {
            for (name, value) in [("alpha_m", alpha.map(|a| a.si)), ("beta_k", beta.map(|b| b.si))] {
                let value = value.unwrap_or(0.0);
                check(document, &format!("solid.rayleigh.{name}"), value, value >= 0.0, "0 or more")?;
            }
            fem::damping::Rayleigh {
                alpha_m: alpha.map_or(0.0, |a| a.si),
                beta_k: beta.map_or(0.0, |b| b.si),
            }
        }
        (None, None, Some(ratio), Some([f1, f2])) => {
            check(
                document,
                "solid.rayleigh.damping_ratio",
                ratio,
                (0.0..1.0).contains(&ratio),
                "0 or more, below 1",
            )?;
            let good = f1.si > 0.0 && f2.si > f1.si;
            if !good {
                let found = format!("{} and {} Hz", f1.si, f2.si);
                return Err(document.error(
                    "solid.rayleigh.frequencies",
                    found,
                    "two rising positive frequencies",
                ));
            }
            fem::damping::Rayleigh::from_frequencies([f1.si, f2.si], [ratio, ratio])
                .map_err(|e| document.error("solid.rayleigh", e.to_string(), "other frequencies"))?
        }
        _ => {
            return Err(document.error(
                "solid.rayleigh",
                "a mixture of keys",
                "either alpha_m and beta_k, or damping_ratio and frequencies",
            ));
        }
    };
    check(document, "solid.rayleigh.alpha_m", result.alpha_m, result.alpha_m >= 0.0, "0 or more")?;
    check(document, "solid.rayleigh.beta_k", result.beta_k, result.beta_k >= 0.0, "0 or more")?;
    Ok(result)
}

fn nodal_load(
    document: &Document,
    mesh: &Mesh,
    index: usize,
    load: &SolidLoad,
) -> Result<NodalLoad, SceneError> {
    let key = |k: &str| format!("solid.load.{index}.{k}");
    let needs =
        |k: &str, kind: &str| document.error(&key(k), "nothing", format!("a value for a {kind} load"));
    let refuse = |k: &str, present: bool| {
        if present {
            Err(document.error(&key(k), "a value", "no such key for this kind of load"))
        } else {
            Ok(())
        }
    };
    let function = match &load.history {
        None => TimeFunction::CONSTANT,
        Some(h) => TimeFunction::new(h)
            .map_err(|(k, found, expected)| document.error(&key(&format!("history.{k}")), found, expected))?,
    };
    let mut pattern = vec![0.0; 3 * mesh.node_count()];
    match load.kind {
        SolidLoadKind::Pressure | SolidLoadKind::Traction => {
            let pressure = load.kind == SolidLoadKind::Pressure;
            refuse(
                if pressure { "traction" } else { "pressure" },
                if pressure { load.traction.is_some() } else { load.pressure.is_some() },
            )?;
            refuse("node", load.node.is_some())?;
            refuse("at", load.at.is_some())?;
            refuse("force", load.force.is_some())?;
            for face in &loaded_faces(document, mesh, index, load)? {
                if pressure {
                    let p = load.pressure.ok_or_else(|| needs("pressure", "pressure"))?.si;
                    fem::loads::face_pressure(mesh, face, p, &mut pattern);
                } else {
                    let t = vector(&load.traction.ok_or_else(|| needs("traction", "traction"))?);
                    fem::loads::face_traction(mesh, face, t, &mut pattern);
                }
            }
        }
        SolidLoadKind::Point => {
            refuse("faces", load.faces.is_some())?;
            refuse("faces_in", load.faces_in.is_some())?;
            refuse("pressure", load.pressure.is_some())?;
            refuse("traction", load.traction.is_some())?;
            let force = vector(&load.force.ok_or_else(|| needs("force", "point"))?);
            match (load.node, load.at) {
                (Some(id), None) => {
                    let node = find_node(document, mesh, &key("node"), id)?;
                    for d in 0..3 {
                        pattern[3 * node + d] += force[d];
                    }
                }
                (None, Some(at)) => point_load(document, mesh, &key("at"), vector(&at), force, &mut pattern)?,
                _ => {
                    return Err(document.error(
                        &key("node"),
                        "both or none of `node` and `at`",
                        "one of them",
                    ));
                }
            }
        }
    }
    let entries = pattern.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(i, v)| (i, *v)).collect();
    Ok(NodalLoad { entries, function })
}

/// Index of the node with number `id`.
///
/// # Errors
/// The mesh has no such node.
pub fn find_node(document: &Document, mesh: &Mesh, key: &str, id: u32) -> Result<usize, SceneError> {
    mesh.node_ids
        .iter()
        .position(|&n| n == id)
        .ok_or_else(|| document.error(key, format!("node {id}"), "the number of a node of the mesh"))
}

fn loaded_faces(
    document: &Document,
    mesh: &Mesh,
    index: usize,
    load: &SolidLoad,
) -> Result<Vec<Face>, SceneError> {
    let key = |k: &str| format!("solid.load.{index}.{k}");
    match (&load.faces, &load.faces_in) {
        (Some(list), None) => {
            let elements: HashMap<u32, usize> =
                mesh.element_ids.iter().enumerate().map(|(i, &id)| (id, i)).collect();
            list.iter()
                .map(|&[element, side]| {
                    let e = elements.get(&element).ok_or_else(|| {
                        document.error(
                            &key("faces"),
                            format!("element {element}"),
                            "the number of an element of the mesh",
                        )
                    })?;
                    if !(1..=6).contains(&side) {
                        return Err(document.error(
                            &key("faces"),
                            format!("face {side}"),
                            "a SOLID186 face, 1 to 6",
                        ));
                    }
                    Ok(mesh.face(*e, side as usize - 1))
                })
                .collect()
        }
        (None, Some([low, high])) => {
            let (low, high) = (vector(low), vector(high));
            let faces: Vec<Face> = mesh
                .boundary_faces()
                .into_iter()
                .filter(|f| {
                    let centre = f.centre(mesh);
                    (0..3).all(|d| low[d] <= centre[d] && centre[d] <= high[d])
                })
                .collect();
            if faces.is_empty() {
                return Err(document.error(&key("faces_in"), "no boundary face in the box", "at least one"));
            }
            Ok(faces)
        }
        _ => Err(document.error(&key("faces"), "both or none of `faces` and `faces_in`", "one of them")),
    }
}

/// Spreads a force at a point of the solid over the nodes of the element that holds the point.
fn point_load(
    document: &Document,
    mesh: &Mesh,
    key: &str,
    point: [f64; 3],
    force: [f64; 3],
    pattern: &mut [f64],
) -> Result<(), SceneError> {
    // A little slack lets a point on the surface belong to the solid in spite of rounding.
    const SLACK: f64 = 1e-9;
    for (e, element) in mesh.connectivity.iter().enumerate() {
        let (x, kind) = (mesh.element_coordinates(e), mesh.connectivity.kind(e));
        let nodes = &x[..element.len()];
        let inside_box = (0..3).all(|d| {
            let low = nodes.iter().map(|p| p[d]).fold(f64::INFINITY, f64::min);
            let high = nodes.iter().map(|p| p[d]).fold(f64::NEG_INFINITY, f64::max);
            let margin = 0.25 * (high - low);
            low - margin <= point[d] && point[d] <= high + margin
        });
        if !inside_box {
            continue;
        }
        let Some(natural) = inverse_map::natural_point(kind, &x, point, kind.natural_centre()) else {
            continue;
        };
        if kind.contains(natural.xi, SLACK) {
            let n = kind.shape_functions(natural.xi);
            for (&node, n) in element.iter().zip(n) {
                for d in 0..3 {
                    pattern[3 * node as usize + d] += n * force[d];
                }
            }
            return Ok(());
        }
    }
    let found = format!("({}, {}, {})", point[0], point[1], point[2]);
    Err(document.error(key, found, "a point of the solid"))
}
