//! Meshed sleepers, free on the grains.

use super::determinism::{SMALL, same_bits_on};
use super::support::{Folder, Table, json, run};
use nalgebra::{Matrix4, RowVector4, Vector4};
use std::fmt::Write;
use std::path::Path;

/// Length, width, height [m].
const SIZE: [f64; 3] = [2.6, 0.28, 0.2];
const MASS: f64 = 360.0;
/// Stiffness of a ball with its two contacts in series [N/m].
const BALL: f64 = 0.6e6;
const ALONG: usize = 26;

/// Long sleeper on two rows of balls on rigid ground, a Winkler bed.
fn on_balls(mesh: &str, load: &str, more: &str) -> String {
    let mut balls = String::new();
    for i in 0..ALONG {
        let x = SIZE[0] * ((i as f64 + 0.5) / ALONG as f64 - 0.5);
        write!(balls, "[{x:.6}, -0.07, 0.05, 0.05], [{x:.6}, 0.07, 0.05, 0.05], ").unwrap();
    }
    format!(
        r#"title = "sleeper on balls"

[solid]
block = {{ x = {{ lines = [-1.5, 1.5], counts = [6] }}, y = {{ lines = [-0.25, 0.25], counts = [1] }}, z = {{ lines = [-0.5, 0.0], counts = [1] }} }}

[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]

[[solid.material]]
id = 1
name = "rock"
young = "4000 GPa"
poisson = 0.3
density = 5000

[[material]]
name = "steel"
density = 2650
stiffness = {}
friction = 0.5
restitution = 0.2

[[grains]]
name = "balls"
shape = "sphere"
material = "steel"
spheres = [{balls}]

[track.sleeper]
size = {SIZE:?}
mass = {MASS}
material = "steel"
centre = [0, 0]
{more}
{mesh}
{load}
[coupling]
substeps = 4
material = "steel"
"#,
        2.0 * BALL
    )
}

const STEP: &str = "time.grain_step=20 us";

const CONCRETE: &str = "[track.sleeper.mesh]\nelements = [16, 2, 2]\nyoung = \"30 GPa\"\npoisson = 0.2\n";

fn ran(text: &str, set: &[&str]) -> (Folder, Table) {
    let folder = Folder::new("meshed");
    let scene = folder.write("scene.toml", text);
    let out = folder.join("out");
    run(&scene, &out, set).good();
    let table = Table::read(&out.join("history.csv"));
    (folder, table)
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    let k =
        table.heads.iter().position(|h| h == name).unwrap_or_else(|| panic!("no {name}: {:?}", table.heads));
    table.rows.iter().map(|r| r[k]).collect()
}

fn last(table: &Table, name: &str) -> f64 {
    *column(table, name).last().unwrap()
}

fn energy_error(out: &Path) -> f64 {
    json(&out.join("summary.json"))["energy"]["relative_error"].as_f64().unwrap()
}

#[test]
fn contact_force_at_rest_equals_weight() {
    let (folder, table) = ran(&on_balls(CONCRETE, "", "[time]\nend = \"0.5 s\"\n"), &[STEP]);
    let weight = MASS * 9.81;
    let contact = last(&table, "sleeper_contact_z");
    let balls = 2.0 * ALONG as f64 * 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3) * 9.81;
    let ground = -last(&table, "contact_force_on_solid_z");
    println!(
        "contact over weight less 1: {:.1e}; on the ground {:.1e}; energy {:.1e}",
        contact / weight - 1.0,
        ground / (weight + balls) - 1.0,
        energy_error(&folder.join("out"))
    );
    assert!((contact / weight - 1.0).abs() < 1e-6, "{contact} {weight}");
    assert!((ground / (weight + balls) - 1.0).abs() < 1e-6, "{ground}");
    assert!(energy_error(&folder.join("out")) < 3e-4);
}

