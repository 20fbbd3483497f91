//! Modes against closed forms and other programs.

use crate::common::{fix, model};
use trackbed_fem::boundary::BoundaryLayer;
use trackbed_fem::element::quadrature::Quadrature::{Gauss2, Gauss3};
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::Mesh;
use trackbed_fem::modal::{self, ModalError, Modes};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::{Mass, SolveError};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };
const STEEL: Elastic = Elastic { young: 210e9, poisson: 0.3, density: 7850.0 };

/// Largest entry of `Φ·M Φ - 1`.
fn orthogonality(model: &Model, modes: &Modes) -> f64 {
    let mut product = vec![0.0; model.dof_count()];
    let mut worst = 0.0_f64;
    for (i, a) in modes.shapes.iter().enumerate() {
        model.mass_times(a, &mut product);
        for (j, b) in modes.shapes.iter().enumerate() {
            let dot: f64 = b.iter().zip(&product).map(|(b, p)| b * p).sum();
            worst = worst.max((dot - f64::from(u8::from(i == j))).abs());
        }
    }
    worst
}

/// Map of the distorted cases in `tests/data/modal/reference.py`.
fn bend(x: [f64; 3]) -> [f64; 3] {
    [
        x[0] + 0.06 * (2.1 * x[1] + 1.3 * x[2]).sin(),
        x[1] + 0.05 * (1.7 * x[0] - 2.3 * x[2]).sin(),
        x[2] + 0.04 * (2.9 * x[0] + 1.1 * x[1]).sin(),
    ]
}

fn straighten(mesh: &mut Mesh) {
    for e in 0..mesh.element_count() {
        for (m, [a, b]) in mesh.connectivity.kind(e).edges().iter().enumerate() {
            let nodes = &mesh.connectivity[e];
            let (mid, a, b) = (nodes[8 + m] as usize, nodes[*a] as usize, nodes[*b] as usize);
            mesh.coordinates[mid] =
                std::array::from_fn(|k| 0.5 * (mesh.coordinates[a][k] + mesh.coordinates[b][k]));
        }
    }
}

/// scikit-fem 12.0.2 (ElementHexS2) with scipy's eigsh; curved mesh: independent assembly. See
/// `tests/data/modal/reference.py`.
#[test]
fn frequencies_are_those_of_other_programs() {
    let block = Mesh::block([3, 2, 4], [1.0, 0.8, 1.5]);
    let held = fix(&block, &[0, 1, 2], |x| x[2] == 0.0);
    let mut curved = block.clone();
    curved.coordinates.iter_mut().for_each(|x| *x = bend(*x));
    let mut straight = curved.clone();
    straighten(&mut straight);
    let free = Mesh::block([2, 2, 3], [1.0, 0.9, 1.3]);
    for (name, mesh, constraints, table) in [
        ("clamped", block, held.clone(), include_str!("../data/modal/clamped.csv")),
        ("free", free, Vec::new(), include_str!("../data/modal/free.csv")),
        ("distorted", straight.clone(), held.clone(), include_str!("../data/modal/distorted.csv")),
        ("distorted_free", straight, Vec::new(), include_str!("../data/modal/distorted_free.csv")),
        ("curved", curved, held, include_str!("../data/modal/curved.csv")),
    ] {
        let is_free = constraints.is_empty();
        let model = model(mesh, constraints, SOIL, Gauss3);
        let modes = modal::solve(&model, 20).unwrap();
        let table: Vec<f64> =
            table.lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert_eq!((table.len(), modes.frequencies.len()), (20, 20));
        assert_eq!(modes.zero_modes, if is_free { 6 } else { 0 });
        let first = modes.zero_modes;
        let worst =
            (first..20).map(|i| (modes.frequencies[i] / table[i] - 1.0).abs()).fold(0.0_f64, f64::max);
        let residual = modes.residuals.iter().fold(0.0_f64, |m, r| m.max(*r));
        let orthogonality = orthogonality(&model, &modes);
        println!(
            "modal {name}: {worst:.1e} from the table, residual {residual:.1e}, orthogonality {orthogonality:.1e}, \
             rigid {:.1e} Hz of {:.3} Hz",
            modes.frequencies[..first].iter().fold(0.0_f64, |m, f| m.max(*f)),
            modes.frequencies[first]
        );
        assert!(worst < 1e-8, "{name}: {:?} {table:?}", modes.frequencies);
        assert!(modes.frequencies[..first].iter().all(|f| *f < 1e-4 * modes.frequencies[first]));
        assert!(residual < 1e-8 && orthogonality < 1e-10);
    }
}

