//! Records formulas over [`Real`] as C source.
//!
//! Guards `any` record as true, `all` as false: both branches are written and selected by mask.

use crate::lanes::{Real, V3};
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Write;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Operation; operands are indices of earlier operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Op {
    Constant(u64),
    Input(u32),
    Negate(u32),
    Sqrt(u32),
    Abs(u32),
    Infix(&'static str, u32, u32),
    Min(u32, u32),
    Max(u32, u32),
    Not(u32),
    Select(u32, u32, u32),
}

impl Op {
    fn operands(&self) -> [Option<u32>; 3] {
        match *self {
            Op::Constant(_) | Op::Input(_) => [None; 3],
            Op::Negate(a) | Op::Sqrt(a) | Op::Abs(a) | Op::Not(a) => [Some(a), None, None],
            Op::Infix(_, a, b) | Op::Min(a, b) | Op::Max(a, b) => [Some(a), Some(b), None],
            Op::Select(m, a, b) => [Some(m), Some(a), Some(b)],
        }
    }

    fn is_truth(&self) -> bool {
        matches!(self, Op::Not(_) | Op::Infix("<" | "<=" | "==" | "&" | "|", ..))
    }
}

#[derive(Default)]
struct Tape {
    ops: Vec<Op>,
    known: HashMap<Op, u32>,
    inputs: Vec<String>,
    counted: usize,
    values: Vec<f64>,
}

thread_local!(static TAPE: RefCell<Tape> = RefCell::default());

fn put(op: Op) -> u32 {
    TAPE.with_borrow_mut(|t| {
        let Tape { ops, known, .. } = t;
        *known.entry(op).or_insert_with(|| {
            ops.push(op);
            ops.len() as u32 - 1
        })
    })
}

/// Not inlined: hundreds of calls per formula made a third of the engine's code.
#[cold]
#[inline(never)]
fn infix(sign: &'static str, a: u32, b: u32) -> u32 {
    put(Op::Infix(sign, a, b))
}

/// As [`infix`], for one operand.
#[cold]
#[inline(never)]
fn prefix(op: fn(u32) -> Op, a: u32) -> u32 {
    put(op(a))
}

/// As [`infix`], for a constant.
#[cold]
#[inline(never)]
fn constant(x: f64) -> Recorded {
    Recorded(put(Op::Constant(x.to_bits())))
}

/// Number on this thread's tape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorded(u32);

/// Truth value known while recording, or on the tape.
#[derive(Clone, Copy, Debug)]
pub(super) enum RecordedMask {
    Known(bool),
    Open(u32),
}

pub(super) fn begin() {
    TAPE.set(Tape::default());
}

#[cold]
#[inline(never)]
fn named(expression: String) -> u32 {
    let k = TAPE.with_borrow_mut(|t| {
        t.inputs.push(expression);
        t.inputs.len() as u32 - 1
    });
    put(Op::Input(k))
}

/// Records a C expression as a number.
pub(super) fn input(expression: impl Into<String>) -> Recorded {
    Recorded(named(expression.into()))
}

#[cold]
#[inline(never)]
pub(super) fn vector(record: &str) -> V3<Recorded> {
    V3::new(input(format!("{record}.x")), input(format!("{record}.y")), input(format!("{record}.z")))
}

/// Records a C expression as a truth value.
pub(super) fn truth(expression: &str) -> RecordedMask {
    RecordedMask::Open(named(expression.into()))
}

/// Returns the next of the constants `k[0]`, `k[1]`, … in order of calls.
pub(super) fn next(_: &[f64; 8]) -> Recorded {
    let k = TAPE.with_borrow_mut(|t| {
        t.counted += 1;
        t.counted - 1
    });
    input(format!("k[{k}]"))
}

/// Stores the value of a constant; see [`values`].
pub(super) fn value(x: &[f64; 8]) -> Recorded {
    TAPE.with_borrow_mut(|t| t.values.push(x[0]));
    Recorded::splat(x[0])
}

/// Values stored since [`begin`], in the order of [`next`].
pub(super) fn values() -> Vec<f64> {
    TAPE.with_borrow(|t| t.values.clone())
}

macro_rules! infix {
    ($trait:ident, $f:ident, $sign:literal) => {
        impl $trait for Recorded {
            type Output = Recorded;
            fn $f(self, o: Recorded) -> Recorded {
                Recorded(infix($sign, self.0, o.0))
            }
        }
    };
}
infix!(Add, add, "+");
infix!(Sub, sub, "-");
infix!(Mul, mul, "*");
infix!(Div, div, "/");

impl Neg for Recorded {
    type Output = Recorded;
    fn neg(self) -> Recorded {
        Recorded(prefix(Op::Negate, self.0))
    }
}

impl BitAnd for RecordedMask {
    type Output = RecordedMask;
    #[inline(never)]
    fn bitand(self, o: RecordedMask) -> RecordedMask {
        match (self, o) {
            (RecordedMask::Known(true), x) | (x, RecordedMask::Known(true)) => x,
            (RecordedMask::Known(false), _) | (_, RecordedMask::Known(false)) => RecordedMask::Known(false),
            (RecordedMask::Open(a), RecordedMask::Open(b)) => RecordedMask::Open(infix("&", a, b)),
        }
    }
}

impl BitOr for RecordedMask {
    type Output = RecordedMask;
    #[inline(never)]
    fn bitor(self, o: RecordedMask) -> RecordedMask {
        match (self, o) {
            (RecordedMask::Known(false), x) | (x, RecordedMask::Known(false)) => x,
            (RecordedMask::Known(true), _) | (_, RecordedMask::Known(true)) => RecordedMask::Known(true),
            (RecordedMask::Open(a), RecordedMask::Open(b)) => RecordedMask::Open(infix("|", a, b)),
        }
    }
}

impl Not for RecordedMask {
    type Output = RecordedMask;
    #[inline(never)]
    fn not(self) -> RecordedMask {
        match self {
            RecordedMask::Known(x) => RecordedMask::Known(!x),
            RecordedMask::Open(a) => RecordedMask::Open(put(Op::Not(a))),
        }
    }
}

impl Real for Recorded {
    type Mask = RecordedMask;
    const RECORDS: bool = true;

    fn splat(x: f64) -> Recorded {
        constant(x)
    }
    fn sqrt(self) -> Recorded {
        Recorded(prefix(Op::Sqrt, self.0))
    }
    fn abs(self) -> Recorded {
        Recorded(prefix(Op::Abs, self.0))
    }
    #[inline(never)]
    fn min(self, o: Recorded) -> Recorded {
        Recorded(put(Op::Min(self.0, o.0)))
    }
    #[inline(never)]
    fn max(self, o: Recorded) -> Recorded {
        Recorded(put(Op::Max(self.0, o.0)))
    }
    fn lt(self, o: Recorded) -> RecordedMask {
        RecordedMask::Open(infix("<", self.0, o.0))
    }
    fn le(self, o: Recorded) -> RecordedMask {
        RecordedMask::Open(infix("<=", self.0, o.0))
    }
    fn equals(self, o: Recorded) -> RecordedMask {
        RecordedMask::Open(infix("==", self.0, o.0))
    }
    #[inline(never)]
    fn select(mask: RecordedMask, yes: Recorded, no: Recorded) -> Recorded {
        match mask {
            RecordedMask::Known(true) => yes,
            RecordedMask::Known(false) => no,
            RecordedMask::Open(_) if yes.0 == no.0 => yes,
            RecordedMask::Open(m) => Recorded(put(Op::Select(m, yes.0, no.0))),
        }
    }
    fn any(mask: RecordedMask) -> bool {
        !matches!(mask, RecordedMask::Known(false))
    }
    fn all(mask: RecordedMask) -> bool {
        matches!(mask, RecordedMask::Known(true))
    }
}

#[derive(Default)]
pub(super) struct Results(Vec<(String, u32)>);

impl Results {
    pub fn number(&mut self, to: impl Into<String>, x: Recorded) {
        self.0.push((to.into(), x.0));
    }

    /// Assigns x, y, z of a C structure.
    pub fn vector(&mut self, to: &str, v: V3<Recorded>) {
        for (c, x) in ["x", "y", "z"].iter().zip(v.array()) {
            self.number(format!("{to}.{c}"), x);
        }
    }

    /// Assigns consecutive vectors of a C array.
    pub fn row(&mut self, to: &str, list: &[V3<Recorded>]) {
        let numbers = list.iter().flat_map(|v| v.array());
        numbers.enumerate().for_each(|(k, x)| self.number(format!("{to}[{k}]"), x));
    }

    pub fn truth(&mut self, to: &str, t: RecordedMask) {
        match t {
            RecordedMask::Open(k) => self.0.push((to.into(), k)),
            RecordedMask::Known(x) => self.0.push((to.into(), Recorded::splat(f64::from(x)).0)),
        }
    }

    pub fn text(&self) -> String {
        TAPE.with_borrow(|t| {
            let mut live = vec![false; t.ops.len()];
            self.0.iter().for_each(|(_, k)| live[*k as usize] = true);
            for k in (0..t.ops.len()).rev() {
                if live[k] {
                    t.ops[k].operands().into_iter().flatten().for_each(|a| live[a as usize] = true);
                }
            }
            let mut out = String::from("    {\n");
            for (k, op) in t.ops.iter().enumerate().filter(|(k, _)| live[*k]) {
                if let Some(expression) = t.expression(op) {
                    let kind = if op.is_truth() { "int" } else { "real" };
                    _ = writeln!(out, "    const {kind} t{k} = {expression};");
                }
            }
            for (to, k) in &self.0 {
                _ = writeln!(out, "    {to} = {};", t.operand(*k));
            }
            out.push_str("    }\n");
            out
        })
    }
}

impl Tape {
    /// C expression of an operation; `None` if written where it is used.
    fn expression(&self, op: &Op) -> Option<String> {
        let of = |k: u32| self.operand(k);
        Some(match *op {
            Op::Constant(_) | Op::Input(_) => return None,
            Op::Negate(a) => format!("-{}", of(a)),
            Op::Sqrt(a) => format!("sqrt({})", of(a)),
            Op::Abs(a) => format!("fabs({})", of(a)),
            Op::Infix(sign, a, b) => format!("{} {sign} {}", of(a), of(b)),
            Op::Min(a, b) => format!("{0} < {1} ? {0} : {1}", of(a), of(b)),
            Op::Max(a, b) => format!("{0} > {1} ? {0} : {1}", of(a), of(b)),
            Op::Not(a) => format!("!{}", of(a)),
            Op::Select(m, a, b) => format!("{} ? {} : {}", of(m), of(a), of(b)),
        })
    }

    fn operand(&self, k: u32) -> String {
        match self.ops[k as usize] {
            Op::Constant(bits) => literal(f64::from_bits(bits)),
            Op::Input(i) => self.inputs[i as usize].clone(),
            _ => format!("t{k}"),
        }
    }
}

/// Number with all digits.
pub(super) fn literal(x: f64) -> String {
    let bits = x.to_bits();
    let (exponent, digits) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let text = match (exponent, digits) {
        (0, 0) => "0.0".to_string(),
        (0, _) => format!("0x0.{digits:013x}p-1022"),
        (0x7ff, 0) => "ENDLESS".to_string(),
        _ => format!("0x1.{digits:013x}p{}", exponent as i64 - 1023),
    };
    if bits >> 63 == 1 { format!("(-{text})") } else { text }
}
