//! ParaView frames: `results.pvd` with `.vtu` (solid) and `.vtp` (grains, force chains, walls) files.

use std::path::{Path, PathBuf};

use super::atomic;
use super::error::WriteError;
use super::frame::Frame;
use super::pvd::Series;
use super::writer::{Format, Mark, Part, Writer};
use super::{vtp, vtu};

/// VTK XML files per part and frame.
pub const FORMAT: Format = Format {
    key: "vtk",
    default: true,
    parts: &[Part::Solid, Part::Grains, Part::Chains, Part::Walls],
    folder: "frames",
    endings: &["vtu", "vtp"],
    files: &["results.pvd", SCRIPT],
    begin,
};

/// Script that shows the results with PyVista.
const SCRIPT: &str = "plot_frame.py";

struct VtkFrames {
    dir: PathBuf,
    series: Series,
}

fn begin(dir: &Path, mark: Option<&Mark>) -> Result<Box<dyn Writer>, WriteError> {
    let script = dir.join(SCRIPT);
    atomic::write(&script, |out| {
        out.write_all(include_bytes!("plot_frame.py")).map_err(WriteError::io(&script))
    })?;
    let file = dir.join("results.pvd");
    let series = match mark {
        None => Series::new(&file),
        Some(mark) => {
            let entries = mark.as_slice().try_into().map_or(0, u64::from_le_bytes);
            let series = Series::resume(&file, entries as usize)?;
            series.write()?;
            series
        }
    };
    Ok(Box::new(VtkFrames { dir: dir.to_path_buf(), series }))
}

impl Writer for VtkFrames {
    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), WriteError> {
        let Frame { number, time, .. } = *frame;
        let name = |part: &str, ending: &str| format!("{}/{part}_{number:05}.{ending}", FORMAT.folder);
        if let Some(solid) = &frame.solid {
            let name = name("solid", "vtu");
            vtu::write_solid(&self.dir.join(&name), solid, frame.fields)?;
            self.series.push(time, 0, "solid", &name);
        }
        if let Some(grains) = frame.grains {
            let name = name("grains", "vtp");
            vtp::write_grains(&self.dir.join(&name), grains, frame.fields)?;
            self.series.push(time, 1, "grains", &name);
        }
        if let Some(chains) = frame.chains {
            let name = name("chains", "vtp");
            vtp::write_chains(&self.dir.join(&name), chains)?;
            self.series.push(time, 2, "force chains", &name);
        }
        if let Some(walls) = frame.walls.filter(|walls| !walls.polygons.is_empty()) {
            let name = name("walls", "vtp");
            vtp::write_walls(&self.dir.join(&name), walls, frame.fields)?;
            self.series.push(time, 3, "walls and sleeper", &name);
        }
        self.series.write()
    }

    fn mark(&self) -> Mark {
        (self.series.entries() as u64).to_le_bytes().to_vec()
    }
}
