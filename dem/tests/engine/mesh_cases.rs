//! Sphere–mesh contacts in 20,000 random cases, against an independent oracle.
//!
//! The oracle keeps critical points of the distance to faces, edges and vertices that are local minima for
//! the union. Coincident points count once. Of contacts with normals within ten degrees (smooth seams) the
//! deepest counts.

use crate::scene::{Random, Run, sphere, stone, weightless};
use trackbed_dem::{Material, TriangleSurface, Vec3};

const RADIUS: f64 = 0.01;
const STIFFNESS: f64 = 1e6;

struct Mesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
}

/// Whether the distance from `x` does not fall from `p` along triangle `t`, or `p` is outside it.
fn resists(t: &[Vec3; 3], p: &Vec3, x: &Vec3) -> bool {
    let eps = 1e-9;
    let normal = (t[1] - t[0]).cross(&(t[2] - t[0])).normalize();
    if (p - t[0]).dot(&normal).abs() > eps * RADIUS {
        return true;
    }
    // Sides that p lies on.
    let mut inward = Vec::new();
    for k in 0..3 {
        let (a, b) = (t[k], t[(k + 1) % 3]);
        let into = normal.cross(&(b - a)).normalize();
        let depth = (p - a).dot(&into);
        if depth < -eps * RADIUS {
            return true;
        }
        if depth < eps * RADIUS {
            inward.push((into, (b - a).normalize()));
        }
    }
    // Rate along a unit direction u: (p − x)·u/|p − x|.
    let fall = |u: &Vec3| (p - x).dot(u) / (p - x).norm() < -1e-9;
    match inward.as_slice() {
        [] => {
            let flat = (x - p) - normal * (x - p).dot(&normal);
            flat.norm() < 1e-9 * (x - p).norm()
        }
        [(into, along)] => !fall(into) && !fall(along) && !fall(&-along),
        _ => {
            let k = (0..3).min_by(|&i, &j| (t[i] - p).norm().total_cmp(&(t[j] - p).norm())).unwrap();
            let (u, v) = ((t[(k + 1) % 3] - t[k]).normalize(), (t[(k + 2) % 3] - t[k]).normalize());
            // Inside the wedge it may fall faster than along its edges: project the gradient.
            let pull = (x - p) - normal * (x - p).dot(&normal);
            let inside = pull.norm() > 1e-9 * (x - p).norm()
                && normal.cross(&u).dot(&pull) * normal.cross(&u).dot(&v) >= 0.0
                && normal.cross(&v).dot(&pull) * normal.cross(&v).dot(&u) >= 0.0
                && pull.dot(&(u + v)) > 0.0;
            !fall(&u) && !fall(&v) && !inside
        }
    }
}

fn oracle(mesh: &Mesh, x: &Vec3) -> Vec<(f64, Vec3)> {
    let corners: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|t| t.map(|v| mesh.vertices[v])).collect();
    let mut points: Vec<Vec3> = Vec::new();
    for t in &corners {
        let normal = (t[1] - t[0]).cross(&(t[2] - t[0])).normalize();
        let foot = x - normal * (x - t[0]).dot(&normal);
        let inside = (0..3).all(|k| normal.cross(&(t[(k + 1) % 3] - t[k])).dot(&(foot - t[k])) > 0.0);
        if inside {
            points.push(foot);
        }
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let s = (x - a).dot(&(b - a)) / (b - a).norm_squared();
            if s > 0.0 && s < 1.0 {
                points.push(a + (b - a) * s);
            }
            points.push(a);
        }
    }
    let mut found: Vec<(f64, Vec3, Vec3)> = Vec::new();
    for p in points {
        let distance = (x - p).norm();
        if distance < RADIUS
            && found.iter().all(|f| (f.2 - p).norm() > 1e-8 * RADIUS)
            && corners.iter().all(|t| resists(t, &p, x))
        {
            found.push((RADIUS - distance, (x - p) / distance, p));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<(f64, Vec3)> = Vec::new();
    for (overlap, normal, _) in found {
        if kept.iter().all(|k| k.1.dot(&normal) <= 10.0_f64.to_radians().cos()) {
            kept.push((overlap, normal));
        }
    }
    kept
}

fn mesh(kind: usize, random: &mut Random) -> Mesh {
    let size = RADIUS * (0.3 + 2.0 * random.unit());
    let fan = |apex: Vec3, rim: &[Vec3], closed: bool| {
        let mut vertices = vec![apex];
        vertices.extend(rim);
        let n = rim.len();
        let last = if closed { n } else { n - 1 };
        let triangles = (0..last).map(|k| [0, 1 + k, 1 + (k + 1) % n]).collect();
        Mesh { vertices, triangles }
    };
    let ring = |n: usize, random: &mut Random, height: f64| -> Vec<Vec3> {
        let start = random.unit();
        (0..n)
            .map(|k| {
                let angle = (k as f64 + start + 0.3 * random.unit()) / n as f64 * std::f64::consts::TAU;
                let r = size * (0.5 + random.unit());
                Vec3::new(r * angle.cos(), r * angle.sin(), height * size * (0.8 + 0.4 * random.unit()))
            })
            .collect()
    };
    match kind {
        0 => Mesh { vertices: (0..3).map(|_| random.vector() * size).collect(), triangles: vec![[0, 1, 2]] },
        1 => Mesh {
            vertices: (0..4).map(|_| random.vector() * size).collect(),
            triangles: vec![[0, 1, 2], [1, 0, 3]],
        },
        2 => fan(Vec3::zeros(), &ring(5 + (random.unit() * 4.0) as usize, random, 0.0), true),
        3 => {
            let steep = (random.unit() - 0.5) * 2.0;
            fan(Vec3::zeros(), &ring(3 + (random.unit() * 5.0) as usize, random, steep), true)
        }
        4 => {
            let mut rim = ring(6, random, 0.0);
            rim.iter_mut().enumerate().for_each(|(k, v)| v.z = if k % 2 == 0 { 0.3 } else { -0.3 } * size);
            fan(Vec3::zeros(), &rim, true)
        }
        5 => Mesh {
            vertices: (0..4).map(|_| random.vector() * size).collect(),
            triangles: vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]],
        },
        _ => {
            let vertices: Vec<Vec3> = (0..7).map(|_| random.vector() * size).collect();
            let mut triangles = Vec::new();
            while triangles.len() < 5 {
                let pick = [0; 3].map(|_| (random.unit() * 7.0) as usize);
                if pick[0] != pick[1] && pick[1] != pick[2] && pick[2] != pick[0] {
                    triangles.push(pick);
                }
            }
            Mesh { vertices, triangles }
        }
    }
}

