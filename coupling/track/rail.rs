//! Rail on pads: a [beam](super::beam) over sleepers inside and outside the model, by Newmark's method.
//!
//! Average acceleration (Newmark 1959, α = ¼, δ = ½) conserves energy:
//!
//! Δ(½ vᵀMv + ½ uᵀKu) = ½ (f₀ + f₁)ᵀ Δu − ½ (C v₀ + C v₁)ᵀ Δu.
//!
//! Leapfrog work belongs to half steps, hence [`RailState::energy_at_half_step`]. Vertical motion only; pads
//! transmit tension. Theory manual: eqs. (6.8), (6.9), (6.10), (6.11).

use super::band::{Band, BandFactor};
use super::beam::Element;
use super::influence::Winkler;
use serde::{Deserialize, Serialize};

/// Rail and supports.
#[derive(Clone, Copy, Debug)]
pub struct RailInput {
    /// Beam elements per bay, at least 1.
    pub elements: usize,
    /// Sleeper spacing [m].
    pub spacing: f64,
    /// Bending stiffness EI [N m²].
    pub bending: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Pad stiffness [N/m] and damping [N s/m].
    pub pad: [f64; 2],
    /// Downward gravity [m/s²].
    pub gravity: f64,
    /// Modelled sleepers.
    pub sleepers: usize,
    /// Sleepers outside the model on each side.
    pub beyond: usize,
    /// Mass of an outside sleeper per rail [kg].
    pub sleeper_mass: f64,
    /// Foundation stiffness [N/m] and damping [N s/m].
    pub foundation: [f64; 2],
}

/// Wheel on the rail.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wheel {
    /// Position from the first modelled sleeper [m].
    pub at: f64,
    /// Downward force [N].
    pub force: f64,
}

/// Rail matrices.
#[derive(Clone, Debug)]
pub struct Rail {
    input: RailInput,
    /// Deflection of each node; its rotation follows.
    dofs: Vec<usize>,
    /// Over modelled sleepers.
    seats: Vec<usize>,
    mass: Band,
    /// All dashpots; `beyond`: without modelled pads.
    damping: Band,
    beyond: Band,
    stiffness: Band,
    /// Nodal loads [N].
    weight: Vec<f64>,
    factor: BandFactor,
    dt: f64,
}

/// Energy and work since placement [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RailEnergy {
    /// Kinetic, with outside sleepers.
    pub kinetic: f64,
    /// Bending, pads and foundation springs.
    pub elastic: f64,
    /// Work of wheels and rail weight, and of lifting hanging sleepers.
    pub wheels: f64,
    /// Work of pads on modelled sleepers.
    pub on_seats: f64,
    /// Dissipation of pads on modelled sleepers.
    pub pads: f64,
    /// Dissipation outside the model.
    pub beyond: f64,
}

impl RailEnergy {
    fn combined(&self, a: f64, other: &RailEnergy, b: f64) -> RailEnergy {
        let mix = |x: f64, y: f64| a * x + b * y;
        RailEnergy {
            kinetic: mix(self.kinetic, other.kinetic),
            elastic: mix(self.elastic, other.elastic),
            wheels: mix(self.wheels, other.wheels),
            on_seats: mix(self.on_seats, other.on_seats),
            pads: mix(self.pads, other.pads),
            beyond: mix(self.beyond, other.beyond),
        }
    }

    /// Sum of two.
    pub fn plus(&self, other: &RailEnergy) -> RailEnergy {
        self.combined(1.0, other, 1.0)
    }

    /// Stored + dissipated − work [J].
    pub fn error(&self) -> f64 {
        self.kinetic + self.elastic + self.pads + self.beyond + self.on_seats - self.wheels
    }
}

/// Motion of a rail.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RailState {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Wheels and weight [N].
    load: Vec<f64>,
    /// Seat displacements less the lifts: current, one and two steps ago [m].
    seats: [Vec<f64>; 3],
    /// Last lifts [m].
    lifts: Vec<f64>,
    /// Per modelled pad, upwards on the seat [N].
    spring: Vec<f64>,
    dashpot: Vec<f64>,
    energy: RailEnergy,
    /// Energy one step ago.
    before: RailEnergy,
}

/// Scratch memory of a step.
#[derive(Clone, Debug, Default)]
pub struct RailScratch {
    right: Vec<f64>,
    load: Vec<f64>,
    moved: Vec<f64>,
    /// Accelerations without further wheels.
    free: Vec<f64>,
}

fn factor(mass: &Band, damping: &Band, stiffness: &Band, dt: f64) -> Option<BandFactor> {
    let mut effective = mass.clone();
    effective.add_scaled(0.5 * dt, damping);
    effective.add_scaled(0.25 * dt * dt, stiffness);
    effective.factor()
}

