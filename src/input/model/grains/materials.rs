//! `[[material]]` and `[[contact]]` resolved.

use super::check::find;
use super::laws;
use super::own_law;
use super::sources;
use crate::scene::material::{DampingKind, GrainMaterial, PairContact, Resistance};
use crate::scene::{Scene, SceneError, Table};
use std::f64::consts::FRAC_PI_2;
use trackbed_dem::law::conical_damage;
use trackbed_dem::law::damping::Damping;
use trackbed_dem::law::formula::Formula;
use trackbed_dem::law::parameter::{self, Parameter};
use trackbed_dem::law::table;
use trackbed_dem::material::LawName;
use trackbed_dem::{Material, PairOverride};

/// Materials of a scene.
#[derive(Clone)]
pub struct MaterialsPart {
    /// Materials in scene order.
    pub all: Vec<Material>,
    /// Overrides for pairs.
    pub pairs: Vec<PairOverride>,
    /// Materials of grains.
    pub of_grains: Vec<usize>,
    /// Checks of an own law, for `check`.
    pub law_lines: Vec<String>,
    /// Own contact law.
    pub own_law: Option<&'static Formula>,
    pub(super) names: Vec<String>,
    /// Stiffness over the mean, by material; 1 beyond its end.
    pub(super) factors: Vec<f64>,
}

impl MaterialsPart {
    /// Returns grain materials that may contact a solid. Rigid sleepers contact grains only.
    pub fn touching(&self) -> impl Iterator<Item = (usize, String)> {
        self.of_grains.iter().map(|&m| (m, self.names[m].clone()))
    }

    /// Returns the corner strength above which crushing of a material, `factor` times as stiff, would gain energy [Pa].
    pub(super) fn greatest_strength(&self, material: usize, factor: f64) -> f64 {
        let Material { young, poisson, corner_angle, .. } = self.all[material];
        let modulus = young.map_or(f64::INFINITY, |young| 0.5 * factor * young / (1.0 - poisson * poisson));
        conical_damage::greatest_strength(modulus, corner_angle)
    }

    /// Returns sources of contact laws and time integration.
    pub fn sources(&self) -> Vec<&'static str> {
        sources::of(&self.all, &self.pairs)
    }

    /// Returns pair overrides, with a common grain friction.
    pub fn pairs_with(&self, friction: Option<f64>) -> Vec<PairOverride> {
        let mut pairs = self.pairs.clone();
        let Some(friction) = friction else { return pairs };
        for (i, &a) in self.of_grains.iter().enumerate() {
            for &b in &self.of_grains[i..] {
                let same = |c: &&mut PairOverride| (c.a.min(c.b), c.a.max(c.b)) == (a.min(b), a.max(b));
                if let Some(c) = pairs.iter_mut().find(same) {
                    c.friction = Some(friction);
                } else {
                    pairs.push(PairOverride { a, b, friction: Some(friction), ..PairOverride::default() });
                }
            }
        }
        pairs
    }
}

pub(super) fn build(scene: &Table<Scene>) -> Result<MaterialsPart, SceneError> {
    let own = own_law::own_law(scene)?;
    let all = materials(scene, own)?;
    let pairs = pairs(scene, own)?;
    laws::check_laws(scene, &all, &pairs)?;
    let law_lines = own_law::checked(scene, own, (&all, &pairs))?;
    let names = scene.material.iter().map(|m| m.name.clone()).collect();
    Ok(MaterialsPart {
        all,
        pairs,
        of_grains: Vec::new(),
        law_lines,
        own_law: own,
        names,
        factors: Vec::new(),
    })
}

