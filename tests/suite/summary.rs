//! `summary.json`: completeness and balance errors.
//!
//! | balance | bound | source |
//! |---|---|---|
//! | grain momentum and angular momentum, over impulses | 1e-9 | rounding; measured 1e-14 |
//! | interface force and moment, relative | 1e-12 | shape functions sum to 1: rounding |
//! | energy, over load work | 1 % | explicit DEM steps; decreases with step length |

use super::support::{COUPLED, GRAINS, SOLID, Table, json, numbers, run, scene_folder};
use serde_json::Value;

const SETTLED: [&str; 3] = ["track.load.rest=0.3", "track.load.cycles=3", "material.0.restitution=0.1"];

#[track_caller]
fn expect_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "no {key} in {value:#}");
    }
}

#[test]
fn coupled_summary_is_complete() {
    let folder = scene_folder("summary", COUPLED);
    run(&folder.join("scene.toml"), &folder.join("out"), &SETTLED).good();
    let summary = json(&folder.join("out/summary.json"));
    let keys = [
        "status",
        "title",
        "version",
        "scene_hash",
        "overrides",
        "threads",
        "peak_memory",
        "cpu_seconds",
        "stages",
        "model",
        "energy",
        "momentum",
        "coupling",
        "settlement",
        "warnings",
        "sources",
    ];
    expect_keys(&summary, &keys);
    assert_eq!((&summary["status"], &summary["title"]), (&"done".into(), &"spheres on a block".into()));
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["overrides"], Value::from(SETTLED.to_vec()));
    let hash = summary["scene_hash"].as_str().unwrap();
    assert!(hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    if cfg!(target_os = "linux") {
        assert!(summary["peak_memory"].as_u64().unwrap() > 1_000_000);
        assert!(summary["cpu_seconds"].as_f64().unwrap() > 0.0);
    }
    assert!(summary["sources"].as_array().unwrap().len() >= 4);

    let stage = &summary["stages"][0];
    expect_keys(stage, &["name", "seconds", "grain_steps", "solid_steps", "windows"]);
    assert_eq!(stage["name"], "run");
    let (grain_steps, solid_steps) =
        (stage["grain_steps"].as_u64().unwrap(), stage["solid_steps"].as_u64().unwrap());
    assert!(
        (2 * solid_steps..=10 * solid_steps).contains(&grain_steps),
        "ten of the first step, fewer of longer ones"
    );
    assert_eq!(stage["windows"], solid_steps);
    let model = &summary["model"];
    let sizes = ["nodes", "elements", "unknowns", "bodies", "spheres"].map(|k| model[k].as_u64().unwrap());
    assert_eq!(sizes, [81, 8, 180, 6, 5]);
    let step = |k: &str| model[k].as_f64().unwrap();
    assert!(step("solid_step") <= 10.0 * step("grain_step") * (1.0 + 1e-12));
    assert!(step("grain_step") <= step("grain_step_limit"));
    assert!(
        (solid_steps as f64 * step("solid_step") - 0.38).abs() < step("solid_step"),
        "rest, ramp, three cycles"
    );

    let momentum = ["linear", "angular"].map(|k| summary["momentum"][k].as_f64().unwrap());
    println!("momentum {:.1e}, angular momentum {:.1e}", momentum[0], momentum[1]);
    assert!(momentum.iter().all(|e| *e < 1e-9), "{momentum:?}");
    let coupling = &summary["coupling"];
    let keys = [
        "transfer",
        "scheme",
        "substeps",
        "stability",
        "classes",
        "passes",
        "interface_work_error",
        "transfer_kind",
    ];
    expect_keys(coupling, &keys);
    let audit = ["force", "moment"].map(|k| coupling["transfer"][k].as_f64().unwrap());
    println!("interface: force {:.1e}, moment {:.1e}", audit[0], audit[1]);
    assert!(audit.iter().all(|e| *e <= 1e-12), "{audit:?}");
    assert!(coupling["transfer"]["exchanges"].as_u64().unwrap() > 0);
}