impl Rail {
    /// Factorises for steps of `dt` [s]; `None` unless positive definite (non-finite or non-positive input).
    pub fn new(input: RailInput, dt: f64) -> Option<Rail> {
        let supports = input.sleepers + 2 * input.beyond;
        let nodes = (supports - 1) * input.elements + 1;
        let modelled = input.beyond..input.beyond + input.sleepers;
        let support_of = |node: usize| node.is_multiple_of(input.elements).then_some(node / input.elements);
        let mut dofs = Vec::with_capacity(nodes);
        let mut size = 0;
        for node in 0..nodes {
            dofs.push(size);
            size += if support_of(node).is_some_and(|s| !modelled.contains(&s)) { 3 } else { 2 };
        }
        // First deflection to second rotation.
        let width = 4;
        let mut mass = Band::zeros(size, width);
        let mut beyond = mass.clone();
        let mut stiffness = mass.clone();
        let mut weight = vec![0.0; size];
        let e = Element {
            length: input.spacing / input.elements as f64,
            bending: input.bending,
            mass: input.mass,
        };
        for pair in dofs.windows(2) {
            let of = [pair[0], pair[0] + 1, pair[1], pair[1] + 1];
            Element::scatter(&e.stiffness(), of, &mut stiffness);
            Element::scatter(&e.mass(), of, &mut mass);
            of.iter().zip(e.line_load()).for_each(|(&d, q)| weight[d] -= input.mass * input.gravity * q);
        }
        let mut seats = Vec::with_capacity(input.sleepers);
        for support in 0..supports {
            let rail = dofs[support * input.elements];
            if modelled.contains(&support) {
                seats.push(rail);
                stiffness.add(rail, rail, input.pad[0]);
            } else {
                let sleeper = rail + 2;
                stiffness.add_between(sleeper, rail, input.pad[0]);
                beyond.add_between(sleeper, rail, input.pad[1]);
                stiffness.add(sleeper, sleeper, input.foundation[0]);
                beyond.add(sleeper, sleeper, input.foundation[1]);
                mass.add(sleeper, sleeper, input.sleeper_mass);
            }
        }
        let mut damping = beyond.clone();
        seats.iter().for_each(|&d| damping.add(d, d, input.pad[1]));
        let factor = factor(&mass, &damping, &stiffness, dt)?;
        Some(Rail { input, dofs, seats, mass, damping, beyond, stiffness, weight, factor, dt })
    }

    /// Time step [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Changes the time step [s].
    pub fn set_dt(&mut self, dt: f64) {
        if dt != self.dt {
            // Positive definite with one step, so with any.
            if let Some(factor) = factor(&self.mass, &self.damping, &self.stiffness, dt) {
                (self.factor, self.dt) = (factor, dt);
            }
        }
    }

    /// Rail ends from the first modelled sleeper [m].
    pub fn ends(&self) -> [f64; 2] {
        let before = self.input.beyond as f64 * self.input.spacing;
        [-before, before + (self.input.sleepers - 1) as f64 * self.input.spacing]
    }

    /// Unknowns and shape functions at `at` [m]; `None` beyond the ends.
    fn shape(&self, at: f64) -> Option<[(usize, f64); 4]> {
        let e = Element {
            length: self.input.spacing / self.input.elements as f64,
            bending: self.input.bending,
            mass: self.input.mass,
        };
        let [begin, end] = self.ends();
        if !(at >= begin && at <= end) {
            return None;
        }
        let along = (at - begin) / e.length;
        let k = (along as usize).min(self.dofs.len() - 2);
        let of = [self.dofs[k], self.dofs[k] + 1, self.dofs[k + 1], self.dofs[k + 1] + 1];
        let n = e.shape(along - k as f64);
        Some(std::array::from_fn(|i| (of[i], n[i])))
    }

    fn add_wheels(&self, wheels: &[Wheel], load: &mut [f64]) {
        for w in wheels {
            let shape = self.shape(w.at).into_iter().flatten();
            shape.for_each(|(d, n)| load[d] -= w.force * n);
        }
    }

    /// Series stiffness of pad and foundation [N/m].
    fn series(&self) -> f64 {
        let [pad, foundation] = [self.input.pad[0], self.input.foundation[0]];
        pad * foundation / (pad + foundation)
    }

    /// Static height of an endless rail on the foundation under its weight [m].
    pub fn own_height(&self) -> f64 {
        -self.input.mass * self.input.gravity * self.input.spacing / self.series()
    }

