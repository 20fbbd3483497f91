//! DEM–FEM coupling: schemes, load transfers, window limits, edges of the solid.

use super::support::{COUPLED, Table, json, run, scene_folder, trackbed};
use serde_json::Value;
use std::fs;

fn summary(name: &str, text: &str, set: &[&str]) -> Value {
    let folder = scene_folder(name, text);
    run(&folder.join("scene.toml"), &folder.join("out"), &[&["track.load.cycles=1"], set].concat()).good();
    json(&folder.join("out/summary.json"))
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value:#}"))
}

#[test]
fn schemes_and_transfers_close_their_accounts() {
    let mut interface = Vec::new();
    for (scheme, transfer, kind) in [
        ("predicted", "\"point\"", "point"),
        ("predicted", "{ spread = \"0.3 m\" }", "distributed over discs of radius 3.0000e-1 m"),
        ("lagged", "\"point\"", "point"),
        ("stiffened", "{ spread_factor = 2 }", "distributed over discs of radius 2.0000e-1 m"),
        ("iterated", "\"point\"", "point"),
        ("iterated", "{ spread = \"0.3 m\" }", "distributed over discs"),
        ("iterated to 1e-6", "\"point\"", "point"),
        ("iterated to 1e-6", "{ spread = \"0.3 m\" }", "distributed over discs"),
    ] {
        let (scheme, tight) = scheme.split_once(" to ").unwrap_or((scheme, "1e-4"));
        let (scheme_set, transfer_set) =
            (format!("coupling.scheme={scheme}"), format!("coupling.transfer={transfer}"));
        let mut set = vec![&scheme_set[..], &transfer_set, "time.grain_step=50 us"];
        if tight == "1e-6" {
            set.push("coupling.tolerance=1e-6");
        }
        let s = summary(scheme, COUPLED, &set);
        let c = &s["coupling"];
        let turned = number(&s, "/energy/work").abs().max(1e-300);
        let own = number(c, "/interface_work_error").abs() / turned;
        println!(
            "{scheme}, {transfer}: account {:.1e} of the work, interface {own:.1e}, {} passes in {} windows, {} solves",
            number(&s, "/energy/relative_error"),
            c["passes"]["passes"],
            c["passes"]["windows"],
            c["passes"]["solves"]
        );
        // The lagged scheme applies each force one window late.
        let bound = if scheme == "lagged" { 0.2 } else { 1e-3 };
        assert!(number(&s, "/energy/relative_error") < bound);
        assert!(number(c, "/transfer/force") < 1e-12 && number(c, "/transfer/moment") < 1e-12);
        assert!(c["transfer_kind"].as_str().unwrap().starts_with(kind), "{c:#}");
        let named = c["scheme"].as_str().map_or("iterated".into(), String::from);
        assert_eq!(named, scheme);
        // Onset of sliding and loss of contact make the fixed-point map discontinuous: some windows reach no
        // fixed point.
        let most = if tight == "1e-6" { 1.0 } else { 0.5 };
        assert!(number(c, "/passes/unconverged") <= most * number(c, "/passes/windows"), "{c:#}");
        assert!(scheme == "iterated" || number(c, "/passes/unconverged") == 0.0);
        let repeated = number(c, "/passes/passes") > 1.5 * number(c, "/passes/windows");
        assert_eq!(repeated, scheme == "iterated");
        assert_eq!(number(c, "/passes/solves") > 0.0, scheme == "stiffened");
        interface.push((scheme, tight, own));
    }
    let predicted = interface[0].2;
    assert!(predicted > 1e-3, "{interface:?}");
    assert!(
        interface.iter().filter(|(_, tight, _)| *tight == "1e-6").all(|(_, _, e)| *e < 0.01 * predicted),
        "{interface:?}"
    );
}

