use super::*;
use crate::irregularity::Dip;
use crate::load::{AxleSpread, Pass, Waveform};
use crate::rail::RailInput;
use crate::train::CarLayout;
use nalgebra::Complex;
use std::f64::consts::TAU;

fn vehicle() -> VehicleInput {
    VehicleInput {
        body: [47.8e3, 1.957888e6],
        bogie: [3500.0, 1715.0],
        wheelset: 1800.0,
        primary: [2.4e6, 20e3],
        secondary: [700e3, 40e3],
        wheelbase: 2.5,
        bogie_spacing: 17.5,
        gravity: 9.81,
    }
}

fn hertz(wheel_radius: f64) -> f64 {
    3.86e-8 * wheel_radius.powf(-0.115)
}

struct Line {
    rail: Rail,
    states: Vec<RailState>,
    scratch: Vec<RailScratch>,
    load: CyclicLoad,
    rolling: Rolling,
    state: RollingState,
    wheels: Vec<Vec<Wheel>>,
    time: f64,
}

impl Line {
    fn new(
        rail: RailInput,
        rails: usize,
        share: f64,
        irregularity: Irregularity,
        speed: f64,
        dt: f64,
    ) -> Line {
        let v = vehicle();
        let car = CarLayout { wheelbase: v.wheelbase, bogie_spacing: v.bogie_spacing, car_length: 25.0 };
        let axles = car.axles(1).into_iter().map(|behind| [behind, v.axle_load()]).collect();
        let places: Vec<f64> = (0..rail.sleepers).map(|k| rail.spacing * k as f64).collect();
        let reach = rail.spacing * rail.beyond as f64;
        let ends = [-reach, reach + places[places.len() - 1]];
        let spread = AxleSpread::Beam { ends, taper: 2.0 * rail.spacing };
        let pass = Pass::over(&places, speed, axles, spread, Vec::new());
        let waveform = Waveform::Pass(pass);
        let load = CyclicLoad { waveform, cycles: 2, rest: 0.0, ramp: 0.0, seating: None, places };
        let rail = Rail::new(rail, dt).unwrap();
        let input = RollingInput { vehicle: v, hertz: hertz(0.46), share, irregularity };
        let rolling = Rolling::new(input, &rail, rails, &load).unwrap();
        let (states, scratch) = (vec![rail.laid(); rails], vec![RailScratch::default(); rails]);
        let (state, wheels) = (rolling.standing(), vec![Vec::new(); rails]);
        Line { rail, states, scratch, load, rolling, state, wheels, time: 0.0 }
    }

    fn step(&mut self) {
        self.time += self.rail.dt();
        let lifts = vec![0.0; self.states[0].seats()];
        for (state, scratch) in self.states.iter_mut().zip(&mut self.scratch) {
            self.rail.begin_step(state, lifts.iter().copied(), &lifts, &[], 1.0, scratch);
        }
        let rails = (&self.states[..], &mut self.scratch[..]);
        self.rolling.advance(&mut self.state, &self.load, self.time, &self.rail, rails, &mut self.wheels);
        for ((state, scratch), wheels) in self.states.iter_mut().zip(&mut self.scratch).zip(&self.wheels) {
            self.rail.end_step(state, &lifts, wheels, scratch);
        }
    }
}

/// Track on 40 + 40 sleepers.
fn track() -> RailInput {
    RailInput { beyond: 40, ..crate::rail::tests::input() }
}

fn rigid() -> RailInput {
    RailInput {
        bending: 1e13,
        pad: [1e14, 0.0],
        foundation: [1e14, 0.0],
        beyond: 150,
        elements: 1,
        ..track()
    }
}

#[test]
fn forces_stay_static_on_even_rigid_track() {
    let mut line = Line::new(rigid(), 1, 1.0, Irregularity::default(), 50.0, 2e-4);
    while line.time < 4.0 {
        line.step();
        for k in 0..AXLES {
            let force = line.rolling.axle_force(&line.state, k);
            assert!((force / vehicle().axle_load() - 1.0).abs() < 1e-6, "{} {force}", line.time);
        }
    }
    let record = line.rolling.record(&line.state).unwrap();
    assert!(
        record.axles.iter().all(|a| a.standard_deviation < 1.0 && a.without_contact == 0.0),
        "{record:?}"
    );
}

