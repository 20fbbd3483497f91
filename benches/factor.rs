//! The direct solver, in seconds of wall time: ordering with symbolic analysis, numeric factorization of a Newmark
//! step's matrix, one solve, one product with the stiffness; all on one thread.
//!
//! * `embankment`: the railway embankment of the verification case E3, 480 elements.
//! * `brick`: 16 × 16 × 16 elements, base clamped, 53,856 equations: the size that is compared with other solvers.
//!
//! `cargo bench --bench factor` (about 12 s); `cargo bench --bench factor -- embankment` leaves the brick out.

#[path = "common/watch.rs"]
mod watch;

use divan::Bencher;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use trackbed::read::{ListLayout, read_lists};
use trackbed_fem::assembly::Combination;
use trackbed_fem::solver::LinearSolver;
use trackbed_fem::solver::cholesky::{Analysis, Cholesky};
use trackbed_fem::{Constraint, Elastic, Mesh, Model, ModelInput, Quadrature};

fn main() {
    divan::main();
    watch::print_remarks();
}

/// A model with its analysis.
struct Case {
    name: &'static str,
    model: Model,
    analysis: Arc<Analysis>,
}

static EMBANKMENT: LazyLock<Case> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/fem/E3_embankment_patch");
    let file = |name| folder.join(name);
    let lists = read_lists(
        &file("NODECOORD.DAT"),
        &file("ELEMENTNUM.DAT"),
        Some(&file("DOF.DAT")),
        &ListLayout::default(),
    )
    .expect("the lists are complete");
    Case::new("embankment", lists.mesh, lists.constraints)
});

static BRICK: LazyLock<Case> = LazyLock::new(|| {
    let mesh = Mesh::block([16; 3], [16.0; 3]);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&i| mesh.coordinates[i as usize][2] == 0.0)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    Case::new("brick", mesh, constraints)
});

impl Case {
    fn new(name: &'static str, mesh: Mesh, constraints: Vec<Constraint>) -> Case {
        let soil = Elastic { young: 60e6, poisson: 0.3, density: 1900.0 };
        let model = Model::new(ModelInput {
            materials: mesh.materials.iter().map(|&number| (number, soil)).collect(),
            mesh,
            quadrature: Quadrature::Gauss3,
            constraints,
            gravity: [0.0; 3],
            ..Default::default()
        })
        .expect("the mesh is a model");
        let analysis = Arc::new(analyse(&model));
        watch::remark(format!(
            "{name}: {} equations, {:.2} M values in the factor",
            analysis.size(),
            analysis.factor_len() as f64 / 1e6
        ));
        Case { name, model, analysis }
    }

    /// Factors K dt²/4 + M for dt = 1 ms.
    fn factor(&self) -> Cholesky {
        let model = &self.model;
        let newmark = Combination { stiffness: 2.5e-7, mass: 1.0, dashpots: 0.0 };
        Cholesky::factor(self.analysis.clone(), model.mesh(), model.matrices(), model.supports(), newmark)
            .expect("the matrix is positive definite")
    }
}

fn analyse(model: &Model) -> Analysis {
    Analysis::new(model.mesh(), model.matrices(), model.supports()).expect("there is enough memory")
}

fn analysis(bencher: Bencher<'_, '_>, case: &Case) {
    bencher.bench_local(|| analyse(&case.model));
}

/// The first factorization is not counted: it waits for memory.
fn numeric(bencher: Bencher<'_, '_>, case: &Case) {
    drop(case.factor());
    let (mut watch, mut count) = (watch::Watch::default(), 0);
    let pool = watch::pool(1);
    bencher.bench_local(|| {
        count += 1;
        watch.time(|| pool.install(|| case.factor()))
    });
    let name = case.name;
    watch::remark(format!("{name}: {:.3} processor seconds per factorization", watch.cpu / f64::from(count)));
}

fn solve(bencher: Bencher<'_, '_>, case: &Case) {
    let mut solver = case.factor();
    let load: Vec<f64> = (0..solver.size()).map(|i| (i as f64).sin()).collect();
    bencher.with_inputs(|| load.clone()).bench_local_refs(|x| solver.solve_in_place(x));
}

fn product(bencher: Bencher<'_, '_>, case: &Case) {
    let (x, mut y) = (vec![1.0; case.model.dof_count()], vec![0.0; case.model.dof_count()]);
    bencher.bench_local(|| case.model.stiffness_times(&x, &mut y));
}

#[divan::bench_group(sample_count = 20, sample_size = 1, max_time = 3)]
mod embankment {
    use super::{Bencher, EMBANKMENT};

    #[divan::bench]
    fn analysis(bencher: Bencher<'_, '_>) {
        super::analysis(bencher, &EMBANKMENT);
    }

    #[divan::bench]
    fn numeric(bencher: Bencher<'_, '_>) {
        super::numeric(bencher, &EMBANKMENT);
    }

    #[divan::bench]
    fn solve(bencher: Bencher<'_, '_>) {
        super::solve(bencher, &EMBANKMENT);
    }

    #[divan::bench]
    fn product(bencher: Bencher<'_, '_>) {
        super::product(bencher, &EMBANKMENT);
    }
}

#[divan::bench_group(sample_count = 20, sample_size = 1, max_time = 3)]
mod brick {
    use super::{BRICK, Bencher};

    #[divan::bench]
    fn analysis(bencher: Bencher<'_, '_>) {
        super::analysis(bencher, &BRICK);
    }

    #[divan::bench]
    fn numeric(bencher: Bencher<'_, '_>) {
        super::numeric(bencher, &BRICK);
    }

    #[divan::bench]
    fn solve(bencher: Bencher<'_, '_>) {
        super::solve(bencher, &BRICK);
    }

    #[divan::bench]
    fn product(bencher: Bencher<'_, '_>) {
        super::product(bencher, &BRICK);
    }
}
