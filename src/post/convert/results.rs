//! Grains and chains of result frames.

use super::{animation, chains};
use std::collections::HashMap;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::read::vtk_arrays::Arrays;
use trackbed_io::results::series::{self, Part};

/// Reads the grains of all frames; the last column is the fragment, else the part.
///
/// # Errors
/// Missing or damaged frames.
pub fn grains(dir: &Path) -> Result<Vec<animation::Moment>, Failure> {
    let mut moments = Vec::new();
    for frame in series::read(dir)? {
        let Some(file) = frame.file(Part::Grains) else { continue };
        let arrays = Arrays::open(file, "PolyData")?;
        let there = |name: &str| arrays.components("PointData", name).is_some();
        let position = triples(&arrays.values("Points", "Points")?);
        let velocity = match there("velocity") {
            true => triples(&arrays.values("PointData", "velocity")?),
            false => vec![[0.0; 3]; position.len()],
        };
        let part = ["fragment", "part"].into_iter().find(|name| there(name));
        moments.push(animation::Moment {
            time: frame.time,
            radius: arrays.values("PointData", "radius")?,
            velocity,
            part: part.map(|name| arrays.values("PointData", name)).transpose()?,
            position,
        });
    }
    Ok(moments)
}

/// Reads the force chains of all frames.
///
/// # Errors
/// Missing or damaged frames, chains without partner ids.
pub fn chains(dir: &Path) -> Result<Vec<chains::Moment>, Failure> {
    let mut moments = Vec::new();
    for frame in series::read(dir)? {
        let (Some(file), Some(grains)) = (frame.file(Part::Chains), frame.file(Part::Grains)) else {
            continue;
        };
        let ids = Arrays::open(grains, "PolyData")?.indices("PointData", "id")?;
        let mut number = HashMap::new();
        for (k, id) in ids.iter().enumerate() {
            number.entry(*id).or_insert(k as u32 + 1);
        }
        let arrays = Arrays::open(file, "PolyData")?;
        let partners = |name: &str| arrays.indices("CellData", name);
        let (a, b) = (partners("a")?, partners("b")?);
        let normal = arrays.values("CellData", "normal_force")?;
        let tangential = arrays.values("CellData", "tangential_force")?;
        let of = |id: &u32| number.get(id).copied().unwrap_or(0);
        let chains = (0..normal.len()).map(|k| chains::Chain {
            first: of(&a[k]),
            second: of(&b[k]),
            normal: normal[k],
            tangential: tangential[k],
        });
        moments.push(chains::Moment { time: frame.time, chains: chains.collect() });
    }
    Ok(moments)
}

fn triples(flat: &[f64]) -> Vec<[f64; 3]> {
    flat.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect()
}
