//! Tests of analysis, factorisation and solves.

use super::*;
use crate::assembly::{Combination, Matrices};
use crate::element::quadrature::Quadrature;
use crate::material::elastic::Elastic;
use crate::mesh::{Constraint, Mesh};
use crate::solver::AnalysisError;
use crate::supports::Supports;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{LltRef, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Knuth's linear congruential generator (MMIX), upper bits.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, bound: usize) -> usize {
        ((self.next() + 1.0) / 2.0 * bound as f64) as usize % bound
    }
}

struct System {
    start: Vec<usize>,
    row: Vec<usize>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    order: Vec<usize>,
}

impl System {
    fn analysis(&self) -> Arc<Analysis> {
        Arc::new(Analysis::from_pattern(self.start.clone(), self.row.clone(), self.order.clone()).unwrap())
    }

    fn size(&self) -> usize {
        self.order.len()
    }

    fn visit(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for c in 0..self.size() {
            for k in self.start[c]..self.start[c + 1] {
                visit(self.row[k], c, self.lower[k]);
                if self.row[k] != c {
                    visit(c, self.row[k], self.upper[k]);
                }
            }
        }
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.visit(|r, c, value| y[r] += value * x[c]);
        y
    }

    /// |b - A x| / (|A| |x| + |b|), maximum norms: backward error of Rigal and Gaches.
    fn residual(&self, x: &[f64], b: &[f64]) -> f64 {
        let mut size = vec![0.0; x.len()];
        self.visit(|r, _, value| size[r] += f64::abs(value));
        let largest = |v: &[f64]| v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let miss: Vec<f64> = self.times(x).iter().zip(b).map(|(a, b)| a - b).collect();
        largest(&miss) / (largest(&size) * largest(x) + largest(b))
    }

    /// Dense Gauss elimination with partial pivoting.
    fn dense_solution(&self, b: &[f64]) -> Vec<f64> {
        let n = b.len();
        let mut a = vec![vec![0.0; n + 1]; n];
        self.visit(|r, c, value| a[r][c] = value);
        (0..n).for_each(|i| a[i][n] = b[i]);
        for p in 0..n {
            let best = (p..n).max_by(|&i, &j| a[i][p].abs().total_cmp(&a[j][p].abs())).unwrap();
            a.swap(p, best);
            for r in p + 1..n {
                let factor = a[r][p] / a[p][p];
                for c in p..=n {
                    a[r][c] -= factor * a[p][c];
                }
            }
        }
        let mut x = vec![0.0; n];
        for p in (0..n).rev() {
            x[p] = (a[p][n] - (p + 1..n).map(|c| a[p][c] * x[c]).sum::<f64>()) / a[p][p];
        }
        x
    }
}

/// Symmetric: diagonally dominant. Else: zero diagonal, large entries within node blocks.
fn random_system(seed: u64, nodes: usize, dofs: usize, links: usize, symmetric: bool) -> System {
    let mut random = Random(seed);
    let mut coupled = vec![vec![false; nodes]; nodes];
    for _ in 0..links {
        let (a, b) = (random.below(nodes), random.below(nodes));
        coupled[a.max(b)][a.min(b)] = true;
    }
    let (mut start, mut row, mut lower, mut upper) = (vec![0], Vec::new(), Vec::new(), Vec::new());
    for c in 0..nodes * dofs {
        for r in c..nodes * dofs {
            let own = c / dofs == r / dofs;
            if !own && !coupled[r / dofs][c / dofs] {
                continue;
            }
            row.push(r);
            let (mut a, mut b) = (random.next(), random.next());
            if symmetric {
                a = if r == c { 1.2 * (nodes * dofs) as f64 + a } else { a };
                b = a;
            } else if own {
                let heavy = 30.0 + 10.0 * a;
                let shift = |from: usize, to: usize| (from % dofs + 1) % dofs == to % dofs;
                a = if r == c && dofs > 1 {
                    0.0
                } else if shift(c, r) || dofs == 1 {
                    heavy
                } else {
                    a
                };
                b = if shift(r, c) { heavy } else { b };
            }
            lower.push(a);
            upper.push(b);
        }
        start.push(row.len());
    }
    let mut order: Vec<usize> = (0..nodes).collect();
    for i in (1..nodes).rev() {
        order.swap(i, random.below(i + 1));
    }
    let order = order.iter().flat_map(|n| (0..dofs).map(move |d| n * dofs + d)).collect();
    System { start, row, lower, upper, order }
}

