//! Table of a scene that reports errors with full key paths.

use super::units::Quantity;
use super::{Document, Problem, SceneError};
use std::fmt;
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// Scene table; dereferences to its value.
pub struct Table<'a, T> {
    document: &'a Document,
    /// Key path from the root, with points.
    place: String,
    value: &'a T,
}

impl<T> Deref for Table<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.value
    }
}

impl<'a, T> Table<'a, T> {
    /// Creates the root table `value` of `document`.
    pub fn root(document: &'a Document, value: &'a T) -> Table<'a, T> {
        Table { document, place: String::new(), value }
    }

    /// Returns the table under `key` of the root.
    pub fn top(document: &'a Document, key: &str, value: &'a T) -> Table<'a, T> {
        Table { document, place: key.to_string(), value }
    }

    /// Returns the table under `key`.
    pub fn below<'b, U>(&'b self, key: &str, value: &'b U) -> Table<'b, U> {
        Table { document: self.document, place: self.path(key), value }
    }

    /// Returns the table under `key`, if present.
    pub fn optional<'b, U>(&'b self, key: &str, value: &'b Option<U>) -> Option<Table<'b, U>> {
        value.as_ref().map(|value| self.below(key, value))
    }

    /// Returns table `index` (from 0) of the list `key`.
    pub fn row<'b, U>(&'b self, key: &str, list: &'b [U], index: usize) -> Table<'b, U> {
        self.below(&format!("{key}.{index}"), &list[index])
    }

    /// Returns the tables of the list `key`.
    pub fn rows<'b, U>(&'b self, key: &str, list: &'b [U]) -> impl Iterator<Item = Table<'b, U>> {
        (0..list.len()).map(move |index| self.row(key, list, index))
    }

    /// Returns the full path of `key`.
    pub fn path(&self, key: &str) -> String {
        if self.place.is_empty() { key.to_string() } else { format!("{}.{key}", self.place) }
    }

    /// Whether the scene gives `key` here.
    pub fn has(&self, key: &str) -> bool {
        self.document.has(&self.path(key))
    }

    /// Resolves a path relative to the scene's directory.
    pub fn locate(&self, file: &Path) -> PathBuf {
        self.document.resolve(file)
    }

    /// Returns the scene file.
    pub fn scene_file(&self) -> &'a Path {
        self.document.file()
    }

    /// Creates an error about `key` or `key.below`.
    pub fn error(&self, key: &str, found: impl Into<String>, expected: impl Into<String>) -> SceneError {
        self.document.error(&self.path(key), found, expected)
    }

    /// Creates an error about the table.
    pub fn here(&self, found: impl Into<String>, expected: impl Into<String>) -> SceneError {
        self.document.error(&self.place, found, expected)
    }

    /// Creates the error of a missing key.
    pub fn missing(&self, key: &str, expected: impl Into<String>) -> SceneError {
        self.problem(key, Problem::missing(expected))
    }

    /// Creates the error of a key that excludes `with`.
    pub fn conflict(&self, key: &str, with: impl Into<String>) -> SceneError {
        self.problem(key, Problem::conflict(with))
    }

    /// Creates the error of a key that requires `without`.
    pub fn requirement(&self, key: &str, without: impl Into<String>) -> SceneError {
        self.problem(key, Problem::requirement(without))
    }

    /// Creates the error of a key without effect.
    pub fn no_effect(&self, key: &str, without: impl Into<String>) -> SceneError {
        self.problem(key, Problem::no_effect(without))
    }

    /// Creates the error of two exclusive keys, both present or missing.
    pub fn choice(&self, keys: [&str; 2], both: bool) -> SceneError {
        let [first, second] = keys;
        if both {
            self.conflict(first, format!("`{second}`"))
        } else {
            self.missing(first, format!("`{first}` or `{second}`"))
        }
    }

    /// Creates the error of exclusive keys, each with its presence.
    pub fn one_of(&self, keys: &[(&str, bool)]) -> SceneError {
        let mut present = keys.iter().filter(|(_, present)| *present);
        match (present.next(), present.next()) {
            (Some((first, _)), Some((second, _))) => self.conflict(first, format!("`{second}`")),
            _ => {
                let names: Vec<&str> = keys.iter().map(|(name, _)| *name).collect();
                let (last, others) = names.split_last().expect("at least one key");
                let expected = format!("`{}` or `{last}`", others.join("`, `"));
                self.missing(names[0], expected)
            }
        }
    }

    /// Creates an error about `key`, of any form.
    pub fn problem(&self, key: &str, problem: Problem) -> SceneError {
        self.document.problem(&self.path(key), problem)
    }

    /// Returns the value of `key`.
    ///
    /// # Errors
    /// The key is missing.
    pub fn need<V>(&self, key: &str, value: Option<V>, expected: &str) -> Result<V, SceneError> {
        value.ok_or_else(|| self.missing(key, expected))
    }

    /// Returns the value of `key`, if present.
    ///
    /// # Errors
    /// Not finite, or not `good`.
    pub fn check<N: Number>(
        &self,
        key: &str,
        value: N,
        good: impl Fn(f64) -> bool,
        expected: &str,
    ) -> Result<N, SceneError> {
        match value.number() {
            Some(v) if !(v.is_finite() && good(v)) => Err(self.error(key, v.to_string(), expected)),
            _ => Ok(value),
        }
    }

    /// Rejects present keys, each with its presence: they exclude `with`.
    ///
    /// # Errors
    /// A key is present.
    pub fn reject_with<'k>(
        &self,
        keys: impl IntoIterator<Item = (&'k str, bool)>,
        with: &str,
    ) -> Result<(), SceneError> {
        match keys.into_iter().find(|(_, present)| *present) {
            Some((key, _)) => Err(self.conflict(key, with)),
            None => Ok(()),
        }
    }

    /// Rejects present keys, each with its presence: they require `without`.
    ///
    /// # Errors
    /// A key is present.
    pub fn reject_without<'k>(
        &self,
        keys: impl IntoIterator<Item = (&'k str, bool)>,
        without: &str,
    ) -> Result<(), SceneError> {
        match keys.into_iter().find(|(_, present)| *present) {
            Some((key, _)) => Err(self.no_effect(key, without)),
            None => Ok(()),
        }
    }
}