#[test]
fn coupled_energy_adds_up() {
    let folder = scene_folder("summary_energy", COUPLED);
    run(&folder.join("scene.toml"), &folder.join("out"), &SETTLED).good();
    let summary = json(&folder.join("out/summary.json"));
    let energy = &summary["energy"];
    let keys =
        ["start", "end", "flows", "error", "work", "reference_energy", "relative_error", "largest_error"];
    expect_keys(energy, &[&keys[..], &["largest_relative_error"]].concat());
    let relative = energy["relative_error"].as_f64().unwrap();
    println!("energy error {:.3} % of the work of {} J", 100.0 * relative, energy["work"]);
    assert!(relative < 0.01, "{energy:#}");

    let total = |k: &str| energy[k].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).sum::<f64>();
    let spent = |k: &str| energy["flows"][k].as_f64().unwrap();
    let dissipated: f64 =
        ["dashpot", "friction", "local_damping", "rayleigh", "numerical"].map(spent).iter().sum();
    let work: f64 = ["applied_work", "wall_work", "solid_load_work"].map(spent).iter().sum();
    let error = total("end") - total("start") + dissipated - work;
    assert!((error - energy["error"].as_f64().unwrap()).abs() < 1e-9);
    // JSON parsing may lose the last bit.
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-15 * a.abs();
    let history = Table::read(&folder.join("out/history.csv"));
    for (column, key) in [("energy_error", "error"), ("work", "work")] {
        assert!(same(*history.column(column).last().unwrap(), energy[key].as_f64().unwrap()), "{column}");
    }

    let cycles = Table::read(&folder.join("out/cycles.csv"));
    let settlement = numbers(&summary["settlement"]["per_cycle"]);
    assert_eq!(settlement.len(), 3);
    assert!(settlement.iter().zip(cycles.column("settlement")).all(|(a, b)| same(*a, b)), "{settlement:?}");
    assert_eq!(numbers(&summary["settlement"]["increments"]).len(), 3);
    let work: f64 = cycles.column("dissipated_energy").iter().sum();
    assert!(work <= energy["work"].as_f64().unwrap() + 1e-9, "the cycles' part of the work, {work} J");
}

#[test]
fn contact_force_on_solid_equals_weight() {
    let folder = scene_folder("carried", COUPLED);
    run(
        &folder.join("scene.toml"),
        &folder.join("out"),
        &["track.load.rest=1.0", "material.0.restitution=0.1"],
    )
    .good();
    let history = Table::read(&folder.join("out/history.csv"));
    let (time, force) = (history.column("time"), history.column("contact_force_on_solid_z"));
    let rest: Vec<f64> =
        time.iter().zip(&force).filter(|(t, _)| (0.5..1.0).contains(*t)).map(|(_, f)| *f).collect();
    let mean = rest.iter().sum::<f64>() / rest.len() as f64;
    let weight = 9.81 * (400.0 + 5.0 * 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.001);
    println!("mean contact force {mean:.2} N, weight {weight:.2} N, {} rows", rest.len());
    assert!((mean / weight + 1.0).abs() < 5e-3, "{mean} N against {weight} N");
}

#[test]
fn hash_covers_scene_overrides_and_files() {
    let folder = scene_folder("hash", SOLID);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let hash = |set: &[&str]| {
        run(&scene, &out, set).good();
        json(&out.join("summary.json"))["scene_hash"].as_str().unwrap().to_string()
    };
    let first = hash(&[]);
    assert_eq!(hash(&[]), first, "the same again");
    let mut seen = vec![first];
    seen.push(hash(&["solid.material.0.poisson=0.3"]));
    let list = std::fs::read_to_string(folder.join("DOF.DAT")).unwrap();
    folder.write("DOF.DAT", &(list + "! a remark\n"));
    seen.push(hash(&[]));
    folder.edit("scene.toml", "title = \"block\"", "title = \"another block\"");
    seen.push(hash(&[]));
    let count = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), count, "{seen:?}");
}

#[test]
fn balances_follow_kind_of_run() {
    let folder = scene_folder("kinds", SOLID);
    run(&folder.join("scene.toml"), &folder.join("solid"), &[]).good();
    let solid = json(&folder.join("solid/summary.json"));
    expect_keys(
        &solid["statics"],
        &["load", "reaction", "equilibrium_error", "largest_displacement", "strain_energy"],
    );
    // 10 kPa on 4 m², and 8 t of soil.
    let load = numbers(&solid["statics"]["load"])[2];
    assert!((load + 40e3 + 8e3 * 9.81).abs() < 1e-6, "{load}");
    assert!(solid["statics"]["equilibrium_error"].as_f64().unwrap() < 1e-12);
    assert!(["momentum", "coupling", "settlement"].iter().all(|k| solid.get(k).is_none()));

    folder.write("grains.toml", GRAINS);
    run(&folder.join("grains.toml"), &folder.join("grains"), &[]).good();
    let grains = json(&folder.join("grains/summary.json"));
    expect_keys(&grains, &["momentum", "energy"]);
    assert!(["statics", "coupling", "settlement"].iter().all(|k| grains.get(k).is_none()));
    assert!(grains["momentum"]["linear"].as_f64().unwrap() < 1e-9);
}
