//! Body forces computed for four bodies at a time.

use super::work::{ForceInput, ForceWork};
use crate::bodies::block::Block;
use crate::lanes::{self, Kernel, Real, Simd4, SimdPack, V3};

/// Input of such a force for four bodies.
pub(super) struct Bodies4<R> {
    /// Velocity of the centre, half a step ago [m/s].
    pub velocity: V3<R>,
    /// Radius of the volume-equivalent sphere [m].
    pub radius: R,
}

/// Force [N] and torque [N m] about the centres of four bodies.
pub(super) trait ActOnFour {
    fn act_on_four<R: Real>(&self, on: &Bodies4<R>) -> (V3<R>, V3<R>);
}

pub(super) fn act(force: &impl ActOnFour, seen: &ForceInput<'_>, work: &mut ForceWork) {
    lanes::run(seen.simd, Acting { force, block: seen.block, work });
}

struct Acting<'a, F> {
    force: &'a F,
    block: &'a Block,
    work: &'a mut ForceWork,
}

impl<F: ActOnFour> Kernel for Acting<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<P: SimdPack>(self) {
        self.by_four::<P::Quad>();
    }
}

impl<F: ActOnFour> Acting<'_, F> {
    #[inline(always)]
    fn by_four<R: Simd4>(self) {
        let Acting { force, block, work: ForceWork { radius, acting, .. } } = self;
        let n = block.bodies.len();
        for k in (0..n).step_by(4) {
            let at = [k, (k + 1).min(n - 1), (k + 2).min(n - 1), (k + 3).min(n - 1)];
            let v = &block.velocity;
            let [vx, vy, vz, _] = R::transpose([
                R::load(&v[at[0]]),
                R::load(&v[at[1]]),
                R::load(&v[at[2]]),
                R::load(&v[at[3]]),
            ]);
            let seen = Bodies4 {
                velocity: V3::new(vx, vy, vz),
                radius: R::load(&[radius[at[0]], radius[at[1]], radius[at[2]], radius[at[3]]]),
            };
            let (f, t) = force.act_on_four(&seen);
            let forces = R::transpose([f.x, f.y, f.z, R::zero()]);
            let torques = R::transpose([t.x, t.y, t.z, R::zero()]);
            for l in 0..4.min(n - k) {
                let (sum, turn) = acting[k + l].both();
                (R::load(sum) + forces[l]).store(sum);
                (R::load(turn) + torques[l]).store(turn);
            }
        }
    }
}
