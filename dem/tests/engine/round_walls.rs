//! Round walls and rotating planes against closed forms.

use crate::scene::{Run, sphere, stone, weightless};
use trackbed_dem::{BodyInput, Material, ModelInput, Motion, Partner, Vec3, WallInput, WallShape, measure};

fn frustum(height: f64, radii: [f64; 2], caps: [bool; 2]) -> WallShape {
    WallShape::Frustum { base: Vec3::zeros(), axis: Vec3::z(), height, radii, caps }
}

fn heavy(material: Material) -> ModelInput {
    ModelInput { gravity: Vec3::new(0.0, 0.0, -9.81), ..weightless(material) }
}

/// Half angle α: normal forces sum to W/sin α; centre (r − d)/sin α above the apex, d = W/(2 K sin α).
#[test]
fn ball_in_a_cone() {
    for degrees in [20.0_f64, 45.0, 70.0] {
        let alpha = degrees.to_radians();
        let mut input = heavy(Material { friction: 0.0, restitution: 0.1, ..stone() });
        input.walls.push(WallInput::fixed(frustum(0.08, [0.0, 0.08 * alpha.tan()], [false; 2]), 0));
        let start = 0.01 / alpha.sin();
        input.bodies.push(sphere(Vec3::new(2e-4, 1e-4, start + 1e-4), Vec3::zeros()));
        let mut run = Run::new(input);
        while run.state.time < 1.0 {
            run.step();
        }
        let weight = run.model.mass(0) * 9.81;
        let contacts = measure::contacts(&run.model, &run.state);
        assert_eq!(contacts.len(), 2);
        assert!(contacts.iter().all(|c| c.b == Partner::Wall(0)));
        let normal: f64 = contacts.iter().map(|c| c.normal_force).sum();
        assert!((normal * alpha.sin() / weight - 1.0).abs() < 1e-6, "{degrees}: {normal}");
        for c in &contacts {
            assert!((c.normal_force * 2.0 * alpha.sin() / weight - 1.0).abs() < 1e-4, "{degrees}: {c:?}");
            assert!((c.normal.z - alpha.sin()).abs() < 1e-6);
        }
        let (force, moment) = run.state.wall_force(0);
        assert!((force + Vec3::z() * weight).norm() < 1e-6 * weight && moment.norm() < 1e-6 * weight * 0.01);
        let d = weight / (2.0 * 1e5 * alpha.sin());
        let x = run.state.position(0);
        assert!((x.z - (0.01 - d) / alpha.sin()).abs() < 1e-3 * d, "{degrees}: {}", x.z);
        assert!(x.xy().norm() < 1e-7, "{degrees}: {x}");
    }
}

/// T = 2π √(7 (R − r)/(5 g)).
#[test]
fn rolling_inside_a_cylinder() {
    let mut input = heavy(Material { friction: 0.9, restitution: 1.0, ..stone() });
    let shape = WallShape::Frustum {
        base: -Vec3::y(),
        axis: Vec3::y(),
        height: 2.0,
        radii: [0.1; 2],
        caps: [false; 2],
    };
    input.walls.push(WallInput::fixed(shape, 0));
    let (angle, reach) = (0.05_f64, 0.09);
    let weight = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 9.81;
    let deep = reach + weight / 1e5;
    input.bodies.push(sphere(Vec3::new(angle.sin(), 0.0, -angle.cos()) * deep, Vec3::zeros()));
    let mut run = Run::new(input);
    let mut crossings = Vec::new();
    let mut before = run.state.position(0).x;
    while crossings.len() < 7 {
        let t = run.state.time;
        run.step();
        let x = run.state.position(0).x;
        if x * before < 0.0 {
            crossings.push(t + run.model.dt() * before / (before - x));
        }
        before = x;
    }
    let period = (crossings[6] - crossings[0]) / 3.0;
    let exact = std::f64::consts::TAU * (7.0 * reach / (5.0 * 9.81)).sqrt();
    eprintln!("period {period} against {exact}: {:+.3} %", 100.0 * (period / exact - 1.0));
    assert!((period / exact - 1.0).abs() < 2e-3, "{period} {exact}");
    assert!(run.state.position(0).y.abs() < 1e-12);
    assert_eq!(run.state.wall_contact_count(), 1);
}

