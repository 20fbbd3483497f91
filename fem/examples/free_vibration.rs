//! Column released from a stretched state: period and energy of three time integrators.

use trackbed_fem::newmark::{Newmark, NewmarkSolver, initial_acceleration};
use trackbed_fem::theta::ThetaSolver;
use trackbed_fem::{Constraint, Elastic, Mesh, Model, ModelInput, Quadrature, State, TimeIntegrator, energy};

/// Runs the example.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (length, steel) = (1.0, Elastic { young: 210e9, poisson: 0.0, density: 7850.0 });
    let mesh = Mesh::block([1, 1, 8], [0.1, 0.1, length]);
    let foot = (0..mesh.node_count() as u32).filter(|&n| mesh.coordinates[n as usize][2] == 0.0);
    let constraints = foot
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    let (materials, quadrature) = ([(1, steel.into())].into(), Quadrature::Gauss3);
    let model = Model::new(ModelInput { mesh, materials, quadrature, constraints, ..Default::default() })?;

    // First longitudinal mode: period 4 L sqrt(rho / E).
    let period = 4.0 * length * (steel.density / steel.young).sqrt();
    let dt = period / 200.0;
    let mut start = State::new(&model);
    for (n, x) in model.mesh().coordinates.iter().enumerate() {
        start.u[3 * n + 2] = 1e-3 * (std::f64::consts::FRAC_PI_2 * x[2] / length).sin();
    }
    initial_acceleration(&model, &mut start, &vec![0.0; model.dof_count()])?;
    let methods: [(&str, Box<dyn TimeIntegrator>); 3] = [
        ("Newmark", Box::new(NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt)?)),
        ("HHT-alpha", Box::new(NewmarkSolver::hht(&model, -0.05, dt)?)),
        ("mid-point", Box::new(ThetaSolver::new(&model, 0.5, dt)?)),
    ];
    for (name, mut method) in methods {
        let mut state = start.clone();
        method.integrate(&model, &mut state, 200.0 * dt, &mut |_, _: &mut [f64]| (), &mut |_, _, _| ())?;
        let top = 3 * (model.mesh().node_count() - 1) + 2;
        let kept = (energy::kinetic(&model, &state) + energy::strain(&model, &state))
            / energy::strain(&model, &start);
        println!(
            "{name}: after one period {:.4} of the deflection, {kept:.6} of the energy",
            state.u[top] / start.u[top]
        );
        assert!((state.u[top] / start.u[top] - 1.0).abs() < 0.02 && kept < 1.0 + 1e-9);
    }
    Ok(())
}
