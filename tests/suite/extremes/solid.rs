//! Elastic solid: Poisson's ratio, contrasts, supports, units, time steps, large strains.

use super::case::{Case, off};
use super::scenes::{LISTS, TABLES, block, held, material, pressure, rollers};
use super::table::{Row, figure, figures, rows};
use std::f64::consts::PI;
use trackbed_fem::mesh::{Constraint, Mesh};

rows! {
    poisson: "Poisson's ratio to 0.5";
    contrast: "moduli far apart";
    unsupported: "body with rigid-body motion";
    units: "units huge and tiny";
    far: "solid far from the origin";
    time_steps: "steps from 1e-9 to 1e3 of the period";
    large_strain: "strains that are not small, forces beyond all numbers";
}

fn moved(case: &Case, mesh: &Mesh, place: [f64; 3]) -> [f64; 3] {
    let distance = |x: &[f64; 3]| -> f64 { (0..3).map(|d| (x[d] - place[d]).powi(2)).sum() };
    let node = (0..mesh.node_count())
        .min_by(|&a, &b| distance(&mesh.coordinates[a]).total_cmp(&distance(&mesh.coordinates[b])))
        .unwrap();
    let table = case.table("nodes.csv");
    let row = table.rows.iter().find(|row| row[0] == f64::from(mesh.node_ids[node])).unwrap();
    [row[1], row[2], row[3]]
}

/// Quarter of a thick cylinder, radii 1 and 2 m: mesh, supports, inner faces.
pub fn cylinder(counts: [usize; 2]) -> (Mesh, Vec<Constraint>, String) {
    let mut mesh = Mesh::block([counts[0], counts[1], 1], [1.0, 1.0, 0.25]);
    let mut constraints = Vec::new();
    for (node, x) in mesh.coordinates.iter_mut().enumerate() {
        let (radius, angle) = (1.0 + x[0], 0.5 * PI * x[1]);
        constraints.push(Constraint { node: node as u32, direction: 2, value: 0.0 });
        if x[1] == 0.0 {
            constraints.push(Constraint { node: node as u32, direction: 1, value: 0.0 });
        } else if x[1] == 1.0 {
            constraints.push(Constraint { node: node as u32, direction: 0, value: 0.0 });
        }
        *x = [radius * angle.cos(), radius * angle.sin(), x[2]];
    }
    // Face 5, low x, of each row's first element.
    let faces: Vec<String> = (0..counts[1]).map(|k| format!("[{}, 5]", k * counts[0] + 1)).collect();
    (mesh, constraints, faces.join(", "))
}

fn poisson() -> Row {
    let (mesh, constraints, faces) = cylinder([4, 6]);
    let mut errors = Vec::new();
    for keys in ["", "integration = \"full\"\ndilatation = \"mean\"", "order = \"linear\""] {
        for ratio in [0.0, 0.49, 0.4999, 0.4999999] {
            let text = LISTS.replace("gravity = false", &format!("gravity = false\n{keys}"))
                + &material(1, &format!("poisson = {ratio:?}"))
                + &format!("\n[[solid.load]]\nkind = \"pressure\"\npressure = 1e5\nfaces = [{faces}]\n")
                + TABLES;
            let case = Case::on_mesh(&mesh, &constraints, &text, &[]).good();
            let found = moved(&case, &mesh, [1.0, 0.0, 0.0])[0];
            // Lamé, plane strain, radii 1 and 2 m.
            let right = (1.0 + ratio) * 1e5 / (3.0 * 20e6) * (1.0 - 2.0 * ratio + 4.0);
            errors.push(off(found, right));
        }
    }
    assert!(errors.iter().all(|e| *e < 0.02), "{errors:?}");
    let locking = LISTS.replace("gravity = false", "gravity = false\nintegration = \"full\"")
        + &material(1, "poisson = 0.4999")
        + &format!("\n[[solid.load]]\nkind = \"pressure\"\npressure = 1e5\nfaces = [{faces}]\n")
        + TABLES;
    let locked = Case::on_mesh(&mesh, &constraints, &locking, &[]).good();
    assert!(locked.warned("elements lock: displacements come out too small"));
    for bad in [0.5, -1.0] {
        let text = LISTS.to_string() + &material(1, &format!("poisson = {bad:?}")) + TABLES;
        Case::on_mesh(&mesh, &constraints, &text, &[]).refused("solid.material.0.poisson: found ");
    }
    let worst = |part: &[f64]| figure(part.iter().copied().fold(0.0, f64::max));
    Row::new(
        "0, 0.49, 0.4999, 0.4999999 in a thick cylinder; 0.5, −1",
        format!(
            "right: inner displacement off by at most {} (reduced), {} (full, mean dilatation), {} (8 nodes); full without mean \
             dilatation warned: locks; 0.5 and −1 refused: `solid.material.0.poisson`",
            worst(&errors[..4]),
            worst(&errors[4..8]),
            worst(&errors[8..])
        ),
        "Lamé",
    )
}

