//! Dilated polyhedra against brute force: closest points by going through all faces and sides, edges integrated numerically.

use super::tests::{energy, placed, stones};
use super::*;
use crate::base::random::Random;
use crate::shape::dilated::{Dilated, Face};
use crate::shape::{Shape, cuboid};

/// A placed core, and the normal and the corners with their numbers of each of its faces.
type Solid<'a> = (&'a Placed<'a>, Vec<(Vec3, Vec<(Vec3, usize)>)>);

fn solid<'a>(body: &'a Placed<'a>) -> Solid<'a> {
    let face = |face: &Face| {
        let numbers = face.corners.iter().map(|c| *c as usize);
        let corners: Vec<_> = numbers.map(|c| (body.core.corners[c], c)).collect();
        let [a, b, c] = [0, 1, 2].map(|k| corners[k].0);
        ((b - a).cross(&(c - a)).normalize(), corners)
    };
    (body, body.core.faces.iter().map(face).collect())
}

/// Distance of a point outside of a placed core: the least to any face that it lies above, and to any side of a face; and which face, side or
/// corner that is.
fn distance((body, faces): &Solid<'_>, p: &Vec3) -> (f64, [usize; 2]) {
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

/// ∫ f by four points of Gauss, halved until that changes nothing. A stretch over which the second part of `f` changes is halved first: what is
/// nearest to one place and to another is nearest to all between them, as such regions are convex.
fn integral(f: &dyn Fn(f64) -> (f64, [usize; 2]), [low, high]: [f64; 2], close: f64) -> f64 {
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

/// Energy of unit springs with which corners and edges of one press into the other.
fn pressing(one: &Placed<'_>, other: &Solid<'_>, reach: f64) -> f64 {
    let world = |c: usize| one.centre + one.orientation * one.core.corners[c] * one.scale;
    let spring = |p: &Vec3| 0.5 * (reach - distance(other, p).0).max(0.0).powi(2);
    let corners: f64 = (0..one.core.corners.len()).map(|c| spring(&world(c))).sum();
    let edges: f64 = one
        .core
        .edges
        .iter()
        .map(|edge| {
            let [a, b] = edge.ends.map(|e| world(e as usize));
            let length = (b - a).norm();
            let near = |s: f64| distance(other, &(a + (b - a) * s));
            let at = |s: f64| near(s).0;
            // The distance changes by no more than the way along the edge.
            if at(0.5) > reach + 0.5 * length {
                return 0.0;
            }
            // It has one minimum, the body being convex: what is below `reach` is one stretch about it.
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
    corners + edges
}

/// Energies of random pairs, thrown together in whatever way, flat on each other, or nearly so; from both sides to rounding.
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
            // Tilts of 1e-9 to 0.1 of a whole turn.
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
            let (mut one, mut two) = (Touches::new(), Touches::new());
            DilatedDilated.touches(&a, &b, &mut one);
            DilatedDilated.touches(&b, &a, &mut two);
            let exact = pressing(&a, &solid(&b), reach) + pressing(&b, &solid(&a), reach);
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

/// The same with 10⁵ pairs of each kind.
#[test]
#[ignore = "some minutes"]
fn energies_of_many_pairs_are_those_of_brute_force() {
    energies(100_000);
}
