//! A rail on pads: a beam over the sleepers of the model and beyond, stepped with Newmark's rule.
//!
//! The rail is a row of cubic elements (see [`beam`](super::beam)). At each modelled sleeper a pad, a spring and a
//! dashpot side by side, joins it to the seat, whose height is given from outside; at each sleeper beyond, a pad joins
//! it to a mass on a spring and a dashpot. Everything is linear: with the step fixed, one factor serves the whole run.
//!
//! A step goes from t to t + Δt with average acceleration (Newmark 1959, α = ¼, δ = ½), which conserves the energy
//! of a linear system to rounding: with M a + C v + K u = f at both ends,
//!
//! Δ(½ vᵀMv + ½ uᵀKu) = ½ (f₀ + f₁)ᵀ Δu − ½ (C v₀ + C v₁)ᵀ Δu.
//!
//! [`RailEnergy`] splits the right side into the work of wheels and weight, the work of the pads on the seats, and the
//! dissipation of the dashpots. Grains move by a leapfrog whose work belongs to half steps;
//! [`RailState::energy_at_half_step`] gives the account at the same instant.
//!
//! Limits: vertical motion only; pads pull as well as they push, as clips do; no shear deformation.
//!
//! Theory manual: equations (6.8), (6.9), (6.10), (6.11) of `docs/theory/track.md`.

use super::band::{Band, BandFactor};
use super::beam::Element;
use serde::{Deserialize, Serialize};

/// Dimensions, stiffness and mass of a rail and its supports.
#[derive(Clone, Copy, Debug)]
pub struct RailInput {
    /// Beam elements between two sleepers, 1 or more.
    pub elements: usize,
    /// Distance of the sleepers [m].
    pub spacing: f64,
    /// Bending stiffness EI [N m²].
    pub bending: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Stiffness [N/m] and damping [N s/m] of a pad.
    pub pad: [f64; 2],
    /// Acceleration of gravity, downwards [m/s²].
    pub gravity: f64,
    /// Sleepers of the model.
    pub sleepers: usize,
    /// Sleepers beyond them on each side.
    pub beyond: usize,
    /// Mass of a sleeper beyond under this rail [kg].
    pub sleeper_mass: f64,
    /// Stiffness [N/m] and damping [N s/m] under it.
    pub foundation: [f64; 2],
}

/// A wheel: place along the rail from the first modelled sleeper [m], downward force [N].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wheel {
    /// Place [m].
    pub at: f64,
    /// Force [N].
    pub force: f64,
}

/// The rail and its matrices.
#[derive(Clone, Debug)]
pub struct Rail {
    input: RailInput,
    /// Unknown of the deflection of each node; its rotation comes next.
    dofs: Vec<usize>,
    /// Unknowns of the rail over each modelled sleeper.
    seats: Vec<usize>,
    mass: Band,
    /// Dashpots, and those of them that are not in the pads of modelled sleepers.
    damping: Band,
    beyond: Band,
    stiffness: Band,
    /// Nodal loads of the rail's weight [N].
    weight: Vec<f64>,
    factor: BandFactor,
    dt: f64,
}

/// Energy and work since the rail was laid [J].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RailEnergy {
    /// Kinetic energy of rail and sleepers beyond.
    pub kinetic: f64,
    /// Energy of bending, pads and the springs under the sleepers beyond.
    pub elastic: f64,
    /// Work of wheels and of the rail's weight.
    pub wheels: f64,
    /// Work of the pads on the seats of the modelled sleepers.
    pub on_seats: f64,
    /// Dissipated in the pads of the modelled sleepers.
    pub pads: f64,
    /// Dissipated in the other pads and under the sleepers beyond.
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

    /// Stored + dissipated − work: zero up to rounding.
    pub fn error(&self) -> f64 {
        self.kinetic + self.elastic + self.pads + self.beyond + self.on_seats - self.wheels
    }
}

/// Where a rail is.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RailState {
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Wheels and weight at the present time [N].
    load: Vec<f64>,
    /// Rise of the seats since the rail was laid, now and one and two steps ago [m].
    seats: [Vec<f64>; 3],
    /// Spring and dashpot force of each modelled pad, upwards on the seat [N].
    spring: Vec<f64>,
    dashpot: Vec<f64>,
    energy: RailEnergy,
    /// RailEnergy one step ago.
    before: RailEnergy,
}

