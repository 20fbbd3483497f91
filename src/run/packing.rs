//! What the grains are like at the end of a run: porosity, coordination, fabric, stress, sieve curves; and the files that
//! hold it: `gradation.csv`, `gradation.svg`, `radial.csv`, `packing.csv`.

use super::system::GrainsView;
use crate::failure::Failure;
use crate::model::Job;
use crate::model::grains::{GradedGroup, GrainsPart, MeasurePlan, RadialPlan};
use crate::write::csv::{Field, write_table};
use crate::write::svg::{LinePlot, Series};
use crate::write::{WriteError, atomic};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::path::Path;
use trackbed_dem as dem;
use trackbed_dem::insert::gradation::achieved_passing;
use trackbed_dem::measure::{self, BoxRegion, ContactRecord};

/// Sizes at which a plotted sieve curve is evaluated.
const CURVE_POINTS: usize = 120;

/// A group after growth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GrowthRecord {
    /// Name of the group.
    pub group: String,
    /// Porosity of its container, overlaps counted once.
    pub porosity: f64,
    /// Largest overlap over the reduced radius of the contact.
    pub largest_overlap: f64,
    /// Mean unbalanced force over mean contact force.
    pub unbalanced_ratio: f64,
}

/// A stage of compaction.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompactionRecord {
    /// What was done.
    pub kind: String,
    /// Porosity of its region before.
    pub porosity_before: f64,
    /// The same after, of the region cut off at a plane that has moved in.
    pub porosity_after: f64,
    /// Force on the plane that has moved [N]. Written even where there is none: checkpoints have no names of fields.
    pub wall_force: Option<f64>,
}

/// The grains at the end of a run; the sleeper is none.
#[derive(Debug, Serialize)]
pub struct PackingRecord {
    /// Mean number of neighbours.
    pub coordination: f64,
    /// The same without the grains that have no or one neighbour, and without their contacts.
    pub mechanical_coordination: f64,
    /// Share of the grains with no or one neighbour.
    pub rattlers: f64,
    /// Number of grains with 0, 1, 2, … neighbours.
    pub neighbours: Vec<usize>,
    /// Mean of n ⊗ n over the contacts of grains with each other: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean normal force of the contacts [N].
    pub mean_contact_force: f64,
    /// Share of the contacts that carry more than the mean.
    pub strong_contacts: f64,
    /// Share of the sum of normal forces that they carry.
    pub strong_load: f64,
    /// Mean unbalanced force over mean contact force; absent without contacts.
    pub unbalanced_ratio: Option<f64>,
    /// Boxes that the scene asks for.
    pub measures: Vec<MeasureRecord>,
    /// Fines in the bed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fouling: Option<FoulingRecord>,
    /// Sieve curves of the groups filled by one.
    pub gradations: Vec<GradationRecord>,
}

/// Fines in the bed (Selig & Waters 1994; Indraratna, Su & Rujikiatkamjorn, Can. Geotech. J. 48, 2011).
#[derive(Debug, Serialize)]
pub struct FoulingRecord {
    /// Mass of the fines over that of all grains: the fouling index with the fines for what passes the sieve of 4.75 mm.
    pub fouling_index: f64,
    /// Solid volume of the fines over that of the other grains: relative ballast fouling ratio.
    pub relative_fouling_ratio: f64,
    /// Name of each measured box, porosity of the other grains alone, and solid volume of the fines over the voids that the
    /// others leave. The void contaminant index is 1 + e_f times the last, e_f the void ratio of the fines.
    pub boxes: Vec<(String, f64, f64)>,
}

/// What a box holds.
#[derive(Debug, Serialize)]
pub struct MeasureRecord {
    /// Its name.
    pub name: String,
    /// Share that no grain fills.
    pub porosity: f64,
    /// Number of grains with their centre inside.
    pub grains: usize,
    /// Their mean number of neighbours, and without those with no or one.
    pub coordination: f64,
    /// The same without rattlers.
    pub mechanical_coordination: f64,
    /// Fabric of the contacts inside: xx, yy, zz, xy, yz, zx.
    pub fabric: [f64; 6],
    /// Mean stress, voids included [Pa]: xx, yy, zz, xy, yz, zx, tension positive.
    pub stress: [f64; 6],
}

/// How well a group meets its sieve curve.
#[derive(Debug, Serialize)]
pub struct GradationRecord {
    /// Name of the group.
    pub group: String,
    /// Number of stones.
    pub stones: usize,
    /// Sieves [m].
    pub sieves: Vec<f64>,
    /// Mass fraction passing that was asked for.
    pub target: Vec<f64>,
    /// Mass fraction passing that the stones have.
    pub achieved: Vec<f64>,
    /// Largest |achieved − target| over all sizes, not the sieves alone.
    pub largest_deviation: f64,
}

