//! Large coordinates, fast walls, extreme gravity.

use super::case::{Case, off};
use super::scenes::{ball, floor, mass, plane, stone, time};
use super::table::{Row, figures, rows};

rows! {
    far: "grains far from the origin";
    gravities: "gravity of any size";
    moving_walls: "walls that move fast";
    skipping_walls: "walls that skip a grain in one step";
    servo_walls: "servo walls beyond their largest speed";
}

fn far() -> Row {
    let (mut forces, mut accounts) = (Vec::new(), Vec::new());
    for offset in [1e3, 1e6, 1e9, 1e12] {
        let text = stone("restitution = 0.1\n")
            + &ball("ball", [offset, 0.0, offset + 0.01], 0.01, [0.0; 3])
            + &plane("floor", [offset, 0.0, offset], [0.0, 0.0, 1.0])
            + &time(0.3, 100);
        let case = Case::run(&text, &[]).good();
        forces.push(off(-case.last("floor_force_z"), mass(0.01) * 9.81));
        accounts.push(case.value("/energy/largest_relative_error"));
    }
    assert!(
        forces.iter().all(|e| *e < 1e-9) && accounts.iter().all(|e| *e < 0.01),
        "{forces:?} {accounts:?}"
    );
    Row::new(
        "ball of 10 mm at rest 1e3, 1e6, 1e9, 1e12 m from the origin",
        format!(
            "right: force on the floor off by {}, energy account by {}",
            figures(&forces),
            figures(&accounts)
        ),
        "weight",
    )
}

fn gravities() -> Row {
    let fallen = |gravity: f64| {
        let text = stone("restitution = 0.3\n")
            .replace("title", &format!("gravity = [0, 0, -{gravity:?}]\ntitle"))
            + &ball("ball", [0.0, 0.0, 0.02], 0.01, [0.0; 3])
            + &floor()
            + &time(4.0 * (0.02 / gravity).sqrt(), 200);
        Case::run(&text, &[])
    };
    let errors = [1e-6, 1.0, 1e3]
        .map(|gravity| off(-fallen(gravity).good().last("floor_force_z"), mass(0.01) * gravity));
    assert!(errors.iter().all(|e| *e < 1e-6), "{errors:?}");
    fallen(1e6).stopped("overlap of body 0 of \"ball\" and wall \"floor\": 0.01");
    Row::new(
        "ball dropped by its radius at 1e-6, 1, 1e3, 1e6 m/s²",
        format!(
            "right: weight at rest off by {}; where it would sink in by its radius stopped: `body 0 and wall 0 overlap`",
            figures(&errors)
        ),
        "weight",
    )
}

/// Triangulated plate hits a resting ball, e = 0.5, `speed` [m/s].
fn struck(speed: f64, stiffness: f64) -> Case {
    let text = stone(&format!("weightless\nstiffness = {stiffness:e}\n"))
        + &ball("ball", [0.3, 0.02, 0.05], 0.01, [0.0; 3])
        + "\n[[walls]]\nkind = \"triangles\"\nmaterial = \"stone\"\n\
           vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\ntriangles = [[0, 1, 2], [0, 2, 3]]\n"
        + &format!("velocity = [0, 0, {speed:?}]\n")
        + &time(0.2 / speed, 100);
    Case::run(&text, &[])
}

fn moving_walls() -> Row {
    let mut errors = Vec::new();
    for (speed, stiffness) in [(0.1, 1e5), (1.0, 1e5), (30.0, 1e5), (1000.0, 1.1e10)] {
        errors.push(off(struck(speed, stiffness).good().velocity("ball", 0.1)[2], 1.5 * speed));
    }
    assert!(errors.iter().all(|e| *e < 0.01), "{errors:?}");
    struck(100.0, 1e5).stopped("overlap of body 0 of \"ball\" and triangle 0");
    Row::new(
        "plate of triangles that meets a ball at rest at 0.1, 1, 30 m/s, 1000 m/s (K = 1.1e10); 100 m/s (K = 1e5)",
        format!(
            "right: speed of the ball off by {}; too soft for it stopped: `overlap of body 0 and triangle 0`",
            figures(&errors)
        ),
        "v' = (1 + e) v",
    )
}

fn skipping_walls() -> Row {
    for speed in [300.0, 1e3, 3e3, 1e4] {
        struck(speed, 1e5).stopped("speed of wall0");
    }
    Row::new(
        "the plate at 300, 1e3, 3e3, 1e4 m/s, K = 1e5: 1.2, 4, 12, 40 radii in a step",
        "stopped: `speed of wall 0` more than half the smallest radius a step",
        "v' = (1 + e) v",
    )
}

fn pressed(frequency: f64, max_speed: f64, keys: &str) -> Case {
    let start = 0.2;
    let text = stone(&format!("restitution = 0.5\n{keys}"))
        + &ball("ball", [0.0, 0.0, 0.01], 0.01, [0.0; 3])
        + &floor()
        + &plane("plate", [0.0, 0.0, 0.0201], [0.0, 0.0, -1.0])
        + &format!(
            "servo = {{ force = 2.0, gain = 1.0, max_speed = {max_speed:?}, pulses = {{ peak = 2.0, frequency = {frequency:?}, count = 5, \
             start = {start:?} }} }}\n"
        )
        + &time(start + 5.0 / frequency, 200);
    Case::run(&text, &[])
}

fn servo_walls() -> Row {
    let error = |case: Case| case.good().value("/loads/0/error");
    let followed = [1.0, 10.0].map(|f| error(pressed(f, 1.0, "")));
    let stiff = ["stiffness = 1e4\n", "stiffness = 1e8\n"].map(|k| error(pressed(10.0, 1.0, k)));
    assert!(followed.iter().chain(&stiff).all(|e| *e < 0.02), "{followed:?} {stiff:?}");
    let beyond = [pressed(100.0, 1.0, ""), pressed(1000.0, 1.0, ""), pressed(100.0, 1e-3, "")].map(|case| {
        let case = case.good();
        let summary = case.summary();
        assert_ne!(summary["verdict"]["outcome"], "passed", "{summary}");
        let checks = summary["validity"].as_array().unwrap();
        let check =
            checks.iter().find(|c| c["name"] == "error of an applied load over its amplitude").unwrap();
        assert!(
            check["status"] != "passed"
                && check["message"].as_str().unwrap().starts_with("wall plate: force")
        );
        case.value("/loads/0/error")
    });
    Row::new(
        "plate that pulses a ball at 1, 10 Hz, K = 1e4, 1e8 N/m; at 100, 1000 Hz; max_speed a sixth of the one needed",
        format!(
            "right: error of the force {}, {}; warned, failed, failed: {}",
            figures(&followed),
            figures(&stiff),
            figures(&beyond)
        ),
        "target force",
    )
}
