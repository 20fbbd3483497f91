//! Natural domains of faces: the square [−1, 1]² and the triangle ξ, η ≥ 0, ξ + η ≤ 1.
//!
//! Square: projected Newton (Bertsekas, SIAM J. Control Optim. 20(2), 1982). Triangle: minimum of the
//! quadratic model (Nocedal and Wright, Numerical Optimization, 2nd ed. 2006, chapter 16).

use super::newton::Local;
use trackbed_fem::element::{quad8, tri6};

/// Tolerance of points on the border.
const BORDER: f64 = 1e-9;

/// Location of a point on a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// Interior.
    Inside,
    /// Side k, from corner k to corner k + 1.
    Side(u8),
    /// Corner.
    Corner(u8),
}

/// Natural domain of a face.
pub(super) trait Domain {
    /// Corners, then mid-sides, in nodal order.
    const LANDMARKS: &'static [[f64; 2]];

    /// Maps an outside point into the domain.
    fn clamp(xi: [f64; 2]) -> [f64; 2];

    /// Newton step that lowers the distance within the domain.
    fn step(here: &Local, xi: [f64; 2]) -> [f64; 2];

    /// Side or corner of a natural point, in nodal order.
    fn locate(xi: [f64; 2]) -> Location;
}

pub(super) struct Square;

impl Domain for Square {
    const LANDMARKS: &'static [[f64; 2]] = &quad8::NATURAL;

    #[inline]
    fn clamp(xi: [f64; 2]) -> [f64; 2] {
        [xi[0].clamp(-1.0, 1.0), xi[1].clamp(-1.0, 1.0)]
    }

    #[inline]
    fn step(here: &Local, xi: [f64; 2]) -> [f64; 2] {
        let g = here.gradient;
        let held = [0, 1].map(|a| (xi[a] >= 1.0 && g[a] < 0.0) || (xi[a] <= -1.0 && g[a] > 0.0));
        let (full, definite) = here.hessian();
        let along = |a: usize| -g[a] / if full[a] > 0.0 { full[a] } else { here.metric[a] };
        match held {
            [true, true] => [0.0, 0.0],
            [true, false] => [0.0, along(1)],
            [false, true] => [along(0), 0.0],
            [false, false] => here.free_step(if definite { full } else { here.metric }),
        }
    }

    #[inline]
    fn locate(xi: [f64; 2]) -> Location {
        let low = xi.map(|c| c <= -1.0 + BORDER);
        let high = xi.map(|c| c >= 1.0 - BORDER);
        match (low[0], high[0], low[1], high[1]) {
            (true, _, true, _) => Location::Corner(0),
            (_, true, true, _) => Location::Corner(1),
            (_, true, _, true) => Location::Corner(2),
            (true, _, _, true) => Location::Corner(3),
            (_, _, true, _) => Location::Side(0),
            (_, true, _, _) => Location::Side(1),
            (_, _, _, true) => Location::Side(2),
            (true, _, _, _) => Location::Side(3),
            _ => Location::Inside,
        }
    }
}

pub(super) struct Triangle;

/// Start and direction of each side of [`Triangle`].
const SIDES: [([f64; 2], [f64; 2]); 3] =
    [([0.0, 0.0], [1.0, 0.0]), ([1.0, 0.0], [-1.0, 1.0]), ([0.0, 1.0], [0.0, -1.0])];

impl Domain for Triangle {
    const LANDMARKS: &'static [[f64; 2]] = &tri6::NATURAL;

    #[inline]
    fn clamp(xi: [f64; 2]) -> [f64; 2] {
        let xi = xi.map(|c| c.max(0.0));
        let sum = xi[0] + xi[1];
        if sum > 1.0 { xi.map(|c| c / sum) } else { xi }
    }

    #[inline]
    fn step(here: &Local, xi: [f64; 2]) -> [f64; 2] {
        let (full, definite) = here.hessian();
        let h = if definite { full } else { here.metric };
        let free = here.free_step(h);
        let end = [xi[0] + free[0], xi[1] + free[1]];
        let beyond = [end[1] < 0.0, end[0] + end[1] > 1.0, end[0] < 0.0];
        if !beyond.contains(&true) {
            return free;
        }
        let g = here.gradient;
        let times = |d: [f64; 2]| [h[0] * d[0] + h[2] * d[1], h[2] * d[0] + h[1] * d[1]];
        let mut best = (f64::INFINITY, [0.0; 2]);
        for ((start, along), _) in SIDES.iter().zip(beyond).filter(|(_, beyond)| *beyond) {
            let d = [start[0] - xi[0], start[1] - xi[1]];
            let (hd, ha) = (times(d), times(*along));
            let slope = along[0] * (g[0] + hd[0]) + along[1] * (g[1] + hd[1]);
            let t = (-slope / (along[0] * ha[0] + along[1] * ha[1])).clamp(0.0, 1.0);
            let d = [d[0] + t * along[0], d[1] + t * along[1]];
            let hd = times(d);
            let value = d[0] * (g[0] + 0.5 * hd[0]) + d[1] * (g[1] + 0.5 * hd[1]);
            if value < best.0 {
                best = (value, d);
            }
        }
        best.1
    }

    #[inline]
    fn locate(xi: [f64; 2]) -> Location {
        match (xi[1] <= BORDER, xi[0] + xi[1] >= 1.0 - BORDER, xi[0] <= BORDER) {
            (true, _, true) => Location::Corner(0),
            (true, true, _) => Location::Corner(1),
            (_, true, true) => Location::Corner(2),
            (true, _, _) => Location::Side(0),
            (_, true, _) => Location::Side(1),
            (_, _, true) => Location::Side(2),
            _ => Location::Inside,
        }
    }
}