/// At the Coulomb limit: moment μN R about the axis, work μN Rω t dissipated.
#[test]
fn turning_walls_drag_at_the_limit() {
    let omega = 3.0;
    let r = 0.01;
    let reach = 0.2;
    let below = Vec3::new(0.0, 0.0, -reach);
    let cases: [(WallShape, Vec3, Vec3); 4] = [
        (WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() }, Vec3::z(), Vec3::new(reach, 0.0, r)),
        (
            WallShape::Frustum {
                base: -Vec3::y(),
                axis: Vec3::y(),
                height: 2.0,
                radii: [reach; 2],
                caps: [false; 2],
            },
            Vec3::y(),
            below + Vec3::z() * r,
        ),
        (frustum(1.0, [0.5; 2], [true, false]), Vec3::z(), Vec3::new(reach, 0.0, r)),
        (WallShape::Sphere { centre: Vec3::zeros(), radius: reach }, Vec3::y(), below + Vec3::z() * r),
    ];
    for (k, (shape, axis, x)) in cases.into_iter().enumerate() {
        let mut input = heavy(Material { restitution: 0.3, ..stone() });
        let motion = Motion { angular_velocity: axis * omega, ..Motion::default() };
        let centre = shape.own_centre();
        input.walls.push(WallInput { motion, ..WallInput::fixed(shape, 0) });
        let fixed = [true, true, false, true, true, true];
        input.bodies.push(BodyInput { fixed, ..sphere(x, Vec3::zeros()) });
        let mut run = Run::new(input);
        let before = measure::momentum(&run.model, &run.state).linear;
        while run.state.time < 0.4 {
            run.step();
        }
        let weight = run.model.mass(0) * 9.81;
        let (force, moment) = run.state.wall_force(0);
        let limit = 0.5 * weight;
        let surface = (axis * omega).cross(&(x - Vec3::z() * r - centre)).normalize();
        assert!(
            (force + Vec3::z() * weight + surface * limit).norm() < 1e-8 * weight,
            "{k}: {force} {surface}"
        );
        assert!((moment.dot(&axis) + limit * reach).abs() < 1e-6 * limit * reach, "{k}: {moment}");
        let balance = &run.state.balance;
        let work = limit * reach * omega * run.state.time;
        assert!((balance.work_walls / work - 1.0).abs() < 1e-3, "{k}: {} {work}", balance.work_walls);
        assert!((balance.dissipated_friction / work - 1.0).abs() < 1e-3, "{k}");
        let change = measure::momentum(&run.model, &run.state).linear - before - balance.impulse().linear;
        assert!(change.norm() < 1e-12);
    }
}

#[test]
fn pieces_that_meet() {
    let at = |x: Vec3| {
        let mut input = weightless(stone());
        input.walls.push(WallInput::fixed(frustum(0.2, [0.1; 2], [true; 2]), 0));
        input.bodies.push(sphere(x, Vec3::zeros()));
        let mut run = Run::new(input);
        run.step();
        (run.state.wall_contact_count(), run.work.contact_force(&run.state, 0))
    };
    let d = 1e-4;
    let (count, force) = at(Vec3::new(0.09 + d, 0.0, 0.01 - d));
    assert_eq!(count, 2);
    assert!((force - Vec3::new(-10.0, 0.0, 10.0)).norm() < 1e-9, "{force}");
    let side = (0.01 - d) / 2.0_f64.sqrt();
    let (count, force) = at(Vec3::new(0.1 + side, 0.0, -side));
    assert_eq!(count, 1);
    assert!((force - Vec3::new(1.0, 0.0, -1.0) * 10.0 / 2.0_f64.sqrt()).norm() < 1e-9, "{force}");
    let (count, force) = at(Vec3::new(0.03, 0.0, 0.19 + d));
    assert_eq!(count, 1);
    assert!((force + Vec3::z() * 10.0).norm() < 1e-9, "{force}");
}
