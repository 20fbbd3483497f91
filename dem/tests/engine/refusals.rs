//! Errors for bad input and failing steps.

use crate::scene::{Run, plane, rigid, sphere, stone, weightless};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    AppliedForce, BodyInput, Material, Model, ModelError, ModelInput, PairOverride, Partner, Shape, State,
    StepError, TimeStep, TriangleSurface, Vec3, Work,
};

fn refused(change: impl FnOnce(&mut ModelInput)) -> ModelError {
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    change(&mut input);
    Model::new(input).expect_err("this must be refused")
}

#[test]
fn materials_out_of_range() {
    type Change = fn(&mut Material);
    let cases: [(&str, Change); 6] = [
        ("density", |m| m.density = 0.0),
        ("stiffness", |m| m.stiffness = -1.0),
        ("friction", |m| m.friction = -0.1),
        ("restitution", |m| m.restitution = 0.0),
        ("restitution", |m| m.restitution = 1.1),
        ("tangential_ratio", |m| m.tangential_ratio = f64::NAN),
    ];
    for (name, change) in cases {
        match refused(|i| change(&mut i.materials[0])) {
            ModelError::Material { material: 0, parameter, .. } => assert_eq!(parameter, name),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn indices_that_point_nowhere() {
    let text = refused(|i| i.bodies[0].shape = 3).to_string();
    assert_eq!(text, "body 0 names shape 3, but there are 1");
    assert!(matches!(refused(|i| i.bodies[0].material = 1), ModelError::Index { owner: "body", .. }));
    assert!(matches!(refused(|i| i.planes[0].material = 1), ModelError::Index { owner: "plane", .. }));
    assert!(matches!(refused(|i| i.surface_material = Some(1)), ModelError::Index { owner: "surface", .. }));
    let other = refused(|i| (i.surface_material, i.other_surface) = (Some(0), Some((3, 1))));
    assert!(matches!(other, ModelError::Index { owner: "surface", .. }));
    let pair = PairOverride { a: 0, b: 9, ..PairOverride::default() };
    assert!(matches!(refused(|i| i.contacts.push(pair)), ModelError::Index { .. }));
}

#[test]
fn degenerate_shapes_bodies_and_walls() {
    assert!(matches!(
        refused(|i| i.shapes[0] = Shape::Sphere { radius: 0.0 }),
        ModelError::Shape { shape: 0, .. }
    ));
    assert!(matches!(
        refused(|i| i.shapes.push(Shape::Box { half: [1.0, 0.0, 1.0] })),
        ModelError::Shape { .. }
    ));
    assert!(matches!(refused(|i| i.bodies[0].scale = -1.0), ModelError::Body { quantity: "scale", .. }));
    assert!(matches!(refused(|i| i.bodies[0].mass = Some(0.0)), ModelError::Body { quantity: "mass", .. }));
    assert!(matches!(refused(|i| i.bodies[0].position.x = f64::NAN), ModelError::Body { .. }));
    assert!(matches!(refused(|i| i.planes[0].normal = Vec3::zeros()), ModelError::Wall { .. }));
    let flat = TriangleSurface {
        vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::x() * 2.0],
        triangles: vec![[0, 1, 2]],
        ..TriangleSurface::default()
    };
    assert_eq!(
        refused(|i| i.triangles.push(flat.clone())).to_string(),
        "triangle 0 of surface 0: it has no area"
    );
    let stray = TriangleSurface { triangles: vec![[0, 1, 3]], ..flat };
    assert!(refused(|i| i.triangles.push(stray)).to_string().contains("vertex that does not exist"));
}

#[test]
fn two_rigid_partners() {
    let error = refused(|i| i.materials[0] = rigid(stone()));
    assert_eq!(error, ModelError::RigidPair { a: "body 0".into(), b: "plane 0".into() });
    let mut input = weightless(rigid(stone()));
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(BodyInput { fixed: [true; 6], ..sphere(Vec3::zeros(), Vec3::zeros()) });
    assert!(Model::new(input).is_ok());
}

#[test]
fn time_step_above_the_limit() {
    let error = refused(|i| i.time_step = TimeStep::Fixed(1.0));
    assert!(error.to_string().contains("set by body 0"), "{error}");
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    input.time_step = TimeStep::FixedAboveLimit(1.0);
    assert_eq!(Model::new(input).unwrap().dt(), 1.0);
    assert!(matches!(
        refused(|i| i.time_step = TimeStep::Auto { fraction: 0.0 }),
        ModelError::StepContext { .. }
    ));
}

fn fails(input: ModelInput, steps: usize) -> StepError {
    let model = Model::new(input).unwrap();
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    for _ in 0..steps {
        if let Err(error) = trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]) {
            return error;
        }
    }
    panic!("no step failed");
}

#[test]
fn bodies_inside_each_other_are_named() {
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::x(), Vec3::zeros()));
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.002), Vec3::zeros()));
    match fails(input, 1) {
        StepError::Overlap { body: 1, partner: Partner::Body(2), overlap, time, .. } => {
            assert!((overlap - 0.018).abs() < 1e-12);
            assert_eq!(time, 0.0);
        }
        other => panic!("{other}"),
    }
    // Coincident centres: no division by zero.
    let mut input = weightless(stone());
    input.bodies.extend([sphere(Vec3::zeros(), Vec3::zeros()), sphere(Vec3::zeros(), Vec3::zeros())]);
    assert!(matches!(fails(input, 1), StepError::Overlap { .. }));
}

#[test]
fn impacts_beyond_the_law_are_stopped() {
    let mut input = weightless(stone());
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.02), Vec3::new(0.0, 0.0, -100.0)));
    assert!(matches!(
        fails(input.clone(), 1000),
        StepError::Overlap { body: 0, partner: Partner::Plane(0), .. }
    ));
    input.bodies[0].velocity.z = -1e5;
    assert!(matches!(fails(input, 1000), StepError::Speed { body: 0, .. }));
}

#[test]
fn passing_through_a_triangle_is_stopped() {
    let mut input = weightless(stone());
    input.triangles.push(TriangleSurface {
        vertices: vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)],
        triangles: vec![[0, 1, 2]],
        ..TriangleSurface::default()
    });
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.02), Vec3::new(0.0, 0.0, -100.0)));
    assert!(matches!(fails(input, 1000), StepError::Overlap { partner: Partner::Triangle(0), .. }));
}

#[test]
fn unstable_step_fails_before_nan() {
    let mut input = weightless(stone());
    input.time_step = TimeStep::FixedAboveLimit(2e-3);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.0099), Vec3::zeros()));
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.0297), Vec3::zeros()));
    let error = fails(input, 100_000);
    assert!(error.to_string().contains("body"), "{error}");
}

#[test]
fn applied_forces_on_nothing() {
    let mut input = weightless(stone());
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    let mut run = Run::new(input);
    for (body, force) in [(1, Vec3::x()), (0, Vec3::new(f64::NAN, 0.0, 0.0))] {
        let bad = AppliedForce { body, force, point: Vec3::zeros() };
        let result = trackbed_dem::step(&run.model, &mut run.state, &mut run.work, &NoSurface, &[bad]);
        assert!(matches!(result, Err(StepError::Applied { index: 0, .. })));
    }
}

#[test]
fn empty_scene_steps() {
    let mut run = Run::new(ModelInput::default());
    run.steps(10);
    assert_eq!(run.state.steps, 10);
}
