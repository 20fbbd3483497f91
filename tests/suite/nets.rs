//! Nets and geogrids: strand under its own weight, joined groups, refused keys.

use super::support::{Folder, Outcome, Table, json, run, trackbed};

const GRAVITY: f64 = 9.81;
/// Radius of the spheres, their distance, length of the strand [m]; stiffness of a bond [N/m]; density [kg/m³].
const RADIUS: f64 = 0.01;
const APART: f64 = 0.05;
const LENGTH: f64 = 2.0;
const STIFFNESS: f64 = 2e4;
const DENSITY: f64 = 1000.0;

/// Strand of 40 segments between fixed ends; `net`: keys of all three groups.
fn strand(net: &str) -> String {
    let group = |name: &str, sides: &str, keys: &str| {
        format!(
            "[[grains]]\nname = \"{name}\"\nshape = \"sphere\"\nmaterial = \"grid\"\nbond = \"rib\"\nrecord = true\n{keys}\n\
             net = {{ {net}, radius = {RADIUS}, {sides} }}\n"
        )
    };
    let fixed = "prescribed_velocity = [0, 0, 0]";
    format!(
        "gravity = [0, 0, -{GRAVITY}]\n[[material]]\nname = \"grid\"\ndensity = {DENSITY}\nstiffness = 1e6\nfriction = 0.5\n\
         restitution = 0.3\n{}{}{}\
         [[bond]]\nname = \"rib\"\ncontact_point = {{ normal_stiffness = {STIFFNESS}, shear_stiffness = 0 }}\n\
         damping_coefficients = [5, 20, 0, 0]\n[[probe]]\nname = \"middle\"\ngrain = 19\n\
         [deposition]\nmax_time = 10\nsettled_speed = 1e-5\nlocal_damping = 0.7\n[time]\nend = 0.02\n[output]\nvtk = false\n",
        group("strand", "without = [\"start\", \"end\"]", ""),
        group("left", "only = [\"start\"]", fixed),
        group("right", "only = [\"end\"]", fixed),
    )
}

/// Horizontal tension, largest tension [N], and sag [m] of the chain of points: equal weights, elastic segments.
fn chain() -> [f64; 3] {
    let weight = DENSITY * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * GRAVITY;
    let segments = (LENGTH / APART).round() as usize;
    let shape = |horizontal: f64| {
        let (mut span, mut depth, mut sag) = (0.0, 0.0, 0.0_f64);
        for i in 0..segments {
            let vertical = weight * (0.5 * (segments - 1) as f64 - i as f64);
            let tension = horizontal.hypot(vertical);
            let length = APART * (1.0 + tension / (STIFFNESS * APART));
            span += length * horizontal / tension;
            depth += length * vertical / tension;
            sag = sag.max(depth);
        }
        (span, sag)
    };
    let (mut low, mut high) = (1e-3, 1e4);
    for _ in 0..200 {
        let middle = f64::sqrt(low * high);
        if shape(middle).0 < LENGTH { low = middle } else { high = middle }
    }
    [low, low.hypot(weight * 0.5 * (segments - 1) as f64), shape(low).1]
}

#[test]
fn a_strand_sags_under_its_weight() {
    let folder = Folder::new("strand");
    let net = "corner = [0, 0, 0], along = [2, 0, 0], meshes = [10, 0], spheres_per_rib = 4";
    let out = folder.join("out");
    run(&folder.write("scene.toml", &strand(net)), &out, &[]).good();
    let history = Table::read(&out.join("history.csv"));
    let last = |name: &str| *history.column(name).last().unwrap();
    let found = [last("left_force_x"), last("strand_tension"), -last("middle_x_z")];
    let expected = chain();
    println!("strand: horizontal tension, largest tension [N], sag [m]: {found:?}, expected {expected:?}");
    for (f, e) in found.iter().zip(expected) {
        assert!((f / e - 1.0).abs() < 5e-4, "{found:?} {expected:?}");
    }
    assert_eq!(json(&out.join("summary.json"))["bonds"]["made"], 40);
}

#[test]
fn groups_of_other_geometry_are_not_joined() {
    let folder = Folder::new("nets");
    let net = "corner = [0, 0, 0], along = [2, 0, 0], across = [0, 0.4, 0], meshes = [5, 2]";
    let scene = folder.write("scene.toml", &strand(net).replace("grain = 19", "grain = 1"));
    let made = |name: &str, set: &[&str]| {
        let out = folder.join(name);
        run(&scene, &out, &[&["gravity=[0, 0, 0]"], set].concat()).good();
        let summary = json(&out.join("summary.json"));
        let warned = summary["warnings"].to_string().contains("is not joined to them");
        (summary["bonds"]["made"].as_u64().unwrap(), warned)
    };
    // 5 × 3 ribs along, 6 × 2 across.
    assert_eq!(made("one", &[]), (27, false));
    assert_eq!(made("rounded", &["grains.2.net.corner=[1e-9, 0, 0]"]), (27, false));
    assert_eq!(made("moved", &["grains.2.net.corner=[0.3, 0, 0]"]), (27 - 3, true));
}

#[test]
fn rejects_keys_of_nets() {
    let folder = Folder::new("net-keys");
    let net = "corner = [0, 0, 0], along = [2, 0, 0], across = [0, 0.4, 0], meshes = [5, 2]";
    let scene = folder.write("scene.toml", &strand(net)).display().to_string();
    for (set, found) in [
        ("grains.0.net.radius=0.11", "at most half the distance of spheres, 0.2000 m"),
        ("grains.0.net.meshes=[0, 2]", "1 or more along"),
        ("grains.0.net.meshes=[5, 0]", "across"),
        ("grains.0.net.across=[1, 0, 0]", "in another direction than `along`"),
        ("grains.0.net.only=[\"start\"]", "sides that leave spheres"),
        ("grains.0.net.spheres_per_rib=0", "1 to 100"),
        ("grains.0.shape=\"clump\"", "which a net consists of"),
        ("grains.0.bond=\"other\"", "the name of a [[bond]]"),
    ] {
        let Outcome { code, stderr, .. } = trackbed(["check", &scene, "--set", set]);
        assert!(code == 2 && stderr.contains(found), "{set}: {code}: {stderr}");
    }
}
