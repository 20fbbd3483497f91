//! Return to the Mohr–Coulomb surface with Rankine cut-off, in principal stresses at fixed strength.
//!
//! Each region is an affine piece of the surface with a cone of flow directions. Regions are disjoint for
//! `0 <= psi <= phi`; at `psi = 0` the apex region is a half-space.
//!
//! Source: Clausen, Damkilde and Andersen (2006, 2007) (lines, points); de Souza Neto, Peric and Owen (2008),
//! section 8.2.

use super::elastic::Elastic;
use super::point::ReturnRegion;

#[derive(Clone, Copy)]
pub(super) struct Moduli {
    pub lambda: f64,
    pub mu: f64,
    /// `lambda / (3 lambda + 2 mu)`, so that `2 mu D^-1 x = x - ratio tr(x)`.
    ratio: f64,
}

impl Moduli {
    pub fn new(elastic: &Elastic) -> Moduli {
        let (lambda, mu) = elastic.lame();
        Moduli { lambda, mu, ratio: lambda / (3.0 * lambda + 2.0 * mu) }
    }

    fn stress(&self, x: &[f64; 3]) -> [f64; 3] {
        let mean = self.lambda * (x[0] + x[1] + x[2]);
        x.map(|x| mean + 2.0 * self.mu * x)
    }

    /// `2 mu D^-1 x`.
    pub fn scaled_strain(&self, x: &[f64; 3]) -> [f64; 3] {
        let mean = self.ratio * (x[0] + x[1] + x[2]);
        x.map(|x| x - mean)
    }
}

/// Strength at `kappa` and its derivatives (`_rate`).
///
/// Plane: `a s1 - b s3 = k` with `a = 1 + sin(phi)`, `b = 1 - sin(phi)`, `k = 2 c cos(phi)`; flow with psi.
#[derive(Clone, Copy)]
pub(super) struct Strength {
    pub sin: f64,
    pub a: f64,
    pub b: f64,
    pub k: f64,
    pub sin_rate: f64,
    pub k_rate: f64,
    /// `1 + sin(psi)` and `1 - sin(psi)`.
    pub flow_a: f64,
    pub flow_b: f64,
    /// Cut-off, if below the apex.
    pub tension: Option<f64>,
}

impl Strength {
    pub fn new(cohesion: (f64, f64), friction: (f64, f64), sin_psi: f64, tension: Option<f64>) -> Strength {
        let ((c, c_rate), (phi, phi_rate)) = (cohesion, friction);
        let (sin, cos) = libm::sincos(phi);
        let k = 2.0 * c * cos;
        Strength {
            sin,
            a: 1.0 + sin,
            b: 1.0 - sin,
            k,
            sin_rate: cos * phi_rate,
            k_rate: 2.0 * (c_rate * cos - c * sin * phi_rate),
            flow_a: 1.0 + sin_psi,
            flow_b: 1.0 - sin_psi,
            tension: tension.filter(|t| 2.0 * t * sin < k),
        }
    }

    /// `a s1 - b s3 - k` [Pa], twice the usual yield function.
    pub fn plane(&self, s: &[f64; 3]) -> f64 {
        self.a * s[0] - self.b * s[2] - self.k
    }

    /// `s3` at plane and cut-off `t`.
    fn corner(&self, t: f64) -> f64 {
        (self.a * t - self.k) / self.b
    }
}

/// Best region; margin [Pa]: smallest condition.
struct ReturnCandidate {
    stress: [f64; 3],
    region: ReturnRegion,
    margin: f64,
}

impl ReturnCandidate {
    #[inline(always)]
    fn offer(&mut self, region: ReturnRegion, stress: [f64; 3], conditions: [f64; 4]) -> bool {
        let margin = conditions[0].min(conditions[1]).min(conditions[2].min(conditions[3]));
        if margin > self.margin {
            *self = ReturnCandidate { stress, region, margin };
        }
        margin >= 0.0
    }
}

pub(super) fn project(trial: &[f64; 3], strength: &Strength, moduli: &Moduli) -> ([f64; 3], ReturnRegion) {
    let mut choice =
        ReturnCandidate { stress: *trial, region: ReturnRegion::Elastic, margin: f64::NEG_INFINITY };
    let _ = plane_and_edges(trial, strength, moduli, &mut choice)
        || match strength.tension {
            Some(t) => tension_cutoff(t, trial, strength, moduli, &mut choice),
            None => apex(trial, strength, moduli, &mut choice),
        };
    (choice.stress, choice.region)
}

