//! Materials of the solid, resolved.

use crate::scene::solid::{Cone, MaterialModel, Solid, SolidMaterial};
use crate::scene::{Document, SceneError};
use std::collections::BTreeMap;
use trackbed_fem::material::{self, DruckerPrager, Elastic, Hardening, Material, MohrCoulomb};

/// Materials of a solid by number, and their names for reports.
pub struct Materials {
    /// Constants.
    pub constants: BTreeMap<u32, Material>,
    /// Names.
    pub names: BTreeMap<u32, String>,
    /// Horizontal over vertical initial stress, where a material has its own.
    pub k0: BTreeMap<u32, f64>,
}

/// Resolves `[[solid.material]]`.
///
/// # Errors
/// A constant is missing, out of range, or not one of the model.
pub fn materials(document: &Document, solid: &Solid) -> Result<Materials, SceneError> {
    let mut materials = Materials { constants: BTreeMap::new(), names: BTreeMap::new(), k0: BTreeMap::new() };
    for (i, m) in solid.material.iter().enumerate() {
        let key = |k: &str| format!("solid.material.{i}.{k}");
        let constants = material(document, i, m)?;
        if materials.constants.insert(m.id, constants).is_some() {
            return Err(document.error(&key("id"), format!("material {} again", m.id), "each number once"));
        }
        let name = if m.name.is_empty() { format!("material {}", m.id) } else { m.name.clone() };
        materials.names.insert(m.id, name);
        if let Some(k0) = m.k0 {
            super::check(document, &key("k0"), k0, k0 >= 0.0 && k0.is_finite(), "0 or more")?;
            materials.k0.insert(m.id, k0);
        }
    }
    Ok(materials)
}

fn material(document: &Document, index: usize, m: &SolidMaterial) -> Result<Material, SceneError> {
    let key = |k: &str| format!("solid.material.{index}.{k}");
    super::check(document, &key("young"), m.young.si, m.young.si > 0.0, "a modulus above 0")?;
    let good = m.poisson > -1.0 && m.poisson < 0.5;
    super::check(document, &key("poisson"), m.poisson, good, "above -1 and below 0.5")?;
    super::check(document, &key("density"), m.density.si, m.density.si > 0.0, "a density above 0")?;
    let elastic = Elastic { young: m.young.si, poisson: m.poisson, density: m.density.si };
    refuse_idle_keys(document, index, m)?;
    let need = |k: &str, value: Option<f64>| {
        let expected = format!("a value for the model `{}`", name(m.model));
        value.ok_or_else(|| document.error(&key(k), "nothing", expected))
    };
    let strength = |k: &str, value: Option<f64>| -> Result<Hardening, SceneError> {
        match (value, m.hardening, &m.hardening_table) {
            (None, None, Some(table)) => {
                Ok(Hardening::Table(table.iter().map(|(x, y)| (*x, y.si)).collect()))
            }
            (Some(_), _, Some(_)) => {
                let expected = format!("either `{k}` (and `hardening`) or `hardening_table`");
                Err(document.error(&key("hardening_table"), "a table", expected))
            }
            (_, Some(_), Some(_)) => {
                Err(document.error(&key("hardening"), "a value", "no such key beside `hardening_table`"))
            }
            (_, modulus, None) => {
                let initial = need(k, value)?;
                Ok(match modulus {
                    None => Hardening::Constant(initial),
                    Some(h) => Hardening::Linear { initial, modulus: h.si, limit: softest(initial, h.si) },
                })
            }
        }
    };
    let material = match m.model {
        MaterialModel::Elastic => return Ok(Material::from(elastic)),
        MaterialModel::VonMises | MaterialModel::Tresca => {
            let yield_stress = strength("yield_stress", m.yield_stress.map(|y| y.si))?;
            // Both criteria are met at half the yield stress of tension as their cohesion.
            let cohesion = yield_stress.map(|y| 0.5 * y);
            if m.model == MaterialModel::VonMises {
                Material::plastic(elastic, DruckerPrager { cohesion, ..DruckerPrager::von_mises(1.0) })
            } else {
                Material::plastic(elastic, MohrCoulomb { cohesion, ..MohrCoulomb::tresca(1.0) })
            }
        }
        MaterialModel::MohrCoulomb | MaterialModel::DruckerPrager => {
            let cohesion = strength("cohesion", m.cohesion.map(|c| c.si))?;
            let friction = match (&m.friction, &m.friction_table) {
                (None, Some(table)) => Hardening::Table(table.iter().map(|(x, y)| (*x, y.si)).collect()),
                (Some(_), Some(_)) => {
                    let expected = "either `friction` or `friction_table`";
                    return Err(document.error(&key("friction_table"), "a table", expected));
                }
                (friction, None) => Hardening::Constant(need("friction", friction.map(|f| f.si))?),
            };
            let dilation = need("dilation", m.dilation.map(|d| d.si))?;
            let tension = m.tension.map(|t| t.si);
            if m.model == MaterialModel::MohrCoulomb {
                Material::plastic(elastic, MohrCoulomb { cohesion, friction, dilation, tension })
            } else {
                let cone = match m.cone {
                    Some(Cone::Compression) => material::Cone::Compression,
                    Some(Cone::Extension) => material::Cone::Extension,
                    Some(Cone::PlaneStrain) => material::Cone::PlaneStrain,
                    None => {
                        let expected = "\"compression\", \"extension\" or \"plane_strain\"";
                        return Err(document.error(&key("cone"), "nothing", expected));
                    }
                };
                Material::plastic(elastic, DruckerPrager { cohesion, friction, dilation, cone, tension })
            }
        }
    };
    match material.fault() {
        None => Ok(material),
        Some((constant, value, expected)) => {
            let found = if constant.contains("angle") {
                format!("{} deg", rounded(value.to_degrees()))
            } else {
                value.to_string()
            };
            Err(document.error(&key(key_of(constant, m)), found, expected))
        }
    }
}

