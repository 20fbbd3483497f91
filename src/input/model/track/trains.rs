//! Trains from a table of axle layouts.

use crate::scene::units::{Force, Length, Quantity};
use crate::scene::{self, Document, SceneError};
use serde::Deserialize;
use std::path::Path;
use trackbed_track::train::CarLayout;

/// Car with two two-axle bogies.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Car {
    /// Train name.
    pub name: String,
    /// Source of the data.
    pub source: String,
    /// Static axle load [N].
    pub axle_load: Quantity<Force>,
    /// Axle distance in a bogie [m].
    pub wheelbase: Quantity<Length>,
    /// Bogie centre distance [m].
    pub bogie_spacing: Quantity<Length>,
    /// Length over couplers, the car spacing [m].
    pub car_length: Quantity<Length>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    train: Vec<Car>,
}

/// Reads the car of train `name`.
///
/// # Errors
/// Missing file or name, invalid lengths.
pub fn car(file: &Path, name: &str) -> Result<Car, SceneError> {
    let document = Document::open(file)?;
    let table: Table = document.read()?;
    let names: Vec<&str> = table.train.iter().map(|t| t.name.as_str()).collect();
    let Some(k) = names.iter().position(|n| *n == name) else {
        let (found, expected) = (format!("no train \"{name}\""), format!("one of {}", names.join(", ")));
        return Err(SceneError::whole(file, "train", found, expected));
    };
    let root = scene::Table::root(&document, &table);
    let car = root.row("train", &table.train, k);
    let lengths = [car.wheelbase.si, car.bogie_spacing.si, car.car_length.si];
    for (key, value, least) in [
        ("axle_load", car.axle_load.si, 0.0),
        ("wheelbase", lengths[0], 0.0),
        ("bogie_spacing", lengths[1], lengths[0]),
        ("car_length", lengths[2], lengths[0] + lengths[1]),
    ] {
        if value <= least {
            return Err(car.error(key, value.to_string(), format!("more than {least}")));
        }
    }
    Ok(car.clone())
}

impl Car {
    /// Returns axle distances of `cars` cars [m], ascending.
    pub fn axles(&self, cars: u32) -> Vec<f64> {
        let layout = CarLayout {
            wheelbase: self.wheelbase.si,
            bogie_spacing: self.bogie_spacing.si,
            car_length: self.car_length.si,
        };
        layout.axles(cars)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shipped_trains() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/data/trains.toml");
        let crh = car(&file, "CRH2").unwrap();
        assert_eq!(crh.axles(2), [0.0, 2.5, 17.5, 20.0, 25.0, 27.5, 42.5, 45.0]);
        assert_eq!(crh.axle_load.si, 140e3);
        let error = car(&file, "TGV").unwrap_err().to_string();
        assert!(error.contains("train: found no train \"TGV\", expected one of CRH2, "), "{error}");
        let names = error.split("one of ").nth(1).unwrap().split(", ");
        let mut count = 0;
        for name in names {
            let axles = car(&file, name).unwrap().axles(3);
            assert!(axles.windows(2).all(|a| a[1] > a[0]), "{name}");
            count += 1;
        }
        assert_eq!(count, 6);
    }
}
