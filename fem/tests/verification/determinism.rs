//! Bitwise identical results for any number of threads and after a restart.

use crate::common::{Random, fix, model};
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::Mesh;
use trackbed_fem::newmark::{Newmark, NewmarkSolver};
use trackbed_fem::state::State;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};
use trackbed_fem::{statics, stress};

/// Static solution, nodal stresses and five dynamic steps.
fn bits(threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut random = Random(4);
        let mut mesh = Mesh::block([6, 5, 5], [6.0, 5.0, 5.0]);
        mesh.coordinates
            .iter_mut()
            .filter(|x| x[2] > 0.0)
            .for_each(|x| *x = x.map(|x| x + 0.03 * random.next()));
        let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
        let soil = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };
        let model = model(mesh, constraints, soil, Quadrature::Gauss3);
        let load: Vec<f64> = (0..model.dof_count()).map(|_| 1e3 * random.next()).collect();
        let solution = statics::solve(&model, &load).unwrap();
        let mut state = State::new(&model);
        let mut newmark = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, 1e-3).unwrap();
        let mut window = ThetaSolver::new(&model, 0.55, 1e-3).unwrap();
        for _ in 0..5 {
            newmark.step(&model, &mut state, &load).unwrap();
            window.step(&model, &mut state, &load).unwrap();
        }
        let stresses = stress::nodal(&model, &solution.u);
        solution
            .u
            .iter()
            .chain(&state.u)
            .chain(&state.v)
            .chain(stresses.iter().flatten())
            .map(|x| x.to_bits())
            .collect()
    })
}

#[test]
fn results_independent_of_thread_count() {
    let one = bits(1);
    assert!(one == bits(2) && one == bits(3));
}

#[test]
fn new_solver_continues_bitwise_identically() {
    let mesh = Mesh::block([2, 2, 2], [1.0; 3]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let soil = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };
    let model = model(mesh, constraints, soil, Quadrature::Gauss2);
    let mut random = Random(8);
    let loads: Vec<Vec<f64>> =
        (0..10).map(|_| (0..model.dof_count()).map(|_| random.next()).collect()).collect();
    let run = |restart: bool| {
        let mut state = State::new(&model);
        let mut solver = ThetaSolver::new(&model, 0.6, 1e-3).unwrap();
        for (n, load) in loads.iter().enumerate() {
            if restart && n == 5 {
                solver = ThetaSolver::new(&model, 0.6, 1e-3).unwrap();
            }
            solver.step(&model, &mut state, load).unwrap();
        }
        state
    };
    assert_eq!(run(false), run(true));
}
