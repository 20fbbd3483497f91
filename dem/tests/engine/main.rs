//! The engine against closed forms, balances, and itself.

mod balance;
mod bonds;
mod bonds_block;
mod bonds_many;
mod determinism;
mod friction;
mod impact;
mod order;
mod packing;
mod refusals;
mod scene;
mod seams;
mod walls;
