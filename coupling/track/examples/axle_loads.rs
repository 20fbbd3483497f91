//! Axle forces on a sleeper: Winkler's formula, and a rail on pads (static).

use trackbed_track::CyclicLoad;
use trackbed_track::influence::Winkler;
use trackbed_track::load::{AxleSpread, Pass, Waveform};
use trackbed_track::rail::{Rail, RailInput, Wheel};
use trackbed_track::train::CarLayout;

fn main() {
    let (bending, spacing, pad, bed) = (6.4e6, 0.6, 120e6, 40e6);
    let winkler = Winkler::new(bending, pad * bed / (pad + bed), spacing);
    let car = CarLayout { wheelbase: 2.5, bogie_spacing: 17.5, car_length: 25.0 };
    let axles: Vec<[f64; 2]> = car.axles(1).into_iter().map(|behind| [behind, 70e3]).collect();
    let spread = AxleSpread::Winkler(winkler);
    let pass = Pass::over(&[0.0], 20.0, axles, spread, Vec::new());
    let waveform = Waveform::Pass(pass);
    let load = CyclicLoad { waveform, cycles: 1, rest: 0.0, ramp: 0.0, seating: None, places: vec![0.0] };
    for k in 0..=20 {
        let t = load.end() * f64::from(k) / 20.0;
        println!("t = {t:.3} s: {:6.2} kN on the sleeper", 1e-3 * load.on(0, t));
    }
    let peak = (0..=2000).map(|k| load.on(0, load.end() * f64::from(k) / 2000.0)).fold(0.0, f64::max);

    let (gravity, mass, sleeper_mass) = (0.0, 60.0, 160.0);
    let (pad, foundation) = ([pad, 0.0], [bed, 0.0]);
    let (elements, sleepers, beyond) = (4, 1, 30);
    let input = RailInput {
        elements,
        spacing,
        bending,
        mass,
        pad,
        gravity,
        sleepers,
        beyond,
        sleeper_mass,
        foundation,
    };
    let rail = Rail::new(input, 1e-4).expect("constants above 0 make a rail");
    let wheels = [0.0, 2.5].map(|at| Wheel { at, force: 70e3 }).to_vec();
    let forces = rail.static_seats([wheels].into_iter()).expect("constants above 0 make a rail");
    println!("largest force {:.2} kN, by the rail on pads {:.2} kN", 1e-3 * peak, 1e-3 * forces[0][0]);
    assert!((peak / forces[0][0] - 1.0).abs() < 0.02, "discrete sleepers differ by a hundredth");
}
