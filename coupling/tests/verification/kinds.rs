//! All face kinds: nodal loads, borders, ripple, and a sphere at rest.

use crate::support::*;
use trackbed_coupling::step;
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::transfer::Transfer;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_dem::surface::{Surface, SurfaceContact};
use trackbed_fem as fem;
use trackbed_fem::{ElementKind, FaceShape, Mesh};

/// Subdivision of a block cell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cut {
    Hexes,
    /// Two wedges.
    Wedges,
    /// Six tetrahedra around the cell diagonal (Kuhn 1960).
    Tets,
    /// Six pyramids with apex at the cell centre.
    Pyramids,
    /// Three pyramids with apex in one top corner; non-conforming.
    Tips,
}

const WEDGES: [&[usize]; 2] = [&[0, 1, 2, 4, 5, 6], &[0, 2, 3, 4, 6, 7]];
const TETS: [&[usize]; 6] =
    [&[0, 1, 2, 6], &[0, 5, 1, 6], &[0, 2, 3, 6], &[0, 3, 7, 6], &[0, 4, 5, 6], &[0, 7, 4, 6]];
const PYRAMIDS: [&[usize]; 6] = [
    &[0, 1, 2, 3, 8],
    &[4, 7, 6, 5, 8],
    &[0, 4, 5, 1, 8],
    &[1, 5, 6, 2, 8],
    &[2, 6, 7, 3, 8],
    &[3, 7, 4, 0, 8],
];
const TIPS: [&[usize]; 3] = [&[0, 1, 2, 3, 6], &[0, 4, 5, 1, 6], &[0, 3, 7, 4, 6]];

fn cut_block(counts: [usize; 3], size: [f64; 3], quadratic: bool, cut: impl Fn(usize) -> Cut) -> Mesh {
    let hexes = Mesh::block(counts, size).to_linear();
    let mut mesh = Mesh { node_ids: hexes.node_ids.clone(), ..Mesh::default() };
    mesh.coordinates = hexes.coordinates.iter().map(|x| [x[0], x[1], x[2] - size[2]]).collect();
    for (cell, corners) in hexes.connectivity.iter().enumerate() {
        let centre = hexes.element_centre(cell);
        let column = (centre[0] / size[0] * counts[0] as f64) as usize;
        let mut nodes = corners.to_vec();
        let (kind, parts): (_, &[&[usize]]) = match cut(column) {
            Cut::Hexes => (ElementKind::Hex8, &[&[0, 1, 2, 3, 4, 5, 6, 7]]),
            Cut::Wedges => (ElementKind::Wedge6, &WEDGES),
            Cut::Tets => (ElementKind::Tet4, &TETS),
            Cut::Tips => (ElementKind::Pyramid5, &TIPS),
            Cut::Pyramids => {
                nodes.push(mesh.coordinates.len() as u32);
                mesh.node_ids.push(mesh.node_ids.iter().max().unwrap() + 1);
                mesh.coordinates.push([centre[0], centre[1], centre[2] - size[2]]);
                (ElementKind::Pyramid5, &PYRAMIDS)
            }
        };
        for part in parts {
            let id = mesh.element_count() as u32 + 1;
            mesh.push_element(id, 1, kind, &part.iter().map(|&k| nodes[k]).collect::<Vec<_>>());
        }
    }
    assert!((0..mesh.element_count()).all(|e| mesh.element_volume(e) > 0.0));
    if quadratic { mesh.to_quadratic() } else { mesh }
}

fn top_of(mesh: &Mesh) -> SolidSurface {
    SolidSurface::new(mesh, SolidSurface::facing(mesh, [0.0, 0.0, 1.0], 0.5))
}

