//! Contacts of dilated disks.

use super::pairs_tests::{distance, integral, solid};
use super::tests::{energy, placed, stones, wrench};
use super::*;
use crate::base::random::Random;
use crate::shape::Shape;
use crate::shape::dilated::Dilated;
use crate::tables::{corners, rows};
use std::f64::consts::TAU;

fn disk(radius: f64, rounding: f64) -> Shape {
    Shape::Polyhedron(Box::new(Dilated::disk(radius, rounding).unwrap()))
}

fn floor() -> PlaneView {
    PlaneView { origin: Vec3::zeros(), normal: Vec3::z(), velocity: Vec3::zeros(), material: 0, open: false }
}

fn rim_point(body: &PosedBody<'_>, t: f64) -> Vec3 {
    let radius = body.core.rim.unwrap() * body.scale;
    body.centre + body.orientation * Vec3::new(radius * t.cos(), radius * t.sin(), 0.0)
}

fn from_disk(body: &PosedBody<'_>, p: &Vec3) -> Vec3 {
    let local = body.orientation.inverse() * (p - body.centre) / body.scale;
    let radius = body.core.rim.unwrap();
    let rho = local.x.hypot(local.y);
    let out = if rho > radius { 1.0 - radius / rho } else { 0.0 };
    body.orientation * Vec3::new(local.x * out, local.y * out, local.z) * body.scale
}

fn shortest([low, high]: [f64; 2], at: &dyn Fn(f64) -> Vec3) -> Vec3 {
    let count = 720;
    let step = (high - low) / f64::from(count);
    let mut best = at(low);
    for k in 0..count {
        let mut s = low + step * (f64::from(k) + 0.5);
        let mut way = at(s);
        if way.norm() > best.norm() + 0.1 {
            continue;
        }
        let mut h = step;
        while h > 1e-9 {
            let next = [s - h, s + h].map(|t| t.clamp(low, high));
            match next.into_iter().find(|t| at(*t).norm() < way.norm()) {
                Some(t) => (s, way) = (t, at(t)),
                None => h *= 0.5,
            }
        }
        if way.norm() < best.norm() {
            best = way;
        }
    }
    best
}

fn along(length: f64, pieces: u32, reach: f64, at: &dyn Fn(f64) -> (f64, [usize; 2])) -> f64 {
    // Unloaded parts have a separate name, to locate ends.
    let spring = |s: f64| match at(s) {
        (d, nearest) if d < reach => (0.5 * (reach - d).powi(2), nearest),
        _ => (0.0, [usize::MAX; 2]),
    };
    let piece = |k: u32| [k, k + 1].map(|k| f64::from(k) / f64::from(pieces));
    let close = 1e-14 * reach * reach;
    (0..pieces).map(|k| integral(&spring, piece(k), close)).sum::<f64>() * length / (LENGTH * reach)
}

fn off_disk(body: &PosedBody<'_>, p: &Vec3) -> (f64, [usize; 2]) {
    let way = from_disk(body, p);
    let axis = body.orientation * Vec3::z();
    (way.norm(), [usize::from((way - axis * axis.dot(&way)).norm() > 1e-12); 2])
}

fn pressing(body: &PosedBody<'_>, reach: f64, at: &dyn Fn(&Vec3) -> (f64, [usize; 2])) -> f64 {
    let around = TAU * body.core.rim.unwrap() * body.scale;
    along(around, 256, reach, &|s| at(&rim_point(body, TAU * s)))
}

