//! Sets of an Abaqus input file.
//!
//! Three fields with GENERATE name any number of members, and sets nest. Ranges are therefore expanded only
//! against existing nodes and elements, and all members are counted.

use std::collections::{BTreeMap, HashSet};

use super::abaqus::Deck;
use super::abaqus_data::whole;
use super::abaqus_lines::Block;
use super::error::ReadError;
use super::mesh_file::Builder;
use super::number;

/// Members of all sets together, beyond listed ids, nodes and elements.
const MOST: u64 = 10_000_000;
/// Mean number of sets per node, element or listed id.
const SETS: u64 = 20;

/// Ids as listed by set rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Members {
    ones: Vec<u32>,
    ranges: Vec<[u32; 3]>,
}

pub(super) struct Known<'a> {
    ids: &'a [u32],
    index: &'a dyn Fn(u32) -> Option<u32>,
}

impl Members {
    pub fn of(ids: impl IntoIterator<Item = u32>) -> Members {
        Members { ones: ids.into_iter().collect(), ..Members::default() }
    }

    pub fn add(&mut self, ids: impl IntoIterator<Item = u32>) {
        self.ones.extend(ids);
    }

    /// Adds another set; common members count once.
    fn join(&mut self, other: &Members) {
        self.ones.extend(&other.ones);
        self.ranges.extend(&other.ranges);
        self.ones.sort_unstable();
        self.ones.dedup();
        self.ranges.sort_unstable();
        self.ranges.dedup();
    }

    fn len(&self) -> u64 {
        (self.ones.len() + self.ranges.len()) as u64
    }

    /// Indices of existing members, and the number of missing ones.
    pub fn resolve(&self, known: &Known<'_>) -> (Vec<u32>, u64) {
        let mut found: Vec<u32> = self.ones.iter().filter_map(|id| (known.index)(*id)).collect();
        let mut absent = (self.ones.len() - found.len()) as u64;
        for range in &self.ranges {
            let before = found.len();
            if count(range) > known.ids.len() as u64 {
                let within = known.ids.iter().filter(|id| holds(range, **id));
                found.extend(within.filter_map(|id| (known.index)(*id)));
            } else {
                found.extend(numbers(range).filter_map(known.index));
            }
            absent += count(range) - (found.len() - before) as u64;
        }
        (found, absent)
    }

    /// First missing member.
    pub fn first_absent(&self, known: &Known<'_>) -> Option<u32> {
        let absent = |id: &u32| (known.index)(*id).is_none();
        let one = self.ones.iter().copied().find(absent);
        one.or_else(|| self.ranges.iter().find_map(|range| numbers(range).find(absent)))
    }

    fn among(&self, ids: &HashSet<u32>) -> u64 {
        let ones = self.ones.iter().filter(|id| ids.contains(id)).count();
        let ranges =
            self.ranges.iter().map(|r| ids.iter().filter(|id| holds(r, **id)).count()).sum::<usize>();
        (ones + ranges) as u64
    }

    fn work(&self, known: usize) -> u64 {
        self.ones.len() as u64 + self.ranges.iter().map(|r| count(r).min(known as u64)).sum::<u64>()
    }
}

fn count([first, last, step]: &[u32; 3]) -> u64 {
    u64::from((last - first) / step) + 1
}

fn holds([first, last, step]: &[u32; 3], id: u32) -> bool {
    (*first..=*last).contains(&id) && (id - first).is_multiple_of(*step)
}

fn numbers([first, last, step]: &[u32; 3]) -> impl Iterator<Item = u32> + use<> {
    (*first..=*last).step_by(*step as usize)
}