#[test]
fn contacts_use_sleeper_material() {
    let soft = "\n[[material]]\nname = \"soft\"\nstiffness = 0.4e6\nfriction = 0.5\nrestitution = 0.2\n\n[time]\nend = \"0.6 s\"\n";
    let (folder, table) = ran(&on_balls(CONCRETE, "", soft), &["coupling.material=soft"]);
    let z = column(&table, "sleeper_z");
    let (sleeper, count) = (MASS * 9.81, 2.0 * ALONG as f64);
    let ball = 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3) * 9.81;
    // Combined stiffness 2 k₁ k₂/(k₁ + k₂).
    let own = 2.0 * BALL;
    let pair = 2.0 * own * 0.4e6 / (own + 0.4e6);
    let expected = sleeper / count / own + (sleeper / count + ball) / pair;
    let lowered = z[0] - z[z.len() - 1];
    println!("lowered by {:.6} mm, springs {:.6} mm", 1e3 * lowered, 1e3 * expected);
    assert!((lowered / expected - 1.0).abs() < 5e-4, "{lowered} {expected}");
    let classes = json(&folder.join("out/summary.json"))["coupling"]["classes"].clone();
    let stiffness = |k: usize| classes[k]["stiffness"].as_f64().unwrap();
    assert!(
        (stiffness(0) / pair - 1.0).abs() < 1e-12 && (stiffness(1) / own - 1.0).abs() < 1e-12,
        "{classes}"
    );
}

/// Deflection w at middle and end of a Timoshenko beam on a Winkler foundation under a central force, on half
/// the length. EI w'''' − EI k/(κGA) w'' + k w = 0, φ = w' + EI/(κGA) (w''' − k/(κGA) w'). Middle: κGA (w' −
/// φ) = −P/2, φ = 0; end: φ' = 0, w' = φ (Hetényi, Beams on Elastic Foundation, 1946, with Timoshenko's
/// shear).
fn beam(force: f64, half: f64, bending: f64, shear: f64, foundation: f64) -> [f64; 2] {
    let (size, real) = ((foundation / bending).sqrt(), 0.5 * foundation / shear);
    let (a, b) = ((0.5 * (size + real)).sqrt(), (0.5 * (size - real)).sqrt());
    // ch c, sh s, ch s, sh c of ax, bx, and the matrix of their derivatives.
    let at = |x: f64| {
        let (sh, ch, (s, c)) = ((a * x).sinh(), (a * x).cosh(), (b * x).sin_cos());
        RowVector4::new(ch * c, sh * s, ch * s, sh * c)
    };
    #[rustfmt::skip]
    let d = Matrix4::new(
        0.0, 0.0, b, a,
        0.0, 0.0, a, -b,
        -b, a, 0.0, 0.0,
        a, b, 0.0, 0.0,
    );
    let w = |x: f64, n: u32| (0..n).fold(at(x), |row, _| row * d);
    let ratio = bending / shear;
    let slip = |x: f64| -ratio * (w(x, 3) - w(x, 1) * (foundation / shear));
    let turn = |x: f64| w(x, 1) - slip(x);
    let curve = |x: f64| w(x, 2) - w(x, 0) * (foundation / shear);
    let rows = Matrix4::from_rows(&[slip(0.0) * shear, turn(0.0), curve(half), slip(half)]);
    let c = rows.lu().solve(&Vector4::new(-0.5 * force, 0.0, 0.0, 0.0)).unwrap();
    [0.0, half].map(|x| (at(x) * c)[0])
}