/// K dt²/4 + M of a clamped brick, unsymmetric by `skew`.
fn brick(side: usize, skew: f64) -> System {
    let mesh = Mesh::block([side; 3], [side as f64; 3]);
    let soil = Elastic { young: 60e6, poisson: 0.3, density: 1900.0 };
    let matrices = Matrices::assemble(&mesh, Quadrature::Gauss3, |_| &soil);
    let base: Vec<Constraint> = (0..mesh.node_count() as u32)
        .filter(|&n| mesh.coordinates[n as usize][2] == 0.0)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    let supports = Supports::new(&mesh, &base).unwrap();
    let analysis = crate::equations::analyse(&mesh, &matrices, &supports).unwrap();
    let lower = crate::equations::values(
        &analysis,
        &matrices,
        &supports,
        Combination { stiffness: 2.5e-7, mass: 1.0, dashpots: 0.0 },
    );
    let mut random = Random(7);
    let upper = lower.iter().map(|a| a * (1.0 + skew * random.next())).collect();
    let (start, row) = analysis.pattern();
    System { start: start.to_vec(), row: row.to_vec(), lower, upper, order: analysis.order().to_vec() }
}

fn load(n: usize) -> Vec<f64> {
    (0..n).map(|i| (1.7 * i as f64 + 0.3).sin()).collect()
}

fn solved(solver: &mut DirectSolver, b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    solver.solve_in_place(&mut x);
    x
}

fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    let scale = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance * scale)
}

fn bits(x: &[f64]) -> Vec<u64> {
    x.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn symmetric_systems_match_dense_elimination() {
    for seed in 0..60 {
        let (nodes, dofs) = (1 + seed as usize % 37, 1 + seed as usize % 4);
        let system = random_system(seed, nodes, dofs, seed as usize * 2, true);
        let b = load(system.size());
        let mut solver = DirectSolver::new(system.analysis());
        solver.factor_symmetric(&system.lower).unwrap();
        let x = solved(&mut solver, &b);
        assert!(close(&x, &system.dense_solution(&b), 1e-12), "seed {seed}");
        solver.factor_unsymmetric(&system.lower, &system.lower).unwrap();
        assert!(close(&solved(&mut solver, &b), &x, 1e-12), "seed {seed}");
    }
}

/// Every first pivot of a node requires a row exchange.
#[test]
fn unsymmetric_systems_match_dense_elimination() {
    for seed in 0..60 {
        let (nodes, dofs) = (1 + seed as usize % 31, 2 + seed as usize % 5);
        let system = random_system(seed, nodes, dofs, seed as usize, false);
        let b = load(system.size());
        let mut solver = DirectSolver::new(system.analysis());
        solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
        let x = solved(&mut solver, &b);
        assert!(system.residual(&x, &b) <= 1e-13, "seed {seed}: {:.1e}", system.residual(&x, &b));
        assert!(close(&x, &system.dense_solution(&b), 1e-10), "seed {seed}");
    }
}

/// Rows are exchanged across panels.
#[test]
fn factors_large_pivot_block() {
    let system = random_system(5, 1, 400, 0, false);
    let analysis = system.analysis();
    assert!(analysis.structure().upper.len() == 1 && analysis.structure().max_width == 400);
    let b = load(400);
    let mut solver = DirectSolver::new(analysis);
    solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
    let x = solved(&mut solver, &b);
    assert!(system.residual(&x, &b) <= 1e-13);
    assert!(close(&x, &system.dense_solution(&b), 1e-10));
}

#[test]
fn brick_solution_matches_faer() {
    let system = brick(6, 0.0);
    let n = system.size();
    let analysis = system.analysis();
    assert!(!analysis.structure().upper.is_empty() && analysis.structure().tasks.len() > 8);
    let b = load(n);
    let mut solver = DirectSolver::new(analysis);
    solver.factor_symmetric(&system.lower).unwrap();
    let x = solved(&mut solver, &b);
    assert!(system.residual(&x, &b) <= 1e-14, "{:.1e}", system.residual(&x, &b));

    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &system.start, None, &system.row);
    let symbolic =
        factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, Default::default())
            .unwrap();
    let mut values = vec![0.0; symbolic.len_val()];
    let mut work =
        MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
    let matrix = SparseColMatRef::new(pattern, &system.lower[..]);
    let stack = MemStack::new(&mut work);
    symbolic
        .factorize_numeric_llt(
            &mut values,
            matrix,
            Side::Lower,
            Default::default(),
            Par::Seq,
            stack,
            Default::default(),
        )
        .unwrap();
    let mut theirs = b.clone();
    let mut work = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
    LltRef::new(&symbolic, &values).solve_in_place_with_conj(
        Conj::No,
        MatMut::from_column_major_slice_mut(&mut theirs, n, 1),
        Par::Seq,
        MemStack::new(&mut work),
    );
    assert!(close(&x, &theirs, 1e-12));

    let system = brick(6, 0.3);
    solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
    let y = solved(&mut solver, &b);
    assert!(system.residual(&y, &b) <= 1e-13, "{:.1e}", system.residual(&y, &b));
    assert!(!close(&x, &y, 1e-4));
}

