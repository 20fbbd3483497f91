//! Formulas of an own normal law (`formula_law.rs`).
//!
//! Three kinds, by the variables in use: with an effective modulus and Mindlin's tangential law; with a
//! stiffness and the linear spring; with memory (largest overlap), permanent deformation and the spring.
//!
//! Theory manual: section 1.12, `docs/theory/contacts.md`.

mod compiled;
mod parse;
mod program;

pub use compiled::NotCompiled;
pub use parse::{FormulaError, is_free_name};
pub(super) use program::{Program, VARIABLES, Values, Variable};

use std::collections::BTreeMap;
use std::sync::Mutex;

/// Kind of law: elastic with dashpot, by an effective modulus.
pub const MODULUS: u8 = 0;
/// Elastic with dashpot, by a stiffness.
pub const STIFFNESS: u8 = 1;
/// With memory, by a stiffness.
pub const MEMORY: u8 = 2;

pub(super) const NAMES: [&str; 3] = ["contact_law with E", "contact_law with K", "contact_law with D"];

/// Texts of an own law.
#[derive(Clone, Copy, Debug)]
pub struct Texts<'a> {
    /// Spring force [N].
    pub force: &'a str,
    /// Dashpot coefficient at the step's middle [N s/m].
    pub damping: Option<&'a str>,
    /// Energy of the spring [J].
    pub energy: Option<&'a str>,
    /// Energy of permanent deformation in a step [J].
    pub loss: Option<&'a str>,
}

/// Formulas of an own law.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    name: String,
    pub(super) kind: u8,
    pub(super) force: Program,
    /// Force, and dashpot coefficient or loss.
    pub(super) step: Program,
    pub(super) energy: Option<Program>,
    pub(super) is_damped: bool,
    compiled: compiled::Compiled,
}

/// Mistake in one of [`Texts`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct InvalidFormula {
    /// Which: `"force"`, `"damping"`, `"energy"` or `"loss"`.
    pub key: &'static str,
    /// Problem.
    pub problem: FormulaProblem,
}

/// Problem of a formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormulaProblem {
    /// Mistake in the text.
    #[error(transparent)]
    Text(#[from] FormulaError),
    /// `K` beside `E`.
    #[error("found `K` and `E`, expected one of them")]
    Both,
    /// Not used by this kind of law.
    #[error("found a formula, expected none: {0}")]
    Idle(&'static str),
    /// Needed by this kind of law.
    #[error("found none, expected a formula: {0}")]
    Missing(&'static str),
}

impl Formula {
    /// Parses the formulas of a law.
    ///
    /// # Errors
    /// [`InvalidFormula`].
    pub fn parse(
        name: &str,
        texts: &Texts<'_>,
        constants: &BTreeMap<String, f64>,
    ) -> Result<Formula, InvalidFormula> {
        use Variable::*;
        let pair = [Radius, Stiffness, Modulus, DampingRatio, Restitution];
        let add = |to: &mut Program, key: &'static str, text: &str, own: &[Variable]| {
            parse::parse(to, text, constants, &[&pair, own].concat())
                .map_err(|e| InvalidFormula { key, problem: FormulaProblem::Text(e) })
        };
        let invalid = |key, problem| Err(InvalidFormula { key, problem });
        let spring = [Overlap, Largest];
        let (mut force, mut energy) = (Program::default(), None);
        add(&mut force, "force", texts.force, &spring)?;
        if let Some(text) = texts.energy {
            add(
                energy.insert(Program::default()),
                "energy",
                text,
                if force.uses(Largest) { &spring } else { &spring[..1] },
            )?;
        }
        let mut step = force.clone();
        if let Some(text) = texts.damping {
            add(&mut step, "damping", text, &[Overlap, InverseMass, Step])?;
        }
        if let Some(text) = texts.loss.filter(|_| texts.damping.is_none() || !force.uses(Largest)) {
            add(&mut step, "loss", text, &[Largest, LargestBefore])?;
        }
        let uses = |v| step.uses(v) || energy.as_ref().is_some_and(|p: &Program| p.uses(v));
        let kind = match (force.uses(Largest), uses(Modulus), uses(Stiffness)) {
            (_, true, true) => return invalid("force", FormulaProblem::Both),
            (true, true, _) => {
                return invalid("force", FormulaProblem::Idle("laws with `D` have `K`, not `E`"));
            }
            (true, ..) => MEMORY,
            (false, true, _) => MODULUS,
            (false, false, _) => STIFFNESS,
        };
        match (kind, texts.damping, texts.energy, texts.loss) {
            (MEMORY, Some(_), ..) => {
                return invalid("damping", FormulaProblem::Idle("laws with `D` have no dashpot"));
            }
            (MEMORY, _, None, _) => {
                return invalid(
                    "energy",
                    FormulaProblem::Missing("the energy that unloading from `D` returns"),
                );
            }
            (MEMORY, _, _, None) => {
                let what = "the energy that growth from `D0` to `D` dissipates";
                return invalid("loss", FormulaProblem::Missing(what));
            }
            (MODULUS | STIFFNESS, _, _, Some(_)) => {
                return invalid(
                    "loss",
                    FormulaProblem::Idle("a law without `D` in `force` keeps no deformation"),
                );
            }
            _ => {}
        }
        let is_damped = texts.damping.is_some();
        Ok(Formula {
            name: name.to_string(),
            kind,
            force,
            step,
            energy,
            is_damped,
            compiled: Default::default(),
        })
    }

    /// Keeps the formula for the life of the process; equal ones once.
    pub fn kept(self) -> &'static Formula {
        static ALL: Mutex<Vec<&'static Formula>> = Mutex::new(Vec::new());
        let mut all = ALL.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(same) = all.iter().find(|f| ***f == self) {
            return same;
        }
        let kept: &'static Formula = Box::leak(Box::new(self));
        all.push(kept);
        kept
    }

    /// Name in the scene.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name of the row of laws.
    pub fn law(&self) -> &'static str {
        NAMES[self.kind as usize]
    }
}
