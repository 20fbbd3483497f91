//! Vehicles on [rails](super::rails): wheels on springs by Hertz, solved with the rail in one step.
//!
//! Force of a wheel: (δ/G)^(3/2) for an approach δ > 0, otherwise 0. Beyond the rail's ends a wheel runs on an even,
//! endless track; over the taper the height of the rail goes over into that of this track. Theory manual: eqs.
//! (6.12a), (6.12b).

use super::irregularity::Irregularity;
use super::load::CyclicLoad;
use super::rail::{Rail, RailScratch, RailState, Wheel};
use super::vehicle::{AXLES, Vehicle, VehicleInput, VehicleState};
use serde::{Deserialize, Serialize};

/// Change of forces over the static one that ends the iteration.
const TOLERANCE: f64 = 1e-12;
const MOST_SWEEPS: usize = 200;
/// Damping ratio of a wheelset on the even track: it does not ring on after leaving the rail.
const EVEN_DAMPING: f64 = 0.1;

/// Vehicles and the surface on which they roll.
#[derive(Clone, Debug)]
pub struct RollingInput {
    /// Each car.
    pub vehicle: VehicleInput,
    /// Wheel constant G [m/N^(2/3)].
    pub hertz: f64,
    /// Part of an axle load on the modelled rails: 0.5 for half a track.
    pub share: f64,
    /// Irregularity of all rails.
    pub irregularity: Irregularity,
}

/// Vehicles of a run.
#[derive(Clone, Debug)]
pub struct Rolling {
    input: RollingInput,
    vehicle: Vehicle,
    /// Modelled rails.
    rails: usize,
    /// Static force of an axle on one rail [N].
    force: f64,
    /// Static height of the rail at each axle, without its weight [m].
    standing: Vec<f64>,
    /// Damping between a wheelset and the even track beyond the rail [N s/m].
    even_damping: f64,
    /// Position, share on the rail. Shape `[axles]`.
    places: Vec<[f64; 2]>,
    /// Shape `[axles × axles]`.
    compliance: Vec<f64>,
    /// Free approach of wheels [m]. Shape `[axles × rails]`.
    approach: Vec<f64>,
}

/// Motion of the vehicles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RollingState {
    /// Number of the pass.
    pass: Option<u32>,
    cars: Vec<VehicleState>,
    /// Downward force of an axle on a rail [N]. Shape `[axles × rails]`.
    forces: Vec<f64>,
    /// Of axle forces. Shape `[axles]`.
    statistics: Vec<Statistics>,
    /// Of the acceleration of bodies.
    body: Statistics,
    /// Steps whose contact forces did not converge.
    unconverged: u64,
}

/// Statistics over time.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Statistics {
    duration: f64,
    sum: f64,
    squares: f64,
    range: [f64; 2],
    /// Time without contact [s].
    lost: f64,
}

impl Default for Statistics {
    fn default() -> Statistics {
        Statistics {
            duration: 0.0,
            sum: 0.0,
            squares: 0.0,
            range: [f64::INFINITY, f64::NEG_INFINITY],
            lost: 0.0,
        }
    }
}

impl Statistics {
    fn add(&mut self, value: f64, dt: f64) {
        self.duration += dt;
        self.sum += dt * value;
        self.squares += dt * value * value;
        self.range = [self.range[0].min(value), self.range[1].max(value)];
    }

    fn mean(&self) -> f64 {
        self.sum / self.duration
    }

    fn deviation(&self) -> f64 {
        (self.squares / self.duration - self.mean().powi(2)).max(0.0).sqrt()
    }
}

/// Results of all passes, over the part of the rail that carries the whole load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RollingRecord {
    /// Static axle load [N].
    pub static_force: f64,
    /// From the front.
    pub axles: Vec<AxleRecord>,
    /// Largest acceleration of the bodies, up or down [m/s²].
    pub body_acceleration: f64,
    /// Its root mean square [m/s²].
    pub body_acceleration_rms: f64,
    /// Steps whose contact forces did not converge.
    pub unconverged_steps: u64,
}

impl RollingRecord {
    /// Warnings about loss of contact and forces that did not converge.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let lost = self.axles.iter().enumerate().filter(|(_, axle)| axle.without_contact > 0.0);
        let lost = lost.map(|(k, axle)| {
            format!("axle {}: without contact for {:.6} s in total", k + 1, axle.without_contact)
        });
        let steps = self.unconverged_steps;
        let forces = format!("vehicles: contact forces not converged to 1e-12 in {steps} steps");
        lost.chain((steps > 0).then_some(forces))
    }
}

