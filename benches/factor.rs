//! Direct solver: symbolic analysis, L L^T (first, repeated), L U on one and two threads, 1 to 8 right-hand
//! sides, predicted and used memory; faer's L L^T with the same ordering.
//!
//! Bricks of 10^3 and 16^3 elements (13,860 and 53,856 equations), fixed base, K dt²/4 + M, dt = 1 ms; 24^3
//! (176,400 equations, 5 GB) with `TRACKBED_LARGE`. Medians; `cpu`, CPU time of all threads, is reliable on
//! shared machines.
//!
//! * `cargo bench --bench factor` (about 40 s); `-- 16`: 16^3 only.
//! * `-- write FILE 16` exports: magic `SPDL`, u32 version 1, u64 n, u64 entries, u64 column starts [n + 1],
//!   u64 rows, f64 values, f64 load [n]; lower triangle, compressed columns, little endian.
//! * `-- peer 16 THREADS`: line for `benches/factor_peers.py`.

#[path = "common/watch.rs"]
mod watch;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::sync::Arc;
use trackbed_fem::assembly::Combination;
use trackbed_fem::equations::{analyse, values};
use trackbed_fem::solver::analysis::Analysis;
use trackbed_fem::solver::multifrontal::DirectSolver;
use trackbed_fem::{Constraint, Elastic, Mesh, Model, ModelInput, Quadrature};
use watch::Watch;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["write", file, side] => Case::new(side.parse()?).write(file)?,
        ["peer", side, threads] => Case::new(side.parse()?).peer_line(threads.parse()?),
        [side] => Case::new(side.parse()?).report(),
        _ => {
            Case::new(10).report();
            Case::new(16).report();
            if std::env::var_os("TRACKBED_LARGE").is_some() {
                Case::new(24).report();
            }
        }
    }
    Ok(())
}

struct Case {
    model: Model,
    analysis: Arc<Analysis>,
    values: Vec<f64>,
    watch: Watch,
}

fn median(times: usize, mut work: impl FnMut()) -> (f64, f64) {
    let mut watches: Vec<(f64, f64)> = (0..times)
        .map(|_| {
            let mut watch = Watch::default();
            watch.time(&mut work);
            (watch.wall, watch.cpu)
        })
        .collect();
    watches.sort_by(|a, b| a.0.total_cmp(&b.0));
    let wall = watches[times / 2].0;
    watches.sort_by(|a, b| a.1.total_cmp(&b.1));
    (wall, watches[times / 2].1)
}

/// Bytes under `key` in /proc; zero if unknown.
fn memory(key: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix(key));
    line.and_then(|l| l.split_whitespace().next()).and_then(|k| k.parse::<f64>().ok()).unwrap_or(0.0) * 1024.0
}

impl Case {
    fn new(side: usize) -> Case {
        let mesh = Mesh::block([side; 3], [side as f64; 3]);
        let constraints = (0..mesh.node_count() as u32)
            .filter(|&i| mesh.coordinates[i as usize][2] == 0.0)
            .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
            .collect();
        let soil = Elastic { young: 60e6, poisson: 0.3, density: 1900.0 };
        let model = Model::new(ModelInput {
            materials: mesh.materials.iter().map(|&number| (number, soil.into())).collect(),
            mesh,
            quadrature: Quadrature::Gauss3,
            constraints,
            gravity: [0.0; 3],
            ..Default::default()
        })
        .expect("the mesh is a model");
        let mut watch = Watch::default();
        let analysis = watch.time(|| {
            analyse(model.mesh(), model.matrices(), model.supports()).expect("there is enough memory")
        });
        let newmark = Combination { stiffness: 2.5e-7, mass: 1.0, dashpots: 0.0 };
        let values = values(&analysis, model.matrices(), model.supports(), newmark);
        Case { model, analysis: Arc::new(analysis), values, watch }
    }

    fn load(&self, count: usize) -> Vec<f64> {
        (0..self.analysis.size() * count).map(|i| (i as f64).sin()).collect()
    }

    fn times(&self) -> usize {
        if self.analysis.flops() > 3e11 { 3 } else { 7 }
    }

    fn report(&self) {
        let analysis = &self.analysis;
        println!(
            "{} equations, {:.2} M values in the factor, {:.2} Gflop",
            analysis.size(),
            analysis.factor_len() as f64 / 1e6,
            analysis.flops() / 1e9
        );
        let (model, times) = (&self.model, self.times());
        let (wall, cpu) = median(times, || {
            analyse(model.mesh(), model.matrices(), model.supports()).expect("there is enough memory");
        });
        line("ordering and symbolic", (wall, cpu), 0.0);
        let mut peak = 0.0;
        for threads in [1, 2] {
            watch::pool(threads).install(|| {
                let before = memory("VmRSS:");
                // Resets the kernel's peak; without permission the process peak remains.
                let _ = std::fs::write("/proc/self/clear_refs", "5");
                let mut solver = DirectSolver::new(analysis.clone());
                let name = format!("L L^T, {threads} thread(s)");
                line(&format!("{name}, first"), median(1, || self.symmetric(&mut solver)), analysis.flops());
                line(
                    &format!("{name}, again"),
                    median(times, || self.symmetric(&mut solver)),
                    analysis.flops(),
                );
                peak = memory("VmHWM:") - before;
                self.solves(&mut solver);
            });
        }
        println!(
            "  memory, L L^T: predicted {:.1} MB, used {:.1} MB",
            analysis.memory(true) as f64 / 1e6,
            peak / 1e6
        );
        for threads in [1, 2] {
            watch::pool(threads).install(|| {
                let before = memory("VmRSS:");
                let _ = std::fs::write("/proc/self/clear_refs", "5");
                let mut solver = DirectSolver::new(analysis.clone());
                let mut factor = || {
                    solver.factor_unsymmetric(&self.values, &self.values).expect("the matrix is regular");
                };
                let name = format!("L U, {threads} thread(s)");
                line(&format!("{name}, first"), median(1, &mut factor), 2.0 * analysis.flops());
                line(&format!("{name}, again"), median(times, &mut factor), 2.0 * analysis.flops());
                peak = memory("VmHWM:") - before;
                self.solves(&mut solver);
            });
        }
        println!(
            "  memory, L U: predicted {:.1} MB, used {:.1} MB",
            analysis.memory(false) as f64 / 1e6,
            peak / 1e6
        );
        self.faer();
    }

