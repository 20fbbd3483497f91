use super::*;
use crate::shape::cuboid;
use crate::shape::dilated::Core;
use crate::shape::dilated::part::{Bounds, Part, View};

fn view() -> View {
    View::everywhere(Vec3::z(), 1.0)
}

fn segment([from, to]: [Vec3; 2]) -> Segment {
    let (way, around) = (to - from, Bounds::near([&from, &to], &view()));
    Segment { from, direction: way.normalize(), range: [0.0, way.norm()], around }
}

fn cube() -> Core {
    Core::new(&(0..8).map(|k| cuboid::corner(&Vec3::repeat(0.5), k)).collect::<Vec<_>>()).unwrap()
}

#[test]
fn distances_from_a_cube() {
    let cube = cube();
    let mut part = Part::none(&cube, view());
    let part = part.all();
    let (d, n) = part.distance(&Vec3::new(0.2, 0.1, 0.6), 1.0).unwrap();
    assert!((d - 0.1).abs() < 1e-15 && n == Vec3::z());
    let (d, n) = part.distance(&Vec3::new(0.8, 0.1, 0.9), 1.0).unwrap();
    assert!((d - 0.5).abs() < 1e-15 && (n - Vec3::new(0.6, 0.0, 0.8)).norm() < 1e-15);
    let (d, _) = part.distance(&Vec3::repeat(0.6), 1.0).unwrap();
    assert!((d - 0.1 * 3.0_f64.sqrt()).abs() < 1e-15);
    assert!(part.distance(&Vec3::new(0.2, 0.1, 0.6), 0.09).is_none());
}

#[test]
fn edge_contact_matches_point_sum() {
    let cube = cube();
    let mut part = Part::none(&cube, view());
    let part = part.all();
    let reach = 0.2;
    let cases = [
        (Vec3::new(-0.3, 0.1, 0.69), Vec3::new(0.3, 0.2, 0.66)),
        (Vec3::new(-0.9, 0.1, 0.69), Vec3::new(0.8, -0.2, 0.66)),
        (Vec3::new(-0.9, 0.1, 0.65), Vec3::new(0.2, 0.9, 0.68)),
        (Vec3::new(0.62, 0.62, -0.7), Vec3::new(0.63, 0.62, 0.8)),
        (Vec3::new(0.5, 0.0, 0.68), Vec3::new(0.5, 0.9, 0.67)),
        (Vec3::new(1.5, -0.1, 0.64), Vec3::new(-0.4, -0.7, 0.67)),
    ];
    for (from, to) in cases {
        let length = (to - from).norm();
        let found = edge(part, &segment([from, to]), reach).unwrap();
        let (mut force, mut torque, mut squares) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        let n = 200_000;
        for k in 0..n {
            let p = from + (to - from) * ((f64::from(k) + 0.5) / f64::from(n));
            let Some((d, normal)) = part.distance(&p, reach) else { continue };
            let overlap = (reach - d) * length / f64::from(n);
            force += normal * overlap;
            torque += p.cross(&(normal * overlap));
            squares += overlap * (reach - d);
        }
        assert!((found.force - force).norm() < 3e-6 * force.norm(), "{from}: {} {force}", found.force);
        let by_one = found.point.cross(&found.force) + found.couple * found.force.norm();
        assert!((by_one - torque).norm() < 3e-6 * force.norm(), "{from}: {by_one} {torque}");
        assert!((found.overlap * force.norm() - squares).abs() < 3e-6 * squares, "{from}");
    }
    let away = [Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 1.0, 0.0)];
    assert!(edge(part, &segment(away), reach).is_none());
}

#[test]
fn an_edge_over_a_plane() {
    let ground = HalfSpace { point: Vec3::zeros(), normal: Vec3::z() };
    let ends = [Vec3::new(0.0, 0.0, 0.1), Vec3::new(2.0, 0.0, 0.1)];
    let found = edge(&ground, &segment(ends), 0.3).unwrap();
    assert!((found.force - Vec3::z() * 0.4).norm() < 1e-15 && (found.overlap - 0.2).abs() < 1e-15);
    assert!((found.point - Vec3::new(1.0, 0.0, 0.1)).norm() < 1e-15);
    let sloping = [Vec3::zeros(), Vec3::new(1.2, 0.0, 1.6)];
    let found = edge(&ground, &segment(sloping), 0.4).unwrap();
    // ∫₀^½ (0.4 − 0.8 s) ds
    assert!((found.force.z - 0.1).abs() < 1e-15);
}
