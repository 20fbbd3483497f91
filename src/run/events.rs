//! Acoustic events: bond breaks clustered in space and time, with magnitudes and b-value.
//!
//! Magnitude M = (lg E − 4.8)/1.5, E the released energy [J] (Gutenberg and Richter 1956). lg N = a − b M;
//! maximum likelihood b with bin width Δ: lg e/(mean M − (M_c − Δ/2)) for events from M_c, standard error 2.3
//! b² s/√n (Shi and Bolt, Bull. Seism. Soc. Am. 72, 1982). M_c: most frequent bin (Wiemer and Wyss 2000).
//! Clustering: Hazzard and Young, Int. J. Rock Mech. 37, 2000.
//!
//! Theory manual: equation (6.41) of `docs/theory/track.md`.

use serde::Serialize;
use std::f64::consts::LOG10_E;
use std::path::Path;
use trackbed_dem::Vec3;
use trackbed_dem::bond::{Break, BreakMode};
use trackbed_input::model::grains::EventPlan;
use trackbed_io::columns::events;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::{Field, write_table};

const BIN: f64 = 0.1;
const FEWEST: usize = 50;

/// Acoustic event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time of the first break [s].
    pub time: f64,
    /// Duration to the last break [s].
    pub duration: f64,
    /// Energy-weighted mean position [m].
    pub place: Vec3,
    /// Number of breaks.
    pub breaks: usize,
    /// Number of shear breaks.
    pub shear: usize,
    /// Released energy [J].
    pub energy: f64,
}

impl Event {
    /// Returns the magnitude.
    pub fn magnitude(&self) -> f64 {
        (libm::log10(self.energy) - 4.8) / 1.5
    }
}

/// Events of a run.
#[derive(Debug, Serialize)]
pub struct EventRecord {
    /// Events with released energy.
    pub count: usize,
    /// Breaks of the largest event.
    pub most_breaks: usize,
    /// Smallest and largest magnitude.
    pub magnitudes: [f64; 2],
    /// Magnitude of completeness.
    pub complete_from: f64,
    /// Number of complete events.
    pub complete: usize,
    /// b-value; none for fewer than 50 events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b_value: Option<f64>,
    /// Standard error of b.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b_error: Option<f64>,
}

const EVENTS: [Field<Event>; 9] = [
    (events::TIME, |e| e.time),
    (events::DURATION, |e| e.duration),
    (events::X, |e| e.place.x),
    (events::Y, |e| e.place.y),
    (events::Z, |e| e.place.z),
    (events::BREAKS, |e| e.breaks as f64),
    (events::SHEAR, |e| e.shear as f64),
    (events::ENERGY, |e| e.energy),
    (events::MAGNITUDE, Event::magnitude),
];

/// Clusters breaks and writes `events.csv`; none without breaks.
///
/// # Errors
/// I/O errors.
pub fn record(dir: &Path, breaks: &[Break], plan: Option<EventPlan>) -> Result<Option<EventRecord>, Failure> {
    let events: Vec<Event> = joined(breaks, plan).into_iter().filter(|e| e.energy > 0.0).collect();
    write_table(&dir.join("events.csv"), &EVENTS, &events)?;
    if events.is_empty() {
        return Ok(None);
    }
    let magnitudes: Vec<f64> = events.iter().map(Event::magnitude).collect();
    let (from, above, b) = b_value(&magnitudes);
    Ok(Some(EventRecord {
        count: events.len(),
        most_breaks: events.iter().map(|e| e.breaks).max().unwrap_or(0),
        magnitudes: [
            magnitudes.iter().copied().fold(f64::INFINITY, f64::min),
            magnitudes.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ],
        complete_from: from,
        complete: above,
        b_value: b.map(|(b, _)| b),
        b_error: b.map(|(_, error)| error),
    }))
}