fn contrast() -> Row {
    let text = |factor: f64| {
        block([
            "{ lines = [0.0, 1.0], counts = [2] }",
            "{ lines = [0.0, 1.0], counts = [1] }",
            "{ lines = [0.0, 1.0, 2.0], counts = [2, 2] }",
        ]) + "layer = [{ material = 1, top = 1.0 }, { material = 2 }]\n"
            + &material(1, &format!("young = {:e}", 1e6 * factor))
            + &material(2, "young = 1e6")
            + &rollers()
            + &pressure("z+", 1e3)
            + TABLES
    };
    let mut errors = Vec::new();
    for factor in [1e-6, 1.0, 1e6, 1e9] {
        let case = Case::run(&text(factor), &[]).good();
        let oedometric = (1.0 - 0.25) / (1.25 * 0.5);
        let right = 1e3 / (1e6 * oedometric) * (1.0 + 1.0 / factor);
        errors.push(off(case.value("/statics/largest_displacement/0"), right));
    }
    assert!(errors.iter().all(|e| *e < 1e-5), "{errors:?}");
    let stiff_below = Case::run(&text(1e13), &[]).good().value("/statics/largest_displacement/0");
    assert!(off(stiff_below, 1e3 / 1.2e6) < 1e-9);
    Case::run(&text(1e-11), &[]).stopped("equilibrium error at node ");
    Case::run(&text(1e-13), &[]).refused("found an ill-conditioned stiffness matrix");
    Row::new(
        "lower layer 1e-6, 1, 1e6, 1e9, 1e13 times as stiff as the upper one; 1e-11, 1e-13 times",
        format!(
            "right: settlement off by {}; 1e-11 stopped: `equilibrium error`; 1e-13 refused: `ill-conditioned stiffness matrix`",
            figures(&errors)
        ),
        "oedometric modulus of the layers",
    )
}

fn unsupported() -> Row {
    let text = |supports: &str| {
        block(["{ lines = [0.0, 1.0], counts = [2] }"; 3])
            + &material(1, "")
            + supports
            + &pressure("z+", 1e3)
            + TABLES
    };
    let node = |node: u32, directions: &str| {
        format!("\n[[solid.support]]\nnode = {node}\ndirections = [{directions}]\n")
    };
    let all = "\"x\", \"y\", \"z\"";
    for supports in [String::new(), held("z-", "z", ""), node(1, all), node(1, all) + &node(2, all)] {
        Case::run(&text(&supports), &[]).refused("insufficiently constrained: rigid-body motion of node ");
    }
    Case::run(&text(&rollers()), &[]).good();
    Row::new(
        "no support, a smooth base, one node, two nodes (turns about their line)",
        "refused: `insufficiently constrained: rigid-body motion of node …`",
        "rigid motions",
    )
}

fn units() -> Row {
    let mut errors = Vec::new();
    for (size, young, load) in
        [(1e-9, 1e15, 1e9), (1e-6, 1e-3, 1e-9), (1.0, 1e-9, 1e-15), (1e6, 1e3, 1e-3), (1e9, 1e18, 1e12)]
    {
        let axis = format!("{{ lines = [0.0, {size:e}], counts = [2] }}");
        let text = block([&axis; 3])
            + &material(1, &format!("young = {young:e}"))
            + &rollers()
            + &pressure("z+", load)
            + TABLES;
        let case = Case::run(&text, &[]).good();
        errors.push(off(case.value("/statics/largest_displacement/0"), size * load / (1.2 * young)));
    }
    assert!(errors.iter().all(|e| *e < 1e-9), "{errors:?}");
    Row::new(
        "column of 1 nm, 1 µm, 1 m, 1000 km, 1e9 m; Young's modulus from 1e-9 to 1e18 Pa",
        format!("right: settlement off by {}", figures(&errors)),
        "oedometric modulus",
    )
}

