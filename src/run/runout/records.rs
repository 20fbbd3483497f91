//! Runout records of the summary, and report lines.

use crate::system::GrainsView;
use serde::Serialize;
use trackbed_dem::{self as dem, Vec3};

/// Runout of a slide.
#[derive(Debug, Serialize)]
pub struct RunoutRecord {
    /// Number of grains.
    pub grains: usize,
    /// Mass [kg].
    pub mass: f64,
    /// Solid volume [m³].
    pub solid_volume: f64,
    /// Mass fraction moved more than a grain diameter.
    pub moved_share: f64,
    /// Front coordinate along the slide [m].
    pub front: f64,
    /// Advance of the front [m].
    pub advance: f64,
    /// Farthest grain [m].
    pub farthest: f64,
    /// Height from head to toe [m].
    pub drop: f64,
    /// Horizontal distance from head to toe [m].
    pub length: f64,
    /// Reach angle [degrees].
    pub reach_angle: f64,
    /// Travel angle [degrees].
    pub travel_angle: f64,
    /// Initial centre of mass [m].
    pub centre_start: [f64; 3],
    /// Final centre of mass [m].
    pub centre_end: [f64; 3],
    /// Cell size of the depth map [m].
    pub cell: f64,
    /// Side of the cells of `passage.csv` [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passage_cell: Option<f64>,
    /// Deposit area in plan [m²].
    pub deposit_area: f64,
    /// Deposit length along the slide [m].
    pub deposit_length: f64,
    /// Deposit width [m].
    pub deposit_width: f64,
    /// Deposit volume with pores [m³].
    pub deposit_volume: f64,
    /// Largest depth [m].
    pub deepest: f64,
    /// Released potential energy [J].
    pub potential_released: f64,
    /// Final kinetic energy [J].
    pub kinetic_left: f64,
    /// Grains with centre below ground.
    pub below_ground: usize,
    /// Grains without ground below.
    pub beyond_ground: usize,
    /// Number of fragments, with single grains.
    pub fragments: usize,
    /// Volume fraction of the largest fragment.
    pub largest_share: f64,
    /// The largest fragments.
    pub largest: Vec<FragmentRecord>,
}

/// Bonded fragment.
#[derive(Clone, Debug, Serialize)]
pub struct FragmentRecord {
    /// Bodies.
    pub bodies: usize,
    /// Solid volume [m³].
    pub volume: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub centre: [f64; 3],
}

impl RunoutRecord {
    /// Formats report lines.
    pub fn report(&self) -> Vec<String> {
        let lost = match (self.below_ground, self.beyond_ground) {
            (0, 0) => String::new(),
            (below, beyond) => format!("; {below} grains below the ground, {beyond} beyond it"),
        };
        vec![
            format!(
                "run-out: front {:.4} m ({:.4} m on), H = {:.4} m, L = {:.4} m, reach angle {:.2}°, travel angle of the \
                 centre {:.2}°",
                self.front, self.advance, self.drop, self.length, self.reach_angle, self.travel_angle
            ),
            format!(
                "deposit: {:.4e} m², {:.4} m long, {:.4} m wide, at most {:.4} m deep, {:.4e} m³ ({:.4e} m³ of grains)",
                self.deposit_area,
                self.deposit_length,
                self.deposit_width,
                self.deepest,
                self.deposit_volume,
                self.solid_volume
            ),
            format!(
                "slide: {} fragments, largest {:.2} % of the volume; {:.1} % of the mass has moved, kinetic energy {:.3e} J of {:.3e} J released{lost}",
                self.fragments,
                100.0 * self.largest_share,
                100.0 * self.moved_share,
                self.kinetic_left,
                self.potential_released
            ),
        ]
    }
}

/// Returns the fragments of bodies, largest first.
pub fn fragments(view: GrainsView<'_>, bodies: &[usize]) -> Vec<FragmentRecord> {
    let found = dem::measure::fragments(view.model, view.state);
    let mut of: Vec<(usize, f64, f64, Vec3)> = vec![(0, 0.0, 0.0, Vec3::zeros()); found.sizes.len()];
    for &b in bodies {
        let (bodies, volume, mass, moment) = &mut of[found.of[b] as usize];
        *bodies += 1;
        *volume += view.model.volume(b);
        *mass += view.model.mass(b);
        *moment += view.state.position(b) * view.model.mass(b);
    }
    of.retain(|f| f.0 > 0);
    of.sort_by(|a, b| b.1.total_cmp(&a.1));
    let record = |(bodies, volume, mass, moment): (usize, f64, f64, Vec3)| FragmentRecord {
        bodies,
        volume,
        mass,
        centre: (moment / mass).into(),
    };
    of.into_iter().map(record).collect()
}