/// All element kinds, single and mixed.
fn all() -> Vec<(String, Mesh)> {
    let mut meshes = Vec::new();
    for quadratic in [true, false] {
        let order = if quadratic { "quadratic" } else { "linear" };
        for kind in [Cut::Hexes, Cut::Wedges, Cut::Tets, Cut::Pyramids, Cut::Tips] {
            let counts = if kind == Cut::Tips { [1, 1, 1] } else { [3, 3, 2] };
            meshes
                .push((format!("{order} {kind:?}"), cut_block(counts, [0.6, 0.6, 0.3], quadratic, |_| kind)));
        }
        let mixed = |x: usize| if x < 2 { Cut::Hexes } else { Cut::Wedges };
        meshes.push((format!("{order} mixture"), cut_block([4, 3, 2], [0.6, 0.6, 0.3], quadratic, mixed)));
    }
    meshes
}

/// Moves top nodes by up to 8 % of an edge.
fn roughen(mesh: &mut Mesh) {
    let mut random = Scatter::new(3);
    for x in mesh.coordinates.iter_mut().filter(|x| x[2] > -1e-9) {
        x.iter_mut().for_each(|c| *c += 0.012 * random.symmetric());
    }
}

#[test]
fn loads_on_every_kind_are_consistent() {
    let mut seen = Vec::new();
    for (name, mut mesh) in all() {
        roughen(&mut mesh);
        let mut surface = top_of(&mesh);
        let mut random = Scatter::new(17);
        let n = 3 * mesh.node_count();
        let rate: Vec<f64> = (0..n).map(|_| random.symmetric()).collect();
        surface.begin_window(&mesh, &vec![0.0; n], &vec![0.0; n], &rate, 1e-9);
        let mut worst = [0.0_f64; 3];
        let patches = surface.faces().len() as u32;
        for k in 0..400 {
            let patch = k % patches;
            let face = surface.faces()[patch as usize];
            seen.push(face.shape);
            // Above the face, some beyond its border.
            let inside = [0.55 * random.symmetric() + 0.45, 0.55 * random.symmetric() + 0.45];
            let (at, normal) = (surface.place(patch, inside), surface.normal(patch, inside));
            let centre = [0, 1, 2].map(|d| at[d] + 0.02 * normal[d]);
            let found = surface.closest_point(patch, centre, [0.0; 2]);
            let force = [30.0 * random.symmetric(), 30.0 * random.symmetric(), -100.0];
            let contact = SurfaceContact {
                sphere: 0,
                body: 0,
                patch,
                local: found.local,
                point: found.point,
                force,
                dashpot: [0.0; 3],
                couple: [0.0; 3],
                overlap: 0.0,
            };
            let mut transfer = Transfer::new(&surface);
            let mut load = vec![0.0; n];
            transfer.add(&surface, &[contact], 1.0, &mut Default::default());
            transfer.add_mean_load(&surface, 1.0, &mut load);
            let moment = |about: [f64; 3], x: [f64; 3], f: [f64; 3]| {
                let r = [0, 1, 2].map(|d| x[d] - about[d]);
                [r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2], r[0] * f[1] - r[1] * f[0]]
            };
            for about in [[0.0; 3], [0.3, -0.2, 0.5], [-1.0, 2.0, 0.1]] {
                let (mut sum, mut turn) = (force, moment(about, found.point, force));
                for (x, f) in mesh.coordinates.iter().zip(load.chunks(3)) {
                    let f = [f[0], f[1], f[2]];
                    let own = moment(about, *x, f);
                    (0..3).for_each(|d| {
                        sum[d] -= f[d];
                        turn[d] -= own[d];
                    });
                }
                worst[0] = sum.iter().fold(worst[0], |m, s| m.max(s.abs() / 100.0));
                worst[1] = turn.iter().fold(worst[1], |m, s| m.max(s.abs() / 100.0));
            }
            let power: f64 = (0..3).map(|d| force[d] * found.velocity[d]).sum();
            let nodal: f64 = load.iter().zip(&rate).map(|(f, v)| f * v).sum();
            worst[2] = worst[2].max((power - nodal).abs() / 100.0);
            for (node, f) in load.chunks(3).enumerate() {
                assert!(f == [0.0; 3] || face.nodes().contains(&(node as u32)), "{name}");
            }
        }
        println!("{name}: force {:.1e}, moment {:.1e}, power {:.1e}", worst[0], worst[1], worst[2]);
        assert!(worst.iter().all(|w| *w < 1e-12), "{name}: {worst:?}");
    }
    for shape in [FaceShape::Quad8, FaceShape::Tri6, FaceShape::Quad4, FaceShape::Tri3] {
        assert!(seen.contains(&shape), "{shape:?}");
    }
}

