//! Static solve of a solid.

use super::stage::{RunState, Stage, Steps};
use crate::context::Run;
use crate::frames;
use crate::summary::{StageRecord, StaticsRecord, Summary};
use crate::system::SolidView;
use crate::validity::small_strain;
use std::path::Path;
use std::time::Instant;
use trackbed_fem as fem;
use trackbed_fem::State;
use trackbed_fem::element::stiffness_points;
use trackbed_fem::model::Model;
use trackbed_input::model::Job;
use trackbed_input::model::solid::{Analysis, SolidPart};
use trackbed_io::columns::{gauss, nodes};
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Column, Field, History, write_table};

/// Static solve.
pub struct Statics;

impl Stage for Statics {
    fn name(&self) -> Option<&'static str> {
        Some("statics")
    }

    fn applies(&self, job: &Job) -> bool {
        job.grains.is_none() && job.solid.as_ref().is_some_and(|s| matches!(s.analysis, Analysis::Static))
    }

    fn report(&self, _: &Job, _: Steps<'_>) -> Vec<String> {
        vec!["statics: one solve".into()]
    }

    fn run<'a>(&self, run: &Run<'a>, state: &mut RunState<'a>) -> Result<(), Failure> {
        let Some(solid) = &run.job.solid else { return Ok(()) };
        solve(run.job, solid, run.dir, || run.prepare(), &mut state.summary)
    }
}

/// `prepare` creates `dir` after success.
///
/// # Errors
/// Insufficient constraints, or an invalid result.
fn solve(
    job: &Job,
    solid: &SolidPart,
    dir: &Path,
    prepare: impl Fn() -> Result<(), Failure>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    let begun = Instant::now();
    let model = &solid.model;
    let mut load = model.gravity_load();
    solid.add_loads(0.0, &mut load);
    let result = fem::statics::solve(model, &load).map_err(|e| solid.failure(&e))?;
    let mut state = fem::state::State::new(model);
    state.u.copy_from_slice(&result.u);

    let energy = fem::energy::strain(model, &state);
    if !energy.is_finite() {
        let found = format!("strain energy not finite: {energy} J");
        return Err(Failure::Numerical(format!("solid: {found}. Check units of loads and stiffness.")));
    }
    summary.validity.extend(small_strain(model, &state.u));
    prepare()?;
    let view = SolidView { model, state: &state };
    frames::write_state(dir, &job.output, view)?;
    if job.output.tables {
        write_tables(model, &state, &result.reactions, dir)?;
    }

    let (mut total, mut reaction, mut scale) = ([0.0; 3], [0.0; 3], 0.0);
    for (i, (l, r)) in load.iter().zip(&result.reactions).enumerate() {
        total[i % 3] += l;
        reaction[i % 3] += r;
        scale += l.abs() + r.abs();
    }
    let imbalance: f64 = (0..3).map(|d| (total[d] + reaction[d]).powi(2)).sum::<f64>().sqrt();
    let length = |n: usize| result.u[3 * n..3 * n + 3].iter().map(|u| u * u).sum::<f64>().sqrt();
    let farthest =
        (0..model.mesh().node_count()).max_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
    summary.solid.statics = Some(StaticsRecord {
        load: total,
        reaction,
        equilibrium_error: if scale > 0.0 { imbalance / scale } else { 0.0 },
        largest_displacement: (length(farthest), model.mesh().node_ids[farthest]),
        strain_energy: energy,
    });
    summary.stages.push(StageRecord {
        name: "static".into(),
        seconds: begun.elapsed().as_secs_f64(),
        grain_steps: 0,
        solid_steps: 1,
        windows: 0,
    });
    Ok(())
}

/// Node, displacement [m], reaction [N].
type Node = (u32, [f64; 3], [f64; 3]);

const NODES: [Field<Node>; 7] = [
    (nodes::NODE, |n| f64::from(n.0)),
    (nodes::UX, |n| n.1[0]),
    (nodes::UY, |n| n.1[1]),
    (nodes::UZ, |n| n.1[2]),
    (nodes::RX, |n| n.2[0]),
    (nodes::RY, |n| n.2[1]),
    (nodes::RZ, |n| n.2[2]),
];

struct GaussPoint {
    element: u32,
    xi: [f64; 3],
    stress: [f64; 6],
    kappa: f64,
}

/// The last column only for plastic solids.
const GAUSS: [Field<GaussPoint>; 11] = [
    (gauss::ELEMENT, |p| f64::from(p.element)),
    (gauss::XI, |p| p.xi[0]),
    (gauss::ETA, |p| p.xi[1]),
    (gauss::ZETA, |p| p.xi[2]),
    (gauss::SXX, |p| p.stress[0]),
    (gauss::SYY, |p| p.stress[1]),
    (gauss::SZZ, |p| p.stress[2]),
    (gauss::SXY, |p| p.stress[3]),
    (gauss::SYZ, |p| p.stress[4]),
    (gauss::SZX, |p| p.stress[5]),
    (gauss::EQUIVALENT_PLASTIC_STRAIN, |p| p.kappa),
];

/// Writes `nodes.csv` (displacements, reactions) and `gauss.csv` (stresses, plastic strain).
///
/// # Errors
/// Non-finite values; I/O errors.
pub fn write_tables(model: &Model, state: &State, reactions: &[f64], dir: &Path) -> Result<(), Failure> {
    let (mesh, u) = (model.mesh(), &state.u);
    let nodes = mesh.node_ids.iter().enumerate().map(|(n, &id)| {
        let of_node = |field: &[f64]| [field[3 * n], field[3 * n + 1], field[3 * n + 2]];
        (id, of_node(u), of_node(reactions))
    });
    write_table(&dir.join("nodes.csv"), &NODES, nodes)?;
    let plastic = !state.points.is_empty();
    let fields = if plastic { &GAUSS[..] } else { &GAUSS[..GAUSS.len() - 1] };
    let own = if plastic { own_values(model) } else { Vec::new() };
    let columns = fields.iter().map(|(column, _)| Column::of(*column));
    let columns = columns.chain(own.iter().map(|value| Column::new(&*value.name, &*value.unit)));
    let mut table = History::create(&dir.join("gauss.csv"), columns.collect())?;
    for (e, &id) in mesh.element_ids.iter().enumerate() {
        let points = stiffness_points(mesh.connectivity.kind(e), model.quadrature());
        let elastic = if plastic { Vec::new() } else { fem::stress::gauss(model, u, e) };
        let of_law = model.material(e).law.state_values();
        for (i, point) in points.iter().enumerate() {
            let at = plastic.then(|| model.point(&state.points, e, i));
            let stress = at.map_or_else(|| elastic[i], |p| p.state.stress);
            let kappa = at.map_or(0.0, |p| p.state.kappa);
            let point = GaussPoint { element: id, xi: point.xi, stress, kappa };
            let mut row: Vec<f64> = fields.iter().map(|(_, value)| value(&point)).collect();
            // 0 if the law lacks this value.
            let value = |own: &fem::StateValue| Some(at?.values[of_law.iter().position(|v| v == own)?]);
            row.extend(own.iter().map(|own| value(own).unwrap_or(0.0)));
            table.row(&row)?;
        }
    }
    Ok(())
}

fn own_values(model: &Model) -> Vec<fem::StateValue> {
    let mut own = Vec::new();
    for value in model.materials().values().flat_map(|m| m.law.state_values()) {
        if !own.contains(value) {
            own.push(value.clone());
        }
    }
    own
}
