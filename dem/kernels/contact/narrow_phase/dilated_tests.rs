use super::*;
use crate::base::random::Random;
use crate::shape::Shape;
use crate::shape::cuboid;
use crate::shape::dilated::Dilated;
use crate::tables::{corners, rows};

pub(super) fn placed<'a>(
    shape: &'a Shape,
    core: &'a Core,
    centre: Vec3,
    orientation: UnitQuaternion<f64>,
    scale: f64,
) -> PosedBody<'a> {
    PosedBody { centre, orientation, shape, scale, core, radius: shape.rounding(scale) }
}

pub(super) fn energy(found: &Manifold) -> f64 {
    found.iter().map(|t| 0.5 * t.weight * t.geometry.overlap.powi(2)).sum()
}

pub(super) fn wrench(found: &Manifold, about: &Vec3) -> [Vec3; 2] {
    let mut sums = [Vec3::zeros(); 2];
    for t in found {
        let force = t.geometry.normal * (t.weight * t.geometry.overlap);
        sums[0] += force;
        sums[1] += (t.geometry.point - about).cross(&force) + t.couple * force.norm();
    }
    sums
}

pub(super) fn stones(random: &mut Random, count: usize, radius: f64) -> Shape {
    let points: Vec<Vec3> = (0..count)
        .map(|_| random.orientation() * Vec3::x())
        .map(|p| Vec3::new(0.5 * p.x, 0.4 * p.y, 0.3 * p.z))
        .collect();
    Shape::Polyhedron(Box::new(Dilated::new(&points, radius).unwrap().0))
}

#[test]
fn forces_have_a_potential() {
    let mut random = Random::new(3, 1);
    let box_ = Shape::Box { half: [0.4, 0.3, 0.2] };
    let mut shapes: Vec<Shape> =
        (0..6).map(|k| stones(&mut random, 8 + 3 * k, 0.05 + 0.02 * k as f64)).collect();
    let cube: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::repeat(0.4), k)).collect();
    shapes.push(Shape::Polyhedron(Box::new(Dilated::new(&cube, 0.06).unwrap().0)));
    shapes.push(box_);
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (mut tried, mut worst) = (0, [[0.0_f64; 2]; 2]);
    while tried < 2000 {
        let [i, j] = [0, 1].map(|_| (random.uniform() * shapes.len() as f64) as usize);
        if i + 1 == shapes.len() && j + 1 == shapes.len() {
            continue;
        }
        let flat = tried % 4 == 0;
        let turn = |random: &mut Random| if flat { UnitQuaternion::identity() } else { random.orientation() };
        let (qa, qb) = (turn(&mut random), turn(&mut random));
        let way = (random.orientation() * Vec3::z()) * (0.2 + 1.2 * random.uniform());
        let b = placed(&shapes[j], &cores[j], Vec3::new(3.0, -2.0, 1.0), qb, 0.8);
        let at = |shift: Vec3, spin: Vec3| {
            placed(
                &shapes[i],
                &cores[i],
                b.centre + way + shift,
                UnitQuaternion::from_scaled_axis(spin) * qa,
                1.1,
            )
        };
        let contact_points = |shift: Vec3, spin: Vec3| {
            let mut found = Manifold::new();
            DilatedDilated.contact_points(&at(shift, spin), &b, &mut found);
            found
        };
        let found = contact_points(Vec3::zeros(), Vec3::zeros());
        let deepest = found.iter().map(|t| t.geometry.overlap / t.bound).fold(0.0, f64::max);
        if found.is_empty() || deepest > 0.3 {
            continue;
        }
        tried += 1;
        let worst = &mut worst[usize::from(deepest > 0.05)];
        let [force, torque] = wrench(&found, &(b.centre + way));
        let h = 1e-7;
        let slope = |f: &dyn Fn(f64) -> Manifold| (energy(&f(h)) - energy(&f(-h))) / (2.0 * h);
        for d in 0..3 {
            let e = Vec3::ith(d, 1.0);
            let by_shift = slope(&|x| contact_points(e * x, Vec3::zeros()));
            let by_spin = slope(&|x| contact_points(Vec3::zeros(), e * x));
            let unit = force.norm() + 1e-4;
            worst[0] = worst[0].max((force[d] + by_shift).abs() / unit);
            worst[1] = worst[1].max((torque[d] + by_spin).abs() / unit);
        }
    }
    println!(
        "force and torque against differences of the energy, {tried} pairs, shallow and deep: {worst:?}"
    );
    assert!(worst.iter().flatten().all(|w| *w < 2e-6), "{worst:?}");
}

