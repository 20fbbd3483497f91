//! Recorded walls: forces; stress–strain of servo tests.

use super::overlay::{dominant, overlay};
use crate::data::RunData;
use crate::page::{Cell, Section, joined, paragraph, plots, table};
use crate::plot::{Axis, figure};
use trackbed_input::scene::walls::{Wall, WallKind};
use trackbed_io::columns::{Definition, history};
use trackbed_io::results::tables::Table;

/// Contact threshold over largest force.
const TOUCH: f64 = 0.01;

/// Formats loads and motions against their targets.
pub fn applied(runs: &[RunData]) -> Option<Section> {
    let mut rows = Vec::new();
    for run in runs {
        for load in run.list("loads") {
            let text = |key: &str| load[key].as_str().unwrap_or_default();
            let unit = if text("quantity").ends_with("[m]") { "m" } else { "N" };
            let name =
                format!("{}: {}", text("name"), text("quantity").split(" [").next().unwrap_or_default());
            let name = if runs.len() > 1 { format!("{}: {name}", run.label) } else { name };
            let number = |side: &str, key: &str| Cell::of(load[side][key].as_f64(), unit);
            let percent =
                load["error"].as_f64().map_or(Cell::Nothing, |e| Cell::text(format!("{:.2} %", 100.0 * e)));
            let phase = load["phase"].as_f64().map_or(Cell::Nothing, |p| Cell::text(format!("{p:.2}°")));
            let sides = ["target", "applied"].map(|side| ["min", "mean", "max"].map(|key| number(side, key)));
            rows.push((name, sides.concat().into_iter().chain([phase, percent]).collect()));
        }
    }
    let heads =
        ["", "target: smallest", "mean", "largest", "applied: smallest", "mean", "largest", "phase", "error"];
    Section::new("applied", "Applied loads", table(&heads, &rows))
}

/// Formats wall forces.
pub fn walls(runs: &[RunData]) -> Option<Section> {
    let forces = overlay(runs, |run| {
        let of = |stem: &str| {
            let (axis, values) = dominant(run, history::WALL_FORCE.of(stem))?;
            let time = run.table("history")?.column(history::TIME)?;
            Some((format!("{stem}, {axis}"), time.iter().zip(values).map(|(t, f)| [*t, *f]).collect()))
        };
        stems(run).iter().filter_map(|s| of(s)).collect()
    });
    let ways = overlay(runs, |run| {
        let of = |stem: &str| {
            let (axis, way) = dominant(run, history::WALL_DISPLACEMENT.of(stem))?;
            let force = run.table("history")?.column(history::WALL_FORCE.of(stem).along(axis)?)?;
            Some((format!("{stem}, {axis}"), way.iter().zip(force).map(|(u, f)| [*u, *f]).collect()))
        };
        stems(run).iter().filter_map(|s| of(s)).collect()
    });
    let stress = overlay(runs, |run| servos(run).into_iter().map(|s| (s.name, s.points)).collect());
    let strained = !stress.is_empty();
    let html = plots([
        figure(
            "Stress and strain of servo walls",
            Axis::new("strain", ""),
            Axis::new("stress", "Pa"),
            stress,
        ),
        figure("Force of the grains on walls", Axis::new("time", "s"), Axis::new("force", "N"), forces),
        figure(
            "Force–displacement of moving walls",
            Axis::new("displacement", "m"),
            Axis::new("force", "N"),
            ways,
        ),
    ]);
    let note = match strained {
        true => paragraph(
            "Component with the largest variation for each wall. Stress of a servo wall: force of the grains along its normal over its \
             area; strain: its displacement towards the plane that faces it since the stress first passed 1 % of its largest, over their distance then.",
        ),
        false => paragraph("Component with the largest variation for each wall."),
    };
    if html.0.is_empty() { None } else { Section::new("walls", "Walls", joined([html, note])) }
}

fn stems(run: &RunData) -> Vec<&str> {
    run.table("history").map(|t| t.items(history::WALL_MOMENT.at(0))).unwrap_or_default()
}

struct Servo {
    name: String,
    points: Vec<[f64; 2]>,
}

/// Planes with an area and an opposite plane.
fn servos(run: &RunData) -> Vec<Servo> {
    let (Some(scene), Some(table)) = (&run.scene, run.table("history")) else { return Vec::new() };
    scene.walls.iter().filter_map(|wall| servo(wall, &scene.walls, table)).collect()
}

fn servo(wall: &Wall, all: &[Wall], table: &Table) -> Option<Servo> {
    let area = wall.servo.as_ref()?.area?;
    let name = wall.name.as_ref()?;
    let (point, normal) = plane(wall)?;
    let along = |vector: &'static Definition| -> Option<Vec<f64>> {
        let [x, y, z] = [0, 1, 2].map(|axis| table.column(vector.of(name).at(axis)));
        let (x, y, z) = (x?, y?, z?);
        Some((0..x.len()).map(|k| dot([x[k], y[k], z[k]], normal)).collect())
    };
    let (force, way) = (along(history::WALL_FORCE)?, along(history::WALL_DISPLACEMENT)?);
    // A platen may travel before contact.
    let most = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let start = force.iter().position(|f| f.abs() > TOUCH * most)?;
    let first = way[start];
    // Nearest opposite plane in front.
    let faces = all.iter().filter_map(plane).filter(|(_, n)| dot(*n, normal) < -0.999);
    let gaps = faces.map(|(p, _)| dot([0, 1, 2].map(|d| p[d] - point[d]), normal) - first);
    let gap = gaps.filter(|g| *g > 0.0).min_by(f64::total_cmp)?;
    let points = way.iter().zip(&force).skip(start).map(|(u, f)| [(u - first) / gap, -f / area]).collect();
    Some(Servo { name: name.clone(), points })
}

fn plane(wall: &Wall) -> Option<([f64; 3], [f64; 3])> {
    if wall.kind != WallKind::Plane {
        return None;
    }
    let normal = wall.normal?;
    let length = dot(normal, normal).sqrt();
    (length > 0.0).then_some((wall.point.map(|p| p.map(|x| x.si))?, normal.map(|n| n / length)))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
