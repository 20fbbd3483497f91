//! Frame formats of a run.
//!
//! A format is a file here with a [`Format`], its [`Writer`], and a line in [`FORMATS`](super::FORMATS).

use std::path::Path;

use super::choice::Choice;
use super::error::WriteError;
use super::frame::Frame;

/// Part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Solid.
    Solid,
    /// Grains.
    Grains,
    /// Grain contacts.
    Chains,
    /// Walls and sleepers.
    Walls,
}

/// Starts a format in a directory, or resumes at a mark.
pub type Begin = fn(&Path, Option<&Mark>) -> Result<Box<dyn Writer>, WriteError>;

/// Format of result files.
#[derive(Debug)]
pub struct Format {
    /// Key in the scene's `[output]`.
    pub key: &'static str,
    /// Whether it is enabled by default.
    pub default: bool,
    /// Parts written.
    pub parts: &'static [Part],
    /// Subdirectory of its frames.
    pub folder: &'static str,
    /// Extensions of the frames, without dot.
    pub endings: &'static [&'static str],
    /// Files in the results directory.
    pub files: &'static [&'static str],
    /// Starts writing, or resumes after a [`Writer::mark`].
    pub begin: Begin,
}

impl Format {
    /// Whether it writes a part.
    pub fn shows(&self, part: Part) -> bool {
        self.parts.contains(&part)
    }

    /// Whether a file of [`Format::folder`] is a (possibly unfinished) frame.
    pub fn is_frame(&self, file: &Path) -> bool {
        let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let name = name.strip_suffix(".part").unwrap_or(&name);
        Path::new(name).extension().is_some_and(|ending| self.endings.iter().any(|e| ending == *e))
    }
}

/// Position of a writer.
pub type Mark = Vec<u8>;

/// Writer of frames in one format.
pub trait Writer {
    /// Writes a frame; all files are complete on return.
    ///
    /// # Errors
    /// Wrong field length, non-finite values; I/O errors.
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError>;

    /// Returns the position for a resumed run.
    fn mark(&self) -> Mark {
        Mark::new()
    }

    /// Completes the files of a run.
    ///
    /// # Errors
    /// I/O errors.
    fn end(&mut self) -> Result<(), WriteError> {
        Ok(())
    }
}

/// Writers of a run.
pub struct Writers {
    formats: Vec<&'static Format>,
    writers: Vec<Box<dyn Writer>>,
    /// Selected optional fields; `None` for all.
    fields: Option<Vec<String>>,
}

impl Writers {
    /// Starts writing all `formats` into `dir`.
    ///
    /// # Errors
    /// I/O errors.
    pub fn begin(dir: &Path, formats: &[&'static Format]) -> Result<Self, WriteError> {
        let writers = formats.iter().map(|format| (format.begin)(dir, None)).collect::<Result<_, _>>()?;
        Ok(Writers { formats: formats.to_vec(), writers, fields: None })
    }

    /// Selects optional fields.
    #[must_use]
    pub fn only(self, fields: &Option<Vec<String>>) -> Self {
        Writers { fields: fields.clone(), ..self }
    }

    /// Resumes after the [`Writers::marks`] of an earlier run.
    ///
    /// # Errors
    /// Files that do not match the marks; I/O errors.
    pub fn resume(dir: &Path, formats: &[&'static Format], marks: &[Mark]) -> Result<Self, WriteError> {
        let resume = |(format, mark): (&&'static Format, &Mark)| (format.begin)(dir, Some(mark));
        let writers = formats.iter().zip(marks).map(resume).collect::<Result<_, _>>()?;
        Ok(Writers { formats: formats.to_vec(), writers, fields: None })
    }

    /// Whether any format writes a part.
    pub fn show(&self, part: Part) -> bool {
        self.formats.iter().any(|format| format.shows(part))
    }

    /// Writes a frame in every format.
    ///
    /// # Errors
    /// As [`Writer::frame`].
    pub fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError> {
        let frame = Frame { fields: Choice(self.fields.as_deref()), ..*frame };
        self.writers.iter_mut().try_for_each(|writer| writer.frame(&frame))
    }

    /// Returns all positions.
    pub fn marks(&self) -> Vec<Mark> {
        self.writers.iter().map(|writer| writer.mark()).collect()
    }

    /// Completes all files.
    ///
    /// # Errors
    /// I/O errors.
    pub fn end(&mut self) -> Result<(), WriteError> {
        self.writers.iter_mut().try_for_each(|writer| writer.end())
    }
}

#[cfg(test)]
#[path = "writer_tests.rs"]
mod tests;