    fn symmetric(&self, solver: &mut DirectSolver) {
        solver.factor_symmetric(&self.values).expect("the matrix is positive definite");
    }

    fn solves(&self, solver: &mut DirectSolver) {
        for count in [1, 2, 4, 8] {
            let load = self.load(count);
            let mut x = load.clone();
            let (wall, cpu) = median(15, || {
                x.copy_from_slice(&load);
                solver.solve_many(&mut x, count);
            });
            let n = count as f64;
            println!(
                "    solve, {count} right-hand side(s): {:.1} ms wall, {:.1} ms cpu each; residual {:.1e}",
                wall / n * 1e3,
                cpu / n * 1e3,
                self.residual(&load, &x)
            );
        }
    }

    /// Largest `|A x - b| / |b|`, first right-hand side.
    fn residual(&self, b: &[f64], x: &[f64]) -> f64 {
        let n = self.analysis.size();
        let (start, row) = self.analysis.pattern();
        let mut r: Vec<f64> = b[..n].to_vec();
        for c in 0..n {
            for k in start[c]..start[c + 1] {
                r[row[k]] -= self.values[k] * x[c];
                if row[k] != c {
                    r[c] -= self.values[k] * x[row[k]];
                }
            }
        }
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        norm(&r) / norm(&b[..n])
    }

    fn faer(&self) {
        let n = self.analysis.size();
        let (start, row) = self.analysis.pattern();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, start, None, row);
        let order = self.analysis.order();
        let mut position = vec![0; n];
        for (i, &e) in order.iter().enumerate() {
            position[e] = i;
        }
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(order, &position, n)),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .expect("there is enough memory");
        let mut values = vec![0.0; symbolic.len_val()];
        let mut work =
            MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
        let time = median(self.times(), || {
            let matrix = SparseColMatRef::new(pattern, &self.values[..]);
            let stack = MemStack::new(&mut work);
            let (options, params) = (Default::default(), Default::default());
            symbolic
                .factorize_numeric_llt(&mut values, matrix, Side::Lower, options, Par::Seq, stack, params)
                .expect("the matrix is positive definite");
        });
        line("faer L L^T, 1 thread, again", time, self.analysis.flops());
        let load = self.load(1);
        let mut x = load.clone();
        let mut work = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let (wall, cpu) = median(15, || {
            x.copy_from_slice(&load);
            let (factor, x) =
                (LltRef::new(&symbolic, &values), MatMut::from_column_major_slice_mut(&mut x, n, 1));
            factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut work));
        });
        println!("    faer solve: {:.1} ms wall, {:.1} ms cpu", wall * 1e3, cpu * 1e3);
    }

    fn peer_line(&self, threads: usize) {
        watch::pool(threads).install(|| {
            let mut solver = DirectSolver::new(self.analysis.clone());
            let first = median(1, || self.symmetric(&mut solver)).0;
            let again = median(3, || self.symmetric(&mut solver));
            let load = self.load(1);
            let mut x = load.clone();
            let solve = median(5, || {
                x.copy_from_slice(&load);
                solver.solve_many(&mut x, 1);
            });
            println!(
                "analyze={:.3} factor1={first:.3} factor2={:.3} cpu2={:.3} solve={:.4} res={:.1e}",
                self.watch.wall,
                again.0,
                again.1,
                solve.0,
                self.residual(&load, &x)
            );
        });
    }

    fn write(&self, file: &str) -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(file)?);
        let (start, row) = self.analysis.pattern();
        out.write_all(b"SPDL")?;
        out.write_all(&1_u32.to_le_bytes())?;
        for &number in [self.analysis.size(), row.len()].iter().chain(start).chain(row) {
            out.write_all(&(number as u64).to_le_bytes())?;
        }
        for value in self.values.iter().chain(&self.load(1)) {
            out.write_all(&value.to_le_bytes())?;
        }
        out.flush()
    }
}

fn line(name: &str, (wall, cpu): (f64, f64), flops: f64) {
    let rate = if flops > 0.0 { format!(", {:.1} Gflop/s", flops / wall * 1e-9) } else { String::new() };
    println!("  {name}: {wall:.3} s wall, {cpu:.3} s cpu{rate}");
}