#[test]
fn pressure_contacts_give_consistent_loads() {
    for (name, mesh) in all() {
        let surface = top_of(&mesh);
        for (k, face) in surface.faces().iter().enumerate() {
            let area = surface.area_vector(k as u32)[2];
            // Constant area on flat faces with straight sides.
            let natural: f64 = face.shape.points().iter().map(|p| p.1).sum();
            let contacts: Vec<SurfaceContact> = face
                .shape
                .points()
                .iter()
                .map(|&(local, weight)| SurfaceContact {
                    sphere: 0,
                    body: 0,
                    patch: k as u32,
                    local,
                    point: surface.place(k as u32, local),
                    force: [0.0, 0.0, -1e4 * area * weight / natural],
                    dashpot: [0.0; 3],
                    couple: [0.0; 3],
                    overlap: 0.0,
                })
                .collect();
            let mut transfer = Transfer::new(&surface);
            let mut load = vec![0.0; 3 * mesh.node_count()];
            transfer.add(&surface, &contacts, 1.0, &mut Default::default());
            transfer.add_mean_load(&surface, 1.0, &mut load);
            let [corner, side] = match face.shape {
                FaceShape::Quad8 => [-1.0 / 12.0, 1.0 / 3.0],
                FaceShape::Tri6 => [0.0, 1.0 / 3.0],
                FaceShape::Quad4 => [0.25, 0.0],
                FaceShape::Tri3 => [1.0 / 3.0, 0.0],
            };
            for (i, &n) in face.nodes().iter().enumerate() {
                let share = -load[3 * n as usize + 2] / (1e4 * area);
                let exact = if i < face.corners().len() { corner } else { side };
                assert!((share - exact).abs() < 1e-13, "{name}: node {i} has {share} of {exact}");
            }
        }
    }
}

/// Drags a heavy sphere, radius 0.05 m, over `surface` with `velocity` [m/s] for `time` [s]; contacts go to
/// `each`.
fn dragged(
    surface: &SolidSurface,
    start: [f64; 3],
    velocity: [f64; 2],
    (friction, time): (f64, f64),
    mut each: impl FnMut(f64, &[SurfaceContact]),
) {
    let dt = 1e-5;
    let model = dem::Model::new(dem::ModelInput {
        materials: vec![material(2650.0, 1e5, friction, 1.0)],
        shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
        bodies: vec![dem::BodyInput {
            position: Vec3::from(start),
            velocity: Vec3::new(velocity[0], velocity[1], 0.0),
            mass: Some(1e15),
            fixed: [true, true, false, true, true, true],
            ..Default::default()
        }],
        gravity: Vec3::zeros(),
        surface_material: Some(0),
        time_step: dem::TimeStep::Fixed(dt),
        ..Default::default()
    })
    .unwrap();
    let mut state = dem::State::new(&model);
    let mut work = dem::Work::new(&model, &state);
    for _ in 0..(time / dt) as usize {
        dem::step(&model, &mut state, &mut work, surface, &[]).unwrap();
        each(state.position(0).x, work.surface_contacts());
    }
}

