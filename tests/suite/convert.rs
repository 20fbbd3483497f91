//! Files of older programs: decks, round trips, invalid files.

use super::scenes::vtk;
use super::support::{Folder, Outcome, json, repository, run, trackbed_in};
use std::f64::consts::PI;
use std::fs;

fn deck(name: &str) -> String {
    fs::read_to_string(repository().join("inputs/geo/decks").join(name)).unwrap()
}

fn convert(folder: &Folder, arguments: &[&str]) -> Outcome {
    trackbed_in(folder.path(), ["convert"].iter().chain(arguments))
}

/// Deck keys in the order of its comments.
const GEOLOGY: &str = "restart pattern BOND_MODEL nstep NFILL NGROWTH CTime NPrint NLast isearch icont IPATTERN DMAX/D DMIN/D \
     cc D dens YoungM PoissonR rns rzs amu eps X0 Y0 Z0 mxnb MAXNB_W GROWTH skin temperature nu_Wall eps_Wall gz ARF RPBN \
     RPBS BSTRENGTH BRATIO NICEX NICEY NICEZ TContact";
const GENERAL: &str = "restart pattern BOND_MODEL nstep Tstrain CTime NPrint MLast isearch icont IPATTERN DMAX/D DMIN/D cc D dens \
     YoungM YMSIGMA PoissonR rns rzs amu eps X0 Y0 Z0 mxnb skin temperature Nwall NPOINT nu_Wall eps_Wall gz BONDNS MEANBOND \
     BSIGMA TContact";

#[test]
fn both_decks_run() {
    let folder = Folder::new("decks");
    folder.write("geology.par", &deck("geology.par"));
    folder.write("general.par", &deck("general.par"));
    let said = convert(&folder, &["geology.par", "geology.toml"]).good().stdout;
    for (key, line) in GEOLOGY.split_whitespace().zip(said.lines()) {
        assert!(line.starts_with(&format!("{key}: ")), "{line}");
    }
    assert!(said.contains("NLast: output.last: "), "{said}");
    assert!(said.contains("ARF: not used: no coefficient of rolling friction is above 1"), "{said}");
    let scene = fs::read_to_string(folder.join("geology.toml")).unwrap();
    for part in [
        "counts = [11, 13, 42]",
        "stiffness = 15000000000.0",
        "tensile_strength = 16000000.0",
        "normal_stiffness = 84882636.3",
        "gravity = [0.0, 0.0, -9.8]",
    ] {
        assert!(scene.contains(part), "{part}\n{scene}");
    }
    run(
        &folder.join("geology.toml"),
        &folder.join("g"),
        &["time.end=0.2", "output.frames=1", "output.last="],
    )
    .good();
    assert_eq!(json(&folder.join("g/summary.json"))["model"]["bodies"], 6006);

    let refused = convert(&folder, &["general.par", "general.toml"]);
    assert_eq!(refused.code, 2);
    assert!(
        refused
            .stderr
            .contains("general.par:1: restart: found \".true.\", expected --packing FILE, or --box X,Y,Z")
    );
    let said = convert(&folder, &["general.par", "general.toml", "--box", "0.15,0.15,0.15"]).good().stdout;
    for (key, line) in GENERAL.split_whitespace().zip(said.lines()) {
        assert!(line.starts_with(&format!("{key}: ")), "{line}");
    }
    assert!(said.contains("wave height: not used: ") && said.contains("doubtful"), "{said}");
    let scene = fs::read_to_string(folder.join("general.toml")).unwrap();
    assert!(scene.contains("spread = { kind = \"normal\", deviation = 0.15 }"), "{scene}");
    // Of grains and of bonds.
    let spread = "stiffness_spread = { kind = \"normal\", deviation = 0.2 }";
    assert_eq!(scene.matches(spread).count(), 2, "{scene}");
    // Random positions have no contacts: deposited before bonding.
    let settle = [
        "time.end=0.001",
        "output.frames=1",
        "output.last=",
        "deposition={ max_time = 0.6 }",
        "bond.0.gap=0.0005",
    ];
    run(&folder.join("general.toml"), &folder.join("s"), &settle).good();
    let bonds = &json(&folder.join("s/summary.json"))["bonds"]["made"];
    assert!(bonds.as_u64().unwrap() > 500, "{bonds}");
}

