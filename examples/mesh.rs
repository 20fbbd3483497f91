//! Reads, checks and converts a mesh.
//!
//! ```sh
//! cargo run --release --example mesh
//! ```

use std::path::Path;
use trackbed::mesh_tools::{check, info};
use trackbed::read::read_mesh_file;
use trackbed::write::{MeshOptions, write_mesh_file};

/// Returns mesh volumes [m³] before and after a round trip.
pub fn round_trip(mesh: &Path, ending: &str) -> Result<[f64; 2], Box<dyn std::error::Error>> {
    let read = read_mesh_file(mesh)?;
    let faults = check(&read.mesh, &read.constraints);
    if !faults.is_empty() {
        return Err(format!("{}: {faults:?}", mesh.display()).into());
    }
    let copy = std::env::temp_dir().join(format!("trackbed_mesh_{}.{ending}", std::process::id()));
    for lost in write_mesh_file(&copy, &read, MeshOptions::default())? {
        println!(".{ending} does not hold: {lost}");
    }
    let again = read_mesh_file(&copy)?;
    std::fs::remove_file(&copy)?;
    Ok([info(&read.mesh, &read.constraints).volume, info(&again.mesh, &again.constraints).volume])
}

/// Quarter of a thick cylinder from Abaqus, radii 0.5 m and 1.5 m.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs/solid/cylinder/cylinder.inp");
    for ending in ["vtu", "msh", "cdb"] {
        let [before, after] = round_trip(&mesh, ending)?;
        println!(".{ending}: {before:.9} m3 before, {after:.9} m3 after");
    }
    Ok(())
}
