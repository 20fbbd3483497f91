//! Formulas as lists of operations, evaluated over [`Real`] and with derivatives.

use crate::lanes::Real;
use std::mem::MaybeUninit;

/// Most operations of a formula.
pub const MOST_OPERATIONS: usize = 64;

/// Quantity of a contact that formulas name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// Overlap [m].
    Overlap,
    /// Largest overlap of the contact so far [m].
    Largest,
    /// Largest overlap before this step [m].
    LargestBefore,
    /// Effective radius [m].
    Radius,
    /// Inverse effective mass [1/kg].
    InverseMass,
    /// Time step [s].
    Step,
    /// Stiffness of the pair [N/m].
    Stiffness,
    /// Effective modulus of the pair [Pa].
    Modulus,
    /// Damping ratio of the restitution [-].
    DampingRatio,
    /// Restitution [-].
    Restitution,
}

/// Variables and their names.
pub const VARIABLES: [(&str, Variable); 10] = [
    ("d", Variable::Overlap),
    ("D", Variable::Largest),
    ("D0", Variable::LargestBefore),
    ("R", Variable::Radius),
    ("w", Variable::InverseMass),
    ("dt", Variable::Step),
    ("K", Variable::Stiffness),
    ("E", Variable::Modulus),
    ("zeta", Variable::DampingRatio),
    ("e", Variable::Restitution),
];

/// Values of [`VARIABLES`], in their order.
pub type Values<R> = [R; VARIABLES.len()];

/// Operation; operands are indices of earlier operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operation {
    Constant(f64),
    Variable(Variable),
    Negate(u8),
    Sqrt(u8),
    Abs(u8),
    Add(u8, u8),
    Subtract(u8, u8),
    Multiply(u8, u8),
    Divide(u8, u8),
    Min(u8, u8),
    Max(u8, u8),
    /// If the first is below the second, the third, else the fourth.
    Below(u8, u8, u8, u8),
}

/// One formula, or several that share operations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    operations: Vec<Operation>,
    results: Vec<u8>,
}

/// More than [`MOST_OPERATIONS`].
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("more than {MOST_OPERATIONS} operations")]
pub struct TooLong;

impl Program {
    /// Adds an operation, folds constants, returns its index; equal operations are shared.
    pub(super) fn put(&mut self, operation: Operation) -> Result<u8, TooLong> {
        let operation = self.folded(operation);
        if let Some(k) = self.operations.iter().position(|o| *o == operation) {
            return Ok(k as u8);
        }
        if self.operations.len() == MOST_OPERATIONS {
            return Err(TooLong);
        }
        self.operations.push(operation);
        Ok(self.operations.len() as u8 - 1)
    }

    /// Adds a result.
    pub(super) fn returns(&mut self, result: u8) {
        self.results.push(result);
    }

    /// Value of an operation that is a constant.
    pub(super) fn constant(&self, k: u8) -> Option<f64> {
        match self.operations[k as usize] {
            Operation::Constant(x) => Some(x),
            _ => None,
        }
    }

    fn folded(&self, operation: Operation) -> Operation {
        use Operation::*;
        let c = |k: u8| self.constant(k);
        let value = match operation {
            Negate(a) => c(a).map(|a| -a),
            Sqrt(a) => c(a).map(f64::sqrt),
            Abs(a) => c(a).map(f64::abs),
            Add(a, b) => c(a).zip(c(b)).map(|(a, b)| a + b),
            Subtract(a, b) => c(a).zip(c(b)).map(|(a, b)| a - b),
            Multiply(a, b) => c(a).zip(c(b)).map(|(a, b)| a * b),
            Divide(a, b) => c(a).zip(c(b)).map(|(a, b)| a / b),
            _ => None,
        };
        value.map_or(operation, Constant)
    }

    /// Whether the formula depends on a variable.
    pub fn uses(&self, variable: Variable) -> bool {
        self.operations.contains(&Operation::Variable(variable))
    }

