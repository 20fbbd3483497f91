//! Dilated polyhedra on triangulated faces of the solid.

use crate::support::*;
use trackbed_coupling::energy_balance::EnergyBalance;
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::step;
use trackbed_coupling::surface::{SolidSurface, face_triangles};
use trackbed_dem as dem;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{Shape, Vec3};
use trackbed_fem as fem;

fn triangles(solid: &fem::Model) -> SolidSurface {
    let faces = SolidSurface::facing(solid.mesh(), [0.0, 0.0, 1.0], 0.3);
    SolidSurface::new(solid.mesh(), faces.iter().flat_map(face_triangles).collect())
}

fn polyhedron(corners: &[Vec3], radius: f64) -> Shape {
    Shape::Polyhedron(Box::new(Dilated::new(corners, radius).expect("a convex body").0))
}

/// 14 corners on an ellipsoid, 0.2 m long, edges rounded by 6 mm.
fn stone(seed: u64) -> Shape {
    let mut random = Scatter::new(seed);
    let mut corner = || {
        let way = Vec3::from_fn(|_, _| random.symmetric()).normalize();
        way.component_mul(&Vec3::new(0.1, 0.08, 0.06))
    };
    polyhedron(&(0..14).map(|_| corner()).collect::<Vec<_>>(), 0.006)
}

fn on_surface(surface: &SolidSurface, material: dem::Material, shapes: Vec<Shape>) -> dem::ModelInput {
    dem::ModelInput {
        materials: vec![material],
        shapes,
        surface_material: Some(0),
        surface_mesh: surface.triangles().map(Into::into),
        time_step: dem::TimeStep::Auto { fraction: 0.5 },
        ..Default::default()
    }
}

fn coupled<'a>(solid: &'a fem::Model, grains: dem::ModelInput, substeps: u32) -> Coupled<'a> {
    Coupled::with_surface(solid, grains, substeps, triangles(solid))
}

#[test]
fn stone_weight_acts_on_base() {
    weight_acts_on_base(&[(2, [0.37, 0.61])]);
}

#[test]
#[ignore = "minutes"]
fn weight_of_each_stone_acts_on_base() {
    weight_acts_on_base(&[(0, [0.45, 0.55]), (1, [0.25, 0.5])]);
}

/// Stones by seed and place.
fn weight_acts_on_base(stones: &[(u64, [f64; 2])]) {
    for &(seed, place) in stones {
        let solid = block_b(4, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 });
        let surface = triangles(&solid);
        let rock = dem::Material { tangential_damping_ratio: 1.0, ..material(2650.0, 2e5, 0.6, 0.2) };
        let mut input = on_surface(&surface, rock, vec![stone(seed)]);
        input.bodies =
            vec![dem::BodyInput { position: Vec3::new(place[0], place[1], 0.11), ..Default::default() }];
        let mut c = coupled(&solid, input, 2);
        let mass = c.model.grains.mass(0);
        let start = (step::stored_energy(&c.model, &c.state), step::work_and_dissipation(&c.state));
        while c.state.grains.time < 1.6 {
            c.step(&[]);
        }
        let contacts = c.work.grains.surface_contacts();
        let force: f64 = contacts.iter().map(|c| -c.force[2]).sum();
        let (load, _) = nodal_load(&solid, &c.work.surface, contacts);
        let reaction: f64 =
            fem::energy::reactions(&solid, &c.state.solid, &load).iter().skip(2).step_by(3).sum();
        let audit = c.state.audit;
        let balance = EnergyBalance {
            start: start.0,
            now: step::stored_energy(&c.model, &c.state),
            spent: step::work_and_dissipation(&c.state),
            ..EnergyBalance::default()
        };
        let weight = 9.81 * mass;
        println!(
            "{place:?}: {} points; contact/weight - 1 = {:.1e}, base/weight - 1 = {:.1e}, force and moment errors {:.1e}, {:.1e}, \
             energy {:.1e}, speed {:.1e} m/s",
            contacts.len(),
            force / weight - 1.0,
            reaction / weight - 1.0,
            audit.force,
            audit.moment,
            balance.error() / balance.reference_energy(),
            c.state.grains.velocity(0).norm(),
        );
        assert!((force / weight - 1.0).abs() < 1e-8);
        assert!((reaction / weight - 1.0).abs() < 1e-8);
        assert!(audit.exchanges > 1000 && audit.force < 1e-12 && audit.moment < 1e-12, "{audit:?}");
        assert!(balance.error().abs() < 1e-3 * balance.reference_energy(), "{balance:?}");
    }
}

