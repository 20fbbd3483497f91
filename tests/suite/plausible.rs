//! Plausibility warnings name the key; shipped scenes have none.

use super::cli::inputs;
use super::support::{Folder, repository, trackbed};
use std::collections::BTreeSet;
use trackbed::model::Job;
use trackbed::plausible::{Finding, near_mode, weigh};
use trackbed::scene::Document;

fn found(scene: &str, set: &[&str]) -> Vec<Finding> {
    let mut document = Document::open(&repository().join(scene)).unwrap();
    set.iter().for_each(|s| document.set(s).unwrap());
    let parsed = document.scene().unwrap_or_else(|e| panic!("{set:?}: {e}"));
    let job = Job::new(&document, &parsed).unwrap_or_else(|e| panic!("{set:?}: {e}"));
    weigh(&parsed, &job).into_iter().chain(near_mode(&job)).collect()
}

const BOX: &str = "inputs/ballast/box.toml";
const CYCLIC: &str = "inputs/track/cyclic/scene.toml";
const SERVO: &str = "inputs/grains/servo.toml";
const FOOTING: &str = "inputs/solid/footing.toml";
const CLAY: &str = "inputs/solid/triaxial_drained.toml";
const TRAIN: &str = "inputs/track/train/scene.toml";
const DRUM: &str = "inputs/grains/drum.toml";
const GRAINS: &str = "inputs/grains/box.toml";
const SHAKEN: &str = "inputs/ice/vibration.toml";
const SCARRED: &str = "inputs/geo/chant-sura/scene.toml";
const WIND: &str = "inputs/verify/wind.toml";