/// Lists values of `key`: `key = "a"`, `"b"` or `"c"`.
pub fn setting(key: &str, values: &[impl AsRef<str>]) -> String {
    let quoted = |value: &dyn AsRef<str>| format!("`\"{}\"`", value.as_ref());
    let Some((first, others)) = values.split_first() else { return format!("`{key}`") };
    let mut text = format!("`{key} = \"{}\"`", first.as_ref());
    for (k, value) in others.iter().enumerate() {
        text += if k + 1 == others.len() { " or " } else { ", " };
        text += &quoted(value);
    }
    text
}

/// Lists one-word variants in lower case, as in scenes.
pub fn kinds(kinds: &[impl fmt::Debug]) -> String {
    let names: Vec<String> = kinds.iter().map(|kind| format!("{kind:?}").to_lowercase()).collect();
    setting("kind", &names)
}

/// Optional number in SI units.
pub trait Number: Copy {
    /// Value, if present.
    fn number(self) -> Option<f64>;
}

impl Number for f64 {
    fn number(self) -> Option<f64> {
        Some(self)
    }
}

impl Number for u32 {
    fn number(self) -> Option<f64> {
        Some(f64::from(self))
    }
}

impl Number for usize {
    fn number(self) -> Option<f64> {
        Some(self as f64)
    }
}

impl<D> Number for Quantity<D> {
    fn number(self) -> Option<f64> {
        Some(self.si)
    }
}