/// Table confirmed by a conic programme to 2e-11.
#[test]
fn disks_of_the_table() {
    let shapes = rows(include_str!("../../../tests/data/shapes/pairs_corners.csv"));
    let table = include_str!("../../../tests/data/shapes/disk_pairs.csv");
    let mut compared = [0; 3];
    for line in table.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |k: usize| -> f64 { words[k].parse().unwrap() };
        let parameters: Vec<&str> = words[2].split(' ').collect();
        let given = |k: usize| -> f64 { parameters[k].parse().unwrap() };
        let turn =
            |q: [f64; 4]| UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
        let shape = disk(number(4), number(5));
        let core = shape.core();
        let at = Vec3::new(number(10), number(11), number(12));
        let body = placed(&shape, &core, at, turn([6, 7, 8, 9].map(number)), 1.0);
        let (distance, gap) = (number(13), number(14));
        let normal = Vec3::new(number(16), number(17), number(18));
        let mut found = Manifold::new();
        let way = match words[1] {
            "plane" => {
                let plane = floor();
                DilatedPlane.contact_points(&body, &plane, &mut found);
                Vec3::z() * shortest([0.0, TAU], &|t| Vec3::z() * rim_point(&body, t).z).z
            }
            "disk" => {
                let other = disk(given(0), number(3));
                let own = other.core();
                let other = placed(&other, &own, Vec3::zeros(), turn([1, 2, 3, 4].map(given)), 1.0);
                DilatedDilated.contact_points(&body, &other, &mut found);
                let one = shortest([0.0, TAU], &|t| from_disk(&other, &rim_point(&body, t)));
                let two = -shortest([0.0, TAU], &|t| from_disk(&body, &rim_point(&other, t)));
                if one.norm() < two.norm() { one } else { two }
            }
            "polyhedron" => {
                let (stone, centre, q) =
                    Dilated::new(&corners(&shapes, parameters[0]), number(3)).expect(line);
                let stone = Shape::Polyhedron(Box::new(stone));
                let own = stone.core();
                let given = turn([1, 2, 3, 4].map(given));
                let other = placed(&stone, &own, given * centre, given * q, 1.0);
                DilatedDilated.contact_points(&body, &other, &mut found);
                let mut part = Part::none(&own, View::everywhere(Vec3::z(), 10.0));
                let part = part.all();
                let to = |p: Vec3| {
                    let local = other.orientation.inverse() * (p - other.centre);
                    let (d, n) = part.distance(&local, 10.0).unwrap();
                    other.orientation * n * d
                };
                let mut best = shortest([0.0, TAU], &|t| to(rim_point(&body, t)));
                for edge in &own.edges {
                    let [p, q] =
                        edge.ends.map(|e| other.centre + other.orientation * own.corners[e as usize]);
                    let way = -shortest([0.0, 1.0], &|s| from_disk(&body, &(p + (q - p) * s)));
                    best = if way.norm() < best.norm() { way } else { best };
                }
                best
            }
            // Walls: `patch_tests.rs`.
            _ => continue,
        };
        compared[["plane", "disk", "polyhedron"].iter().position(|p| *p == words[1]).unwrap()] += 1;
        assert!((way.norm() - distance).abs() < 1e-8, "{} for {line}", way.norm());
        assert!((way / way.norm() + normal).norm() < 1e-6, "{way} for {line}");
        if gap >= 0.0 {
            assert!(found.is_empty(), "{line}");
            continue;
        }
        let deepest = found.iter().map(|t| t.geometry.overlap).fold(0.0, f64::max);
        assert!(deepest < -gap + 1e-8 && deepest > -0.3 * gap, "{deepest} for {line}");
        let force = wrench(&found, &body.centre)[0];
        // Distributed pressure rotates the force.
        assert!(force.normalize().dot(&normal) < -0.9, "{force} for {line}");
    }
    assert_eq!(compared, [25; 3]);
}

fn with_stone(body: &PosedBody<'_>, other: &PosedBody<'_>, reach: f64) -> f64 {
    let (own, stone) = (other.core, solid(other));
    let mut exact = pressing(body, reach, &|p| distance(&stone, p));
    for edge in &own.edges {
        let [p, q] =
            edge.ends.map(|e| other.centre + other.orientation * own.corners[e as usize] * other.scale);
        exact += along((q - p).norm(), 64, reach, &|s| off_disk(body, &(p + (q - p) * s)));
    }
    for corner in &own.corners {
        let x = other.centre + other.orientation * corner * other.scale;
        exact += 0.5 * (reach - from_disk(body, &x).norm()).max(0.0).powi(2);
    }
    exact
}

fn close(apart: &dyn Fn(f64) -> Option<f64>, distance: f64) -> f64 {
    let (mut low, mut high) = (0.0, 8.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if apart(middle).is_some_and(|d| d > distance) { high = middle } else { low = middle }
    }
    high
}

