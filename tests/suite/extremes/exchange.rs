//! Coupling: windows, soft ground, heavy grains, borders, lift-off, edge of the mesh.

use super::case::{Case, off};
use super::scenes::{ball, mass, material, stone, time};
use super::table::{Row, figure, figures, rows};
use trackbed_fem::mesh::{Constraint, Mesh};

rows! {
    windows: "soft ground under stiff stones, W from 0.01 to 10";
    heavy: "stone heavier than the mesh";
    sliding: "sliding over borders of elements and materials";
    lift_off: "lift-off and return";
    seats: "stone on a node, a seam, the edge and the corner of the mesh";
    leaving: "stone that leaves the mesh";
    impact: "1000 m/s against a thin plate of elements";
    folding: "surface that folds";
}

fn ground(counts: [u32; 2], keys: &str) -> String {
    let [n, layers] = counts;
    format!(
        "\n[solid]\n\n[solid.block]\nx = {{ lines = [0.0, 1.0], counts = [{n}] }}\n\
         y = {{ lines = [0.0, 1.0], counts = [{n}] }}\nz = {{ lines = [-0.5, 0.0], counts = [{layers}] }}\n\n\
         [[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n"
    ) + &material(1, keys)
}

const DAMPED: &str = "\n[solid.rayleigh]\nalpha_m = 100.0\nbeta_k = 1e-3\n";

fn coupled(keys: &str, end: f64, rows: u32) -> String {
    format!("\n[coupling]\nmaterial = \"stone\"\n{keys}\n")
        + &time(end, rows).replace("vtk = false", "vtk = false\ntecplot = false")
}

fn class(case: &Case, key: &str) -> f64 {
    case.value(&format!("/coupling/classes/0/{key}"))
}

/// Relative error of the mean force of a ball in the last tenth.
fn weight_error(case: &Case, radius: f64) -> f64 {
    let force = case.history("contact_force_on_solid_z");
    let late = &force[force.len() * 9 / 10..];
    off(-late.iter().sum::<f64>() / late.len() as f64, mass(radius) * 9.81)
}

fn windows() -> Row {
    let text = |keys: &str| {
        stone("stiffness = 1e7\n")
            + &ground([4, 2], "young = 1e6\npoisson = 0.3\ndensity = 1000")
            + &ball("ball", [0.52, 0.47, 0.051], 0.05, [0.0, 0.0, -0.5])
            + &coupled(keys, 0.015, 100)
    };
    let one = Case::run(&text("substeps = 1"), &["time.end=1e-4"]).good();
    let scale = (class(&one, "masses/corner") / class(&one, "stiffness")).sqrt();
    let run = |scheme: &str, w: f64| {
        let keys = format!("scheme = \"{scheme}\"\nwindow = {:e}", w * scale);
        let grain = w / (w / 0.28).ceil() * scale;
        let case = Case::run(&text(&keys).replace("[time]", &format!("[time]\ngrain_step = {grain:e}")), &[]);
        assert!(off(class(&case, "w"), w) < 1e-9);
        case
    };
    let account = |case: Case| case.good().value("/energy/largest_relative_error");
    let predicted = [0.01, 0.1, 0.5].map(|w| account(run("predicted", w)));
    assert!(predicted.iter().all(|e| *e < 0.01), "{predicted:?}");
    for w in [3.0, 10.0] {
        let case = run("predicted", w);
        case.stopped("energy error: ");
        assert!(case.warned("coupling may be unstable"));
    }
    let iterated = [0.5, 3.0, 10.0].map(|w| account(run("iterated", w)));
    assert!(iterated.iter().all(|e| *e < 0.01), "{iterated:?}");
    Row::new(
        "stone at 0.5 m/s, K = 10 MN/m, on ground of 1 MPa; predicted: W = 0.01, 0.1, 0.5; 3, 10; iterated: 0.5, 3, 10",
        format!(
            "predicted right up to its limit 1: energy account off by {}; beyond warned before the run (`coupling may be unstable`) and stopped by the account; iterated right: {}",
            figures(&predicted),
            figures(&iterated)
        ),
        "energy account",
    )
}