    /// Static heights of an endless rail on the foundation under equal wheels `behind` [m] each other, without its
    /// weight [m]. Shape `[wheels]`.
    pub fn standing(&self, behind: &[f64], force: f64) -> Vec<f64> {
        let series = self.series();
        let line = Winkler::new(self.input.bending, series, self.input.spacing);
        let height =
            |at: &f64| -behind.iter().map(|other| force * line.share(at - other)).sum::<f64>() / series;
        behind.iter().map(height).collect()
    }

    /// Straight, at rest, without force.
    pub fn laid(&self) -> RailState {
        let (n, m) = (self.mass.size(), self.seats.len());
        let none = vec![0.0; m];
        RailState {
            u: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            load: vec![0.0; n],
            seats: [none.clone(), none.clone(), none.clone()],
            lifts: none.clone(),
            spring: none.clone(),
            dashpot: none,
            energy: RailEnergy::default(),
            before: RailEnergy::default(),
        }
    }

    /// Advances by a step to seat displacements `seats` [m], `lifts` of pads without force above them [m],
    /// `wheels` and fraction `weight` of the rail weight.
    pub fn step(
        &self,
        state: &mut RailState,
        seats: impl Iterator<Item = f64>,
        lifts: &[f64],
        wheels: &[Wheel],
        weight: f64,
        scratch: &mut RailScratch,
    ) {
        self.begin_step(state, seats, lifts, wheels, weight, scratch);
        self.end_step(state, lifts, &[], scratch);
    }

    /// First part of a [step](Self::step): all but the accelerations.
    pub fn begin_step(
        &self,
        state: &mut RailState,
        seats: impl Iterator<Item = f64>,
        lifts: &[f64],
        wheels: &[Wheel],
        weight: f64,
        scratch: &mut RailScratch,
    ) {
        let (dt, [stiff, damp]) = (self.dt, self.input.pad);
        let n = self.mass.size();
        let RailScratch { right, load, moved, .. } = scratch;
        load.clear();
        load.extend(self.weight.iter().map(|w| weight * w));
        self.add_wheels(wheels, load);
        state.seats.rotate_right(1);
        state.seats[0].iter_mut().zip(seats.zip(lifts)).for_each(|(old, (new, lift))| *old = new - lift);

        moved.clear();
        moved.extend((0..n).map(|i| dt * state.v[i] + 0.25 * dt * dt * state.a[i]));
        for i in 0..n {
            state.u[i] += moved[i];
            state.v[i] += 0.5 * dt * state.a[i];
        }
        right.clear();
        right.extend_from_slice(load);
        for (k, &d) in self.seats.iter().enumerate() {
            right[d] += stiff * state.seats[0][k] + damp * state.seat_speed(k, dt);
        }
        self.stiffness.multiply_add(-1.0, &state.u, right);
        self.damping.multiply_add(-1.0, &state.v, right);
    }

    /// Second part of a step, with further `wheels`.
    pub fn end_step(
        &self,
        state: &mut RailState,
        lifts: &[f64],
        wheels: &[Wheel],
        scratch: &mut RailScratch,
    ) {
        let (dt, [stiff, damp]) = (self.dt, self.input.pad);
        let n = self.mass.size();
        let RailScratch { right, load, moved, .. } = scratch;
        self.add_wheels(wheels, load);
        self.add_wheels(wheels, right);
        self.factor.solve(right);
        state.a[..n].copy_from_slice(&right[..n]);
        for i in 0..n {
            state.v[i] += 0.5 * dt * right[i];
            let more = 0.25 * dt * dt * right[i];
            state.u[i] += more;
            moved[i] += more;
        }

        // Energy; `moved` is Δu here.
        state.before = state.energy;
        let mut energy = state.energy;
        energy.wheels += (0..n).map(|i| 0.5 * (state.load[i] + load[i]) * moved[i]).sum::<f64>();
        let (mut springs, mut squares) = (0.0, 0.0);
        for (k, &d) in self.seats.iter().enumerate() {
            let (now, last) = (state.seats[0][k], state.seats[1][k]);
            let (spring, dashpot) =
                (stiff * (state.u[d] - now), damp * (state.v[d] - state.seat_speed(k, dt)));
            let (rise, lifted) = (now - last, lifts[k] - state.lifts[k]);
            let mean = 0.5 * (dashpot + state.dashpot[k]);
            let force = 0.5 * (spring + state.spring[k]) + mean;
            energy.on_seats += force * (rise + lifted);
            energy.wheels += force * lifted;
            energy.pads += mean * (moved[d] - rise);
            // The stiffness matrix contains pads on fixed seats.
            springs += 0.5 * stiff * (state.u[d] - now).powi(2);
            squares += 0.5 * stiff * state.u[d].powi(2);
            (state.spring[k], state.dashpot[k]) = (spring, dashpot);
        }
        energy.beyond += 2.0 / dt * self.beyond.half_square(moved);
        energy.kinetic = self.mass.half_square(&state.v);
        energy.elastic = self.stiffness.half_square(&state.u) - squares + springs;
        state.energy = energy;
        state.load.copy_from_slice(load);
        state.lifts.copy_from_slice(lifts);
    }

