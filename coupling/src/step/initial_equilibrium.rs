//! Initial contact load on the solid.

use crate::surface::SolidSurface;
use crate::transfer::{Transfer, TransferAudit};
use trackbed_dem as dem;
use trackbed_fem as fem;

/// Returns the nodal load [N], shape `[3·nodes]`, of grains on the undeformed surface, and the state with
/// contacts.
///
/// # Errors
/// The grains cannot make a step.
pub fn initial_contact_load(
    grains: &dem::Model,
    mut state: dem::State,
    surface: &mut SolidSurface,
    mesh: &fem::mesh::Mesh,
) -> Result<(Vec<f64>, dem::State), dem::StepError> {
    let mut work = dem::Work::new(grains, &state);
    let zero = vec![0.0; 3 * mesh.node_count()];
    surface.begin_window(mesh, &zero, &zero, &zero, grains.dt());
    dem::find_contacts(grains, &mut state, &mut work, &*surface)?;
    let mut transfer = Transfer::new(surface);
    transfer.add(surface, work.surface_contacts(), grains.dt(), &mut TransferAudit::default());
    let mut load = zero;
    transfer.add_mean_load(surface, grains.dt(), &mut load);
    Ok((load, state))
}
