//! Target and achieved sieve curves: `gradation.csv`, `gradation.svg`.

use super::records::GradationRecord;
use crate::system::GrainsView;
use std::path::Path;
use trackbed_dem::insert::gradation::achieved_passing;
use trackbed_dem::measure;
use trackbed_input::model::grains::GradedGroup;
use trackbed_io::columns::gradation;
use trackbed_io::failure::Failure;
use trackbed_io::plot::{Axis, Plot};
use trackbed_io::write::csv::{Field, write_table};

const CURVE_POINTS: usize = 120;

pub(super) fn graded(view: GrainsView<'_>, group: &GradedGroup) -> GradationRecord {
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

/// Sieve size [m], mass [kg].
fn stones(view: GrainsView<'_>, group: &GradedGroup) -> Vec<(f64, f64)> {
    measure::stones(view.model, |b| view.state.present(b) && view.model.part(b) == group.part)
}

/// Log-spaced, slightly beyond the sieve range [m].
fn curve_sizes(group: &GradedGroup) -> Vec<f64> {
    let sizes = group.grading.curve.sizes();
    let (low, high) = (sizes[0] * 0.999, sizes[sizes.len() - 1] * 1.001);
    (0..=CURVE_POINTS).map(|k| low * libm::pow(high / low, k as f64 / CURVE_POINTS as f64)).collect()
}

type Sieve = [f64; 6];

const SIEVES: [Field<Sieve>; 6] = [
    (gradation::GROUP, |r| r[0]),
    (gradation::SIEVE, |r| r[1]),
    (gradation::LOWER_LIMIT, |r| r[2]),
    (gradation::UPPER_LIMIT, |r| r[3]),
    (gradation::TARGET, |r| r[4]),
    (gradation::ACHIEVED, |r| r[5]),
];

pub(super) fn write(
    dir: &Path,
    title: &str,
    view: GrainsView<'_>,
    groups: &[GradedGroup],
) -> Result<(), Failure> {
    let mut rows: Vec<Sieve> = Vec::new();
    let mut curves = Vec::<(String, Vec<[f64; 2]>)>::new();
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
            curves.push((name, points));
        };
        let points = curve_sizes(group);
        let curve = &group.grading.curve;
        add("target", points.iter().map(|&d| [d, curve.passing_at(d)]).collect());
        let achieved = achieved_passing(&points, &stones);
        add("stones", points.iter().zip(achieved).map(|(&d, a)| [d, a]).collect());
        add("upper limit", limits.iter().map(|l| [l[0], l[2]]).collect());
        add("lower limit", limits.iter().map(|l| [l[0], l[1]]).collect());
    }
    write_table(&dir.join("gradation.csv"), &SIEVES, rows)?;
    let (x, y) = (Axis::new("sieve", "mm"), Axis::new("passing by mass", "%"));
    let plot = Plot::lines(format!("{title}: sieve curve"), x, y, curves);
    Ok(plot.write(&dir.join("gradation.svg"))?)
}
