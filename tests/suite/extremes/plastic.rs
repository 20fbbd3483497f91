//! Plasticity: limiting friction angles, no cohesion, apex and edges, huge steps.

use super::case::{Case, off};
use super::scenes::{LISTS, TABLES, held, material, pressure};
use super::solid::cylinder;
use super::table::{Row, figure, figures, rows};
use crate::suite::support::PLASTIC;

rows! {
    friction_angles: "friction 0, towards 0, 60° in a structure";
    dilation: "dilation 0 and equal to the friction";
    no_cohesion: "no cohesion at a free surface";
    steep: "slope without cohesion";
    apex: "returns to the apex and the cut-off";
    edges: "returns to the edges";
    load_steps: "load steps 1, 10, 100 times too large";
    collapse: "loads beyond the collapse";
}

fn mohr_coulomb(cohesion: f64, friction: f64, dilation: f64) -> String {
    format!(
        "model = \"mohr_coulomb\"\ncohesion = {cohesion:e}\nfriction = \"{friction:?} deg\"\ndilation = \"{dilation:?} deg\""
    )
}

/// Limit pressure [Pa] of a thick cylinder, radii 1 and 2 m, plane strain.
fn bursting(cohesion: f64, tangent: f64) -> f64 {
    if tangent < 1e-12 {
        return 2.0 * cohesion * 2.0_f64.ln();
    }
    let sine = tangent / (1.0 + tangent * tangent).sqrt();
    cohesion / tangent * (2.0_f64.powf(2.0 * sine / (1.0 + sine)) - 1.0)
}

/// Inner pressure rising to `load` [Pa] in steps of fraction `step`.
fn burst(keys: &str, load: f64, step: f64) -> Case {
    let (mesh, constraints, faces) = cylinder([4, 6]);
    let text = LISTS.to_string()
        + &material(1, keys)
        + &format!(
            "\n[[solid.load]]\nkind = \"pressure\"\npressure = {load:e}\nfaces = [{faces}]\n\
             history = {{ kind = \"ramp\", duration = 1.0 }}\n\n[solid.newton]\nmax_iterations = 20\n\n\
             [solid.quasi_static]\n\n[time]\nend = 1.0\nsolid_step = {step:e}\n"
        )
        + TABLES;
    Case::on_mesh(&mesh, &constraints, &text, &[])
}

/// Reported fraction of the final pressure at failure.
fn reached(case: &Case) -> f64 {
    case.stopped("solid: not converged at time ");
    let text = case.outcome.stderr.split_once("at time ").unwrap().1;
    text.split_once(':').unwrap().0.parse().unwrap()
}

/// Computed over exact limit pressure, to the smallest step (5e-5).
fn strength(friction: f64, dilation: f64) -> f64 {
    let right = bursting(1e4, friction.to_radians().tan());
    1.05 * reached(&burst(&mohr_coulomb(1e4, friction, dilation), 1.05 * right, 0.05))
}

