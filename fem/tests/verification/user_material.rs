//! User materials of the shipped sources: arguments, failures, laws against references.
//!
//! Tolerance: 1e-10 against laws of this crate, 1e-6 against independent integrations.

use crate::common::Random;
use crate::plastic_common::tight;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use trackbed_fem::material::umat::{LibraryError, Routine, UserEnergy, UserOptions, UserTangent};
use trackbed_fem::material::{CallError, UpdateContext, UserMaterial};
use trackbed_fem::nonlinear::{LoadFunctions, QuasiStatic, StepControl};
use trackbed_fem::{
    Cone, Constraint, DruckerPrager, Elastic, Material, Mesh, Model, ModelInput, Point, PointState, Response,
    ReturnError, SolveError, State, StateValue, TimeIntegrator,
};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 1900.0 };
const SHIPPED: &str = "../inputs/solid/umat";
const PROBE: &str = "tests/verification/user_material/probe.c";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Compiles a source of the crate's folder with `compiler`.
fn compile(compiler: &str, source: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = format!("trackbed-umat-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    let library = folder.join("law.so");
    let options = ["-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o"];
    let mut command = Command::new(compiler);
    command.current_dir(&folder).args(options).arg(&library).arg(root().join(source)).arg("-lm");
    let done = command.output().unwrap_or_else(|e| panic!("{compiler}: {e}"));
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    library
}

fn routine(library: &Path) -> Routine {
    // SAFETY: the library was just compiled.
    let loaded = unsafe { libloading::Library::new(library) }.unwrap();
    Routine::new(loaded, library, "umat_").unwrap()
}

fn states(names: &[(&str, f64)]) -> Vec<(StateValue, f64)> {
    let value = |name: &str| StateValue { name: name.to_string().into(), unit: "".into() };
    names.iter().map(|(name, initial)| (value(name), *initial)).collect()
}

fn probe_options(mode: f64, limit: f64) -> UserOptions {
    let names: Vec<String> = (0..20).map(|k| format!("s{k}")).collect();
    let states = states(&names.iter().map(|n| (n.as_str(), 0.0)).collect::<Vec<_>>());
    UserOptions { name: "soil".into(), constants: vec![mode, limit], states, ..UserOptions::default() }
}

fn probe(mode: f64, limit: f64, change: impl Fn(&mut UserOptions)) -> Material {
    let mut options = probe_options(mode, limit);
    change(&mut options);
    let law = UserMaterial::new(routine(&compile("cc", Path::new(PROBE))), options).unwrap();
    Material::plastic(SOIL, law)
}

/// Shipped Drucker–Prager law with the constants of `law`.
pub fn drucker_prager(elastic: &Elastic, law: &DruckerPrager, energy: UserEnergy) -> Material {
    let phi = law.friction.at(0.0).0;
    let [eta, xi, ..] = law.cone.coefficients(phi);
    let flow = law.cone.coefficients(law.dilation)[0];
    let constants = vec![elastic.young, elastic.poisson, eta, xi * law.cohesion.at(0.0).0, flow];
    let options =
        UserOptions { constants, states: states(&[("kappa", 0.0)]), energy, ..UserOptions::default() };
    let library = compile("cc", &Path::new(SHIPPED).join("drucker_prager.c"));
    Material::plastic(*elastic, UserMaterial::new(routine(&library), options).unwrap())
}

/// One point of a material.
struct Walk<'a> {
    material: &'a Material,
    state: PointState,
    values: Vec<f64>,
    context: UpdateContext,
}

impl<'a> Walk<'a> {
    fn new(material: &'a Material, stress: [f64; 6]) -> Walk<'a> {
        let mut values = vec![0.0; material.law.state_values().len()];
        material.law.initial_values(&material.elastic, &stress, &mut values);
        let state = PointState { stress, ..PointState::default() };
        Walk { material, state, values, context: UpdateContext::default() }
    }

    fn point(&self) -> Point<'_> {
        Point { state: &self.state, values: &self.values, context: self.context }
    }

    fn step(&mut self, increment: &[f64; 6]) -> Result<Response, ReturnError> {
        let mut values = vec![f64::NAN; self.values.len()];
        let law = &self.material.law;
        let response = law.update(&self.material.elastic, self.point(), increment, true, &mut values)?;
        (self.state, self.values) = (response.state, values);
        Ok(response)
    }
}

