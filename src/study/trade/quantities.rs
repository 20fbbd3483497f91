//! Results that a study of a scene compares.

use toml::Value;
use trackbed_input::scene::solid::Support;
use trackbed_input::scene::walls::Wall;
use trackbed_input::scene::{Document, Scene, SceneError};

/// Largest relative energy error of the recommended case.
const ENERGY: f64 = 0.01;

/// Returns `[[quantity]]` tables: results of load cycles, reactions, probes, structures, run-out, measuring boxes.
///
/// # Errors
/// A scene without any of these.
pub fn of(document: &Document, scene: &Scene) -> Result<Vec<Value>, SceneError> {
    let mut all = Vec::new();
    if scene.track.as_ref().is_some_and(|track| track.load.is_some()) {
        all.push(column("settlement", "cycles.csv", "settlement", "last", (1e3, "mm")));
        all.push(column("secant stiffness", "cycles.csv", "secant_stiffness", "mean", (1e-6, "kN/mm")));
    }
    if let Some(solid) = &scene.solid {
        all.extend(solid.support.iter().filter_map(reaction));
        if solid.strength_reduction.is_some() {
            all.push(summary("factor of safety", "safety.stable_at", (1.0, "")));
        }
    }
    all.extend(probes(scene));
    for structure in &scene.structure {
        let name = format!("largest load on {}", structure.name);
        all.push(summary(&name, &format!("structures.{}.largest", structure.name), (1e-3, "kN")));
    }
    if scene.runout.is_some() {
        all.push(summary("front", "runout.front", (1.0, "m")));
    }
    for measure in &scene.measure {
        let name = format!("porosity of {}", measure.name);
        all.push(summary(&name, &format!("packing.measures.{}.porosity", measure.name), (1.0, "")));
    }
    all.extend(scene.walls.iter().enumerate().filter_map(wall));
    if all.is_empty() {
        let expected = "load cycles, displacements of supports, probes, structures, run-out, recorded planes or measuring boxes";
        return Err(document.error("scene", "no results to compare", expected));
    }
    if !scene.grains.is_empty() {
        let mut energy = summary("energy error", "energy.relative_error", (1.0, ""));
        let more = [("norm", "absolute".into()), ("exact", 0.0.into()), ("tolerance", ENERGY.into())];
        if let Value::Table(energy) = &mut energy {
            energy.extend(more.map(|(key, value): (&str, Value)| (key.to_string(), value)));
        }
        all.push(energy);
    }
    Ok(all)
}

/// Along the prescribed displacement.
fn reaction(support: &Support) -> Option<Value> {
    let name = support.name.as_ref().filter(|_| support.displacement.is_some())?;
    let axis =
        ["x", "y", "z"].iter().position(|axis| support.directions.first().is_some_and(|d| d == axis))?;
    Some(summary(&format!("force of {name}"), &format!("reactions.{name}.force.{axis}"), (1e-3, "kN")))
}

/// Displacement of servo walls, mean force on other recorded planes, along the axis nearest to the normal.
fn wall((index, wall): (usize, &Wall)) -> Option<Value> {
    let normal = wall.normal?;
    let axis = ["x", "y", "z"][(0..3).max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))?];
    let name = wall.name.clone().unwrap_or_else(|| format!("wall{index}"));
    let of = |what: &str, take: &str, unit| {
        column(&format!("{what} of {name}"), "history.csv", &format!("{name}_{what}_{axis}"), take, unit)
    };
    match (&wall.servo, wall.record) {
        (_, false) => None,
        (Some(_), true) => Some(of("displacement", "last", (1e3, "mm"))),
        (None, true) => Some(of("force", "mean", (1e-3, "kN"))),
    }
}

fn probes(scene: &Scene) -> impl Iterator<Item = Value> {
    let single = scene.probe.iter().filter(|p| (p.node.is_some() || p.at.is_some()) && p.fields.is_none());
    single.filter_map(|p| {
        let name = p.name.as_ref()?;
        let mut curve =
            column(&format!("{name} u_z"), "history.csv", &format!("{name}_u_z"), "curve", (1e3, "mm"));
        if let Value::Table(curve) = &mut curve {
            curve.insert("against".into(), "time".into());
        }
        Some(curve)
    })
}

fn column(name: &str, file: &str, column: &str, take: &str, (factor, unit): (f64, &str)) -> Value {
    let texts = [("name", name), ("file", file), ("column", column), ("take", take), ("unit", unit)];
    let mut all = table(texts.map(|(key, text)| (key, text.into())));
    if let Value::Table(all) = &mut all {
        all.insert("factor".into(), factor.into());
    }
    all
}

fn summary(name: &str, path: &str, (factor, unit): (f64, &str)) -> Value {
    table([("name", name.into()), ("summary", path.into()), ("factor", factor.into()), ("unit", unit.into())])
}

/// Creates a table.
pub fn table<const N: usize>(entries: [(&str, Value); N]) -> Value {
    Value::Table(entries.into_iter().map(|(key, value)| (key.to_string(), value)).collect())
}
