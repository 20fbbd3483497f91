//! Tests resolved to materials and strain paths.

use super::file::{Controlled, ElementFile, Kind, Names, TestTable};
use serde::Deserialize;
use std::path::PathBuf;
use trackbed_fem::element_test::{self, Control, Segment};
use trackbed_fem::material::Material;
use trackbed_input::scene::solid::{MaterialFault, SolidMaterial};
use trackbed_input::scene::units::{Quantity, Stress};
use trackbed_input::scene::{Document, SceneError, Table};

const STEPS: usize = 200;
/// Most steps of all segments of a test.
const MOST_STEPS: usize = 100_000;
/// Largest strain.
const MOST_STRAIN: f64 = 1.0;
/// Excess of the yield function over the size of the stress that still counts as elastic.
const INSIDE: f64 = 1e-9;

/// Material with its name.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name.
    pub name: String,
    /// Constants.
    pub material: Material,
}

/// Resolved test.
#[derive(Clone, Debug)]
pub struct Test {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: Kind,
    /// Materials, by index.
    pub materials: Vec<usize>,
    /// Initial stress [Pa], tension positive.
    pub initial: [f64; 6],
    /// Path.
    pub segments: Vec<Segment>,
}

/// Resolved file.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Heading.
    pub name: String,
    /// Materials.
    pub materials: Vec<Named>,
    /// Tests.
    pub tests: Vec<Test>,
}

impl Plan {
    /// Resolves a file.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, file: &ElementFile) -> Result<Plan, SceneError> {
        let root = Table::root(document, file);
        let mut materials = own_materials(&root)?;
        if let Some(scene) = &file.scene {
            materials.extend(scene_materials(document.resolve(scene))?);
        } else if materials.is_empty() {
            return Err(root.choice(["material", "scene"], false));
        }
        for (k, material) in materials.iter().enumerate() {
            if materials[..k].iter().any(|other| other.name == material.name) {
                let key = if k < file.material.len() { format!("material.{k}.name") } else { "scene".into() };
                let found = format!("the material \"{}\" twice", material.name);
                return Err(root.error(&key, found, "distinct names"));
            }
        }
        if file.test.is_empty() {
            return Err(root.missing("test", "at least one [[test]]"));
        }
        let mut tests: Vec<Test> = Vec::new();
        for table in root.rows("test", &file.test) {
            let test = test(&table, &materials)?;
            if tests.iter().any(|other| other.name == test.name) {
                return Err(table.error(
                    "name",
                    format!("the test \"{}\" twice", test.name),
                    "distinct names",
                ));
            }
            tests.push(test);
        }
        let name = match file.name.as_str() {
            "" => document.file().file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            name => name.into(),
        };
        Ok(Plan { name, materials, tests })
    }
}

fn named(table: &Table<SolidMaterial>) -> Result<Named, SceneError> {
    let material = table
        .resolve(|file| table.locate(file))
        .map_err(|MaterialFault { key, problem }| table.problem(key, problem))?;
    Ok(Named { name: table.title(), material })
}

fn own_materials(root: &Table<ElementFile>) -> Result<Vec<Named>, SceneError> {
    let rows = root.rows("material", &root.material);
    let resolve = |table: Table<SolidMaterial>| {
        if table.k0.is_some() {
            return Err(table.no_effect("k0", "`[solid.initial_stress]` of a scene"));
        }
        named(&table)
    };
    rows.map(resolve).collect()
}

fn scene_materials(file: PathBuf) -> Result<Vec<Named>, SceneError> {
    let document = Document::open(&file)?;
    let scene = document.scene()?;
    let Some(solid) = &scene.solid else {
        return Err(document.error("solid", "nothing", "a solid with materials"));
    };
    let table = Table::top(&document, "solid", solid);
    table.rows("material", &solid.material).map(|material| named(&material)).collect()
}

fn test(table: &Table<TestTable>, materials: &[Named]) -> Result<Test, SceneError> {
    let name = table.name.clone().unwrap_or_else(|| table.kind.word().into());
    let used = used_materials(table, materials)?;
    let stress = table.check("stress", table.stress, |s| s >= 0.0, "a compressive stress of 0 or more")?;
    let pressure = stress.map_or(0.0, |s| s.si);
    let initial = [-pressure, -pressure, -pressure, 0.0, 0.0, 0.0];
    for &k in &used {
        let Named { name, material } = &materials[k];
        if element_test::initial_excess(material, &initial) > INSIDE {
            let found = format!("{pressure} Pa, outside the yield surface of \"{name}\"");
            return Err(table.error("stress", found, "an initial stress inside the yield surface"));
        }
    }
    let segments = match table.kind {
        Kind::Path => path(table)?,
        _ => loading(table, pressure)?,
    };
    Ok(Test { name, kind: table.kind, materials: used, initial, segments })
}