pub(super) fn with_nodes<T>(builder: &Builder, with: impl FnOnce(&Known<'_>) -> T) -> T {
    with(&Known { ids: &builder.made.mesh.node_ids, index: &|id| builder.node_index(id) })
}

pub(super) fn with_elements<T>(builder: &Builder, with: impl FnOnce(&Known<'_>) -> T) -> T {
    with(&Known { ids: &builder.made.mesh.element_ids, index: &|id| builder.element_index(id) })
}

fn members(
    builder: &Builder,
    deck: &Deck,
    block: &Block,
    sets: &BTreeMap<String, Members>,
) -> Result<Members, ReadError> {
    let mut members = Members::default();
    let generate = block.option("GENERATE").is_some();
    for (line, row) in block.rows() {
        let key = format!("*{}", block.keyword);
        let row: Vec<&str> =
            row.into_iter().filter(|t| !t.is_empty()).map(|t| deck.without_instance(t)).collect();
        if generate {
            if row.len() < 2 {
                return Err(builder.fault(line, key, row.join(", "), "first, last, step"));
            }
            let (first, last) =
                (whole(builder, line, &key, Some(row[0]))?, whole(builder, line, &key, Some(row[1]))?);
            let step = if row.len() > 2 { whole(builder, line, &key, Some(row[2]))? } else { 1 };
            if step == 0 || last < first {
                let found = format!("{first} to {last} in steps of {step}");
                return Err(builder.fault(line, key, found, "a range upwards"));
            }
            members.ranges.push([first, last, step]);
            continue;
        }
        for text in row {
            if let Some(id) = number::whole(text) {
                members.ones.push(id);
            } else if let Some(set) = sets.get(&text.to_uppercase()) {
                members.join(set);
            } else {
                return Err(builder.fault(line, key, format!("\"{text}\""), "a number or the name of a set"));
            }
        }
    }
    Ok(members)
}

pub(super) fn node_set(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    let name = block.required(builder, "NSET")?.to_string();
    let mut ids = members(builder, deck, block, &deck.node_sets)?;
    if let Some(of) = block.option("ELSET") {
        let of = deck.without_instance(of).to_uppercase();
        let Some(elements) = deck.element_sets.get(&of) else {
            return Err(builder.fault(block.line, "*NSET", format!("ELSET={of}"), "a set of elements"));
        };
        let mesh = &builder.made.mesh;
        let (mut elements, _) = with_elements(builder, |known| elements.resolve(known));
        elements.sort_unstable();
        elements.dedup();
        let nodes = elements.iter().flat_map(|e| &mesh.connectivity[*e as usize]);
        ids.add(nodes.map(|n| mesh.node_ids[*n as usize]).collect::<HashSet<_>>());
    }
    let name = deck.name(&name);
    store(builder, block, &mut deck.members, deck.node_sets.entry(name).or_default(), &ids)
}

pub(super) fn element_set(builder: &mut Builder, deck: &mut Deck, block: &Block) -> Result<(), ReadError> {
    let name = block.required(builder, "ELSET")?.to_string();
    let ids = members(builder, deck, block, &deck.element_sets)?;
    let name = deck.name(&name);
    store(builder, block, &mut deck.members, deck.element_sets.entry(name).or_default(), &ids)
}

/// Adds members, counted in the limited total `all`.
fn store(
    builder: &Builder,
    block: &Block,
    all: &mut u64,
    set: &mut Members,
    ids: &Members,
) -> Result<(), ReadError> {
    *all += ids.len();
    check_count(builder, block.line, *all)?;
    set.join(ids);
    Ok(())
}

/// Rejects implausibly many set members for the mesh size.
fn check_count(builder: &Builder, line: usize, all: u64) -> Result<(), ReadError> {
    let mesh = &builder.made.mesh;
    let most = MOST + SETS * (mesh.node_count() + mesh.element_count()) as u64;
    if all <= most {
        return Ok(());
    }
    Err(builder.fault(line, "sets", format!("{all} members in all of them"), format!("at most {most}")))
}

pub(super) fn check_sizes(builder: &Builder, deck: &Deck) -> Result<(), ReadError> {
    let mesh = &builder.made.mesh;
    let nodes = deck.node_sets.values().map(|s| s.work(mesh.node_count())).sum::<u64>();
    let elements = deck.element_sets.values().map(|s| s.work(mesh.element_count())).sum::<u64>();
    check_count(builder, 0, nodes + elements)
}

pub(super) fn sets(builder: &mut Builder, deck: &Deck) {
    let spelled = |upper: &String| deck.names.get(upper).unwrap_or(upper).clone();
    for (upper, ids) in &deck.node_sets {
        let (nodes, absent) = with_nodes(builder, |known| ids.resolve(known));
        if absent > 0 {
            builder.warn(format!("set {} names {absent} nodes that are not there", spelled(upper)));
        }
        builder.node_set(&spelled(upper), nodes);
    }
    for (upper, ids) in &deck.element_sets {
        if deck.sections.iter().any(|(_, set, material)| set == upper && material == upper) {
            continue;
        }
        let (elements, absent) = with_elements(builder, |known| ids.resolve(known));
        let absent = absent.saturating_sub(ids.among(&deck.left_out));
        if absent > 0 {
            builder.warn(format!("set {} names {absent} elements that are not there", spelled(upper)));
        }
        if !elements.is_empty() {
            builder.element_set(&spelled(upper), elements);
        }
    }
}