/// `2 mu` times the plastic strain.
fn flow(moduli: &Moduli, trial: &[f64; 3], s: &[f64; 3]) -> [f64; 3] {
    moduli.scaled_strain(&[trial[0] - s[0], trial[1] - s[1], trial[2] - s[2]])
}

fn dot(x: &[f64; 3], y: &[f64; 3]) -> f64 {
    x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
}

fn plane_and_edges(trial: &[f64; 3], q: &Strength, moduli: &Moduli, choice: &mut ReturnCandidate) -> bool {
    let cut = q.tension.unwrap_or(f64::INFINITY);
    // s1 follows from s3, so that large steps stay on the surface.
    let r = moduli.stress(&[q.flow_a, 0.0, -q.flow_b]);
    let f = q.plane(trial);
    let multiplier = f / (q.a * r[0] - q.b * r[2]);
    let s3 = trial[2] - multiplier * r[2];
    let s = [(q.b * s3 + q.k) / q.a, trial[1] - multiplier * r[1], s3];
    if choice.offer(ReturnRegion::Plane, s, [f, s[0] - s[1], s[1] - s[2], cut - s[0]]) {
        return true;
    }
    let (start, slope) = (q.k / q.a, q.b / q.a);
    let u = moduli.scaled_strain(&[q.flow_b, q.flow_b, q.flow_a]);
    let s3 = (dot(&u, trial) - (u[0] + u[1]) * start) / ((u[0] + u[1]) * slope + u[2]);
    let s1 = start + slope * s3;
    let s = [s1, s1, s3];
    let e = flow(moduli, trial, &s);
    if choice.offer(ReturnRegion::EdgeCompression, s, [e[1], -e[2], s1 - s3, cut - s1]) {
        return true;
    }
    let u = moduli.scaled_strain(&[q.flow_b, q.flow_a, q.flow_a]);
    let s3 = (dot(&u, trial) - u[0] * start) / (u[0] * slope + u[1] + u[2]);
    let s1 = start + slope * s3;
    let s = [s1, s3, s3];
    let e = flow(moduli, trial, &s);
    choice.offer(ReturnRegion::EdgeExtension, s, [-e[1], e[0], s1 - s3, cut - s1])
}

fn apex(trial: &[f64; 3], q: &Strength, moduli: &Moduli, choice: &mut ReturnCandidate) -> bool {
    if q.sin == 0.0 {
        return false;
    }
    let s = [q.k / (2.0 * q.sin); 3];
    let e = flow(moduli, trial, &s);
    let (low, high) = (q.flow_b, q.flow_a);
    let compression = low * (e[0] + e[1]) + high * e[2];
    let extension = low * e[0] + high * (e[1] + e[2]);
    choice.offer(ReturnRegion::Apex, s, [compression, extension, compression, extension])
}

fn tension_cutoff(
    t: f64,
    trial: &[f64; 3],
    q: &Strength,
    moduli: &Moduli,
    choice: &mut ReturnCandidate,
) -> bool {
    let s3 = q.corner(t);
    let steep = q.flow_a / q.flow_b;
    let drop = (trial[0] - t) * moduli.lambda / (moduli.lambda + 2.0 * moduli.mu);
    let s = [t, trial[1] - drop, trial[2] - drop];
    if choice.offer(ReturnRegion::TensionPlane, s, [trial[0] - t, t - s[1], s[2] - s3, trial[0] - t]) {
        return true;
    }
    let (d1, d3) = (trial[0] - t, trial[2] - s3);
    let drop = 0.5 * moduli.lambda / (moduli.lambda + moduli.mu) * (d1 + d3);
    let s = [t, trial[1] - drop, s3];
    let (e1, e3) = (d1 - drop, d3 - drop);
    if choice.offer(ReturnRegion::PlaneTension, s, [-e3, e1 + steep * e3, t - s[1], s[1] - s3]) {
        return true;
    }
    let (d1, d2) = (trial[0] - t, trial[1] - t);
    let drop = 0.5 * moduli.lambda / (moduli.lambda + moduli.mu) * (d1 + d2);
    let s = [t, t, trial[2] - drop];
    if choice.offer(ReturnRegion::TensionEdge, s, [d2 - drop, d1 - drop, t - s[2], s[2] - s3]) {
        return true;
    }
    let s = [t, t, s3];
    let e = flow(moduli, trial, &s);
    if choice.offer(ReturnRegion::EdgeCompressionTension, s, [-e[2], e[1], e[0], e[0] + e[1] + steep * e[2]])
    {
        return true;
    }
    let s = [t, s3, s3];
    let e = flow(moduli, trial, &s);
    if choice.offer(ReturnRegion::EdgeExtensionTension, s, [-e[1], -e[2], e[0], e[0] + steep * (e[1] + e[2])])
    {
        return true;
    }
    let s = [t; 3];
    let e = flow(moduli, trial, &s);
    choice.offer(ReturnRegion::TensionCorner, s, [e[2], e[1], e[0], e[2]])
}

