//! Sums the block totals of a device in the engine's order.

use super::layout::{Features, TotalsPart, WALL_TOTALS};
use crate::base::Vec3;
use crate::base::balance_terms::{BalanceTerms, Impulse};
use crate::bodies::sums::{BlockTotals, WallSum};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::step::StepTotals;
use crate::engine::work::Work;

/// Sums the totals of a step block by block; wall and bond totals go to `work`. `mass`: per block [kg].
pub(super) fn reduce_blocks(
    books: &[f64],
    f: &Features,
    mass: &[f64],
    model: &Model,
    state: &State,
    work: &mut Work,
) -> StepTotals {
    let dt = state.step_size.kick();
    let impulse = model.gravity * dt;
    let mut all = StepTotals::default();
    let StepTotals { sum, fastest, failure } = &mut all;
    let mut fastest2 = 0.0_f64;
    work.surface_contacts.clear();
    for ((b, booked), mass) in books.chunks_exact(f.quantities()).enumerate().zip(mass) {
        if f.beside && work.members[b].solid() {
            let totals = &work.blocks[b].totals;
            *sum += &totals.balance;
            *fastest = fastest.max(totals.fastest);
            *failure = failure.or(work.cross[b].failure).or(totals.failure);
            add_pairs(sum, work, b, [0.0; 2]);
            continue;
        }
        let of = |part: TotalsPart| &booked[f.booked(part)];
        let [spheres, planes, motion] = [TotalsPart::Spheres, TotalsPart::Planes, TotalsPart::Motion].map(of);
        let mut loss = [spheres[2] + planes[0], spheres[3] + planes[1]];
        if f.walls > 0 {
            let q = of(TotalsPart::Patches);
            loss = [loss[0] + q[0], loss[1] + q[1]];
            let sum = |q: &[f64]| WallSum { force: vector(q, 0), moment: vector(q, 3), ..WallSum::default() };
            if !f.beside {
                work.cross[b].clear_totals();
            }
            let sums = &mut work.blocks[b].patches.wall_sums;
            sums.clear();
            sums.extend(q[2..].chunks_exact(WALL_TOTALS).map(sum));
        }
        if f.beside {
            let BlockTotals { balance, failure: wrong, .. } = &work.blocks[b].totals;
            let aside = &work.blocks[b].patches.aside;
            loss = [loss[0] + aside.dashpot, loss[1] + aside.friction];
            loss = [loss[0] + balance.dissipated_dashpot, loss[1] + balance.dissipated_friction];
            sum.work_surface += balance.work_surface;
            sum.surface += &balance.surface;
            *failure = failure.or(work.cross[b].failure).or(*wrong);
        }
        sum.dissipated_dashpot += loss[0];
        sum.dissipated_friction += loss[1];
        sum.work_walls += planes[2] * dt;
        sum.walls.linear += vector(planes, 3) * dt;
        sum.walls.angular += vector(planes, 6) * dt;
        if f.beside {
            add_pairs(sum, work, b, [spheres[0], spheres[1]]);
        } else {
            sum.dissipated_dashpot += spheres[0];
            sum.dissipated_friction += spheres[1];
        }
        sum.gravity.linear += impulse * *mass;
        sum.gravity.angular += vector(motion, 0).cross(&impulse);
        fastest2 = fastest2.max(motion[3]);
        if f.held {
            add_held(sum, of(TotalsPart::Held), dt, f.damped);
        }
        if f.periodic {
            sum.periodic.angular += vector(of(TotalsPart::Images), 0);
        }
        if f.bonds {
            let q = of(TotalsPart::Bonds);
            let lists = [&mut work.bonds.cross[b], &mut work.blocks[b].bonds];
            for (k, list) in lists.into_iter().enumerate() {
                list.reset();
                list.power = q[k];
                (list.dashpot, list.friction) = (q[2 + 2 * k], q[3 + 2 * k]);
            }
        }
    }
    *fastest = fastest.max(fastest2.sqrt());
    all
}

/// Adds CPU pairs of a block, and their loss [J].
fn add_pairs(sum: &mut BalanceTerms, work: &mut Work, b: usize, [dashpot, friction]: [f64; 2]) {
    let cross = &work.cross[b];
    sum.dissipated_dashpot += dashpot + cross.dashpot;
    sum.dissipated_friction += friction + cross.friction;
    sum.work_walls += cross.work_walls;
    sum.walls += &cross.walls;
    sum.work_surface += cross.surface.work;
    sum.surface += &cross.surface.impulse;
    work.surface_contacts.extend_from_slice(&work.blocks[b].patches.contacts);
    work.surface_contacts.extend_from_slice(&cross.surface.contacts);
}

fn vector(q: &[f64], k: usize) -> Vec3 {
    Vec3::new(q[k], q[k + 1], q[k + 2])
}

fn add_held(sum: &mut BalanceTerms, q: &[f64], kick: f64, damped: bool) {
    let vector = |k: usize| vector(q, k);
    sum.work_constraints += q[7];
    sum.constraints += &Impulse { linear: vector(8), angular: vector(11) };
    if damped {
        sum.dissipated_local_damping += q[14] - q[0] * kick;
        sum.local_damping +=
            &Impulse { linear: vector(15) + vector(1) * kick, angular: vector(18) + vector(4) * kick };
    }
}
