//! FEM against reference solutions, through the user's input and result files.
//!
//! Source: `tests/data/fem/<case>/case.json` with mesh, loads, reference and tolerances. References: two
//! independent programs with 3 × 3 × 3 integration, checked by a third; patch tests are exact fields.
//!
//! | case | quantity | tolerance | source |
//! |---|---|---|---|
//! | E1 straight, curved | displacement against G x | 1e-10 of the largest | case.json |
//! | E1 straight, curved | stress against the constant one | 1e-9 of the largest | case.json |
//! | E2, E3 load and weight, E6 | displacement of all nodes | 1e-6 of the largest | case.json |
//! | E2, E3 load and weight, E6 | stress at centroids and 2×2×2 points | 1e-5 of the largest | case.json |
//! | E5 | displacement history per node and component | 1e-6 of its largest | case.json |
//! | E5 | velocity history per node and component | 1e-5 of its largest | case.json |
//! | all static | probes with 2×2×2 and 14-point integration | 1e-7 of the largest | 8 printed digits |
//! | all static | sum of reactions | 1e-9 of the sum of absolute values | reference solver |
//! | all static | strain energy | 1e-9 | reference solver |
//! | E6 | radial displacement against Lamé | 1e-4 | case.json: the reference has 8e-5 |

use super::support::{Folder, Table, json, numbers, repository, run};
use serde_json::Value;
use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;
use trackbed::model::Job;
use trackbed::scene::Document;
use trackbed_fem::stress::at_natural;

struct Case {
    name: &'static str,
    data: PathBuf,
    case: Value,
    out: Folder,
    nodes: Table,
}

impl Case {
    fn run(name: &'static str, set: &[&str]) -> Case {
        let data = repository().join("tests/data/fem").join(name);
        let out = Folder::new(name);
        run(&data.join("scene.toml"), out.path(), set).good();
        let case = json(&data.join("case.json"));
        let nodes = Table::read(&out.join("nodes.csv"));
        assert_eq!(nodes.heads, ["node", "ux", "uy", "uz", "rx", "ry", "rz"]);
        assert_eq!(nodes.rows.len() as u64, case["reference"]["nodes"].as_u64().unwrap());
        Case { name, data, case, out, nodes }
    }

    #[track_caller]
    fn within(&self, what: &str, error: f64, tolerance: f64) {
        println!("{}: {what}: {error:.2e}, tolerance {tolerance:.0e}", self.name);
        assert!(error <= tolerance, "{}: {what}: {error:e} is above {tolerance:e}", self.name);
    }

    fn displacement(&self) -> HashMap<u32, [f64; 3]> {
        self.nodes.rows.iter().map(|r| (r[0] as u32, [r[1], r[2], r[3]])).collect()
    }

    fn largest_reference(&self) -> f64 {
        self.case["reference"]["max_abs_u"].as_f64().unwrap()
    }

    /// Largest |u − u_ref| over largest |u_ref|.
    fn displacement_error(&self, file: &str) -> f64 {
        let u = self.displacement();
        let reference = Table::read(&self.data.join(file));
        assert_eq!(reference.rows.len(), u.len());
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        for row in &reference.rows {
            error = error.max(distance(&u[&(row[0] as u32)], &row[1..4]));
            largest = largest.max(distance(&[0.0; 3], &row[1..4]));
        }
        error / largest
    }

    fn gauss(&self) -> Vec<(u32, [f64; 3], [f64; 6])> {
        let table = Table::read(&self.out.join("gauss.csv"));
        assert_eq!(table.heads, ["element", "xi", "eta", "zeta", "sxx", "syy", "szz", "sxy", "syz", "szx"]);
        let part = |r: &Vec<f64>| (r[0] as u32, r[1..4].try_into().unwrap(), r[4..10].try_into().unwrap());
        table.rows.iter().map(part).collect()
    }

    fn stress_at(&self, wanted: &[(u32, [f64; 3])]) -> Vec<[f64; 6]> {
        let document = Document::open(&self.data.join("scene.toml")).unwrap();
        let job = Job::new(&document, &document.scene().unwrap()).unwrap();
        let model = job.solid.unwrap().model;
        let moved = self.displacement();
        let u: Vec<f64> = model.mesh().node_ids.iter().flat_map(|id| moved[id]).collect();
        let index = |id: u32| model.mesh().element_ids.iter().position(|e| *e == id).unwrap();
        wanted.iter().map(|&(element, xi)| at_natural(&model, &u, index(element), xi)).collect()
    }

    fn check_stress(&self, tolerance: f64) {
        let centroid = Table::read(&self.data.join("reference_stress_centroid.csv"));
        let middle: HashMap<u32, [f64; 6]> =
            self.gauss().into_iter().filter(|(_, xi, _)| *xi == [0.0; 3]).map(|(e, _, s)| (e, s)).collect();
        assert_eq!(centroid.rows.len(), middle.len());
        let pairs = centroid.rows.iter().map(|r| (middle[&(r[0] as u32)], &r[4..10]));
        self.within("stress at centroids", stress_error(pairs), tolerance);

        let points = Table::read(&self.data.join("reference_stress_gauss2x2x2.csv"));
        assert!(points.rows.len() >= 8);
        let wanted: Vec<(u32, [f64; 3])> =
            points.rows.iter().map(|r| (r[0] as u32, r[1..4].try_into().unwrap())).collect();
        let found = self.stress_at(&wanted);
        let pairs = found.into_iter().zip(points.rows.iter().map(|r| &r[7..13]));
        self.within("stress at 2x2x2 points", stress_error(pairs), tolerance);
    }

