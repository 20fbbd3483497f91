//! Scene parts, SI units.

use std::f64::consts::PI;

/// Material `stone`, 2600 kg/m³, with `keys`.
pub fn stone(keys: &str) -> String {
    let mut text = String::from("title = \"edge\"\n");
    text += if keys.contains("weightless") { "gravity = [0, 0, 0]\n" } else { "" };
    text += "\n[[material]]\nname = \"stone\"\ndensity = 2600\n";
    for (key, usual) in [("stiffness", "1e5"), ("friction", "0.5"), ("restitution", "0.5")] {
        if !keys.lines().any(|line| line.starts_with(&format!("{key} ="))) {
            text += &format!("{key} = {usual}\n");
        }
    }
    text + &keys.replace("weightless", "")
}

/// Recorded ball [m, m/s].
pub fn ball(name: &str, place: [f64; 3], radius: f64, velocity: [f64; 3]) -> String {
    let [x, y, z] = place;
    format!(
        "\n[[grains]]\nname = \"{name}\"\nshape = \"sphere\"\nmaterial = \"stone\"\nrecord = true\naccept_overlap = true\n\
         spheres = [[{x:?}, {y:?}, {z:?}, {radius:?}]]\nvelocity = {velocity:?}\n"
    )
}

/// Recorded plane.
pub fn plane(name: &str, point: [f64; 3], normal: [f64; 3]) -> String {
    format!(
        "\n[[walls]]\nname = \"{name}\"\nkind = \"plane\"\nmaterial = \"stone\"\nrecord = true\n\
         point = {point:?}\nnormal = {normal:?}\n"
    )
}

/// Duration [s] and history rows.
pub fn time(end: f64, rows: u32) -> String {
    let interval = end / f64::from(rows);
    format!("\n[time]\nend = {end:?}\n\n[output]\nvtk = false\nhistory_interval = {interval:?}\n")
}

/// Floor through the origin.
pub fn floor() -> String {
    plane("floor", [0.0; 3], [0.0, 0.0, 1.0])
}

/// Mass of a ball of 2600 kg/m³ [kg].
pub fn mass(radius: f64) -> f64 {
    2600.0 * 4.0 / 3.0 * PI * radius.powi(3)
}

/// Solid material.
pub fn material(id: u32, keys: &str) -> String {
    let mut text = format!("\n[[solid.material]]\nid = {id}\n{keys}\n");
    for (key, usual) in [("young", "20e6"), ("poisson", "0.25"), ("density", "2000")] {
        if !keys.lines().any(|line| line.starts_with(&format!("{key} ="))) {
            text += &format!("{key} = {usual}\n");
        }
    }
    text
}

/// Constrained or moved side.
pub fn held(side: &str, directions: &str, more: &str) -> String {
    let list: Vec<String> = directions.chars().map(|d| format!("\"{d}\"")).collect();
    format!("\n[[solid.support]]\nside = \"{side}\"\ndirections = [{}]\n{more}\n", list.join(", "))
}

/// Rollers on all sides but the top.
pub fn rollers() -> String {
    [("x-", "x"), ("x+", "x"), ("y-", "y"), ("y+", "y"), ("z-", "z")]
        .map(|(side, d)| held(side, d, ""))
        .concat()
}

/// Pressure on a side.
pub fn pressure(side: &str, value: f64) -> String {
    format!("\n[[solid.load]]\nkind = \"pressure\"\nside = \"{side}\"\npressure = {value:e}\n")
}

/// Scene on adjacent lists.
pub const LISTS: &str = "title = \"edge\"\n\n[solid]\ngravity = false\nnodes = \"NODECOORD.DAT\"\n\
                         elements = \"ELEMENTNUM.DAT\"\nconstraints = \"DOF.DAT\"\n";

/// Final tables, no frames.
pub const TABLES: &str = "\n[output]\nvtk = false\ntecplot = false\ntables = true\n";

/// Block of one material.
pub fn block(lines: [&str; 3]) -> String {
    let [x, y, z] = lines;
    format!("title = \"edge\"\n\n[solid]\ngravity = false\n\n[solid.block]\nx = {x}\ny = {y}\nz = {z}\n")
}
