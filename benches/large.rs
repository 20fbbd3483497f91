//! Large elastic solids: direct solver against conjugate gradients, time and memory.
//!
//! Embankment of `inputs/solid/large.toml` at several sizes, 20-node bricks of 0.41 (crest 0.14) x 0.5 x 0.7
//! m, lumped mass. Windows of 0.1 ms with noise on the crest: no useful initial guess. Statics: weight and
//! noise. CPU time of one thread.
//!
//! * `cargo bench --bench large -- windows` or `-- statics`, up to 100,000 nodes; `-- windows 0.4`: one
//!   fraction of the largest; `-- windows 1 gradients`: without the direct solver (7.3 GB).
//! * `cargo bench --features mumps --bench large -- windows 0.6 mumps` or `-- statics 0.6 mumps`: also MUMPS,
//!   in core and out of core.

#[path = "common/watch.rs"]
mod watch;

use std::error::Error;
use trackbed_fem::statics::StaticSolver;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};
use trackbed_fem::{
    Constraint, Elastic, Mass, Mesh, Method, Methods, Model, ModelInput, MumpsMethod, Quadrature, Rayleigh,
    State,
};
use watch::{Watch, pool};

const WINDOW: f64 = 1e-4;
const THETA: f64 = 0.55;
/// Fractions of the largest element counts.
const SHARES: [f64; 6] = [0.2, 0.3, 0.4, 0.6, 0.8, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if let [what @ ("windows" | "statics"), share, "mumps"] = words[..] {
        let share = share.parse()?;
        return Ok(pool(1).install(|| ways(what == "statics", share).map_err(|e| e.to_string()))?);
    }
    let (what, share, direct) = match words[..] {
        [what, share] => (what, Some(share.parse()?), true),
        [what, share, "gradients"] => (what, Some(share.parse()?), false),
        [what] => (what, None, true),
        _ => ("windows", None, true),
    };
    let shares: Vec<f64> = share.map_or(SHARES.to_vec(), |s| vec![s]);
    let measure = match what {
        "windows" => {
            println!("nodes, equations: factor MB, s, ms a window; gradients MB, s, iterations, ms a window");
            windows
        }
        "statics" => {
            println!("nodes, equations: factor MB, s; aggregation MB, set-up s, iterations, s");
            statics
        }
        other => return Err(format!("{other}: expected windows or statics").into()),
    };
    for &share in &shares {
        pool(1).install(|| measure(share, direct).map_err(|e| e.to_string()))?;
    }
    Ok(())
}

fn embankment(share: f64, methods: Methods) -> Result<Model, Box<dyn Error>> {
    let count = |n: f64| (n * share).round().max(1.0) as usize;
    let counts = [count(58.0), count(40.0), 2 * count(5.0)];
    let step = [24.0 / 58.0, 0.5, 0.7];
    let size: [f64; 3] = std::array::from_fn(|k| step[k] * counts[k] as f64);
    let mut mesh = Mesh::block(counts, size);
    for x in &mut mesh.coordinates {
        // Upper half narrows to a third.
        let above = (2.0 * x[2] / size[2] - 1.0).max(0.0);
        x[0] = (x[0] - 0.5 * size[0]) * (1.0 - above * 2.0 / 3.0);
    }
    for e in 0..mesh.element_count() {
        mesh.materials[e] = if mesh.element_centre(e)[2] > 0.5 * size[2] { 2 } else { 1 };
    }
    let base = (0..mesh.node_count() as u32).filter(|&n| mesh.coordinates[n as usize][2] == 0.0);
    let constraints =
        base.flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }));
    let soil = |young, poisson, density| Elastic { young, poisson, density }.into();
    Ok(Model::new(ModelInput {
        constraints: constraints.collect(),
        materials: [(1, soil(60e6, 0.35, 1900.0)), (2, soil(120e6, 0.3, 2000.0))].into(),
        quadrature: Quadrature::Gauss2,
        gravity: [0.0, 0.0, -9.81],
        rayleigh: Rayleigh { alpha_m: 2.0, beta_k: 2e-4 },
        mass: Mass::Lumped,
        methods,
        mesh,
        ..ModelInput::default()
    })?)
}

