//! `trackbed check`: resolves and reports a scene.

use serde_json::{Value, json};
use trackbed_dem as dem;
use trackbed_input::model::Job;
use trackbed_input::model::exchange::{self, CouplingPart, Windows};
use trackbed_input::model::grains::{FilledGroup, GrainsPart, Preview};
use trackbed_input::model::solid::SolidPart;
use trackbed_input::plausible;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_post::preview::Source;
use trackbed_run::estimate::Estimate;
use trackbed_run::{self as run, stages};

/// Report of a scene: lines, and numbers by name.
pub struct Report {
    title: String,
    lines: Vec<Line>,
    numbers: Value,
}

/// Line of a report.
struct Line {
    text: String,
    /// Printed with `--verbose` only.
    detail: bool,
}

impl From<String> for Line {
    fn from(text: String) -> Line {
        Line { text, detail: false }
    }
}

fn detail(text: String) -> Line {
    Line { text, detail: true }
}

impl Report {
    /// Formats as text; `details`: with stability and solver lines.
    pub fn text(&self, details: bool) -> String {
        let lines = self.lines.iter().filter(|line| details || !line.detail);
        lines.fold(format!("{}\n", self.title), |text, line| text + "  " + &line.text + "\n")
    }

    /// Formats as JSON: `title`, `findings`, `solid`, `grains`, `coupling`, `lines`.
    pub fn json(&self) -> String {
        let mut all = self.numbers.clone();
        all["title"] = json!(self.title);
        let lines: Vec<&str> = self.lines.iter().map(|line| line.text.as_str()).collect();
        all["lines"] = json!(lines);
        format!("{all:#}\n")
    }

    pub(super) fn add(&mut self, line: String) {
        self.lines.push(line.into());
    }

    pub(super) fn estimate(&mut self, estimate: &Estimate) {
        self.lines.push(estimate.line().into());
        self.numbers["time"] = json!({
            "threads": estimate.threads,
            "seconds": estimate.seconds(),
            "stages": estimate.stages,
        });
    }
}

/// Validates a scene.
///
/// # Errors
/// Input errors of a run.
pub fn check(source: &Source, memory: Option<u64>, strict: bool) -> Result<Report, Failure> {
    let (document, job) = source.resolve()?;
    report(&document, &job, memory, strict)
}

/// Reports a scene.
///
/// # Errors
/// Input errors; more than `memory` [bytes]; implausible values if `strict`.
pub fn report(document: &Document, job: &Job, memory: Option<u64>, strict: bool) -> Result<Report, Failure> {
    let mut findings = plausible::weigh(&document.scene()?, job);
    findings.extend(plausible::near_mode(job));
    if strict {
        plausible::refuse(document, &findings)?;
    }
    let mut lines: Vec<Line> = findings.iter().map(|f| format!("warning: {f}").into()).collect();
    let mut numbers = json!({ "findings": findings, "solid": null, "grains": null, "coupling": null });
    if let Some(solid) = &job.solid {
        let (own, values) = solid_lines(solid, memory)?;
        lines.extend(own);
        numbers["solid"] = values;
    }
    match &job.grains {
        Some(grains) => {
            let (model, own) = grain_lines(document, job, grains)?;
            lines.extend(own);
            numbers["grains"] = grain_numbers(&model);
            numbers["grains"]["beds"] = bed_numbers(grains);
            if let (Some(coupling), Some(solid)) = (&job.coupling, &job.solid) {
                let (own, values) = coupling_lines(document, coupling, solid, grains, &model)?;
                lines.extend(own);
                numbers["coupling"] = values;
            }
        }
        None => {
            let stages = stages::of(job).flat_map(|s| s.report(job, &|_| String::new()));
            lines.extend(stages.map(Line::from));
        }
    }
    if let Some(line) = lines.iter().map(|line| line.text.as_str()).find(|line| has_no_number(line)) {
        return Err(document.beyond_range(&format!("a value of the report ({})", quantity(line))).into());
    }
    Ok(Report { title: job.title.clone(), lines, numbers })
}

fn has_no_number(line: &str) -> bool {
    line.split(|c: char| !c.is_alphanumeric()).any(|word| matches!(word, "inf" | "NaN"))
}

fn quantity(line: &str) -> String {
    let words = line.split_whitespace().map(|word| word.trim_matches(|c: char| !c.is_alphanumeric()));
    words
        .take_while(|word| word.starts_with(char::is_alphabetic) && !has_no_number(word))
        .collect::<Vec<_>>()
        .join(" ")
}

fn solid_lines(solid: &SolidPart, memory: Option<u64>) -> Result<(Vec<Line>, Value), Failure> {
    let prediction = run::Prediction::of(solid)?;
    prediction.check(memory)?;
    let mesh = solid.model.mesh();
    let total = format!(
        "solid: {} nodes, {} elements, {} unknowns, {}",
        mesh.node_count(),
        mesh.element_count(),
        solid.model.free_dof_count(),
        mass(solid.model.total_mass()),
    );
    let mut lines: Vec<Line> =
        vec![total.into(), detail(format!("  integration rule: {:?}", solid.model.quadrature()))];
    let names = solid.material_names.iter().map(|(id, name)| format!("  material {id}: {name}"));
    lines.extend(names.map(Line::from));
    if let Some(s) = &solid.sleepers {
        let elements = (mesh.element_count() - s.ground_elements()) / s.count();
        lines.push(
            format!("  sleepers: {} of {elements} elements, {} each", s.count(), mass(s.mass())).into(),
        );
    }
    let (all, solver) = (run::size(prediction.total()), run::size(prediction.solver));
    lines.push(format!("  memory: {all}, of which {solver} for the equations").into());
    if prediction.flops > 0.0 {
        lines.push(detail(format!("  one factorization: {:.2} Gflop", 1e-9 * prediction.flops)));
    }
    let (methods, equations): (Vec<_>, Vec<_>) = run::methods(solid)?.into_iter().unzip();
    lines.extend(methods.iter().map(|line| detail(format!("  {line}"))));
    lines.extend(solid.warnings.iter().map(|warning| format!("  warning: {warning}").into()));
    let numbers = json!({
        "nodes": mesh.node_count(),
        "elements": mesh.element_count(),
        "unknowns": solid.model.free_dof_count(),
        "mass": solid.model.total_mass(),
        "memory_bytes": prediction.total(),
        "solver_bytes": prediction.solver,
        "factorization_flops": prediction.flops,
        "equations": equations,
        "notes": solid.warnings,
    });
    Ok((lines, numbers))
}

