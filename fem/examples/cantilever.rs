//! Cantilever under a transverse tip load: deflection against Timoshenko beam theory.

use trackbed_fem::{Constraint, Elastic, Mesh, Model, ModelInput, Quadrature, loads, statics};

/// Runs the example.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (length, height, width, force) = (2.0, 0.2, 0.1, 5e3);
    let steel = Elastic { young: 210e9, poisson: 0.3, density: 7850.0 };
    let mesh = Mesh::block([10, 1, 2], [length, width, height]);
    let clamped = (0..mesh.node_count() as u32).filter(|&n| mesh.coordinates[n as usize][0] == 0.0);
    let constraints = clamped
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    let materials = [(1, steel.into())].into();
    let quadrature = Quadrature::Gauss2;
    let model = Model::new(ModelInput { mesh, materials, quadrature, constraints, ..Default::default() })?;

    // Traction on the end faces.
    let mut load = vec![0.0; model.dof_count()];
    let traction = [0.0, 0.0, -force / (height * width)];
    for face in model.mesh().boundary_faces() {
        if face.nodes().iter().all(|&n| model.mesh().coordinates[n as usize][0] == length) {
            loads::face_traction(model.mesh(), &face, traction, &mut load);
        }
    }
    let solution = statics::solve(&model, &load)?;
    let tip = (0..model.dof_count()).skip(2).step_by(3).fold(0.0, |m: f64, d| m.min(solution.u[d]));
    let (inertia, shear) = (width * height.powi(3) / 12.0, steel.young / 2.6 * 5.0 / 6.0 * width * height);
    let beam = -force * (length.powi(3) / (3.0 * steel.young * inertia) + length / shear);
    println!("tip deflection {:.4} mm, Timoshenko's beam {:.4} mm", 1e3 * tip, 1e3 * beam);
    assert!((tip / beam - 1.0).abs() < 0.02);
    Ok(())
}