fn fingerprint(solver: &mut DirectSolver, n: usize) -> Vec<u64> {
    let mut all = bits(&solver.first);
    all.extend(bits(&solver.second));
    all.extend(solver.rows.iter().map(|&r| u64::from(r)));
    for count in [1, 2, 5, 15] {
        let mut x = load(n * count);
        solver.solve_many(&mut x, count);
        all.extend(bits(&x));
    }
    all
}

#[test]
fn is_bitwise_independent_of_threads() {
    let system = brick(8, 0.2);
    let analysis = system.analysis();
    let structure = analysis.structure();
    let shared = structure.upper.iter().filter(|&&s| structure.front_flops(s as usize) > 3e7).count();
    assert!(shared > 3 && structure.tasks.len() > 8, "{shared} shared fronts");
    let run = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| {
            let mut solver = DirectSolver::new(analysis.clone());
            solver.factor_symmetric(&system.lower).unwrap();
            let symmetric = fingerprint(&mut solver, system.size());
            solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
            (symmetric, fingerprint(&mut solver, system.size()))
        })
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn refactorization_is_bitwise_identical() {
    let (system, other) = (brick(4, 0.2), brick(4, 0.1));
    let analysis = system.analysis();
    let mut used = DirectSolver::new(analysis.clone());
    used.factor_symmetric(&other.lower.iter().map(|a| 3.0 * a).collect::<Vec<_>>()).unwrap();
    used.factor_unsymmetric(&other.upper, &other.lower).unwrap();
    used.factor_unsymmetric(&system.lower, &system.upper).unwrap();
    let mut fresh = DirectSolver::new(analysis.clone());
    fresh.factor_unsymmetric(&system.lower, &system.upper).unwrap();
    assert!(fingerprint(&mut used, system.size()) == fingerprint(&mut fresh, system.size()));
    used.factor_symmetric(&system.lower).unwrap();
    let mut fresh = DirectSolver::new(analysis);
    fresh.factor_symmetric(&system.lower).unwrap();
    assert!(bits(&used.first) == bits(&fresh.first));
    let b = load(system.size());
    assert_eq!(bits(&solved(&mut used, &b)), bits(&solved(&mut fresh, &b)));
}

