//! Columns of the sleepers, the interface, the energies, the rails, the supports, the probes, inlets and outlets.

use crate::model::Observed;
use crate::run::recorder::{Now, Recorder};
use crate::run::system::{GrainsView, System};
use crate::write::csv::Row;
use trackbed_dem as dem;

/// Place, load and shape of each sleeper.
pub struct Sleepers;

impl<S: System> Recorder<S> for Sleepers {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        for k in 0..now.track.count() {
            let Some(sleeper) = now.track.sleeper(k, now.time, now.system) else { continue };
            let number = number(now, k);
            row.put(format_args!("load{number}"), "N", sleeper.load);
            row.vector(format_args!("sleeper{number}"), "m", sleeper.place);
            row.put(format_args!("sleeper{number}_tilt"), "rad", sleeper.tilt);
            if let Some(meshed) = sleeper.meshed {
                row.put(format_args!("sleeper{number}_seats"), "m", meshed.moved.seats);
                row.put(format_args!("sleeper{number}_bend"), "m", meshed.moved.bend);
                row.vector(format_args!("sleeper{number}_contact"), "N", meshed.contact);
            }
        }
    }
}

/// What is added to the name of a column of a sleeper: its number from 1, where there are several.
fn number<S>(now: &Now<'_, S>, k: usize) -> String {
    if now.track.count() > 1 { format!("_{}", k + 1) } else { String::new() }
}

/// Forces between grains and solid.
pub struct Interface;

impl<S: System> Recorder<S> for Interface {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        if now.system.grains().is_some() && now.system.solid().is_some() {
            row.vector("contact_force_on_solid", "N", now.system.contact_force());
            row.put("peak_formation_pressure", "Pa", now.system.peak_pressure());
        }
    }
}

/// Stored energies, work and dissipation.
pub struct Energies;

impl<S> Recorder<S> for Energies {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (stored, spent) = (&now.balance.now, &now.balance.spent);
        let in_solid = spent.rayleigh + spent.absorbed + spent.plastic + spent.numerical;
        row.put("grains_kinetic", "J", stored.grains_kinetic);
        row.put("contact_springs", "J", stored.contact_springs);
        row.put("grains_gravity", "J", stored.grains_gravity);
        row.put("solid_kinetic", "J", stored.solid_kinetic);
        row.put("solid_strain", "J", stored.solid_strain);
        row.put("solid_gravity", "J", stored.solid_gravity);
        row.put("work", "J", spent.work());
        row.put("dissipated_dashpot", "J", spent.dashpot);
        row.put("dissipated_friction", "J", spent.friction);
        row.put("dissipated_solid", "J", in_solid);
        row.put("interface_error", "J", spent.interface());
        row.put("energy_error", "J", now.balance.error());
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
            row.put(format_args!("rail{}", number(now, k)), "m", now.track.rail_deflection(k));
        }
        let (stored, spent) = (&now.balance.now, &now.balance.spent);
        row.put("rail_energy", "J", stored.rail);
        row.put("wheels_work", "J", spent.wheels);
        row.put("dissipated_track", "J", spent.pads + spent.track_beyond);
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
                row.vector(format_args!("{name}_reaction"), "N", force);
            }
        }
    }
}

/// Motion of the observed nodes.
pub struct Probes;

impl<S: System> Recorder<S> for Probes {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        for (name, observed) in &now.job.probes {
            match (observed, now.system.solid(), now.system.grains()) {
                (Observed::Node(node), Some(solid), _) => {
                    let of_node = |field: &[f64]| [field[3 * node], field[3 * node + 1], field[3 * node + 2]];
                    row.vector(format_args!("{name}_u"), "m", of_node(&solid.state.u));
                    row.vector(format_args!("{name}_v"), "m/s", of_node(&solid.state.v));
                }
                (observed, _, Some(view)) => of_grains(name, *observed, view, row),
                _ => {}
            }
        }
    }
}

/// Number, mean place, velocity, spin and mean stress of the grains that a probe observes, each weighted by mass, stress by volume; zeros
/// without any.
fn of_grains(name: &str, observed: Observed, view: GrainsView<'_>, row: &mut Row) {
    let GrainsView { model, state } = view;
    let seen = |b: usize| match observed {
        Observed::Node(_) => false,
        Observed::Grain(grain) => b == grain,
        Observed::Group(part) => model.part(b) == part,
        Observed::Region(region) => region.holds(&model.wrap(&state.position(b))),
    };
    let bodies: Vec<usize> = (0..model.body_count()).filter(|&b| state.present(b) && seen(b)).collect();
    let mass: f64 = bodies.iter().map(|&b| model.mass(b)).sum();
    let mean = |of: &dyn Fn(usize) -> dem::Vec3| {
        let sum: dem::Vec3 = bodies.iter().map(|&b| of(b) * model.mass(b)).sum();
        sum / mass.max(f64::MIN_POSITIVE)
    };
    if !matches!(observed, Observed::Grain(_)) {
        row.put(format_args!("{name}_grains"), "", bodies.len() as f64);
    }
    row.vector(format_args!("{name}_x"), "m", mean(&|b| state.position(b)));
    row.vector(format_args!("{name}_v"), "m/s", mean(&|b| state.velocity(b)));
    row.vector(format_args!("{name}_spin"), "rad/s", mean(&|b| state.spin(b)));
    let stress = dem::measure::mean_stress(model, state);
    let volume: f64 = bodies.iter().map(|&b| model.volume(b)).sum();
    let trace = |b: usize| stress[b][0] + stress[b][1] + stress[b][2];
    let sum: f64 = bodies.iter().map(|&b| model.volume(b) * trace(b) / 3.0).sum();
    row.put(format_args!("{name}_mean_stress"), "Pa", sum / volume.max(f64::MIN_POSITIVE));
}

/// Grains that are there, that came in and that went out.
pub struct Inventory;

impl<S: System> Recorder<S> for Inventory {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(flow), Some(view)) = (now.flow, now.system.grains()) else { return };
        let [come, gone] = flow.sums();
        for (name, amount) in [("present", flow.present(view)), ("in", come), ("out", gone)] {
            row.put(format_args!("grains_{name}"), "", amount.grains as f64);
            row.put(format_args!("mass_{name}"), "kg", amount.mass);
        }
    }
}
