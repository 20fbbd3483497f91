//! Names of groups, materials and line probes, from the scene in `run.json`.

use std::path::Path;

use serde_json::{Map, Value, json};

use trackbed_input::scene::Scene;
use trackbed_run::RunFile;

/// Returns groups with their contact materials, in order; solid materials by id; line probes with their lengths [m].
///
/// Empty where the scene is not understood.
pub fn of_run(dir: &Path) -> [Value; 3] {
    let document = RunFile::read(dir).and_then(|file| file.document());
    of_scene(document.and_then(|document| document.scene().ok()))
}

fn of_scene(scene: Option<Scene>) -> [Value; 3] {
    let Some(scene) = scene else { return [json!([]), json!({}), json!([])] };
    let groups = scene.grains.iter().map(|g| json!({ "name": g.name, "material": g.material }));
    let solids = scene.solid.iter().flat_map(|solid| &solid.material);
    let materials: Map<String, Value> =
        solids.filter(|m| !m.name.is_empty()).map(|m| (m.id.to_string(), json!(m.name))).collect();
    let lines = scene.probe.iter().filter_map(|probe| probe.named_line());
    let lines = lines.map(|(name, length)| json!({ "name": name, "length": length }));
    [groups.collect(), materials.into(), lines.collect()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use trackbed_input::scene::Document;

    #[test]
    fn reads_names_of_groups_materials_and_lines() {
        let text = "title = \"a\"\n[[grains]]\nname = \"ballast\"\nshape = \"sphere\"\nmaterial = \"stone\"\n[solid]\n\
                    [[solid.material]]\nid = 2\nname = \"clay\"\ndensity = 2\n[[solid.material]]\nid = 3\ndensity = 2\n\
                    [[probe]]\nline = [[0, 0, 0], [\"30 cm\", 0, 0.4]]\n[[probe]]\nat = [0, 0, 0]\n";
        let document = Document::with_included(Path::new("a.toml"), text.into(), vec![]).unwrap();
        let groups = json!([{ "name": "ballast", "material": "stone" }]);
        let lines = json!([{ "name": "line", "length": 0.5 }]);
        assert_eq!(of_scene(Some(document.scene().unwrap())), [groups, json!({ "2": "clay" }), lines]);
    }

    #[test]
    fn unreadable_scene_has_no_names() {
        assert_eq!(of_scene(None), [json!([]), json!({}), json!([])]);
    }
}
