//! Contact laws: overlap-dependent stiffness, adhesion.

use super::case::{Case, off};
use super::scenes::{ball, floor, mass, time};
use super::table::{Row, figures, rows};

rows! {
    hertz: "Young's modulus of Hertzian contacts, soft and stiff";
    adhesion: "adhesion up to and beyond the weight";
}

fn material(keys: &str) -> String {
    format!(
        "title = \"edge\"\n\n[[material]]\nname = \"stone\"\ndensity = 2600\nfriction = 0.5\nrestitution = 0.1\n{keys}\n"
    )
}

fn hertz() -> Row {
    let mut errors = Vec::new();
    for (young, poisson) in [(1e5, 0.3), (1e8, 0.0), (1e11, 0.5), (1e14, 0.3)] {
        let modulus = young / (2.0 * (1.0 - poisson * poisson));
        let rest = (0.75 * mass(0.01) * 9.81 / (modulus * 0.1)).powf(2.0 / 3.0);
        let text = material(&format!("young = {young:e}\npoisson = {poisson:?}"))
            + &ball("ball", [0.0, 0.0, 0.01 - 0.9 * rest], 0.01, [0.0; 3])
            + &floor()
            + &time(100.0 * (rest / 9.81).sqrt(), 100);
        let case = Case::run(&text, &[]).good();
        errors.push(off(0.01 - case.last("ball_z"), rest));
    }
    assert!(errors.iter().all(|e| *e < 1e-3), "{errors:?}");
    for poisson in [0.51, -1.0] {
        let text = material(&format!("young = 1e9\npoisson = {poisson:?}"))
            + &ball("ball", [0.0, 0.0, 0.01], 0.01, [0.0; 3])
            + &time(0.1, 10);
        Case::run(&text, &[]).refused("material.0.poisson: found ");
    }
    Row::new(
        "ball at rest on a floor, Young's modulus 1e5, 1e8, 1e11, 1e14 Pa, Poisson's ratio 0 to 0.5; 0.51, −1",
        format!(
            "right: overlap off by {}; outside −1 to 0.5 refused: `material.0.poisson`",
            figures(&errors)
        ),
        "F = 4/3 E* √R δ^1.5",
    )
}

fn adhesion() -> Row {
    // Hanging ball: adhesion 2 π w R.
    let weight = mass(0.01) * 9.81;
    let hangs = |share: f64| {
        let work = share * weight / (2.0 * std::f64::consts::PI * 0.01);
        let depth = (share - 1.0).max(0.0) * weight / 1e5;
        let text = material("stiffness = 1e5")
            + &format!("\n[[contact]]\nbetween = [\"stone\", \"stone\"]\nadhesion = {work:e}\n")
            + &ball("ball", [0.0, 0.0, -0.01 + 1.1 * depth], 0.01, [0.0; 3])
            + &floor().replace("normal = [0.0, 0.0, 1.0]", "normal = [0.0, 0.0, -1.0]")
            + &time(0.2, 100);
        let case = Case::run(&text, &[]).good();
        (case.last("ball_z") + 0.01, depth, case.last("time"))
    };
    let mut errors = Vec::new();
    for share in [1.01, 10.0, 1000.0] {
        let (overlap, right, _) = hangs(share);
        errors.push(off(overlap, right));
    }
    for share in [0.0, 0.99] {
        let (fallen, _, time) = hangs(share);
        errors.push(off(fallen, -0.5 * 9.81 * time * time));
    }
    assert!(errors.iter().all(|e| *e < 1e-3), "{errors:?}");
    Row::new(
        "ball under a ceiling, 2π w R of 1.01, 10, 1000 and 0, 0.99 weights",
        format!(
            "right: overlap off by {}; less than the weight falls, way off by {}",
            figures(&errors[..3]),
            figures(&errors[3..])
        ),
        "2π w R − m g = K δ; ½ g t²",
    )
}
