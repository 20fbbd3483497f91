//! Grains: time step, extreme ratios, friction and restitution limits, impacts, single bodies.

use super::case::{Case, off};
use super::scenes::{ball, floor, mass, plane, stone, time};
use super::table::{Row, figure, figures, rows};

rows! {
    step: "DEM time step at its limit";
    stiffnesses: "stiffnesses far apart";
    masses: "masses and radii far apart";
    friction: "friction 0 and beyond all need";
    restitution: "restitution near 0 and 1";
    overlap: "overlap at the start";
    coincident: "centres that coincide";
    impact: "1000 m/s against a thin plate";
    alone: "no gravity, one grain, none";
}

/// FCC crystal of 3³ cells, compressed 1 % and perturbed, between six planes.
fn crystal() -> String {
    let cell = 0.99 * 0.02 * 2.0_f64.sqrt();
    let mut spheres = Vec::new();
    for k in 0..27_u32 {
        let corner = [k % 3, k / 3 % 3, k / 9].map(f64::from);
        for (m, place) in
            [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]].iter().enumerate()
        {
            let place: [f64; 3] = std::array::from_fn(|d| {
                let disturbance = (f64::from(7 * k) + m as f64 * 2.3 + d as f64 * 1.7).sin() * 5e-5;
                (corner[d] + place[d]) * cell + disturbance
            });
            spheres.push(format!("[{:?}, {:?}, {:?}, 0.01]", place[0], place[1], place[2]));
        }
    }
    let mut text = stone("weightless\nrestitution = 0.9\n")
        + &format!(
            "\n[[grains]]\nname = \"crystal\"\nshape = \"sphere\"\nmaterial = \"stone\"\nspheres = [{}]\n",
            spheres.join(",\n")
        );
    for axis in 0..3 {
        let along = |x: f64| std::array::from_fn(|d| if d == axis { x } else { 0.0 });
        text += &plane(&format!("low{axis}"), along(-0.01), along(1.0));
        text += &plane(&format!("high{axis}"), along(2.5 * cell + 0.01), along(-1.0));
    }
    text + &time(0.5, 100)
}

fn step() -> Row {
    let text = crystal();
    let limit = Case::run(&text, &["time.end=1e-5"]).good().value("/model/grain_step_limit");
    let with = |factor: f64, accept: bool| {
        let step = format!("time.grain_step={:e}", factor * limit);
        let accept = format!("time.accept_step_above_limit={accept}");
        Case::run(&text, &[&step, &accept])
    };
    let errors = [0.9, 1.0].map(|factor| {
        let case = with(factor * (1.0 - 1e-12), false).good();
        let (kinetic, held) = (case.history("grains_kinetic"), case.history("contact_springs"));
        let total: Vec<f64> = kinetic.iter().zip(&held).map(|(k, e)| k + e).collect();
        assert!(total.windows(2).skip(5).all(|t| t[1] < 1.001 * t[0]), "{factor}: {total:?}");
        case.value("/energy/largest_relative_error")
    });
    assert!(errors.iter().all(|e| *e < 0.2), "{errors:?}");
    for factor in [1.0 + 1e-9, 1.1, 3.0] {
        with(factor, false).refused("time.grain_step: found ");
    }
    with(1.1, true).good();
    for factor in [1.5, 3.0] {
        with(factor, true).stopped("at t = ");
    }
    Case::run(&text, &["time.grain_step_fraction=1.1"]).refused("time.grain_step_fraction: found 1.1");
    Row::new(
        "0.9, 1, 1 + 1e-9, 1.1, 1.5, 3 times the limit of a pressed crystal",
        format!(
            "up to 1 stable: the stored energy does not grow; warned: the energy account, which such steps resolve to {} % only; \
             beyond 1 refused: `time.grain_step`; accepted all the same, 1.1 is still stable, 1.5 and 3 are stopped",
            figures(&errors.map(|e| 100.0 * e))
        ),
        "energy account; stiffest packing of spheres",
    )
}