fn heavy() -> Row {
    let text = |density: f64, keys: &str, step: &str| {
        stone("stiffness = 1e6\nrestitution = 0.2\n")
            + &ground([2, 1], &format!("poisson = 0.3\ndensity = {density:?}"))
            + DAMPED
            + &ball("ball", [0.52, 0.47, 0.25], 0.25, [0.0; 3])
            + &coupled(keys, 0.4, 100).replace("[time]", &format!("[time]\n{step}"))
    };
    let mut errors = Vec::new();
    for density in [100.0, 10.0] {
        let ten = Case::run(&text(density, "", ""), &[]);
        ten.stopped("energy error: ");
        assert!(ten.warned("times the smallest effective nodal mass") && ten.warned("may be unstable"));
        let refused = Case::run(&text(density, "substeps = \"auto\"", ""), &[]);
        refused.refused("coupling.substeps: found \"auto\" with W = ");
        let iterated = Case::run(&text(density, "scheme = \"iterated\"", ""), &[]).good();
        assert!(iterated.warned("may be unstable"));
        errors.push(weight_error(&iterated, 0.25));
        if density == 100.0 {
            let said = refused.outcome.stderr.split_once("time.grain_step of ").unwrap().1;
            let step = format!("grain_step = {}", said.split_once(" s or less").unwrap().0);
            errors.push(weight_error(
                &Case::run(&text(density, "substeps = \"auto\"", &step), &[]).good(),
                0.25,
            ));
        }
    }
    assert!(errors.iter().all(|e| *e < 5e-3), "{errors:?}");
    Row::new(
        "stone 3.4 and 34 times as heavy as the mesh, 844 and 8440 times as its lightest point",
        format!(
            "10 sub-steps warned (`times the smallest effective nodal mass`, `may be unstable`) and stopped by the energy account; \
             `\"auto\"` refused: `coupling.substeps` with the step that would do; with that step and in iterated windows right: \
             weight off by {}",
            figures(&errors)
        ),
        "weight at rest",
    )
}

fn sliding() -> Row {
    let mut mesh = Mesh::block([8, 2, 1], [1.0, 0.25, 0.25]);
    mesh.coordinates.iter_mut().for_each(|x| x[2] -= 0.25);
    for (e, material) in mesh.materials.iter_mut().enumerate() {
        *material = if e % 8 < 4 { 1 } else { 2 };
    }
    let base = (0..mesh.node_count()).filter(|&n| mesh.coordinates[n][2] < -0.249);
    let constraints: Vec<Constraint> = base
        .flat_map(|node| (0..3).map(move |direction| Constraint { node: node as u32, direction, value: 0.0 }))
        .collect();
    let (mut speeds, mut weights) = (Vec::new(), Vec::new());
    for ratio in [1.0, 100.0, 1e6] {
        let text = stone("stiffness = 1e6\nrestitution = 0.2\nfriction = 0\n")
            + "\n[solid]\nnodes = \"NODECOORD.DAT\"\nelements = \"ELEMENTNUM.DAT\"\nconstraints = \"DOF.DAT\"\n"
            + DAMPED
            + &material(1, "young = 5e6")
            + &material(2, &format!("young = {:e}", 5e6 * ratio))
            + &ball("ball", [0.1, 0.11, 0.04995], 0.05, [2.0, 0.0, 0.0])
            + &coupled("substeps = \"auto\"", 0.4, 800);
        let case = Case::on_mesh(&mesh, &constraints, &text, &[]).good();
        let [x, y, _] = case.velocity("ball", 0.1);
        speeds.push(off(x, 2.0).max(y.abs() / 2.0));
        let force = case.history("contact_force_on_solid_z");
        let over = &force[200..force.len() - 100];
        weights.push(off(-over.iter().sum::<f64>() / over.len() as f64, mass(0.05) * 9.81));
    }
    assert!(speeds.iter().all(|e| *e < 1e-3) && weights.iter().all(|e| *e < 0.01), "{speeds:?} {weights:?}");
    Row::new(
        "ball at 2 m/s over eight elements, the last four 1, 100, 1e6 times as stiff",
        format!(
            "right: speed afterwards off by {}, mean force on the way by {} of the weight",
            figures(&speeds),
            figures(&weights)
        ),
        "a frictionless ball keeps its speed",
    )
}

fn lift_off() -> Row {
    let text = stone("stiffness = 1e6\n")
        + &ground([4, 2], "young = 5e6\npoisson = 0.3")
        + DAMPED
        + &ball("ball", [0.52, 0.47, 0.15], 0.05, [0.0; 3])
        + &coupled("substeps = \"auto\"", 1.2, 1200);
    let case = Case::run(&text, &[]).good();
    let force = case.history("contact_force_on_solid_z");
    let offs = force.windows(2).filter(|f| f[0] != 0.0 && f[1] == 0.0).count();
    let (rest, account) = (weight_error(&case, 0.05), case.value("/energy/largest_relative_error"));
    assert!(offs >= 2 && rest < 1e-4 && account < 0.05, "{offs} {rest} {account}");
    Row::new(
        "ball dropped from 0.1 m",
        format!(
            "right: lifts off {offs} times, then rests with its weight to {}; warned: energy account off by {} %",
            figure(rest),
            figure(100.0 * account)
        ),
        "weight at rest",
    )
}

