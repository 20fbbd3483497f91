use super::*;
use crate::cycles::BedColumn;
use crate::load::{CyclicLoad, Waveform};
use crate::system::GrainsView;
use dem::Vec3;

const PLAN: CycleJumpOptions = CycleJumpOptions {
    grains: true,
    first: 12,
    measure: 5,
    settle: 3,
    tolerance: 1e-3,
    largest: 1.0,
    overlap: 2.0,
};

/// Grains displaced by jumps only.
struct Grains {
    model: dem::Model,
    state: dem::State,
}

impl TrackSystem for Grains {
    fn window(&self) -> f64 {
        self.model.dt()
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model, state: &self.state })
    }

    fn relocate(&mut self, moves: &[(usize, Vec3, UnitQuaternion<f64>)]) {
        moves.iter().for_each(|(body, shift, turn)| self.state.shift(&self.model, *body, shift, turn));
        self.state.request_search();
    }
}

/// A sphere indenting a corner by 1 mm, and a rattler.
fn corner() -> Grains {
    let wall =
        |normal: Vec3| dem::Plane { point: Vec3::zeros(), normal, material: 0, velocity: Vec3::zeros() };
    let at = |x: f64| dem::BodyInput { position: Vec3::repeat(x), ..Default::default() };
    let input = dem::ModelInput {
        materials: vec![dem::Material { density: 2650.0, stiffness: 1e6, ..Default::default() }],
        shapes: vec![dem::Shape::Sphere { radius: 0.05 }],
        bodies: vec![at(0.049), at(1.0)],
        planes: vec![wall(Vec3::x()), wall(Vec3::y()), wall(Vec3::z())],
        gravity: Vec3::zeros(),
        time_step: dem::TimeStep::Fixed(1e-6),
        ..Default::default()
    };
    let model = dem::Model::new(input).unwrap();
    let mut state = dem::State::new(&model);
    let mut work = dem::Work::new(&model, &state);
    dem::find_contacts(&model, &mut state, &mut work, &dem::surface::NoSurface).unwrap();
    Grains { model, state }
}