/// W, its limit, and the sub-steps from the output of `check`.
fn classes(text: &str) -> (f64, f64, u32) {
    let after = |mark: &str| text.split_once(mark).unwrap_or_else(|| panic!("{mark} in {text}")).1;
    let number = |t: &str| -> f64 {
        t.split(|c: char| !(c.is_ascii_digit() || ".e-".contains(c))).next().unwrap().parse().unwrap()
    };
    let row = after("stone on ");
    let row = row.split_once('\n').unwrap().0;
    let w = number(row.split_once("W = ").unwrap().1);
    let limit = number(row.split_once("(limit ").unwrap().1);
    let count = after(" faces, ");
    (w, limit, number(count) as u32)
}

#[test]
fn unstable_window_on_soft_ground_warns() {
    let soft = [
        "solid.material.0.young=1e6",
        "solid.material.0.density=1000",
        "material.0.stiffness=1e7",
        "track.load.cycles=1",
    ];
    let folder = scene_folder("soft", COUPLED);
    let scene = folder.join("scene.toml");
    let check = |more: &[&str]| {
        let mut arguments = vec!["check".to_string(), "--verbose".into(), scene.display().to_string()];
        for s in soft.iter().chain(more) {
            arguments.extend(["--set".to_string(), s.to_string()]);
        }
        trackbed(arguments).good().stdout
    };
    let (per_step, limit, _) = classes(&check(&["coupling.substeps=1"]));
    let many = format!("coupling.substeps={}", (10.0 * limit / per_step).ceil());
    let text = check(&[&many]);
    println!("{text}");
    assert!(text.contains("warning: stone on "), "{text}");
    assert!(text.contains("coupling.substeps = "), "{text}");
    let fitting = text.split_once("coupling.substeps = ").unwrap().1;
    let fitting: u32 = fitting.split_once(' ').unwrap().0.parse().unwrap();
    for (count, bad) in [(fitting, false), (fitting + 1, true)] {
        let text = check(&[&format!("coupling.substeps={count}")]);
        assert_eq!(text.contains("unstable"), bad, "{count}: {text}");
    }
    let (w, limit, _) = classes(&text);
    assert!(w > 10.0 * limit);

    let run_with = |out: &str, more: &[&str]| run(&scene, &folder.join(out), &[&soft[..], more].concat());
    let outcome = run_with("long", &[&many]);
    let warnings = json(&folder.join("long/summary.json"))["warnings"].to_string();
    println!("windows too long: exit {}, {}", outcome.code, outcome.stderr);
    assert!(warnings.contains("coupling may be unstable"), "{warnings}");
    assert!(outcome.code == 0 || outcome.code == 3);

    let text = check(&["coupling.substeps=auto"]);
    let (w, limit, found) = classes(&text);
    println!("automatic: {found} sub-steps, W = {w} of {limit}");
    assert!(text.contains("(automatic)") && !text.contains("unstable") && found >= 1);
    assert!(w <= limit);
    run_with("auto", &["coupling.substeps=auto"]).good();
    let s = json(&folder.join("auto/summary.json"));
    assert_eq!(number(&s, "/coupling/substeps") as u32, found);
    assert!(!s["warnings"].to_string().contains("unstable"), "{}", s["warnings"]);
    assert!(number(&s, "/energy/relative_error") < 0.01, "{:#}", s["energy"]);
}

#[test]
fn automatic_substeps_meet_both_limits() {
    let light = COUPLED.replace("[1.0, 1.0, 0.1, 0.1],", "[1.0, 1.0, 0.06, 0.06],");
    let set = [
        "solid.material.0.young=1e6",
        "solid.material.0.density=300",
        "material.0.stiffness=1e7",
        "time.grain_step=18 us",
    ];
    let s = summary("light", &light, &[&set[..], &["coupling.substeps=\"auto\""]].concat());
    let c = &s["coupling"]["classes"][0];
    let found = number(&s, "/coupling/substeps");
    // The first DEM step: later ones follow the contacts.
    let (dt, k) = (number(&s, "/model/solid_step") / found, number(c, "/stiffness"));
    let m = number(c, "/masses/corner");
    let heavy = 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
    let d = 2.0 * number(c, "/damping_ratio") * (heavy * k).sqrt() / m * dt;
    let w = (k / m).sqrt() * dt;
    // Limit of W for a damped contact.
    assert_eq!(number(c, "/w_limit"), 1.0);
    let room = (1.0 / d).min(0.5 / w);
    println!("{found} sub-steps, room for {room:.2}: W {w:.4}, D {d:.4} in one");
    assert!((2.0..19.0).contains(&room));
    assert_eq!(found, room.floor());
    assert!((number(c, "/d") / (found * d) - 1.0).abs() < 1e-9);
    assert!((number(c, "/stones/0") / (heavy * 0.216) - 1.0).abs() < 1e-9);
}

