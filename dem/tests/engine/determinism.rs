//! The same bits whatever the threads, the skin, or a restart.

use crate::scene::{Run, pile};
use trackbed_dem::{ModelInput, State, Work};

/// Everything that a user can see of a state, as bits.
fn bits(run: &Run) -> Vec<u64> {
    let mut out = Vec::new();
    for b in 0..run.model.body_count() {
        let q = run.state.orientation(&run.model, b);
        let v = [run.state.position(b), run.state.velocity(b), run.state.spin(b)];
        out.extend(v.iter().flat_map(|v| v.iter()).chain(q.coords.iter()).map(|x| x.to_bits()));
    }
    let l = &run.state.ledger;
    out.extend([l.dissipated_dashpot, l.dissipated_friction, l.work_walls].map(f64::to_bits));
    out.extend(l.walls.angular.iter().map(|x| x.to_bits()));
    out
}

/// Large enough to be shared among threads: over 2500 spheres in clumps, with planes, triangles and a block.
fn scene() -> ModelInput {
    pile(10, true)
}

#[test]
fn pools_of_one_two_and_three_threads() {
    let run_in = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(scene());
            assert!(run.model.sphere_count() > 2500);
            run.steps(4000);
            let (searches, lists) = run.work.rebuilds();
            assert!(searches > 2 && lists > 20, "{searches} {lists}");
            assert!(run.state.ledger.dissipated() > 0.1);
            bits(&run)
        })
    };
    let one = run_in(1);
    assert!(one == run_in(2), "two threads differ from one");
    assert!(one == run_in(3), "three threads differ from one");
}

#[test]
fn skin_changes_nothing() {
    let run_with = |skin: f64| {
        let mut run = Run::new(ModelInput { skin: Some(skin), ..pile(4, true) });
        run.steps(4000);
        (bits(&run), run.work.rebuilds())
    };
    let (a, rebuilds_a) = run_with(0.0005);
    let (b, rebuilds_b) = run_with(0.006);
    assert!(rebuilds_a.0 > 3 * rebuilds_b.0 && rebuilds_b.0 > 2, "{rebuilds_a:?} {rebuilds_b:?}");
    assert!(a == b, "the skin shows");
}

/// A clone of the state with new scratch goes on bit for bit, also across a sorting of the bodies (every 5000 steps).
#[test]
fn restart_changes_nothing() {
    let mut run = Run::new(pile(4, true));
    run.steps(4321);
    let state: State = run.state.clone();
    let work = Work::new(&run.model, &state);
    let mut again = Run { model: run.model.clone(), state, work };
    run.steps(1500);
    again.steps(1500);
    assert!(bits(&run) == bits(&again), "the restart shows");
}

/// Sorting the bodies anew keeps every contact: a settled pile does not feel it.
#[test]
fn sorting_keeps_contacts() {
    let mut run = Run::new(pile(3, true));
    let mut worst = 0.0_f64;
    let mut before = None;
    for _ in 0..5010 {
        run.step();
        let e = trackbed_dem::measure::energies(&run.model, &run.state);
        if run.state.steps > 4990 {
            if let Some(last) = before {
                let last: f64 = last;
                worst = worst.max((e.elastic_tangential - last).abs() / e.elastic_tangential);
            }
            before = Some(e.elastic_tangential);
        }
    }
    assert!(worst < 0.05, "tangential energy jumps by {worst}");
}
