//! Reports all independent input errors: erroneous values are replaced, and the scene is read again.

use super::Job;
use crate::scene::{Document, Problem, Scene, SceneError};
use std::time::{Duration, Instant};
use trackbed_io::failure::Failure;

const MOST: usize = 20;
/// Each further error needs a new model.
const LONGEST: Duration = Duration::from_secs(2);

/// Reads a scene.
///
/// # Errors
/// Unknown or missing keys, wrong types or units.
pub fn read_scene(document: &Document) -> Result<Scene, Failure> {
    let again = |rest: &Document| Ok(rest.scene().map(drop)?);
    // Key types are independent.
    document.scene().map_err(|first| all(document, first.into(), again, of_form, |_, _| true))
}

/// Resolves a scene.
///
/// # Errors
/// All independent input errors; see [`Job::new`].
pub fn resolve(document: &Document, scene: &Scene) -> Result<Job, Failure> {
    let again = |rest: &Document| Job::new(rest, &rest.scene()?).map(drop);
    Job::new(document, scene).map_err(|first| all(document, first, again, of_value, apart))
}

/// Substitutes for a required value of wrong type.
const FORMS: [&str; 5] = ["1", "\"1\"", "true", "[1, 1, 1]", "[]"];

/// Substitutes for a number out of range.
const VALUES: [&str; 3] = ["1", "0.3", "1000"];

/// Adds errors that `again` reports after replacing earlier erroneous values, if `independent` and about
/// existing values.
fn all(
    document: &Document,
    first: Failure,
    again: impl Fn(&Document) -> Result<(), Failure>,
    mendings: impl Fn(&Document, &SceneError) -> Vec<Vec<String>>,
    independent: impl Fn(&SceneError, &SceneError) -> bool,
) -> Failure {
    let Failure::Faults(mut faults) = first else { return first };
    let (mut rest, begun) = (document.clone(), Instant::now());
    while faults.len() < MOST && begun.elapsed() < LONGEST {
        let last = faults.last().expect("the first one");
        let mended = mendings(document, last).into_iter().find_map(|mending| {
            let mut trial = rest.clone();
            trial.set_all(&mending).ok()?;
            match again(&trial) {
                Err(Failure::Faults(next)) if next.iter().all(|n| is_new(document, &faults, n)) => {
                    Some((trial, next))
                }
                _ => None,
            }
        });
        match mended {
            Some((trial, next)) if next.iter().all(|n| faults.iter().all(|f| independent(f, n))) => {
                rest = trial;
                faults.extend(next);
            }
            _ => break,
        }
    }
    Failure::Faults(faults)
}

/// Errors of substitutes do not count.
fn is_new(document: &Document, faults: &[SceneError], next: &SceneError) -> bool {
    document.has(&next.key) && faults.iter().all(|fault| !within(&next.key, &fault.key))
}

fn within(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Other values than numbers select which keys are required, so they stay.
fn of_value(document: &Document, fault: &SceneError) -> Vec<Vec<String>> {
    let value = document.value(&fault.key).unwrap_or_default();
    let number = value.trim_matches('"').starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '+');
    let others = VALUES.iter().filter(|_| number);
    others.map(|value| vec![format!("{}={value}", fault.key)]).collect()
}

/// Tries the key probably meant, none, or another value.
fn of_form(document: &Document, fault: &SceneError) -> Vec<Vec<String>> {
    let key = &fault.key;
    if !document.has(key) {
        return Vec::new();
    }
    let gone = format!("{key}=");
    let meant = match &fault.problem {
        Problem::Value { found, expected }
            if found.starts_with("the unknown key") || found.starts_with('`') =>
        {
            expected.strip_prefix('`').and_then(|e| e.strip_suffix('`'))
        }
        _ => None,
    };
    let word = match &fault.problem {
        Problem::Value { expected, .. } if expected.starts_with('"') => {
            Some(vec![format!("{key}={expected}")])
        }
        _ => None,
    };
    let meant = meant.zip(document.value(key));
    let renamed = meant.map(|(meant, value)| {
        let table = key.rsplit_once('.').map_or(String::new(), |(table, _)| format!("{table}."));
        vec![gone.clone(), format!("{table}{meant}={value}")]
    });
    let others = FORMS.iter().map(|value| vec![format!("{key}={value}")]);
    renamed.into_iter().chain(word).chain([vec![gone.clone()]]).chain(others).collect()
}

/// Values within a table, and in nested tables, may depend on each other.
fn apart(before: &SceneError, next: &SceneError) -> bool {
    let table = |key: &str| key.rsplit_once('.').map_or(String::new(), |(table, _)| table.to_string());
    !within(&next.key, &table(&before.key))
        && !within(&before.key, &table(&next.key))
        && !within(&before.key, &next.key)
}
