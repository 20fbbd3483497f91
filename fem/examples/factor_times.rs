//! Times of the equation solver on blocks of bricks:
//! `cargo run --release -p trackbed-fem --example factor_times -- 8x8x8 16x16x16 48x16x6`.
//!
//! Base clamped; the matrix is that of a Newmark step. Prints one line per brick: dofs, values of the factor, and seconds
//! of model (checks and assembly), ordering with symbolic analysis and first factorization, second factorization (memory
//! is warm then), one solve, and one product with each matrix.

use std::time::Instant;
use trackbed_fem::damping::Rayleigh;
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::solver::LinearSolver;
use trackbed_fem::solver::cholesky::{Analysis, Cholesky};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for argument in std::env::args().skip(1) {
        let counts: Vec<usize> = argument.split('x').map(str::parse).collect::<Result<_, _>>()?;
        let counts: [usize; 3] =
            counts.try_into().map_err(|_| format!("{argument}: expected a form like 8x8x8"))?;
        let mesh = Mesh::block(counts, counts.map(|n| n as f64));
        let constraints = (0..mesh.node_count() as u32)
            .filter(|&i| mesh.coordinates[i as usize][2] == 0.0)
            .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
            .collect();
        let clock = Instant::now();
        let model = Model::new(ModelInput {
            mesh,
            materials: [(1, Elastic { young: 20e6, poisson: 0.3, density: 2000.0 })].into(),
            quadrature: Quadrature::Gauss3,
            constraints,
            gravity: [0.0; 3],
            rayleigh: Rayleigh::default(),
        })?;
        let build = clock.elapsed();
        let (matrices, supports) = (model.matrices(), model.supports());

        let clock = Instant::now();
        let analysis = std::sync::Arc::new(Analysis::new(model.mesh(), matrices, supports)?);
        let analyse = clock.elapsed();
        let factor = || Cholesky::factor(analysis.clone(), model.mesh(), matrices, supports, 2.5e-7, 1.0);
        let clock = Instant::now();
        drop(factor()?);
        let first = clock.elapsed();
        let clock = Instant::now();
        let mut solver = factor()?;
        let second = clock.elapsed();

        let mut x: Vec<f64> = (0..solver.size()).map(|i| (i as f64).sin()).collect();
        solver.solve_in_place(&mut x);
        let repeats = 10;
        let mean = |work: &mut dyn FnMut()| {
            let clock = Instant::now();
            (0..repeats).for_each(|_| work());
            clock.elapsed() / repeats
        };
        let solve = mean(&mut || solver.solve_in_place(&mut x));
        let (u, mut product) = (vec![1.0; model.dof_count()], vec![0.0; model.dof_count()]);
        let stiffness = mean(&mut || model.stiffness_times(&u, &mut product));
        let mass = mean(&mut || model.mass_times(&u, &mut product));
        println!(
            "{argument}: {} equations, factor {:.2} M values; model {build:.2?}, analysis {analyse:.2?}, factor {first:.2?} then \
             {second:.2?}, solve {solve:.2?}, K x {stiffness:.2?}, M x {mass:.2?}",
            solver.size(),
            analysis.factor_len() as f64 / 1e6,
        );
    }
    Ok(())
}
