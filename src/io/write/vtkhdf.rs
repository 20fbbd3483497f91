//! VTKHDF frames: `grains.vtkhdf` (poly data) and `solid.vtkhdf` (unstructured grid), each with all times.
//!
//! The undeformed mesh is written once, grain vertices only if their number changes.
//!
//! Source: VTK's documentation, "VTKHDF file format", version 2.0, and its part on transient data.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::read::foreign_elements::foreign;

use super::choice::Choice;
use super::error::{WriteError, check_field};
use super::frame::{Frame, GrainFrame, NodalValues, SolidFrame, Values as FieldValues};
use super::hdf5::{Attribute, File, GroupId, Kind};
use super::vtk::matrices;
use super::writer::{Format, Mark, Part, Writer};

/// VTKHDF, one file per part.
pub const FORMAT: Format = Format {
    key: "vtkhdf",
    default: false,
    parts: &[Part::Solid, Part::Grains],
    folder: "",
    endings: &[],
    files: &["solid.vtkhdf", "grains.vtkhdf"],
    begin,
};

const TOPOLOGIES: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];

struct VtkHdf {
    dir: PathBuf,
    /// Solid and grains, from their first frame.
    series: [Option<Series>; 2],
}

fn begin(dir: &Path, mark: Option<&Mark>) -> Result<Box<dyn Writer>, WriteError> {
    let mut writer = VtkHdf { dir: dir.to_path_buf(), series: [None, None] };
    if let Some(mark) = mark {
        let marks: [Option<SeriesMark>; 2] =
            postcard::from_bytes(mark).map_err(|error| WriteError::format(dir, error))?;
        for ((name, mark), series) in FORMAT.files.iter().zip(marks).zip(&mut writer.series) {
            *series = mark.map(|mark| Series::resume(&dir.join(name), mark)).transpose()?;
        }
    }
    Ok(Box::new(writer))
}

impl Writer for VtkHdf {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError> {
        let files = [0, 1].map(|k| self.dir.join(FORMAT.files[k]));
        let [solid, grains] = &mut self.series;
        if let Some(shown) = &frame.solid {
            let series = Series::at(solid, &files[0], "UnstructuredGrid")?;
            series.solid(frame.time, shown, frame.fields)?;
        }
        if let Some(shown) = frame.grains {
            let series = Series::at(grains, &files[1], "PolyData")?;
            series.grains(frame.time, shown, frame.fields)?;
        }
        Ok(())
    }

    fn mark(&self) -> Mark {
        let marks = self.series.each_ref().map(|series| series.as_ref().map(Series::mark));
        postcard::to_allocvec(&marks).expect("plain data can be serialized")
    }
}

struct Field<'a> {
    name: &'static str,
    values: Values<'a>,
}

enum Values<'a> {
    Doubles(u32, Cow<'a, [f64]>),
    Ids(&'a [u32]),
}

fn doubles<'a>(name: &'static str, components: u32, values: &'a [f64]) -> Field<'a> {
    Field { name, values: Values::Doubles(components, Cow::Borrowed(values)) }
}

fn ids<'a>(name: &'static str, values: &'a [u32]) -> Field<'a> {
    Field { name, values: Values::Ids(values) }
}

fn nodal<'a>((name, values): &'a (&'static str, NodalValues<'_>)) -> Field<'a> {
    match values {
        NodalValues::Numbers(values) => doubles(name, 1, values),
        NodalValues::Vectors(values) => doubles(name, 3, values),
        NodalValues::Tensors(values) => {
            Field { name, values: Values::Doubles(9, Cow::Owned(matrices(values))) }
        }
    }
}

fn chosen<'a>(fields: impl IntoIterator<Item = Field<'a>>, choice: Choice<'_>) -> Vec<Field<'a>> {
    fields.into_iter().filter(|field| choice.has(field.name)).collect()
}

fn points(points: &[[f64; 3]]) -> Field<'_> {
    doubles("Points", 3, points.as_flattened())
}

