//! Dilated polyhedra against brute force.

use super::tests::{energy, placed, stones};
use super::*;
use crate::base::random::Random;
use crate::contact::narrow_phase::patch::{on_facet, two};
use crate::shape::dilated::{Dilated, Face};
use crate::shape::{Shape, cuboid};
use crate::spatial::facet::{Facet, facets};

/// Placed core; normal and corners of each face.
pub(super) type Solid<'a> = (&'a PosedBody<'a>, Vec<(Vec3, Vec<(Vec3, usize)>)>);

pub(super) fn solid<'a>(body: &'a PosedBody<'a>) -> Solid<'a> {
    let face = |face: &Face| {
        let numbers = face.corners.iter().map(|c| *c as usize);
        let corners: Vec<_> = numbers.map(|c| (body.core.corners[c], c)).collect();
        let [a, b, c] = [0, 1, 2].map(|k| corners[k].0);
        ((b - a).cross(&(c - a)).normalize(), corners)
    };
    (body, body.core.faces.iter().map(face).collect())
}

pub(super) fn distance((body, faces): &Solid<'_>, p: &Vec3) -> (f64, [usize; 2]) {
    let local = body.orientation.inverse() * (p - body.centre) / body.scale;
    let mut best = (f64::INFINITY, [0; 2]);
    for (f, (normal, corners)) in faces.iter().enumerate() {
        let mut above = true;
        for (k, (a, own)) in corners.iter().enumerate() {
            let (b, other) = corners[(k + 1) % corners.len()];
            let (side, way) = (b - a, local - a);
            above &= normal.dot(&side.cross(&way)) >= 0.0;
            let share = (way.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
            let away = (way - side * share).norm();
            if away < best.0 {
                let name = match share {
                    0.0 => [*own; 2],
                    1.0 => [other; 2],
                    _ => [*own.min(&other), *own.max(&other)],
                };
                best = (away, name);
            }
        }
        let height = normal.dot(&(local - corners[0].0));
        if above && height >= 0.0 && height <= best.0 {
            best = (height, [usize::MAX, f]);
        }
    }
    (best.0 * body.scale, best.1)
}

/// Four-point Gauss integral, bisected to convergence; feature changes are bisected first.
pub(super) fn integral(f: &dyn Fn(f64) -> (f64, [usize; 2]), [low, high]: [f64; 2], close: f64) -> f64 {
    let rule = |a: f64, b: f64| {
        let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
        let two = |x: f64, w: f64| w * (f(m - h * x).0 + f(m + h * x).0);
        h * (two(0.339_981_043_584_856_3, 0.652_145_154_862_546_1)
            + two(0.861_136_311_594_052_6, 0.347_854_845_137_453_86))
    };
    let middle = 0.5 * (low + high);
    let halves = rule(low, middle) + rule(middle, high);
    let smooth = f(low).1 == f(high).1 && (rule(low, high) - halves).abs() < close;
    if smooth || high - low < 1e-9 {
        return halves;
    }
    integral(f, [low, middle], close) + integral(f, [middle, high], close)
}

type Skeleton = (Vec<Vec3>, Vec<[usize; 2]>);

fn skeleton_of(body: &PosedBody<'_>) -> Skeleton {
    let world = |c: &Vec3| body.centre + body.orientation * c * body.scale;
    let edges = body.core.edges.iter().map(|edge| edge.ends.map(|e| e as usize));
    (body.core.corners.iter().map(world).collect(), edges.collect())
}

fn pressing((corners, edges): &Skeleton, distance: &dyn Fn(&Vec3) -> (f64, [usize; 2]), reach: f64) -> f64 {
    let spring = |p: &Vec3| 0.5 * (reach - distance(p).0).max(0.0).powi(2);
    let of_corners: f64 = corners.iter().map(spring).sum();
    let of_edges: f64 = edges
        .iter()
        .map(|ends| {
            let [a, b] = ends.map(|e| corners[e]);
            let length = (b - a).norm();
            let near = |s: f64| distance(&(a + (b - a) * s));
            let at = |s: f64| near(s).0;
            if at(0.5) > reach + 0.5 * length {
                return 0.0;
            }
            // One minimum, as the body is convex: one stretch below `reach`.
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..40 {
                let third = (high - low) / 3.0;
                if at(low + third) < at(high - third) { high -= third } else { low += third }
            }
            let best = 0.5 * (low + high);
            if at(best) >= reach {
                return 0.0;
            }
            let end = |mut outside: f64| {
                if at(outside) < reach {
                    return outside;
                }
                let mut inside = best;
                for _ in 0..45 {
                    let middle = 0.5 * (inside + outside);
                    if at(middle) < reach { inside = middle } else { outside = middle }
                }
                inside
            };
            let stretch = [end(0.0), end(1.0)];
            let pressed = |s: f64| {
                let (d, name) = near(s);
                (0.5 * (reach - d).max(0.0).powi(2), name)
            };
            integral(&pressed, stretch, 1e-12 * reach * reach) * length / (LENGTH * reach)
        })
        .sum();
    of_corners + of_edges
}

fn energies(count: usize) {
    let mut random = Random::new(23, 1);
    let cube: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::repeat(0.35), k)).collect();
    let shapes = [
        stones(&mut random, 9, 0.06),
        stones(&mut random, 16, 0.08),
        stones(&mut random, 26, 0.05),
        Shape::Polyhedron(Box::new(Dilated::new(&cube, 0.07).unwrap().0)),
        Shape::Box { half: [0.4, 0.3, 0.2] },
    ];
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    for (name, tilt) in [("any", None), ("flat", Some(0.0)), ("nearly flat", Some(1.0))] {
        let (mut worst, mut both, mut touched) = (0.0_f64, 0.0_f64, 0);
        while touched < count {
            let [i, j] = [0, 1].map(|_| (random.uniform() * shapes.len() as f64) as usize);
            if i == 4 && j == 4 {
                continue;
            }
            let any = [0, 1].map(|_| random.orientation());
            // Tilts of 1e-9 to 0.1 turns.
            let slight = 10.0_f64.powf(-1.0 - 8.0 * random.uniform());
            let turns = match tilt {
                None => any,
                Some(t) => {
                    let first = UnitQuaternion::from_scaled_axis(any[0].scaled_axis() * (t * slight));
                    [first, UnitQuaternion::identity()]
                }
            };
            let direction = match tilt {
                None => random.orientation() * Vec3::z(),
                Some(_) => Vec3::new(0.4 * random.uniform(), 0.4 * random.uniform(), 1.0).normalize(),
            };
            let b = placed(&shapes[j], &cores[j], Vec3::new(1.0, -2.0, 3.0), turns[1], 0.8);
            let at = |s: f64| placed(&shapes[i], &cores[i], b.centre + direction * s, turns[0], 1.1);
            let reach = at(0.0).radius + b.radius;
            let share = 0.3 + 0.69 * random.uniform();
            let (mut low, mut high) = (0.0, 4.0);
            for _ in 0..30 {
                let middle = 0.5 * (low + high);
                let apart = Two::new(&at(middle), &b).separation(Vec3::z(), f64::INFINITY);
                if apart.is_some_and(|(_, d)| d * b.scale > share * reach) {
                    high = middle
                } else {
                    low = middle
                }
            }
            let a = at(high);
            let (mut one, mut two) = (Manifold::new(), Manifold::new());
            DilatedDilated.contact_points(&a, &b, &mut one);
            DilatedDilated.contact_points(&b, &a, &mut two);
            let into = |one: &PosedBody<'_>, other: &PosedBody<'_>| {
                let other = solid(other);
                pressing(&skeleton_of(one), &|p| distance(&other, p), reach)
            };
            let exact = into(&a, &b) + into(&b, &a);
            if exact == 0.0 {
                assert!(one.is_empty() && two.is_empty());
                continue;
            }
            touched += 1;
            let unit = reach * reach;
            worst = worst.max((energy(&one) - exact).abs() / unit);
            both = both.max((energy(&one) - energy(&two)).abs() / unit);
        }
        println!(
            "{name}: {touched} pairs, energies off by {worst:.1e} of reach², from the other side by {both:.1e}"
        );
        assert!(worst < 1e-9 && both < 1e-12, "{name}: {worst:e} {both:e}");
    }
}

