//! Coupling against closed forms and reference solutions. Numbers and names of the problems (V0.5, (i)a, …) are
//! those of the project's list of coupling verification problems; each test's head says what is exact in it.

mod alone;
mod beam;
mod bed;
mod bounce;
mod collapse;
mod curved;
mod cyclic;
mod edges;
mod impact;
mod kinds;
mod mapping;
mod plate;
mod polyhedra;
mod pressure;
mod reduction;
mod rest;
mod resting;
mod sliding;
mod spread;
mod support;
mod transfer;
mod two_mass;
