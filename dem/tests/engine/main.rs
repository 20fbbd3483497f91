//! The engine against closed forms, balances, and itself.

mod balance;
mod bonds;
mod bonds_block;
mod bonds_many;
mod determinism;
mod extremes;
mod friction;
mod impact;
mod order;
mod packing;
mod physics_clumps;
mod physics_flow;
mod physics_packing;
mod physics_settling;
mod refusals;
mod scene;
mod seams;
mod tables;
mod walls;
