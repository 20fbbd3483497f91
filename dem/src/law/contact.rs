//! A contact as detection finds it, what it remembers, and what a law makes of it: one by one and in lanes.

use crate::base::Vec3;
use crate::lanes::{Real, V3};
use serde::{Deserialize, Serialize};

/// Where and how two partners touch. "a" is the partner the force is computed for, "b" the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// The one point where the force acts on both [m].
    pub point: Vec3,
    /// Unit normal, from b to a.
    pub normal: Vec3,
    /// Overlap, positive in contact [m].
    pub overlap: f64,
    /// Effective radius 1/(1/R₁ + 1/R₂) [m].
    pub radius: f64,
}

/// Memory of one contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Tangential spring: displacement of a against b that still pulls back [m].
    pub spring: Vec3,
    /// The one number that the normal part of the law keeps, [`FRESH`] before the first force: the approach speed half a
    /// step before the last force where it has a dashpot [m/s], or what its file states.
    pub rate: f64,
    /// Rolling spring (three components) and twisting spring: angles of a against b that still turn back, times the
    /// effective radius [m]. Zero where neither resistance is modelled.
    pub turn: [f64; 4],
}

/// Marks a history without a contact (finite, so that every format can hold it).
pub const FRESH: f64 = f64::MAX;

impl History {
    /// Memory of a contact that has not begun.
    pub const NONE: History = History { spring: Vec3::new(0.0, 0.0, 0.0), rate: FRESH, turn: [0.0; 4] };

    /// Whether the contact has not begun.
    #[inline(always)]
    pub fn is_fresh(&self) -> bool {
        self.rate == FRESH
    }

    /// Moves the partner of the tangential spring by `way` [m] where no step has: the part across `normal` counts.
    #[inline(always)]
    pub(crate) fn displace(&mut self, way: &Vec3, normal: &Vec3) {
        if !self.is_fresh() {
            self.spring -= way - normal * normal.dot(way);
        }
    }

    /// The same contact seen from the other partner. A twist has the same sense from both sides.
    pub(crate) fn turned(&self) -> History {
        if self.is_fresh() {
            // No zero gets a sign that a step without a contact would not take away from it.
            return *self;
        }
        // Likewise of springs that nothing has strained: less than zero by nothing is zero.
        let back = |x: f64| 0.0 - x;
        let [x, y, z, twist] = self.turn;
        History { spring: self.spring.map(back), rate: self.rate, turn: [back(x), back(y), back(z), twist] }
    }

    /// Of one lane.
    #[inline(always)]
    pub(crate) fn of(memory: &Memory<f64>) -> History {
        let &Memory { spring, rate, roll, twist } = memory;
        History { spring: spring.to_vec(), rate, turn: [roll.x, roll.y, roll.z, twist] }
    }

    /// In one lane.
    #[inline(always)]
    pub(crate) fn memory(&self) -> Memory<f64> {
        let [x, y, z, twist] = self.turn;
        Memory { spring: V3::from_vec(&self.spring), rate: self.rate, roll: V3::new(x, y, z), twist }
    }
}

/// What a law makes of one contact in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Force on a [N]; b takes the opposite.
    pub force: Vec3,
    /// Its normal part, pressure positive [N], less adhesion.
    pub normal: f64,
    /// Moment of rolling and twisting resistance on a [N m]; b takes the opposite.
    pub moment: Vec3,
    /// Energy dissipated by dashpots and lasting deformation in this step [J].
    pub dashpot: f64,
    /// Energy dissipated by sliding, rolling and twisting in this step [J].
    pub friction: f64,
}

/// A contact as springs and dashpots about where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Linearised {
    /// Stiffness along the normal [N/m], the larger of loading and unloading.
    pub normal: f64,
    /// Stiffness across it [N/m].
    pub tangential: f64,
    /// Dashpot along the normal [N s/m].
    pub damping: f64,
    /// Dashpot across it [N s/m].
    pub tangential_damping: f64,
    /// Rolling stiffness [N m/rad].
    pub rolling: f64,
    /// Twisting stiffness [N m/rad].
    pub twisting: f64,
}

/// Contacts as a law sees them, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawInput<R> {
    /// Sum of the inverse masses of the bodies, 1/m* = 1/m₁ + 1/m₂ [1/kg].
    pub inverse_mass: R,
    /// Effective radius [m].
    pub radius: R,
    /// Overlap [m].
    pub overlap: R,
    /// Unit normal from b to a.
    pub normal: V3<R>,
    /// Velocity of a relative to b at the contact point, half a step ago [m/s].
    pub velocity: V3<R>,
    /// Spin of a less that of b, half a step ago [rad/s].
    pub spin: V3<R>,
}

/// [`History`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct Memory<R> {
    /// Tangential spring [m].
    pub spring: V3<R>,
    /// The number of the normal law, or [`FRESH`].
    pub rate: R,
    /// Rolling spring [m].
    pub roll: V3<R>,
    /// Twisting spring [m].
    pub twist: R,
}

impl<R: Real> Memory<R> {
    /// `yes` where the mask holds, else `no`.
    #[inline(always)]
    pub(crate) fn select(mask: R::Mask, yes: &Memory<R>, no: &Memory<R>) -> Memory<R> {
        Memory {
            spring: V3::select(mask, yes.spring, no.spring),
            rate: R::select(mask, yes.rate, no.rate),
            roll: V3::select(mask, yes.roll, no.roll),
            twist: R::select(mask, yes.twist, no.twist),
        }
    }
}

/// [`ContactForce`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawOutput<R> {
    /// Force on a [N].
    pub force: V3<R>,
    /// Normal force [N].
    pub normal: R,
    /// Moment on a [N m].
    pub moment: V3<R>,
    /// Energy dissipated by dashpots and lasting deformation [J].
    pub dashpot: R,
    /// Energy dissipated by sliding, rolling and twisting [J].
    pub friction: R,
}

impl<R: Real> LawOutput<R> {
    /// No force.
    #[inline(always)]
    pub(crate) fn none() -> LawOutput<R> {
        let (zero, vector) = (R::zero(), V3::zero());
        LawOutput { force: vector, normal: zero, moment: vector, dashpot: zero, friction: zero }
    }

    /// `yes` where the mask holds, else `no`.
    #[inline(always)]
    pub(crate) fn select(mask: R::Mask, yes: &LawOutput<R>, no: &LawOutput<R>) -> LawOutput<R> {
        LawOutput {
            force: V3::select(mask, yes.force, no.force),
            normal: R::select(mask, yes.normal, no.normal),
            moment: V3::select(mask, yes.moment, no.moment),
            dashpot: R::select(mask, yes.dashpot, no.dashpot),
            friction: R::select(mask, yes.friction, no.friction),
        }
    }
}
