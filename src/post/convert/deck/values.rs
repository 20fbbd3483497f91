//! Deck values by key.

use super::keys::{GENERAL, GEOLOGY, Line};
use std::path::{Path, PathBuf};
use trackbed_io::read::ReadError;
use trackbed_io::read::number;

pub struct Deck {
    file: PathBuf,
    /// Whether it is the deck of 2011.
    pub geology: bool,
    values: Vec<(&'static str, String, usize)>,
}

impl Deck {
    /// Reads a deck; the fifth line has two values in the older one.
    ///
    /// # Errors
    /// Wrong number of lines or values, comments with other keys.
    pub fn parse(file: &Path, text: &str) -> Result<Deck, ReadError> {
        let lines = text.lines().enumerate().map(|(k, l)| (k + 1, l.trim())).filter(|(_, l)| !l.is_empty());
        let lines: Vec<(usize, &str, &str)> = lines
            .map(|(n, l)| {
                let (values, comment) = l.split_once('(').unwrap_or((l, ""));
                (n, values.trim(), comment.trim_end_matches(')').trim())
            })
            .collect();
        let geology = lines.get(4).is_some_and(|(_, values, _)| fields(values).count() == 2);
        let order: &[Line] = if geology { GEOLOGY } else { GENERAL };
        let mut deck = Deck { file: file.to_path_buf(), geology, values: Vec::new() };
        for ((number, values, comment), keys) in lines.iter().zip(order) {
            deck.line(*number, values, comment, keys)?;
        }
        if lines.len() != order.len() {
            let expected = format!("{}: {} is {}", order.len(), "the last", order[order.len() - 1][0].0);
            return Err(ReadError::whole(file, "lines with values", lines.len().to_string(), expected));
        }
        Ok(deck)
    }

    fn line(&mut self, number: usize, values: &str, comment: &str, keys: Line) -> Result<(), ReadError> {
        let names = || keys.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let found: Vec<&str> = fields(values).collect();
        if found.len() != keys.len() {
            let found = format!("{} values", found.len());
            return Err(ReadError::at(&self.file, number, names(), found, format!("{}", keys.len())));
        }
        if !comment.is_empty() && !names_one(comment, keys) {
            let found = format!("\"({comment})\"");
            return Err(ReadError::at(&self.file, number, "comment", found, format!("that of {}", names())));
        }
        for ((name, _), value) in keys.iter().zip(found) {
            self.values.push((name, value.to_string(), number));
        }
        Ok(())
    }

    /// Error about a key.
    pub fn error(&self, key: &str, expected: impl Into<String>) -> ReadError {
        let (_, value, line) = self.entry(key);
        ReadError::at(&self.file, *line, key, format!("\"{value}\""), expected)
    }

    fn entry(&self, key: &str) -> &(&'static str, String, usize) {
        self.values.iter().find(|(name, _, _)| *name == key).expect("a key of the deck")
    }

    pub fn has(&self, key: &str) -> bool {
        self.values.iter().any(|(name, _, _)| *name == key)
    }

    pub fn keys(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.values.iter().map(|(name, _, _)| *name)
    }

    /// Raw value in lower case.
    pub fn word(&self, key: &str) -> String {
        self.entry(key).1.to_ascii_lowercase()
    }

    /// Logical value, `.true.` or `.false.`, also without points.
    ///
    /// # Errors
    /// Neither.
    pub fn logical(&self, key: &str) -> Result<bool, ReadError> {
        match self.word(key).trim_matches(['.', '|']) {
            "true" | "t" => Ok(true),
            "false" | "f" => Ok(false),
            _ => Err(self.error(key, ".true. or .false.")),
        }
    }

    /// Number that satisfies `fit`.
    ///
    /// # Errors
    /// No number, or unfit.
    pub fn number(&self, key: &str, fit: impl Fn(f64) -> bool, expected: &str) -> Result<f64, ReadError> {
        let value = number::real(&self.entry(key).1).filter(|v| v.is_finite() && fit(*v));
        value.ok_or_else(|| self.error(key, expected))
    }
}

fn fields(values: &str) -> impl Iterator<Item = &str> {
    values.split(|c: char| c == ',' || c.is_whitespace()).filter(|f| !f.is_empty())
}

fn names_one(comment: &str, keys: Line) -> bool {
    let comment = comment.to_ascii_lowercase();
    keys.iter().any(|(name, others)| {
        let spelled = |n: &str| {
            let n = n.to_ascii_lowercase();
            comment.match_indices(&n).any(|(at, _)| {
                let open = |c: Option<char>| c.is_none_or(|c| !c.is_ascii_alphanumeric() && c != '_');
                open(comment[..at].chars().next_back()) && open(comment[at + n.len()..].chars().next())
            })
        };
        spelled(name) || others.iter().any(|n| spelled(n))
    })
}