#[test]
fn packings_are_read_by_decks() {
    let folder = Folder::new("packing");
    folder.write("old.dat", "3\n1 0 0 0.02 0.006\n2 0.012 0 0.02 0.006\n3 0.0D+0 1.2E-002 0.02 0.006\n");
    convert(&folder, &["old.dat", "packing.csv"]).good();
    let packing = fs::read_to_string(folder.join("packing.csv")).unwrap();
    assert_eq!(packing.lines().count(), 4, "{packing}");
    convert(&folder, &["packing.csv", "again.csv"]).good();
    assert_eq!(fs::read_to_string(folder.join("again.csv")).unwrap(), packing);
    folder.write("general.par", &deck("general.par"));
    convert(&folder, &["general.par", "scene.toml", "--packing", "packing.csv"]).good();
    run(
        &folder.join("scene.toml"),
        &folder.join("r"),
        &["time.end=0.001", "output.frames=1", "output.last="],
    )
    .good();
    let summary = json(&folder.join("r/summary.json"));
    assert_eq!((&summary["model"]["bodies"], &summary["bonds"]["made"]), (&3.into(), &2.into()));
}

const ANIMATION: &str = "3D: 0 2\n0 0 1 0.5 0 0 0 1\n0 0 2 0.5 0 0 -1 2\n3D: 0.25 2\n0 0 1 0.5 0 0 0 1\n0 0 1.75 0.5 0 0 -1.5 2\n";
const CHAINS: &str = "3DF: 0.25 2\n1 2 45895.55 22947.77\n1 0 12 0\n";

#[test]
fn animations_and_chains_come_back() {
    let folder = Folder::new("forms");
    folder.write("ANIMATION_3D.DAT", ANIMATION);
    folder.write("a.3df", CHAINS);
    convert(&folder, &["ANIMATION_3D.DAT", "same.dat"]).good();
    assert_eq!(fs::read_to_string(folder.join("same.dat")).unwrap(), ANIMATION);
    convert(&folder, &["a.3df", "same.3df"]).good();
    assert_eq!(fs::read_to_string(folder.join("same.3df")).unwrap(), CHAINS);
    // Column 1 of five counts.
    folder.write("five.3df", "3DF: 0.25 2\n2 1 2 45895.55 22947.77\n3 1 0 12 0\n");
    convert(&folder, &["five.3df", "four.3df"]).good();
    assert_eq!(fs::read_to_string(folder.join("four.3df")).unwrap(), CHAINS);
    convert(&folder, &["a.3df", "chains.csv"]).good();
    let table = fs::read_to_string(folder.join("chains.csv")).unwrap();
    assert!(table.starts_with("time [s],i,j,normal_force [N],tangential_force [N]\n"), "{table}");
    convert(&folder, &["ANIMATION_3D.DAT", "animation.csv"]).good();
    assert_eq!(fs::read_to_string(folder.join("animation.csv")).unwrap().lines().count(), 5);

    let said = convert(&folder, &["a.3df", "frames", "--grains", "ANIMATION_3D.DAT"]).good().stdout;
    assert!(said.starts_with("2 frames\n1 chains to walls omitted"), "{said}");
    convert(&folder, &["frames", "back.dat"]).good();
    assert_eq!(fs::read_to_string(folder.join("back.dat")).unwrap(), ANIMATION);
    convert(&folder, &["frames", "back.3df"]).good();
    assert_eq!(fs::read_to_string(folder.join("back.3df")).unwrap(), "3DF: 0.25 1\n1 2 45895.55 22947.77\n");
    convert(&folder, &["ANIMATION_3D.DAT", "hdf", "--format", "vtkhdf"]).good();
    assert!(folder.join("hdf/grains.vtkhdf").exists());
    let again = convert(&folder, &["a.3df", "same.3df"]);
    assert_eq!(again.code, 2);
    assert_eq!(
        again.stderr,
        "error: output: found same.3df, which exists, expected a new file, or --force\n"
    );
}

#[test]
fn a_run_becomes_an_animation() {
    let folder = Folder::new("run");
    folder.write(
        "scene.toml",
        r#"[[material]]
name = "rock"
density = 2600
stiffness = "100 kN/m"
friction = 0.5
restitution = 0.1
[[grains]]
name = "pair"
shape = "sphere"
material = "rock"
spheres = [[0, 0, 0.01, 0.01], [0, 0, 0.03, 0.01]]
[[walls]]
kind = "plane"
material = "rock"
point = [0, 0, 0]
normal = [0, 0, 1]
[time]
end = 0.3
[output]
frames = 1
"#,
    );
    run(&folder.join("scene.toml"), &folder.join("r"), &[]).good();
    convert(&folder, &["r", "a.dat"]).good();
    let animation = fs::read_to_string(folder.join("a.dat")).unwrap();
    assert_eq!(
        animation.lines().filter(|l| l.starts_with("3D: ") && l.ends_with(" 2")).count(),
        2,
        "{animation}"
    );
    convert(&folder, &["r", "a.3df"]).good();
    let chains = fs::read_to_string(folder.join("a.3df")).unwrap();
    let last: Vec<Vec<f64>> = chains
        .lines()
        .skip_while(|l| !l.starts_with("3DF: 0.3"))
        .skip(1)
        .map(|l| l.split(' ').map(|v| v.parse().unwrap()).collect())
        .collect();
    let weight = 2600.0 * std::f64::consts::PI / 6.0 * 8e-6 * 9.81;
    assert_eq!(last.len(), 2, "{chains}");
    for c in last {
        let expected = if c[1] == 0.0 { 2.0 * weight } else { weight };
        assert!((c[2] / expected - 1.0).abs() < 1e-3, "{chains}");
        assert!(c[1] == 0.0 || [c[0], c[1]] == [1.0, 2.0] || [c[0], c[1]] == [2.0, 1.0], "{chains}");
    }
}

