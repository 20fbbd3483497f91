//! The engine against closed forms, balances, and itself.

mod balance;
mod determinism;
mod friction;
mod hertz;
mod impact;
mod mesh_cases;
mod order;
mod refusals;
mod rolling;
mod round_walls;
mod scene;
mod seams;
mod triangle_bodies;
mod wall_motion;
mod walls;
