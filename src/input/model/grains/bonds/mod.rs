//! `[[bond]]` resolved: types and pair rules.

mod kind;
mod part;
mod rule;

pub use part::BondPart;
pub(super) use rule::law;

use super::deposition::DepositionPlan;
use crate::scene::{Document, Scene, SceneError, Table};
use rule::{Joinable, rule};
use trackbed_dem::bond::BondInput;
use trackbed_dem::{BodyInput, ModelInput, Shape};
use trackbed_io::failure::Failure;

/// Resolved before grains refer to them.
pub(super) fn kinds(scene: &Table<Scene>) -> Result<BondPart, Failure> {
    let mut part = BondPart::default();
    for table in scene.rows("bond", &scene.bond) {
        if part.find(&table.name).is_some() {
            return Err(table.error("name", format!("\"{}\" again", table.name), "another name").into());
        }
        part.add_kind(&table.name, kind::kind(&table)?);
    }
    Ok(part)
}

/// Resolved after all grains are known.
pub(super) fn rules(
    scene: &Table<Scene>,
    groups: &[String],
    count: usize,
    settling: Option<&DepositionPlan>,
    bonds: &mut BondPart,
) -> Result<(), Failure> {
    if bonds.has_made() {
        let idle = [
            ("deposition.level", settling.is_some_and(|d| d.level.is_some())),
            ("deposition.layers", settling.is_some_and(|d| d.layers > 1)),
        ];
        scene.reject_with(idle, "[[grains]] with `bond`")?;
    }
    let levelled = settling.is_some_and(|d| d.level.is_some());
    for (kind, table) in scene.rows("bond", &scene.bond).enumerate() {
        let bodies = Joinable { bonds, kind, groups, count, levelled };
        let rule = rule(&table, &bodies)?;
        bonds.add_rule(rule);
    }
    Ok(())
}

const WIDEST_GAP: f64 = 10.0;

/// Rejects gaps that bond each sphere to hundreds of others.
pub fn check_gaps(
    document: &Document,
    part: &BondPart,
    bodies: &[BodyInput],
    shapes: &[Shape],
) -> Result<(), SceneError> {
    let Some((kind, gap, radius)) = wide_gap(part, bodies, shapes) else { return Ok(()) };
    let expected = format!("at most {WIDEST_GAP} times the largest radius, which is {radius:.3e} m");
    Err(document.error(&format!("bond.{kind}.gap"), format!("{gap} m"), expected))
}

/// Returns a kind of bonds with too wide a gap, the gap and the largest radius [m].
pub(super) fn wide_gap(part: &BondPart, bodies: &[BodyInput], shapes: &[Shape]) -> Option<(usize, f64, f64)> {
    let gap = |kind| part.gap(kind, bodies, shapes).map(|(gap, radius)| (kind, gap, radius));
    (0..part.names.len()).filter_map(gap).find(|(_, gap, radius)| *gap > WIDEST_GAP * radius)
}

/// Rejects rules that cannot bond any pair at any positions.
pub(super) fn check_joinable(
    document: &Document,
    part: &BondPart,
    input: &ModelInput,
) -> Result<(), SceneError> {
    for kind in 0..part.names.len() {
        if !part.can_join(kind, &input.bodies, &input.shapes) {
            return Err(nothing_joined(document, part, kind));
        }
    }
    Ok(())
}

fn nothing_joined(document: &Document, part: &BondPart, kind: usize) -> SceneError {
    let expected = "a bond that joins grains: a larger `gap`, or other groups";
    let found = format!("no pair for \"{}\"", part.names[kind]);
    document.error(&format!("bond.{kind}"), found, expected)
}

/// Rejects rules without any initial bond.
pub fn check_joined(document: &Document, part: &BondPart, bonds: &[BondInput]) -> Result<(), SceneError> {
    for kind in 0..part.names.len() {
        if !bonds.iter().any(|b| b.kind == kind) {
            return Err(nothing_joined(document, part, kind));
        }
    }
    Ok(())
}