impl Field<'_> {
    fn check(&self, file: &Path, count: usize) -> Result<(), WriteError> {
        match &self.values {
            Values::Doubles(components, values) => {
                check_field(file, self.name, values, *components as usize, count)
            }
            Values::Ids(values) if values.len() == count => Ok(()),
            Values::Ids(values) => {
                let (file, field) = (file.to_path_buf(), self.name.to_string());
                Err(WriteError::Length { file, field, found: values.len(), expected: count })
            }
        }
    }
}

struct Place {
    part: i64,
    points: i64,
    cells: Vec<i64>,
}

struct Series {
    path: PathBuf,
    file: File,
    steps: i64,
    points: Option<i64>,
}

type SeriesMark = (Vec<u8>, i64, Option<i64>);

const ROOT: GroupId = 1;

impl Series {
    fn at<'a>(series: &'a mut Option<Series>, path: &Path, kind: &str) -> Result<&'a mut Series, WriteError> {
        if series.is_none() {
            let mut file = File::create(path)?;
            let root = file.group(0, "VTKHDF");
            file.set(root, "Version", Attribute::Integers(vec![2, 0]));
            file.set(root, "Type", Attribute::Text(kind.into()));
            *series = Some(Series { path: path.to_path_buf(), file, steps: 0, points: None });
        }
        Ok(series.as_mut().expect("begun above"))
    }

    fn resume(path: &Path, mark: SeriesMark) -> Result<Series, WriteError> {
        let (file, steps, points) = mark;
        Ok(Series { path: path.to_path_buf(), file: File::resume(path, &file)?, steps, points })
    }

    fn mark(&self) -> SeriesMark {
        (self.file.mark(), self.steps, self.points)
    }

    /// Appends; returns the previous row count.
    fn add(
        &mut self,
        (group, name): (GroupId, &str),
        (kind, columns): (Kind, Option<u32>),
        bytes: Vec<u8>,
    ) -> Result<i64, WriteError> {
        let dataset = self.file.dataset(group, name, kind, columns);
        let before = self.file.rows(dataset) as i64;
        self.file.append(dataset, &bytes)?;
        Ok(before)
    }

    /// Appends integers.
    fn whole(
        &mut self,
        group: GroupId,
        name: &str,
        values: impl IntoIterator<Item = i64>,
    ) -> Result<i64, WriteError> {
        let bytes = values.into_iter().flat_map(i64::to_le_bytes).collect();
        self.add((group, name), (Kind::I64, None), bytes)
    }

    fn field(&mut self, group: GroupId, field: &Field) -> Result<i64, WriteError> {
        let (kind, columns, bytes) = match &field.values {
            Values::Doubles(components, values) => {
                let columns = (*components > 1).then_some(*components);
                (Kind::F64, columns, values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            Values::Ids(values) => (Kind::U32, None, values.iter().flat_map(|v| v.to_le_bytes()).collect()),
        };
        self.add((group, field.name), (kind, columns), bytes)
    }

    /// Commits a step with its fields and unchanged parts.
    fn step(
        &mut self,
        time: f64,
        place: &Place,
        changing: &[Field],
        fixed: [(&str, &[&'static str]); 2],
    ) -> Result<(), WriteError> {
        let steps = self.file.group(ROOT, "Steps");
        self.field(steps, &doubles("Values", 1, &[time]))?;
        self.whole(steps, "PartOffsets", [place.part])?;
        self.whole(steps, "NumberOfParts", [1])?;
        self.whole(steps, "PointOffsets", [place.points])?;
        for name in ["CellOffsets", "ConnectivityIdOffsets"] {
            let bytes = place.cells.iter().flat_map(|n| n.to_le_bytes()).collect();
            self.add((steps, name), (Kind::I64, Some(place.cells.len() as u32)), bytes)?;
        }
        let (data, offsets) =
            (self.file.group(ROOT, "PointData"), self.file.group(steps, "PointDataOffsets"));
        for field in changing {
            let before = self.field(data, field)?;
            self.whole(offsets, field.name, [before])?;
        }
        for (group, names) in fixed {
            let offsets = self.file.group(steps, group);
            names.iter().try_for_each(|name| self.whole(offsets, name, [0]).map(|_| ()))?;
        }
        self.steps += 1;
        self.file.set(steps, "NSteps", Attribute::Integer(self.steps));
        self.file.commit()
    }

    fn solid(&mut self, time: f64, frame: &SolidFrame<'_>, choice: Choice<'_>) -> Result<(), WriteError> {
        let mesh = frame.mesh;
        let fields: Vec<Field<'_>> = frame.fields.iter().map(nodal).collect();
        let nodes = mesh.node_count();
        check_field(&self.path, "time", &[time], 1, 1)?;
        check_field(&self.path, "points", mesh.coordinates.as_flattened(), 3, nodes)?;
        fields.iter().try_for_each(|field| field.check(&self.path, nodes))?;
        let chosen = chosen(fields, choice);
        if self.steps == 0 {
            let connectivity = mesh.connectivity.nodes();
            self.field(ROOT, &points(&mesh.coordinates))?;
            self.whole(ROOT, "NumberOfPoints", [nodes as i64])?;
            self.whole(ROOT, "NumberOfCells", [mesh.element_count() as i64])?;
            self.whole(ROOT, "NumberOfConnectivityIds", [connectivity.len() as i64])?;
            self.whole(ROOT, "Connectivity", connectivity.iter().map(|n| i64::from(*n)))?;
            let kinds = mesh.connectivity.kinds();
            let ends = kinds.iter().scan(0, |end, kind| {
                *end += kind.node_count() as i64;
                Some(*end)
            });
            self.whole(ROOT, "Offsets", [0].into_iter().chain(ends))?;
            let types = kinds.iter().map(|kind| foreign(*kind).vtk.0).collect();
            self.add((ROOT, "Types"), (Kind::U8, None), types)?;
            let data = self.file.group(ROOT, "PointData");
            self.field(data, &ids("node_id", &mesh.node_ids))?;
            let data = self.file.group(ROOT, "CellData");
            for (name, values) in frame.element_fields() {
                self.field(data, &ids(name, values))?;
            }
        }
        let place = Place { part: 0, points: 0, cells: vec![0] };
        let fixed: [(&str, &[&'static str]); 2] =
            [("PointDataOffsets", &["node_id"]), ("CellDataOffsets", &["material", "element_id"])];
        self.step(time, &place, &chosen, fixed)
    }

    fn grains(&mut self, time: f64, frame: &GrainFrame, choice: Choice<'_>) -> Result<(), WriteError> {
        let fields = frame.fields.iter().map(|(name, values)| match values {
            FieldValues::Vectors(values) => doubles(name, 3, values.as_flattened()),
            FieldValues::Quaternions(values) => doubles(name, 4, values.as_flattened()),
            FieldValues::Numbers(values) => doubles(name, 1, values),
            FieldValues::Counts(values) => ids(name, values),
        });
        let fields: Vec<Field<'_>> = fields.collect();
        let count = frame.position.len();
        check_field(&self.path, "time", &[time], 1, 1)?;
        check_field(&self.path, "points", frame.position.as_flattened(), 3, count)?;
        fields.iter().try_for_each(|field| field.check(&self.path, count))?;
        let chosen = chosen(fields, choice);
        let count = count as i64;
        if self.points != Some(count) {
            // New vertices, valid until their number changes.
            self.whole(ROOT, "NumberOfPoints", [count])?;
            for (k, name) in TOPOLOGIES.into_iter().enumerate() {
                let (group, cells) = (self.file.group(ROOT, name), if k == 0 { count } else { 0 });
                self.whole(group, "NumberOfCells", [cells])?;
                self.whole(group, "NumberOfConnectivityIds", [cells])?;
                self.whole(group, "Connectivity", 0..cells)?;
                self.whole(group, "Offsets", 0..=cells)?;
            }
            self.points = Some(count);
        }
        let part = self.whole(ROOT, "NumberOfPoints", [])? - 1;
        let vertices = self.file.group(ROOT, TOPOLOGIES[0]);
        let first = self.whole(vertices, "Connectivity", [])? - count;
        let points = self.field(ROOT, &points(&frame.position))?;
        let place = Place { part, points, cells: vec![first, 0, 0, 0] };
        self.step(time, &place, &chosen, [("PointDataOffsets", &[]), ("CellDataOffsets", &[])])
    }
}

#[cfg(test)]
#[path = "vtkhdf_tests.rs"]
mod tests;