/// Scratch memory of a step.
#[derive(Clone, Debug, Default)]
pub struct RailScratch {
    right: Vec<f64>,
    load: Vec<f64>,
    moved: Vec<f64>,
}

/// Factor of Newmark's matrix (mean acceleration) for steps of `dt` [s].
fn factor(mass: &Band, damping: &Band, stiffness: &Band, dt: f64) -> Option<BandFactor> {
    let mut effective = mass.clone();
    effective.add_scaled(0.5 * dt, damping);
    effective.add_scaled(0.25 * dt * dt, stiffness);
    effective.factor()
}

impl Rail {
    /// The rail with the factor for steps of `dt` [s]; `None` where its matrix is not positive definite, which takes
    /// input that is not finite or positive.
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
        // Furthest apart in an element: the deflection of its first node and the rotation of its second.
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

    /// Step [s].
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Gives the steps from now on another length [s].
    pub fn set_dt(&mut self, dt: f64) {
        if dt != self.dt {
            // With one step it was positive definite, so it is with any.
            if let Some(factor) = factor(&self.mass, &self.damping, &self.stiffness, dt) {
                (self.factor, self.dt) = (factor, dt);
            }
        }
    }

    /// Where the rail begins and ends, from the first modelled sleeper [m].
    pub fn ends(&self) -> [f64; 2] {
        let before = self.input.beyond as f64 * self.input.spacing;
        [-before, before + (self.input.sleepers - 1) as f64 * self.input.spacing]
    }

    /// Adds wheels to nodal loads; those beside the rail carry nothing.
    fn add_wheels(&self, wheels: &[Wheel], load: &mut [f64]) {
        let e = Element {
            length: self.input.spacing / self.input.elements as f64,
            bending: self.input.bending,
            mass: self.input.mass,
        };
        let [begin, end] = self.ends();
        for w in wheels.iter().filter(|w| w.at >= begin && w.at <= end) {
            let along = (w.at - begin) / e.length;
            let k = (along as usize).min(self.dofs.len() - 2);
            let of = [self.dofs[k], self.dofs[k] + 1, self.dofs[k + 1], self.dofs[k + 1] + 1];
            of.iter().zip(e.shape(along - k as f64)).for_each(|(&d, n)| load[d] -= w.force * n);
        }
    }

    /// The rail as it is laid: straight, at rest, without force.
    pub fn laid(&self) -> RailState {
        let (n, m) = (self.mass.size(), self.seats.len());
        let none = vec![0.0; m];
        RailState {
            u: vec![0.0; n],
            v: vec![0.0; n],
            a: vec![0.0; n],
            load: vec![0.0; n],
            seats: [none.clone(), none.clone(), none.clone()],
            spring: none.clone(),
            dashpot: none,
            energy: RailEnergy::default(),
            before: RailEnergy::default(),
        }
    }

