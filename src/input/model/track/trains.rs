//! Trains and load models from a table of axle layouts.

use crate::scene::units::{Force, Length, Quantity, Stiffness};
use crate::scene::{self, Document, SceneError};
use serde::Deserialize;
use std::path::Path;
use trackbed_track::train::{self, CarLayout};

/// One of three layouts: cars with two two-axle bogies; a universal train; given axles and line loads.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Train {
    /// Train name.
    pub name: String,
    /// Source of the data.
    pub source: String,
    /// Static axle load; with cars and universal trains [N].
    pub axle_load: Option<Quantity<Force>>,
    /// Axle distance in a bogie [m].
    pub wheelbase: Option<Quantity<Length>>,
    /// Bogie centre distance; with cars [m].
    pub bogie_spacing: Option<Quantity<Length>>,
    /// Length over couplers, the car spacing [m].
    pub car_length: Option<Quantity<Length>>,
    /// Intermediate coaches between a power car and an end coach on each side: a universal train.
    pub coaches: Option<u32>,
    /// Axles `[[x, F], …]`, ascending [m, N].
    #[serde(default)]
    pub axles: Vec<(Quantity<Length>, Quantity<Force>)>,
    /// Line loads `[[from, to, F/m], …]` [m, N/m].
    #[serde(default)]
    pub lines: Vec<(Quantity<Length>, Quantity<Length>, Quantity<Stiffness>)>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    train: Vec<Train>,
}

/// Reads the axles of `cars` cars of train `name`: distance behind the first [m], force [N], which `axle_load`
/// replaces.
///
/// # Errors
/// Missing file or name, invalid or superfluous values.
pub fn axles(
    file: &Path,
    name: &str,
    cars: Option<u32>,
    axle_load: Option<f64>,
) -> Result<Vec<[f64; 2]>, SceneError> {
    let document = Document::open(file)?;
    let table: Table = document.read()?;
    let Some(k) = table.train.iter().position(|t| t.name == name) else {
        let names: Vec<&str> = table.train.iter().map(|t| t.name.as_str()).collect();
        let (found, expected) = (format!("no train \"{name}\""), format!("one of {}", names.join(", ")));
        return Err(SceneError::whole(file, "train", found, expected));
    };
    let root = scene::Table::root(&document, &table);
    let row = root.row("train", &table.train, k);
    let given = !row.axles.is_empty() || !row.lines.is_empty();
    if (given || row.coaches.is_some()) && cars.is_some() {
        let expected = "no `track.load.cars`: this train is complete";
        return Err(row.error("name", format!("\"{name}\""), expected));
    }
    if given && axle_load.is_some() {
        let expected = "no `track.load.axle_load`: this train has its own loads";
        return Err(row.error("name", format!("\"{name}\""), expected));
    }
    match (given, row.coaches) {
        (true, _) => model(&row),
        (false, Some(coaches)) => {
            let [load, base, length] = universal(&row, coaches)?;
            let force = axle_load.unwrap_or(load);
            Ok(train::universal(coaches, length, base).into_iter().map(|x| [x, force]).collect())
        }
        (false, None) => {
            let (load, layout) = layout(&row)?;
            let force = axle_load.unwrap_or(load);
            Ok(layout.axles(cars.unwrap_or(1)).into_iter().map(|behind| [behind, force]).collect())
        }
    }
}

/// A value above `least`.
fn above<D>(
    row: &scene::Table<Train>,
    key: &str,
    value: Option<Quantity<D>>,
    least: f64,
) -> Result<f64, SceneError> {
    let Some(value) = value else { return Err(row.missing(key, "a value for this train")) };
    if value.si <= least {
        return Err(row.error(key, value.si.to_string(), format!("more than {least}")));
    }
    Ok(value.si)
}

fn layout(row: &scene::Table<Train>) -> Result<(f64, CarLayout), SceneError> {
    let load = above(row, "axle_load", row.axle_load, 0.0)?;
    let wheelbase = above(row, "wheelbase", row.wheelbase, 0.0)?;
    let bogie_spacing = above(row, "bogie_spacing", row.bogie_spacing, wheelbase)?;
    let car_length = above(row, "car_length", row.car_length, wheelbase + bogie_spacing)?;
    Ok((load, CarLayout { wheelbase, bogie_spacing, car_length }))
}

