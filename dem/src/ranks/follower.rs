//! Command loop of all ranks but the first.

use super::codec::{decode, encode, read_numbers, write_numbers};
use super::commands::{self, Command, StepCommand};
use super::link::{Link, Lost};
use super::message_counters::MessageKind;
use super::rank::Rank;
use super::{block_totals, state_message};
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::engine::work::Work;

const FIRST: usize = 0;

/// Serves the first rank until it ends; `make` builds the model from its description.
///
/// # Errors
/// [`Lost`] if a rank is lost.
pub fn serve<L: Link>(mut link: L, mut make: impl FnMut(&[u8]) -> Result<Model, String>) -> Result<(), Lost> {
    loop {
        let mut message = Vec::new();
        link.receive(FIRST, &mut message)?;
        let rest = &mut &message[..];
        match decode(rest) {
            Some(Command::Model { bodies, dt }) => {
                let made = make(rest).and_then(|model| same(model, bodies, dt));
                let mut out = Vec::new();
                encode(&mut out, made.as_ref().err().map_or("", |problem| problem.as_str()));
                link.send(FIRST, &out)?;
                if let Ok(model) = made {
                    return follow(link, &model);
                }
            }
            Some(Command::End) => return Ok(()),
            _ => return Err(Lost::garbled(FIRST)),
        }
    }
}

/// Checks that the model matches the first rank's.
fn same(model: Model, bodies: u64, dt: f64) -> Result<Model, String> {
    if model.body_count() as u64 == bodies && model.dt() == dt {
        return Ok(model);
    }
    Err(format!(
        "other model: found {} bodies, time step {} s, expected {bodies} bodies, time step {dt} s",
        model.body_count(),
        model.dt()
    ))
}

/// Receives a state and runs commands.
fn follow<L: Link>(mut link: L, model: &Model) -> Result<(), Lost> {
    let mut message = Vec::new();
    link.receive(FIRST, &mut message)?;
    let rest = &mut &message[..];
    match decode(rest) {
        Some(Command::Take) => {}
        Some(Command::End) => return Ok(()),
        _ => return Err(Lost::garbled(FIRST)),
    }
    let (mut state, partition) = state_message::read(link.rank(), rest).ok_or(Lost::garbled(FIRST))?;
    drop(message);
    let mut rank = Rank::new(link, Work::new(model, &state));
    rank.take_over(model, &state, partition)?;
    loop {
        rank.receive(FIRST)?;
        let rest = &mut &rank.message[..];
        match decode(rest) {
            Some(Command::Step(now)) => {
                let read = commands::read_step(&mut state, &now, &mut rank.work.applied, rest);
                read.ok_or(Lost::garbled(FIRST))?;
                step(&mut rank, model, &mut state, &now)?;
            }
            Some(Command::Give) => {
                rank.out.clear();
                encode(&mut rank.out, &rank.traffic);
                state_message::write_back(&state, rank.work.own.clone(), &mut rank.out);
                rank.send(MessageKind::State, FIRST)?;
                rank.out = Vec::new();
            }
            Some(Command::Take) => {
                let (fresh, partition) =
                    state_message::read(rank.link.rank(), rest).ok_or(Lost::garbled(FIRST))?;
                state = fresh;
                rank.message = Vec::new();
                rank.take_over(model, &state, partition)?;
            }
            Some(Command::End) => return Ok(()),
            _ => return Err(Lost::garbled(FIRST)),
        }
    }
}

fn step<L: Link>(
    rank: &mut Rank<L>,
    model: &Model,
    state: &mut State,
    now: &StepCommand,
) -> Result<(), Lost> {
    if now.rebuild {
        let moved2 = rank.moved2(state);
        rank.boxes = rank.bounds(state).collect();
        rank.out.clear();
        write_numbers(&mut rank.out, [moved2]);
        encode(&mut rank.out, &rank.boxes);
        rank.send(MessageKind::NearList, FIRST)?;
        rank.receive(FIRST)?;
        let rest = &mut &rank.message[..];
        let [approach] = read_numbers(rest).ok_or(Lost::garbled(FIRST))?;
        if !rest.is_empty() {
            rank.boxes = decode(rest).ok_or(Lost::garbled(FIRST))?;
        }
        rank.rebuild(model, state, approach)?;
    }
    rank.advance(model, state)?;
    rank.out.clear();
    block_totals::write(&rank.work, rank.work.own.clone(), !model.bonds.is_empty(), &mut rank.out);
    rank.send(MessageKind::Books, FIRST)?;
    rank.await_ghosts(state)
}
