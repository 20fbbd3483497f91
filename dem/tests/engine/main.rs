//! The engine against closed forms, balances, and itself.

mod balance;
mod determinism;
mod friction;
mod hertz;
mod impact;
mod mesh_cases;
mod order;
mod refusals;
<<<<<<< HEAD
mod round_walls;
=======
mod rolling;
>>>>>>> w-k
mod scene;
mod seams;
mod triangle_bodies;
mod wall_motion;
mod walls;
