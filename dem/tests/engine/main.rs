//! The engine against closed forms, balances, and itself.

mod balance;
mod bonds;
mod bonds_block;
mod bonds_many;
mod determinism;
mod extremes;
mod friction;
mod impact;
mod mesh_cases;
mod order;
mod packing;
mod periodic;
mod physics_clumps;
mod physics_flow;
mod physics_packing;
mod physics_settling;
mod refusals;
mod round_walls;
mod scene;
mod seams;
mod tables;
mod triangle_bodies;
mod wall_motion;
mod walls;
