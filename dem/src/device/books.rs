//! What the blocks of a device book, added up as the engine adds up its own.

use super::layout::{Booked, Features, WALL_BOOKED};
use crate::base::Vec3;
use crate::base::ledger::{Impulse, Ledger};
use crate::bodies::sums::WallSum;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::step::Collected;
use crate::engine::work::Work;

/// Adds up what the blocks have booked in a step, block by block, each number where the engine's loops would; what walls and bonds
/// take block by block goes to `work`. `mass`: of the bodies of each block [kg].
pub(super) fn add_up(
    books: &[f64],
    f: &Features,
    mass: &[f64],
    model: &Model,
    state: &State,
    work: &mut Work,
) -> Collected {
    let dt = state.pace.kick();
    let impulse = model.gravity * dt;
    let mut all = Collected::default();
    let sum = &mut all.sum;
    let mut fastest2 = 0.0_f64;
    for ((b, all), mass) in books.chunks_exact(f.quantities()).enumerate().zip(mass) {
        let of = |part: Booked| &all[f.booked(part)];
        let (spheres, planes, motion) = (of(Booked::Spheres), of(Booked::Planes), of(Booked::Motion));
        let mut spent = [spheres[2] + planes[0], spheres[3] + planes[1]];
        if f.walls > 0 {
            let q = of(Booked::Patches);
            spent = [spent[0] + q[0], spent[1] + q[1]];
            let sum = |q: &[f64]| WallSum { force: vector(q, 0), moment: vector(q, 3), ..WallSum::default() };
            work.cross[b].clear_books();
            let sums = &mut work.blocks[b].patches.wall_sums;
            sums.clear();
            sums.extend(q[2..].chunks_exact(WALL_BOOKED).map(sum));
        }
        // Of contacts within the block and with planes, then of those across.
        for (to, own, across) in [
            (&mut sum.dissipated_dashpot, spent[0], spheres[0]),
            (&mut sum.dissipated_friction, spent[1], spheres[1]),
        ] {
            *to += own;
            *to += across;
        }
        sum.work_walls += planes[2] * dt;
        sum.walls.linear += vector(planes, 3) * dt;
        sum.walls.angular += vector(planes, 6) * dt;
        sum.gravity.linear += impulse * *mass;
        sum.gravity.angular += vector(motion, 0).cross(&impulse);
        fastest2 = fastest2.max(motion[3]);
        if f.held {
            add_held(sum, of(Booked::Held), dt, f.damped);
        }
        if f.periodic {
            sum.periodic.angular += vector(of(Booked::Images), 0);
        }
        if f.bonds {
            let q = of(Booked::Bonds);
            let lists = [&mut work.bonds.cross[b], &mut work.blocks[b].bonds];
            for (k, list) in lists.into_iter().enumerate() {
                list.reset();
                list.power = q[k];
                (list.dashpot, list.friction) = (q[2 + 2 * k], q[3 + 2 * k]);
            }
        }
    }
    all.fastest = fastest2.sqrt();
    all
}

fn vector(q: &[f64], k: usize) -> Vec3 {
    Vec3::new(q[k], q[k + 1], q[k + 2])
}

/// Adds what local damping and fixed motions did to a block.
fn add_held(sum: &mut Ledger, q: &[f64], kick: f64, damped: bool) {
    let vector = |k: usize| vector(q, k);
    sum.work_constraints += q[7];
    sum.constraints += &Impulse { linear: vector(8), angular: vector(11) };
    if damped {
        sum.dissipated_local_damping += q[14] - q[0] * kick;
        sum.local_damping +=
            &Impulse { linear: vector(15) + vector(1) * kick, angular: vector(18) + vector(4) * kick };
    }
}
