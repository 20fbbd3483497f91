use super::*;
use crate::base::error::Partner;
use crate::base::random::Random;
use crate::contact::narrow_phase::dilated::{DilatedDilated, DilatedPlane};
use crate::contact::narrow_phase::scene::PlaneView;
use crate::shape::dilated::{Core, Dilated};
use crate::shape::{Shape, cuboid};
use crate::spatial::facet::facets;
use crate::spatial::patchwork::{Patch, WallView};
use crate::spatial::round::Round;
use nalgebra::UnitQuaternion;

struct Wall {
    patches: Vec<Patch>,
    now: WallView,
}

impl Wall {
    fn of(forms: Vec<Form>, at: Vec3, orientation: UnitQuaternion<f64>) -> Wall {
        let patches = forms.into_iter().map(|f| Patch::new(0, f, Partner::Wall(0))).collect();
        let now = WallView {
            origin: at,
            orientation,
            centre: at,
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            material: 0,
            inverse_mass: 0.0,
            open: false,
            driven: false,
            scarred: false,
        };
        Wall { patches, now }
    }

    fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]], at: Vec3, orientation: UnitQuaternion<f64>) -> Wall {
        let same: Vec<u32> = (0..vertices.len() as u32).collect();
        let forms = facets(vertices, triangles, &same).into_iter().map(|f| Form::Facet(Box::new(f)));
        Wall::of(forms.collect(), at, orientation)
    }

    fn contact_points(&self, body: &PosedBody<'_>) -> Manifold {
        let mut found = Manifold::new();
        for patch in &self.patches {
            let view = PatchView { patch, wall: &self.now, shift: Vec3::zeros() };
            if DilatedPatch.may_touch(body, &view, 0.0) {
                DilatedPatch.contact_points(body, &view, &mut found);
            }
        }
        found
    }
}

fn placed<'a>(
    shape: &'a Shape,
    core: &'a Core,
    centre: Vec3,
    q: UnitQuaternion<f64>,
    scale: f64,
) -> PosedBody<'a> {
    PosedBody { centre, orientation: q, shape, scale, core, radius: shape.rounding(scale) }
}

fn energy(found: &Manifold) -> f64 {
    found.iter().map(|t| 0.5 * t.weight * t.geometry.overlap.powi(2)).sum()
}

fn wrench(found: &Manifold, about: &Vec3) -> [Vec3; 2] {
    let mut sums = [Vec3::zeros(); 2];
    for t in found {
        let normal = t.weight * t.geometry.overlap;
        let force = t.geometry.normal * normal;
        sums[0] += force;
        sums[1] += (t.geometry.point - about).cross(&force) + t.couple * normal;
    }
    sums
}

fn stone(random: &mut Random, corners: usize, radius: f64) -> Shape {
    let points: Vec<Vec3> = (0..corners)
        .map(|_| random.orientation() * Vec3::x())
        .map(|p| Vec3::new(0.5 * p.x, 0.4 * p.y, 0.3 * p.z))
        .collect();
    Shape::Polyhedron(Box::new(Dilated::new(&points, radius).unwrap().0))
}

fn shapes(random: &mut Random) -> Vec<Shape> {
    let mut shapes: Vec<Shape> = (0..5).map(|k| stone(random, 8 + 3 * k, 0.05 + 0.02 * k as f64)).collect();
    let cube: Vec<Vec3> = (0..8).map(|k| cuboid::corner(&Vec3::repeat(0.4), k)).collect();
    shapes.push(Shape::Polyhedron(Box::new(Dilated::new(&cube, 0.06).unwrap().0)));
    shapes
}

fn disks() -> Vec<Shape> {
    [[0.5, 0.06], [0.3, 0.12], [0.7, 0.05]]
        .map(|[big, r]| Shape::Polyhedron(Box::new(Dilated::disk(big, r).unwrap())))
        .to_vec()
}

