//! Bonds: closed forms, bond rules, lists, regions, breakage, restart.

use super::support::{Folder, Table, json, repository, run};
use std::fs;
use std::path::Path;
use trackbed::run::{Interrupt, Options, Verbosity};

/// Row of spheres 2 cm apart with gripped ends pulled apart; `bond`: its table.
fn row(bond: &str, end: &str) -> String {
    format!(
        r#"gravity = [0, 0, 0]
[[material]]
name = "rock"
density = 2600
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.5

[[grains]]
name = "foot"
shape = "sphere"
material = "rock"
spheres = [[0, 0, 0, 0.01]]
prescribed_velocity = [0, 0, 0]

[[grains]]
name = "middle"
shape = "sphere"
material = "rock"
spheres = [[0, 0, 0.02, 0.01], [0, 0, 0.04, 0.01], [0, 0, 0.06, 0.01]]

[[grains]]
name = "head"
shape = "sphere"
material = "rock"
spheres = [[0, 0, 0.08, 0.01]]
prescribed_velocity = [0, 0, "5 mm/s"]

{bond}
[time]
grain_step_fraction = 0.4
end = "{end}"
[output]
frames = 1
history_interval = "50 us"
"#
    )
}

const CEMENT: &str = r#"[[bond]]
name = "cement"
gap = "1 mm"
damping = 0.5
[bond.parallel]
young = "1 GPa"
stiffness_ratio = 2.5
tensile_strength = "0.2 MPa"
shear_strength = "0.4 MPa"
"#;

fn ran(folder: &Folder, text: &str) -> (serde_json::Value, Table) {
    run(&folder.write("scene.toml", text), &folder.join("out"), &[]).good();
    (json(&folder.join("out/summary.json")), Table::read(&folder.join("out/history.csv")))
}

fn breaks(folder: &Folder) -> Table {
    Table::read(&folder.join("out/breaks.csv"))
}

/// Four bonds in series, E A/L each, break at σ A = 62.83 N: elongation 4 × 4 µm, after 3.2 ms.
#[test]
fn a_row_is_pulled_apart() {
    let folder = Folder::new("row");
    let (summary, history) = ran(&folder, &row(CEMENT, "6 ms"));
    // By symmetry two bonds may break in one step.
    let broken = breaks(&folder).rows.len() as u64;
    assert!((1..=2).contains(&broken) && summary["bonds"]["made"] == 4);
    assert_eq!(summary["bonds"]["fragments"].as_u64(), Some(broken + 1));
    assert_eq!(summary["bonds"]["broken_by_tension"].as_u64(), Some(broken));
    let strength = 2e5 * std::f64::consts::PI * 1e-4;
    let pull = history.column("head_force_z").iter().fold(0.0_f64, |m, f| m.max(-f));
    assert!((pull / strength - 1.0).abs() < 0.02, "{pull} {strength}");
    let foot = history.column("foot_force_z").iter().fold(0.0_f64, |m, f| m.max(*f));
    assert!((foot / strength - 1.0).abs() < 0.02, "{foot}");
    let breaks = breaks(&folder);
    let time = breaks.column("time")[0];
    assert!((time - 3.2e-3).abs() < 1e-4, "{time}");
    // ½ T²/(E A/L), less the dashpot forces.
    let energy = breaks.column("energy")[0];
    let expected = 0.5 * strength * strength / (1e9 * std::f64::consts::PI * 1e-4 / 0.02);
    assert!((energy / expected - 1.0).abs() < 0.01, "{energy} {expected}");
    let all = summary["bonds"]["energy_of_breaks"].as_f64().unwrap();
    assert!((all / (broken as f64 * energy) - 1.0).abs() < 0.01);
    assert_eq!(history.column("released_by_breaks").last(), Some(&all));
    let error = summary["energy"]["largest_error"].as_f64().unwrap();
    assert!(error < 0.01 * 4.0 * expected, "{error}");
    assert_eq!(summary["energy"]["end"]["bonds"].as_f64(), history.column("bond_energy").last().copied());
    let head = history.column("head_z");
    // The run ends with a full window.
    let end = *history.column("time").last().unwrap();
    assert!((6e-3..6.1e-3).contains(&end), "{end}");
    assert!((head.last().unwrap() - 0.08 - 5e-3 * end).abs() < 1e-7);
}

