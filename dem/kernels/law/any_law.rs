//! Several laws in one model. Lanes evaluate every law present and select by mask.

use super::contact::{HistoryLanes, LawInput, LawOutput};
use super::contact_law::ContactLaw;
use crate::lanes::Real;

macro_rules! combinations {
    ($($row:ident($normal:ty, $tangential:ty) = $title:literal),+ $(,)?) => {
        /// All law combinations.
        pub const COMBINATIONS: &[LawInfo] =
            &[$(LawInfo::of::<$normal, $tangential>($title)),+];

        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(super) enum Row { $($row),+ }

        /// Any row of the table.
        #[derive(Clone, Copy, Debug)]
        pub enum AnyLaw {
            $(
                #[doc = $title]
                $row(Composed<$normal, $tangential>)
            ),+
        }

        /// Constants of all rows, and the row of each lane.
        #[derive(Clone, Copy, Debug)]
        #[allow(non_snake_case)]
        pub struct AnyLawLanes<R: $crate::lanes::Real> {
            number: R,
            $($row: <Composed<$normal, $tangential> as $crate::law::constants::Constants>::Lanes<R>),+
        }

        impl AnyLaw {
            #[inline(always)]
            fn number(&self) -> f64 {
                match self { $(AnyLaw::$row(_) => Row::$row as usize as f64),+ }
            }
        }

        impl $crate::law::constants::Constants for AnyLaw {
            type Lanes<R: $crate::lanes::Real> = AnyLawLanes<R>;

            const ZERO: AnyLaw = {
                [$(AnyLaw::$row(<Composed<$normal, $tangential> as $crate::law::constants::Constants>::ZERO)),+][0]
            };

            #[inline(always)]
            fn splat<R: $crate::lanes::Real>(&self) -> AnyLawLanes<R> {
                AnyLawLanes {
                    number: R::splat(self.number()),
                    $($row: match self {
                        AnyLaw::$row(own) => own.splat(),
                        _ => <Composed<$normal, $tangential> as $crate::law::constants::Constants>::ZERO.splat(),
                    }),+
                }
            }

            #[inline(always)]
            fn mixed<R: $crate::lanes::Real>(all: [&AnyLaw; 8], join: fn(&[f64; 8]) -> R) -> AnyLawLanes<R> {
                AnyLawLanes {
                    number: join(&all.map(|law| law.number())),
                    $($row: {
                        let zero = <Composed<$normal, $tangential> as $crate::law::constants::Constants>::ZERO;
                        let own = all.map(|law| if let AnyLaw::$row(own) = law { *own } else { zero });
                        let [a, b, c, d, e, f, g, h] = &own;
                        $crate::law::constants::Constants::mixed([a, b, c, d, e, f, g, h], join)
                    }),+
                }
            }
        }

        impl ContactLaw for AnyLaw {
            fn mix(pair: &Pair<'_>) -> AnyLaw {
                let number = select_law(pair).ok().flatten().unwrap_or(0);
                [$(|pair: &Pair<'_>| AnyLaw::$row(ContactLaw::mix(pair))),+][number](pair)
            }

            fn with_friction(&self, friction: f64) -> AnyLaw {
                match self { $(AnyLaw::$row(own) => AnyLaw::$row(own.with_friction(friction))),+ }
            }

            #[inline(always)]
            fn evaluate<R: $crate::lanes::Real, const ROLLING: bool>(
                law: &AnyLawLanes<R>,
                touch: &$crate::law::contact::LawInput<R>,
                memory: &mut $crate::law::contact::HistoryLanes<R>,
                on: R::Mask,
                step: R,
            ) -> $crate::law::contact::LawOutput<R> {
                use $crate::law::contact::{LawOutput, HistoryLanes};
                let before = *memory;
                let mut out = LawOutput::none();
                $({
                    let own = law.number.equals(R::splat(Row::$row as usize as f64)) & on;
                    if R::any(own) {
                        let mut after = before;
                        let force = $crate::law::any_law::row::<Composed<$normal, $tangential>, R, ROLLING>(
                            &law.$row, touch, &mut after, own, step,
                        );
                        out = LawOutput::select(own, &force, &out);
                        *memory = HistoryLanes::select(own, &after, memory);
                    }
                })+
                out
            }

            #[inline(always)]
            fn tangential_energy<R: $crate::lanes::Real, const ROLLING: bool>(
                law: &AnyLawLanes<R>,
                memory: &$crate::law::contact::HistoryLanes<R>,
            ) -> R {
                let mut out = R::zero();
                $({
                    let own = law.number.equals(R::splat(Row::$row as usize as f64));
                    let left = <Composed<$normal, $tangential>>::tangential_energy::<R, ROLLING>(&law.$row, memory);
                    out = R::select(own, left, out);
                })+
                out
            }

            $crate::law::any_law::of_each_row! { $($row),+ => {
                stored(overlap: f64, radius: f64, history: &$crate::law::contact::History) -> (f64, f64), (overlap, radius, history);
                springs(overlap: f64, radius: f64, history: &$crate::law::contact::History) -> (f64, f64), (overlap, radius, history);
                friction_limit(overlap: f64, radius: f64, history: &$crate::law::contact::History) -> (f64, f64), (overlap, radius, history);
                loading(overlap: f64, radius: f64) -> (f64, f64), (overlap, radius);
                stiffness(overlap: f64, radius: f64) -> f64, (overlap, radius);
                linearised(mass: f64, radius: f64, overlap: f64, history: &$crate::law::contact::History) -> $crate::law::contact::Linearised, (mass, radius, overlap, history);
                tangential_ratio() -> f64, ();
                damping_ratio() -> f64, ();
                loss() -> f64, ();
                expected_overlap(expected: &$crate::law::normal::Expected) -> f64, (expected);
                initial_state(approach: f64) -> f64, (approach);
                rolls() -> bool, ();
                names() -> [&'static str; 2], ();
                sources() -> Vec<&'static str>, ();
            } }
        }
    };
}
pub(super) use combinations;

/// Evaluates one row, by a call where [`Real::CALLS`].
#[inline(always)]
pub(super) fn row<L: ContactLaw, R: Real, const ROLLING: bool>(
    law: &L::Lanes<R>,
    touch: &LawInput<R>,
    memory: &mut HistoryLanes<R>,
    on: R::Mask,
    step: R,
) -> LawOutput<R> {
    if R::CALLS {
        called::<L, R, ROLLING>(law, touch, memory, on, step)
    } else {
        L::evaluate::<R, ROLLING>(law, touch, memory, on, step)
    }
}

#[inline(never)]
fn called<L: ContactLaw, R: Real, const ROLLING: bool>(
    law: &L::Lanes<R>,
    touch: &LawInput<R>,
    memory: &mut HistoryLanes<R>,
    on: R::Mask,
    step: R,
) -> LawOutput<R> {
    L::evaluate::<R, ROLLING>(law, touch, memory, on, step)
}

/// Forwards to the row's law.
macro_rules! of_each_row {
    ($($row:ident),+ => {}) => {};
    ($($row:ident),+ => {
        $name:ident($($arg:ident: $type:ty),*) -> $out:ty, $call:tt; $($rest:tt)*
    }) => {
        #[inline(always)]
        fn $name(&self, $($arg: $type),*) -> $out {
            match self { $(Self::$row(law) => law.$name $call),+ }
        }
        $crate::law::any_law::of_each_row! { $($row),+ => { $($rest)* } }
    };
}
pub(super) use of_each_row;
