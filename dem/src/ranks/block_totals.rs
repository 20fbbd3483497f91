//! Messages of block totals to the first rank.

use super::codec::{decode, encode};
use crate::base::balance_terms::BalanceTerms;
use crate::base::failure::Failure;
use crate::bodies::sums::WallSum;
use crate::bond::pass::{Broken, ListWork};
use crate::engine::work::Work;
use serde::{Deserialize, Serialize};
use std::ops::Range;

#[derive(Serialize, Deserialize)]
struct Book {
    fastest: f64,
    failure: Option<Failure>,
    /// Contacts with later blocks.
    dashpot: f64,
    friction: f64,
    failure_across: Option<Failure>,
    wall_sums: u32,
}

/// Upper limit on balance values in a message.
const LEDGER: usize = 128;

/// Zeros, except −0, take one bit.
fn write_balance(out: &mut Vec<u8>, balance: &BalanceTerms) {
    let mut room = [0; 8 * LEDGER];
    let count = words(balance, &mut room);
    for eight in room.as_chunks::<8>().0[..count].chunks(8) {
        let mask = eight.iter().rev().fold(0_u8, |mask, word| 2 * mask + u8::from(*word != [0; 8]));
        out.push(mask);
        eight.iter().filter(|word| **word != [0; 8]).for_each(|word| out.extend_from_slice(word));
    }
}

/// Returns the number of eight-byte words.
fn words(balance: &BalanceTerms, room: &mut [u8]) -> usize {
    postcard::to_slice(balance, room).expect("balance terms have a fixed number of values").len().div_ceil(8)
}

fn read_balance(rest: &mut &[u8]) -> Option<BalanceTerms> {
    let mut room = [0; 8 * LEDGER];
    let count = words(&BalanceTerms::default(), &mut room);
    for eight in room.as_chunks_mut::<8>().0[..count].chunks_mut(8) {
        let (mask, left) = rest.split_first()?;
        *rest = left;
        for (k, word) in eight.iter_mut().enumerate() {
            if mask >> k & 1 == 1 {
                let (number, left) = rest.split_first_chunk::<8>()?;
                (*word, *rest) = (*number, left);
            }
        }
    }
    decode(&mut &room[..])
}

/// Totals of a bond list; broken bonds follow.
#[derive(Serialize, Deserialize)]
struct BondBook {
    power: f64,
    dashpot: f64,
    friction: f64,
    failure: Option<Failure>,
    broken: u32,
}

fn write_bonds(w: &ListWork, out: &mut Vec<u8>) {
    let &ListWork { power, dashpot, friction, failure, .. } = w;
    encode(out, &BondBook { power, dashpot, friction, failure, broken: w.broken.len() as u32 });
    w.broken.iter().for_each(|broken| encode(out, broken));
}

fn read_bonds(w: &mut ListWork, rest: &mut &[u8]) -> Option<()> {
    let book: BondBook = decode(rest)?;
    w.reset();
    (w.power, w.dashpot, w.friction, w.failure) = (book.power, book.dashpot, book.friction, book.failure);
    for _ in 0..book.broken {
        w.broken.push(decode::<Broken>(rest)?);
    }
    Some(())
}

pub(super) fn any_broken(work: &Work) -> bool {
    let lists = work.blocks.iter().map(|w| &w.bonds).chain(&work.bonds.cross);
    lists.into_iter().any(|list| !list.broken.is_empty())
}

pub(super) fn write(work: &Work, own: Range<usize>, bonds: bool, out: &mut Vec<u8>) {
    for b in own.clone().filter(|_| bonds) {
        write_bonds(&work.blocks[b].bonds, out);
        write_bonds(&work.bonds.cross[b], out);
    }
    for (w, cross) in work.blocks[own.clone()].iter().zip(&work.cross[own]) {
        let (totals, walls) = (&w.totals, &w.patches.wall_sums);
        let book = Book {
            fastest: totals.fastest,
            failure: totals.failure,
            dashpot: cross.dashpot,
            friction: cross.friction,
            failure_across: cross.failure,
            wall_sums: walls.len() as u32,
        };
        encode(out, &book);
        write_balance(out, &totals.balance);
        walls.iter().for_each(|sum| encode(out, sum));
    }
}

/// `None` if the message is malformed.
pub(super) fn read(work: &mut Work, own: Range<usize>, bonds: bool, rest: &mut &[u8]) -> Option<()> {
    for b in own.clone().filter(|_| bonds) {
        read_bonds(&mut work.blocks[b].bonds, rest)?;
        read_bonds(&mut work.bonds.cross[b], rest)?;
    }
    for (w, cross) in work.blocks[own.clone()].iter_mut().zip(&mut work.cross[own]) {
        let book: Book = decode(rest)?;
        cross.clear_totals();
        (cross.dashpot, cross.friction, cross.failure) = (book.dashpot, book.friction, book.failure_across);
        let totals = &mut w.totals;
        (totals.balance, totals.fastest, totals.failure) = (read_balance(rest)?, book.fastest, book.failure);
        w.patches.wall_sums.clear();
        for _ in 0..book.wall_sums {
            w.patches.wall_sums.push(decode::<WallSum>(rest)?);
        }
    }
    rest.is_empty().then_some(())
}
