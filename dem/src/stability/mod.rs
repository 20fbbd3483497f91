//! DEM time step from current contacts and bonds ([`limit`]), usually 2 to 10 times the a-priori bound
//! ([`crate::timestep`]).
//!
//! * the limit is evaluated every [`LEAST`] to [`MOST`] steps, more often if it changes, and at once if the
//!   bodies received nearly half of their spring energy or the dissipation rate rises tenfold;
//! * the step is a fraction of it ([`TimeStep::Measured`](crate::TimeStep::Measured)), smaller while it
//!   changes;
//! * a fraction of the collision time (`engine/collision.rs`) bounds it;
//!
//! Steps depend on the state only.
//!
//! Theory manual: eq. (3.5), `docs/theory/motion.md`.

mod lanczos;
mod operator;

use crate::engine::model::Model;
use crate::engine::state::State;
use operator::Operator;

/// Fewest steps between evaluations of the limit.
pub const LEAST: u64 = 64;
/// Most steps between evaluations.
pub const MOST: u64 = 1024;

/// Energy received since the last evaluation, relative to the spring energy, that calls for the next one if
/// stiffness grows with the overlap. For Hertz contacts: a quarter more force, 4 % off the limit.
const RECEIVED: f64 = 0.45;

/// Rise of the dissipation rate since the last evaluation that calls for the next one.
const SURGE: f64 = 10.0;

/// Fraction of the limit that a step may reach between evaluations.
const NEAR: f64 = 0.95;

/// Contacts per body of a packing.
const LASTING: f64 = 1.5;

/// Factor on the fraction while the limit changes.
const UNSTEADY: f64 = 0.7;

/// Largest growth of the step per evaluation.
const GROWTH: f64 = 1.25;

/// Ratio of neighbouring steps: 2^⅛.
const RUNG: f64 = 1.090_507_732_665_257_7;

/// Returns the critical time step [s] of current sticking contacts and bonds; infinite without any.
///
/// Lanczos method, a few per cent conservative. [`Model::longest`] covers contacts of wall vertices with
/// planes.
pub fn limit(model: &Model, state: &State) -> f64 {
    largest_step(&mut Operator::new(model, state), state)
}

fn largest_step(operator: &mut Operator, state: &State) -> f64 {
    let guess = if state.step_size.limit > 0.0 { state.step_size.limit } else { state.step_size.dt };
    if operator.links() == 0 {
        return f64::INFINITY;
    }
    let mut dt = guess;
    for _ in 0..ROUNDS {
        let largest = lanczos::largest(operator.at(dt));
        let room = if largest > 0.0 { 4.0 / largest } else { return f64::INFINITY };
        // The eigenvalue grows with dt to dt²: the smaller step of both if far away, else the mean.
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

/// Most eigenvalue solves per evaluation.
const ROUNDS: usize = 6;

/// Evaluates the limit if due and sets the step of `state`, unless fixed. Returns whether it was evaluated.
pub fn follow(model: &Model, state: &mut State) -> bool {
    let Some(share) = model.measured() else { return false };
    let rate = dissipation_rate(state);
    let received = state.balance.work() - state.balance.dissipated();
    let loaded = model.stiffens() && received > state.step_size.expected;
    let surges = loaded || rate > SURGE * state.step_size.rate;
    let due = state.steps >= state.step_size.look;
    if state.steps == 0 || !due && !surges {
        return false;
    }
    let mut operator = Operator::new(model, state);
    state.step_size.rate = rate;
    state.step_size.expected = received + RECEIVED * operator.spring_energy();
    // Between evaluations, only a step near the limit changes.
    let wanted = state.step_size.wanted;
    if !due && lanczos::largest(operator.at(wanted)) < 4.0 * NEAR * NEAR {
        return false;
    }
    let (found, before) = (largest_step(&mut operator, state), state.step_size.limit);
    if !due && wanted < NEAR * found {
        return false;
    }
    let packed = operator.links() as f64 > LASTING * state.present_count() as f64;
    let longest = model.longest(packed);
    let change = if before > 0.0 && found.is_finite() { (found / before).max(before / found) } else { 2.0 };
    let interval = state.step_size.interval.max(LEAST);
    let step_size = &mut state.step_size;
    step_size.interval = match change {
        c if c < 1.03 => (2 * interval).min(MOST),
        c if c > 1.1 => (interval / 2).max(LEAST),
        _ => interval,
    };
    step_size.look = state.steps + step_size.interval;
    // Infinity cannot be saved.
    step_size.limit = if found.is_finite() { found } else { 0.0 };
    let share = if change < 1.1 { share } else { UNSTEADY * share };
    let wanted = (share * found).min(longest).min(GROWTH * step_size.wanted);
    step_size.wanted = rung(model.dt(), wanted);
    step_size.dt = step_size.wanted;
    true
}

/// Dissipation rate since the last call [W].
fn dissipation_rate(state: &mut State) -> f64 {
    let balance = &state.balance;
    let now =
        [state.time, balance.dissipated_dashpot + balance.dissipated_friction + balance.dissipated_bonds];
    let [elapsed, dissipated] = [now[0] - state.step_size.before[0], now[1] - state.step_size.before[1]];
    state.step_size.before = now;
    if elapsed > 0.0 { (dissipated / elapsed).max(0.0) } else { 0.0 }
}

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

/// Divides a time window [s] into equal DEM steps within [`follow`]'s limit; sets the step and returns their
/// number, `most` for a fixed step.
pub fn divide(model: &Model, state: &mut State, window: f64, most: u32) -> u32 {
    if model.measured().is_none() {
        return most;
    }
    follow(model, state);
    // Tolerates rounding of a whole number of steps.
    let steps = (window / state.step_size.wanted * (1.0 - 1e-12)).ceil().clamp(1.0, 1e6) as u32;
    state.step_size.dt = window / f64::from(steps);
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rung_is_largest_below_limit() {
        for wanted in [0.3, 0.999, 1.0, 1.05, 1.5, 7.0] {
            let dt = rung(1.0, wanted);
            assert!(dt <= wanted && dt * RUNG > wanted, "{wanted}: {dt}");
        }
        assert!((RUNG.powi(8) - 2.0).abs() < 1e-14);
    }
}
