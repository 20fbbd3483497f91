//! Grains filled up to an open border.

use super::bed::{Extent, of_solid};
use super::findings::{Findings, shown};
use crate::model::Job;
use crate::scene::Scene;
use crate::scene::walls::{Wall, WallKind};

const AXES: [&str; 2] = ["x", "y"];

/// Checks each fill against the four solid borders.
pub fn weigh(findings: &mut Findings, scene: &Scene, job: &Job) {
    let (Some(part), Some(solid), Some(_)) = (&job.grains, of_solid(job), &scene.coupling) else { return };
    let size = 2.0 * part.groups.mean_reach();
    // Other walls may hold the grains.
    if scene.walls.iter().any(|w| !matches!(w.kind, WallKind::Plane)) {
        return;
    }
    for (k, group) in scene.grains.iter().enumerate() {
        let Some(fill) = &group.fill else { continue };
        let low = [fill.low[0].si, fill.low[1].si];
        let high = [fill.high[0].si, fill.high[1].si];
        let open = open_borders(scene, &solid, (low, high), size);
        if !open.is_empty() {
            let found =
                format!("grains up to the border of the solid at {}, without a wall there", open.join(", "));
            findings.add(
                false,
                format!("grains.{k}.fill"),
                found,
                format!(
                    "a plane within a grain's size ({}) of the border, or a wider solid",
                    shown(size, "m")
                ),
            );
        }
    }
}

/// Open borders within half a grain `size` [m] of a fill.
fn open_borders(scene: &Scene, solid: &Extent, fill: ([f64; 2], [f64; 2]), size: f64) -> Vec<String> {
    let mut open = Vec::new();
    for d in (0..2).filter(|d| !is_periodic(scene, *d)) {
        for (sign, border, edge) in [(1.0, solid.low[d], fill.0[d]), (-1.0, solid.high[d], fill.1[d])] {
            let touches = sign * (edge - border) < 0.5 * size;
            if touches && !scene.walls.iter().any(|w| closes(w, d, sign, border, size)) {
                open.push(format!("{} = {}", AXES[d], shown(border, "m")));
            }
        }
    }
    open
}

/// A plane within a grain size of a border, or inside it.
fn closes(wall: &Wall, d: usize, sign: f64, border: f64, size: f64) -> bool {
    let (Some(point), Some(normal)) = (&wall.point, wall.normal) else { return false };
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    sign * normal[d] > 0.7 * length && sign * (point[d].si - border) > -size
}

fn is_periodic(scene: &Scene, d: usize) -> bool {
    scene.periodic.as_ref().is_some_and(|p| [&p.x, &p.y][d].is_some())
}
