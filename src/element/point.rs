//! States of a test with compression positive, and the figures derived from them.

use super::file::Kind;
use serde::Serialize;
use trackbed_fem::element_test::{Curve, Sample};
use trackbed_fem::material::principal_values;

/// Peak of q: the first step within this fraction of the largest value.
const PEAK: f64 = 1e-9;

/// State of a test, compression positive.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Step, 0 at the start.
    pub step: usize,
    /// Strain xx, yy, zz, xy, yz, zx [-], engineering shear.
    pub strain: [f64; 6],
    /// Stress xx, yy, zz, xy, yz, zx [Pa].
    pub stress: [f64; 6],
    /// Plastic strain [-], engineering shear.
    pub plastic: [f64; 6],
    /// Equivalent plastic strain [-].
    pub kappa: f64,
    /// Plastic work since the start [J/m³].
    pub plastic_work: f64,
    /// Excess pore pressure [Pa] of an undrained test at constant total lateral stress, else 0.
    pub pore_pressure: f64,
    /// Deviatoric stress q [Pa].
    pub q: f64,
}

impl State {
    /// Volumetric strain [-].
    pub fn volumetric(&self) -> f64 {
        self.strain[..3].iter().sum()
    }

    /// Deviatoric strain `√(2/3 e : e)` [-].
    pub fn deviatoric(&self) -> f64 {
        (4.0 / 9.0 * square(&self.strain, 0.5)).sqrt()
    }

    /// Mean stress p [Pa].
    pub fn p(&self) -> f64 {
        self.stress[..3].iter().sum::<f64>() / 3.0
    }

    /// Mobilised friction angle [rad], if all principal stresses are compressive.
    pub fn friction(&self) -> Option<f64> {
        let [high, _, low] = principal_values(&self.stress);
        (low > 0.0).then(|| libm::asin((high - low) / (high + low)))
    }
}

/// `3 J2` of a tensor whose shear components have the factor `shear` over the tensor.
fn square(t: &[f64; 6], shear: f64) -> f64 {
    let mean = (t[0] + t[1] + t[2]) / 3.0;
    let normal: f64 = t[..3].iter().map(|x| (x - mean) * (x - mean)).sum();
    let sheared: f64 = t[3..].iter().map(|x| shear * shear * x * x).sum();
    1.5 * normal + 3.0 * sheared
}

/// States of a curve.
pub fn states(kind: Kind, curve: &Curve) -> Vec<State> {
    let lateral = -curve.samples[0].state.stress[0];
    let state = |(step, sample): (usize, &Sample)| {
        let negative = |t: [f64; 6]| t.map(|x| 0.0 - x);
        let stress = negative(sample.state.stress);
        let size = square(&stress, 1.0).sqrt();
        let extends = stress[2] < 0.5 * (stress[0] + stress[1]);
        State {
            step,
            strain: negative(sample.strain),
            stress,
            plastic: negative(sample.state.plastic_strain),
            kappa: sample.state.kappa,
            plastic_work: sample.plastic_work,
            pore_pressure: if kind == Kind::Undrained { lateral - stress[0] } else { 0.0 },
            q: if extends && is_axial(kind) { -size } else { size },
        }
    };
    curve.samples.iter().enumerate().map(state).collect()
}

/// Whether the axial strain is prescribed.
pub fn is_axial(kind: Kind) -> bool {
    matches!(kind, Kind::Triaxial | Kind::Undrained | Kind::Oedometer)
}

/// Strain of the abscissa: axial, shear, or deviatoric.
pub fn abscissa(kind: Kind, state: &State) -> f64 {
    match kind {
        Kind::SimpleShear => state.strain[5],
        Kind::Path => state.deviatoric(),
        _ => state.strain[2],
    }
}

/// Stress whose slope over the abscissa is the stiffness.
fn ordinate(kind: Kind, state: &State) -> Option<f64> {
    match kind {
        Kind::Triaxial | Kind::Undrained => Some(state.q),
        Kind::Oedometer => Some(state.stress[2]),
        Kind::SimpleShear => Some(state.stress[5]),
        Kind::Path => None,
    }
}

/// Figures of a curve [SI units, rad].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Largest absolute q [Pa].
    pub peak_q: f64,
    /// Strain of the abscissa at the peak [-].
    pub peak_strain: f64,
    /// Mobilised friction angle at the peak.
    pub friction_peak: Option<f64>,
    /// Mobilised friction angle at the end.
    pub friction_end: Option<f64>,
    /// Stiffness of the first step [Pa].
    pub stiffness_start: Option<f64>,
    /// Secant stiffness at half of the largest stress change of the first loading [Pa].
    pub stiffness_50: Option<f64>,
    /// Dilation angle of the plastic strain increment at the peak.
    pub dilation: Option<f64>,
    /// Excess pore pressure at the end [Pa].
    pub pore_pressure: Option<f64>,
    /// q over p at the end [-].
    pub stress_ratio_end: Option<f64>,
}

impl Figures {
    /// Figures of a test; `first`: steps of the first loading.
    pub fn of(kind: Kind, states: &[State], first: usize) -> Figures {
        let most = states.iter().map(|s| s.q.abs()).fold(0.0, f64::max);
        let peak = states.iter().position(|s| s.q.abs() >= most * (1.0 - PEAK)).unwrap_or(0);
        let end = &states[states.len() - 1];
        Figures {
            peak_q: most,
            peak_strain: abscissa(kind, &states[peak]),
            friction_peak: states[peak].friction(),
            friction_end: end.friction(),
            stiffness_start: stiffness_start(kind, states),
            stiffness_50: stiffness_50(kind, &states[..=first]),
            dilation: dilation(kind, states, peak),
            pore_pressure: (kind == Kind::Undrained).then_some(end.pore_pressure),
            stress_ratio_end: (end.p() > 0.0).then(|| end.q / end.p()),
        }
    }
}

fn stiffness_start(kind: Kind, states: &[State]) -> Option<f64> {
    let [first, second] = states.first_chunk()?;
    let rise = ordinate(kind, second)? - ordinate(kind, first)?;
    Some(rise / (abscissa(kind, second) - abscissa(kind, first))).filter(|x| x.is_finite())
}

fn stiffness_50(kind: Kind, states: &[State]) -> Option<f64> {
    let start = ordinate(kind, states.first()?)?;
    let change = |state: &State| ordinate(kind, state).map_or(0.0, |y| y - start);
    let most = states.iter().map(change).fold(0.0, |m: f64, y| if y.abs() > m.abs() { y } else { m });
    let half = 0.5 * most;
    let next = states.iter().position(|s| most != 0.0 && change(s) / most >= 0.5)?.max(1);
    let [before, after] = [&states[next - 1], &states[next]];
    let part = (half - change(before)) / (change(after) - change(before));
    let strain = abscissa(kind, before) + part * (abscissa(kind, after) - abscissa(kind, before));
    Some(half / strain).filter(|x| x.is_finite())
}

/// `sin ψ = d/(d − 2)` of `d`, volumetric over axial plastic strain increment in triaxial compression.
fn dilation(kind: Kind, states: &[State], peak: usize) -> Option<f64> {
    if !matches!(kind, Kind::Triaxial | Kind::Undrained) || peak == 0 {
        return None;
    }
    let change: [f64; 3] = std::array::from_fn(|k| states[peak].plastic[k] - states[peak - 1].plastic[k]);
    let ratio = change.iter().sum::<f64>() / change[2];
    (change[2] > 0.0 && ratio < 1.0).then(|| libm::asin(ratio / (ratio - 2.0))).filter(|x| x.is_finite())
}