impl<N: Number> Number for Option<N> {
    fn number(self) -> Option<f64> {
        self.and_then(N::number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Length;

    struct Scene {
        walls: Vec<Wall>,
        periodic: Option<Wall>,
    }

    struct Wall {
        radius: Option<Quantity<Length>>,
        shape: Shape,
    }

    struct Shape {
        count: u32,
    }

    const TEXT: &str = "[[walls]]\nradius = 1\n[[walls]]\nradius = 2\nshape.count = 0\n";

    fn with_scene(act: impl Fn(&Table<Scene>)) {
        let document = Document::parse(Path::new("folder/x.toml"), TEXT.into()).unwrap();
        let wall = |radius, count| Wall { radius: Some(Quantity::new(radius)), shape: Shape { count } };
        let scene = Scene { walls: vec![wall(1.0, 7), wall(2.0, 0)], periodic: None };
        act(&Table::root(&document, &scene));
    }

    #[test]
    fn errors_name_the_place() {
        with_scene(|scene| {
            assert_eq!(
                scene.error("walls", "a", "b").to_string(),
                "folder/x.toml:1: walls: found a, expected b"
            );
            let walls: Vec<_> = scene.rows("walls", &scene.walls).collect();
            assert_eq!(walls.len(), 2);
            let shape = walls[1].below("shape", &walls[1].shape);
            for (error, line, key) in [
                (walls[0].error("radius", "a", "b"), 2, "walls.0.radius"),
                (walls[1].error("shape.count", "a", "b"), 5, "walls.1.shape.count"),
                (shape.error("count", "a", "b"), 5, "walls.1.shape.count"),
                (shape.here("a", "b"), 5, "walls.1.shape"),
            ] {
                assert_eq!((error.line, error.key.as_str()), (Some(line), key));
            }
            let missing = walls[0].need("height", None::<f64>, "the height").unwrap_err();
            assert_eq!(
                (missing.key.as_str(), missing.problem),
                ("walls.0.height", Problem::missing("the height"))
            );
            assert!(scene.optional("periodic", &scene.periodic).is_none());
            assert_eq!(scene.locate(Path::new("mesh.inp")), Path::new("folder/mesh.inp"));
        });
    }

    #[test]
    fn text_in_memory_has_no_lines() {
        let file = Path::new("folder/x.toml");
        let document = Document::open_or(file, Some(TEXT)).unwrap();
        assert_eq!(
            document.error("walls", "a", "b").to_string(),
            "folder/x.toml: walls: found a, expected b"
        );
        assert_eq!(
            (document.resolve(Path::new("mesh.inp")), document.text_in_memory()),
            ("folder/mesh.inp".into(), Some(TEXT))
        );
        assert!(Document::open_or(file, None).is_err());
    }

    #[test]
    fn values_are_checked() {
        with_scene(|scene| {
            let wall = scene.row("walls", &scene.walls, 1);
            let above = |x: f64| x > 0.0;
            let radius = wall.check("radius", wall.radius, above, "above 0").unwrap();
            assert_eq!(radius.map(|r| r.si), Some(2.0));
            assert_eq!(wall.check("scale", None::<f64>, above, "above 0").unwrap(), None);
            for (error, found) in [
                (wall.check("shape.count", wall.shape.count, above, "above 0").unwrap_err(), "0"),
                (wall.check("radius", -0.5, above, "above 0").unwrap_err(), "-0.5"),
                (wall.check("radius", f64::INFINITY, above, "above 0").unwrap_err(), "inf"),
                (wall.check("radius", Some(f64::NAN), |_| true, "a length").unwrap_err(), "NaN"),
            ] {
                let Problem::Value { found: shown, .. } = error.problem else { panic!("{found}") };
                assert_eq!(&*shown, found);
            }
        });
    }

    #[test]
    fn rejects_first_present_key() {
        with_scene(|scene| {
            let (none, one) =
                ([("walls", false), ("periodic", false)], [("periodic", false), ("walls", true)]);
            assert!(scene.reject_with(none, "`track`").is_ok());
            assert!(scene.reject_without(none, "`track`").is_ok());
            let error = scene.reject_with(one, "`track`").unwrap_err();
            assert_eq!((error.key.as_str(), error.problem), ("walls", Problem::conflict("`track`")));
            let error = scene.reject_without(one, "`track`").unwrap_err();
            assert_eq!((error.key.as_str(), error.problem), ("walls", Problem::no_effect("`track`")));
        });
    }

    #[test]
    fn one_of_two_keys() {
        with_scene(|scene| {
            let both = scene.choice(["walls", "periodic"], true).to_string();
            assert!(
                both.ends_with("walls: found together with `periodic`, expected only one of them"),
                "{both}"
            );
            let neither = scene.choice(["track", "rail"], false).to_string();
            assert!(neither.ends_with("track: found nothing, expected `track` or `rail`"), "{neither}");
            let several = scene.one_of(&[("a", false), ("walls", true), ("b", true)]).to_string();
            assert!(
                several.ends_with("walls: found together with `b`, expected only one of them"),
                "{several}"
            );
            let none = scene.one_of(&[("a", false), ("b", false), ("c", false)]).to_string();
            assert!(none.ends_with("a: found nothing, expected `a`, `b` or `c`"), "{none}");
        });
    }

    #[test]
    fn values_are_listed() {
        #[derive(Debug)]
        enum Kind {
            Plane,
            Mesh,
        }
        assert_eq!(kinds(&[Kind::Plane, Kind::Mesh]), "`kind = \"plane\"` or `\"mesh\"`");
        assert_eq!(setting("model", &["a", "b", "c"]), "`model = \"a\"`, `\"b\"` or `\"c\"`");
    }
}
