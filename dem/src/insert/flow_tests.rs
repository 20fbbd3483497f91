use super::*;
use crate::base::error::Partner;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::engine::work::Work;
use crate::insert::free_space::{FreePositions, FreeSpace};
use crate::law::material::Material;
use crate::measure::{BoxRegion, contacts};
use crate::shape::Shape;
use crate::spatial::surface::NoSurface;
use crate::testing::{SOFT, dumbbells, push, shaft};
use crate::{Model, ModelError, step};

const SIDE: f64 = 0.12;

fn input(periodic: bool) -> ModelInput {
    let material = Material {
        stiffness: 2e4,
        tangential_damping_ratio: 0.1,
        restitution: 0.6,
        rolling_friction: 0.05,
        ..SOFT
    };
    let mut input = dumbbells(material, [0.02; 3]);
    let walled: &[Vec3] = if periodic { &[Vec3::y()] } else { &[Vec3::x(), Vec3::y()] };
    input.planes = shaft(SIDE, walled);
    input.periodic[0] = periodic.then_some([0.0, SIDE]);
    for k in 0..160_usize {
        let cell = Vec3::new((k % 4) as f64 + 0.5, (k / 4 % 4) as f64 + 0.5, (k / 16) as f64 + 0.6);
        input.bodies.push(BodyInput {
            shape: k % 2,
            position: cell * 0.029,
            velocity: push(k) * 0.5,
            absent: k % 5 == 4,
            ..BodyInput::default()
        });
    }
    input
}

struct Run {
    model: Model,
    state: State,
    work: Work,
}

impl Run {
    fn new(input: ModelInput) -> Run {
        let model = Model::new(input).unwrap();
        let state = State::new(&model);
        let work = Work::new(&model, &state);
        Run { model, state, work }
    }

    fn steps(&mut self, count: usize) {
        for _ in 0..count {
            step(&self.model, &mut self.state, &mut self.work, &NoSurface, &[]).unwrap();
        }
    }

    fn exchange(&mut self, leave: &[usize], arrive: &[Arrival]) -> Result<(), FlowError> {
        exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
    }

    fn account(&self) -> f64 {
        let balance = &self.state.balance;
        measure::energies(&self.model, &self.state).total() + balance.dissipated() - balance.work()
    }

    fn momentum_error(&self, start: &crate::base::balance_terms::Impulse) -> (f64, f64) {
        let (now, sum) = (measure::momentum(&self.model, &self.state), self.state.balance.impulse());
        ((now.linear - start.linear - sum.linear).norm(), (now.angular - start.angular - sum.angular).norm())
    }
}

fn turn_over(run: &mut Run, waiting: &mut Vec<usize>, places: &mut FreePositions) -> (usize, usize) {
    let low: Vec<usize> = (0..run.model.body_count())
        .filter(|&b| run.state.present(b) && run.state.position(b).z < 0.03)
        .take(4)
        .collect();
    let region = BoxRegion { low: Vec3::new(0.0, 0.0, 0.3), high: Vec3::new(SIDE, SIDE, 0.45) };
    let mut room = FreeSpace::new(&run.model, &run.state, &NoSurface, region, 0.02, |b| low.contains(&b));
    let mut arrive = Vec::new();
    while let (Some(&body), true) = (waiting.first(), arrive.len() < 4) {
        let Some((position, orientation)) = room.find_position(run.model.radius(body), places) else { break };
        waiting.remove(0);
        let (velocity, spin) = (Vec3::new(0.1, -0.2, -0.8), Vec3::new(3.0, 4.0, -5.0));
        arrive.push(Arrival { body, position, orientation, velocity, spin });
    }
    run.exchange(&low, &arrive).unwrap();
    waiting.extend(&low);
    (low.len(), arrive.len())
}