#[test]
fn pairs_match_from_both_sides() {
    let mut random = Random::new(4, 1);
    let shapes: Vec<Shape> = (0..2).map(|k| stones(&mut random, 12, 0.05 + 0.05 * k as f64)).collect();
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let mut tried = 0;
    while tried < 500 {
        let a = placed(&shapes[0], &cores[0], Vec3::zeros(), random.orientation(), 1.0);
        let way = random.orientation() * Vec3::z() * (0.5 + 0.6 * random.uniform());
        let b = placed(&shapes[1], &cores[1], way, random.orientation(), 0.7);
        let (mut one, mut two) = (Manifold::new(), Manifold::new());
        DilatedDilated.contact_points(&a, &b, &mut one);
        DilatedDilated.contact_points(&b, &a, &mut two);
        assert_eq!(one.len(), two.len());
        if one.is_empty() || one[0].feature == 0 {
            continue;
        }
        tried += 1;
        for s in &one {
            let t = two.iter().find(|t| t.feature == s.feature.rotate_left(16)).expect("the same features");
            assert!((s.geometry.point - t.geometry.point).norm() < 1e-13);
            assert!((s.geometry.normal + t.geometry.normal).norm() < 1e-12);
            assert!((s.weight - t.weight).abs() <= 1e-12 * s.weight + 1e-14, "{} {}", s.weight, t.weight);
        }
    }
}

/// 350 pairs against a table confirmed by two other methods to 3e-13.
#[test]
fn overlaps_are_those_of_the_table() {
    let shapes = rows(include_str!("../../../tests/data/shapes/pairs_corners.csv"));
    let table = include_str!("../../../tests/data/shapes/pairs.csv");
    let (mut compared, mut crossing) = (0, 0);
    for line in table.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |k: usize| -> f64 { words[k].parse().unwrap() };
        let kind = words[1];
        if kind == "deep" {
            continue;
        }
        let body = |first: usize| {
            let points = corners(&shapes, words[first]);
            let radius = number(first + 8);
            let (own, centre, turn) = Dilated::new(&points, radius).unwrap();
            let q = nalgebra::Quaternion::new(
                number(first + 1),
                number(first + 2),
                number(first + 3),
                number(first + 4),
            );
            let q = UnitQuaternion::from_quaternion(q);
            let p = Vec3::new(number(first + 5), number(first + 6), number(first + 7));
            (Shape::Polyhedron(Box::new(own)), p + q * centre, q * turn)
        };
        let [a, b] = [body(2), body(11)];
        let cores = [a.0.core(), b.0.core()];
        let (a, b) = (placed(&a.0, &cores[0], a.1, a.2, 1.0), placed(&b.0, &cores[1], b.1, b.2, 1.0));
        let (gap, normal) = (number(21), Vec3::new(number(23), number(24), number(25)));
        let mut found = Manifold::new();
        DilatedDilated.contact_points(&a, &b, &mut found);
        if gap >= 0.0 {
            assert!(found.is_empty(), "{line}");
            continue;
        }
        let bound = 0.9 * (a.radius + b.radius);
        if -gap >= bound {
            assert!(found.iter().any(|t| t.geometry.overlap >= t.bound - 1e-9), "{line}");
            continue;
        }
        let deepest =
            found.iter().max_by(|s, t| s.geometry.overlap.total_cmp(&t.geometry.overlap)).expect(line);
        if !["VV", "VE", "VF"].contains(&kind) {
            let share = deepest.geometry.overlap / -gap;
            assert!((0.3..1.05).contains(&share), "{share}: {line}");
            crossing += 1;
            continue;
        }
        compared += 1;
        assert!((deepest.geometry.overlap + gap).abs() < 1e-9, "{line}: {deepest:?}");
        assert!((deepest.geometry.normal + normal).norm() < 1e-7, "{line}: {deepest:?}");
    }
    assert!(compared > 80 && crossing > 100, "{compared} {crossing}");
}

