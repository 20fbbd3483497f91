//! `[solid.initial_stress]` resolved.

use super::material::Materials;
use crate::scene::solid::{InitialStress, InitialStressMethod, Solid};
use crate::scene::{SceneError, Table, setting};
use std::collections::BTreeMap;
use trackbed_fem::Mesh;
use trackbed_fem::nonlinear::initial_stress::Overburden;

/// Initial stress.
#[derive(Clone, Debug)]
pub struct InitialStressPlan {
    /// Method.
    pub kind: InitialStressKind,
    /// Load steps to equilibrium.
    pub steps: u32,
    /// Whether loads at time 0 are included.
    pub loads: bool,
}

/// Initial stress method.
#[derive(Clone, Debug)]
pub enum InitialStressKind {
    /// K₀ times the overburden horizontally.
    K0 {
        /// K₀ by material.
        k0: BTreeMap<u32, f64>,
        /// Overburden; default level ground at the top of the mesh.
        overburden: Option<Overburden>,
    },
    /// Gravity applied in steps.
    Gravity,
    /// Uniform stress [Pa].
    Uniform([f64; 6]),
}

pub(super) fn initial_stress(
    i: &Table<InitialStress>,
    materials: &Materials,
) -> Result<InitialStressPlan, SceneError> {
    let method = match i.method {
        InitialStressMethod::K0 => "k0",
        InitialStressMethod::Gravity => "gravity",
        InitialStressMethod::Uniform => "uniform",
    };
    for (name, present, of) in [
        ("k0", i.k0.is_some(), "k0"),
        ("surface", i.surface.is_some(), "k0"),
        ("layers", i.layers.is_some(), "k0"),
        ("stress", i.stress.is_some(), "uniform"),
    ] {
        i.reject_without([(name, present && of != method)], &setting("method", &[of]))?;
    }
    let kind = match i.method {
        InitialStressMethod::Gravity => InitialStressKind::Gravity,
        InitialStressMethod::Uniform => {
            let stress = i.need("stress", i.stress, "six components in Pa")?;
            InitialStressKind::Uniform(stress.map(|s| s.si))
        }
        InitialStressMethod::K0 => {
            i.check("k0", i.k0, |k0| k0 >= 0.0, "0 or more")?;
            let mut all = BTreeMap::new();
            for (&id, name) in &materials.names {
                let k0 = materials.k0.get(&id).copied().or(i.k0);
                let expected = format!("a value, or a separate one for {name}");
                all.insert(id, i.need("k0", k0, &expected)?);
            }
            InitialStressKind::K0 { k0: all, overburden: overburden(i)? }
        }
    };
    let good = |n| (1.0..=10_000.0).contains(&n);
    let steps = i.check("steps", i.steps.unwrap_or(10), good, "1 to 10000")?;
    Ok(InitialStressPlan { kind, steps, loads: i.loads })
}

fn overburden(i: &Table<InitialStress>) -> Result<Option<Overburden>, SceneError> {
    match (&i.surface, &i.layers) {
        (None, None) => Ok(None),
        (Some(surface), None) => Ok(Some(Overburden::Level(surface.si))),
        (None, Some(layers)) => {
            let layers: Vec<(f64, f64)> = layers.iter().map(|(top, density)| (top.si, density.si)).collect();
            let good = !layers.is_empty() && layers.windows(2).all(|w| w[1].0 < w[0].0);
            if !good || layers.iter().any(|l| l.1 < 0.0) {
                let expected = "[[height of the top, density], …] from the top down, densities of 0 or more";
                return Err(i.error("layers", format!("{layers:?}"), expected));
            }
            Ok(Some(Overburden::Layers(layers)))
        }
        _ => Err(i.conflict("layers", "`surface`")),
    }
}

/// Rejects a K₀ state of several densities without layers.
///
/// # Errors
/// Densities that differ.
pub fn check_overburden(
    solid: &Table<Solid>,
    plan: Option<&InitialStressPlan>,
    mesh: &Mesh,
    materials: &Materials,
) -> Result<(), SceneError> {
    let Some(InitialStressPlan { kind: InitialStressKind::K0 { overburden, .. }, .. }) = plan else {
        return Ok(());
    };
    if matches!(overburden, Some(Overburden::Layers(_))) {
        return Ok(());
    }
    let used = materials.constants.iter().filter(|(number, _)| mesh.materials.contains(number));
    let densities: Vec<f64> = used.map(|(_, m)| m.elastic.density).collect();
    let (least, most) = densities.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), d| (a.min(*d), b.max(*d)));
    if most > least * (1.0 + 1e-9) {
        let found = format!("nothing, and materials of {least} to {most} kg/m3");
        let expected = "the layers as [[height of the top, density], …]";
        return Err(solid.error("initial_stress.layers", found, expected));
    }
    Ok(())
}