#[test]
fn multiple_solves_match_single_solves() {
    let system = brick(5, 0.2);
    let n = system.size();
    let mut solver = DirectSolver::new(system.analysis());
    for symmetric in [true, false] {
        if symmetric {
            solver.factor_symmetric(&system.lower).unwrap();
        } else {
            solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
        }
        let b = load(n * 15);
        let mut x = b.clone();
        solver.solve_many(&mut x, 15);
        for (b, x) in b.chunks(n).zip(x.chunks(n)) {
            assert!(close(x, &solved(&mut solver, b), 1e-13));
        }
        solver.solve_many(&mut [], 0);
    }
}

#[test]
fn the_weakest_pivot_is_named() {
    let (start, row) = (vec![0, 1, 2, 4, 5], vec![0, 1, 2, 3, 3]);
    let analysis = Arc::new(Analysis::from_pattern(start, row, vec![3, 1, 2, 0]).unwrap());
    assert_eq!(analysis.order(), [1, 3, 2, 0]);
    let mut solver = DirectSolver::new(analysis);
    assert_eq!(solver.weakest_pivot(), (1.0, 3));
    solver.factor_symmetric(&[4.0, 9.0, 1.0, 3.999, 16.0]).unwrap();
    let (ratio, equation) = solver.weakest_pivot();
    // Equation 3 is eliminated first, then 2: 1 - 3.999²/16.
    assert_eq!(equation, 2);
    assert!((ratio - (1.0 - 3.999 * 3.999 / 16.0)).abs() < 1e-15);
    solver.factor_unsymmetric(&[4.0, 9.0, 1.0, 3.999, 16.0], &[0.0, 0.0, 0.0, 2.0, 0.0]).unwrap();
    assert_eq!(solver.weakest_pivot().1, 2);
}

#[test]
fn reports_bad_pivot_and_recovers() {
    let system = brick(4, 0.0);
    let n = system.size();
    let analysis = system.analysis();
    let mut solver = DirectSolver::new(analysis.clone());
    for position in [0, n / 3, n - 1] {
        let equation = analysis.equation(position);
        let mut wrong = system.lower.clone();
        wrong[system.start[equation]] = -1.0;
        assert_eq!(solver.factor_symmetric(&wrong), Err(PivotError { equation, ratio: 0.0 }));
        wrong[system.start[equation]] = f64::NAN;
        assert_eq!(solver.factor_symmetric(&wrong), Err(PivotError { equation, ratio: 0.0 }));
    }
    // Two empty equations: the first eliminated is reported.
    let empty = [analysis.equation(n / 2), analysis.equation(n - 7)];
    let (mut lower, mut upper) = (system.lower.clone(), system.upper.clone());
    for c in 0..n {
        for k in system.start[c]..system.start[c + 1] {
            if empty.contains(&c) || empty.contains(&system.row[k]) {
                (lower[k], upper[k]) = (0.0, 0.0);
            }
        }
    }
    let error = solver.factor_unsymmetric(&lower, &upper).unwrap_err();
    assert_eq!(error.equation, empty[0]);
    assert!(error.to_string().contains(&format!("equation {}", empty[0])));
    solver.factor_symmetric(&system.lower).unwrap();
    let b = load(n);
    assert!(system.residual(&solved(&mut solver, &b), &b) <= 1e-14);
}

#[test]
fn the_memory_is_predicted() {
    for system in [brick(7, 0.0), random_system(3, 30, 3, 40, true)] {
        let analysis = system.analysis();
        for symmetric in [true, false] {
            let mut solver = DirectSolver::new(analysis.clone());
            assert_eq!(solver.allocated(), 0);
            if symmetric {
                solver.factor_symmetric(&system.lower).unwrap();
            } else {
                solver.factor_unsymmetric(&system.lower, &system.lower).unwrap();
            }
            let (predicted, allocated) = (analysis.memory(symmetric) as f64, solver.allocated() as f64);
            assert!((predicted / allocated - 1.0).abs() < 0.1, "{predicted} {allocated}");
            solver.solve_in_place(&mut load(system.size()));
            assert_eq!(solver.allocated() as f64, allocated);
        }
    }
}

