//! Ranks (threads with messages): bitwise identical to the engine.

use crate::bonds_many::crash;
use crate::determinism::mill;
use crate::scene::{FOLLOWED, Random, pile, plane, sphere, stone};
use trackbed_dem::ranks::{Link, Local, Lost, MessageCounters, MessageKind, Ranks, check, local, serve};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    AppliedForce, BackEnd, BodyForce, Material, Model, ModelInput, Plane, Shape, State, StepError, Vec3,
    Wind, Work, stability,
};

/// Of seven ranks, some have no block.
const RANKS: [usize; 5] = [1, 2, 3, 4, 7];

fn gas() -> ModelInput {
    let mut random = Random::new(11);
    let smooth = Material { friction: 0.2, restitution: 0.8, density: 2000.0, ..stone() };
    let rolling = Material { rolling_friction: 0.1, ..stone() };
    let mut input = ModelInput {
        materials: vec![smooth, rolling],
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        gravity: Vec3::new(0.3, -0.2, -9.81),
        ..ModelInput::default()
    };
    for k in 0..5_600_usize {
        let cell = Vec3::new((k % 20) as f64, (k / 20 % 14) as f64, (k / 280) as f64);
        let place = (cell + Vec3::repeat(0.5)) * 0.0206 + random.vector() * 3e-4;
        let mut body = sphere(place, random.vector() * 1.5);
        body.material = usize::from(k % 3 == 0);
        body.scale = 0.8 + 0.2 * random.unit();
        body.spin = random.vector() * 40.0;
        body.fixed = if k % 97 == 0 { [true; 6] } else { [false, false, false, k % 50 == 0, false, false] };
        if body.fixed[0] {
            (body.velocity, body.spin) = (Vec3::zeros(), Vec3::zeros());
        }
        input.bodies.push(body);
    }
    let far = Vec3::new(20.0, 14.0, 20.0) * 0.0206;
    for (point, normal) in [
        (Vec3::zeros(), Vec3::z()),
        (Vec3::zeros(), Vec3::x()),
        (Vec3::zeros(), Vec3::y()),
        (far, -Vec3::x()),
        (far, -Vec3::y()),
        (far, -Vec3::z()),
    ] {
        let velocity = if input.planes.is_empty() { Vec3::new(0.1, 0.0, 0.4) } else { Vec3::zeros() };
        input.planes.push(Plane { velocity, ..plane(point, normal) });
    }
    input
}

#[derive(Clone, Copy, Default)]
struct How {
    steps: usize,
    /// Steps between downloads.
    look: usize,
    /// Step size control by contacts, at downloads.
    follows: bool,
    /// Body pushed in every fifth step.
    pushed: Option<usize>,
}

fn push(how: How, state: &State, k: usize) -> Vec<AppliedForce> {
    let pushed = how.pushed.filter(|_| k.is_multiple_of(5)).into_iter();
    pushed
        .map(|body| {
            let point = state.position(body) + Vec3::x() * 0.005;
            AppliedForce { body, force: Vec3::new(0.2, 0.4, 0.1), point }
        })
        .collect()
}

fn bytes(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).expect("a state that can be written")
}

fn states<B: BackEnd>(model: &Model, state: &mut State, work: &mut B, how: How) -> Vec<Vec<u8>> {
    let mut seen = Vec::new();
    for k in 1..=how.steps {
        if how.follows && (k - 1).is_multiple_of(how.look) {
            stability::follow(model, state);
        }
        // Forces need a complete state.
        let applied = push(how, state, k);
        work.step(model, state, &NoSurface, &applied).expect("a good step");
        if k.is_multiple_of(how.look) || (how.pushed.is_some() && (k + 1).is_multiple_of(5)) {
            work.download(model, state).expect("ranks that respond");
            seen.push(bytes(state));
        }
    }
    seen
}

fn with_ranks<T>(model: &Model, size: usize, lead: impl FnOnce(Local) -> T) -> T {
    let mut links = local(size);
    let first = links.remove(0);
    std::thread::scope(|scope| {
        for link in links {
            scope.spawn(|| serve(link, |_| Ok(model.clone())).expect("the first rank"));
        }
        lead(first)
    })
}

fn start(model: &Model) -> State {
    let mut state = State::new(model);
    // Includes a re-sorting of bodies.
    state.steps = 4750;
    state
}

fn same_bits(name: &str, input: ModelInput, how: How) -> State {
    let model = Model::new(input).expect("a good input");
    check(&model).expect("a model for ranks");
    let mut alone = start(&model);
    let mut work = Work::new(&model, &alone);
    let expected = states(&model, &mut alone, &mut work, how);
    assert!(alone.steps > 5100, "a new order");
    for size in RANKS {
        let (seen, rebuilds, traffic) = with_ranks(&model, size, |link| {
            let mut state = start(&model);
            let mut ranks = Ranks::new(link, &model, &state, &[]).expect("ranks");
            let seen = states(&model, &mut state, &mut ranks, how);
            (seen, ranks.rebuilds(), *ranks.traffic())
        });
        let differs = seen.iter().zip(&expected).position(|(a, b)| a != b);
        assert_eq!(differs, None, "{name}: the first look at which {size} ranks differ");
        let books = traffic.messages[MessageKind::Books as usize];
        assert_eq!(books, (how.steps * (size - 1)) as u64, "{name}: reports of {size} ranks");
        assert!(size == 1 || traffic.ghosts > 60, "{name}: {} ghosts", traffic.ghosts);
        println!(
            "{name}: {size} ranks, {} steps, {} searches, {} near lists, {} ghosts",
            how.steps, rebuilds.0, rebuilds.1, traffic.ghosts
        );
        traffic.lines(how.steps as u64).iter().filter(|_| size > 1).for_each(|line| println!("  {line}"));
        assert!(rebuilds.0 > 2 && rebuilds.1 > 5, "{name}: {rebuilds:?}");
    }
    alone
}