    /// Between the two parts of a step: heights that the rail would reach at `places` without further wheels [m],
    /// 0 beyond the ends.
    pub fn free_heights(
        &self,
        state: &RailState,
        places: impl Iterator<Item = f64>,
        scratch: &mut RailScratch,
        mut each: impl FnMut(f64),
    ) {
        let RailScratch { right, free, .. } = scratch;
        free.clear();
        free.extend_from_slice(right);
        self.factor.solve(free);
        let share = 0.25 * self.dt * self.dt;
        for at in places {
            let shape = self.shape(at).into_iter().flatten();
            each(shape.map(|(d, n)| n * (state.u[d] + share * free[d])).sum());
        }
    }

    /// Height of the rail at `at` [m], 0 beyond the ends.
    pub fn height(&self, state: &RailState, at: f64) -> f64 {
        self.shape(at).into_iter().flatten().map(|(d, n)| n * state.u[d]).sum()
    }

    /// Lowering within a step at `places[i]` for 1 N downwards at `places[j]` [m/N], 0 beyond the ends.
    /// Shape of `out`: `[places × places]`.
    pub fn compliance(&self, places: &[[f64; 2]], scratch: &mut RailScratch, out: &mut Vec<f64>) {
        let unit = &mut scratch.free;
        out.clear();
        for [at, _] in places {
            unit.clear();
            unit.resize(self.mass.size(), 0.0);
            if let Some(shape) = self.shape(*at) {
                shape.iter().for_each(|&(d, n)| unit[d] += n);
                self.factor.solve(unit);
            }
            let share = 0.25 * self.dt * self.dt;
            out.extend(places.iter().map(|[other, _]| {
                self.shape(*other).into_iter().flatten().map(|(d, n)| share * n * unit[d]).sum::<f64>()
            }));
        }
    }

    /// Static pad forces [N, downwards on the seat] per wheel position, with rail weight and foundation
    /// springs under all sleepers. `None` as in [`Rail::new`].
    pub fn static_seats(&self, passes: impl Iterator<Item = Vec<Wheel>>) -> Option<Vec<Vec<f64>>> {
        let series = self.series();
        let mut stiffness = self.stiffness.clone();
        self.seats.iter().for_each(|&d| stiffness.add(d, d, series - self.input.pad[0]));
        let factor = stiffness.factor()?;
        let mut u = vec![0.0; self.mass.size()];
        let force = |wheels: Vec<Wheel>| {
            u.copy_from_slice(&self.weight);
            self.add_wheels(&wheels, &mut u);
            factor.solve(&mut u);
            self.seats.iter().map(|&d| -series * u[d]).collect()
        };
        Some(passes.map(force).collect())
    }
}

impl RailState {
    /// Upward speed of modelled seat `k`, extrapolated over a step of `dt` [m/s].
    fn seat_speed(&self, k: usize, dt: f64) -> f64 {
        let [now, last, earlier] = &self.seats;
        (1.5 * (now[k] - last[k]) - 0.5 * (last[k] - earlier[k])) / dt
    }

    /// Number of modelled pads.
    pub fn seats(&self) -> usize {
        self.spring.len()
    }

    /// Downward pad force on modelled sleeper `k` [N].
    pub fn force(&self, k: usize) -> f64 {
        -(self.spring[k] + self.dashpot[k])
    }

    /// Upward rail deflection over modelled sleeper `k` [m].
    pub fn deflection(&self, rail: &Rail, k: usize) -> f64 {
        self.u[rail.seats[k]]
    }

    /// Position along the rail and height of its nodes [m].
    pub fn line<'a>(&'a self, rail: &'a Rail) -> impl Iterator<Item = [f64; 2]> + 'a {
        let [begin, _] = rail.ends();
        let step = rail.input.spacing / rail.input.elements as f64;
        rail.dofs.iter().enumerate().map(move |(i, &d)| [begin + i as f64 * step, self.u[d]])
    }

    /// Current energy.
    pub fn energy(&self) -> &RailEnergy {
        &self.energy
    }

    /// Energy at mid-step, as for grains.
    pub fn energy_at_half_step(&self) -> RailEnergy {
        self.energy.combined(0.5, &self.before, 0.5)
    }
}

#[cfg(test)]
#[path = "rail_tests.rs"]
pub(super) mod tests;
