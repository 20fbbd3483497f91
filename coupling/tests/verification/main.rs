//! Coupling against closed forms and reference solutions. Numbers and names of the problems (V0.5, (i)a, …) are
//! those of the project's list of coupling verification problems; each test's head says what is exact in it.

mod alone;
mod edges;
mod impact;
mod pressure;
mod rest;
mod sliding;
mod spread;
mod support;
mod transfer;
mod two_mass;