#[test]
fn rejects_automatic_window_above_limit() {
    let folder = scene_folder("refused", COUPLED);
    let scene = folder.join("scene.toml").display().to_string();
    let check = |more: &[&str]| {
        let light = ["solid.material.0.density=5", "coupling.substeps=\"auto\"", "material.0.stiffness=1e7"];
        let mut arguments = vec!["check".to_string(), scene.clone()];
        light.iter().chain(more).for_each(|s| arguments.extend(["--set".to_string(), s.to_string()]));
        trackbed(arguments)
    };
    let refused = check(&[]);
    println!("{}", refused.stderr);
    assert_eq!(refused.code, 2, "{}", refused.stdout);
    assert!(refused.stderr.contains("coupling.substeps: found \"auto\" with W = "), "{}", refused.stderr);
    let step =
        refused.stderr.split_once("time.grain_step of ").unwrap().1.split_once(" s or less").unwrap().0;
    let good = check(&[&format!("time.grain_step={step}")]).good().stdout;
    assert!(
        !good.contains("unstable") && good.contains(" times the smallest effective nodal mass"),
        "{good}"
    );
    assert!(check(&["coupling.substeps=1"]).good().stdout.contains("may be unstable"));
    let heavier = check(&["solid.material.0.density=2000"]).good().stdout;
    assert!(!heavier.contains("times the smallest effective nodal mass"), "{heavier}");
}

#[test]
fn lagged_scheme_limits_energy_error() {
    let head = COUPLED.split_once("[[grains]]").unwrap().0;
    let text = format!("{head}{ROLLING}");
    let folder = scene_folder("late", &text);
    let scene = folder.join("scene.toml");
    let set = [
        "grains.0.spheres=[[1.0, 1.0, 0.1, 0.1]]",
        "grains.0.velocity=[0, 0, -5]",
        "coupling.scheme=lagged",
        "time.end=0.02",
    ];
    let outcome = |name: &str, step: f64, count: u32| {
        let step = format!("time.grain_step={step}");
        let count = format!("coupling.substeps={count}");
        run(&scene, &folder.join(name), &[&set[..], &[&step, &count]].concat());
        let s = json(&folder.join(name).join("summary.json"));
        let error = number(&s, "/energy/largest_relative_error");
        let class = &s["coupling"]["classes"][0];
        println!("{name}: W = {}, D = {}, energy {error:.3}", class["w"], class["d"]);
        assert!((number(class, "/w_limit") - 0.1).abs() < 1e-12 && number(class, "/d_limit") == 0.2);
        (number(class, "/w"), error, s["warnings"].to_string().contains("unstable or inaccurate in energy"))
    };
    let (w, _, _) = outcome("probe", 1e-5, 1);
    let (_, small, remarked) = outcome("within", 0.09e-5 / w, 1);
    assert!(small < 0.035 && !remarked, "{small}");
    let (_, large, remarked) = outcome("beyond", 0.0725e-5 / w, 4);
    assert!(large > small && remarked, "{large} after {small}");
}