/// Where a softening strength stops: at a hundredth of its start. Hardening has no end.
fn softest(initial: f64, modulus: f64) -> Option<f64> {
    (modulus < 0.0).then_some(0.01 * initial)
}

fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// The key that a faulty constant was written under.
fn key_of(constant: &str, m: &SolidMaterial) -> &'static str {
    match constant {
        "Young's modulus" => "young",
        "Poisson's ratio" => "poisson",
        "density" => "density",
        "friction angle" if m.friction_table.is_some() => "friction_table",
        "friction angle" => "friction",
        "dilation angle" => "dilation",
        "tension cut-off" => "tension",
        _ if m.hardening_table.is_some() => "hardening_table",
        _ if m.yield_stress.is_some() => "yield_stress",
        "cohesion" => "cohesion",
        _ => "hardening",
    }
}

fn name(model: MaterialModel) -> &'static str {
    match model {
        MaterialModel::Elastic => "elastic",
        MaterialModel::MohrCoulomb => "mohr_coulomb",
        MaterialModel::DruckerPrager => "drucker_prager",
        MaterialModel::VonMises => "von_mises",
        MaterialModel::Tresca => "tresca",
    }
}

/// Keys that the model of a material has no use for.
fn refuse_idle_keys(document: &Document, index: usize, m: &SolidMaterial) -> Result<(), SceneError> {
    let model = m.model;
    let frictional = matches!(model, MaterialModel::MohrCoulomb | MaterialModel::DruckerPrager);
    let metal = matches!(model, MaterialModel::VonMises | MaterialModel::Tresca);
    let keys = [
        ("cohesion", m.cohesion.is_some(), frictional),
        ("friction", m.friction.is_some(), frictional),
        ("dilation", m.dilation.is_some(), frictional),
        ("tension", m.tension.is_some(), frictional),
        ("friction_table", m.friction_table.is_some(), frictional),
        ("cone", m.cone.is_some(), model == MaterialModel::DruckerPrager),
        ("yield_stress", m.yield_stress.is_some(), metal),
        ("hardening", m.hardening.is_some(), frictional || metal),
        ("hardening_table", m.hardening_table.is_some(), frictional || metal),
    ];
    for (key, present, used) in keys {
        if present && !used {
            let key = format!("solid.material.{index}.{key}");
            let expected = format!("no such key for the model `{}`", name(model));
            return Err(document.error(&key, "a value", expected));
        }
    }
    Ok(())
}
