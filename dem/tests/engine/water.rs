//! Bodies in water against tables of closed forms.

use crate::scene::{Run, stone};
use crate::tables::read;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{
    BodyForce, BodyInput, DragArea, Measured, ModelInput, Shape, TimeStep, Vec3, Water, Wave, measure,
};

pub fn still(density: f64) -> Water {
    Water {
        level: 0.0,
        density,
        current: [0.0; 2],
        wave: None,
        drag: 0.0,
        drag_area: DragArea::Projected,
        skin_drag: 0.0,
        drag_moment: 0.0,
        added_mass: 0.0,
    }
}

/// One body in water; it starts with `lift` [m/s²] less, as other forces act with their first full kick (see
/// `State::new`).
fn one(shape: Shape, density: f64, body: BodyInput, water: Water, (dt, lift): (f64, f64)) -> Run {
    let mut material = stone();
    material.density = density;
    let velocity = body.velocity - Vec3::z() * (0.5 * lift * dt);
    let body = BodyInput { velocity, ..body };
    Run::new(ModelInput {
        materials: vec![material],
        shapes: vec![shape],
        bodies: vec![body],
        gravity: Vec3::new(0.0, 0.0, -9.81),
        body_forces: vec![BodyForce::Water(water)],
        time_step: TimeStep::FixedAboveLimit(dt),
        ..ModelInput::default()
    })
}

fn block(sides: [f64; 3]) -> Shape {
    Shape::Box { half: sides.map(|s| 0.5 * s) }
}

/// Submerged from rest, with added mass: v = v∞ tanh(a t/v∞).
#[test]
fn terminal_velocity_matches_closed_form() {
    let mut worst = 0.0_f64;
    for row in read("tests/data/water/terminal_speed.csv") {
        let [d, density, water, drag, added, end, start, t, speed, distance] = row[..10].try_into().unwrap();
        let dt = end / start / 1000.0;
        let lift = 9.81 + if density < water { start } else { -start };
        let water = Water { drag, added_mass: added, ..still(water) };
        let body = BodyInput { position: Vec3::new(0.0, 0.0, -100.0), ..BodyInput::default() };
        let mut run = one(Shape::Sphere { radius: 0.5 * d }, density, body, water, (dt, lift));
        let steps = (t / dt).round();
        run.steps(steps as usize);
        let late = t - (steps - 0.5) * dt;
        let slope = start * (1.0 - (speed / end).powi(2));
        let found = run.state.velocity(0).z.abs() + slope * late;
        let way = (run.state.position(0).z + 100.0).abs() + speed * (t - steps * dt);
        worst = worst.max((found / speed - 1.0).abs()).max((way / distance - 1.0).abs() * 0.1);
    }
    println!("off by {worst:.1e}");
    assert!(worst < 1e-4);
}

#[test]
fn a_current_takes_floes_along() {
    let mut worst = 0.0_f64;
    for row in read("tests/data/water/current_drift.csv") {
        let [length, width, thickness, ratio, drag, added, current, v0] = row[..8].try_into().unwrap();
        let wetted = length * width < row[9];
        let drag_area = if wetted { DragArea::Wetted } else { DragArea::Projected };
        let [t, v, x, moment, w0, reach, w] = row[10..17].try_into().unwrap();
        let water = Water { drag, drag_area, added_mass: added, current: [current, 0.0], ..still(1025.0) };
        let draft = ratio * thickness;
        let body = BodyInput {
            position: Vec3::new(0.0, 0.0, 0.5 * thickness - draft),
            velocity: Vec3::new(v0, 0.0, 0.0),
            // The table excludes pitching by the drag's lever arm.
            fixed: [false, false, false, true, true, false],
            ..BodyInput::default()
        };
        let dt = 5e-4;
        let past = current - v0;
        let drawn = 0.5 * drag * row[9] * past.abs() * past / (draft * length * width * (1.0 + added));
        let body = BodyInput { velocity: Vec3::new(v0 - 0.5 * dt * drawn, 0.0, 0.0), ..body };
        // Separate rotation: it changes the projected area.
        let mut turning = one(
            block([length, width, thickness]),
            ratio * 1025.0,
            BodyInput { spin: Vec3::new(0.0, 0.0, w0), velocity: Vec3::zeros(), ..body.clone() },
            Water { drag_moment: moment, ..still(1025.0) },
            (dt, 9.81),
        );
        let mut run = one(block([length, width, thickness]), ratio * 1025.0, body, water, (dt, 9.81));
        let steps = (t / dt).round() as usize;
        run.steps(steps);
        turning.steps(steps);
        let found = run.state.velocity(0).x;
        worst = worst.max((found - v).abs() / current.abs().max(v0.abs()));
        worst = worst.max((run.state.position(0).x - x).abs() / x.abs());
        assert!(
            (reach - 0.5 * (length * length + width * width + thickness * thickness).sqrt()).abs() < 1e-9
        );
        worst = worst.max((turning.state.spin(0).z - w).abs() / w0);
    }
    println!("off by {worst:.1e}");
    assert!(worst < 1e-4);
}

