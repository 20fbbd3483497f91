use super::*;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::shape::Shape;
use crate::shape::plane::Plane;
use crate::spatial::surface::NoSurface;
use crate::testing::SOFT;
use crate::wall::TriangleSurface;

const RADIUS: f64 = 0.05;

fn model(periodic: bool) -> Model {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let mut input = ModelInput {
        materials: vec![SOFT],
        shapes: vec![Shape::Sphere { radius: 0.25 }, Shape::Box { half: [0.1, 0.15, 0.3] }],
        bodies: vec![
            BodyInput { position: at(0.0, 0.3, 0.5), ..BodyInput::default() },
            BodyInput { position: at(0.6, 0.5, 0.9), ..BodyInput::default() },
        ],
        planes: vec![Plane {
            point: at(0.0, 0.0, 0.1),
            normal: Vec3::z(),
            material: 0,
            velocity: Vec3::zeros(),
        }],
        ..ModelInput::default()
    };
    if periodic {
        input.periodic[0] = Some([0.0, 2.0]);
    } else {
        input.bodies.push(BodyInput { shape: 1, position: at(0.8, 0.2, 0.3), ..BodyInput::default() });
        input.triangles.push(TriangleSurface {
            vertices: vec![at(0.2, 1.0, 0.0), at(0.9, 0.9, 0.1), at(0.6, 0.7, 1.0)],
            triangles: vec![[0, 1, 2]],
            material: 0,
            velocity: Vec3::zeros(),
        });
    }
    Model::new(input).unwrap()
}

#[test]
fn grains_touch_nothing() {
    for periodic in [false, true] {
        let length = if periodic { 2.0 } else { 1.0 };
        let region = BoxRegion { low: Vec3::zeros(), high: Vec3::new(length, 1.0, 1.0) };
        let model = model(periodic);
        let state = State::new(&model);
        let fill = || {
            let (mut room, mut places) = (
                FreeSpace::new(&model, &state, &NoSurface, region, RADIUS, |_| false),
                FreePositions::new(11),
            );
            let mut found = Vec::new();
            while let Some((x, _)) = room.find_position(RADIUS, &mut places) {
                found.push(x);
                assert!(found.len() < 10_000, "places without end");
            }
            found
        };
        let found = fill();
        assert_eq!(found, fill());
        assert!(found.len() > 200, "{}", found.len());
        let mut gaps = [f64::INFINITY; 6];
        let turns = if periodic { vec![-2.0, 0.0, 2.0] } else { vec![0.0] };
        let centre = Vec3::new(0.8, 0.2, 0.3);
        let corner = Vec3::new(0.1, 0.15, 0.3);
        let (a, b, c) = (Vec3::new(0.2, 1.0, 0.0), Vec3::new(0.9, 0.9, 0.1), Vec3::new(0.6, 0.7, 1.0));
        for (k, x) in found.iter().enumerate() {
            let inside = (0..3).map(|d| x[d].min(region.high[d] - x[d])).fold(f64::INFINITY, f64::min);
            gaps[0] = gaps[0].min(inside).min(x.z - 0.1);
            for s in [Vec3::new(0.0, 0.3, 0.5), Vec3::new(0.6, 0.5, 0.9)] {
                for turn in &turns {
                    gaps[1] = gaps[1].min((x - s - Vec3::x() * *turn).norm() - 0.25);
                }
            }
            for y in &found[..k] {
                for turn in &turns {
                    gaps[2] = gaps[2].min(0.5 * (x - y - Vec3::x() * *turn).norm());
                }
            }
            if !periodic {
                let off = (x - centre).abs() - corner;
                gaps[3] = gaps[3].min(off.sup(&Vec3::zeros()).norm());
                for i in 0..=40 {
                    for j in 0..=40 - i {
                        let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
                        gaps[4] = gaps[4].min((x - (a + (b - a) * u + (c - a) * v)).norm());
                    }
                }
            }
        }
        for (k, gap) in gaps.iter().enumerate().take(if periodic { 3 } else { 5 }) {
            assert!((RADIUS..1.4 * RADIUS).contains(gap), "{periodic} {k}: {gap}");
        }
    }
}

#[test]
fn room_for_one() {
    let model = model(false);
    let state = State::new(&model);
    let low = Vec3::new(0.5, 0.4, 0.8);
    let region = BoxRegion { low, high: low.add_scalar(0.2) };
    let mut places = FreePositions::new(1);
    let mut room = FreeSpace::new(&model, &state, &NoSurface, region, 0.06, |_| false);
    assert_eq!(room.find_position(0.06, &mut places), None);
    let mut room = FreeSpace::new(&model, &state, &NoSurface, region, 0.06, |b| b == 1);
    assert_eq!(room.find_position(0.11, &mut places), None);
    let first = room.find_position(0.06, &mut places).unwrap();
    let mut room = FreeSpace::new(&model, &state, &NoSurface, region, 0.06, |b| b == 1);
    let second = room.find_position(0.06, &mut places).unwrap();
    assert!(first.0 != second.0 && first.1 != second.1);
}
