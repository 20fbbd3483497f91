//! What the summary holds of a slide, and its lines in the report.

use crate::run::system::GrainsView;
use serde::Serialize;
use trackbed_dem::{self as dem, Vec3};

/// How far a slide has run and what it has left.
#[derive(Debug, Serialize)]
pub struct RunoutRecord {
    /// Grains of the slide.
    pub grains: usize,
    /// Their mass [kg].
    pub mass: f64,
    /// Their volume, without pores [m³].
    pub solid_volume: f64,
    /// Share of the mass that has come farther than its own diameter.
    pub moved_share: f64,
    /// Place of the front along the direction of the slide: the share of the mass asked for lies behind it [m].
    pub front: f64,
    /// How far the front has come [m].
    pub advance: f64,
    /// Place of the farthest grain [m].
    pub farthest: f64,
    /// Height from the head to the toe [m].
    pub drop: f64,
    /// Horizontal distance from the head to the toe along the direction [m].
    pub length: f64,
    /// Angle of the line from head to toe [degrees].
    pub reach_angle: f64,
    /// Angle of the line between the centres of mass [degrees].
    pub travel_angle: f64,
    /// Centre of mass at the start [m].
    pub centre_start: [f64; 3],
    /// Centre of mass at the end [m].
    pub centre_end: [f64; 3],
    /// Side of a cell of the depth map [m].
    pub cell: f64,
    /// Area of the deposit in plan [m²].
    pub deposit_area: f64,
    /// Its extent along the direction [m].
    pub deposit_length: f64,
    /// Its extent across [m].
    pub deposit_width: f64,
    /// Volume between ground and highest grains, with pores [m³].
    pub deposit_volume: f64,
    /// Largest depth [m].
    pub deepest: f64,
    /// Potential energy set free [J].
    pub potential_released: f64,
    /// Kinetic energy at the end [J].
    pub kinetic_left: f64,
    /// Grains whose centre lies below the ground.
    pub below_ground: usize,
    /// Grains without ground under them.
    pub beyond_ground: usize,
    /// Number of fragments, single grains among them.
    pub fragments: usize,
    /// Volume of the largest fragment over that of the slide.
    pub largest_share: f64,
    /// The largest fragments.
    pub largest: Vec<FragmentRecord>,
}

/// A piece that bonds hold together.
#[derive(Clone, Debug, Serialize)]
pub struct FragmentRecord {
    /// Bodies.
    pub bodies: usize,
    /// Volume of the bodies [m³].
    pub volume: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub centre: [f64; 3],
}

impl RunoutRecord {
    /// Lines of the report.
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

/// The fragments of bodies, the largest first.
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
