//! Names of groups and materials, from the scene text in `run.json`.

use std::fs;
use std::path::Path;

use serde_json::{Map, Value, json};

use trackbed_io::results::series;

/// Returns the groups with their contact materials, in order, and the solid materials by id.
///
/// Included files are not read: their groups follow the groups of the scene.
pub fn of_run(dir: &Path) -> [Value; 2] {
    let bytes = series::own(dir, "run.json").and_then(|file| fs::read(file).ok());
    let run: Value = bytes.and_then(|bytes| serde_json::from_slice(&bytes).ok()).unwrap_or_default();
    of_scene(run["text"].as_str().unwrap_or_default())
}

fn of_scene(text: &str) -> [Value; 2] {
    let scene: toml::Table = text.parse().unwrap_or_default();
    let list = |table: Option<&toml::Value>| table.and_then(|t| t.as_array()).cloned().unwrap_or_default();
    let name = |of: &toml::Value, key: &str| of.get(key).and_then(|v| v.as_str()).map(String::from);
    let groups = list(scene.get("grains"));
    let groups = groups.iter().map(|g| json!({ "name": name(g, "name"), "material": name(g, "material") }));
    let solids = list(scene.get("solid").and_then(|solid| solid.get("material")));
    let materials: Map<String, Value> = solids
        .iter()
        .filter_map(|m| Some((m.get("id")?.as_integer()?.to_string(), json!(name(m, "name")?))))
        .collect();
    [groups.collect(), materials.into()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_names_of_groups_and_materials() {
        let text = "[[grains]]\nname = \"ballast\"\nmaterial = \"stone\"\n[[grains]]\nname = \"crib\"\n\
                    [[solid.material]]\nid = 2\nname = \"clay\"\n[[solid.material]]\nid = 3\n";
        let groups =
            json!([{ "name": "ballast", "material": "stone" }, { "name": "crib", "material": null }]);
        assert_eq!(of_scene(text), [groups, json!({ "2": "clay" })]);
    }

    #[test]
    fn unreadable_scene_has_no_names() {
        assert_eq!(of_scene("[[grains"), [json!([]), json!({})]);
    }
}
