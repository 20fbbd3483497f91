//! The step of the grains, from the contacts that are there.
//!
//! Before anything touches, only a bound is known ([`crate::timestep`]), and it must hold for the worst that may come: many
//! contacts in one direction, each at the farthest lever. What the contacts and bonds of a moment allow is found from them
//! ([`limit`]), usually 2 to 10 times as much, and [`follow`] lets the step of a run go with it:
//!
//! * it is looked for again every [`LEAST`] to [`MOST`] steps, more often the more it changes;
//! * a share of it is taken ([`TimeStep::Measured`](crate::TimeStep::Measured)), a smaller one while it changes, which leaves
//!   room for contacts that come before the next look; the step grows by a quarter at most from one look to the next;
//! * no step is longer than a share of the time of a collision (`engine/collision.rs`), so that restitution is right; in a
//!   packing, where most contacts last, and where nobody asks for it, four times as much;
//! * steps are the first one times a power of 2^⅛, so that small changes leave it as it is.
//!
//! All of it depends on the state alone, so that a run has the same steps with any number of threads and across a restart.
//!
//! Theory manual: equation (3.5) of `docs/theory/motion.md`.

mod lanczos;
mod operator;

use crate::engine::model::Model;
use crate::engine::state::State;
use operator::Operator;

/// Fewest and most steps between two looks at the limit.
pub const LEAST: u64 = 64;
/// See [`LEAST`].
pub const MOST: u64 = 1024;

/// Contacts per body that make a packing.
const LASTING: f64 = 1.5;

/// Part of the share that is taken while the limit changes.
const UNSTEADY: f64 = 0.7;

/// Largest growth of the step from one look to the next.
const GROWTH: f64 = 1.25;

/// Ratio of neighbouring steps: 2^⅛.
const RUNG: f64 = 1.090_507_732_665_257_7;

/// The largest stable step [s] for the contacts and bonds of a state, all of them sticking; infinite where nothing holds
/// anything. Dashpots act with velocities of half a step ago. Rigid bodies of walls move and have their mounts;
/// what they stand on with their vertices is left out: [`Model::longest`] knows it.
///
/// With K and C made of these contacts the leapfrog is stable while the largest eigenvalue of M⁻¹(dt² K + 2 dt C) is below
/// 4; Lanczos' method finds it, to a few per cent on the safe side.
pub fn limit(model: &Model, state: &State) -> f64 {
    largest_step(&mut Operator::new(model, state), state)
}

/// [`limit`], given the operator.
fn largest_step(operator: &mut Operator, state: &State) -> f64 {
    let guess = if state.pace.limit > 0.0 { state.pace.limit } else { state.pace.dt };
    if operator.links() == 0 {
        return f64::INFINITY;
    }
    let mut dt = guess;
    for _ in 0..ROUNDS {
        let largest = lanczos::largest(operator.at(dt));
        let room = if largest > 0.0 { 4.0 / largest } else { return f64::INFINITY };
        // The eigenvalue grows with dt to dt²: far away take the smaller step that either allows, near by the mean.
        let factor = match room {
            r if r > 1.5 => r.sqrt(),
            r if r < 0.7 => r,
            r => 1.0 + (r - 1.0) / 1.5,
        };
        dt *= factor;
        if (0.93..1.07).contains(&factor) {
            break;
        }
    }
    dt
}

/// Most evaluations of the eigenvalue in one look.
const ROUNDS: usize = 6;

/// Looks at the limit if it is time to, and sets the step of `state` accordingly. Does nothing where the scene fixes the step.
/// Returns whether it looked.
pub fn follow(model: &Model, state: &mut State) -> bool {
    let Some(share) = model.measured() else { return false };
    if state.steps < state.pace.look || state.steps == 0 {
        return false;
    }
    let mut operator = Operator::new(model, state);
    let (found, before) = (largest_step(&mut operator, state), state.pace.limit);
    let packed = operator.links() as f64 > LASTING * state.present_count() as f64;
    let longest = model.longest(packed);
    let change = if before > 0.0 && found.is_finite() { (found / before).max(before / found) } else { 2.0 };
    let interval = state.pace.interval.max(LEAST);
    let pace = &mut state.pace;
    pace.interval = match change {
        c if c < 1.03 => (2 * interval).min(MOST),
        c if c > 1.1 => (interval / 2).max(LEAST),
        _ => interval,
    };
    pace.look = state.steps + pace.interval;
    // What cannot be saved is not kept.
    pace.limit = if found.is_finite() { found } else { 0.0 };
    let share = if change < 1.1 { share } else { UNSTEADY * share };
    let wanted = (share * found).min(longest).min(GROWTH * pace.wanted);
    pace.wanted = rung(model.dt(), wanted);
    pace.dt = pace.wanted;
    true
}

/// The largest of `first` times powers of 2^⅛ that is not above `wanted`.
fn rung(first: f64, wanted: f64) -> f64 {
    let mut dt = first;
    while dt > wanted {
        dt /= RUNG;
    }
    while dt * RUNG <= wanted {
        dt *= RUNG;
    }
    dt
}

/// Divides a window of time [s] into equal steps of the grains, as long as [`follow`] allows; sets the step and returns their
/// number, which is `most` where the scene fixes the step.
pub fn divide(model: &Model, state: &mut State, window: f64, most: u32) -> u32 {
    if model.measured().is_none() {
        return most;
    }
    follow(model, state);
    // A window that is a whole number of steps but for rounding is that number.
    let steps = (window / state.pace.wanted * (1.0 - 1e-12)).ceil().clamp(1.0, 1e6) as u32;
    state.pace.dt = window / f64::from(steps);
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_rungs_below_what_is_wanted() {
        for wanted in [0.3, 0.999, 1.0, 1.05, 1.5, 7.0] {
            let dt = rung(1.0, wanted);
            assert!(dt <= wanted && dt * RUNG > wanted, "{wanted}: {dt}");
        }
        assert!((RUNG.powi(8) - 2.0).abs() < 1e-14);
    }
}
