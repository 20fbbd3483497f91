//! Evaluation of a specimen curve.

use super::Point;
use crate::runout;
use crate::system::GrainsView;
use serde::Serialize;
use trackbed_dem::bond::{Break, BreakMode};
use trackbed_input::model::grains::SpecimenPlan;

/// Test results.
#[derive(Debug, Serialize)]
pub struct SpecimenRecord {
    /// Strength [Pa]; Brazilian test: tensile strength.
    pub strength: f64,
    /// Strain at peak.
    pub peak_strain: f64,
    /// Mean confining pressure at peak [Pa].
    pub confinement: f64,
    /// Secant modulus from grain strain [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modulus: Option<f64>,
    /// Secant modulus from platen strain [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub platen_modulus: Option<f64>,
    /// Poisson's ratio in the same range.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson: Option<f64>,
    /// Final over peak stress.
    pub residual: f64,
    /// Tension cracks up to the peak.
    pub tension_cracks_at_peak: usize,
    /// Shear cracks up to the peak.
    pub shear_cracks_at_peak: usize,
    /// Crack initiation: stress at 1 % of pre-peak bond breaks, over peak.
    pub crack_initiation: f64,
    /// Tension cracks within 30° of the axis; one half if random.
    pub axial_cracks: f64,
}

/// Evaluates a curve; none without stress.
pub fn record(plan: &SpecimenPlan, curve: &[Point], view: GrainsView<'_>) -> Option<SpecimenRecord> {
    let top = curve.iter().enumerate().max_by(|a, b| a.1.stress.total_cmp(&b.1.stress))?.0;
    let peak = curve[top];
    if peak.stress <= 0.0 {
        return None;
    }
    let [low, high] = plan.between.map(|s| s * peak.stress);
    let branch: Vec<&Point> = {
        let begin = curve[..=top].iter().rposition(|p| p.stress < low).map_or(0, |k| k + 1);
        let begin = begin.min(top);
        let end = curve[begin..=top].iter().position(|p| p.stress > high).map_or(top, |k| begin + k);
        curve[begin..=end].iter().collect()
    };
    // A disc has no uniform strain.
    let slope = |x: fn(&Point) -> f64, y: fn(&Point) -> f64| slope(&branch, x, y).filter(|_| !plan.brazilian);
    let breaks = view.state.breaks();
    let by_peak = |mode: BreakMode| breaks.iter().filter(|b| b.time <= peak.time && b.mode == mode).count();
    let cracks = breaks.iter().filter(|b| b.time <= peak.time).count();
    let first = breaks.get((cracks / 100).min(breaks.len().saturating_sub(1))).map(|b| b.time);
    let at = |time: f64| curve.iter().find(|p| p.time >= time).map_or(peak.stress, |p| p.stress);
    Some(SpecimenRecord {
        strength: peak.stress,
        peak_strain: peak.strain,
        confinement: peak.confinement,
        modulus: slope(|p| p.axial, |p| p.stress),
        platen_modulus: slope(|p| p.strain, |p| p.stress),
        poisson: slope(|p| p.axial, |p| p.lateral),
        residual: curve[curve.len() - 1].stress / peak.stress,
        tension_cracks_at_peak: by_peak(BreakMode::Tension),
        shear_cracks_at_peak: by_peak(BreakMode::Shear),
        crack_initiation: first.map_or(1.0, at) / peak.stress,
        axial_cracks: axial(plan, breaks, view),
    })
}

fn axial(plan: &SpecimenPlan, breaks: &[Break], view: GrainsView<'_>) -> f64 {
    let from = runout::origins(view.model);
    let (mut along, mut all) = (0.0, 0.0_f64);
    for b in breaks.iter().filter(|b| b.mode == BreakMode::Tension) {
        let normal = from[b.bodies[1] as usize] - from[b.bodies[0] as usize];
        all += 1.0;
        along += f64::from(u8::from(normal[plan.axis].abs() < 0.5 * normal.norm()));
    }
    along / all.max(1.0)
}

fn slope(points: &[&Point], x: fn(&Point) -> f64, y: fn(&Point) -> f64) -> Option<f64> {
    let count = points.len() as f64;
    let mean = |of: fn(&Point) -> f64| points.iter().map(|p| of(p)).sum::<f64>() / count;
    let (mx, my) = (mean(x), mean(y));
    let square: f64 = points.iter().map(|p| (x(p) - mx).powi(2)).sum();
    let cross: f64 = points.iter().map(|p| (x(p) - mx) * (y(p) - my)).sum();
    (points.len() > 2 && square > 0.0).then(|| cross / square)
}

impl SpecimenRecord {
    /// Formats report lines.
    pub fn report(&self) -> Vec<String> {
        let known = |name: &str, value: Option<f64>, unit: &str| {
            value.map_or(String::new(), |v| format!(", {name} {v:.4e}{unit}"))
        };
        let mut line =
            format!("specimen: strength {:.4e} Pa at a strain of {:.3e}", self.strength, self.peak_strain);
        if self.confinement > 0.0 {
            line += &format!(" under {:.3e} Pa", self.confinement);
        }
        line += &known("modulus", self.modulus, " Pa");
        line += &known("by platens", self.platen_modulus, " Pa");
        line += &known("Poisson's ratio", self.poisson, "");
        let cracks = format!(
            "cracks at the peak: {} in tension, {} in shear; the first at {:.0} % of it; {:.0} % of the tension cracks \
             within 30° of the axis (50 % at random)",
            self.tension_cracks_at_peak,
            self.shear_cracks_at_peak,
            100.0 * self.crack_initiation,
            100.0 * self.axial_cracks
        );
        vec![line, cracks]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_by_least_squares() {
        let line =
            |k: u32| Point { axial: f64::from(k), stress: 3.0 * f64::from(k) + 1.0, ..Point::default() };
        let points: Vec<Point> = (0..5).map(line).collect();
        let points: Vec<&Point> = points.iter().collect();
        assert_eq!(slope(&points, |p| p.axial, |p| p.stress), Some(3.0));
        assert_eq!(slope(&points[..2], |p| p.axial, |p| p.stress), None);
        assert_eq!(slope(&points, |p| p.lateral, |p| p.stress), None);
    }
}
