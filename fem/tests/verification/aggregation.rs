//! CG with smoothed aggregation for statics, against the direct solver.

use crate::common::{Random, difference, fix};
use crate::mixed::block;
use trackbed_fem::statics::StaticSolver;
use trackbed_fem::{
    Elastic, ElementKind, Mesh, Method, Methods, Model, ModelInput, Quadrature, SolveError, loads, statics,
};

const SOIL: Elastic = Elastic { young: 60e6, poisson: 0.35, density: 1900.0 };
const STIFF: Elastic = Elastic { young: 300e6, poisson: 0.25, density: 2300.0 };

fn iterative(tolerance: f64) -> Methods {
    Methods { statics: Method::Iterative { tolerance }, ..Methods::default() }
}

/// Tapered block of two soils.
pub fn soils(kind: ElementKind, counts: [usize; 3], methods: Methods) -> Model {
    let size = [4.0, 3.0, 2.0];
    let mut mesh = match kind {
        ElementKind::Hex20 => Mesh::block(counts, size),
        kind => block(kind, counts, size),
    };
    for e in 0..mesh.element_count() {
        mesh.materials[e] = if mesh.element_centre(e)[2] > 1.0 { 2 } else { 1 };
    }
    mesh.coordinates.iter_mut().for_each(|x| x[0] = (x[0] - 2.0) * (1.0 - 0.2 * x[2]));
    let mut constraints = fix(&mesh, &[0, 1, 2], |x| x[2] < 1e-9);
    constraints.extend(fix(&mesh, &[1], |x| x[2] > 1e-9 && (x[1] < 1e-9 || x[1] > 3.0 - 1e-9)));
    Model::new(ModelInput {
        constraints,
        materials: [(1, SOIL.into()), (2, STIFF.into())].into(),
        quadrature: Quadrature::Gauss2,
        gravity: [0.0, 0.0, -9.81],
        methods,
        mesh,
        ..ModelInput::default()
    })
    .unwrap()
}

/// Gravity, pressure on part of the top, uneven support settlement.
pub fn solve(model: &Model) -> (statics::StaticSolution, u32) {
    let mut load = model.gravity_load();
    for face in model.mesh().boundary_faces() {
        let [x, y, z] = face.centre(model.mesh());
        if z > 2.0 - 1e-9 && x.abs() < 0.5 && y < 1.0 {
            loads::face_pressure(model.mesh(), &face, 80e3, &mut load);
        }
    }
    let settled = |dof: u32| if dof % 3 == 2 { 1e-4 * f64::from(dof % 7) } else { 0.0 };
    let settled: Vec<f64> = model.supports().fixed().iter().map(|(dof, _)| settled(*dof)).collect();
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve_prescribed(model, &load, Some(&settled)).unwrap();
    (solution, solver.counts().map_or(0, |c| c.most))
}

#[test]
fn statics_match_direct_solver() {
    let cases =
        [(ElementKind::Hex20, [8, 6, 5]), (ElementKind::Tet10, [6, 4, 4]), (ElementKind::Hex8, [12, 9, 7])];
    for (kind, counts) in cases {
        let (direct, none) = solve(&soils(kind, counts, Methods::default()));
        for tolerance in [1e-6, 1e-10] {
            let (found, most) = solve(&soils(kind, counts, iterative(tolerance)));
            let miss = difference(&found.u, &direct.u).max(difference(&found.reactions, &direct.reactions));
            println!("{}, tolerance {tolerance:.0e}: {most} iterations, differs by {miss:.1e}", kind.name());
            assert!(none == 0 && most > 3 && miss > 0.0 && miss < 100.0 * tolerance, "{miss:e}");
        }
    }
}

#[test]
fn iteration_count_independent_of_mesh_size() {
    let sizes = [[6, 5, 4], [12, 9, 8], [20, 16, 13]];
    let counts = sizes.map(|counts| {
        let model = soils(ElementKind::Hex20, counts, iterative(1e-8));
        let most = solve(&model).1;
        println!("{counts:?}, {} nodes: {most} iterations", model.mesh().node_count());
        most
    });
    // An unsmoothed prolongator takes 16, 20 and 25 iterations.
    assert!(counts.iter().all(|&c| c > 5 && 10 * c <= 13 * counts[0] && c < 20), "{counts:?}");
}

#[test]
fn static_bits_independent_of_thread_count() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = soils(ElementKind::Hex20, [11, 9, 8], iterative(1e-8));
            solve(&model).0.u.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = on(1);
    assert!(one == on(2) && one == on(3) && one == on(7));
}

#[test]
fn any_load_is_carried() {
    let model = soils(ElementKind::Hex20, [8, 6, 5], iterative(1e-9));
    let plain = soils(ElementKind::Hex20, [8, 6, 5], Methods::default());
    let (mut a, mut b) = (StaticSolver::new(&model).unwrap(), StaticSolver::new(&plain).unwrap());
    let mut random = Random(3);
    for _ in 0..3 {
        let load: Vec<f64> = (0..model.dof_count()).map(|_| 1e3 * random.next()).collect();
        let miss = difference(&a.solve(&model, &load).unwrap().u, &b.solve(&plain, &load).unwrap().u);
        assert!(miss < 1e-7, "{miss:e}");
    }
    assert!(a.counts().unwrap().solves >= 3);
}

/// Two blocks joined along one line of nodes.
pub fn hinged(methods: Methods) -> Model {
    let whole = Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]);
    let mut mesh = Mesh { coordinates: whole.coordinates.clone(), ..Mesh::default() };
    for e in 0..2 {
        let mut nodes = whole.connectivity[e].to_vec();
        for n in nodes.iter_mut().filter(|_| e == 1) {
            let place = whole.coordinates[*n as usize];
            if (place[0] - 1.0).abs() < 1e-9 && place[2] < 1.0 - 1e-9 {
                mesh.coordinates.push(place);
                *n = mesh.coordinates.len() as u32 - 1;
            }
        }
        mesh.push_element(e as u32 + 1, 1, ElementKind::Hex20, &nodes);
    }
    mesh.node_ids = (1..=mesh.coordinates.len() as u32).collect();
    Model::new(ModelInput {
        mesh,
        constraints: fix(&whole, &[0, 1, 2], |x| x[0] < 1e-9),
        materials: [(1, SOIL.into())].into(),
        quadrature: Quadrature::Gauss3,
        gravity: [0.0, 0.0, -9.81],
        methods,
        ..ModelInput::default()
    })
    .unwrap()
}

#[test]
fn a_mechanism_is_no_solution() {
    for methods in [Methods::default(), iterative(1e-8)] {
        let model = hinged(methods);
        let error = statics::solve(&model, &model.gravity_load()).unwrap_err();
        println!("{error}");
        let iterated = matches!(
            error,
            SolveError::Singular | SolveError::NotConverged { .. } | SolveError::Inaccurate { .. }
        );
        assert!(iterated || matches!(error, SolveError::NoStiffness { .. }), "{error}");
    }
}