/// Scene, override, key, whether certainly wrong.
const CASES: &[(&str, &str, &str, bool)] = &[
    (CYCLIC, "solid.material.0.young=80", "solid.material.0.young", true),
    (CYCLIC, "solid.material.1.young=\"110e6 MPa\"", "solid.material.1.young", true),
    (CYCLIC, "solid.material.0.density=1.9", "solid.material.0.density", false),
    (CYCLIC, "solid.material.0.poisson=0.4999", "solid.material.0.poisson", false),
    (FOOTING, "solid.material.0.cohesion=\"20 GPa\"", "solid.material.0.cohesion", true),
    (FOOTING, "solid.material.0.friction=\"70 deg\"", "solid.material.0.friction", false),
    (FOOTING, "solid.material.0.dilation=\"0.05 deg\"", "solid.material.0.dilation", false),
    (CLAY, "solid.material.0.lambda=9.3", "solid.material.0.lambda", false),
    (CLAY, "solid.material.0.void_ratio=60", "solid.material.0.void_ratio", false),
    (BOX, "material.0.density=2.65", "material.0.density", true),
    (BOX, "material.0.density=2650000", "material.0.density", true),
    (GRAINS, "material.0.stiffness=\"5e6 MN/m\"", "material.0.stiffness", true),
    (BOX, "material.0.young=\"15e3 GPa\"", "material.0.young", false),
    (BOX, "material.0.friction=40", "material.0.friction", false),
    (BOX, "material.0.restitution=0.001", "material.0.restitution", false),
    (BOX, "material.0.rolling_friction=5", "material.0.rolling_friction", false),
    (GRAINS, "material.0.tangential_ratio=0.01", "material.0.tangential_ratio", false),
    (SERVO, "grains.0.size=[0.000001, 0.0000012]", "grains.0.size", false),
    (SERVO, "grains.0.size=[0.0001, 0.01]", "grains.0.size", false),
    (BOX, "grains.0.gradation.scale=0.001", "grains.0.gradation.scale", false),
    (GRAINS, "grains.0.velocity=[0.0, 0.0, -500.0]", "grains.0.velocity", false),
    (WIND, "wind.velocity=[\"600 m/s\", 0, 0]", "wind.velocity", false),
    (WIND, "wind.density=12000", "wind.density", false),
    (SHAKEN, "walls.0.body.mount.frequency=[1500, 1.5, 0]", "walls.0.body.mount.frequency", false),
    (SHAKEN, "walls.0.body.mount.damping_ratio=[0.03, 300, 0]", "walls.0.body.mount.damping_ratio", true),
    (SHAKEN, "walls.0.body.mount={ stiffness = [\"20 N/m\", 0, 0] }", "walls.0.body.mount.stiffness", false),
    (SCARRED, "walls.0.scarring.strength=15", "walls.0.scarring.strength", true),
    (SCARRED, "walls.0.scarring.drag=250", "walls.0.scarring.drag", false),
    (SCARRED, "walls.0.scarring.density=1.7", "walls.0.scarring.density", true),
    (SCARRED, "walls.0.scarring.friction=[0.5, 55]", "walls.0.scarring.friction", false),
    (SERVO, "walls.2.servo.pressure=\"20000 MPa\"", "walls.2.servo.pressure", true),
    (SERVO, "walls.2.servo.area=78539", "walls.2.servo.area", true),
    (SERVO, "walls.2.servo.max_speed=\"200 m/s\"", "walls.2.servo.max_speed", false),
    (BOX, "walls.2.point=[-0.5, 0.0, 0.0]", "walls.2", true),
    (BOX, "walls.1.normal=[-1.0, 0.0, 0.0]", "walls.1", true),
    (DRUM, "grains.0.fill.low=[-0.05, 0.005, -0.06]", "walls.0", true),
    (BOX, "gravity=[0.0, 0.0, 9.81]", "gravity", true),
    (BOX, "gravity=[0.0, 0.0, -9810.0]", "gravity", true),
    (BOX, "gravity=[0.0, 0.0, -981.0]", "gravity", false),
    (BOX, "gravity=[0.0, -9.81, 0.0]", "gravity", true),
    (CYCLIC, "gravity=[9.81, 0.0, 0.0]", "gravity", true),
    (CYCLIC, "gravity=[0.0, -9.0, -3.0]", "gravity", true),
    // Millimetre meshes: size, elements, or weight on soft ground.
    (CYCLIC, "solid.scale=1000", "solid", true),
    (FOOTING, "solid.block.z.lines=[-4000.0, 0.0]", "solid", true),
    (GRAINS, "walls=", "walls", true),
    (BOX, "deposition.max_time=\"1 ms\"", "deposition.max_time", true),
    (BOX, "deposition.settled_speed=2e-8", "deposition.settled_speed", true),
    (BOX, "gravity=[0.0, 0.0, 0.0]", "deposition", true),
    (BOX, "deposition.level=220", "deposition.level", true),
    (BOX, "deposition.level=-0.1", "deposition.level", true),
    (BOX, "track.sleeper.centre=[30.0, 0.15]", "track.sleeper.centre", true),
    (CYCLIC, "track.sleeper.centre=[0.3, 0.3]", "track.sleeper.centre", true),
    (CYCLIC, "track.sleeper.centre=[0.0, 0.0]", "track.sleeper.centre", true),
    (CYCLIC, "track.sleeper.size=[3.2, 0.28, 0.20]", "track.sleeper.centre", true),
    (CYCLIC, "walls.3.point=[1.2, 0.0, 0.0]", "track.sleeper.centre", true),
    (CYCLIC, "walls.1.normal=[0.5, -1.0, 0.0]", "track.sleeper.centre", true),
    (CYCLIC, "grains.0.fill={ low = [-1.5, 0.0, -2.0], high = [1.5, 0.6] }", "grains.0", true),
    (CYCLIC, "grains.0.fill={ low = [50.0, 0.0, 0.0], high = [53.0, 0.6] }", "grains.0", true),
    (BOX, "track.sleeper.mass=\"85 t\"", "track.sleeper.mass", true),
    (BOX, "track.sleeper.size=[780.0, 290.0, 150.0]", "track.sleeper.size", true),
    (BOX, "track.load.maximum=\"40 MN\"", "track.load.maximum", false),
    (BOX, "track.load.frequency=\"30 kHz\"", "track.load.frequency", true),
    (BOX, "track.sleeper.mass=\"4.5 t\"", "track.load.maximum", false),
    // Fourth ground mode: 33.1 Hz, 44 % of the mass vertical.
    (CYCLIC, "track.load.frequency=\"33 Hz\"", "track.load", false),
    (BOX, "track.load.ramp=\"100 h\"", "track.load.ramp", true),
    (TRAIN, "track.rail.bending_stiffness=6.4", "track.rail.bending_stiffness", true),
    (TRAIN, "track.load.speed=\"2000 m/s\"", "track.load.speed", false),
    (TRAIN, "track.load.axle_load=140", "track.load.axle_load", false),
    (FOOTING, "solid.support.6.displacement=-60", "solid.support.6.displacement", true),
    (CLAY, "solid.load.0.pressure=\"207 GPa\"", "solid.load.0.pressure", true),
    (CYCLIC, "output.frames=100000", "output.frames", false),
    (BOX, "output.history_interval=1e-8", "output.history_interval", true),
    (BOX, "track.load.cycles=100000000", "track.load.cycles", false),
    (FOOTING, "time.end=1.5e7", "time.end", false),
    (GRAINS, "time.end=\"1e3 h\"", "time.end", false),
];