/// `f_n = (2 n - 1) c/(4 L)`, compression wave speed c (Clough and Penzien, chapter 20). 20 quadratic
/// elements: 1e-6 of the first, 2e-4 of the fifth.
#[test]
fn bar_frequencies_match_closed_form() {
    let mesh = Mesh::block([1, 1, 20], [0.5, 0.5, 10.0]);
    let mut constraints = fix(&mesh, &[0, 1], |_| true);
    constraints.extend(fix(&mesh, &[2], |x| x[2] == 0.0));
    let bar = model(mesh, constraints, SOIL, Gauss3);
    let modes = modal::solve(&bar, 5).unwrap();
    let c = SOIL.compression_wave_speed();
    let mut total = 0.0;
    for (n, f) in modes.frequencies.iter().enumerate() {
        let odd = (2 * n + 1) as f64;
        let error = f / (odd * c / 40.0) - 1.0;
        // Effective mass ratio of mode n: 8/(odd² pi²) (Clough and Penzien, section 13-3).
        let share = modes.effective_mass[n][2] / bar.total_mass();
        let exact = 8.0 / (odd * std::f64::consts::PI).powi(2);
        println!("bar mode {}: frequency {error:+.1e}, effective mass {:+.1e}", n + 1, share / exact - 1.0);
        assert!(error > 0.0 && error < 2e-6 * odd.powi(4), "{error:e}");
        assert!((share / exact - 1.0).abs() < 1e-3 && modes.effective_mass[n][0] < 1e-12 * bar.total_mass());
        total += share;
    }
    assert!(total > 0.95 && total < 1.0);
}

/// Cantilever, L/h = 40: `beta² sqrt(EI/(m L^4))`, beta = 1.8751, 4.6941 (Euler-Bernoulli), with
/// first-order Timoshenko correction; both within 1 %.
#[test]
fn beam_bending_frequencies_match_closed_form() {
    let (length, height, width) = (8.0, 0.2, 0.3);
    let mesh = Mesh::block([20, 1, 1], [length, width, height]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[0] == 0.0);
    // Slender hex20 with the full rule: no zero-energy modes.
    let beam = model(mesh, constraints, Elastic { poisson: 0.0, ..STEEL }, Gauss3);
    let modes = modal::solve(&beam, 8).unwrap();
    let mut checked = 0;
    for (direction, depth) in [(2, height), (1, width)] {
        let bending: Vec<f64> = (0..8)
            .filter(|&i| modes.effective_mass[i][direction] > 1e-3 * beam.total_mass())
            .map(|i| modes.circular[i])
            .collect();
        for (n, beta) in [1.875_104_07_f64, 4.694_091_13].into_iter().enumerate() {
            let radius = depth / 12.0_f64.sqrt();
            let (e, rho) = (STEEL.young, STEEL.density);
            let euler = (beta / length).powi(2) * radius * (e / rho).sqrt();
            // Timoshenko: w = w_E (1 - (beta r/L)² (1 + E/(k G))/2), k = 5/6.
            let timoshenko = euler * (1.0 - 0.5 * (beta * radius / length).powi(2) * (1.0 + 2.0 * 6.0 / 5.0));
            let errors = (bending[n] / euler - 1.0, bending[n] / timoshenko - 1.0);
            println!(
                "beam along {direction}, mode {}: Euler {:+.2e}, Timoshenko {:+.2e}",
                n + 1,
                errors.0,
                errors.1
            );
            assert!(errors.0.abs() < 1e-2 && errors.1.abs() < 3e-3, "{errors:?}");
            checked += 1;
        }
    }
    assert_eq!(checked, 4);
}