#[test]
fn regions_lists_and_groups() {
    let folder = Folder::new("rules");
    let weak =
        format!("{CEMENT}[[bond.region]]\nlow = [-1, -1, 0.045]\nhigh = [1, 1, 0.055]\nstrength = 0.5\n");
    let (_, history) = ran(&folder, &row(&weak, "4 ms"));
    assert!((breaks(&folder).column("z")[0] - 0.05).abs() < 1e-4);
    let pull = history.column("head_force_z").iter().fold(0.0_f64, |m, f| m.max(-f));
    assert!((pull / 31.416 - 1.0).abs() < 0.03, "{pull}");

    folder.write("pairs.csv", "a,b\n0,1\n3, 4\n");
    let listed = CEMENT.replace("gap = \"1 mm\"", "pairs = \"pairs.csv\"");
    let (summary, _) = ran(&folder, &row(&listed, "0.2 ms"));
    assert_eq!(
        (summary["bonds"]["made"].as_u64(), summary["bonds"]["fragments"].as_u64()),
        (Some(2), Some(3))
    );

    let between = CEMENT.replace("gap", "between = [\"middle\", \"head\"]\ngap");
    let (summary, _) = ran(&folder, &row(&between, "0.2 ms"));
    assert_eq!(summary["bonds"]["made"], 1);
    let within = CEMENT.replace("gap", "between = [\"middle\", \"middle\"]\ngap");
    let (summary, _) = ran(&folder, &row(&within, "0.2 ms"));
    assert_eq!(summary["bonds"]["made"], 2);
    let both = format!("{within}\n{}", CEMENT.replace("cement", "glue"));
    let (summary, _) = ran(&folder, &row(&both, "0.2 ms"));
    assert_eq!(summary["bonds"]["made"], 4);
}

#[test]
fn strengths_spread_by_seed() {
    let folder = Folder::new("spread");
    let mut seen = Vec::new();
    for seed in 1..5 {
        let spread = format!("{CEMENT}[bond.spread]\nkind = \"weibull\"\nmodulus = 3.0\nseed = {seed}\n");
        let (_, history) = ran(&folder, &row(&spread, "6 ms"));
        let pull = history.column("head_force_z").iter().fold(0.0_f64, |m, f| m.max(-f));
        assert!(pull < 1.5 * 62.83 && pull > 1.0, "{pull}");
        seen.push((breaks(&folder).column("bond")[0] as u32, pull as u32));
    }
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() > 2, "{seen:?}");
}

#[test]
fn kinds_of_bonds() {
    let folder = Folder::new("kinds");
    for (kind, strength) in [
        (
            "[bond.contact_point]\nnormal_stiffness = \"15.7 MN/m\"\nshear_stiffness = \"5 MN/m\"\ntension_limit = 40\n",
            40.0,
        ),
        (
            "[bond.direct]\nstiffness = [1.57e7, 6e6, 390, 310]\nstrength = [50, 100, 0.1, 0.1]\ncriterion = \"sum\"\n",
            50.0,
        ),
        (
            "[bond.parallel]\nradius_factor = 0.5\nnormal_stiffness = 2e11\nshear_stiffness = 1e11\ntensile_strength = \"0.4 MPa\"\n\
             shear_strength = \"1 MPa\"\nfriction_angle = \"30 deg\"\nmoment_factor = 0.5\n",
            4e5 * std::f64::consts::PI * 25e-6,
        ),
    ] {
        let bond = format!("[[bond]]\nname = \"b\"\ngap = \"1 mm\"\ndamping = 0.5\n{kind}");
        let (_, history) = ran(&folder, &row(&bond, "6 ms"));
        let pull = history.column("head_force_z").iter().fold(0.0_f64, |m, f| m.max(-f));
        assert!((pull / strength - 1.0).abs() < 0.03, "{pull} {strength}");
        assert_eq!(breaks(&folder).column("shear")[0], 0.0);
    }
}

