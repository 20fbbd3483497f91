//! What blocks book in a step, sent to the first rank.

use super::code::{put, take};
use crate::base::failure::Failure;
use crate::base::ledger::Ledger;
use crate::bodies::sums::WallSum;
use crate::engine::work::Work;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What a block books; of walls what follows.
#[derive(Serialize, Deserialize)]
struct Book {
    ledger: Ledger,
    fastest: f64,
    failure: Option<Failure>,
    /// Of its contacts with later blocks.
    dashpot: f64,
    friction: f64,
    failure_across: Option<Failure>,
    wall_sums: u32,
}

/// Puts the books of blocks into a message.
pub(super) fn write(work: &Work, own: Range<usize>, out: &mut Vec<u8>) {
    for (w, cross) in work.blocks[own.clone()].iter().zip(&work.cross[own]) {
        let (tally, walls) = (&w.tally, &w.patches.wall_sums);
        let book = Book {
            ledger: tally.ledger,
            fastest: tally.fastest,
            failure: tally.failure,
            dashpot: cross.dashpot,
            friction: cross.friction,
            failure_across: cross.failure,
            wall_sums: walls.len() as u32,
        };
        put(out, &book);
        walls.iter().for_each(|sum| put(out, sum));
    }
}

/// Reads them; `None` where the message is not what it should be.
pub(super) fn read(work: &mut Work, own: Range<usize>, rest: &mut &[u8]) -> Option<()> {
    for (w, cross) in work.blocks[own.clone()].iter_mut().zip(&mut work.cross[own]) {
        let book: Book = take(rest)?;
        cross.clear_books();
        (cross.dashpot, cross.friction, cross.failure) = (book.dashpot, book.friction, book.failure_across);
        let tally = &mut w.tally;
        (tally.ledger, tally.fastest, tally.failure) = (book.ledger, book.fastest, book.failure);
        w.patches.wall_sums.clear();
        for _ in 0..book.wall_sums {
            w.patches.wall_sums.push(take::<WallSum>(rest)?);
        }
    }
    rest.is_empty().then_some(())
}