/// Entry of the probe's matrix by tensor components.
fn entry(row: &str, column: &str) -> f64 {
    // Order of Abaqus.
    let index = |name: &str| ["xx", "yy", "zz", "xy", "zx", "yz"].iter().position(|n| *n == name).unwrap();
    let (i, j) = (index(row), index(column));
    1e6 * (10 * (i + 1) + j + 1) as f64 + if i == j { 1e8 } else { 0.0 }
}

const NAMES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

#[test]
fn components_follow_their_names() {
    for (mode, tangent) in
        [(0.0, UserTangent::Library), (0.0, UserTangent::Differences), (6.0, UserTangent::Library)]
    {
        let material = probe(mode, 1.0, |options| options.tangent = tangent);
        let start = [-1e5, -2e5, -3e5, 1e4, 2e4, 3e4];
        let increment = [1e-4, -2e-4, 3e-4, -4e-4, 5e-4, -6e-4];
        let mut walk = Walk::new(&material, start);
        let response = walk.step(&increment).unwrap();
        for (i, row) in NAMES.iter().enumerate() {
            let change: f64 = NAMES.iter().zip(&increment).map(|(column, e)| entry(row, column) * e).sum();
            let miss = (response.state.stress[i] - start[i] - change).abs();
            assert!(miss < 1e-9 * 1e5, "{row}: {miss}");
            for (j, column) in NAMES.iter().enumerate() {
                let miss = (response.tangent[i][j] / entry(row, column) - 1.0).abs();
                let limit = if mode == 0.0 && tangent == UserTangent::Library { 0.0 } else { 1e-6 };
                assert!(miss <= limit, "{row} {column}: {} {}", response.tangent[i][j], entry(row, column));
            }
        }
    }
}

#[test]
fn arguments_are_those_of_the_increment() {
    let material = probe(0.0, 1.0, |options| options.energy = UserEnergy::Library);
    let mut walk = Walk::new(&material, [0.0; 6]);
    walk.context = UpdateContext { time: 2.5, time_step: 0.125, element: 42, point: 7 };
    let strain = [1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4];
    walk.step(&strain).unwrap();
    assert_eq!(walk.values[..6], [2.5, 2.5, 0.125, 42.0, 7.0, 1.0]);
    assert_eq!(walk.values[6..12], [0.0; 6]);
    assert_eq!(walk.values[12..17], [336.0, 2002.0, 113.0, 1101.0, 1111.0]);
    walk.step(&strain).unwrap();
    assert_eq!(walk.values[5], 2.0);
    // Strain of the first increment, 11 22 33 12 13 23.
    assert_eq!(walk.values[6..12], [1e-4, 2e-4, 3e-4, 4e-4, 6e-4, 5e-4]);
    assert_eq!(walk.values[20..26], strain.map(|e| 2.0 * e));
    assert_eq!(walk.values[26..], [2.0, 4.0, 6.0, 8.0]);
    assert_eq!(material.law.stored_energy(&SOIL, walk.point()), 4.0);
    let start = Walk::new(&material, [0.0; 6]);
    assert_eq!(material.law.dissipation(start.point(), walk.point()), Some(14.0));
    // Equilibrium before the start.
    walk.context.time = -0.75;
    walk.step(&[0.0; 6]).unwrap();
    assert_eq!(walk.values[..3], [0.0, 0.0, 0.125]);
}

#[test]
fn failures_leave_the_state() {
    let expected = [
        (1.0, "a shorter step requested (PNEWDT = 0.5)"),
        (2.0, "STRESS not finite"),
        (3.0, "STATEV not finite"),
        (4.0, "DDSDDE not finite"),
        (5.0, "STATEV written beyond its 20 values"),
    ];
    for (mode, message) in expected {
        let material = probe(mode, 1.0, |_| ());
        let mut walk = Walk::new(&material, [-1e5; 6]);
        let (state, values) = (walk.state, walk.values.clone());
        assert_eq!(walk.step(&[1e-5; 6]).unwrap_err().to_string(), message);
        assert_eq!((walk.state, walk.values), (state, values));
    }
}

