//! Triangle surfaces: seams have no effect.

use crate::scene::{Random, Run, plane, sphere, stone, weightless};
use trackbed_dem::{BodyInput, Material, ModelInput, Plane, Shape, TriangleSurface, Vec3, measure};

fn of_one(body: BodyInput) -> ModelInput {
    let mut input = weightless(Material { stiffness: 1e6, tangential_damping_ratio: 0.3, ..stone() });
    input.shapes.push(Shape::Clump(crate::scene::clump()));
    input.bodies.push(body);
    input
}

fn on_planes(planes: Vec<Plane>, body: BodyInput) -> ModelInput {
    ModelInput { planes, ..of_one(body) }
}

fn heavy(mut input: ModelInput) -> Run {
    input.gravity = Vec3::new(0.0, 0.0, -9.81);
    let mut run = Run::new(input);
    run.work.keep_forces(true);
    run
}

fn on_triangles(vertices: &[[f64; 3]], triangles: &[[u32; 3]], body: BodyInput) -> ModelInput {
    let mut input = of_one(body);
    input.triangles.push(TriangleSurface {
        vertices: vertices.iter().map(|&v| v.into()).collect(),
        triangles: triangles.to_vec(),
        ..TriangleSurface::default()
    });
    input
}

#[test]
fn triangulated_floor_is_a_plane() {
    let mut random = Random::new(5);
    let n = 8;
    let pitch = 0.02;
    let mut vertices = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let mut shift = || (random.unit() - 0.5) * 0.6 * pitch;
            vertices.push([
                (f64::from(i) - 1.0) * pitch + shift(),
                (f64::from(j) - 4.0) * pitch + shift(),
                0.0,
            ]);
        }
    }
    let at = |i: i32, j: i32| (j * (n + 1) + i) as u32;
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[b, a, d], [b, c, d]] });
        }
    }
    let soup_vertices: Vec<[f64; 3]> =
        triangles.iter().flat_map(|t| t.iter().map(|&v| vertices[v as usize])).collect();
    let soup_triangles: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();

    let ball = BodyInput {
        spin: Vec3::new(0.0, 0.0, 15.0),
        ..sphere(Vec3::new(0.0, 0.001, 0.0099), Vec3::new(0.5, 0.013, 0.0))
    };
    let stone = BodyInput { shape: 1, position: Vec3::new(0.0, 0.0, 0.02), ..ball.clone() };
    for body in [ball, stone] {
        let mut reference = heavy(on_planes(vec![plane(Vec3::zeros(), Vec3::z())], body.clone()));
        let mut runs = [(&vertices, &triangles), (&soup_vertices, &soup_triangles)]
            .map(|(v, t)| heavy(on_triangles(v, t, body.clone())));
        let bounce = if body.shape == 0 { 1e-10 } else { 1e-6 };
        let mut forces = 0.0_f64;
        while reference.state.time < 0.2 {
            reference.step();
            let force = reference.work.contact_force(&reference.state, 0);
            forces = forces.max(force.norm());
            for run in &mut runs {
                run.step();
                let difference = (run.work.contact_force(&run.state, 0) - force).norm();
                assert!(difference <= bounce * forces, "t {}: {difference:e}", run.state.time);
                assert!((run.state.position(0) - reference.state.position(0)).norm() < bounce);
            }
        }
        assert!(
            reference.state.position(0).x > 0.05,
            "it must cross seams, x {}",
            reference.state.position(0).x
        );
    }
}

fn contact_count(vertices: &[[f64; 3]], triangles: &[[u32; 3]], centre: Vec3) -> (usize, Vec3) {
    let mut run = Run::new(on_triangles(vertices, triangles, sphere(centre, Vec3::zeros())));
    run.work.keep_forces(true);
    run.step();
    let contacts = measure::contacts(&run.model, &run.state);
    (contacts.len(), run.work.contact_force(&run.state, 0))
}

#[test]
fn ridge_counts_once_and_valley_twice() {
    let roof = |h: f64| {
        [
            [-0.1, -0.1, 0.0],
            [-0.1, 0.1, 0.0],
            [0.0, 0.1, h],
            [0.0, -0.1, h],
            [0.1, -0.1, 0.0],
            [0.1, 0.1, 0.0],
        ]
    };
    let triangles = [[0, 1, 2], [0, 2, 3], [3, 2, 5], [3, 5, 4]];
    let overlap = 1e-4;
    let (count, force) = contact_count(&roof(0.05), &triangles, Vec3::new(0.0, 0.013, 0.05 + 0.01 - overlap));
    assert_eq!(count, 1);
    assert!((force - Vec3::new(0.0, 0.0, 1e6 * overlap)).norm() < 1e-6, "{force}");

    let slope = (0.05_f64 / 0.1).atan();
    let height = (0.01 - overlap) / slope.cos();
    let (count, force) = contact_count(&roof(-0.05), &triangles, Vec3::new(0.0, 0.013, -0.05 + height));
    assert_eq!(count, 2);
    assert!((force.z - 2.0 * 1e6 * overlap * slope.cos()).abs() < 1e-6 && force.x.abs() < 1e-6, "{force}");
}