#[test]
fn flat_borders_do_not_disturb_sphere() {
    let mut meshes: Vec<(String, Mesh)> =
        all().into_iter().filter(|(name, _)| !name.contains("Tips")).collect();
    // 8-node next to 4-node faces with common border corners.
    let linear = cut_block([4, 3, 2], [0.6, 0.6, 0.3], false, |_| Cut::Hexes);
    let quadratic = linear.to_quadratic();
    let mut both = Mesh {
        node_ids: quadratic.node_ids.clone(),
        coordinates: quadratic.coordinates.clone(),
        ..Mesh::default()
    };
    for e in 0..linear.element_count() {
        let left = linear.element_centre(e)[0] < 0.3;
        let (kind, nodes) = match left {
            true => (ElementKind::Hex20, &quadratic.connectivity[e]),
            false => (ElementKind::Hex8, &linear.connectivity[e]),
        };
        both.push_element(e as u32 + 1, 1, kind, nodes);
    }
    meshes.push(("8 nodes beside 4".into(), both));
    for (name, mesh) in meshes {
        let surface = top_of(&mesh);
        let (mut worst, mut slide, mut faces) = (0.0_f64, 0.0_f64, Vec::new());
        for friction in [0.0, 0.5] {
            // At a border both faces count as inside.
            dragged(&surface, [0.11, 0.13, 0.0499], [1.0, 0.83], (friction, 0.38), |x, contacts| {
                assert_eq!(contacts.len(), 1, "{name}: {contacts:?}");
                let [fx, fy, fz] = contacts[0].force;
                worst = worst.max((fz + 10.0).abs() / 10.0);
                faces.push(contacts[0].patch);
                if friction > 0.0 && x > 0.115 {
                    slide = slide.max((fx.hypot(fy) - 5.0).abs() / 5.0);
                }
            });
        }
        faces.dedup();
        println!(
            "{name}: normal force off by {worst:.1e}, sliding force by {slide:.1e}, over {} borders",
            faces.len() - 1
        );
        assert!(faces.len() > 5 && worst < 1e-11 && slide < 1e-9, "{name}: {worst:e}, {slide:e}, {faces:?}");
    }
}

fn kinds_of_block_b(m: usize) -> Vec<(&'static str, fem::Model)> {
    let size = [1.0, 1.0, 0.5];
    let mixed = |x: usize| if x < 4 { Cut::Hexes } else { Cut::Wedges };
    let make = |name: &'static str, quadratic: bool, cut: &dyn Fn(usize) -> Cut| {
        let mesh = cut_block([m, m, m / 2], size, quadratic, cut);
        let damping = fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 };
        (name, model(mesh, size, 20e6, 0.3, 2000.0, Held::Base, damping))
    };
    vec![
        make("hex20", true, &|_| Cut::Hexes),
        make("tet10", true, &|_| Cut::Tets),
        make("wedge15", true, &|_| Cut::Wedges),
        make("pyramid13", true, &|_| Cut::Pyramids),
        make("hex20 and wedge15", true, &mixed),
        make("hex8", false, &|_| Cut::Hexes),
        make("wedge6", false, &|_| Cut::Wedges),
        make("pyramid5", false, &|_| Cut::Pyramids),
        make("tet4", false, &|_| Cut::Tets),
    ]
}

