//! The tests of the whole program: each runs the binary as a user would, on scene files, and judges what it says and
//! what it leaves on disk.

mod suite {
    mod bad_input;
    mod ballast;
    mod bedding;
    mod bonds;
    mod checkpoint;
    mod checkpoint_kill;
    mod cli;
    mod contact_laws;
    mod convert;
    mod determinism;
    mod examples;
    mod exchange;
    mod extremes;
    mod faces;
    mod fem_cases;
    mod floes;
    mod flow;
    mod go_on;
    mod grain_limits;
    mod hostile;
    mod include;
    mod mesh_forms;
    mod mesh_forms_files;
    mod mesh_orders;
    mod meshed_sleeper;
    mod messages;
    mod observe;
    mod packings;
    mod plausible;
    mod polyhedra;
    mod rail;
    mod random_runs;
    mod render;
    mod report;
    mod runout;
    mod scenes;
    mod solid_edges;
    mod solid_keys;
    mod solid_runs;
    mod solid_scenes;
    mod specimen;
    mod start;
    mod stones;
    mod structure;
    mod study;
    mod summary;
    pub mod support;
    mod track;
    mod trade;
    mod train;
    mod tutorials;
    mod verdict;
    mod view;
    mod walls;
}