#[test]
fn lagged_scheme_warns_of_undamped_contacts() {
    let folder = scene_folder("undamped", COUPLED);
    let warned = |scheme: &str, ratio: f64| {
        let scene = folder.join("scene.toml");
        let scheme = format!("coupling.scheme={scheme}");
        let ratio = format!("material.0.tangential_damping_ratio={ratio}");
        let checked = trackbed(["check", scene.to_str().unwrap(), "--set", &scheme, "--set", &ratio]);
        checked.good().stdout.contains("undamped tangential contacts at rest gain energy in every window")
    };
    assert!(warned("lagged", 0.0));
    assert!(!warned("lagged", 0.1) && !warned("predicted", 0.0));
}

#[test]
fn contact_classes_have_separate_limits() {
    let more = "[[material]]\nname = \"pebble\"\ndensity = 2650\nstiffness = \"4 MN/m\"\nfriction = 0.5\nrestitution = 0.4\n\n\
                [[grains]]\nname = \"fines\"\nshape = \"sphere\"\nmaterial = \"pebble\"\nspheres = [[1.0, 0.4, 0.03, 0.03]]\n\n\
                [track.sleeper]";
    let s = summary("classes", &COUPLED.replace("[track.sleeper]", more), &[]);
    let classes = s["coupling"]["classes"].as_array().unwrap();
    let named: Vec<_> = classes.iter().map(|c| c["grains"].as_str().unwrap()).collect();
    assert_eq!(named, ["stone", "pebble"]);
    for c in classes {
        let w =
            number(&s, "/model/solid_step") * (number(c, "/stiffness") / number(c, "/masses/corner")).sqrt();
        assert!((number(c, "/w") / w - 1.0).abs() < 1e-9, "{c:#}");
        assert!(number(c, "/masses/corner") < number(c, "/masses/side"));
        assert!(number(c, "/masses/side") < number(c, "/masses/middle"));
    }
    let mass = |k: usize| number(&classes[k], "/stones/0");
    let exact = |r: f64| 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * r * r * r;
    assert!((mass(0) / exact(0.1) - 1.0).abs() < 1e-9 && (mass(1) / exact(0.03) - 1.0).abs() < 1e-9);
    // Harmonic means of 1 and 1, and of 4 and 1 MN/m.
    assert!((number(&classes[1], "/stiffness") / number(&classes[0], "/stiffness") - 1.6).abs() < 1e-9);
}