/// Polyhedron on a plane, on it a disk, on it a sphere.
const STACK: &str = r#"[[material]]
name = "rock"
density = 2600
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.1
[[grains]]
name = "block"
shape = "polyhedron"
material = "rock"
frustum = { from = [0.3, 0, 0], to = [0.3, 0, 0.1], radii = [0.1, 0.08], sides = 8, radius = "0.01 m" }
[[grains]]
name = "disk"
shape = "disk"
aspect = 0.4
material = "rock"
packing = "disk.csv"
[[grains]]
name = "ball"
shape = "sphere"
material = "rock"
spheres = [[0.3, 0, 0.17, 0.03], [1, 0, 0.03, 0.03]]
[[walls]]
kind = "plane"
material = "rock"
point = [0, 0, 0]
normal = [0, 0, 1]
[time]
end = 0.3
[output]
frames = 1
"#;

/// Centres of chains between grains, from the first to the second partner.
fn ends_of(file: &std::path::Path) -> Vec<[[f64; 3]; 2]> {
    let (points, _, cells) = vtk(file);
    let count = cells["normal_force"].1.len();
    let point = |k: usize| [0, 1, 2].map(|d| points[3 * k + d]);
    let kind = &cells["kind"].1;
    (0..count).filter(|k| kind[*k] == 0.0).map(|k| [point(2 * k), point(2 * k + 1)]).collect()
}

#[test]
fn polyhedra_have_particles_and_chains() {
    let folder = Folder::new("stack");
    folder.write("scene.toml", STACK);
    folder.write("disk.csv", "0.3, 0, 0.12, 1, 0, 0, 0, 0.1, 0\n");
    run(&folder.join("scene.toml"), &folder.join("r"), &[]).good();
    for output in ["a.3df", "a.dat"] {
        convert(&folder, &["r", output]).good();
    }
    let block = |file: &str, head: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let rows = text.lines().skip_while(|l| !l.starts_with(&format!("{head} 0.3 "))).skip(1);
        rows.map(|l| l.split(' ').map(|v| v.parse().unwrap()).collect()).collect()
    };
    let (grains, chains) = (block("a.dat", "3D:"), block("a.3df", "3DF:"));
    // Two spheres, then block and disk: volumes of a cylinder and of a frustum of eight sides, corners cut.
    let volume = |k: usize| 4.0 / 3.0 * PI * f64::powi(grains[k][3], 3);
    assert_eq!(grains.len(), 4, "{grains:?}");
    assert!((0.8..1.0).contains(&(volume(2) / (PI * 0.1 * 0.0081))), "{grains:?}");
    assert!((0.75..1.0).contains(&(volume(3) / (PI * 0.0025 * 0.04))), "{grains:?}");
    let pair = |c: &Vec<f64>| [c[0].min(c[1]) as usize, c[0].max(c[1]) as usize];
    let sum = |of: [usize; 2]| chains.iter().filter(|c| pair(c) == of).map(|c| c[2]).sum::<f64>();
    assert!(chains.iter().all(|c| [[0, 2], [0, 3], [1, 4], [3, 4]].contains(&pair(c))), "{chains:?}");
    let ball = 2600.0 * 9.81 * volume(0);
    let close = |force: f64, expected: f64, limit: f64| {
        assert!((force / expected - 1.0).abs() < limit, "{force} N, expected {expected} N: {chains:?}");
    };
    close(sum([0, 2]), ball, 1e-3);
    close(sum([1, 4]), ball, 1e-2);
    // Weights of the drawn bodies.
    let disk = 2600.0 * 9.81 * volume(3);
    close(sum([3, 4]), ball + disk, 0.07);
    close(sum([0, 3]), ball + disk + 2600.0 * 9.81 * volume(2), 0.07);
    // Rows of the animation are the ends of the lines for VTK.
    let lines = ends_of(&folder.join("r/frames/chains_00001.vtp"));
    let rows = chains.iter().filter(|c| c[0] > 0.0 && c[1] > 0.0);
    let mut count = 0;
    for (line, row) in lines.iter().zip(rows) {
        for (end, of) in line.iter().zip(row) {
            let x = &grains[*of as usize - 1];
            assert!((0..3).all(|d| (x[d] - end[d]).abs() < 1e-12), "{x:?}, expected {end:?}");
        }
        count += 1;
    }
    assert!(count == lines.len() && count >= 2, "{lines:?}");
    convert(&folder, &["a.3df", "frames", "--grains", "a.dat"]).good();
    let back = ends_of(&folder.join("frames/frames/chains_00001.vtp"));
    assert_eq!(back.len(), lines.len());
    for (a, b) in back.as_flattened().iter().zip(lines.as_flattened()) {
        assert!((0..3).all(|d| (a[d] - b[d]).abs() < 1e-12), "{a:?}, expected {b:?}");
    }
    // Frames of earlier versions have no bodies.
    let file = folder.join("r/frames/walls_00001.vtp");
    let text = fs::read_to_string(&file).unwrap().replace("Name=\"body\"", "Name=\"bodies\"");
    fs::write(&file, text).unwrap();
    for output in ["b.3df", "b.dat"] {
        let outcome = convert(&folder, &["r", output]);
        let expected = "array body of CellData: found none, expected the bodies of polyhedra and disks; run the scene again";
        assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{}", outcome.stderr);
    }
}

