//! Inlets and outlets.

use super::checkpoint::broken;
use super::determinism::same_bits;
use super::support::{COUPLED, Folder, Table, json, repository, results, run, scene_folder};
use serde_json::Value;
use std::fs;
use std::path::Path;

const G: f64 = 9.81;

/// Spheres of 10 mm, inserted above a shaft and removed at its foot.
const RAIN: &str = r#"title = "rain"

[[material]]
name = "glass"
density = 2500
stiffness = "10 kN/m"
friction = 0.3
restitution = 0.6

[[grains]]
name = "drops"
shape = "sphere"
material = "glass"
count = 600
size = ["8 mm", "12 mm"]
inlet = { box = [[0.0, 0.0, 0.9], [0.1, 0.1, 1.0]], rate = "0.3 kg/s", velocity = [0.2, 0.1, -1.0] }

[[outlet]]
name = "foot"
point = [0.0, 0.0, 0.3]
normal = [0.0, 0.0, -2.0]

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [1, 0, 0]
material = "glass"

[[walls]]
kind = "plane"
point = [0.1, 0, 0]
normal = [-1, 0, 0]
material = "glass"

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "glass"

[[walls]]
kind = "plane"
point = [0, 0.1, 0]
normal = [0, -1, 0]
material = "glass"

[time]
end = "1 s"

[output]
frames = 4
"#;