const ROLLING: &str = r#"
[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
spheres = [[1.6, 1.0, 0.1, 0.1]]
velocity = [2.0, 0.0, 0.0]

[coupling]
material = "stone"

[time]
end = 0.6

[output]
frames = 2
"#;

#[test]
fn rejects_start_overlap_with_the_solid() {
    let head = COUPLED.split_once("[[grains]]").unwrap().0;
    let folder = scene_folder("overlaps", &format!("{head}{ROLLING}"));
    let place = ["time.end=0.001", "grains.0.spheres=[[1.0, 1.0, 0.08, 0.1]]"];
    let outcome = run(&folder.join("scene.toml"), &folder.join("out"), &place);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    let said = ["surface patch", "20 % of the smaller radius, expected at most 10 % at the start"];
    assert!(said.iter().all(|words| outcome.stderr.contains(words)), "{}", outcome.stderr);
    assert!(!folder.join("out/summary.json").exists());
    run(&folder.join("scene.toml"), &folder.join("out"), &["time.end=0.001"]).good();
}

#[test]
fn grain_leaving_mesh_gives_warning() {
    let head = COUPLED.split_once("[[grains]]").unwrap().0;
    let folder = scene_folder("leaves", &format!("{head}{ROLLING}"));
    run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
    let s = json(&folder.join("out/summary.json"));
    let warnings = s["warnings"].to_string();
    println!("{warnings}, energy {}", s["energy"]["relative_error"]);
    assert!(warnings.contains("bodies lost below the surface of the solid: 1, first body 0 of "));
    let start: f64 = s["energy"]["start"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).sum();
    assert!(number(&s, "/energy/largest_error") < 5e-3 * start.abs(), "{:#}", s["energy"]);
    run(&folder.join("scene.toml"), &folder.join("stays"), &["grains.0.velocity=[0, 0, 0]"]).good();
    let s = json(&folder.join("stays/summary.json"));
    assert!(!s["warnings"].to_string().contains("left the solid"));
}

#[test]
fn a_surface_that_folds_is_named() {
    let load = "\n[[solid.load]]\nkind = \"point\"\nat = [0.0, 0.0, 0.0]\nforce = [4e8, 4e8, 0]\n\
                history = { kind = \"ramp\", duration = 0.05 }\n\n[[material]]";
    let head = COUPLED.split_once("[[grains]]").unwrap().0.replacen("\n[[material]]", load, 1);
    let folder = scene_folder("folds", &format!("{head}{ROLLING}"));
    let outcome = run(&folder.join("scene.toml"), &folder.join("out"), &["grains.0.velocity=[0, 0, 0]"]);
    println!("{outcome:?}");
    assert_eq!(outcome.code, 3);
    assert!(outcome.stderr.contains("inverted face of the solid surface at element "), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("at t = ") && outcome.stderr.lines().count() == 1);
    let s = fs::read_to_string(folder.join("out/summary.json")).unwrap();
    assert!(s.contains("failed: "));
}

/// Elastic ground with fixed base, `[lines, counts]` by axis.
fn ground(axes: [&str; 3], young: &str, stiffness: &str, contact: &str) -> String {
    let [x, y, z] = axes;
    format!(
        "[solid.block]\nx = {{ {x} }}\ny = {{ {y} }}\nz = {{ {z} }}\n\
         [[solid.material]]\nid = 1\nyoung = \"{young}\"\npoisson = 0.3\ndensity = 2000\n\
         [[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n\
         [[material]]\nname = \"s\"\ndensity = 2600\nstiffness = \"{stiffness}\"\n{contact}\
         [[material]]\nname = \"w\"\n{contact}\
         [output]\nframes = 0\nvtk = false\n"
    )
}

fn at_rest(scene: &str, set: &[&str]) -> (Value, [Vec<f64>; 2]) {
    let folder = scene_folder("rest", scene);
    run(&folder.join("scene.toml"), &folder.join("out"), set).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let kinetic = ["grains_kinetic", "solid_kinetic"].map(|column| history.column(column));
    (json(&folder.join("out/summary.json")), kinetic)
}

fn box_of_grains(size: f64, count: usize, sizes: &str, seed: usize, end: &str) -> String {
    let walls: String = [([1, 0], 0.0), ([-1, 0], size), ([0, 1], 0.0), ([0, -1], size)]
        .map(|([x, y], at)| {
            let (px, py) = if x == 0 { (0.0, at) } else { (at, 0.0) };
            format!("    {{ kind = \"plane\", point = [{px}, {py}, 0], normal = [{x}, {y}, 0], material = \"w\" }},\n")
        })
        .concat();
    format!(
        "walls = [\n{walls}]\ngrains = [{{ name = \"g\", shape = \"sphere\", material = \"s\", count = {count}, size = {sizes}, seed = {seed}, \
         fill = {{ low = [0, 0, 0], high = [{size}, {size}] }} }}]\ndeposition = {{ max_time = 2, settled_speed = \"1 mm/s\" }}\n\
         time = {{ end = \"{end}\" }}\ncoupling = {{ material = \"w\", substeps = \"auto\", transfer = TRANSFER }}\n"
    )
}

#[test]
fn soft_ground_beds_reach_rest() {
    let damping =
        |ratio: f64| format!("solid.rayleigh = {{ damping_ratio = {ratio:.2}, frequencies = [10, 200] }}\n");
    let bed = box_of_grains(0.6, 60, "[\"60 mm\", \"100 mm\"]", 1, "2 s") + &damping(0.03);
    let loose = box_of_grains(0.6, 40, "[\"60 mm\", \"100 mm\"]", 1, "2 s") + &damping(0.0);
    let few = box_of_grains(0.1992, 17, "[\"37.36 mm\", \"40.58 mm\"]", 12, "1 s");
    let ball = r#"
grains = [{ name = "g", shape = "sphere", material = "s", spheres = [[0.02, 0.02, 0.1, 0.1]] }]
time = { end = "1 s" }
coupling = { material = "w", substeps = "auto", transfer = TRANSFER }
solid.gravity = false
solid.rayleigh = { damping_ratio = 0.03, frequencies = [10, 200] }
"#;
    let undamped = "friction = 0.6\nrestitution = 0.3\n";
    let damped = format!("{undamped}rolling_friction = 0.1\ntangential_damping_ratio = 1\n");
    let slippery = "friction = 0.207\nrestitution = 0.35\ntangential_damping_ratio = 0.0\n";
    for (name, text, [side, depth], transfer, [young, stiffness, contact], divided) in [
        (
            "bed under wide discs",
            &bed[..],
            [0.6, 0.5],
            "{ spread_factor = 2.0 }",
            ["20 MPa", "2 MN/m", undamped],
            true,
        ),
        (
            "bed under discs",
            &bed,
            [0.6, 0.5],
            "{ spread_factor = 1.0 }",
            ["20 MPa", "2 MN/m", undamped],
            true,
        ),
        ("ball at a corner", ball, [1.0, 0.5], "{ spread = \"50 mm\" }", ["20 MPa", "2 MN/m", &damped], true),
        ("loose stones", &loose, [0.6, 0.5], "\"point\"", ["20 MPa", "2 MN/m", undamped], false),
        // Without the half-step damping correction the energy error stops this run.
        (
            "few slippery stones",
            &few,
            [0.1992, 0.1353],
            "\"point\"",
            ["31.92 MPa", "0.688 MN/m", slippery],
            false,
        ),
    ] {
        let side = format!("lines = [0, {side}], counts = [3]");
        let soft = ground(
            [&side, &side, &format!("lines = [-{depth}, 0], counts = [2]")],
            young,
            stiffness,
            contact,
        );
        let (s, kinetic) = at_rest(&format!("{}{soft}", text.replace("TRANSFER", transfer)), &[]);
        let kinetic = kinetic.map(|energy| *energy.last().unwrap());
        let c = &s["coupling"];
        println!(
            "{name}: kinetic energy {:.1e}, {:.1e} J, {} parts, theta {}, {}",
            kinetic[0], kinetic[1], c["division"], c["theta"], c["interface"]
        );
        assert!(kinetic[0] < 1e-6 && kinetic[1] < 1e-6, "{name}: {kinetic:?}");
        assert_eq!(number(c, "/division") > 1.0, divided, "{name}: {c:#}");
        assert!(divided || number(&s, "/energy/largest_error") < 1e-4, "{name}: {:#}", s["energy"]);
    }
}

#[test]
fn undamped_contact_needs_theta() {
    let axes = [
        "lines = [0.0, 1.6], counts = [4]",
        "lines = [0.0, 0.4], counts = [2]",
        "lines = [-0.3, 0.0], counts = [1]",
    ];
    let contact = "friction = 1.0\nrestitution = 0.2\nrolling_friction = 0.9\n";
    let ball = r#"
grains = [{ name = "b", shape = "sphere", material = "s", spheres = [[0.8, 0.2, 0.04999, 0.05]], velocity = [0.001, 0, 0] }]
time = { end = "1 s" }
coupling = { material = "w", substeps = "auto" }
solid.gravity = false
"#;
    let scene = format!("{ball}{}", ground(axes, "100 MPa", "1 MN/m", contact));
    let late = |set: &[&str]| {
        let (s, [_, energy]) = at_rest(&scene, set);
        let warned = s["warnings"].to_string().contains("undamped contacts at rest");
        assert_eq!(warned, !set.is_empty(), "{}", s["warnings"]);
        energy[energy.len() * 9 / 10..].iter().fold(0.0_f64, |a, b| a.max(*b))
    };
    let kinetic = [late(&[]), late(&["coupling.theta=0.5"])];
    println!("solid's kinetic energy at the end: {kinetic:?} J");
    assert!(kinetic[0] < 1.5e-8, "{kinetic:?}");
}
