//! Key tables from the schema of a scene.

use super::description::Description;
use serde_json::Value;
use std::collections::BTreeSet;

#[derive(Clone, Debug)]
pub struct Key {
    pub name: String,
    pub required: bool,
    pub description: Description,
    /// Allowed words, with meanings not stated before.
    pub words: Vec<(String, String)>,
    /// Table of its value, if that has a section.
    pub table: Option<String>,
}

enum Leaf<'a> {
    Table(&'a str),
    Word {
        word: &'a str,
        meaning: &'a str,
        /// List name in the schema.
        list: &'a str,
    },
}

pub struct Tables<'a> {
    schema: &'a Value,
    sections: BTreeSet<String>,
    described: BTreeSet<&'a str>,
}

impl<'a> Tables<'a> {
    /// Tables of `schema`; those not in `sections` are part of their parent.
    pub fn new(schema: &'a Value, sections: BTreeSet<String>) -> Tables<'a> {
        Tables { schema, sections, described: BTreeSet::new() }
    }

    /// Lists the keys of table `name`: required ones first, then by name.
    pub fn keys(&mut self, name: &str) -> Vec<Key> {
        let table = table(self.schema, name);
        match table["oneOf"].as_array() {
            Some(kinds) => self.keys_of_kinds(kinds),
            None => self.keys_of_table(table),
        }
    }

    fn keys_of_table(&mut self, table: &'a Value) -> Vec<Key> {
        let Some(properties) = table["properties"].as_object() else { return Vec::new() };
        let required: Vec<&str> =
            table["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let optional = properties.keys().map(String::as_str).filter(|key| !required.contains(key));
        let mut keys = Vec::new();
        for key in required.iter().copied().chain(optional) {
            keys.extend(self.key(key, &properties[key], required.contains(&key)));
        }
        keys
    }

    /// Nested keys are included unless their table has a section.
    fn key(&mut self, name: &str, property: &'a Value, required: bool) -> Vec<Key> {
        let (mut words, mut section, mut inline) = (Vec::new(), None, Vec::new());
        let mut lists = BTreeSet::new();
        for leaf in leaves(self.schema, property, "") {
            match leaf {
                Leaf::Table(table) if self.sections.contains(table) => section = Some(table.to_string()),
                Leaf::Table(table) => inline.push(table),
                Leaf::Word { word, meaning, list } => {
                    lists.insert(list);
                    let stated = self.described.contains(list) || says_the_same(word, meaning);
                    let meaning = if stated { "" } else { meaning };
                    words.push((word.to_string(), uncapitalized(&Description::parse(meaning).meaning)));
                }
            }
        }
        self.described.extend(lists);
        let description = Description::parse(property["description"].as_str().unwrap_or_default());
        let mut keys = vec![Key { name: name.into(), required, description, words, table: section }];
        for table in inline {
            let below = self.keys(table);
            keys.extend(below.into_iter().map(|key| Key { name: format!("{name}.{}", key.name), ..key }));
        }
        keys
    }

    /// The first key, a word, selects the others. Keys of equal description appear once.
    fn keys_of_kinds(&mut self, kinds: &'a [Value]) -> Vec<Key> {
        let mut words = Vec::new();
        let mut tag = "";
        let mut keys: Vec<(Key, Vec<String>)> = Vec::new();
        for kind in kinds {
            let constants = kind["properties"].as_object().into_iter().flatten();
            let Some((key, word)) = constants.filter_map(|(k, v)| Some((k, v["const"].as_str()?))).next()
            else {
                continue;
            };
            tag = key;
            let meaning = kind["description"].as_str().unwrap_or_default();
            words.push((word.to_string(), uncapitalized(&Description::parse(meaning).meaning)));
            for below in self.keys_of_table(kind).into_iter().filter(|below| below.name != *key) {
                let text = |key: &Key| (key.name.clone(), key.description.clone());
                match keys.iter_mut().find(|(other, _)| text(other) == text(&below)) {
                    Some((_, of)) => of.push(format!("`\"{word}\"`")),
                    None => keys.push((below, vec![format!("`\"{word}\"`")])),
                }
            }
        }
        let first = Key {
            name: tag.to_string(),
            required: true,
            description: Description::default(),
            words,
            table: None,
        };
        let with = |(mut key, of): (Key, Vec<String>)| {
            key.description.conditions.push(format!("with {}", of.join(", ")));
            Key { required: false, ..key }
        };
        std::iter::once(first).chain(keys.into_iter().map(with)).collect()
    }
}

/// Lower-cases the first word unless it is an abbreviation.
fn uncapitalized(text: &str) -> String {
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain([second]).chain(letters).collect()
        }
        _ => text.to_string(),
    }
}

/// Whether a meaning repeats the word, such as `Von Mises.` of `von_mises`.
fn says_the_same(word: &str, meaning: &str) -> bool {
    let letters =
        |text: &str| text.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_lowercase();
    letters(word) == letters(meaning)
}

/// Finds the table under the keys `path`, such as `solid.block`.
pub fn find<'a>(schema: &'a Value, path: &str) -> Option<&'a str> {
    let mut name = "";
    for key in path.split('.').filter(|key| !key.is_empty()) {
        let property = table(schema, name).get("properties")?.get(key)?;
        name = leaves(schema, property, "").into_iter().find_map(|leaf| match leaf {
            Leaf::Table(name) => Some(name),
            Leaf::Word { .. } => None,
        })?;
    }
    Some(name)
}

/// Lists the shortest key path of each table, by length.
pub fn paths(schema: &Value) -> Vec<String> {
    let mut found = BTreeSet::new();
    let mut paths = vec![String::new()];
    let mut next = 0;
    while next < paths.len() {
        let path = paths[next].clone();
        let keys = find(schema, &path).and_then(|name| table(schema, name)["properties"].as_object());
        for key in keys.into_iter().flat_map(|keys| keys.keys()) {
            let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            if find(schema, &below).is_some_and(|name| found.insert(name)) {
                paths.push(below);
            }
        }
        next += 1;
    }
    paths
}

fn table<'a>(schema: &'a Value, name: &str) -> &'a Value {
    if name.is_empty() { schema } else { &schema["$defs"][name] }
}

/// Tables and words of a value, also in lists.
fn leaves<'a>(schema: &'a Value, value: &'a Value, list: &'a str) -> Vec<Leaf<'a>> {
    if let Some(name) = value["$ref"].as_str().and_then(|to| to.strip_prefix("#/$defs/")) {
        let table = &schema["$defs"][name];
        let kinds =
            table["oneOf"].as_array().is_some_and(|all| all.iter().any(|k| k.get("properties").is_some()));
        if kinds || table.get("properties").is_some() {
            return vec![Leaf::Table(name)];
        }
        return leaves(schema, table, name);
    }
    if let Some(word) = value["const"].as_str() {
        return vec![Leaf::Word { word, meaning: value["description"].as_str().unwrap_or_default(), list }];
    }
    if let Some(words) = value["enum"].as_array() {
        let words = words.iter().filter_map(Value::as_str);
        return words.map(|word| Leaf::Word { word, meaning: "", list }).collect();
    }
    let choices = ["anyOf", "oneOf"].iter().filter_map(|key| value[*key].as_array()).flatten();
    choices.chain(value.get("items")).flat_map(|choice| leaves(schema, choice, list)).collect()
}