#[test]
fn a_cube_on_a_plane() {
    let cube: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::repeat(0.4), k)).collect();
    let shape = Shape::Polyhedron(Box::new(Dilated::new(&cube, 0.1).unwrap().0));
    let core = shape.core();
    let plane = PlaneView {
        origin: Vec3::zeros(),
        normal: Vec3::z(),
        velocity: Vec3::zeros(),
        material: 0,
        open: false,
    };
    let contact_points = |height: f64, turn: UnitQuaternion<f64>| {
        let mut found = Manifold::new();
        DilatedPlane.contact_points(
            &placed(&shape, &core, Vec3::z() * height, turn, 1.0),
            &plane,
            &mut found,
        );
        found
    };
    let mut flat = contact_points(0.499, UnitQuaternion::identity());
    // Ends of upright edges press slightly.
    assert_eq!(flat.len(), 12);
    assert!(flat.iter().filter(|t| t.weight < 0.004).count() == 4, "{flat:?}");
    flat.retain(|t| t.weight > 0.5);
    let weight: f64 = flat.iter().map(|t| t.weight).sum();
    assert!((weight - (4.0 + 4.0 * 0.8 / (LENGTH * 0.1))).abs() < 1e-9, "{weight}");
    assert!(
        flat.iter()
            .all(|t| (t.geometry.overlap - 1e-3).abs() < 1e-12 && (t.geometry.point.z + 5e-4).abs() < 1e-12)
    );
    let turn = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), std::f64::consts::FRAC_PI_4);
    let edge = contact_points(0.4 * 2.0_f64.sqrt() + 0.099, turn);
    let large = edge.iter().filter(|t| t.weight > 0.5).count();
    assert_eq!(large, 3, "{edge:?}");
    assert!(contact_points(0.501, UnitQuaternion::identity()).is_empty());
}

type Pose = (Vec3, UnitQuaternion<f64>);

type Sweep<'a> = &'a dyn Fn(f64) -> [Pose; 2];

