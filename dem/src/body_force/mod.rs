//! Body forces: what acts on bodies without a partner. A stage of the step between contacts and motion, which works on four
//! bodies at a time and leaves their motion as it is; a model without body forces has no such stage. (Gravity and local
//! damping belong to the motion itself: one is the same acceleration for all, the other needs the sum of all forces.)
//!
//! A body force is one file with an `Act` and one line in `body_forces!`.
//!
//! Velocities are those of half a step ago, so a force that depends on them is right to first order in the share of the
//! velocity that it takes in a step. Its work is booked exactly for translation, and with the spins before and after the step
//! for rotation.

mod wind;

pub use wind::Wind;

use crate::base::Vec3;
use crate::base::held::held;
use crate::base::ledger::Ledger;
use crate::bodies::block::Block;
use crate::bodies::sums::Sums;
use crate::lanes::record::xyz;
use crate::lanes::{self, Four, Kernel, Pack, Real, Simd, V3};

/// Four bodies as a body force sees them; one that depends on more adds it here.
pub(crate) struct Seen<R> {
    /// Velocity of the centre half a step ago [m/s].
    pub velocity: V3<R>,
    /// Radius of the sphere of the body's volume [m].
    pub radius: R,
}

/// A body force: the force [N] on four bodies at their centres, and the torque about them [N m].
pub(crate) trait Act {
    fn act<R: Real>(&self, on: &Seen<R>) -> (V3<R>, V3<R>);
}

/// Writes the list of all body forces.
macro_rules! body_forces {
    ($($name:ident = $source:expr),+ $(,)?) => {
        /// A body force.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum BodyForce {
            $(
                #[doc = concat!("See [`", stringify!($name), "`].")]
                $name($name)
            ),+
        }

        impl BodyForce {
            fn on_block(&self, simd: Simd, block: &Block, work: &mut ForceWork) {
                match self { $(BodyForce::$name(force) => lanes::run(simd, Acting { force, block, work })),+ }
            }

            /// Where it is published.
            pub fn source(&self) -> &'static str {
                match self { $(BodyForce::$name(_) => $source),+ }
            }

            /// What of it is out of range: quantity, value and requirement.
            pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
                match self { $(BodyForce::$name(force) => force.fault()),+ }
            }
        }
    };
}

body_forces! {
    Wind = wind::SOURCE,
}

/// Scratch of a block: empty in models without body forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForceWork {
    /// Radii of spheres of the bodies' volumes [m], in block order.
    radius: Vec<f64>,
    /// Force and torque on each body in the step at hand.
    acting: Vec<Sums>,
    /// Their power before the kick [W].
    power: f64,
}

impl ForceWork {
    /// Lays itself out for bodies in the order of their block, given the volume of a body [m³] by number.
    pub fn arrange(&mut self, block: &Block, volume: impl Fn(usize) -> f64) {
        let radius = |v: f64| libm::cbrt(v * 0.75 / std::f64::consts::PI);
        self.radius.clear();
        self.radius.extend(block.bodies.iter().map(|&b| radius(volume(b as usize))));
    }

    /// Adds the forces on the bodies of a block to `sums`, and books their impulse over `kick` [s].
    pub fn act(
        &mut self,
        simd: Simd,
        forces: &[BodyForce],
        block: &Block,
        sums: &mut [Sums],
        ledger: &mut Ledger,
        kick: f64,
    ) {
        self.acting.clear();
        self.acting.resize(block.bodies.len(), Sums::default());
        for force in forces {
            force.on_block(simd, block, self);
        }
        for ((sum, own), centre) in sums.iter_mut().zip(&self.acting).zip(&block.centre) {
            let (force, torque) = (xyz(own.force()), xyz(own.torque()));
            sum.push(&force, &torque);
            ledger.body_forces.add(&xyz(centre), &(force * kick));
            ledger.body_forces.angular += torque * kick;
        }
        self.power = self.power_on(block);
    }

    /// Books the work of the forces of this step, after the bodies have moved.
    pub fn book(&self, block: &Block, ledger: &mut Ledger, kick: f64) {
        ledger.work_body_forces += 0.5 * (self.power + self.power_on(block)) * kick;
    }

    /// Power with the velocities of the block as they are [W].
    fn power_on(&self, block: &Block) -> f64 {
        let of = |(k, own): (usize, &Sums)| {
            let (v, w): (Vec3, Vec3) = (xyz(&block.velocity[k]), xyz(&block.spin[k]));
            xyz(own.force()).dot(&v) + xyz(own.torque()).dot(&w)
        };
        self.acting.iter().enumerate().map(of).sum()
    }

    /// Bytes held between steps.
    pub fn bytes(&self) -> usize {
        held(&self.radius) + held(&self.acting)
    }
}

/// Adds one force on the bodies of a block to what acts on them.
struct Acting<'a, F> {
    force: &'a F,
    block: &'a Block,
    work: &'a mut ForceWork,
}

impl<F: Act> Kernel for Acting<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<P: Pack>(self) {
        self.by_four::<P::Quad>();
    }
}

impl<F: Act> Acting<'_, F> {
    #[inline(always)]
    fn by_four<R: Four>(self) {
        let Acting { force, block, work: ForceWork { radius, acting, .. } } = self;
        let n = block.bodies.len();
        for k in (0..n).step_by(4) {
            // The last four may be fewer: the lanes beyond see the last body again, and nobody reads them.
            let at = [k, (k + 1).min(n - 1), (k + 2).min(n - 1), (k + 3).min(n - 1)];
            let v = &block.velocity;
            let [vx, vy, vz, _] = R::transpose([
                R::load(&v[at[0]]),
                R::load(&v[at[1]]),
                R::load(&v[at[2]]),
                R::load(&v[at[3]]),
            ]);
            let seen = Seen {
                velocity: V3::new(vx, vy, vz),
                radius: R::load(&[radius[at[0]], radius[at[1]], radius[at[2]], radius[at[3]]]),
            };
            let (f, t) = force.act(&seen);
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