fn period(run: &mut Run, dt: f64, signal: impl Fn(&Run) -> f64) -> f64 {
    let mut zeros = Vec::new();
    let mut before = signal(run);
    let mut step = 0_u32;
    while zeros.len() < 5 && step < 200_000 {
        run.step();
        step += 1;
        let now = signal(run);
        if before * now < 0.0 {
            zeros.push(f64::from(step) - now / (now - before));
        }
        before = now;
    }
    (zeros[4] - zeros[0]) * 0.5 * dt
}

#[test]
fn floes_have_expected_periods() {
    for row in read("tests/data/water/box_periods.csv") {
        let [l, w, h, ratio, added, _, draft, heave, gm_roll, gm_pitch, roll, pitch] =
            row[..12].try_into().unwrap();
        let place = Vec3::new(0.0, 0.0, 0.5 * h - draft);
        let dt = 1e-3;
        let water = Water { added_mass: added, ..still(1025.0) };
        let body = BodyInput { position: place + Vec3::z() * (0.01 * draft), ..BodyInput::default() };
        let mut run = one(block([l, w, h]), ratio * 1025.0, body, water, (dt, 9.81));
        let found = period(&mut run, dt, |r| r.state.position(0).z - place.z);
        assert!((found / heave - 1.0).abs() < 0.01, "{found} for {heave}");
        for (axis, exact, gm) in [(Vec3::x_axis(), roll, gm_roll), (Vec3::y_axis(), pitch, gm_pitch)] {
            assert!(gm > 0.0);
            let tilt = 0.01 * draft / l.max(w);
            let body = BodyInput {
                position: place,
                orientation: nalgebra::UnitQuaternion::from_axis_angle(&axis, tilt),
                ..BodyInput::default()
            };
            let mut run = one(block([l, w, h]), ratio * 1025.0, body, still(1025.0), (dt, 9.81));
            let found = period(&mut run, dt, |r| r.state.orientation(&r.model, 0).imag().dot(&axis));
            assert!((found / exact - 1.0).abs() < 0.01, "{axis:?}: {found} for {exact}");
        }
    }
}

/// Stable tilts: Gilbert 1991; Erdős, Schibler & Herndon 1992; within half a degree.
#[test]
fn boxes_float_at_their_stable_tilts() {
    let text = include_str!("../data/water/box_stability.csv");
    for line in text.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let [w, h, ratio, _] = [0, 1, 2, 3].map(|k| words[k].parse::<f64>().unwrap());
        let stable: Vec<f64> = words[4].split(' ').map(|x| x.parse().unwrap()).collect();
        let water = Water { drag: 2.0, drag_moment: 0.6, skin_drag: 0.1, ..still(1000.0) };
        let body = BodyInput {
            position: Vec3::new(0.0, 0.0, h * (0.5 - ratio)),
            orientation: nalgebra::UnitQuaternion::from_axis_angle(&Vec3::y_axis(), 10_f64.to_radians()),
            fixed: [false, true, false, true, false, true],
            ..BodyInput::default()
        };
        let mut run = one(block([w, 4.0 * w, h]), ratio * 1000.0, body, water, (5e-3, 9.81));
        run.steps(60_000);
        let axis = run.state.orientation(&run.model, 0) * Vec3::x();
        let tilt = axis.z.abs().asin().to_degrees();
        let off = stable.iter().map(|s| (s - tilt).abs()).fold(f64::INFINITY, f64::min);
        assert!(off < 0.5, "{line}: settles at {tilt}");
    }
}