/// Force of an axle on the track, both rails together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AxleRecord {
    /// Largest [N].
    pub largest_force: f64,
    /// Smallest [N].
    pub smallest_force: f64,
    /// Mean [N].
    pub mean_force: f64,
    /// Standard deviation [N].
    pub standard_deviation: f64,
    /// Time without contact [s].
    pub without_contact: f64,
}

impl Rolling {
    /// Vehicles on `rails` rails like `rail`; `None` for invalid input.
    pub fn new(input: RollingInput, rail: &Rail, rails: usize, load: &CyclicLoad) -> Option<Rolling> {
        let vehicle = Vehicle::new(&input.vehicle, rail.dt())?;
        let force = input.share * vehicle.axle_load() / rails as f64;
        let behind: Vec<f64> = load.axles().iter().map(|a| a[0]).collect();
        let standing = rail.standing(&behind, force);
        let stiffness = 1.5 * vehicle.axle_load() / at_rest(input.hertz, &vehicle);
        let even_damping = EVEN_DAMPING * 2.0 * (stiffness * input.vehicle.wheelset).sqrt();
        let (places, compliance, approach) = Default::default();
        Some(Rolling { input, vehicle, rails, force, standing, even_damping, places, compliance, approach })
    }

    /// Standing vehicles, before the first pass.
    pub fn standing(&self) -> RollingState {
        let axles = self.standing.len();
        RollingState {
            pass: None,
            cars: vec![VehicleState::default(); axles / AXLES],
            forces: vec![self.force; axles * self.rails],
            statistics: vec![Statistics::default(); axles],
            body: Statistics::default(),
            unconverged: 0,
        }
    }

    /// Sets the wheels at `time` and their approach if they kept off the rails; `None` without wheels.
    fn place(
        &mut self,
        state: &mut RollingState,
        load: &CyclicLoad,
        time: f64,
        rail: &Rail,
        rails: (&[RailState], &mut [RailScratch]),
    ) -> Option<()> {
        let (_, pass) = load.passing(time)?;
        if state.pass != Some(pass) {
            // Every pass begins in equilibrium, on even track.
            let RollingState { cars, forces, .. } = self.standing();
            (state.pass, state.cars, state.forces) = (Some(pass), cars, forces);
        }
        self.places.clear();
        self.places.extend(load.axle_places(time));
        let Rolling { vehicle, places, approach, standing, input, .. } = self;
        let (at_rest, own) = (at_rest(input.hertz, vehicle), rail.own_height());
        approach.clear();
        approach.resize(places.len() * self.rails, 0.0);
        for (r, (rail_state, scratch)) in rails.0.iter().zip(&mut *rails.1).enumerate() {
            let mut axle = 0;
            rail.free_heights(rail_state, places.iter().map(|p| p[0]), scratch, |height| {
                let [at, share] = places[axle];
                let uneven = input.irregularity.height(at);
                // A rail under a part of the wheel sinks by this part of the height of the even track.
                let raised = share * (height + uneven - own - share * standing[axle]);
                approach[axle * self.rails + r] = at_rest + if share > 0.0 { raised } else { 0.0 };
                axle += 1;
            });
        }
        for (c, car) in state.cars.iter().enumerate() {
            for (k, height) in vehicle.free(car).into_iter().enumerate() {
                let own = (AXLES * c + k) * self.rails;
                approach[own..own + self.rails].iter_mut().for_each(|a| *a -= height);
            }
        }
        rail.compliance(places, &mut rails.1[0], &mut self.compliance);
        Some(())
    }

    /// Forces by nonlinear Gauss–Seidel sweeps: the problem is convex. Returns whether they converged.
    fn solve(&self, forces: &mut [f64]) -> bool {
        let (n, rails) = (self.places.len(), self.rails);
        // Wheels per axle on a modelled rail.
        let wheels = 2.0 * self.input.share / rails as f64;
        for _ in 0..MOST_SWEEPS {
            let mut change = 0.0_f64;
            for i in 0..n {
                let share = self.places[i][1];
                let first = i - i % AXLES;
                for r in 0..rails {
                    let own = i * rails + r;
                    let mut approach = self.approach[own];
                    for j in 0..n {
                        let down = share * self.places[j][1] * self.compliance[i * n + j];
                        approach -= down * forces[j * rails + r];
                    }
                    for j in 0..AXLES {
                        let lift = self.vehicle.compliance(i - first, j) / self.input.share;
                        let from = (first + j) * rails;
                        approach -= lift * forces[from..from + rails].iter().sum::<f64>();
                    }
                    let soft = share * share * self.compliance[i * n + i]
                        + self.vehicle.compliance(i - first, i - first) / self.input.share;
                    let new = pressed(approach + soft * forces[own], soft, wheels, self.input.hertz);
                    change = change.max((new - forces[own]).abs());
                    forces[own] = new;
                }
            }
            if change <= TOLERANCE * self.force {
                return forces.iter().all(|f| f.is_finite());
            }
        }
        false
    }