#[test]
fn implausible_values_name_their_key() {
    let keys: BTreeSet<&str> = CASES.iter().map(|c| c.2).collect();
    assert!(CASES.len() >= 50 && keys.len() >= 40, "{} cases, {} keys", CASES.len(), keys.len());
    let mut wrong = Vec::new();
    for (scene, set, key, serious) in CASES {
        let all = std::panic::catch_unwind(|| found(scene, &[set]));
        let Ok(all) = all else {
            wrong.push(format!("{scene} {set}: refused"));
            continue;
        };
        if !all.iter().any(|f| f.key == *key && (f.serious || !serious)) {
            wrong.push(format!(
                "{scene} {set}: {:?}",
                all.iter().map(ToString::to_string).collect::<Vec<_>>()
            ));
        }
        let order: Vec<bool> = all.iter().map(|f| !f.serious).collect();
        assert!(order.is_sorted(), "the implausible come first: {all:?}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn weight_reveals_millimetre_mesh() {
    let high = ["solid.block.z.lines=[-800.0, 0.0]", "solid.gravity=true"];
    let found = |more: &str| found(FOOTING, &[high[0], high[1], more]);
    let all = found("title=\"soft\"");
    let solid = all.iter().find(|f| f.key == "solid").unwrap_or_else(|| panic!("{all:?}"));
    assert!(solid.serious && solid.found.contains("under its own weight"), "{solid}");
    for more in ["solid.material.0.young=\"2 GPa\"", "solid.gravity=false"] {
        assert!(found(more).iter().all(|f| f.key != "solid"), "{more}");
    }
}

/// Ball on a rigid floor; walls and sleeper to be added.
const BALL: &str = r#"
[[material]]
name = "s"
density = 2650
stiffness = "50 MN/m"
friction = 0.5
restitution = 0.5
[[material]]
name = "w"
friction = 0.5
restitution = 0.5
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "w"
[[grains]]
name = "g"
shape = "sphere"
material = "s"
spheres = [[0, 0, 0.02, 0.02]]
[time]
end = 0.1
"#;

fn found_in(name: &str, text: &str) -> Vec<Finding> {
    let folder = Folder::new(name);
    let file = folder.write("scene.toml", text);
    found(file.to_str().unwrap(), &[])
}

/// 2 % of the radius release 8 J, where a rise by the radius takes 0.02 J.
#[test]
fn start_overlap_that_throws_is_found() {
    let at = |z: &str| BALL.replace("[[0, 0, 0.02, 0.02]]", &format!("[[0, 0, {z}, 0.02]]"));
    let thrown = |text: &str| {
        let all = found_in("implausible-thrown", text);
        all.into_iter().find(|f| f.found.contains("at the start, which throws it at"))
    };
    let deep = thrown(&at("0.0196")).expect("a finding");
    assert_eq!(deep.key, "grains.0");
    assert!(deep.found.starts_with("grain 0 of \"g\" with an overlap of 4.000e-4 m with wall"), "{deep}");
    assert!(thrown(&at("0.019999991")).is_none());
    assert!(thrown(&at("0.02")).is_none());
    let accepted =
        at("0.0196").replace("material = \"s\"\nspheres", "material = \"s\"\naccept_overlap = true\nspheres");
    assert!(accepted.contains("accept_overlap") && thrown(&accepted).is_none());
}

#[test]
fn grain_in_closed_triangles_is_found() {
    let block = r#"
[[walls]]
kind = "triangles"
material = "w"
vertices = [[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0], [-0.1, -0.1, 0.3], [0.1, -0.1, 0.3], [0.1, 0.1, 0.3], [-0.1, 0.1, 0.3]]
triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]
"#;
    let two = BALL.replace("[[0, 0, 0.02, 0.02]]", "[[0, 0, 0.15, 0.02], [0.4, 0, 0.15, 0.02]]");
    let all = found_in("implausible-block", &(two.clone() + block));
    let closed = all.iter().find(|f| f.key == "walls.1").unwrap_or_else(|| panic!("{all:?}"));
    assert!(closed.serious && closed.found == "1 of 2 grains outside it, the others inside", "{closed}");
    let outside = two.replace("[[0, 0, 0.15", "[[0.3, 0, 0.15") + block;
    assert!(found_in("implausible-outside", &outside).iter().all(|f| f.key != "walls.1"));
}

#[test]
fn sleeper_through_round_wall_is_found() {
    let scene = |radius: f64| {
        format!(
            "{BALL}\n[[walls]]\nkind = \"cylinder\"\nmaterial = \"w\"\nbase = [0, 0, 0]\nheight = 1\nradius = {radius}\n\
             [track.sleeper]\nsize = [0.6, 0.2, 0.1]\nmass = \"40 kg\"\nmaterial = \"s\"\ncentre = [0, 0]\n"
        )
    };
    let found = |radius: f64| {
        let all = found_in("implausible-cylinder", &scene(radius));
        all.into_iter().find(|f| f.key == "track.sleeper.centre").map(|f| f.found)
    };
    assert_eq!(found(0.25).as_deref(), Some("the sleeper through walls.1"));
    assert_eq!(found(0.4), None);
}

/// First vertical mode of a column, c/4H = 7.9 Hz.
#[test]
fn solid_load_near_mode_is_found() {
    let column = |kind: &str, frequency: f64| {
        format!(
            "[solid]\nintegration = \"full\"\ndynamics = {{}}\ngravity = false\n[solid.block]\nx = {{ lines = [0, 1], counts = [1] }}\n\
             y = {{ lines = [0, 1], counts = [1] }}\nz = {{ lines = [0, 5], counts = [10] }}\n[[solid.material]]\nid = 1\n\
             young = \"50 MPa\"\npoisson = 0\ndensity = 2000\n[[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n\
             [[solid.load]]\nkind = \"pressure\"\nside = \"z+\"\npressure = \"10 kPa\"\n\
             history = {{ kind = \"{kind}\", frequency = \"{frequency} Hz\" }}\n[time]\nend = 2\nsolid_step = \"2 ms\"\n"
        )
    };
    for kind in ["sine", "haversine"] {
        let all = found_in("implausible-mode", &column(kind, 7.9));
        let near = all.iter().find(|f| f.key == "solid.load.0").unwrap_or_else(|| panic!("{all:?}"));
        assert!(near.found.contains("near the vertical mode of the solid at 7.9"), "{near}");
        assert!(found_in("implausible-far", &column(kind, 2.0)).iter().all(|f| f.key != "solid.load.0"));
    }
}

#[test]
fn no_shipped_scene_is_blamed() {
    let all = inputs();
    assert!(all.len() > 35, "{}", all.len());
    let mut blamed = Vec::new();
    for scene in &all {
        let name = scene.strip_prefix(repository()).unwrap().display().to_string();
        blamed.extend(found(&name, &[]).iter().map(|f| format!("{name}: {f}")));
    }
    assert!(blamed.is_empty(), "{}", blamed.join("\n"));
}

#[test]
fn strict_rejects_implausible_values() {
    let folder = Folder::new("implausible");
    let scene = repository().join(CLAY);
    let scene = scene.to_str().unwrap();
    let out = folder.join("out");
    let set = ["--set", "output.history_interval=2", "--set", "time.solid_step=0.25"];
    let words = "output.history_interval: found 2 s, longer than the run of 1 s, expected a part of the run (unusual)";
    let checked = trackbed([&["check", scene], &set[..]].concat()).good();
    assert!(checked.stdout.contains(words), "{checked:?}");
    let run = [&["run", scene, "--out", out.to_str().unwrap()], &set[..]].concat();
    let strict = trackbed([&run[..], &["--strict"]].concat());
    assert_eq!((strict.code, strict.stderr.lines().count()), (2, 1), "{strict:?}");
    let refusal = "output.history_interval: found 2 s, longer than the run of 1 s, expected a part of the run (--strict)";
    assert!(strict.stderr.contains(refusal) && !out.exists(), "{strict:?}");
    assert_eq!(trackbed([&["check", scene, "--strict"], &set[..]].concat()).code, 2);
    let said = trackbed(&run).good();
    assert!(said.stderr.lines().any(|line| line == format!("warning: {words}")), "{said:?}");
    trackbed(["check", scene, "--strict"]).good();
}
