//! Scene tables of solid materials and their constitutive laws.

use super::user_material::UserTable;
use crate::units::{Angle, Density, Quantity, Stress};
use crate::{Problem, setting};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};
use trackbed_fem::material::{
    self, Consolidation, DruckerPrager, Elastic, Hardening, Material, ModifiedCamClay, MohrCoulomb, Shear,
};

/// `[[solid.material]]`: one for each material number of the mesh.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidMaterial {
    /// Material number.
    pub id: u32,
    /// Name in reports; default `material <id>`.
    #[serde(default)]
    pub name: String,
    /// Yield criterion; default `"elastic"`.
    #[serde(default)]
    pub model: MaterialModel,
    /// Young's modulus [Pa]; > 0; not with `"modified_cam_clay"`.
    pub young: Option<Quantity<Stress>>,
    /// Poisson's ratio; or `shear_modulus` (clay); > −1, < 0.5.
    pub poisson: Option<f64>,
    /// Density [kg/m³]; > 0.
    pub density: Quantity<Density>,
    /// Cohesion c [Pa]; ≥ 0, > 0 without friction; with `"mohr_coulomb"`, `"drucker_prager"`.
    pub cohesion: Option<Quantity<Stress>>,
    /// Friction angle φ [rad]; 0–80°; with `"mohr_coulomb"`, `"drucker_prager"`.
    pub friction: Option<Quantity<Angle>>,
    /// Dilation angle [rad]; 0 – `friction`; with `"mohr_coulomb"`, `"drucker_prager"`.
    pub dilation: Option<Quantity<Angle>>,
    /// Tension cut-off: principal, with `"drucker_prager"` mean stress [Pa]; default apex; 0 – c cot φ; with `"mohr_coulomb"`,
    /// `"drucker_prager"`.
    pub tension: Option<Quantity<Stress>>,
    /// Meridian shared with Mohr–Coulomb; with `"drucker_prager"`.
    pub cone: Option<Cone>,
    /// Yield stress in tension [Pa]; > 0; with `"von_mises"`, `"tresca"`.
    pub yield_stress: Option<Quantity<Stress>>,
    /// Strength slope over plastic strain, softening to 1 % [Pa]; default 0; with all but elastic, clay.
    pub hardening: Option<Quantity<Stress>>,
    /// Strength over plastic strain `[[strain, Pa], …]`; or `cohesion`, `yield_stress`.
    pub hardening_table: Option<Vec<(f64, Quantity<Stress>)>>,
    /// Friction angle `[[strain, angle], …]`; or `friction`; with `"mohr_coulomb"`, `"drucker_prager"`.
    pub friction_table: Option<Vec<(f64, Quantity<Angle>)>>,
    /// Slope of normal compression over ln p; > `kappa`; with `"modified_cam_clay"`.
    pub lambda: Option<f64>,
    /// Slope of swelling lines over ln p; > 0; with `"modified_cam_clay"`.
    pub kappa: Option<f64>,
    /// Critical stress ratio M, 6 sin φ/(3 − sin φ) in compression; > 0, < 3; with `"modified_cam_clay"`.
    pub critical_ratio: Option<f64>,
    /// Initial void ratio e₀; > 0; with `"modified_cam_clay"`.
    pub void_ratio: Option<f64>,
    /// Initial preconsolidation pressure p_c [Pa]; or `overconsolidation`; > 0; with `"modified_cam_clay"`.
    pub preconsolidation: Option<Quantity<Stress>>,
    /// p_c over the ellipse of the initial stress; or `preconsolidation`; ≥ 1; with `"modified_cam_clay"`.
    pub overconsolidation: Option<f64>,
    /// Constant shear modulus [Pa]; or `poisson`; > 0; with `"modified_cam_clay"`.
    pub shear_modulus: Option<Quantity<Stress>>,
    /// Lower bound of pressure in stiffness and p_c [Pa]; default 1 kPa; > 0; with `"modified_cam_clay"`.
    pub minimum_pressure: Option<Quantity<Stress>>,
    /// Routine of a shared library; with `"umat"`.
    pub umat: Option<UserTable>,
    /// Horizontal over vertical initial stress; default of `initial_stress`; ≥ 0.
    pub k0: Option<f64>,
}

