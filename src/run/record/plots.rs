//! Final settlement plots.

use super::Results;
use crate::specimen::Point;
use trackbed_io::failure::Failure;
use trackbed_io::write::svg::{LinePlot, Series};
use trackbed_track::cycles::Cycle;

impl Results<'_> {
    /// Draws settlement curves.
    ///
    /// # Errors
    /// I/O errors.
    pub fn plot_settlement(&self) -> Result<(), Failure> {
        self.plot_lowering()?;
        self.plot_cycles()
    }

    /// Draws `specimen.svg`.
    ///
    /// # Errors
    /// I/O errors.
    pub fn plot_specimen(&self, brazilian: bool) -> Result<(), Failure> {
        let curve = &self.course.specimen;
        let series = |name: &str, x: fn(&Point) -> f64| Series {
            name: name.into(),
            points: curve.iter().map(|p| [1e3 * x(p), 1e-6 * p.stress]).collect(),
        };
        let mut curves = vec![series("platens", |p| p.strain)];
        if !brazilian {
            curves.push(series("axial, of the grains", |p| p.axial));
            curves.push(series("lateral, to the left", |p| -p.lateral));
        }
        let plot = LinePlot {
            title: format!("{}: stress and strain", self.job.title),
            x_label: "strain [1e-3]".into(),
            y_label: "stress [MPa]".into(),
            series: curves,
        };
        Ok(plot.write(&self.dir.join("specimen.svg"))?)
    }

    fn plot_lowering(&self) -> Result<(), Failure> {
        let lowering = &self.course.settlement;
        if lowering.is_empty() {
            return Ok(());
        }
        let (several, whose) = if lowering.len() > 1 { (true, "sleepers") } else { (false, "sleeper") };
        let name = |k: usize| if several { format!("sleeper {}", k + 1) } else { "sleeper".into() };
        let series = lowering.iter().enumerate();
        let plot = LinePlot {
            title: format!("{}: settlement of the {whose}", self.job.title),
            x_label: "time [s]".into(),
            y_label: "settlement [mm]".into(),
            series: series.map(|(k, points)| Series { name: name(k), points: points.clone() }).collect(),
        };
        Ok(plot.write(&self.dir.join("sleeper.svg"))?)
    }

    fn plot_cycles(&self) -> Result<(), Failure> {
        let cycles = self.cycles();
        if cycles.is_empty() {
            return Ok(());
        }
        let series = |name: &str, f: fn(&Cycle) -> f64| Series {
            name: name.into(),
            points: cycles.iter().map(|c| [f64::from(c.number), 1e3 * f(c)]).collect(),
        };
        let plot = LinePlot {
            title: format!("{}: settlement", self.job.title),
            x_label: "load cycle".into(),
            y_label: "[mm]".into(),
            series: vec![
                series("settlement", |c| c.settlement),
                series("resilient deflection", |c| c.resilient_deflection),
            ],
        };
        Ok(plot.write(&self.dir.join("settlement.svg"))?)
    }
}