fn float(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Present = initial + inserted − removed in every row: counts exact, masses to rounding.
#[track_caller]
fn adds_up(out: &Path) -> Table {
    let history = Table::read(&out.join("history.csv"));
    for (what, slack) in [("grains", 0.0), ("mass", 1e-12)] {
        let [present, come, gone] =
            ["present", "in", "out"].map(|kind| history.column(&format!("{what}_{kind}")));
        for k in 0..present.len() {
            let error = present[k] - (present[0] + come[k] - gone[k]);
            assert!(error.abs() <= slack * (present[0] + come[k]), "{what}, row {k}: {error:e}");
        }
    }
    history
}

fn points(frame: &Path) -> usize {
    let bytes = fs::read(frame).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let from = text.find("NumberOfPoints=\"").unwrap() + 16;
    text[from..].split('"').next().unwrap().parse().unwrap()
}

#[test]
fn rain_in_steady_flow() {
    let folder = Folder::new("rain");
    let scene = folder.write("scene.toml", RAIN);
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let history = adds_up(&out);
    let summary = json(&out.join("summary.json"));
    let flow = &summary["flow"];
    let (time, come) = (history.column("time"), history.column("mass_in"));
    let largest = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.006_f64.powi(3);
    for (t, m) in time.iter().zip(&come) {
        let behind = 0.3 * t - m;
        assert!((-1e-9..largest + 0.3 * 1.1e-3).contains(&behind), "{behind} at {t}");
    }
    let later = [float(&flow["later_rate_in"]), float(&flow["later_rate_out"])];
    println!("{later:?} {} {}", summary["energy"], summary["momentum"]);
    later.iter().for_each(|r| assert!((r / 0.3 - 1.0).abs() < 0.03, "{later:?}"));
    assert!(float(&flow["inlets"][0]["backlog"]) < largest);
    assert_eq!(flow["inserted"]["grains"], flow["inlets"][0]["amount"]["grains"]);
    assert_eq!(flow["removed"]["mass"], flow["outlets"][0]["amount"]["mass"]);
    assert_eq!((&flow["at_start"]["grains"], &flow["outlets"][0]["name"]), (&Value::from(0), &"foot".into()));
    // Sizes are mixed: the mean mass is constant over time.
    let grains = history.column("grains_in");
    let half = grains.len() / 2;
    let means = [come[half] / grains[half], come[grains.len() - 1] / grains[grains.len() - 1]];
    assert!((means[0] / means[1] - 1.0).abs() < 0.1, "{means:?}");
    assert!(float(&summary["energy"]["relative_error"]) < 5e-4, "{}", summary["energy"]);
    assert!(float(&summary["momentum"]["linear"]) < 1e-11, "{}", summary["momentum"]);
    assert!(float(&summary["momentum"]["angular"]) < 1e-11, "{}", summary["momentum"]);
    let height = 0.95 * G + 0.5 * 1.05;
    let brought = float(&flow["inserted"]["mass"]) * height;
    let removed = float(&flow["removed"]["mass"]) * (0.3 * G + 0.5 * (1.05 + 2.0 * G * 0.65));
    let energy = float(&flow["energy_in"]);
    assert!((energy - (brought - removed)).abs() < 0.05 * brought, "{energy} {brought} {removed}");
    // One grain may be inserted or removed between a frame and a row.
    let rows = history.column("grains_present");
    for frame in 0..=4 {
        let there = rows[frame * (rows.len() - 1) / 4] as usize;
        let shown = points(&out.join(format!("frames/grains_0000{frame}.vtp")));
        assert!(shown.abs_diff(there) <= 1, "frame {frame}: {shown} of {there}");
    }
    let log = fs::read_to_string(out.join("log.txt")).unwrap();
    assert!(log.contains("flow: ") && log.contains("  foot: ") && !log.contains("warning: "), "{log}");
}

#[test]
fn a_drop_falls_from_the_inlet() {
    let folder = Folder::new("drop");
    let scene = folder.write("scene.toml", RAIN);
    let out = folder.join("out");
    let set = [
        "grains.0.inlet.rate=",
        "grains.0.inlet.grains_per_second=10",
        "grains.0.inlet.start=0.03",
        "grains.0.inlet.stop=0.18",
        "grains.0.inlet.velocity=[0.02, 0.01, -1]",
        "grains.0.record=true",
        "time.flow_interval=\"0.5 ms\"",
        "time.end=0.48",
        "output.history_interval=0.001",
    ];
    run(&scene, &out, &set).good();
    let history = adds_up(&out);
    let [time, there, come] = ["time", "grains_present", "grains_in"].map(|c| history.column(c));
    let place = ["drops_x", "drops_y", "drops_z"].map(|c| history.column(c));
    assert_eq!(come.last(), Some(&1.0));
    let first = there.iter().position(|n| *n > 0.0).unwrap();
    assert!((time[first] - 0.13).abs() < 2e-3, "{}", time[first]);
    let last = there.iter().rposition(|n| *n > 0.0).unwrap();
    // The first two rows give velocity and position.
    let speed = [0.02, 0.01, -1.0];
    let entry = time[first];
    for k in first..last {
        let t = time[k] - entry;
        for d in 0..3 {
            let gravity = if d == 2 { -G } else { 0.0 };
            // Inserted up to one interval before the row.
            let slack = 0.5e-3 * 1e-2 + 1e-3 * G * t.max(1e-3);
            let expected = place[d][first] + speed[d] * t + 0.5 * gravity * t * t;
            assert!((place[d][k] - expected).abs() < slack, "{d} {t}: {} {expected}", place[d][k]);
        }
    }
    assert!((0.3..0.306).contains(&place[2][last]) && place[2][first] > 0.9, "{}", place[2][last]);
}

#[test]
fn recycling_limits_backlog_rate() {
    let folder = Folder::new("again");
    let scene = folder.write("scene.toml", RAIN);
    let out = folder.join("out");
    let set = [
        "grains.0.count=",
        "grains.0.size=",
        "grains.0.lattice={ kind = \"loose\", size = \"8 mm\", low = [0.02, 0.02, 0.5], counts = [4, 3, 1] }",
        "grains.0.inlet.rate=",
        "grains.0.inlet.grains_per_second=100",
        "outlet.0.recycle=true",
        "output.history_interval=0.001",
        "time.end=0.8",
    ];
    run(&scene, &out, &set).good();
    let history = adds_up(&out);
    let [time, come, gone] = ["time", "grains_in", "grains_out"].map(|c| history.column(c));
    let fallen = (2.0 * (0.504 - 0.3) / G).sqrt();
    let left = gone.iter().position(|n| *n > 0.0).unwrap();
    assert!((time[left] - fallen).abs() < 3e-3 && gone[left] == 12.0, "{} {}", time[left], gone[left]);
    let all = come.iter().position(|n| *n == 12.0).unwrap();
    // Eleven intervals of 5 ms after an immediate first insertion.
    assert!((time[all] - time[left] - 0.055).abs() < 6e-3, "{} {}", time[all], time[left]);
    for k in left..all {
        assert!(come[k] <= 1.0 + 200.0 * (time[k] - time[left] + 2e-3), "{} at {}", come[k], time[k]);
    }
    let summary = json(&out.join("summary.json"));
    let inlet = &summary["flow"]["inlets"][0];
    assert!(come.last().unwrap() > &20.0 && inlet["without_free_position"] == 0, "{inlet}");
    assert!(inlet["without_grains"].as_u64().unwrap() > 100, "{inlet}");
    let notes = summary["warnings"].to_string();
    assert!(
        notes.contains("inlet of \\\"drops\\\": inserted") && notes.contains("empty queue at"),
        "{notes}"
    );
}

#[test]
fn no_room_at_the_inlet() {
    let folder = Folder::new("no_room");
    let scene = folder.write("scene.toml", RAIN);
    let out = folder.join("out");
    let set = [
        "grains.0.inlet.box=[[0.04, 0.04, 0.9], [0.053, 0.053, 0.913]]",
        "grains.0.inlet.velocity=[0, 0, 0]",
        "time.end=0.5",
    ];
    run(&scene, &out, &set).good();
    adds_up(&out);
    let flow = &json(&out.join("summary.json"))["flow"];
    let inlet = &flow["inlets"][0];
    let (requested, owed) = (float(&inlet["requested"]), float(&inlet["backlog"]));
    assert!((requested - 0.15).abs() < 1e-4 && owed > 0.05 && owed < requested, "{inlet}");
    assert!((float(&inlet["amount"]["mass"]) - (requested - owed)).abs() < 1e-12, "{inlet}");
    assert!(
        inlet["without_free_position"].as_u64().unwrap() > 100 && inlet["without_grains"] == 0,
        "{inlet}"
    );
    let waiting = inlet["queued"].as_u64().unwrap();
    assert_eq!(waiting + flow["inserted"]["grains"].as_u64().unwrap(), 600);
}

#[test]
fn a_box_that_is_flown_through() {
    let folder = Folder::new("thin");
    let scene = folder.write("scene.toml", RAIN);
    let out = folder.join("out");
    let set = [
        "outlet.0.point=",
        "outlet.0.normal=",
        "outlet.0.box=[[0, 0, 0.5], [0.1, 0.1, 0.51]]",
        "time.flow_interval=\"10 ms\"",
        "time.end=0.5",
    ];
    run(&scene, &out, &set).good();
    adds_up(&out);
    let summary = json(&out.join("summary.json"));
    let outlet = &summary["flow"]["outlets"][0];
    let (seen, missed) = (outlet["amount"]["grains"].as_u64().unwrap(), outlet["missed"].as_u64().unwrap());
    assert!(missed > seen && seen > 5, "{outlet}");
    assert!(summary["warnings"].to_string().contains("Reduce time.flow_interval"), "{}", summary["warnings"]);
    let fine = folder.join("fine");
    run(&scene, &fine, &[&set[..3], &["time.end=0.5"]].concat()).good();
    assert_eq!(json(&fine.join("summary.json"))["flow"]["outlets"][0]["missed"], 0);
}

#[test]
fn an_outlet_out_of_reach() {
    let folder = Folder::new("out_of_reach");
    let without = repository().join("inputs/grains/drum.toml");
    let text = fs::read_to_string(&without).unwrap();
    let outlet = "[[outlet]]\nbox = [[9, 9, 9], [10, 10, 10]]\n\n[deposition]";
    let with = folder.write("scene.toml", &text.replace("[deposition]", outlet));
    let set = ["time.end=0.05", "deposition.max_time=0.05", "output.frames=2", "output.packing=true"];
    let outs = [(without, "without"), (with, "with")].map(|(scene, name)| {
        run(&scene, &folder.join(name), &set).good();
        results(&folder.join(name))
    });
    assert!(outs[0].keys().eq(outs[1].keys()), "{:?}", outs[1].keys());
    for (name, bytes) in
        outs[0].iter().filter(|(name, _)| name.starts_with("frames") || *name == "packing.csv")
    {
        assert!(*bytes == outs[1][name], "{name} differs");
    }
    let rows = |k: usize| String::from_utf8(outs[k]["history.csv"].clone()).unwrap();
    for (without, with) in rows(0).lines().zip(rows(1).lines()) {
        assert!(with.strip_prefix(without).is_some_and(|more| more.split(',').count() == 7), "{with}");
    }
    assert!(json(&folder.join("without/summary.json")).get("flow").is_none());
}

#[test]
fn chute_is_identical_across_threads() {
    let scene = repository().join("inputs/grains/chute_flow.toml");
    let set = ["time.end=0.2", "grains.0.inlet.rate=16", "output.frames=2", "outlet.0.point=[0.2, 0, 0]"];
    let folder = same_bits(&scene, &set, &["history.csv", "frames/grains_00002.vtp"]);
    let summary = json(&folder.join("2/summary.json"));
    assert!(summary["model"]["spheres"].as_u64().unwrap() >= 2500, "{}", summary["model"]);
    assert!(summary["flow"]["removed"]["grains"].as_u64().unwrap() > 10, "{}", summary["flow"]);
}

#[test]
fn a_hopper_that_is_interrupted() {
    let scene = repository().join("inputs/grains/hopper_flow.toml");
    let set = [
        "grains.0.count=300",
        "grains.0.fill={ low = [-0.03, -0.03, 0.06], high = [0.03, 0.03] }",
        "deposition.max_time=0.1",
        "time.end=0.3",
        "output.frames=3",
    ];
    broken(&scene, &set, &[0.1, 0.4, 0.55, 0.8, 0.95], &["history.csv", "frames/grains_00003.vtp"]);
    let folder = Folder::new("hopper_flow");
    run(&scene, folder.path(), &set).good();
    adds_up(folder.path());
    let flow = &json(&folder.join("summary.json"))["flow"];
    assert!(flow["inserted"]["grains"].as_u64().unwrap() > 50, "{flow}");
}

#[test]
fn the_hopper_of_the_examples() {
    let scene = repository().join("inputs/grains/hopper_flow.toml");
    let folder = Folder::new("hopper_steady");
    let set = ["grains.0.count=1000", "time.end=0.8", "output.vtk=false", "time.grain_step_fraction=0.9"];
    run(&scene, folder.path(), &set).good();
    adds_up(folder.path());
    let summary = json(&folder.join("summary.json"));
    let flow = &summary["flow"];
    let [come, gone] = ["later_rate_in", "later_rate_out"].map(|k| float(&flow[k]));
    println!("{come} {gone} {}", summary["energy"]["relative_error"]);
    assert!((come / gone - 1.0).abs() < 0.02, "{flow}");
    assert!((0.7..2.0).contains(&gone), "{flow}");
    assert!(float(&summary["energy"]["relative_error"]) < 0.01, "{}", summary["energy"]);
    assert!(float(&summary["momentum"]["linear"]) < 1e-10, "{}", summary["momentum"]);
}

/// Grains on a flexible block, recycled after they roll off.
fn rain_on_a_block() -> String {
    let from = COUPLED.find("[track.sleeper]").unwrap();
    let to = COUPLED.find("[coupling]").unwrap();
    let flow = r#"[[grains]]
name = "rain"
shape = "sphere"
material = "stone"
count = 30
size = ["150 mm", "200 mm"]
inlet = { box = [[0.2, 0.2, 0.5], [1.8, 1.8, 1.0]], grains_per_second = 150, velocity = [2, 0, -6] }

[[outlet]]
box = [[-1, -1, -1], [3, 3, 0.085]]
groups = ["rain"]
recycle = true

[[outlet]]
point = [1.7, 0, 0]
normal = [1, 0, 0]
groups = ["rain"]
recycle = true

"#;
    let text = format!("{}{flow}{}", &COUPLED[..from], &COUPLED[to..]);
    format!("{text}\n[time]\nend = 0.25\n").replace("\"1 MN/m\"", "\"4 MN/m\"")
}

#[test]
fn rain_on_a_solid() {
    let folder = scene_folder("rain_on_a_block", &rain_on_a_block());
    let out = folder.join("out");
    run(&folder.join("scene.toml"), &out, &[]).good();
    adds_up(&out);
    let summary = json(&out.join("summary.json"));
    let flow = &summary["flow"];
    println!("{flow} {} {}", summary["energy"], summary["coupling"]);
    assert!(flow["inserted"]["grains"].as_u64().unwrap() > 30, "{flow}");
    assert!(flow["outlets"][0]["amount"]["grains"].as_u64().unwrap() > 5, "{flow}");
    assert!(float(&summary["energy"]["relative_error"]) < 0.02, "{}", summary["energy"]);
    assert!(float(&summary["momentum"]["linear"]) < 1e-10, "{}", summary["momentum"]);
    assert!(float(&summary["coupling"]["transfer"]["force"]) < 1e-9, "{}", summary["coupling"]);
}

#[test]
fn insertion_over_solid_resumes() {
    let folder = scene_folder("rain_on_a_block", &rain_on_a_block());
    for scheme in ["predicted", "lagged", "stiffened", "iterated"] {
        let scheme = format!("coupling.scheme={scheme}");
        let set = [scheme.as_str(), "time.end=0.12", "coupling.substeps=5"];
        broken(&folder.join("scene.toml"), &set, &[0.35, 0.7, 0.9], &["history.csv"]);
    }
}

#[test]
fn periodic_insertion_above_bed() {
    let folder = Folder::new("periodic");
    let text = RAIN.replace(
        "[[outlet]]",
        "[[grains]]\nname = \"bed\"\nshape = \"sphere\"\nmaterial = \"glass\"\ncount = 60\nsize = [\"12 mm\", \"14 mm\"]\n\
         fill = { low = [0, 0, 0.4], high = [0.1, 0.1] }\n\n[[outlet]]",
    );
    let text = text
        .replace("point = [0, 0, 0]\nnormal = [1, 0, 0]", "point = [0, 0, 0.4]\nnormal = [0, 0, 1]")
        .replace("point = [0.1, 0, 0]\nnormal = [-1, 0, 0]", "point = [0, 0, 0]\nnormal = [0, 1, 0]");
    let more = "[periodic]\nx = [0.0, 0.1]\n\n[deposition]\nmax_time = 0.3\nlayers = 2\nlevel = 0.6\n\n[[measure]]\n\
                name = \"bed\"\nbox = [[0, 0, 0.4], [0.1, 0.1, 0.6]]\n\n[time]";
    let text = text.replace("[time]", more) + "packing = true\n";
    let scene = folder.write("scene.toml", &text);
    let out = folder.join("out");
    let set = [
        "outlet.0.point=",
        "outlet.0.normal=",
        "outlet.0.box=[[0.0, 0.0, 0.3], [0.03, 0.03, 0.42]]",
        "grains.0.inlet.rate=0.15",
        "time.end=0.5",
    ];
    run(&scene, &out, &set).good();
    let history = adds_up(&out);
    assert_eq!(history.column("grains_present")[0], 60.0);
    let summary = json(&out.join("summary.json"));
    let flow = &summary["flow"];
    println!("{flow} {}", summary["energy"]);
    assert!(flow["removed"]["grains"].as_u64().unwrap() > 10, "{flow}");
    assert!(float(&summary["energy"]["relative_error"]) < 0.02, "{}", summary["energy"]);
    assert!(float(&summary["momentum"]["linear"]) < 1e-10, "{}", summary["momentum"]);
    assert!(float(&summary["momentum"]["angular"]) < 1e-10, "{}", summary["momentum"]);
    let inside = summary["packing"]["measures"][0]["grains"].as_u64().unwrap();
    assert!((30..=flow["at_end"]["grains"].as_u64().unwrap()).contains(&inside), "{}", summary["packing"]);
    let rows = |name: &str| fs::read_to_string(out.join(name)).unwrap().lines().count() - 1;
    let there = flow["at_end"]["grains"].as_u64().unwrap() as usize;
    assert_eq!(rows("packing_0.csv") + rows("packing_1.csv"), there);
    let counted: u64 =
        summary["packing"]["neighbours"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).sum();
    assert_eq!(counted as usize, there);
}

#[test]
fn rain_beside_a_sleeper() {
    let flow = r#"[[grains]]
name = "rain"
shape = "sphere"
material = "stone"
count = 30
size = ["100 mm", "150 mm"]
inlet = { box = [[0.1, 0.1, 0.6], [1.9, 1.9, 1.0]], grains_per_second = 250, velocity = [2, 0, -6] }

[[outlet]]
point = [1.7, 0, 0]
normal = [1, 0, 0]
recycle = true
groups = ["rain"]

[deposition]
max_time = 0.03

[track.sleeper]"#;
    let folder = scene_folder("rain_and_sleeper", &COUPLED.replace("[track.sleeper]", flow));
    let scene = folder.join("scene.toml");
    broken(&scene, &[], &[0.2, 0.5, 0.9], &["history.csv", "cycles.csv"]);
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let history = adds_up(&out);
    assert_eq!(history.column("grains_present")[0], 5.0);
    let summary = json(&out.join("summary.json"));
    println!("{} {} {}", summary["flow"], summary["energy"]["relative_error"], summary["momentum"]);
    assert!(summary["flow"]["inserted"]["grains"].as_u64().unwrap() > 15, "{}", summary["flow"]);
    assert!(summary["flow"]["removed"]["grains"].as_u64().unwrap() > 0, "{}", summary["flow"]);
    assert!(float(&summary["energy"]["relative_error"]) < 0.05, "{}", summary["energy"]);
    assert!(float(&summary["momentum"]["linear"]) < 1e-10, "{}", summary["momentum"]);
}
