//! Final settlement plots.

use super::Results;
use crate::specimen::Point;
use trackbed_io::failure::Failure;
use trackbed_io::plot::{Axis, Plot};
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
        let line = |name, x: fn(&Point) -> f64| {
            (name, curve.iter().map(|p| [1e3 * x(p), 1e-6 * p.stress]).collect())
        };
        let strains = [
            line("platens", |p| p.strain),
            line("axial, of the grains", |p| p.axial),
            line("lateral, to the left", |p| -p.lateral),
        ];
        let shown = if brazilian { 1 } else { 3 };
        let title = format!("{}: stress and strain", self.job.title);
        let (x, y) = (Axis::new("strain", "1e-3"), Axis::new("stress", "MPa"));
        let plot = Plot::lines(title, x, y, strains.into_iter().take(shown));
        Ok(plot.write(&self.dir.join("specimen.svg"))?)
    }

    fn plot_lowering(&self) -> Result<(), Failure> {
        let lowering = &self.course.settlement;
        if lowering.is_empty() {
            return Ok(());
        }
        let (several, whose) = if lowering.len() > 1 { (true, "sleepers") } else { (false, "sleeper") };
        let name = |k: usize| if several { format!("sleeper {}", k + 1) } else { "sleeper".into() };
        let lines = lowering.iter().enumerate().map(|(k, points)| (name(k), points.clone()));
        let title = format!("{}: settlement of the {whose}", self.job.title);
        let plot = Plot::lines(title, Axis::new("time", "s"), Axis::new("settlement", "mm"), lines);
        Ok(plot.write(&self.dir.join("sleeper.svg"))?)
    }

    fn plot_cycles(&self) -> Result<(), Failure> {
        let cycles = self.cycles();
        if cycles.is_empty() {
            return Ok(());
        }
        let line = |name, f: fn(&Cycle) -> f64| {
            (name, cycles.iter().map(|c| [f64::from(c.number), 1e3 * f(c)]).collect())
        };
        let lines =
            [line("settlement", |c| c.settlement), line("resilient deflection", |c| c.resilient_deflection)];
        let title = format!("{}: settlement", self.job.title);
        let (x, y) = (Axis::count("load cycle"), Axis::new("settlement, deflection", "mm"));
        let plot = Plot::lines(title, x, y, lines);
        Ok(plot.write(&self.dir.join("settlement.svg"))?)
    }
}
