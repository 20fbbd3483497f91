//! Scene before it runs: what its tables place where, as named objects; nothing that a run computes.

mod context;
mod grains;
mod item;
mod kinds;
mod observed;
mod palette;
mod solid;
mod source;
mod structures;
mod walls;

pub use item::{Item, Shape};
pub use kinds::{KINDS, Kind};
pub use source::{Source, is_scene, scene_file, version};

use context::Context;
use item::union;
use trackbed_input::model::Job;
use trackbed_input::plausible;
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;

/// Warning with the object that it is about.
pub struct Warning {
    /// Sentence, as `check` prints it.
    pub text: String,
    /// Whether implausible.
    pub serious: bool,
    /// Index of the object.
    pub item: Option<usize>,
}

/// Objects and warnings of a scene.
pub struct Preview {
    /// Title of the scene.
    pub title: String,
    /// Objects, by kind.
    pub items: Vec<Item>,
    /// Warnings, the serious ones first.
    pub warnings: Vec<Warning>,
    /// Bounding box [m].
    pub bounds: [[f64; 3]; 2],
}

impl Preview {
    /// Collects the objects of a resolved scene.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, job: &Job) -> Result<Preview, Failure> {
        let scene = document.scene()?;
        let none = [[0.0; 3]; 2];
        let mut context = Context { document, scene: &scene, job, bounds: none };
        let (mut items, mut bounds) = (Vec::new(), None);
        for (kind, entry) in KINDS.iter().enumerate() {
            for item in (entry.make)(&context) {
                bounds = union(bounds.into_iter().chain(item.shape.bounds()));
                let colour = if item.colour.is_empty() { entry.colour } else { item.colour };
                items.push(Item { kind, colour, ..item });
            }
            context.bounds = bounds.unwrap_or(none);
        }
        let warnings = warnings(&scene, job, &items);
        Ok(Preview { title: job.title.clone(), items, warnings, bounds: context.bounds })
    }

    /// Returns the objects of a kind, by its word.
    pub fn of<'a>(&'a self, word: &'a str) -> impl Iterator<Item = &'a Item> {
        self.items.iter().filter(move |item| KINDS[item.kind].word == word)
    }
}

fn warnings(scene: &Scene, job: &Job, items: &[Item]) -> Vec<Warning> {
    let findings = plausible::weigh(scene, job).into_iter().map(|finding| Warning {
        text: finding.to_string(),
        serious: finding.serious,
        item: nearest(&finding.key, items),
    });
    let solid = job.solid.iter().flat_map(|part| &part.warnings).map(|text| (text, "solid"));
    let grains = job.grains.iter().flat_map(|part| &part.groups.remarks).map(|text| (text, "grains"));
    let others = solid.chain(grains).map(|(text, key)| Warning {
        text: text.clone(),
        serious: false,
        item: nearest(key, items),
    });
    findings.chain(others).collect()
}

/// Object whose key has most parts in common with `key`.
fn nearest(key: &str, items: &[Item]) -> Option<usize> {
    let common = |item: &Item| key.split('.').zip(item.key.split('.')).take_while(|(a, b)| a == b).count();
    let best = items.iter().enumerate().rev().max_by_key(|(_, item)| common(item))?;
    (common(best.1) > 0).then_some(best.0)
}
