//! The engine against closed forms, balances, and itself.

mod balance;
mod determinism;
mod friction;
mod hertz;
mod impact;
mod order;
mod refusals;
mod rolling;
mod scene;
mod seams;
mod walls;
