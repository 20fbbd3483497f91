//! `trackbed check`: reads and resolves everything that a run would, runs nothing, and says what would happen.

use crate::failure::Failure;
use crate::model::grains::refused;
use crate::model::solid::Analysis;
use crate::model::{Job, exchange};
use crate::run;
use crate::scene::{Document, Scene};
use std::fmt::Write;
use std::path::Path;
use trackbed_dem as dem;

/// Validates a scene; the text says what a run of it would do.
///
/// # Errors
/// The same bad input that a run would refuse.
pub fn check(scene: &Path, set: &[String], memory: Option<u64>) -> Result<String, Failure> {
    let mut document = Document::open(scene)?;
    for assignment in set {
        document.set(assignment)?;
    }
    let parsed: Scene = document.read()?;
    let job = Job::new(&document, &parsed)?;
    let mut text = format!("{}\n", job.title);
    let mut line = |t: String| writeln!(text, "  {t}").expect("writing to a string does not fail");
    if let Some(solid) = &job.solid {
        let prediction = run::Prediction::of(solid)?;
        prediction.check(memory)?;
        let mesh = solid.model.mesh();
        line(format!(
            "solid: {} nodes, {} elements, {} unknowns, {:?} rule, {:.3e} kg",
            mesh.node_count(),
            mesh.element_count(),
            solid.model.free_dof_count(),
            solid.model.quadrature(),
            solid.model.total_mass(),
        ));
        for (id, name) in &solid.material_names {
            line(format!("  material {id}: {name}"));
        }
        if let Some(s) = &solid.sleepers {
            let elements = (mesh.element_count() - s.ground_elements()) / s.count();
            line(format!("  sleepers: {} of {elements} elements, {:.3e} kg each", s.count(), s.mass()));
        }
        line(format!(
            "  memory: {} in all, {} of it for the equations; one factorization {:.2} Gflop",
            run::size(prediction.total()),
            run::size(prediction.solver),
            1e-9 * prediction.flops
        ));
        for warning in &solid.warnings {
            line(format!("  note: {warning}"));
        }
    }
    if let Some(grains) = &job.grains {
        // First without the sleeper, as a run does to find its place. That place does not matter to the step's limit.
        let alone =
            dem::Model::new(grains.input(grains.bodies.clone())).map_err(|e| refused(&document, &e))?;
        let sleepers = grains
            .rigid_sleeper()
            .into_iter()
            .flat_map(|plan| plan.row.centres.iter().map(|&centre| grains.sleeper_body(plan, centre, 0.0)));
        let bodies = grains.bodies.iter().cloned().chain(sleepers).collect();
        let model = dem::Model::new(grains.input(bodies)).map_err(|e| refused(&document, &e))?;
        grains.check_pads(&document, model.dt())?;
        line(format!("grains: {} bodies with {} spheres", alone.body_count(), alone.sphere_count()));
        line(format!("  step {:.4e} s; {}", model.dt(), model.dt_limit()));
        if let Some(d) = &grains.deposition {
            line(format!("  settling: at most {} s, {:.0} steps", d.max_time, d.max_time / model.dt()));
        }
        line(format!("  run: {} s, {:.0} steps", job.end, job.end / model.dt()));
        let waiting = |part| grains.bodies.iter().filter(|b| b.absent && b.part == part).count();
        for text in grains.flow.iter().flat_map(|f| f.lines(&grains.parts, waiting)) {
            line(format!("  {text}"));
        }
        if let (Some(coupling), Some(solid)) = (&job.coupling, &job.solid) {
            let surface = coupling.ground(solid, grains);
            let (classes, substeps) = coupling.classes(grains, &model, solid, &surface);
            let window = model.dt() * f64::from(substeps);
            let s = exchange::stability(&classes);
            line(format!(
                "coupling: {} faces, {} grain steps per window of {window:.4e} s{}; stability W = {:.3}, D = {:.3} (largest of \
                 all contacts); scheme {}, transfer: {}",
                coupling.faces.len(),
                substeps,
                if coupling.automatic() { " (automatic)" } else { "" },
                s.stiffness,
                s.damping,
                coupling.scheme,
                coupling.transfer_kind(&surface),
            ));
            classes.iter().for_each(|c| line(format!("  {}", c.line())));
            for remark in exchange::remarks(&classes, coupling.scheme, substeps) {
                line(format!("  note: {remark}"));
            }
        }
    } else if let Some(solid) = &job.solid {
        let steps = |step: f64| format!("{} s in {:.0} steps of {step} s", job.end, job.end / step);
        line(match (&solid.analysis, job.solid_step) {
            (Analysis::Dynamic(_), Some(step)) => format!("dynamics: {}", steps(step)),
            (Analysis::QuasiStatic(_), Some(step)) => format!("quasi-static: {}", steps(step)),
            (Analysis::StrengthReduction(plan), _) => {
                format!("strength reduction: from the factor {} on, to within {}", plan.start, plan.tolerance)
            }
            _ => "statics: one solve".into(),
        });
    }
    Ok(text)
}
