//! Grains, force chains and walls as VTK poly data (`.vtp`).

use std::path::Path;

use super::choice::Choice;
use super::error::WriteError;
use super::frame::{ChainFrame, GrainFrame, Values, WallFrame};
use super::vtk::{self, Fields, Section};

/// Writes the selected grain fields as point data.
///
/// # Errors
/// Wrong field length, non-finite values; I/O errors.
pub fn write_grains(file: &Path, frame: &GrainFrame, choice: Choice<'_>) -> Result<(), WriteError> {
    let count = frame.position.len();
    let mut fields = Fields::of_points(file, count).only(choice);
    add(&mut fields, &frame.fields)?;
    let verts = Section::cells_in_order("Verts", count, 1);
    write(file, &frame.position, fields, verts, ("NumberOfVerts", count))
}

fn add(fields: &mut Fields, all: &[(&'static str, Values)]) -> Result<(), WriteError> {
    for (name, values) in all {
        match values {
            Values::Vectors(values) => fields.vector(name, values.as_flattened())?,
            Values::Quaternions(values) => fields.generic(name, values.as_flattened(), 4)?,
            Values::Numbers(values) => fields.scalar(name, values)?,
            Values::Counts(values) => fields.ids(name, values)?,
        }
    }
    Ok(())
}

/// Writes force chains: cell data `normal_force`, `tangential_force`, `magnitude`, `kind`, `strong`, partner
/// ids `a`, `b`.
///
/// # Errors
/// As [`write_grains`].
pub fn write_chains(file: &Path, frame: &ChainFrame) -> Result<(), WriteError> {
    let count = frame.ends.len();
    let mut fields = Fields::of_cells(file, count);
    fields.scalar("normal_force", &frame.normal_force)?;
    fields.scalar("tangential_force", &frame.tangential_force)?;
    let parts = frame.normal_force.iter().zip(&frame.tangential_force);
    let magnitude: Vec<f64> = parts.map(|(normal, tangential)| libm::hypot(*normal, *tangential)).collect();
    fields.scalar("magnitude", &magnitude)?;
    fields.ids("kind", &frame.kind)?;
    fields.ids("strong", &frame.strong)?;
    for (k, name) in ["a", "b"].into_iter().enumerate() {
        fields.ids(name, &frame.partners.iter().map(|p| p[k]).collect::<Vec<_>>())?;
    }
    let lines = Section::cells_in_order("Lines", count, 2);
    write(file, frame.ends.as_flattened(), fields, lines, ("NumberOfLines", count))
}

/// Writes walls: cell data `id`, `kind`, fields of polyhedral grains.
///
/// # Errors
/// As [`write_grains`]; invalid polygons.
pub fn write_walls(file: &Path, frame: &WallFrame, choice: Choice<'_>) -> Result<(), WriteError> {
    for (at, polygon) in frame.polygons.iter().enumerate() {
        if polygon.len() < 3 {
            let message = format!("polygon {at} has {} corners, expected 3 or more", polygon.len());
            return Err(WriteError::format(file, message));
        }
        if let Some(corner) = polygon.iter().find(|c| **c as usize >= frame.points.len()) {
            let message = format!("polygon {at} names point {corner}, expected below {}", frame.points.len());
            return Err(WriteError::format(file, message));
        }
    }
    let mut fields = Fields::of_cells(file, frame.polygons.len()).only(choice);
    fields.ids("id", &frame.id)?;
    fields.ids("kind", &frame.kind)?;
    add(&mut fields, &frame.grains)?;
    let connectivity = frame.polygons.iter().flatten().map(|c| u64::from(*c));
    let ends = frame.polygons.iter().scan(0, |end, polygon| {
        *end += polygon.len() as u64;
        Some(*end)
    });
    let polygons = Section::cells("Polys", connectivity, ends);
    write(file, &frame.points, fields, polygons, ("NumberOfPolys", frame.polygons.len()))
}

fn write(
    file: &Path,
    points: &[[f64; 3]],
    fields: Fields,
    cells: Section,
    count: (&str, usize),
) -> Result<(), WriteError> {
    let counts = [("NumberOfPoints", points.len()), count];
    vtk::write(file, "PolyData", &counts, &[fields.finish(), Section::points(file, points)?, cells])
}

#[cfg(test)]
mod tests {
    use vtkio::model::DataSet;

    use super::*;
    use crate::write::sample::{self, folder};

    fn grains(count: usize) -> GrainFrame {
        sample::grains(count, |i| [i as f64, 0.5, -1.0])
    }

    #[test]
    fn error_names_field_and_grain() {
        let dir = folder("vtp_nan");
        let file = dir.join("grains.vtp");
        let mut frame = grains(5);
        let of = |frame: &GrainFrame, name: &str| frame.fields.iter().position(|f| f.0 == name).unwrap();
        let (orientation, id) = (of(&frame, "orientation"), of(&frame, "id"));
        let Values::Quaternions(values) = &mut frame.fields[orientation].1 else { unreachable!() };
        values[3][2] = f64::NAN;
        let error = write_grains(&file, &frame, Choice::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("{}: orientation at index 3 is NaN: not written", file.display())
        );
        let mut frame = grains(5);
        frame.position[4][0] = f64::NEG_INFINITY;
        let error = write_grains(&file, &frame, Choice::default()).unwrap_err();
        assert!(error.to_string().contains("points at index 4 is -inf"), "{error}");
        let mut frame = grains(5);
        let Values::Counts(values) = &mut frame.fields[id].1 else { unreachable!() };
        values.pop();
        let error = write_grains(&file, &frame, Choice::default()).unwrap_err();
        assert!(error.to_string().contains("id has 4 values, expected 5"), "{error}");
        assert!(!file.exists());
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn bad_polygons_are_refused() {
        let dir = folder("vtp_walls");
        let file = dir.join("walls.vtp");
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let frame = WallFrame {
            points: points.clone(),
            polygons: vec![vec![0, 1, 3]],
            id: vec![0],
            kind: vec![0],
            grains: Vec::new(),
        };
        let error = write_walls(&file, &frame, Choice::default()).unwrap_err();
        assert!(error.to_string().contains("polygon 0 names point 3, expected below 3"), "{error}");
        let frame = WallFrame { polygons: vec![vec![0, 1]], ..frame };
        let error = write_walls(&file, &frame, Choice::default()).unwrap_err();
        assert!(error.to_string().contains("polygon 0 has 2 corners"), "{error}");
        assert!(!file.exists());
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn chains_contain_total_force() {
        let dir = folder("vtp_chains");
        let file = dir.join("chains.vtp");
        let frame = ChainFrame {
            ends: vec![[[0.0; 3], [1.0, 2.0, 3.0]]],
            normal_force: vec![3.0],
            tangential_force: vec![4.0],
            kind: vec![1],
            strong: vec![1],
            partners: vec![[0, 1]; 1],
        };
        write_chains(&file, &frame).unwrap();
        let DataSet::PolyData { mut pieces, .. } = vtkio::Vtk::import(&file).unwrap().data else {
            panic!("not poly data")
        };
        let piece = pieces.remove(0).into_loaded_piece_data(None).unwrap();
        assert_eq!(piece.points.into_vec::<f64>().unwrap(), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0]);
        let magnitude = piece.data.cell.iter().find_map(|a| match a {
            vtkio::model::Attribute::DataArray(a) if a.name == "magnitude" => a.data.cast_into::<f64>(),
            _ => None,
        });
        assert_eq!(magnitude.unwrap(), [5.0]);
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
