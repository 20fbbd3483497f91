//! Requirements on every constitutive law; a new law needs one line in the table below.

mod checks;
mod paths;

use crate::user_material;
use checks::*;
use paths::Case;
use trackbed_fem::material::umat::UserEnergy;
use trackbed_fem::material::{Consolidation, ModifiedCamClay, Shear};
use trackbed_fem::{Cone, DruckerPrager, Elastic, Hardening, Material, MohrCoulomb};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 1900.0 };

fn coulomb(phi: f64, psi: f64, tension: Option<f64>) -> MohrCoulomb {
    MohrCoulomb { cohesion: 10e3.into(), friction: phi.into(), dilation: psi, tension }
}

fn cone(phi: f64, psi: f64, cohesion: Hardening) -> DruckerPrager {
    let (friction, cone) = (phi.into(), Cone::PlaneStrain);
    DruckerPrager { cohesion, friction, dilation: psi, cone, tension: None }
}

/// Routine of a shared library.
fn user_cone(energy: UserEnergy) -> Material {
    user_material::drucker_prager(&SOIL, &cone(0.5, 0.1, 10e3.into()), energy)
}

fn rising() -> Hardening {
    Hardening::Linear { initial: 10e3, modulus: 2e6, limit: None }
}

const POISSON: Shear = Shear::Poisson(0.3);
const MODULUS: Shear = Shear::Modulus(1.5e6);

fn clay(shear: Shear) -> ModifiedCamClay {
    ModifiedCamClay {
        lambda: 0.093,
        kappa: 0.035,
        critical_ratio: 0.95,
        void_ratio: 0.6,
        shear,
        consolidation: Consolidation::Ratio(1.5),
        minimum_pressure: 1e3,
    }
}

fn dense() -> ModifiedCamClay {
    ModifiedCamClay { consolidation: Consolidation::Pressure(300e3), ..clay(POISSON) }
}

/// `name: material, initial isotropic pressure [Pa], elastic strain limit, strain of the walks`.
macro_rules! laws {
    ($($name:ident: $material:expr, $pressure:expr, $elastic:expr, $walk:expr;)*) => {
        $(mod $name {
            use super::*;

            fn case() -> Case {
                Case { material: $material, pressure: $pressure, elastic: $elastic, walk: $walk }
            }

            #[test]
            fn tangent_is_stress_derivative() {
                tangent(&case());
            }

            #[test]
            fn response_is_objective() {
                objectivity(&case());
            }

            #[test]
            fn elastic_cycles_conserve_energy_as_declared() {
                elastic_cycles(&case());
            }

            #[test]
            fn associated_plastic_work_is_nonnegative() {
                dissipation(&case());
            }

            #[test]
            fn returned_stresses_are_admissible() {
                admissibility(&case());
            }

            #[test]
            fn restart_is_bitwise_identical() {
                round_trip(&case());
            }

            #[test]
            fn declared_properties_are_consistent() {
                statements(&case());
            }
        })*
    };
}

laws! {
    linear_elastic: SOIL.into(), 100e3, 1e-3, 1e-3;
    mohr_coulomb_associated: Material::plastic(SOIL, coulomb(0.5, 0.5, None)), 50e3, 1e-4, 5e-4;
    mohr_coulomb_cut_off: Material::plastic(SOIL, coulomb(0.5, 0.1, Some(5e3))), 20e3, 1e-4, 5e-4;
    tresca: Material::plastic(SOIL, MohrCoulomb::tresca(50e3)), 0.0, 1e-4, 2e-3;
    drucker_prager_associated: Material::plastic(SOIL, cone(0.5, 0.5, 10e3.into())), 50e3, 1e-4, 5e-4;
    drucker_prager_hardening: Material::plastic(SOIL, cone(0.5, 0.1, rising())), 50e3, 1e-4, 5e-4;
    cam_clay: Material::plastic(clay(POISSON).reference(1900.0), clay(POISSON)), 50e3, 1e-4, 2e-3;
    cam_clay_conservative: Material::plastic(clay(MODULUS).reference(1900.0), clay(MODULUS)), 50e3, 1e-4, 2e-3;
    cam_clay_overconsolidated: Material::plastic(dense().reference(1900.0), dense()), 50e3, 1e-4, 1e-2;
    user_drucker_prager: user_cone(UserEnergy::Reference), 50e3, 1e-4, 5e-4;
    user_drucker_prager_energies: user_cone(UserEnergy::Library), 50e3, 1e-4, 5e-4;
    von_mises: Material::plastic(SOIL, DruckerPrager::von_mises(50e3)), 0.0, 1e-4, 2e-3;
}