/// `n` × `n` squares over the unit square.
fn grid(n: u32, height: impl Fn(f64, f64) -> f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |i: u32| f64::from(i) / f64::from(n);
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| [i, j]));
    let vertices = vertices.map(|[i, j]| Vec3::new(at(i), at(j), height(at(i), at(j)))).collect();
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let v = |a: u32, b: u32| (j + b) * (n + 1) + i + a;
            // Alternating diagonals.
            if (i + j) % 2 == 0 {
                triangles.extend([[v(0, 0), v(1, 0), v(1, 1)], [v(0, 0), v(1, 1), v(0, 1)]]);
            } else {
                triangles.extend([[v(0, 0), v(1, 0), v(0, 1)], [v(1, 0), v(1, 1), v(0, 1)]]);
            }
        }
    }
    (vertices, triangles)
}

/// Welded, `n` × `n` squares per side.
fn box_mesh(half: &Vec3, n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (flat, triangles) = grid(n, |_, _| 1.0);
    let (mut vertices, mut all): (Vec<Vec3>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    for d in 0..3 {
        for sign in [1.0, -1.0] {
            let place = |p: &Vec3| {
                let mut x = Vec3::zeros();
                (x[d], x[(d + 1) % 3], x[(d + 2) % 3]) = (sign, 2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
                x.component_mul(half)
            };
            let numbers: Vec<u32> = flat
                .iter()
                .map(|p| {
                    let x = place(p);
                    let known = vertices.iter().position(|v| (v - x).norm() < 1e-9);
                    known.unwrap_or_else(|| {
                        vertices.push(x);
                        vertices.len() - 1
                    }) as u32
                })
                .collect();
            all.extend(triangles.iter().map(|t| t.map(|v| numbers[v as usize])));
        }
    }
    (vertices, all)
}

#[test]
fn triangulated_box_matches_box() {
    boxes_of_triangles(shapes(&mut Random::new(21, 1)), &[1, 3], 1e-8);
    boxes_of_triangles(disks(), &[1], 2e-4);
}

fn boxes_of_triangles(shapes: Vec<Shape>, cuts: &[u32], bound: f64) {
    let mut random = Random::new(25, 1);
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let half = Vec3::new(0.5, 0.4, 0.3);
    let (turn, at) = (random.orientation(), Vec3::new(1.0, -2.0, 0.5));
    let whole = Shape::Box { half: half.into() };
    let whole_core = whole.core();
    let itself = placed(&whole, &whole_core, at, turn, 1.0);
    for &n in cuts {
        let (vertices, triangles) = box_mesh(&half, n);
        let wall = Wall::mesh(&vertices, &triangles, at, turn);
        let (mut tried, mut worst) = (0, 0.0_f64);
        while tried < 600 {
            let k = (random.uniform() * shapes.len() as f64) as usize;
            let way = (random.orientation() * Vec3::z()) * (0.5 + 0.8 * random.uniform());
            let q = if tried % 3 == 0 { turn } else { random.orientation() };
            let body = placed(&shapes[k], &cores[k], at + way, q, 1.1);
            let (mut as_body, on_wall) = (Manifold::new(), wall.contact_points(&body));
            DilatedDilated.contact_points(&body, &itself, &mut as_body);
            let deepest = as_body.iter().map(|t| t.geometry.overlap / t.bound).fold(0.0, f64::max);
            if as_body.is_empty() || deepest > 0.5 {
                continue;
            }
            tried += 1;
            let (one, two) = (wrench(&as_body, &body.centre), wrench(&on_wall, &body.centre));
            let unit = one[0].norm() + 1e-3;
            for m in 0..2 {
                worst = worst.max((one[m] - two[m]).norm() / unit);
            }
            worst = worst.max((energy(&as_body) - energy(&on_wall)).abs() / (energy(&as_body) + 1e-6));
        }
        println!("a box of {} triangles: off by {worst:e}", triangles.len());
        assert!(worst < bound, "{worst:e}");
    }
}

#[test]
fn triangulated_floor_matches_plane() {
    let mut random = Random::new(22, 1);
    let shapes = shapes(&mut random);
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (vertices, triangles) = grid(7, |_, _| 0.0);
    let wide: Vec<Vec3> = vertices.iter().map(|v| (v - Vec3::new(0.5, 0.5, 0.0)) * 6.0).collect();
    let wall = Wall::mesh(&wide, &triangles, Vec3::zeros(), UnitQuaternion::identity());
    let plane = PlaneView {
        origin: Vec3::zeros(),
        normal: Vec3::z(),
        velocity: Vec3::zeros(),
        material: 0,
        open: false,
    };
    let (mut tried, mut worst) = (0, 0.0_f64);
    while tried < 1000 {
        let k = (random.uniform() * shapes.len() as f64) as usize;
        let at = Vec3::new(
            2.0 * random.uniform() - 1.0,
            2.0 * random.uniform() - 1.0,
            0.2 + 0.6 * random.uniform(),
        );
        let q = if tried % 3 == 0 { UnitQuaternion::identity() } else { random.orientation() };
        let body = placed(&shapes[k], &cores[k], at, q, 1.0);
        let (mut on_plane, on_wall) = (Manifold::new(), wall.contact_points(&body));
        DilatedPlane.contact_points(&body, &plane, &mut on_plane);
        let deepest = on_plane.iter().map(|t| t.geometry.overlap / t.bound).fold(0.0, f64::max);
        if on_plane.is_empty() || deepest > 0.5 {
            continue;
        }
        tried += 1;
        let (one, two) = (wrench(&on_plane, &at), wrench(&on_wall, &at));
        for m in 0..2 {
            worst = worst.max((one[m] - two[m]).norm() / (one[0].norm() + 1e-3));
        }
    }
    println!("a floor of {} triangles: off by {worst:e}", triangles.len());
    assert!(worst < 1e-8, "{worst:e}");
}

#[test]
fn walls_have_a_potential() {
    potentials_of_walls(shapes(&mut Random::new(23, 1)), 8, 1.0);
    // Rims are summed over cells that need not end at a round wall.
    potentials_of_walls(disks(), 2, 1000.0);
}

fn potentials_of_walls(shapes: Vec<Shape>, count: usize, loose: f64) {
    let mut random = Random::new(27, 1);
    let cores: Vec<Core> = shapes.iter().map(Shape::core).collect();
    let (still, none) = (UnitQuaternion::identity(), Vec3::zeros());
    let (rough, triangles) = grid(5, |x, y| 0.2 * libm::sin(9.0 * x) * libm::cos(8.0 * y));
    let hills: Vec<Vec3> = rough.iter().map(|v| (v - Vec3::new(0.5, 0.5, 0.0)) * 2.0).collect();
    let frustum = |radii: [f64; 2], height: f64| Round::Frustum {
        base: Vec3::new(0.0, 0.0, -0.5 * height),
        axis: Vec3::z(),
        height,
        radii,
        far: false,
    };
    let disc = |z: f64| Round::Disc { centre: Vec3::z() * z, axis: Vec3::z() * z.signum(), radius: 0.7 };
    let round = |forms: Vec<Round>| Wall::of(forms.into_iter().map(Form::Round).collect(), none, still);
    let walls: [(&str, Wall, f64); 8] = [
        ("hills", Wall::mesh(&hills, &triangles, none, still), 1e-6),
        ("pile", round(vec![frustum([0.6, 0.6], 4.0)]), 1e-6),
        ("short pile", round(vec![frustum([0.7, 0.7], 1.0), disc(0.5), disc(-0.5)]), 1e-5),
        ("cone", round(vec![frustum([1.0, 0.3], 1.2)]), 2e-5),
        ("drum", round(vec![frustum([1.5, 1.5], 4.0)]), 1e-5),
        ("funnel", round(vec![frustum([1.2, 2.0], 3.0)]), 1e-5),
        ("ball", round(vec![Round::Sphere { centre: Vec3::x() * 0.1, radius: 0.5 }]), 1e-7),
        ("bowl", round(vec![Round::Sphere { centre: Vec3::x() * 0.1, radius: 1.6 }]), 1e-6),
    ];
    for (name, wall, bound) in walls.into_iter().take(count) {
        let at = |k: usize, x: Vec3, q: UnitQuaternion<f64>| placed(&shapes[k], &cores[k], x, q, 1.0);
        let (mut tried, mut missed, mut worst) = (0, 0, [0.0_f64; 2]);
        while tried < 150 {
            let k = (random.uniform() * shapes.len() as f64) as usize;
            let x = (random.orientation() * Vec3::z()) * (0.3 + 1.6 * random.uniform());
            let q = if tried % 4 == 0 { still } else { random.orientation() };
            let found = wall.contact_points(&at(k, x, q));
            let deepest = found.iter().map(|t| t.geometry.overlap / t.bound).fold(0.0, f64::max);
            missed += 1;
            assert!(missed < 2_000_000, "{name}: {tried}");
            if found.is_empty() || deepest > 0.3 {
                continue;
            }
            tried += 1;
            let [force, torque] = wrench(&found, &x);
            let h = 1e-6;
            let of = |shift: Vec3, spin: Vec3| {
                energy(&wall.contact_points(&at(k, x + shift, UnitQuaternion::from_scaled_axis(spin) * q)))
            };
            for d in 0..3 {
                let e = Vec3::ith(d, h);
                let by_shift = (of(e, none) - of(-e, none)) / (2.0 * h);
                let by_spin = (of(none, e) - of(none, -e)) / (2.0 * h);
                let unit = force.norm() + 1e-3;
                worst[0] = worst[0].max((force[d] + by_shift).abs() / unit);
                worst[1] = worst[1].max((torque[d] + by_spin).abs() / unit);
            }
        }
        println!("{name}: force and torque against differences of the energy {worst:?}");
        assert!(worst.iter().all(|w| *w < bound * loose), "{name}: {worst:?}");
    }
}

#[test]
fn disks_of_the_table_on_walls() {
    let table = include_str!("../../../tests/data/shapes/disk_pairs.csv");
    let mut compared = [0; 2];
    for line in table.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let number = |k: usize| -> f64 { words[k].parse().unwrap() };
        let given: Vec<f64> = words[2].split(' ').map(|w| w.parse().unwrap_or(f64::NAN)).collect();
        let still = UnitQuaternion::identity();
        let wall = match words[1] {
            "triangle" => {
                let corners: Vec<Vec3> = given.chunks(3).map(|c| Vec3::new(c[0], c[1], c[2])).collect();
                Wall::mesh(&corners, &[[0, 1, 2]], Vec3::zeros(), still)
            }
            "cylinder_inf" => {
                let side = Round::Frustum {
                    base: Vec3::z() * -20.0,
                    axis: Vec3::z(),
                    height: 40.0,
                    radii: [given[0]; 2],
                    far: false,
                };
                Wall::of(vec![Form::Round(side)], Vec3::zeros(), still)
            }
            _ => continue,
        };
        compared[usize::from(words[1] == "triangle")] += 1;
        let shape = Shape::Polyhedron(Box::new(Dilated::disk(number(4), number(5)).unwrap()));
        let core = shape.core();
        let q = nalgebra::Quaternion::new(number(6), number(7), number(8), number(9));
        let at = Vec3::new(number(10), number(11), number(12));
        let body = placed(&shape, &core, at, UnitQuaternion::from_quaternion(q), 1.0);
        let found = wall.contact_points(&body);
        let (gap, normal) = (number(14), Vec3::new(number(16), number(17), number(18)));
        if gap >= 0.0 {
            assert!(energy(&found) < 1e-20, "{line}");
            continue;
        }
        let deepest = found.iter().map(|t| t.geometry.overlap).fold(0.0, f64::max);
        assert!(deepest < -gap + 1e-8 && deepest > -0.3 * gap, "{deepest} for {line}");
        let force = wrench(&found, &body.centre)[0];
        assert!(force.normalize().dot(&normal) < -0.9, "{force} for {line}");
    }
    assert_eq!(compared, [25; 2]);
}
