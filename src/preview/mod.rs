//! Scene before it runs: what its tables place where, as named objects; nothing that a run computes.

mod grains;
mod item;
mod observed;
mod palette;
mod solid;
mod source;
mod walls;

pub use item::{Item, Shape};
pub use source::{Source, is_scene, scene_file, version};

use crate::failure::Failure;
use crate::model::Job;
use crate::plausible;
use crate::scene::{Document, Scene};
use item::union;

/// Kind of objects. One entry is all that a new kind needs.
pub struct Kind {
    /// Identifier.
    pub word: &'static str,
    /// Heading.
    pub label: &'static str,
    /// Part of pictures, as in `--show` and `--hide`.
    pub part: &'static str,
    /// Whether shown at first.
    pub shown: bool,
    /// Opacity.
    pub opacity: f32,
    /// Colour `rrggbb` of objects without their own.
    pub colour: &'static str,
    make: fn(&Context) -> Vec<Item>,
}

/// All kinds. Later ones extend to the bounds of earlier ones.
pub static KINDS: [Kind; 16] = {
    const fn kind(
        (word, label, part): (&'static str, &'static str, &'static str),
        (shown, opacity, colour): (bool, f32, &'static str),
        make: fn(&Context) -> Vec<Item>,
    ) -> Kind {
        Kind { word, label, part, shown, opacity, colour, make }
    }
    [
        kind(("solid", "Solid", "solid"), (true, 1.0, "9aa7b3"), solid::materials),
        kind(("grains", "Grains", "grains"), (true, 1.0, "b9ab94"), grains::groups),
        kind(("fills", "Filled regions", "marks"), (true, 1.0, "0072b2"), grains::fills),
        kind(("sleepers", "Sleepers", "track"), (true, 1.0, "8f959c"), walls::sleepers),
        kind(("rails", "Rails, seat loads", "track"), (true, 1.0, "5b4a3f"), walls::rails),
        kind(("supports", "Supports", "marks"), (true, 1.0, "218f33"), solid::supports),
        kind(("loads", "Loads", "marks"), (true, 1.0, "d55e00"), solid::loads),
        kind(("absorbing", "Absorbing boundaries", "marks"), (true, 0.6, "cc79a7"), solid::absorbing),
        kind(("probes", "Probes", "marks"), (true, 1.0, "cc0077"), observed::probes),
        kind(("boxes", "Measuring boxes", "marks"), (true, 1.0, "8a2be2"), observed::boxes),
        kind(("flow", "Inlets, outlets", "marks"), (true, 1.0, "218f33"), grains::flow),
        kind(("walls", "Walls", "boundary"), (true, 0.25, "7d8fa3"), walls::walls),
        kind(("water", "Water", "boundary"), (true, 0.3, "56b4e9"), observed::water),
        kind(("periodic", "Periodic borders", "boundary"), (true, 0.15, "cc79a7"), observed::periodic),
        kind(("contact", "Contact faces of the solid", "sets"), (false, 1.0, "7fd6bd"), solid::contact),
        kind(("sets", "Sets of the mesh", "sets"), (false, 1.0, "e69f00"), solid::sets),
    ]
};

/// Scene with the bounds of the objects so far.
struct Context<'a> {
    document: &'a Document,
    scene: &'a Scene,
    job: &'a Job,
    bounds: [[f64; 3]; 2],
}

impl Context<'_> {
    /// Diagonal [m].
    fn size(&self) -> f64 {
        let [low, high] = self.bounds;
        (0..3).map(|k| (high[k] - low[k]).powi(2)).sum::<f64>().sqrt()
    }
}

/// Warning with the object that it is about.
pub struct Remark {
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
    pub remarks: Vec<Remark>,
    /// Bounding box [m].
    pub bounds: [[f64; 3]; 2],
}

impl Preview {
    /// Collects the objects of a resolved scene.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, job: &Job) -> Result<Preview, Failure> {
        let scene: Scene = document.read()?;
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
        let remarks = remarks(&scene, job, &items);
        Ok(Preview { title: job.title.clone(), items, remarks, bounds: context.bounds })
    }

    /// Returns the objects of a kind, by its word.
    pub fn of<'a>(&'a self, word: &'a str) -> impl Iterator<Item = &'a Item> {
        self.items.iter().filter(move |item| KINDS[item.kind].word == word)
    }
}

fn remarks(scene: &Scene, job: &Job, items: &[Item]) -> Vec<Remark> {
    let findings = plausible::weigh(scene, job).into_iter().map(|finding| Remark {
        text: finding.to_string(),
        serious: finding.serious,
        item: nearest(&finding.key, items),
    });
    let solid = job.solid.iter().flat_map(|part| &part.warnings).map(|text| (text, "solid"));
    let grains = job.grains.iter().flat_map(|part| &part.groups.remarks).map(|text| (text, "grains"));
    let others = solid.chain(grains).map(|(text, key)| Remark {
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