/// Yield criterion of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaterialModel {
    /// Elastic.
    #[default]
    Elastic,
    /// Mohr–Coulomb.
    MohrCoulomb,
    /// Drucker–Prager.
    DruckerPrager,
    /// Von Mises.
    VonMises,
    /// Tresca.
    Tresca,
    /// Modified Cam clay.
    ModifiedCamClay,
    /// Routine of a shared library.
    Umat,
}

/// Meridian of Mohr–Coulomb that the cone of Drucker–Prager passes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cone {
    /// Compression.
    Compression,
    /// Extension.
    Extension,
    /// Equal collapse load.
    PlaneStrain,
}

/// Invalid key of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialFault {
    /// Key within the material.
    pub key: &'static str,
    /// Problem of the key.
    pub problem: Problem,
}

fn fault<T>(
    key: &'static str,
    found: impl ToString,
    expected: impl Into<String>,
) -> Result<T, MaterialFault> {
    faulty(key, Problem::value(found.to_string(), expected))
}

fn faulty<T>(key: &'static str, problem: Problem) -> Result<T, MaterialFault> {
    Err(MaterialFault { key, problem })
}

fn conflicting<T>(key: &'static str, with: &str) -> Result<T, MaterialFault> {
    faulty(key, Problem::conflict(format!("`{with}`")))
}

fn check(key: &'static str, value: f64, good: bool, expected: &str) -> Result<(), MaterialFault> {
    if good { Ok(()) } else { fault(key, value, expected) }
}

/// Largest friction angle [rad]: beyond it, residuals relative to the admissible forces are meaningless.
const STEEPEST: f64 = 80.0 * std::f64::consts::PI / 180.0 + 1e-12;

impl SolidMaterial {
    /// Resolves the material of the solid; `locate` resolves the path of a library.
    ///
    /// # Errors
    /// A constant is missing, out of range or unused by the model; an unusable library.
    pub fn resolve(&self, locate: impl Fn(&Path) -> PathBuf) -> Result<Material, MaterialFault> {
        if let Some(young) = self.young {
            check("young", young.si, young.si > 0.0, "a modulus above 0")?;
        }
        if let Some(poisson) = self.poisson {
            check("poisson", poisson, poisson > -1.0 && poisson < 0.5, "above -1 and below 0.5")?;
        }
        check("density", self.density.si, self.density.si > 0.0, "a density above 0")?;
        self.refuse_idle_keys()?;
        let material = match self.model {
            MaterialModel::Elastic => return Ok(Material::from(self.elastic()?)),
            MaterialModel::VonMises | MaterialModel::Tresca => self.metal(self.elastic()?)?,
            MaterialModel::MohrCoulomb | MaterialModel::DruckerPrager => self.frictional(self.elastic()?)?,
            MaterialModel::ModifiedCamClay => self.cam_clay()?,
            MaterialModel::Umat => self.user(self.elastic()?, locate)?,
        };
        match material.invalid_constant() {
            None => Ok(material),
            Some((constant, value, expected)) => {
                let found = if constant.contains("angle") {
                    format!("{} deg", rounded(value.to_degrees()))
                } else {
                    value.to_string()
                };
                fault(self.key_of(constant), found, expected)
            }
        }
    }

