use crate::base::Vec3;
use crate::bodies::input::BodyInput;
use crate::bond::{Bond, BondDamping, BondInput, Criterion, DirectBond, within_gap};
use crate::engine::input::{ModelInput, TimeStep};
use crate::lanes::Simd;
use crate::law::material::Material;
use crate::measure::bond_records;
use crate::shape::Shape;
use crate::spatial::surface::NoSurface;
use crate::{Model, State, Work};

fn cube(strength: f64) -> ModelInput {
    let mut input = ModelInput {
        materials: vec![Material {
            density: 2600.0,
            stiffness: 1e5,
            tangential_ratio: 0.5,
            friction: 0.5,
            restitution: 0.5,
            ..Material::default()
        }],
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        gravity: Vec3::zeros(),
        time_step: TimeStep::Auto { fraction: 0.5 },
        ..ModelInput::default()
    };
    for k in 0..1331_u32 {
        let cell = Vec3::new(f64::from(k % 11), f64::from(k / 11 % 11), f64::from(k / 121));
        let wave = f64::from(k * k % 97) * 0.1;
        input.bodies.push(BodyInput {
            position: cell * 0.0201,
            velocity: Vec3::new(wave.sin(), wave.cos(), (2.0 * wave).sin()) * 0.1,
            spin: Vec3::new(wave.cos(), 0.3, wave.sin()) * 3.0,
            ..BodyInput::default()
        });
    }
    let spheres: Vec<_> = input.bodies.iter().map(|b| (b.position, 0.01)).collect();
    input.bonds = within_gap(&spheres, 1e-3, |_, _| true)
        .iter()
        .enumerate()
        .map(|(k, p)| BondInput::new(p[0], p[1], k % 3))
        .collect();
    assert_eq!(input.bonds.len(), 3 * 11 * 11 * 10);
    // Every third bond may break.
    for strength in [strength, f64::INFINITY, f64::INFINITY] {
        input.bond_kinds.push(Bond::Direct(DirectBond {
            stiffness: [1.5e7, 6e6, 390.0, 310.0],
            strength: [strength; 4],
            criterion: Criterion::Stress,
            damping: BondDamping::Fraction(0.02),
            contact: false,
        }));
    }
    input
}

#[test]
fn scalar_and_simd_match_bitwise() {
    let model = Model::new(cube(20.0)).unwrap();
    let run = |simd: Simd| {
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        work.bonds.simd = simd;
        for _ in 0..150 {
            crate::step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
        }
        let (tension, shear) = state.broken_bonds();
        assert!(tension + shear > 10 && state.bond_count() > 100, "{tension} {shear}");
        let at = |b| [state.position(b), state.velocity(b), state.spin(b)];
        let mut bits: Vec<_> =
            (0..1331).flat_map(at).flat_map(|v| [v.x, v.y, v.z]).map(f64::to_bits).collect();
        bits.push(state.balance.dissipated_bonds.to_bits());
        bits
    };
    assert!(run(Simd::Portable) == run(Simd::best()));
}

#[test]
fn bonds_survive_a_new_order() {
    let model = Model::new(cube(f64::INFINITY)).unwrap();
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    for _ in 0..50 {
        crate::step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
    }
    let forces = |state: &State| {
        let mut f = vec![[Vec3::zeros(); 2]; 1331];
        for r in bond_records(&model, state) {
            f[r.a] = [f[r.a][0] + r.force, f[r.a][1] + r.shear * r.bending];
            f[r.b] = [f[r.b][0] - r.force, f[r.b][1] + r.shear * r.twisting];
        }
        f
    };
    let (before, energy) = (forces(&state), crate::measure::energies(&model, &state).elastic_bonds);
    let places = state.places.clone();
    let positions: Vec<Vec3> = (0..1331).map(|b| state.position(1330 - b).yzx()).collect();
    let all = crate::engine::reordering::BodyChanges::none(&state);
    crate::engine::reordering::reorder(&mut state, &model, &positions, &all);
    assert!(places != state.places);
    let moved = places.iter().zip(&state.places).filter(|(a, b)| a[0] != b[0]).count();
    assert!(moved > 100, "{moved}");
    assert_eq!(state.bond_count(), model.bond_count());
    assert!((crate::measure::energies(&model, &state).elastic_bonds - energy).abs() < 1e-12 * energy);
    for (x, y) in before.iter().zip(&forces(&state)) {
        for (x, y) in x.iter().zip(y) {
            assert!((x - y).norm() < 1e-9 * (1.0 + x.norm()), "{x} {y}");
        }
    }
}