#[test]
fn spheres() {
    let state = same_bits("spheres", gas(), How { steps: 1211, look: 173, ..How::default() });
    let l = &state.balance;
    assert!(l.dissipated_dashpot > 0.0 && l.dissipated_friction > 0.0 && l.work_walls != 0.0, "{l:?}");
}

#[test]
fn clumps_in_wind() {
    let wind = Wind { velocity: Vec3::new(3.0, 1.0, 0.0), density: 1.2, drag: 0.5 };
    let gravity = Vec3::new(0.0, 0.0, -80.0);
    let input = ModelInput {
        time_step: FOLLOWED,
        body_forces: vec![BodyForce::Wind(wind)],
        gravity,
        ..pile(11, false)
    };
    let state = same_bits("clumps", input, How { steps: 1800, look: 60, follows: true, ..How::default() });
    assert!(state.balance.dissipated_friction > 0.0 && state.balance.work_body_forces != 0.0);
    assert!(state.wall_contact_count() > 10, "{}", state.wall_contact_count());
}

#[test]
fn walls_that_move() {
    let state = same_bits("walls", mill(15), How { steps: 1000, look: 100, ..How::default() });
    assert!(state.balance.work_walls != 0.0 && state.wall_contact_count() > 10, "{:?}", state.balance);
    let lid = 2;
    assert!(state.wall_offset(lid).norm() > 0.0, "the lid is driven");
}

#[test]
fn bonds_that_break() {
    let state = same_bits("bonds", crash(), How { steps: 800, look: 100, ..How::default() });
    let (tension, shear) = state.broken_bonds();
    println!("bonds: {tension} + {shear} broken of {}", state.bond_count() + (tension + shear) as usize);
    assert!(tension > 50 && shear > 2, "{tension} {shear}");
}

#[test]
fn pushed_bodies() {
    let how = How { steps: 400, look: 100, pushed: Some(4321), ..How::default() };
    let state = same_bits("pushed", gas(), how);
    assert!(state.balance.work_applied != 0.0);
}

struct Failing(Local, usize);

impl Link for Failing {
    fn rank(&self) -> usize {
        self.0.rank()
    }

    fn size(&self) -> usize {
        self.0.size()
    }

    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost> {
        if self.1 == 0 {
            return Err(Lost { rank: self.rank(), problem: "it fails".into() });
        }
        self.1 -= 1;
        self.0.send(to, message)
    }

    fn receive(&mut self, from: usize, message: &mut Vec<u8>) -> Result<(), Lost> {
        self.0.receive(from, message)
    }
}

#[test]
fn a_lost_rank_ends_all() {
    let model = Model::new(gas()).expect("a good input");
    let mut links = local(4);
    let (first, mut state) = (links.remove(0), start(&model));
    let error = std::thread::scope(|scope| {
        let model = &model;
        let others: Vec<_> = links
            .into_iter()
            .map(|link| {
                let count = if link.rank() == 2 { 200 } else { usize::MAX };
                scope.spawn(move || serve(Failing(link, count), |_| Ok(model.clone())))
            })
            .collect();
        let error = {
            let mut ranks = Ranks::new(first, model, &state, &[]).expect("ranks");
            let mut steps = (0..1000).map(|_| ranks.step(model, &mut state, &NoSurface, &[]));
            steps.find_map(Result::err).expect("a rank that is lost")
        };
        for (k, other) in others.into_iter().enumerate() {
            // Uninvolved ranks may have ended.
            match other.join().expect("a thread") {
                Ok(()) => assert_ne!(k + 1, 2),
                Err(lost) => assert_eq!(lost.rank, 2, "{lost}"),
            }
        }
        error
    });
    assert!(matches!(error, StepError::Rank { rank: 2, .. }), "{error}");
    let text = error.to_string();
    assert!(text.contains("rank 2 lost: its thread has ended"), "{text}");
}

#[test]
fn other_models_and_features_are_refused() {
    let model = Model::new(gas()).expect("a good input");
    let other = Model::new(pile(3, false)).expect("a good input");
    let error = with_ranks(&other, 2, |link| Ranks::new(link, &model, &start(&model), &[]).err());
    let text = error.expect("another model").to_string();
    assert!(text.contains("rank 1") && text.contains("other model: found 27 bodies"), "{text}");

    let block = Model::new(pile(3, true)).expect("a good input");
    let text = check(&block).expect_err("a block").to_string();
    assert_eq!(text, "not supported with several ranks: boxes and polyhedra");
    let periodic = ModelInput { periodic: [Some([-1.0, 2.0]), None, None], planes: Vec::new(), ..gas() };
    let text = check(&Model::new(periodic).expect("a good input")).expect_err("a border").to_string();
    assert!(text.ends_with("periodic borders"), "{text}");
}

#[test]
fn traffic_is_counted_by_kind() {
    let lines = MessageCounters { messages: [4; 6], bytes: [80; 6], ghosts: 0 }.lines(8);
    assert_eq!(lines[MessageKind::Ghosts as usize], "ghosts: 0.500 messages per step, 10 bytes per step");
}
