//! Assumed strains, and warnings about locking.

use crate::scene::solid::{Dilatation, Solid};
use crate::scene::{SceneError, Table};
use std::collections::BTreeMap;
use trackbed_fem::element::Locking;
use trackbed_fem::{self as fem, AssumedStrain, ElementKind, Material, Mesh, Quadrature};

/// Poisson's ratio of volumetric locking.
const NEARLY_INCOMPRESSIBLE: f64 = 0.49;

/// Returns the assumed strains.
///
/// # Errors
/// Keys without effect.
pub fn assumed(solid: &Table<Solid>, mesh: &Mesh) -> Result<AssumedStrain, SceneError> {
    let kinds = mesh.connectivity.kinds();
    let idle = solid.dilatation.is_some() && kinds.iter().all(|k| k.is_linear());
    if idle {
        let remedy = "Linear elements always use the mean dilatation";
        return Err(solid.no_effect("dilatation", "quadratic elements").remedy(remedy));
    }
    let idle = solid.incompatible_modes.is_some() && !kinds.iter().any(|k| k.properties().incompatible_modes);
    solid.reject_without([("incompatible_modes", idle)], "8-node hexahedra")?;
    Ok(AssumedStrain {
        dilatation: match solid.dilatation.unwrap_or_default() {
            Dilatation::Pointwise => fem::Dilatation::Pointwise,
            Dilatation::Mean => fem::Dilatation::Mean,
        },
        incompatible_modes: solid.incompatible_modes.unwrap_or(true),
    })
}

/// Returns warnings about volumetric locking, with a remedy.
pub fn remarks(
    mesh: &Mesh,
    materials: &BTreeMap<u32, Material>,
    rule: Quadrature,
    assumed: AssumedStrain,
) -> Vec<String> {
    let mut found: BTreeMap<(ElementKind, u32), usize> = BTreeMap::new();
    for (&kind, &number) in mesh.connectivity.kinds().iter().zip(&mesh.materials) {
        let stiff = materials.get(&number).is_some_and(|m| m.elastic.poisson >= NEARLY_INCOMPRESSIBLE);
        if stiff && remedy(kind, rule, assumed).is_some() {
            *found.entry((kind, number)).or_default() += 1;
        }
    }
    found
        .into_iter()
        .filter_map(|((kind, number), count)| {
            let (poisson, remedy) = (materials[&number].elastic.poisson, remedy(kind, rule, assumed)?);
            Some(format!(
                "material {number} has Poisson's ratio {poisson}, at which its {count} {} elements lock: displacements come out \
                 too small; {remedy}",
                kind.name()
            ))
        })
        .collect()
}

fn remedy(kind: ElementKind, rule: Quadrature, assumed: AssumedStrain) -> Option<&'static str> {
    let mean = assumed.dilatation == fem::Dilatation::Mean;
    match kind.properties().locking {
        Locking::FullRules if rule == Quadrature::Gauss2 => None,
        Locking::FullRules | Locking::Pointwise if !mean => Some("set solid.dilatation = \"mean\""),
        Locking::Always => Some("set solid.order = \"quadratic\" and solid.dilatation = \"mean\""),
        _ => None,
    }
}
