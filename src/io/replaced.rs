//! Replaced names of scene keys, their values, options and `summary.json`. In paths, `*` is a list entry.

use serde_json::Value;

/// Scene keys: path, new name.
const KEYS: [(&str, &str); 6] = [
    ("bond.*.spread.together", "correlated"),
    ("grains.*.concentration", "solid_fraction"),
    ("grains.*.motion", "prescribed_velocity"),
    ("outlet.*.again", "recycle"),
    ("solid.dynamics.alpha", "beta"),
    ("solid.dynamics.delta", "gamma"),
];

/// Values of scene keys: path, value, new value.
const VALUES: [(&str, &str, &str); 4] = [
    ("grains.*.sizes.law", "equal", "monodisperse"),
    ("grains.*.sizes.law", "two", "bidisperse"),
    ("track.jump.method", "account", "extrapolate"),
    ("track.jump.method", "grains", "displace"),
];

/// Options: command, name, new name.
const OPTIONS: [(&str, &str, &str); 2] =
    [("explain", "--rehearse", "--trial"), ("render", "--least", "--min-force")];

/// Names in `summary.json`: path with new names of parents, new name.
const RESULTS: [(&str, &str); 15] = [
    ("energy.spent", "flows"),
    ("energy.turned_over", "reference_energy"),
    ("energy.flows.dashpot_lag", "interface_dashpot_error"),
    ("energy.flows.track_beyond", "far_field_track"),
    ("flow.came_in", "inserted"),
    ("flow.went_out", "removed"),
    ("flow.inlets.*.asked", "requested"),
    ("flow.inlets.*.owed", "backlog"),
    ("flow.inlets.*.waiting", "queued"),
    ("flow.inlets.*.without_room", "without_free_position"),
    ("safety.fails_at", "unstable_at"),
    ("safety.stands_at", "stable_at"),
    ("stage_energy.*.turned_over", "reference_energy"),
    ("verdict.judged", "checks"),
    ("verdict.checks.*.what", "name"),
];

fn matches(pattern: &str, path: &[&str]) -> bool {
    let parts: Vec<&str> = pattern.split('.').collect();
    parts.len() == path.len() && parts.iter().zip(path).all(|(part, key)| *part == "*" || part == key)
}

/// Whether a scene text, a path or a value may have a replaced name.
pub fn occurs_in(text: &str) -> bool {
    let is_key = |(path, _): &(&str, &str)| path.rsplit('.').next().is_some_and(|key| text.contains(key));
    let quoted = |old: &str, mark: char| {
        text.match_indices(old)
            .any(|(at, _)| text[..at].ends_with(mark) && text[at + old.len()..].starts_with(mark))
    };
    let is_value = |(_, old, _): &(&str, &str, &str)| text == *old || quoted(old, '"') || quoted(old, '\'');
    KEYS.iter().any(is_key) || VALUES.iter().any(is_value)
}

/// Returns the new name of the scene key at `path`, if replaced.
pub fn key(path: &str) -> Option<&'static str> {
    let path: Vec<&str> = path.split('.').collect();
    KEYS.iter().find(|(pattern, _)| matches(pattern, &path)).map(|(_, new)| *new)
}

/// Returns the new name of `value` at `path` of a scene, if replaced.
pub fn value(path: &str, value: &str) -> Option<&'static str> {
    let path: Vec<&str> = path.split('.').collect();
    let row = VALUES.iter().find(|(pattern, old, _)| *old == value && matches(pattern, &path));
    row.map(|(_, _, new)| *new)
}

/// Returns the new name of an option of `command`, if replaced.
pub fn option(command: &str, option: &str) -> Option<&'static str> {
    OPTIONS.iter().find(|(of, old, _)| (*of, *old) == (command, option)).map(|(_, _, new)| *new)
}

/// Returns the new path in `summary.json`, if `path` has a replaced name.
pub fn result(path: &str) -> Option<String> {
    let mut parts: Vec<&str> = path.split('.').collect();
    let mut replaced = false;
    for (pattern, new) in RESULTS {
        let depth = pattern.split('.').count();
        if depth <= parts.len() && matches(pattern, &parts[..depth]) {
            parts[depth - 1] = new;
            replaced = true;
        }
    }
    replaced.then(|| parts.join("."))
}

/// Renames the keys of a `summary.json` of an earlier version.
pub fn update(summary: &mut Value) {
    for (pattern, new) in RESULTS {
        let path: Vec<&str> = pattern.split('.').collect();
        rename(summary, &path, new);
    }
}

fn rename(table: &mut Value, path: &[&str], new: &str) {
    match (path, table) {
        ([old], Value::Object(entries)) => {
            if let Some(value) = entries.remove(*old) {
                entries.insert(new.to_string(), value);
            }
        }
        (["*", below @ ..], Value::Array(list)) => {
            list.iter_mut().for_each(|entry| rename(entry, below, new));
        }
        ([key, below @ ..], Value::Object(entries)) => {
            if let Some(entry) = entries.get_mut(*key) {
                rename(entry, below, new);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn finds_replaced_names() {
        assert_eq!(key("grains.12.motion"), Some("prescribed_velocity"));
        assert_eq!(key("grains.0.floes.concentration"), None);
        assert_eq!(key("walls.0.motion"), None);
        assert_eq!(value("track.jump.method", "account"), Some("extrapolate"));
        assert_eq!(value("track.jump.method", "extrapolate"), None);
        assert!(occurs_in("method = \"grains\"") && occurs_in("account") && occurs_in("delta = 0.5"));
        assert!(!occurs_in("[[grains]]\ncount = 2\nname = \"two grains\"\n"));
        assert_eq!(option("render", "--least"), Some("--min-force"));
        assert_eq!(option("explain", "--least"), None);
        for (old, new) in [
            ("energy.spent.dashpot_lag", "energy.flows.interface_dashpot_error"),
            ("energy.flows.dashpot_lag", "energy.flows.interface_dashpot_error"),
            ("flow.inlets.last.owed", "flow.inlets.last.backlog"),
            ("verdict.judged.0.value", "verdict.checks.0.value"),
        ] {
            assert_eq!(result(old).as_deref(), Some(new));
            assert_eq!(result(new), None);
        }
    }

    #[test]
    fn updates_earlier_summary() {
        let mut summary = json!({
            "energy": { "turned_over": 2.0, "spent": { "dashpot_lag": -1.0, "friction": 1.0 } },
            "flow": { "came_in": 3, "inlets": [{ "owed": 4.0 }, { "owed": 5.0 }] },
            "safety": "spent",
        });
        update(&mut summary);
        let updated = json!({
            "energy": { "reference_energy": 2.0, "flows": { "interface_dashpot_error": -1.0, "friction": 1.0 } },
            "flow": { "inserted": 3, "inlets": [{ "backlog": 4.0 }, { "backlog": 5.0 }] },
            "safety": "spent",
        });
        assert_eq!(summary, updated);
        update(&mut summary);
        assert_eq!(summary, updated);
    }
}