#[test]
fn a_rigid_block_is_a_plane() {
    for (friction, restitution, bound) in [(0.0, 1.0, 1e-8), (0.0, 0.4, 1e-2), (0.5, 0.4, 1e-2)] {
        let rayleigh = fem::Rayleigh::default();
        let solid = block([4, 4, 2], [1.0, 1.0, 0.5], 1e16, 0.3, 2000.0, Held::Base, rayleigh);
        let surface = triangles(&solid);
        let rock = material(2650.0, 1e6, friction, restitution);
        let mut input = on_surface(&surface, rock, vec![stone(5)]);
        input.bodies = vec![dem::BodyInput {
            position: Vec3::new(0.4, 0.45, 0.13),
            velocity: Vec3::new(0.4, 0.1, -0.5),
            spin: Vec3::new(1.0, -2.0, 0.5),
            ..Default::default()
        }];
        let mut c = coupled(&solid, input.clone(), 1);
        let plane =
            dem::Plane { point: Vec3::zeros(), normal: Vec3::z(), material: 0, velocity: Vec3::zeros() };
        let alone =
            dem::ModelInput { planes: vec![plane], surface_material: None, surface_mesh: None, ..input };
        let model = dem::Model::new(alone).expect("a valid model");
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        let mut apart = 0.0_f64;
        while state.time < 0.25 {
            c.step(&[]);
            dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a step");
            apart = apart.max((c.state.grains.position(0) - state.position(0)).norm());
        }
        println!("friction {friction}, e = {restitution}: apart by {:.1e} of the size", apart / 0.2);
        assert!((c.state.grains.time / state.time - 1.0).abs() < 1e-9);
        assert!(apart < bound * 0.2, "{apart}");
        let moved = (state.position(0) - Vec3::new(0.4, 0.45, 0.13)).norm();
        assert!(moved > 0.05, "{moved}");
    }
}

#[test]
fn jumping_stones_conserve_energy() {
    let rayleigh = fem::Rayleigh::default();
    let solid = block([2, 2, 1], [1.0, 1.0, 0.5], 20e6, 0.3, 2000.0, Held::BaseAndSides, rayleigh);
    let surface = triangles(&solid);
    let shapes: Vec<Shape> = (0..2).map(stone).collect();
    let mut input = on_surface(&surface, material(2650.0, 5e5, 0.0, 1.0), shapes);
    input.time_step = dem::TimeStep::Auto { fraction: 0.03 };
    input.bodies = (0..2)
        .map(|k| dem::BodyInput {
            shape: k,
            position: Vec3::new(0.25 + 0.5 * k as f64, 0.4, 0.2),
            spin: Vec3::new(3.0, 1.0 - k as f64, 0.0),
            ..Default::default()
        })
        .collect();
    let mut c = coupled(&solid, input, 2);
    c.model.scheme = Scheme::Iterated { tolerance: 1e-9, passes: 40 };
    let start = step::stored_energy(&c.model, &c.state);
    let mut worst = 0.0_f64;
    while c.state.grains.time < 0.25 {
        c.step(&[]);
        let (now, spent) = (step::stored_energy(&c.model, &c.state), step::work_and_dissipation(&c.state));
        let fall = start.total() - now.grains_gravity;
        worst = worst.max(
            EnergyBalance { start, now, spent, ..EnergyBalance::default() }.error().abs()
                / fall.max(0.05 * start.total().abs()),
        );
    }
    let shaken = step::stored_energy(&c.model, &c.state);
    let interface = step::work_and_dissipation(&c.state).interface() / start.total();
    println!(
        "account within {worst:.1e}, interface {interface:.1e}; solid {:.2e} J of {:.2e} J",
        shaken.solid_kinetic + shaken.solid_strain,
        start.total()
    );
    assert!(worst < 1e-3 && interface.abs() < 1e-9, "{worst} {interface}");
    assert!(shaken.solid_kinetic + shaken.solid_strain > 1e-3 * start.total());
    assert!(c.state.audit.force < 1e-12 && c.state.audit.moment < 1e-12, "{:?}", c.state.audit);
}
