//! Forces that move over the solid.

use super::location::Locator;
use crate::scene::solid::SolidLoad;
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use trackbed_fem::mesh::Mesh;

/// Positions at which nodal shares are computed; linear between.
const STATIONS: usize = 2000;
/// Points along and across a patch of finite size, each with an equal share.
const PATCH: usize = 4;
/// Slack of natural coordinates for points on the surface.
const SLACK: f64 = 1e-9;

/// Equal forces at fixed distances that move along a line.
pub struct MovingForce {
    force: [f64; 3],
    speed: f64,
    /// Time at which the first is at the start of the line [s].
    start: f64,
    /// Distances behind the first [m].
    behind: Vec<f64>,
    /// Distance of the stations [m].
    spacing: f64,
    /// Nodes and their shares of a force at each station.
    stations: Vec<Vec<(u32, f64)>>,
}

impl MovingForce {
    /// Resolves a load of kind `"moving"`.
    ///
    /// # Errors
    /// Missing keys, numbers out of range, a line off the solid.
    pub fn new(load: &Table<SolidLoad>, mesh: &Mesh) -> Result<MovingForce, SceneError> {
        let force = vector(&load.need("force", load.force, "a value for a moving load")?);
        let [from, to] = load.need("path", load.path, "start and end of a moving load")?.map(|p| vector(&p));
        let speed = load.need("speed", load.speed, "a value for a moving load")?.si;
        if !(speed > 0.0 && speed.is_finite()) {
            return Err(load.error("speed", speed.to_string(), "above 0"));
        }
        let length = distance(&from, &to);
        if !(length > 0.0 && length.is_finite()) {
            return Err(load.error("path", "two equal points", "two points"));
        }
        let behind: Vec<f64> = match &load.axles {
            None => vec![0.0],
            Some(axles) => axles.iter().map(|d| d.si).collect(),
        };
        let ascends = behind.first() == Some(&0.0) && behind.windows(2).all(|w| w[0] < w[1]);
        if !ascends {
            return Err(load.error("axles", format!("{behind:?}"), "distances that ascend from 0"));
        }
        let size = load.size.map_or([0.0; 2], |s| s.map(|q| q.si));
        if !size.iter().all(|s| *s >= 0.0 && s.is_finite()) {
            return Err(load.error("size", format!("{size:?}"), "two lengths of 0 or more"));
        }
        let along = [0, 1, 2].map(|d| (to[d] - from[d]) / length);
        let patch = patch(along, size);
        let locator = Locator::new(mesh, mesh.element_count());
        let spacing = length / STATIONS as f64;
        let station = |k: usize| {
            let centre = [0, 1, 2].map(|d| from[d] + along[d] * (k as f64 * spacing));
            shares(&locator, mesh, centre, &patch).ok_or_else(|| {
                let found = format!("({}, {}, {})", centre[0], centre[1], centre[2]);
                load.error("path", found, "points of the solid, with all of `size`")
            })
        };
        let stations = (0..=STATIONS).map(station).collect::<Result<_, _>>()?;
        let start = load.start.map_or(0.0, |t| t.si);
        Ok(MovingForce { force, speed, start, behind, spacing, stations })
    }

    /// Adds the forces at time `t` [s], times `factor`, shape `[3·nodes]`.
    pub fn add(&self, t: f64, factor: f64, load: &mut [f64]) {
        let first = self.speed * (t - self.start);
        for behind in &self.behind {
            let place = (first - behind) / self.spacing;
            if !(place >= 0.0 && place <= STATIONS as f64) {
                continue;
            }
            let k = (place as usize).min(STATIONS - 1);
            let share = place - k as f64;
            for (station, share) in [(k, 1.0 - share), (k + 1, share)] {
                for (node, own) in &self.stations[station] {
                    for d in 0..3 {
                        load[3 * *node as usize + d] += factor * share * own * self.force[d];
                    }
                }
            }
        }
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    [0, 1, 2].map(|d| (a[d] - b[d]) * (a[d] - b[d])).iter().sum::<f64>().sqrt()
}

/// Offsets of the points of a patch: along the line, and across it in the horizontal plane.
fn patch(along: [f64; 3], [length, width]: [f64; 2]) -> Vec<[f64; 3]> {
    let flat = (along[0] * along[0] + along[1] * along[1]).sqrt();
    let across = if flat > 0.0 { [-along[1] / flat, along[0] / flat, 0.0] } else { [1.0, 0.0, 0.0] };
    let steps = |size: f64| -> Vec<f64> {
        match size > 0.0 {
            true => (0..PATCH).map(|k| size * ((k as f64 + 0.5) / PATCH as f64 - 0.5)).collect(),
            false => vec![0.0],
        }
    };
    let (along_steps, across_steps) = (steps(length), steps(width));
    let offset = |a: f64, b: f64| [0, 1, 2].map(|d| along[d] * a + across[d] * b);
    along_steps.iter().flat_map(|a| across_steps.iter().map(move |b| offset(*a, *b))).collect()
}

/// Shares of the nodes; none off the solid.
fn shares(
    locator: &Locator<'_>,
    mesh: &Mesh,
    centre: [f64; 3],
    patch: &[[f64; 3]],
) -> Option<Vec<(u32, f64)>> {
    let mut all: Vec<(u32, f64)> = Vec::new();
    for offset in patch {
        let (e, xi) = locator.find([0, 1, 2].map(|d| centre[d] + offset[d]), SLACK)?;
        let shape = mesh.connectivity.kind(e).shape_functions(xi);
        for (node, n) in mesh.connectivity[e].iter().zip(shape) {
            let n = n / patch.len() as f64;
            match all.iter_mut().find(|(other, _)| other == node) {
                Some((_, share)) => *share += n,
                None => all.push((*node, n)),
            }
        }
    }
    all.retain(|(_, share)| *share != 0.0);
    Some(all)
}
