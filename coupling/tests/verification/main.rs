//! Verification of the coupling against closed forms and reference solutions.

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