#[test]
fn corners_and_diagonals() {
    let base = [[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]];
    let with_tip = |h: f64| [base[0], base[1], base[2], base[3], [0.0, 0.0, h]];
    let sides = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let (count, force) = contact_count(&with_tip(0.1), &sides, Vec3::new(0.0, 0.0, 0.1099));
    assert_eq!(count, 1);
    assert!((force - Vec3::new(0.0, 0.0, 100.0)).norm() < 1e-6, "{force}");
    for centre in [[0.0, 0.0], [0.05, 0.05], [0.03, -0.03], [0.0, 0.05], [0.02, 0.071]] {
        let (count, force) = contact_count(&with_tip(0.0), &sides, Vec3::new(centre[0], centre[1], 0.0099));
        assert_eq!(count, 1, "{centre:?}");
        assert!((force - Vec3::new(0.0, 0.0, 100.0)).norm() < 1e-6, "{force}");
    }
    let room = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    let walls = [[0, 1, 2], [0, 2, 3], [0, 3, 1]];
    let (count, force) = contact_count(&room, &walls, Vec3::repeat(0.0099));
    assert_eq!(count, 3);
    assert!((force - Vec3::repeat(100.0)).norm() < 1e-6, "{force}");
}

#[test]
fn triangle_corner_matches_planes() {
    let n = 8_u32;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    // Right-handed: normals point inwards.
    for (u, v, corner) in [
        (Vec3::x(), Vec3::y(), Vec3::zeros()),
        (Vec3::z(), Vec3::y(), Vec3::x() * 0.1),
        (Vec3::x(), Vec3::z(), Vec3::y() * 0.1),
    ] {
        let first = vertices.len() as u32;
        for k in 0..(n + 1) * (n + 1) {
            let [i, j] = [k % (n + 1), k / (n + 1)].map(|i| 0.1 * f64::from(i) / f64::from(n));
            vertices.push((corner + u * i + v * j).into());
        }
        for k in 0..n * n {
            let a = first + k / n * (n + 1) + k % n;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let body = sphere(Vec3::new(0.031, 0.047, 0.009_999_8), Vec3::new(0.9, 0.6, 0.0));
    let planes = vec![
        plane(Vec3::zeros(), Vec3::z()),
        plane(Vec3::x() * 0.1, -Vec3::x()),
        plane(Vec3::y() * 0.1, -Vec3::y()),
    ];
    let mut reference = heavy(on_planes(planes, body.clone()));
    let mut run = heavy(on_triangles(&vertices, &triangles, body));
    // Rounding grows with each bounce.
    let (mut forces, mut walls, mut worst) = (0.0_f64, [0, 0], 0.0_f64);
    while reference.state.time < 0.3 {
        reference.step();
        run.step();
        let (a, b) =
            (reference.work.contact_force(&reference.state, 0), run.work.contact_force(&run.state, 0));
        forces = forces.max(a.norm());
        worst = worst.max((a - b).norm() / forces);
        let x = reference.state.position(0);
        (0..2).filter(|&d| x[d] > 0.09).for_each(|d| walls[d] += 1);
    }
    println!("largest difference {worst:e}");
    assert!(worst < 1e-7, "{worst:e}");
    assert!(walls.iter().all(|&steps| steps > 10), "both walls are hit");
}

#[test]
fn both_sides_push() {
    let square = [[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]];
    for side in [1.0, -1.0] {
        let centre = Vec3::new(0.01, 0.02, side * 0.0099);
        let (count, force) = contact_count(&square, &[[0, 1, 2], [0, 2, 3]], centre);
        assert_eq!(count, 1);
        assert!((force - Vec3::new(0.0, 0.0, side * 100.0)).norm() < 1e-6, "{force}");
    }
}

/// Over several hundred seams: force to 1e-10 (relative).
#[test]
fn slope_force_matches_plane() {
    let mut random = Random::new(77);
    let (nx, ny, pitch) = (90, 8, 0.0021);
    let tilt = nalgebra::UnitQuaternion::from_euler_angles(0.03, 0.25, 0.4);
    let mut flat = Vec::new();
    for j in 0..=ny {
        for i in 0..=nx {
            let mut shift = || (random.unit() - 0.5) * 0.7 * pitch;
            flat.push(Vec3::new(
                (f64::from(i) - 3.0) * pitch + shift(),
                (f64::from(j) - 0.5 * f64::from(ny)) * pitch + shift(),
                0.0,
            ));
        }
    }
    let vertices: Vec<[f64; 3]> = flat.iter().map(|v| (tilt * v).into()).collect();
    let at = |i: i32, j: i32| (j * (nx + 1) + i) as u32;
    let mut triangles = Vec::new();
    for j in 0..ny {
        for i in 0..nx {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend(if random.unit() < 0.5 {
                [[a, b, c], [c, a, d]]
            } else {
                [[b, a, d], [d, b, c]]
            });
        }
    }
    let normal = tilt * Vec3::z();
    let body = sphere(normal * 0.00999, tilt * Vec3::new(0.6, 0.01, 0.0));
    let prepare = |mut input: ModelInput, exact: bool| {
        input.materials[0] =
            Material { stiffness: 1e4, friction: 0.4, tangential_damping_ratio: 0.2, ..stone() };
        input.gravity = Vec3::new(0.0, 0.0, -9.81);
        if exact {
            input.triangles.clear();
            input.planes.push(plane(Vec3::zeros(), normal));
        }
        Run::new(input)
    };
    let mut plane_run = prepare(on_triangles(&vertices, &triangles, body.clone()), true);
    let mut mesh_run = prepare(on_triangles(&vertices, &triangles, body), false);
    let (mut worst, mut touching, mut seams) = (0.0_f64, 0, 0);
    while plane_run.state.time < 0.2 {
        plane_run.step();
        mesh_run.step();
        let force = plane_run.work.contact_force(&plane_run.state, 0);
        let other = mesh_run.work.contact_force(&mesh_run.state, 0);
        if force.norm() > 0.0 || other.norm() > 0.0 {
            touching += 1;
            worst = worst.max((other - force).norm() / force.norm());
        }
        seams += usize::from(mesh_run.state.wall_contact_count() > 1);
    }
    let way = (mesh_run.state.position(0) - normal * 0.01).norm();
    eprintln!("largest relative difference {worst:e} in {touching} steps with contact, over {way:.3} m");
    assert!(worst < 1e-10 && touching > 1000 && way > 0.1, "{worst:e} {touching} {way}");
    assert_eq!(seams, 0, "never more than one contact");
}

#[test]
fn face_before_edge_beside_a_seam() {
    let square = [[-0.1, -0.1, 0.0], [0.1, -0.1, 0.0], [0.1, 0.1, 0.0], [-0.1, 0.1, 0.0]];
    for (list, side) in [([[0, 1, 2], [0, 2, 3]], -1.0), ([[0, 2, 3], [0, 1, 2]], 1.0)] {
        let off = 3e-9 * side;
        let (count, force) = contact_count(&square, &list, Vec3::new(0.02 + off, 0.02 - off, 0.0099));
        assert_eq!(count, 1);
        assert!(force.xy().norm() < 1e-12 * force.z, "{force}");
    }
}

#[test]
fn finds_slot_in_floor() {
    let plate = |from: f64, to: f64| [[from, -0.1, 0.0], [to, -0.1, 0.0], [to, 0.1, 0.0], [from, 0.1, 0.0]];
    let vertices = [plate(-0.1, 0.0005), plate(0.0025, 0.1)].concat();
    let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let start = Vec3::new(0.0, 0.03, 0.00999);
    let body = BodyInput { velocity: Vec3::new(0.0, 0.0, -10.0), ..sphere(start, Vec3::zeros()) };
    let mut run = heavy(on_triangles(&vertices, &triangles, body));
    let mut seen = [false; 2];
    while run.state.velocity(0).z < 0.0 {
        run.step();
        let x = run.state.position(0);
        let gap = x.z.hypot(x.x - 0.0025);
        let count = measure::contacts(&run.model, &run.state).len();
        let expected = contact_count(&vertices, &triangles, x).0;
        // Contacts precede the last motion.
        if (gap - 0.01).abs() > 1e-4 {
            assert_eq!(count, expected, "{x}");
            seen[count - 1] = true;
        }
    }
    assert_eq!(seen, [true; 2]);
}
