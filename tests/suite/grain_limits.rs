//! Contacts at their limits: exit code 2 with the key, or 3 with both partners.

use super::support::{Folder, GRAINS, Table, json, run};

fn stops(name: &str, text: &str, what: &str) {
    let folder = Folder::new(name);
    let scene = folder.write("scene.toml", text);
    let out = folder.join("out");
    let outcome = run(&scene, &out, &[]);
    assert_eq!(outcome.code, 3, "{outcome:?}");
    assert!(outcome.stderr.contains(what) && outcome.stderr.contains("at t = "), "{}", outcome.stderr);
    let summary = json(&out.join("summary.json"));
    let status = summary["status"].as_str().unwrap();
    assert!(status.starts_with("failed: ") && status.contains(what), "{status}");
}

/// Rejected; if forced, a single pair still runs, since the bound is conservative.
#[test]
fn rejects_step_above_limit() {
    let folder = Folder::new("step_limit");
    let scene = folder.write("scene.toml", GRAINS);
    let step = "time.grain_step=2.06e-4";
    let refused = run(&scene, &folder.join("out"), &[step]);
    assert_eq!(refused.code, 2, "{refused:?}");
    assert!(refused.stderr.contains("time.grain_step: found 0.000206 s"), "{}", refused.stderr);
    assert!(!folder.join("out").exists());
    run(&scene, &folder.join("out"), &[step, "time.accept_step_above_limit=true"]).good();
}

#[test]
fn head_on_collision_stops() {
    let pair = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
    let group = |name: &str, x: f64, speed: f64| {
        format!(
            "[[grains]]\nname = \"{name}\"\nshape = \"sphere\"\nmaterial = \"stone\"\n\
             spheres = [[{x:?}, 0.0, 0.5, 0.05]]\nvelocity = [{speed:?}, 0.0, 0.0]\n"
        )
    };
    let grains = format!("[[grains]]\nname = \"pair\"\nshape = \"sphere\"\nmaterial = \"stone\"\n{pair}\n");
    assert!(GRAINS.contains(&grains));
    let text = GRAINS.replace(&grains, &(group("left", -0.2, 100.0) + &group("right", 0.2, -100.0)));
    stops("head_on", &text, "overlap of body 0 of \"left\" and body 1 of \"right\"");
}

#[test]
fn fast_impact_on_floor_stops() {
    let spheres = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
    let fast = "spheres = [[0.0, 0.0, 0.3, 0.05]]\nvelocity = [0.0, 0.0, -1000.0]";
    assert!(GRAINS.contains(spheres));
    let text = GRAINS.replace(spheres, fast);
    // More than half a radius per step: speed limit. Short steps: overlap limit.
    stops("fast_floor", &text, "speed of body 0 of \"pair\": 1000");
    let short = text.replace("end = \"20 ms\"", "end = \"20 ms\"\ngrain_step = \"5 us\"");
    stops("fast_floor_short", &short, "overlap of body 0 of \"pair\" and wall0");
}

/// Drag acceleration within 0.1 µs, contacts a hundred times slower: u = V/(1 + cVt), c = ½ρCπr²/m.
#[test]
fn stiff_drag_limits_the_step() {
    let text = r#"
gravity = [0, 0, 0]
[wind]
drag = 1.0
velocity = [100.0, 0, 0]
density = 1000
[[material]]
name = "foam"
density = 10
stiffness = 10
restitution = 0.9
friction = 0.5
[[grains]]
name = "g"
shape = "sphere"
material = "foam"
spheres = [[0, 0, 0, 0.001]]
record = true
[time]
end = 2e-5
[output]
frames = 0
vtk = false
"#;
    let folder = Folder::new("stiff_drag");
    let scene = folder.write("scene.toml", text);
    run(&scene, &folder.join("out"), &[]).good();
    let way = *Table::read(&folder.join("out/history.csv")).column("g_x").last().unwrap();
    let c = 0.5 * 1000.0 * std::f64::consts::PI * 1e-6 / (10.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9);
    let expected = 100.0 * 2e-5 - (1.0_f64 + c * 100.0 * 2e-5).ln() / c;
    assert!((way / expected - 1.0).abs() < 0.01, "{way} {expected}");
    let fixed = run(&scene, &folder.join("fixed"), &["time.grain_step=1e-6"]);
    assert_eq!(fixed.code, 2, "{fixed:?}");
    assert!(fixed.stderr.contains("the drag or lift of a fluid"), "{}", fixed.stderr);
}
