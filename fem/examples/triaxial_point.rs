//! Drained triaxial compression of one Mohr–Coulomb point at 100 kPa cell pressure: strength against the
//! closed form.

use trackbed_fem::material::{regularise, update};
use trackbed_fem::{Elastic, Material, MohrCoulomb, PointState};

/// Runs the example.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (cell, cohesion, phi) = (100e3, 20e3, 30_f64.to_radians());
    let elastic = Elastic { young: 50e6, poisson: 0.3, density: 1900.0 };
    let law = MohrCoulomb { cohesion: cohesion.into(), friction: phi.into(), dilation: 0.2, tension: None };
    let soil = Material::plastic(elastic, law);

    let mut state = PointState { stress: [-cell, -cell, -cell, 0.0, 0.0, 0.0], ..PointState::default() };
    for step in 1..=10 {
        // Axial compression of 0.2 %; Newton iteration finds the radial strain at constant cell pressure.
        let mut strain = [0.0, 0.0, -2e-3, 0.0, 0.0, 0.0];
        for _ in 0..60 {
            let mut response = update(&soil, &state, &strain, true)?;
            let miss = response.state.stress[0] + cell;
            if miss.abs() < 1e-6 * cell {
                break;
            }
            regularise(&mut response.tangent, &elastic, 1e-6);
            let slope = response.tangent[0][0] + response.tangent[0][1];
            strain[0] -= miss / slope;
            strain[1] = strain[0];
        }
        state = update(&soil, &state, &strain, false)?.state;
        println!(
            "axial strain {:.1} %: q = {:.1} kPa",
            0.2 * f64::from(step),
            -1e-3 * (state.stress[2] + cell)
        );
    }
    let slope = (1.0 + phi.sin()) / (1.0 - phi.sin());
    let strength = slope * cell + 2.0 * cohesion * slope.sqrt();
    println!("axial stress {:.1} kPa, closed form {:.1} kPa", -1e-3 * state.stress[2], 1e-3 * strength);
    assert!((-state.stress[2] / strength - 1.0).abs() < 1e-6);
    Ok(())
}