    fn name(&self) -> &'static str {
        match self.model {
            MaterialModel::Elastic => "elastic",
            MaterialModel::MohrCoulomb => "mohr_coulomb",
            MaterialModel::DruckerPrager => "drucker_prager",
            MaterialModel::VonMises => "von_mises",
            MaterialModel::Tresca => "tresca",
            MaterialModel::ModifiedCamClay => "modified_cam_clay",
            MaterialModel::Umat => "umat",
        }
    }

    fn elastic(&self) -> Result<Elastic, MaterialFault> {
        let young = self.need("young", self.young.map(|y| y.si))?;
        Ok(Elastic { young, poisson: self.need("poisson", self.poisson)?, density: self.density.si })
    }

    fn cam_clay(&self) -> Result<Material, MaterialFault> {
        let shear = match (self.poisson, self.shear_modulus) {
            (Some(_), Some(_)) => {
                return conflicting("shear_modulus", "poisson");
            }
            (None, Some(modulus)) => Shear::Modulus(modulus.si),
            (poisson, None) => Shear::Poisson(self.need("poisson", poisson)?),
        };
        let consolidation = match (self.preconsolidation, self.overconsolidation) {
            (Some(_), Some(_)) => {
                return conflicting("overconsolidation", "preconsolidation");
            }
            (None, Some(ratio)) => Consolidation::Ratio(ratio),
            (pressure, None) => {
                Consolidation::Pressure(self.need("preconsolidation", pressure.map(|p| p.si))?)
            }
        };
        let law = ModifiedCamClay {
            lambda: self.need("lambda", self.lambda)?,
            kappa: self.need("kappa", self.kappa)?,
            critical_ratio: self.need("critical_ratio", self.critical_ratio)?,
            void_ratio: self.need("void_ratio", self.void_ratio)?,
            shear,
            consolidation,
            minimum_pressure: self.minimum_pressure.map_or(1e3, |p| p.si),
        };
        Ok(Material { elastic: law.reference(self.density.si), law: law.into() })
    }

    fn user(&self, elastic: Elastic, locate: impl Fn(&Path) -> PathBuf) -> Result<Material, MaterialFault> {
        let Some(umat) = &self.umat else {
            return faulty("umat", Problem::missing("a table with a `library`"));
        };
        let law = umat.law(&self.title(), locate);
        law.map(|law| Material::plastic(elastic, law))
            .map_err(|(key, problem)| MaterialFault { key, problem })
    }

    /// Name in reports.
    pub fn title(&self) -> String {
        if self.name.is_empty() { format!("material {}", self.id) } else { self.name.clone() }
    }

    fn need(&self, key: &'static str, value: Option<f64>) -> Result<f64, MaterialFault> {
        match value {
            Some(value) => Ok(value),
            None => faulty(key, Problem::missing(format!("a value for the model `{}`", self.name()))),
        }
    }

    fn strength(&self, key: &'static str, value: Option<f64>) -> Result<Hardening, MaterialFault> {
        match (value, self.hardening, &self.hardening_table) {
            (None, None, Some(table)) => {
                Ok(Hardening::Table(table.iter().map(|(x, y)| (*x, y.si)).collect()))
            }
            (Some(_), _, Some(_)) => conflicting("hardening_table", key),
            (_, Some(_), Some(_)) => conflicting("hardening", "hardening_table"),
            (_, modulus, None) => {
                let initial = self.need(key, value)?;
                Ok(match modulus {
                    None => Hardening::Constant(initial),
                    Some(h) => Hardening::Linear { initial, modulus: h.si, limit: softest(initial, h.si) },
                })
            }
        }
    }

    fn metal(&self, elastic: Elastic) -> Result<Material, MaterialFault> {
        let yield_stress = self.strength("yield_stress", self.yield_stress.map(|y| y.si))?;
        // Both criteria match with half the tensile yield stress as cohesion.
        let cohesion = yield_stress.map(|y| 0.5 * y);
        Ok(if self.model == MaterialModel::VonMises {
            Material::plastic(elastic, DruckerPrager { cohesion, ..DruckerPrager::von_mises(1.0) })
        } else {
            Material::plastic(elastic, MohrCoulomb { cohesion, ..MohrCoulomb::tresca(1.0) })
        })
    }

    fn frictional(&self, elastic: Elastic) -> Result<Material, MaterialFault> {
        let cohesion = self.strength("cohesion", self.cohesion.map(|c| c.si))?;
        let friction = match (&self.friction, &self.friction_table) {
            (None, Some(table)) => Hardening::Table(table.iter().map(|(x, y)| (*x, y.si)).collect()),
            (Some(_), Some(_)) => {
                return conflicting("friction_table", "friction");
            }
            (friction, None) => Hardening::Constant(self.need("friction", friction.map(|f| f.si))?),
        };
        let (key, steepest) = match &friction {
            Hardening::Table(table) => ("friction_table", table.iter().map(|p| p.1).fold(0.0, f64::max)),
            Hardening::Constant(angle) => ("friction", *angle),
            Hardening::Linear { .. } => ("friction", 0.0),
        };
        if steepest > STEEPEST {
            let degrees = (1e6 * steepest.to_degrees()).round() / 1e6;
            return fault(key, format!("{degrees} deg"), "an angle of 80 degrees at most");
        }
        let dilation = self.need("dilation", self.dilation.map(|d| d.si))?;
        let tension = self.tension.map(|t| t.si);
        if self.model == MaterialModel::MohrCoulomb {
            return Ok(Material::plastic(elastic, MohrCoulomb { cohesion, friction, dilation, tension }));
        }
        let cone = match self.cone {
            Some(Cone::Compression) => material::Cone::Compression,
            Some(Cone::Extension) => material::Cone::Extension,
            Some(Cone::PlaneStrain) => material::Cone::PlaneStrain,
            None => {
                let expected = "\"compression\", \"extension\" or \"plane_strain\"";
                return faulty("cone", Problem::missing(expected));
            }
        };
        Ok(Material::plastic(elastic, DruckerPrager { cohesion, friction, dilation, cone, tension }))
    }

    fn key_of(&self, constant: &str) -> &'static str {
        match constant {
            "Young's modulus" => "young",
            "Poisson's ratio" => "poisson",
            "density" => "density",
            "friction angle" if self.friction_table.is_some() => "friction_table",
            "friction angle" => "friction",
            "dilation angle" => "dilation",
            "tension cut-off" => "tension",
            "lambda" => "lambda",
            "kappa" => "kappa",
            "critical ratio" => "critical_ratio",
            "void ratio" => "void_ratio",
            "shear modulus" => "shear_modulus",
            "preconsolidation pressure" => "preconsolidation",
            "overconsolidation ratio" => "overconsolidation",
            "minimum pressure" => "minimum_pressure",
            _ if self.hardening_table.is_some() => "hardening_table",
            _ if self.yield_stress.is_some() => "yield_stress",
            "cohesion" => "cohesion",
            _ => "hardening",
        }
    }

    fn refuse_idle_keys(&self) -> Result<(), MaterialFault> {
        let clay: &[&str] = &["modified_cam_clay"];
        let others: &[&str] = &["elastic", "umat", "mohr_coulomb", "drucker_prager", "von_mises", "tresca"];
        let frictional: &[&str] = &["mohr_coulomb", "drucker_prager"];
        let (metal, plastic, user) = (&others[4..], &others[2..], &others[1..2]);
        let keys = [
            ("young", self.young.is_some(), others),
            ("lambda", self.lambda.is_some(), clay),
            ("kappa", self.kappa.is_some(), clay),
            ("critical_ratio", self.critical_ratio.is_some(), clay),
            ("void_ratio", self.void_ratio.is_some(), clay),
            ("preconsolidation", self.preconsolidation.is_some(), clay),
            ("overconsolidation", self.overconsolidation.is_some(), clay),
            ("shear_modulus", self.shear_modulus.is_some(), clay),
            ("minimum_pressure", self.minimum_pressure.is_some(), clay),
            ("cohesion", self.cohesion.is_some(), frictional),
            ("friction", self.friction.is_some(), frictional),
            ("dilation", self.dilation.is_some(), frictional),
            ("tension", self.tension.is_some(), frictional),
            ("friction_table", self.friction_table.is_some(), frictional),
            ("cone", self.cone.is_some(), &frictional[1..]),
            ("yield_stress", self.yield_stress.is_some(), metal),
            ("hardening", self.hardening.is_some(), plastic),
            ("hardening_table", self.hardening_table.is_some(), plastic),
            ("umat", self.umat.is_some(), user),
        ];
        match keys.iter().find(|(_, present, models)| *present && !models.contains(&self.name())) {
            Some((key, _, models)) => faulty(key, Problem::no_effect(setting("model", models))),
            None => Ok(()),
        }
    }
}

/// Softening limit: a hundredth of the initial strength. Hardening has no limit.
fn softest(initial: f64, modulus: f64) -> Option<f64> {
    (modulus < 0.0).then_some(0.01 * initial)
}

fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}