#[test]
fn rejects_other_counts_and_missing_routine() {
    let library = compile("cc", Path::new(PROBE));
    let counts = |change: fn(&mut UserOptions)| {
        let mut options = probe_options(0.0, 1.0);
        change(&mut options);
        UserMaterial::new(routine(&library), options).unwrap_err()
    };
    let path = library.clone();
    let error = counts(|options| options.constants.push(1.0));
    assert_eq!(error, LibraryError::Constants { path: path.clone(), found: 3, expected: 2 });
    let error = counts(|options| options.states.truncate(3));
    assert_eq!(error, LibraryError::States { path, found: 3, expected: 20 });
    // SAFETY: the library was just compiled.
    let loaded = unsafe { libloading::Library::new(&library) }.unwrap();
    let error = Routine::new(loaded, &library, "vumat_").unwrap_err().to_string();
    assert!(error.starts_with("no symbol `vumat_` in "), "{error}");
}

#[test]
fn drucker_prager_matches_that_of_the_crate() {
    let law = DruckerPrager {
        cohesion: 5e3.into(),
        friction: 0.5.into(),
        dilation: 0.2,
        cone: Cone::PlaneStrain,
        tension: None,
    };
    let ours = Material::plastic(SOIL, law.clone());
    for energy in [UserEnergy::Reference, UserEnergy::Library] {
        let theirs = drucker_prager(&SOIL, &law, energy);
        let (mut random, mut plastic) = (Random(7), 0);
        let mut walks = [
            Walk::new(&ours, [-50e3, -50e3, -50e3, 0.0, 0.0, 0.0]),
            Walk::new(&theirs, [-50e3, -50e3, -50e3, 0.0, 0.0, 0.0]),
        ];
        let mut drift = [0.0; 6];
        for step in 0..400 {
            if step % 20 == 0 {
                drift = std::array::from_fn(|_| 3e-4 * random.next());
            }
            let increment: [f64; 6] = std::array::from_fn(|k| drift[k] + 1e-4 * random.next());
            let old = [walks[0].state, walks[1].state];
            let values = walks[1].values.clone();
            let [a, b] = [0, 1].map(|k| walks[k].step(&increment).unwrap());
            plastic += usize::from(a.region.is_plastic());
            assert_eq!(a.region.is_plastic(), b.region.is_plastic());
            let size = 1e5;
            for i in 0..6 {
                assert!((a.state.stress[i] - b.state.stress[i]).abs() < 1e-10 * size);
                let strain = (a.state.plastic_strain[i] - b.state.plastic_strain[i]).abs();
                assert!(strain < 1e-10 * 0.1, "{strain:e}");
                for j in 0..6 {
                    assert!((a.tangent[i][j] - b.tangent[i][j]).abs() < 1e-10 * SOIL.young);
                }
            }
            assert!(
                (a.state.kappa - b.state.kappa).abs() < 1e-10
                    && (a.state.kappa - walks[1].values[0]).abs() < 1e-10
            );
            let stored = walks.each_ref().map(|w| w.material.law.stored_energy(&SOIL, w.point()));
            assert!((stored[0] - stored[1]).abs() < 1e-9 * 100.0, "{stored:?}");
            let before = Point::new(&old[1], &values);
            if let Some(lost) = theirs.law.dissipation(before, walks[1].point()) {
                let work: f64 = (0..6)
                    .map(|k| {
                        0.5 * (old[0].stress[k] + a.state.stress[k])
                            * (a.state.plastic_strain[k] - old[0].plastic_strain[k])
                    })
                    .sum();
                assert!((lost - work).abs() < 1e-9 * 100.0, "{lost} {work}");
            }
        }
        assert!(plastic > 100, "{plastic}");
    }
}

/// Elastic routine against Hooke's law.
fn check_elastic(library: &Path) {
    let options = UserOptions { constants: vec![SOIL.young, SOIL.poisson], ..UserOptions::default() };
    let material = Material::plastic(SOIL, UserMaterial::new(routine(library), options).unwrap());
    let mut walk = Walk::new(&material, [-1e5, -2e5, -3e5, 1e4, 2e4, 3e4]);
    let (mut random, mut stress) = (Random(3), walk.state.stress);
    for _ in 0..50 {
        let increment: [f64; 6] = std::array::from_fn(|_| 1e-4 * random.next());
        let step = SOIL.stress(&increment);
        (0..6).for_each(|k| stress[k] += step[k]);
        let response = walk.step(&increment).unwrap();
        assert!(!response.region.is_plastic());
        for i in 0..6 {
            assert!((response.state.stress[i] - stress[i]).abs() < 1e-10 * 3e5);
            for j in 0..6 {
                assert!((response.tangent[i][j] - SOIL.matrix()[i][j]).abs() < 1e-10 * SOIL.young);
            }
        }
    }
}

