//! Commands of the first rank.

use super::codec::{decode, encode};
use crate::base::Vec3;
use crate::engine::state::State;
use crate::integrate::leapfrog::Applied;
use crate::integrate::step_size::StepSize;
use crate::shape::plane::PlaneMotion;
use serde::{Deserialize, Serialize};

/// Command; data follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Command {
    Model {
        /// Number of bodies, and initial time step [s].
        bodies: u64,
        dt: f64,
    },
    Take,
    Step(StepCommand),
    Give,
    End,
}

/// Step data of all blocks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct StepCommand {
    time: f64,
    step_size: StepSize,
    near: f64,
    max_travel: f64,
    wall_travel: f64,
    /// Whether bonds have not been stepped.
    fresh: bool,
    pub rebuild: bool,
}

#[derive(Serialize, Deserialize)]
struct Force {
    block: u32,
    place: u32,
    force: Vec3,
    torque: Vec3,
}

/// With wall and plane motion.
pub(super) fn write_step(state: &State, rebuild: bool, applied: &[Applied], out: &mut Vec<u8>) {
    let &State { time, step_size, near, max_travel, wall_travel, .. } = state;
    let fresh = state.bonds.fresh;
    encode(
        out,
        &Command::Step(StepCommand { time, step_size, near, max_travel, wall_travel, fresh, rebuild }),
    );
    state.planes.iter().for_each(|plane| encode(out, plane));
    encode(out, &state.walls);
    encode(out, &(applied.len() as u32));
    for &Applied { block, place, force, torque } in applied {
        encode(out, &Force { block, place, force, torque });
    }
}

/// `None` if the message is malformed.
pub(super) fn read_step(
    state: &mut State,
    now: &StepCommand,
    applied: &mut Vec<Applied>,
    rest: &mut &[u8],
) -> Option<()> {
    (state.time, state.step_size, state.near) = (now.time, now.step_size, now.near);
    (state.max_travel, state.wall_travel, state.bonds.fresh) = (now.max_travel, now.wall_travel, now.fresh);
    for plane in &mut state.planes {
        *plane = decode::<PlaneMotion>(rest)?;
    }
    state.walls = decode(rest)?;
    applied.clear();
    for _ in 0..decode::<u32>(rest)? {
        let Force { block, place, force, torque } = decode(rest)?;
        applied.push(Applied { block, place, force, torque });
    }
    Some(())
}
