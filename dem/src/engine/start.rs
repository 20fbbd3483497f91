//! Initial state of a run.

use super::block_layout::{self, BodyState};
use super::bonds;
use super::model::Model;
use super::state::State;
use crate::base::Vec3;
use crate::base::balance_terms::BalanceTerms;
use crate::bodies::block::Rotation;
use crate::bond::BondState;
use crate::integrate::step_size::StepSize;
use crate::law::scarring::Scar;
use crate::shape::plane::PlaneMotion;

/// Leapfrog velocity half a step of `dt` [s] ago, in free fall; `velocity` [m/s].
pub(crate) fn half_a_step_ago(model: &Model, body: usize, velocity: &Vec3, dt: f64) -> Vec3 {
    let fixed = model.body(body).fixed;
    let kick = Vec3::from_fn(|d, _| if fixed >> d & 1 == 1 { 0.0 } else { model.gravity[d] });
    velocity - kick * (0.5 * dt)
}

impl State {
    /// Creates the initial state at time 0.
    ///
    /// Initial contact or applied forces act with a full first kick, a time shift of half a step.
    pub fn new(model: &Model) -> State {
        let plane =
            |p: &crate::Plane| PlaneMotion { offset: Vec3::zeros(), velocity: p.velocity, open: false };
        let mut state = State {
            time: 0.0,
            step_size: StepSize::new(model.dt()),
            steps: 0,
            before: 0,
            balance: BalanceTerms::default(),
            places: Vec::new(),
            blocks: Vec::new(),
            lists: Vec::new(),
            cross: Vec::new(),
            bonds: BondState::default(),
            planes: model.planes.iter().map(plane).collect(),
            walls: model.walls.start(&model.gravity, model.dt()),
            sheet: model.sheet.rest.clone(),
            scars: vec![Scar::default(); if model.scarred { model.bodies.len() } else { 0 }],
            near: 0.1 * model.skin,
            max_travel: 0.0,
            wall_travel: 0.0,
            steps_since_search: 0,
            driven_speed: 0.0,
            stale: true,
        };
        let positions = model.bodies.positions().expect("a model that has not given its start up");
        for bodies in block_layout::blocks(model, positions, |b| !model.bodies.absent(b)) {
            let block = block_layout::block(model, bodies, |body| {
                let body = body as usize;
                let rotation =
                    Rotation { orientation: model.bodies.orientation(body), momentum: Vec3::zeros() };
                BodyState::at_rest(model, body, &positions[body], rotation)
            });
            let (lists, cross) = block_layout::lists(model, &block);
            state.blocks.push(block);
            state.lists.push(lists);
            state.cross.push(cross);
        }
        state.number(model);
        bonds::start(model, &mut state);
        for k in (0..model.bodies.len()).filter(|&k| !model.bodies.absent(k)) {
            let velocity = half_a_step_ago(model, k, &model.bodies.velocity(k), model.dt());
            state.set_velocity(model, k, velocity, model.bodies.spin(k));
        }
        state
    }
}
