//! ParaView time series (`.pvd`), rewritten after each frame.

use std::io::Write;
use std::path::{Path, PathBuf};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::read::xml::{Tag, tags};

use super::atomic;
use super::error::WriteError;

/// Frame list of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    file: PathBuf,
    frames: Vec<Frame>,
}

#[derive(Clone, Debug, PartialEq)]
struct Frame {
    time: f64,
    part: u32,
    name: String,
    file: String,
}

impl Series {
    /// Creates an empty series for `file`; writes nothing.
    pub fn new(file: &Path) -> Self {
        Series { file: file.to_path_buf(), frames: Vec::new() }
    }

    /// Resumes a series with its first `entries` files; an empty series needs no file.
    ///
    /// # Errors
    /// I/O errors, unknown content, too few entries.
    pub fn resume(file: &Path, entries: usize) -> Result<Self, WriteError> {
        let mut series = Series::new(file);
        if entries == 0 {
            return Ok(series);
        }
        let bytes = std::fs::read(file).map_err(WriteError::io(file))?;
        for tag in tags(&bytes).filter(|tag| tag.name == "DataSet").take(entries) {
            let number = series.frames.len();
            let frame = parse(&tag).ok_or_else(|| {
                WriteError::format(file, format!("DataSet {number} is not one of this program"))
            })?;
            series.frames.push(frame);
        }
        if series.frames.len() < entries {
            let message = format!("{} frames, expected at least {entries}", series.frames.len());
            return Err(WriteError::format(file, message));
        }
        Ok(series)
    }

    /// Returns the number of files.
    pub fn entries(&self) -> usize {
        self.frames.len()
    }

    /// Adds a file relative to the series: `part` (0 solid, 1 grains, …) is shown as `name`.
    pub fn push(&mut self, time: f64, part: u32, name: &str, file: &str) {
        self.frames.push(Frame { time, part, name: name.to_string(), file: file.to_string() });
    }

    /// Writes the series.
    ///
    /// # Errors
    /// Non-finite times; I/O errors.
    pub fn write(&self) -> Result<(), WriteError> {
        if let Some((index, frame)) = self.frames.iter().enumerate().find(|(_, f)| !f.time.is_finite()) {
            let (file, field) = (self.file.clone(), "time".to_string());
            return Err(WriteError::NotFinite { file, field, index, value: frame.time });
        }
        atomic::write(&self.file, |out| {
            let mut xml = Writer::new_with_indent(&mut *out, b' ', 2);
            let written = self.write_xml(&mut xml);
            written.map_err(|error| WriteError::format(&self.file, error))?;
            out.write_all(b"\n").map_err(WriteError::io(&self.file))
        })
    }

    fn write_xml<W: Write>(&self, xml: &mut Writer<W>) -> Result<(), quick_xml::Error> {
        xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
        let root = xml.create_element("VTKFile").with_attributes([
            ("type", "Collection"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
        ]);
        root.write_inner_content(|xml| {
            xml.create_element("Collection").write_inner_content(|xml| {
                for Frame { time, part, name, file } in &self.frames {
                    let (time, part) = (time.to_string(), part.to_string());
                    let values = [("timestep", &time), ("part", &part), ("name", name), ("file", file)];
                    let values = values.map(|(key, value)| (key, value.as_str()));
                    xml.create_element("DataSet").with_attributes(values).write_empty()?;
                }
                Ok::<(), quick_xml::Error>(())
            })?;
            Ok::<(), quick_xml::Error>(())
        })?;
        Ok(())
    }
}

fn parse(tag: &Tag) -> Option<Frame> {
    Some(Frame {
        time: tag.attribute("timestep")?.parse().ok()?,
        part: tag.attribute("part")?.parse().ok()?,
        name: tag.attribute("name")?,
        file: tag.attribute("file")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write::sample::folder;

    #[test]
    fn resumes_series() {
        let dir = folder("pvd");
        let file = dir.join("results.pvd");
        assert_eq!(Series::resume(&file, 0).unwrap(), Series::new(&file));
        assert!(Series::resume(&file, 1).is_err());
        let mut series = Series::new(&file);
        for frame in 0..4 {
            let time = 0.1 * f64::from(frame);
            series.push(time, 0, "solid", &format!("solid_{frame}.vtu"));
            series.push(time, 1, "grains & <chains>", &format!("\"{frame}\".vtp"));
        }
        series.write().unwrap();
        assert_eq!((Series::resume(&file, 8).unwrap(), series.entries()), (series.clone(), 8));
        let cut = Series::resume(&file, 6).unwrap();
        assert_eq!(cut.frames, series.frames[..6]);
        let error = Series::resume(&file, 9).unwrap_err().to_string();
        assert!(error.contains("8 frames, expected at least 9"), "{error}");
        std::fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn rejects_nonfinite_time() {
        let dir = folder("pvd_nan");
        let file = dir.join("results.pvd");
        let mut series = Series::new(&file);
        series.push(0.0, 0, "solid", "a.vtu");
        series.push(f64::NAN, 0, "solid", "b.vtu");
        let error = series.write().unwrap_err();
        assert!(error.to_string().contains("time at index 1 is NaN"), "{error}");
        assert!(!file.exists());
        std::fs::write(&file, "<DataSet nonsense/>\n").unwrap();
        assert!(Series::resume(&file, 1).is_err());
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