#[test]
fn energies_are_those_of_brute_force() {
    energies(200);
}

#[test]
#[ignore = "some minutes"]
fn energies_of_many_pairs() {
    energies(100_000);
}

fn from_triangle(corners: &[Vec3; 3], p: &Vec3) -> (f64, [usize; 2]) {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a)).normalize();
    let mut best = (f64::INFINITY, [0; 2]);
    let mut above = true;
    for k in 0..3 {
        let (side, way) = (corners[(k + 1) % 3] - corners[k], p - corners[k]);
        above &= normal.dot(&side.cross(&way)) >= 0.0;
        let share = (way.dot(&side) / side.norm_squared()).clamp(0.0, 1.0);
        let away = (way - side * share).norm();
        if away < best.0 {
            let name = match share {
                0.0 => [k; 2],
                1.0 => [(k + 1) % 3; 2],
                _ => [k, 3 + k],
            };
            best = (away, name);
        }
    }
    let height = normal.dot(&(p - a));
    if above && height.abs() <= best.0 { (height.abs(), [usize::from(height < 0.0), 9]) } else { best }
}

enum Other {
    Sphere(f64),
    Plane(PlaneView),
    Triangle([Vec3; 3], Box<Facet>),
}

const WORLD: Pose = Pose {
    centre: Vec3::new(0.0, 0.0, 0.0),
    orientation: UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1.0, 0.0, 0.0, 0.0)),
    scale: 1.0,
};

