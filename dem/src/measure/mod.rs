//! Measures of a state.
//!
//! Energies and momentum belong to the last half step, t − dt/2. The energy balance is second order in dt,
//! the momentum balance exact. Contacts have the forces of the next step.

mod bonds;
mod breakage;
mod contacts;
mod coordination;
mod energy;
mod extent;
mod force_on;
mod fragments;
mod memory_size;
mod porosity;
mod radial;
mod region;
mod sieve;
mod sphere_box_volume;
mod stress;

pub use bonds::{BondRecord, BondRotation, largest_rotation, records as bond_records};
pub use breakage::{Breakage, breakage};
pub(crate) use contacts::visit;
pub use contacts::{ContactRecord, contact_forces, contact_forces_of, contacts, coordination};
pub use coordination::{
    Coordination, StrongNetwork, coordination_of, fabric, neighbours, strong_network, unbalanced_ratio,
};
pub use energy::{Energies, energies, momentum, reference_energy};
pub(crate) use energy::{energies_of, momentum_of};
pub use extent::{highest_over, lowest};
pub use force_on::{force_on, loads_on};
pub use fragments::{Fragments, fragments};
pub use memory_size::{bytes, kernels};
pub use porosity::{COLUMNS, body_volume_in, porosity, solid_volume};
pub use radial::radial_distribution;
pub use region::BoxRegion;
pub use sieve::{size_of, stones};
pub use sphere_box_volume::sphere_box_volume;
pub use stress::{mean_stress, mean_stress_of, region_stress};