#[test]
fn deflection_matches_beam_on_foundation() {
    let (low, high) = (1e3, 21e3);
    let load = format!(
        "[track.load]\nkind = \"ramp\"\nminimum = {low}\nmaximum = {high}\nrise = 0.2\nhold = 0.5\nrest = 0.3\nramp = 0.2\n"
    );
    let mesh = format!("{CONCRETE}foot = [0.02, 0.28]\n");
    let ground = trackbed_fem::mesh::Mesh::block([6, 1, 1], [1.0; 3]).node_count();
    let block = trackbed_fem::mesh::Mesh::block([16, 2, 2], SIZE);
    let node = |x: f64| {
        let at = |c: &[f64; 3]| (c[0] - x).abs() + (c[1] - 0.14).abs() + c[2].abs() < 1e-9;
        ground + 1 + block.coordinates.iter().position(at).unwrap()
    };
    let probes = format!(
        "[[probe]]\nname = \"middle\"\nnode = {}\n\n[[probe]]\nname = \"end\"\nnode = {}\n",
        node(1.3),
        node(0.0)
    );
    let (folder, table) = ran(&(on_balls(&mesh, &load, "") + &probes), &[]);
    let (time, force) = (column(&table, "time"), column(&table, "load"));
    let before = time.iter().rposition(|t| *t <= 0.5).unwrap();
    assert!((force[before] / low - 1.0).abs() < 1e-3 && (force.last().unwrap() / high - 1.0).abs() < 1e-9);
    let share = force.last().unwrap() - force[before];
    let sunk = |name: &str| {
        let u = column(&table, name);
        u[before] - u[u.len() - 1]
    };
    let found = [sunk("middle_u_z"), sunk("end_u_z")];
    let [l, b, h] = SIZE;
    let (young, poisson) = (30e9, 0.2);
    let bending = young * b * h.powi(3) / 12.0;
    let shear = 5.0 / 6.0 * young / (2.0 * (1.0 + poisson)) * b * h;
    let foundation = 2.0 * ALONG as f64 * BALL / l;
    let expected = beam(share, 0.5 * l, bending, shear, foundation);
    let without = beam(share, 0.5 * l, bending, 1e6 * shear, foundation);
    let bend = column(&table, "sleeper_bend");
    let bend = bend[bend.len() - 1] - bend[before];
    println!(
        "middle {:.4} mm, closed form {:.4} (without shear {:.4}); end {:.4} mm, closed form {:.4} ({:.4}); bend {:.4} mm; \
         energy {:.1e}",
        1e3 * found[0],
        1e3 * expected[0],
        1e3 * without[0],
        1e3 * found[1],
        1e3 * expected[1],
        1e3 * without[1],
        1e3 * bend,
        energy_error(&folder.join("out"))
    );
    // Equilibrium with the bed, and clearly flexible.
    assert!(expected[0] > 1.8 * expected[1] && expected[1] > 0.0);
    for k in 0..2 {
        assert!((found[k] / expected[k] - 1.0).abs() < 0.03, "{found:?} {expected:?}");
    }
    assert!((bend / (expected[0] - expected[1]) - 1.0).abs() < 0.03, "{bend}");
    assert!(energy_error(&folder.join("out")) < 1e-3);
}

/// Without shear: handbook solution of a free beam, central force, λL = 3.
#[test]
fn closed_form_matches_handbook() {
    let (half, foundation) = (1.5, 4.0);
    let [middle, end] = beam(1.0, half, 1.0, 1e9, foundation);
    // λ = 1: w₀ = Pλ/2k · (cosh λL + cos λL + 2)/(sinh λL + sin λL); w_end = 2Pλ/k · cosh(λL/2)
    // cos(λL/2)/(sinh λL + sin λL).
    let l = 2.0 * half;
    let base = l.sinh() + l.sin();
    assert!((middle / ((l.cosh() + l.cos() + 2.0) / (2.0 * foundation * base)) - 1.0).abs() < 1e-6);
    assert!((end / (2.0 / foundation * half.cosh() * half.cos() / base) - 1.0).abs() < 1e-6);
}

