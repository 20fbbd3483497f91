//! MUMPS against the built-in direct solver, and builds without it.

use crate::aggregation::hinged;
use trackbed_fem::solver::mumps::MumpsError;
use trackbed_fem::{Method, Methods, MumpsMethod, SolveError, statics};

fn by(method: MumpsMethod) -> Methods {
    Methods { statics: Method::Mumps(method), dynamics: Method::Mumps(method) }
}

#[test]
fn a_program_without_it_says_so() {
    let model = hinged(by(MumpsMethod::default()));
    let error = statics::solve(&model, &model.gravity_load()).unwrap_err();
    assert_eq!(
        error == SolveError::Library(MumpsError::Missing.to_string()),
        !cfg!(feature = "mumps"),
        "{error}"
    );
}

#[cfg(feature = "mumps")]
mod library {
    use super::by;
    use crate::aggregation::{hinged, soils as block, solve};
    use crate::common::difference;
    use crate::iterative::{loads, predict, soils, windows};
    use trackbed_fem::solver::mumps::MumpsError;
    use trackbed_fem::statics::StaticSolver;
    use trackbed_fem::theta::{ThetaMethod, ThetaSolver};
    use trackbed_fem::{ElementKind, Mass, Method, Methods, MumpsMethod, Regime, SolveError, State, statics};

    const OUT_OF_CORE: MumpsMethod = MumpsMethod { out_of_core: true };

    /// Two exact factors: rounding times the condition number, about 1e4, gives 1e-12.
    #[test]
    fn statics_match_direct_solver() {
        let cases = [(ElementKind::Hex20, [8, 6, 5]), (ElementKind::Tet10, [6, 4, 4])];
        for (kind, counts) in cases {
            let (own, _) = solve(&block(kind, counts, Methods::default()));
            for out_of_core in [false, true] {
                let method = MumpsMethod { out_of_core };
                let (found, iterations) = solve(&block(kind, counts, by(method)));
                let miss = difference(&found.u, &own.u).max(difference(&found.reactions, &own.reactions));
                println!("{}, out of core {out_of_core}: differs by {miss:.1e}", kind.name());
                assert!(iterations == 0 && miss > 0.0 && miss < 1e-11, "{miss:e}");
            }
        }
    }

    #[test]
    fn windows_match_direct_solver() {
        for (mass, theta) in [(Mass::Lumped, 0.5), (Mass::Consistent, 0.55)] {
            let model = |methods| soils(ElementKind::Hex20, [5, 4, 4], mass, methods);
            let (own, _) = windows(&model(Methods::default()), theta);
            for out_of_core in [false, true] {
                let method = MumpsMethod { out_of_core };
                let (found, iterations) = windows(&model(by(method)), theta);
                let miss = difference(&found.u, &own.u).max(difference(&found.v, &own.v));
                println!("{mass:?}, theta {theta}, out of core {out_of_core}: differs by {miss:.1e}");
                assert!(iterations == 0 && miss > 0.0 && miss < 1e-11, "{miss:e}");
            }
        }
    }

    #[test]
    fn predictions_match_direct_solver() {
        let (own, iterations) = predict(Methods::default());
        for method in [MumpsMethod::default(), OUT_OF_CORE] {
            let (found, made) = predict(by(method));
            let miss = difference(&found, &own);
            println!("{made} iterations, {iterations} on the own factor: differ by {miss:.1e}");
            assert!(miss < 1e-6 && made.abs_diff(iterations) < 3, "{miss:e}");
        }
    }

    /// The singular pivot belongs to the second block or to the hinge.
    #[test]
    fn a_mechanism_is_named() {
        for method in [MumpsMethod::default(), OUT_OF_CORE] {
            let model = hinged(by(method));
            let error = statics::solve(&model, &model.gravity_load()).unwrap_err();
            println!("{error}");
            let SolveError::NoStiffness { node, .. } = error else { panic!("{error}") };
            let place = model.mesh().coordinates[node as usize - 1];
            assert!(place[0] > 1.0 - 1e-9, "node {node} at {place:?}");
        }
    }

    /// Instances share library variables.
    #[test]
    fn concurrent_solvers_are_independent() {
        let model = block(ElementKind::Hex20, [6, 5, 4], by(MumpsMethod::default()));
        let alone = solve(&model).0;
        std::thread::scope(|scope| {
            let all: Vec<_> = (0..4).map(|_| scope.spawn(|| solve(&model).0)).collect();
            all.into_iter().for_each(|t| assert!(t.join().unwrap() == alone));
        });
    }

    #[test]
    fn the_memory_is_known_before() {
        for method in [MumpsMethod::default(), OUT_OF_CORE] {
            let model = block(ElementKind::Hex20, [14, 12, 10], by(method));
            let (expected, peak) = (
                model.solver_memory(Method::Mumps(method), Regime::Statics).unwrap(),
                StaticSolver::new(&model).unwrap().solver_memory().unwrap(),
            );
            println!("{method:?}: {expected} bytes expected, {peak} peak");
            assert!(expected >= peak && expected < 3 * peak, "{expected} {peak}");
        }
    }

    #[test]
    fn missing_directory_is_an_error() {
        // The directory is set per process.
        if std::env::var_os("TRACKBED_NO_FOLDER").is_none() {
            let output = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "mumps::library::missing_directory_is_an_error"])
                .env("TRACKBED_NO_FOLDER", "1")
                .env("TMPDIR", "/no/such/folder")
                .output()
                .unwrap();
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            assert!(output.status.success() && text.contains("1 passed"), "{text}");
            return;
        }
        let method = OUT_OF_CORE;
        let model = block(ElementKind::Hex20, [3, 3, 3], by(method));
        let error = StaticSolver::new(&model).err().unwrap();
        assert_eq!(error, SolveError::Library(MumpsError::Files.to_string()));
    }

    #[test]
    fn new_solver_continues_bitwise_identically() {
        let model = soils(ElementKind::Hex20, [5, 4, 4], Mass::Lumped, by(MumpsMethod::default()));
        let loads = loads(&model, 6);
        let new = || ThetaSolver::new(&model, 0.6, 1e-4).unwrap();
        let (mut whole, mut parts, mut solver) = (State::new(&model), State::new(&model), new());
        for load in &loads {
            solver.step(&model, &mut whole, load).unwrap();
            new().step(&model, &mut parts, load).unwrap();
        }
        assert!(whole == parts);
    }
}