fn used_materials(table: &Table<TestTable>, materials: &[Named]) -> Result<Vec<usize>, SceneError> {
    let Some(Names { list, is_list }) = &table.material else { return Ok((0..materials.len()).collect()) };
    if list.is_empty() {
        return Err(table.error("material", "an empty list", "at least one name"));
    }
    let mut used = Vec::new();
    for (k, name) in list.iter().enumerate() {
        let key = if *is_list { format!("material.{k}") } else { "material".into() };
        match materials.iter().position(|material| material.name == *name) {
            Some(index) if used.contains(&index) => {
                return Err(table.error(&key, format!("\"{name}\" twice"), "each name once"));
            }
            Some(index) => used.push(index),
            None => {
                let names: Vec<String> = materials.iter().map(|m| format!("\"{}\"", m.name)).collect();
                let expected = format!("one of {}", names.join(", "));
                return Err(table.error(&key, format!("\"{name}\""), expected));
            }
        }
    }
    Ok(used)
}

/// Steps of a segment, if `segments` of these are allowed.
fn steps(table: &Table<TestTable>, segments: usize) -> Result<usize, SceneError> {
    let most = (MOST_STEPS / segments.max(1)).max(1);
    let steps = table.steps.unwrap_or(STEPS);
    if (1..=most).contains(&steps) {
        return Ok(steps);
    }
    let expected = format!("1 to {most} (at most {MOST_STEPS} steps of a test)");
    Err(table.error("steps", steps.to_string(), expected))
}

fn loading(table: &Table<TestTable>, pressure: f64) -> Result<Vec<Segment>, SceneError> {
    let without = "`kind = \"path\"`";
    table.reject_without(
        [("controls", table.controls.is_some()), ("points", table.points.is_some())],
        without,
    )?;
    let range = |x: f64| x.abs() <= MOST_STRAIN;
    let strain = table.need("strain", table.strain, "the strain at the end")?;
    table.check("strain", strain, |x| x != 0.0 && range(x), "-1 to 1, not 0")?;
    let least = table.check("least", table.least, range, "-1 to 1")?;
    let ends = match table.cycles {
        None => {
            table.reject_without([("least", least.is_some())], "`cycles`")?;
            vec![strain]
        }
        Some(cycles) => {
            let most = MOST_STEPS / 2;
            if !(1..=most).contains(&cycles) {
                return Err(table.error("cycles", cycles.to_string(), format!("1 to {most}")));
            }
            let least = least.unwrap_or(0.0);
            if least == strain {
                return Err(table.error("least", least.to_string(), "a strain other than `strain`"));
            }
            [strain, least].repeat(cycles)
        }
    };
    let steps = steps(table, ends.len())?;
    Ok(ends.into_iter().map(|end| segment(table.kind, end, pressure, steps)).collect())
}

/// Segment of a kind other than `path`; axial direction z, shear in the plane zx.
fn segment(kind: Kind, strain: f64, pressure: f64, steps: usize) -> Segment {
    let mut controls = [Control::Strain; 6];
    let mut target = [0.0; 6];
    match kind {
        Kind::Triaxial => {
            controls[..2].fill(Control::Stress);
            target[..2].fill(-pressure);
            target[2] = -strain;
        }
        Kind::Undrained => target[..3].copy_from_slice(&[0.5 * strain, 0.5 * strain, -strain]),
        Kind::Oedometer | Kind::Path => target[2] = -strain,
        Kind::SimpleShear => {
            controls[2] = Control::Stress;
            target[2] = -pressure;
            target[5] = -strain;
        }
    }
    Segment { controls, target, steps }
}

fn path(table: &Table<TestTable>) -> Result<Vec<Segment>, SceneError> {
    let others = [
        ("strain", table.strain.is_some()),
        ("least", table.least.is_some()),
        ("cycles", table.cycles.is_some()),
    ];
    table.reject_with(others, "`kind = \"path\"`")?;
    let controls = table.need("controls", table.controls, "\"strain\" or \"stress\" of six components")?;
    let points = table.need("points", table.points.as_deref(), "a list of six values for each segment")?;
    if points.is_empty() {
        return Err(table.error("points", "an empty list", "at least one list of six values"));
    }
    let steps = steps(table, points.len())?;
    let kinds = controls.map(|controlled| match controlled {
        Controlled::Strain => Control::Strain,
        Controlled::Stress => Control::Stress,
    });
    let mut segments = Vec::new();
    for (k, point) in points.iter().enumerate() {
        let mut target = [0.0; 6];
        for (j, value) in point.iter().enumerate() {
            let key = format!("points.{k}.{j}");
            target[j] = -component(value, controls[j])
                .map_err(|expected| table.error(&key, value.to_string(), expected))?;
        }
        segments.push(Segment { controls: kinds, target, steps });
    }
    Ok(segments)
}

fn component(value: &toml::Value, controlled: Controlled) -> Result<f64, &'static str> {
    match controlled {
        Controlled::Stress => Quantity::<Stress>::deserialize(value.clone())
            .map(|stress| stress.si)
            .map_err(|_| "a stress in Pa, such as 1e5 or \"100 kPa\""),
        Controlled::Strain => {
            let number = value.as_float().or_else(|| value.as_integer().map(|n| n as f64));
            number.filter(|x| x.abs() <= MOST_STRAIN).ok_or("a strain of -1 to 1")
        }
    }
}
