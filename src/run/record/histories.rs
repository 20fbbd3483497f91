//! Recorders of `history.csv`.

use super::solid_probes;
use crate::packing;
use crate::recorder::{Now, Recorder};
use crate::system::{GrainsView, System};
use trackbed_dem as dem;
use trackbed_input::model::Observed;
use trackbed_io::columns::history;
use trackbed_io::write::csv::Row;

/// Position, load and shape of sleepers.
pub struct Sleepers;

impl<S: System> Recorder<S> for Sleepers {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        for k in 0..now.track.count() {
            let Some(sleeper) = now.track.sleeper(k, now.time, now.system) else { continue };
            let number = number(now, k);
            row.put(history::LOAD.of(&number), sleeper.load);
            row.vector(history::SLEEPER.of(&number), sleeper.place);
            row.put(history::SLEEPER_TILT.of(&number), sleeper.tilt);
            if let Some(meshed) = sleeper.meshed {
                row.put(history::SLEEPER_SEATS.of(&number), meshed.moved.seats);
                row.put(history::SLEEPER_BEND.of(&number), meshed.moved.bend);
                row.vector(history::SLEEPER_CONTACT.of(&number), meshed.contact);
            }
        }
    }
}

fn number<S>(now: &Now<'_, S>, k: usize) -> String {
    if now.track.count() > 1 { format!("_{}", k + 1) } else { String::new() }
}

/// Forces between grains and solid.
pub struct Interface;

impl<S: System> Recorder<S> for Interface {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        if now.system.grains().is_some() && now.system.solid().is_some() {
            row.vector(history::CONTACT_FORCE_ON_SOLID, now.system.contact_force());
            row.put(history::PEAK_FORMATION_PRESSURE, now.system.peak_pressure());
        }
    }
}

/// Stored energies, work and dissipation.
pub struct Energies;

impl<S> Recorder<S> for Energies {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (stored, spent) = (&now.balance.now, &now.balance.spent);
        let in_solid = spent.rayleigh + spent.absorbed + spent.plastic + spent.numerical;
        row.put(history::GRAINS_KINETIC, stored.grains_kinetic);
        row.put(history::CONTACT_SPRINGS, stored.contact_springs);
        row.put(history::GRAINS_GRAVITY, stored.grains_gravity);
        row.put(history::SOLID_KINETIC, stored.solid_kinetic);
        row.put(history::SOLID_STRAIN, stored.solid_strain);
        row.put(history::SOLID_GRAVITY, stored.solid_gravity);
        row.put(history::WORK, spent.work());
        row.put(history::DISSIPATED_DASHPOT, spent.dashpot);
        row.put(history::DISSIPATED_FRICTION, spent.friction);
        row.put(history::DISSIPATED_SOLID, in_solid);
        row.put(history::INTERFACE_ERROR, spent.interface());
        row.put(history::ENERGY_ERROR, now.balance.error());
    }
}

/// Deflections and energies of rails.
pub struct Rails;

impl<S> Recorder<S> for Rails {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        if !now.track.has_rails() {
            return;
        }
        for k in 0..now.track.count() {
            row.put(history::RAIL.of(&number(now, k)), now.track.rail_deflection(k));
        }
        for (k, force) in now.track.axle_forces().enumerate() {
            row.put(history::AXLE_FORCE.of(&format!("_{}", k + 1)), force);
        }
        let (stored, spent) = (&now.balance.now, &now.balance.spent);
        row.put(history::RAIL_ENERGY, stored.rail);
        row.put(history::WHEELS_WORK, spent.wheels);
        row.put(history::DISSIPATED_TRACK, spent.pads + spent.far_field_track);
    }
}

/// Sums of the reactions of named supports.
pub struct Supports;

impl<S: System> Recorder<S> for Supports {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        if let Some(part) = now.job.solid.as_ref().filter(|part| !part.supports.named.is_empty())
            && let Some(reactions) = now.system.reactions()
        {
            for (name, force) in part.named_sums(&reactions) {
                row.vector(history::SUPPORT_REACTION.of(name), force);
            }
        }
    }
}

