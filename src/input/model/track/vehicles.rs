//! Vehicles from a table of masses and suspensions.

use crate::scene::units::{Dashpot, Length, Mass, Quantity, Stiffness};
use crate::scene::{self, Document, SceneError};
use serde::Deserialize;
use std::path::Path;
use trackbed_track::train::CarLayout;
use trackbed_track::vehicle::VehicleInput;

/// Vehicle of a body, two bogies and four wheelsets; suspensions of both sides together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Vehicle name.
    pub name: String,
    /// Source of the data.
    pub source: String,
    /// Mass of the body [kg].
    pub body_mass: Quantity<Mass>,
    /// Its moment of inertia in pitch [kg m²].
    pub body_inertia: f64,
    /// Mass of a bogie without wheelsets [kg].
    pub bogie_mass: Quantity<Mass>,
    /// Its moment of inertia in pitch [kg m²].
    pub bogie_inertia: f64,
    /// Mass of a wheelset [kg].
    pub wheelset_mass: Quantity<Mass>,
    /// Radius of a wheel [m].
    pub wheel_radius: Quantity<Length>,
    /// Stiffness between wheelset and bogie, per axle [N/m].
    pub primary_stiffness: Quantity<Stiffness>,
    /// Damping there [N s/m].
    pub primary_damping: Quantity<Dashpot>,
    /// Stiffness between bogie and body, per bogie [N/m].
    pub secondary_stiffness: Quantity<Stiffness>,
    /// Damping there [N s/m].
    pub secondary_damping: Quantity<Dashpot>,
    /// Axle distance in a bogie [m].
    pub wheelbase: Quantity<Length>,
    /// Bogie centre distance [m].
    pub bogie_spacing: Quantity<Length>,
    /// Length over couplers [m].
    pub car_length: Quantity<Length>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    vehicle: Vec<Vehicle>,
}

/// Reads vehicle `name`.
///
/// # Errors
/// Missing file or name, invalid values.
pub fn vehicle(file: &Path, name: &str) -> Result<Vehicle, SceneError> {
    let document = Document::open(file)?;
    let table: Table = document.read()?;
    let Some(k) = table.vehicle.iter().position(|v| v.name == name) else {
        let names: Vec<&str> = table.vehicle.iter().map(|v| v.name.as_str()).collect();
        let (found, expected) = (format!("no vehicle \"{name}\""), format!("one of {}", names.join(", ")));
        return Err(SceneError::whole(file, "vehicle", found, expected));
    };
    let root = scene::Table::root(&document, &table);
    let v = root.row("vehicle", &table.vehicle, k);
    let (base, bogies) = (v.wheelbase.si, v.bogie_spacing.si);
    for (key, value, least) in [
        ("body_mass", v.body_mass.si, 0.0),
        ("body_inertia", v.body_inertia, 0.0),
        ("bogie_mass", v.bogie_mass.si, 0.0),
        ("bogie_inertia", v.bogie_inertia, 0.0),
        ("wheelset_mass", v.wheelset_mass.si, 0.0),
        ("wheel_radius", v.wheel_radius.si, 0.0),
        ("primary_stiffness", v.primary_stiffness.si, 0.0),
        ("secondary_stiffness", v.secondary_stiffness.si, 0.0),
        ("wheelbase", base, 0.0),
        ("bogie_spacing", bogies, base),
        ("car_length", v.car_length.si, bogies + base),
    ] {
        v.check(key, value, |x| x.is_finite() && x > least, &format!("more than {least}"))?;
    }
    for (key, value) in
        [("primary_damping", v.primary_damping.si), ("secondary_damping", v.secondary_damping.si)]
    {
        v.check(key, value, |x| x >= 0.0, "0 or more")?;
    }
    Ok(v.clone())
}

impl Vehicle {
    /// Returns axle distances of `cars` vehicles [m], ascending.
    pub fn axles(&self, cars: u32) -> Vec<f64> {
        let layout = CarLayout {
            wheelbase: self.wheelbase.si,
            bogie_spacing: self.bogie_spacing.si,
            car_length: self.car_length.si,
        };
        layout.axles(cars)
    }

    /// Returns masses and suspensions under `gravity` [m/s²].
    pub fn input(&self, gravity: f64) -> VehicleInput {
        VehicleInput {
            body: [self.body_mass.si, self.body_inertia],
            bogie: [self.bogie_mass.si, self.bogie_inertia],
            wheelset: self.wheelset_mass.si,
            primary: [self.primary_stiffness.si, self.primary_damping.si],
            secondary: [self.secondary_stiffness.si, self.secondary_damping.si],
            wheelbase: self.wheelbase.si,
            bogie_spacing: self.bogie_spacing.si,
            gravity,
        }
    }

    /// Returns the constant G of a wheel with worn profile, δ = G F^(2/3) [m/N^(2/3)]: Zhai, Wang & Cai 2009.
    pub fn hertz(&self) -> f64 {
        3.86e-8 * libm::pow(self.wheel_radius.si, -0.115)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_vehicles() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/data/vehicles.toml");
        for (name, tonnes) in [("Velaro E", 15.5), ("Manchester", 11.1), ("China Star", 19.5)] {
            let v = vehicle(&file, name).unwrap();
            let load = v.input(9.81).axle_load() / 9810.0;
            assert!((load - tonnes).abs() < 0.1, "{name}: {load} t");
            assert!(v.axles(2).windows(2).all(|a| a[1] > a[0]), "{name}");
        }
        let error = vehicle(&file, "TGV").unwrap_err().to_string();
        assert!(error.contains("found no vehicle \"TGV\", expected one of Velaro E, "), "{error}");
    }
}