fn stiffnesses() -> Row {
    let mut errors = Vec::new();
    for ratio in [1.0, 1e3, 1e6, 1e12] {
        let rigid = format!(
            "\n[[material]]\nname = \"rock\"\nstiffness = {:e}\nfriction = 0.5\nrestitution = 0.1\n",
            1e4 * ratio
        );
        let text = stone("stiffness = 1e4\nrestitution = 0.1\n")
            + &rigid
            + &ball("ball", [0.0, 0.0, 0.01], 0.01, [0.0; 3])
            + &floor().replace("\"stone\"", "\"rock\"")
            + &time(0.3, 100);
        let rest = 0.01 - Case::run(&text, &[]).good().last("ball_z");
        errors.push(off(rest, mass(0.01) * 9.81 / (2e4 * ratio / (1.0 + ratio))));
    }
    assert!(errors.iter().all(|e| *e < 1e-4), "{errors:?}");
    Row::new(
        "ball at rest on a floor 1, 1e3, 1e6, 1e12 times as stiff",
        format!("right: overlap off by {}", figures(&errors)),
        "m g / K, K = 2 k₁k₂/(k₁ + k₂)",
    )
}

fn masses() -> Row {
    let mut errors = Vec::new();
    for ratio in [1.0, 10.0, 100.0, 1000.0] {
        let (small, large) = (0.01, 0.01 * ratio);
        let text = stone("weightless\n")
            + &ball("boulder", [0.0; 3], large, [0.0; 3])
            + &ball("grain", [0.0, 0.0, large + 1.001 * small], small, [0.0, 0.0, -1.0])
            + &time(0.01, 100);
        let case = Case::run(&text, &[]).good();
        let (boulder, grain) = (case.velocity("boulder", 0.1)[2], case.velocity("grain", 0.1)[2]);
        let share = ratio.powi(3);
        errors.push((grain - boulder - 0.5).abs() / 0.5);
        let momentum = case.value("/momentum/linear");
        let expected = -1.5 / (1.0 + share);
        assert!(
            momentum < 1e-9 && (boulder - expected).abs() < 0.01 * expected.abs() + 1e-9,
            "{ratio}: {boulder}"
        );
    }
    assert!(errors.iter().all(|e| *e < 0.01), "{errors:?}");
    Row::new(
        "hit of two balls of radius ratio 1, 10, 100, 1000 (mass 1e9)",
        format!("right: restitution off by {}, momentum kept", figures(&errors)),
        "e = 0.5, conservation of momentum",
    )
}

fn friction() -> Row {
    let mut errors = Vec::new();
    let slope = 0.5_f64.sqrt();
    for (friction, share) in [(0.0, 1.0), (10.0, 5.0 / 7.0), (1e6, 5.0 / 7.0)] {
        let press = mass(0.01) * 9.81 * slope / 1e5;
        let text = stone(&format!("friction = {friction:?}\ntangential_damping_ratio = 1\n"))
            + &ball("ball", [(0.01 - press) * slope, 0.0, (0.01 - press) * slope], 0.01, [0.0; 3])
            + &plane("slope", [0.0; 3], [1.0, 0.0, 1.0])
            + &time(0.2, 100);
        let case = Case::run(&text, &[]).good();
        let (x, t) = (case.history("ball_x"), case.history("time"));
        let way = (x[100] - x[0]) / slope;
        errors.push(off(way, 0.5 * share * 9.81 * slope * t[100] * t[100]));
    }
    assert!(errors.iter().all(|e| *e < 3e-3), "{errors:?}");
    let text = stone("friction = -0.1\n") + &ball("ball", [0.0; 3], 0.01, [0.0; 3]) + &time(0.2, 100);
    Case::run(&text, &[]).refused("material.0.friction: found -0.1");
    Row::new(
        "ball on a slope of 45°, friction 0, 10, 1e6; −0.1",
        format!("right: way off by {}; negative refused: `material.0.friction`", figures(&errors)),
        "½ g sin 45° t², rolling 5/7 of it",
    )
}