impl Other {
    fn at_random(name: &str, random: &mut Random) -> Other {
        let size = 0.05 + 0.3 * random.uniform();
        match name {
            "sphere" => Other::Sphere(size),
            "plane" => Other::Plane(PlaneView {
                origin: Vec3::zeros(),
                normal: random.orientation() * Vec3::z(),
                velocity: Vec3::zeros(),
                material: 0,
                open: false,
            }),
            _ => {
                let corners = [0, 1, 2].map(|_| random.orientation() * Vec3::x() * (3.0 * size));
                let facet = facets(&corners, &[[0, 1, 2]], &[0, 1, 2]).swap_remove(0);
                Other::Triangle(corners, Box::new(facet))
            }
        }
    }

    fn apart(&self, body: &PosedBody<'_>) -> f64 {
        match self {
            Other::Sphere(size) => {
                let local = body.orientation.inverse() * -body.centre / body.scale;
                let inside = outside(body.core, &local) <= 0.0;
                if inside { -1.0 } else { distance(&solid(body), &Vec3::zeros()).0 - size }
            }
            Other::Plane(plane) => {
                let heights = skeleton_of(body).0.into_iter().map(|c| plane.normal.dot(&c));
                heights.fold(f64::INFINITY, f64::min)
            }
            Other::Triangle(_, facet) => {
                let apart = two(body, &WORLD, facet).separation(Vec3::z(), f64::INFINITY);
                apart.map_or(-1.0, |(_, apart)| apart)
            }
        }
    }

    fn energies(&self, body: &PosedBody<'_>) -> (Manifold, f64, f64) {
        let (mut found, own) = (Manifold::new(), body.radius);
        match self {
            Other::Sphere(size) => {
                let sphere = Vec4::of(&Vec3::zeros(), *size);
                SphereDilated.contact_points(&&sphere, body, &mut found);
                let reach = size + own;
                let overlap = (reach - distance(&solid(body), &Vec3::zeros()).0).max(0.0);
                (found, 0.5 * overlap * overlap, reach)
            }
            Other::Plane(plane) => {
                DilatedPlane.contact_points(body, plane, &mut found);
                let exact = pressing(&skeleton_of(body), &|p| (plane.normal.dot(p), [0; 2]), own);
                (found, exact, own)
            }
            Other::Triangle(corners, facet) => {
                on_facet(body, &WORLD, facet, &mut None, &mut found);
                let (stone, triangle) = (solid(body), (corners.to_vec(), vec![[0, 1], [1, 2], [2, 0]]));
                let into = pressing(&skeleton_of(body), &|p| from_triangle(corners, p), own);
                (found, into + pressing(&triangle, &|p| distance(&stone, p), own), own)
            }
        }
    }
}

fn energies_with_others(count: usize) {
    let mut random = Random::new(29, 1);
    let shapes = [stones(&mut random, 9, 0.06), stones(&mut random, 16, 0.08), stones(&mut random, 26, 0.05)];
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    for name in ["sphere", "plane", "triangle"] {
        let (mut worst, mut touched) = (0.0_f64, 0);
        while touched < count {
            let k = (random.uniform() * shapes.len() as f64) as usize;
            let (turn, direction) = (random.orientation(), random.orientation() * Vec3::z());
            let at = |s: f64| placed(&shapes[k], &cores[k], direction * s, turn, 0.9);
            // Overlaps up to 0.7 radii.
            let share = 0.3 + 0.69 * random.uniform();
            let other = Other::at_random(name, &mut random);
            if matches!(&other, Other::Plane(plane) if plane.normal.dot(&direction) < 0.2) {
                continue;
            }
            let (mut low, mut high) = (0.0, 4.0);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if other.apart(&at(middle)) > share * at(0.0).radius { high = middle } else { low = middle }
            }
            let (found, exact, reach) = other.energies(&at(high));
            if exact == 0.0 {
                assert!(found.is_empty());
                continue;
            }
            touched += 1;
            worst = worst.max((energy(&found) - exact).abs() / (reach * reach));
        }
        println!("{name}: {touched} pairs, energies off by {worst:.1e} of reach²");
        assert!(worst < 1e-9, "{name}: {worst:e}");
    }
}

#[test]
fn energies_with_others_match_brute_force() {
    energies_with_others(300);
}

#[test]
#[ignore = "some minutes"]
fn energies_of_many_pairs_with_others() {
    energies_with_others(100_000);
}
