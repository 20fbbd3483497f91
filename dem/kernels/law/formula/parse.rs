//! Parser of formulas: numbers, names, `+ - * / ^`, `sqrt`, `abs`, `min`, `max`, `below(a, b, yes, no)`, `half_step(c)`;
//! `name = formula;` defines an intermediate value.

use super::program::{Operation, Program, TooLong, VARIABLES, Variable};
use std::collections::{BTreeMap, BTreeSet};

/// Functions and their numbers of arguments.
const FUNCTIONS: [(&str, usize); 6] =
    [("sqrt", 1), ("abs", 1), ("min", 2), ("max", 2), ("below", 4), (HALF_STEP, 1)];
/// Correction of dashpots (`half_step_damping.rs`), where a formula may use `w` and `dt`.
const HALF_STEP: &str = "half_step";

const MOST_CHARACTERS: usize = 1000;

/// Mistake in a formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormulaError {
    /// Unexpected text at a position, from 1.
    #[error("found {found} at character {at}, expected {expected}")]
    Syntax {
        /// What stands there.
        found: String,
        /// Character, from 1.
        at: usize,
        /// What may stand there.
        expected: String,
    },
    /// Name without meaning.
    #[error("found the unknown name `{name}`, expected one of {known}")]
    Unknown {
        /// Name.
        name: String,
        /// Names with meaning.
        known: String,
    },
    /// Definition of a name that has a meaning already.
    #[error("found a second meaning of `{0}`, expected a new name")]
    Again(String),
    /// Definition without use.
    #[error("found `{0}` without use, expected its use in the formula")]
    Unused(String),
    /// Exponent that lanes cannot evaluate.
    #[error("found the exponent {0}, expected a number that is a multiple of 1/4, at most 16")]
    Exponent(String),
    /// More than 1,000 characters.
    #[error("found {0} characters, expected at most {MOST_CHARACTERS}")]
    Characters(usize),
    /// Too many operations.
    #[error("{0}, expected a shorter formula")]
    Long(#[from] TooLong),
}

/// Adds a formula to `program`; `constants` are further names, `variables` those that it may use.
///
/// # Errors
/// [`FormulaError`].
pub fn parse(
    program: &mut Program,
    text: &str,
    constants: &BTreeMap<String, f64>,
    variables: &[Variable],
) -> Result<(), FormulaError> {
    if text.len() > MOST_CHARACTERS {
        return Err(FormulaError::Characters(text.len()));
    }
    let text = text.char_indices().collect();
    let (defined, unused) = (BTreeMap::new(), BTreeSet::new());
    let mut parser = Parser { text, at: 0, program, constants, variables, defined, unused };
    let result = parser.statements()?;
    if let Some(name) = parser.unused.into_iter().next() {
        return Err(FormulaError::Unused(name));
    }
    program.returns(result);
    Ok(())
}

/// Whether a name may be that of a constant.
pub fn is_free_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(|c| c.is_ascii_alphabetic())
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && VARIABLES.iter().all(|(n, _)| *n != name)
        && FUNCTIONS.iter().all(|(n, _)| *n != name)
}

struct Parser<'a> {
    text: Vec<(usize, char)>,
    at: usize,
    program: &'a mut Program,
    constants: &'a BTreeMap<String, f64>,
    variables: &'a [Variable],
    defined: BTreeMap<String, u8>,
    unused: BTreeSet<String>,
}