fn far() -> Row {
    let errors = [1e3, 1e6, 1e9, 1e12].map(|offset: f64| {
        let axis = format!("{{ lines = [{offset:?}, {:?}], counts = [2] }}", offset + 1.0);
        let text = block([&axis; 3]) + &material(1, "") + &rollers() + &pressure("z+", 1e4) + TABLES;
        off(Case::run(&text, &[]).good().value("/statics/largest_displacement/0"), 1e4 / 24e6)
    });
    assert!(errors[..3].iter().all(|e| *e < 1e-5) && errors[3] < 1e-2, "{errors:?}");
    Row::new(
        "column of 1 m at 1e3, 1e6, 1e9, 1e12 m from the origin",
        format!("right: settlement off by {}, as coordinates there are rounded", figures(&errors)),
        "oedometric modulus",
    )
}

fn time_steps() -> Row {
    // Element on rollers, sudden pressure: with lumped mass a spring with half its mass.
    let text = |step: f64, end: f64| {
        let history = end / 100.0;
        block(["{ lines = [0.0, 1.0], counts = [1] }"; 3])
            .replace("gravity = false", "gravity = false\norder = \"linear\"")
            + &material(1, "young = 24e6\npoisson = 0")
            + &rollers()
            + &pressure("z+", 1e3)
            + "\n[[probe]]\nname = \"top\"\nat = [0.0, 0.0, 1.0]\n\n[solid.dynamics]\n"
            + &format!("\n[time]\nend = {end:e}\nsolid_step = {step:e}\n")
            + &TABLES.replace("tables = true", &format!("history_interval = {history:e}\nframes = 0"))
    };
    // Consistent mass: a third of 2000 kg at the top.
    let (stiffness, mass) = (24e6, 2000.0 / 3.0);
    let omega = f64::sqrt(stiffness / mass);
    let period = 2.0 * PI / omega;
    let rest = 1e3 / stiffness;
    let mut errors = Vec::new();
    for share in [1e-9, 1e-6, 1e-3, 0.1, 1.0, 1e3] {
        let step = share * period;
        let case = Case::run(&text(step, 1000.0 * step), &[]).good();
        // Trapezoidal rule: 2 atan(ω Δt/2) per step.
        let turn = 2.0 * (0.5 * omega * step).atan();
        let (time, top) = (case.history("time"), case.history("top_u_z"));
        let error = time
            .iter()
            .zip(&top)
            .skip(1)
            .map(|(t, u)| {
                let angle = turn * (t / step).round();
                let right = 2.0 * rest * (0.5 * angle).sin().powi(2);
                (-u - right).abs()
            })
            .fold(0.0, f64::max);
        errors.push(error / top.iter().fold(0.0_f64, |m, u| m.max(u.abs())));
        assert!(case.value("/energy/largest_relative_error") < 1e-6);
    }
    assert!(errors.iter().all(|e| *e < 1e-3), "{errors:?}");
    Row::new(
        "an element under a sudden pressure, 1000 steps of 1e-9, 1e-6, 1e-3, 0.1, 1, 1000 periods",
        format!("right: motion off by {} of the trapezoidal rule, energy balance closed", figures(&errors)),
        "trapezoidal rule of an oscillator: angle 2 atan(ω Δt/2) a step",
    )
}

fn large_strain() -> Row {
    let text = |load: f64| {
        block(["{ lines = [0.0, 1.0], counts = [2] }"; 3])
            + &material(1, "")
            + &rollers()
            + &pressure("z+", load)
            + TABLES
    };
    let small = Case::run(&text(1e4), &[]).good();
    assert!(!small.warned("strained") && !small.warned("size"));
    assert!(Case::run(&text(2e6), &[]).good().warned("solid: strain "));
    assert!(Case::run(&text(2e8), &[]).good().warned("more than its size of "));
    Case::run(&text(1e200), &[]).stopped("strain energy");
    Row::new(
        "column pressed by 4e-4, 0.08, 8 and 1e193 of its height",
        "right; warned: `solid: strain …`; warned: `more than its size`; stopped: `strain energy`",
        "range of small strains",
    )
}