/// Random pairs against brute-force rim integrals.
fn energies(count: usize) {
    let mut random = Random::new(17, 1);
    let stone = stones(&mut random, 14, 0.06);
    let own = stone.core();
    let (mut worst, mut touched) = ([0.0_f64; 3], [0; 3]);
    let mut tried = 0;
    while touched.iter().any(|t| *t < count) {
        tried += 1;
        assert!(tried < 200 * count, "{touched:?}");
        let mut size = || 0.3 + random.uniform();
        let (big, small) = (size(), 0.05 + 0.1 * size());
        let (other_big, other_small) = (size(), 0.05 + 0.1 * size());
        let (one, two) = (disk(big, small), disk(other_big, other_small));
        let cores = [one.core(), two.core()];
        let slight = tried % 3 == 0;
        let turn = |random: &mut Random| {
            let any = random.orientation();
            if slight { UnitQuaternion::identity().slerp(&any, 0.01 * random.uniform()) } else { any }
        };
        let q = turn(&mut random);
        let other_turn = turn(&mut random);
        let direction = if slight {
            Vec3::new(0.4 * random.uniform(), 0.4 * random.uniform(), 1.0).normalize()
        } else {
            random.orientation() * Vec3::z()
        };
        let share = 0.3 + 0.69 * random.uniform();
        let scale = [1.0, 0.7][tried % 2];
        let kind = tried % 3;
        if touched[kind] >= count {
            continue;
        }
        let other = match kind {
            0 => placed(&two, &cores[1], Vec3::new(1.0, -2.0, 3.0), other_turn, scale),
            _ => placed(&stone, &own, Vec3::new(1.0, -2.0, 3.0), other_turn, scale),
        };
        let at = |s: f64| placed(&one, &cores[0], other.centre + direction * s, q, 1.1);
        let mut found = Manifold::new();
        let (mut exact, reach);
        if kind == 2 {
            let body = at(0.0);
            reach = body.radius;
            let low = rim_lowest(&body);
            let body = PosedBody { centre: body.centre - Vec3::z() * (low - share * reach), ..body };
            let plane = floor();
            DilatedPlane.contact_points(&body, &plane, &mut found);
            exact = pressing(&body, reach, &|p| (p.z, [0; 2]));
        } else {
            let apart = |s: f64| {
                let body = at(s);
                Two::new(&body, &other).separation(Vec3::z(), f64::INFINITY).map(|(_, d)| d * other.scale)
            };
            reach = at(0.0).radius + other.radius;
            let s = close(&apart, reach * share);
            let body = at(s);
            DilatedDilated.contact_points(&body, &other, &mut found);
            if kind == 0 {
                exact = pressing(&body, reach, &|p| off_disk(&other, p));
                exact += pressing(&other, reach, &|p| off_disk(&body, p));
            } else {
                exact = with_stone(&body, &other, reach);
            }
            let mut back = Manifold::new();
            DilatedDilated.contact_points(&other, &body, &mut back);
            assert!((energy(&back) - energy(&found)).abs() < 1e-13 * reach * reach, "{back:?} {found:?}");
        }
        if exact == 0.0 {
            assert!(found.is_empty());
            continue;
        }
        touched[kind] += 1;
        let off = (energy(&found) - exact).abs() / (reach * reach);
        worst[kind] = worst[kind].max(off);
    }
    println!("energies off by {worst:?} of reach² (disks, stones, planes), {touched:?} pairs of {tried}");
    // An edge near a rim, as curved as the rim, uses eight points.
    assert!(worst[0] < 1e-9 && worst[1] < 1e-6 && worst[2] < 1e-9, "{worst:?}");
}

fn rim_lowest(body: &PosedBody<'_>) -> f64 {
    let radius = body.core.rim.unwrap() * body.scale;
    let axis = body.orientation * Vec3::z();
    body.centre.z - radius * axis.x.hypot(axis.y)
}

#[test]
fn disk_energies_match_brute_force() {
    energies(300);
}

#[test]
#[ignore = "some minutes"]
fn energies_of_many_disks() {
    energies(100_000);
}

#[test]
fn forces_of_disks_have_a_potential() {
    let mut random = Random::new(5, 1);
    let shapes = [
        disk(0.5, 0.08),
        disk(0.35, 0.12),
        stones(&mut random, 12, 0.06),
        Shape::Box { half: [0.4, 0.3, 0.2] },
    ];
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (mut tried, mut worst) = (0, [[0.0_f64; 2]; 2]);
    while tried < 2000 {
        let (i, j) = (tried % 2, (tried / 2) % 4);
        let flat = tried % 5 == 0;
        let tilt = |random: &mut Random| {
            let any = random.orientation();
            if flat { UnitQuaternion::identity().slerp(&any, 0.02 * random.uniform()) } else { any }
        };
        let (qa, qb) = (tilt(&mut random), tilt(&mut random));
        let way = random.orientation() * Vec3::z() * (0.1 + 1.2 * random.uniform());
        let b = placed(&shapes[j], &cores[j], Vec3::new(3.0, -2.0, 1.0), qb, 0.8);
        let at = |shift: Vec3, spin: Vec3| {
            let q = UnitQuaternion::from_scaled_axis(spin) * qa;
            placed(&shapes[i], &cores[i], b.centre + way + shift, q, 1.1)
        };
        let contact_points = |shift: Vec3, spin: Vec3| {
            let mut found = Manifold::new();
            DilatedDilated.contact_points(&at(shift, spin), &b, &mut found);
            found
        };
        let found = contact_points(Vec3::zeros(), Vec3::zeros());
        let deepest = found.iter().map(|t| t.geometry.overlap / t.bound).fold(0.0, f64::max);
        if found.is_empty() || deepest > 0.3 || energy(&found) < 1e-9 {
            continue;
        }
        tried += 1;
        let worst = &mut worst[usize::from(deepest > 0.05)];
        let [force, torque] = wrench(&found, &(b.centre + way));
        let h = 1e-7;
        let slope = |f: &dyn Fn(f64) -> Manifold| (energy(&f(h)) - energy(&f(-h))) / (2.0 * h);
        for d in 0..3 {
            let e = Vec3::ith(d, 1.0);
            let unit = force.norm() + 1e-4;
            worst[0] =
                worst[0].max((force[d] + slope(&|x| contact_points(e * x, Vec3::zeros()))).abs() / unit);
            worst[1] =
                worst[1].max((torque[d] + slope(&|x| contact_points(Vec3::zeros(), e * x))).abs() / unit);
        }
    }
    println!("force and torque of disks against differences of the energy, shallow and deep: {worst:?}");
    assert!(worst.iter().flatten().all(|w| *w < 1e-5), "{worst:?}");
}