#[test]
fn elastic_routine_in_c_is_hooke() {
    check_elastic(&compile("cc", &Path::new(SHIPPED).join("elastic.c")));
}

#[test]
fn elastic_routine_in_fortran_is_hooke() {
    if Command::new("gfortran").arg("--version").output().is_err() {
        eprintln!("skipped: no gfortran on this machine, so the routine in Fortran is not built");
        return;
    }
    check_elastic(&compile("gfortran", &Path::new(SHIPPED).join("elastic.f90")));
}

/// Constants of `hypoplastic_sand.c` without added pressure.
const SAND: [f64; 9] = [33.0, 1500e6, 0.28, 0.55, 0.95, 1.05, 0.25, 1.0, 0.0];

fn sand(void_ratio: f64) -> Material {
    let states = states(&[("void_ratio", void_ratio)]);
    let options = UserOptions { constants: SAND.to_vec(), states, ..UserOptions::default() };
    let library = compile("cc", &Path::new(SHIPPED).join("hypoplastic_sand.c"));
    Material::plastic(SOIL, UserMaterial::new(routine(&library), options).unwrap())
}

/// Loosest void ratio at the pressure p (Bauer 1996).
fn loosest(p: f64) -> f64 {
    SAND[5] * (-(3.0 * p / SAND[1]).powf(SAND[2])).exp()
}

#[test]
fn loosest_sand_follows_isotropic_compression_law() {
    let (start, mut worst) = (10e3, 0.0_f64);
    let material = sand(loosest(start));
    let mut walk = Walk::new(&material, [-start, -start, -start, 0.0, 0.0, 0.0]);
    for _ in 0..200 {
        walk.step(&[-2e-4, -2e-4, -2e-4, 0.0, 0.0, 0.0]).unwrap();
        let p = -(walk.state.stress[0] + walk.state.stress[1] + walk.state.stress[2]) / 3.0;
        worst = worst.max((walk.values[0] / loosest(p) - 1.0).abs());
    }
    println!("p = {:.3e} Pa, e misses by {worst:.1e}", -walk.state.stress[0]);
    assert!(worst < 1e-7 && walk.state.stress[0] < -500e3);
    // Critical friction angle: no change of stress and volume in triaxial compression.
    let sine = SAND[0].to_radians().sin();
    let (axial, lateral) = (-(1.0 + sine) * 100e3, -(1.0 - sine) * 100e3);
    let p = -(axial + 2.0 * lateral) / 3.0;
    let material = sand(SAND[4] * (-(3.0 * p / SAND[1]).powf(SAND[2])).exp());
    let mut walk = Walk::new(&material, [lateral, lateral, axial, 0.0, 0.0, 0.0]);
    walk.step(&[5e-5, 5e-5, -1e-4, 0.0, 0.0, 0.0]).unwrap();
    assert!(
        (walk.state.stress[2] - axial).abs() < 1e-7 * p && (walk.state.stress[0] - lateral).abs() < 1e-7 * p
    );
}

/// Rates of axial and lateral stress and void ratio by axial strain in oedometric compression, compression positive:
/// von Wolffersdorff (1996) for axial symmetry, where F = 1 in compression.
fn oedometer([s1, s3, e]: [f64; 3]) -> [f64; 3] {
    let [phi, hs, n, ed0, ec0, ei0, alpha, beta, _] = SAND;
    let (sine, sum) = (phi.to_radians().sin(), s1 + 2.0 * s3);
    let a = 3.0_f64.sqrt() * (3.0 - sine) / (2.0 * 2.0_f64.sqrt() * sine);
    let bauer = (-(sum / hs).powf(n)).exp();
    let (ed, ec, ei) = (ed0 * bauer, ec0 * bauer, ei0 * bauer);
    let (h1, h3) = (s1 / sum, s3 / sum);
    let fd = ((e - ed) / (ec - ed)).powf(alpha);
    let fs = (ec / e).powf(beta) * hs / n * (ei0 / ec0).powf(beta) * (1.0 + ei) / ei
        * (sum / hs).powf(1.0 - n)
        / (3.0 + a * a - a * 3.0_f64.sqrt() * ((ei0 - ed0) / (ec0 - ed0)).powf(alpha))
        / (h1 * h1 + 2.0 * h3 * h3);
    let rate = |h: f64, d: f64| fs * (d + a * a * h1 * h - fd * a * (2.0 * h - 1.0 / 3.0));
    [rate(h1, 1.0), rate(h3, 0.0), -(1.0 + e)]
}