#[test]
fn a_sphere_rests_on_every_kind() {
    let mut reference = None;
    for (name, solid) in kinds_of_block_b(6) {
        let mut vertical = [true; 6];
        vertical[2] = false;
        let mut c = Coupled::new(
            &solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 1e5, 0.0, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
                bodies: vec![dem::BodyInput {
                    position: Vec3::new(0.47, 0.56, 0.05),
                    fixed: vertical,
                    ..Default::default()
                }],
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(4e-5),
                ..Default::default()
            },
            5,
        );
        let weight = c.model.grains.mass(0) * 9.81;
        for _ in 0..2_500 {
            c.step(&[]);
        }
        let contacts = c.work.grains.surface_contacts();
        assert_eq!(contacts.len(), 1, "{name}");
        let force = -contacts[0].force[2];
        let (load, _) = nodal_load(&solid, &c.work.surface, contacts);
        let reaction: f64 =
            fem::energy::reactions(&solid, &c.state.solid, &load).iter().skip(2).step_by(3).sum();
        let rest = fem::statics::solve(&solid, &load).unwrap();
        let deflection = deflection(&c.work.surface, &contacts[0], &rest.u);
        let centre = c.state.grains.position(0);
        let arm = centre - Vec3::from(contacts[0].point);
        let normal = force * arm.norm() / arm.z;
        let gap = centre.z - ((0.05 - normal / 1e5) * arm.z / arm.norm() + deflection);
        let mean = mean_top(&solid, &c.work.surface, &rest.u);
        let reference = *reference.get_or_insert(mean);
        println!(
            "{name}: contact/weight - 1 = {:.1e}, base/weight - 1 = {:.1e}, gap error {:.1e} of the deflection {:.3e} m, \
             mean settlement {:+.2} % of hex20's",
            force / weight - 1.0,
            reaction / weight - 1.0,
            gap / deflection,
            deflection,
            100.0 * (mean / reference - 1.0)
        );
        assert!((force / weight - 1.0).abs() < 1e-6 && (reaction / weight - 1.0).abs() < 1e-6, "{name}");
        assert!((gap / deflection).abs() < 1e-6, "{name}: {gap}");
        let audit = c.state.audit;
        assert!(audit.force < 1e-12 && audit.moment < 1e-12, "{name}: {audit:?}");
        let most = if solid.mesh().connectivity.kind(0).is_linear() { 0.05 } else { 0.005 };
        assert!((mean / reference - 1.0).abs() < most, "{name}: {mean} of {reference}");
    }
}

#[test]
fn sliding_balances_energy_on_every_kind() {
    for (name, solid) in kinds_of_block_b(6) {
        let sphere = |x: f64, y: f64, v: [f64; 2]| dem::BodyInput {
            position: Vec3::new(x, y, 0.05 - 1e-4),
            velocity: Vec3::new(v[0], v[1], 0.0),
            fixed: [false, false, false, true, true, true],
            ..Default::default()
        };
        let mut c = Coupled::new(
            &solid,
            dem::ModelInput {
                materials: vec![material(2650.0, 1e5, 0.1, 0.5)],
                shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
                bodies: vec![
                    sphere(0.25, 0.31, [2.2, 0.3]),
                    sphere(0.61, 0.74, [-0.9, -0.55]),
                    sphere(0.22, 0.55, [1.1, -0.4]),
                ],
                surface_material: Some(0),
                time_step: dem::TimeStep::Fixed(1e-5),
                ..Default::default()
            },
            10,
        );
        let start = step::stored_energy(&c.model, &c.state).total();
        let kinetic = step::stored_energy(&c.model, &c.state).grains_kinetic;
        let mut touched = Vec::new();
        for _ in 0..2_500 {
            c.step(&[]);
            touched.extend(c.work.grains.surface_contacts().iter().filter(|s| s.body == 0).map(|s| s.patch));
        }
        touched.dedup();
        let spent = step::work_and_dissipation(&c.state);
        let end = step::stored_energy(&c.model, &c.state).total();
        let error = (end - start + spent.dissipated() - spent.work()) / kinetic;
        let audit = c.state.audit;
        println!(
            "{name}: account {error:.1e}, interface {:.1e} of {kinetic:.2} J, {} borders, friction {:.2} J",
            spent.interface() / kinetic,
            touched.len() - 1,
            spent.friction
        );
        assert!(touched.len() > 2 && spent.friction > 0.1 * kinetic, "{name}: {touched:?}");
        assert!(error.abs() < 1e-3, "{name}: {error}");
        assert!(audit.force < 1e-12 && audit.moment < 1e-12, "{name}: {audit:?}");
    }
}
