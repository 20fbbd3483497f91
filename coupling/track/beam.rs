//! Cubic Euler–Bernoulli beam elements: stiffness, consistent mass, loads.
//!
//! Przemieniecki, Theory of Matrix Structural Analysis, 1968, eqs 5.116 and 11.24 (without shear and rotatory
//! inertia). Theory manual: eq. (6.7).

use super::band::Band;

/// Element with unknowns (w₁, θ₁, w₂, θ₂), θ = dw/dx.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Length [m].
    pub length: f64,
    /// Bending stiffness EI [N m²].
    pub bending: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
}

impl Element {
    /// Stiffness matrix.
    pub fn stiffness(&self) -> [[f64; 4]; 4] {
        let l = self.length;
        let c = self.bending / l.powi(3);
        let m = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
            [-12.0, -6.0 * l, 12.0, -6.0 * l],
            [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
        ];
        m.map(|row| row.map(|v| c * v))
    }

    /// Consistent mass matrix.
    pub fn mass(&self) -> [[f64; 4]; 4] {
        let l = self.length;
        let c = self.mass * l / 420.0;
        let m = [
            [156.0, 22.0 * l, 54.0, -13.0 * l],
            [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
            [54.0, 13.0 * l, 156.0, -22.0 * l],
            [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
        ];
        m.map(|row| row.map(|v| c * v))
    }

    /// Shape functions at `s` = 0…1.
    pub fn shape(&self, s: f64) -> [f64; 4] {
        let (l, r) = (self.length, 1.0 - s);
        [r * r * (1.0 + 2.0 * s), l * s * r * r, s * s * (3.0 - 2.0 * s), -l * s * s * r]
    }

    /// Nodal loads of 1 N/m.
    pub fn line_load(&self) -> [f64; 4] {
        let l = self.length;
        [0.5 * l, l * l / 12.0, 0.5 * l, -l * l / 12.0]
    }

    /// Adds an element matrix with unknowns `dofs` to a band.
    pub fn scatter(matrix: &[[f64; 4]; 4], dofs: [usize; 4], band: &mut Band) {
        for (i, &row) in dofs.iter().enumerate() {
            for (j, &column) in dofs.iter().enumerate().take(i + 1) {
                band.add(row, column, matrix[i][j]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// By inverse iteration.
    fn first_frequency(elements: usize) -> f64 {
        let e = Element { length: 1.0 / elements as f64, bending: 1.0, mass: 1.0 };
        // Unknowns θ₀, w₁, θ₁, …, θₙ; pinned deflections are omitted.
        let size = 2 * elements;
        let dof = |node: usize, rotation: usize| match (node, rotation) {
            (0, 1) => Some(0),
            (0, _) => None,
            (k, 0) if k == elements => None,
            (k, 1) if k == elements => Some(size - 1),
            (k, r) => Some(2 * k - 1 + r),
        };
        let (mut k, mut m) = (Band::zeros(size, 3), Band::zeros(size, 3));
        for node in 0..elements {
            let dofs = [dof(node, 0), dof(node, 1), dof(node + 1, 0), dof(node + 1, 1)];
            for (matrix, band) in [(e.stiffness(), &mut k), (e.mass(), &mut m)] {
                for (i, row) in dofs.iter().enumerate() {
                    for (j, column) in dofs.iter().enumerate().take(i + 1) {
                        if let (Some(r), Some(c)) = (row, column) {
                            band.add(*r, *c, matrix[i][j]);
                        }
                    }
                }
            }
        }
        let factor = k.clone().factor().unwrap();
        let mut x = vec![1.0; size];
        for _ in 0..60 {
            let mut y = vec![0.0; size];
            m.multiply_add(1.0, &x, &mut y);
            factor.solve(&mut y);
            let norm = y.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
            x = y.iter().map(|v| v / norm).collect();
        }
        (k.half_square(&x) / m.half_square(&x)).sqrt()
    }

    /// ω = π² √(EI/(m L⁴)) (Timoshenko 1937); cubic elements: fourth order.
    #[test]
    fn frequencies_of_a_pinned_beam_converge() {
        let errors = [2, 4, 8].map(|n| first_frequency(n) / (PI * PI) - 1.0);
        println!("errors of the first frequency with 2, 4, 8 elements: {errors:?}");
        let orders = [(errors[0] / errors[1]).log2(), (errors[1] / errors[2]).log2()];
        assert!(orders.iter().all(|o| (3.9..4.1).contains(o)), "{orders:?}");
        assert!(errors[2] > 0.0 && errors[2] < 2e-5, "{errors:?}");
    }

    #[test]
    fn shapes_conserve_force_and_moment() {
        let e = Element { length: 0.3, bending: 1.0, mass: 60.0 };
        for s in [0.0, 0.2, 0.7, 1.0] {
            let n = e.shape(s);
            assert!((n[0] + n[2] - 1.0).abs() < 1e-15);
            assert!((n[1] + n[3] + n[2] * e.length - s * e.length).abs() < 1e-15);
        }
        let q = e.line_load();
        assert!((q[0] + q[2] - 0.3).abs() < 1e-15);
        assert!((q[1] + q[3] + q[2] * 0.3 - 0.5 * 0.3 * 0.3).abs() < 1e-15);
        let total: f64 = [0, 2].iter().flat_map(|&i| [0, 2].map(|j| e.mass()[i][j])).sum();
        assert!((total - 18.0).abs() < 1e-12);
    }
}
