//! Vehicle of ten degrees of freedom: body and bogies bounce and pitch, four wheelsets bounce.
//!
//! Displacements are upward and relative to the static equilibrium on a level track, so gravity only appears in
//! the [static axle load](VehicleInput::axle_load). Newmark's method with average acceleration, as the
//! [rail](super::rail). Zhai, Wang & Cai 2009, Vehicle System Dynamics 47, 1349–1376. Theory manual: eq. (6.12a).

use nalgebra::{Cholesky, Const, SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Degrees of freedom: body (bounce, pitch), front bogie, rear bogie, wheelsets from the front.
const SIZE: usize = 10;
/// First wheelset.
const WHEELS: usize = 6;
/// Axles of a vehicle.
pub const AXLES: usize = 4;

type Matrix = SMatrix<f64, SIZE, SIZE>;
type Vector = SVector<f64, SIZE>;

/// Masses and suspension of a whole vehicle.
#[derive(Clone, Copy, Debug)]
pub struct VehicleInput {
    /// Body: mass [kg], moment of inertia in pitch [kg m²].
    pub body: [f64; 2],
    /// One bogie: mass [kg], moment of inertia in pitch [kg m²].
    pub bogie: [f64; 2],
    /// Mass of a wheelset [kg].
    pub wheelset: f64,
    /// Suspension of one axle: stiffness [N/m], damping [N s/m].
    pub primary: [f64; 2],
    /// Suspension of one bogie: stiffness [N/m], damping [N s/m].
    pub secondary: [f64; 2],
    /// Axle distance in a bogie [m].
    pub wheelbase: f64,
    /// Distance of bogie centres [m].
    pub bogie_spacing: f64,
    /// Downward gravity [m/s²].
    pub gravity: f64,
}

impl VehicleInput {
    /// Static axle load [N].
    pub fn axle_load(&self) -> f64 {
        let mass = self.body[0] + 2.0 * self.bogie[0] + AXLES as f64 * self.wheelset;
        mass * self.gravity / AXLES as f64
    }

    /// Elongation of each suspension as a row over the degrees of freedom: secondary, primary.
    fn suspension(&self) -> ([Vector; 2], [Vector; AXLES]) {
        let (half, base) = (0.5 * self.bogie_spacing, 0.5 * self.wheelbase);
        let secondary = [half, -half].map(|ahead| {
            let mut row = Vector::zeros();
            (row[0], row[1]) = (1.0, ahead);
            row[if ahead > 0.0 { 2 } else { 4 }] = -1.0;
            row
        });
        let primary = std::array::from_fn(|k| {
            let mut row = Vector::zeros();
            let bogie = 2 + 2 * (k / 2);
            (row[bogie], row[bogie + 1]) = (1.0, if k % 2 == 0 { base } else { -base });
            row[WHEELS + k] = -1.0;
            row
        });
        (secondary, primary)
    }

    /// Σ of the suspensions, each a spring or dashpot `[secondary, primary]`.
    fn assemble(&self, [second, first]: [f64; 2]) -> Matrix {
        let (secondary, primary) = self.suspension();
        let add = |sum: Matrix, row: &Vector, value: f64| sum + value * row * row.transpose();
        let sum = secondary.iter().fold(Matrix::zeros(), |sum, row| add(sum, row, second));
        primary.iter().fold(sum, |sum, row| add(sum, row, first))
    }
}

/// Matrices of a vehicle.
#[derive(Clone, Debug)]
pub struct Vehicle {
    mass: Vector,
    damping: Matrix,
    stiffness: Matrix,
    factor: Cholesky<f64, Const<SIZE>>,
    /// Uplift of wheelset `i` within a step for 1 N upwards on `j` [m/N].
    compliance: [[f64; AXLES]; AXLES],
    axle_load: f64,
    dt: f64,
}

/// Motion of a vehicle.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct VehicleState {
    u: Vector,
    v: Vector,
    a: Vector,
}

fn factor(
    mass: &Vector,
    damping: &Matrix,
    stiffness: &Matrix,
    dt: f64,
) -> Option<Cholesky<f64, Const<SIZE>>> {
    Cholesky::new(Matrix::from_diagonal(mass) + damping * (0.5 * dt) + stiffness * (0.25 * dt * dt))
}