fn restitution() -> Row {
    let mut errors = Vec::new();
    let from = |height: f64, e: f64| {
        stone(&format!("weightless\nrestitution = {e:?}\n"))
            + &ball("ball", [0.0, 0.0, height], 0.01, [0.0, 0.0, -1.0])
            + &floor()
            + &time(if e < 0.1 { 0.1 } else { 0.01 }, 1000)
    };
    let text = |e: f64| from(0.0105, e);
    for e in [1e-2, 0.1, 0.5, 1.0] {
        let shorter: &[&str] = if e < 0.5 { &["time.grain_step_fraction=0.4"] } else { &[] };
        let case = Case::run(&text(e), shorter).good();
        errors.push((case.velocity("ball", 0.1)[2] - e).abs());
        assert!(case.value("/energy/largest_relative_error") < 0.01);
    }
    assert!(errors.iter().all(|e| *e < 5e-3), "{errors:?}");
    let sticky = [0.0105, 0.010_505, 0.010_51].map(|height| Case::run(&from(height, 1e-3), &[]).good());
    assert!(sticky.iter().all(|case| case.velocity("ball", 0.1)[2].abs() < 5e-3));
    assert!(sticky.iter().any(|case| case.summary()["verdict"]["outcome"] == "warned"));
    let account = sticky.iter().map(|case| case.value("/energy/largest_relative_error")).fold(0.0, f64::max);
    Case::run(&text(1e-4), &[]).stopped("energy error: ");
    for e in [0.0, 9e-5, 1.0 + 1e-9] {
        Case::run(&text(e), &[]).refused("material.0.restitution: found ");
    }
    Row::new(
        "0.01, 0.1, 0.5, 1; 1e-3; 1e-4; 0, 9e-5, 1 + 1e-9",
        format!(
            "right from 0.01: speed after the impact off by {} of that before, energy account within 1 %, below 0.5 with \
             `grain_step_fraction = 0.4` (0.3 to 3 % with the default, by where in a step the impact begins); 1e-3 warned: speed right, energy account of a \
             single impact off by {} %; 1e-4 stopped by that account; outside 1e-4 to 1 refused: `material.0.restitution`",
            figures(&errors),
            figure(100.0 * account)
        ),
        "v' = e v",
    )
}

fn overlap() -> Row {
    let pair = |depth: f64| {
        stone("weightless\nrestitution = 1\n")
            + &ball("left", [0.0; 3], 0.01, [0.0; 3])
            + &ball("right", [0.02 - depth, 0.0, 0.0], 0.01, [0.0; 3])
            + &time(0.02, 100)
    };
    let mut errors = Vec::new();
    for depth in [1e-6, 1e-3, 5e-3, 9.9e-3] {
        let case = Case::run(&pair(depth), &[]).good();
        let energy = case.last("grains_kinetic");
        errors.push(off(energy, 0.5 * 1e5 * depth * depth));
    }
    assert!(errors.iter().all(|e| *e < 0.02), "{errors:?}");
    Case::run(&pair(0.0101), &[])
        .stopped("overlap of body 0 of \"left\" and body 1 of \"right\": 0.0101 m (limit 0.01 m)");
    Row::new(
        "pair 1e-4, 0.1, 0.5, 0.99, 1.01 radii inside each other",
        format!(
            "right up to a radius: energy off by {}; beyond stopped at t = 0: `overlap of body 0 and body 1`",
            figures(&errors)
        ),
        "½ K δ²",
    )
}

