//! All faults of a scene at once: what is at fault is taken away, and the rest read again.

use super::Job;
use crate::failure::Failure;
use crate::scene::{Document, Scene, SceneError};
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
    document.read().map_err(|first| all(document, first.into(), again, |_, _| true))
}

/// Resolves a scene.
///
/// # Errors
/// Bad input, as far as one fault does not follow from another: [`Job::new`].
pub fn resolve(document: &Document, scene: &Scene) -> Result<Job, Failure> {
    let again = |rest: &Document| Job::new(rest, &rest.read()?).map(drop);
    Job::new(document, scene).map_err(|first| all(document, first, again, apart))
}

/// A failure with the further faults that `again` finds where those before are taken away, as long as they are `independent` of
/// them. A key that is missing then may follow from what was taken away: the search ends there.
fn all(
    document: &Document,
    first: Failure,
    again: impl Fn(&Document) -> Result<(), Failure>,
    independent: impl Fn(&SceneError, &SceneError) -> bool,
) -> Failure {
    let Failure::Faults(mut faults) = first else { return first };
    let (mut rest, begun) = (document.clone(), Instant::now());
    while faults.len() < MOST && begun.elapsed() < LONGEST {
        let last = faults.last().expect("the first one");
        // What others are called by is not to be missed by them.
        let name = last.key.rsplit('.').next() == Some("name");
        if name || !rest.has(&last.key) || rest.set(&format!("{}=", last.key)).is_err() {
            break;
        }
        match again(&rest) {
            Err(Failure::Faults(next))
                if next.iter().all(|n| rest.has(&n.key) && faults.iter().all(|f| independent(f, n))) =>
            {
                faults.extend(next);
            }
            _ => break,
        }
    }
    Failure::Faults(faults)
}

/// Whether two faults are in tables apart from each other: within one, values may depend on each other.
fn apart(before: &SceneError, next: &SceneError) -> bool {
    let table = |key: &str| key.rsplit_once('.').map_or(String::new(), |(table, _)| table.to_string());
    let within = |key: &str, table: &str| key.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'));
    !within(&next.key, &table(&before.key)) && !within(&before.key, &table(&next.key))
}