/// All methods, relative to the direct solver.
fn ways(statics: bool, share: f64) -> Result<(), Box<dyn Error>> {
    let tolerance = Method::WINDOW_TOLERANCE;
    let ways = [
        ("factor", Method::Direct),
        ("gradients", Method::Iterative { tolerance }),
        ("MUMPS", Method::Mumps(MumpsMethod { out_of_core: false })),
        ("MUMPS, out of core", Method::Mumps(MumpsMethod { out_of_core: true })),
    ];
    let mut first: Option<Vec<f64>> = None;
    for (name, method) in ways {
        let model = embankment(share, Methods { statics: method, dynamics: method })?;
        let (set_up, seconds, u, iterations, memory) = if statics {
            let (set_up, seconds, u, most, memory) = stand(&model)?;
            (set_up, seconds, u, f64::from(most), memory)
        } else {
            run(&model)
                .map(|(set_up, seconds, state, mean, memory)| (set_up, seconds, state.u, mean, memory))?
        };
        let memory = if method == Method::Direct { model.solver_demand(true)?.bytes } else { memory };
        let other = first.get_or_insert_with(|| u.clone());
        let miss = u.iter().zip(&*other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = other.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        println!(
            "{}, {}, {name}: {:.0} MB, {:.2} s ({:.2} s wall time), {iterations:.1} iterations, {:.1} ms ({:.1}), differs by {:.0e}",
            model.mesh().node_count(),
            model.free_dof_count(),
            1e-6 * memory as f64,
            set_up.cpu,
            set_up.wall,
            1e3 * seconds.cpu,
            1e3 * seconds.wall,
            miss / size
        );
    }
    Ok(())
}

/// Reproducible uniform noise in [-1, 1) (Knuth's linear congruential generator).
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

type Run = (Watch, Watch, State, f64, usize);

fn run(model: &Model) -> Result<Run, Box<dyn Error>> {
    let mut set_up = Watch::default();
    let mut solver = set_up.time(|| ThetaSolver::new(model, THETA, WINDOW))?;
    let top = model.mesh().coordinates.iter().map(|x| x[2]).fold(0.0, f64::max);
    let crest: Vec<usize> =
        (0..model.mesh().node_count()).filter(|&n| model.mesh().coordinates[n][2] > top - 1e-9).collect();
    let (mut state, mut seed, mut load) = (State::new(model), 1, vec![0.0; model.dof_count()]);
    let mut watch = Watch::default();
    const COUNT: u32 = 12;
    for k in 0..=COUNT {
        for &n in &crest {
            (0..3).for_each(|k| load[3 * n + k] = 100.0 * noise(&mut seed));
        }
        // Warm-up.
        if k == 1 {
            watch = Watch::default();
        }
        watch.time(|| solver.step(model, &mut state, &load))?;
    }
    let mean = solver.counts().map_or(0.0, |c| c.iterations as f64 / c.solves as f64);
    let one = Watch { wall: watch.wall / f64::from(COUNT), cpu: watch.cpu / f64::from(COUNT) };
    Ok((set_up, one, state, mean, solver.solver_memory().unwrap_or(0)))
}

type Stand = (Watch, Watch, Vec<f64>, u32, usize);

fn stand(model: &Model) -> Result<Stand, Box<dyn Error>> {
    let (mut set_up, mut watch) = (Watch::default(), Watch::default());
    let mut solver = set_up.time(|| StaticSolver::new(model))?;
    let (mut load, mut seed) = (model.gravity_load(), 1);
    load.iter_mut().for_each(|l| *l += 10.0 * noise(&mut seed));
    let solution = watch.time(|| solver.solve(model, &load))?;
    let most = solver.counts().map_or(0, |c| c.most);
    Ok((set_up, watch, solution.u, most, solver.solver_memory().unwrap_or(0)))
}

fn statics(share: f64, direct: bool) -> Result<(), Box<dyn Error>> {
    let tolerance = Method::WINDOW_TOLERANCE;
    let methods = Methods { statics: Method::Iterative { tolerance }, ..Methods::default() };
    let model = embankment(share, methods)?;
    let (set_up, seconds, u, iterations, memory) = stand(&model)?;
    let (nodes, equations) = (model.mesh().node_count(), model.free_dof_count());
    let factor = if direct {
        let model = embankment(share, Methods::default())?;
        let demand = model.solver_demand(true)?;
        let (factor, seconds, other, _, _) = stand(&model)?;
        let miss = u.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = other.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let mb = 1e-6 * demand.bytes as f64;
        format!("{mb:.0} MB, {:.2} s (differs by {:.0e})", factor.cpu + seconds.cpu, miss / size)
    } else {
        "not made".into()
    };
    let mb = 1e-6 * memory as f64;
    println!(
        "{nodes}, {equations}: {factor}; {mb:.0} MB, {:.2} s, {iterations} iterations, {:.2} s",
        set_up.cpu, seconds.cpu
    );
    Ok(())
}

fn windows(share: f64, direct: bool) -> Result<(), Box<dyn Error>> {
    let tolerance = Method::WINDOW_TOLERANCE;
    let methods = Methods { dynamics: Method::Iterative { tolerance }, ..Methods::default() };
    let model = embankment(share, methods)?;
    let (set_up, seconds, state, iterations, memory) = run(&model)?;
    let (nodes, equations) = (model.mesh().node_count(), model.free_dof_count());
    let factor = if direct {
        let model = embankment(share, Methods::default())?;
        let demand = model.solver_demand(true)?;
        let (factor, seconds, other, ..) = run(&model)?;
        let miss = state.u.iter().zip(&other.u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = other.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let (mb, ms) = (1e-6 * demand.bytes as f64, 1e3 * seconds.cpu);
        format!("{mb:.0} MB, {:.2} s, {ms:.1} ms (differs by {:.0e})", factor.cpu, miss / size)
    } else {
        "not made".into()
    };
    println!(
        "{nodes}, {equations}: {factor}; {:.0} MB, {:.2} s, {iterations:.1} iterations, {:.1} ms",
        1e-6 * memory as f64,
        set_up.cpu,
        1e3 * seconds.cpu
    );
    Ok(())
}
