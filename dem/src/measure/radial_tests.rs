use super::*;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::law::material::Material;
use crate::shape::Shape;
use rand_core::Rng;

fn scene(points: impl Iterator<Item = Vec3>, sides: Option<f64>) -> (Model, State) {
    let input = ModelInput {
        materials: vec![Material { density: 1000.0, stiffness: 1e3, ..Material::RIGID }],
        shapes: vec![Shape::Sphere { radius: 1e-4 }],
        bodies: points.map(|position| BodyInput { position, ..BodyInput::default() }).collect(),
        periodic: [sides.map(|l| [0.0, l]); 3],
        ..ModelInput::default()
    };
    let model = Model::new(input).unwrap();
    let state = State::new(&model);
    (model, state)
}

fn cube(side: f64) -> BoxRegion {
    BoxRegion { low: Vec3::zeros(), high: Vec3::repeat(side) }
}

/// Face-centred cubic, edge 1: 12 neighbours at √½, 6 at 1, 24 at √1.5, 12 at √2, 24 at √2.5 (Conway &
/// Sloane, Sphere Packings, Lattices and Groups, 1988, table 4.5).
#[test]
fn shells_of_a_crystal() {
    const N: usize = 8;
    let lattice = |n: usize| {
        (0..4 * n * n * n).map(move |k| {
            let base = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]][k % 4];
            let cell = [k / 4 % n, k / 4 / n % n, k / 4 / n / n];
            Vec3::from_fn(|d, _| cell[d] as f64 + base[d] + 0.2)
        })
    };
    let (reach, bins) = (1.6, 320);
    let width = reach / bins as f64;
    for (periodic, points) in [(true, 4 * N * N * N), (false, 4 * N * N * N)] {
        let (model, state) = scene(lattice(N), periodic.then_some(N as f64));
        assert_eq!(model.body_count(), points);
        let g = radial_distribution(&model, &state, &cube(N as f64), |_| true, reach, bins).unwrap();
        let mut found = Vec::new();
        for (k, g) in g.iter().enumerate().filter(|(_, g)| **g > 0.0) {
            let r = [k as f64 * width, (k + 1) as f64 * width];
            found.push((r, g * 4.0 * 4.0 / 3.0 * PI * (r[1].powi(3) - r[0].powi(3))));
        }
        let shells = [(0.5_f64, 12.0), (1.0, 6.0), (1.5, 24.0), (2.0, 12.0), (2.5, 24.0)];
        assert_eq!(found.len(), shells.len(), "{found:?}");
        for ((r, n), (square, number)) in found.iter().zip(shells) {
            let slack = 1e-12;
            assert!(r[0] <= square.sqrt() + slack && square.sqrt() - slack <= r[1], "{r:?} {square}");
            assert!((n / number - 1.0).abs() < 1e-9, "periodic {periodic}: {n} at {r:?}");
        }
    }
}

#[test]
fn an_ideal_gas_has_none() {
    let mut random = rand_pcg::Pcg64Mcg::new(5);
    let mut unit = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let points: Vec<Vec3> = (0..12_000).map(|_| Vec3::new(unit(), unit(), unit())).collect();
    let (reach, bins) = (0.15, 15);
    for periodic in [true, false] {
        let (model, state) = scene(points.iter().copied(), periodic.then_some(1.0));
        let counted = |b: usize| !b.is_multiple_of(3);
        let g = radial_distribution(&model, &state, &cube(1.0), counted, reach, bins).unwrap();
        let centres = 8000.0 * if periodic { 1.0 } else { 0.7_f64.powi(3) };
        let width = reach / bins as f64;
        for (k, g) in g.iter().enumerate() {
            let shell = 4.0 / 3.0 * PI * width.powi(3) * ((k + 1).pow(3) - k.pow(3)) as f64;
            let pairs = 0.5 * centres * 8000.0 * shell;
            assert!((g - 1.0).abs() < 4.0 / pairs.sqrt(), "periodic {periodic}, shell {k}: {g}");
        }
    }
}

#[test]
fn nothing_without_room() {
    let (model, state) = scene([Vec3::repeat(0.5), Vec3::repeat(0.6)].into_iter(), Some(1.0));
    let g = |side: f64, reach: f64| radial_distribution(&model, &state, &cube(side), |_| true, reach, 4);
    assert_eq!(g(1.0, 0.51), None);
    assert_eq!(g(0.9, 0.47), None);
    assert!(g(1.0, 0.5).unwrap()[1] > 0.0);
}