/// Masses in a row under the wheel: body on bogies on wheelsets on the springs of Hertz, all wheels in phase on
/// waves of the wheelbase.
#[test]
fn wheel_force_on_waves_has_closed_form() {
    for (length, speed) in [(2.5, 30.0), (2.5, 80.0), (1.25, 70.0)] {
        let amplitude = 2e-6;
        let irregularity = Irregularity { waves: vec![[length, amplitude]], ..Irregularity::default() };
        let omega = TAU * speed / length;
        let dt = TAU / omega / 400.0;
        let mut line = Line::new(rigid(), 1, 1.0, irregularity, speed, dt);
        // 30 periods before the first wheel leaves the rail.
        let period = TAU / omega;
        let end = 176.0 / speed;
        let (mut sine, mut cosine) = (0.0, 0.0);
        let begin = end - (20.0 * period / dt).round() * dt;
        while line.time < end - 0.5 * dt {
            line.step();
            if line.time > begin + 0.5 * dt {
                let force = line.rolling.axle_force(&line.state, 0) - vehicle().axle_load();
                let phase = omega * line.time;
                sine += 2.0 * force * phase.sin() / (20.0 * 400.0);
                cosine += 2.0 * force * phase.cos() / (20.0 * 400.0);
            }
        }
        let v = vehicle();
        let spring = |[k, c]: [f64; 2]| Complex::new(k, omega * c);
        let row = |spring: Complex<f64>, end: Complex<f64>| spring * end / (spring + end);
        let mass = |m: f64| Complex::new(-omega * omega * m, 0.0);
        let body = mass(v.body[0] / 4.0);
        let bogie = mass(v.bogie[0] / 2.0) + row(spring(v.secondary) * 0.5, body);
        let wheel = mass(v.wheelset) + row(spring(v.primary), bogie);
        // Two wheels, linear about the static force.
        let load = 0.5 * v.axle_load();
        let contact = 2.0 * 1.5 * load / (hertz(0.46) * load.powf(2.0 / 3.0));
        let expected = amplitude * row(Complex::new(contact, 0.0), wheel).norm();
        let found = sine.hypot(cosine);
        println!("{speed} m/s, waves of {length} m: {found:.2} N, closed form {expected:.2} N");
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
}

/// At the end of a step forces and heights satisfy the law of the contact.
#[test]
fn contact_law_holds_at_the_end_of_a_step() {
    let dip = Dip { at: 0.0, depth: 3e-3, length: 1.0 };
    let irregularity = Irregularity { dips: vec![dip], ..Irregularity::default() };
    for (rails, share) in [(1, 0.5), (2, 1.0)] {
        let mut line = Line::new(track(), rails, share, irregularity.clone(), 60.0, 5e-5);
        let g = hertz(0.46);
        let (mut apart, mut largest) = (0, 0.0_f64);
        while line.time < 0.9 {
            line.step();
            for (axle, place) in line.load.axle_places(line.time).enumerate().filter(|(_, p)| p[1] == 1.0) {
                let rail = line.rail.height(&line.states[0], place[0]) + irregularity.height(place[0]);
                let own = line.rail.own_height() + line.rolling.standing[axle];
                let rest = g * (0.5 * vehicle().axle_load()).powf(2.0 / 3.0) - own;
                let approach = rest + rail - line.state.cars[0].wheelset(axle);
                let expected = 2.0 * (approach.max(0.0) / g).powf(1.5);
                let found = line.rolling.axle_force(&line.state, axle);
                assert!((found - expected).abs() < 1e-6 * vehicle().axle_load(), "{found} {expected}");
                largest = largest.max(found / vehicle().axle_load());
                apart += usize::from(found == 0.0);
            }
            let e = line.states[0].energy();
            assert!(e.error().abs() < 1e-9 * e.elastic.max(10.0), "{}: {e:?}", line.time);
        }
        assert_eq!(line.state.unconverged, 0);
        let record = line.rolling.record(&line.state);
        let warned =
            record.is_some_and(|r| r.warnings().any(|w| w.starts_with("axle 1: without contact for ")));
        assert_eq!(warned, apart > 0, "{apart}");
        println!("joint dipped by 24 mrad at 216 km/h: {largest:.2} of the static load, {apart} steps apart");
        assert!(largest > 1.5, "{largest}");
    }
}

/// Half of a track carries half of the vehicle: the same motion.
#[test]
fn half_a_track_bears_half() {
    let dip = Dip { at: 0.0, depth: 2e-3, length: 1.0 };
    let irregularity = Irregularity { dips: vec![dip], ..Irregularity::default() };
    let record = |rails, share| {
        let mut line = Line::new(track(), rails, share, irregularity.clone(), 60.0, 1e-4);
        while line.time < 0.9 {
            line.step();
        }
        line.rolling.record(&line.state).unwrap()
    };
    let (half, whole) = (record(1, 0.5), record(2, 1.0));
    for (a, b) in half.axles.iter().zip(&whole.axles) {
        assert!((a.largest_force / b.largest_force - 1.0).abs() < 1e-8, "{a:?} {b:?}");
        assert!((a.mean_force / half.static_force - 1.0).abs() < 0.01, "{a:?}");
    }
    assert!((half.body_acceleration_rms / whole.body_acceleration_rms - 1.0).abs() < 1e-6);
}

/// Wheels enter and leave a flexible rail without a jerk: the peak in the taper is near the static force.
#[test]
fn wheels_enter_and_leave_softly() {
    let mut line = Line::new(track(), 1, 0.5, Irregularity::default(), 60.0, 1e-4);
    let mut range = [f64::INFINITY, 0.0_f64];
    while line.time < 1.1 {
        line.step();
        let over = line.rolling.axle_force(&line.state, 0) / vehicle().axle_load();
        range = [range[0].min(over), range[1].max(over)];
    }
    println!("first axle over the whole pass: {range:.3?} of the static load");
    assert!(range[0] > 0.8 && range[1] < 1.2, "{range:?}");
}
