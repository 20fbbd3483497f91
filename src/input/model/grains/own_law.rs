//! `[contact_law]` resolved: formulas of an own normal law, checked with every pair that uses it.

use crate::scene::material::ContactLawTable;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::law::formula::{Formula, Texts, is_free_name};
use trackbed_dem::law::formula_check::verify;
use trackbed_dem::law::table;
use trackbed_dem::material::{LawName, Pair};
use trackbed_dem::{Material, PairOverride};

pub(super) fn own_law(scene: &Table<Scene>) -> Result<Option<&'static Formula>, SceneError> {
    let Some(law) = scene.optional("contact_law", &scene.contact_law) else { return Ok(None) };
    if table::normal_named(&law.name).is_some() {
        return Err(law.error("name", format!("\"{}\"", law.name), "a name that no shipped law has"));
    }
    if law.name.trim().is_empty() {
        return Err(law.error("name", "\"\"", "a name"));
    }
    check_constants(&law)?;
    let texts = Texts {
        force: &law.force,
        damping: law.damping.as_deref(),
        energy: law.energy.as_deref(),
        loss: law.loss.as_deref(),
    };
    let formula = Formula::parse(&law.name, &texts, &law.constants)
        .map_err(|e| mistake(&law, e.key, &e.to_string()))?;
    let named = |normal: &Option<String>| normal.as_ref() == Some(&law.name);
    if !(scene.material.iter().any(|m| named(&m.normal)) || scene.contact.iter().any(|c| named(&c.normal))) {
        let expected = format!("`normal = \"{}\"` of a [[material]] or [[contact]]", law.name);
        return Err(law.no_effect("name", expected));
    }
    Ok(Some(formula.kept()))
}

/// Error of a formula: "found …, expected …" as one.
fn mistake(law: &Table<ContactLawTable>, key: &str, problem: &str) -> SceneError {
    let (found, expected) = problem.split_once(", expected ").unwrap_or((problem, "a formula"));
    law.error(key, found.strip_prefix("found ").unwrap_or(found), expected)
}

fn check_constants(law: &Table<ContactLawTable>) -> Result<(), SceneError> {
    let texts = [Some(&law.force), law.damping.as_ref(), law.energy.as_ref(), law.loss.as_ref()];
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<&str> =
        texts.into_iter().flatten().flat_map(|t| t.split(move |c| !is_letter(c))).collect();
    for (name, value) in &law.constants {
        let key = format!("constants.{name}");
        if !is_free_name(name) {
            return Err(law.error("constants", format!("\"{name}\""), "new names of letters, digits and _"));
        }
        law.check(&key, *value, f64::is_finite, "a finite number")?;
        if !words.contains(&name.as_str()) {
            return Err(law.no_effect(&key, "its name in a formula"));
        }
    }
    Ok(())
}

/// Law of a name, if it is the own one.
pub(super) fn named(own: Option<&'static Formula>, name: &str) -> Option<(LawName, &'static Formula)> {
    own.filter(|f| f.name() == name).map(|f| (LawName::of(f), f))
}

/// Checks the own law with each pair that uses it; returns a line for `check`.
pub(super) fn checked(
    scene: &Table<Scene>,
    own: Option<&'static Formula>,
    (materials, pairs): (&[Material], &[PairOverride]),
) -> Result<Vec<String>, SceneError> {
    let (Some(formula), Some(law)) = (own, scene.optional("contact_law", &scene.contact_law)) else {
        return Ok(Vec::new());
    };
    let mut lines = Vec::new();
    for i in 0..materials.len() {
        for j in i..materials.len() {
            let pair = Pair::of(materials, pairs, i, j);
            let uses = table::combination(&pair).ok().flatten().is_some_and(|c| c.normal == formula.law());
            if !uses {
                continue;
            }
            let names = [i, j].map(|k| scene.material[k].name.as_str());
            let verdict = verify(formula, &pair).map_err(|fault| {
                let found = format!("for \"{}\" and \"{}\" {}", names[0], names[1], fault.problem);
                let expected = match fault.key {
                    "force" => "a force that grows from zero with the overlap",
                    "energy" => "the work of first loading",
                    _ => "dissipation, as stated",
                };
                law.error(fault.key, found, expected)
            })?;
            lines.push(format!(
                "contact law \"{}\", {} and {}: {verdict}",
                formula.name(),
                names[0],
                names[1]
            ));
        }
    }
    Ok(lines)
}