/// A break joins an event near any of its breaks in distance and time.
fn joined(breaks: &[Break], plan: Option<EventPlan>) -> Vec<Event> {
    let mut parent: Vec<usize> = (0..breaks.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    if let Some(plan) = plan {
        let mut first = 0;
        for k in 0..breaks.len() {
            while breaks[k].time - breaks[first].time > plan.time {
                first += 1;
            }
            for j in first..k {
                if (breaks[k].place - breaks[j].place).norm() <= plan.distance {
                    let (a, b) = (root(&mut parent, j), root(&mut parent, k));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
    }
    let mut number = vec![usize::MAX; breaks.len()];
    let mut events: Vec<Event> = Vec::new();
    for (k, b) in breaks.iter().enumerate() {
        let first = root(&mut parent, k);
        if first == k {
            number[k] = events.len();
            events.push(Event {
                time: b.time,
                duration: 0.0,
                place: Vec3::zeros(),
                breaks: 0,
                shear: 0,
                energy: 0.0,
            });
        }
        let event = &mut events[number[first]];
        event.duration = b.time - event.time;
        event.place += b.place * b.energy;
        event.breaks += 1;
        event.shear += usize::from(b.mode == BreakMode::Shear);
        event.energy += b.energy;
    }
    events.iter_mut().filter(|e| e.energy > 0.0).for_each(|e| e.place /= e.energy);
    events
}

fn b_value(magnitudes: &[f64]) -> (f64, usize, Option<(f64, f64)>) {
    let bin = |m: f64| (m / BIN).round() as i64;
    let mut counts = std::collections::BTreeMap::new();
    magnitudes.iter().for_each(|m| *counts.entry(bin(*m)).or_insert(0_usize) += 1);
    // The lowest bin on ties.
    let most = counts.iter().max_by(|a, b| a.1.cmp(b.1).then(b.0.cmp(a.0))).map_or(0, |(k, _)| *k);
    let from = most as f64 * BIN;
    let above: Vec<f64> = magnitudes.iter().copied().filter(|m| bin(*m) >= most).collect();
    let n = above.len() as f64;
    if above.len() < FEWEST {
        return (from, above.len(), None);
    }
    let mean = above.iter().sum::<f64>() / n;
    let b = LOG10_E / (mean - (from - 0.5 * BIN));
    let scatter = above.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n * (n - 1.0));
    (from, above.len(), Some((b, std::f64::consts::LN_10 * b * b * scatter.sqrt())))
}

impl EventRecord {
    /// Formats a report line.
    pub fn report(&self) -> String {
        let b = match (self.b_value, self.b_error) {
            (Some(b), Some(error)) => format!(", b-value {b:.2} ± {error:.2} from {} of them", self.complete),
            _ => String::new(),
        };
        format!(
            "acoustic events: {}, magnitudes {:.2} to {:.2}{b}",
            self.count, self.magnitudes[0], self.magnitudes[1]
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn broken(time: f64, x: f64, energy: f64) -> Break {
        Break {
            time,
            bond: 0,
            bodies: [0, 1],
            place: Vec3::new(x, 0.0, 0.0),
            mode: BreakMode::Tension,
            energy,
        }
    }

    #[test]
    fn clusters_neighbours_in_space_and_time() {
        let breaks = [
            broken(0.0, 0.0, 1.0),
            broken(0.5, 1.0, 3.0),
            broken(0.6, 9.0, 1.0),
            broken(1.2, 2.0, 1.0),
            broken(3.0, 2.0, 1.0),
        ];
        let events = joined(&breaks, Some(EventPlan { distance: 1.0, time: 1.0 }));
        let found: Vec<(usize, f64)> = events.iter().map(|e| (e.breaks, e.energy)).collect();
        assert_eq!(found, [(3, 5.0), (1, 1.0), (1, 1.0)]);
        assert_eq!((events[0].place.x, events[0].duration), (1.0, 1.2));
        assert_eq!(joined(&breaks, None).len(), 5);
    }

    #[test]
    fn b_values_of_known_laws() {
        let mut seed = 1_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        for b in [0.7, 1.0, 1.5] {
            let drawn: Vec<f64> = (0..5000).map(|_| -9.05 - libm::log10(random()) / b).collect();
            let (from, count, found) = b_value(&drawn);
            let (found, error) = found.unwrap();
            println!("b {b}: {found:.3} ± {error:.3} from {count}, M_c {from:.2}");
            assert!((found - b).abs() < 3.0 * error && error < 0.05 * b, "{b} {found} {error}");
        }
        assert!(b_value(&[-9.0; 20]).2.is_none());
    }

    #[test]
    fn magnitude_of_an_energy() {
        let event = &joined(&[broken(0.0, 0.0, libm::pow(10.0, 4.8))], None)[0];
        assert!(event.magnitude().abs() < 1e-12);
    }
}
