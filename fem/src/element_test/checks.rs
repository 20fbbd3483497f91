//! Checks of a law along a test: consistent tangent, plastic work, objectivity.

use crate::material::{Material, Point, PointState, Response};

/// Limit of the tangent's deviation from central differences over the elastic stiffness.
pub const TANGENT_LIMIT: f64 = 1e-5;
/// Limit of negative plastic work over elastic stiffness times strain increment squared.
pub const WORK_LIMIT: f64 = 1e-9;
/// Limit of the deviation of the rotated response over the size of the stress.
pub const OBJECTIVITY_LIMIT: f64 = 1e-9;
/// Step of central differences over the strain increment.
const DIFFERENCE: f64 = 1e-6;
/// Least strain increment for the step of differences.
const LEAST: f64 = 1e-5;
/// Axis and angle [rad] of the rotation.
const AXIS: [f64; 3] = [1.0, 2.0, 3.0];
const ANGLE: f64 = 0.7;

/// Consistent tangent against central differences of the stress.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TangentCheck {
    /// Largest deviation over the elastic stiffness.
    pub largest: f64,
    /// Step of the largest deviation, from 1.
    pub step: usize,
    /// Number of compared increments.
    pub compared: usize,
    /// Number of increments whose differences straddle the yield surface or two of its regions.
    pub skipped: usize,
}

/// Checks of all increments; a step of several parts has several.
#[derive(Clone, Debug, PartialEq)]
pub struct Checks {
    material: Material,
    rotation: [[f64; 3]; 3],
    /// Consistent tangent.
    pub tangent: TangentCheck,
    /// Largest negative plastic work over elastic stiffness times strain increment squared; none if the plastic
    /// strain is not of the law.
    pub negative_work: Option<f64>,
    /// Number of increments with plastic flow.
    pub plastic: usize,
    /// Largest deviation of the rotated response over the size of the stress; none for anisotropic laws.
    pub objectivity: Option<f64>,
}

/// Committed strain increment.
pub(super) struct Increment<'a> {
    pub(super) step: usize,
    pub(super) old: Point<'a>,
    pub(super) increment: &'a [f64; 6],
    pub(super) response: &'a Response,
}

impl Checks {
    pub(super) fn new(material: &Material) -> Checks {
        Checks {
            material: material.clone(),
            rotation: rotation(),
            tangent: TangentCheck::default(),
            negative_work: material.law.has_plastic_strain().then_some(0.0),
            plastic: 0,
            objectivity: material.law.is_isotropic().then_some(0.0),
        }
    }

    /// Checks an increment and returns its plastic work [J/m³].
    pub(super) fn add(&mut self, at: &Increment<'_>) -> f64 {
        let stiffness = self.stiffness(at.old);
        self.check_tangent(at, stiffness);
        self.check_objectivity(at, stiffness);
        let (new, old) = (&at.response.state, at.old.state);
        let work: f64 = (0..6).map(|k| new.stress[k] * (new.plastic_strain[k] - old.plastic_strain[k])).sum();
        self.plastic += usize::from(at.response.region.is_plastic());
        let size = largest(at.increment);
        if let Some(most) = &mut self.negative_work
            && work < 0.0
            && size > 0.0
        {
            *most = most.max(-work / (stiffness * size * size));
        }
        work
    }

    fn stiffness(&self, point: Point<'_>) -> f64 {
        largest(self.material.law.elastic_tangent(&self.material.elastic, point).as_flattened())
    }

    fn check_tangent(&mut self, at: &Increment<'_>, stiffness: f64) {
        let h = DIFFERENCE * largest(at.increment).max(LEAST);
        let mut values = vec![0.0; at.old.values.len()];
        let mut side = |j: usize, change: f64| {
            let mut strain = *at.increment;
            strain[j] += change;
            let Material { elastic, law } = &self.material;
            let response = law.update(elastic, at.old, &strain, false, &mut values).ok()?;
            (response.region == at.response.region).then_some(response.state.stress)
        };
        let mut most = 0.0_f64;
        for j in 0..6 {
            let (Some(ahead), Some(behind)) = (side(j, h), side(j, -h)) else {
                self.tangent.skipped += 1;
                return;
            };
            for i in 0..6 {
                let slope = (ahead[i] - behind[i]) / (2.0 * h);
                most = most.max((at.response.tangent[i][j] - slope).abs() / stiffness);
            }
        }
        self.tangent.compared += 1;
        if most > self.tangent.largest {
            (self.tangent.largest, self.tangent.step) = (most, at.step);
        }
    }

    fn check_objectivity(&mut self, at: &Increment<'_>, stiffness: f64) {
        let Some(most) = &mut self.objectivity else { return };
        let turn = |tensor: &[f64; 6], shear: f64| rotated(tensor, &self.rotation, shear);
        let state = PointState {
            stress: turn(&at.old.state.stress, 1.0),
            plastic_strain: turn(&at.old.state.plastic_strain, 2.0),
            kappa: at.old.state.kappa,
        };
        let mut values = vec![0.0; at.old.values.len()];
        let old = Point { state: &state, ..at.old };
        let Material { elastic, law } = &self.material;
        let expected = turn(&at.response.state.stress, 1.0);
        let size = largest(&expected).max(stiffness * largest(at.increment));
        let deviation = match law.update(elastic, old, &turn(at.increment, 2.0), false, &mut values) {
            Ok(found) => (0..6).map(|k| (found.state.stress[k] - expected[k]).abs()).fold(0.0, f64::max),
            Err(_) => f64::INFINITY,
        };
        if size > 0.0 {
            *most = most.max(deviation / size);
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Proper rotation (Rodrigues).
fn rotation() -> [[f64; 3]; 3] {
    let length = AXIS.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z] = AXIS.map(|a| a / length);
    let (sin, cos) = libm::sincos(ANGLE);
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let axis = [x, y, z];
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = f64::from(u8::from(i == j));
            cos * unit + sin * cross[i][j] + (1.0 - cos) * axis[i] * axis[j]
        })
    })
}

/// `Q T Qᵀ`; `shear`: factor of shear components over tensor components.
fn rotated(tensor: &[f64; 6], q: &[[f64; 3]; 3], shear: f64) -> [f64; 6] {
    const AT: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    let mut full = [[0.0; 3]; 3];
    for (k, &(i, j)) in AT.iter().enumerate() {
        full[i][j] = tensor[k] / if k < 3 { 1.0 } else { shear };
        full[j][i] = full[i][j];
    }
    std::array::from_fn(|k| {
        let (i, j) = AT[k];
        let mut sum = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                sum += q[i][a] * full[a][b] * q[j][b];
            }
        }
        sum * if k < 3 { 1.0 } else { shear }
    })
}
