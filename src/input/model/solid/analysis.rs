//! `[solid]` analysis resolved.

use super::initial_stress::{InitialStressKind, InitialStressPlan, initial_stress};
use super::material::Materials;
use crate::scene::solid::{
    Dynamics, LinearSolver, MaterialModel, NewtonVariant, QuasiStatic, Solid, StrengthReduction,
};
use crate::scene::{SceneError, Table};
use trackbed_fem::newmark::Newmark;
use trackbed_fem::nonlinear::strength_reduction::ReductionOptions;
use trackbed_fem::nonlinear::{LinearMethod, NewtonOptions, Variant};

/// Quasi-static force tolerance: displacements and loads within 5e-6; 1e-4 gives 7e-5 for 5 to 8 % fewer
/// iterations (`inputs/studies/newton_*.toml`).
const QUASI_STATIC: f64 = 1e-5;

/// Analysis of a solid-only model.
#[derive(Clone, Copy, Debug)]
pub enum Analysis {
    /// Static solve.
    Static,
    /// Time integration.
    Dynamic(TimeMethod),
    /// Equilibrium at pseudo-time steps.
    QuasiStatic(QuasiStaticPlan),
    /// Factor of safety.
    StrengthReduction(StrengthReductionPlan),
}

/// Time integration method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeMethod {
    /// Newmark.
    Newmark(Newmark),
    /// Hilber, Hughes, Taylor with α in −1/3 to 0.
    Hht(f64),
}

/// Quasi-static stepping.
#[derive(Clone, Copy, Debug)]
pub struct QuasiStaticPlan {
    /// Smallest fraction of the step.
    pub smallest_step: f64,
    /// Newton iterations that reduce the next step.
    pub target_iterations: u32,
}

/// Factor of safety search.
pub type StrengthReductionPlan = ReductionOptions;

/// Newton options.
pub type NewtonPlan = NewtonOptions;

/// Resolved plans of a solid.
pub struct Plans {
    /// Analysis type.
    pub analysis: Analysis,
    /// Initial stress.
    pub initial_stress: Option<InitialStressPlan>,
    /// Newton options.
    pub newton: NewtonPlan,
}

/// Resolves the analysis. `linear`: not plastic; `coupled`: with grains.
///
/// # Errors
/// Input errors.
pub fn plans(
    solid: &Table<Solid>,
    materials: &Materials,
    linear: bool,
    coupled: bool,
) -> Result<Plans, SceneError> {
    let chosen = [
        ("dynamics", solid.dynamics.is_some()),
        ("quasi_static", solid.quasi_static.is_some()),
        ("strength_reduction", solid.strength_reduction.is_some()),
    ];
    let mut present = chosen.iter().filter(|(_, present)| *present).map(|(name, _)| *name);
    if let (Some(first), Some(second)) = (present.next(), present.next()) {
        return Err(solid.conflict(second, format!("`{first}`")));
    }
    let analysis = match (&solid.dynamics, &solid.quasi_static, &solid.strength_reduction) {
        (Some(d), _, _) => Analysis::Dynamic(time_method(&solid.below("dynamics", d))?),
        (_, Some(q), _) => Analysis::QuasiStatic(quasi_static(&solid.below("quasi_static", q))?),
        (_, _, Some(s)) => {
            let s = solid.below("strength_reduction", s);
            if linear {
                return Err(s.here("elastic materials only", "a material that yields"));
            }
            if let Some(k) = solid.material.iter().position(|m| m.model == MaterialModel::Umat) {
                let material = solid.row("material", &solid.material, k);
                let remedy = "The strength of a user material cannot be divided";
                return Err(material.conflict("model", "[solid.strength_reduction]").remedy(remedy));
            }
            Analysis::StrengthReduction(strength_reduction(&s, newton(solid)?)?)
        }
        _ => Analysis::Static,
    };
    if matches!(analysis, Analysis::Static) && !coupled {
        let expected = "[solid.quasi_static], [solid.dynamics] or [solid.strength_reduction]";
        if !linear {
            return Err(solid.here("a material that yields, and one static solve", expected));
        }
        if solid.initial_stress.is_some() {
            let found = "a table, and one static solve";
            return Err(solid.error("initial_stress", found, expected));
        }
    }
    if solid.newton.is_some() && linear && solid.initial_stress.is_none() {
        return Err(solid.no_effect("newton", "a plastic material or [solid.initial_stress]"));
    }
    let initial = solid.optional("initial_stress", &solid.initial_stress);
    let initial_stress = initial.map(|i| initial_stress(&i, materials)).transpose()?;
    if coupled && solid.initial_stress.as_ref().is_some_and(|i| i.loads) {
        let remedy = "Loads of a coupled solid act after the initial stress";
        return Err(solid.conflict("initial_stress.loads", "[[grains]]").remedy(remedy));
    }
    if let Some(&first) = materials.k0.keys().next()
        && !matches!(initial_stress, Some(InitialStressPlan { kind: InitialStressKind::K0 { .. }, .. }))
    {
        let position = solid.material.iter().position(|m| m.id == first).unwrap_or(0);
        let without = "`method = \"k0\"` in [solid.initial_stress]";
        return Err(solid.row("material", &solid.material, position).no_effect("k0", without));
    }
    let mut newton = newton(solid)?.unwrap_or_default();
    let given = solid.newton.as_ref().is_some_and(|n| n.tolerance.is_some());
    if matches!(analysis, Analysis::QuasiStatic(_)) && !given {
        newton.force_tolerance = QUASI_STATIC;
    }
    Ok(Plans { analysis, initial_stress, newton })
}

