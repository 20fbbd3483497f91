//! Contact laws of material pairs, and unused constants.

use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::law::parameter;
use trackbed_dem::law::table::{COMBINATIONS, LawInfo, combination};
use trackbed_dem::material::Pair;
use trackbed_dem::{Material, PairOverride};

pub(super) fn check_laws(
    scene: &Table<Scene>,
    materials: &[Material],
    contacts: &[PairOverride],
) -> Result<(), SceneError> {
    let name = |i: usize| scene.material[i].name.as_str();
    let law = |i: usize, j: usize| combination(&Pair::of(materials, contacts, i, j));
    let given =
        |i: usize, j: usize| contacts.iter().rposition(|c| (c.a, c.b) == (i, j) || (c.a, c.b) == (j, i));
    for i in 0..materials.len() {
        let mut laws: Vec<&LawInfo> = Vec::new();
        for j in 0..materials.len() {
            match law(i, j) {
                Ok(law) => laws.extend(law),
                Err(problem) => {
                    let entry = given(i, j).filter(|&c| contacts[c].normal.is_some());
                    let expected =
                        "a law for each pair of materials, from both or from `normal` of their [[contact]]";
                    let found = format!("for \"{}\" and \"{}\" {problem}", name(i), name(j));
                    return Err(match entry {
                        Some(c) => scene.row("contact", &scene.contact, c).error("normal", found, expected),
                        None => scene.row("material", &scene.material, j).here(found, expected),
                    });
                }
            }
        }
        check_constants(scene, i, &laws)?;
        if let (Some(normal), Ok(Some(own))) = (materials[i].normal, law(i, i)) {
            let m = scene.row("material", &scene.material, i);
            let there = [("stiffness", m.stiffness.is_some()), ("young", m.young.is_some())];
            if let Some((key, _)) = there.iter().find(|(key, there)| own.normal_keys.contains(key) && !there)
            {
                let expected = format!(
                    "a value for this key, which `normal = \"{}\"` needs",
                    m.normal.as_deref().unwrap_or(normal.as_str())
                );
                return Err(m.missing(key, expected));
            }
        }
    }
    for (pair, c) in contacts.iter().zip(scene.rows("contact", &scene.contact)) {
        let Ok(Some(own)) = law(pair.a, pair.b) else { continue };
        if c.stiffness.is_some() && !own.uses("stiffness") {
            return Err(c.conflict("stiffness", "`young` of the materials"));
        }
        if c.damping.is_some() && !own.dashpot {
            let remedy = format!("The normal law \"{}\" has no dashpot", own.normal);
            return Err(c.no_effect("damping", "a dashpot").remedy(remedy));
        }
    }
    Ok(())
}

fn check_constants(scene: &Table<Scene>, i: usize, laws: &[&LawInfo]) -> Result<(), SceneError> {
    let m = scene.row("material", &scene.material, i);
    let unused = |key: &str| !laws.is_empty() && !laws.iter().any(|law| law.uses(key));
    if m.stiffness.is_some() && unused("stiffness") {
        let young = scene.material.iter().find(|other| other.young.is_some());
        return Err(match young {
            Some(other) => m.conflict("stiffness", format!("`young` of \"{}\"", other.name)),
            None => m.no_effect("stiffness", "a contact law that uses it"),
        });
    }
    if m.young.is_some() && unused("young") {
        return Err(m.no_effect("young", "a contact law that uses it"));
    }
    if m.tangential_damping_ratio > 0.0 && !laws.is_empty() && !laws.iter().any(|law| law.dashpot) {
        return Err(m.no_effect("tangential_damping_ratio", "a contact law with a dashpot"));
    }
    if m.corner_strength.is_some() && unused("corner_strength") {
        return Err(m.no_effect("corner_strength", "a contact law with conical damage"));
    }
    // Asperities add a tangential law to the linear law.
    let knows = |law: &&LawInfo| law.normal == "linear" || law.uses("asperity_friction");
    if m.asperity_friction > 0.0 && !laws.is_empty() && !laws.iter().any(knows) {
        return Err(m.no_effect("asperity_friction", "a contact law with asperities"));
    }
    if m.tangential_ratio.is_some() && unused("tangential_ratio") {
        return Err(m.conflict("tangential_ratio", "`young`").remedy("Poisson's ratio sets it"));
    }
    // Asperities are judged by their value above, as zero is the default.
    let named = |key: &str| key != "asperity_friction" && COMBINATIONS.iter().any(|law| law.uses(key));
    let idle = |key: &&str| named(key) && unused(key) && m.has(key);
    match parameter::MATERIAL.iter().map(|p| p.key).find(idle) {
        Some(key) => Err(m.no_effect(key, "a contact law that uses it")),
        None => Ok(()),
    }
}

pub(super) fn stiffens(materials: &[Material], contacts: &[PairOverride]) -> bool {
    let count = materials.len();
    let mut pairs = (0..count).flat_map(|i| (i..count).map(move |j| Pair::of(materials, contacts, i, j)));
    pairs.any(|pair| combination(&pair).ok().flatten().is_some_and(|law| law.stiffens))
}
