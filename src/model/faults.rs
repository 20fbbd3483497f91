//! All faults of a scene at once: what is at fault is mended, and the rest read again.

use super::Job;
use crate::failure::Failure;
use crate::scene::{Document, Problem, Scene, SceneError};
use std::time::{Duration, Instant};

/// Most faults that are reported.
const MOST: usize = 20;
/// Time after which no further ones are looked for: models are made anew for each.
const LONGEST: Duration = Duration::from_secs(2);

/// Reads a scene.
///
/// # Errors
/// Bad input: every key that is unknown, missing, or of the wrong type or unit.
pub fn read_scene(document: &Document) -> Result<Scene, Failure> {
    let again = |rest: &Document| Ok(rest.read::<Scene>().map(drop)?);
    // Forms of keys do not depend on each other.
    document.read().map_err(|first| all(document, first.into(), again, of_form, |_, _| true))
}

/// Resolves a scene.
///
/// # Errors
/// Bad input, as far as one fault does not follow from another: [`Job::new`].
pub fn resolve(document: &Document, scene: &Scene) -> Result<Job, Failure> {
    let again = |rest: &Document| Job::new(rest, &rest.read()?).map(drop);
    Job::new(document, scene).map_err(|first| all(document, first, again, of_value, apart))
}

/// What is put in the place of a value of a wrong form, one after the other, where a scene must have one.
const FORMS: [&str; 5] = ["1", "\"1\"", "true", "[1, 1, 1]", "[]"];

/// The same of a number out of its range.
const VALUES: [&str; 3] = ["1", "0.3", "1000"];

/// A failure with the further faults that `again` finds where those before are mended by one of `mendings`, as long as they
/// are `independent` of them and about values that the scene has.
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
            mending.iter().try_for_each(|assignment| trial.set(assignment)).ok()?;
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

/// Whether a fault is about a value that the scene has, and not about what took the place of another.
fn is_new(document: &Document, faults: &[SceneError], next: &SceneError) -> bool {
    document.has(&next.key) && faults.iter().all(|fault| !within(&next.key, &fault.key))
}

/// Whether a key is another one, or in its table.
fn within(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Overrides that may mend a value out of its range: another number. What is no number decides what else a scene must have.
fn of_value(document: &Document, fault: &SceneError) -> Vec<Vec<String>> {
    let value = document.value(&fault.key).unwrap_or_default();
    let number = value.trim_matches('"').starts_with(|c: char| c.is_ascii_digit() || c == '-' || c == '+');
    let others = VALUES.iter().filter(|_| number);
    others.map(|value| vec![format!("{}={value}", fault.key)]).collect()
}

/// Overrides that may mend the form of a key: the key that was meant in the place of an unknown one, none, or another value.
fn of_form(document: &Document, fault: &SceneError) -> Vec<Vec<String>> {
    let key = &fault.key;
    if !document.has(key) {
        return Vec::new();
    }
    let gone = format!("{key}=");
    let meant = match &fault.problem {
        Problem::Value { found, expected } if found.starts_with("the unknown key") => {
            expected.strip_prefix('`').and_then(|e| e.strip_suffix('`'))
        }
        _ => None,
    };
    let meant = meant.zip(document.value(key));
    let renamed = meant.map(|(meant, value)| {
        let table = key.rsplit_once('.').map_or(String::new(), |(table, _)| format!("{table}."));
        vec![gone.clone(), format!("{table}{meant}={value}")]
    });
    let others = FORMS.iter().map(|value| vec![format!("{key}={value}")]);
    renamed.into_iter().chain([vec![gone.clone()]]).chain(others).collect()
}

/// Whether two faults are in tables apart from each other: within one, and between a table and what holds it, values may depend
/// on each other.
fn apart(before: &SceneError, next: &SceneError) -> bool {
    let table = |key: &str| key.rsplit_once('.').map_or(String::new(), |(table, _)| table.to_string());
    !within(&next.key, &table(&before.key))
        && !within(&before.key, &table(&next.key))
        && !within(&before.key, &next.key)
}
