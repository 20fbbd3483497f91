//! Sleepers of elements that lie free on the grains.

use super::determinism::same_bits;
use super::support::{Folder, Table, json, run};
use nalgebra::{Matrix4, RowVector4, Vector4};
use std::fmt::Write;
use std::path::Path;

/// Length, width, height of the long sleeper [m].
const SIZE: [f64; 3] = [2.6, 0.28, 0.2];
/// Its mass [kg].
const MASS: f64 = 360.0;
/// Stiffness of a ball between ground and sleeper [N/m]: two contacts in a row.
const BALL: f64 = 0.6e6;
/// Balls along the sleeper, in two rows.
const ALONG: usize = 26;

/// A long sleeper on balls in two rows on ground that does not give: a bed of springs. `more` follows the sleeper.
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

/// Elements of concrete.
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
    let k = table.heads.iter().position(|h| h == name).unwrap_or_else(|| panic!("no {name}: {:?}", table.heads));
    table.rows.iter().map(|r| r[k]).collect()
}

fn last(table: &Table, name: &str) -> f64 {
    *column(table, name).last().unwrap()
}

/// Energy not accounted for over what was turned over.
fn energy_error(out: &Path) -> f64 {
    json(&out.join("summary.json"))["energy"]["relative_error"].as_f64().unwrap()
}

#[test]
fn at_rest_it_weighs_what_it_weighs() {
    let (folder, table) = ran(&on_balls(CONCRETE, "", "[time]\nend = \"0.5 s\"\n"), &[]);
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
    assert!(energy_error(&folder.join("out")) < 1e-4);
}

/// Deflection and its derivatives of a Timoshenko beam on a Winkler foundation under a force at its middle, half of it from
/// 0 to `half`: EI w'''' − EI k/(κGA) w'' + k w = 0, φ = w' + EI/(κGA) (w''' − k/(κGA) w'), with κGA (w' − φ) = −P/2 and φ
/// = 0 in the middle, φ' = 0 and w' = φ at the end (Hetényi, Beams on Elastic Foundation, 1946, with the shear of
/// Timoshenko). Comes back with w in the middle and at the end.
fn beam(force: f64, half: f64, bending: f64, shear: f64, foundation: f64) -> [f64; 2] {
    let (size, real) = ((foundation / bending).sqrt(), 0.5 * foundation / shear);
    let (a, b) = ((0.5 * (size + real)).sqrt(), (0.5 * (size - real)).sqrt());
    // ch c, sh s, ch s, sh c of ax, bx; and what their derivatives are of these.
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

/// A force in the middle of the long sleeper bends it as a beam on an elastic foundation.
#[test]
fn it_bends_as_a_beam_on_an_elastic_foundation() {
    let (low, high) = (1e3, 21e3);
    let load = format!(
        "[track.load]\nkind = \"ramp\"\nminimum = {low}\nmaximum = {high}\nrise = 0.2\nhold = 0.5\nrest = 0.3\nramp = 0.2\n"
    );
    let mesh = format!("{CONCRETE}foot = [0.02, 0.28]\n");
    // Nodes of the base on the middle line: at the end, and in the middle. The ground has 6 × 1 × 1 elements.
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
    // Before the cycle at the lower load, after it at the higher.
    let before = time.iter().rposition(|t| *t <= 0.5).unwrap();
    assert!((force[before] / low - 1.0).abs() < 1e-9 && (force.last().unwrap() / high - 1.0).abs() < 1e-9);
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
    let expected = beam(high - low, 0.5 * l, bending, shear, foundation);
    let without = beam(high - low, 0.5 * l, bending, 1e6 * shear, foundation);
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
    // The force is in equilibrium with the bed, and the beam is far from rigid.
    assert!(expected[0] > 1.8 * expected[1] && expected[1] > 0.0);
    for k in 0..2 {
        assert!((found[k] / expected[k] - 1.0).abs() < 0.03, "{found:?} {expected:?}");
    }
    assert!((bend / (expected[0] - expected[1]) - 1.0).abs() < 0.03, "{bend}");
    assert!(energy_error(&folder.join("out")) < 1e-3);
}

/// The closed form without shear is that of the handbook: a free beam with a force in the middle, λL = 3.
#[test]
fn the_closed_form_is_that_of_the_handbook() {
    let (half, foundation) = (1.5, 4.0);
    let [middle, end] = beam(1.0, half, 1.0, 1e9, foundation);
    // λ = 1: w₀ = Pλ/2k · (cosh λL + cos λL + 2)/(sinh λL + sin λL); w_end = 2Pλ/k · cosh(λL/2) cos(λL/2)/(sinh λL + sin λL).
    let l = 2.0 * half;
    let base = l.sinh() + l.sin();
    assert!((middle / ((l.cosh() + l.cos() + 2.0) / (2.0 * foundation * base)) - 1.0).abs() < 1e-6);
    assert!((end / (2.0 / foundation * half.cosh() * half.cos() / base) - 1.0).abs() < 1e-6);
}