fn materials(scene: &Table<Scene>, own: Option<&'static Formula>) -> Result<Vec<Material>, SceneError> {
    let mut out = Vec::new();
    for (i, m) in scene.rows("material", &scene.material).enumerate() {
        if scene.material[..i].iter().any(|other| other.name == m.name) {
            return Err(m.error("name", format!("\"{}\" again", m.name), "each name once"));
        }
        // Infinity would be read as not set.
        m.check("stiffness", m.stiffness, |_| true, "a finite stiffness")?;
        m.check("corner_strength", m.corner_strength, |_| true, "a finite strength")?;
        m.check("asperity_pressure", m.asperity_pressure, |_| true, "a finite pressure")?;
        let (normal, formula) = normal(&m, m.normal.as_deref(), own)?;
        let material = Material { normal, formula, ..parameters(&m) };
        poisson_beside_young(&m)?;
        corner_keys(&m)?;
        check_ranges(&m, &parameter::MATERIAL, &material)?;
        crushing(&m)?;
        asperities(&m)?;
        out.push(material);
    }
    Ok(out)
}

/// Returns material parameters without normal law.
pub fn parameters(m: &GrainMaterial) -> Material {
    Material {
        // Required for bodies; unused for walls.
        density: m.density.map_or(1.0, |d| d.si),
        stiffness: m.stiffness.map_or(f64::INFINITY, |s| s.si),
        tangential_ratio: m.tangential_ratio.unwrap_or(0.5),
        tangential_damping_ratio: m.tangential_damping_ratio,
        friction: m.friction,
        asperity_friction: m.asperity_friction,
        asperity_pressure: m.asperity_pressure.map_or(f64::INFINITY, |p| p.si),
        restitution: m.restitution,
        young: m.young.map(|y| y.si),
        poisson: m.poisson.unwrap_or(0.0),
        edge_factor: m.edge_factor.unwrap_or(1.0),
        corner_strength: m.corner_strength.map_or(f64::INFINITY, |s| s.si),
        corner_angle: m.corner_angle.map_or(FRAC_PI_2, |a| a.si),
        rolling_friction: m.rolling_friction,
        twisting_friction: m.twisting_friction,
        normal: None,
        formula: None,
    }
}

fn check_ranges<T, P>(row: &Table<T>, table: &[Parameter<P>], of: &P) -> Result<(), SceneError> {
    for p in table {
        match p.value(of) {
            Some(value) if !p.range.contains(value) => {
                let found = format!("{} {}", round_12(value), p.unit);
                return Err(row.error(p.key, found.trim_end(), p.range.to_string()));
            }
            _ => {}
        }
    }
    Ok(())
}