/// Measures the grains at the end and writes their files.
///
/// # Errors
/// The disk refuses.
pub fn record(
    job: &Job,
    dir: &Path,
    view: GrainsView<'_>,
    grains: &GrainsPart,
) -> Result<PackingRecord, Failure> {
    let GrainsView { model, state } = view;
    let sleeper = grains.track.rigid_sleeper().map(|_| grains.groups.names.len() as u32 - 1);
    // Those that are not there at the end do not count.
    let is_grain = |b: usize| state.present(b) && Some(model.part(b)) != sleeper;
    let contacts = measure::contacts(model, state);
    let stress = measure::mean_stress_of(model, state, &contacts);
    let all = measure::coordination_of(model, state, &contacts, is_grain);
    let strong = measure::strong_network(&contacts);
    let ratio = measure::unbalanced_ratio(model, state, &contacts);
    let between = |c: &ContactRecord| matches!(c.b, dem::Partner::Body(b) if is_grain(b)) && is_grain(c.a);
    let measures = grains.measures.iter().map(|MeasurePlan { name, region, .. }| {
        let inside = |b: usize| is_grain(b) && region.holds(&model.wrap(&state.position(b)));
        let own = measure::coordination_of(model, state, &contacts, inside);
        MeasureRecord {
            name: name.clone(),
            porosity: porosity(view, region, is_grain),
            grains: (0..model.body_count()).filter(|&b| inside(b)).count(),
            coordination: own.mean,
            mechanical_coordination: own.mechanical,
            fabric: measure::fabric(&contacts, |c| between(c) && region.holds(&c.point)),
            stress: measure::region_stress(model, state, &stress, region),
        }
    });
    let gradations = grains.groups.graded.iter().map(|g| graded(view, g)).collect::<Vec<_>>();
    if !gradations.is_empty() {
        write_gradations(dir, &job.title, view, &grains.groups.graded)?;
    }
    if grains.measures.iter().any(|m| m.radial.is_some()) {
        write_radial(dir, view, &grains.measures, is_grain)?;
    }
    if job.output.packing {
        write_packings(dir, view, grains)?;
    }
    Ok(PackingRecord {
        coordination: all.mean,
        mechanical_coordination: all.mechanical,
        rattlers: all.rattlers,
        neighbours: all.distribution,
        fabric: measure::fabric(&contacts, between),
        mean_contact_force: strong.mean_force,
        strong_contacts: strong.contacts,
        strong_load: strong.load,
        unbalanced_ratio: ratio.is_finite().then_some(ratio),
        measures: measures.collect(),
        fouling: fouling(view, grains, is_grain),
        gradations,
    })
}

/// How much of the fouling groups is in the bed.
fn fouling(
    view: GrainsView<'_>,
    grains: &GrainsPart,
    is_grain: impl Fn(usize) -> bool,
) -> Option<FoulingRecord> {
    if grains.groups.fouling.is_empty() {
        return None;
    }
    let model = view.model;
    let fine = |b: usize| grains.groups.fouling.contains(&model.part(b));
    let sum = |of: fn(&dem::Model, usize) -> f64, fines: bool| -> f64 {
        (0..model.body_count()).filter(|&b| is_grain(b) && fine(b) == fines).map(|b| of(model, b)).sum()
    };
    let [stones, fines] = [false, true].map(|f| sum(dem::Model::mass, f));
    let boxes = grains.measures.iter().map(|MeasurePlan { name, region, .. }| {
        let skeleton = porosity(view, region, |b| is_grain(b) && !fine(b));
        let both = porosity(view, region, &is_grain);
        let share = if skeleton > 0.0 { (skeleton - both) / skeleton } else { 0.0 };
        (name.clone(), skeleton, share)
    });
    Some(FoulingRecord {
        fouling_index: share_of(fines, stones + fines),
        relative_fouling_ratio: share_of(sum(dem::Model::volume, true), sum(dem::Model::volume, false)),
        boxes: boxes.collect(),
    })
}