    /// Sum of reactions and strain energy; summary and tables must agree.
    fn check_sums(&self) {
        let summary = json(&self.out.join("summary.json"));
        assert_eq!(summary["status"], "done");
        let statics = &summary["statics"];
        let (mut sum, mut scale) = ([0.0; 3], 0.0);
        for row in &self.nodes.rows {
            for d in 0..3 {
                sum[d] += row[4 + d];
                scale += row[4 + d].abs();
            }
        }
        let reference = numbers(&self.case["reference"]["reaction_sum"]);
        self.within("sum of reactions", distance(&sum, &reference) / scale, 1e-9);
        self.within(
            "sum of reactions in the summary",
            distance(&sum, &numbers(&statics["reaction"])) / scale,
            1e-9,
        );
        let balance: Vec<f64> = numbers(&statics["load"]).iter().map(|l| -l).collect();
        self.within("loads against reactions", distance(&sum, &balance) / scale, 1e-9);
        let energy = self.case["reference"]["strain_energy"].as_f64().unwrap();
        let error = (statics["strain_energy"].as_f64().unwrap() / energy - 1.0).abs();
        self.within("strain energy", error, 1e-9);
    }

    /// Probe displacements with 2 × 2 × 2 and Irons' 14 points.
    fn check_reduced(name: &'static str, rules_differ: bool) -> Case {
        Case::check_rule(name, rules_differ, "irons14", "irons14", 14);
        Case::check_rule(name, rules_differ, "reduced", "2x2x2", 8)
    }

    /// Rule `key` of scenes with `points` points, `probes` of the reference.
    fn check_rule(name: &'static str, rules_differ: bool, key: &str, probes: &str, points: u64) -> Case {
        let reduced = Case::run(name, &[&format!("solid.integration={key}")]);
        assert_eq!(
            reduced.gauss().len() as u64,
            points * reduced.case["reference"]["elements"].as_u64().unwrap()
        );
        let u = reduced.displacement();
        let error = |values: &Value| {
            let values = values.as_object().unwrap();
            assert!(!values.is_empty());
            let one = |(id, at): (&String, &Value)| distance(&u[&id.parse().unwrap()], &numbers(at));
            values.iter().map(one).fold(0.0, f64::max) / reduced.largest_reference()
        };
        let rules = &reduced.case["other_integration_rules"];
        reduced.within(&format!("probes with {probes} integration"), error(&rules["probes"][probes]), 1e-7);
        if rules_differ {
            let other = error(&rules["same_probes_27pt"]);
            assert!(other > 1e-6, "{name}: the rules should differ, but by {other:e} only");
        }
        reduced
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

fn stress_error<'a>(pairs: impl Iterator<Item = ([f64; 6], &'a [f64])>) -> f64 {
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for (found, reference) in pairs {
        for (f, r) in found.iter().zip(reference) {
            error = error.max((f - r).abs());
            largest = largest.max(r.abs());
        }
    }
    error / largest
}

fn check_against_reference(name: &'static str) -> Case {
    let case = Case::run(name, &[]);
    case.within("displacement", case.displacement_error("reference_displacement.csv"), 1e-6);
    case.check_stress(1e-5);
    case.check_sums();
    Case::check_reduced(name, true);
    case
}

fn patch_errors(case: &Case) -> (f64, f64) {
    let gradient: Vec<Vec<f64>> = case.case["exact"]["G"].as_array().unwrap().iter().map(numbers).collect();
    let list = fs::read_to_string(case.data.join("NODECOORD.DAT")).unwrap();
    let u = case.displacement();
    let (mut error, mut largest) = (0.0_f64, 0.0_f64);
    for line in list.lines() {
        let fields: Vec<f64> = line.split_whitespace().map(|f| f.parse().unwrap()).collect();
        let exact: Vec<f64> =
            gradient.iter().map(|g| g.iter().zip(&fields[1..]).map(|(g, x)| g * x).sum()).collect();
        error = error.max(distance(&u[&(fields[0] as u32)], &exact));
        largest = largest.max(distance(&exact, &[0.0; 3]));
    }
    let exact = numbers(&case.case["exact"]["stress_xx_yy_zz_xy_yz_zx"]);
    let stress = stress_error(case.gauss().into_iter().map(|(_, _, s)| (s, exact.as_slice())));
    (error / largest, stress)
}

