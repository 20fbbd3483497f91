//! The formats in which a run writes its frames.
//!
//! A format is one file of this folder, with a [`Format`] that describes it and a type that is its [`Writer`], and one line
//! in [`FORMATS`](super::FORMATS). From there come the key of the scene that switches it on, the files that are cleared before a run,
//! and what of a frame is computed at all.

use std::path::Path;

use super::choice::Choice;
use super::error::WriteError;
use super::frame::Frame;

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The solid.
    Solid,
    /// The grains.
    Grains,
    /// Contacts of the grains.
    Chains,
    /// Walls and sleepers.
    Walls,
}

/// Begins a format in a folder, or goes on from a mark.
pub type Begin = fn(&Path, Option<&Mark>) -> Result<Box<dyn Writer>, WriteError>;

/// A format of result files.
#[derive(Debug)]
pub struct Format {
    /// Key of the scene's `[output]` that switches it on or off.
    pub key: &'static str,
    /// Whether it is on where the scene does not say.
    pub default: bool,
    /// What it shows. A format that shows the solid alone is refused in a scene without one.
    pub parts: &'static [Part],
    /// Folder of its frames in the folder of the results, and the endings of their names, without the dot. The number
    /// of the frame stands behind the last underscore of a name.
    pub folder: &'static str,
    /// Endings of the frames there.
    pub endings: &'static [&'static str],
    /// Its files in the folder of the results itself.
    pub files: &'static [&'static str],
    /// Begins to write into the folder of the results, or goes on after a [`Writer::mark`].
    pub begin: Begin,
}

impl Format {
    /// Whether it shows a part.
    pub fn shows(&self, part: Part) -> bool {
        self.parts.contains(&part)
    }

    /// Whether a file of [`Format::folder`] is a frame, or the beginning of one.
    pub fn is_frame(&self, file: &Path) -> bool {
        let name = file.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let name = name.strip_suffix(".part").unwrap_or(&name);
        Path::new(name).extension().is_some_and(|ending| self.endings.iter().any(|e| ending == *e))
    }
}

/// How far a writer has come, in bytes that only the writer itself reads.
pub type Mark = Vec<u8>;

/// Writes the frames of a run in one format. [`Format::begin`] makes it.
pub trait Writer {
    /// Writes a frame. All of its files are whole when this returns.
    ///
    /// # Errors
    /// A field of the wrong length or with a number that is not finite, and what the system refuses.
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError>;

    /// What a run that is resumed goes on from: every frame written so far, and none that comes later.
    fn mark(&self) -> Mark {
        Mark::new()
    }

    /// Ends the run's files.
    ///
    /// # Errors
    /// What the system refuses.
    fn end(&mut self) -> Result<(), WriteError> {
        Ok(())
    }
}

/// The writers of one run.
pub struct Writers {
    formats: Vec<&'static Format>,
    writers: Vec<Box<dyn Writer>>,
    /// Names of the fields that are written of those that may be chosen; none: all.
    fields: Option<Vec<String>>,
}

impl Writers {
    /// Begins to write into `dir`, in every one of `formats`.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn begin(dir: &Path, formats: &[&'static Format]) -> Result<Self, WriteError> {
        let writers = formats.iter().map(|format| (format.begin)(dir, None)).collect::<Result<_, _>>()?;
        Ok(Writers { formats: formats.to_vec(), writers, fields: None })
    }

    /// The same; of the fields that may be chosen these alone are written.
    #[must_use]
    pub fn only(self, fields: &Option<Vec<String>>) -> Self {
        Writers { fields: fields.clone(), ..self }
    }

    /// Goes on after the [`Writers::marks`] of an earlier run.
    ///
    /// # Errors
    /// Files that are not those of the marks; what the system refuses.
    pub fn resume(dir: &Path, formats: &[&'static Format], marks: &[Mark]) -> Result<Self, WriteError> {
        let resume = |(format, mark): (&&'static Format, &Mark)| (format.begin)(dir, Some(mark));
        let writers = formats.iter().zip(marks).map(resume).collect::<Result<_, _>>()?;
        Ok(Writers { formats: formats.to_vec(), writers, fields: None })
    }

    /// Whether any format shows a part.
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

    /// How far they have come.
    pub fn marks(&self) -> Vec<Mark> {
        self.writers.iter().map(|writer| writer.mark()).collect()
    }

    /// Ends all files.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn end(&mut self) -> Result<(), WriteError> {
        self.writers.iter_mut().try_for_each(|writer| writer.end())
    }
}

#[cfg(test)]
#[path = "writer_tests.rs"]
mod tests;