/// A ratio; zero where there is nothing to compare with.
fn share_of(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// Share of a box that grains leave.
fn porosity(view: GrainsView<'_>, region: &BoxRegion, is_grain: impl Fn(usize) -> bool) -> f64 {
    let grains = (0..view.model.body_count()).filter(|&b| is_grain(b));
    let solid: f64 = grains.map(|b| measure::body_volume_in(view.model, view.state, b, region)).sum();
    1.0 - solid / region.volume()
}

fn graded(view: GrainsView<'_>, group: &GradedGroup) -> GradationRecord {
    let stones = stones(view, group);
    let curve = &group.grading.curve;
    let sieves = curve.sizes().to_vec();
    let points = curve_sizes(group);
    let far = points.iter().zip(achieved_passing(&points, &stones));
    GradationRecord {
        group: group.name.clone(),
        stones: stones.len(),
        target: curve.passing().to_vec(),
        achieved: achieved_passing(&sieves, &stones),
        largest_deviation: far.map(|(d, a)| (a - curve.passing_at(*d)).abs()).fold(0.0, f64::max),
        sieves,
    }
}

/// Sieve size [m] and mass [kg] of the stones of a group that are there.
fn stones(view: GrainsView<'_>, group: &GradedGroup) -> Vec<(f64, f64)> {
    measure::stones(view.model, |b| view.state.present(b) && view.model.part(b) == group.part)
}

/// Sizes from the smallest sieve to the largest, evenly on the logarithmic scale, a little beyond at both ends [m].
fn curve_sizes(group: &GradedGroup) -> Vec<f64> {
    let sizes = group.grading.curve.sizes();
    let (low, high) = (sizes[0] * 0.999, sizes[sizes.len() - 1] * 1.001);
    (0..=CURVE_POINTS).map(|k| low * (high / low).powf(k as f64 / CURVE_POINTS as f64)).collect()
}

/// Radial distribution functions of the boxes that ask for one: distance at the middle of each shell, and g.
fn write_radial(
    dir: &Path,
    view: GrainsView<'_>,
    measures: &[MeasurePlan],
    is_grain: impl Fn(usize) -> bool,
) -> Result<(), Failure> {
    let columns: [Field<[f64; 3]>; 3] =
        [("measure", "", |r| r[0]), ("distance", "m", |r| r[1]), ("g", "", |r| r[2])];
    let rows = measures.iter().enumerate().flat_map(|(i, m)| {
        let g = m.radial.and_then(|RadialPlan { reach, bins }| {
            let g = measure::radial_distribution(view.model, view.state, &m.region, &is_grain, reach, bins)?;
            let row = |(k, g): (usize, f64)| [i as f64, (k as f64 + 0.5) * reach / bins as f64, g];
            Some(g.into_iter().enumerate().map(row).collect::<Vec<_>>())
        });
        g.unwrap_or_default()
    });
    Ok(write_table(&dir.join("radial.csv"), &columns, rows)?)
}

/// A row of `gradation.csv`.
type Sieve = [f64; 6];

/// Its columns.
const SIEVES: [Field<Sieve>; 6] = [
    ("group", "", |r| r[0]),
    ("sieve", "m", |r| r[1]),
    ("lower_limit", "", |r| r[2]),
    ("upper_limit", "", |r| r[3]),
    ("target", "", |r| r[4]),
    ("achieved", "", |r| r[5]),
];

/// `gradation.csv`: the limits, the curve asked for and the one achieved at every sieve of the table; `gradation.svg`: the
/// same drawn.
fn write_gradations(
    dir: &Path,
    title: &str,
    view: GrainsView<'_>,
    groups: &[GradedGroup],
) -> Result<(), Failure> {
    let mut rows: Vec<Sieve> = Vec::new();
    let mut series = Vec::new();
    for group in groups {
        let stones = stones(view, group);
        let limits = &group.grading.limits;
        let sieves: Vec<f64> = limits.iter().map(|l| l[0]).collect();
        for (&[size, low, high], achieved) in limits.iter().zip(achieved_passing(&sieves, &stones)) {
            let target = group.grading.curve.passing_at(size);
            rows.push([f64::from(group.part), size, low, high, target, achieved]);
        }
        let mut add = |name: &str, points: Vec<[f64; 2]>| {
            let name = if groups.len() > 1 { format!("{}: {name}", group.name) } else { name.to_string() };
            let points = points.into_iter().map(|[size, passing]| [1e3 * size, 100.0 * passing]).collect();
            series.push(Series { name, points });
        };
        let points = curve_sizes(group);
        let curve = &group.grading.curve;
        add("asked for", points.iter().map(|&d| [d, curve.passing_at(d)]).collect());
        let achieved = achieved_passing(&points, &stones);
        add("stones", points.iter().zip(achieved).map(|(&d, a)| [d, a]).collect());
        add("upper limit", limits.iter().map(|l| [l[0], l[2]]).collect());
        add("lower limit", limits.iter().map(|l| [l[0], l[1]]).collect());
    }
    write_table(&dir.join("gradation.csv"), &SIEVES, rows)?;
    let plot = LinePlot {
        title: format!("{title}: sieve curve"),
        x_label: "sieve [mm]".into(),
        y_label: "passing by mass [%]".into(),
        series,
    };
    Ok(plot.write(&dir.join("gradation.svg"))?)
}

/// `packing.csv`, or one file for each of several groups: what `[[grains]] packing` reads.
fn write_packings(dir: &Path, view: GrainsView<'_>, grains: &GrainsPart) -> Result<(), Failure> {
    let groups = grains.groups.first_shape.len();
    for group in 0..groups {
        let name = if groups == 1 { "packing.csv".to_string() } else { format!("packing_{group}.csv") };
        let file = dir.join(name);
        let text = packing(view, group as u32, grains.groups.first_shape[group]);
        atomic::write(&file, |out| {
            out.write_all(text.as_bytes()).map_err(|source| WriteError::Io { file: file.clone(), source })
        })?;
    }
    Ok(())
}

/// Rows of one group: `x,y,z,r` of spheres; of clumps place, quaternion, scale and number of the stone. Numbers are
/// written in the shortest form that reads back to the same bits.
fn packing(view: GrainsView<'_>, part: u32, first_shape: usize) -> String {
    let GrainsView { model, state } = view;
    let own = || (0..model.body_count()).filter(|&b| state.present(b) && model.part(b) == part);
    let single = |b: usize| matches!(model.shape(b), dem::Shape::Sphere { .. });
    let mut text = String::new();
    let mut line = |row: &[f64]| {
        let fields: Vec<String> = row.iter().map(f64::to_string).collect();
        writeln!(text, "{}", fields.join(",")).expect("writing to a string does not fail");
    };
    let spheres = own().all(single);
    for b in own() {
        let x = model.wrap(&state.position(b));
        if spheres {
            line(&[x.x, x.y, x.z, model.radius(b)]);
        } else {
            let q = state.orientation(model, b);
            let stone = model.shape_number(b) - first_shape;
            line(&[x.x, x.y, x.z, q.w, q.i, q.j, q.k, model.scale(b), stone as f64]);
        }
    }
    let heading = if spheres { "x,y,z,r\n" } else { "x,y,z,qw,qx,qy,qz,scale,stone\n" };
    heading.to_string() + &text
}

/// Lines of the report about grains.
pub(super) fn report(
    growth: &[GrowthRecord],
    compaction: &[CompactionRecord],
    packing: Option<&PackingRecord>,
) -> Vec<String> {
    let mut lines = Vec::new();
    for g in growth {
        lines.push(format!(
            "growth of {}: porosity {:.4}, largest overlap {:.2e} of the radius, unbalanced force {:.1e}",
            g.group, g.porosity, g.largest_overlap, g.unbalanced_ratio
        ));
    }
    for (i, c) in compaction.iter().enumerate() {
        let force = c.wall_force.map_or(String::new(), |f| format!(", force on the plane {f:.3e} N"));
        lines.push(format!(
            "compaction {} ({}): porosity {:.4} to {:.4}{force}",
            i + 1,
            c.kind,
            c.porosity_before,
            c.porosity_after
        ));
    }
    let Some(p) = packing else { return lines };
    lines.push(format!(
        "grains: {:.2} neighbours, {:.2} without rattlers ({:.1} % of the grains); {:.0} % of the contacts carry {:.0} % of \
         the normal forces",
        p.coordination,
        p.mechanical_coordination,
        100.0 * p.rattlers,
        100.0 * p.strong_contacts,
        100.0 * p.strong_load
    ));
    for m in &p.measures {
        let pressure = -(m.stress[0] + m.stress[1] + m.stress[2]) / 3.0;
        lines.push(format!(
            "{}: porosity {:.4}, {} grains, {:.2} neighbours, mean pressure {pressure:.3e} Pa",
            m.name, m.porosity, m.grains, m.coordination
        ));
    }
    if let Some(f) = &p.fouling {
        let boxes: Vec<String> = f
            .boxes
            .iter()
            .map(|(name, _, share)| format!(", {:.1} % of the voids of {name}", 100.0 * share))
            .collect();
        lines.push(format!("fines: {:.2} % of the mass{}", 100.0 * f.fouling_index, boxes.concat()));
    }
    for g in &p.gradations {
        lines.push(format!(
            "sieve curve of {}: {} stones, within {:.2} % passing of the curve asked for",
            g.group,
            g.stones,
            100.0 * g.largest_deviation
        ));
    }
    lines
}