#[test]
fn twenty_thousand_spheres_against_meshes() {
    let mut random = Random::new(2026);
    let (mut cases, mut touching, mut wrong) = (0, [0_usize; 4], 0);
    let mut of_kind = [0_usize; 7];
    while cases < 20_000 {
        let kind = cases % 7;
        let m = mesh(kind, &mut random);
        let flat = m.triangles.iter().any(|t| {
            let [a, b, c] = t.map(|v| m.vertices[v]);
            (b - a).cross(&(c - a)).norm() < 1e-3 * RADIUS * RADIUS
        });
        if flat {
            continue;
        }
        let t = m.triangles[(random.unit() * m.triangles.len() as f64) as usize].map(|v| m.vertices[v]);
        let weights = match cases % 3 {
            0 => [random.unit(), random.unit(), random.unit()],
            1 => [random.unit(), random.unit(), 0.0],
            _ => [1.0, 0.0, 0.0],
        };
        let at = (t[0] * weights[0] + t[1] * weights[1] + t[2] * weights[2]) / weights.iter().sum::<f64>();
        let way = random.vector();
        let x = at + way.normalize() * RADIUS * (0.4 + 0.7 * random.unit());
        let expected = oracle(&m, &x);
        cases += 1;
        of_kind[kind] += 1;

        let mut input = weightless(Material { stiffness: STIFFNESS, restitution: 1.0, ..stone() });
        input.triangles.push(TriangleSurface {
            vertices: m.vertices.clone(),
            triangles: m.triangles.iter().map(|t| t.map(|v| v as u32)).collect(),
            ..TriangleSurface::default()
        });
        input.bodies.push(sphere(x, Vec3::zeros()));
        let mut run = Run::new(input);
        trackbed_dem::find_contacts(
            &run.model,
            &mut run.state,
            &mut run.work,
            &trackbed_dem::surface::NoSurface,
        )
        .unwrap();
        let force = run.work.contact_force(&run.state, 0);
        let count = run.state.wall_contact_count();
        let sum: Vec3 = expected.iter().map(|(d, n)| n * (d * STIFFNESS)).sum();
        touching[expected.len().min(3)] += 1;
        if count != expected.len() || (force - sum).norm() > 1e-6 * STIFFNESS * RADIUS {
            wrong += 1;
            if wrong <= 5 {
                eprintln!(
                    "case {cases} kind {kind}: {count} against {expected:?}, force {force} against {sum}"
                );
            }
        }
    }
    eprintln!("{cases} cases, {touching:?} with 0, 1, 2, more contacts; by kind {of_kind:?}; {wrong} wrong");
    assert_eq!(wrong, 0);
    assert!(touching.iter().all(|&n| n > 300), "{touching:?}");
}
