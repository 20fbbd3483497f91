use super::*;
use crate::base::error::Partner;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::engine::input::TimeStep;
use crate::engine::work::Work;
use crate::law::material::Material;
use crate::measure;
use crate::pairs::cross::Cross;
use crate::shape::Shape;
use crate::shape::clump::Clump;
use crate::shape::plane::Plane;
use crate::spatial::surface::NoSurface;

#[test]
fn wraps_into_the_box() {
    let p = Periodic { low: Vec3::new(-1.0, 0.0, 5.0), length: Vec3::new(2.0, 3.0, 0.0) };
    assert_eq!(p.wrap(&Vec3::new(1.5, -0.5, 99.0)), Vec3::new(-0.5, 2.5, 99.0));
    assert_eq!(p.wrap(&Vec3::new(1.0, 3.0, -9.0)), Vec3::new(-1.0, 0.0, -9.0));
    assert_eq!(p.wrap(&Vec3::new(-9.5, -1e-30, 0.0)), Vec3::new(0.5, 0.0, 0.0));
    assert_eq!(p.turns(&Vec3::new(-9.5, 7.0, 0.0)), [-5, 2, 0]);
}

fn drifting() -> ModelInput {
    let material = Material {
        density: 2600.0,
        stiffness: 1e5,
        tangential_ratio: 0.5,
        friction: 0.5,
        restitution: 0.5,
        rolling_friction: 0.1,
        twisting_friction: 0.1,
        ..Material::RIGID
    };
    const L: f64 = 0.3;
    let mut input = ModelInput {
        materials: vec![material],
        time_step: TimeStep::Auto { fraction: 0.5 },
        gravity: Vec3::new(1.0, 0.5, -9.81),
        shapes: vec![
            Shape::Clump(Clump::from_spheres(&[([0.0; 3], 0.01), ([0.01, 0.0, 0.0], 0.009)]).unwrap()),
            Shape::Sphere { radius: 0.011 },
        ],
        periodic: [Some([0.0, L]), Some([-0.5 * L, 0.5 * L]), None],
        ..ModelInput::default()
    };
    input.planes.push(Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
        material: 0,
        velocity: Vec3::new(0.3, 0.2, 0.0),
    });
    for k in 0..1500_usize {
        let cell =
            Vec3::new((k % 11) as f64 + 0.5, (k / 11 % 11) as f64 - 5.0, (k / 121) as f64 * 0.85 + 0.6);
        let push = Vec3::new((k as f64 * 1.7).sin() + 1.0, (k as f64 * 2.9).cos() + 0.6, -1.0);
        let (position, velocity) = (cell * (L / 11.0), push * 0.5);
        input.bodies.push(BodyInput { shape: k % 2, position, velocity, ..BodyInput::default() });
    }
    input
}

#[test]
fn wrapping_keeps_contact_forces() {
    let model = Model::new(drifting()).unwrap();
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    assert!(state.blocks.len() > 1);
    for _ in 0..8000 {
        crate::step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
    }
    let forces = |state: &State| {
        let (mut across, mut swapped) = (0, 0);
        let mut list: Vec<_> = measure::contacts(&model, state)
            .iter()
            .filter_map(|c| match c.b {
                Partner::Body(b) => {
                    across += usize::from(c.shift != Vec3::zeros());
                    swapped += usize::from(b < c.a);
                    let sign = if b < c.a { -1.0 } else { 1.0 };
                    Some(((c.a.min(b), c.a.max(b)), c.force * sign))
                }
                _ => None,
            })
            .collect();
        list.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.norm().total_cmp(&y.1.norm())));
        (list, across, swapped)
    };
    let springs = |state: &State| -> f64 {
        let near = |g: &crate::pairs::groups::Groups<2>| g.iter().map(|p| p.1.spring.norm()).sum::<f64>();
        let far = |g: &crate::pairs::groups::Groups<3>| g.iter().map(|p| p.1.spring.norm()).sum::<f64>();
        let images = |c: &Cross| c.images.iter().map(|p| p.history.spring.norm()).sum::<f64>();
        state.lists.iter().map(|l| near(&l.pairs)).sum::<f64>()
            + state.cross.iter().map(|c| far(&c.spheres) + images(c)).sum::<f64>()
    };
    let (before, across_before, swapped_before) = forces(&state);
    let length = springs(&state);
    state.reorder(&model);
    let (after, across_after, swapped_after) = forces(&state);
    println!("{} contacts, across {across_before} then {across_after}", before.len());
    assert!(before.len() > 300 && across_before > 20 && across_after > 20);
    assert!(across_before != across_after && swapped_before != swapped_after);
    assert!(length > 1e-4 && (springs(&state) / length - 1.0).abs() < 1e-12);
    assert_eq!(before.len(), after.len());
    for (x, y) in before.iter().zip(&after) {
        assert_eq!(x.0, y.0);
        assert!((x.1 - y.1).norm() < 1e-9 * (1.0 + x.1.norm()), "{x:?} {y:?}");
    }
    for body in 0..model.body_count() {
        let x = state.position(body);
        assert!((model.wrap(&x) - x).norm() < 1e-15, "{x:?}");
    }
}
