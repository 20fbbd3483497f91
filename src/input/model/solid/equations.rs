//! Selection of equation solvers.

use super::analysis::Analysis;
use crate::scene::solid::{EquationMethod, Equations, Mass, Solid};
use crate::scene::{SceneError, Table};
use trackbed_fem::solver::mumps;
use trackbed_fem::{Method, Methods, MumpsMethod, Regime};

/// Nodes above which lumped-mass steps use CG: time of a stored factor, a hundredth of its memory
/// (`benches/README.md`, "Large solids").
const WINDOW_NODES: usize = 100_000;

/// Nodes above which CG with smoothed aggregation is faster in static solves (same section).
const STATIC_NODES: usize = 25_000;

/// Solvers of a solid, with reasons.
#[derive(Clone, Debug)]
pub struct EquationPlan {
    /// Solvers; direct if unused.
    pub methods: Methods,
    /// Whether there is a linear static solve.
    pub statics: bool,
    /// Whether there are linear time steps.
    pub dynamics: bool,
    /// Reason for the static solver.
    pub statics_reason: String,
    /// Reason for the dynamic solver.
    pub dynamics_reason: String,
}

impl EquationPlan {
    /// Returns the solvers in use, by regime.
    pub fn used(&self) -> impl Iterator<Item = (Regime, Method)> + use<> {
        let statics = self.statics.then_some((Regime::Statics, self.methods.statics));
        let dynamics = self.dynamics.then_some((Regime::Dynamics, self.methods.dynamics));
        statics.into_iter().chain(dynamics)
    }

    /// Whether the built-in direct solver is used.
    pub fn takes_factor(&self) -> bool {
        // Neither: plastic, always direct.
        let neither = !self.statics && !self.dynamics;
        neither || self.used().any(|(_, method)| method == Method::Direct)
    }
}

pub(super) fn plan(
    solid: &Table<Solid>,
    analysis: &Analysis,
    linear: bool,
    coupled: bool,
    nodes: usize,
) -> Result<EquationPlan, SceneError> {
    let table = solid.optional("equations", &solid.equations);
    let keys = table.as_ref().map_or(Equations::default(), |t| **t);
    let tolerance = keys.tolerance.unwrap_or(Method::WINDOW_TOLERANCE);
    let chosen = match keys.method {
        EquationMethod::Auto => None,
        EquationMethod::Direct => Some(Method::Direct),
        EquationMethod::Iterative => Some(Method::Iterative { tolerance }),
        EquationMethod::Mumps => {
            Some(Method::Mumps(MumpsMethod { out_of_core: keys.out_of_core.unwrap_or(false) }))
        }
    };
    let hindrance = hindrance(solid, analysis, linear, coupled);
    if let Some(t) = &table {
        check(t)?;
        if let (Some(method), Some(hindrance)) = (chosen.filter(|m| *m != Method::Direct), hindrance) {
            let found = format!("\"{}\" with {hindrance}", method.name());
            return Err(t.error("method", found, "\"auto\" or \"direct\""));
        }
    }
    let choose = |used: bool, wins: bool, why: String| match chosen {
        _ if !used => (Method::Direct, String::new()),
        Some(method) => (method, "set in the scene".into()),
        None if wins => (Method::Iterative { tolerance }, why),
        None => (Method::Direct, why),
    };
    let possible = hindrance.is_none();
    let statics = possible && (coupled || matches!(analysis, Analysis::Static));
    let dynamics = possible && (coupled || matches!(analysis, Analysis::Dynamic(_)));
    let lumped = solid.mass == Mass::Lumped;
    let why = if lumped {
        let compare = if nodes >= WINDOW_NODES { "at least" } else { "fewer than" };
        format!("lumped mass, {compare} {WINDOW_NODES} nodes")
    } else {
        "consistent mass".into()
    };
    let (of_steps, dynamics_reason) = choose(dynamics, lumped && nodes >= WINDOW_NODES, why);
    let compare = if nodes >= STATIC_NODES { "at least" } else { "fewer than" };
    let why = format!("{compare} {STATIC_NODES} nodes");
    let (of_statics, statics_reason) = choose(statics, nodes >= STATIC_NODES, why);
    let methods = Methods { statics: of_statics, dynamics: of_steps };
    Ok(EquationPlan { methods, statics, dynamics, statics_reason, dynamics_reason })
}

fn check(t: &Table<Equations>) -> Result<(), SceneError> {
    t.check("tolerance", t.tolerance, |t| (1e-13..=1e-4).contains(&t), "1e-13 to 1e-4")?;
    let (direct, by_mumps) = (t.method == EquationMethod::Direct, t.method == EquationMethod::Mumps);
    let idle = t.out_of_core.is_some() && !by_mumps;
    t.reject_without([("out_of_core", idle)], "`method = \"mumps\"`")?;
    t.reject_with([("tolerance", direct && t.tolerance.is_some())], "`method = \"direct\"`")?;
    t.reject_with([("tolerance", by_mumps && t.tolerance.is_some())], "`method = \"mumps\"`")?;
    if by_mumps && !mumps::BUILT_IN {
        let found = "\"mumps\", which this program was built without";
        let expected = "\"auto\", \"direct\" or \"iterative\"; `cargo build --release --features mumps` builds a program that has it";
        return Err(t.error("method", found, expected));
    }
    Ok(())
}

fn hindrance(solid: &Solid, analysis: &Analysis, linear: bool, coupled: bool) -> Option<&'static str> {
    if !linear {
        Some("a material that yields")
    } else if solid.initial_stress.is_some() {
        Some("[solid.initial_stress]")
    } else if solid.reduction.is_some() {
        Some("[solid.reduction]")
    } else if coupled {
        None
    } else {
        match analysis {
            Analysis::Static | Analysis::Dynamic(_) => None,
            Analysis::QuasiStatic(_) => Some("[solid.quasi_static]"),
            Analysis::StrengthReduction(_) => Some("[solid.strength_reduction]"),
        }
    }
}