/// 0.44587 m for the source's floe, 0.44634 without rounding.
#[test]
fn rounded_floes_have_expected_draught() {
    let prisms = read("tests/data/water/draft_corners.csv");
    for (sides, core, r, ratio, draft) in [
        (6.0, 0.42, 0.04, 0.892682926829, 0.4458697527),
        (5.0, 0.42, 0.04, 0.892682926829, 0.4458539195),
        (7.0, 0.22, 0.04, 0.9, 0.2693791108),
    ] {
        let corners: Vec<Vec3> =
            prisms.iter().filter(|p| p[0] == sides).map(|p| Vec3::new(p[1], p[2], p[3])).collect();
        let (shape, _, turn) = Dilated::new(&corners, r).unwrap();
        let thickness = core + 2.0 * r;
        let body = BodyInput {
            position: Vec3::new(0.0, 0.0, 0.5 * thickness - ratio * thickness),
            orientation: turn,
            ..BodyInput::default()
        };
        let water = Water { drag: 5.0, ..still(1025.0) };
        let mut run = one(Shape::Polyhedron(Box::new(shape)), ratio * 1025.0, body, water, (2e-3, 9.81));
        // Mean of the heave: drag hardly damps slow motion.
        let mut sum = 0.0;
        for _ in 0..50_000 {
            run.step();
            sum += run.state.position(0).z;
        }
        let found = 0.5 * thickness - sum / 50_000.0;
        println!("draft {found:.7} for {draft}");
        assert!((found - draft).abs() < 1e-4 * thickness, "{found} for {draft}");
    }
}

#[test]
fn small_floes_follow_the_waves() {
    let (height, period) = (0.3, 4.0);
    let wave = Wave::new(height, Measured::Period(period), 0.0, 0.0, 200.0, [0.0; 2], 9.81).unwrap();
    let water = Water { wave: Some(wave), drag: 1.0, added_mass: 0.5, ..still(1025.0) };
    let shape = Shape::Sphere { radius: 0.05 };
    let body = BodyInput { position: Vec3::new(0.0, 0.0, 0.5 * height), ..BodyInput::default() };
    let dt = 2e-3;
    let mut run = one(shape, 0.9 * 1025.0, body, water, (dt, 9.81));
    let whole = (period / dt).round() as usize;
    run.steps(5 * whole);
    let from = run.state.position(0).x;
    let mut highest = f64::NEG_INFINITY;
    for _ in 0..20 * whole {
        run.step();
        highest = highest.max(run.state.position(0).z);
    }
    // Drift lengthens its period.
    let drift = (run.state.position(0).x - from) / (20.0 * period);
    println!("drift {drift:.5} m/s, highest {highest:.4} m");
    assert!((drift / 0.00888941 - 1.0).abs() < 0.2, "{drift}");
    assert!((highest - (0.15 - 0.0304)).abs() < 0.003, "{highest}");
}

#[test]
fn accounts_close_in_water() {
    let water = Water {
        drag: 0.6,
        drag_moment: 0.1,
        skin_drag: 0.005,
        added_mass: 0.4,
        current: [0.3, 0.1],
        wave: Wave::new(0.2, Measured::Period(3.0), 0.4, 0.0, 10.0, [0.3, 0.1], 9.81).ok(),
        ..still(1025.0)
    };
    let body = BodyInput {
        position: Vec3::new(1.0, 2.0, 0.1),
        spin: Vec3::new(0.3, -0.2, 0.4),
        ..BodyInput::default()
    };
    let mut errors = Vec::new();
    for dt in [4e-3, 2e-3] {
        let mut run = one(block([2.0, 1.5, 0.5]), 915.0, body.clone(), water, (dt, 9.81));
        let left = |run: &Run| measure::energies(&run.model, &run.state).total() - run.state.balance.work();
        let (start, momentum) = (left(&run), measure::momentum(&run.model, &run.state));
        run.steps((10.0 / dt) as usize);
        let error = (left(&run) - start).abs();
        let work = run.state.balance.work_body_forces.abs();
        println!("dt {dt}: {error:.2e} J of {work:.2e} J");
        errors.push(error / work);
        let after = measure::momentum(&run.model, &run.state);
        let gap = after.linear - momentum.linear - run.state.balance.impulse().linear;
        assert!(gap.norm() < 1e-9 * after.linear.norm().max(1.0), "{gap}");
    }
    assert!(errors[1] < 1e-3 && work_is_resolved(&errors), "{errors:?}");
}

fn work_is_resolved(errors: &[f64]) -> bool {
    errors[1] < 0.6 * errors[0] || errors[1] < 1e-6
}