fn compliance(factor: &Cholesky<f64, Const<SIZE>>, dt: f64) -> [[f64; AXLES]; AXLES] {
    let inverse = factor.inverse();
    std::array::from_fn(|i| std::array::from_fn(|j| 0.25 * dt * dt * inverse[(WHEELS + i, WHEELS + j)]))
}

impl Vehicle {
    /// Vehicle for steps of `dt` [s]; `None` unless masses are positive and all is finite.
    pub fn new(input: &VehicleInput, dt: f64) -> Option<Vehicle> {
        let [body, bogie] = [input.body, input.bogie];
        let mut mass = Vector::repeat(input.wheelset);
        for (k, pair) in [body, bogie, bogie].into_iter().enumerate() {
            (mass[2 * k], mass[2 * k + 1]) = (pair[0], pair[1]);
        }
        let stiffness = input.assemble([input.secondary[0], input.primary[0]]);
        let damping = input.assemble([input.secondary[1], input.primary[1]]);
        let factor = factor(&mass, &damping, &stiffness, dt)?;
        let compliance = compliance(&factor, dt);
        Some(Vehicle { mass, damping, stiffness, factor, compliance, axle_load: input.axle_load(), dt })
    }

    /// Changes the time step [s].
    pub fn set_dt(&mut self, dt: f64) {
        if dt != self.dt
            && let Some(factor) = factor(&self.mass, &self.damping, &self.stiffness, dt)
        {
            self.compliance = compliance(&factor, dt);
            (self.factor, self.dt) = (factor, dt);
        }
    }

    /// Static axle load [N].
    pub fn axle_load(&self) -> f64 {
        self.axle_load
    }

    /// Uplift of wheelset `i` within a step for 1 N upwards on wheelset `j` [m/N].
    pub fn compliance(&self, i: usize, j: usize) -> f64 {
        self.compliance[i][j]
    }

    /// Right-hand side and displacement before accelerations, with `forces` on the wheelsets [N, upwards].
    fn predict(&self, state: &VehicleState, forces: [f64; AXLES]) -> (Vector, Vector, Vector) {
        let dt = self.dt;
        let u = state.u + dt * state.v + 0.25 * dt * dt * state.a;
        let v = state.v + 0.5 * dt * state.a;
        let mut right = -(self.stiffness * u + self.damping * v);
        forces.iter().enumerate().for_each(|(k, f)| right[WHEELS + k] += f - self.axle_load);
        (u, v, right)
    }

    /// Heights of the wheelsets after a step without contact [m].
    pub fn free(&self, state: &VehicleState) -> [f64; AXLES] {
        let (u, _, right) = self.predict(state, [0.0; AXLES]);
        let a = self.factor.solve(&right);
        std::array::from_fn(|k| u[WHEELS + k] + 0.25 * self.dt * self.dt * a[WHEELS + k])
    }

    /// Advances by a step with `forces` on the wheelsets [N, upwards].
    pub fn step(&self, state: &mut VehicleState, forces: [f64; AXLES]) {
        let (u, v, right) = self.predict(state, forces);
        let a = self.factor.solve(&right);
        *state = VehicleState { u: u + 0.25 * self.dt * self.dt * a, v: v + 0.5 * self.dt * a, a };
    }

    /// Kinetic and elastic energy relative to the static equilibrium [J].
    pub fn energy(&self, state: &VehicleState) -> f64 {
        0.5 * state.v.component_mul(&self.mass).dot(&state.v) + 0.5 * state.u.dot(&(self.stiffness * state.u))
    }
}

impl VehicleState {
    /// Height of wheelset `k` [m].
    pub fn wheelset(&self, k: usize) -> f64 {
        self.u[WHEELS + k]
    }

    /// Upward velocity of wheelset `k` [m/s].
    pub fn wheelset_velocity(&self, k: usize) -> f64 {
        self.v[WHEELS + k]
    }

    /// Upward acceleration of the body's centre [m/s²].
    pub fn body_acceleration(&self) -> f64 {
        self.a[0]
    }
}

#[cfg(test)]
#[path = "vehicle_tests.rs"]
mod tests;
