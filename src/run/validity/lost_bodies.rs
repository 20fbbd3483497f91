//! Check for bodies below the solid surface.

use super::{Check, Limits};
use trackbed_track::GrainsView;

/// Lost over all bodies.
const LOST: Limits = Limits { warn: 0.01, fail: Some(0.5) };

/// Checks for bodies below the solid's lowest point [m]; message if any.
pub fn lost_bodies(view: GrainsView<'_>, lowest: f64) -> (Check, Option<String>) {
    let (model, state) = (view.model, view.state);
    let lost = |b: &usize| state.present(*b) && state.position(*b).z < lowest - model.radius(*b);
    let mut below = (0..model.body_count()).filter(lost);
    let first = below.next();
    let count = first.map_or(0, |_| 1 + below.count());
    let present = (0..model.body_count()).filter(|b| state.present(*b)).count();
    let message = first.map(|first| {
        let x = state.position(first);
        let first = model.name_objects(&format!("body {first}"));
        format!(
            "bodies lost below the surface of the solid: {count}, first {first} at ({:.4}, {:.4}, {:.4}) m. Enlarge the mesh, or place walls at its borders.",
            x.x, x.y, x.z
        )
    });
    let value = count as f64 / present.max(1) as f64;
    let text = message.clone();
    let check = Check::new("bodies lost over all bodies", value, LOST, || text.unwrap_or_default());
    let few = message.filter(|_| check.message.is_empty());
    (check, few)
}