fn seats() -> Row {
    let run = |x: f64, y: f64, keys: &str| {
        let text = stone(
            "stiffness = 1e6\nrestitution = 0.2\nrolling_friction = 0.5\ntangential_damping_ratio = 1.0\n",
        ) + &ground([4, 2], "young = 50e6\npoisson = 0.3")
            + DAMPED
            + &ball("ball", [x, y, 0.0501], 0.05, [0.0; 3])
            + &coupled(keys, 0.25, 250);
        Case::run(&text, &[]).good()
    };
    let inside = [(0.52, 0.47), (0.5, 0.52), (0.5, 0.5), (0.625, 0.5)];
    let inside = inside.map(|(x, y)| weight_error(&run(x, y, "substeps = \"auto\""), 0.05));
    assert!(inside.iter().all(|e| *e < 1e-6), "{inside:?}");
    let edge = weight_error(&run(1.0, 0.52, "substeps = \"auto\""), 0.05);
    let iterated = run(1.0, 1.0, "scheme = \"iterated\"");
    let corner = [weight_error(&run(1.0, 1.0, "substeps = 1"), 0.05), weight_error(&iterated, 0.05)];
    assert!(edge < 1e-6 && corner.iter().all(|e| *e < 1e-6), "{edge} {corner:?}");
    let chatter = run(1.0, 1.0, "substeps = \"auto\"");
    assert!(chatter.warned("coupling: interface dashpot error "));
    let account = chatter.value("/energy/largest_relative_error");
    Row::new(
        "ball at rest in a face, over a seam, a node, a mid-side node, the edge and the corner of the mesh",
        format!(
            "right: weight off by {}, on the edge by {}, on the corner with one sub-step by {}, in iterated windows by {}; limit: \
             `\"auto\"` follows the masses within, at the corner it chatters, warned: energy account off by {} %",
            figures(&inside),
            figure(edge),
            figure(corner[0]),
            figure(corner[1]),
            figure(100.0 * account)
        ),
        "weight at rest",
    )
}

fn leaving() -> Row {
    let text = |speed: f64| {
        stone("stiffness = 1e6\nrestitution = 0.4\n")
            + &ground([4, 2], "poisson = 0.3")
            + &ball("ball", [0.8, 0.5, 0.05], 0.05, [speed, 0.0, 0.0])
            + &coupled("substeps = \"auto\"", 0.4, 400)
    };
    let remark = "bodies lost below the surface of the solid: 1, first body 0 of \"ball\" at";
    let case = Case::run(&text(2.0), &[]).good();
    let account = case.value("/energy/largest_relative_error");
    assert!(case.warned(remark) && case.last("ball_z") < -0.1 && account < 0.01, "{account}");
    assert!(!Case::run(&text(0.0), &[]).good().warned("left the solid"));
    Row::new(
        "ball rolling off the border at 2 m/s; one that stays",
        format!(
            "falls past the mesh, energy account off by {}; warned: `bodies that have left the solid`",
            figure(account)
        ),
        "energy account",
    )
}

fn impact() -> Row {
    let run = |stiffness: f64| {
        let plate = ground([4, 1], "young = 200e9\npoisson = 0.3\ndensity = 7850")
            .replace("lines = [-0.5, 0.0]", "lines = [-0.01, 0.0]")
            .replace("side = \"z-\"", "side = \"x-\"");
        let text = stone(&format!("stiffness = {stiffness:e}\nrestitution = 0.9\n"))
            + &plate
            + &ball("ball", [0.52, 0.47, 0.0101], 0.01, [0.0, 0.0, -1000.0])
            + &coupled("substeps = \"auto\"", 1e-4, 100);
        Case::run(&text, &[])
    };
    let (mut accounts, mut speeds) = (Vec::new(), Vec::new());
    for stiffness in [1.1e10, 4.4e8, 4.8e7] {
        let case = run(stiffness).good();
        accounts.push(case.value("/energy/largest_relative_error"));
        speeds.push(case.velocity("ball", 0.1)[2]);
    }
    assert!(accounts.iter().all(|e| *e < 0.01), "{accounts:?}");
    assert!(speeds.iter().all(|v| (850.0..900.0).contains(v)), "{speeds:?}");
    run(1e7).stopped("energy error: ");
    run(1e5).stopped("speed of body 0 of \"ball\": 1000");
    Row::new(
        "ball of 10 mm, e = 0.9, on a steel plate 1 m × 10 mm; deepest overlap 0.1, 0.5, 1.5 radii; 3.3; 33",
        format!(
            "right: comes back at {} m/s (900 less what the plate takes), energy account off by {}; deeper than its diameter \
             stopped by that account; softer stopped: `speed of body 0`",
            speeds.iter().map(|v| format!("{v:.0}")).collect::<Vec<_>>().join(", "),
            figures(&accounts)
        ),
        "energy account",
    )
}

fn folding() -> Row {
    let load = "\n[[solid.load]]\nkind = \"point\"\nat = [0.0, 0.0, 0.0]\nforce = [4e8, 4e8, 0]\n\
                history = { kind = \"ramp\", duration = 0.05 }\n";
    let text = stone("")
        + &ground([4, 2], "poisson = 0.3")
        + load
        + &ball("ball", [0.5, 0.5, 0.05], 0.05, [0.0; 3])
        + &coupled("", 0.1, 100);
    Case::run(&text, &[]).stopped("inverted face of the solid surface at element ");
    Row::new(
        "corner of the ground pushed through its neighbours",
        "stopped: `inverted face of the solid surface` with time",
        "a face turns over",
    )
}
