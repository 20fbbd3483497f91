//! Contacts between walls: bodies of triangles and other patch walls (`contact/narrow_phase/shell.rs`).

use super::model::Model;
use super::state::State;
use crate::base::balance_terms::BalanceTerms;
use crate::base::failure::Failure;
use crate::bodies::sums::WallSum;
use crate::contact::narrow_phase::shell::{self, ShellPose, WallContactList};
use crate::contact::narrow_phase::shell_pass::Two;
use crate::contact::narrow_phase::{ContactView, Pose};
use crate::pairs::wall_history::WallContactHistory;
use crate::spatial::patchwork::WallView;
use crate::wall::shells::Form;

/// Largest approach per step over the radii of two walls, against undetected penetration.
const LARGEST_STEP: f64 = 0.5;

#[derive(Clone, Debug, Default)]
pub(crate) struct WallContacts {
    /// Load of each wall on others; empty without contacts.
    pub sums: Vec<WallSum>,
    now: Vec<WallView>,
    met: WallContactList,
    old: Vec<WallContactHistory>,
}

fn find(model: &Model, [a, b]: [u32; 2], now: &[WallView], met: &mut WallContactList) {
    met.clear();
    let [own, other] = [a, b].map(|k| &now[k as usize]);
    if own.open || other.open {
        return;
    }
    let [first, second] = [a, b].map(|k| &model.walls.walls[k as usize]);
    let reach = model.shells.radius(a) + model.shells.radius(b);
    if second.body.is_some() && (own.centre - other.centre).norm() > first.reach + second.reach + reach {
        return;
    }
    let pose = |wall: &WallView| Pose { centre: wall.origin, orientation: wall.orientation, scale: 1.0 };
    let Some(shell) = model.shells.shell(a) else { return };
    let shell = ShellPose { shell, pose: pose(own) };
    match &model.shells.forms[b as usize] {
        Form::Shell(it) => shell::shells(&shell, &ShellPose { shell: it, pose: pose(other) }, met),
        Form::Rounds(forms) => shell::rounds(&shell, &first.centre, forms, pose(other), met),
        Form::Untouched => {}
    }
}

pub(crate) fn forces(
    model: &Model,
    state: &mut State,
    work: &mut WallContacts,
    balance: &mut BalanceTerms,
) -> Option<Failure> {
    let WallContacts { sums, now, met, old } = work;
    sums.clear();
    if model.shells.pairs.is_empty() {
        return None;
    }
    sums.resize(state.walls.len(), WallSum::default());
    model.walls.update_poses(&state.walls, 0.0, now);
    let (dt, mut failure) = (state.step_size.kick(), None);
    for pairs in model.shells.pairs.chunk_by(|p, q| p[0] == q[0]) {
        let holder = pairs[0][0] as usize;
        std::mem::swap(&mut state.walls[holder].meets, old);
        state.walls[holder].meets.clear();
        for &[a, b] in pairs {
            find(model, [a, b], now, met);
            let old = of(old, b);
            if met.names.is_empty() && old.is_empty() {
                continue;
            }
            let two = Two { walls: [a, b].map(|k| &now[k as usize]), other: b };
            let new = &mut state.walls[holder].meets;
            let [first, second] = sums.get_disjoint_mut([a as usize, b as usize]).expect("two walls");
            let deep = two.forces((&model.laws, dt), met, (old, new), [first, second], balance);
            let speed = [a, b].map(|k| speed(model, state, k)).iter().sum::<f64>();
            let most = LARGEST_STEP * (model.shells.radius(a) + model.shells.radius(b)) / state.step_size.dt;
            let deep = deep.map(|[overlap, bound]| Failure::Walls { walls: [a, b], overlap, bound });
            let fast = (speed > most).then_some(Failure::Wall { wall: a, speed, bound: most });
            failure = failure.or(fast).or(deep);
        }
    }
    failure
}

/// Largest speed of a wall point [m/s].
fn speed(model: &Model, state: &State, wall: u32) -> f64 {
    let (wall, own) = (&model.walls.walls[wall as usize], &state.walls[wall as usize]);
    own.velocity.norm() + own.spin.norm() * wall.reach
}

fn of(meets: &[WallContactHistory], other: u32) -> &[WallContactHistory] {
    let from = meets.partition_point(|m| m.other < other);
    let to = meets.partition_point(|m| m.other <= other);
    &meets[from..to]
}

/// `back`: seconds ago.
pub(crate) fn visit(model: &Model, state: &State, back: f64, mut f: impl FnMut([u32; 2], &ContactView<'_>)) {
    if model.shells.pairs.is_empty() {
        return;
    }
    let (mut now, mut met) = (Vec::new(), WallContactList::default());
    model.walls.update_poses(&state.walls, back, &mut now);
    for &[a, b] in &model.shells.pairs {
        find(model, [a, b], &now, &mut met);
        let two = Two { walls: [a, b].map(|k| &now[k as usize]), other: b };
        two.visit(&model.laws, &mut met, of(&state.walls[a as usize].meets, b), &mut |c| f([a, b], c));
    }
}
