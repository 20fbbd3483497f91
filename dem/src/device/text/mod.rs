//! Kernel source of a model: C templates (`*.c`) and recorded formulas.

mod bonds;
mod clumps;
mod handed;
mod images;
mod motion;
mod patches;
mod planes;
mod record;
mod search;
mod spheres;

use super::layout::{self, Features};
use super::sizes::classes;
use super::tape::{self, Recorded};
use crate::engine::cpu_part;
use crate::engine::model::Model;
use crate::law::{ContactLaw, Laws, NO_CONTACT, PairTable, with_law};
use record::Part;

/// Template; lines starting with `//@` are replaced.
const FRAME: &str = include_str!("frame.c");

pub(super) fn features(model: &Model) -> Features {
    let damped = model.damping != 0.0;
    let fixed = (0..model.body_count()).any(|k| model.body(k).fixed != 0);
    let law_width = with_law!(&model.laws, table => constants(table, 1).len());
    Features {
        law_width,
        roll: model.laws.rolls(),
        damped,
        held: damped || fixed,
        bonds: !model.bonds.is_empty(),
        clumps: model.clumps,
        walls: if cpu_part::walls(model) { 0 } else { model.walls.walls.len() },
        periodic: model.periodic.is_some(),
        beside: cpu_part::any(model),
        classes: classes(model.radii),
    }
}

/// Parts that a model needs, in order of sums and calls.
fn parts<L: ContactLaw, const ROLLING: bool>(table: &PairTable<L>, f: &Features) -> Vec<Part> {
    let law = || record::law(table);
    let mut all = vec![spheres::part::<L, ROLLING>(&law), planes::part::<L, ROLLING>(&law)];
    if f.bonds {
        all.push(bonds::part::<L, ROLLING>(&law));
    }
    if f.clumps {
        all.push(clumps::contacts::<L, ROLLING>(&law));
        all.push(clumps::motion(f));
    }
    if f.periodic {
        all.push(images::part::<L, ROLLING>(&law, f));
    }
    if f.walls > 0 {
        all.push(patches::part::<L, ROLLING>(&law));
    }
    if f.beside {
        all.push(handed::part());
    }
    all.push(motion::part(f));
    if f.held {
        all.push(motion::books());
    }
    all.push(search::part());
    all
}

pub(super) fn text(laws: &Laws, f: &Features) -> String {
    let parts = with_law!(laws, table => if f.roll { parts::<_, true>(table, f) } else { parts::<_, false>(table, f) });
    let filled = |frame: &str, formulas: &[(&str, String)]| {
        let with = |text: String, (name, part): &(&str, String)| text.replace(&format!("//@{name}\n"), part);
        formulas.iter().fold(frame.to_string(), with)
    };
    let bodies: Vec<String> = parts.iter().map(|p| filled(p.frame, &p.formulas) + "\n").collect();
    let formulas = [
        ("LAYOUT", layout::declarations(f, &tape::literal(NO_CONTACT))),
        (
            "LEFT",
            with_law!(laws, table => if f.roll { record::left::<_, true>(table) } else { record::left::<_, false>(table) }),
        ),
        ("PARTS", bodies.concat()),
        ("ENTRIES", entries(&parts)),
        ("BOOKS", f.books()),
    ];
    filled(FRAME, &formulas)
}

/// C code that dispatches an entry to the function of its part.
fn entries(parts: &[Part]) -> String {
    let tests = parts.iter().flat_map(|p| p.entries).map(|(what, function)| {
        format!("if (what == {}u) {function}(p, c, there, second, x, v, w, &s);\n", *what as u32)
    });
    format!("        {}", tests.collect::<Vec<_>>().join("        else "))
}

/// Law constants of each pair of `materials`, in the order of use.
pub(super) fn constants<L: ContactLaw>(table: &PairTable<L>, materials: u32) -> Vec<f64> {
    let mut out = Vec::new();
    for a in 0..materials {
        for b in 0..materials {
            tape::begin();
            _ = L::mixed::<Recorded>([table.get(a, b); 8], tape::value);
            out.extend(tape::values());
        }
    }
    out
}

/// As [`constants`], for any laws.
pub(super) fn law_constants(laws: &Laws, materials: u32) -> Vec<f64> {
    with_law!(laws, table => constants(table, materials))
}