#[test]
fn stiff_mesh_on_springs_is_rigid() {
    let load = "[track.load]\nkind = \"ramp\"\nminimum = 1e3\nmaximum = 21e3\nrise = 0.2\nhold = 0.4\nrest = 0.3\nramp = 0.2\n\
                seats = [[-0.75, 0], [0.75, 0]]\n";
    let stiff = CONCRETE.replace("30 GPa", "2000 GPa");
    let lowered = |mesh: &str| {
        let (folder, table) = ran(&on_balls(mesh, load, ""), &[]);
        let z = column(&table, "sleeper_z");
        let record = &json(&folder.join("out/summary.json"))["track"]["sleepers"][0];
        (z[0] - z[z.len() - 1], record["lowering"].as_f64().unwrap(), record["bend"].is_array())
    };
    let (rigid, meshed) = (lowered(""), lowered(&stiff));
    println!("lowered by {:.6} mm rigid, {:.6} mm meshed", 1e3 * rigid.0, 1e3 * meshed.0);
    assert!(rigid.0 > 7e-4 && !rigid.2 && meshed.2);
    for (a, b) in [(rigid.0, meshed.0), (rigid.1, meshed.1)] {
        assert!((a / b - 1.0).abs() < 0.002, "{rigid:?} {meshed:?}");
    }
}