#[test]
fn no_mode_is_missed() {
    let cube = Mesh::block([2, 2, 2], [1.0; 3]);
    let single = Mesh::block([1, 1, 1], [1.0; 3]);
    let apart = |count: u32| {
        let mut mesh = single.clone();
        for body in 1..count {
            let shift = 3.0 * f64::from(body);
            mesh.coordinates.extend(single.coordinates.iter().map(|c| [c[0] + shift, c[1], c[2]]));
            let nodes: Vec<u32> = single.connectivity[0].iter().map(|n| n + 20 * body).collect();
            mesh.push_element(body + 1, 1, trackbed_fem::ElementKind::Hex20, &nodes);
        }
        mesh.node_ids = (1..=20 * count).collect();
        mesh
    };
    for (name, mesh, held, mass, counts) in [
        ("free cube", cube.clone(), false, Mass::Consistent, vec![1, 6, 7, 30]),
        ("clamped cube", cube, true, Mass::Lumped, vec![3, 24]),
        ("two cubes", apart(2), false, Mass::Consistent, vec![12, 13, 40, 1000]),
        ("eight cubes", apart(8), false, Mass::Consistent, vec![8, 48, 50]),
    ] {
        let constraints = fix(&mesh, &[0, 1, 2], |x| held && x[2] == 0.0);
        let materials = [(1, SOIL.into())].into();
        let input =
            ModelInput { mesh, materials, quadrature: Gauss3, constraints, mass, ..Default::default() };
        let model = Model::new(input).unwrap();
        let dense = dense_squares(&model);
        let elastic = *dense.iter().find(|s| **s > 1e-6 * dense[dense.len() - 1]).unwrap();
        for count in counts {
            let modes = modal::solve(&model, count).unwrap();
            let count = count.min(dense.len());
            assert_eq!(modes.frequencies.len(), count, "{name}");
            let worst = (0..count)
                .map(|i| (modes.circular[i].powi(2) - dense[i]).abs() / (dense[i].abs() + elastic))
                .fold(0.0_f64, f64::max);
            println!("{name}, {count} modes: {worst:.1e} from the dense solution");
            assert!(worst < 1e-9, "{name} {count}: {worst:e}");
            assert!(orthogonality(&model, &modes) < 1e-9);
        }
    }
}