/// Equal pairs of principal stresses: (1,2) and (2,3).
pub(super) fn equal_pairs(region: ReturnRegion) -> (bool, bool) {
    match region {
        ReturnRegion::EdgeCompression | ReturnRegion::TensionEdge | ReturnRegion::EdgeCompressionTension => {
            (true, false)
        }
        ReturnRegion::EdgeExtension | ReturnRegion::EdgeExtensionTension => (false, true),
        ReturnRegion::Apex | ReturnRegion::TensionCorner => (true, true),
        _ => (false, false),
    }
}

/// Velocity of the surface with `kappa` at `s`.
fn drift(region: ReturnRegion, s: &[f64; 3], q: &Strength) -> [f64; 3] {
    // a' = sin', b' = -sin'.
    let along_s1 = (q.k_rate - q.sin_rate * (s[0] + s[2])) / q.a;
    let corner = (q.sin_rate * (s[0] + s[2]) - q.k_rate) / q.b;
    match region {
        ReturnRegion::EdgeCompression => [along_s1, along_s1, 0.0],
        ReturnRegion::EdgeExtension => [along_s1, 0.0, 0.0],
        ReturnRegion::Apex => [(q.k_rate - 2.0 * s[0] * q.sin_rate) / (2.0 * q.sin); 3],
        ReturnRegion::PlaneTension | ReturnRegion::EdgeCompressionTension => [0.0, 0.0, corner],
        ReturnRegion::EdgeExtensionTension => [0.0, corner, corner],
        _ => [0.0; 3],
    }
}

/// Direction `l` of a line and `w`, orthogonal to the flow.
fn line(region: ReturnRegion, q: &Strength) -> Option<([f64; 3], [f64; 3])> {
    match region {
        ReturnRegion::EdgeCompression => Some(([q.b, q.b, q.a], [q.flow_b, q.flow_b, q.flow_a])),
        ReturnRegion::EdgeExtension => Some(([q.b, q.a, q.a], [q.flow_b, q.flow_a, q.flow_a])),
        ReturnRegion::PlaneTension => Some(([0.0, 1.0, 0.0], [0.0, 1.0, 0.0])),
        ReturnRegion::TensionEdge => Some(([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])),
        _ => None,
    }
}

/// Derivative of the returned stress by `kappa` at fixed trial.
pub(super) fn rate(region: ReturnRegion, s: &[f64; 3], q: &Strength, moduli: &Moduli) -> [f64; 3] {
    if region == ReturnRegion::Plane {
        let r = moduli.stress(&[q.flow_a, 0.0, -q.flow_b]);
        let multiplier = (q.k_rate - q.sin_rate * (s[0] + s[2])) / (q.a * r[0] - q.b * r[2]);
        return r.map(|r| r * multiplier);
    }
    let mut rate = drift(region, s, q);
    if let Some((l, w)) = line(region, q) {
        let u = moduli.scaled_strain(&w);
        let back = dot(&u, &rate) / dot(&u, &l);
        for i in 0..3 {
            rate[i] -= l[i] * back;
        }
    }
    rate
}

/// `A[i][j] = d s_i / d e_j` at fixed strength, `e` trial principal strain.
pub(super) fn tangent(region: ReturnRegion, q: &Strength, moduli: &Moduli) -> [[f64; 3]; 3] {
    if let Some((l, w)) = line(region, q) {
        let scale = 2.0 * moduli.mu / dot(&moduli.scaled_strain(&w), &l);
        return l.map(|l| w.map(|w| scale * l * w));
    }
    let elastic: [[f64; 3]; 3] =
        std::array::from_fn(|i| moduli.stress(&std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 })));
    let (normal, flow) = match region {
        ReturnRegion::Elastic => return elastic,
        ReturnRegion::Plane => ([q.a, 0.0, -q.b], [q.flow_a, 0.0, -q.flow_b]),
        ReturnRegion::TensionPlane => ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
        _ => return [[0.0; 3]; 3],
    };
    let (r, n) = (moduli.stress(&flow), moduli.stress(&normal));
    let scale = 1.0 / dot(&normal, &r);
    std::array::from_fn(|i| std::array::from_fn(|j| elastic[i][j] - scale * r[i] * n[j]))
}