fn time_method(d: &Table<Dynamics>) -> Result<TimeMethod, SceneError> {
    if let Some(alpha) = d.hht_alpha {
        let idle = [
            ("beta", d.beta.is_some()),
            ("gamma", d.gamma.is_some()),
            ("accept_conditional_stability", d.accept_conditional_stability),
        ];
        d.reject_with(idle, "`hht_alpha`")?;
        d.check("hht_alpha", alpha, |a| (-1.0 / 3.0..=0.0).contains(&a), "-1/3 to 0")?;
        return Ok(TimeMethod::Hht(alpha));
    }
    let method = Newmark { beta: d.beta.unwrap_or(0.25), gamma: d.gamma.unwrap_or(0.5) };
    let checked = if d.accept_conditional_stability { method.check_range() } else { method.check() };
    checked.map_err(|e| d.here(e.to_string(), "stable constants"))?;
    Ok(TimeMethod::Newmark(method))
}

fn quasi_static(q: &Table<QuasiStatic>) -> Result<QuasiStaticPlan, SceneError> {
    let plan = QuasiStaticPlan {
        smallest_step: q.smallest_step.unwrap_or(1.0 / 1024.0),
        target_iterations: q.target_iterations.unwrap_or(40),
    };
    // Smaller fractions are lost to rounding.
    q.check("smallest_step", plan.smallest_step, |s| (1e-9..=1.0).contains(&s), "1e-9 to 1")?;
    q.check("target_iterations", plan.target_iterations, |n| (2.0..=1000.0).contains(&n), "2 to 1000")?;
    Ok(plan)
}

fn strength_reduction(
    s: &Table<StrengthReduction>,
    chosen: Option<NewtonOptions>,
) -> Result<StrengthReductionPlan, SceneError> {
    let default = ReductionOptions::default();
    let plan = ReductionOptions {
        start: s.start.unwrap_or(default.start),
        tolerance: s.tolerance.unwrap_or(default.tolerance),
        largest: s.largest.unwrap_or(default.largest),
        newton: chosen.unwrap_or(default.newton),
        ..default
    };
    s.check("start", plan.start, |f| (1e-3..=1e3).contains(&f), "0.001 to 1000")?;
    // Each bisection is an equilibrium search; strength is known to 1 %.
    s.check("tolerance", plan.tolerance, |f| (1e-4..=10.0).contains(&f), "0.0001 to 10")?;
    let good = |f| f <= 1e4 && f > plan.start.max(plan.start.recip());
    s.check("largest", plan.largest, good, "above `start` and its reciprocal, at most 10000")?;
    Ok(plan)
}

fn newton(solid: &Table<Solid>) -> Result<Option<NewtonPlan>, SceneError> {
    let Some(n) = solid.optional("newton", &solid.newton) else { return Ok(None) };
    let mut plan = NewtonOptions::new(match n.variant.unwrap_or(NewtonVariant::Full) {
        NewtonVariant::Full => Variant::Full,
        NewtonVariant::Modified => Variant::Modified(0),
        NewtonVariant::InitialStiffness => Variant::InitialStiffness,
    });
    if let Some(l) = n.line_search {
        plan.line_search = l;
    }
    let good = |t| (1e-12..=1e-2).contains(&t);
    if let Some(t) = n.check("tolerance", n.tolerance, good, "1e-12 to 0.01")? {
        plan.force_tolerance = t;
    }
    let good = |m| (1.0..=10_000.0).contains(&m);
    if let Some(m) = n.check("max_iterations", n.max_iterations, good, "1 to 10000")? {
        plan.max_iterations = m;
    }
    if let Some(s) = n.solver {
        plan.linear = match s {
            LinearSolver::Auto => LinearMethod::Auto,
            LinearSolver::Direct => LinearMethod::Direct,
            LinearSolver::Krylov => LinearMethod::Krylov,
        };
    }
    Ok(Some(plan))
}