    /// Advances by a step, at whose end the seats are `seats` higher than when the rail was laid [m], the wheels are
    /// `wheels` and the rail has this share of its weight.
    ///
    /// The dashpots of the pads take the velocity that the seats had over the last two steps, continued to the end
    /// of this one.
    pub fn step(
        &self,
        state: &mut RailState,
        seats: impl Iterator<Item = f64>,
        wheels: &[Wheel],
        weight: f64,
        scratch: &mut RailScratch,
    ) {
        let (dt, [stiff, damp]) = (self.dt, self.input.pad);
        let n = self.mass.size();
        let RailScratch { right, load, moved } = scratch;
        load.clear();
        load.extend(self.weight.iter().map(|w| weight * w));
        self.add_wheels(wheels, load);
        state.seats.rotate_right(1);
        state.seats[0].iter_mut().zip(seats).for_each(|(old, new)| *old = new);
        let [now, last, earlier] = &state.seats;
        let speed = |k: usize| (1.5 * (now[k] - last[k]) - 0.5 * (last[k] - earlier[k])) / dt;

        // Predict with the old acceleration, then solve for the new one.
        moved.clear();
        moved.extend((0..n).map(|i| dt * state.v[i] + 0.25 * dt * dt * state.a[i]));
        for i in 0..n {
            state.u[i] += moved[i];
            state.v[i] += 0.5 * dt * state.a[i];
        }
        right.clear();
        right.extend_from_slice(load);
        for (k, &d) in self.seats.iter().enumerate() {
            right[d] += stiff * now[k] + damp * speed(k);
        }
        self.stiffness.multiply_add(-1.0, &state.u, right);
        self.damping.multiply_add(-1.0, &state.v, right);
        self.factor.solve(right);
        state.a[..n].copy_from_slice(&right[..n]);
        for i in 0..n {
            state.v[i] += 0.5 * dt * right[i];
            let more = 0.25 * dt * dt * right[i];
            state.u[i] += more;
            moved[i] += more;
        }

        // RailEnergy. `moved` is Δu now.
        state.before = state.energy;
        let mut energy = state.energy;
        energy.wheels += (0..n).map(|i| 0.5 * (state.load[i] + load[i]) * moved[i]).sum::<f64>();
        let (mut springs, mut squares) = (0.0, 0.0);
        for (k, &d) in self.seats.iter().enumerate() {
            let (spring, dashpot) = (stiff * (state.u[d] - now[k]), damp * (state.v[d] - speed(k)));
            let lift = now[k] - last[k];
            let mean = 0.5 * (dashpot + state.dashpot[k]);
            energy.on_seats += (0.5 * (spring + state.spring[k]) + mean) * lift;
            energy.pads += mean * (moved[d] - lift);
            // The stiffness matrix holds the pads as if the seats stood still.
            springs += 0.5 * stiff * (state.u[d] - now[k]).powi(2);
            squares += 0.5 * stiff * state.u[d].powi(2);
            (state.spring[k], state.dashpot[k]) = (spring, dashpot);
        }
        // The mean velocity of the step is Δu/Δt.
        energy.beyond += 2.0 / dt * self.beyond.half_square(moved);
        energy.kinetic = self.mass.half_square(&state.v);
        energy.elastic = self.stiffness.half_square(&state.u) - squares + springs;
        state.energy = energy;
        state.load.copy_from_slice(load);
    }

    /// Forces at rest of the pads of all modelled sleepers [N, downwards on the seat] under wheels, where each of these
    /// sleepers too has the foundation's spring, and the rail has its weight. For a row of wheel
    /// places; `None` as in [`Rail::new`].
    pub fn static_seats(&self, passes: impl Iterator<Item = Vec<Wheel>>) -> Option<Vec<Vec<f64>>> {
        let [pad, foundation] = [self.input.pad[0], self.input.foundation[0]];
        let series = pad * foundation / (pad + foundation);
        let mut stiffness = self.stiffness.clone();
        self.seats.iter().for_each(|&d| stiffness.add(d, d, series - pad));
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
    /// Force of the pad on the seat of modelled sleeper `k`, downwards [N].
    pub fn force(&self, k: usize) -> f64 {
        -(self.spring[k] + self.dashpot[k])
    }

    /// Deflection of the rail over modelled sleeper `k`, upwards [m].
    pub fn deflection(&self, rail: &Rail, k: usize) -> f64 {
        self.u[rail.seats[k]]
    }

    /// Height of the rail at its nodes [m] and their places along it [m].
    pub fn line<'a>(&'a self, rail: &'a Rail) -> impl Iterator<Item = [f64; 2]> + 'a {
        let [begin, _] = rail.ends();
        let step = rail.input.spacing / rail.input.elements as f64;
        rail.dofs.iter().enumerate().map(move |(i, &d)| [begin + i as f64 * step, self.u[d]])
    }

    /// Account of energy now.
    pub fn energy(&self) -> &RailEnergy {
        &self.energy
    }

    /// Account of energy in the middle of the last step, where the account of grains is.
    pub fn energy_at_half_step(&self) -> RailEnergy {
        self.energy.combined(0.5, &self.before, 0.5)
    }
}

#[cfg(test)]
#[path = "rail_tests.rs"]
mod tests;