#[test]
fn balances_close_during_insertion_and_removal() {
    for periodic in [false, true] {
        let mut run = Run::new(input(periodic));
        let mut waiting: Vec<usize> =
            (0..run.model.body_count()).filter(|&b| !run.state.present(b)).collect();
        assert_eq!((waiting.len(), run.state.present_count()), (32, 128));
        let mut places = FreePositions::new(5);
        let (first, start) = (run.account(), measure::momentum(&run.model, &run.state));
        let (mut changes, mut worst, mut moved) = (0.0, 0.0_f64, (0, 0));
        let (mut jump, mut springs) = (0.0_f64, 0.0);
        for _ in 0..60 {
            run.steps(300);
            let before = (run.account(), run.state.balance.work_flow);
            let elastic = measure::energies(&run.model, &run.state).elastic();
            let (out, come) = turn_over(&mut run, &mut waiting, &mut places);
            moved = (moved.0 + out, moved.1 + come);
            springs += elastic - measure::energies(&run.model, &run.state).elastic();
            jump = jump.max((run.account() - before.0).abs());
            changes += (run.state.balance.work_flow - before.1).abs();
            worst = worst.max((run.account() - first).abs());
        }
        let error = run.momentum_error(&start);
        let scale = run.state.balance.gravity.linear.norm();
        println!(
            "{periodic}: {moved:?} {worst:e} of {changes:e}, jump {jump:e}, springs {springs:e}, {error:?} of {scale}"
        );
        assert!(moved.0 > 150 && moved.1 > 150, "{moved:?}");
        assert!(jump < 1e-13 * changes, "{jump:e} of {changes}");
        assert!(springs > 1e-6, "{springs:e}");
        assert!(worst < 4e-3 * changes, "{worst:e} of {changes:e}");
        assert!(error.0 < 1e-12 * scale && error.1 < 1e-12 * scale, "{error:?} of {scale}");
    }
}

fn forces(run: &Run) -> Vec<((usize, usize, usize), Vec3)> {
    let mut list: Vec<_> = contacts(&run.model, &run.state)
        .iter()
        .map(|c| match c.b {
            Partner::Body(b) if b < c.a => ((b, c.a, 0), -c.force),
            Partner::Body(b) => ((c.a, b, 0), c.force),
            Partner::Plane(p) => ((c.a, 0, p + 1), c.force),
            _ => unreachable!("no other partners"),
        })
        .collect();
    list.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.norm().total_cmp(&y.1.norm())));
    list
}

#[test]
fn remaining_contacts_keep_forces() {
    for periodic in [false, true] {
        let mut run = Run::new(input(periodic));
        run.steps(4000);
        let leave: Vec<usize> =
            (0..run.model.body_count()).filter(|&b| b % 7 == 0 && run.state.present(b)).collect();
        let mut expected = forces(&run);
        let all = expected.len();
        expected.retain(|((a, b, plane), _)| !leave.contains(a) && (*plane > 0 || !leave.contains(b)));
        let position = run.state.position(leave[0]);
        let back = Arrival {
            body: leave[0],
            position,
            orientation: UnitQuaternion::identity(),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
        };
        run.exchange(&leave, &[back]).unwrap();
        let found = forces(&run);
        assert!(found.len() > 40 && found.len() + 10 < all, "{} of {all}", found.len());
        assert_eq!(expected.len(), found.len());
        let mut same = 0;
        for (x, y) in expected.iter().zip(&found) {
            assert_eq!(x.0, y.0);
            same += usize::from(x.1 == y.1);
            assert!((x.1 - y.1).norm() <= 1e-12 * x.1.norm(), "{x:?} {y:?}");
        }
        assert!(same * 10 > found.len() * 7, "{same} of {}", found.len());
        assert_eq!(run.state.position(leave[0]), position);
        assert!(!run.state.present(leave[1]) && run.state.present_count() == 128 - leave.len() + 1);
    }
}

#[test]
fn inserted_body_falls_freely() {
    for body in [4, 9, 3] {
        let mut run = Run::new(input(false));
        run.steps(333);
        let (x, v) = (Vec3::new(0.05, 0.06, 0.8), Vec3::new(0.3, -0.2, 1.5));
        let spin = Vec3::new(0.0, 0.0, 7.0);
        let leave: &[usize] = if run.state.present(body) { &[body] } else { &[] };
        let orientation = UnitQuaternion::from_scaled_axis(Vec3::z() * 0.3);
        run.exchange(leave, &[Arrival { body, position: x, orientation, velocity: v, spin }]).unwrap();
        let begun = run.state.time;
        for _ in 0..50 {
            run.steps(10);
            let t = run.state.time - begun;
            let expected = x + v * t + Vec3::new(0.0, 0.0, -9.81) * (0.5 * t * t);
            let off = (run.state.position(body) - expected).norm();
            assert!(off < 1e-12, "{off:e} after {t} s");
        }
        let t = run.state.time - begun;
        assert!(t > 0.01, "{t} {}", run.model.dt());
        if matches!(run.model.shape(body), Shape::Clump(_)) {
            // Shape and inertia axes differ.
            let angle = run.state.orientation(&run.model, body).angle();
            assert!(angle > 0.3 && (run.state.spin(body) - spin).norm() < 7.0, "{angle}");
        } else {
            assert_eq!(run.state.spin(body), spin);
        }
    }
}