    /// Evaluates the formulas; results that do not exist are zero.
    #[inline(always)]
    pub fn evaluate<R: Real, const RESULTS: usize>(&self, values: &Values<R>) -> [R; RESULTS] {
        use Operation::*;
        let mut found = [MaybeUninit::<R>::uninit(); MOST_OPERATIONS];
        for (k, operation) in self.operations.iter().enumerate().take(MOST_OPERATIONS) {
            // SAFETY: `put` appends an operation after its operands, which are therefore computed.
            let v = |k: u8| unsafe { found[k as usize].assume_init() };
            let value = match *operation {
                Constant(x) => R::splat(x),
                Variable(x) => values[x as usize],
                Negate(a) => -v(a),
                Sqrt(a) => v(a).sqrt(),
                Abs(a) => v(a).abs(),
                Add(a, b) => v(a) + v(b),
                Subtract(a, b) => v(a) - v(b),
                Multiply(a, b) => v(a) * v(b),
                Divide(a, b) => v(a) / v(b),
                Min(a, b) => v(a).min(v(b)),
                Max(a, b) => v(a).max(v(b)),
                Below(a, b, yes, no) => R::select(v(a).lt(v(b)), v(yes), v(no)),
            };
            found[k] = MaybeUninit::new(value);
        }
        let mut results = [R::zero(); RESULTS];
        for (result, k) in results.iter_mut().zip(&self.results) {
            // SAFETY: results are operations of the list, all computed above.
            *result = unsafe { found[*k as usize].assume_init() };
        }
        results
    }

    /// Statements in C: variable v of lane l is `v[v*width + l]`, results likewise.
    pub(super) fn in_c(&self, text: &mut String, width: usize, results: usize) {
        use Operation::*;
        let number = |x: f64| match x {
            _ if x.is_nan() => "(0.0/0.0)".to_string(),
            _ if x.is_infinite() => format!("({}1.0/0.0)", if x > 0.0 { "" } else { "-" }),
            _ => format!("({x:e})"),
        };
        for (k, operation) in self.operations.iter().enumerate() {
            let value = match *operation {
                Constant(x) => number(x),
                Variable(x) => format!("v[{} + l]", x as usize * width),
                Negate(a) => format!("-x{a}"),
                Sqrt(a) => format!("__builtin_sqrt(x{a})"),
                Abs(a) => format!("__builtin_fabs(x{a})"),
                Add(a, b) => format!("x{a} + x{b}"),
                Subtract(a, b) => format!("x{a} - x{b}"),
                Multiply(a, b) => format!("x{a} * x{b}"),
                Divide(a, b) => format!("x{a} / x{b}"),
                Min(a, b) => format!("x{a} < x{b} ? x{a} : x{b}"),
                Max(a, b) => format!("x{a} > x{b} ? x{a} : x{b}"),
                Below(a, b, yes, no) => format!("x{a} < x{b} ? x{yes} : x{no}"),
            };
            text.push_str(&format!("const double x{k} = {value};\n"));
        }
        for k in 0..results {
            let value = self.results.get(k).map_or("0.0".to_string(), |r| format!("x{r}"));
            text.push_str(&format!("r[{} + l] = {value};\n", k * width));
        }
    }

    /// First value, and its derivative along `rates` of the variables.
    pub fn derivative(&self, values: &Values<f64>, rates: &Values<f64>) -> (f64, f64) {
        use Operation::*;
        let mut found = [(0.0_f64, 0.0_f64); MOST_OPERATIONS];
        for (k, operation) in self.operations.iter().enumerate() {
            let v = |k: u8| found[k as usize];
            found[k] = match *operation {
                Constant(x) => (x, 0.0),
                Variable(x) => (values[x as usize], rates[x as usize]),
                Negate(a) => (-v(a).0, -v(a).1),
                Sqrt(a) => {
                    let root = v(a).0.sqrt();
                    (root, if v(a).1 == 0.0 { 0.0 } else { 0.5 * v(a).1 / root })
                }
                Abs(a) => (v(a).0.abs(), v(a).1 * if v(a).0 < 0.0 { -1.0 } else { 1.0 }),
                Add(a, b) => (v(a).0 + v(b).0, v(a).1 + v(b).1),
                Subtract(a, b) => (v(a).0 - v(b).0, v(a).1 - v(b).1),
                Multiply(a, b) => (v(a).0 * v(b).0, v(a).1 * v(b).0 + v(a).0 * v(b).1),
                Divide(a, b) => {
                    let ratio = v(a).0 / v(b).0;
                    (ratio, (v(a).1 - ratio * v(b).1) / v(b).0)
                }
                Min(a, b) => {
                    if v(a).0 < v(b).0 {
                        v(a)
                    } else {
                        v(b)
                    }
                }
                Max(a, b) => {
                    if v(a).0 > v(b).0 {
                        v(a)
                    } else {
                        v(b)
                    }
                }
                Below(a, b, yes, no) => {
                    if v(a).0 < v(b).0 {
                        v(yes)
                    } else {
                        v(no)
                    }
                }
            };
        }
        self.results.first().map_or((0.0, 0.0), |k| found[*k as usize])
    }
}
