//! Grains on tetrahedra, wedges and mixed meshes.

use super::support::{Folder, json, repository, run, trackbed};
use serde_json::Value;
use std::fs;

const TETRAHEDRA: &str = "inputs/coupled/embankment_tet10";
const MIXTURE: &str = "inputs/coupled/slab_mixed";

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value:#}"))
}

#[test]
fn tetrahedra_and_mixed_meshes_conserve_energy() {
    let folder = Folder::new("faces");
    let short: [(&str, &[&str]); 2] = [
        (
            TETRAHEDRA,
            &[
                "grains.0.count=60",
                "deposition.max_time=0.5",
                "track.load.cycles=1",
                "track.load.frequency=50",
            ],
        ),
        (MIXTURE, &["grains.0.count=40", "time.end=0.1"]),
    ];
    for (k, (scene, set)) in short.into_iter().enumerate() {
        let out = folder.join(&format!("out{k}"));
        run(&repository().join(scene).join("scene.toml"), &out, &[set, &["output.frames=1"]].concat()).good();
        let s = json(&out.join("summary.json"));
        let warnings = s["warnings"].to_string();
        println!("{scene}: {:.1e}, {:#}", number(&s, "/energy/relative_error"), s["coupling"]["transfer"]);
        assert!(
            !warnings.contains("left the solid") && !warnings.contains("unstable"),
            "{scene}: {warnings}"
        );
        assert!(number(&s, "/energy/relative_error") < 1e-2, "{scene}: {:#}", s["energy"]);
        assert!(number(&s, "/coupling/transfer/force") < 1e-12, "{scene}");
        assert!(number(&s, "/coupling/transfer/moment") < 1e-12, "{scene}");
        assert!(number(&s, "/coupling/transfer/exchanges") > 1000.0, "{scene}");
    }
}

#[test]
fn mixed_mesh_bears_weight_of_spheres() {
    let folder = Folder::new("faces-forms");
    let source = repository().join(MIXTURE);
    fs::copy(source.join("slab.inp"), folder.join("slab.inp")).unwrap();
    let text = fs::read_to_string(source.join("scene.toml")).unwrap();
    let scene = folder.write("scene.toml", &text);
    let spheres: [[f64; 3]; 5] =
        [[0.0, 0.0, 0.03], [0.13, 0.2, 0.04], [-0.2, -0.02, 0.035], [0.35, 0.3, 0.05], [0.2, -0.4, 0.025]];
    let placed: Vec<String> =
        spheres.iter().map(|[x, y, r]| format!("[{x}, {y}, {}, {r}]", r + 1e-5)).collect();
    let placed = format!("grains.0.spheres=[{}]", placed.join(", "));
    let weight: f64 =
        spheres.iter().map(|s| 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * s[2].powi(3) * 9.81).sum();
    for mesh in ["slab.inp", "slab.msh", "slab.vtu", "slab.cdb"] {
        if mesh != "slab.inp" {
            let paths = ["slab.inp", mesh].map(|m| folder.join(m).display().to_string());
            trackbed(["mesh", "convert", &paths[0], &paths[1]]).good();
        }
        let named = format!("solid.mesh={mesh}");
        let mut set = vec![&named[..], &placed, "deposition=", "time.end=0.4", "output.frames=1"];
        set.extend(["grains.0.count=", "grains.0.size=", "grains.0.fill=", "grains.0.seed="]);
        let check: Vec<String> = ["check", &scene.display().to_string()].map(String::from).into();
        let check = check.into_iter().chain(set.iter().flat_map(|s| ["--set".to_string(), s.to_string()]));
        let said = trackbed(check).good().stdout;
        assert!(said.contains("coupling: 168 faces"), "{mesh}: {said}");
        let out = folder.join(&format!("out-{mesh}"));
        run(&scene, &out, &set).good();
        let rows = fs::read_to_string(out.join("history.csv")).unwrap();
        let last = rows.lines().last().unwrap();
        let force: f64 = -last.split(',').nth(3).unwrap().parse::<f64>().unwrap();
        println!("{mesh}: {force} N of {weight} N");
        assert!((force / weight - 1.0).abs() < 1e-3, "{mesh}: {force} of {weight}");
    }
}

#[test]
fn no_upward_face_is_left_out() {
    let scene = repository().join(TETRAHEDRA).join("scene.toml").display().to_string();
    let said = |order: &str| trackbed(["check", &scene, "--set", order]).good().stdout;
    let (quadratic, linear) = (said("solid.order=quadratic"), said("solid.order=linear"));
    let faces = |text: &str| -> u32 {
        text.split_once("coupling: ").unwrap().1.split_once(" faces").unwrap().0.parse().unwrap()
    };
    assert_eq!(faces(&quadratic), faces(&linear));
    assert!(faces(&quadratic) > 100, "{quadratic}");
}