fn worst(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

fn friction_angles() -> Row {
    let errors = [0.0, 1e-6, 1e-3, 1.0, 60.0, 80.0].map(|friction| (strength(friction, 0.0) - 1.0).abs());
    assert!(errors.iter().all(|e| *e < 5e-3), "{errors:?}");
    burst(&mohr_coulomb(1e4, 80.1, 0.0), 1.0, 1.0).refused("solid.material.0.friction: found ");
    burst(&mohr_coulomb(0.0, 0.0, 0.0), 1.0, 1.0).refused("solid.material.0.cohesion: found ");
    Row::new(
        "0, 1e-6°, 1e-3°, 1°, 60°, 80° in a thick cylinder; 80.1°; 0 without cohesion",
        format!(
            "right: bursting pressure off by {} at most; refused: `solid.material.0.friction`, `solid.material.0.cohesion`",
            figure(worst(&errors))
        ),
        "c cot φ ((b/a)^(2 sin φ/(1 + sin φ)) − 1)",
    )
}

fn dilation() -> Row {
    let angles = [(30.0, 0.0), (30.0, 30.0), (60.0, 60.0), (1e-3, 1e-3)];
    let errors = angles.map(|(friction, dilation)| (strength(friction, dilation) - 1.0).abs());
    assert!(errors.iter().all(|e| *e < 5e-3), "{errors:?}");
    burst(&mohr_coulomb(1e4, 30.0, 30.1), 1.0, 1.0).refused("solid.material.0.dilation: found ");
    Row::new(
        "friction and dilation 30° and 0, 30° and 30°, 60° and 60°, 1e-3° and 1e-3°; dilation above friction",
        format!(
            "right: bursting pressure off by {} at most; refused: `solid.material.0.dilation`",
            figure(worst(&errors))
        ),
        "as above; it does not depend on the dilation",
    )
}

/// Ground of 2 m × 1 m. Force over Rankine's.
fn rankine(friction: f64, way: f64) -> f64 {
    let text = "title = \"wall\"\n\n[solid]\n\n[solid.block]\nx = { lines = [0.0, 2.0], counts = [2] }\n\
                y = { lines = [0.0, 1.0], counts = [1] }\nz = { lines = [0.0, 1.0], counts = [4] }\n"
        .to_string()
        + &material(1, &mohr_coulomb(0.0, friction, 0.0))
        + &[("x-", "x"), ("y-", "y"), ("y+", "y"), ("z-", "z")].map(|(side, d)| held(side, d, "")).concat()
        + &held(
            "x+",
            "x",
            &format!(
                "name = \"wall\"\ndisplacement = {way:e}\nhistory = {{ kind = \"ramp\", duration = 1.0 }}"
            ),
        )
        + "\n[solid.initial_stress]\nmethod = \"k0\"\nk0 = 0.5\n\n[solid.quasi_static]\n\n[time]\nend = 1.0\nsolid_step = 0.05\n"
        + TABLES;
    let case = Case::run(&text, &[]).good();
    let sine = friction.to_radians().sin();
    let ratio = if way < 0.0 { (1.0 + sine) / (1.0 - sine) } else { (1.0 - sine) / (1.0 + sine) };
    case.last("wall_reaction_x") / (-0.5 * 2000.0 * 9.81 * ratio)
}

fn no_cohesion() -> Row {
    let mut errors = Vec::new();
    for (friction, way) in [(30.0, -0.04), (60.0, -0.1), (30.0, 0.01), (60.0, 0.01)] {
        errors.push((rankine(friction, way) - 1.0).abs());
    }
    assert!(errors.iter().all(|e| *e < 1e-4), "{errors:?}");
    Row::new(
        "level ground without cohesion pushed and let go by a smooth wall, friction 30° and 60°",
        format!(
            "right: passive forces off by {}, active ones by {}",
            figures(&errors[..2]),
            figures(&errors[2..])
        ),
        "Rankine, ½ γ H² K",
    )
}

/// Cube under top displacements `ways` [m] or cell pressure; top reaction [N].
fn cube(keys: &str, ways: [Option<f64>; 3], cell: f64, step: f64) -> Case {
    let axis = "{ lines = [0.0, 1.0], counts = [2] }";
    let mut text = format!(
        "title = \"cube\"\n\n[solid]\ngravity = false\n\n[solid.block]\nx = {axis}\ny = {axis}\nz = {axis}\n"
    ) + &material(1, keys)
        + &[("x-", "x"), ("y-", "y"), ("z-", "z")].map(|(side, d)| held(side, d, "")).concat();
    for (axis, way) in ["x", "y", "z"].into_iter().zip(ways) {
        let side = format!("{axis}+");
        text += &match way {
            Some(way) => held(
                &side,
                axis,
                &format!(
                    "name = \"{axis}\"\ndisplacement = {way:e}\nhistory = {{ kind = \"ramp\", duration = 1.0 }}"
                ),
            ),
            None => pressure(&side, cell),
        };
    }
    text += &format!("\n[solid.quasi_static]\n\n[time]\nend = 1.0\nsolid_step = {step:e}\n");
    Case::run(&(text + TABLES), &[])
}

/// Cohesionless slope of 45°, 1 m high, under its weight.
fn slope(friction: f64) -> Case {
    let text = "title = \"slope\"\n\n[solid]\n\n[solid.block]\nx = { lines = [0.0, 2.0, 3.0], counts = [4, 3] }\n\
                y = { lines = [0.0, 0.5], counts = [1] }\nz = { lines = [0.0, 1.0], counts = [4] }\ncrest = [0.0, 2.0]\n"
        .to_string()
        + &material(1, &mohr_coulomb(0.0, friction, 0.0))
        + &[("x-", "x"), ("y-", "y"), ("y+", "y"), ("z-", "xyz")].map(|(side, d)| held(side, d, "")).concat()
        + "\n[solid.newton]\nmax_iterations = 30\n\n[solid.initial_stress]\nmethod = \"gravity\"\nsteps = 5\n\n[solid.quasi_static]\nsmallest_step = 0.1\n\n[time]\nend = 1.0\nsolid_step = 1.0\n"
        + TABLES;
    Case::run(&text, &[])
}

fn steep() -> Row {
    for friction in [60.0, 46.0] {
        slope(friction).good();
    }
    for friction in [43.0, 20.0] {
        slope(friction).stopped("not converged at time ");
    }
    Row::new(
        "slope of 45° without cohesion, friction 60°, 46°, 43°, 20°",
        "right: stands from 46° on; below 45° stopped: `initial stress: … not converged` with element and point",
        "stable where φ ≥ β (dry sand)",
    )
}

fn apex() -> Row {
    let apart = [Some(0.01); 3];
    let apex = 1e4 / 30.0_f64.to_radians().tan();
    let mut errors = Vec::new();
    let drucker =
        mohr_coulomb(1e4, 30.0, 30.0).replace("mohr_coulomb\"", "drucker_prager\"\ncone = \"compression\"");
    let cut = "\ntension = 5e3";
    for (keys, right) in [
        (mohr_coulomb(1e4, 30.0, 30.0), apex),
        (mohr_coulomb(1e4, 30.0, 0.0), apex),
        (drucker.clone(), apex),
        (mohr_coulomb(1e4, 30.0, 10.0) + cut, 5e3),
        (drucker + cut, 5e3),
    ] {
        errors.push(off(cube(&keys, apart, 0.0, 0.1).good().last("z_reaction_z"), right));
    }
    assert!(errors.iter().all(|e| *e < 1e-6), "{errors:?}");
    Row::new(
        "cube pulled on all sides to a hundred times the strain at yield: Mohr–Coulomb ψ = φ and ψ = 0, Drucker–Prager; both cut off",
        format!("right: stress off by {}", figures(&errors)),
        "c cot φ; tension",
    )
}

fn edges() -> Row {
    let mut errors = Vec::new();
    let sine = 30.0_f64.to_radians().sin();
    let passive: f64 = (1.0 + sine) / (1.0 - sine);
    for dilation in [0.0, 30.0] {
        let keys = mohr_coulomb(1e4, 30.0, dilation);
        for (way, right) in
            [(-0.05, 1e5 * passive + 2e4 * passive.sqrt()), (0.05, 1e5 / passive - 2e4 / passive.sqrt())]
        {
            let case = cube(&keys, [None, None, Some(way)], 1e5, 0.05).good();
            errors.push(off(-case.last("z_reaction_z"), right));
        }
    }
    assert!(errors.iter().all(|e| *e < 1e-3), "{errors:?}");
    Row::new(
        "triaxial compression and extension, ψ = 0 and ψ = φ",
        format!("right: axial stress off by {}", figures(&errors)),
        "Mohr–Coulomb's σ₁ and σ₃",
    )
}

fn load_steps() -> Row {
    let passive: f64 = 3.0;
    let right = 1e5 * passive + 2e4 * passive.sqrt();
    let once = [1.5, 10.0, 100.0].map(|factor| {
        let way = -factor * (right - 1e5) / 20e6;
        let case = cube(&mohr_coulomb(1e4, 30.0, 10.0), [None, None, Some(way)], 1e5, 1.0).good();
        off(-case.last("z_reaction_z"), right)
    });
    assert!(once.iter().all(|e| *e < 1e-4), "{once:?}");
    let top = |step: f64, way: f64| {
        let text = PLASTIC
            .replace("\"-10 mm\"", &format!("{way:e}"))
            .replace("solid_step = 0.1", &format!("solid_step = {step:e}"));
        Case::run(&text, &[]).good().last("plate_reaction_z")
    };
    let steps = [-0.01, -0.1].map(|way| {
        let fine = top(0.01, way);
        [0.1, 1.0].map(|step| off(top(step, way), fine))
    });
    let steps = steps.as_flattened();
    assert!(steps.iter().all(|e| *e < 0.03), "{steps:?}");
    Row::new(
        "triaxial test: 1.5, 10, 100 times the strain at yield in one step; block between rough plates pressed by 1 % and 10 % in \
         10 steps and in 1 for 100",
        format!(
            "right: axial stress off by {}; force off that of 100 steps by {}",
            figures(&once),
            figures(steps)
        ),
        "Mohr–Coulomb's σ₁ and σ₃; short steps",
    )
}

fn collapse() -> Row {
    let keys = mohr_coulomb(1e4, 30.0, 30.0);
    let limit = bursting(1e4, 30.0_f64.to_radians().tan());
    for step in [1.0, 0.1] {
        burst(&keys, 0.97 * limit, step).good();
    }
    let found = [1.03, 10.0, 100.0].map(|factor| factor * reached(&burst(&keys, factor * limit, 1.0)));
    assert!(
        found[..2].iter().all(|f| (f - 1.0).abs() < 0.02) && found[2] > 0.9 && found[2] < 1.0,
        "{found:?}"
    );
    assert_eq!(reached(&burst(&keys, 1e6 * limit, 1.0)), 0.0);
    Row::new(
        "bursting pressure times 0.97; 1.03, 10, 100, 1e6, each in one step",
        format!(
            "0.97 right; beyond stopped: `not converged at time …` with element and point, having carried {} and 0 of the \
             bursting pressure",
            figures(&found)
        ),
        "bursting pressure of a thick cylinder",
    )
}