#[test]
fn hostile_files_are_refused() {
    let folder = Folder::new("hostile");
    let good = deck("geology.par");
    let cases: Vec<(String, &str, &str)> = vec![
        (
            String::new(),
            "a.csv",
            "a: spheres: found none, expected a packing, an animation, force chains, or a deck",
        ),
        ("1 2\n".into(), "a.csv", "a:1: columns: found 2, expected x y z r, or these behind a number"),
        ("1 2 3 -1\n".into(), "a.csv", "a:1: radius: found -1, expected above 0"),
        ("2\n1 2 3 1\n".into(), "a.csv", "a: spheres: found 1, expected 2, as in the first row"),
        ("3D: 0 2\n0 0 0 1 0 0 0\n".into(), "a.csv", "a:1: rows: found 1, expected 2, as in the header"),
        ("3D: 0 1\n0 0 0 1 0 0\n".into(), "a.csv", "a:2: columns: found 6, expected 7 or 8"),
        (
            "3D: 0 1\n0 0 0 1 0 0 nan\n".into(),
            "a.csv",
            "a:2: number: found \"nan\", expected a finite number",
        ),
        ("3D: 0 1e99\n".into(), "a.csv", "a:1: number of rows: found 1e99, expected a whole number"),
        ("3DF: 0\n".into(), "a.csv", "a:1: 3DF:: found 1 numbers, expected time and number of rows"),
        (
            "3DF: 0 1\n1 -2 3 4\n".into(),
            "a.csv",
            "a:2: particle: found -2, expected the number of a particle",
        ),
        (
            "3DF: 0 1\n1 2 3 4\n".into(),
            "a.toml",
            "output: found a.toml, expected .csv, .3df, or a directory for frames for a",
        ),
        (
            good.replace("15.0   ", "-15.0  "),
            "a.toml",
            "a:14: D: found \"-15.0\", expected a diameter above 0",
        ),
        (good.replace("HEX", "BCC"), "a.toml", "a:2: pattern: found \"BCC\", expected HEX, FCC or LOS"),
        (good.replace("(rzs)", "(rns)"), "a.toml", "a:18: comment: found \"(rns)\", expected that of rzs"),
        (good.replace("0.5, 0.2 ", "0.5 "), "a.toml", "a:19: amu, eps: found 1 values, expected 2"),
        (
            good.replace(".true.", "maybe("),
            "a.toml",
            "a:1: restart: found \"maybe\", expected .true. or .false.",
        ),
        (
            good.lines().take(31).collect::<Vec<_>>().join("\n"),
            "a.toml",
            "a: lines with values: found 31, expected 32: the last is TContact",
        ),
    ];
    for (text, output, sentence) in cases {
        folder.write("a", &text);
        let outcome = convert(&folder, &["a", output]);
        assert_eq!(outcome.code, 2, "{text}: {outcome:?}");
        assert!(outcome.stderr.contains(sentence), "{sentence}\n{}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
        assert!(!folder.join(output).exists());
    }
}