/// Both spheres follow a sleeper with settlement `law`.
fn jumps_of(plan: &CycleJumpOptions, cycles: u32, law: impl Fn(f64) -> f64) -> (CycleJumper, Vec<[f64; 4]>) {
    let wave = Waveform::Wave { sine: false, minimum: 0.0, maximum: 1.0, frequency: 1.0 };
    let load =
        CyclicLoad { waveform: wave, cycles: 10_000, rest: 0.0, ramp: 0.0, seating: None, places: vec![0.0] };
    let mut recorder = CycleRecorder::new(&load, [0.2, 0.8], BedColumn::default());
    let (mut system, mut jumper) = (corner(), CycleJumper::new(plan));
    let mut settled = 0.0;
    let mut jumps = Vec::new();
    recorder.record(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
    for k in 1..=cycles {
        // Without displacement the bed is as old as its simulated cycles.
        let now = law(f64::from(if plan.grains { recorder.number() + 1 } else { k }));
        let down = (Vec3::new(0.0, 0.0, settled - now), UnitQuaternion::identity());
        system.relocate(&[(0, down.0, down.1), (1, down.0, down.1)]);
        settled = now;
        recorder.record(f64::from(k), 1.0, -now, 1.0, 0.0, 0.0).expect("a cycle");
        let (number, before) = (recorder.number(), [0, 1].map(|b| system.state.position(b).z));
        if jumper.after_cycle(plan, &mut recorder, &mut system) {
            let way = [0, 1].map(|b| before[b] - system.state.position(b).z);
            jumps.push([number.into(), (recorder.number() - number).into(), way[0], way[1]]);
            settled += way[0];
        }
    }
    (jumper, jumps)
}

/// For s = b ln N each jump displaces the sphere by b ln(1 + ΔN/N).
#[test]
fn jumps_of_grains_follow_the_logarithm() {
    let b = 1e-6;
    let (jumper, jumps) = jumps_of(&PLAN, 40, |n| b * n.ln());
    assert!(jumps.len() >= 3, "{jumps:?}");
    for ([number, skipped, way, rattler], share) in jumps.iter().zip([0.25, 0.5, 1.0]) {
        assert_eq!(*skipped, (share * number).floor(), "{jumps:?}");
        let expected = b * (1.0 + skipped / number).ln();
        assert!((way / expected - 1.0).abs() < 1e-6, "{way} {expected}");
        assert_eq!(*rattler, 0.0);
    }
    assert!(jumper.jumps.iter().all(|j| j.error < 1e-6 * b), "{:?}", jumper.jumps);
}

#[test]
fn large_error_shortens_next_jump() {
    let b = 1e-6;
    let first = 12.0 + 3.0;
    let law = |n: f64| if n <= first { b * n.ln() } else { b * first.ln() + 3.0 * b * (n / first).ln() };
    let (jumper, jumps) = jumps_of(&PLAN, 24, law);
    let [number, skipped, ..] = jumps[0];
    assert_eq!((number, skipped), (12.0, 3.0));
    let end = first + f64::from(PLAN.settle + PLAN.measure);
    let expected = 2.0 * b * (end / first).ln();
    assert!((jumper.jumps[0].error / expected - 1.0).abs() < 1e-6, "{:?} {expected}", jumper.jumps[0]);
    assert_eq!(jumps[1][1], (0.125 * jumps[1][0]).floor(), "{jumps:?}");
}

#[test]
fn overlap_change_limits_jumps() {
    let plan = CycleJumpOptions { overlap: 1e-4, largest: 10.0, ..PLAN };
    let b = 1e-6;
    let (jumper, jumps) = jumps_of(&plan, 20, |n| b * n.ln());
    let [number, skipped, way, _] = jumps[0];
    let reported = jumper.jumps[0].overlap_change.unwrap();
    // The sphere indents one plane slightly.
    let change = way / (3e-3 + b * number.ln());
    assert!((reported / change - 1.0).abs() < 1e-3, "{reported} {change}");
    assert!(reported <= 1e-4 && reported > 0.8e-4, "{reported}");
    assert!(skipped < (2.5 * number).floor() && skipped > 1.0, "{jumps:?}");
}

const EXTRAPOLATED: CycleJumpOptions =
    CycleJumpOptions { grains: false, first: 40, measure: 6, settle: 0, tolerance: 0.02, ..PLAN };

#[test]
fn cycles_of_one_law_cost_the_fewest() {
    let plan = EXTRAPOLATED;
    let fewest = plan.fewest_simulated(10_000);
    let (jumper, _) = jumps_of(&plan, fewest, |n| 1e-6 * n.ln());
    let skipped: u32 = jumper.jumps.iter().map(|j| j.cycles).sum();
    assert_eq!(fewest + skipped, 10_000, "{:?}", jumper.jumps);
    assert!(jumper.delays.is_empty() && fewest < 200, "{fewest}");
    assert_eq!(CycleJumpOptions { first: 10_000, ..plan }.fewest_simulated(10_000), 10_000);
}

/// A rearrangement before the first jump: it waits until the settlement of the last cycles follows one law again.
#[test]
fn jumps_wait_after_a_step() {
    let b = 1e-6;
    let step = |n: f64| b * n.ln() + if n > 30.0 { b } else { 0.0 };
    let (jumper, _) = jumps_of(&EXTRAPOLATED, 130, step);
    let first = jumper.delays.first().expect("a delay");
    assert_eq!((first.cycle, first.reason.as_str()), (40, "settlement stepped"));
    // A quarter of the age lies behind the step, and enough cycles before it to see it.
    let begun = jumper.jumps.first().expect("a jump").from;
    assert!((60..=130).contains(&begun), "{begun} {:?}", jumper.delays);
    let (steady, _) = jumps_of(&EXTRAPOLATED, 60, |n| b * n.ln());
    assert!(steady.delays.is_empty() && steady.jumps[0].from == 40, "{:?}", steady.jumps);
}