fn coincident() -> Row {
    let pair = |gap: f64| {
        stone("")
            + &ball("one", [0.0, 0.0, 0.02], 0.01, [0.0; 3])
            + &ball("two", [gap, 0.0, 0.02], 0.01, [0.0; 3])
            + &floor()
            + &time(0.02, 100)
    };
    for gap in [0.0, 1e-300, 1e-12] {
        Case::run(&pair(gap), &[])
            .stopped("at t = 0.000000e0 s: overlap of body 0 of \"one\" and body 1 of \"two\": 0.0");
    }
    let on_floor =
        |z: f64| stone("") + &ball("one", [0.0, 0.0, z], 0.01, [0.0; 3]) + &floor() + &time(0.02, 100);
    let case = Case::run(&on_floor(0.0), &[]).good();
    let error = case.value("/energy/largest_relative_error");
    assert!(error < 0.01 && case.last("one_z") > 0.01);
    Case::run(&on_floor(-0.005), &[]).stopped("overlap of body 0 of \"one\" and wall \"floor\": 0.015 m");
    Row::new(
        "two balls 0, 1e-300, 1e-12 m apart; a ball with its centre in a plane, and 0.5 radii beyond",
        format!(
            "stopped at t = 0: `overlap of body 0 and body 1`; centre in the plane right: thrown up, energy account off by {}; \
             beyond it stopped: `body 0 and wall 0 overlap`",
            figure(error)
        ),
        "energy account",
    )
}

fn impact() -> Row {
    let scene = |stiffness: f64, offset: f64| {
        stone(&format!("weightless\nstiffness = {stiffness:e}\n"))
            + &ball("ball", [offset, 0.02, 0.05], 0.01, [0.0, 0.0, -1000.0])
            + "\n[[walls]]\nkind = \"triangles\"\nmaterial = \"stone\"\n\
               vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]\ntriangles = [[0, 1, 2], [0, 2, 3]]\n"
            + &time(2e-4, 1000)
    };
    let mut errors = Vec::new();
    for offset in [0.3, 0.02] {
        let case = Case::run(&scene(1.1e10, offset), &[]).good();
        errors.push(off(case.velocity("ball", 0.1)[2], 500.0));
        for stiffness in [1e5, 1e7] {
            Case::run(&scene(stiffness, offset), &[]).stopped("of body 0");
        }
    }
    assert!(errors.iter().all(|e| *e < 0.01), "{errors:?}");
    Row::new(
        "ball on a face and on a seam of a plate of triangles, K = 1.1e10, 1e7, 1e5 N/m",
        format!(
            "stiff enough (overlap a tenth of the radius) right: speed off by {}; softer stopped: `body 0 …` overlaps or is too \
             fast, never through",
            figures(&errors)
        ),
        "v' = e v",
    )
}

fn alone() -> Row {
    let free = stone("weightless\n") + &ball("ball", [0.0; 3], 0.01, [1.0, -2.0, 0.5]) + &time(1.0, 100);
    let case = Case::run(&free, &[]).good();
    let end = case.last("time");
    let error = off(case.last("ball_y"), -2.0 * end);
    assert!(error < 1e-11, "{error:e}");
    let falls = stone("") + &ball("ball", [0.0; 3], 0.01, [0.0; 3]) + &time(1.0, 100);
    let case = Case::run(&falls, &[]).good();
    let fall = off(case.last("ball_z"), -0.5 * 9.81 * case.last("time").powi(2));
    assert!(fall < 1e-6, "{fall:e}");
    let none = stone("") + &floor() + &time(0.1, 10);
    Case::run(&none, &[]).refused("found neither [solid] nor [[grains]]");
    let empty = free.replace("spheres = [[0.0, 0.0, 0.0, 0.01]]", "spheres = []");
    Case::run(&empty, &[]).refused("grains.0.spheres: found none");
    Row::new(
        "one ball without gravity, one that falls; no group, a group of none",
        format!(
            "right: ways of 1 s off by {}, {}; none refused: `found neither [solid] nor [[grains]]`, `grains.0.spheres`",
            figure(error),
            figure(fall)
        ),
        "v t, ½ g t²",
    )
}