#[test]
fn solves_trivial_and_uncoupled_systems() {
    let empty = Arc::new(Analysis::from_pattern(vec![0], vec![], vec![]).unwrap());
    let mut solver = DirectSolver::new(empty);
    solver.factor_symmetric(&[]).unwrap();
    solver.solve_in_place(&mut []);
    solver.factor_unsymmetric(&[], &[]).unwrap();
    solver.solve_many(&mut [], 3);
    assert_eq!((solver.size(), solver.weakest_pivot()), (0, (1.0, 0)));

    let one = Arc::new(Analysis::from_pattern(vec![0, 1], vec![0], vec![0]).unwrap());
    let mut solver = DirectSolver::new(one);
    solver.factor_symmetric(&[4.0]).unwrap();
    assert_eq!(solved(&mut solver, &[2.0]), [0.5]);
    assert_eq!(solver.factor_symmetric(&[-4.0]), Err(PivotError { equation: 0, ratio: 0.0 }));
    solver.factor_unsymmetric(&[-4.0], &[7.0]).unwrap();
    assert_eq!(solved(&mut solver, &[2.0]), [-0.5]);

    let n = 10_000;
    let diagonal = Analysis::from_pattern((0..=n).collect(), (0..n).collect(), (0..n).rev().collect());
    let mut solver = DirectSolver::new(Arc::new(diagonal.unwrap()));
    let values: Vec<f64> = (0..n).map(|i| 1.0 + (i % 7) as f64).collect();
    solver.factor_symmetric(&values).unwrap();
    let x = solved(&mut solver, &vec![1.0; n]);
    assert!(x.iter().zip(&values).all(|(x, v)| (x * v - 1.0).abs() < 1e-15));
}

/// Elimination tree is a path.
#[test]
fn long_chain_needs_shallow_stack() {
    let n = 60_003;
    let (mut start, mut row, mut values) = (vec![0], Vec::new(), Vec::new());
    for c in 0..n {
        for r in (c..n.min((c / 3 + 2) * 3)).filter(|r| r % 3 == c % 3 || r / 3 == c / 3) {
            row.push(r);
            values.push(if r == c { 2.5 } else { -1.0 / (1 + r - c) as f64 });
        }
        start.push(row.len());
    }
    let order: Vec<usize> = (0..n).collect();
    let system = System { start, row, upper: values.clone(), lower: values, order };
    let mut solver = DirectSolver::new(system.analysis());
    let b = load(n);
    solver.factor_symmetric(&system.lower).unwrap();
    assert!(system.residual(&solved(&mut solver, &b), &b) <= 1e-14);
    solver.factor_unsymmetric(&system.lower, &system.upper).unwrap();
    assert!(system.residual(&solved(&mut solver, &b), &b) <= 1e-14);
}

#[test]
fn rejects_invalid_pattern() {
    let refused = |start: &[usize], row: &[usize], order: &[usize]| {
        let result = Analysis::from_pattern(start.to_vec(), row.to_vec(), order.to_vec());
        assert!(matches!(result, Err(AnalysisError::Pattern { .. })), "{result:?}");
    };
    refused(&[0, 1], &[0], &[0, 1]);
    refused(&[0, 2, 4], &[0, 1, 1], &[0, 1]);
    refused(&[0, 2, 3], &[1, 0, 1], &[0, 1]);
    refused(&[0, 2, 3], &[0, 2, 1], &[0, 1]);
    refused(&[0, 3, 4, 5], &[0, 2, 1, 1, 2], &[0, 1, 2]);
    refused(&[0, 1, 1], &[0], &[0, 1]);
    refused(&[0, 2, 3], &[0, 1, 1], &[1, 1]);
    refused(&[0, 2, 3], &[0, 1, 1], &[0, 2]);
}
