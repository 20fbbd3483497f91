use super::*;
use trackbed_fem::Elastic;

fn plan(elements: [usize; 3]) -> MeshedSleepers {
    MeshedSleepers {
        half: [1.3, 0.14, 0.1],
        elements,
        elastic: Elastic { young: 3e10, poisson: 0.2, density: 2400.0 },
        centres: vec![[0.2, 0.3], [0.2, 0.9]],
        seats: vec![[-0.75, 0.0], [0.75, 0.02]],
        feet: vec![[0.15, 0.28], [0.2, 0.0]],
        symmetric: [false; 2],
        gravity: [0.0, 0.0, -9.81],
    }
}

fn on_a_block(elements: [usize; 3]) -> (SleeperBodies, Mesh) {
    let mut mesh = Mesh::block([2, 2, 1], [1.0, 1.0, 0.5]);
    let mut materials = [(1, Elastic { young: 2e7, poisson: 0.3, density: 2000.0 }.into())].into();
    let mut constraints = Vec::new();
    let bodies = SleeperBodies::add(plan(elements), &mut mesh, &mut materials, &mut constraints);
    let own: usize = elements.iter().product();
    assert_eq!((bodies.material, constraints.len(), mesh.element_count()), (2, 0, 4 + 2 * own));
    (bodies, mesh)
}

#[test]
fn motions_are_measured_exactly() {
    for elements in [[6, 2, 1], [7, 1, 2], [1, 1, 1]] {
        let (bodies, mesh) = on_a_block(elements);
        for k in 0..2 {
            let c = bodies.centre(k, bodies.waiting);
            let mut u = vec![0.0; 3 * mesh.node_count()];
            for n in bodies.nodes_of(k) {
                let [x, y, z] = [0, 1, 2].map(|d| mesh.coordinates[n][d] - c[d]);
                u[3 * n] = 0.01 - 0.02 * z;
                u[3 * n + 1] = -0.03 + 0.01 * z;
                u[3 * n + 2] = 0.5 + 0.02 * x - 0.01 * y + 0.04 * x * x;
            }
            let m = bodies.moved(k, &u);
            let parabola = 0.04 * 1.3 * 1.3;
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{elements:?} {k}: {a} {b}");
            close(m.translation[0], 0.01);
            close(m.translation[1], -0.03);
            close(m.translation[2], 0.5 + parabola / 3.0);
            close(m.tilt, 0.02_f64.hypot(0.01).atan());
            close(m.bend, parabola);
            // Mean of x² over feet of 0.15 and 0.2 m.
            let mean = |foot: f64| 0.75 * 0.75 + foot * foot / 12.0;
            close(m.seats, 0.5 - 0.01 * 0.01 + 0.04 * 0.5 * (mean(0.15) + mean(0.2)));
            let mut load = vec![0.0; u.len()];
            bodies.add_load(k, 7.0, &mut load);
            close(load.iter().sum(), -7.0);
            close(load.iter().zip(&u).map(|(f, u)| f * u).sum(), -7.0 * m.seats);
        }
    }
}

/// Number of zero-energy modes.
fn loose(elements: [usize; 3], quadrature: fem::Quadrature) -> usize {
    let body = fem::Model::new(fem::ModelInput {
        mesh: block(&plan(elements), [0.0; 2], 0.0),
        materials: [(1, plan(elements).elastic.into())].into(),
        quadrature,
        ..fem::ModelInput::default()
    })
    .unwrap();
    let n = body.dof_count();
    let mut k = nalgebra::DMatrix::zeros(n, n);
    for j in 0..n {
        let (mut x, mut y) = (vec![0.0; n], vec![0.0; n]);
        x[j] = 1.0;
        body.stiffness_times(&x, &mut y);
        k.set_column(j, &nalgebra::DVector::from_vec(y));
    }
    let values = k.symmetric_eigenvalues();
    let most = values.max();
    values.iter().filter(|v| v.abs() < 1e-9 * most).count()
}

#[test]
fn nothing_is_loose_but_rigid_motions() {
    for elements in [[2, 2, 1], [1, 3, 2], [3, 1, 2], [2, 2, 2]] {
        assert_eq!(loose(elements, fem::Quadrature::Gauss2), 6, "{elements:?}");
    }
    for elements in [[1, 1, 1], [4, 1, 1]] {
        for rule in [fem::Quadrature::Irons14, fem::Quadrature::Gauss3] {
            assert_eq!(loose(elements, rule), 6, "{elements:?}");
        }
        // Why a single row is rejected.
        assert!(loose(elements, fem::Quadrature::Gauss2) > 10);
    }
}

#[test]
fn set_down_they_keep_their_matrices() {
    let (bodies, mesh) = on_a_block([3, 1, 1]);
    let elastic = Elastic { young: 2e7, poisson: 0.3, density: 2000.0 };
    let model = fem::Model::new(fem::ModelInput {
        mesh,
        materials: [(1, elastic.into()), (2, bodies.plan.elastic.into())].into(),
        ..fem::ModelInput::default()
    })
    .unwrap();
    let down = bodies.set_down(&model, &[0.7, 0.8]);
    for (k, base) in [0.7, 0.8].into_iter().enumerate() {
        let own = &down.mesh().coordinates[bodies.nodes_of(k)];
        let low = own.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
        assert!((low - base).abs() < 1e-12, "{low}");
    }
    assert_eq!(
        down.mesh().coordinates[..bodies.ground_nodes()],
        model.mesh().coordinates[..bodies.ground_nodes()]
    );
    assert!(std::ptr::eq(model.matrices(), down.matrices()));
    let (alone, surface) = bodies.alone(&model).unwrap();
    assert!((alone.total_mass() - bodies.mass()).abs() < 1e-9);
    assert_eq!((surface.faces().len(), bodies.telling_faces(&surface).len()), (bodies.face_count(), 2));
}