fn mass(kg: f64) -> String {
    match kg {
        ..10.0 => format!("{kg:.4} kg"),
        ..1e4 => format!("{kg:.1} kg"),
        _ => format!("{:.1} t", 1e-3 * kg),
    }
}

/// Then no step limit exists.
fn all_prescribed(grains: &GrainsPart) -> bool {
    let groups = &grains.groups;
    let prescribed = |part: u32| groups.moving.iter().any(|m| m.part == part);
    !groups.bodies.is_empty() && groups.bodies.iter().all(|b| prescribed(b.part))
}

fn grain_lines(
    document: &Document,
    job: &Job,
    grains: &GrainsPart,
) -> Result<(dem::Model, Vec<Line>), Failure> {
    let Preview { alone, whole: model } = stages::preview(document, job, grains)?;
    let bodies = match alone.sphere_count() {
        0 => format!("grains: {} bodies", alone.body_count()),
        spheres => format!("grains: {} bodies with {spheres} spheres", alone.body_count()),
    };
    let prescribed = all_prescribed(grains);
    let step = match model.measured().filter(|_| !prescribed) {
        None => format!("  DEM time step {:.4e} s", model.dt()),
        Some(share) => format!(
            "  DEM time step {:.4e} s initially, then {share} of the critical time step, at most {:.4e} s",
            model.dt(),
            model.longest(true)
        ),
    };
    let governed = match prescribed {
        true => "  the motion of all bodies is prescribed".into(),
        false => format!("  critical for the initial step: {}", model.describe_limit()),
    };
    let mut lines: Vec<Line> = vec![bodies.into(), step.into(), governed.into()];
    let steps = |time: f64| {
        let most = time / model.dt();
        match model.measured() {
            None => format!("{most:.0} steps"),
            Some(_) => format!("{:.0} to {most:.0} steps", time / model.longest(true)),
        }
    };
    let stages = stages::of(job).flat_map(|s| s.report(job, &steps));
    lines.extend(stages.map(|line| format!("  {line}").into()));
    lines.extend(grains.materials.law_lines.iter().map(|line| format!("  {line}").into()));
    lines.extend(grains.groups.filled.iter().map(|bed| format!("  {}", bed.line()).into()));
    lines.extend(grains.groups.remarks.iter().map(|remark| format!("  warning: {remark}").into()));
    Ok((model, lines))
}

fn grain_numbers(model: &dem::Model) -> Value {
    let longest = model.measured().map_or(model.dt(), |_| model.longest(true));
    json!({
        "bodies": model.body_count(),
        "spheres": model.sphere_count(),
        "first_step": model.dt(),
        "longest_step": longest,
        "step_limit": model.describe_limit(),
    })
}

fn bed_numbers(grains: &GrainsPart) -> Value {
    let bed = |bed: &FilledGroup| {
        json!({
            "group": bed.name,
            "grains": bed.count,
            "mass": bed.mass,
            "porosity": bed.porosity,
            "height": bed.height,
            "floor": bed.floor,
        })
    };
    grains.groups.filled.iter().map(bed).collect()
}

fn coupling_lines(
    document: &Document,
    coupling: &CouplingPart,
    solid: &SolidPart,
    grains: &GrainsPart,
    model: &dem::Model,
) -> Result<(Vec<Line>, Value), Failure> {
    let surface = coupling.ground(solid, grains);
    let Windows { classes, substeps, theta } = coupling.windows(grains, model, solid, &surface);
    coupling.refuse(document, &classes, substeps, model.dt())?;
    let window = model.dt() * f64::from(substeps);
    let s = exchange::stability(&classes);
    let automatic = if coupling.automatic() { " (automatic)" } else { "" };
    let windows = format!(
        "coupling: {} faces, {substeps} DEM steps per window of {window:.4e} s{automatic}",
        coupling.faces.len()
    );
    let stability = format!(
        "  stability W = {:.3}, D = {:.3} (largest of all contacts); scheme {}, transfer: {}",
        s.stiffness,
        s.damping,
        coupling.scheme,
        coupling.transfer_kind(&surface),
    );
    let mut lines: Vec<Line> = vec![windows.into(), detail(stability)];
    lines.extend(classes.iter().map(|c| detail(format!("  {}", c.line()))));
    let remarks = exchange::remarks(&classes, coupling.scheme, substeps);
    lines.extend(remarks.iter().map(|remark| format!("  warning: {remark}").into()));
    let numbers = json!({
        "faces": coupling.faces.len(),
        "substeps": substeps,
        "window": window,
        "stability": { "stiffness": s.stiffness, "damping": s.damping },
        "theta": theta,
        "scheme": coupling.scheme.to_string(),
        "notes": remarks,
    });
    Ok((lines, numbers))
}