/// Axle load, axle distance, car length.
fn universal(row: &scene::Table<Train>, coaches: u32) -> Result<[f64; 3], SceneError> {
    row.check("coaches", coaches, |n| n <= 1000.0, "at most 1000")?;
    row.reject_with([("bogie_spacing", row.bogie_spacing.is_some())], "`coaches`")?;
    let load = above(row, "axle_load", row.axle_load, 0.0)?;
    let base = above(row, "wheelbase", row.wheelbase, 0.0)?;
    Ok([load, base, above(row, "car_length", row.car_length, base)?])
}

/// Given axles with line loads as axles at short distances, from the foremost.
fn model(row: &scene::Table<Train>) -> Result<Vec<[f64; 2]>, SceneError> {
    let others = [
        ("axle_load", row.axle_load.is_some()),
        ("wheelbase", row.wheelbase.is_some()),
        ("bogie_spacing", row.bogie_spacing.is_some()),
        ("car_length", row.car_length.is_some()),
        ("coaches", row.coaches.is_some()),
    ];
    row.reject_with(others, "`axles` or `lines`")?;
    let mut all: Vec<[f64; 2]> = row.axles.iter().map(|(x, f)| [x.si, f.si]).collect();
    for (k, (from, to, per_length)) in row.lines.iter().enumerate() {
        if to.si <= from.si || to.si - from.si > 1e4 {
            let expected = format!("an end at most 10 km beyond {}", from.si);
            return Err(row.error(&format!("lines.{k}"), to.si.to_string(), expected));
        }
        all.extend(train::line_load(from.si, to.si, per_length.si));
    }
    if let Some(f) = all.iter().map(|a| a[1]).find(|f| *f <= 0.0) {
        return Err(row.error("axles", f.to_string(), "forces above 0"));
    }
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let first = all[0][0];
    Ok(all.into_iter().map(|[x, force]| [x - first, force]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped(name: &str) -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/data").join(name)
    }

    fn all(file: &Path) -> Vec<String> {
        let error = axles(file, "", None, None).unwrap_err().to_string();
        error.split("one of ").nth(1).unwrap().split(", ").map(str::to_string).collect()
    }

    #[test]
    fn shipped_trains() {
        let file = shipped("trains.toml");
        let crh = axles(&file, "CRH2", Some(2), None).unwrap();
        assert_eq!(
            crh.iter().map(|a| a[0]).collect::<Vec<_>>(),
            [0.0, 2.5, 17.5, 20.0, 25.0, 27.5, 42.5, 45.0]
        );
        assert!(crh.iter().all(|a| a[1] == 140e3));
        assert_eq!(axles(&file, "CRH2", None, Some(1.0)).unwrap()[3], [20.0, 1.0]);
        let error = axles(&file, "TGV", None, None).unwrap_err().to_string();
        assert!(error.contains("train: found no train \"TGV\", expected one of CRH2, "), "{error}");
        let names = all(&file);
        for name in &names {
            let axles = axles(&file, name, Some(3), None).unwrap();
            assert!(axles.windows(2).all(|a| a[1][0] > a[0][0]), "{name}");
        }
        assert_eq!(names.len(), 6);
    }

    /// EN 1991-2: LM71 4 × 250 kN at 1.6 m and 80 kN/m from 0.8 m on; SW/0 2 × 133 kN/m × 15 m, 5.3 m between;
    /// HSLM-A: 400 m.
    #[test]
    fn shipped_load_models() {
        let file = shipped("load_models.toml");
        let of = |name: &str| axles(&file, name, None, None).unwrap();
        let total = |axles: &[[f64; 2]]| axles.iter().map(|a| a[1]).sum::<f64>();
        assert!((total(&of("LM71")) - (1000e3 + 2.0 * 40.0 * 80e3)).abs() < 1e-3);
        let heavy: Vec<f64> = of("LM71").iter().filter(|a| a[1] == 250e3).map(|a| a[0]).collect();
        assert!(heavy.windows(2).all(|x| (x[1] - x[0] - 1.6).abs() < 1e-9) && heavy.len() == 4, "{heavy:?}");
        assert!((total(&of("SW/0")) - 2.0 * 15.0 * 133e3).abs() < 1e-3);
        for k in 1..=10 {
            let train = of(&format!("HSLM-A{k}"));
            let length = train[train.len() - 1][0];
            assert!((380.0..410.0).contains(&length), "A{k}: {length} m");
            assert!(train.windows(2).all(|a| a[1][0] > a[0][0]));
        }
        let first = of("HSLM-A1");
        assert_eq!((first.len(), first[0][1]), (50, 170e3));
        let error = axles(&file, "LM71", Some(2), None).unwrap_err().to_string();
        assert!(error.contains("no `track.load.cars`"), "{error}");
    }
}