    /// Advances the vehicles to `time` with the rails between the parts of their step, and sets `wheels` to
    /// their loads on each rail.
    pub fn advance(
        &mut self,
        state: &mut RollingState,
        load: &CyclicLoad,
        time: f64,
        rail: &Rail,
        rails: (&[RailState], &mut [RailScratch]),
        wheels: &mut [Vec<Wheel>],
    ) {
        wheels.iter_mut().for_each(Vec::clear);
        self.vehicle.set_dt(rail.dt());
        if self.place(state, load, time, rail, rails).is_none() {
            state.pass = None;
            return;
        }
        state.unconverged += u64::from(!self.solve(&mut state.forces));
        let on_axle = |i: usize, forces: &[f64]| {
            forces[i * self.rails..(i + 1) * self.rails].iter().sum::<f64>() / self.input.share
        };
        for (i, [at, share]) in self.places.iter().enumerate() {
            for (r, out) in wheels.iter_mut().enumerate() {
                if *share > 0.0 {
                    out.push(Wheel { at: *at, force: share * state.forces[i * self.rails + r] });
                }
            }
            if *share == 1.0 {
                let force = on_axle(i, &state.forces);
                state.statistics[i].add(force, rail.dt());
                state.statistics[i].lost += if force == 0.0 { rail.dt() } else { 0.0 };
            }
        }
        for (c, car) in state.cars.iter_mut().enumerate() {
            let own = &self.places[AXLES * c..AXLES * (c + 1)];
            let forces = std::array::from_fn(|k| {
                let even = (1.0 - own[k][1]) * self.even_damping * car.wheelset_velocity(k);
                on_axle(AXLES * c + k, &state.forces) - even
            });
            self.vehicle.step(car, forces);
            if own.iter().any(|p| p[1] == 1.0) {
                state.body.add(car.body_acceleration(), rail.dt());
            }
        }
    }

    /// Number of axles.
    pub fn axles(&self) -> usize {
        self.standing.len()
    }

    /// Force of axle `i` [N], both rails together; 0 without wheels.
    pub fn axle_force(&self, state: &RollingState, i: usize) -> f64 {
        let own = &state.forces[i * self.rails..(i + 1) * self.rails];
        if state.pass.is_some() { own.iter().sum::<f64>() / self.input.share } else { 0.0 }
    }

    /// Results; `None` before wheels were on the rails.
    pub fn record(&self, state: &RollingState) -> Option<RollingRecord> {
        let axle = |t: &Statistics| AxleRecord {
            largest_force: t.range[1],
            smallest_force: t.range[0],
            mean_force: t.mean(),
            standard_deviation: t.deviation(),
            without_contact: t.lost,
        };
        let begun = state.statistics.iter().all(|t| t.duration > 0.0);
        begun.then(|| RollingRecord {
            static_force: self.vehicle.axle_load(),
            axles: state.statistics.iter().map(axle).collect(),
            body_acceleration: state.body.range[1].max(-state.body.range[0]),
            body_acceleration_rms: (state.body.squares / state.body.duration).sqrt(),
            unconverged_steps: state.unconverged,
        })
    }
}

/// Static approach of a wheel [m].
fn at_rest(hertz: f64, vehicle: &Vehicle) -> f64 {
    hertz * libm::cbrt(0.5 * vehicle.axle_load()).powi(2)
}

/// Force F = n (δ/G)^(3/2) with δ = `free` − `soft` F, 0 for `free` ≤ 0.
fn pressed(free: f64, soft: f64, wheels: f64, hertz: f64) -> f64 {
    if free <= 0.0 {
        return 0.0;
    }
    let force = |d: f64| wheels * (d / hertz) * libm::sqrt(d / hertz);
    // Convex and increasing: Newton's method descends from the right.
    let mut approach = free;
    for _ in 0..100 {
        let slope = 1.0 + 1.5 * soft * force(approach) / approach;
        let step = (approach + soft * force(approach) - free) / slope;
        approach -= step;
        if step <= 1e-15 * free {
            break;
        }
    }
    force(approach.max(0.0))
}

#[cfg(test)]
#[path = "rolling_tests.rs"]
mod tests;