#[test]
fn disks_match_from_both_sides() {
    let mut random = Random::new(6, 1);
    let shapes = [disk(0.5, 0.08), disk(0.35, 0.12), stones(&mut random, 12, 0.06)];
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (mut points, mut hint) = (0, None);
    for pair in 0..90 {
        let (i, j) = (pair % 2, pair / 2 % 3);
        let spin = random.orientation() * Vec3::x() * if pair % 4 == 0 { 0.05 } else { 1.0 };
        let from = if pair % 4 == 0 { Vec3::z() * 0.22 } else { random.orientation() * Vec3::x() * 0.6 };
        let way = random.orientation() * Vec3::x();
        for step in 0..200 {
            let t = 0.01 * f64::from(step) - 1.0;
            let a = placed(&shapes[i], &cores[i], from + way * (0.3 * t), UnitQuaternion::new(spin * t), 1.0);
            let b = placed(&shapes[j], &cores[j], Vec3::zeros(), UnitQuaternion::identity(), 0.9);
            let [mut cold, mut warm, mut back] = [Manifold::new(), Manifold::new(), Manifold::new()];
            DilatedDilated.contact_points(&a, &b, &mut cold);
            DilatedDilated.contact_points_from_hint(&a, &b, &mut hint, &mut warm);
            DilatedDilated.contact_points(&b, &a, &mut back);
            if cold.iter().any(|t| t.geometry.overlap > t.bound) {
                hint = None;
                continue;
            }
            let bits = |found: &Manifold| -> Vec<(u32, [u64; 8])> {
                let of = |t: &PairContactPoint| {
                    let ([x, y, z], p) = (t.geometry.normal.into(), t.geometry.point);
                    [t.geometry.overlap, t.weight, x, y, z, p.x, p.y, p.z].map(f64::to_bits)
                };
                found.iter().map(|t| (t.feature, of(t))).collect()
            };
            assert_eq!(bits(&cold), bits(&warm), "pair {pair}, step {step}");
            points += cold.len();
            assert_eq!(cold.len(), back.len());
            for s in &cold {
                let t =
                    back.iter().find(|t| t.feature == s.feature.rotate_left(16)).expect("the same features");
                assert!((s.geometry.point - t.geometry.point).norm() < 1e-9, "{s:?} {t:?}");
                assert!((s.weight - t.weight).abs() <= 1e-9 * s.weight + 1e-12, "{} {}", s.weight, t.weight);
            }
        }
    }
    assert!(points > 3000, "{points}");
}

#[test]
fn a_disk_flat_on_a_plane() {
    let shape = disk(0.5, 0.1);
    let core = shape.core();
    let plane = floor();
    let contact_points = |tilt: f64| {
        let mut found = Manifold::new();
        let turn = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), tilt);
        DilatedPlane.contact_points(&placed(&shape, &core, Vec3::z() * 0.099, turn, 1.0), &plane, &mut found);
        found
    };
    let flat = contact_points(0.0);
    assert_eq!(flat.len(), 8);
    let weight: f64 = flat.iter().map(|t| t.weight).sum();
    assert!((weight - TAU * 0.5 / (LENGTH * 0.1)).abs() < 1e-12, "{weight}");
    assert!(flat.iter().all(|t| (t.geometry.overlap - 1e-3).abs() < 1e-12));
    let torque = wrench(&contact_points(1e-3), &(Vec3::z() * 0.099))[1].x;
    // ∫ y² over a ring: half its length times R².
    let ring = weight * 0.5 * 0.25 * 1e-3;
    assert!((torque / ring + 1.0).abs() < 2e-3, "{torque} {ring}");
}