/// Ascending squared circular frequencies by a dense solution.
fn dense_squares(model: &Model) -> Vec<f64> {
    let (free, n) = (model.supports().free(), model.free_dof_count());
    let columns = |times: &dyn Fn(&[f64], &mut [f64])| {
        let mut matrix = nalgebra::DMatrix::zeros(n, n);
        let (mut unit, mut product) = (vec![0.0; model.dof_count()], vec![0.0; model.dof_count()]);
        for j in 0..n {
            unit[free[j] as usize] = 1.0;
            times(&unit, &mut product);
            unit[free[j] as usize] = 0.0;
            for i in 0..n {
                matrix[(i, j)] = product[free[i] as usize];
            }
        }
        matrix
    };
    let k = columns(&|x, y| model.stiffness_times(x, y));
    let m = columns(&|x, y| model.mass_times(x, y));
    let lower = m.cholesky().unwrap().l();
    let half = lower.solve_lower_triangular(&k).unwrap();
    let both = lower.solve_lower_triangular(&half.transpose()).unwrap();
    let mut values: Vec<f64> = both.symmetric_eigen().eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Effective masses sum to `r·M_f (M_ff)^-1 M_f r`.
#[test]
fn effective_masses_sum_to_total_mass() {
    let model = model(Mesh::block([2, 1, 1], [2.0, 1.0, 1.0]), Vec::new(), SOIL, Gauss3);
    let modes = modal::solve(&model, 6).unwrap();
    for k in 0..3 {
        let sum: f64 = modes.effective_mass.iter().map(|m| m[k]).sum();
        assert!((sum / 4000.0 - 1.0).abs() < 1e-9, "{sum}");
    }
}

/// Heave at `sqrt(k A/m)`, sliding at `sqrt(k_t A/m)`, within the block's own flexibility.
#[test]
fn block_on_springs_matches_closed_form() {
    let mesh = Mesh::block([2, 2, 2], [1.0, 1.0, 0.5]);
    let base = mesh.boundary_faces().into_iter().filter(|f| f.side == 0).collect();
    let model = Model::new(ModelInput {
        mesh,
        materials: [(1, STEEL.into())].into(),
        quadrature: Gauss3,
        boundaries: vec![BoundaryLayer::springs(base, 4e6, 0.5e6)],
        ..Default::default()
    })
    .unwrap();
    let modes = modal::solve(&model, 6).unwrap();
    assert_eq!((modes.zero_modes, modes.shift), (0, 0.0));
    let heave = (0..6).find(|&i| modes.effective_mass[i][2] > 0.5 * model.total_mass()).unwrap();
    let exact = (4e6_f64 / (0.5 * STEEL.density)).sqrt();
    println!("block on springs: heave {:+.1e}", modes.circular[heave] / exact - 1.0);
    assert!((modes.circular[heave] / exact - 1.0).abs() < 1e-4);
}

#[test]
fn counts_mechanisms_of_reduced_integration() {
    let single = |rule| {
        let model = model(Mesh::block([1, 1, 1], [1.0; 3]), Vec::new(), SOIL, rule);
        modal::solve(&model, 20).unwrap().zero_modes
    };
    assert_eq!((single(Gauss3), single(Gauss2)), (6, 12));
}

/// Consistent mass: from above (Rayleigh), fourth order. Lumped mass: from below, second order.
#[test]
fn lumped_mass_converges_from_below() {
    let bar = |mass, count: usize| {
        let width = 10.0 / count as f64;
        let mesh = Mesh::block([1, 1, count], [width, width, 10.0]);
        let mut constraints = fix(&mesh, &[0, 1], |_| true);
        constraints.extend(fix(&mesh, &[2], |x| x[2] == 0.0));
        let materials = [(1, SOIL.into())].into();
        let input =
            ModelInput { mesh, materials, quadrature: Gauss3, constraints, mass, ..Default::default() };
        let model = Model::new(input).unwrap();
        let total: f64 = {
            let (unit, mut p) = (vec![1.0; model.dof_count()], vec![0.0; model.dof_count()]);
            model.mass_times(&unit, &mut p);
            p.iter().step_by(3).sum()
        };
        assert!((total / model.total_mass() - 1.0).abs() < 1e-13, "the mass is exact");
        let modes = modal::solve(&model, 2).unwrap();
        modes.frequencies[1] / (3.0 * SOIL.compression_wave_speed() / 40.0) - 1.0
    };
    for (mass, sign, order) in [(Mass::Consistent, 1.0, 4.0), (Mass::Lumped, -1.0, 2.0)] {
        let (coarse, fine) = (sign * bar(mass, 12), sign * bar(mass, 24));
        let found = (coarse / fine).log2();
        println!("bar, second mode, {mass:?}: {:+.2e} {:+.2e}, order {found:.2}", sign * coarse, sign * fine);
        assert!(coarse > 0.0 && fine > 0.0 && (found - order).abs() < 0.2);
    }
}

#[test]
fn odd_requests_are_met_or_refused() {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let all = fix(&mesh, &[0, 1, 2], |_| true);
    let fixed = model(mesh.clone(), all, SOIL, Gauss3);
    assert!(modal::solve(&fixed, 5).unwrap().frequencies.is_empty());
    let free = model(mesh.clone(), Vec::new(), SOIL, Gauss3);
    assert!(modal::solve(&free, 0).unwrap().frequencies.is_empty());
    assert_eq!(modal::solve(&free, 61).unwrap().frequencies.len(), 60);
    let weightless = model(mesh, Vec::new(), Elastic { density: 0.0, ..SOIL }, Gauss3);
    assert_eq!(modal::solve(&weightless, 3), Err(ModalError::Solve(SolveError::NoMass { material: 1 })));
}

#[test]
fn results_independent_of_thread_count() {
    let bits = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut mesh = Mesh::block([4, 3, 3], [1.0, 0.8, 1.5]);
            mesh.coordinates.iter_mut().for_each(|x| *x = bend(*x));
            let model = model(mesh, Vec::new(), SOIL, Gauss3);
            let modes = modal::solve(&model, 12).unwrap();
            let shapes = modes.shapes.into_iter().flatten();
            modes.frequencies.into_iter().chain(shapes).map(f64::to_bits).collect::<Vec<_>>()
        })
    };
    let one = bits(1);
    assert!(one == bits(2) && one == bits(3));
}

#[test]
#[ignore = "for measurement: about 20 s"]
fn modes_of_a_large_block() {
    for held in [true, false] {
        let mesh = Mesh::block([16, 16, 16], [4.0, 3.0, 2.0]);
        let constraints = fix(&mesh, &[0, 1, 2], |x| held && x[2] == 0.0);
        let model = model(mesh, constraints, SOIL, Gauss3);
        let start = std::time::Instant::now();
        let modes = modal::solve(&model, 10).unwrap();
        let residual = modes.residuals.iter().fold(0.0_f64, |m, r| m.max(*r));
        println!(
            "{} dofs, held {held}: {:.1} s, residual {residual:.1e}, zero modes {}, {:.4?} Hz",
            model.free_dof_count(),
            start.elapsed().as_secs_f64(),
            modes.zero_modes,
            modes.frequencies
        );
        assert!(residual < 1e-7 && modes.zero_modes == if held { 0 } else { 6 });
    }
}
