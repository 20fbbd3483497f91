//! Constitutive law at one point and its strain paths.

use trackbed_fem::material::Response;
use trackbed_fem::{Material, Point, PointState};

pub struct Case {
    pub material: Material,
    /// Initial isotropic pressure [Pa].
    pub pressure: f64,
    /// Elastic strain limit.
    pub elastic: f64,
    /// Strain increment of the walks.
    pub walk: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Owned {
    pub state: PointState,
    pub values: Vec<f64>,
}

impl Owned {
    pub fn point(&self) -> Point<'_> {
        Point::new(&self.state, &self.values)
    }
}

impl Case {
    pub fn start(&self) -> Owned {
        let p = -self.pressure;
        let state = PointState { stress: [p, p, p, 0.0, 0.0, 0.0], ..PointState::default() };
        let mut values = vec![0.0; self.material.law.state_values().len()];
        self.material.law.initial_values(&self.material.elastic, &state.stress, &mut values);
        Owned { state, values }
    }

    pub fn step(&self, old: &Owned, increment: &[f64; 6], want_tangent: bool) -> (Response, Owned) {
        let mut values = vec![f64::NAN; old.values.len()];
        let law = &self.material.law;
        let response = law
            .update(&self.material.elastic, old.point(), increment, want_tangent, &mut values)
            .expect("a response");
        (response, Owned { state: response.state, values })
    }

    /// Random strain increments.
    pub fn walk(&self, seed: u64, steps: usize, mut visit: impl FnMut(&Owned, &[f64; 6])) {
        let (mut random, mut at) = (Random(seed), self.start());
        let mut drift = [0.0; 6];
        for i in 0..steps {
            // Constant drift, so that the walk leaves the elastic range.
            if i % 8 == 0 {
                drift = random.strain();
            }
            let noise = random.strain();
            let increment = std::array::from_fn(|k| self.walk * (0.7 * drift[k] + 0.3 * noise[k]));
            visit(&at, &increment);
            at = self.step(&at, &increment, false).1;
        }
    }

    /// Largest entry of the elastic matrix [Pa].
    pub fn stiffness(&self, at: &Owned) -> f64 {
        let matrix = self.material.law.elastic_tangent(&self.material.elastic, at.point());
        matrix.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()))
    }
}

/// Knuth's linear congruential generator (MMIX), upper bits; range (-1, 1).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn strain(&mut self) -> [f64; 6] {
        std::array::from_fn(|_| self.next())
    }

    pub fn rotation(&mut self) -> [[f64; 3]; 3] {
        let q: [f64; 4] = std::array::from_fn(|_| self.next());
        let size = q.iter().map(|q| q * q).sum::<f64>().sqrt();
        let [w, x, y, z] = q.map(|q| q / size);
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    }
}

/// `Q t Q^T` of a Voigt tensor; `shear` is 2 for engineering strains, 1 for stresses.
pub fn rotated(t: &[f64; 6], q: &[[f64; 3]; 3], shear: f64) -> [f64; 6] {
    let s = |k: usize| t[k] / shear;
    let full = [[t[0], s(3), s(5)], [s(3), t[1], s(4)], [s(5), s(4), t[2]]];
    let entry = |i: usize, j: usize| -> f64 {
        (0..3).map(|k| (0..3).map(|l| q[i][k] * full[k][l] * q[j][l]).sum::<f64>()).sum()
    };
    let e = |i, j| shear * entry(i, j);
    [entry(0, 0), entry(1, 1), entry(2, 2), e(0, 1), e(1, 2), e(2, 0)]
}

pub fn work(stress: &[f64; 6], strain: &[f64; 6]) -> f64 {
    stress.iter().zip(strain).map(|(s, e)| s * e).sum()
}