#[test]
fn oedometer_of_sand_matches_independent_integration() {
    let material = sand(0.7);
    let mut walk = Walk::new(&material, [-25e3, -25e3, -50e3, 0.0, 0.0, 0.0]);
    let mut x = [50e3, 25e3, 0.7];
    let (steps, h, mut worst) = (100, 1e-6, 0.0_f64);
    for _ in 0..steps {
        walk.step(&[0.0, 0.0, -2e-4, 0.0, 0.0, 0.0]).unwrap();
        for _ in 0..200 {
            let next = |k: [f64; 3], f: f64| std::array::from_fn(|i| x[i] + f * k[i]);
            let k1 = oedometer(x);
            let k2 = oedometer(next(k1, 0.5 * h));
            x = next(k2, h);
        }
        let stress = walk.state.stress;
        worst = worst.max((-stress[2] / x[0] - 1.0).abs()).max((-stress[0] / x[1] - 1.0).abs());
        worst = worst.max((walk.values[0] / x[2] - 1.0).abs());
    }
    println!("s1 {:.4e} s3 {:.4e} e {:.5}: {worst:.1e}", x[0], x[1], x[2]);
    assert!(worst < 1e-6 && x[0] > 200e3, "{worst:e}");
}

/// Column of one element pressed by `strain`.
fn press(material: Material, strain: f64, control: StepControl) -> (Result<(), SolveError>, State, u64) {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let at = |node: u32, direction: u8| mesh.coordinates[node as usize][direction as usize];
    let dofs = (0..mesh.node_count() as u32).flat_map(|node| (0..3).map(move |direction| (node, direction)));
    let held = dofs.filter(|&(node, direction)| [0.0, 1.0].contains(&at(node, direction)));
    let constraints = held.map(|(node, direction)| Constraint { node, direction, value: 0.0 }).collect();
    let model = Model::new(ModelInput {
        mesh: mesh.clone(),
        materials: [(1, material)].into(),
        constraints,
        ..Default::default()
    })
    .unwrap();
    let fixed = model.supports().fixed().iter();
    let ends: Vec<f64> =
        fixed.map(|(dof, _)| if dof % 3 == 2 && at(dof / 3, 2) == 1.0 { -strain } else { 0.0 }).collect();
    let mut loading = LoadFunctions {
        load: |_: f64, _: &mut [f64]| (),
        prescribed: |time: f64, values: &mut [f64]| {
            values.iter_mut().zip(&ends).for_each(|(value, end)| *value = time * end);
        },
    };
    let mut state = State { points: model.new_points(), ..State::new(&model) };
    let mut solver = QuasiStatic::new(&model, tight(), control).unwrap();
    let outcome = solver.integrate(&model, &mut state, 1.0, &mut loading, &mut |_, _, _| ());
    (outcome, state, solver.statistics().halvings)
}

#[test]
fn shorter_steps_are_halved() {
    let control = StepControl { initial: 1.0, min: 1e-3, max: 1.0, target_iterations: 40 };
    let (outcome, state, halvings) = press(probe(0.0, 3e-4, |_| ()), 1e-3, control);
    outcome.unwrap();
    assert!(halvings >= 2, "{halvings}");
    let (_, whole, none) = press(probe(0.0, 1.0, |_| ()), 1e-3, control);
    assert_eq!(none, 0);
    let [found, expected] = [&state, &whole].map(|state| state.points[0].stress[2]);
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    let (outcome, ..) = press(probe(1.0, 1.0, |_| ()), 1e-3, control);
    let error = outcome.unwrap_err();
    let SolveError::UserMaterial { element: 1, point: 1, cause, .. } = &error else { panic!("{error}") };
    assert_eq!(*cause, ReturnError::UserMaterial(CallError::ShorterStep { pnewdt: 0.5 }));
    let message = error.to_string();
    assert!(
        message.starts_with("user material `umat_` of ") && message.contains("law.so failed at time 0"),
        "{message}"
    );
}