#[test]
fn a_run_without_any_body() {
    let mut run = Run::new(input(true));
    run.steps(20);
    let all: Vec<usize> = (0..run.model.body_count()).filter(|&b| run.state.present(b)).collect();
    run.exchange(&all, &[]).unwrap();
    run.steps(20);
    let e = measure::energies(&run.model, &run.state);
    assert_eq!((e.total(), run.state.present_count()), (0.0, 0));
    let region = BoxRegion { low: Vec3::zeros(), high: Vec3::repeat(SIDE) };
    assert_eq!(measure::porosity(&run.model, &run.state, &region), 1.0);
    assert_eq!(measure::coordination(&run.model, &run.state), 0.0);
    let none = contacts(&run.model, &run.state);
    assert!(measure::coordination_of(&run.model, &run.state, &none, |_| true).distribution.is_empty());
    assert_eq!(measure::region_stress(&run.model, &run.state, &vec![[1.0; 6]; 160], &region), [0.0; 6]);
    assert!(measure::radial_distribution(&run.model, &run.state, &region, |_| true, 0.03, 4).is_none());
    let position = Vec3::new(0.05, 0.05, 0.0112);
    let (orientation, zero) = (UnitQuaternion::identity(), Vec3::zeros());
    let arrive = [Arrival { body: 77, position, orientation, velocity: zero, spin: zero }];
    run.exchange(&[], &arrive).unwrap();
    run.steps(4000);
    assert!(run.state.present_count() == 1 && run.state.position(77).z < 0.011);
    assert_eq!(measure::coordination(&run.model, &run.state), 1.0);
    let found = contacts(&run.model, &run.state);
    let all = measure::coordination_of(&run.model, &run.state, &found, |_| true);
    assert_eq!((all.mean, all.distribution), (1.0, vec![0, 1]));
    let ratio = measure::unbalanced_ratio(&run.model, &run.state, &found);
    assert!(ratio < 1e-3, "{ratio}");
}

#[test]
fn new_scratch_continues_bitwise() {
    let mut run = Run::new(input(false));
    let mut waiting: Vec<usize> = (0..160).filter(|&b| !run.state.present(b)).collect();
    run.steps(700);
    turn_over(&mut run, &mut waiting, &mut FreePositions::new(3));
    let state = run.state.clone();
    let mut copy = Run { model: run.model.clone(), work: Work::new(&run.model, &state), state };
    run.steps(300);
    copy.steps(300);
    for b in (0..160).filter(|&b| run.state.present(b)) {
        assert_eq!(run.state.position(b), copy.state.position(b));
        assert_eq!(run.state.velocity(b), copy.state.velocity(b));
    }
}

#[test]
fn rejects_invalid_exchange() {
    let mut input = input(false);
    let position = Vec3::new(0.06, 0.06, 0.7);
    input.bodies.push(BodyInput { shape: 2, position, ..BodyInput::default() });
    let mut run = Run::new(input.clone());
    let arrival = |body| Arrival {
        body,
        position: Vec3::repeat(0.5),
        orientation: UnitQuaternion::identity(),
        velocity: Vec3::zeros(),
        spin: Vec3::zeros(),
    };
    let astray = Arrival { velocity: Vec3::repeat(f64::NAN), ..arrival(4) };
    for (leave, arrive, text) in [
        (vec![4], vec![], "body 4 cannot be taken out: it is not there"),
        (vec![3, 3], vec![], "body 3 cannot be taken out: it is not there"),
        (vec![999], vec![], "body 999 cannot be taken out: there is no such body"),
        (vec![160], vec![], "body 160 cannot be taken out: it is a box"),
        (vec![], vec![arrival(3)], "body 3 cannot be put in: it is there already"),
        (vec![], vec![arrival(4), arrival(4)], "body 4 cannot be put in: it is there already"),
        (vec![], vec![astray], "body 4 cannot be put in: its position or motion is not finite"),
    ] {
        assert_eq!(run.exchange(&leave, &arrive).unwrap_err().to_string(), text);
    }
    assert_eq!(run.state.balance.work_flow, 0.0);
    let force = crate::AppliedForce { body: 4, force: Vec3::x(), point: Vec3::zeros() };
    let error = step(&run.model, &mut run.state, &mut run.work, &NoSurface, &[force]).unwrap_err();
    assert!(error.to_string().contains("applied force 0 (body 4): no such body"), "{error}");

    let mut waiting = input.clone();
    waiting.bodies[160].absent = true;
    let error = Model::new(waiting).unwrap_err();
    assert_eq!(error, ModelError::Absent { body: 160, problem: "it is a box" });
}
