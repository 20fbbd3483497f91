//! Half-sine cycles of a rigid sleeper on a bed on block B: restart, unloading, ratio of time steps.

use crate::support::*;
use trackbed_coupling::step::State;
use trackbed_dem as dem;
use trackbed_dem::Vec3;
use trackbed_fem as fem;

const SLEEPER: usize = 0;
const PEAK: f64 = 2000.0;
/// Cycle duration [s].
const CYCLE: f64 = 0.05;
const SETTLING: f64 = 0.6;

fn ground() -> fem::Model {
    block_b(4, Held::Base, fem::Rayleigh { alpha_m: 400.0, beta_k: 1e-3 })
}

fn bed(dt: f64) -> dem::ModelInput {
    sleeper_on_a_bed(3, dt)
}

/// Half-sine pulses after deposition.
fn load(time: f64) -> f64 {
    if time < SETTLING { 0.0 } else { PEAK * (std::f64::consts::PI * (time - SETTLING) / CYCLE).sin().abs() }
}

/// Sleeper height and total nodal load per window.
type Record = Vec<[f64; 2]>;

/// Checks nodal loads against contact forces in every window.
fn advance(c: &mut Coupled, end: f64, worst: &mut f64) -> Record {
    let window = c.model.window();
    let steps = ((end - c.state.solid.time) / window).round() as usize;
    let mut record = Vec::with_capacity(steps);
    for _ in 0..steps {
        c.step(&[(SLEEPER, [0.0, 0.0, -load(c.state.solid.time)])]);
        let nodal: f64 = c.work.load().iter().skip(2).step_by(3).sum();
        let contact = c.work.mean_contact_force(window)[2];
        *worst = worst.max((nodal - contact).abs() / contact.abs().max(1.0));
        record.push([c.state.grains.position(SLEEPER).z, nodal]);
    }
    record
}

fn deepest(solid: &fem::State) -> f64 {
    solid.u.iter().fold(0.0, |m, u| m.max(u.abs()))
}

/// Block force equals grain forces within 1e-10 per step. The unloaded block returns within 1e-9 of its
/// largest displacement.
fn cycles(cycles: u32) {
    let solid = ground();
    let mut c = Coupled::new(&solid, bed(5e-5), 5);
    let mut worst = 0.0;
    advance(&mut c, SETTLING, &mut worst);
    let half = SETTLING + f64::from(cycles / 2) * CYCLE;
    let end = SETTLING + f64::from(cycles) * CYCLE;
    advance(&mut c, half, &mut worst);
    let saved = postcard::to_stdvec(&c.state).expect("a state can be written");
    let record = advance(&mut c, end, &mut worst);
    println!(
        "{cycles} cycles: nodal loads less contact forces {worst:.1e}, audit {:?}, sleeper {:.5} to {:.5} m",
        c.state.audit,
        record[0][0],
        record[record.len() - 1][0]
    );
    assert!(worst < 1e-10 && c.state.audit.force < 1e-10 && c.state.audit.moment < 1e-10);

    let mut again = Coupled::new(&solid, bed(5e-5), 5);
    again.state = postcard::from_bytes::<State>(&saved).expect("a state can be read");
    again.work =
        trackbed_coupling::step::Work::new(&again.model, &again.state, top(&solid)).expect("a factor");
    let repeated = advance(&mut again, end, &mut worst);
    let bits = |r: &Record| r.iter().map(|x| x.map(f64::to_bits)).collect::<Vec<_>>();
    assert!(!record.is_empty() && bits(&record) == bits(&repeated), "the record after a restart differs");

    // Under the last peak, and without bed.
    let peak = deepest(&c.state.solid);
    let away = dem::ModelInput {
        bodies: vec![dem::BodyInput {
            position: Vec3::new(0.5, 0.5, 5.0),
            fixed: [true; 6],
            ..Default::default()
        }],
        ..bed(5e-5)
    };
    let mut alone = Coupled::new(&solid, away, 5);
    alone.state.solid = c.state.solid.clone();
    for _ in 0..3000 {
        alone.step(&[]);
    }
    let left = deepest(&alone.state.solid) / peak;
    println!("displacement {peak:.3e} m under the bed, {left:.1e} of it with the bed lifted off");
    assert!(peak > 1e-5 && left < 1e-9);
}

fn on_one_thread(run: impl FnOnce() + Send) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool").install(run);
}

#[test]
#[ignore = "20 cycles, about 15 s"]
fn twenty_cycles_with_restart() {
    on_one_thread(|| cycles(20));
}

#[test]
fn four_cycles_with_restart() {
    on_one_thread(|| cycles(4));
}

#[test]
#[ignore = "2,500 solid steps at ratio 1, about 5 s"]
fn the_ratio_of_time_steps() {
    let solid = ground();
    let mut c = Coupled::new(&solid, bed(2e-5), 10);
    advance(&mut c, SETTLING, &mut 0.0);
    let settled = postcard::to_stdvec(&c.state).expect("a state can be written");
    let start = c.state.grains.position(SLEEPER).z;
    let mut peaks = Vec::new();
    for ratio in [1, 10, 100] {
        let mut c = Coupled::new(&solid, bed(2e-5), ratio);
        c.state = postcard::from_bytes::<State>(&settled).expect("a state can be read");
        c.work = trackbed_coupling::step::Work::new(&c.model, &c.state, top(&solid)).expect("a factor");
        let record = advance(&mut c, SETTLING + CYCLE, &mut 0.0);
        let peak = start - record.iter().map(|r| r[0]).fold(f64::INFINITY, f64::min);
        println!("ratio {ratio}: largest settlement {peak:.6e} m");
        peaks.push(peak);
    }
    println!(
        "ratio 10: {:+.3} %, ratio 100: {:+.3} %",
        100.0 * (peaks[1] / peaks[0] - 1.0),
        100.0 * (peaks[2] / peaks[0] - 1.0)
    );
    assert!(peaks[0] > 1e-4 && (peaks[1] / peaks[0] - 1.0).abs() < 0.01);
}
