//! Grains at and beyond what their contacts can follow, through scenes: refused with the key (exit code 2), or stopped
//! with the names of both partners (exit code 3).

use super::support::{Folder, GRAINS, Table, json, run};

/// Stops with code 3 and `what` on standard error; the summary says the same.
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

/// 1.5 of the limit: refused by the key. Taken all the same, a single pair, for which the bound is wide, still runs.
#[test]
fn step_of_one_and_a_half_limits() {
    let folder = Folder::new("step_limit");
    let scene = folder.write("scene.toml", GRAINS);
    let step = "time.grain_step=2.06e-4";
    let refused = run(&scene, &folder.join("out"), &[step]);
    assert_eq!(refused.code, 2, "{refused:?}");
    assert!(refused.stderr.contains("time.grain_step: found 0.000206 s"), "{}", refused.stderr);
    assert!(!folder.join("out").exists());
    run(&scene, &folder.join("out"), &[step, "time.accept_step_above_limit=true"]).good();
}

/// Two grains shot at each other faster than their contact can stop them.
#[test]
fn head_on_at_two_hundred_metres_per_second() {
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
    stops("head_on", &text, "overlap of body 0 and body 1");
}

/// 1000 m/s at a floor that is far too soft for it.
#[test]
fn floor_struck_at_a_thousand_metres_per_second() {
    let spheres = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
    let fast = "spheres = [[0.0, 0.0, 0.3, 0.05]]\nvelocity = [0.0, 0.0, -1000.0]";
    assert!(GRAINS.contains(spheres));
    let text = GRAINS.replace(spheres, fast);
    // Half the radius is passed within a step: stopped by speed, at once. With short steps, by the overlap.
    stops("fast_floor", &text, "speed of body 0: 1000");
    let short = text.replace("end = \"20 ms\"", "end = \"20 ms\"\ngrain_step = \"5 us\"");
    stops("fast_floor_short", &short, "overlap of body 0 and plane 0");
}

/// A light grain in a stream that carries it along within 0.1 µs, on contacts a hundred times slower: u = V/(1 + cVt), c = ½ρCπr²/m. A
/// fixed step that passes that time is rejected.
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