/// Sweeps in 1,000 steps; half steps halve the largest force change. Within a degree of parallel, edges
/// stiffen steeply.
#[test]
fn forces_are_continuous() {
    let half = Vec3::new(0.4, 0.3, 0.2);
    let points: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&half, k)).collect();
    let (block, _, turn) = Dilated::new(&points, 0.05).unwrap();
    let given = |q: UnitQuaternion<f64>| q * turn;
    let shape = Shape::Polyhedron(Box::new(block));
    let core = shape.core();
    let about = |axis: Vec3, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
    let eighth = std::f64::consts::FRAC_PI_4;
    let edge = about(Vec3::x(), eighth);
    let tip = (0.3 + 0.2) * eighth.sin() + 0.05;
    let on_corner = UnitQuaternion::rotation_between(&half, &Vec3::z()).unwrap();
    let corner = half.norm() + 0.05;
    let sweeps: [(&str, Sweep<'_>); 4] = [
        ("crossed to parallel", &|x| {
            let above = about(Vec3::z(), 2.0 * eighth * (1.0 - x)) * edge;
            [(Vec3::z() * (2.0 * tip - 1e-3), above), (Vec3::zeros(), edge)]
        }),
        ("edge to face", &|x| {
            // Lowest corner 1 mm below the face.
            let tilt = eighth * (1.0 - x);
            let down = 0.3 * tilt.sin() + 0.2 * tilt.cos() + 0.05;
            [
                (Vec3::z() * (0.25 + down - 1e-3), about(Vec3::x(), tilt)),
                (Vec3::zeros(), about(Vec3::x(), 0.0)),
            ]
        }),
        ("face off an edge", &|x| {
            let aside = Vec3::new(0.1, 0.9 * x, 0.5 - 1e-3);
            [(aside, about(Vec3::z(), 0.0)), (Vec3::zeros(), about(Vec3::x(), 0.0))]
        }),
        ("corner over corner", &|x| {
            let aside = Vec3::new(0.04 * (x - 0.5), 0.01, 2.0 * corner - 4e-3);
            [(aside, on_corner), (Vec3::zeros(), on_corner)]
        }),
    ];
    for (name, sweep) in sweeps {
        let force = |x: f64| {
            let [a, b] = sweep(x).map(|(at, q)| placed(&shape, &core, at, given(q), 1.0));
            let mut found = Manifold::new();
            DilatedDilated.contact_points(&a, &b, &mut found);
            wrench(&found, &b.centre)
        };
        let largest = |steps: i32| {
            let mut sums = [[0.0_f64; 2]; 2];
            let mut last = force(0.0);
            for k in 1..=steps {
                let next = force(f64::from(k) / f64::from(steps));
                for m in 0..2 {
                    sums[m][0] = sums[m][0].max(next[m].norm());
                    sums[m][1] = sums[m][1].max((next[m] - last[m]).norm());
                }
                last = next;
            }
            sums.map(|[peak, jump]| jump / peak)
        };
        let [coarse, fine] = [largest(1000), largest(2000)];
        println!("{name}: largest step of force, torque over the peak {coarse:?}, {fine:?}");
        for m in 0..2 {
            assert!(coarse[m] < 0.5 && fine[m] < 0.6 * coarse[m] + 1e-9, "{name}: {coarse:?} {fine:?}");
        }
    }
}

#[test]
fn hints_change_nothing() {
    let mut random = Random::new(11, 1);
    let shapes: Vec<Shape> = (0..4).map(|k| stones(&mut random, 8 + 6 * k, 0.05)).collect();
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (mut hint, mut points, mut none) = (None, 0, 0);
    for pair in 0..60 {
        let [i, j] = [pair % 4, pair / 4 % 4];
        let spin = random.orientation() * Vec3::x();
        let [from, way] = [0, 1].map(|_| random.orientation() * Vec3::x());
        for step in 0..200 {
            let t = 0.01 * f64::from(step) - 1.0;
            let centre = from * 0.75 + way * (0.5 * t);
            let turn = UnitQuaternion::new(spin * t);
            let a = placed(&shapes[i], &cores[i], centre, turn, 1.0);
            let b = placed(&shapes[j], &cores[j], Vec3::zeros(), UnitQuaternion::identity(), 1.1);
            let (mut cold, mut warm) = (Manifold::new(), Manifold::new());
            DilatedDilated.contact_points(&a, &b, &mut cold);
            DilatedDilated.contact_points_from_hint(&a, &b, &mut hint, &mut warm);
            if cold.first().is_some_and(|t| t.geometry.overlap > t.bound) {
                hint = None;
                continue;
            }
            let bits = |found: &Manifold| -> Vec<(u32, [u64; 5])> {
                let of = |t: &PairContactPoint| {
                    let [x, y, z] = t.geometry.normal.into();
                    [t.geometry.overlap, t.weight, x, y, z].map(f64::to_bits)
                };
                found.iter().map(|t| (t.feature, of(t))).collect()
            };
            assert_eq!(bits(&cold), bits(&warm), "pair {pair}, step {step}");
            points += cold.len();
            none += usize::from(cold.is_empty());
        }
    }
    assert!(points > 3000 && none > 3000, "{points} {none}");
}