fn on_ground(half: [f64; 2], grains: &str, track: &str) -> String {
    let wall = |d: usize, sign: f64| {
        let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
        (point[d], normal[d]) = (-sign * half[d], sign);
        format!(
            "[[walls]]\nkind = \"plane\"\npoint = {point:?}\nnormal = {normal:?}\nmaterial = \"stone\"\n\n"
        )
    };
    let walls = [wall(0, 1.0), wall(0, -1.0), wall(1, 1.0), wall(1, -1.0)].concat();
    format!(
        r#"title = "sleepers on stones on ground"

[solid]
block = {{ x = {{ lines = [-0.6, 0.6], counts = [4] }}, y = {{ lines = [-0.4, 0.4], counts = [3] }}, z = {{ lines = [-0.4, 0.0], counts = [2] }} }}
rayleigh = {{ damping_ratio = 0.03, frequencies = [20, 200] }}

[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]

[[solid.material]]
id = 1
young = "60 MPa"
poisson = 0.3
density = 2000

[[material]]
name = "stone"
density = 2650
stiffness = "2 MN/m"
friction = 0.6
restitution = 0.3

[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
{grains}
{walls}{track}
[coupling]
substeps = 4
material = "stone"

[output]
frames = 2
"#
    )
}

fn on_layers(mesh: &str) -> String {
    let mut spheres = String::new();
    for (nx, ny, z) in [(7, 5, 0.05), (6, 4, 0.05 + 0.1 * 0.5_f64.sqrt())] {
        for k in 0..nx * ny {
            let at = |i: usize, n: usize| 0.1 * (i as f64 - 0.5 * (n - 1) as f64);
            let (x, y) = (at(k % nx, nx), at(k / nx, ny));
            write!(spheres, "[{x:.3}, {y:.3}, {z:.6}, 0.05], ").unwrap();
        }
    }
    let track = format!(
        "[track.sleeper]\nsize = [0.6, 0.4, 0.15]\nmass = 60\nmaterial = \"stone\"\ncentre = [0, 0]\n\n{mesh}\n[track.load]\n\
         kind = \"haversine\"\nminimum = \"500 N\"\nmaximum = \"10 kN\"\nfrequency = 10\ncycles = 3\nrest = 0.08\n\
         ramp = 0.02\nseats = [[-0.2, 0], [0.2, 0]]\n"
    );
    // Mass-proportional Rayleigh damping would act on the meshed sleeper but not on the rigid box.
    on_ground([0.35, 0.25], &format!("spheres = [{spheres}]\n"), &track)
        .replace("rayleigh = { damping_ratio = 0.03, frequencies = [20, 200] }\n", "")
}

#[test]
fn stiff_mesh_on_grains_is_rigid() {
    let gone = |mesh: &str| {
        let (folder, _) = ran(&on_layers(mesh), &[STEP]);
        let out = folder.join("out");
        let summary = json(&out.join("summary.json"));
        assert_eq!(summary["warnings"].as_array().unwrap().len(), 0, "{}", summary["warnings"]);
        assert!(summary["coupling"]["transfer"]["force"].as_f64().unwrap() < 1e-12);
        assert!(summary["coupling"]["transfer"]["moment"].as_f64().unwrap() < 1e-12);
        assert!(summary["momentum"]["linear"].as_f64().unwrap() < 1e-9, "{}", summary["momentum"]);
        let cycles = Table::read(&out.join("cycles.csv"));
        let columns = ["settlement", "resilient_deflection", "secant_stiffness", "dissipated_energy"];
        (columns.map(|name| column(&cycles, name)), energy_error(&out))
    };
    let (rigid, meshed) =
        (gone(""), gone("[track.sleeper.mesh]\nelements = [4, 3, 1]\nyoung = \"2000 GPa\"\npoisson = 0.2\n"));
    println!("rigid {rigid:?}\nmeshed {meshed:?}");
    let ([s, r, k, e], [settled, resilient, stiffness, energy]) = (&rigid.0, &meshed.0);
    for i in 0..3 {
        assert!((resilient[i] / r[i] - 1.0).abs() < 0.002, "{resilient:?}");
        assert!((stiffness[i] / k[i] - 1.0).abs() < 0.002, "{stiffness:?}");
        assert!((settled[i] - s[i]).abs() < 0.002 * r[i], "{settled:?}");
        assert!((energy[i] / e[i] - 1.0).abs() < 0.02, "{energy:?}");
    }
    assert!(rigid.1 < 1e-3 && meshed.1 < 1e-3);
}

#[test]
fn late_interface_dashpots_give_warning() {
    let (folder, _) = ran(&on_layers(""), &["coupling.substeps=20"]);
    let summary = json(&folder.join("out/summary.json"));
    let remarked = |summary: &serde_json::Value| {
        let warnings = summary["warnings"].to_string();
        assert!(warnings.contains("coupling may be unstable"), "{warnings}");
        assert!(warnings.contains("coupling: interface dashpot error "), "{warnings}");
    };
    remarked(&summary);
    let spent = |key: &str| summary["energy"]["flows"][key].as_f64().unwrap();
    assert!(spent("interface_dashpot_error") < -spent("dashpot"), "{}", summary["energy"]);
    assert_eq!(summary["verdict"]["outcome"], "warned");
    let longer =
        super::support::run(&folder.join("scene.toml"), &folder.join("out"), &["coupling.substeps=60"]);
    assert_eq!(longer.code, 3, "{}", longer.stderr);
    assert!(longer.stderr.contains("energy error: "), "{}", longer.stderr);
    remarked(&json(&folder.join("out/summary.json")));
}

fn on_a_bed() -> String {
    let grains = "count = 220\nsize = [\"80 mm\", \"100 mm\"]\nfill = { low = [-0.5, -0.3, 0.0], high = [0.5, 0.3] }\nseed = 5\n";
    let track = "[deposition]\nmax_time = 0.1\nlocal_damping = 0.2\n\n[track.sleeper]\nsize = [0.36, 0.4, 0.15]\nmass = 60\n\
                 material = \"stone\"\ncentre = [-0.24, 0]\ncount = 2\nspacing = 0.48\nalong = \"x\"\n\n[track.sleeper.mesh]\n\
                 elements = [2, 3, 1]\nyoung = \"30 GPa\"\npoisson = 0.2\n\n[track.load]\nkind = \"haversine\"\nminimum = 500\n\
                 maximum = 3000\nfrequency = 25\ncycles = 1\nrest = 0.08\nramp = 0.02\nseats = [[0, -0.1], [0, 0.1]]\n";
    on_ground([0.5, 0.3], grains, track)
}

#[test]
fn the_same_bits_on_any_threads() {
    let mesh = "track.sleeper.mesh={ elements = [10, 2, 2], young = 3e10, poisson = 0.2 }";
    let set: Vec<&str> = SMALL.into_iter().chain([mesh, "solid.reduction="]).collect();
    let scene = super::support::repository().join("inputs/track/cyclic/scene.toml");
    let expected = ["history.csv", "cycles.csv", "frames/solid_00002.vtu"];
    let folder = same_bits_on(["1", "3"], &scene, &set, &expected);
    let table = Table::read(&folder.join("1/history.csv"));
    assert!(column(&table, "sleeper_contact_z").iter().any(|f| *f > 100.0), "stones do carry it");
}

#[test]
fn resumes_bitwise() {
    let folder = Folder::new("meshed_broken");
    let scene = folder.write("scene.toml", &on_a_bed());
    let plastic = [
        "solid.material.0.model=mohr_coulomb",
        "solid.material.0.cohesion=3000",
        "solid.material.0.friction=0.6",
        "solid.material.0.dilation=0.1",
        "solid.initial_stress={ method = \"k0\", k0 = 0.5 }",
    ];
    for more in [
        &[][..],
        &["coupling.scheme=stiffened", "coupling.transfer={ spread = 0.05 }"],
        &["coupling.scheme=lagged", "coupling.substeps=2"],
        &plastic,
    ] {
        let set = [&["output.tables=true"], more].concat();
        super::checkpoint::broken(&scene, &set, &[0.1, 0.9, 0.97, 1.0], &["cycles.csv", "nodes.csv"]);
    }
}

#[test]
fn missing_numerical_damping_gives_warning() {
    let text = on_balls(CONCRETE, "", "[time]\nend = \"1 ms\"\n");
    for (theta, remarks) in [("0.5", 1), ("0.6", 0)] {
        let (folder, _) = ran(&text, &[&format!("coupling.theta={theta}")]);
        let summary = json(&folder.join("out/summary.json"));
        let warnings = summary["warnings"].as_array().unwrap();
        assert_eq!(warnings.len(), remarks, "{warnings:?}");
        let right = |w: &serde_json::Value| w.as_str().unwrap().contains("Set coupling.theta = 0.60");
        assert!(warnings.iter().all(right), "{warnings:?}");
    }
}

#[test]
fn ground_without_weight() {
    let text = on_balls(CONCRETE, "", "[time]\nend = \"0.4 s\"\n");
    let (_, table) = ran(&text, &["solid.gravity=false", STEP]);
    let contact = last(&table, "sleeper_contact_z");
    assert!((contact / (MASS * 9.81) - 1.0).abs() < 1e-5, "{contact}");
}

#[test]
fn the_scene_of_the_guide() {
    let folder = Folder::new("meshed_scene");
    let (scene, out) =
        (super::support::repository().join("inputs/track/meshed_sleeper/scene.toml"), folder.join("out"));
    let set = [
        "grains.0.count=100",
        "compaction=",
        "deposition.max_time=0.1",
        "track.load.cycles=1",
        "output.frames=2",
    ];
    run(&scene, &out, &set).good();
    let summary = json(&out.join("summary.json"));
    let sleeper = &summary["track"]["sleepers"][0];
    println!("{sleeper}\nenergy {:.1e}", energy_error(&out));
    assert!((sleeper["largest_force"].as_f64().unwrap() / 40e3 - 1.0).abs() < 1e-3, "{sleeper}");
    assert_eq!(sleeper["bend"].as_array().unwrap().len(), 2);
    assert!(energy_error(&out) < 3e-3);
    let classes = summary["coupling"]["classes"].as_array().unwrap();
    assert!(classes.iter().any(|c| c["solid"] == "sleeper" && c["masses"]["corner"].as_f64().unwrap() > 1.0));
}
