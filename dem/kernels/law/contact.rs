//! Contact geometry, history and force.

use crate::base::Vec3;
use crate::lanes::{Real, V3};
use serde::{Deserialize, Serialize};

/// Contact history.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Tangential displacement of a against b [m].
    pub spring: Vec3,
    /// Normal law's number, [`NO_CONTACT`] before the first force: with dashpot the approach speed half a step
    /// before the last force [m/s].
    pub rate: f64,
    /// Rolling (three components) and twisting spring: angle of a against b × effective radius [m]; zero
    /// without resistance.
    pub turn: [f64; 4],
}

/// Marker of a new contact, finite for all file formats.
pub const NO_CONTACT: f64 = f64::MAX;

impl History {
    /// New contact.
    pub const NONE: History = History { spring: Vec3::new(0.0, 0.0, 0.0), rate: NO_CONTACT, turn: [0.0; 4] };

    /// Whether the contact is new.
    #[inline(always)]
    pub fn is_new(&self) -> bool {
        self.rate == NO_CONTACT
    }

    /// Displaces the tangential spring by `way` [m], outside a step.
    #[inline(always)]
    pub fn displace(&mut self, way: &Vec3, normal: &Vec3) {
        if !self.is_new() {
            self.spring -= way - normal * normal.dot(way);
        }
    }

    /// History for the other partner; twist keeps its sense.
    pub fn turned(&self) -> History {
        if self.is_new() {
            // Zeros keep their sign, as in steps without contact.
            return *self;
        }
        // Unstrained springs keep +0.
        let back = |x: f64| 0.0 - x;
        let [x, y, z, twist] = self.turn;
        History { spring: self.spring.map(back), rate: self.rate, turn: [back(x), back(y), back(z), twist] }
    }

    #[doc(hidden)]
    #[inline(always)]
    pub fn of(memory: &HistoryLanes<f64>) -> History {
        let &HistoryLanes { spring, rate, roll, twist } = memory;
        History { spring: spring.to_vec(), rate, turn: [roll.x, roll.y, roll.z, twist] }
    }

    #[doc(hidden)]
    #[inline(always)]
    pub fn memory(&self) -> HistoryLanes<f64> {
        let [x, y, z, twist] = self.turn;
        HistoryLanes { spring: V3::from_vec(&self.spring), rate: self.rate, roll: V3::new(x, y, z), twist }
    }
}

/// Contact force of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactForce {
    /// Force on a, opposite on b [N].
    pub force: Vec3,
    /// Normal part, compression positive, without adhesion [N].
    pub normal: f64,
    /// Rolling and twisting moment on a, opposite on b [N m].
    pub moment: Vec3,
    /// Dissipation by dashpots and permanent deformation [J].
    pub dashpot: f64,
    /// Dissipation by sliding, rolling and twisting [J].
    pub friction: f64,
}

/// Linearised contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Linearised {
    /// Normal stiffness, larger of loading and unloading [N/m].
    pub normal: f64,
    /// Tangential stiffness [N/m].
    pub tangential: f64,
    /// Normal damping [N s/m].
    pub damping: f64,
    /// Tangential damping [N s/m].
    pub tangential_damping: f64,
    /// Rolling stiffness [N m/rad].
    pub rolling: f64,
    /// Twisting stiffness [N m/rad].
    pub twisting: f64,
}

/// Law input in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawInput<R> {
    /// 1/m* = 1/m₁ + 1/m₂ [1/kg].
    pub inverse_mass: R,
    /// Effective radius [m].
    pub radius: R,
    /// Overlap [m].
    pub overlap: R,
    /// Unit normal from b to a.
    pub normal: V3<R>,
    /// Velocity of a minus b at the contact point, last half step [m/s].
    pub velocity: V3<R>,
    /// Angular velocity of a minus b, last half step [rad/s].
    pub spin: V3<R>,
}

/// [`History`] in lanes.
#[derive(Clone, Copy, Debug)]
pub struct HistoryLanes<R> {
    /// Tangential spring [m].
    pub spring: V3<R>,
    /// Normal law's number, or [`NO_CONTACT`].
    pub rate: R,
    /// Rolling spring [m].
    pub roll: V3<R>,
    /// Twisting spring [m].
    pub twist: R,
}

impl<R: Real> HistoryLanes<R> {
    #[doc(hidden)]
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: &HistoryLanes<R>, no: &HistoryLanes<R>) -> HistoryLanes<R> {
        HistoryLanes {
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
    /// Dashpot and deformation loss [J].
    pub dashpot: R,
    /// Sliding, rolling and twisting loss [J].
    pub friction: R,
}

impl<R: Real> LawOutput<R> {
    #[doc(hidden)]
    #[inline(always)]
    pub fn none() -> LawOutput<R> {
        let (zero, vector) = (R::zero(), V3::zero());
        LawOutput { force: vector, normal: zero, moment: vector, dashpot: zero, friction: zero }
    }

    #[doc(hidden)]
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: &LawOutput<R>, no: &LawOutput<R>) -> LawOutput<R> {
        LawOutput {
            force: V3::select(mask, yes.force, no.force),
            normal: R::select(mask, yes.normal, no.normal),
            moment: V3::select(mask, yes.moment, no.moment),
            dashpot: R::select(mask, yes.dashpot, no.dashpot),
            friction: R::select(mask, yes.friction, no.friction),
        }
    }
}