/// Fields of observed nodes, points and boxes, means of observed grains.
pub struct Probes;

impl<S: System> Recorder<S> for Probes {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        for (name, observed) in &now.job.probes {
            match (observed, now.system.solid(), now.system.grains()) {
                (Observed::Node(node), Some(solid), _) => {
                    let of_node = |field: &[f64]| [field[3 * node], field[3 * node + 1], field[3 * node + 2]];
                    row.vector(history::PROBE_U.of(name), of_node(&solid.state.u));
                    row.vector(history::PROBE_V.of(name), of_node(&solid.state.v));
                }
                (Observed::Grain(_) | Observed::Group(_) | Observed::Region(_), _, Some(view)) => {
                    of_grains(name, observed, view, row);
                }
                (_, Some(view), _) => solid_probes::record(name, observed, view, row),
                _ => {}
            }
        }
    }
}

/// Position, velocity and angular velocity weighted by mass, stress by volume.
fn of_grains(name: &str, observed: &Observed, view: GrainsView<'_>, row: &mut Row) {
    let GrainsView { model, state } = view;
    let seen = |b: usize| match observed {
        Observed::Grain(grain) => b == *grain,
        Observed::Group(part) => model.part(b) == *part,
        Observed::Region(region) => region.holds(&model.wrap(&state.position(b))),
        _ => false,
    };
    let bodies: Vec<usize> = (0..model.body_count()).filter(|&b| state.present(b) && seen(b)).collect();
    let mass: f64 = bodies.iter().map(|&b| model.mass(b)).sum();
    let mean = |of: &dyn Fn(usize) -> dem::Vec3| {
        let sum: dem::Vec3 = bodies.iter().map(|&b| of(b) * model.mass(b)).sum();
        sum / mass.max(f64::MIN_POSITIVE)
    };
    if !matches!(observed, Observed::Grain(_)) {
        row.put(history::PROBE_GRAINS.of(name), bodies.len() as f64);
    }
    row.vector(history::PROBE_X.of(name), mean(&|b| state.position(b)));
    row.vector(history::PROBE_V.of(name), mean(&|b| state.velocity(b)));
    row.vector(history::PROBE_SPIN.of(name), mean(&|b| state.spin(b)));
    let stress = dem::measure::mean_stress(model, state);
    let volume: f64 = bodies.iter().map(|&b| model.volume(b)).sum();
    let trace = |b: usize| stress[b][0] + stress[b][1] + stress[b][2];
    let sum: f64 = bodies.iter().map(|&b| model.volume(b) * trace(b) / 3.0).sum();
    row.put(history::PROBE_MEAN_STRESS.of(name), sum / volume.max(f64::MIN_POSITIVE));
}

/// Packing in measured boxes with `history`.
pub struct Measures;

impl<S: System> Recorder<S> for Measures {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(part), Some(view)) = (&now.job.grains, now.system.grains()) else { return };
        for measured in packing::measured(view, part) {
            let name = measured.name;
            row.put(history::MEASURE_POROSITY.of(name), measured.porosity);
            row.put(history::MEASURE_COORDINATION.of(name), measured.coordination);
            row.put(history::PROBE_MEAN_STRESS.of(name), measured.mean_stress);
        }
    }
}

/// Present, inserted and removed grains.
pub struct Inventory;

impl<S: System> Recorder<S> for Inventory {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(flow), Some(view)) = (now.flow, now.system.grains()) else { return };
        let [come, gone] = flow.sums();
        for (grains, mass, amount) in [
            (history::GRAINS_PRESENT, history::MASS_PRESENT, flow.present(view)),
            (history::GRAINS_IN, history::MASS_IN, come),
            (history::GRAINS_OUT, history::MASS_OUT, gone),
        ] {
            row.put(grains, amount.grains as f64);
            row.put(mass, amount.mass);
        }
    }
}