impl Parser<'_> {
    fn statements(&mut self) -> Result<u8, FormulaError> {
        loop {
            let start = self.at;
            if let Some(name) = self.name()
                && self.eat('=')
            {
                if !is_free_name(&name)
                    || self.constants.contains_key(&name)
                    || self.defined.contains_key(&name)
                {
                    return Err(FormulaError::Again(name));
                }
                let value = self.sum()?;
                self.need(';')?;
                self.defined.insert(name.clone(), value);
                self.unused.insert(name);
                continue;
            }
            self.at = start;
            let value = self.sum()?;
            return if self.peek().is_none() {
                Ok(value)
            } else {
                Err(self.unexpected("an operator or the end"))
            };
        }
    }

    fn sum(&mut self) -> Result<u8, FormulaError> {
        let mut left = self.product()?;
        loop {
            if self.eat('+') {
                let right = self.product()?;
                left = self.put(Operation::Add(left, right))?;
            } else if self.eat('-') {
                let right = self.product()?;
                left = self.put(Operation::Subtract(left, right))?;
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<u8, FormulaError> {
        let mut left = self.sign()?;
        loop {
            if self.eat('*') {
                let right = self.sign()?;
                left = self.put(Operation::Multiply(left, right))?;
            } else if self.eat('/') {
                let right = self.sign()?;
                left = self.put(Operation::Divide(left, right))?;
            } else {
                return Ok(left);
            }
        }
    }

    fn sign(&mut self) -> Result<u8, FormulaError> {
        if self.eat('-') {
            let value = self.sign()?;
            return self.put(Operation::Negate(value));
        }
        let base = self.atom()?;
        if !self.eat('^') {
            return Ok(base);
        }
        let negative = self.eat('-');
        let exponent = self.atom()?;
        let exponent = self.program.constant(exponent).unwrap_or(f64::NAN);
        self.power(base, if negative { -exponent } else { exponent })
    }

    /// Multiples of a quarter by roots and products.
    fn power(&mut self, base: u8, exponent: f64) -> Result<u8, FormulaError> {
        let quarters = 4.0 * exponent.abs();
        if !(quarters.fract() == 0.0 && (1.0..=64.0).contains(&quarters)) {
            return Err(FormulaError::Exponent(exponent.to_string()));
        }
        let quarters = quarters as u32;
        let mut factors = vec![base; (quarters / 4) as usize];
        if !quarters.is_multiple_of(4) {
            let half = self.put(Operation::Sqrt(base))?;
            if quarters % 4 >= 2 {
                factors.push(half);
            }
            if !quarters.is_multiple_of(2) {
                factors.push(self.put(Operation::Sqrt(half))?);
            }
        }
        let mut value = factors[0];
        for factor in &factors[1..] {
            value = self.put(Operation::Multiply(value, *factor))?;
        }
        if exponent < 0.0 {
            let one = self.put(Operation::Constant(1.0))?;
            value = self.put(Operation::Divide(one, value))?;
        }
        Ok(value)
    }

    fn atom(&mut self) -> Result<u8, FormulaError> {
        if self.eat('(') {
            let value = self.sum()?;
            self.need(')')?;
            return Ok(value);
        }
        if let Some(number) = self.number() {
            return self.put(Operation::Constant(number));
        }
        let Some(name) = self.name() else { return Err(self.unexpected("a number, a name or `(`")) };
        let function = self.functions().find(|(n, _)| *n == name);
        if let Some((_, count)) = function {
            return self.call(&name, count);
        }
        if let Some(value) = self.defined.get(&name) {
            self.unused.remove(&name);
            return Ok(*value);
        }
        if let Some(x) = self.constants.get(&name) {
            return self.put(Operation::Constant(*x));
        }
        match VARIABLES.iter().find(|(n, v)| *n == name && self.variables.contains(v)) {
            Some((_, variable)) => self.put(Operation::Variable(*variable)),
            None => Err(FormulaError::Unknown { name, known: self.known() }),
        }
    }

    fn call(&mut self, name: &str, count: usize) -> Result<u8, FormulaError> {
        self.need('(')?;
        let mut given = vec![self.sum()?];
        while given.len() < count {
            self.need(',')?;
            given.push(self.sum()?);
        }
        self.need(')')?;
        let operation = match (name, &given[..]) {
            ("sqrt", &[a]) => Operation::Sqrt(a),
            ("abs", &[a]) => Operation::Abs(a),
            ("min", &[a, b]) => Operation::Min(a, b),
            ("max", &[a, b]) => Operation::Max(a, b),
            (HALF_STEP, &[c]) => return self.half_step(c),
            (_, &[a, b, yes, no]) => Operation::Below(a, b, yes, no),
            _ => unreachable!("functions have these numbers of arguments"),
        };
        self.put(operation)
    }

    /// c (4 + x)/(4 + 3x), x = c w dt/2.
    fn half_step(&mut self, c: u8) -> Result<u8, FormulaError> {
        let [half, three, four] = [0.5, 3.0, 4.0].map(Operation::Constant);
        let (half, three, four) = (self.put(half)?, self.put(three)?, self.put(four)?);
        let step = self.put(Operation::Variable(Variable::Step))?;
        let mass = self.put(Operation::Variable(Variable::InverseMass))?;
        let x = self.put(Operation::Multiply(half, step))?;
        let x = self.put(Operation::Multiply(x, c))?;
        let x = self.put(Operation::Multiply(x, mass))?;
        let above = self.put(Operation::Add(four, x))?;
        let above = self.put(Operation::Multiply(c, above))?;
        let below = self.put(Operation::Multiply(three, x))?;
        let below = self.put(Operation::Add(four, below))?;
        self.put(Operation::Divide(above, below))
    }

    fn functions(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let steps = self.variables.contains(&Variable::Step);
        FUNCTIONS.into_iter().filter(move |(name, _)| *name != HALF_STEP || steps)
    }

    fn put(&mut self, operation: Operation) -> Result<u8, FormulaError> {
        Ok(self.program.put(operation)?)
    }

    fn known(&self) -> String {
        let variables = VARIABLES.iter().filter(|(_, v)| self.variables.contains(v)).map(|(n, _)| *n);
        let own = self.constants.keys().chain(self.defined.keys()).map(String::as_str);
        let functions = self.functions().map(|(n, _)| n);
        variables.chain(own).chain(functions).collect::<Vec<_>>().join(", ")
    }

    fn peek(&mut self) -> Option<char> {
        while self.text.get(self.at).is_some_and(|(_, c)| c.is_whitespace()) {
            self.at += 1;
        }
        self.text.get(self.at).map(|(_, c)| *c)
    }

    fn eat(&mut self, wanted: char) -> bool {
        let there = self.peek() == Some(wanted);
        self.at += usize::from(there);
        there
    }

    fn need(&mut self, wanted: char) -> Result<(), FormulaError> {
        if self.eat(wanted) { Ok(()) } else { Err(self.unexpected(&format!("`{wanted}`"))) }
    }

    fn unexpected(&mut self, expected: &str) -> FormulaError {
        let found = self.peek().map_or("the end".to_string(), |c| format!("`{c}`"));
        FormulaError::Syntax { found, at: self.at + 1, expected: expected.to_string() }
    }

    fn name(&mut self) -> Option<String> {
        self.peek().filter(char::is_ascii_alphabetic)?;
        let rest = &self.text[self.at..];
        let name: String =
            rest.iter().map(|(_, c)| *c).take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
        self.at += name.len();
        Some(name)
    }

    fn number(&mut self) -> Option<f64> {
        self.peek().filter(|c| c.is_ascii_digit() || *c == '.')?;
        let rest: String = self.text[self.at..].iter().map(|(_, c)| *c).collect();
        let mut end = 0;
        for (k, c) in rest.char_indices() {
            let exponent = matches!(c, 'e' | 'E')
                && rest[k + 1..].trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit());
            let sign = matches!(c, '+' | '-') && rest[..k].ends_with(['e', 'E']) && k == end;
            if !(c.is_ascii_digit() || c == '.' || exponent || sign) {
                break;
            }
            end = k + 1;
        }
        let number = rest[..end].parse().ok()?;
        self.at += end;
        Some(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Result<f64, FormulaError> {
        let constants = BTreeMap::from([("k".to_string(), 3.0)]);
        let mut program = Program::default();
        parse(&mut program, text, &constants, &VARIABLES.map(|(_, v)| v))?;
        let mut values = [0.0; VARIABLES.len()];
        values[Variable::Overlap as usize] = 4.0;
        values[Variable::Radius as usize] = 9.0;
        values[Variable::InverseMass as usize] = 2.0;
        values[Variable::Step as usize] = 0.5;
        Ok(program.evaluate::<f64, 1>(&values)[0])
    }

    #[test]
    fn formulas_have_their_values() {
        for (text, expected) in [
            ("2 + 3 * d", 14.0),
            ("2 - 3 - 4", -5.0),
            ("12 / 2 / 3", 2.0),
            ("-d^2", -16.0),
            ("(2 + d) * k", 18.0),
            ("sqrt(R) + abs(-1)", 4.0),
            ("d^1.5 + d^0.5 + d^-1", 8.0 + 2.0 + 0.25),
            ("16^0.25 + 16^0.75", 2.0 + 8.0),
            ("max(d, R) - min(d, R)", 5.0),
            ("below(d, 4, 1, 2) + below(d, 5, 10, 20)", 12.0),
            ("a = d + 1; b = a * a; b - a", 20.0),
            ("1e2 + 1.5e-1 + 2E+1", 120.15),
            ("k*d", 12.0),
            // x = 0.5 · 0.5 · 4 · 2 = 2.
            ("half_step(d)", 4.0 * (4.0 + 2.0) / (4.0 + 3.0 * 2.0)),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn mistakes_name_place_and_remedy() {
        for (text, expected) in [
            ("", "found the end at character 1, expected a number, a name or `(`"),
            ("2 +", "found the end at character 4, expected a number"),
            ("(d", "found the end at character 3, expected `)`"),
            ("d d", "found `d` at character 3, expected an operator or the end"),
            ("2 * delta", "found the unknown name `delta`, expected one of d, D, D0, R"),
            ("d^1.3", "found the exponent 1.3, expected a number that is a multiple of 1/4"),
            ("d^R", "found the exponent NaN"),
            ("d = 3; d", "found a second meaning of `d`"),
            ("a = 3; d", "found `a` without use"),
            ("max(d)", "found `)` at character 6, expected `,`"),
        ] {
            let found = value(text).unwrap_err().to_string();
            assert!(found.contains(expected), "{text}: {found}");
        }
        let long = (0..70).map(|k| format!("{k}.5*d")).collect::<Vec<_>>().join("+");
        assert!(value(&long).unwrap_err().to_string().contains("more than 64 operations"));
    }

    #[test]
    fn derivatives_match_differences() {
        let text = "a = sqrt(R*d); max(2/3*a*d - 1/(1 + d), d^2.5 - abs(d - 5)) + below(d, R, d*d, 0)";
        let mut program = Program::default();
        parse(&mut program, text, &BTreeMap::new(), &VARIABLES.map(|(_, v)| v)).unwrap();
        let mut values = [0.0; VARIABLES.len()];
        values[Variable::Radius as usize] = 9.0;
        let mut rates = [0.0; VARIABLES.len()];
        rates[Variable::Overlap as usize] = 1.0;
        for d in [0.3, 1.0, 4.0] {
            let mut at = |d: f64| {
                values[Variable::Overlap as usize] = d;
                program.derivative(&values, &rates)
            };
            let h = 1e-6;
            let difference = (at(d + h).0 - at(d - h).0) / (2.0 * h);
            let exact = at(d).1;
            assert!((exact / difference - 1.0).abs() < 1e-7, "{d}: {exact} {difference}");
        }
    }
}