#[test]
fn bonded_beam_sags_as_predicted() {
    let folder = Folder::new("beam");
    let out = folder.join("out");
    run(&repository().join("inputs/verify/bonded_beam.toml"), &out, &["output.vtk=false"]).good();
    let tip = Table::read(&out.join("history.csv")).column("tip_z");
    let mean = -tip.iter().sum::<f64>() / tip.len() as f64;
    println!("bonded beam: tip sags by {mean:e} m, predicted 3.1469e-4 m");
    assert!((mean / 3.1469e-4 - 1.0).abs() < 0.02, "{mean}");
    assert!(tip[0] == 0.0);
}

#[test]
fn a_stone_is_crushed() {
    let folder = Folder::new("stone");
    let out = folder.join("out");
    let scene = repository().join("inputs/grains/bonded_stone/scene.toml");
    run(&scene, &out, &["output.frames=2", "time.end=0.12"]).good();
    let summary = json(&out.join("summary.json"));
    let bonds = &summary["bonds"];
    let breaks = Table::read(&out.join("breaks.csv"));
    println!("crushed stone: {bonds}, energy {}", summary["energy"]);
    assert_eq!(bonds["made"], 486);
    let broken = bonds["broken_by_tension"].as_u64().unwrap() + bonds["broken_by_shear"].as_u64().unwrap();
    assert!(broken > 20 && bonds["fragments"].as_u64().unwrap() > 1, "{bonds}");
    assert_eq!(breaks.rows.len() as u64, broken);
    let energy: f64 = breaks.column("energy").iter().sum();
    assert!((energy / bonds["energy_of_breaks"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 0.01, "{}", summary["energy"]);
    let frame = fs::read(out.join("frames/grains_00002.vtp")).unwrap();
    assert!(frame.windows(8).any(|w| w == b"fragment"));
}

/// First tenth of the rock test: equal grip forces, modulus as in `docs/guide/slopes.md`.
#[test]
fn rock_is_compressed() {
    let folder = Folder::new("rock");
    let out = folder.join("out");
    let scene = repository().join("inputs/geo/rock-ucs/scene.toml");
    let set = ["time.end=0.003", "output.frames=0", "grains.2.prescribed_velocity=[0.0, 0.0, -0.02]"];
    run(&scene, &out, &set).good();
    assert_eq!(json(&out.join("summary.json"))["bonds"]["made"], 19480);
    let history = Table::read(&out.join("history.csv"));
    let (top, bottom) = (history.column("top_force_z"), history.column("bottom_force_z"));
    let strain: Vec<f64> = history.column("time").iter().map(|t| t * 0.02 / 0.36).collect();
    let last = top.len() - 1;
    let from = strain.iter().position(|s| *s > 7e-5).unwrap();
    let force = |k: usize| 0.5 * (top[k] - bottom[k]);
    let slope = (force(last) - force(from)) / (strain[last] - strain[from]);
    println!("rock: {slope:e} N per unit of strain");
    assert!((slope / 7.858e7 - 1.0).abs() < 0.06, "{slope:e}");
}

#[test]
fn breaking_is_resumed() {
    let folder = Folder::new("resumed");
    let scene = repository().join("inputs/grains/bonded_stone/scene.toml");
    let options = |out: &Path, threads| Options {
        out: Some(out.to_path_buf()),
        threads: Some(threads),
        set: ["output.frames=1", "time.end=0.12"].map(String::from).to_vec(),
        verbosity: Verbosity::Quiet,
        ..Options::default()
    };
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    trackbed::run::run(&scene, &options(&whole, 1)).unwrap();
    let steps = json(&whole.join("summary.json"))["stages"][0]["windows"].as_u64().unwrap();
    for (k, share) in [0.9, 0.05].into_iter().enumerate() {
        let interrupt = Interrupt::after((share * steps as f64) as u64);
        let stopped =
            trackbed::run::run(&scene, &Options { interrupt, resume: k > 0, ..options(&broken, 2) });
        assert!(stopped.is_err());
    }
    trackbed::run::run(&scene, &Options { resume: true, ..options(&broken, 1) }).unwrap();
    for name in ["history.csv", "breaks.csv", "frames/grains_00001.vtp"] {
        let [a, b] = [&whole, &broken].map(|dir| fs::read(dir.join(name)).unwrap());
        assert!(a == b, "{name} differs after a restart");
    }
    assert!(Table::read(&whole.join("breaks.csv")).rows.len() > 20);
}