fn check_patch(name: &'static str) {
    let case = Case::run(name, &[]);
    let (displacement, stress) = patch_errors(&case);
    case.within("displacement against G x", displacement, 1e-10);
    case.within("stress at 27 points per element", stress, 1e-9);
    // Printed references have ten digits, too few for 1e-9.
    case.within(
        "displacement against the printed one",
        case.displacement_error("reference_displacement.csv"),
        1e-9,
    );
    case.check_stress(1e-8);
    case.check_sums();
}

#[test]
fn e1_straight_patch() {
    check_patch("E1_patch_straight");
    // With straight edges 2 × 2 × 2 points are sufficient.
    let reduced = Case::check_reduced("E1_patch_straight", false);
    let (displacement, stress) = patch_errors(&reduced);
    reduced.within("displacement against G x with 2x2x2 integration", displacement, 1e-10);
    reduced.within("stress with 2x2x2 integration", stress, 1e-9);
}

#[test]
fn e1_curved_patch() {
    check_patch("E1_patch_curved");
    let reduced = Case::check_reduced("E1_patch_curved", true);
    let (displacement, _) = patch_errors(&reduced);
    assert!(displacement > 1e-5, "2x2x2 points cannot pass with curved edges: {displacement:e}");
}

#[test]
fn e2_cantilever() {
    check_against_reference("E2_cantilever");
}

#[test]
fn e3_embankment_under_load() {
    check_against_reference("E3_embankment_patch");
}

#[test]
fn e3_embankment_under_its_weight() {
    let case = check_against_reference("E3_embankment_patchg");
    let weight = case.case["total_weight"].as_f64().unwrap();
    let vertical: f64 = case.nodes.column("rz").iter().sum();
    case.within("vertical reaction against the weight", (vertical / weight - 1.0).abs(), 1e-9);
}

#[test]
fn e6_thick_cylinder() {
    let case = check_against_reference("E6_thick_cylinder");
    // Lamé, plane strain: u_r = (1 + ν) p a² / (E (b² − a²)) ((1 − 2ν) r + b² / r).
    let (a, b, p, young, nu) = (0.5_f64, 1.0_f64, 10e6, 200e9, 0.3);
    let lame =
        |r: f64| (1.0 + nu) * p * a * a / (young * (b * b - a * a)) * ((1.0 - 2.0 * nu) * r + b * b / r);
    let list = fs::read_to_string(case.data.join("NODECOORD.DAT")).unwrap();
    let u = case.displacement();
    let mut error = 0.0_f64;
    for line in list.lines() {
        let x: Vec<f64> = line.split_whitespace().map(|f| f.parse().unwrap()).collect();
        let r = x[1].hypot(x[2]);
        let [ux, uy, _] = u[&(x[0] as u32)];
        error = error.max(((ux * x[1] + uy * x[2]) / r / lame(r) - 1.0).abs());
    }
    case.within("radial displacement against Lamé", error, 1e-4);
}

#[test]
fn e5_pulse_on_a_layered_column() {
    let case = Case::run("E5_column_pulse", &[]);
    let (found, reference) =
        (Table::read(&case.out.join("history.csv")), Table::read(&case.data.join("reference_history.csv")));
    assert_eq!((found.rows.len(), reference.rows.len()), (401, 401));
    for (a, b) in found.column("time").iter().zip(reference.column("t")) {
        assert!((a - b).abs() < 1e-12, "rows at the same times: {a} {b}");
    }
    let largest = |column: &[f64]| column.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let nodes: Vec<u64> = case.case["reference"]["history_nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_u64().unwrap())
        .collect();
    for (kind, tolerance) in [("u", 1e-6), ("v", 1e-5)] {
        // By column, without near-zero columns (see case.json).
        let columns: Vec<(String, Vec<f64>, Vec<f64>)> = nodes
            .iter()
            .flat_map(|n| ["x", "y", "z"].map(|d| (*n, d)))
            .map(|(n, d)| {
                let ours = found.column(&format!("n{n}_{kind}_{d}"));
                (format!("n{n} {kind}{d}"), ours, reference.column(&format!("n{n}_{kind}{d}")))
            })
            .collect();
        let most = columns.iter().map(|(_, _, r)| largest(r)).fold(0.0, f64::max);
        let (mut compared, mut worst) = (0, 0.0_f64);
        for (name, ours, theirs) in &columns {
            let scale = largest(theirs);
            if scale > 1e-3 * most {
                let difference: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| a - b).collect();
                let error = largest(&difference) / scale;
                assert!(error <= tolerance, "{name}: {error:e} is above {tolerance:e}");
                (compared, worst) = (compared + 1, worst.max(error));
            } else {
                assert!(largest(ours) <= 1e-3 * most, "{name} should hold next to nothing");
            }
        }
        println!("{compared} of {} columns of {kind} compared", columns.len());
        assert!(compared >= nodes.len(), "at least the vertical motion of every node counts");
        case.within(if kind == "u" { "displacement history" } else { "velocity history" }, worst, tolerance);
    }
    case.within("last displacement", case.displacement_error("reference_displacement_final.csv"), 1e-6);
    let summary = json(&case.out.join("summary.json"));
    case.within("energy error over the work", summary["energy"]["relative_error"].as_f64().unwrap(), 1e-9);
}