fn round_12(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

fn asperities(m: &Table<GrainMaterial>) -> Result<(), SceneError> {
    match (m.asperity_friction > 0.0, &m.asperity_pressure) {
        (true, None) => {
            Err(m.missing("asperity_pressure", "the pressure at which half of `asperity_friction` is left"))
        }
        (false, Some(_)) => Err(m.no_effect("asperity_pressure", "`asperity_friction`")),
        _ => Ok(()),
    }
}

fn corner_keys(m: &Table<GrainMaterial>) -> Result<(), SceneError> {
    match (m.corner_strength, m.corner_angle) {
        (None, None) => Ok(()),
        (None, Some(_)) => Err(m.no_effect("corner_angle", "`corner_strength`")),
        (Some(_), None) => Err(m.missing("corner_angle", "half the angle of the cones that crush")),
        (Some(_), Some(_)) if m.young.is_none() => Err(m.requirement("corner_strength", "`young`")),
        (Some(_), Some(_)) => Ok(()),
    }
}

/// Crushing must dissipate energy.
fn crushing(m: &Table<GrainMaterial>) -> Result<(), SceneError> {
    let (Some(strength), Some(angle), Some(young)) = (m.corner_strength, m.corner_angle, m.young) else {
        return Ok(());
    };
    let poisson = m.poisson.unwrap_or(0.0);
    let most = conical_damage::greatest_strength(0.5 * young.si / (1.0 - poisson * poisson), angle.si);
    m.check(
        "corner_strength",
        Some(strength.si),
        |s| s < most,
        &format!("below {most:.3e} Pa with this modulus and angle, so that crushing dissipates energy"),
    )?;
    Ok(())
}

fn poisson_beside_young(m: &Table<GrainMaterial>) -> Result<(), SceneError> {
    match (&m.young, m.poisson) {
        (Some(_), None) => Err(m.missing("poisson", "Poisson's ratio with `young`")),
        (None, Some(_)) => Err(m.requirement("poisson", "`young`")),
        (None, None) if m.edge_factor.is_some() => Err(m.no_effect("edge_factor", "`young`")),
        _ => Ok(()),
    }
}

type Normal = (Option<LawName>, Option<&'static Formula>);

fn normal<T>(
    table: &Table<T>,
    name: Option<&str>,
    own: Option<&'static Formula>,
) -> Result<Normal, SceneError> {
    let Some(name) = name else { return Ok((None, None)) };
    if let Some((law, formula)) = own_law::named(own, name) {
        return Ok((Some(law), Some(formula)));
    }
    let expected = || format!("one of {}", table::normals().join(", "));
    table::normal_named(name)
        .map(|law| (Some(law), None))
        .ok_or_else(|| table.error("normal", format!("\"{name}\""), expected()))
}

fn tangential(c: &Table<PairContact>) -> Result<Option<LawName>, SceneError> {
    let Some(name) = c.tangential.as_deref() else { return Ok(None) };
    let expected = || format!("one of {}", table::tangentials().join(", "));
    table::tangential_named(name)
        .map(Some)
        .ok_or_else(|| c.error("tangential", format!("\"{name}\""), expected()))
}

fn pairs(scene: &Table<Scene>, own: Option<&'static Formula>) -> Result<Vec<PairOverride>, SceneError> {
    let mut out = Vec::new();
    for c in scene.rows("contact", &scene.contact) {
        let resist = |k: &str, kind: Option<Resistance>, value: Option<f64>| match (kind, value) {
            (Some(Resistance::None), Some(_)) => {
                let resistance = k.trim_end_matches("_friction");
                Err(c.conflict(k, format!("`{resistance} = \"none\"`")))
            }
            (Some(Resistance::None), None) => Ok(Some(0.0)),
            (Some(Resistance::Spring) | None, value) => Ok(value),
        };
        let (normal, formula) = normal(&c, c.normal.as_deref(), own)?;
        let pair = PairOverride {
            a: find(scene, &c, "between", &c.between[0])?,
            b: find(scene, &c, "between", &c.between[1])?,
            friction: c.friction,
            restitution: c.restitution,
            stiffness: c.stiffness.map(|s| s.si),
            adhesion: c.adhesion.map(|w| w.si),
            normal,
            formula,
            tangential: tangential(&c)?,
            damping: damping(&c)?,
            rolling_friction: resist("rolling_friction", c.rolling, c.rolling_friction)?,
            twisting_friction: resist("twisting_friction", c.twisting, c.twisting_friction)?,
        };
        check_ranges(&c, &parameter::PAIR, &pair)?;
        out.push(pair);
    }
    Ok(out)
}

fn damping(c: &Table<PairContact>) -> Result<Option<Damping>, SceneError> {
    match (c.damping, c.damping_ratio) {
        (Some(DampingKind::Ratio), Some(zeta)) => Ok(Some(Damping::Ratio(zeta))),
        (Some(DampingKind::Ratio), None) => Err(c.missing("damping_ratio", "the damping ratio")),
        (_, Some(_)) => Err(c.no_effect("damping_ratio", "`damping = \"ratio\"`")),
        (Some(_), None) if c.restitution.is_some() && c.damping == Some(DampingKind::None) => {
            Err(c.conflict("restitution", "`damping = \"none\"`"))
        }
        (Some(DampingKind::None), None) => Ok(Some(Damping::None)),
        (Some(DampingKind::Restitution), None) => Ok(Some(Damping::Restitution)),
        (None, None) => Ok(None),
    }
}
